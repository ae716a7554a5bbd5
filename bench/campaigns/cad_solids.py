#!/usr/bin/python3
"""Meshes generated CAD solids (bench/models/cad_solids.py) and judges each run; writes docs/measured/cad-solids.md.

  bench/campaigns/cad_solids.py [FIRST:END] [--seed N] [--page]

Each is meshed with automatic sizes, linear and of second order, and with a --size of a fiftieth of its diagonal. A run is good if `octafront check`
finds the mesh valid, and its volume is within 1 % of OpenCASCADE's (of second order .1 %); a size that is given may lose more if a note says so.
One thread. Needs Gmsh's Python module and a built
octafront with CAD (build/release, or OCTAFRONT=FILE). Status 1 if any run is not good.
"""
import argparse
import collections
import json
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from bench.models import cad_solids
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_measured, waited

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
SECONDS = 300
WAYS = {"automatic": (["--order", "1"], .01), "of second order": (["--order", "2"], .001), "a fiftieth": (["--size"], .01)}
"""How, and how far volumes may be off."""
HEAD = ["family", "how", "runs", "good", "elements, median", "elements, most", "CPU s, most", "volume off, worst, %", "mean β", "least β", "least angle, °"]
Run = collections.namedtuple("Run", "number family way fault elements cpu off mean least angle")


def one(number, family, way, file, volume, diagonal, folder):
    options, most = WAYS[way]
    if options == ["--size"]:
        options = ["--size", repr(diagonal / 50)]
    ended = run_measured([OCTAFRONT, "mesh", file, "-o", "made.vtu", "--json", "report.json", "--threads", "1", "--quiet", *options], folder, SECONDS)
    report = pathlib.Path(folder, "report.json")
    if ended.error or not report.is_file():
        return Run(number, family, way, ended.error or "no report", 0, ended.cpu_seconds, 0, 0, 0, 0)
    told = json.loads(report.read_text())
    report.unlink()
    off, quality = told["volume"] / volume - 1, told["quality"]
    said = options[0] == "--size" and any("volume" in note for stage in told["stages"] for note in stage["notes"])
    fault = f"volume {100 * off:+.3f} %" if abs(off) > most and not said else ""
    if waited([OCTAFRONT, "check", "made.vtu"], SECONDS, folder)[0] != 0:
        fault = "not valid"
    return Run(number, family, way, fault, told["tets"], ended.cpu_seconds, off, quality["beta_mean"], quality["beta_min"],
               quality["dihedral_min_degrees"])


def cells(family, way, runs):
    made = [r for r in runs if r.elements]
    elements = sorted(r.elements for r in made)
    return [family.replace("_", " "), way, len(runs), sum(not r.fault for r in runs), f"{elements[len(elements) // 2]:,}", f"{elements[-1]:,}",
            f"{max(r.cpu for r in runs):.1f}", f"{100 * max((abs(r.off) for r in made)):.3f}", f"{sum(r.mean for r in made) / len(made):.3f}",
            f"{min(r.least for r in made):.3f}", f"{min(r.angle for r in made):.1f}"]


def page(runs, arguments):
    rows = []
    for family in [*cad_solids.FAMILIES, "all"]:
        for way in WAYS:
            here = [r for r in runs if family in (r.family, "all") and r.way == way]
            if any(r.elements for r in here):
                rows.append(cells(family, way, here))
    tables.write("cad-solids", [
        "# Generated CAD solids", "",
        f"{written_by(f'bench/campaigns/cad_solids.py {arguments.cases} --page')}: {len(cad_solids.FAMILIES)} families, {len(runs)} runs, one thread.", "",
        "A run is good if the mesh is valid and its volume within 1 % of OpenCASCADE's, of second order .1 %; a size that is given may lose more if a note says so. Sizes are automatic, or a fiftieth of"
        " the diagonal.", "",
        *tables.table(HEAD, rows[-len(WAYS):]), "", f"Each family: {tables.put('cad-solids', HEAD, rows)}.", "",
        "Not good:", "", *([f"- {r.number} {r.family.replace('_', ' ')}, {r.way}: {r.fault}" for r in runs if r.fault] or ["- none"])])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="?", default="0:54", metavar="FIRST:END")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--page", action="store_true")
    arguments = parser.parse_args()
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(*map(int, arguments.cases.split(":"))):
            file = pathlib.Path(folder, f"{number:03}.step")
            family, volume, diagonal = cad_solids.make(number, file, arguments.seed)
            for way in WAYS:
                runs.append(one(number, family, way, file, volume, diagonal, folder))
                if runs[-1].fault:
                    print(f"{number} {family}, {way}: {runs[-1].fault}", flush=True)
    print(f"{sum(not r.fault for r in runs)} of {len(runs)} good; {sum(r.cpu for r in runs):.0f} CPU s")
    if arguments.page:
        page(runs, arguments)
    return 1 if any(r.fault for r in runs) else 0


if __name__ == "__main__":
    sys.exit(main())
