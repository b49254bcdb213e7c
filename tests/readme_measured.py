#!/usr/bin/env python3
"""Puts the figures of tests/quality.md and tests/performance.md into README.md's table.

usage: readme_measured.py [--check]

--check says whether the table is of these pages, and writes nothing. tests/pages.sh makes them.
"""
import re
import sys

from pages import SOURCE, cells

# run in quality.md; method and options in performance.md, or a quality of the portrait; what it is
ROWS = [
    ("input", None, "the untouched photo"),
    ("standard", ("quality", "standard"), "`sweep`, the default: quality `auto`, at this blur `standard`"),
    ("standard-off", None, "the same with `--highlights off`: no light added, as in the methods below"),
    ("standard", ("sweep", "--rays 64 --cpu c"), "the default in plain C"),
    ("best", ("quality", "best"), "`sweep`, quality `best`"),
    ("paper", ("search", "--rays full --iterations 1 --blend stored --sigma 128"),
     "the paper as written: `search`, one test, every ray, stored values weighted by eq. 5"),
    ("paper-plain", ("search", "--rays full --iterations 1 --blend stored"),
     "the same without eq. 5, which is what gives highlights more light there"),
    ("sweep-paper", None, "`sweep` blended as the paper: every ray, stored values, eq. 5"),
    ("search-T1-full", ("search", "--rays full --iterations 1"),
     "the paper's search, blended as the default: linear light, no eq. 5"),
    ("search-T2", ("search", "--rays 64 --iterations 2"), "`search`, two tests, 64 rays"),
    ("raytrace-full", ("raytrace", "--rays full"), "`raytrace`, every ray"),
]


def quality():
    """Scores of the first table, the means of the views: run -> PSNR, edges, SSIM."""
    text = (SOURCE / "tests" / "quality.md").read_text(encoding="utf-8")
    table = text.split("## Methods")[1].split("\n\n")[1]
    return {cells(line)[0].strip("`"): cells(line)[2:5] for line in table.splitlines()[2:]}


def times():
    """(method, options, threads) -> best ms; and the line that names the machine."""
    page = (SOURCE / "tests" / "performance.md").read_text(encoding="utf-8")
    lines = page.split("<!-- /methods -->")[0].splitlines()
    found = {}
    for line in lines:
        row = cells(line)
        if line.startswith("| `"):
            found[row[0].strip("`"), row[1], int(row[2])] = row[6]
    for line in page.split("## Qualities")[1].split("\n<!--")[0].splitlines():
        row = cells(line)
        if line.startswith("| portrait | 720x540 |"):
            found["quality", row[3], 1], found["quality", row[3], 2] = row[7:9]
    machine = next(line for line in lines if "logical processors" in line)
    return found, machine


def main():
    scores, (best, machine) = quality(), times()
    out = ["| | PSNR, dB | near depth edges | SSIM | ms, 1 thread | ms, 2 threads |",
           "| --- | --- | --- | --- | --- | --- |"]
    for run, timed, words in ROWS:
        if run not in scores:
            continue
        ms = [best.get((timed[0], timed[1], n), "") if timed else "" for n in (1, 2)]
        out.append("| " + " | ".join([words] + scores[run] + ms) + " |")
    block = "\n".join(out) + f"\n\n720x540, K = 20; whole frames of the portrait, the best of 20 and more: {machine}.\n"
    readme = SOURCE / "README.md"
    text = readme.read_text(encoding="utf-8")
    new = re.sub(r"(<!-- measured:.*?-->\n).*?(<!-- /measured -->)",
                  lambda m: m.group(1) + block + m.group(2), text, flags=re.S)
    if "--check" not in sys.argv:
        readme.write_text(new, encoding="utf-8")
    elif new != text:
        sys.exit("README.md: its table is not of tests/quality.md and tests/performance.md: "
                 "tests/pages.sh BUILD readme")


if __name__ == "__main__":
    main()
