#!/usr/bin/env python3
"""Programs and libraries of release builds are hardened.

usage: test_hardened.py FILE...   (ELF files that are shipped)

Each has to be of position-independent code, with read-only relocations that are all resolved at
its start (full RELRO), and without an executable stack; one file with buffers must call the stack
protector, and all files together some checked function of libc (FORTIFY).
"""
import pathlib
import subprocess
import sys


def readelf(option, path):
    return subprocess.run(['readelf', '-W', option, path], check=True, capture_output=True,
                          text=True, env={'LC_ALL': 'C', 'PATH': '/usr/bin:/bin'}).stdout


def lines(text, word):
    return [line for line in text.splitlines() if word in line]


def faults(path):
    """What a file lacks, and the names that it imports."""
    segments, dynamic = readelf('-l', path), readelf('-d', path)
    imports = {line.split(' UND ')[1].split('@')[0].strip()
               for line in lines(readelf('--dyn-syms', path), ' UND ')}
    found = []
    if not lines(segments, 'GNU_RELRO'):
        found.append('no read-only relocations')
    if not any('BIND_NOW' in line or ' NOW' in line for line in lines(dynamic, 'FLAGS')):
        found.append('symbols are bound when they are first used, not at the start')
    if any(' RWE ' in line for line in lines(segments, 'GNU_STACK')) or not lines(segments, 'GNU_STACK'):
        found.append('an executable stack')
    if lines(dynamic, 'TEXTREL'):
        found.append('relocations in the code')
    if 'DYN (' not in readelf('-h', path):
        found.append('a fixed address')
    if '__stack_chk_fail' not in imports:
        found.append('no stack protector')
    return found, imports


def main():
    failed, imports = 0, set()
    for path in sys.argv[1:]:
        found, names = faults(path)
        imports |= names
        for fault in found:
            print(f'{pathlib.Path(path).name}: {fault}')
        failed += len(found)
    checked = sorted(name for name in imports if name.startswith('__') and name.endswith('_chk'))
    if not checked:
        print('no checked function of libc: FORTIFY is off')
        failed += 1
    print(f'{len(sys.argv) - 1} files, {failed} faults; checked:', ' '.join(checked))
    return bool(failed)


if __name__ == '__main__':
    sys.exit(main())
