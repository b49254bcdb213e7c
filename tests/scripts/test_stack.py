#!/usr/bin/env python3
"""The most stack that a call into the core takes, from the compiler's own figures.

usage: test_stack.py LIBRARY FOLDER [--list]   (the shared library, and where its .su files are)

The compiler notes the frame of each function (-fstack-usage), the disassembled library says who calls
whom. Where calls by pointer lead is read from the source: to the kernels and to the work of pools that
a file names, and to the operations of shapes; CALLBACKS has the rest. What libc takes is not counted; the tests small-stack-* of
tests/render run the core on threads of 64 KiB.
"""
import collections
import pathlib
import re
import subprocess
import sys

SRC = pathlib.Path(__file__).resolve().parent.parent.parent / 'src'
LIMIT = 16384  # bytes a chain of calls
RETURN = 8     # bytes of an address to return to
SETS = ('c', 'sse41', 'avx2', 'avx512', 'neon')
# Functions that are passed to others, by the caller.
CALLBACKS = {'tile_item': ['rf_sweep_tile', 'rf_sweep_yuv_tile', 'rf_search_tile',
                           'rf_search_yuv_tile'],
             'rf_run_strips': ['run_tiles']}


def frames(folder):
    """Bytes of the largest frame of each name, and its files; static functions may share a name."""
    sizes, files = collections.defaultdict(int), collections.defaultdict(set)
    for path in pathlib.Path(folder).rglob('*.su'):
        for line in path.read_text().splitlines():
            place, size, kind = line.split('\t')
            name = place.split(':')[-1]
            source = SRC / place.split(':')[0].split('src/', 1)[1]
            # What a build left of a source that is gone since is in no library.
            if '/papers/' in place or not source.exists():
                continue
            if kind == 'dynamic':
                sys.exit(f'{place}: the size of its frame is not known')
            sizes[name] = max(sizes[name], int(size))
            files[name].add(source)
    return sizes, files


def operations():
    """The operations of shapes of apertures, by their member."""
    found = collections.defaultdict(set)
    for path in (SRC / 'aperture').glob('*.c'):
        for member, name in re.findall(r'\.(open|rays|corners|corner) = (\w+)', path.read_text()):
            found[member].add(name)
    return found


def calls(library):
    """The functions of a library by address: name, addresses that it calls, whether by pointer too."""
    text = subprocess.run(['objdump', '-d', '--no-show-raw-insn', library], check=True,
                          capture_output=True, text=True).stdout
    functions, current = {}, None
    for line in text.splitlines():
        if (head := re.match(r'([0-9a-f]+) <([^>]+)>:', line)):
            current = functions[head[1].lstrip('0')] = {'name': head[2], 'calls': set(), 'pointer': False}
        elif (to := re.search(r'\t(?:callq?|jmpq?|b|bl|blx)\s+([0-9a-f]+) <[^>+]+>', line)):
            current['calls'].add(to[1])
        elif re.search(r'\t(?:callq?|jmpq?|blr|br)\s+(?:\*|x\d)', line):
            current['pointer'] = True
    return functions


def named(path, seen={}):
    """The kernels and operations that a source file calls, and its functions that a pool can run."""
    if path not in seen:
        text = path.read_text()
        kernels = re.findall(r'\bkernels(?:->|\.)(\w+)', text)
        work = re.findall(r'^static void (\w+)\(void \*\w+,\s*int \w+,\s*int \w+\)', text, re.M)
        seen[path] = set(kernels), set(work), set(re.findall(r'\bshape->(\w+)\(', text))
    return seen[path]


def main():
    library, folder = sys.argv[1:3]
    sizes, files = frames(folder)
    functions = calls(library)
    places = collections.defaultdict(set)
    for at, f in functions.items():
        places[re.sub(r'\.(part|isra|constprop)\..*', '', f['name'])].add(at)
        places[f['name']].add(at)
    pool = {at for name in ('rf_pool_run', 'take_items') for at in places[name]}
    pool_size = sum(sizes[name] + RETURN for name in ('rf_pool_run', 'take_items'))
    if not pool_size or not all(places[name] for names in CALLBACKS.values() for name in names):
        sys.exit('functions that this script names are not in the library')
    of_shapes = operations()
    deepest = {}

    def by_pointer(f):
        """The functions that one may call by pointer."""
        names = {name for path in files[f['name']] for name in named(path)[0]}
        members = {member for path in files[f['name']] for member in named(path)[2]}
        names_of = [*CALLBACKS.get(f['name'], ()), *(n for m in members for n in of_shapes[m])]
        return [at for name in names_of for at in places[name]] + \
            [at for name in names for kind in SETS for at in places.get(f'rf_{name}_{kind}', ())]

    def work_of(f):
        names = {name for path in files[f['name']] for name in named(path)[1]}
        if not any(places[name] for name in names):
            sys.exit(f'{f["name"]}: it is not known what its pool runs')
        return [at for name in names for at in places[name]]

    def depth(at, above=()):
        """The bytes of the longest chain from a function on, and the names in it."""
        if at in deepest or at not in functions or at in above:
            return deepest.get(at, (0, ()))
        f = functions[at]
        if f['name'].endswith('@plt'):
            return max((depth(to, above) for to in places.get(f['name'][:-4], ())), default=(0, ()))
        below = [depth(to, above + (at,)) for to in f['calls'] - pool]
        if f['pointer']:
            below += [depth(to, above + (at,)) for to in by_pointer(f)]
        if f['calls'] & pool and f['name'] != 'thread_main':
            for size, chain in [depth(to, above + (at,)) for to in work_of(f)]:
                below.append((size + pool_size, (('rf_pool_run', pool_size),) + chain))
        size, chain = max(below, default=(0, ()))
        own = sizes[f['name']] + RETURN
        deepest[at] = (own + size, ((f['name'], own),) + chain)
        return deepest[at]

    roots = sorted((depth(at) for at, f in functions.items() if f['name'].startswith('refocus_')
                    and f['name'] in files), reverse=True)
    for size, chain in roots[:len(roots) if '--list' in sys.argv else 5]:
        print(size, ' > '.join(f'{name} {own}' for name, own in chain))
    if len(roots) < 20 or len(sizes) < 500:
        sys.exit(f'only {len(roots)} public functions of {len(sizes)} were found')
    return roots[0][0] > LIMIT


if __name__ == '__main__':
    sys.exit(main())
