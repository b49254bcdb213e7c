#!/usr/bin/env python3
"""usage: test_live_all.py REFOCUS  -- refocus live: each input format x each sink x each option.

The formats, the sinks and the options are those that `refocus live --help-all` names; one that has no
row in the tables here fails. Options that go together are tried in one run, and one by one when
that fails. A run either works: exit 0, each frame, and what the sink holds has the right size and
format. Or it is refused as the tables say: with that exit code, and one line with those words."""
import concurrent.futures
import contextlib
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading

from names import method_names, methods_with_rays

REFOCUS = os.path.abspath(sys.argv[1])
SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))
WIDTH, HEIGHT, FRAMES = 17, 11, 4  # odd: a half pair at the end of each row and column
HALF = (WIDTH + 1) // 2 * ((HEIGHT + 1) // 2)
LUMA, PACKED = WIDTH * HEIGHT, (WIDTH + 1) // 2 * 4 * HEIGHT
YUV = 'NV12', 'NV21', 'YUV420', 'YUYV', 'UYVY'

# Bytes of a frame; MJPEG comes by a script.
FORMATS = {'YUYV': PACKED, 'UYVY': PACKED, 'NV12': LUMA + 2 * HALF, 'NV21': LUMA + 2 * HALF,
           'YUV420': LUMA + 2 * HALF, 'RGB24': 3 * LUMA, 'BGR24': 3 * LUMA, 'RGBX': 4 * LUMA,
           'BGRX': 4 * LUMA, 'MJPEG': None, 'GREY': LUMA, 'Y16': 2 * LUMA, 'Z16': 2 * LUMA}

# Other kinds of sources: the camera, and the format that its frames have.
SOURCES = {'y4m 4:2:0': ('y4m:420.y4m', 'YUV420'), 'y4m 4:2:2': ('y4m:422.y4m', 'YUYV'),
           'y4m mono': ('y4m:mono.y4m', 'GREY'), 'pictures': ('file:in-%d.ppm', 'RGB24'),
           'script': ('replay::format NV12;size %dx%d;frames %d' % (WIDTH, HEIGHT, FRAMES), 'NV12')}

# As --out's help has them: the names to try, and how they are refused.
RAW = 'own', 'NV12', 'NV21', 'YUV420', 'YUYV', 'UYVY', 'RGB24', 'BGR24', 'RGBX', 'BGRX'
SINKS = {'window': ['window'], 'v4l2:/dev/video9': ['v4l2:/dev/none'],
         'pipewire:[NAME] (a camera that browsers list)': ['pipewire:none'], 'y4m:FILE': ['y4m:out.y4m'],
         'raw:FILE[,FORMAT]': ['raw:out.raw'] + ['raw:out.raw,' + name for name in RAW],
         'frames-%04d.png': ['out-%d.png', 'out-%d.jpg', 'out-%d.ppm'], 'null': ['null']}
REFUSED_SINKS = {'v4l2:/dev/none': (1, 'it is not there'),
                 'pipewire:none': (1, 'no PipeWire runs for this user|modules are missing; install')}
os.environ['PIPEWIRE_REMOTE'] = 'no such socket'

