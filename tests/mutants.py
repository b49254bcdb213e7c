#!/usr/bin/env python3
"""Seeds faults in the core and the parsers, and reports those that no test notices.

usage: tests/mutants.py DIR [--count N] [--seed N] [--minutes N] [--only TEXT] [--report]

DIR       a folder of its own, made if need be: a copy of the sources, their build, and log.tsv
--count   faults to judge in all, those in the log included (300)
--seed    which faults are chosen (1); the same seed goes on where the log ends
--minutes ends after so long; the next run goes on
--only    files whose path has this text
--report  tells what the log has, and judges nothing

A fault is one operator, bound, constant, condition or call of a file (tests/faults.py). The tests of
that file run on it, fast ones first, until one fails. `caught`: a test fails or takes 5 s and ten times
longer than without the fault. `lives`: all pass. Neither counts: `same` is compiled to the same bytes,
`unbuilt` does not compile. `tests/mutants.txt` explains faults that live and change nothing; the exit
code is 1 when others live. The sources are not touched: faults are seeded in the copy.
"""
import argparse
import collections
import json
import os
import pathlib
import platform
import re
import resource
import signal
import subprocess
import sys
import time

import faults

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXPLAINED = ROOT / 'tests' / 'mutants.txt'
OPTIONS = ['-Dbuildtype=release', '-Doptimization=1', '-Dauto_features=disabled', '-Dexamples=false',
           '-Dtests=enabled', '-Dtools=enabled', '-Dsimd=enabled', '-Djpeg=enabled', '-Dpng=enabled',
           '-Dxmp=enabled']
if platform.machine() == 'x86_64':  # one set of vector kernels: their source is the same for all
    OPTIONS += ['-Dsimd_sets=avx2']
# Sources by pattern, and the tests that concern them; the first that fits counts.
AREAS = [
    (r'src/papers/.*\.c', r'papers-.*'),
    (r'src/kernels/.*\.c', r'check-kernels|digest|render-(yuv|deep|thin|texture)|depth_edges.*'),
    (r'src/(depth|edges|focus|focus_stack|optics)/.*\.c',
     r'aperture|depth.*|dequantise|focus.*|lens|mixed_pixels|noise|place_edges|strays|temporal|upsample|'
     r'sized|misuse|digest|render-(focus|optics)|stack.*|fuzz-core.*'),
    (r'src/(?!tables).*\.c',
     r'aperture|corners|depth|slabs|pool|thread-faults|sized|misuse|digest|render-(?!parallel|deep_yuv).*|'
     r'fuzz-core.*'),
    (r'platform/file/.*\.c', r'file-(?!symbols).*|fuzz-file-.*|misuse'),
    (r'platform/strokes/.*\.c', r'strokes.*|fuzz-strokes|misuse'),
    (r'platform/capture/.*\.c', r'capture-.*|fuzz-capture-.*'),
]
MEMORY = 4 << 30  # bytes of address space a test may take
MOST_SECONDS = 30  # tests that are slower without a fault are left out


def run(args, **more):
    return subprocess.run(args, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more)


