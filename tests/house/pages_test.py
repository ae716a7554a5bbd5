#!/usr/bin/env python3
"""Do pages of docs/measured get what their rows come to, and CSV files all of them?

    pages_test.py ROOT
"""
import pathlib
import sys
import tempfile

sys.path.insert(0, sys.argv[1])
from bench.pages import tables  # noqa: E402

HEAD = ["model", "kind", "elements", "angle", "said"]
ROWS = [["a", "x", "1,200", "3.5 %", "one"], ["b", "x", "**900**", "-7.0 %", "1, 2"], ["c", "y", "30", "", "no | mesh"], ["d", "x", "1e3", "0.5 %", ""]]


def numbers():
    assert [tables.number(c) for c in ("1,200", "**900**", "-7.0 %", "1e-3", ".5", 3)] == [1200, 900, -7, 1e-3, .5, 3]
    assert [tables.number(c) for c in ("", "-", "1, 2", "30.9 - 126.9", "no mesh", "5 %, 2", "4.8.4")] == [None] * 7


def spreads():
    assert tables.spread(HEAD, ROWS, ["elements", "angle"])[2:] == ["| elements | 30 | **900** | 1,200 |", "| angle | -7.0 % | 0.5 % | 3.5 % |"]
    assert tables.spread_by("kind", HEAD, ROWS, ["elements", "angle"])[2:] == [
        "| x | 3 | 1e3 (**900**…1,200) | 0.5 % (-7.0 %…3.5 %) |", "| y | 1 | 30 |  |"]
    assert tables.worst(HEAD, ROWS, "elements", ["model", "said"], count=2)[2:] == ["| c | no \\| mesh |", "| b | 1, 2 |"]
    assert tables.worst(HEAD, ROWS, "elements", ["model"], most=True, count=1)[2:] == ["| a |"]


def files(folder):
    assert tables.put("it", HEAD, ROWS, folder) == "[it.csv](rows/it.csv), 4 rows"
    assert (folder / "rows/it.csv").read_text() == 'model,kind,elements,angle,said\na,x,1200,3.5 %,one\nb,x,900,-7.0 %,"1, 2"\nc,y,30,,no | mesh\nd,x,1e3,0.5 %,\n'
    assert tables.rows_of("it", folder)[2] == ["c", "y", "30", "", "no | mesh"]
    assert tables.parsed("Text.\n\n" + "\n".join(tables.table(HEAD, ROWS)) + "\n\n| a |\n|--:|\n| 1 |") == [(HEAD, ROWS), (["a"], [["1"]])]


def pages(folder):
    page = folder / "it.md"
    tables.write("it", ["# It", "", "old"], folder)
    page.write_text(page.read_text() + "\n## What it says\n\nBy hand.\n\n## And more\n")
    tables.write("it", ["# It", "", "<!-- part: begin -->", "new", "<!-- part: end -->"], folder)
    tables.rewrite(page, "part", ["newer"])
    assert page.read_text() == "# It\n\n<!-- part: begin -->\nnewer\n<!-- part: end -->\n\n## What it says\n\nBy hand.\n\n## And more\n"


numbers()
spreads()
with tempfile.TemporaryDirectory() as name:
    files(pathlib.Path(name))
    pages(pathlib.Path(name))
