#!/usr/bin/env python3
"""Every public function has a user: a program of platform or examples names it.

A function that no program needs is one to take away, or one that an example has yet to show.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
# function: why no program names it
WITHOUT = {}
SOURCES = ('*.c', '*.h', '*.cpp', '*.hpp')


def public_functions():
    """{function: header} of everything that is marked REFOCUS_API."""
    found = {}
    for header in sorted((TOP / 'include').rglob('*.h')):
        text = re.sub(r'/\*.*?\*/', '', header.read_text(), flags=re.S)
        for name in re.findall(r'REFOCUS_API[^;{]*?\b(refocus_\w+)\(', text):
            found[name] = header.relative_to(TOP)
    return found


def words_of_programs():
    """The words of all programs; a function's own definition is the one place that is no use."""
    words = set()
    for folder in 'platform', 'examples':
        for pattern in SOURCES:
            for path in (TOP / folder).rglob(pattern):
                text = re.sub(r'/\*.*?\*/|//[^\n]*', '', path.read_text(), flags=re.S)
                text = re.sub(r'^[a-z][\w *]*\b(refocus_\w+)\([^;{]*\)\s*\{', '', text, flags=re.M)
                words.update(re.findall(r'\brefocus_\w+', text))
    return words


def main():
    functions, words = public_functions(), words_of_programs()
    alone = sorted(name for name in functions if name not in words)
    wrong = [f'{functions[name]}: no program uses {name}()' for name in alone
             if name not in WITHOUT]
    wrong += [f'{name} in WITHOUT has a user, or is no function' for name in WITHOUT
              if name not in alone]
    print('\n'.join(wrong))
    print(f'{len(functions)} public functions, {len(wrong)} to mend')
    return 1 if wrong or len(functions) < 50 else 0


if __name__ == '__main__':
    sys.exit(main())
