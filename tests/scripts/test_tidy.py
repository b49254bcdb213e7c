#!/usr/bin/env python3
"""clang-tidy has no finding in the core, in platform and in the examples; .clang-tidy has its checks.

usage: test_tidy.py BUILD   (BUILD has compile_commands.json; exit 77: there is no clang-tidy)
"""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ('src', 'platform', 'examples')
AT_ONCE = 8  # files that one process looks at
SKIPPED = 77


def files(build):
    """Those of the build that are ours, each once."""
    found = set()
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        path = (pathlib.Path(entry['directory']) / entry['file']).resolve()
        if any(TOP / folder in path.parents for folder in FOLDERS):
            found.add(path)
    return sorted(found)


def look(program, build, part):
    done = subprocess.run([program, '-p', build, '--quiet', *part], capture_output=True,
                          text=True, check=False)
    return done.stdout if done.returncode else ''


def main():
    program = shutil.which('clang-tidy-14') or shutil.which('clang-tidy')
    if not program:
        print('no clang-tidy')
        return SKIPPED
    build = pathlib.Path(sys.argv[1]).resolve()
    all_files = files(build)
    if not all_files:
        print(f'{build} names no file of ours')
        return 1
    parts = [all_files[i:i + AT_ONCE] for i in range(0, len(all_files), AT_ONCE)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(lambda part: look(program, build, part), parts) if text]
    print(''.join(found))
    print(f'{len(all_files)} files, {len(found)} groups of them with findings')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
