"""FreeCAD's FEM workbench from a body to CalculiX's answer: meshed by Gmsh, as FreeCAD does it, and by the workbench of addons/freecad.

Usage: bench/run.sh freecad [--program OCTAFRONT]
The jobs are those of bench/models/freecad_jobs.py, each in a process of freecadcmd. Octafront gets the sizes of Gmsh, and where that makes another number of
elements a size that makes about as many. Writes the table of docs/use/freecad.md.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from bench.ours import asked_program
from bench.pages import tables
from bench.pages.origin import ROOT, written_by

JOBS = {"bracket": "a bracket, force at its wall: its fillet", "plate": "a plate with a hole, pulled: the hole",
        "pipe": "a thick pipe, a quarter, pressed: its inner wall", "two_metals": "a bar of two metals, bent: its lower side"}
INSIDE = """
import json, os, sys
sys.path.insert(0, os.environ["OCTAFRONT_ROOT"] + "/bench/models")
import freecad_jobs
row = freecad_jobs.run(**json.loads(os.environ["OCTAFRONT_RUN"]))
with open(os.environ["OCTAFRONT_ROW"], "w") as file:
    json.dump(row, file)
"""
SECONDS = 1200


def run(program, **wanted):
    """freecad_jobs.run() in a freecadcmd with settings of its own. freecadcmd ends with status 0 whatever happens, so the row is what counts."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        script, row = folder / "run.py", folder / "row.json"
        script.write_text(INSIDE)
        around = {**os.environ, "HOME": str(folder), "OCTAFRONT": str(program), "OCTAFRONT_ROOT": str(ROOT), "OCTAFRONT_RUN": json.dumps(wanted),
                  "OCTAFRONT_ROW": str(row)}
        done = subprocess.run(["freecadcmd", str(script)], env=around, capture_output=True, text=True, errors="replace", timeout=SECONDS, check=False)
        if not row.exists():
            raise RuntimeError(f"{wanted}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        return json.loads(row.read_text())


def off(found, beside):
    return f"{100 * (found / beside - 1):+.2f} %"


def cells(name, gmsh, ours):
    """One job: ours beside Gmsh; both beside the formula, where there is one."""
    row = [JOBS[name], f"{gmsh['tets']:,}", f"{ours['tets']:,}", off(ours["displacement"], gmsh["displacement"]), off(ours["stress"], gmsh["stress"]),
           off(ours["peak"], gmsh["peak"])]
    if gmsh["exact_stress"]:
        row += [f"{off(gmsh['stress'], gmsh['exact_stress'])}, {off(ours['stress'], gmsh['exact_stress'])}"]
    else:
        row += [""]
    return [*row, f"{gmsh['mesh_seconds']:.1f}", f"{ours['mesh_seconds']:.1f}"]


HEAD = ["job, and where stress is read", "tetrahedra: Gmsh", "tetrahedra: ours", "displacement", "stress, mean", "stress, peak",
        "stress off the formula: Gmsh, ours", "s: Gmsh", "s: ours"]


def main():
    program = asked_program()
    rows = []
    for name in JOBS:
        gmsh = run(program, name=name, mesher="gmsh")
        rows.append(cells(name, gmsh, run(program, name=name, mesher="octafront", count=gmsh["tets"])))
        print(tables.row(rows[-1]), flush=True)
    page = ROOT / "docs/use/freecad.md"
    head = f"{written_by('bench/run.sh freecad')}; [as a file](../measured/rows/freecad.csv)."
    tables.put("freecad", HEAD, rows)
    part = "\n".join(["<!-- rows: begin -->", head, "", *tables.table(HEAD, rows), "<!-- rows: end -->"])
    page.write_text(re.sub(r"<!-- rows: begin -->.*?<!-- rows: end -->", lambda _: part, page.read_text(), flags=re.S))
    return 0


if __name__ == "__main__":
    sys.exit(main())
