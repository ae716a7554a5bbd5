#!/usr/bin/python3
"""Assemblies from STEP to a solved job, one command each: writes docs/measured/assemblies.md.

  bench/campaigns/assemblies.py FILE.step[@x] ... [--page] [--seconds S]

Each part is meshed at a twentieth of the assembly's diagonal, held at the largest plane at z min, pulled at that at z max by 100 along x, y and z
(FILE@x: of x), and solved by ccx at orders 1 and 2: nodes shared; contacts opened and tied; one of them with friction .2 and the others tied. That is the largest one
without which all parts hang together still: no friction without pressure holds a part. A run is good if ccx ends and the reaction is the load within
.1 %. One thread. On the page rows of other assemblies stay as they are. Needs ccx and a built octafront with CAD (build/release, or OCTAFRONT=FILE). Status 1 if any run is not good.
"""
import argparse
import collections
import json
import math
import os
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_measured

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
PLANE, FORCE, PART, NEAR = "largest plane at {} {}", 100, 20, 1e-3
HEAD = ["assembly", "parts", "contacts", "how", "order", "elements", "CPU s, mesh", "CPU s, ccx", "reaction off, %", "outcome"]
Run = collections.namedtuple("Run", "mesh solve elements off outcome", defaults=(0, 0, 0, math.nan, "good"))


def pieces(parts, contacts):
    """How many pieces the parts hang together in."""
    piece = {p: p for p in parts}
    for a, b in contacts:
        piece = {p: piece[a] if q == piece[b] else q for p, q in piece.items()}
    return len(set(piece.values()))


def sliding(told):
    """The patch of the largest contact without which no part comes off; None if there is none."""
    touching = sorted((c for c in told["contacts"] if "patch" in c), key=lambda c: -c["area"])
    parts = [s["name"] for s in told["solids"]]
    for chosen in touching:
        rest = [c["solids"] for c in touching if c["patch"] != chosen["patch"]]
        if pieces(parts, rest) == pieces(parts, [c["solids"] for c in touching]):
            return chosen["patch"]
    return None


def ways(told):
    """How contacts are taken: options by law and order."""
    laws = {"shared": [], "tied": ["--contacts", "split"]}
    if patch := sliding(told):
        laws["friction"] = ["--contacts", "split", "--friction", f"{patch}=.2"]
    return {(law, order): [*options, "--order", order] for law, options in laws.items() for order in "12"}


def reaction(folder):
    """The last total force of ccx, at all supports together; None if there is none."""
    told = pathlib.Path(folder, "job.dat")
    found = re.findall(r"total force.*\n\n(.*)\n", told.read_text()) if told.is_file() else []
    return [float(x) for x in found[-1].split()] if found else None


def one(file, axis, size, options, seconds):
    with tempfile.TemporaryDirectory() as folder:
        made = run_measured([OCTAFRONT, "mesh", file, "-o", "job.inp", "--json", "report.json", "--threads", "1", "--size", repr(size), "--fix",
                             PLANE.format(axis, "min"), "--load", f"{PLANE.format(axis, 'max')}={FORCE},{FORCE},{FORCE}", *options], folder, seconds)
        if made.error:
            return Run(made.cpu_seconds, outcome="mesh: " + made.error)
        elements = json.loads(pathlib.Path(folder, "report.json").read_text())["tets"]
        solved = run_measured(["ccx", "job"], folder, seconds)
        forces = reaction(folder)
        if solved.error or not forces:
            return Run(made.cpu_seconds, solved.cpu_seconds, elements, outcome="ccx: " + (solved.error or "no forces"))
        off = max(abs(f / -FORCE - 1) for f in forces)
        return Run(made.cpu_seconds, solved.cpu_seconds, elements, off, "good" if off < NEAR else "reaction")


def info(file):
    with tempfile.TemporaryDirectory() as folder:
        run_measured([OCTAFRONT, "info", file, "--json", "info.json"], folder, 300)
        told = pathlib.Path(folder, "info.json")
        return json.loads(told.read_text()) if told.is_file() else {}


def with_others(rows):
    """Before these the rows of the page's other assemblies, as they are."""
    made = {row[0] for row in rows}
    before = [[f"{int(cell):,}" if k == HEAD.index("elements") else cell for k, cell in enumerate(row)] for row in tables.rows_of("assemblies")]
    return [row for row in before if row[0] not in made] + rows


def by_assembly(rows):
    """A line for each assembly: what CalculiX took of each way, or why that is not good."""
    ways = [(how, order) for how in ("shared", "tied", "friction") for order in "12"]

    def said(its, how, order):
        run = next((row for row in its if (row[3], str(row[4])) == (how, order)), None)
        return "" if run is None else run[7] if run[9] == "good" else run[9].replace("ccx: ", "")

    lines = []
    for name in dict.fromkeys(row[0] for row in rows):
        its = [row for row in rows if row[0] == name]
        lines.append([*its[0][:3], its[0][5], *(said(its, *way) for way in ways)])
    return tables.table(["assembly", "parts", "contacts", "elements, order 1", *(f"{how}, order {order}" for how, order in ways)], lines)


def page(rows, arguments):
    rows = with_others(rows)
    good = sum(row[-1] == "good" for row in rows)
    tables.write("assemblies", [
        "# Assemblies, from STEP to a solved job", "",
        f"{written_by('bench/campaigns/assemblies.py ' + ' '.join(pathlib.Path(f).name for f in arguments.files) + ' --page')}: {good} of {len(rows)} good.", "",
        f"Each is meshed at a twentieth of its diagonal, held at the largest plane at z min (of x where it says so), pulled at that at z max by {FORCE} along each axis, and solved by CalculiX: one"
        " command for the mesh with its job, one to solve it. Contacts share nodes, or are opened and tied, or the largest one without which no part comes off"
        " has friction .2. Good: the solver ends, and the reaction is the load within .1 %.", "",
        "CPU seconds of CalculiX, or what was wrong:", "", *by_assembly(rows), "", f"Each run: {tables.put('assemblies', HEAD, rows)}."])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--page", action="store_true")
    arguments = parser.parse_args()
    rows = []
    for given in arguments.files:
        name, _, axis = given.partition("@")
        file = pathlib.Path(name)
        told = info(file.resolve())
        if not told.get("solids"):
            print(f"{file.name}: no solids", flush=True)
            continue
        for (law, order), options in ways(told).items():
            run = one(file.resolve(), axis or "z", math.dist(*told["box"]) / PART, options, arguments.seconds)
            rows.append([file.stem + (f", {axis}" if axis else ""), len(told["solids"]), len(told.get("contacts", [])), law, order, f"{run.elements:,}", f"{run.mesh:.1f}",
                         f"{run.solve:.1f}", f"{100 * run.off:.4f}", run.outcome])
            print(*rows[-1], sep="  ", flush=True)
    if arguments.page:
        page(rows, arguments)
    return 1 if any(row[-1] != "good" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
