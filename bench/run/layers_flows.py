"""Boundary layers as flows want them: around bodies in a box, and in vessels whose ends are bare.

Usage: bench/run.sh layers_flows [--only SUBSTRING] [--vessels FOLDER] [--program OCTAFRONT]
Bodies: a generated wing, and those of models/flows. Vessels: STL files of FOLDER, as they come: open ends are closed by repair. Each mesh is an OpenFOAM case
that checkMesh judges. Keeps results in BUILD/layers_flows.json; writes a part of docs/measured/layers-flows.md.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from bench.judges.foam_mesh import check_mesh, verdict
from bench.models import layers_bodies as bodies, solids
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_bounded

ROOT = pathlib.Path(__file__).resolve().parents[2]

CASES = [(3, 0.1), (5, 0.1), (3, 0.02)]
GROWTH = 1.2
FLOWS = {  # name: (body, edge length on it, more)
    "wing": (lambda: bodies.wing()["body"], 0.03, ["--curvature", 30]),
    "motorbike": ("motorBike", 0.01, []), "car": ("simpleCar", 0.06, []), "propeller tip": ("propellerTip", 0.004, []),
    "fan": ("fan", 0.03, []),
}
CASES_OF = {"motorbike": CASES[:1]}  # five million cells each
VESSEL_SIZE = 0.01  # of the diagonal


def extent(points):
    return points.min(axis=0), points.max(axis=0), float(np.linalg.norm(np.ptp(points, axis=0)))


def make_flow(name, folder):
    """Options; in.obj is the body in a box that reaches a diagonal farther on all sides."""
    body, size, more = FLOWS[name]
    part = body() if callable(body) else tuple(solids.read_off(ROOT / f"models/flows/{body}.off"))
    low, high, diagonal = extent(part[0])
    bodies.write_obj(folder / "in.obj", bodies.in_box({"body": part}, low - diagonal, high + diagonal))
    return ["--nested", "cavity", "--size", diagonal / 5, "--size-of", f"body={size}", "--gradation", 0.3, "--on", "body", *more]


def make_vessel(path, program, folder):
    """in.obj has the patches `wall` and, where repair closed it, `ends`."""
    subprocess.run([program, "repair", path, "-q", "-o", folder / "mended.obj"], check=True, timeout=120)
    read = bodies.read_obj(folder / "mended.obj")
    patches = {"ends" if name == "closed by repair" else "wall": part for name, part in read.items()}
    bodies.write_obj(folder / "in.obj", patches)
    return ["--size", VESSEL_SIZE * extent(patches["wall"][0])[2], "--on", "wall"]


def measure(program, options, case, folder):
    layers, part = case
    (folder / "constant").mkdir()
    status, said, cpu, memory = run_bounded([program, "mesh", folder / "in.obj", *options, "--layers", layers, "--first-part", part, "--growth", GROWTH, "-q",
                                     "--threads", 1, "--json", folder / "out.json", "-o", folder / "constant/polyMesh"], 400)
    if status != 0:
        return {"error": said.splitlines()[-1] if said else f"status {status}"}
    return {"wall": json.loads((folder / "out.json").read_text())["layers"][0], "foam": check_mesh(folder), "cpu": cpu, "memory": memory}


HEAD = ["body", "layers x first height", "faces", "cells", "full, %", "stopped by", "SJ", "checkMesh", "n-o", "faces > 70", "skewness", "CPU s"]
ABOUT = ("Bodies in a box that reaches a diagonal farther on all sides, layers on the body; vessels with layers on their walls, none on their ends (edges of a "
         "hundredth of the diagonal). Growth 1.2, one thread. The wing is NACA 0012 with a sharp trailing edge, the other bodies are OpenFOAM's examples, mended (`bench/models/get-flows.sh`), the vessels public test data of vmtk and vmtk4aneurysms. *n-o*: most non-orthogonality, degrees; *skewness*: the most, checkMesh wants at most 4.")


def shown(rows):
    """Rows of cells: the bodies one by one, the vessels together."""
    bodies = [r for r in rows if not r[0].startswith("vessel")]
    vessels = [r for r in rows if r[0].startswith("vessel")]
    shown = ["full, %", "SJ", "n-o", "skewness", "CPU s"]
    columns = ["body", "layers x first height", "cells", "full, %", "SJ", "checkMesh", "faces > 70", "CPU s"]
    return [*tables.some(HEAD, [r for r in bodies if r[1] == "3 x 1/10"], columns), "", f"The {len({r[0] for r in vessels})} vessels:", "",
            *tables.spread_by("layers x first height", HEAD, vessels, shown), "", f"Each: {tables.put('layers-flows', HEAD, rows)}."]


def line(name, case, row):
    if "error" in row:
        return [name, case, "", "", "", f"no mesh: {row['error']}", *[""] * (len(HEAD) - 6)]
    wall, foam = row["wall"], row["foam"]
    stopped = ", ".join(f"{why} {100 * share:.2g} %" for why, share in wall["stopped"].items())
    return [name, case, f"{wall['faces']:,}", f"{foam['cells']:,}", f"{100 * wall['share_full']:.1f}", stopped or "-", f"{wall['least_scaled_jacobian']:.3f}",
            verdict(foam), f"{foam['non_orthogonality']:.1f}", foam["severe"], f"{foam['skewness']:.1f}", f"{row['cpu']:.1f}"]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--vessels", type=pathlib.Path)
    arguments.add_argument("--program", type=pathlib.Path)
    arguments.add_argument("--again", action="store_true")
    a = arguments.parse_args()
    program = (a.program or a.build / "cli/octafront").resolve()
    makers = {name: lambda folder, name=name: make_flow(name, folder) for name in FLOWS}
    for path in sorted(a.vessels.glob("*.stl")) if a.vessels else ():
        makers[f"vessel {path.stem}"] = lambda folder, path=path.resolve(): make_vessel(path, program, folder)
    kept = a.build / "layers_flows.json"
    results = json.loads(kept.read_text()) if kept.exists() and not a.again else {}
    for name, make in makers.items():
        for case in CASES_OF.get(name, CASES):
            key = f"{name}|{case[0]} x 1/{round(1 / case[1])}"
            if a.only not in name or key in results:
                continue
            with tempfile.TemporaryDirectory() as temporary:
                folder = pathlib.Path(temporary)
                results[key] = measure(program, make(folder), case, folder)
            kept.write_text(json.dumps(results))
            print(tables.row(line(*key.split("|"), results[key])), flush=True)
    order = [*FLOWS, *sorted({key.split("|")[0] for key in results} - {*FLOWS})]
    rows = [line(*key.split("|"), results[key]) for key in sorted(results, key=lambda key: order.index(key.split("|")[0]))]
    tables.rewrite(tables.MEASURED / "layers-flows.md", "flows", [f"{written_by('bench/run.sh layers_flows --vessels FOLDER')}. {ABOUT}", "", *shown(rows)])


if __name__ == "__main__":
    main()
