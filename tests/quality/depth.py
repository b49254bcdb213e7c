#!/usr/bin/env python3
"""usage: depth.py BUILD [--check] [SECTION...]
Write tests/depth.md: what depth costs, and how good it is; or only these sections of it anew.
With --check compare the scores that the scenes give with the page, and name the rows that moved.

The scenes are those in examples/data, unless REFOCUS_SCENES names another folder. Photos with known
depth are not in the repository: REFOCUS_PHOTOS names their folder, else it is sought in
../shared/photos beside the source. Without it their sections stay as they are.
"""
import array
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from pages import SOURCE, check, photos, scenes  # noqa: E402

PAGE = SOURCE / 'tests' / 'depth.md'

UPSAMPLING = '''`refocus-depth-quality SCENE...` on `depth_lowres.png` of the reference scenes: 180x135 samples
for 720x540 pixels, 1 % noise, 3 % holes. An edge is a step of 1/20 of the range. PSNR: sweep, 64
rays, mean of all views without blades, against the path-traced references; *to exact* is the
difference to rendering with the exact disparities. The joint bilateral mean is that of Kopf et
al. 2007 over 5x5 samples, sigma 1 sample and 0.1 of the range of codes. Asked: at most 0.5 dB
below exact on portrait and tabletop, 1.0 dB on fence. Builds with `-Dximgproc=enabled` add the
filters of OpenCV's contrib modules.'''

TIME = '''`refocus-depth-quality --time SCENE...`: 320x240 samples to 1920x1080 pixels, memory and threads of
its own in every call, the least and the median of 21 calls (5 of slow ones), CPU time of the
whole process. On a shared machine wall time means little; CPU time is reliable. Asked: 5 ms
on two threads. OpenCV chooses its own number of threads, but
for `joint-bilateral`, which works in one.'''

FLICKER = '''`refocus-depth-flicker --scenes SCENE...`: videos of 20 frames made of the scenes, 150x120 samples
with new noise of 1 % and new holes of 3 % in each, from the sixth frame on; panning by one sample
a frame. *Change* is |d - d of the last frame at the same point of the scene|, *flips* are changes
of more than 1/24 of the range that the scene does not make, errors are against the exact
disparities. `refocus_temporal_run()` with its defaults.'''

FLICKER_OF_PICTURES = '''`refocus-picture-flicker SCENE...`: how much rendered pictures flicker within 6 px of
the edges of the scene: the mean of the standard deviation over 14 frames of the brightness at a point
of the scene, in codes, at the scene's first view. The sensor has 150x120 samples for 600x480 pixels,
1 % noise, 3 % holes and flying pixels: of the samples beside an edge half lie somewhere between
both surfaces, others in each frame. The photo is rendered without noise; the filter sees it with noise
of 1.5 codes. With panning a sample never lies where it lay before: with depth that has no noise, 3
pixels a frame still come to 1.3 (portrait) and 1.6 (fence).'''

STEREO = '''`refocus depth LEFT RIGHT --match HOW` against ground truth: share of all known pixels that are
off after filling. *plain* is OpenCV's semi-global matching, holes filled as any; *checked* is the
default.'''

ONE_PICTURE = '''`refocus depth PHOTO --estimate` with the small TCMonoDepth network: Pearson's correlation with
the depth that is known of the photo.'''

FAULTY = '''`refocus-depth-quality --faults SCENE...`: the exact disparities of the reference scenes, spoilt as
those of phones, sensors and networks are, and what is left of it after `refocus_depth_edges()`
(*edges put right*). *Soft* is a Gaussian blur. *Quarter size* is the means of 4x4 pixels, which
`refocus_prepare()` upsamples by itself. *Grown* and *shrunk* are the greatest and the least of a
disc of radius 4. *Shifted* is to the right. *Displaced* is by a random field of vectors, 2 px long
as a root mean square, smoothed by a Gaussian of sigma 12; the nearest sample is taken. *Noise* is
the standard deviation of Gaussian noise, as a share of the range. PSNR: sweep, 64 rays, no light
given back to highlights, mean of all views without blades, against the path-traced references; *to
exact* is the difference to rendering with the exact disparities.'''

DECIMATED = '''`refocus-depth-quality --truth NAME PHOTO TRUTH...`: every fourth row and column of the
disparities of a Middlebury pair's left picture (2014 and 2006), brought back to all pixels; the
samples lie half a pixel off the middle of the 4x4 pixels that they stand for. No noise is added.
What is not known is filled before upsampling, or counts for little, and is not judged: no edge lies
there, nor is an error counted within 4 px of it. An edge is a step of 1/20 of the range; smooth
parts are more than 4 px from every edge.'''


def run(*command):
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except OSError as error:
        sys.exit('depth.py: %s' % error)


