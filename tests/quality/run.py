#!/usr/bin/env python3
"""Measures how good the pictures are and writes tests/quality.md.

usage: run.py BUILD [--check | --floors]

BUILD is the folder of a release build. The scenes are those in examples/data, unless
$REFOCUS_SCENES names another folder. --check compares with the page, all but what takes seconds a
view, and names the rows that moved; --floors so too, but some fast methods on the views with
K = 20 and a disc alone, in some seconds.
"""
import argparse
import json
import subprocess
import sys
from math import inf
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from pages import SOURCE, check, scenes  # noqa: E402
from sections import table  # noqa: E402

SCENES = ["portrait", "tabletop", "fence", "nightlights"]
PAGE = SOURCE / "tests" / "quality.md"

# label, settings (see refocus-quality --help), what it is
METHODS = [
    ("input", "method=input", "untouched photo: the floor"),
    ("standard", "method=sweep,estimate=1,thin=1",
     "the default: two layers, 64 rays, light of highlights estimated, thin structures composited"),
    ("standard-off", "method=sweep,thin=1", "the same with `--highlights off`"),
    ("preview", "method=sweep,rays=32,estimate=1", "quality `preview`: 32 rays"),
    ("preview-off", "method=sweep,rays=32", "the same with `--highlights off`"),
    ("sweep", "method=sweep", "`standard-off` without thin structures"),
    ("sweep-paper", "method=sweep,rays=full,blend=stored,sigma=128",
     "the sweep with the paper's blending: every ray, stored values, eq. 5 with σ = 128"),
    ("best", "method=sweep,rays=128,estimate=1,thin=1", "the default with 128 rays"),
    ("paper-64", "method=search,iterations=1,blend=stored,sigma=128",
     "the paper as written with 64 rays: one test, stored values, eq. 5 with σ = 128"),
    ("paper-plain", "method=search,iterations=1,rays=full,blend=stored",
     "the paper with plain averages: one test, every ray, stored values, no eq. 5"),
    ("search-T1-full", "method=search,iterations=1,rays=full",
     "one test, every ray, but the default's blending: linear light, no eq. 5"),
    ("search-T2-full", "method=search,iterations=2,rays=full", "two tests, every ray"),
    ("search-T1", "method=search,iterations=1", "one test, 64 rays"),
    ("search-T2", "method=search,iterations=2", "two tests, 64 rays"),
    ("search-T4-full", "method=search,iterations=4,rays=full", "four tests, every ray"),
    ("search-T2-back", "method=search,iterations=2,background=1",
     "two tests, 64 rays, rays without a hit take the hidden background"),
    ("raytrace", "method=raytrace", "ray tracing, 64 rays, rays without a hit mirrored"),
]
# Those that tests/run.sh holds to the page.
FLOORS = ["standard", "standard-off", "preview", "preview-off", "sweep-paper", "paper-64",
          "search-T1", "search-T2", "search-T2-back"]
