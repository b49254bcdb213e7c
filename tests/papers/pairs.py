"""The section of tests/papers.md on Yang et al. 2016, Fig. 9 and 10: photos at a small aperture are
rendered as at a wide one and compared with photos that a camera made at that; papers.py writes it.

A folder has NAME-narrow.jpg and NAME-wide.jpg, or NAME-f16.jpg, NAME-f2.8.jpg and the like, and
NAME-disparity.png, 1 = near. A tripod shifts, exposures differ and nobody knows where the lens was:
the wide photo is moved by whole pixels and its channels are scaled, then the focus and the blur are
taken for which the sweep comes nearest to it. All of it at 480 pixels across.
"""
import re
import subprocess
import tempfile
from pathlib import Path

from sections import table

ACROSS, SHIFT = 480, 8
FOCUSES = [i / 20 for i in range(21)]
BLURS = [2, 3, 4, 6, 8, 11, 16, 22, 30, 40]
METHODS = [("sweep", "sweep:rays=64"), ("sweep, highlights off", "sweep:rays=64:highlights=off"),
           ("search as written",
            "search:iterations=1:rays=full:highlights=off:blend=stored:sigma=128"),
           ("search T=2, highlights", "search:iterations=2:rays=full"), ("blur", "blur:rays=full")]


def read_ppm(path):
    head, size, most, data = Path(path).read_bytes().split(b"\n", 3)
    assert head == b"P6" and most == b"255"
    width, height = map(int, size.split())
    return width, height, data


def write_ppm(path, width, height, data):
    Path(path).write_bytes(b"P6\n%d %d\n255\n" % (width, height) + data)


def small(refocus, photo, out):
    """The photo, ACROSS pixels wide."""
    Path(f"{out}.pgm").write_bytes(b"P5\n3 2\n255\n" + bytes(6))
    subprocess.run([refocus, "render", photo, "--depth", f"{out}.pgm", "--blur", "0", "--resize",
                    str(ACROSS), "-o", out], check=True)
    return read_ppm(out)


def shift_between(a, b, width, height):
    """The whole pixels by which b, moved, is nearest to a: of every other row of green."""
    def row(data, x0, x1, y):
        return data[3 * (y * width + x0) + 1:3 * (y * width + x1) + 1:3]

    def apart(dx, dy):
        rows = range(SHIFT, height - SHIFT, 2)
        return sum(abs(p - q) for y in rows
                   for p, q in zip(row(a, SHIFT, width - SHIFT, y),
                                   row(b, SHIFT + dx, width - SHIFT + dx, y + dy)))
    return min(((dx, dy) for dx in range(-SHIFT, SHIFT + 1) for dy in range(-SHIFT, SHIFT + 1)),
               key=lambda at: apart(*at))


def moved(data, width, height, dx, dy):
    out = bytearray(len(data))
    for y in range(height):
        source = min(max(y + dy, 0), height - 1) * width
        for x in range(width):
            at = 3 * (source + min(max(x + dx, 0), width - 1))
            out[3 * (y * width + x):3 * (y * width + x) + 3] = data[at:at + 3]
    return bytes(out)


def scaled(data, like):
    """The same with the mean of each channel that the other has."""
    out = bytearray(data)
    for c in range(3):
        gain = sum(like[c::3]) / max(sum(data[c::3]), 1)
        curve = bytes(min(255, int(v * gain + 0.5)) for v in range(256))
        out[c::3] = data[c::3].translate(curve)
    return bytes(out)


def aperture(photo):
    """How small the aperture of a photo is by its name: an f-number, or one that compares like it."""
    kind = photo.stem.rsplit("-", 1)[1]
    return {"narrow": 100.0, "wide": 1.0}.get(kind) or float(kind[1:])


def pairs_in(folder):
    """(name, the photo at the smallest aperture, another one, disparities)"""
    for disparity in sorted(folder.glob("*-disparity.png")):
        name = disparity.name[:-len("-disparity.png")]
        photos = sorted((p for p in folder.glob(f"{name}-*.jpg")
                         if re.fullmatch(r"narrow|wide|f[\d.]+", p.stem[len(name) + 1:])),
                        key=aperture, reverse=True)
        for wide in photos[1:]:
            yield wide.stem, photos[0], wide, disparity


def fit(compare, photo, disparity, truth):
    """The focus and the blur of the sweep that is nearest, and the scores of all methods there."""
    def psnr(focus, blur):
        return compare(METHODS[:1], photo, disparity, truth, focus, blur)["sweep"]["psnr"]
    blur = 6
    for _ in range(2):
        focus = max(FOCUSES, key=lambda f: psnr(f, blur))
        blur = max(BLURS, key=lambda b: psnr(focus, b))
    return focus, blur, compare(METHODS, photo, disparity, truth, focus, blur)


def pairs(refocus, folder, compare):
    """The section; `compare` scores methods, as in papers.py."""
    rows = []
    for name, narrow, wide, disparity in pairs_in(folder):
        with tempfile.TemporaryDirectory() as out:
            width, height, photo = small(refocus, narrow, f"{out}/narrow.ppm")
            other = small(refocus, wide, f"{out}/wide.ppm")
            if other[:2] != (width, height):
                continue
            dx, dy = shift_between(photo, other[2], width, height)
            write_ppm(f"{out}/truth.ppm", width, height,
                      scaled(moved(other[2], width, height, dx, dy), photo))
            focus, blur, scores = fit(
                lambda *args: compare(refocus, *args), f"{out}/narrow.ppm", disparity,
                f"{out}/truth.ppm")
        rows.append([name, f"{dx},{dy}", f"{focus:.2f}", blur]
                    + [f"{scores[label]['psnr']:.2f}"
                       for label in ["photo"] + [label for label, _ in METHODS]])
    return ("## Yang et al. 2016, Fig. 9 and 10\n\n"
            "Photos at a small aperture, rendered, beside the camera's own at a wide one, of a folder "
            "that is not in the repository. Disparities are a network's. Focus and blur are those of "
            f"the best sweep, the wide photo is shifted and its channels are scaled, at {ACROSS} "
            "pixels across:\n\n"
            + table(["pair", "shift", "df", "K"] + [f"PSNR, {label}" for label in
                                                    ["photo"] + [label for label, _ in METHODS]],
                    rows))
