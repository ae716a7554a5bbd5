#!/usr/bin/python3
"""Assemblies from STEP to a solved job, one command each: writes docs/measured/assemblies.md.

  bench/campaigns/assemblies.py FILE.step ... [--page] [--seconds S]

Each part is meshed at a fortieth of the assembly's diagonal, held at the largest plane at z min, pulled at that at z max by 100 along x, y and z,
and solved by ccx: contacts tied, and with friction .2, at orders 1 and 2. A run is good if ccx ends and the reaction is the load within .1 %. One
thread. Needs ccx and a built octafront with CAD (build/release, or OCTAFRONT=FILE). Status 1 if any run is not good.
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
HELD, PULLED, FORCE, PART, NEAR = "largest plane at z min", "largest plane at z max", 100, 40, 1e-3
WAYS = {(law, order): [*options, "--order", order] for law, options in
        {"shared": [], "tied": ["--contacts", "split"], "friction": ["--contacts", "split", "--friction", ".2"]}.items() for order in "12"}
HEAD = ["assembly", "parts", "contacts", "how", "order", "elements", "CPU s, mesh", "CPU s, ccx", "reaction off, %", "outcome"]
Run = collections.namedtuple("Run", "mesh solve elements off outcome", defaults=(0, 0, 0, math.nan, "good"))


def reaction(folder):
    """The last total force of ccx, at all supports together; None if there is none."""
    told = pathlib.Path(folder, "job.dat")
    found = re.findall(r"total force.*\n\n(.*)\n", told.read_text()) if told.is_file() else []
    return [float(x) for x in found[-1].split()] if found else None


def one(file, size, options, seconds):
    with tempfile.TemporaryDirectory() as folder:
        made = run_measured([OCTAFRONT, "mesh", file, "-o", "job.inp", "--json", "report.json", "--threads", "1", "--size", repr(size), "--fix", HELD,
                             "--load", f"{PULLED}={FORCE},{FORCE},{FORCE}", *options], folder, seconds)
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


def page(rows, arguments):
    good = sum(row[-1] == "good" for row in rows)
    tables.write("assemblies", [
        "# Assemblies, from STEP to a solved job", "",
        f"{written_by('bench/campaigns/assemblies.py ' + ' '.join(f.name for f in arguments.files) + ' --page')}: {good} of {len(rows)} good.", "",
        f"Each is meshed at a fortieth of its diagonal, held at the {HELD}, pulled at the {PULLED} by {FORCE} along each axis, and solved by CalculiX: one"
        " command for the mesh with its job, one to solve it. Good: the solver ends, and the reaction is the load within .1 %.", "",
        *tables.table(HEAD, rows), "", f"The rows: {tables.put('assemblies', HEAD, rows)}."])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--page", action="store_true")
    arguments = parser.parse_args()
    rows = []
    for file in arguments.files:
        told = info(file.resolve())
        if not told.get("solids"):
            print(f"{file.name}: no solids", flush=True)
            continue
        for (law, order), options in WAYS.items():
            run = one(file.resolve(), math.dist(*told["box"]) / PART, options, arguments.seconds)
            rows.append([file.stem, len(told["solids"]), len(told.get("contacts", [])), law, order, f"{run.elements:,}", f"{run.mesh:.1f}",
                         f"{run.solve:.1f}", f"{100 * run.off:.4f}", run.outcome])
            print(*rows[-1], sep="  ", flush=True)
    if arguments.page:
        page(rows, arguments)
    return 1 if any(row[-1] != "good" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
