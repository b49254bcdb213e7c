#!/usr/bin/env python3
"""Lets fuzz targets search, one after another on one processor, and logs each run.

usage: tests/fuzz_runs.py BUILD DIR [--seconds N] [--only TEXT] [--page]

BUILD      a build folder of -Dfuzz=true (tests/fuzz/meson.build)
DIR        inputs that were found, a folder for each target, and runs.tsv, one line for each run
--seconds  how long each target searches (60)
--only     targets whose name has this text
--page     prints the table of tests/fuzz.md from DIR/runs.tsv, and searches nothing

The exit code is 1 when an input ends a target; it is in DIR then.
"""
import argparse
import collections
import json
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUPPRESSED = ROOT / 'tests' / 'lsan.supp'  # leaks of others' libraries


def corpora(build):
    """{target: folder of its seeds}, as the tests of the build have them."""
    tests = json.loads(subprocess.check_output(['meson', 'introspect', '--tests', build]))
    return {test['name'][5:]: test['cmd'][1] for test in tests if test['name'].startswith('fuzz-')}


def search(build, name, seeds, folder, seconds):
    """(executions, features covered, whether an input ended it)"""
    (folder / name).mkdir(parents=True, exist_ok=True)
    before = set(folder.iterdir())
    log = folder / (name + '.log')
    # How often a loop over pixels is run says nothing, and makes inputs interesting that are not.
    loops = ['-use_counters=0'] if name.startswith('core') else []
    env = {**os.environ, 'LSAN_OPTIONS': f'suppressions={SUPPRESSED}:print_suppressions=0'}
    if name == 'file-photo':  # leaks below libraries without frame pointers, see SUPPRESSED
        env['ASAN_OPTIONS'] = 'fast_unwind_on_malloc=0'
    with log.open('w') as file:
        code = subprocess.run(
            [build.resolve() / 'tests' / 'fuzz' / ('fuzz-' + name), f'-max_total_time={seconds}',
             '-print_final_stats=1', '-rss_limit_mb=2048', '-timeout=20', *loops, name, seeds],
            env=env, cwd=folder, stdout=file, stderr=subprocess.STDOUT).returncode
    text = log.read_text(errors='replace')
    executions = re.findall(r'number_of_executed_units: (\d+)', text)
    covered = re.findall(r' cov: (\d+)', text)
    for found in sorted(set(folder.iterdir()) - before - {log}):
        print(f'{name}: {found}', flush=True)
    return int(executions[-1]) if executions else 0, int(covered[-1]) if covered else 0, code != 0


def page(runs):
    """Rows of the table: all runs of each target together."""
    sums = collections.defaultdict(lambda: [0, 0, 0, 0])
    for line in runs.read_text().splitlines():
        _, _, name, executions, seconds, covered, found = line.split('\t')
        mine = sums[name]
        mine[0] += int(executions)
        mine[1] += float(seconds)
        mine[2] = int(covered)
        mine[3] += int(found)
    print('| target | executions | share of 10⁸ | a second | edges covered | findings |')
    print('| --- | ---: | ---: | ---: | ---: | ---: |')
    for name, (executions, seconds, covered, found) in sorted(sums.items()):
        print(f'| {name} | {executions:,} | {executions / 1e6:.3g} % | {executions / seconds:,.0f} | '
              f'{covered:,} | {found} |')


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split('usage: ')[1].split('\n')[0],
                                     description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', type=pathlib.Path)
    parser.add_argument('dir', type=pathlib.Path)
    parser.add_argument('--seconds', type=int, default=60)
    parser.add_argument('--only', default='')
    parser.add_argument('--page', action='store_true')
    asked = parser.parse_args()
    runs = asked.dir / 'runs.tsv'
    if asked.page:
        page(runs)
        return 0
    commit = subprocess.check_output(['git', 'rev-parse', '--short', 'HEAD'], cwd=ROOT).decode().strip()
    any_found = False
    for name, seeds in sorted(corpora(asked.build).items()):
        if asked.only not in name:
            continue
        began = time.monotonic()
        executions, covered, found = search(asked.build, name, seeds, asked.dir, asked.seconds)
        seconds = time.monotonic() - began
        any_found |= found
        with runs.open('a') as file:
            file.write(f'{time.strftime("%Y-%m-%d")}\t{commit}\t{name}\t{executions}\t{seconds:.1f}\t'
                       f'{covered}\t{found:d}\n')
        print(f'{name}: {executions:,} executions, {executions / seconds:,.0f} a second, '
              f'{covered:,} edges{", FOUND SOMETHING" if found else ""}', flush=True)
    return 1 if any_found else 0


if __name__ == '__main__':
    sys.exit(main())
