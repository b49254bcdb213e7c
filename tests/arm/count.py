#!/usr/bin/env python3
"""Counts the instructions of whole frames on AArch64 and ARMv7 and estimates their cycles.

usage: count.py [--build FOLDER] [--quick] [--search] [--stack] [--out tests/performance.md]

Cross-builds the core, renders under qemu-user with a plugin that counts blocks (plugin.c), and
takes the difference between two runs that differ by whole frames: counts are exact and the
same each time. Blocks of AArch64 go through llvm-mca's models of cores. Needs, from Debian 12:
meson ninja-build gcc qemu-user gcc-aarch64-linux-gnu gcc-arm-linux-gnueabihf llvm-19.
"""
import argparse
import bisect
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests"))
sys.path.insert(0, str(SOURCE / "tests" / "cli"))
import pictures  # noqa: E402
import sections  # noqa: E402

# triple, emulator, the processor it is to be
ARCHES = {"aarch64": ("aarch64-linux-gnu", "qemu-aarch64", "cortex-a76"),
          "armv7": ("arm-linux-gnueabihf", "qemu-arm", "cortex-a15")}
# LLVM has no schedule of the A76; the Neoverse N1 is the same core. Its A72 is the A57's.
CORES = {"A53": "cortex-a53", "A55": "cortex-a55", "A72": "cortex-a72", "A76": "neoverse-n1"}
SIZES = [(720, 540), (1280, 720), (1920, 1080)]
BLUR = 20
# beside each other: name, rays, tests of the search (0: sweep), sigma (0: linear light, no eq. 5)
METHODS = [("`sweep`", 64, 0, 0), ("`sweep`", 64, 0, 128), ("`search`", 64, 1, 0),
           ("`search`", 64, 1, 128), ("`search`", 64, 2, 0), ("`search`", 64, 2, 128),
           ("`search`", -1, 1, 0), ("`search`", -1, 1, 128)]
STACKS = [2, 9]  # frames
# what four cores are to reach: size, core, frames a second, a usual clock in MHz
TARGETS = [((1920, 1080), "A76", 30, 2400), ((1280, 720), "A72", 30, 1800),
           ((720, 540), "A53", 15, 1400), ((720, 540), "A55", 15, 1800)]


def run(*command, **options):
    return subprocess.run([str(c) for c in command], check=True, text=True,
                          stdout=subprocess.PIPE, **options).stdout


def scene_file(path):
    """examples/data/portrait as frame.c reads it."""
    data = SOURCE / "examples" / "data" / "portrait"
    width, height, _, _, rgb = pictures.read_png(data / "allfocus.png")
    _, _, bits, _, depth = pictures.read_png(data / "disparity.png")
    assert bits == 16
    with open(path, "wb") as out:
        out.write(struct.pack("<II", width, height) + b"".join(rgb))
        for row in depth:  # big-endian in PNG
            swapped = bytearray(row)
            swapped[0::2], swapped[1::2] = row[1::2], row[0::2]
            out.write(swapped)


def build(folder, arch):
    triple = ARCHES[arch][0]
    where = folder / arch
    if not (where / "build.ninja").exists():
        run("meson", "setup", where, SOURCE, "--buildtype=release", "--cross-file",
            SOURCE / "tests" / "cross" / f"{arch}.ini", "-Dauto_features=disabled",
            "-Dsimd=enabled", "-Dtests=disabled", "-Dexamples=false")
    run("ninja", "-C", where, "src/librefocus.a")
    for program in ("frame", "stack"):
        run(f"{triple}-gcc", "-std=c11", "-O2", "-static", "-no-pie", f"-I{SOURCE / 'include'}",
            "-o", where / program, SOURCE / "tests" / "arm" / f"{program}.c",
            where / "src" / "librefocus.a", "-lm", "-lpthread")
    return where / "frame"


