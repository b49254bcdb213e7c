#!/usr/bin/env python3
"""Faults of tests/mutants.py are found where they belong, each changes one thing, and a seed chooses them.

usage: test_mutants.py
"""
import contextlib
import io
import itertools
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import faults  # noqa: E402
import mutants  # noqa: E402

SOURCE = '''#include <a-b.h>
#define LIMIT (3 + 4)
static const int table[] = {1, 2};

/* No fault: 1 + 2 < 3. */
int f(int a, const char *b)
{
    if (a < 16 && *b != '+') {
        note("1 + 1",
             a);
    }
    return a - -1; // 5
}
'''
EXPECTED = [
    ('negate', 8, "if (!(a < 16 && *b != '+')) {"),
    ('compare', 8, "if (a <= 16 && *b != '+') {"),
    ('constant', 8, "if (a < 17 && *b != '+') {"),
    ('logic', 8, "if (a < 16 || *b != '+') {"),
    ('compare', 8, "if (a < 16 && *b == '+') {"),
    ('call', 9, ';\n'),
    ('arithmetic', 12, 'return a + -1; // 5'),
    ('constant', 12, 'return a - -2; // 5'),
]


def places():
    found = faults.faults_of(SOURCE)
    got = []
    for fault in found:
        after = faults.lines_changed(SOURCE, fault)[1]
        got.append((fault.kind, faults.line_of(SOURCE, fault),
                    fault.text[-2:] if fault.kind == 'call' else after))
        assert faults.changed(SOURCE, fault).count('\n') == SOURCE.count('\n'), fault
        assert faults.changed(SOURCE, fault) != SOURCE, fault
    assert got == EXPECTED, '\n'.join(map(str, got))


def literals():
    assert [faults.one_more(one) for one in ('0', '9', '0xff', '0666')] == ['1', '10', '0x100', '0667']


def choice():
    sources = {'a.c': SOURCE, 'b.c': SOURCE.replace('16', '0x1f')}
    all_of = list(faults.chosen(sources, 1))
    assert len(all_of) == len(set(all_of)) == 2 * len(EXPECTED)
    assert all_of == list(faults.chosen(sources, 1)) != list(faults.chosen(sources, 2))
    assert {path for path, _ in itertools.islice(faults.chosen(sources, 3), 2)} == set(sources)
    assert any(fault.text == '0x20' for _, fault in all_of)


def reports():
    row = ['lives', 'a.c:8', 'compare', 'a < b', 'a <= b', '', '1.0']
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / 'log.tsv'
        log.write_text('\t'.join(row) + '\ncut off\t')
        rows = mutants.read_log(log)
        assert rows == [row]
        mutants.EXPLAINED = pathlib.Path(folder) / 'mutants.txt'
        assert mutants.report(rows) == 1
        mutants.EXPLAINED.write_text('Heading.\n\na.c\n- a < b\n+ a <= b\nThey are never equal.\n')
        assert mutants.report(rows) == 0
        mutants.EXPLAINED.write_text('b.c\n- a < b\n+ a <= b\nThey are never equal.\n')
        assert mutants.report(rows) == 1
        assert mutants.report([['caught', *row[1:]]]) == 0


def areas():
    """Every C file of the core and of the own parsers is in an area; explained lines are in their files."""
    for folder in ('src', 'platform/file', 'platform/strokes', 'platform/capture'):
        for path in (mutants.ROOT / folder).rglob('*.c'):
            name = str(path.relative_to(mutants.ROOT))
            if '/tables/' not in name:
                assert any(mutants.re.fullmatch(files, name) for files, _ in mutants.AREAS), name
    for path, before, after in mutants.explained():
        text = (mutants.ROOT / path).read_text()
        pairs = {faults.lines_changed(text, fault) for fault in faults.faults_of(text)}
        assert (before, after) in pairs, (path, before, after)


areas()
places()
literals()
choice()
with contextlib.redirect_stdout(io.StringIO()):
    reports()
print('faults are found, chosen and reported')