# Seconds a view, and so for the views with K = 20 and a disc only.
SLOW = [
    ("paper", "method=search,iterations=1,rays=full,blend=stored,sigma=128",
     "the paper as written: one test, every ray, stored values, eq. 5 with σ = 128"),
    ("raytrace-full", "method=raytrace,rays=full",
     "ray tracing, every ray, rays without a hit mirrored (the reference)"),
]
RAYS = [
    ("sweep-full", "rays=full", "every ray"),
    ("sweep-32", "rays=32", "preview"),
    ("sweep-64", "rays=64", "standard"),
    ("sweep-128", "rays=128", "as many as best"),
    ("sweep-64-raw", "rays=64,prefilter=0", "64 rays without the pre-filter"),
]
LIGHTS = [
    ("gain-1", "highlight=1", "as the photo has them"),
    ("gain-2", "highlight=2", "highlights of up to twice white"),
    ("gain-3", "highlight=3", "three times"),
    ("gain-4", "highlight=4", "four times"),
    ("estimate", "estimate=1", "estimated from the photo: standard"),
    ("gain-4-s400", "highlight=4,sigma=400", "four times, σ = 400"),
    ("gain-8", "highlight=8", "eight times"),
    ("gain-9.5", "highlight=9.5", "nine and a half times"),
    ("gain-8-s400", "highlight=8,sigma=400", "eight times, σ = 400"),
    ("gain-16", "highlight=16", "sixteen times"),
    ("gain-4-128", "highlight=4,rays=128", "four times, 128 rays"),
    ("estimate-128", "estimate=1,rays=128", "estimated, 128 rays: best"),
    ("gain-9.5-128", "highlight=9.5,rays=128", "nine and a half times, 128 rays"),
    ("gain-8-128-s400", "highlight=8,rays=128,sigma=400", "eight times, 128 rays, σ = 400"),
]
BLENDS = [
    ("linear", "blend=linear,sigma=off", "linear light, plain average"),
    ("linear-s500", "blend=linear,sigma=500", "linear light, σ = 500"),
    ("linear-s400", "blend=linear,sigma=400", "linear light, σ = 400"),
    ("linear-s300", "blend=linear,sigma=300", "linear light, σ = 300"),
    ("linear-s200", "blend=linear,sigma=200", "linear light, σ = 200"),
    ("linear-s128", "blend=linear,sigma=128", "linear light, σ = 128"),
    ("gamma", "blend=gamma,sigma=off", "gamma 2.2, plain average"),
    ("stored", "blend=stored,sigma=off", "stored values, plain average"),
    ("stored-s160", "blend=stored,sigma=160", "stored values, σ = 160"),
    ("stored-s128", "blend=stored,sigma=128", "stored values, σ = 128"),
    ("stored-s96", "blend=stored,sigma=96", "stored values, σ = 96"),
    ("stored-s64", "blend=stored,sigma=64", "stored values, σ = 64"),
]
THIN = [
    ("rays", "estimate=1", "64 rays, no separation"),
    ("drawn", "estimate=1,thin=1",
     "separated and composited far before the focus and in it: standard"),
    ("rays-32", "estimate=1,rays=32", "32 rays: preview"),
    ("drawn-32", "estimate=1,rays=32,thin=1", "32 rays, drawn"),
    ("rays-128", "estimate=1,rays=128", "128 rays"),
    ("drawn-128", "estimate=1,rays=128,thin=1", "128 rays, drawn: best"),
    ("rays-512", "estimate=1,rays=512", "512 rays"),
]
SCORES = [("psnr", "PSNR", "{:.2f}"), ("edge_psnr", "near edges", "{:.2f}"),
          ("ssim", "SSIM", "{:.4f}"), ("rmse", "RMSE", "{:.2f}")]


def measure(tool, scenes, runs, blur, blades):
    """Rows of refocus-quality for the views of one K and number of blades."""
    command = [tool, "--json", "--blur", str(blur), "--blades", str(blades)]
    for label, settings, *_ in runs:
        command += ["--run", f"{label}:{settings}"]
    rows = []
    for scene in scenes:
        print(f"K = {blur}, {blades} blades: {scene}", file=sys.stderr)
        try:
            done = subprocess.run(command + [scene], stdout=subprocess.PIPE, check=True)
        except (OSError, subprocess.CalledProcessError) as error:
            sys.exit(f"run.py: {error}")
        rows += json.loads(done.stdout)
    return rows


def mean(values):
    values = [inf if v is None else v for v in values]
    return sum(values) / len(values) if values else inf


def mean_table(runs, rows):
    lines = []
    for label, settings, words in runs:
        mine = [r for r in rows if r["run"] == label]
        lines.append([f"`{label}`", words]
                     + [form.format(mean([r[key] for r in mine])) for key, _, form in SCORES])
    return table(["run", "what it is"] + [name for _, name, _ in SCORES], lines)