class Counter:
    """Blocks that a program runs: {(address, bytes): (instructions, runs)}."""

    def __init__(self, folder, scene):
        self.folder, self.scene = folder, scene
        self.plugin = folder / "plugin.so"
        run("cc", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-o", self.plugin,
            SOURCE / "tests" / "arm" / "plugin.c")

    def blocks(self, arch, program, *args):
        out = self.folder / "blocks"
        run(ARCHES[arch][1], "-cpu", ARCHES[arch][2], "-plugin", f"{self.plugin},out={out}", program, self.scene, *args)
        found = {}
        for line in out.read_text().splitlines():
            address, size, instructions, runs = line.split()
            key = int(address, 16), int(size)
            found[key] = int(instructions), found.get(key, (0, 0))[1] + int(runs)
        return found

    def render(self, arch, program, size, rays, tests, sigma):
        """Blocks of rendering a photo once more."""
        def of(renders):
            return self.blocks(arch, program, *size, BLUR, rays, 1, renders, "auto", tests, sigma)
        return difference(of(3), of(1), 2)

    def frame(self, arch, program, size, rays):
        """Blocks of a new photo, prepared and rendered, and of rendering it once more."""
        def of(photos, renders):
            return self.blocks(arch, program, *size, BLUR, rays, photos, renders)
        one = of(1, 1)
        return difference(of(2, 1), one, 1), difference(of(1, 3), one, 2)

    def stack(self, arch, program, size, frames):
        """Blocks of adding all frames to a new stack, and of finishing it."""
        def of(stacks, finished):
            return self.blocks(arch, program, *size, frames, stacks, finished)
        one = of(1, 0)
        return difference(of(2, 0), one, 1), difference(of(1, 1), one, 1)


def difference(more, less, frames):
    return {key: (n, (runs - less.get(key, (0, 0))[1]) / frames)
            for key, (n, runs) in more.items() if runs != less.get(key, (0, 0))[1]}


def total(blocks):
    return sum(n * runs for n, runs in blocks.values())


class Program:
    """Functions and instructions of an ELF file."""

    def __init__(self, arch, program):
        triple = ARCHES[arch][0]
        symbols = sorted((int(a, 16) & ~1, name) for a, kind, name in
                         (line.split() for line in run(f"{triple}-nm", program).splitlines()
                          if len(line.split()) == 3) if kind in "tTwWi" and name[0] != "$")
        self.starts, self.names = [a for a, _ in symbols], [n for _, n in symbols]
        self.text = {}
        if arch == "aarch64":
            for line in run(f"{triple}-objdump", "-d", "--no-show-raw-insn",
                            program).splitlines():
                found = re.match(r" *([0-9a-f]+):\t(.*)", line)
                if found:
                    self.text[int(found[1], 16)] = found[2]

    def function(self, address):
        name = self.names[bisect.bisect_right(self.starts, address) - 1]
        return re.sub(r"\.(constprop|part|isra|cold)\.\d+", "", name)

    def assembly(self, address, size):
        lines = []
        for at in range(address, address + size, 4):
            text = self.text[at].split("//")[0].strip()
            lines.append(re.sub(r"\b[0-9a-f]+ <[^>]*>", ".Lx", text))
        return lines


def model(program, blocks, mca):
    """{core: {key: cycles of one run}} for the blocks that make 99 % of the instructions."""
    want, most = 0.99 * total(blocks), []
    for key in sorted(blocks, key=lambda k: -blocks[k][0] * blocks[k][1]):
        if want <= 0:
            break
        most.append(key)
        want -= blocks[key][0] * blocks[key][1]
    source = [".Lx:"]
    for key in most:
        source += [f"# LLVM-MCA-BEGIN {key[0]:x}-{key[1]}"] + program.assembly(*key) + [
            "# LLVM-MCA-END"]
    cycles = {}
    for core, cpu in CORES.items():
        report = json.loads(run(mca, "-mtriple=aarch64-linux-gnu", f"-mcpu={cpu}",
                                "-iterations=100", "-json", input="\n".join(source) + "\n",
                                stderr=subprocess.DEVNULL))
        cycles[core] = {}
        for region in report["CodeRegions"]:
            address, size = region["Name"].split("-")
            view = region["SummaryView"]
            cycles[core][int(address, 16), int(size)] = view["TotalCycles"] / view["Iterations"]
    return cycles


