#!/usr/bin/env python3
"""Writes the seeds of fuzz_core, fuzz_edges and fuzz_repair into corpus/core/, edges/ and repair/;
the order is that of take() in these files."""
import random
import struct
from pathlib import Path

CORPUS = Path(__file__).resolve().parent / "corpus"


def u16(value, low=0):
    return struct.pack(">H", value - low)


def share(part, whole):
    return struct.pack(">H", round(65535 * part / whole))


def limits(width, height, blur, threads, flags=0):
    return bytes([flags]) + u16(width, 1) + u16(height, 1) + share(blur, 12) + u16(threads, 1)


def picture(width, height, form, out, bits, depth=None, behind=False, textured=False):
    dw, dh = depth or (width, height)
    return (u16(width, 1) + u16(height, 1) + bytes([form - 1, out - 1, bits == 16])
            + u16(dw, 1) + u16(dh, 1) + bytes([(depth is None) | behind << 1 | textured << 2]))


def lens(focus, blur, most, method, rays, blend=0, sigma=128, gain=1, iterations=2, flags=(0, 0, 1),
         region=(0, 0, 0, 0)):
    return (share(focus, 1) + share(blur / most, 1) + u16(method) + u16(rays) + u16(blend)
            + share(sigma - 1, 300) + share(gain - 1, 15) + u16(iterations, 1) + b"".join(map(u16, flags))
            + b"".join(map(u16, region)))


IRIS = b"\4" + u16(0) + u16(6, 2) + share(15, 360) + share(.4, 1) + share(.8, 1) + share(.3, 1.5) \
    + share(.3, .9) + share(.4, 2) + b"\0"
DISC, POLYGON, MASK = b"\1", b"\2" + u16(6, 3) + share(15, 360), b"\3" + bytes(range(0, 256, 16))


def edges(width, height, depth=None, bits=16, form=1, reach=0, noise=20, cell=32, moved=(0, 0),
          threads=False, wild=b""):
    columns, rows = depth or (width, height)
    flags = (depth is None) | (bits == 16) << 1 | form - 1 << 2 | bool(wild) << 4 | threads << 5
    return bytes([flags, width - 1, height - 1, columns - 1, rows - 1, reach, noise, cell - 1,
                  *moved]) + wild


def seeds_of_edges():
    """Pictures of cells, whose map is exact, soft, coarse, moved ..."""
    two = bytes([20, 200, 20, 20, 200, 200, 90])
    return {
        "exact": edges(72, 72) + two,
        "exact_codes": edges(72, 60, bits=8) + two,
        "soft": edges(72, 72, reach=6, threads=True) + two,
        "soft_codes": edges(72, 72, bits=8, reach=9, form=4) + two,
        "very_soft": edges(72, 72, reach=12, cell=128) + two,
        "shifted": edges(72, 72, cell=16, moved=(7, 4), threads=True) + two,
        "far_off": edges(72, 72, cell=40, moved=(30, 30)) + two,
        "coarse": edges(72, 70, depth=(24, 23), form=2) + two,
        "very_coarse": edges(72, 70, depth=(12, 11), form=3) + two,
        "reduced": edges(72, 72, depth=(17, 17), reach=1, cell=50, threads=True) + two,
        "enlarged": edges(72, 72, depth=(36, 34), reach=1, cell=50, moved=(9, 0)) + two,
        "one_sample": edges(50, 40, depth=(1, 1)) + two,
        "larger": edges(40, 30, depth=(72, 60), reach=2) + two,
        "pixel": edges(1, 1) + two,
        "row": edges(72, 1, reach=3) + two,
        "column": edges(1, 72, depth=(1, 30)) + two,
        "noise": edges(60, 60, cell=1) + bytes(range(0, 256, 7)),
        "wild": edges(20, 20, wild=bytes([15]) + b"\xff" * 13) + two,
        "empty": b"",
    }


