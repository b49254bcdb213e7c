#!/usr/bin/env python3
"""usage: hostile.py REFOCUS [--all] [NAME...]  -- what hostile files cost, and how they are answered.

Prints a line for each file: its size, processor time, peak memory and the answer. What is refused
may take a second and 256 MiB; what is accepted a second, 256 MiB and so much for each of its
pixels. The exit status allows BUSY times the seconds: the same work takes twice as long and more
on a busy machine, and work without a limit takes a hundred times as long.
--all, too, takes those that need minutes to be made or gigabytes where a limit fails."""
import argparse
import os
import socket
import subprocess
import sys
import tempfile
import time

import files

MIB = 1 << 20
SECONDS, BYTES = 1, 256 * MIB
SECONDS_A_PIXEL, BYTES_A_PIXEL = 1.2e-6, 16  # a photo is 3 bytes a pixel, and info reads it twice
BUSY = 6
PATIENCE = 40                                # seconds after which a command is ended
SCREEN = 720, 540
SCREEN_PIXELS = 720 * 540
# A limit of a tenth of the time would say as much, but sanitizers and emulators are slow.
SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))

REFUSED = None  # or the pixels of a file that is accepted


def info(name):
    return ['info', name]


def paint(name):
    return ['depth', 'screen.ppm', '--strokes', name, '-o', 'out.png']


def sparse(size, start=b''):
    def make(path):
        with open(path, 'wb') as file:
            file.write(start)
            file.truncate(size)
    return make


def pnm(text):
    return lambda: text.encode()


def bind(path):
    with socket.socket(socket.AF_UNIX) as place:
        place.bind(path)


def link(target):
    return lambda path: os.symlink(target, path)


# name: what makes the file, the command, and what is expected. Those of ALL cost much to make.
CASES = {
    'fifo without writer': (os.mkfifo, info, REFUSED),
    'fifo of strokes': (os.mkfifo, paint, REFUSED),
    '/dev/zero': (link('/dev/zero'), info, REFUSED),
    '/dev/zero of strokes': (link('/dev/zero'), paint, REFUSED),
    'folder': (os.mkdir, info, REFUSED),
    'socket': (bind, info, REFUSED),
    'sparse file of 900 MB': (sparse(900 * MIB), info, REFUSED),
    'sparse file of 3 TB': (sparse(3 << 40), info, REFUSED),
    'P5 65535x65535': (pnm('P5 65535 65535 255\n'), info, REFUSED),
    'P2 20000x20000': (pnm('P2 20000 20000 255\n' + '1 ' * 1000), info, REFUSED),
    'Pf 65535x65535': (pnm('Pf 65535 65535 -1\n'), info, REFUSED),
    'PNG 65535x3000': (lambda: files.png(65535, 3000, 1), info, REFUSED),
    'PNG 4000x3000': (lambda: files.png(4000, 3000), info, 12000000),
    'PNG, 20 zTXt of 45 MB': (lambda: files.png_texts(b'zTXt', 20, 45 * MIB), info, 256),
    'PNG, 20 iTXt of 45 MB': (lambda: files.png_texts(b'iTXt', 20, 45 * MIB), info, 256),
    'PNG, iCCP of 90 MB': (lambda: files.png_texts(b'iCCP', 1, 90 * MIB), info, 256),
    'PNG, 500 MB behind its pixels': (lambda: files.png_beyond(500 * MIB), info, REFUSED),
    'PNG, 80000 chunks': (lambda: files.png(16, 16, extra=files.chunk(b'vvVv') * 80000), info,
                          256),
    'JPEG 2048x2048, 480 scans': (lambda: files.progressive(2048, 2048, 480), info, REFUSED),
    'JPEG 2048x2048, 90 scans': (lambda: files.progressive(2048, 2048, 90), info, 2048 ** 2),
    'JPEG 9000x9000, 90 scans': (lambda: files.progressive(9000, 9000, 90), info, REFUSED),
    'JPEG, 250000 segments': (lambda: files.jpeg_segments(250000), info, REFUSED),
    'XMP, 5 million elements': (lambda: files.xmp_elements(5000000), info, 256),
    'XMP, a million nested': (lambda: files.xmp_deep(1000000), info, 256),
    'XMP, a million attributes': (lambda: files.xmp_attributes(1000000), info, 256),
    'XMP, 500000 namespaces': (lambda: files.xmp_namespaces(500000), info, 256),
    'GDepth, 2 million elements': (lambda: files.gdepth(files.png(16, 16, 1), None, 2000000), info,
                                   REFUSED),
    'GDepth, two PNG of 11000': (lambda: files.gdepth(files.png(11000, 11000, 1),
                                                      files.png(11000, 11000)), info, REFUSED),
    'Dynamic Depth, two PNG of 11000': (
        lambda: files.dynamic([files.png(11000, 11000, 1), files.png(11000, 11000)]), info,
        REFUSED),
    'Dynamic Depth, 30000 items': (
        lambda: files.dynamic([files.png(16, 16, 1)], 30000), info, 256),
    'Dynamic Depth of 9 PB': (
        lambda: files.dynamic([files.png(16, 16, 1)], length=9 * 10 ** 15), info, REFUSED),
    'strokes, 4000 objects': (lambda: files.objects(SCREEN, 4000), paint, REFUSED),
    'strokes, 4000 small objects': (lambda: files.objects(SCREEN, 4000, radius=1, reach=1), paint,
                                    REFUSED),
    'strokes, 900 small objects': (lambda: files.objects(SCREEN, 900, radius=1, reach=1), paint,
                                   SCREEN_PIXELS),
    'strokes, brush of 3000 points': (lambda: files.zigzag(SCREEN, 3000, 'brush', 50), paint,
                                      SCREEN_PIXELS),
    'strokes, 4000 more': (lambda: files.objects(SCREEN, 4000, 'more'), paint, SCREEN_PIXELS),
    'strokes, 100000 points': (lambda: files.zigzag(SCREEN, 100000, 'object', 4), paint,
                               SCREEN_PIXELS),
    'strokes, 100000 of a brush': (lambda: files.zigzag(SCREEN, 100000, 'brush', 4096), paint,
                                   REFUSED),
    'strokes, 80 objects': (lambda: files.objects(SCREEN, 80), paint, SCREEN_PIXELS),
    'strokes, nested 2000000': (lambda: files.nested(2000000), paint, REFUSED),
}
ALL = {
    'PNG 16384x16384': (lambda: files.png(16384, 16384), info, REFUSED),
    'PNG 14000x14000': (lambda: files.png(14000, 14000), info, 14000 ** 2),
    'JPEG 16384x16384, 480 scans': (lambda: files.progressive(16384, 16384, 480), info, REFUSED),
    'JPEG 9000x9000, 480 scans': (lambda: files.progressive(9000, 9000, 480), info, REFUSED),
    'PNG, iCCP of 900 MB': (lambda: files.png_texts(b'iCCP', 1, 900 * MIB), info, 256),
    'GDepth, two PNG of 16384': (lambda: files.gdepth(files.png(16384, 16384, 1),
                                                      files.png(16384, 16384)), info, REFUSED),
}


