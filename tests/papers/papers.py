#!/usr/bin/env python3
"""Measures the methods of the five papers side by side and writes tests/papers.md.

usage: papers.py BUILD_DIR [--quick] [--out FOLDER]

BUILD_DIR holds a release build. Scenes: $REFOCUS_SCENES or ../shared/scenes beside the source
tree. The light field: $REFOCUS_PHOTOS or ../shared/photos; without it that part is left out,
and said so. --quick takes 64 rays where the rest takes every ray of the mask.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
REPEAT = 2
SCENES = ["portrait", "tabletop", "fence", "nightlights", "portrait1080"]
# label, an entry of `refocus compare --methods`; {full}: every ray of the mask
METHODS = [
    ("sweep", "sweep:rays=64"),
    ("sweep, highlights off", "sweep:rays=64:highlights=off"),
    ("search T=1", "search:iterations=1:rays={full}"),
    ("search T=2", "search:iterations=2:rays={full}"),
    ("raytrace", "raytrace:rays={full}"),
    ("jittered a=2", "jittered:cell=2"),
    ("jittered a=4", "jittered:cell=4"),
    ("lightfield", "lightfield:rays=256"),
    ("blur", "blur:rays={full}"),
    ("scatter", "scatter"),
    ("scatter Lommel", "scatter:spread=lommel"),
    ("foveated", "foveated"),
    ("interpolated", "interpolated"),
    ("diffusion", "diffusion"),
]
MANY = "1024"  # rays at K = 40, where the mask has 5,025 pixels
PAPER_FPS = {"blur": 15, "lightfield": 5, "raytrace": 3, "jittered a=4": 15, "search T=1": 15}


def order(rays):
    """Sorts numbers of rays; "full" is the most."""
    return float("inf") if rays == "full" else int(rays)


def run(*command):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, check=True)
    return done.stdout.decode()


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, r)) + " |" for r in rows]) + "\n"


def compare(refocus, photo, depth, truth, focus, blur, full):
    """Scores and times of each method, by label."""
    print(f"{photo} K = {blur:g}", file=sys.stderr)
    report = json.loads(run(refocus, "compare", photo, "--depth", depth, "--reference", truth,
                            "--focus", focus, "--blur", blur, "--json",
                            "--methods", ",".join(m.format(full=full) for _, m in METHODS)))
    result = dict(zip(["photo"] + [label for label, _ in METHODS], report["methods"]))
    for scores in result.values():
        scores["threads"] = report["threads"]
    return result


def score_rows(scores):
    rows = []
    for label, s in scores.items():
        edge = s["edge_psnr"]
        row = [label, f"{s['psnr']:.2f}", f"{s['ssim']:.4f}",
               f"{edge:.2f}" if isinstance(edge, float) else "-", f"{s['rmse']:.2f}"]
        if "cpu_ms" in s:
            row += [f"{s['cpu_ms']['min']:.0f}", f"{s['renderer_bytes'] / 2**20:.1f}"]
        rows.append(row + [""] * (7 - len(row)))
    return rows


HEAD = ["method", "PSNR", "SSIM", "edge PSNR", "RMSE", "ms", "MiB"]


def plot(path, title, x_label, y_label, curves, y_from=0.0):
    """Curves {name: [(x, y)]} as an SVG file."""
    w, h, left, top, right, bottom = 640, 360, 60, 34, 150, 44
    xs = [x for c in curves.values() for x, _ in c]
    ys = [y for c in curves.values() for _, y in c]
    x0, x1, y0, y1 = min(xs), max(xs), y_from, max(ys) * 1.05
    if x1 == x0:
        x1 = x0 + 1

    def at(x, y):
        return (left + (x - x0) / (x1 - x0) * (w - left - right),
                h - bottom - (y - y0) / (y1 - y0) * (h - top - bottom))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" '
           f'fill="white"/><text x="{left}" y="20" font-size="14">{title}</text>']
    for i in range(6):
        y = y0 + (y1 - y0) * i / 5
        px, py = at(x0, y)
        out.append(f'<path d="M{px:.1f} {py:.1f}H{w - right}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{py + 4:.1f}" text-anchor="end">{y:.3g}</text>')
    for x in sorted(set(xs)):
        px, py = at(x, y0)
        out.append(f'<text x="{px:.1f}" y="{h - bottom + 16}" text-anchor="middle">{x:.3g}</text>')
    out.append(f'<text x="{(left + w - right) / 2}" y="{h - 8}" text-anchor="middle">{x_label}'
               f'</text><text transform="translate(14 {h / 2}) rotate(-90)" '
               f'text-anchor="middle">{y_label}</text>')
    colours = ["#1b6ca8", "#d1495b", "#2a9d4a", "#e08e00", "#7b4fb5", "#555555"]
    for i, (name, curve) in enumerate(curves.items()):
        points = " ".join("{:.1f},{:.1f}".format(*at(x, y)) for x, y in sorted(curve))
        colour = colours[i % len(colours)]
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" '
                   f'stroke-width="2"/><text x="{w - right + 8}" y="{top + 14 + 18 * i}" '
                   f'fill="{colour}">{name}</text>')
    path.write_text("\n".join(out) + "\n</svg>\n", encoding="utf-8")


def scene_views(folder, blurs):
    """The first round-aperture view of each K."""
    views = {}
    for view in json.loads((folder / "scene.json").read_text())["gt"]:
        if view["K"] in blurs and not view.get("blades"):
            views.setdefault(view["K"], view)
    return [views[k] for k in sorted(views)]


def light_field(build, refocus, folder, full):
    """Scores for rising apertures of the real light field: {K: scores}."""
    result = {}
    for radius in (1, 2, 3, 4):
        with tempfile.TemporaryDirectory() as out:
            blur, focus, views = run(build / "tests/papers/lightfield-truth", folder, out, 0.54,
                                     radius).split()
            result[float(blur), int(views)] = compare(
                refocus, f"{out}/photo.png", f"{out}/disparity.png", f"{out}/truth.png", focus,
                float(blur), full)
    return result


def table_1(scores, blur):
    """Frames a second relative to `blur`, theirs and ours."""
    base = scores["blur"]["cpu_ms"]["min"]
    rows = []
    for label, fps in PAPER_FPS.items():
        ms = scores[label]["cpu_ms"]["min"]
        rows.append([label, fps, f"{fps / 15:.2f}", f"{ms:.0f}", f"{base / ms:.2f}"])
    ms = scores["sweep"]["cpu_ms"]["min"]
    rows.append(["sweep (64 rays)", "-", "-", f"{ms:.0f}", f"{base / ms:.2f}"])
    return table(["method", "paper, fps", "paper, to blur", f"ours, ms (K = {blur:g})",
                  "ours, to blur"], rows)


def timed(refocus, scene, focus, blur, runs, *options):
    """Best time of each of several runs, in turns, of one thread; of what takes a minute, one."""
    best = [float("inf")] * len(runs)
    for _ in range(REPEAT if blur < 80 else 1):
        for i, (repeat, run_options) in enumerate(runs):
            report = json.loads(run(refocus, "bench", scene / "allfocus.png", "--depth",
                                    scene / "disparity.png", "--focus", focus, "--blur", blur,
                                    "--threads", 1, "--repeat", repeat, "--json", *options,
                                    *run_options.split()))
            best[i] = min(best[i], report["cpu_ms"]["min"])
    return best


def mulder(refocus, folder):
    rows = []
    for name in SCENES[:4]:
        for blur in (10, 20, 40):
            everywhere, centre = timed(refocus, folder / name, 0.5, blur, [
                (1, "--method foveated --attention-angle 170"), (2, "--method foveated")])
            rows.append([name, blur, f"{everywhere:.0f}", f"{centre:.0f}",
                         f"{everywhere / centre:.1f}"])
    return table(["scene", "K", "exact everywhere, ms", "exact in a cone of 10 degrees, ms",
                  "times faster"], rows)


def preview(refocus, folder):
    rows = []
    for blur in (5, 10, 20, 40):
        sweep, interpolated = timed(refocus, folder / "tabletop", 0, blur, [
            (20, "--method sweep --rays 32"), (20, "--method interpolated")])
        rows.append([blur, f"{sweep:.1f}", f"{interpolated:.1f}"])
    return table(["K", "sweep, 32 rays, ms", "interpolated, ms"], rows)


def difference(refocus, scene, blur):
    """Largest difference between the solvers' pictures, and the share of values that differ."""
    pictures = []
    with tempfile.TemporaryDirectory() as out:
        for solver in ("steps", "series"):
            run(refocus, "render", scene / "allfocus.png", "--depth", scene / "disparity.png",
                "--focus", 0, "--blur", blur, "--method", "diffusion", "--solver", solver, "-o",
                f"{out}/{solver}.ppm")
            pictures.append(Path(f"{out}/{solver}.ppm").read_bytes())
    apart = [abs(a - b) for a, b in zip(*pictures)]
    return max(apart), sum(a > 0 for a in apart) / len(apart)