class Bench:
    """A copy of the sources with its build, and the tests that can be run in it."""

    def __init__(self, folder):
        self.folder = folder
        self.tree, self.build = folder / 'tree', folder / 'build'
        self.copy()
        if not (self.build / 'build.ninja').exists():
            subprocess.run(['meson', 'setup', self.build, self.tree, *OPTIONS], check=True)
        self.ninja = ['ninja', '-C', str(self.build), '-j', str(os.cpu_count())]
        subprocess.run(self.ninja + ['build.ninja'], check=True)  # tests may be new
        made = {one['id']: [os.path.relpath(name, self.build) for name in one['filename']]
                for one in self.introspect('targets')}
        self.tests = {}
        for test in self.introspect('tests'):
            targets = [name for one in test['depends'] for name in made.get(one, [])]
            self.tests.setdefault(test['name'], dict(test, targets=targets))
        concerned = [test for test in self.tests.values()
                     if any(re.fullmatch(names, test['name']) for _, names in AREAS)]
        subprocess.run(self.ninja + sorted({name for test in concerned for name in test['targets']}),
                       check=True)
        self.objects = collections.defaultdict(list)
        for one in json.loads((self.build / 'compile_commands.json').read_text()):
            path = (self.build / one['file']).resolve()
            if path.is_relative_to(self.tree.resolve()):
                self.objects[str(path.relative_to(self.tree.resolve()))].append(one['output'])
        self.seconds_file = folder / 'seconds.json'
        self.seconds = json.loads(self.seconds_file.read_text()) if self.seconds_file.exists() else {}

    def introspect(self, what):
        return json.loads(subprocess.check_output(['meson', 'introspect', '--' + what, self.build]))

    def copy(self):
        """Brings the copy to the sources' state, an interrupted run's fault undone."""
        names = subprocess.check_output(['git', 'ls-files', '-z', '-co', '--exclude-standard'],
                                        cwd=ROOT).decode().split('\0')
        for name in filter(None, names):
            here, there = ROOT / name, self.tree / name
            if not here.is_file():
                continue
            data = here.read_bytes()
            if not there.exists() or there.read_bytes() != data:
                there.parent.mkdir(parents=True, exist_ok=True)
                there.write_bytes(data)
                there.chmod(here.stat().st_mode)

    def make(self, targets):
        return run(self.ninja + targets).returncode == 0

    def run_test(self, name, limit):
        """Seconds a test takes, or None: it fails or takes too long."""
        test = self.tests[name]
        began = time.monotonic()
        child = subprocess.Popen(
            test['cmd'], cwd=test['workdir'] or self.build, env={**os.environ, **test['env']},
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
        try:
            code = child.wait(timeout=limit)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            try:
                os.killpg(child.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            child.wait()
        return time.monotonic() - began if code in (0, 77) else None

    def tests_of(self, path):
        """Names of the tests that concern a file: those with its name first, then the fast ones."""
        names = next((tests for files, tests in AREAS if re.fullmatch(files, path)), None)
        if names is None:
            return []
        stem = pathlib.Path(path).stem.replace('_vec', '')
        concerned = []
        for name in sorted(self.tests):
            if not re.fullmatch(names, name):
                continue
            if name not in self.seconds:
                self.seconds[name] = self.run_test(name, 2 * MOST_SECONDS)
                self.seconds_file.write_text(json.dumps(self.seconds, indent=1))
                if self.seconds[name] is None:
                    print(f'{name} fails without a fault: left out', flush=True)
            if self.seconds[name] is not None and self.seconds[name] < MOST_SECONDS:
                concerned.append(name)
        return sorted(concerned, key=lambda name: (stem not in name, self.seconds[name]))

    def judge(self, path, source, fault):
        """(state, test that failed)."""
        names = self.tests_of(path)
        objects = self.objects[path]
        file = self.tree / path
        try:
            self.make(objects)
            before = [(self.build / one).read_bytes() for one in objects]
            file.write_text(faults.changed(source, fault))
            if not objects or not self.make(objects):
                return 'unbuilt', ''
            if [(self.build / one).read_bytes() for one in objects] == before:
                return 'same', ''
            for name in names:
                if not self.make(self.tests[name]['targets']):
                    return 'caught', 'build of ' + name
                if self.run_test(name, 5 + 10 * self.seconds[name]) is None:
                    return 'caught', name
            return ('lives' if names else 'unbuilt'), ''
        finally:
            file.write_text(source)


def explained():
    """{(path, line before, line after): reason}, from blocks of tests/mutants.txt."""
    reasons = {}
    if EXPLAINED.exists():
        for block in EXPLAINED.read_text().split('\n\n'):
            lines = block.strip().splitlines()
            if len(lines) >= 4 and lines[1].startswith('- ') and lines[2].startswith('+ '):
                reasons[lines[0], lines[1][2:], lines[2][2:]] = ' '.join(lines[3:])
    return reasons


def read_log(path):
    """Rows of (state, path:line, kind, before, after, test, seconds)."""
    if not path.exists():
        return []
    rows = [line.split('\t') for line in path.read_text().splitlines()]
    return [row for row in rows if len(row) == 7]


def report(rows):
    """Tells what lives; 1 when a fault does that is not explained."""
    reasons, unexplained = explained(), 0
    states = collections.Counter(row[0] for row in rows)
    for state, place, kind, before, after, _, _ in rows:
        if state == 'lives':
            reason = reasons.get((place.rsplit(':', 1)[0], before, after))
            unexplained += reason is None
            print(f'{place}: {kind}\n- {before}\n+ {after}\n{reason or "LIVES"}\n')
    judged = states['caught'] + states['lives']
    print(f'{judged} faults judged: {states["caught"]} caught, {states["lives"]} live, '
          f'{states["lives"] - unexplained} of them explained; '
          f'{states["same"]} same code, {states["unbuilt"]} not built')
    return 1 if unexplained else 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split('usage: ')[1].split('\n')[0],
                                     description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('dir', type=pathlib.Path)
    parser.add_argument('--count', type=int, default=300)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--minutes', type=float)
    parser.add_argument('--only', default='')
    parser.add_argument('--report', action='store_true')
    asked = parser.parse_args()
    log = asked.dir / 'log.tsv'
    if asked.report:
        return report(read_log(log))
    asked.dir.mkdir(parents=True, exist_ok=True)
    bench = Bench(asked.dir.resolve())
    until = time.monotonic() + 60 * asked.minutes if asked.minutes else None
    sources = {path: (ROOT / path).read_text() for path in bench.objects
               if asked.only in path and any(re.fullmatch(files, path) for files, _ in AREAS)}
    rows = read_log(log)
    known = {(row[1], row[3], row[4]) for row in rows}
    count = sum(row[0] in ('caught', 'lives') for row in rows)
    for path, fault in faults.chosen(sources, asked.seed):
        if count >= asked.count or until and time.monotonic() > until:
            break
        source = sources[path]
        place = f'{path}:{faults.line_of(source, fault)}'
        before, after = faults.lines_changed(source, fault)
        if (place, before, after) in known:
            continue
        began = time.monotonic()
        state, test = bench.judge(path, source, fault)
        count += state in ('caught', 'lives')
        row = [state, place, fault.kind, before, after, test, f'{time.monotonic() - began:.1f}']
        print('  '.join(row), flush=True)
        with log.open('a') as file:
            file.write('\t'.join(row) + '\n')
    return report(read_log(log))


if __name__ == '__main__':
    sys.exit(main())