def write(path, make):
    """Functions of a path make it; others return its bytes. In a process of its own: the memory
    that this one ever had would count for the command, too."""
    process = os.fork()
    if process:
        return os.waitpid(process, 0)[1] == 0
    try:
        if make in (os.mkfifo, os.mkdir, bind) or make.__code__.co_argcount == 1:
            make(path)
        else:
            with open(path, 'wb') as file:
                file.write(make())
        os._exit(0)
    finally:
        os._exit(1)


def run(arguments):
    """Status (None: ended after PATIENCE), processor seconds, peak bytes, its lines."""
    with tempfile.TemporaryFile() as words:
        begin = time.monotonic()
        child = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=words, stderr=words)
        process = 0
        while not process:
            process, status, usage = os.wait4(child.pid, os.WNOHANG)
            if not process and time.monotonic() - begin > PATIENCE:
                child.kill()
            time.sleep(0.01)
        child.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        return (None if child.returncode < 0 else child.returncode,
                usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024,
                words.read().decode(errors='replace').strip().split('\n'))


def judge(pixels, status, seconds, peak, words):
    """What is wrong with an answer, in words; '' for nothing."""
    allowed = (SECONDS + (pixels or 0) * SECONDS_A_PIXEL) * BUSY * SLOW
    if status is None:
        return 'it did not end'
    if status != (1 if pixels is REFUSED else 0):
        return 'status %d' % status
    if pixels is REFUSED and (len(words) != 1 or not words[0].startswith('refocus: ')):
        return 'not refused in one line'
    if seconds > allowed:
        return 'more than %.1f s' % allowed
    if SLOW == 1 and peak > BYTES + (pixels or 0) * BYTES_A_PIXEL:
        return 'more than %d MiB' % ((BYTES + (pixels or 0) * BYTES_A_PIXEL) // MIB)
    return ''


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('refocus')
    parser.add_argument('--all', action='store_true')
    parser.add_argument('names', nargs='*')
    options = parser.parse_args()
    cases, failed = {**CASES, **(ALL if options.all else {})}, 0
    print('%-30s %9s %8s %6s  %s' % ('file', 'KiB', 's', 'MiB', 'answer'))
    with tempfile.TemporaryDirectory() as folder:
        command = os.path.abspath(options.refocus)
        os.chdir(folder)
        with open('screen.ppm', 'wb') as file:
            file.write(b'P6 %d %d 255\n' % SCREEN +
                       bytes((x * x // 37 + y * y // 41) // 16 * (c + 1) & 255
                             for y in range(SCREEN[1]) for x in range(SCREEN[0])
                             for c in range(3)))
        for name in options.names or cases:
            make, order, pixels = cases[name]
            if not write('it', make):
                sys.exit(name + ': cannot be made')
            status, seconds, peak, words = run([command, *order('it')])
            wrong = judge(pixels, status, seconds, peak, words)
            failed += bool(wrong)
            size = os.lstat('it').st_size
            print('%-30s %9d %8.2f %6d  %s%s' % (name, size >> 10, seconds, peak // MIB,
                                                 'FAIL (%s) ' % wrong if wrong else '',
                                                 words[0][:110] if status else 'accepted'),
                  flush=True)
            os.rmdir('it') if os.path.isdir('it') else os.unlink('it')
    return failed > 0


if __name__ == '__main__':
    sys.exit(main())
