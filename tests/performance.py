#!/usr/bin/env python3
"""Times whole frames with the refocus command and writes tests/performance.md.

usage: performance.py BUILD_DIR [--repeat N] [--out FILE]

BUILD_DIR holds a release build, and the machine should be idle. The picture is the portrait of
examples/data, 720x540, K = 20; the tables of qualities and of large blurs take all scenes there, or
those in the folder that $REFOCUS_SCENES names.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import sections
from pages import DATA, SOURCE

SCENE = DATA / "portrait"

# method, options, repeats: 1 for what takes seconds
RUNS = [
    ("sweep", ["--rays", "32"], 0),
    ("sweep", ["--rays", "64"], 0),
    ("sweep", ["--rays", "128"], 0),
    ("sweep", ["--rays", "64", "--cpu", "c"], 0),
    ("search", ["--rays", "64", "--iterations", "1"], 0),
    ("search", ["--rays", "64", "--iterations", "2"], 0),
    ("search", ["--rays", "full", "--iterations", "1"], 3),
    ("search", ["--rays", "full", "--iterations", "1", "--blend", "stored"], 3),
    ("search", ["--rays", "full", "--iterations", "1", "--blend", "stored", "--sigma", "128"], 3),
    ("raytrace", ["--rays", "full"], 1),
]


def machine():
    """Model of the processor and how many there are."""
    models = []
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith(("model name", "Model", "Processor")):
            models.append(line.split(":", 1)[1].strip())
    compiler = subprocess.run(["cc", "--version"], stdout=subprocess.PIPE, text=True,
                              check=False).stdout.splitlines()[:1]
    return f"{models[0] if models else 'unknown processor'}, {len(models)} logical processors; " \
           f"{compiler[0] if compiler else 'unknown compiler'}"


def render(refocus, scene, *options, check=True):
    """What `refocus render --json` says of a scene; None if it fails and may."""
    with tempfile.TemporaryDirectory() as work:
        done = subprocess.run(
            [refocus, "render", scene / "allfocus.png", "--depth", scene / "disparity.png",
             *map(str, options), "--json", "-o", Path(work) / "out.png"],
            stdout=subprocess.PIPE, check=check)
    return None if done.returncode else json.loads(done.stdout)


def methods(refocus, repeat_most):
    rows = []
    for method, options, repeat in RUNS:
        for threads in (1, 2):
            n = repeat or repeat_most
            r = render(refocus, SCENE, "--focus", 0.689, "--blur", 20, "--method", method, *options,
                       "--threads", threads, "--repeat", n)
            ms = r["render_ms"]
            rows.append([f"`{r['method']}`", " ".join(options), r["threads"], r["cpu"], n,
                         f"{r['prepare_ms']:.1f}", f"{ms['min']:.1f}", f"{ms['median']:.1f}",
                         f"{r['peak_rss_kib'] / 1024:.0f}"])
            print(rows[-1], file=sys.stderr)
    return "\n".join([
        "# How long it takes\n",
        "720x540, K = 20, whole frames (everything but reading and writing files); the best and "
        "the median.\n", machine() + "\n",
        sections.table(["method", "options", "threads", "cpu", "frames", "prepare ms",
                        "render ms, best", "median", "peak memory MiB"], rows)])


def scene_rows(scenes):
    """Frames that the table of qualities has: scene, K, quality."""
    for path in sorted(p.parent for p in scenes.glob("*/scene.json")):
        focus = json.loads((path / "scene.json").read_text(encoding="utf-8"))["gt"][0]["df"]
        for quality in ("preview", "standard", "best"):
            for blur in (20, 40) if path.name.endswith("1080") else (20,):
                yield path, focus, blur, quality


def qualities(refocus, scenes, repeat, rounds=6):
    """Qualities by turns with the instruction sets and threads, the best of all rounds."""
    columns = [("avx2", 1), ("avx2", 2), ("sse41", 1), ("auto", 1), ("auto", 2)]
    best, used = {}, "auto"
    frames_of = list(scene_rows(scenes))
    for turn in range(rounds):
        for frame in frames_of:
            path, focus, blur, quality = frame
            for cpu, threads in columns:
                report = render(refocus, path, "--focus", f"{focus:.4f}", "--blur", blur,
                                "--quality", quality, "--cpu", cpu, "--threads", threads,
                                "--repeat", repeat, check=False)
                if not report:
                    continue  # a set that this processor lacks
                size = f"{report['width']}x{report['height']}"
                used = report["cpu"] if cpu == "auto" else used
                key = frame, cpu, threads
                best[key] = min(best.get(key, (1e9,)), (report["render_ms"]["min"], size))
        print(f"qualities: round {turn + 1} of {rounds}", file=sys.stderr)
    rows = [[f[0].name, best[f, "auto", 1][1], f[2], f[3]]
            + [f"{best[f, c, n][0]:.1f}" if (f, c, n) in best else "-" for c, n in columns]
            for f in frames_of]
    return "\n".join([
        "## Qualities\n",
        f"Whole frames of the path-traced scenes in ms, the best of {rounds} rounds of {repeat} "
        f"by turns; `auto` is {used} here.\n", machine() + "\n",
        sections.table(["scene", "size", "K", "quality"]
                       + [f"{c}, {n} thread{'s' * (n > 1)}" for c, n in columns], rows)])


def large_blurs(refocus, scenes, repeat, rounds=4):
    """What K = 64 costs beside K = 16, of all views of the small scenes."""
    blurs = (16, 64)
    best = {}
    views = [(path.parent, focus)
             for path in sorted(scenes.glob("*/scene.json")) if "1080" not in path.parent.name
             for focus in sorted({g["df"] for g in json.loads(path.read_text("utf-8"))["gt"]})]
    for turn in range(rounds):
        for path, focus in views:
            for quality in ("preview", "standard"):
                for blur in blurs:
                    report = render(refocus, path, "--focus", f"{focus:.4f}", "--blur", blur,
                                    "--quality", quality, "--threads", 1, "--repeat", repeat)
                    key = path.name, focus, quality, blur
                    best[key] = min(best.get(key, 1e9), report["render_ms"]["min"])
        print(f"large blurs: round {turn + 1} of {rounds}", file=sys.stderr)
    rows = []
    for path, focus in views:
        row = [path.name, f"{focus:.3f}"]
        for quality in ("preview", "standard"):
            few, many = (best[path.name, focus, quality, blur] for blur in blurs)
            row += [f"{few:.1f}", f"{many:.1f}", f"{many / few:.2f}"]
        rows.append(row)
    return "\n".join([
        "## Large blurs\n",
        f"Frames of 720x540 in ms, one thread, the best of {rounds} rounds of {repeat} by turns.\n",
        machine() + "\n",
        sections.table(["scene", "focus"] + [f"{q}, {c}" for q in ("preview", "standard")
                                             for c in ("K = 16", "K = 64", "ratio")], rows)])


def large(refocus, repeat):
    """Twelve megapixels at the largest blur that is asked for."""
    rows = []
    for threads in (1, 2):
        done = subprocess.run([refocus, "bench", "--size", "4000x3000", "--blur", "100",
                               "--quality", "best", "--threads", str(threads), "--repeat",
                               str(repeat), "--json"], stdout=subprocess.PIPE, check=True)
        report = json.loads(done.stdout)
        rows.append([threads, f"{report['prepare_ms']:.0f}",
                     f"{report['render_ms']['min']:.0f}"])
    return "\n".join(["## Twelve megapixels\n",
                      f"`refocus bench --size 4000x3000 --blur 100 --quality best`, the best of "
                      f"{repeat}.\n",
                      sections.table(["threads", "prepare ms", "render ms"], rows)])


def frames(refocus, repeat):
    """The table of `refocus bench --frames`."""
    print("bench --frames", file=sys.stderr)
    report = json.loads(subprocess.run([refocus, "bench", "--frames", "--repeat", str(repeat),
                                        "--json"], stdout=subprocess.PIPE, check=True).stdout)
    rows = [[f"{f['width']}x{f['height']}", f"{f['blur']:g}", f["quality"], f["threads"],
             f"{f['memcpy_ms']:.2f}", f"{f['box_ms']:.1f}", f"{f['prepare_ms']:.1f}",
             f"{f['render_ms']:.1f}", f"{1000 / f['render_ms']:.0f}",
             f"{f['render_ms'] / f['box_ms']:.2f}"] for f in report["frames"]]
    return "\n".join([
        "## By size, blur, quality and threads\n",
        f"`refocus bench --frames`: a made-up scene, the best of {repeat}, in turns with a memcpy "
        "of the frame and a plain box blur of the same radius, both of one thread.\n",
        machine() + "\n",
        sections.table(["size", "K", "quality", "threads", "memcpy ms", "box blur ms",
                        "prepare ms", "render ms", "frames a second", "to the box blur"], rows)])


def interactive(build):
    """Rows on how soon a renderer answers, on a drawn picture of 12 megapixels."""
    lines = ["## Interactive use\n",
             "`render-interactive`: 4000x3000, 64 rays, 2 threads; the best of five, milliseconds. "
             "Previews are the photo at 1/2, 1/4 and 1/8 of its size.\n"]
    results = []
    for blur in (20, 100):
        done = subprocess.run([build / "tests" / "render" / "render-interactive", "--blur",
                               str(blur), "--threads", "2"], stdout=subprocess.PIPE, text=True,
                              check=True)
        text = done.stdout
        results.append(json.loads(text[text.index("{\n"):text.index("\n}\n") + 2]))
    lines += ["| what | K = 20 | K = 100 |", "| --- | --- | --- |"]
    for one, other in zip(results[0]["times"], results[1]["times"]):
        if one:
            lines.append(f"| {one['what']} | {one['ms']:.1f} | {other['ms']:.1f} |")
    lines += ["\nCancelled at moments spread over the first two seconds, K = 100: the longest time "
              "that a call went on, by the clock, and what all threads computed in it.\n",
              "| call | times | worst ms | mean ms | worst processor ms |",
              "| --- | --- | --- | --- | --- |"]
    lines += [f"| {c['of']} | {c['cancelled']} | {c['worst_ms']:.1f} | {c['mean_ms']:.1f} "
              f"| {c['worst_cpu_ms']:.1f} |" for c in results[1]["cancel"]]
    return "\n".join(lines)


def format_rows(build, repeat):
    """Pixel formats by turns, prepared and rendered, against RGB."""
    yield "\n## Pixel formats\n"
    yield ("Prepare and render by turns in each format, CPU time of one thread, the best of "
           f"{repeat}; 720x540, K = 20.\n")
    yield "| rays | sigma | format | prepare ms | render ms | both | of RGB8 |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for rays, sigma in ((32, "inf"), (64, "inf"), (64, "400"), (128, "inf"), (128, "400")):
        done = subprocess.run([build / "tests" / "quality" / "refocus-format-times", SCENE, "20",
                               str(rays), str(repeat), sigma], stdout=subprocess.PIPE,
                              text=True, check=True)
        rows = [line.split() for line in done.stdout.splitlines()]
        for name, prepare, render, both in rows:
            yield (f"| {rays} | {'off' if sigma == 'inf' else sigma} | {name} | {prepare} "
                   f"| {render} | {both} | {100 * float(both) / float(rows[0][3]):.0f} % |")


def live_rows(refocus, seconds):
    """Frames of the replay source at 30 a second, from the camera to the sink."""
    yield "\n## Live\n"
    yield (f"`refocus live` with the replay source, 30 frames a second for {seconds} s, depth of "
           "the same size, K = 20, `--out null`; milliseconds.\n")
    yield ("| camera | rendered in | frames a second | latency, median | 99 % | prepare | render "
           "| outside rendering | peak memory MiB |")
    yield "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for size in ("640x480", "1280x720"):
        for form in ("NV12", "YUYV", "RGB24"):
            done = subprocess.run(
                [refocus, "live", "--camera", f"replay::format {form};size {size};fps 30",
                 "--depth", f"replay::format Z16;size {size};fps 30", "--focus", "0.5",
                 "--blur", "20", "--duration", str(seconds), "--no-commands",
                 "--json"],
                stdout=subprocess.PIPE, check=True)
            r = json.loads(done.stdout)
            stage = r["stages_ms"]
            yield (f"| {form} {size} | {r['rendered_in']} | {r['fps']:.1f} "
                   f"| {r['latency_ms']['median']:.1f} | {r['latency_ms']['p99']:.1f} "
                   f"| {stage['prepare']['median']:.1f} | {stage['render']['median']:.1f} "
                   f"| {100 * r['outside_rendering']:.1f} % | {r['peak_rss_kib'] / 1024:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--repeat", type=int, default=20)
    parser.add_argument("--out", type=Path, default=SOURCE / "tests" / "performance.md")
    args = parser.parse_args()
    refocus = args.build / "platform" / "cli" / "refocus"

    scenes = Path(os.environ.get("REFOCUS_SCENES", DATA))
    if not list(scenes.glob("*/scene.json")):
        sys.exit(f"performance.py: no scenes in {scenes}: set REFOCUS_SCENES to their folder")

    sections.put(args.out, "methods", "tests/performance.py", methods(refocus, args.repeat))
    sections.put(args.out, "qualities", "tests/performance.py",
                 qualities(refocus, scenes, args.repeat))
    sections.put(args.out, "blurs", "tests/performance.py",
                 large_blurs(refocus, scenes, args.repeat))
    sections.put(args.out, "large", "tests/performance.py", large(refocus, 5))
    sections.put(args.out, "frames", "tests/performance.py", frames(refocus, args.repeat))
    sections.put(args.out, "interactive", "tests/performance.py", interactive(args.build))
    sections.put(args.out, "formats", "tests/performance.py",
                 "\n".join(format_rows(args.build, 2 * args.repeat)))
    sections.put(args.out, "live", "tests/performance.py", "\n".join(live_rows(refocus, 10)))
    print(f"wrote {args.out}", file=sys.stderr)


if __name__ == "__main__":
    main()