def frame_cycles(blocks, cycles):
    """Cycles of a frame; what is not modelled takes as many an instruction as the rest."""
    known = sum(blocks[k][0] * blocks[k][1] for k in cycles)
    return sum(blocks[k][1] * c for k, c in cycles.items()) * total(blocks) / known


def where_it_goes(program, blocks, cycles, pixels, most):
    counted, taken = defaultdict(float), defaultdict(float)
    for key, (n, runs) in blocks.items():
        name = program.function(key[0])
        counted[name] += n * runs
        taken[name] += cycles.get(key, 0) * runs
    rows, all_taken = [], sum(taken.values())
    for name in sorted(counted, key=lambda n: -taken[n])[:most]:
        rows.append([f"`{name}`", f"{counted[name] / pixels:.1f}",
                     f"{counted[name] / total(blocks):.1%}", f"{taken[name] / all_taken:.1%}"])
    return rows


def report(counter, programs, mca, rays_list):
    counts, needs, goes = [], [], None
    for size in SIZES:
        pixels = size[0] * size[1]
        for rays in rays_list:
            for arch, program in programs.items():
                print(f"{arch} {size[0]}x{size[1]}, {rays} rays", file=sys.stderr)
                frame, render = counter.frame(arch, program, size, rays)
                row = [f"{size[0]}x{size[1]}", rays, arch,
                       f"{(total(frame) - total(render)) / pixels:.0f}",
                       f"{total(render) / pixels:.0f}"]
                if arch != "aarch64" or not mca:
                    counts.append(row + ["-"] * len(CORES))
                    continue
                elf = Program(arch, program)
                cycles = model(elf, frame, mca)
                whole = {core: frame_cycles(frame, cycles[core]) for core in CORES}
                counts.append(row + [f"{whole[core] / pixels:.0f}" for core in CORES])
                for wanted, core, fps, clock in TARGETS:
                    if wanted == size:
                        mhz = whole[core] * fps / 4 / 1e6
                        needs.append([f"{size[0]}x{size[1]}", rays, f"four {core}", fps,
                                      f"{mhz:.0f}", clock, "yes" if mhz <= clock else
                                      f"no: {fps * clock / mhz:.1f} frames a second"])
                if size == SIZES[-1] and rays == rays_list[0]:
                    goes = where_it_goes(elf, frame, cycles["A76"], pixels, 16)
    return counts, needs, goes


def search_report(counter, program):
    """The section of the search: instructions a pixel beside those of the sweep."""
    rows, pixels = [], SIZES[0][0] * SIZES[0][1]
    for method, rays, tests, sigma in METHODS:
        print(f"{method}, {rays} rays, T = {tests}, sigma {sigma}", file=sys.stderr)
        rows.append([method, "full" if rays < 0 else rays, tests or "-",
                     f"stored, sigma {sigma}" if sigma else "linear"] +
                    [f"{total(counter.render('aarch64', program, SIZES[0], rays, tests, sigma)) / pixels:.0f}"])
    return "\n".join([
        "## ARM: the search beside the sweep, instructions counted\n",
        f"examples/data/portrait, 720x540, K = {BLUR}, focus 0.689, NEON on AArch64, one thread, RGB "
        "in and out: what it takes to render a prepared photo anew, with another focus. The sweep "
        "splats highlights.\n",
        sections.table(["method", "rays", "tests", "light", "instructions a pixel"], rows)])


