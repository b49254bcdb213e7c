#!/usr/bin/env python3
"""Write the files of the page as one C file: embed.py OUT.c FILE..."""
import os
import sys

TYPES = {'.html': 'text/html; charset=utf-8', '.css': 'text/css; charset=utf-8',
         '.js': 'text/javascript; charset=utf-8', '.svg': 'image/svg+xml', '.png': 'image/png'}


def main():
    out, *names = sys.argv[1:]
    lines = ['/* Written by embed.py. */', '#include "page_files.h"', '']
    rows = []
    for i, name in enumerate(names):
        with open(name, 'rb') as file:
            data = file.read()
        lines.append('static const unsigned char file%d[] = {' % i)
        lines += ['    ' + ','.join(map(str, data[at:at + 24])) + ',' for at in
                  range(0, len(data), 24)] or ['    0']
        lines += ['};', '']
        base = os.path.basename(name)
        rows.append('    {"%s", "%s", file%d, %d},' %
                    ('' if base == 'index.html' else base, TYPES[os.path.splitext(base)[1]], i,
                     len(data)))
    lines += ['const struct page_file page_files[] = {'] + rows + ['    {0, 0, 0, 0},', '};', '']
    with open(out, 'w') as file:
        file.write('\n'.join(lines))


main()
