#!/usr/bin/env python3
"""usage: tests/stack_scores.py BUILD [--check]

Writes tests/stack.md: what depth and photo of a focus stack are worth, by refocusing with them.
Scenes are those in examples/data, unless REFOCUS_SCENES names a folder; path-traced stacks of a
camera are taken from the folder that REFOCUS_CAMERA_SCENES names, if it is there."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pages
import stack_photos
from sections import table

SCENES = ('portrait', 'tabletop', 'fence', 'nightlights')
PAGE = pages.SOURCE / 'tests' / 'stack.md'
FRAMES, K_STACK, K = 9, 8, 20
FEW = (0, 8), (0, 4, 8), (0, 2, 4, 6, 8)  # all from the farthest to the nearest surface


def run(refocus, *arguments):
    done = subprocess.run([refocus, *map(str, arguments)], stdout=subprocess.PIPE, check=True)
    return done.stdout


def views(folder):
    """Focus and reference of the round aperture at K = 20."""
    scene = json.loads((folder / 'scene.json').read_text())
    return [(gt['df'], folder / gt['file']) for gt in scene['gt']
            if gt['K'] == K and not gt['blades'] and (folder / gt['file']).is_file()]


def score(refocus, folder, photo, depth, lens=lambda focus: (focus, K)):
    """Mean PSNR over the focus distances; `lens` gives focus and K on the scale of the depth."""
    psnr = []
    for focus, reference in views(folder):
        at, blur = lens(focus)
        report = json.loads(run(refocus, 'compare', photo, '--depth', depth, '--reference',
                                reference, '--focus', min(max(at, 0), 1), '--blur', blur,
                                '--methods', 'sweep', '--depth-edges', 'as-given', '--json'))
        psnr += [m['psnr'] for m in report['methods'] if m['method'] == 'sweep']
    return sum(psnr) / len(psnr)


def aperture_rows(refocus, folder, work):
    """The pinhole's photo and a reference, focused on the nearest or the farthest surface."""
    pinhole, exact = folder / 'allfocus.png', folder / 'disparity.png'
    pair, depth = [work / 'narrow.jpg', work / 'wide.jpg'], work / 'depth.png'
    nearest = max(focus for focus, _ in views(folder))
    lines = []
    for focus, reference in views(folder):
        if focus not in (0, nearest):
            continue
        which = 'nearest' if focus else 'farthest'
        for picture, jpeg in zip((pinhole, reference), pair):
            run(refocus, 'render', picture, '--depth', exact, '--blur', 0, '--jpeg-quality', 95,
                '-o', jpeg)
        report = json.loads(run(refocus, 'depth', '--focal-stack', *pair, '--in-focus', which,
                                '-o', depth, '--json'))
        blur = float(re.search(r'up to ([0-9.]+) pixels$', report['evidence'][-1])[1])

        def lens(at, end=focus, blur=blur):
            return (1 - K * (end - at) / blur if end else K * at / blur), blur
        scores = [score(refocus, folder, pinhole, exact),
                  score(refocus, folder, pinhole, depth, lens)]
        lines.append([folder.name, which, *('%.2f' % s for s in scores), '%.0f' % blur,
                      '%.1f' % (K * (focus or 1))])
        print(*lines[-1], file=sys.stderr, flush=True)
    return lines


def row(refocus, folder, what, frames, work, *options):
    """Scores of exact depth with the pinhole's photo, and of what the stack gives."""
    depth, photo, light = work / 'depth.png', work / 'photo.png', work / 'light.jpg'
    for made in photo, light:
        run(refocus, 'depth', '--focal-stack', *frames, '-o', depth, '--photo', made, *options)
    pinhole, exact = folder / 'allfocus.png', folder / 'disparity.png'
    jpeg = work / 'pinhole.jpg'
    run(refocus, 'render', pinhole, '--depth', exact, '--blur', 0, '--jpeg-quality', 89, '-o', jpeg)
    scores = [score(refocus, folder, p, d) for p, d in
              ((pinhole, exact), (jpeg, exact), (pinhole, depth), (photo, exact), (photo, depth),
               (light, depth))]
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


