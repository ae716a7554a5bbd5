#!/usr/bin/env python3
"""The house in numbers and a picture: wings, rooms, arrows, circles, files and lines.

    bench/pages/house.py [COMMIT ...]   prints docs/measured/house.md: the tree as it is, beside older commits; the part that
                                    bench/pages/touched.py wrote stays as it is committed
    bench/pages/house.py --picture FILE.svg COMMIT   draws the rooms of that commit beside those of the tree as it is

Wings are those that ARCHITECTURE.md of that commit names, rooms those of src/WING/README.md (before: of ARCHITECTURE.md); an arrow is a room (or wing) of which a file includes one of
another; a circle is a set of rooms that reach each other; a class begins in the first column and ends there.
"""
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.pages.origin import written_by  # noqa: E402

TOUCHED = "## What an edit costs"  # of bench/pages/touched.py, to the page's end
CLASS = re.compile(r"^(?:class|struct) \w[^;{]*\{\n.*?^\};", re.M | re.S)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=True, capture_output=True, text=True).stdout


def tree(commit):
    """{path under src: text} of sources, ARCHITECTURE.md, the pages with rooms."""
    if commit is None:
        texts = {p: (ROOT / p).read_text() for p in git("ls-files", "src", "ARCHITECTURE.md").split() if (ROOT / p).exists()}
    else:
        texts = {p: git("show", f"{commit}:{p}") for p in git("ls-tree", "-r", "--name-only", commit, "src", "ARCHITECTURE.md").split()}
    architecture = texts.pop("ARCHITECTURE.md")
    pages = [texts.pop(p) for p in list(texts) if p.endswith("/README.md")]
    return {p.removeprefix("src/"): text for p, text in texts.items()}, architecture, "\n".join(pages)


def rows(page, columns):
    """{room or wing: what its row names} of the tables with so many columns."""
    cells = ([c.strip() for c in line.strip().strip("|").split("|")] for line in page.splitlines())
    named = ((re.fullmatch(r"\[?`([\w/]+)`(?:\]\(\S+\))?", c[0]), c) for c in cells if len(c) == columns)
    return {name[1]: re.findall(r"`([\w/]+)`", c[1]) for name, c in named if name}


def arrows_between(files, place):
    arrows = collections.defaultdict(set)
    for path, text in files.items():
        for header in INCLUDE.findall(text):
            here, there = place(path), place(header)
            if here and there and here != there:
                arrows[here].add(there)
    return arrows


def circles(arrows):
    def reach(start):
        seen, todo = set(), [start]
        while todo:
            for other in arrows.get(todo.pop(), ()):
                if other not in seen:
                    seen.add(other)
                    todo.append(other)
        return seen

    reached = {name: reach(name) for name in arrows}
    return {frozenset(o for o in reached[name] if name in reached.get(o, ())) for name in arrows if name in reached[name]}


class House:
    def __init__(self, commit):
        self.files, architecture, pages = tree(commit)
        self.name = git("log", "-1", "--format=%h of %cd", "--date=format:%Y-%m-%d", commit or "HEAD").strip()
        self.may, self.rooms = rows(architecture, 3), rows(pages, 5) or rows(architecture, 4)
        self.room_arrows = arrows_between(self.files, self.room)
        self.wing_arrows = arrows_between(self.files, self.wing)
        self.wings = collections.Counter(filter(None, map(self.wing, self.files)))

    def room(self, path):
        parts = path.split("/")[:-1]
        return next(("/".join(parts[:n]) for n in range(len(parts), 0, -1) if "/".join(parts[:n]) in self.rooms), None)

    def wing(self, path):
        return path.split("/")[0] if "/" in path else None

    def lines(self, place=None, name=None):
        return sum(text.count("\n") for path, text in self.files.items() if place is None or place(path) == name)

    def longest_class(self):
        return max(text[0].count("\n") + 1 for file in self.files.values() for text in CLASS.finditer(file))

    def row(self):
        in_room = collections.Counter(filter(None, map(self.room, self.files)))
        return [self.name, len(self.wings), len(self.rooms), sum(map(len, self.room_arrows.values())), len(circles(self.room_arrows)),
                sum(map(len, self.wing_arrows.values())), len(circles(self.wing_arrows)), len(self.files), max(in_room.values()), f"{self.lines():,}",
                self.longest_class()]

    def order(self):
        """The rooms by wings, each behind all that it includes from."""
        wings = in_order(self.wings, self.wing_arrows)
        rooms = in_order(self.rooms, self.room_arrows)
        return sorted(rooms, key=lambda room: wings.index(room.split("/")[0]))


