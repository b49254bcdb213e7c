"""Pages that several scripts write: each has a section between two comments."""
import re
from pathlib import Path


def put(page, name, script, text):
    """Replace section `name` of a page, or append it; says which script writes it."""
    page = Path(page)
    old = page.read_text(encoding="utf-8") if page.exists() else ""
    block = (f"<!-- {name}: written by {script}; do not edit -->\n{text.rstrip()}\n"
             f"<!-- /{name} -->\n")
    pattern = re.compile(rf"<!-- {name}: .*?<!-- /{name} -->\n", re.S)
    if pattern.search(old):
        new = pattern.sub(lambda _: block, old)
    else:
        new = (old.rstrip() + "\n\n" if old else "") + block
    page.write_text(new, encoding="utf-8")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, r)) + " |" for r in rows]) + "\n"