def view_table(runs, rows, key, form):
    views = []
    for r in rows:
        view = (r["scene"], r["focus"], r["blur"], r["blades"])
        if view not in views:
            views.append(view)
    lines = []
    for view in views:
        cells = []
        for label, *_ in runs:
            value = [r[key] for r in rows if r["run"] == label
                     and (r["scene"], r["focus"], r["blur"], r["blades"]) == view]
            cells.append(form.format(mean(value)))
        scene, focus, blur, blades = view
        kind = f"{blades} blades" if blades else "disc"
        lines.append([scene, f"{focus:.3f}", f"{blur:g}", kind] + cells)
    return table(["scene", "df", "K", "aperture"] + [f"`{r[0]}`" for r in runs], lines)


def settings_list(runs):
    return "".join(f"- `{label}`: `{settings}`\n" for label, settings, _ in runs)


def means(title, runs, rows):
    views = len({(r["scene"], r["focus"]) for r in rows})
    return f"## {title}: mean of {views} views\n\n" + mean_table(runs, rows)


def methods(measure_at, runs):
    """The section that the floors are taken from."""
    rows = measure_at(runs, 20, 0)
    yield means("Methods", runs, rows)
    yield "Settings of each run beyond the defaults:\n\n" + settings_list(runs)
    yield "## PSNR of each view\n\n" + view_table(runs, rows, "psnr", "{:.2f}")
    yield "## PSNR near edges of each view\n\n" + view_table(runs, rows, "edge_psnr", "{:.2f}")
    yield "## SSIM of each view\n\n" + view_table(runs, rows, "ssim", "{:.4f}")


def others(measure_at):
    rays = measure_at(RAYS, 20, 0)
    against = measure_at([RAYS[0]] + [(l, s + ",against=sweep-full", w) for l, s, w in RAYS[1:]],
                         20, 0)
    yield means("Number of rays, `sweep`", RAYS, rays)
    yield "The same against the picture of `sweep-full`:\n\n" + mean_table(RAYS[1:], against)
    yield means("Blending, `sweep`", BLENDS, measure_at(BLENDS, 20, 0))
    yield means("Clipped highlights, `sweep`", LIGHTS, measure_at(LIGHTS, 20, 0))
    thin = measure_at(THIN, 20, 0)
    yield means("Thin structures, `sweep`", THIN, thin)
    yield "## Thin structures: PSNR of each view\n\n" + view_table(THIN, thin, "psnr", "{:.2f}")
    rows = [r for blur, blades in ((20, 6), (10, 0), (40, 0))
            for r in measure_at(METHODS, blur, blades)]
    for key, words in ("psnr", "PSNR of each view"), ("edge_psnr", "PSNR near edges"):
        yield f"## Other apertures: {words}\n\n" + view_table(METHODS, rows, key, "{:.2f}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--floors", action="store_true")
    args = parser.parse_args()
    tool = args.build / "tests" / "quality" / "refocus-quality"
    folders, where = scenes(SCENES)

    def measure_at(runs, blur, blades):
        return measure(tool, folders, runs, blur, blades)

    parts = [
        "# How good the pictures are\n\n"
        "Written by `tests/quality/run.py`; do not edit. Renderings of path-traced scenes by "
        "the public API, scored against the pictures that the path tracer took through a real "
        f"thin lens: {where}; 720x540, three focus distances each, K = 20, round "
        "aperture. PSNR and RMSE over the 8-bit values of R, G and B; SSIM on luma "
        "(Gaussian 11x11, σ = 1.5); a border of K pixels left out. *Near edges*: PSNR of the "
        "pixels within the larger of the two blur radii of a depth edge of 2 pixels of blur "
        "or more. All in linear light, 64 rays, unless said; means are means of the views' "
        "values.\n"]
    if args.floors:
        parts += methods(measure_at, [run for run in METHODS if run[0] in FLOORS])
    else:
        parts += methods(measure_at, METHODS + ([] if args.check else SLOW))
        parts += others(measure_at)
    text = "\n".join(parts)
    if args.check or args.floors:
        check(PAGE, text, "tests/pages.sh BUILD quality")
    else:
        PAGE.write_text(text, encoding="utf-8")
        print(f"wrote {PAGE}", file=sys.stderr)


if __name__ == "__main__":
    main()
