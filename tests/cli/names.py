"""The methods and the instruction sets that the refocus command knows, as its help and its errors
list them, so that tests go through all of them."""
import re
import subprocess


def read_help(refocus):
    return subprocess.run([refocus, 'render', '--help-all'], stdout=subprocess.PIPE, text=True,
                          check=True).stdout


def method_names(refocus):
    """In the order of the help of --method, the default first."""
    rows = re.search(r'^  --method NAME(.*?)^  --', read_help(refocus), re.M | re.S).group(1)
    names = re.findall(r'^ {28}(\w+)', rows, re.M)
    assert names[:2] == ['sweep', 'search'] and len(names) > 9, names
    return names


def methods_with_rays(refocus):
    """Those that --rays changes something with: what the error of another one names."""
    line = subprocess.run([refocus, 'render', 'x', '-o', 'x.png', '--method', 'jittered', '--rays',
                           '9'], stderr=subprocess.PIPE, text=True).stderr
    names = re.search('; give (.*), or leave it out', line).group(1).split(', ')
    assert names[:5] == ['sweep', 'search', 'raytrace', 'lightfield', 'blur'], names
    return names


def cpu_names(refocus):
    """Those of --cpu: auto first, then c."""
    flat = ' '.join(read_help(refocus).split())
    names = re.search('never changes the result: (.*?) --', flat).group(1).split(', ')
    assert names[:6] == ['auto', 'c', 'neon', 'sse41', 'avx2', 'avx512'], names
    return names