def moved(refocus, folder, camera, work):
    """Frames that breathe or shake, with the middle one as reference: scenes go where it has them."""
    if not stack_photos.HERE:
        return []
    variants = json.loads((camera / 'scene.json').read_text())['stack']['variants']
    lines = []
    for variant, word in ('breathing', 'breathing'), ('shake', 'shaken'):
        place = work / word / folder.name
        place.parent.mkdir(exist_ok=True)
        middle = variants[variant][FRAMES // 2]
        scene = stack_photos.as_seen(folder, middle['still_to_frame'], place)
        frames = [camera / frame['file'] for frame in variants[variant]]
        lines.append(row(refocus, scene, f'path-traced, {word}, by the middle', frames, work))
    return lines


def main():
    arguments = [a for a in sys.argv[1:] if a != '--check']
    if len(arguments) != 1:
        sys.exit(__doc__)
    refocus = Path(arguments[0]).resolve() / 'platform/cli/refocus'
    folders, where = pages.scenes(SCENES)
    camera = os.environ.get('REFOCUS_CAMERA_SCENES')
    lines, few, photos, apertures = [], [], [], []
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        for folder in folders:
            stack = Path(camera) / folder.name / 'stack' if camera else None
            if stack and stack.is_dir():
                for variant in ('static', 'breathing'):
                    frames = [stack / variant / f'{k}.jpg' for k in range(FRAMES)]
                    lines.append(row(refocus, folder, 'path-traced, ' + variant, frames, work,
                                     '--reference', 1))
                lines += moved(refocus, folder, stack.parent, work)
            frames = rendered(refocus, folder, work)
            lines.append(row(refocus, folder, 'rendered', frames, work))
            if stack and stack.is_dir():
                frames = [stack / 'static' / f'{k}.jpg' for k in range(FRAMES)]
            few += [row(refocus, folder, f'{len(numbers)} of them', [frames[k] for k in numbers],
                        work, '--reference', 1) for numbers in FEW]
            apertures += aperture_rows(refocus, folder, work)
            if stack_photos.HERE:
                photos += stack_photos.photos(refocus, folder, 'path-traced' if stack and
                                              stack.is_dir() else 'rendered', frames, work)
    text = TEXT % (where, table(HEAD, lines), table(HEAD, few), table(PHOTO_HEAD, photos),
                   table(APERTURES_HEAD, apertures))
    if '--check' in sys.argv:
        pages.check(PAGE, text, 'tests/pages.sh BUILD stack')
    else:
        PAGE.write_text(text, encoding='utf-8')


HEAD = ('scene', 'stack', 'PSNR, both exact', 'PSNR, pinhole as JPEG', 'PSNR, depth of the stack',
        'PSNR, photo of the stack', 'PSNR, both of the stack', 'PSNR, both, with light')
APERTURES_HEAD = ('scene', 'in focus', 'PSNR, exact depth', 'PSNR, depth of the pair', 'blur found',
                  'blur of the whole range')
PHOTO_HEAD = ('scene', 'stack', 'photo', 'PSNR', 'PSNR, luminance', 'PSNR, everywhere')
TEXT = '''# Depth and photo of a focus stack

Written by `tests/stack_scores.py BUILD`. Nine frames, their focus even in disparity from 0 to 1, K = 8,
720x540, go through `refocus depth --focal-stack`; its depth (`--depth-edges as-given`) and its photo, or
exact depth and the pinhole's photo in place of either, are refocused at K = 20 and scored against
path-traced references: PSNR in dB, the mean over the focus distances. *With light* the photo is a JPEG, whose
gain map has what is above white; all others have 8 bits. *Pinhole as JPEG* has exact depth, and a photo that
lost as much as a frame of the path-traced stacks: a JPEG with colour of half the size (quality 89; 90 and up
keep all colour). Scenes: %s.

Path-traced stacks (`$REFOCUS_CAMERA_SCENES`) have noise of a sensor and JPEG 4:2:0 at quality 95;
*breathing* ones grow by 3 %% from the first frame to the last, and the result is in the geometry of the
first. Those *by the middle* and *shaken* ones (1.5 px and 0.04 degrees rms) are in that of the middle frame: references, exact
depth and pinhole are moved there (`still_to_frame`), which costs what is exact, too. *Rendered* ones are made by `refocus render` from the exact depth, as JPEGs of quality 95. Costs
and alignment were chosen by looking at portrait and tabletop alone. How sure a sample is, and how votes
fill what is not, was chosen by the mean over all of these, three frames of each, and a real stack: no
scene was left out for that. Depths between six to nine frames, two or three to a frame, raise the depth of every scene here (nine
frames by .1 to .6 dB), so that the choice is the same whichever scene is left out.

What silhouettes change, and light taken out beside them, was chosen by refocusing with both of the stack (nine frames):
eight pairs of a reach of 8, 12 or 16 samples with votes of the nearer side by 1, 1/2, 1/4 or 1/8; 8 and 1/2 have the best
mean of the four scenes, and tabletop and nightlights are .02 and .05 dB better with others. Shares that say when
light is taken out were set by looking at these scenes and the circuit board: no scene was left out for them.
Colour of half the size that follows luma: bounds of 16, 64 and 256 on the variance, .1 dB apart; 14 real photos made smaller lose nothing by it. Means of colour held to what
is stored, all of them: +.3 dB on tabletop, but -.1 to -.4 on real photos; as far as quantisation tells them (2 steps; 4 and
8 have half and a quarter of the gain): +.2 dB on tabletop, and 18 photos lose .02 at the most.

What is clipped becomes white by the codes that are taken for clipped elsewhere (242, 250) and a mean three codes above, with
both of the stack: portrait +.25, tabletop +.08, rendered ones +.38, -.05, fence +.07, nightlights +.34, 21 drawn scenes +.01 (the
worst -.02). A mean one code higher has half of that on portrait. Of what the static stacks then lose, exact depth would give
back .5 dB each; with exact depth, colour of half the size alone costs a pinhole's photo .9 (portrait) and .8. Tried and
left out: means of frames that agree (+.05 to .08 dB), and sharpening: frames near the focus are as sharp as the pinhole's.

Codes above 242 in a frame may be clipped when light above white is found, as for what becomes white: with both of the stack
and light 36 stacks (six here, 30 drawn) gain .42 dB over 250, the worst loses .02; from 230 on it is .48, but skies of 1.05
times white lose .15. On 27 of them, whichever one is left out: without smoothing along clipped surfaces light loses .09 dB
(the worst .93), half of its length is the same (+.01), and six rounds gain .12 over four on 33 of them, but three lose
.05, .05 and .16 (one view 1.0, where a lamp's depth is wrong). Of the photo in focus everywhere luminance is within reach of what the table asks, colour is not: the
pinhole's photo as a JPEG with colour of half the size and the noise of the frames has 35.3 dB (portrait) and 33.7
(tabletop) where it counts. Tried and left out for it, on four scenes, 19 real photos made smaller and ten drawn ones: lines
of colour over luma by samples of like luma (real photos +.1 dB, drawn ones up to -.2), by pixels (tabletop -.4), a larger
bound on the variance (real photos +.06, tabletop -.15), a second round of held means (+.02, at -.07 the worst); colour from
all frames that are nearly in focus (+.0 to .2). Hair at its exact depth, of one sample each, loses .2 dB of portrait, as the
map has no place for what is behind it.

What a stack could tell of what is behind silhouettes, had it no error: with the true hidden background as far in as frames
of K = 8 see past them, given as `--behind`, both of the stack with light gain .28 dB on portrait (taken from the
reference), .00 on tabletop and .06 or -.06 in the mean of ten drawn scenes (+.7 to -1.2), by whether what is wrongly near is
left out or counts as hidden; exact depth and photo gain .87, .04 and .39. The silhouettes that the stack finds are too
far off for it: depth comes first, and no layer is made.

Faint texture that counts as measured where no edge is near, and noise that is taken from sharpness first, were chosen by six
scenes and five photos rendered as stacks with noise, the two path-traced ones, and 24 drawn ones of even texture (1.5 to 20
codes), refocused with both of the stack. The drawn ones gain .7 dB in the mean and .07 in the median: in six of them nearly
all depth was wrong, or turned round; the worst loses .12. The others gain .00 to .04, the worst loses .02. Depth of 11 %% of the
pixels is off by more than an eighth of the range, 17 %% before. Ten stacks of other people's cameras stay as they are but for
a few samples: with samples in place of blocks, at twice the gain, they had specks on paper and cloth. Blocks of half the size
and a share of 1/8 have the best mean whichever stack is left out (.57 for .46), but lose up to .6.

What makes depth smooth where it was not measured, and the bounds of noise, were chosen by looking at ten stacks of
other people's cameras (2 to 32 frames: insects, books, balls, a keyboard, hedges), whose paper, walls and grain had combs
and patches before. The scores here stay within .1 dB (portrait up to +.1; two frames of fence -.2, three +.3), those of
96 rendered stacks of eight scenes gain .02 in the mean; the scene that loses most is aloe, -.15 in the mean.

The median along silhouettes was chosen by looking at two stacks of a light field camera, among colours 4, 8 and 16 codes
apart: with both of the stack the scores here change by -.01 to +.08 dB, the photo beside edges by -.03 to +.4 dB; ten
stacks of that camera, refocused at their ends, lose .004 dB of 35.3. Two and three frames go without: fence lost .17 dB.

Which end is far (`--order auto`): of 100 stacks of a light field camera, 3 to 12 frames, nearest first, edges turn 67,
leave 31 as they are and are wrong in 2; of 14 other stacks (cameras and renderers, both ways), 12 are right and 2 stay as
given. The weights of votes and the bound of 1/20 were chosen by these: before votes had weights, and with a bound of 1/32
that was chosen by half of them, 4 of 40 were wrong in the other half. Below 1/20 what lies lower counts as nearer, too:
of 36 pairs and 9 stacks of other sources 39 are right, 5 wrong and 1 not told, with edges alone 26, 5 and 14; of the 20
pairs of a light field camera that were looked at afterwards 20 are right, with edges alone 17 and 3 not told.
Since these were counted, edges beside what is clipped vote no more, and what lies lower counts as well where it is the
opposite of edges and outweighs them: one of nine frames of a tabletop that has 1.9 times the light, or somebody small who
walks by, votes -.06 to -.19. Of 35 other stacks, drawn and of cameras, four have too few edges left, and one whose
edges voted .01 votes -.02.
Edges of which fewer than one in eight was measured on both sides tell nothing: of 31 drawn stacks and such of cameras,
each with 2, 3, 4 and all of its frames in the order, 9 of 124 were turned wrongly and are 4, no other one changed; 110 are
right. The share was chosen by these: it is .05 and less in the five, .17 and more in others but four pairs, right by rows.
Three frames of an engraved surface through a macro lens, the farthest first, are turned by it against edges that vote
.03 (rows: -.49), so that the command says where what lies lower alone turns a stack that this is doubtful.

Processor time of `refocus depth --focal-stack`, nine frames, with files read and written, x86-64: 2 megapixels
4.5 s and 280 MB, 12 megapixels 19 s and 735 MB (a slow day; on another 2.9 and 10.4 s). By the clock with two threads,
by turns with one thread for most of it, as it was before, medians of five and of two: 2.98 for 4.01 s, and 13.5 for
20.6 s. Files are read and written by one thread: a quarter of the 2.98 s.

%s

Two, three and five of the nine frames (static, or rendered), from the first to the last. Their model of
defocus was chosen by these and by frames 1, 4, 7, the exponent among 2, 1.5 and 1, the share of samples in focus
among 1/50, 1/20 and 1/8, rho among one to six. Chosen for two frames with the scene left out that is
scored, the mean PSNR of the depth of the four is 25.23 dB, with this choice 25.51, with the sharpest frame as depth 22.99;
three: 24.87 with the sharpest frame, five: 27.84. Frames 1, 4 and 7, beyond which surfaces lie on
either side, have 25.63 and, with the sharpest frame, 25.68.

%s

The photo in focus everywhere beside the pinhole's, ten pixels and more away from depth edges and from what is clipped.
With *exact depth* each pixel is of the frame that is focused nearest to it: no choice of frames is
better. Its colour and that of enfuse are interpolated from half the size, that of the stack follows luma. `enfuse` 4.2 with
`--exposure-weight=0 --saturation-weight=0 --contrast-weight=1 --hard-mask`.

%s

Two frames of one focus and several apertures (`--in-focus`): the pinhole's photo and the path-traced one at K = 20,
focused on the nearest surface of the references or on the farthest, both as JPEGs of quality 95. The depth of the pair is
refocused with the pinhole's photo; its blur is the K of its range, in pixels, beside that from the focus to the other end of
the disparities, where there need be no surface. Surfaces nearer than the nearest focus are taken for such as lie
behind it. Constants were chosen by these and six pairs with noise: squares and absolute differences, windows of 5 or of 1,
9 and 17, noise of 16 to 256 and half and double the price of steps lie within .15 dB in the mean, so that the choice tells
little of the scenes. Without means that are made the same nightlights loses 5 dB, without the bound for what is clipped
.2 in the mean. 18 real pairs of cameras (f/16 with f/2.8 or f/1.8; not in the repository) showed how to align, how samples grow
and what is clipped; their depth looks right but for leaves that the wind moved, two pairs whose camera moved between the
shots, and what is beside places that the wide aperture overexposed. Tried and left out: discs that leave out what is nearer,
in a second pass (+.5 dB on fence, -.6 on portrait). Beside silhouettes the depth of what is nearer reaches some seven samples
too far, as windows do: a sharp stripe of background beside a subject in focus. Half, a quarter and less of its votes there,
as for focus stacks, cost .04 dB and more in the mean.

%s'''

if __name__ == '__main__':
    main()
