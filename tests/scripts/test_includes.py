#!/usr/bin/env python3
"""Includes point one way: who may know whom.

usage: test_includes.py [--list]   (--list prints the arrows between folders)

In src a folder may include its own headers and those of folders before it in ORDER. Outside,
examples see public headers alone, platform sees public headers and its own, and no two folders of
platform include each other. Files that name the renderer are few, and lie in src/renderer.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
# What the core is made of, from the ground up. A folder knows those before it.
ORDER = ['tables', 'support', 'colour', 'simd', 'kernels', 'image', 'aperture', 'optics', 'focus',
         'depth', 'edges', 'focus_stack', 'tiles', 'background', 'passes', 'thin', 'highlights', 'look', 'gather',
         'papers', 'renderer']
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.M)
SOURCES = ('*.c', '*.h', '*.cpp', '*.hpp')
MOST_NAMING_THE_RENDERER = 20


def files(folder):
    return sorted(path for pattern in SOURCES for path in (TOP / folder).rglob(pattern))


def includes(path):
    """The files of this tree that a file includes."""
    for mark, name in INCLUDE.findall(path.read_text()):
        if mark == '<':
            if name.startswith('refocus/'):
                yield TOP / 'include' / name
            continue
        for base in (path.parent, *[p for p in path.parents if p != TOP and TOP in p.parents]):
            if (base / name).exists():
                yield (base / name).resolve()
                break


def folder_of(path, root):
    return path.relative_to(TOP / root).parts[0] if len(path.relative_to(TOP / root).parts) > 1 \
        else ''


def is_in(path, root):
    return (TOP / root) in path.parents


def arrows(root):
    """{(folder, folder): [file that includes]}, of different folders of root."""
    found = {}
    for path in files(root):
        for other in includes(path):
            if is_in(other, root) and folder_of(path, root) != folder_of(other, root):
                found.setdefault((folder_of(path, root), folder_of(other, root)), []).append(path)
    return found


def circles(units):
    """Groups of units that reach each other (Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(unit):
        index[unit] = low[unit] = len(index)
        stack.append(unit)
        for other in units.get(unit, ()):
            if other not in index:
                visit(other)
                low[unit] = min(low[unit], low[other])
            elif other in stack:
                low[unit] = min(low[unit], index[other])
        if low[unit] == index[unit]:
            group = []
            while True:
                group.append(stack.pop())
                if group[-1] == unit:
                    break
            if len(group) > 1:
                found.append(sorted(group))

    for unit in sorted(units):
        if unit not in index:
            visit(unit)
    return found


def units_of(root):
    """X.c and X.h are one unit: {unit: units it includes}."""
    units = {}
    for path in files(root):
        unit = str(path.relative_to(TOP).with_suffix(''))
        units.setdefault(unit, set())
        for other in includes(path):
            name = str(other.relative_to(TOP).with_suffix(''))
            if is_in(other, root) and name != unit:
                units[unit].add(name)
    return units


def core_faults():
    for (a, b), where in sorted(arrows('src').items()):
        names = ', '.join(str(path.relative_to(TOP)) for path in where[:4])
        if a not in ORDER or b not in ORDER:
            yield f'src/{a if a not in ORDER else b} is not in the order of folders: {names}'
        elif ORDER.index(a) < ORDER.index(b):
            yield f'src/{a} includes src/{b}, which is above it: {names}'
    for path in files('src'):
        for other in includes(path):
            if is_in(other, 'include/refocus/platform') or is_in(other, 'platform'):
                yield f'{path.relative_to(TOP)} includes {other.relative_to(TOP)}'


def renderer_faults():
    named = [path for path in files('src') if 'struct refocus_renderer' in path.read_text()
             and not is_in(path, 'src/renderer')]
    own = [path for path in files('src/renderer')
           if 'struct refocus_renderer' in path.read_text()]
    for path in named:
        yield f'{path.relative_to(TOP)} names struct refocus_renderer; src/renderer alone may'
    if len(own) >= MOST_NAMING_THE_RENDERER:
        yield f'{len(own)} files of src/renderer name the renderer, ' \
              f'{MOST_NAMING_THE_RENDERER} are too many'


def platform_faults():
    for root in ('platform', 'platform/cli'):
        pairs = arrows(root)
        for a, b in sorted(pairs):
            if a and b and a < b and (b, a) in pairs:
                yield f'{root}/{a} and {root}/{b} include each other'
    for root in ('src', 'platform'):
        for group in circles(units_of(root)):
            yield 'a circle of files: ' + ', '.join(group)
    for path in files('platform'):
        for other in includes(path):
            if is_in(other, 'src') or is_in(other, 'tests'):
                yield f'{path.relative_to(TOP)} includes {other.relative_to(TOP)}'
    for path in files('examples'):
        for other in includes(path):
            if not is_in(other, 'include') and not is_in(other, 'examples'):
                yield f'{path.relative_to(TOP)} includes {other.relative_to(TOP)}'


def main():
    if sys.argv[1:] == ['--list']:
        for root in ('src', 'platform'):
            for (a, b), where in sorted(arrows(root).items()):
                print(f'{root}: {a} -> {b} ({len(where)})')
        return 0
    faults = [*core_faults(), *renderer_faults(), *platform_faults()]
    for fault in faults:
        print(fault)
    print(f'{len(faults)} arrows go the wrong way')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