def tool(*command):
    """What a program prints that cannot fail but by the tree or its files."""
    try:
        return run(*command)
    except subprocess.CalledProcessError as error:
        sys.exit('depth.py: %s: %s' % (os.path.basename(command[0]), error.stderr.strip()))


def read_pfm(path):
    with open(path, 'rb') as file:
        kind, size, scale = file.readline(), file.readline(), float(file.readline())
        data = array.array('f', file.read())
    width, height = map(int, size.split())
    assert kind == b'Pf\n' and scale < 0
    rows = [data[y * width:(y + 1) * width] for y in range(height)]
    return width, height, [v for row in reversed(rows) for v in row]


def read_npz(path):
    with zipfile.ZipFile(path) as file:
        data = file.read(file.namelist()[0])
    header = struct.unpack('<H', data[8:10])[0]
    about = eval(data[10:10 + header].decode())  # a literal of the format
    assert about['descr'] == '<f4' and not about['fortran_order']
    values = array.array('f', data[10 + header:])
    return about['shape'][1], about['shape'][0], list(values)


def write_png16(path, width, height, values):
    def chunk(name, data):
        return (struct.pack('>I', len(data)) + name + data +
                struct.pack('>I', zlib.crc32(name + data)))

    rows = b''.join(b'\0' + struct.pack('>%dH' % width, *values[y * width:(y + 1) * width])
                    for y in range(height))
    with open(path, 'wb') as file:
        file.write(b'\x89PNG\r\n\x1a\n' +
                   chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 16, 0, 0, 0, 0)) +
                   chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def correlation(a, b):
    n = len(a)
    ma, mb = sum(a) / n, sum(b) / n
    cov = sum((x - ma) * (y - mb) for x, y in zip(a, b))
    return cov / math.sqrt(sum((x - ma) ** 2 for x in a) * sum((y - mb) ** 2 for y in b))


