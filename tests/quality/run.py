#!/usr/bin/env python3
"""Measures how good the pictures are and writes tests/quality.md.

usage: run.py BUILD_DIR [--quick] [--out FILE]

BUILD_DIR holds a release build. The scenes are in $REFOCUS_SCENES or in
../shared/scenes beside the source tree. --quick leaves out what takes many
seconds a view.
"""
import argparse
import json
import os
import subprocess
import sys
from math import inf
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
SCENES = ["portrait", "tabletop", "fence", "nightlights"]

# label, settings (see refocus-quality --help), what it is
METHODS = [
    ("input", "method=input", "untouched photo: the floor"),
    ("standard", "method=sweep,estimate=1,thin=1",
     "the default: two layers, 64 rays, light of highlights estimated, thin structures composited"),
    ("standard-off", "method=sweep,thin=1", "the same with `--highlights off`"),
    ("sweep", "method=sweep", "`standard-off` without thin structures"),
    ("best", "method=sweep,rays=128,estimate=1,thin=1", "the default with 128 rays"),
    ("search-T1-full", "method=search,iterations=1,rays=full",
     "as in the paper: one test, every ray"),
    ("search-T2-full", "method=search,iterations=2,rays=full", "two tests, every ray"),
    ("search-T1", "method=search,iterations=1", "one test, 64 rays"),
    ("search-T2", "method=search,iterations=2", "two tests, 64 rays"),
    ("search-T4-full", "method=search,iterations=4,rays=full", "four tests, every ray"),
    ("search-T2-back", "method=search,iterations=2,background=1",
     "two tests, 64 rays, rays without a hit take the hidden background"),
    ("raytrace", "method=raytrace", "ray tracing, 64 rays, rays without a hit mirrored"),
]
# Many seconds a view, and so for the twelve views only.
SLOW = [
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
        done = subprocess.run(command + [scene], stdout=subprocess.PIPE, check=True)
        rows += json.loads(done.stdout)
    return rows


def mean(values):
    values = [inf if v is None else v for v in values]
    return sum(values) / len(values) if values else inf


def table(head, lines):
    out = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(out + ["| " + " | ".join(line) + " |" for line in lines]) + "\n"


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


def write(out, methods, rows, rays, against, blends, lights, thin, others):
    parts = [
        "# How good the pictures are\n\n"
        "Written by `tests/quality/run.py`; do not edit. Renderings of path-traced scenes by "
        "the public API, scored against the pictures that the path tracer took through a real "
        "thin lens: four scenes of 720x540, three focus distances each, K = 20, round "
        "aperture. PSNR and RMSE over the 8-bit values of R, G and B; SSIM on luma "
        "(Gaussian 11x11, σ = 1.5); a border of K pixels left out. *Near edges*: PSNR of the "
        "pixels within the larger of the two blur radii of a depth edge of 2 pixels of blur "
        "or more. All in linear light, 64 rays, unless said; means are means of the views' "
        "values.\n",
        "## Methods: mean of the twelve views\n\n" + mean_table(methods, rows),
        "Settings of each run beyond the defaults:\n\n" + settings_list(methods),
        "## PSNR of each view\n\n" + view_table(methods, rows, "psnr", "{:.2f}"),
        "## PSNR near edges of each view\n\n" + view_table(methods, rows, "edge_psnr", "{:.2f}"),
        "## SSIM of each view\n\n" + view_table(methods, rows, "ssim", "{:.4f}"),
        "## Number of rays, `sweep`: mean of the twelve views\n\n" + mean_table(RAYS, rays),
        "The same against the picture of `sweep-full`:\n\n" + mean_table(RAYS[1:], against),
        "## Blending, `sweep`: mean of the twelve views\n\n" + mean_table(BLENDS, blends),
        "## Clipped highlights, `sweep`: mean of the twelve views\n\n" + mean_table(LIGHTS, lights),
        "## Thin structures, `sweep`: mean of the twelve views\n\n" + mean_table(THIN, thin),
        "## Thin structures: PSNR of each view\n\n" + view_table(THIN, thin, "psnr", "{:.2f}"),
        "## Other apertures: PSNR of each view\n\n" + view_table(METHODS, others, "psnr", "{:.2f}"),
        "## Other apertures: PSNR near edges\n\n"
        + view_table(METHODS, others, "edge_psnr", "{:.2f}"),
    ]
    out.write_text("\n".join(parts), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--quick", action="store_true", help="leave out what is slow")
    parser.add_argument("--out", type=Path, default=SOURCE / "tests" / "quality.md")
    args = parser.parse_args()

    folder = Path(os.environ.get("REFOCUS_SCENES", SOURCE.parent / "shared" / "scenes"))
    scenes = [folder / name for name in SCENES]
    missing = [str(s) for s in scenes if not (s / "scene.json").is_file()]
    if missing:
        sys.exit(f"run.py: no reference scenes at {', '.join(missing)}: set REFOCUS_SCENES")
    tool = args.build / "tests" / "quality" / "refocus-quality"
    methods = METHODS + ([] if args.quick else SLOW)

    rows = measure(tool, scenes, methods, 20, 0)
    rays = measure(tool, scenes, RAYS, 20, 0)
    against = measure(tool, scenes, [RAYS[0]] + [(l, s + ",against=sweep-full")
                                                 for l, s, _ in RAYS[1:]], 20, 0)
    blends = measure(tool, scenes, BLENDS, 20, 0)
    lights = measure(tool, scenes, LIGHTS, 20, 0)
    thin = measure(tool, scenes, THIN, 20, 0)
    others = [r for blur, blades in ((20, 6), (10, 0), (40, 0))
              for r in measure(tool, scenes, METHODS, blur, blades)]
    write(args.out, methods, rows, rays, against, blends, lights, thin, others)
    print(f"wrote {args.out}", file=sys.stderr)


if __name__ == "__main__":
    main()
