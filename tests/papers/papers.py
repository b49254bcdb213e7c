#!/usr/bin/env python3
"""Measures the methods of the five papers side by side and writes tests/papers.md.

usage: papers.py BUILD [--check | --scores]

BUILD is the folder of a release build. The scenes are those in examples/data, unless
$REFOCUS_SCENES names another folder. The light field is not in the repository: $REFOCUS_PHOTOS
names the folder of photos, else it is sought in ../shared/photos beside the source; without it its
sections stay as they are. --check compares scores with the page, all but those of methods that take
seconds a frame, and names the rows that moved; --scores leaves the times of Mulder's and Kosloff's
methods as they are, which take minutes.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from pages import SOURCE, check, photos, scenes  # noqa: E402
from pairs import pairs  # noqa: E402
from plot import plot  # noqa: E402
from potmesil import potmesil  # noqa: E402
from sections import table  # noqa: E402

PAGE = SOURCE / "tests" / "papers.md"
PICTURES = SOURCE / "tests" / "papers"
REPEAT = 2
SCENES = ["portrait", "tabletop", "fence", "nightlights"]
# label, an entry of `refocus compare --methods`; {full}: every ray of the mask
METHODS = [
    ("sweep", "sweep:rays=64"),
    ("sweep, highlights off", "sweep:rays=64:highlights=off"),
    ("sweep, blended as written", "sweep:rays={full}:highlights=off:blend=stored:sigma=128"),
    ("search as written",
     "search:iterations=1:rays={full}:highlights=off:blend=stored:sigma=128"),
    ("search as written, highlights", "search:iterations=1:rays={full}:blend=stored:sigma=128"),
    ("search T=1", "search:iterations=1:rays={full}:highlights=off"),
    ("search T=2", "search:iterations=2:rays={full}:highlights=off"),
    ("search T=2, highlights", "search:iterations=2:rays={full}"),
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
SECONDS = ("search as written", "raytrace", "jittered a=2", "jittered a=4")  # a frame or more
SHOWN = ["search as written", "search T=1", "search T=2", "jittered a=2", "jittered a=4",
         "raytrace", "sweep"]
# What is not as in the papers, and why.
LISTED = """\
- Yang: the paper gives no σ for eq. 5; 128 scores best here of 64 to 160 (`quality.md`, Blending).
  In the table of Fig. 2 and 3 a hit may be a pixel beside, because coordinates are rounded, both the
  front-most and one of the set.
- Potmesil: `--airy-radius` is in pixels, 1.22 λN by a pixel of the sensor, which makes our u and v
  those of eq. 17 and 18; it is not found from the lens, because the rings that a lens has are seen
  at small apertures alone (the table above), where circles are small. A photo's pixel is one sample
  and a mean over its area; the paper's are points at corners, middles and sides, four for a pixel,
  which takes its four sets of tables and its 2x2 squares. A photo has no such points, and those made
  up from it would hold nothing more. Tables are for equally spaced radii, which serve every depth,
  not for equally spaced depths, which are many far away, where the radius hardly changes, and few
  nearby. 1 / z² (eq. 20) is on in the paper and off here unless `--depth-ratio` is given z1 / z0: it lets
  what is near and blurred outweigh what is sharp behind it. Of 20 views of four scenes (K = 20 and 40,
  every focus) it gains 1.5 dB in the mean on nightlights and loses 0.2, 4.0 and 8.3 dB on tabletop,
  portrait and fence; on one view it is below the untouched photo (fence, df = 0, K = 20: 15.56, the photo
  18.77, without it 23.61). Ratios of √Q and Q^¼, Q = z1 / z0, lose 1.4 and 0.4 dB in the mean of the
  scenes. With one scene left out, the mean of the others chooses no weighting three times of four, at no
  loss; with fence left out it chooses Q^¼, which gains 0.2 dB on the others and loses 2.0 on fence.
- NVIDIA: that the quick preview is the cheapest is measured, not claimed: the table has where it
  takes less time than `sweep` with 32 rays.