class Photos:
    def __init__(self, build, folder, work):
        self.refocus = os.path.join(build, 'platform', 'cli', 'refocus')
        self.folder, self.work = folder, work

    def at(self, *names):
        return os.path.join(self.folder, *names)

    def depth(self, *arguments):
        """Disparities as refocus depth makes them, and the lines of its report."""
        out = os.path.join(self.work, 'out.pfm')
        report = run(self.refocus, 'depth', *arguments, '-o', out)
        return read_pfm(out), report

    def stereo(self, method, left, right):
        (width, height, d), report = self.depth(left, right, '--match', method)
        least, greatest = map(float, re.search(r'disparities (\S+) to (\S+) pixels',
                                               report).groups())
        return width, height, [least + v * (greatest - least) for v in d]

    def stereo_rows(self):
        pairs = (('motorcycle (Middlebury 2014)', 'motorcycle_left.png', 'motorcycle_right.png',
                  read_npz(self.at('stereo-gt', 'motorcycle_disp.npz'))),
                 ('aloe (Middlebury 2006)', 'aloeL.jpg', 'aloeR.jpg', self.aloe()))
        for name, left, right, truth in pairs:
            for method in 'plain', 'checked', 'wls':
                try:
                    _, _, d = self.stereo(method, self.at('stereo-gt', left),
                                          self.at('stereo-gt', right))
                except subprocess.CalledProcessError:
                    continue  # no module of contrib filters
                off = [abs(a - b) for a, b in zip(d, truth[2]) if b > 0 and math.isfinite(b)]
                yield '| %s | %s | %.1f | %.1f |' % (
                    name, method, 100 * sum(v > 1 for v in off) / len(off),
                    100 * sum(v > 2 for v in off) / len(off))

    def aloe(self):
        """By way of refocus, which reads any PNG: 0 is unknown, 1 to 255 are pixels."""
        (width, height, d), report = self.depth(self.at('stereo-gt', 'aloeGT.png'))
        return width, height, [v * 255 for v in d]

    def truths(self):
        """Arguments of --truth: photos, and their disparities as codes of 16 bits, 0 unknown."""
        width, height, d = read_npz(self.at('stereo-gt', 'motorcycle_disp.npz'))
        most = max(v for v in d if math.isfinite(v))
        path = os.path.join(self.work, 'motorcycle.png')
        write_png16(path, width, height, [round(65535 * v / most) if v > 0 and math.isfinite(v)
                                          else 0 for v in d])
        aloe = os.path.join(self.work, 'aloe.png')
        run(self.refocus, 'render', self.at('stereo-gt', 'aloeL.jpg'), '--depth',
            self.at('stereo-gt', 'aloeGT.png'), '--blur', '0', '-o', aloe)
        return ('motorcycle', self.at('stereo-gt', 'motorcycle_left.png'), path,
                'aloe', aloe, self.at('stereo-gt', 'aloeGT.png'))

    def mono_rows(self):
        model = self.at('model', 'tcmonodepth_tcsmallnet_192x320.onnx')
        known = (('dahlia', ('phone', 'gdepth-dahlia.jpg'), ()),
                 ('pug', ('phone', 'apple-heic-pug.heic'), ()),
                 ('street', ('mono', 'street_8_all-in-focus.jpg'),
                  ('--depth', self.at('mono', 'street_8_disparity.jpg'))),
                 ('TUM office', ('rgbd', 'tum-office-color.png'),
                  ('--depth', self.at('rgbd', 'tum-office-depth.png'), '--depth-unit', '5000/m')),
                 ('TUM desk', ('rgbd', 'tum-fr2-desk-color.png'),
                  ('--depth', self.at('rgbd', 'tum-fr2-desk-depth.png'), '--depth-unit',
                   '5000/m')),
                 ('aloe', ('stereo-gt', 'aloeL.jpg'),
                  ('--depth', self.at('stereo-gt', 'aloeGT.png'))))
        for name, photo, more in known:
            (w, h, guess), _ = self.depth(self.at(*photo), '--estimate', model)
            (tw, th, truth), _ = self.depth(self.at(*photo), *more)
            at = [truth[(2 * y + 1) * th // (2 * h) * tw + (2 * x + 1) * tw // (2 * w)]
                  for y in range(h) for x in range(w)]
            yield '| %s | %.2f |' % (name, correlation(guess, at))


def section(name, words, table):
    return '\n## %s\n\n%s\n\n%s\n' % (name, words, table.strip())


def scene_sections(tools, folders):
    """(name, function that makes it) of what the scenes say."""
    def by(name, *options):
        return tool(os.path.join(tools, name), *options, *folders)

    yield 'Upsampling', lambda name: section(name, UPSAMPLING, by('refocus-depth-quality'))
    yield 'Faulty maps', lambda name: section(name, FAULTY, by('refocus-depth-quality',
                                                              '--faults'))
    yield 'Time of upsampling', lambda name: section(name, TIME, by('refocus-depth-quality',
                                                                   '--time'))
    yield 'Flicker', lambda name: section(name, FLICKER, by('refocus-depth-flicker', '--scenes'))
    yield 'Flicker of pictures', lambda name: section(name, FLICKER_OF_PICTURES,
                                                      by('refocus-picture-flicker'))


def photo_sections(tools, known):
    """And of what photos with known depth say."""
    yield 'Decimated ground truth', lambda name: section(
        name, DECIMATED, tool(os.path.join(tools, 'refocus-depth-quality'), '--truth',
                              *known.truths()))
    yield 'Stereo', lambda name: section(
        name, STEREO, '| pair | match | > 1 px, % | > 2 px, % |\n| --- | --- | --: | --: |\n' +
        '\n'.join(known.stereo_rows()))
    yield 'One picture', lambda name: section(
        name, ONE_PICTURE, '| photo | correlation |\n| --- | --: |\n' +
        '\n'.join(known.mono_rows()))


def sections_of(path):
    """The sections of the page that is there, by name."""
    with open(path, encoding='utf-8') as file:
        parts = re.split(r'(?m)^\n(?=## )', file.read())
    return {part[3:part.index('\n')]: '\n' + part for part in parts[1:]}


def main():
    only = [word for word in sys.argv[2:] if word != '--check']
    checks = len(only) < len(sys.argv) - 2
    if len(sys.argv) < 2 or sys.argv[1].startswith('-'):
        sys.exit(__doc__)
    build, there = os.path.abspath(sys.argv[1]), sections_of(PAGE)
    folders, where = scenes(['portrait', 'tabletop', 'fence'])
    text = ('# Depth: cost of coarse maps, and quality of estimated ones\n\n'
            'Written by `tests/quality/depth.py BUILD`. Scenes: %s. The sections from *%s* on are '
            'of photos that are not in the repository.\n' % (where, 'Decimated ground truth'))
    with tempfile.TemporaryDirectory() as work:
        makers = dict(scene_sections(os.path.join(build, 'tests', 'quality'), folders))
        if checks:
            del makers['Time of upsampling']
        elif photos().is_dir():
            makers.update(photo_sections(os.path.join(build, 'tests', 'quality'),
                                         Photos(build, str(photos()), work)))
        else:
            print('depth.py: no photos at %s: their sections stay' % photos(), file=sys.stderr)
        unknown = set(only) - set(makers)
        if unknown:
            sys.exit('depth.py: no such section, or its files are not there: %s' %
                     ', '.join(sorted(unknown)))
        made = {name: make(name) for name, make in makers.items() if not only or name in only}
    if checks:
        check(PAGE, ''.join(made.values()), 'tests/pages.sh BUILD depth')
        return
    text += ''.join(made.get(name, there.get(name, '')) for name in {**there, **made})
    PAGE.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
