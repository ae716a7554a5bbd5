"""docs/measured/answers.md from what bench/answers.py found."""
import math
import pathlib

from origin import written_by

PAGE = pathlib.Path("docs/measured/answers.md")
MEASURES = ("displacement", "energy", "stress")


def percent(value):
    return f"{value:+.2g}" if abs(value) < 0.1 else f"{value:+.1f}" if abs(value) >= 10 else f"{value:+.2f}"


def cells(r):
    errors = [percent(r[m]) for m in MEASURES] if "stress" in r else [r.get("error", ""), "", ""]
    count = [f"{r[k]:,}" if k in r else "" for k in ("elements", "unknowns")]
    return "| " + " | ".join([r["who"], r["what"], *count, *errors, f"{r['mesh']:.2f}", f"{r['solve']:.2f}" if "solve" in r else ""]) + " |"


def table(head, lines):
    return ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head), *lines, ""]


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


def summary(rows, cases, order, measure, bound):
    ways = [w for w in WAYS if any(r["who"] == w[1] and r["row"] == w[2] and r["order"] == order for r in rows)]
    lines = []
    for case in cases:
        mine = [[r for r in rows if (r["case"], r["who"], r["row"], r["order"]) == (case, who, row, order)] for _, who, row in ways]
        best = [reached(m, measure, bound) for m in mine]
        lines.append("| " + " | ".join([case, *(in_words(b) for b in best)]) + " |")
    return table(["case", *(w[0] for w in ways)], lines)


DEFAULTS = (("draft", "Octafront"), ("standard", "Octafront"), ("fine", "Octafront"), ("12 a turn", "Gmsh"), ("its defaults", "Netgen"))


def default_cell(rows, case, order, what, who):
    r = next((r for r in rows if (r["case"], r["order"], r["what"], r["who"], r["row"]) == (case, order, what, who, "default")), {})
    if "stress" in r:
        return f"{two_digits(r['unknowns'])}: {percent(r['stress'])}"
    return r.get("error", "")


def defaults(rows, cases, order):
    lines = ["| " + " | ".join([case, *(default_cell(rows, case, order, *d) for d in DEFAULTS)]) + " |" for case in cases]
    return table(["case", *(f"{who}, {what}" for what, who in DEFAULTS)], lines)


def mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def constants(rows):
    rows = [r for r in rows if r["row"].startswith("constant ")]
    if not rows:
        return []
    cases, names = (list(dict.fromkeys(r[k] for r in rows)) for k in ("case", "row"))
    lines = []
    for name in names:
        found = [reached([r for r in rows if (r["row"], r["case"]) == (name, case)], "stress", 1) for case in cases]
        whole = two_digits(mean([f[1] for f in found])) if all(f and f[0] != "> " for f in found) else ""
        lines.append("| " + " | ".join([name[9:], *(in_words(f) for f in found), whole]) + " |")
    at_one = [r for r in rows if r["what"].endswith("factor 1") and "stress" in r]
    plain = ["| " + " | ".join([name[9:], *(f"{two_digits(r['unknowns'])}: {percent(r['stress'])}" for case in cases for r in at_one if (r["row"], r["case"]) == (name, case))]) + " |" for name in names]
    return ["## Constants of automatic sizes", "", "Second order, by `--constants`: unknowns to 1 % of stress, when all automatic sizes are scaled by `--automatic-factor` (1.6 to .4), and their geometric mean.", "",
            *table(["constant", *cases, "mean"], lines), "And at a factor of 1, unknowns and the error of stress in percent.", "", *table(["constant", *cases], plain)]


ABOUT = """# What elements are worth: answers against unknowns and time

{written}. Bodies whose answers are known, drawn with OpenCASCADE's kernel in Gmsh, written as STEP, meshed by three programs, solved by CalculiX 2.20 (SPOOLES, C3D4 and C3D10,
DC3D4 and DC3D10 for heat), all with one thread; CPU seconds of whole processes, reading the STEP file too. Loads are consistent nodal forces and supports are by place, computed alike for all meshers.
*Octafront*: `--preset draft`, nothing, `--preset fine`, `--size H`, `--curvature K`; *Gmsh* 4.8.4: `-clcurv 12` (or K) and `-clmax H`, all else as it comes; *Netgen* 6.2: its own sizes, `maxh` H. Sizes are those at which regular tetrahedra
would fill the body with 2,000 to 60,000 (second order 500 to 20,000). Second order is each mesher's own. *Unknowns* are degrees of freedom that are not held. *Stress*: averaged at nodes, as CalculiX writes it, at the known place; *energy*: the work of the loads. FEniCSx is left out.
A row of runs ends where its stress is within {good} %, or before {most:,} unknowns, which CalculiX would take more than a minute for.

"""


def summaries(rows, cases):
    text = ["## Fewest unknowns and least time to 1 % of stress", "", "Second order: unknowns from which on the stress is within 1 %, between runs on a line of logarithms, and the seconds of meshing and solving together there. "
            "≤: the first run is within; >: the last is not.", "", *summary(rows, cases, 2, "stress", 1)]
    text += ["First order, to **10 %** of stress (1 % is beyond all these runs):", "", *summary(rows, cases, 1, "stress", 10)]
    text += ["First order, to 1 % of energy:", "", *summary(rows, cases, 1, "energy", 1)]
    text += ["## Where defaults lie", "", "Unknowns, and the error of stress in percent. Second order:", "", *defaults(rows, cases, 2), "First order:", "", *defaults(rows, cases, 1)]
    return text


def each(rows, cases):
    head = ["mesher", "how", "elements", "unknowns", "displacement, %", "energy, %", "stress, %", "mesh, s", "solve, s"]
    text = ["## Each case", ""]
    for case, says in cases.items():
        text += [f"### {case[0].upper()}{case[1:]}", "", says, ""]
        for order in (1, 2):
            mine = [r for r in rows if (r["case"], r["order"]) == (case, order) and not r["row"].startswith("constant")]
            text += [f"Order {order}:", "", *table(head, [cells(r) for r in sorted(mine, key=lambda r: (r["who"] != "Octafront", r["who"]))])]
    return text


def said():
    """What was written by hand."""
    mark = "## What it says\n"
    text = PAGE.read_text() if PAGE.is_file() else ""
    return [mark + text.split(mark)[1].split("\n## ")[0].rstrip("\n"), ""] if mark in text else []


def write(found, good, most):
    rows, cases = list(found["runs"].values()), found["cases"]
    text = [ABOUT.format(written=written_by("bench/run.sh answers", {r["origin"] for r in rows}), good=good, most=most).rstrip("\n"), "", *said()]
    text += summaries(rows, cases) + constants(rows) + each(rows, cases)
    PAGE.write_text("\n".join(text).rstrip("\n") + "\n")
