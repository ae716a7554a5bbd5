"""Tables of docs/measured: every row goes to a CSV file of docs/measured/rows, and on the page stands what the rows come to.

    lines = [*spread(head, rows, ["elements", "CPU s"]), "", f"Each: {put('status', head, rows)}."]
    write("status", [*head_of_page, *lines])

Cells are what people read: numbers with separators of thousands, units, words. Least, median and most are cells as they stand,
so no figure is rounded twice; a CSV file has plain numbers where a cell is nothing else.
"""
import csv
import re

from bench.pages.origin import ROOT

MEASURED = ROOT / "docs/measured"
SAID = "## What it says"  # written by hand: stays, with all that follows, when a command writes the page anew
FIGURE = re.compile(r"[-+]?(\d[\d,]*\.?\d*|\.\d+)(e[-+]?\d+)?")


def row(cells):
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"


def table(head, rows):
    return [row(head), "|" + " --- |" * len(head), *map(row, rows)]


def parsed(text):
    """(head, rows) of each Markdown table that a program printed."""
    found, lines = [], text.splitlines()
    for before, line in zip(["", *lines], lines):
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if cells and not before.startswith("|"):
            found.append((cells, []))
        elif cells and not set(line) <= set("|-: "):
            found[-1][1].append(cells)
    return found


def some(head, rows, columns):
    """A table of the given columns."""
    return table(columns, [[cells[head.index(c)] for c in columns] for cells in rows])


def number(cell):
    """The figure of a cell of one figure and a unit, if any; None of other cells."""
    text = str(cell).strip("*` ")
    found = FIGURE.match(text)
    if not found or not re.fullmatch(r"| ?[%‰°sk]", text[found.end():]):
        return None
    return float(found[0].replace(",", ""))


def plain(cell):
    """A cell for a CSV file."""
    text = str(cell).replace("**", "").replace("`", "")
    return text.replace(",", "") if FIGURE.fullmatch(text) else text


def put(name, head, rows, folder=MEASURED):
    """Writes the rows to a CSV file; a link to it, for a sentence."""
    assert len(set(head)) == len(head), head
    (folder / "rows").mkdir(exist_ok=True)
    with (folder / f"rows/{name}.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([[plain(cell) for cell in cells] for cells in [head, *rows]])
    return f"[{name}.csv](rows/{name}.csv), {len(rows)} rows"


def rows_of(name, folder=MEASURED):
    """What `put` wrote of earlier runs."""
    path = folder / f"rows/{name}.csv"
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.reader(file))[1:]


def sorted_cells(head, rows, column):
    """The figures of a column by size."""
    at = head.index(column)
    return sorted((cells[at] for cells in rows if len(cells) > at and number(cells[at]) is not None), key=number)


def three(cells):
    """Least, median (of an even number the lower), most."""
    return [cells[0], cells[(len(cells) - 1) // 2], cells[-1]] if cells else ["", "", ""]


def spread(head, rows, columns):
    """A line for each column: its least, median and most."""
    return table([f"of {len(rows)}", "least", "median", "most"], [[column, *three(sorted_cells(head, rows, column))] for column in columns])


def spread_by(by, head, rows, columns):
    """A line for each kind of rows, those that agree in the column `by`: of each of the other columns median, least and most."""
    kinds = list(dict.fromkeys(cells[head.index(by)] for cells in rows))
    lines = []
    for kind in kinds:
        its = [cells for cells in rows if cells[head.index(by)] == kind]
        found = (three(sorted_cells(head, its, column)) for column in columns)
        lines.append([kind, len(its), *(f"{median} ({least}…{most})" if least != most else median for least, median, most in found)])
    return table([by, "rows", *columns], lines)


def worst(head, rows, column, columns, most=False, count=10):
    """The rows with the least, or the most, of a column, and of these the given columns."""
    at = head.index(column)
    known = [cells for cells in rows if len(cells) > at and number(cells[at]) is not None]
    known.sort(key=lambda cells: number(cells[at]), reverse=most)
    return some(head, known[:count], columns)


def write(page, lines, folder=MEASURED):
    """The page, with what was written by hand on the one that is there."""
    path = folder / f"{page}.md"
    before = path.read_text(encoding="utf-8").partition(SAID)[2] if path.exists() else ""
    text = "\n".join(lines).rstrip("\n") + "\n"
    path.write_text(text + (f"\n{SAID}{before}" if before else ""), encoding="utf-8")


def rewrite(path, mark, lines):
    """Puts the lines between `<!-- MARK: begin -->` and `<!-- MARK: end -->` of a page of several commands; what is around stays."""
    begin, end = f"<!-- {mark}: begin -->", f"<!-- {mark}: end -->"
    before, rest = path.read_text(encoding="utf-8").split(begin)
    behind = rest.split(end)[1]
    path.write_text("\n".join([before + begin, *lines]) + "\n" + end + behind, encoding="utf-8")