- Mulder: level 3 spreads a pixel over 29x29 by the 5x5 filters alone; the paper counts 31x31. The
  volume of attention is about the place where the focus is found (`--focus-at`, also of `live`, the
  file's focus point), else the middle; an object's outline is not looked for. There are no options for
  pupil and screen, because they are a lens: a pupil of E mm is `--f-number F/E --focal-length F`, F =
  18 mm / tan(half the angle that the picture's larger side is seen at), wherever the screen is.
  Outside of the volume each pixel reads both pyramids, and what lies before the focus is composited
  over the rest. In the paper it reads its own side's alone and the original picture shows where that
  does not cover, which shines through sharply (fence, K = 40: 20.5 dB so, 25.9 dB ours). Where
  `foveated` still scores below `blur` at K = 40, tabletop by 0.04 dB, we do not know the cause.
- Kosloff: layers come from a renderer there; ours are cut from one picture, so the hidden
  background at an edge is not known, and is filled with the colours beside it: a layer below counts
  as whole wherever 5 % of it came by diffusion, and is divided by what came. Places are x, y and
  disparity, not a map of positions in the world, which one photo does not give without its lens.
  In eq. 3 the edge pixels of a square of 16x16 that is not next to a pixel's own count together at
  their middle: radii move by 0.4 % in the mean and by 4 % at most (`test_diffusion.c`).
"""
MANY = "1024"  # rays at K = 40, where the mask has 5,025 pixels
# Table 1, each with the paper's blending.
AS_WRITTEN = ":blend=stored:sigma=128"
TABLE_1 = [("blur", "blur:rays=full" + AS_WRITTEN), ("lightfield", "lightfield:rays=256" + AS_WRITTEN),
           ("raytrace", "raytrace:rays=full" + AS_WRITTEN),
           ("jittered a=4", "jittered:cell=4" + AS_WRITTEN),
           ("search as written", "search:iterations=1:rays=full:highlights=off" + AS_WRITTEN),
           ("sweep", "sweep:rays=64:highlights=off" + AS_WRITTEN)]
PAPER_FPS = {"blur": 15, "lightfield": 5, "raytrace": 3, "jittered a=4": 15,
             "search as written": 15}


def run(*command):
    try:
        return subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, check=True,
                              text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"papers.py: {error}")


def compare(refocus, methods, photo, depth, truth, focus, blur):
    """Scores and times of each method, by label."""
    full = "full" if blur <= 30 else MANY
    print(f"{photo} K = {blur:g}", file=sys.stderr)
    report = json.loads(run(refocus, "compare", photo, "--depth", depth, "--reference", truth,
                            "--focus", focus, "--blur", blur, "--json",
                            "--methods", ",".join(m.format(full=full) for _, m in methods)))
    result = dict(zip(["photo"] + [label for label, _ in methods], report["methods"]))
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


def scene_views(folder, blurs):
    """The first round-aperture view of each K."""
    views = {}
    for view in json.loads((folder / "scene.json").read_text())["gt"]:
        if view["K"] in blurs and not view.get("blades"):
            views.setdefault(view["K"], view)
    return [views[k] for k in sorted(views)]


def light_field(build, refocus):
    """Scores for rising apertures of the real light field: {(K, views): scores}."""
    result = {}
    for radius in (1, 2, 3, 4):
        with tempfile.TemporaryDirectory() as out:
            blur, focus, views = run(build / "tests/papers/lightfield-truth",
                                     photos() / "light-field" / "antinous", out, 0.54,
                                     radius).split()
            result[float(blur), int(views)] = compare(
                refocus, METHODS, f"{out}/photo.png", f"{out}/disparity.png", f"{out}/truth.png",
                focus, float(blur))
    return result


def table_1(scores, blur):
    """Frames a second relative to `blur`, theirs and ours, all with eq. 5."""
    base = scores["blur"]["cpu_ms"]["min"]
    rows = []
    for label, fps in PAPER_FPS.items():
        ms = scores[label]["cpu_ms"]["min"]
        rows.append([label, fps, f"{fps / 15:.2f}", f"{ms:.0f}", f"{base / ms:.2f}"])
    ms = scores["sweep"]["cpu_ms"]["min"]
    rows.append(["sweep (64 rays)", "-", "-", f"{ms:.0f}", f"{base / ms:.2f}"])
    return table(["method", "paper, fps", "paper, to blur", f"ours, ms (K = {blur:g})",
                  "ours, to blur"], rows)


def table_1_intro(scene, scores):
    return ("## Yang et al. 2016, Table 1\n\n"
            f"720x540, a mask of 41x41 pixels, stored values and eq. 5 with σ = 128; {scene.name}. "
            f"Theirs on a tablet's GPU, ours on {scores['blur']['threads']} threads of a processor, "
            "plain C but for `sweep` and `search`.\n")


def score_table_1(refocus, scene):
    view = next(v for v in scene_views(scene, (20,)))
    return compare(refocus, TABLE_1, scene / "allfocus.png", scene / "disparity.png",
                   scene / view["file"], view["df"], 20)


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


def mulder(refocus, folders):
    rows = []
    for scene in folders:
        for blur in (10, 20, 40):
            everywhere, centre = timed(refocus, scene, 0.5, blur, [
                (1, "--method foveated --attention-angle 170"), (2, "--method foveated")])
            rows.append([scene.name, blur, f"{everywhere:.0f}", f"{centre:.0f}",
                         f"{everywhere / centre:.1f}"])
    return table(["scene", "K", "exact everywhere, ms", "exact in a cone of 10 degrees, ms",
                  "times faster"], rows)


def preview(refocus, scene):
    rows = []
    for blur in (5, 10, 20, 40):
        sweep, interpolated = timed(refocus, scene, 0, blur, [
            (20, "--method sweep --rays 32"), (20, "--method interpolated")])
        rows.append([blur, f"{sweep:.1f}", f"{interpolated:.1f}",
                     "yes" if interpolated < sweep else "no"])
    return table(["K", "sweep, 32 rays, ms", "interpolated, ms", "cheaper"], rows)


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


def diffusion(refocus, scene):
    rows = []
    for blur in (20, 40, 80):
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
        "sweep,search:rays=64:iterations=1:highlights=off,raytrace:rays=64,jittered:cell=4,"
        "lightfield:rays=256,blur:rays=64", "-o", out / "fig8.jpg")
    return "![crops along depth edges by each method](papers/fig8.jpg)\n"


def score_scenes(refocus, methods, folders):
    """(scene's folder, view, scores) of one view of each K."""
    for scene in folders:
        for view in scene_views(scene, (10, 20, 40)):
            yield scene, view, compare(refocus, methods, scene / "allfocus.png",
                                       scene / "disparity.png", scene / view["file"], view["df"],
                                       view["K"])


def scene_tables(scored):
    for scene, view, scores in scored:
        yield f"## {scene.name}, df = {view['df']:.3f}, K = {view['K']:g}\n"
        yield table(HEAD, score_rows(scores))


def light_field_tables(scored):
    for (blur, views), scores in scored.items():
        yield f"## Light field, {views} views, K = {blur:.2f}\n"
        yield table(HEAD, score_rows(scores))


def kept(name):
    """Sections whose heading begins so, as the page has them."""
    print(f"papers.py: '{name}' stays as it is", file=sys.stderr)
    return [section.rstrip("\n") + "\n" for section in re.findall(
        rf"(?ms)^## {name}.*?(?=^## |\Z)", PAGE.read_text(encoding="utf-8"))]


def found_rays(refocus, scene, view):
    return json.loads(run(refocus, "bench", scene / "allfocus.png", "--depth",
                          scene / "disparity.png", "--focus", view["df"], "--blur", 20, "--rays",
                          "--json"))


def rays_table(rays):
    return table(["scene", "hidden", "T = 1", "T = 2", "T = 3", "never", "front-most, T = 1",
                  "front-most, T = 2", "in set, T = 1", "in set, T = 2"],
                 [[n, f"{r['hidden']:.1%}"] + [f"{v:.1%}" for v in r["found_after"][:3]]
                  + [f"{r['never']:.1%}"] + [f"{v:.1%}" for v in r["front_most"][:2]]
                  + [f"{v:.1%}" for v in r["in_set"][:2]] for n, r in rays.items()])


def figures_2_and_3(rays, rmse, lf):
    count = len(next(iter(rays.values()))["found_after"])
    plot(PICTURES / "fig3a.svg", "Rays that have found an intersection", "tests T", "share",
         {n: [(i + 1, sum(r["found_after"][:i + 1])) for i in range(count)]
          for n, r in rays.items()})
    yield "## Yang et al. 2016, Fig. 2 and 3\n"
    yield "![rays found](papers/fig3a.svg)\n"
    yield rays_table(rays)
    plot(PICTURES / "fig3b.svg", "RMSE to the scenes' references, mean", "K", "RMSE",
         {n: list(rmse[n].items()) for n in SHOWN})
    yield "![RMSE over K](papers/fig3b.svg)\n"
    if lf:
        plot(PICTURES / "fig3b-lightfield.svg", "RMSE to the light field", "K", "RMSE",
             {n: [(blur, s[n]["rmse"]) for (blur, _), s in lf.items()] for n in SHOWN})
    yield "![RMSE over K, light field](papers/fig3b-lightfield.svg)\n"
    yield table(["K"] + SHOWN, [[f"{k:g}"] + [f"{rmse[n][k]:.2f}" for n in SHOWN]
                                for k in sorted(rmse["sweep"])])


def mean_rmse(scored):
    """{label: {K: mean RMSE of the scenes}}."""
    rmse = {}
    for _, view, scores in scored:
        for label, s in scores.items():
            rmse.setdefault(label, {}).setdefault(view["K"], []).append(s["rmse"])
    return {n: {k: sum(v) / len(v) for k, v in by_k.items()} for n, by_k in rmse.items()}


def differences(rays, scored, rmse, first):
    wide = [scores for _, view, scores in scored if view["K"] == 40]
    below = sum(s["foveated"]["psnr"] < s["blur"]["psnr"] for s in wide)
    t1 = sum(r["found_after"][0] for r in rays.values()) / len(rays)
    t2 = sum(r["found_after"][1] for r in rays.values()) / len(rays)
    relative = first["blur"]["cpu_ms"]["min"] / first["lightfield"]["cpu_ms"]["min"]
    jitter = first["blur"]["cpu_ms"]["min"] / first["jittered a=4"]["cpu_ms"]["min"]
    at20 = {n: rmse[n][20] for n in rmse}
    return (
        "## Where our results differ\n\n"
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
        f"- Mulder: at K = 40 `foveated` scores below `blur` in {below} of {len(wide)} scenes.\n"
        + LISTED)


def intro(where):
    return ("# The methods of the five papers, side by side\n\n"
            "Written by `tests/papers/papers.py`; do not edit. References: path-traced scenes "
            f"through a real thin lens ({where}), and the averaged views of a light field that is "
            "not in the repository. PSNR and RMSE of 8-bit values, SSIM of luma, edge PSNR within "
            "reach of depth edges of 2 pixels of blur or more, a border of K left out. *As "
            "written* is with the paper's blending, stored values and eq. 5, σ = 128; all else "
            "is in linear light without eq. 5. Light is given back to highlights by `sweep`, "
            "unless it says *off*, and by `search` where it says *highlights*. Rays: every pixel "
            "of the aperture mask for `search`, `raytrace` "
            f"and `blur` ({MANY} at K = 40), 64 for `sweep`, 256 views for `lightfield`. ms: of "
            "one frame, processor time of all threads together, because others used the machine "
            "too; MiB: all a renderer takes.\n")


def page(refocus, folders, where, scored, lf, times):
    first = score_table_1(refocus, folders[0])
    rays = {scene.name: found_rays(refocus, scene, view) for scene, view, _ in scored
            if view["K"] == 20}
    rmse = mean_rmse(scored)
    by_name = {scene.name: scene for scene in folders}
    portrait, tabletop = (by_name.get(n, folders[0]) for n in ("portrait", "tabletop"))
    yield intro(where)
    yield from scene_tables(scored)
    yield from light_field_tables(lf) if lf else kept("Light field")
    yield table_1_intro(folders[0], first)
    yield table_1(first, 20)
    yield from figures_2_and_3(rays, rmse, lf)
    yield f"## Yang et al. 2016, Fig. 8\n\n{portrait.name}, K = 20:\n"
    yield figure_8(refocus, portrait, PICTURES)
    real = photos() / "real-lens"
    if real.is_dir():
        yield pairs(refocus, real, compare)
    else:
        yield from kept("Yang et al. 2016, Fig. 9 and 10")
    yield potmesil(refocus, folders, compare, scene_views)
    if times:
        yield "## Mulder & van Liere 2000\n\nOne thread, focus 0.5:\n"
        yield mulder(refocus, folders)
    else:
        yield from kept("Mulder")
    yield (f"## NVIDIA 2004\n\nThe quick preview beside `sweep` with 32 rays; {tabletop.name}, "
           "focus 0, one thread:\n")
    yield preview(refocus, tabletop)
    if times:
        yield ("## Kosloff & Barsky 2007\n\n"
               "Whole frames, one thread, by the iterated form and by the series that replaces "
               f"it; {tabletop.name}, focus 0, the largest weight 1/8:\n")
        yield diffusion(refocus, tabletop)
        yield f"Fields on {tabletop.name}:\n"
        yield fields(refocus, tabletop, PICTURES)
    else:
        yield from kept("Kosloff")
    yield differences(rays, scored, rmse, first)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--scores", action="store_true")
    args = parser.parse_args()
    refocus = args.build / "platform" / "cli" / "refocus"
    folders, where = scenes(SCENES)
    if args.check:
        methods = [m for m in METHODS if m[0] not in SECONDS]
        check(PAGE, "\n".join([*scene_tables(score_scenes(refocus, methods, folders)),
                               potmesil(refocus, folders, compare, scene_views)]),
              "tests/pages.sh BUILD papers")
        return
    scored = list(score_scenes(refocus, METHODS, folders))
    lf = light_field(args.build, refocus) if (photos() / "light-field").is_dir() else {}
    text = "\n".join(page(refocus, folders, where, scored, lf, not args.scores))
    PAGE.write_text(text, encoding="utf-8")
    print(f"wrote {PAGE}", file=sys.stderr)


if __name__ == "__main__":
    main()
