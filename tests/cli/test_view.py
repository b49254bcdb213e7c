#!/usr/bin/env python3
"""usage: test_view.py REFOCUS  -- refocus view in a window, on a screen in memory (Xvfb), worked by
synthetic events (xdotool).

The screen is read from Xvfb's file of it and compared pixel by pixel. Exit status 77, after
saying so, where Xvfb or xdotool is missing. With REFOCUS_VIEW_SHOTS=FOLDER screenshots are kept
there as PPM files."""
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

import pictures
from test_window import screen_rows, start_display

SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))
ROOT = os.environ.get('REFOCUS_SOURCE_ROOT', os.path.join(os.path.dirname(__file__), '../..'))
SCENE = os.path.join(ROOT, 'examples/data/portrait/')
SHOTS = os.environ.get('REFOCUS_VIEW_SHOTS')
W, H = 720, 540
BOTTOM = H - 30  # rows above the line of text


class Viewer:
    """A viewer of W x H pixels without a window manager: at the corner of the screen, or in its
    middle."""

    def __init__(self, refocus, folder, display, *arguments):
        self.folder = folder
        self.environment = dict(os.environ, DISPLAY=display, SDL_VIDEODRIVER='x11',
                                SDL_RENDER_DRIVER='software',
                                SDL_FRAMEBUFFER_ACCELERATION='0')
        self.process = subprocess.Popen(
            [refocus, 'view', *arguments, '--json', '--size', '%dx%d' % (W, H)],
            env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        name = os.path.basename(arguments[0])
        found = self.until(lambda: self.xdotool('search', '--name', name), 'a window')
        self.window = found.split()[0]
        place = self.xdotool('getwindowgeometry', '--shell', self.window)
        values = dict(line.split('=') for line in place.split())
        self.x, self.y = int(values['X']), int(values['Y'])

    def xdotool(self, *arguments):
        return subprocess.run(['xdotool', *arguments], env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout

    def until(self, happened, what):
        end = time.monotonic() + 30 * SLOW
        while time.monotonic() < end:
            if self.process.poll() is not None:
                sys.exit('FAILED: the viewer ended while waiting for %s: %s' %
                         (what, self.process.communicate()))
            result = happened()
            if result:
                return result
            time.sleep(0.05)
        self.keep('late')
        self.process.kill()
        sys.exit('FAILED: no %s' % what)

    def at(self, x, y):
        return '%d' % (self.x + x), '%d' % (self.y + y)

    def tap(self, x, y):
        self.xdotool('mousemove', *self.at(x, y), 'click', '1')

    def drag(self, points, button='1'):
        moves = []
        for x, y in points[1:]:
            moves += ['mousemove', *self.at(x, y), 'sleep', '0.03']
        self.xdotool('mousemove', *self.at(*points[0]), 'mousedown', button, 'sleep', '0.05',
                     *moves, 'mouseup', button)

    def key(self, *names):
        self.xdotool('key', *names)

    def rows(self):
        """The window's rows, as bytes R, G, B."""
        rows = list(screen_rows(self.folder))[self.y:self.y + H]
        return [row[3 * self.x:3 * (self.x + W)] for row in rows]

    def keep(self, name):
        if SHOTS:
            with open(os.path.join(SHOTS, name + '.ppm'), 'wb') as file:
                file.write(b'P6 %d %d 255\n' % (W, H) + b''.join(self.rows()))

    def shows(self, picture, what):
        """Waits until the window shows these rows."""
        self.until(lambda: self.rows()[:BOTTOM] == picture[:BOTTOM], what)
        self.keep(what.replace(' ', '-'))

    def end(self):
        self.key('q')
        out, err = self.process.communicate(timeout=60 * SLOW)
        check(self.process.returncode == 0 and err == '', (self.process.returncode, err))
        return json.loads(out)


def check(holds, what):
    if not holds:
        sys.exit('FAILED: %s' % (what,))


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    check(done.returncode == 0, (command, done.stderr))


def read_png8(path):
    width, height, bits, channels, rows = pictures.read_png(path)
    check((width, height, bits, channels) == (W, H, 8, 3), path)
    return rows


def read_ppm(path):
    width, height, samples = pictures.read_pnm(path)
    check((width, height, max(samples) < 256) == (W, H, True), path)
    return [bytes(samples[3 * W * y:3 * W * (y + 1)]) for y in range(H)]


def read_depth(path):
    width, height, bits, channels, rows = pictures.read_png(path)
    check((width, height, bits, channels) == (W, H, 16, 1), path)
    return rows


def looked_at(refocus, folder, display):
    """Focus, aperture, method, views: what is on the screen is what `render` makes."""
    photo, depth = SCENE + 'allfocus.png', SCENE + 'disparity.png'
    before = read_png8(photo)
    disparity = read_depth(depth)
    grey = [b''.join(row[2 * x:2 * x + 1] * 3 for x in range(W)) for row in disparity]
    viewer = Viewer(refocus, folder, display, photo, '--depth', depth, '--focus', '0.1',
                    '--blur', '12', '-o', folder + '/out.png')

    def shows_render(what, *options):
        run(refocus, 'render', photo, '--depth', depth, '-o', folder + '/r.png', *options)
        viewer.shows(read_png8(folder + '/r.png'), what)

    shows_render('the first picture', '--focus', '0.1', '--blur', '12')
    viewer.key('b')
    viewer.shows(before, 'the photo before')
    viewer.key('b', 'd')
    viewer.shows(grey, 'the depth')
    viewer.key('d')
    viewer.tap(400, 200)
    viewer.key('j')
    settings = folder + '/out-settings.json'
    viewer.until(lambda: os.path.exists(settings), 'settings saved')
    with open(settings) as file:
        saved = json.load(file)
    value = int.from_bytes(disparity[200][800:802], 'big') / 65535
    check(abs(saved['focus'] - value) < 0.02 and saved['blur'] == 12, (saved, value))
    viewer.xdotool('mousemove', *viewer.at(30, 300))  # the mark of the tap stays, though:
    viewer.key('b', 'b')
    viewer.drag([(200, 250), (230, 250), (290, 250)])
    os.remove(settings)
    viewer.key('m', 'j')
    viewer.until(lambda: os.path.exists(settings), 'settings saved again')
    time.sleep(0.2)
    with open(settings) as file:
        saved = json.load(file)
    check(saved['method'] == 'search' and saved['blur'] > 15, saved)
    viewer.key('s')
    viewer.until(lambda: os.path.exists(folder + '/out.png'), 'the picture saved')
    run(refocus, 'render', photo, '--settings', settings, '-o', folder + '/r.png')
    check(read_png8(folder + '/out.png') == read_png8(folder + '/r.png'), 'what was saved')
    viewer.key('k')
    time.sleep(0.5 * SLOW)
    green = sum(row.count(b'\x20\xff\x40') for row in viewer.rows())
    viewer.keep('peaking')
    check(green > 500, 'peaking: %d' % green)
    viewer.key('k', 'End', 'Home')
    report = viewer.end()
    check(report['saved'] == 3 and report['driver'] == 'x11', report)
    causes = [one['cause'] for one in report['times']]
    for cause in ('open', 'tap', 'aperture', 'method', 'depth', 'before', 'peaking', 'zoom'):
        check(cause in causes, (cause, causes))
    check(report['times'][0]['full_ms'] > report['times'][0]['first_ms'] > 0, report)


def with_settings(refocus, folder, display):
    """What is saved is what `render` makes of the same settings, before and after a tap."""
    photo, depth = SCENE + 'allfocus.png', SCENE + 'disparity.png'
    small = folder + '/small.pgm'  # to be brought to the photo's size, alike in both
    rows = read_depth(depth)
    pictures.pgm(small, W // 4, H // 4, lambda x, y: int.from_bytes(
        rows[4 * y + 1][8 * x + 2:8 * x + 4], 'big'), 65535)
    grey = folder + '/grey.pgm'
    pictures.pgm(grey, 60, 45, lambda x, y: 255 * (x > 20 and y > 15))
    saved, settings = folder + '/s.png', folder + '/s-settings.json'
    for number, (map_, tap, *options) in enumerate((
            (depth, None, '--bokeh', 'vintage', '--focus-at', '400,200', '--blur', '40'),
            (small, None, '--focus-at', '400,200', '--tilt-angle', '30', '--grain', '1', '--seed',
             '3'),
            (depth, (300, 330), '--tilt-angle', '-25', '--star', '6', '--star-length', '40'),
            (depth, (300, 330), '--tilt-angle', '20', '--tilt-line', '100,100,600,400',
             '--focus', '0.3'),
            (depth, None, '--focus-plane', '100,500,600,500,400,200', '--cat-eye', '0.5'),
            (depth, (500, 100), '--focus-plane', '100,500,600,500,400,200', '--focus-width',
             '0.02', '--also-focus', '0.9:0.01', '--far-clamp', '0.1', '--blur-limit', '9'),
            (depth, (200, 400), '--sharp-mask', grey, '--squeeze', '0.6', '--fringe', '0.1'),
            (depth, (200, 400), '--field', 'plus', '--field-at', '300,300', '--field-disparity',
             '0.4', '--method', 'search', '--iterations', '1'),
            (depth, (200, 400), '--field', 'cylinder', '--field-radius', '0.2', '--aperture',
             'polygon:5', '--curvature', '0.5', '--quality', 'best'))):
        viewer = Viewer(refocus, folder, display, photo, '--depth', map_, '--blur', '12',
                        *options, '-o', saved)
        if tap:
            viewer.tap(*tap)
        viewer.key('s', 'j')
        viewer.until(lambda: os.path.exists(saved) and os.path.exists(settings), 'both files')
        viewer.end()
        run(refocus, 'render', photo, '--settings', settings, '-o', folder + '/r.png')
        check(read_png8(saved) == read_png8(folder + '/r.png'), ('settings', options))
        if not tap:
            run(refocus, 'render', photo, '--depth', map_, '--blur', '12', *options, '-o',
                folder + '/r.png')
            check(read_png8(saved) == read_png8(folder + '/r.png'), ('options', options))
        os.remove(saved)
        if number in (2, 4):  # and the file that was saved opens where it was left
            viewer = Viewer(refocus, folder, display, photo, '--settings', settings, '-o', saved)
            viewer.key('s')
            viewer.until(lambda: os.path.exists(saved), 'the picture again')
            viewer.end()
            check(read_png8(saved) == read_png8(folder + '/r.png'), ('again', options))
            os.remove(saved)
        os.remove(settings)
    # methods that cannot do it are passed over
    viewer = Viewer(refocus, folder, display, photo, '--depth', depth, '--cat-eye', '0.5', '-o',
                    saved)
    viewer.key('m', 'm')
    check(viewer.end()['method'] == 'sweep', 'cat eyes are of sweep')
    viewer = Viewer(refocus, folder, display, photo, '--depth', depth, '--tilt-angle', '9', '-o',
                    saved)
    viewer.key('m', 'm')
    check(viewer.end()['method'] == 'blur', 'jittered knows no tilt')


def with_noise(refocus, folder, display):
    """Noise that blur averages away is put back as `render` does it."""
    random_ = random.Random(5)
    noisy, saved = folder + '/noisy.ppm', folder + '/noisy.png'
    with open(noisy, 'wb') as file:
        file.write(b'P6 %d %d 255\n' % (W, H) + bytes(
            value for _ in range(W * H) for value in [round(random_.gauss(120, 4))] * 3))
    options = '--depth', SCENE + 'disparity.png', '--focus', '0.3', '--blur', '12'
    viewer = Viewer(refocus, folder, display, noisy, *options, '-o', saved)
    viewer.key('s')
    viewer.until(lambda: os.path.exists(saved), 'the noisy picture')
    viewer.end()
    for more in (), ('--grain', 'off'):
        run(refocus, 'render', noisy, *options, *more, '-o', folder + '/r.png')
        check((read_png8(saved) == read_png8(folder + '/r.png')) == (not more), ('noise', more))


def with_light(refocus, folder, display):
    """Photos of more than 8 bits and gain maps: what is shown and saved is what `render` makes."""
    rows, saved = read_png8(SCENE + 'allfocus.png'), folder + '/light.png'
    depth = '--depth', SCENE + 'disparity.png', '--depth-edges', 'as-given'
    lens = '--focus', '0.9', '--blur', '14', '--quality', 'standard'
    floats, deep, hdr = folder + '/f.pfm', folder + '/deep.png', folder + '/hdr.jpg'
    pictures.pfm_colour(floats, W, H, lambda x, y: [
        (8 if value > 220 else 1) * (value / 255) ** 2.2 for value in rows[y][3 * x:3 * x + 3]])
    pictures.png(deep, W, H, [b''.join(b'%c%c' % (value, 77) for value in row) for row in rows], 16)
    pictures.pgm(folder + '/gain.pgm', 60, 45, lambda x, y: 255 * (x > 30))
    for name in 'base', 'gain':
        run(refocus, 'render', SCENE + 'allfocus.png' if name == 'base' else folder + '/gain.pgm',
            *depth[:2], '--blur', '0', '-o', '%s/%s.jpg' % (folder, name))
    pictures.ultra_hdr(hdr, folder + '/base.jpg', folder + '/gain.jpg', 3)
    linear = '--transfer', 'linear', '--white', '0.7'
    made, sharp = folder + '/made.ppm', folder + '/sharp.ppm'  # of 8 bits, whatever the photo has
    for photo, *options in (floats,), (deep, *linear), (hdr,), (hdr, '--gain-map', 'ignore'):
        run(refocus, 'render', photo, *depth, *lens, *options, '-o', made)
        run(refocus, 'render', photo, *depth, '--blur', '0', *options, '-o', sharp)
        viewer = Viewer(refocus, folder, display, photo, *depth, *lens, *options, '-o', saved)
        viewer.shows(read_ppm(made), 'light %s' % ' '.join(options))
        viewer.key('s', 'b')
        viewer.until(lambda: os.path.exists(saved), 'the picture of light')
        before = b''.join(read_ppm(sharp)[:BOTTOM])  # dithered; what is shown may be rounded
        viewer.until(lambda: max(abs(a - b) for a, b in zip(
            before, b''.join(viewer.rows()[:BOTTOM]))) <= 2, 'before %s' % ' '.join(options))
        viewer.end()
        run(refocus, 'render', photo, *depth, *lens, *options, '-o', folder + '/r.png')
        check(pictures.read_png(saved) == pictures.read_png(folder + '/r.png'), (photo, options))
        check(pictures.read_png(saved)[2] == (8 if photo == hdr else 16), 'bits of what is saved')
        os.remove(saved)
    saved = folder + '/light.jpg'  # with a gain map of its own
    viewer = Viewer(refocus, folder, display, hdr, *depth, *lens, '-o', saved)
    viewer.key('s')
    viewer.until(lambda: os.path.exists(saved), 'the JPEG of light')
    viewer.end()
    run(refocus, 'render', hdr, *depth, *lens, '--no-editable', '-o', folder + '/r.jpg')
    check(pictures.read_bytes(saved) == pictures.read_bytes(folder + '/r.jpg'), 'Ultra HDR')
    check(pictures.read_bytes(saved).count(b'hdrgm:') > 0, 'it has a gain map')
    done = subprocess.run([refocus, 'view', deep, *depth, *linear, '--star', '6'], text=True,
                          env=dict(os.environ, SDL_VIDEODRIVER='dummy'),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    check(done.returncode == 1 and done.stderr.startswith('refocus: --transfer: '), done)


def with_strokes(refocus, folder, display):
    """--strokes paint before the window opens."""
    photo, depth = SCENE + 'allfocus.png', SCENE + 'disparity.png'
    strokes, saved = folder + '/strokes.json', folder + '/w.png'
    with open(strokes, 'w') as file:
        json.dump({'refocus-strokes': 1, 'width': W, 'height': H, 'strokes': [
            {'kind': 'all', 'gradient': [[0, 0, 0.1], [0, H - 1, 0.9]]},
            {'kind': 'object', 'radius': 9, 'points': [[380, 170], [400, 280]],
             'disparity': 0.6}]}, file)
    for base in ((), ('--depth', depth)):
        run(refocus, 'depth', photo, *base, '--strokes', strokes, '-o', folder + '/d.png')
        run(refocus, 'render', photo, '--depth', folder + '/d.png', '--focus-at', '390,200',
            '--blur', '10', '-o', folder + '/r.png')
        viewer = Viewer(refocus, folder, display, photo, *base, '--strokes', strokes,
                        '--focus-at', '390,200', '--blur', '10', '-o', saved)
        viewer.shows(read_png8(folder + '/r.png'), 'the picture of strokes')
        viewer.key('s', 'w')
        viewer.until(lambda: os.path.exists(folder + '/w-depth.png'), 'depth saved')
        check(viewer.end()['saved'] == 2, 'both saved')
        check(read_png8(saved) == read_png8(folder + '/r.png'), 'the picture of strokes')
        check(read_depth(folder + '/w-depth.png') == read_depth(folder + '/d.png'), 'their depth')
        for name in 'w-depth.png', 'w.png':
            os.remove(os.path.join(folder, name))
    with open(strokes, 'w') as file:
        file.write('{')
    done = subprocess.run([refocus, 'view', photo, '--strokes', strokes], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    check(done.returncode == 1 and done.stderr.count('\n') == 1 and
          done.stderr.startswith('refocus: ' + strokes + ': '), done)


def bright(rows):
    """Pixels of letters, in rows that are dark elsewhere."""
    return sum(row[i] > 90 for row in rows for i in range(0, 3 * W, 3))


def text(refocus, folder, display):
    """The line in a font, larger with more dots an inch; the keys; the title without a font."""
    dark = folder + '/dark.ppm'
    with open(dark, 'wb') as file:
        file.write(b'P6 %d %d 255\n' % (W, H) + bytes(3 * W * H))
    options = dark, '--depth', SCENE + 'disparity.png', '--focus', '0.25', '--blur', '7', '-o'
    done = subprocess.run([refocus, 'view', *options, folder + '/u.jpg', '--font', dark], text=True,
                          env=dict(os.environ, SDL_VIDEODRIVER='dummy'),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    check(done.returncode == 1 and done.stderr.count('\n') == 1 and
          'the font ' + dark in done.stderr, done)
    seen = {}
    # Without SDL2_ttf there is the title alone.
    for dpi in () if 'build it with SDL2_ttf' in done.stderr else ('96', '192'):
        viewer = Viewer(refocus, folder, display, *options, folder + '/t.jpg', '--dpi', dpi)
        viewer.until(lambda: bright(viewer.rows()[BOTTOM:]) > 50, 'the line')
        rows = viewer.rows()
        seen[dpi] = sum(bright([row]) > 0 for row in rows)
        check(bright(rows[:H - 60]) == 0, 'text above the line')
        viewer.keep('line-' + dpi)
        for press in 'question', 'h', 'F1':
            viewer.key(press)
            viewer.until(lambda: bright(viewer.rows()[:H - 60]) > 500, 'the keys')
            viewer.keep('keys-' + dpi)
            viewer.key('Escape')
            viewer.until(lambda: bright(viewer.rows()[:H - 60]) == 0, 'the keys gone')
        viewer.end()
    check(not seen or 1.6 * seen['96'] < seen['192'] < 2.4 * seen['96'], seen)
    viewer = Viewer(refocus, folder, display, *options, folder + '/t.jpg', '--font', 'none')

    def titled(words):
        viewer.until(lambda: words in viewer.xdotool('getwindowname', viewer.window), words)

    titled('dark.ppm: focus 0.250 \u00b7 blur 7.0 px')
    viewer.until(lambda: not any(map(any, viewer.rows())), 'the photo with nothing over it')
    viewer.key('h')
    titled('drag, wheel: aperture')
    viewer.key('h', 's')
    titled('saved ' + folder)
    viewer.end()


def refused(refocus, folder):
    """No display, no depth: one line, exit status 1."""
    environment = {key: value for key, value in os.environ.items()
                   if key not in ('DISPLAY', 'WAYLAND_DISPLAY', 'XDG_RUNTIME_DIR')}
    if os.path.exists('/dev/dri'):  # a screen there might be
        environment['SDL_VIDEODRIVER'] = 'x11'
    for options, why in ((('--depth', SCENE + 'disparity.png'), 'no display can be opened'),
                         ((), "paint it: 'refocus view --page PHOTO'")):
        done = subprocess.run([refocus, 'view', SCENE + 'allfocus.png', *options], text=True,
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        check(done.returncode == 1 and done.stdout == '' and done.stderr.count('\n') == 1 and
              why in done.stderr, done)


def main():
    refocus = os.path.abspath(sys.argv[1])
    for program in ('Xvfb', 'xdotool'):
        if not shutil.which(program):
            print('SKIPPED: there is no %s; install what Debian calls %s' %
                  (program, program.lower()))
            return 77
    with tempfile.TemporaryDirectory() as folder:
        server, display = start_display(folder)
        try:
            refused(refocus, folder)
            looked_at(refocus, folder, display)
            text(refocus, folder, display)
            with_settings(refocus, folder, display)
            with_noise(refocus, folder, display)
            with_light(refocus, folder, display)
            with_strokes(refocus, folder, display)
        finally:
            server.terminate()
            server.wait()
    print('ok')
    return 0


if __name__ == '__main__':
    sys.exit(main())
