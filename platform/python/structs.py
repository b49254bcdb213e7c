#!/usr/bin/env python3
"""Makes structs and enums of the public headers known to Python, with their names and comments.

usage: structs.py INCLUDE_FOLDER FIELDS_H STRUCTS_PY

FIELDS_H gets a table of fields for each struct in STRUCTS, STRUCTS_PY a class for each of them and
for each enum in ENUMS. So a field that is new in a header is there in Python, and cannot differ.
"""
import pathlib
import re
import sys
import textwrap

STRUCTS = ('renderer_params', 'renderer_info', 'render_params', 'highlight_params', 'thin_params',
           'look_params', 'focus_params', 'field_params', 'search_params', 'jittered_params',
           'scatter_params', 'interpolated_params', 'foveated_params', 'diffusion_params',
           'aperture_params', 'depth_report', 'depth_edges_report', 'lens', 'depth_range',
           'depth_of_field', 'photo_info')
ENUMS = ('format', 'transfer', 'matrix', 'range', 'blend', 'inpaint', 'dither', 'method', 'cpu',
         'figure', 'field', 'spread', 'solver', 'depth_edges', 'view', 'depth_source')
KINDS = {'int32_t': ('I32', 'int'), 'uint32_t': ('U32', 'int'), 'uint64_t': ('U64', 'int'),
         'float': ('F32', 'float'), 'double': ('F64', 'float'), 'char': ('TEXT', 'str'),
         'const struct refocus_disparity *': ('MAP', 'typing.Any')}
# Not for programs in Python: sizes and room for later; parts that classes of their own stand for
# (features, apertures, masks, bands, evidence); functions of C.
NAMES_LEFT_OUT = re.compile(r'struct_size|reserved\d*|bands|evidence|evidence_count|mask_\w+')
TYPES_LEFT_OUT = re.compile(r'(const )?struct refocus_(?!disparity\b)\w+( \*)?|const uint8_t \*')


def words(comment):
    """The text of a comment without its marks."""
    text = re.sub(r'^/\*\*<?|\*/$', '', comment.strip())
    text = re.sub(r'^[ \t]*\*(?= |$)', '', text, flags=re.M)
    return ' '.join(text.split()).replace('\\', '\\\\')


def statements(body):
    """(code, comment) of each field or enumerator; a comment stands behind or before it."""
    found, before = [], ''
    for match in re.finditer(r'/\*.*?\*/|[^;,/]+[;,]?', body, re.S):
        piece = match.group()
        if piece.startswith('/**<') and found:
            found[-1][1] = words(piece)
        elif piece.startswith('/**'):
            before = words(piece)
        elif piece.strip(' \t\n;,') and not piece.startswith('/*'):
            found.append([' '.join(piece.split()), before])
            before = ''
    for this, after in zip(found[-2::-1], found[:0:-1]):
        # float x, y; // one comment for both
        if this[0].endswith(',') and '=' not in this[0] and not this[1]:
            this[1] = after[1]
    return found


def fields(name, body):
    """[(field, kind, type in Python, comment)] of a struct."""
    found, base = [], ''
    for code, comment in statements(body):
        # 'float x, y;' comes as 'float x,' and 'y;': the second has the type of the first.
        match = re.fullmatch(r'(?:(.*?)[ ]?(\*?))?\b(\w+)((?:\[[^]]+\])*)([,;])', code)
        if not match:
            sys.exit(f'structs.py: a field of struct refocus_{name} is not understood: {code}')
        kind, star, field, sizes, end = match.groups()
        kind = f'{kind} *' if star else kind or base
        base = kind if end == ',' else ''
        if NAMES_LEFT_OUT.fullmatch(field) or TYPES_LEFT_OUT.fullmatch(kind):
            continue
        if kind not in KINDS or bool(sizes) != (kind == 'char'):
            sys.exit(f'structs.py: struct refocus_{name} has a {kind} {field}{sizes}: say in '
                     'structs.py how Python sees it')
        found.append((field, *KINDS[kind], comment))
    return found


def class_name(name):
    return ''.join(part.capitalize() for part in name.split('_'))


