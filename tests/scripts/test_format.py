#!/usr/bin/env python3
"""Every C and C++ file of the tree is as .clang-format says.

usage: test_format.py   (exit 77: there is no clang-format 14, or this is no git checkout)
"""
import pathlib
import re
import shutil
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77


def clang_format():
    """The program, of the version whose output the tree has."""
    for name in ('clang-format-14', 'clang-format'):
        path = shutil.which(name)
        if path and re.search(r'version 14\.', subprocess.run(
                [path, '--version'], capture_output=True, text=True, check=True).stdout):
            return path
    print('no clang-format 14')
    sys.exit(SKIPPED)


def sources():
    listed = subprocess.run(['git', '-C', TOP, 'ls-files', '*.c', '*.h', '*.cpp', '*.hpp'],
                            capture_output=True, text=True, check=False)
    if listed.returncode:
        print('no git checkout')
        sys.exit(SKIPPED)
    return [TOP / name for name in listed.stdout.split() if (TOP / name).exists()]


def main():
    program, files = clang_format(), sources()
    checked = subprocess.run([program, '--dry-run', '-Werror', '--ferror-limit=3', *files],
                             capture_output=True, text=True, check=False)
    if checked.returncode:
        print(checked.stderr)
        print('Repair with: git ls-files "*.c" "*.h" "*.?pp" | xargs clang-format-14 -i')
        return 1
    print(f'{len(files)} files are as .clang-format says')
    return 0


if __name__ == '__main__':
    sys.exit(main())
