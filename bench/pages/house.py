#!/usr/bin/env python3
"""The house in numbers and a picture: wings, rooms, arrows, circles, files and lines.

    bench/pages/house.py [COMMIT ...]   prints docs/measured/house.md: the tree as it is, beside older commits; the part that
                                    bench/pages/touched.py wrote stays as it is committed

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


def main():
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
    _, _, touched = git("show", "HEAD:docs/measured/house.md").partition(TOUCHED)
    if touched:
        print("\n" + TOUCHED + touched, end="")


if __name__ == "__main__":
    main()
