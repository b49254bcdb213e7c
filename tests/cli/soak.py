#!/usr/bin/env python3
"""usage: soak.py REFOCUS [FRAMES]  -- refocus live for long, while 1 % of the frames have a fault.

Both cameras are scripts with faults of every kind by chance, and the colour camera changes its
format and size now and then. Memory and descriptors of the process are looked at all the time: in
the last quarter of the run they are those of the first. Exit status 0, or 1 and what grew.
"""
import json
import os
import subprocess
import sys
import time

PAGE_KIB = os.sysconf('SC_PAGE_SIZE') // 1024
GROWTH_KIB = 512  # what the heap may come to by its own order of blocks
SIZES = 'YUYV,48x32', 'RGB24,32x24', 'NV12,64x48', 'NV12,32x24'


def look(pid):
    """Resident memory, descriptors and threads; None when it has ended."""
    try:
        with open(f'/proc/{pid}/statm', encoding='ascii') as file:
            pages = int(file.read().split()[1])
        return (pages * PAGE_KIB, len(os.listdir(f'/proc/{pid}/fd')),
                len(os.listdir(f'/proc/{pid}/task')))
    except (FileNotFoundError, ProcessLookupError, IndexError):
        return None


def watch(process):
    """What was seen, ten times a second, until it ends."""
    seen = []
    while process.poll() is None:
        now = look(process.pid)
        if now and now[0]:
            seen.append(now)
        time.sleep(0.1)
    return seen


def main():
    refocus, frames = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200000
    changes = ';'.join(f'at {frames * (i + 1) // 40} format {SIZES[i % 4]}' for i in range(36))
    colour = f'replay::format NV12;size 32x24;frames {frames};random 1;seed 3;{changes}'
    depth = 'replay::format Z16;size 32x24;random 1;seed 4'
    process = subprocess.Popen(
        [refocus, 'live', '--camera', colour, '--depth', depth, '--fast', '--frames-policy',
         'every', '--steady', '0.8', '--depth-edges', 'auto', '--blur', '3', '--rays', '4',
         '--threads', '2', '--no-commands', '--json'],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
    seen = watch(process)
    out, words = process.communicate()
    if process.returncode != 0:
        print(f'exit status {process.returncode}: {words.decode()}')
        return 1
    report = json.loads(out)
    quarter = len(seen) // 4
    failed = quarter < 10
    print(f'{report["frames_in"]} frames in, {report["frames_out"]} out, '
          f'{report["camera_dropped"]} lost by the camera, {report["colour"]["corrupt"]} corrupt, '
          f'{report["colour"]["recoveries"]} and {report["depth"]["recoveries"]} recoveries, '
          f'{report["buffers_lost"]} buffers lost, {len(seen)} looks')
    for name, i, slack in ('KiB resident', 0, GROWTH_KIB), ('descriptors', 1, 0), ('threads', 2, 0):
        most = [max(s[i] for s in part) for part in (seen[:quarter], seen[-quarter:])]
        grew = most[1] > most[0] + slack
        failed |= grew
        print(f'{name}: at most {most[0]} in the first quarter, {most[1]} in the last'
              f'{": it grew" if grew else ""}')
    # Every kind of fault came, and no frame is lost but those that a fault took.
    faults = [report['camera_dropped'], report['colour']['corrupt'],
              report['colour']['recoveries'], report['depth']['recoveries'],
              report['colour']['retimed'] + report['colour']['reordered']]
    if min(faults) == 0 or report['frames_out'] < 0.98 * frames:
        print(f'faults that came: {faults}; {report["frames_out"]} of {frames} frames')
        failed = True
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
