#!/usr/bin/env python3
"""Runs refocus beside ffmpeg's varblur and GEGL's lens-blur and writes the ratios.

usage: rivals.py BUILD_DIR [--rounds N] [--out tests/performance.md]

Both are in Debian 12: apt-get install ffmpeg gegl. One that is missing is left out, and said
so. Same picture, same blur at each pixel, one thread each, in turns. Times are processor time
of the filter alone: that of many frames, or of the filter several times in a row, less that
of fewer, so that starting, reading and writing cancel. Ours are preparing and rendering.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests"))
sys.path.insert(0, str(SOURCE / "tests" / "cli"))
import pictures  # noqa: E402
import sections  # noqa: E402

FOCUS = 0.689
SIZES = [(720, 540), (1920, 1080)]
BLURS = [20, 40]


def cpu_seconds(*command):
    """Processor time that a command takes, with its children."""
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, env={**os.environ, "GEGL_THREADS": "1"})
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"rivals.py: {command[0]} failed: {errors.decode(errors='replace')[-500:]}")
    return usage.ru_utime + usage.ru_stime


class Files:
    """The scene of examples/data/portrait brought to a size by repeating pixels."""

    def __init__(self, folder, size):
        data = SOURCE / "examples" / "data" / "portrait"
        width, height, _, _, rgb = pictures.read_png(data / "allfocus.png")
        _, _, _, _, depth = pictures.read_png(data / "disparity.png")
        self.photo, self.depth = folder / "photo.ppm", folder / "depth.pgm"
        self.radius, self.out = folder / "radius.pgm", folder / "out.ppm"
        columns = [x * width // size[0] for x in range(size[0])]
        rows = [y * height // size[1] for y in range(size[1])]
        with open(self.photo, "wb") as photo, open(self.depth, "wb") as deep, \
                open(self.radius, "wb") as radius:
            photo.write(b"P6\n%d %d\n255\n" % size)
            deep.write(b"P5\n%d %d\n65535\n" % size)
            radius.write(b"P5\n%d %d\n255\n" % size)
            last = None
            for y in rows:
                if y != last:
                    last = y
                    line = b"".join(rgb[y][3 * x:3 * x + 3] for x in columns)
                    values = [depth[y][2 * x] << 8 | depth[y][2 * x + 1] for x in columns]
                    shares = bytes(round(255 * abs(v / 65535 - FOCUS)) for v in values)
                    wide = b"".join(v.to_bytes(2, "big") for v in values)
                photo.write(line)
                deep.write(wide)
                radius.write(shares)


def ours(refocus, files, blur, rays):
    report = json.loads(subprocess.run(
        [refocus, "bench", files.photo, "--depth", files.depth, "--focus", str(FOCUS), "--blur",
         str(blur), "--rays", str(rays), "--threads", "1", "--repeat", "10", "--json"],
        stdout=subprocess.PIPE, check=True).stdout)
    return report["cpu_ms"]["min"] + report["prepare_ms"]


def varblur(files, blur):
    def frames(count):
        graph = (f"[0:v]format=gbrp,loop=loop={count}:size=1[a];[1:v]format=gbrp[b];"
                 f"[a][b]varblur=min_r=0:max_r={blur}")
        return cpu_seconds("ffmpeg", "-v", "error", "-nostdin", "-threads", 1,
                           "-filter_complex_threads", 1, "-i", files.photo, "-i", files.radius,
                           "-filter_complex", graph, "-f", "null", "-")

    def copies(count):  # what looping frames costs without the filter
        graph = f"[0:v]format=gbrp,loop=loop={count}:size=1"
        return cpu_seconds("ffmpeg", "-v", "error", "-nostdin", "-threads", 1,
                           "-filter_complex_threads", 1, "-i", files.photo, "-i", files.radius,
                           "-filter_complex", graph, "-f", "null", "-")
    return 1e3 * ((frames(21) - frames(1)) - (copies(21) - copies(1))) / 20


def lens_blur(files, blur):
    def times(count):
        chain = ["lens-blur", f"radius={blur}", "aux=[", "load", f"path={files.radius}", "]"]
        return cpu_seconds("gegl", files.photo, "-o", files.out, "--", *(chain * count))
    return 1e3 * (times(5) - times(1)) / 4


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=SOURCE / "tests" / "performance.md")
    args = parser.parse_args()
    refocus = args.build / "platform" / "cli" / "refocus"
    rivals = {"ffmpeg": ("ffmpeg varblur", varblur), "gegl": ("gegl:lens-blur", lens_blur)}
    for tool in [t for t in rivals if not shutil.which(t)]:
        print(f"rivals.py: SKIPPED {tool}: it is not there; apt-get install {tool}",
              file=sys.stderr)
        del rivals[tool]
    if not rivals:
        sys.exit(77)
    rows = []
    for size in SIZES:
        for blur in BLURS:
            with tempfile.TemporaryDirectory() as folder:
                files = Files(Path(folder), size)
                runs = {f"refocus, {rays} rays": lambda r=rays: ours(refocus, files, blur, r)
                        for rays in (32, 64)}
                runs.update({name: lambda f=filter_: f(files, blur)
                             for name, filter_ in rivals.values()})
                best = {name: float("inf") for name in runs}
                for _ in range(args.rounds):
                    for name, run in runs.items():
                        best[name] = min(best[name], run())
            rows.append([f"{size[0]}x{size[1]}", blur] + [f"{ms:.1f}" for ms in best.values()] +
                        [f"{best[name] / best['refocus, 64 rays']:.2f}"
                         for name, _ in rivals.values()])
            print(rows[-1], file=sys.stderr)
    head = ["size", "K"] + [f"{name}, ms" for name in runs] + [
        f"{name} / refocus, 64 rays" for name, _ in rivals.values()]
    sections.put(args.out, "rivals", "tests/rivals.py", "\n".join([
        "## Beside others\n",
        "One thread each, in turns, processor time of the filter alone, the best of "
        f"{args.rounds}. examples/data/portrait, focus {FOCUS}; brought to 1920x1080 by repeating "
        "pixels. The others blur each pixel by its own radius, with one layer and a square or "
        "disc; a ratio above 1 means slower than refocus.\n", sections.table(head, rows)]))
    print(f"wrote {args.out}", file=sys.stderr)


if __name__ == "__main__":
    main()