def stack_report(counter, programs, mca):
    """The section of focus stacks."""
    size = SIZES[0]
    pixels, rows, goes = size[0] * size[1], [], None
    for frames in STACKS:
        for arch, frame in programs.items():
            program = frame.parent / "stack"
            print(f"{arch}, a stack of {frames}", file=sys.stderr)
            added, finished = counter.stack(arch, program, size, frames)
            row = [frames, arch, f"{total(added) / pixels / frames:.0f}",
                   f"{total(finished) / pixels:.0f}"]
            if arch != "aarch64" or not mca:
                rows.append(row + ["-"] * len(CORES))
                continue
            elf = Program(arch, program)
            cycles = model(elf, finished, mca)
            rows.append(row + [f"{frame_cycles(finished, cycles[core]) / pixels:.0f}"
                               for core in CORES])
            if frames == STACKS[-1]:
                goes = where_it_goes(elf, finished, cycles["A76"], pixels, 12)
    text = ["## ARM: focus stacks, instructions counted\n",
            "examples/data/portrait, 720x540, frames that are rendered with K = 8, their focus even "
            "in disparity, one thread: `refocus_stack_add()` and `refocus_stack_finish()`, which "
            "makes depth and the photo. Cycles are estimated as above.\n",
            sections.table(["frames", "", "add, instructions a pixel and frame",
                            "finish, instructions a pixel"] +
                           [f"{core}, cycles a pixel, finish" for core in CORES], rows)]
    if goes:
        text += [f"Where it goes, {STACKS[-1]} frames, AArch64:\n",
                 sections.table(["function", "instructions a pixel", "of the instructions",
                                 "of the A76's cycles"], goes)]
    return "\n".join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=Path, help="folder that is kept; default a new one")
    parser.add_argument("--quick", action="store_true", help="720x540 and 32 rays alone")
    parser.add_argument("--search", action="store_true", help="the section of the search alone")
    parser.add_argument("--stack", action="store_true", help="the section of focus stacks alone")
    parser.add_argument("--out", type=Path, default=SOURCE / "tests" / "performance.md")
    args = parser.parse_args()
    tools = ["meson", "ninja", "cc"] + [t for triple, qemu, _ in ARCHES.values()
                                        for t in (f"{triple}-gcc", qemu)]
    missing = [tool for tool in tools if not shutil.which(tool)]
    if missing:
        sys.exit(f"count.py: SKIPPED: {', '.join(missing)} missing; see --help")
    mca = next((m for m in ("llvm-mca-19", "llvm-mca-18", "llvm-mca-17") if shutil.which(m)), None)
    if not mca:
        print("count.py: NO llvm-mca 17 or newer: no cycles, counts alone", file=sys.stderr)
    if args.quick:
        del SIZES[1:]
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.build.resolve() if args.build else Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        scene_file(folder / "scene")
        counter = Counter(folder, folder / "scene")
        programs = {arch: build(folder, arch) for arch in (["aarch64"] if args.search else ARCHES)}
        if not args.search:
            sections.put(args.out, "arm-stack", "tests/arm/count.py",
                         stack_report(counter, programs, mca))
        if args.stack:
            return
        sections.put(args.out, "arm-search", "tests/arm/count.py",
                     search_report(counter, programs["aarch64"]))
        if args.search:
            return
        counts, needs, goes = report(counter, programs, mca, [32] if args.quick else [32, 64])
    text = ["## ARM: instructions counted, cycles estimated\n",
            f"examples/data/portrait brought to each size by repeating pixels, K = {BLUR}, `sweep`, "
            "focus 0.689, NEON, "
            "one thread, RGB in and out, highlights splatted with a gain of 4. Instructions are counted exactly, under "
            "emulation. Cycles are an ESTIMATE that no ARM machine has confirmed: LLVM's models of the cores (the "
            "A57's schedule stands for the A72, the Neoverse N1's for the A76), each block in "
            "a loop of its own, all data in the first-level cache, no branch mispredicted. They are "
            "lower bounds, and may be 30 % off.\n",
            sections.table(["size", "rays", "", "prepare and highlights, instructions a pixel",
                            "render, instructions a pixel"] +
                           [f"{core}, cycles a pixel, both" for core in CORES], counts)]
    if needs:
        text += ["What four cores need, if they share the work evenly; a new photo each frame:\n",
                 sections.table(["size", "rays", "cores", "frames a second wanted",
                                 "MHz needed, estimated", "usual MHz", "enough"], needs)]
    if goes:
        text += [f"Where it goes, {SIZES[-1][0]}x{SIZES[-1][1]}, 32 rays, AArch64:\n",
                 sections.table(["function", "instructions a pixel", "of the instructions",
                                 "of the A76's cycles"], goes)]
    sections.put(args.out, "arm", "tests/arm/count.py", "\n".join(text))
    print(f"wrote {args.out}", file=sys.stderr)


if __name__ == "__main__":
    main()