def repair(width, height, sample=1, meaning=1, flags=1, near=255, far=0, unknown=(), speckle=0, form=1,
           photo=(20, 20), upwards=0, wild=0):
    ends = (0, 0, 0, 30) if meaning == 1 else (65, 0, 0, 40)
    codes = [*unknown, 0, 0, 0, 0][:4]
    return bytes([7 * wild]) + b"".join(map(u16, (
        sample - 1, width - 1, height - 1, meaning - 1, flags, near, far, *ends, len(unknown), *codes,
        speckle, form - 1, photo[0] - 1, photo[1] - 1, upwards)))


def seeds_of_repair():
    """Maps with holes, which are zeros, and photos of any size."""
    noise = random.Random(2)
    holes = bytes(noise.choice((0, 0, 60, 61, 200, 201, 255)) for _ in range(97))
    two = (bytes([200] * 9 + [0] * 6 + [40] * 12) * 5)
    metres = b"".join(struct.pack("<f", v) for v in (1, 1.1, 4, 0, float("nan"), 4.2, float("inf")) * 3)
    return {
        "holes": repair(40, 40, photo=(40, 40)) + holes,
        "silhouette": repair(27, 30, photo=(40, 13), form=2) + two,
        "upwards": repair(40, 33, photo=(9, 40), form=4, upwards=1) + two,
        "speckle": repair(40, 40, speckle=30, form=3) + holes,
        "words": repair(31, 40, sample=2, flags=7) + holes,
        "distances": repair(40, 28, sample=2, meaning=2, flags=3) + holes,
        "metres": repair(40, 40, sample=3, meaning=2, flags=1) + metres,
        "codes": repair(40, 40, flags=0, unknown=(60, 200)) + holes,
        "one_depth": repair(40, 40, near=7, far=7) + bytes([9, 0, 9, 9]),
        "all_unknown": repair(12, 12) + bytes([0]),
        "row": repair(40, 1, photo=(1, 1)) + holes,
        "column": repair(1, 40, photo=(40, 1)) + holes,
        "wild": repair(9, 9, wild=1) + holes,
        "empty": b"",
    }


def chosen(data):
    """Behind two bytes for which draw.h gives pictures as large as they are said to be, as many threads,
    and all that is done twice."""
    first = 0
    while (first + sum(data)) * 2654435769 >> 21 & 2047:
        first += 1
    return struct.pack(">H", first) + data


def write(name, seeds, drawn=True):
    folder = CORPUS / name
    folder.mkdir(parents=True, exist_ok=True)
    for seed, data in seeds.items():
        (folder / seed).write_bytes(chosen(data) if drawn else data)