def diffusion(refocus, scene, quick):
    rows = []
    for blur in (20, 40) if quick else (20, 40, 80):
        worst, share = difference(refocus, scene, blur)
        for cpu in ("auto", "c") if blur < 80 else ("auto",):
            steps, series = timed(refocus, scene, 0, blur, [
                (1, "--solver steps"), (5, "--solver series")], "--method", "diffusion",
                "--cpu", cpu)
            rows.append([blur, cpu, f"{steps:.0f}", f"{series:.0f}", f"{steps / series:.0f}",
                         worst, f"{share:.4%}"])
    return table(["r = K", "cpu", "steps, ms", "series, ms", "times faster",
                  "grey levels apart at most", "of the values"], rows)


def fields(refocus, scene, out):
    lines = []
    for field, options in (("cylinder", ""), ("plus", ""), ("plane", "--field-angle 30"),
                           ("sphere", "--field-radius 0.15")):
        run(refocus, "render", scene / "allfocus.png", "--depth", scene / "disparity.png",
            "--focus", 0.35, "--blur", 14, "--method", "diffusion", "--field", field,
            "-o", out / f"field-{field}.jpg", *options.split())
        lines.append(f"![{field}](papers/field-{field}.jpg)")
    return "\n".join(lines) + "\n"


def figure_8(refocus, scene, out):
    """Labelled crops along depth edges, as in the paper's Fig. 8."""
    view = next(v for v in scene_views(scene, (20,)))
    run(refocus, "compare", scene / "allfocus.png", "--depth", scene / "disparity.png",
        "--reference", scene / view["file"], "--focus", view["df"], "--blur", 20, "--methods",
        "sweep,search:rays=64:iterations=1,raytrace:rays=64,jittered:cell=4,"
        "lightfield:rays=256,blur:rays=64", "-o", out / "fig8.jpg")
    return "![crops along depth edges by each method](papers/fig8.jpg)\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--out", type=Path, default=SOURCE / "tests")
    args = parser.parse_args()
    refocus = args.build / "platform" / "cli" / "refocus"
    full = "64" if args.quick else "full"
    blurs = (10, 20, 40)
    folder = Path(os.environ.get("REFOCUS_SCENES", SOURCE.parent / "shared" / "scenes"))
    photos = Path(os.environ.get("REFOCUS_PHOTOS", SOURCE.parent / "shared" / "photos"))
    pictures = args.out / "papers"
    pictures.mkdir(parents=True, exist_ok=True)
    text = ["# The methods of the five papers, side by side\n",
            "Written by `tests/papers/papers.py`; do not edit. References: path-traced scenes "
            "through a real thin lens, and a light field's views averaged. PSNR and RMSE of "
            "8-bit values, SSIM of luma, edge PSNR within reach of depth edges of 2 pixels of "
            "blur or more, a border of K left out; linear light. Rays: "
            + ("64" if args.quick else "every pixel of the aperture mask for `search`, "
               f"`raytrace` and `blur` ({MANY} at K = 40)") + ", 64 for `sweep`, 256 views for `lightfield`. ms: of one "
            "frame, processor time of all threads together, because others used the machine "
            "too; MiB: all a renderer takes.\n"]

    rmse, first, rays = {}, None, {}
    for name in SCENES:
        scene = folder / name
        if not (scene / "scene.json").is_file():
            sys.exit(f"papers.py: no scene at {scene}: set REFOCUS_SCENES")
        for view in scene_views(scene, blurs):
            scores = compare(refocus, scene / "allfocus.png", scene / "disparity.png",
                             scene / view["file"], view["df"], view["K"],
                             full if view["K"] <= 20 else min(full, MANY, key=order))
            text += [f"## {name}, df = {view['df']:.3f}, K = {view['K']:g}\n",
                     table(HEAD, score_rows(scores))]
            if name != "portrait1080":
                for label, s in scores.items():
                    rmse.setdefault(label, {}).setdefault(view["K"], []).append(s["rmse"])
            if view["K"] == 20 and name != "portrait1080":
                first = first or scores
                rays[name] = json.loads(run(refocus, "bench", scene / "allfocus.png", "--depth",
                                            scene / "disparity.png", "--focus", view["df"],
                                            "--blur", 20, "--rays", "--json"))
    field = photos / "light-field" / "antinous"
    lf = {}
    if field.is_dir():
        lf = light_field(args.build, refocus, field, full)
        for (blur, views), scores in lf.items():
            text += [f"## Light field, {views} views, K = {blur:.2f}\n",
                     table(HEAD, score_rows(scores))]
    else:
        print(f"papers.py: NO LIGHT FIELD at {field}: left out", file=sys.stderr)
        text.append("## Light field\n\nLeft out: the folder was not there.\n")

    text += ["## Yang et al. 2016, Table 1\n",
             "720x540, a mask of 41x41 pixels" + (
                 " (64 rays of it for all but `jittered`: --quick)" if args.quick else "")
             + ". Theirs on a tablet's GPU, ours on "
             f"{first['blur']['threads']} threads of a processor, plain C but for `sweep`, `search` and the rows of `diffusion`.\n",
             table_1(first, 20)]
    count = len(next(iter(rays.values()))["found_after"])
    plot(pictures / "fig3a.svg", "Rays that have found an intersection", "tests T", "share",
         {n: [(i + 1, sum(r["found_after"][:i + 1])) for i in range(count)]
          for n, r in rays.items()})
    text += ["## Yang et al. 2016, Fig. 2 and 3\n", "![rays found](papers/fig3a.svg)\n",
             table(["scene", "hidden", "T = 1", "T = 2", "T = 3", "never", "front-most, T = 1",
                    "front-most, T = 2", "in set, T = 1", "in set, T = 2"],
                   [[n, f"{r['hidden']:.1%}"] + [f"{v:.1%}" for v in r["found_after"][:3]]
                    + [f"{r['never']:.1%}"] + [f"{v:.1%}" for v in r["front_most"][:2]]
                    + [f"{v:.1%}" for v in r["in_set"][:2]] for n, r in rays.items()])]
    shown = ["search T=1", "search T=2", "jittered a=2", "jittered a=4", "raytrace", "sweep"]
    curves = {n: [(k, sum(v) / len(v)) for k, v in rmse[n].items()] for n in shown}
    plot(pictures / "fig3b.svg", "RMSE to the scenes' references, mean", "K", "RMSE", curves)
    text.append("![RMSE over K](papers/fig3b.svg)\n")
    if lf:
        plot(pictures / "fig3b-lightfield.svg", "RMSE to the light field", "K", "RMSE",
             {n: [(blur, s[n]["rmse"]) for (blur, _), s in lf.items()] for n in shown})
        text.append("![RMSE over K, light field](papers/fig3b-lightfield.svg)\n")
    text.append(table(["K"] + shown, [[f"{k:g}"] + [
        f"{sum(rmse[n][k]) / len(rmse[n][k]):.2f}" if k in rmse[n] else "-" for n in shown] for k in sorted(rmse["sweep"])]))

    t1 = sum(r["found_after"][0] for r in rays.values()) / len(rays)
    t2 = sum(r["found_after"][1] for r in rays.values()) / len(rays)
    at20 = {n: sum(rmse[n][20]) / len(rmse[n][20]) for n in shown}
    relative = first["blur"]["cpu_ms"]["min"] / first["lightfield"]["cpu_ms"]["min"]
    jitter = first["blur"]["cpu_ms"]["min"] / first["jittered a=4"]["cpu_ms"]["min"]
    text += ["## Yang et al. 2016, Fig. 8\n", "portrait, K = 20:\n",
             figure_8(refocus, folder / "portrait", pictures)]
    text += ["## Mulder & van Liere 2000\n",
             "One thread, focus 0.5:\n", mulder(refocus, folder),
             "## NVIDIA 2004\n",
             "The cheapest preview beside `sweep` with 32 rays; tabletop, focus 0, one thread:\n",
             preview(refocus, folder),
             "## Kosloff & Barsky 2007\n",
             "Whole frames, one thread, by the iterated form and by the series that replaces it; "
             "tabletop, focus 0, the largest weight 1/8:\n",
             diffusion(refocus, folder / "tabletop", args.quick),
             "Fields on tabletop:\n", fields(refocus, folder / "tabletop", pictures),
             "## Where our results differ\n",
             f"- Fig. 3a: {t1:.0%} of the rays find an intersection in the first test and "
             f"{t2:.0%} more in the second, almost none later. We do not confirm that T = 1 "
             f"suffices: its RMSE at K = 20 is {at20['search T=1']:.1f}, that of T = 2 is "
             f"{at20['search T=2']:.1f}, and that of full ray tracing {at20['raytrace']:.1f}.\n"
             f"- Table 1: the light field is {'slower' if relative < 1 else 'faster'} than the "
             f"filter ({relative:.2f} times its frames a second; in the paper 0.33 times), but ours "
             "makes 256 views, not one for each of 1,257 rays. Jittered sampling, as fast as the "
             f"filter on the GPU of the paper, reaches {jitter:.2f} times its frames here, in "
             "double precision.\n"
             f"- The noise of jittered sampling hardly raises the RMSE (a = 2: "
             f"{at20['jittered a=2']:.1f}, a = 4: {at20['jittered a=4']:.1f}), although it is "
             "plainly visible.\n"
             "- Potmesil's physical wavelengths make rings far below a pixel at photographic "
             "f-numbers; `--spread lommel` is therefore given the radius of the Airy disc in pixels.\n"
             "- Mulder's level 3 spreads a pixel over 29x29 by the 5x5 filters alone; the paper "
             "counts 31x31.\n"
             "- Kosloff's layers come from a renderer; ours are cut from one picture, so "
             "the hidden background at an edge is not known, and is filled with the colours beside it.\n"]
    (args.out / "papers.md").write_text("\n".join(text), encoding="utf-8")
    print(f"wrote {args.out / 'papers.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
