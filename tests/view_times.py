#!/usr/bin/env python3
"""usage: tests/view_times.py BUILD [TAPS]

Writes tests/view.md: the time from a tap in the window of `refocus view` to the first picture that
answers it, and to the one of full resolution, at 2, 12 and 48 megapixels; and the memory. A
real window on a screen in memory (Xvfb), tapped by xdotool, each tap when the one before is
answered wholly."""
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TOP, 'tests/cli'))
import pictures                       # noqa: E402
from test_window import start_display  # noqa: E402

SCENE = os.path.join(TOP, 'examples/data/portrait/')
SIZES = ((1632, 1224), (4032, 3024), (8064, 6048))
SPOTS = ((620, 400), (100, 200))  # the figure, the wall; of 1280 x 960


def enlarge(rows, width, height, pixel, kind, path):
    """Pixels of `pixel` bytes, repeated to width x height; a PPM or PGM file."""
    columns = [x * (len(rows[0]) // pixel) // width for x in range(width)]
    with open(path, 'wb') as file:
        file.write(b'%s %d %d %d\n' % (kind, width, height, 255 if pixel == 3 else 65535))
        for y, row in enumerate(rows):
            cells = [row[i:i + pixel] for i in range(0, len(row), pixel)]
            wide = b''.join(cells[x] for x in columns)
            file.write(wide * ((y + 1) * height // len(rows) - y * height // len(rows)))


def xdotool(display, *arguments):
    return subprocess.run(['xdotool', *arguments], env=dict(os.environ, DISPLAY=display),
                          text=True, stdout=subprocess.PIPE).stdout


def measure(refocus, display, photo, depth, taps, patience):
    viewer = subprocess.Popen(
        [refocus, 'view', photo, '--depth', depth, '--focus', '0.1', '--json', '--size',
         '1280x960'], stdout=subprocess.PIPE, text=True,
        env=dict(os.environ, DISPLAY=display, SDL_VIDEODRIVER='x11',
                 SDL_RENDER_DRIVER='software', SDL_FRAMEBUFFER_ACCELERATION='0'))
    while not xdotool(display, 'search', '--name', os.path.basename(photo)):
        time.sleep(0.2)
    window = xdotool(display, 'search', '--name', os.path.basename(photo)).split()[0]
    place = dict(line.split('=') for line in
                 xdotool(display, 'getwindowgeometry', '--shell', window).split())
    time.sleep(3 * patience)
    for i in range(taps):
        x, y = SPOTS[i % 2]
        xdotool(display, 'mousemove', str(int(place['X']) + x), str(int(place['Y']) + y),
                'click', '1')
        time.sleep(patience)
    xdotool(display, 'key', 'q')
    report = json.loads(viewer.communicate()[0])
    times = [one for one in report['times'] if one['cause'] == 'tap']
    full = [one['full_ms'] for one in times if one['full_ms']]
    return report, [[one[key] for one in times if one['first_ms']]
                    for key in ('first_ms', 'first_cpu_ms')], full


def machine():
    with open('/proc/cpuinfo') as file:
        names = [line.split(':')[1].strip() for line in file if line.startswith('model name')]
    return '%s, %d logical processors' % (names[0] if names else platform.machine(),
                                          os.cpu_count())


def main():
    refocus = os.path.join(sys.argv[1], 'platform/cli/refocus')
    taps = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    lines = []
    photo_rows = pictures.read_png(SCENE + 'allfocus.png')[4]
    depth_rows = pictures.read_png(SCENE + 'disparity.png')[4]
    with tempfile.TemporaryDirectory() as folder:
        server, display = start_display(folder, '1400x1100x24')
        try:
            for width, height in SIZES:
                photo, depth = folder + '/photo.ppm', folder + '/depth.pgm'
                enlarge(photo_rows, width, height, 3, b'P6', photo)
                enlarge(depth_rows, width, height, 2, b'P5', depth)
                report, (first, cpu), full = measure(refocus, display, photo, depth, taps,
                                              0.5 + width * height / 4e6)
                lines.append('| %.0f | %dx%d | 1/%d | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f |' % (
                    width * height / 1e6, width, height, report['reduction'], min(first),
                    statistics.median(first), min(cpu), min(full), statistics.median(full),
                    report['peak_rss_kib'] / 1024))
                print(lines[-1], flush=True)
        finally:
            server.terminate()
            server.wait()
    with open(os.path.join(TOP, 'tests/view.md'), 'w') as file:
        file.write('''# The viewer: from a tap to a picture

Written by `tests/view_times.py BUILD`: the time in milliseconds from a tap in a window of 1280x960
pixels to the picture on the screen that shows its focus, reading the event and drawing included, for
%d taps between two surfaces. The first picture is rendered with 32 rays from the photo reduced by the
factor given; the full one with 64 rays from the whole photo, K = 1/50 of its width up to 127 pixels.
Processor time is the least of all threads together from the tap to the first picture, drawing
included. As two threads render, it is more than the time that an idle machine takes. The scene is
`portrait`, enlarged. Memory is the peak of the process, SDL included. %s; %s; load average %.1f.

| megapixels | photo | reduced | first: min | median | its processor time | full: min | median | MiB |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
%s
''' % (taps, machine(), 'Xvfb, SDL drawing in software', os.getloadavg()[1], '\n'.join(lines)))


if __name__ == '__main__':
    main()
