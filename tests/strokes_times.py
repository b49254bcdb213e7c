#!/usr/bin/env python3
"""usage: tests/strokes_times.py BUILD

Writes tests/strokes.md: how long a segment of a stroke takes while an object is painted over."""
import os
import re
import subprocess
import sys
import tempfile

from pages import SOURCE
from sections import table
from view_times import SCENE, enlarge, machine, pictures

ROUNDS = 3
SIZES = ((720, 540), (2000, 1500), (4032, 3024))
REPORT = re.compile(r'create (\S+) ms; (\d+) segments: min (\S+), median (\S+), 95 % (\S+), '
                    r'max (\S+) ms')


def measure(program, photo):
    """The round with the least median: ms to begin, segments, and ms of a segment."""
    rounds = []
    for _ in range(ROUNDS):
        done = subprocess.run([program, photo], stdout=subprocess.PIPE, text=True, check=True)
        rounds.append(REPORT.search(done.stdout).groups())
    return min(rounds, key=lambda figures: float(figures[3]))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = os.path.join(sys.argv[1], 'tests/platform/strokes/time-strokes')
    photo_rows, lines = pictures.read_png(SCENE + 'allfocus.png')[4], []
    with tempfile.TemporaryDirectory() as folder:
        for width, height in SIZES:
            photo = folder + '/photo.ppm'
            enlarge(photo_rows, width, height, 3, b'P6', photo)
            lines.append(['%dx%d' % (width, height), *measure(program, photo)])
            print(lines[-1], file=sys.stderr)
    (SOURCE / 'tests' / 'strokes.md').write_text('''# Strokes: time of a segment

Written by `tests/strokes_times.py BUILD`: `time-strokes` adds two points at a time to a stroke along
a spiral of 200 points around the middle of `portrait`, enlarged, its brush 1/60 of the width, and
selects and fills after each. The table gives milliseconds of processor time of one thread, of the
best of %d rounds. A segment includes the selection by all points so far, its edge at full size, and
the new disparities. %s; load average %.1f.

%s
The target is 50 ms at 12 megapixels. More than half of the time goes into exact cuts of the coarse
levels. The two finest levels stop at an edge that no change of a single pixel improves.
''' % (ROUNDS, machine(), os.getloadavg()[1], table(
        ['photo', 'begin', 'segments', 'min', 'median', '95 %', 'max'], lines)), encoding='utf-8')


if __name__ == '__main__':
    main()