HAS_OPENCV = b'OpenCV' in subprocess.run([REFOCUS, '--version'], capture_output=True).stdout
BASE = ['--depth', 'raw:depth.raw,Z16,8x6,30', '--json']
EVERY = ['--fast', '--frames-policy', 'every']
FEW = ['--rays', '4', *EVERY]
# Options that are tried together: each option of the help is in one of these.
GROUPS = [
    FEW,
    ['--rays', '4', '--frames', '3'],  # the newest wins; from files to files each frame
    [*FEW, '--steady', '0.9', '--near', '0.5', '--far', 'inf', '--depth-unit', 'mm', '--focus',
     '0.7', '--blur-most', '9', '--threads', '1', '--cpu', 'c', '--no-commands', '--invalid', 'max',
     '--patience', '1', '--matrix', 'bt709', '--highlights', 'off', '--depth-edges', 'auto',
     '--tilt-angle', '20', '--tilt-line', '0,5,9,5', '--tilt-compress', '0.5', '--far-clamp', '0.1',
     '--near-clamp', '0.9', '--blur-limit', '4', '--f-number', '2', '--focal-length', '50',
     '--sensor-width', '30', '--open-f-number', '1.4', '--aperture', 'polygon:6', '--curvature',
     '0.5', '--squeeze', '0.8', '--ring', '0.3', '--field', 'plane', '--field-at', '4,4',
     '--field-disparity', '0.5', '--field-radius', '0.1', '--field-falloff', '0.2', '--field-angle',
     '30'],
    [*EVERY, '--focus-at', '3,3', '--quality', 'preview', '--aperture', 'polygon:5', '--blend',
     'gamma', '--sigma', '100', '--focus-width', '0.1', '--focus-transition', '0.1',
     '--also-focus', '0.2,0.9:0.1', '--focus-map', 'in-0.ppm', '--sharp-mask', 'in-1.ppm', '--fps',
     '25', '--size', '17x11', '--format', 'any',
     '--calibration', 'calibration.json', '--socket', 'socket'],
    [*EVERY, '--quality', 'best', '--blend', 'stored', '--rays', 'full', '--highlights', '2',
     '--aperture', 'heart', '--near', '1', '--field', 'picture', '--field-map', 'in-2.ppm'],
    # By way of R, G and B: what Y, U and V cannot be rendered with.
    [*FEW, '--bokeh', 'vintage', '--edge', '0.5', '--edge-before', '0.2', '--cat-eye', '0.3',
     '--fringe', '0.1', '--grain', '1', '--seed', '3', '--highlight-stops', '2', '--star', '4',
     '--star-length', '5', '--star-angle', '10', '--star-strength', '0.5', '--focus-distance', '2'],
    [*FEW, '--loop', '--duration', '0.05', '--focus-rectangle', '2,2,9,6'],
    [*FEW, '--upsample', 'joint-bilateral' if HAS_OPENCV else 'core', '--near', '1', '--focus',
     '0.7'],
    [*FEW, '--method', 'search', '--iterations', '1', '--mirror', '--background', '--steady',
     '0.5'],
]
BY_RGB = '--bokeh', 'joint-bilateral'
# Options of single methods, tried with these.
OF_METHODS = {'jittered': ['--cell', '3', '--seed', '1'],
              'scatter': ['--spread', 'lommel', '--airy-radius', '2', '--depth-ratio', '3'],
              'interpolated': ['--sharp-radius', '1', '--middle-ratio', '2', '--last-ratio', '3'],
              'foveated': ['--attention', '3,3', '--attention-angle', '5', '--picture-angle', '40',
                           '--attention-depth', '0.5'],
              'diffusion': ['--layers', '2', '--solver', 'steps', '--conductivity', '0.2']}
# Tried with each format and with each sink, but not with each pair of them.
METHODS = [m for m in method_names(REFOCUS) if m not in ('sweep', 'search')]
WITHOUT_RAYS = set(METHODS) - set(methods_with_rays(REFOCUS))
# Options that nothing here takes: an exit code and words, or what standard output begins with.
ALONE = {'--dmabuf': (2, 'it is for V4L2 cameras'),
         '--autofocus=off': (1, 'its lens does not move; leave it out'),
         '--focus-plane=1,1,5,5,9,1': (2, 'changes in live'), '--list': 'FORMAT', '--help': 'usage:',
         '--help-all': 'usage:'}
IN_BASE = '--camera', '--depth', '--out', '--blur', '--json'


thread = threading.local()


def content(name):
    with open(name, 'rb') as file:
        return file.read()


def run(args, folder, timeout=60):
    return subprocess.run([REFOCUS, 'live', *args], cwd=folder, stdin=subprocess.DEVNULL,
                          capture_output=True, timeout=timeout * SLOW,
                          env={**os.environ, 'SDL_VIDEODRIVER': 'dummy'})