def main():
    noise = random.Random(1)
    pixels = bytes(noise.randrange(256) for _ in range(48)) + bytes(range(0, 250, 10)) * 2
    seeds = {
        "sweep": limits(40, 30, 8, 2) + picture(40, 30, 1, 1, 16) + lens(.3, 8, 8, 0, 64) + DISC,
        "sweep_full_mask": limits(33, 17, 5, 1) + picture(33, 17, 3, 4, 8)
        + lens(1, 5, 5, 0, 65) + MASK,
        "search": limits(40, 30, 12, 3) + picture(31, 29, 2, 1, 16)
        + lens(0, 12, 12, 1, 64, blend=1, iterations=1, flags=(1, 1, 0)) + POLYGON,
        "raytrace": limits(20, 20, 6, 1) + picture(20, 19, 4, 2, 8)
        + lens(.5, 6, 6, 2, 65, blend=2, flags=(1, 0, 0)) + b"\0",
        "region": limits(48, 48, 10, 2) + picture(48, 48, 1, 3, 16)
        + lens(.8, 7, 10, 0, 32, region=(5, 9, 20, 17)) + DISC,
        "coarse_depth": limits(48, 48, 10, 2) + picture(46, 44, 1, 1, 8, depth=(9, 7))
        + lens(.2, 10, 10, 0, 24, sigma=3) + DISC,
        "fine_depth": limits(12, 12, 3, 1) + picture(9, 12, 1, 1, 16, depth=(48, 41))
        + lens(.2, 3, 3, 1, 7) + DISC,
        "lights": limits(48, 40, 9, 2) + picture(48, 40, 1, 1, 16)
        + lens(.1, 9, 9, 0, 64, gain=4, sigma=300) + DISC,
        "too_large": limits(10, 10, 3, 1) + picture(11, 10, 1, 1, 16) + lens(.2, 3, 3, 0, 7),
        "no_blur": limits(10, 10, 3, 1) + picture(10, 10, 1, 1, 16) + lens(.2, 0, 3, 0, 7) + DISC,
        "behind": (limits(40, 30, 8, 2, flags=4) + picture(40, 30, 1, 1, 16, behind=True)
                   + lens(0, 8, 8, 0, 64) + DISC),
        "behind_thin": (limits(40, 30, 8, 1, flags=12) + picture(40, 30, 3, 3, 8, behind=True)
                        + lens(.3, 8, 8, 0, 16) + DISC),
        "textured": (limits(40, 30, 8, 2, flags=16) + picture(40, 30, 1, 1, 16, textured=True)
                     + lens(0, 8, 8, 0, 64) + DISC),
        "column": limits(1, 48, 12, 3) + picture(1, 48, 1, 1, 16) + lens(.6, 12, 12, 0, 64) + DISC,
        "wild_limits": b"\1" + struct.pack(">iifi", 65535, 65535, 127, 64),
        "wild_nan": b"\2" + limits(9, 9, 3, 1)[1:] + picture(9, 9, 1, 1, 16)
        + struct.pack(">ff", float("nan"), 1) + b"\xff" * 40,
    }
    for form, out, name in ((5, 5, "nv12"), (6, 7, "nv21"), (7, 6, "i420"), (8, 8, "yuyv")):
        seeds[name] = (limits(48, 40, 9, 2) + picture(47, 39, form, out, 16)
                       + lens(.3, 9, 9, 0, 64, gain=3) + DISC)
        seeds[name + "_full"] = (limits(40, 30, 5, 1) + picture(33, 30, form + 24, out, 8, depth=(9, 7))
                                 + lens(1, 5, 5, 0, 65, blend=1, sigma=300) + MASK)
        seeds[name + "_region"] = (limits(48, 48, 10, 2) + picture(48, 48, form + 8, out, 16)
                                   + lens(.8, 7, 10, 0, 32, region=(6, 8, 20, 16)) + POLYGON)
    for number, (depth, bits) in enumerate(((None, 16), ((9, 7), 8), (None, 8), ((40, 31), 16))):
        seeds["matte%d" % number] = (b"\4" + limits(48, 40, 9, 2)[1:]
                                     + picture(46, 39, 65 + 128 * (number % 2), 1, bits, depth=depth)
                                     + lens(.3 * number, 9, 9, 0, 32, blend=number % 3) + DISC)
    seeds["matte_yuv"] = (b"\4" + limits(48, 40, 9, 2)[1:] + picture(46, 39, 71, 7, 16)
                          + lens(.3, 9, 9, 0, 32) + DISC)
    seeds["matte_refused"] = limits(40, 30, 8, 2) + picture(40, 30, 65, 1, 16) + lens(.3, 8, 8, 0, 64)
    papers = ["jittered", "lightfield", "blur", "scatter", "foveated", "interpolated", "diffusion"]
    for method, name in enumerate(papers, 3):
        seeds[name] = (limits(40, 30, 8, 2) + picture(40, 27, 1, 1, 16)
                       + lens(.4, 7, 8, method, 40) + DISC + bytes(range(90)))
    # extras: 46 bytes; then the controls
    for number, (name, aperture) in enumerate((("controls", DISC), ("iris", IRIS))):
        for seed in range(3):
            bits = random.Random(10 * number + seed)
            extras = bytes(bits.randrange(256) for _ in range(120))
            seeds["%s%d" % (name, seed)] = (limits(40, 30, 8, 2) + picture(40, 30, 1, 1, 16)
                                            + lens(.4, 7, 8, 0, 64, gain=8) + aperture + extras)
    write("core", {name: seed + pixels for name, seed in seeds.items()})
    write("edges", seeds_of_edges())
    write("repair", seeds_of_repair(), drawn=False)


if __name__ == "__main__":
    main()
