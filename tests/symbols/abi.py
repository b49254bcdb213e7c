#!/usr/bin/env python3
"""Holds the ABI of the last release (until there is one: of 0.2 as it is kept): what programs were
compiled against has to stay.

    abi.py SOURCE LIBRARY.so WORK_FOLDER COMPILER...    checks; 77 when there is no abidiff
    abi.py --renew SOURCE COMPILER...                   after a release: keeps its headers

The ABI that is kept is that of the headers in tests/symbols/abi-VERSION, without their comments.
Both they and the present ones are compiled into a library of nothing but their types, which
abidiff compares: fields at the end of a struct that begins with struct_size, new functions and new
enumerators may come, and nothing else. Each function of the release has to be in LIBRARY.so.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77
# Structs that may grow are compared field by field.
SUPPRESSED = """[suppress_type]
  type_kind = struct
  name_regexp = ^({})$
"""


def kept(source):
    """The folder of the last release's headers."""
    return sorted((source / "tests/symbols").glob("abi-*"))[-1]


def text_of(include):
    """All public headers of the core without comments."""
    headers = sorted((include / "refocus").glob("*.h"))
    return "".join(re.sub(r"/\*.*?\*/", "", h.read_text(), flags=re.S) for h in headers)


def functions_of(include):
    return sorted(set(re.findall(r"REFOCUS_API[^;{]*?\b(refocus_\w+)\(", text_of(include))))


def structs_of(include):
    """All but refocus_settings, which grows with its parts and which the library never sees."""
    return sorted(set(re.findall(r"^struct (\w+) \{", text_of(include), flags=re.M)) -
                  {"refocus_settings"})


def sized(include):
    """Structs that may grow, and the names of their fields."""
    found = re.findall(r"^struct (\w+) \{(\s*uint32_t struct_size;.*?)^\};", text_of(include),
                       flags=re.M | re.S)
    return {name: re.findall(r"(\w+)(?:\[[^;]*?\])?\s*(?=[,;])", body) for name, body in found
            if name != "refocus_settings"}


def compile_types(include, release, work, name, compiler):
    """A library with a variable for each type of the release that its headers have."""
    lines = ["#include <refocus/refocus.h>"]
    lines += [f"struct {s} *keep_{s};" for s in structs_of(release)]
    lines += [f"enum {e} *keep_enum_{e};" for e in
              sorted(set(re.findall(r"^enum (\w+) \{", text_of(release), flags=re.M)))]
    lines += [f"__typeof__({f}) *keep_{f} = {f};" for f in functions_of(release)]
    for struct, fields in sized(release).items():
        for field in fields:
            lines += [f"__typeof__(((struct {struct} *)0)->{field}) *type_{struct}_{field};",
                      f"char place_{struct}_{field}[1 + offsetof(struct {struct}, {field})];"]
    (work / f"{name}.c").write_text("\n".join(lines) + "\n")
    library = work / f"{name}.so"
    subprocess.run([*compiler, "-g", "-gdwarf-4", "-O0", "-shared", "-fPIC", "-Wl,-z,lazy",
                    f"-I{include}", "-o", library, work / f"{name}.c"], check=True)
    return library


def check(source, library, work, compiler):
    if not shutil.which("abidiff"):
        print("SKIPPED: no abidiff, which is in abigail-tools")
        return SKIPPED
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    release = kept(source)
    nm = subprocess.run(["nm", "-D", "--defined-only", library], check=True, text=True,
                        capture_output=True).stdout
    exported = {line.split()[-1].split("@")[0] for line in nm.splitlines()}
    missing = [f for f in functions_of(release) if f not in exported
               and f != "refocus_papers"]  # a library of its own has that one
    for name in missing:
        print(f"{release.name}: {name}() is no longer there")
    (work / "suppressed").write_text(SUPPRESSED.format("|".join(sized(release))))
    before = compile_types(release, release, work, "release", compiler)
    now = compile_types(source / "include", release, work, "present", compiler)
    result = subprocess.run(["abidiff", "--suppr", work / "suppressed", "--no-added-syms",
                             "--no-show-locs", before, now], text=True, capture_output=True)
    print(result.stdout + result.stderr, end="")
    print(f"{release.name}: {len(functions_of(release))} functions, {len(structs_of(release))} "
          f"structs, abidiff {result.returncode}, {len(missing)} missing")
    return 1 if missing or result.returncode else 0


def renew(source, compiler):
    version = re.search(r'VERSION_STRING "(\d+\.\d+)', (source / "include/refocus/version.h")
                        .read_text()).group(1)
    folder = source / f"tests/symbols/abi-{version}"
    for old in (source / "tests/symbols").glob("abi-*"):
        shutil.rmtree(old)
    (folder / "refocus").mkdir(parents=True)
    for header in sorted((source / "include/refocus").glob("*.h")):
        bare = subprocess.run([*compiler, "-fpreprocessed", "-dD", "-E", "-P", header], check=True,
                              text=True, capture_output=True).stdout
        to = folder / "refocus" / header.name
        to.write_text(f"/* {header.name}: that of librefocus {version}, without its comments; made "
                      f"by tests/symbols/abi.py. */\n{bare}")
        subprocess.run(["clang-format", "-i", to], check=True)
    return 0


if __name__ == "__main__":
    if sys.argv[1] == "--renew":
        sys.exit(renew(Path(sys.argv[2]), sys.argv[3:]))
    sys.exit(check(Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]))
