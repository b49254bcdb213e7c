#!/usr/bin/env python3
"""Prints what has to be built for some of the tests of a build folder.

usage: needed.py FOLDER SUITE...    a SUITE that begins with '-' is one to leave out

One line for each file, as ninja takes it. Modules that programs load while they run are always
among them, as no test names them.
"""
import json
import os
import subprocess
import sys


def introspect(folder, what):
    return json.loads(subprocess.check_output(["meson", "introspect", what, folder]))


def main():
    folder = sys.argv[1]
    wanted = {word for word in sys.argv[2:] if not word.startswith("-")}
    unwanted = {word[1:] for word in sys.argv[2:] if word.startswith("-")}
    needed = set()
    for test in introspect(folder, "--tests"):
        suites = {suite.split(":")[-1] for suite in test["suite"]}
        if (not wanted or suites & wanted) and not suites & unwanted:
            needed.update(test["depends"])
    for target in introspect(folder, "--targets"):
        if target["id"] in needed or target["type"] == "shared module":
            for name in target["filename"]:
                print(os.path.relpath(name, folder))


if __name__ == "__main__":
    main()
