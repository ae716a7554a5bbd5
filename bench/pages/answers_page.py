"""docs/measured/answers.md from what bench/run/answers.py found."""
import math
import pathlib

from bench.pages.origin import written_by
from bench.pages.tables import put, table, write as write_page

HERE = pathlib.Path(__file__).resolve().parent
MEASURES = ("displacement", "energy", "stress")


def percent(value):
    return f"{value:+.2g}" if abs(value) < 0.1 else f"{value:+.1f}" if abs(value) >= 10 else f"{value:+.2f}"


def cells(r):
    errors = [percent(r[m]) for m in MEASURES] if "stress" in r else [r.get("error", ""), "", ""]
    count = [f"{r[k]:,}" if k in r else "" for k in ("elements", "unknowns")]
    return [r["case"], r["order"], r["who"], r["what"], *count, *errors, f"{r['mesh']:.2f}", f"{r['solve']:.2f}" if "solve" in r else ""]


def between(a, b, measure, bound, of):
    """The value of `of` where the error is `bound`, on a straight line of logarithms."""
    low, high = (math.log(max(abs(r[measure]), 1e-12)) for r in (a, b))
    part = (low - math.log(bound)) / (low - high)
    return math.exp(math.log(of(a)) + part * (math.log(of(b)) - math.log(of(a))))


def seconds(r):
    return r["mesh"] + r["solve"]


def reached(rows, measure, bound):
    """Unknowns and seconds from which on the error stays below the bound: (words before, unknowns, seconds); None of no rows."""
    rows = sorted((r for r in rows if measure in r), key=lambda r: r["unknowns"])
    if not rows:
        return None
    above = [i for i, r in enumerate(rows) if abs(r[measure]) > bound]
    if not above:
        return "≤ ", rows[0]["unknowns"], seconds(rows[0])
    if above[-1] == len(rows) - 1:
        return "> ", rows[-1]["unknowns"], seconds(rows[-1])
    a, b = rows[above[-1]], rows[above[-1] + 1]
    return "", between(a, b, measure, bound, lambda r: r["unknowns"]), between(a, b, measure, bound, seconds)


def two_digits(n):
    step = 10 ** max(0, int(math.log10(max(n, 1))) - 1)
    return f"{round(n / step) * step:,}"


def in_words(found):
    return "" if found is None else f"{found[0]}{two_digits(found[1])} ({found[2]:.1f} s)"


WAYS = (("Octafront, sizes", "Octafront", "size"), ("Gmsh, sizes", "Gmsh", "size"), ("Netgen, sizes", "Netgen", "size"), ("Octafront, a turn", "Octafront", "turn"),
        ("Gmsh, a turn", "Gmsh", "turn"))


def belongs(r, row):
    """A row of elements a turn begins with the 12 of the default."""
    return r["row"] == row or (row == "turn" and r["row"] == "default" and r["what"] in ("standard", "12 a turn"))


ASKED = {"second order, 1 % of stress": (2, "stress", 1), "first order, 10 % of stress": (1, "stress", 10), "first order, 1 % of energy": (1, "energy", 1)}
REACHED = ["asked", "case", *(way[0] for way in WAYS)]


def all_reached(rows, cases):
    made = []
    for asked, (order, measure, bound) in ASKED.items():
        for case in cases:
            mine = ([r for r in rows if (r["case"], r["who"], r["order"]) == (case, who, order) and belongs(r, row)]
                    if any((r["who"], r["order"], r["row"]) == (who, order, row) for r in rows) else [] for _, who, row in WAYS)
            made.append([asked, case, *(in_words(reached(m, measure, bound)) for m in mine)])
    return made


DEFAULTS = (("draft", "Octafront"), ("standard", "Octafront"), ("fine", "Octafront"), ("12 a turn", "Gmsh"), ("its defaults", "Netgen"))


def default_cell(rows, case, order, what, who):
    r = next((r for r in rows if (r["case"], r["order"], r["what"], r["who"], r["row"]) == (case, order, what, who, "default")), {})
    if "stress" in r:
        return f"{two_digits(r['unknowns'])}: {percent(r['stress'])}"
    return r.get("error", "")


DEFAULT_HEAD = ["order", "case", *(f"{who}, {what}" for what, who in DEFAULTS)]


def defaults(rows, cases):
    return [[order, case, *(default_cell(rows, case, order, *d) for d in DEFAULTS)] for order in (2, 1) for case in cases]


def mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def constants(rows):
    """Unknowns to 1 % of stress as elements a turn grow, and their geometric mean; the errors. Where a row never comes to 1 %, its mean has no meaning."""
    rows = [r for r in rows if r["row"].startswith("constant ")]
    cases, names, turns = (list(dict.fromkeys(r[k] for r in rows)) for k in ("case", "row", "what"))
    names.sort(key=lambda name: ("," in name, int(name.split("/")[1].split(",")[0]), name))  # of rows that were added later, too
    sums = []
    for name in names:
        found = [reached([r for r in rows if (r["row"], r["case"]) == (name, case)], "stress", 1) for case in cases]
        whole = two_digits(mean([f[1] for f in found])) if all(f and f[0] != "> " for f in found) else ""
        sums.append([name[9:], *(in_words(f) for f in found), whole])
    plain = [[case, name[9:], *(told(rows, name, case, turn) for turn in turns)] for case in cases for name in names]
    return (["constant", *cases, "mean"], sums), (["case", "constant", *turns], plain)


def told(rows, name, case, turn):
    r = next((r for r in rows if (r["row"], r["case"], r["what"]) == (name, case, turn)), {})
    return f"{two_digits(r['unknowns'])}: {percent(r['stress'])}" if "stress" in r else r.get("error", "")


HEAD = ["case", "order", "mesher", "how", "elements", "unknowns", "displacement, %", "energy, %", "stress, %", "mesh, s", "solve, s"]


def each(rows, cases):
    kept = [r for r in rows if not r["row"].startswith("constant") and r["case"] in cases]
    order = list(cases)
    return [cells(r) for r in sorted(kept, key=lambda r: (order.index(r["case"]), r["order"], r["who"] != "Octafront", r["who"]))]


def write(found, good, most):
    rows, cases = list(found["runs"].values()), found["cases"]
    fill(written_by("bench/run.sh answers", {r["origin"] for r in rows}), good, most, list(cases.items()), all_reached(rows, cases), defaults(rows, cases),
         constants(rows), each(rows, cases))


def fill(written, good, most, cases, of_all, by_default, found, runs):
    """Writes the page, and the rows of cells that go to CSV files."""
    second = [row[1:] for row in of_all if row[0] == next(iter(ASKED))]
    (sums, plain) = found
    text = (f"Constants that automatic sizes choose from (`--constants`, second order): unknowns to 1 % of stress, {put('answers-constants', *sums)}; unknowns and "
            f"errors, {put('answers-constants-errors', *plain)}. ") if sums[1] else ""
    page = (HERE / "answers.md.in").read_text(encoding="utf-8").format(
        written=written, good=good, most=most, cases=put("answers-cases", ["case", "what is known"], cases),
        second_stress="\n".join(table(REACHED[1:], second)), reached=put("answers-reached", REACHED, of_all),
        defaults=put("answers-defaults", DEFAULT_HEAD, by_default), constants=text, runs=put("answers", HEAD, runs))
    write_page("answers", [page])