def in_order(names, arrows):
    placed = []
    while len(placed) < len(names):
        ready = [n for n in names if n not in placed and not arrows.get(n, set()) - set(placed)]
        placed += ready[:1] or [n for n in names if n not in placed]
    return placed


CELL, LABEL, HEAD = 10, 210, 30  # of the picture; pixels
LINES_OF_PIXEL = 130


def panel(house, x0):
    """A row and a column for each room: a filled cell where the room of the row includes from that of the column."""
    order = house.order()
    at = {room: k for k, room in enumerate(order)}
    side = CELL * len(order)
    yield f'<text x="{x0}" y="16" font-size="13">{house.name}: {len(order)} rooms, {sum(map(len, house.room_arrows.values()))} arrows, {house.lines():,} lines in src/</text>'
    yield f'<rect x="{x0 + LABEL}" y="{HEAD}" width="{side}" height="{side}" fill="#fff" stroke="#bbb"/>'
    for room, k in at.items():
        y, lines = HEAD + CELL * k, house.lines(house.room, room)
        yield f'<text x="{x0 + 135}" y="{y + 8}" font-size="9" text-anchor="end">{room}</text>'
        yield f'<rect x="{x0 + 139}" y="{y + 2}" width="{lines / LINES_OF_PIXEL:.0f}" height="6" fill="#9ab"/>'
        yield f'<rect x="{x0 + LABEL + CELL * k}" y="{y}" width="{CELL}" height="{CELL}" fill="#ddd"/>'
        for other in sorted(house.room_arrows.get(room, ()), key=at.get):
            same = room.split("/")[0] == other.split("/")[0]
            yield f'<rect x="{x0 + LABEL + CELL * at[other] + 1}" y="{y + 1}" width="{CELL - 2}" height="{CELL - 2}" fill="{"#c60" if same else "#246"}"/>'


def picture(houses):
    widths = [LABEL + CELL * len(house.rooms) + 30 for house in houses]
    height = HEAD + CELL * max(len(house.rooms) for house in houses) + 40
    yield f'<svg xmlns="http://www.w3.org/2000/svg" width="{sum(widths) + 10}" height="{height}" font-family="sans-serif">'
    yield '<rect width="100%" height="100%" fill="#fff"/>'
    for k, house in enumerate(houses):
        yield from panel(house, 10 + sum(widths[:k]))
    yield (f'<text x="10" y="{height - 10}" font-size="11">A filled cell: the room of the row includes from that of the column (orange: of its own wing); '
           f'none above the diagonal: no circles. Bars: lines.</text></svg>')


def main():
    if sys.argv[1:2] == ["--picture"]:
        pathlib.Path(sys.argv[2]).write_text("\n".join(picture([House(sys.argv[3]), House(None)])) + "\n")
        return
    houses = [House(commit) for commit in sys.argv[1:]] + [House(None)]
    now = houses[-1]
    print("# The house\n\nWhat `ARCHITECTURE.md` says in words, counted.", written_by(" ".join(["bench/pages/house.py", *sys.argv[1:]])) + ".\n")
    print("| commit | folders in `src/` | rooms | arrows between rooms | circles of rooms | arrows between folders | circles of these | files | most in a room | lines | longest class |")
    print("| --- |" + " ---: |" * 10)
    for house in houses:
        print("|", " | ".join(map(str, house.row())), "|")
    print("\nAn arrow: a file of one includes a header of the other.\n")
    wings = sorted(now.wings, key=lambda w: -now.lines(now.wing, w))
    print(f"Lines of the wings: {', '.join(f'`{wing}` {now.lines(now.wing, wing):,}' for wing in wings)}.")
    print("\n![Rooms and what they include from, before and now](../images/house.svg)")
    _, _, touched = git("show", "HEAD:docs/measured/house.md").partition(TOUCHED)
    if touched:
        print("\n" + TOUCHED + touched, end="")


if __name__ == "__main__":
    main()
