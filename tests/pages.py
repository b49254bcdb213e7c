"""What the scripts that write pages of measurements share: where scenes and photos are, and whether
the figures of a page are still those of the program."""
import os
import re
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
DATA = SOURCE / "examples" / "data"
# Columns that hold scores; those to their left name the row, those to their right are times.
SCORE = re.compile(r"`.+`|.*PSNR.*|near edges|SSIM|RMSE|to exact|edges put right|.*, %|.*1/1000|"
                   r"hidden|never|T = \d|front-most.*|in set.*|.*, stops|false highlights.*")


def scenes(names):
    """Folders of those reference scenes that are there, and a phrase that says which they are."""
    folder = Path(os.environ.get("REFOCUS_SCENES", DATA))
    found = [folder / name for name in names if (folder / name / "scene.json").is_file()]
    lost = [name for name in names if folder / name not in found]
    if not found:
        sys.exit(f"{Path(sys.argv[0]).name}: {folder}: none of the scenes {', '.join(names)}: "
                 "set REFOCUS_SCENES to their folder")
    if lost:
        print(f"NOT THERE, left out: {', '.join(lost)} of {folder}", file=sys.stderr)
    where = "`examples/data`" if folder == DATA else "`$REFOCUS_SCENES`"
    return found, f"{', '.join(f.name for f in found)}, in {where}"


def photos():
    """The folder of photos that cannot be in the repository; it may not be there."""
    return Path(os.environ.get("REFOCUS_PHOTOS", SOURCE.parent / "shared" / "photos"))


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def figures(text):
    """The scores in a page's tables: {(heading, table under it, row, column): text}."""
    found, heading, table, head, row = {}, "", 0, None, ""
    for line in text.splitlines():
        if line.startswith("#"):
            heading, table = line.lstrip("# "), 0
        if not line.startswith("|"):
            head = None
        elif head is None:
            head, table = cells(line), table + 1
            first = next((i for i, name in enumerate(head) if SCORE.fullmatch(name)), len(head))
        elif not line.startswith("| ---"):
            row = cells(line)
            for i in range(first, len(row)):
                if SCORE.fullmatch(head[i]):
                    column = f"{head[i]} {head[:i].count(head[i]) + 1}"
                    found[heading, table, ", ".join(row[:first]), column] = row[i]
    return found


def apart(key, old, new):
    """Whether two figures differ by more than rounding: 0.05 dB, SSIM 0.001."""
    try:
        limit = 0.001 if "SSIM" in key[0] + key[3] else 0.05
        return abs(float(old.strip("%")) - float(new.strip("%"))) > limit + 1e-9
    except ValueError:
        return old != new


def check(page, text, command):
    """Ends the program with the rows that moved, if figures of `text` are not those of the page."""
    old, new = figures(Path(page).read_text(encoding="utf-8")), figures(text)
    if not new:
        sys.exit(f"{page}: nothing was measured")
    moved = [key for key in new if key not in old or apart(key, old[key], new[key])]
    for key in moved:
        heading, _, row, column = key
        print(f"{heading}: {row}: {column.rsplit(' ', 1)[0]}: the page has "
              f"{old.get(key, 'no such figure')}, measured {new[key]}")
    if moved:
        sys.exit(f"{page}: {len(moved)} of {len(new)} figures are not this program's; is the "
                 f"change meant? Then: {command}")
    print(f"{page}: {len(new)} figures hold")
