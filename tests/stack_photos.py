"""What tests/stack_scores.py needs NumPy and OpenCV for: scenes as a moved frame shows them, and
photos in focus everywhere beside those of enfuse."""
import json
import shutil
import subprocess

try:
    import cv2
    import numpy as np
except ImportError:
    cv2 = None

HERE = cv2 is not None
ENFUSE = shutil.which('enfuse')
FAR = 10  # pixels from depth edges and clipped pixels: the widest blur of a stack, and two


def as_seen(folder, matrix, into):
    """A copy of a scene as a frame shows it that is moved by a matrix, 2 x 3, of pixel centres."""
    into.mkdir()
    scene = json.loads((folder / 'scene.json').read_text())
    names = {gt['file'] for gt in scene['gt']} | {'allfocus.png', 'disparity.png'}
    for name in names:
        if (folder / name).is_file():
            picture = cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED)
            how = cv2.INTER_LINEAR if name == 'disparity.png' else cv2.INTER_CUBIC
            height, width = picture.shape[:2]
            (into / name).parent.mkdir(exist_ok=True)
            cv2.imwrite(str(into / name), cv2.warpAffine(picture, np.float64(matrix), (width, height),
                                                         flags=how, borderMode=cv2.BORDER_REPLICATE))
    (into / 'scene.json').write_text(json.dumps(scene))
    return into


def far_from(mask):
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * FAR + 1,) * 2)
    return cv2.dilate(mask.astype(np.uint8), disc) == 0


def psnr(one, other, where):
    error = (one.astype(np.float64) - other)[where]
    return 10 * np.log10(255 ** 2 / (error ** 2).mean())


def scores(photo, pinhole, where):
    """PSNR of colours and of luminance where it counts, and of colours everywhere."""
    grey = [cv2.cvtColor(p, cv2.COLOR_BGR2GRAY) for p in (photo, pinhole)]
    everywhere = np.ones_like(where)
    return ['%.2f' % s for s in (psnr(photo, pinhole, where), psnr(*grey, where),
                                 psnr(photo, pinhole, everywhere))]


def photos(refocus, folder, what, frames, work):
    """Rows of the photo of a stack, of the frame that is nearest in focus by exact depth, and of
    enfuse, against the pinhole's, away from depth edges and what clips."""
    depth = cv2.imread(str(folder / 'disparity.png'), cv2.IMREAD_UNCHANGED) / 65535
    pinhole = cv2.imread(str(folder / 'allfocus.png'))
    box = np.ones((3, 3))
    step = cv2.dilate(depth, box) - cv2.erode(depth, box) > 0.04
    where = far_from(step) & far_from(pinhole.max(2) >= 250)
    subprocess.run([refocus, 'depth', '--focal-stack', *frames, '-o', work / 'd.png', '--photo',
                    work / 'p.png'], stdout=subprocess.DEVNULL, check=True)
    best = np.rint(depth * (len(frames) - 1)).astype(int)
    stack = np.stack([cv2.imread(str(f)) for f in frames])
    made = [('stack', cv2.imread(str(work / 'p.png'))),
            ('nearest frame, exact depth', np.take_along_axis(stack, best[None, :, :, None], 0)[0])]
    if ENFUSE:
        subprocess.run([ENFUSE, '--exposure-weight=0', '--saturation-weight=0',
                        '--contrast-weight=1', '--hard-mask', '-o', work / 'e.tif', *frames],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        made.append(('enfuse', cv2.imread(str(work / 'e.tif'))[:, :, :3]))
    return [[folder.name, what, name, *scores(photo, pinhole, where)] for name, photo in made]
