#!/usr/bin/env python3
"""usage: tests/stack_scores.py BUILD [--check]

Writes tests/stack.md: what depth and photo of a focus stack are worth, by refocusing with them.
Scenes are those in examples/data, unless REFOCUS_SCENES names a folder; path-traced stacks of a
camera are taken from the folder that REFOCUS_CAMERA_SCENES names, if it is there."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pages
from sections import table

SCENES = ('portrait', 'tabletop', 'fence', 'nightlights')
PAGE = pages.SOURCE / 'tests' / 'stack.md'
FRAMES, K_STACK, K = 9, 8, 20


def run(refocus, *arguments):
    done = subprocess.run([refocus, *map(str, arguments)], stdout=subprocess.PIPE, check=True)
    return done.stdout


def views(folder):
    """Focus and reference of the round aperture at K = 20."""
    scene = json.loads((folder / 'scene.json').read_text())
    return [(gt['df'], folder / gt['file']) for gt in scene['gt']
            if gt['K'] == K and not gt['blades'] and (folder / gt['file']).is_file()]


def score(refocus, folder, photo, depth):
    """Mean PSNR over the focus distances."""
    psnr = []
    for focus, reference in views(folder):
        report = json.loads(run(refocus, 'compare', photo, '--depth', depth, '--reference',
                                reference, '--focus', focus, '--blur', K, '--methods', 'sweep',
                                '--depth-edges', 'as-given', '--json'))
        psnr += [m['psnr'] for m in report['methods'] if m['method'] == 'sweep']
    return sum(psnr) / len(psnr)


def row(refocus, folder, what, frames, work, *options):
    """Scores of exact depth with the pinhole's photo, and of what the stack gives."""
    depth, photo = work / 'depth.png', work / 'photo.png'
    run(refocus, 'depth', '--focal-stack', *frames, '-o', depth, '--photo', photo, *options)
    pinhole, exact = folder / 'allfocus.png', folder / 'disparity.png'
    jpeg = work / 'pinhole.jpg'
    run(refocus, 'render', pinhole, '--depth', exact, '--blur', 0, '--jpeg-quality', 89, '-o', jpeg)
    scores = [score(refocus, folder, p, d) for p, d in
              ((pinhole, exact), (jpeg, exact), (pinhole, depth), (photo, exact), (photo, depth))]
    line = [folder.name, what, *('%.2f' % s for s in scores)]
    print(*line, file=sys.stderr, flush=True)
    return line


def rendered(refocus, folder, work):
    """Frames of the sweep itself, as JPEGs."""
    for k in range(FRAMES):
        run(refocus, 'render', folder / 'allfocus.png', '--depth', folder / 'disparity.png',
            '--focus', k / (FRAMES - 1), '--blur', K_STACK, '--jpeg-quality', 95, '-o',
            work / f'{k}.jpg')
    return [work / f'{k}.jpg' for k in range(FRAMES)]


def main():
    arguments = [a for a in sys.argv[1:] if a != '--check']
    if len(arguments) != 1:
        sys.exit(__doc__)
    refocus = Path(arguments[0]).resolve() / 'platform/cli/refocus'
    folders, where = pages.scenes(SCENES)
    camera = os.environ.get('REFOCUS_CAMERA_SCENES')
    lines = []
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        for folder in folders:
            stack = Path(camera) / folder.name / 'stack' if camera else None
            if stack and stack.is_dir():
                for variant in ('static', 'breathing'):
                    frames = [stack / variant / f'{k}.jpg' for k in range(FRAMES)]
                    lines.append(row(refocus, folder, 'path-traced, ' + variant, frames, work,
                                     '--reference', 1))
            lines.append(row(refocus, folder, 'rendered', rendered(refocus, folder, work), work))
    text = TEXT % (where, table(HEAD, lines))
    if '--check' in sys.argv:
        pages.check(PAGE, text, 'tests/pages.sh BUILD stack')
    else:
        PAGE.write_text(text, encoding='utf-8')


HEAD = ('scene', 'stack', 'PSNR, both exact', 'PSNR, pinhole as JPEG', 'PSNR, depth of the stack',
        'PSNR, photo of the stack', 'PSNR, both of the stack')
TEXT = '''# Depth and photo of a focus stack

Written by `tests/stack_scores.py BUILD`. Nine frames, their focus even in disparity from 0 to 1, K = 8,
720x540, go through `refocus depth --focal-stack`; its depth (`--depth-edges as-given`) and its photo, or
exact depth and the pinhole's photo in place of either, are refocused at K = 20 and scored against
path-traced references: PSNR in dB, the mean over the focus distances. *Pinhole as JPEG* has exact
depth, and a photo that lost as much as a frame of the path-traced stacks: a JPEG with colour of half
the size (quality 89; 90 and up keep all colour). Scenes: %s.

Path-traced stacks (`$REFOCUS_CAMERA_SCENES`) have noise of a sensor and JPEG 4:2:0 at quality 95;
*breathing* ones grow by 3 %% from the first frame to the last, and the result is in the geometry of the
first. *Rendered* ones are made by `refocus render` from the exact depth, as JPEGs of quality 95. Costs
and alignment were chosen by looking at portrait and tabletop alone. How sure a sample is, and how votes
fill what is not, was chosen by the mean over all of these, three frames of each, and a real stack: no
scene was left out for that.

%s'''

if __name__ == '__main__':
    main()
