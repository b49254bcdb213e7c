#!/usr/bin/env python3
"""Files and comments begin with words that a stranger understands.

usage: test_comments.py [--list]

Each .c and .h file of src and platform begins with a comment: `/* name.c: what it does. */`, the
public headers with `/** @file name.h  What it is. */`. No comment begins with a word that points at
something outside it (of, what, those, and, ...), nor names a file or a function of ours that is not
there.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
BARE = ('of', 'what', 'those', 'and', 'that', 'which', 'its', 'their', 'the same', 'in which',
        'from which', 'where those')
COMMENT = re.compile(r'/\*\*?<?[ \t\n*]*(.*?)\*/', re.S)
BEGINS_BARE = re.compile(r'(?:%s)\b' % '|'.join(BARE), re.I)
FILE = re.compile(r'(?<![*\w])[\w/]+\.(?:c|h|cpp|hpp|def|py|sh|md)\b')
FUNCTION = re.compile(r'\b(?:rf|refocus)_\w+(?=\(\))')
FOLDERS = ('src', 'include', 'platform', 'examples', 'tests')


def sources():
    for folder in FOLDERS:
        for pattern in ('*.c', '*.h', '*.cpp', '*.hpp'):
            yield from sorted((TOP / folder).rglob(pattern))


def bare(path):
    text = path.read_text()
    for comment in COMMENT.finditer(text):
        if BEGINS_BARE.match(comment.group(1)):
            yield f'{path.relative_to(TOP)}:{text.count(chr(10), 0, comment.start()) + 1}: ' \
                  f'{" ".join(comment.group(1).split())[:70]}'


def faults_of_first_line(path):
    first = path.read_text().lstrip()
    name = re.escape(path.name)
    if path.is_relative_to(TOP / 'include'):
        good = re.match(r'/\*\* @file (?:\S*/)?%s\s+\S' % name, first)
    else:
        good = re.match(r'/\*\s+(?:\S*/)?%s: \S' % name, first)
    if not good:
        yield f'{path.relative_to(TOP)}: the first line does not say what the file does'


def names_that_are_missing():
    """Files and functions that comments name; those in capitals stand for any."""
    texts = {path: path.read_text() for path in sources()}
    words = {word for text in texts.values() for word in re.findall(r'\w+', COMMENT.sub('', text))}
    files = [str(path) for path in TOP.glob('*.*')]
    files += [str(path) for folder in FOLDERS for path in (TOP / folder).rglob('*.*')]
    for path, text in texts.items():
        for comment in COMMENT.findall(text):
            names = [name for name in FILE.findall(comment)
                     if not any(file.endswith('/' + name) for file in files)]
            names += [name for name in FUNCTION.findall(comment) if name not in words]
            for name in names:
                if re.search('[A-Z]', name):
                    continue
                yield f'{path.relative_to(TOP)}: {name} is not there'


def main():
    found = [line for path in sources() for line in bare(path)]
    found += [line for path in sources()
              if path.is_relative_to(TOP / 'src') or path.is_relative_to(TOP / 'platform')
              or path.is_relative_to(TOP / 'include') for line in faults_of_first_line(path)]
    found += names_that_are_missing()
    for line in found:
        print(line)
    print(f'{len(found)} comments or first lines to mend')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
