"""docs/measured/answers.md from what bench/answers.py found."""
import math
import pathlib

from pages.origin import written_by

PAGE = pathlib.Path("docs/measured/answers.md")
HERE = pathlib.Path(__file__).resolve().parent
MEASURES = ("displacement", "energy", "stress")


def percent(value):
    return f"{value:+.2g}" if abs(value) < 0.1 else f"{value:+.1f}" if abs(value) >= 10 else f"{value:+.2f}"


def cells(r):
    errors = [percent(r[m]) for m in MEASURES] if "stress" in r else [r.get("error", ""), "", ""]
    count = [f"{r[k]:,}" if k in r else "" for k in ("elements", "unknowns")]
    return "| " + " | ".join([r["who"], r["what"], *count, *errors, f"{r['mesh']:.2f}", f"{r['solve']:.2f}" if "solve" in r else ""]) + " |"


def table(head, lines):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + " --- |" * len(head), *lines])


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


def summary(rows, cases, order, measure, bound):
    ways = [w for w in WAYS if any(r["who"] == w[1] and r["row"] == w[2] and r["order"] == order for r in rows)]
    lines = []
    for case in cases:
        mine = [[r for r in rows if (r["case"], r["who"], r["order"]) == (case, who, order) and belongs(r, row)] for _, who, row in ways]
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
    """Where a row never comes to 1 %, its mean has no meaning."""
    rows = [r for r in rows if r["row"].startswith("constant ")]
    if not rows:
        return ""
    cases, names, turns = (list(dict.fromkeys(r[k] for r in rows)) for k in ("case", "row", "what"))
    names.sort(key=lambda name: ("," in name, int(name.split("/")[1].split(",")[0]), name))  # of rows that were added later, too
    lines = []
    for name in names:
        found = [reached([r for r in rows if (r["row"], r["case"]) == (name, case)], "stress", 1) for case in cases]
        whole = two_digits(mean([f[1] for f in found])) if all(f and f[0] != "> " for f in found) else ""
        lines.append("| " + " | ".join([name[9:], *(in_words(f) for f in found), whole]) + " |")
    plain = (f"{capital(case)}, unknowns and the error of stress in percent:\n\n" + table(["constant", *turns], [
        "| " + " | ".join([name[9:], *(told(rows, name, case, turn) for turn in turns)]) + " |" for name in names]) for case in cases)
    return (HERE / "answers_constants.md.in").read_text().format(reached=table(["constant", *cases, "mean"], lines), each="\n\n".join(plain))


def told(rows, name, case, turn):
    r = next((r for r in rows if (r["row"], r["case"], r["what"]) == (name, case, turn)), {})
    return f"{two_digits(r['unknowns'])}: {percent(r['stress'])}" if "stress" in r else r.get("error", "")


def capital(text):
    return text[0].upper() + text[1:]


HEAD = ["mesher", "how", "elements", "unknowns", "displacement, %", "energy, %", "stress, %", "mesh, s", "solve, s"]


def each(rows, cases):
    text = []
    for case, says in cases.items():
        text += [f"### {capital(case)}", says]
        for order in (1, 2):
            mine = [r for r in rows if (r["case"], r["order"]) == (case, order) and not r["row"].startswith("constant")]
            text += [f"Order {order}:", table(HEAD, [cells(r) for r in sorted(mine, key=lambda r: (r["who"] != "Octafront", r["who"]))])]
    return "\n\n".join(text)


def said():
    """What was written by hand."""
    mark = "## What it says\n"
    text = PAGE.read_text() if PAGE.is_file() else ""
    return mark + text.split(mark)[1].split("\n## ")[0].rstrip("\n") + "\n\n" if mark in text else ""


def write(found, good, most):
    rows, cases = list(found["runs"].values()), found["cases"]
    PAGE.write_text((HERE / "answers.md.in").read_text().format(
        written=written_by("bench/run.sh answers", {r["origin"] for r in rows}), good=good, most=most, said=said(),
        second_stress=summary(rows, cases, 2, "stress", 1), first_stress=summary(rows, cases, 1, "stress", 10), first_energy=summary(rows, cases, 1, "energy", 1),
        second_defaults=defaults(rows, cases, 2), first_defaults=defaults(rows, cases, 1), constants=constants(rows), cases=each(rows, cases)))