def block(text, indent, first=''):
    return textwrap.fill(text, 98, initial_indent=indent + first, subsequent_indent=indent +
                         ('#: ' if first == '#: ' else ''))


def python_struct(name, comment, members):
    lines = [f'class {class_name(name)}(_Struct):', block(f'"""{comment}"""', '    '), '',
             f"    _name = '{name}'"]
    for field, _, kind, about in members:
        if about:
            lines.append(block(about, '    ', '#: '))
        lines.append(f'    {field}: {kind}')
    if name == 'focus_params':
        lines += ['    #: Bands in focus beside it: (disparity, half_width, transition) of each.',
                  '    band: list[tuple[float, float, float]]']
    elif name == 'photo_info':
        lines += ['    #: A line each for what was found and why it is believed.',
                  '    evidence: list[str]']
    return '\n'.join(lines) + '\n'


def c_struct(name, members, makes_default):
    lines = [f'static const struct rf_field {name}_fields[] = {{']
    for field, kind, _, _ in members:
        lines.append(f'    RF_FIELD({name}, {kind}, {field}),')
    lines += ['    {0}};', f'static void {name}_default(void *into)', '{']
    if makes_default is None:
        lines.append(f'    memset(into, 0, sizeof(struct refocus_{name}));')
    else:
        zeros = ', '.join('0' for _ in makes_default)
        lines += [f'    const struct refocus_{name} made = refocus_{name}_default({zeros});',
                  '    memcpy(into, &made, sizeof made);']
    lines += ['}', f'_Static_assert(sizeof(struct refocus_{name}) <= RF_MOST_STRUCT, "too large");']
    return '\n'.join(lines) + '\n'


def enum(name, comment, body):
    members = [(*re.fullmatch(r'(REFOCUS_\w+) = (-?\d+),?', code).groups(), about)
               for code, about in statements(body)]
    names = ' '.join(member for member, _, _ in members)
    shared = re.match(r'(REFOCUS_(?:\w+_)?)\w*(?: \1\w*)*$', names).group(1)
    lines = [f'class {class_name(name)}(enum.IntEnum):', block(f'"""{comment}"""', '    '), '']
    for member, value, about in members:
        if about:
            lines.append(block(about, '    ', '#: '))
        lines.append(f'    {member.removeprefix(shared)} = {value}')
    return '\n'.join(lines) + '\n'


def main():
    include, fields_h, structs_py = map(pathlib.Path, sys.argv[1:])
    text = '\n'.join(path.read_text() for path in sorted(include.rglob('*.h')))
    found = {kind: {name: (words(comment or ''), body) for comment, name, body in re.findall(
        r'(/\*\*(?:(?!\*/).)*\*/)?\n%s refocus_(\w+) \{(.*?)\n\}' % kind, text, re.S)}
        for kind in ('struct', 'enum')}
    defaults = {name: [] if arguments == 'void' else arguments.split(',') for name, arguments in
                re.findall(r'refocus_(\w+)_default\(([^)]*)\)\n\{', text)}
    table, c_code = [], ['/* fields.h: made by structs.py of the public headers. */']
    python = ['"""Structs and enums of the library, as in its headers. Made by structs.py."""',
              'import enum', 'import typing', '', 'from ._struct import Struct as _Struct', '', '']
    for name in ENUMS:
        python.append(enum(name, *found['enum'][name]) + '\n')
    for name in STRUCTS:
        comment, body = found['struct'][name]
        members = fields(name, body)
        python.append(python_struct(name, comment, members) + '\n')
        c_code.append(c_struct(name, members, defaults.get(name)))
        table.append(f'    {{"{name}", {name}_fields, {name}_default}},')
    c_code += ['static const struct rf_struct rf_structs[] = {', *table, '};', '']
    fields_h.write_text('\n'.join(c_code))
    names = [class_name(name) for name in (*ENUMS, *STRUCTS)]
    python.append(textwrap.fill(f'__all__ = {names}', 98, subsequent_indent='           '))
    structs_py.write_text('\n'.join(python).rstrip() + '\n')


if __name__ == '__main__':
    main()
