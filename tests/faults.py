"""The faults that tests/mutants.py seeds: finds the places in a C file, and changes one."""
import collections
import random
import re

Fault = collections.namedtuple('Fault', 'kind start end text')  # text in place of [start, end)

SWAPS = {
    'compare': {'<': '<=', '<=': '<', '>': '>=', '>=': '>', '==': '!=', '!=': '=='},
    'logic': {'&&': '||', '||': '&&'},
    'arithmetic': {'+': '-', '-': '+', '*': '/', '/': '*', '%': '*', '<<': '>>', '>>': '<<',
                   '+=': '-=', '-=': '+=', '&': '|', '|': '&'},
}
# clang-format sets a space on both sides of an operator of two operands, and of no other.
OPERATOR = re.compile(r'(?<= )(<<|>>|<=|>=|==|!=|&&|\|\||\+=|-=|[-+*/%<>&|])(?= |\n)')
NUMBER = re.compile(r'(?<![\w.])(0x[0-9a-fA-F]+|\d+)(?=[uUlL]*\b)(?![\w]*\.)')
CALL = re.compile(r'^ +(?!return\b|else\b)[a-z_]\w*\([^;{}]*\);$', re.M)
NOT_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
DIRECTIVE = re.compile(r'^#(?:[^\n]*\\\n)*[^\n]*', re.M)
BODY = re.compile(r'^\{$.*?^\}$', re.M | re.S)


def blank(match):
    return re.sub(r'[^\n]', '_', match.group())


def code_of(source):
    """The text with comments, strings and directives blanked: every place stays where it is."""
    return DIRECTIVE.sub(blank, NOT_CODE.sub(blank, source))


def one_more(number):
    """The literal after this one, in its base."""
    if number.startswith('0x'):
        return hex(int(number, 16) + 1)
    return f'0{int(number, 8) + 1:o}' if number.startswith('0') and number != '0' else str(int(number) + 1)


def closing(code, opened):
    """Where the parenthesis at `opened` is closed."""
    level = 0
    for place in range(opened, len(code)):
        level += (code[place] == '(') - (code[place] == ')')
        if level == 0:
            return place
    return None


def faults_of(source):
    """All faults that fit into the bodies of functions, in the order of the text."""
    code, found = code_of(source), []
    for body in BODY.finditer(code):
        low, high = body.span()
        for match in OPERATOR.finditer(code, low, high):
            for kind, swaps in SWAPS.items():
                if match[1] in swaps:
                    found.append(Fault(kind, *match.span(1), swaps[match[1]]))
        for match in NUMBER.finditer(code, low, high):
            found.append(Fault('constant', *match.span(1), one_more(match[1])))
        for match in re.finditer(r'\b(?:if|while) \(', code[low:high]):
            opened = low + match.end() - 1
            shut = closing(code, opened)
            if shut is not None and shut < high:
                found.append(Fault('negate', opened, shut + 1,
                                   f'(!{source[opened:shut + 1]})'))
        for match in CALL.finditer(code, low, high):
            first = match.start() + len(match[0]) - len(match[0].lstrip())
            found.append(Fault('call', first, match.end(), ';' + '\n' * match[0].count('\n')))
    return sorted(found, key=lambda fault: (fault.start, fault.kind))


def changed(source, fault):
    return source[:fault.start] + fault.text + source[fault.end:]


def line_of(source, fault):
    return source.count('\n', 0, fault.start) + 1


def lines_changed(source, fault):
    """The line with the fault's place before and after, without the space around it."""
    first = source.rfind('\n', 0, fault.start) + 1
    last = source.find('\n', fault.end)
    before = source[first:last]
    after = before[:fault.start - first] + fault.text + before[fault.end - first:]
    return ' '.join(before.split()), ' '.join(after.split())


def chosen(sources, seed):
    """(path, fault) for ever different places: files in turn, in each a kind at random, then a place.

    The order is of the seed and the sources alone; a longer run begins as a shorter one.
    """
    chance = random.Random(seed)
    left = {}
    for path in sorted(sources):
        kinds = collections.defaultdict(list)
        for fault in faults_of(sources[path]):
            kinds[fault.kind].append(fault)
        if kinds:
            left[path] = kinds
    while left:
        turn = sorted(left)
        chance.shuffle(turn)
        for path in turn:
            kinds = left[path]
            kind = chance.choice(sorted(kinds))
            yield path, kinds[kind].pop(chance.randrange(len(kinds[kind])))
            if not kinds[kind]:
                del kinds[kind]
            if not kinds:
                del left[path]
