#!/usr/bin/env python3
"""usage: test_view.py REFOCUS  -- refocus view in a window, on a screen in memory (Xvfb), worked by
synthetic events (xdotool).

The screen is read from Xvfb's file of it and compared pixel by pixel. Exit status 77, after
saying so, where Xvfb or xdotool is missing. With REFOCUS_VIEW_SHOTS=FOLDER screenshots are kept
there as PPM files."""
import json
import os
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
TOP, BOTTOM = 30, H - 80  # rows without the bars of the window


class Viewer:
    """A viewer of W x H pixels without a window manager: at the corner of the screen, or in its
    middle."""

    def __init__(self, refocus, folder, display, *arguments):
        self.folder = folder
        self.environment = dict(os.environ, DISPLAY=display, SDL_VIDEODRIVER='x11',
                                SDL_RENDER_DRIVER='software')
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
        """The window's rows between its bars, as bytes R, G, B."""
        rows = list(screen_rows(self.folder))[self.y + TOP:self.y + BOTTOM]
        return [row[3 * self.x:3 * (self.x + W)] for row in rows]

    def keep(self, name):
        if SHOTS:
            with open(os.path.join(SHOTS, name + '.ppm'), 'wb') as file:
                rows = [row[3 * self.x:3 * (self.x + W)] for row in
                        list(screen_rows(self.folder))[self.y:self.y + H]]
                file.write(b'P6 %d %d 255\n' % (W, H) + b''.join(rows))

    def shows(self, picture, what):
        """Waits until the window shows these rows."""
        self.until(lambda: self.rows() == picture[TOP:BOTTOM], what)
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
    viewer.tap(60, 520)  # on a button: no tap on the photo
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
    viewer.key('k', 'h')
    viewer.keep('help')
    viewer.key('h', 'End', 'Home')
    report = viewer.end()
    check(report['saved'] == 3 and report['driver'] == 'x11', report)
    causes = [one['cause'] for one in report['times']]
    for cause in ('open', 'tap', 'aperture', 'method', 'depth', 'before', 'peaking', 'zoom'):
        check(cause in causes, (cause, causes))
    check(report['times'][0]['full_ms'] > report['times'][0]['first_ms'] > 0, report)


def painted(refocus, folder, display):
    """Depth from nothing: a ground, a slope, an object, more and less of it, undo."""
    photo = SCENE + 'allfocus.png'
    viewer = Viewer(refocus, folder, display, photo, '--blur', '9', '-o', folder + '/p.png')
    saved, strokes = folder + '/p-depth.png', folder + '/p-strokes.json'

    def depth():
        for path in (saved, strokes):
            if os.path.exists(path):
                os.remove(path)
        viewer.key('w')
        viewer.until(lambda: os.path.exists(saved), 'depth saved')
        time.sleep(0.1 * SLOW)
        return read_depth(saved)

    def value(rows, x, y):
        return int.from_bytes(rows[y][2 * x:2 * x + 2], 'big') / 65535

    check(value(depth(), 300, 300) == 0, 'no depth')
    viewer.key('2', 'l', '9', 'g')
    viewer.drag([(360, 450), (360, 350), (360, 250)])
    slope = depth()
    check(abs(value(slope, 10, 449) - 0.9) < 0.02 and abs(value(slope, 10, 100) - 0.2) < 0.001 and
          0.4 < value(slope, 10, 350) < 0.7, [value(slope, 10, y) for y in (449, 350, 100)])
    viewer.key('6', 'p')
    viewer.drag([(262, 215), (320, 190), (380, 170), (460, 180), (475, 220), (400, 230),
                 (400, 280), (400, 340)])
    head = depth()
    time.sleep(0.5 * SLOW if SHOTS else 0)
    viewer.keep('painted')
    check(abs(value(head, 400, 200) - 0.6) < 1e-4 and value(head, 100, 100) < 0.21, 'the head')
    with open(strokes) as file:
        kinds = [one['kind'] for one in json.load(file)['strokes']]
    check(kinds == ['all', 'fill', 'object'], kinds)
    run(refocus, 'depth', photo, '--strokes', strokes, '-o', folder + '/again.png')
    check(read_depth(folder + '/again.png') == head, 'the strokes again')
    viewer.key('a')
    viewer.drag([(300, 450), (400, 430), (500, 460)])
    viewer.key('x')
    viewer.drag([(395, 335), (405, 335)])
    both = depth()
    check(abs(value(both, 400, 430) - 0.6) < 1e-4 and value(both, 400, 335) != 0.6, 'both')
    viewer.key('u', 'ctrl+z')
    check(depth() == head, 'undo')
    viewer.key('t')
    viewer.tap(400, 200)
    viewer.drag([(300, 300), (350, 320)], button='3')  # to move
    report = viewer.end()
    check(abs(report['focus'] - 0.6) < 1e-4, report['focus'])
    check([one for one in report['times'] if one['cause'] == 'paint' and one['first_ms']], 'paint')


def refused(refocus, folder):
    """No display: one line, exit status 1."""
    environment = {key: value for key, value in os.environ.items()
                   if key not in ('DISPLAY', 'WAYLAND_DISPLAY', 'XDG_RUNTIME_DIR')}
    if os.path.exists('/dev/dri'):  # a screen there might be
        environment['SDL_VIDEODRIVER'] = 'x11'
    done = subprocess.run([refocus, 'view', SCENE + 'allfocus.png'], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    check(done.returncode == 1 and done.stdout == '' and done.stderr.count('\n') == 1 and
          'no display can be opened' in done.stderr, done)


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
            painted(refocus, folder, display)
        finally:
            server.terminate()
            server.wait()
    print('ok')
    return 0


if __name__ == '__main__':
    sys.exit(main())
