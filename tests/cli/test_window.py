#!/usr/bin/env python3
"""usage: test_window.py REFOCUS  -- refocus live --out window, on a screen in memory (Xvfb).

What is on the screen is read from Xvfb's file of it and compared with the picture, pixel by
pixel. Exit status 77, after saying so, where there is no Xvfb."""
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))
WIDTH, HEIGHT = 161, 90


def start_display(folder, screen='800x640x24'):
    """A display of its own; its number comes through a pipe."""
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        ['Xvfb', '-displayfd', str(write_end), '-screen', '0', screen, '-fbdir', folder,
         '-nolisten', 'tcp', '-ac', '-noreset'], pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        return server, ':' + pipe.readline().strip()


def screen_rows(folder):
    """The rows of the screen as bytes R, G, B, from an XWD file (header of big-endian words)."""
    with open(os.path.join(folder, 'Xvfb_screen0'), 'rb') as file:
        data = file.read()
    header = struct.unpack('>25I', data[:100])
    size, width, height, stride, colours = header[0], header[4], header[5], header[12], header[19]
    begin = size + 12 * colours
    for y in range(height):
        row = data[begin + y * stride:begin + y * stride + 4 * width]
        rgb = bytearray(3 * width)
        rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
        yield bytes(rgb)


def is_shown(folder, pixels):
    rows = list(screen_rows(folder))
    for y, row in enumerate(rows[:-HEIGHT]):
        x = row.find(pixels[:3 * WIDTH])
        if x >= 0 and all(rows[y + i][x:x + 3 * WIDTH] ==
                          pixels[i * 3 * WIDTH:(i + 1) * 3 * WIDTH] for i in range(HEIGHT)):
            return True
    return False


def main():
    refocus = os.path.abspath(sys.argv[1])
    if not shutil.which('Xvfb'):
        print('SKIPPED: there is no Xvfb; install what Debian calls xvfb')
        return 77
    with tempfile.TemporaryDirectory() as folder:
        server, display = start_display(folder)
        try:
            return look(refocus, folder, display)
        finally:
            server.terminate()
            server.wait()


def look(refocus, folder, display):
    # What the libraries of X and D-Bus keep is theirs; ours is looked for in capture-window.
    environment = {**os.environ, 'DISPLAY': display, 'SDL_VIDEODRIVER': 'x11',
                   'ASAN_OPTIONS': os.environ.get('ASAN_OPTIONS', '') + ':detect_leaks=0'}
    pixels = random.Random(7).randbytes(3 * WIDTH * HEIGHT)
    with open(os.path.join(folder, 'in.ppm'), 'wb') as file:
        file.write(b'P6\n%d %d\n255\n' % (WIDTH, HEIGHT) + pixels)
    with open(os.path.join(folder, 'depth.pgm'), 'wb') as file:
        file.write(b'P5\n2 1\n255\n\x00\xff')
    if is_shown(folder, pixels):
        print('FAILED: the picture is there before the window')
        return 1
    run = subprocess.Popen(
        [refocus, 'live', '--camera', 'file:in.ppm', '--depth', 'depth.pgm', '--blur', '0',
         '--no-commands', '--out', 'window'], cwd=folder, env=environment,
        stderr=subprocess.PIPE)
    until = time.monotonic() + 30 * SLOW
    shown = False
    while not shown and time.monotonic() < until and run.poll() is None:
        time.sleep(0.1)
        shown = is_shown(folder, pixels)
    run.send_signal(signal.SIGINT)
    error = run.communicate(timeout=30 * SLOW)[1].decode()
    print('shown: %s, exit status %d\n%s' % (shown, run.returncode, error))
    return 0 if shown and run.returncode == 0 else 1


if __name__ == '__main__':
    sys.exit(main())