def read_help():
    """The formats, sinks, raw formats and options that the help names."""
    text = run(['--help-all'], '.').stdout.decode()
    options = set(re.findall(r'^  (?:-., )?(?:    )?(--[a-z-]+)', text, re.M))
    flat = ' '.join(text.split())
    formats = re.search(r'--format NAME .*?: ([\w, ]+?) --size', flat).group(1).split(', ')
    out = re.search(r'--out SINK (.*?) --list', flat).group(1)
    sinks = out.split(';')[0].replace(' (default)', '').replace(' or ', ', ').split(', ')
    raw = re.sub(r' \([^)]*\)', '', out.split('FORMAT ')[-1]).replace(' or ', ', ').split(', ')
    return set(formats) - {'any'}, set(sinks), set(raw), options


def check_tables():
    """What the help has and the tables have not, and the other way."""
    formats, sinks, raw, options = read_help()
    covered = {a for group in (*GROUPS, *OF_METHODS.values()) for a in group
               if a.startswith('--')} | {'--method'}
    for what, there, here in (('formats', formats, set(FORMATS)), ('sinks', sinks, set(SINKS)),
                              ('raw formats', raw, set(RAW)),
                              ('options', options, covered | {option.split('=')[0] for option in ALONE} | set(IN_BASE))):
        if there != here:
            yield '%s: the help has %s, the tables here %s' % (what, sorted(there - here),
                                                               sorted(here - there))


def make_inputs():
    noise = bytes((i * 73 + i // 31 * 11) % 200 + 30 for i in range(4 * LUMA + 4 * HALF)) * 2
    for name, size in FORMATS.items():
        if size:
            with open(name + '.raw', 'wb') as file:
                file.write(b''.join(noise[7 * n:7 * n + size] for n in range(FRAMES)))
    for name, space, size in (('420', '420jpeg', LUMA + 2 * HALF),
                              ('422', '422', LUMA + (WIDTH + 1) // 2 * HEIGHT * 2),
                              ('mono', 'mono', LUMA)):
        with open(name + '.y4m', 'wb') as file:
            file.write(b'YUV4MPEG2 W%d H%d F30:1 C%s\n' % (WIDTH, HEIGHT, space.encode()))
            for n in range(FRAMES):
                file.write(b'FRAME\n' + noise[n:n + size])
    for n in range(FRAMES):
        with open('in-%d.ppm' % n, 'wb') as file:
            file.write(b'P6\n%d %d\n255\n' % (WIDTH, HEIGHT) + noise[n:n + 3 * LUMA])
    with open('depth.raw', 'wb') as file:
        for n in range(FRAMES):
            file.write(b''.join(struct.pack('<H', 900 if x in (n, n + 1) else 2000 + 100 * x)
                                for y in range(6) for x in range(8)))
    pinhole = {'fx': 30, 'fy': 30}
    with open('calibration.json', 'w') as file:
        json.dump({'depth': {'width': 8, 'height': 6, 'cx': 3.5, 'cy': 2.5, **pinhole},
                   'colour': {'width': WIDTH, 'height': HEIGHT, 'cx': 8, 'cy': 5, **pinhole},
                   'rotation': [1, 0, 0, 0, 1, 0, 0, 0, 1], 'translation_m': [0, 0, 0]}, file)


def jpeg_size(data):
    at = 2
    while data[at + 1] not in (0xc0, 0xc1, 0xc2):
        at += 2 + struct.unpack('>H', data[at + 2:at + 4])[0]
    return struct.unpack('>HH', data[at + 5:at + 9])[::-1]


def picture_size(data, kind):
    if kind == 'png':
        return struct.unpack('>II', data[16:24])
    return jpeg_size(data) if kind == 'jpg' else tuple(map(int, data.split()[1:3]))


def check_output(folder, out, frames, rendered_in):
    """What is wrong with what the sink wrote, or None."""
    if out.startswith('y4m:'):
        tall = rendered_in == 'YUYV'
        head = b'W%d H%d F' % (WIDTH, HEIGHT), b' C%s ' % (b'422' if tall else b'420jpeg')
        size = LUMA + (2 * ((WIDTH + 1) // 2) * HEIGHT if tall else 2 * HALF)
        header, _, rest = content(os.path.join(folder, 'out.y4m')).partition(b'\n')
        if any(word not in header for word in head):
            return 'its header is %r' % header
        if len(rest) != frames * (6 + size) or rest[::6 + size] != b'F' * frames:
            return 'it has %d bytes, not %d frames of %d' % (len(rest), frames, 6 + size)
    elif out.startswith('raw:'):
        form = out.partition(',')[2] or 'RGB24'
        size = FORMATS[rendered_in if form == 'own' else form]
        there = os.path.getsize(os.path.join(folder, 'out.raw'))
        if there != frames * size:
            return 'it has %d bytes, not %d frames of %d' % (there, frames, size)
    elif '%' in out:
        for n in range(frames):
            size = picture_size(content(os.path.join(folder, out % n)), out[-3:])
            if size != (WIDTH, HEIGHT):
                return '%s is of %s' % (out % n, size)
        if os.path.exists(os.path.join(folder, out % frames)):
            return 'there are more than %d pictures' % frames
    return None


def expected_frames(camera, out, args):
    """The least and the most."""
    files = (out.startswith(('y4m:', 'raw:')) or '%' in out) and not camera.startswith('replay:')
    frames = 3 if '--frames' in args else FRAMES
    if '--duration' in args:  # of the frames from files to files: those at 0 and 33 ms
        return (2, 2) if files else (0, sys.maxsize)
    return (frames, frames) if files or '--fast' in args else (1, frames)


@contextlib.contextmanager
def folder_of_its_own():
    """One of each thread, with the inputs in it; what a run leaves there goes."""
    if not hasattr(thread, 'folder'):
        thread.folder = tempfile.mkdtemp(dir='.')
        thread.inputs = {name for name in os.listdir('.') if os.path.isfile(name)}
        for name in thread.inputs:
            os.symlink(os.path.abspath(name), os.path.join(thread.folder, name))
    yield thread.folder
    for name in set(os.listdir(thread.folder)) - thread.inputs:
        os.remove(os.path.join(thread.folder, name))


def check_run(camera, form, out, args, refused):
    """What is wrong with a run, or None."""
    with folder_of_its_own() as folder:
        try:
            blur = [] if '--f-number' in args else ['--blur', '3']
            done = run(['--camera', camera, '--out', out, *BASE, *blur, *args], folder)
        except subprocess.TimeoutExpired:
            return 'it does not end'
        lines = done.stderr.decode().splitlines()
        if refused:
            if (done.returncode, len(lines), done.stdout) != (refused[0], 1, b'') or \
                    not re.match(r'refocus: .+: .+', lines[0]) or not re.search(refused[1], lines[0]):
                return 'exit %d, %r; not refused with %d, %r' % (done.returncode, lines, *refused)
            return None
        if done.returncode != 0 or lines:
            return 'exit %d, %r' % (done.returncode, lines)
        report = json.loads(done.stdout)
        least, most = expected_frames(camera, out, args)
        frames = report['frames_out']
        if not least <= frames <= most:
            return '%d frames, not %d to %d' % (frames, least, most)
        by_rgb = '--method' in args and 'search' not in args
        direct = form in YUV and not by_rgb and not any(a in args for a in BY_RGB) and \
            (out == 'null' or out.startswith('y4m:') or out.partition(',')[2] in (*YUV, 'own'))
        rendered_in = 'RGB24' if not direct else 'YUYV' if form == 'UYVY' else form
        if frames and report['rendered_in'] != rendered_in:
            return 'it was rendered in %s, not %s' % (report['rendered_in'], rendered_in)
        return check_output(folder, out, frames, rendered_in) if frames else None


def one_by_one(args):
    """Each option of a group by itself, beside what keeps runs short."""
    at = 0
    while at < len(args):
        many = at + 1 < len(args) and not args[at + 1].startswith('--')
        option = args[at:at + 1 + many]
        at += len(option)
        if option[0] not in FEW:
            yield [*FEW, *option, *(['--frames', '3'] if option[0] == '--loop' else [])]


def check(case):
    """Lines about a combination that fails."""
    camera, form, out, args, refused = case
    wrong = check_run(*case)
    if not wrong:
        return []
    alone = [(option, check_run(camera, form, out, option, refused)) for option in one_by_one(args)]
    named = [(option, why) for option, why in alone if why == wrong] or [(args, wrong)]
    return ['%s -> %s %s: %s' % (camera, out, ' '.join(option), why) for option, why in named]


def all_cases(has_jpeg, has_window, version):
    refused = dict(REFUSED_SINKS)
    if not has_window:
        refused['window'] = (1, 'this build has no window')
    if b'v4l2' not in version:
        refused['v4l2:/dev/none'] = (1, 'this build has no v4l2')
    if b'pipewire' not in version:
        refused['pipewire:none'] = (1, 'this build has no pipewire')
    outs = [out for names in SINKS.values() for out in names if has_jpeg or '.jpg' not in out]
    inputs = [('raw:%s.raw,%s,%dx%d,30' % (form, form, WIDTH, HEIGHT), form)
              for form, size in FORMATS.items() if size]
    if has_jpeg:
        inputs.append(('replay::jpeg in.jpg;frames %d' % FRAMES, 'MJPEG'))
    for camera, form in inputs:
        for out in outs:
            for args in GROUPS:
                yield camera, form, out, args, refused.get(out)
    for n, method in enumerate(METHODS):
        for i in range(max(len(inputs), len(outs))):
            out = outs[(i + n) % len(outs)]
            args = [*(EVERY if method in WITHOUT_RAYS else FEW), '--method', method,
                    *OF_METHODS.get(method, [])]
            yield (*inputs[i % len(inputs)], out, args, refused.get(out))
        if method in WITHOUT_RAYS:
            yield (*inputs[n], outs[n], [*FEW, '--method', method], (2, 'it changes nothing'))
    for camera, form in SOURCES.values():
        for out in outs:
            yield camera, form, out, FEW, refused.get(out)
            yield camera, form, out, [*FEW, '--steady', '0.5'], refused.get(out)
    yield ('raw:YUYV.raw,MJPEG,17x11,30', 'MJPEG', 'null', FEW, (2, 'is no format of raw frames'))


def check_alone():
    for option, expected in ALONE.items():
        done = run(['--camera', 'raw:NV12.raw,NV12,17x11,30', '--depth', 'depth.raw', option], '.')
        if isinstance(expected, tuple):
            sound = done.returncode == expected[0] and expected[1] in done.stderr.decode()
        else:
            begin = 'NV12' if expected == 'FORMAT' else expected
            sound = done.returncode == 0 and done.stdout.decode().startswith(begin)
        if not sound:
            yield '%s: exit %d, %r %r' % (option, done.returncode, done.stdout[:80], done.stderr)


def main():
    version = subprocess.run([REFOCUS, '--version'], capture_output=True, check=True).stdout
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_inputs()
        has_jpeg = b'JPEG' in version
        if has_jpeg:
            run(['--camera', 'file:in-0.ppm', '--depth', 'raw:depth.raw,Z16,8x6,30', '--frames',
                 '1', '--out', 'made-%d.jpg'], '.')
            shutil.move('made-0.jpg', 'in.jpg')
        cases = list(all_cases(has_jpeg, 'RF_WINDOW' in os.environ, version))
        if SLOW > 1:  # of a build with sanitizers some of each
            cases = cases[::7]
        failures = list(check_tables()) + list(check_alone())
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for lines in pool.map(check, cases):
                failures += lines
        os.chdir('/')
    print('%d combinations, %d failures' % (len(cases), len(failures)))
    print('\n'.join(failures[:60]))
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
