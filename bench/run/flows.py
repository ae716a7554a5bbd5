"""Flows around bodies, from a surface to the drag: octafront mesh --wind-tunnel --layers --yplus --deck, then OpenFOAM's checkMesh and simpleFoam, with
the case as it was written. Tetrahedra and polyhedra.

Usage: bench/run.sh flows [--only SUBSTRING] [--program OCTAFRONT] [--keep FOLDER]
Keeps results in BUILD/flows.json; writes docs/measured/flows.md.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import tempfile

from bench.judges.foam_mesh import check_mesh, environment, verdict
from bench.models import flow_bodies, layers_bodies
from bench.pages import tables
from bench.pages.origin import ORIGIN, ROOT, written_by
from bench.process import run_bounded

AHMED = ["--wind-tunnel", "-3,0,0:6,1.5,1.5", "--speed", 40, "--layers", 4, "--yplus", 50]
# Faces between the layers of both sides of a sharp edge are skew unless edges there are about ten times as long as the first layer is high.
WING = ["--wind-tunnel", "-6,0,-6:11,6,6", "--speed", 30, "--layers", 3, "--yplus", 100, "--size", 0.1, "--curvature", 8, "--gradation", 0.4,
        "--size-of", "box:0.97,-0.1,-0.1,1.01,1.01,-0.07=0.012"]
# name: (body or file, options, area of the coefficients (None: that of the deck), published drag and lift)
CASES = {
    "Ahmed's car, edges 60 mm": (flow_bodies.ahmed, [*AHMED, "--size", 0.06, "--size-of", "box:0.9,-0.1,0,1.8,0.25,0.4=0.08"], None, ".285", ""),
    "Ahmed's car, edges 40 mm": (flow_bodies.ahmed, [*AHMED, "--size", 0.04, "--size-of", "box:0.9,-0.1,0,2,0.3,0.45=0.05"], None, ".285", ""),
    "Ahmed's car, edges 28 mm": (flow_bodies.ahmed, [*AHMED, "--size", 0.028, "--size-of", "box:0.9,-0.1,0,2,0.3,0.45=0.04"], None, ".285", ""),
    "Ahmed's car, edges 20 mm": (flow_bodies.ahmed, [*AHMED, "--size", 0.02, "--size-of", "box:0.9,-0.1,0,2,0.3,0.45=0.03"], None, ".285", ""),
    "wing of aspect ratio 2, 5 degrees": (lambda: flow_bodies.wing(2, 5), WING, 1.0, ".017", ".227"),
    "bracket": (ROOT / "samples/bracket.stl", ["--unit", "mm", "--wind-tunnel", "auto", "--speed", 30, "--size", 4, "--size-of",
                                               "box:20,-30,-10,120,30,60=8", "--layers", 3, "--yplus", 30, "--gradation", 0.3], None, "", ""),
}
KINDS = {"tetrahedra": [], "polyhedra": ["--polyhedral"]}


def mesh_case(program, case, folder, kind):
    body, options, *_ = CASES[case]
    (folder / "constant").mkdir(parents=True)
    source = body
    if callable(body):
        source = folder / "body.obj"
        layers_bodies.write_obj(source, body())
    status, said, cpu, _ = run_bounded([program, "mesh", source, *options, *KINDS[kind], "--fluid", "air", "--deck", "-q", "--threads", 1, "--json",
                                        folder / "out.json", "-o", folder / "constant/polyMesh"], 400)
    if status != 0:
        raise SystemExit(f"{case}: {said}")
    return cpu, json.loads((folder / "out.json").read_text())["layers"]


def solve(folder, area):
    """Iterations until it says that it has converged, or that it was given; residuals and coefficients of the last one."""
    done = subprocess.run(["prlimit", "--cpu=900", "simpleFoam", "-case", folder], capture_output=True, text=True, env=environment(), timeout=7200)
    (folder / "log.simpleFoam").write_text(done.stdout + done.stderr)
    if done.returncode != 0:
        return {"error": (done.stdout + done.stderr).strip().splitlines()[-1]}
    last = lambda name: float(re.findall(rf"Solving for {name}, Initial residual = (\S+),", done.stdout)[-1])
    rows = [line.split() for line in next(folder.glob("postProcessing/forceCoeffs/0/*.dat")).read_text().splitlines() if not line.startswith("#")]
    scale = 1 if area is None else float(re.search(r"Aref ([^;]+);", (folder / "system/controlDict").read_text())[1]) / area
    drags = [scale * float(row[1]) for row in rows[-10:]]
    return {"converged": "SIMPLE solution converged" in done.stdout, "iterations": len(rows), "U": max(map(last, ("Ux", "Uy", "Uz"))),
            "drag": drags[-1], "spread": max(drags) - min(drags), "lift": scale * float(rows[-1][3]),
            "yplus": re.findall(r"average = (\S+)", done.stdout)[:1], "cpu": float(re.findall(r"ExecutionTime = ([\d.]+)", done.stdout)[-1])}


def measured(program, case, kind, folder):
    cpu, layers = mesh_case(program, case, folder, kind)
    return {"origin": ORIGIN, "mesh cpu": cpu, "full": min(wall["share_full"] for wall in layers), "foam": check_mesh(folder), "flow": solve(folder, CASES[case][2])}


HEAD = ["flow", "mesh", "cells", "layers full, %", "checkMesh", "n-o", "skewness", "meshing, CPU s", "iterations", "drag", "in 10 iterations", "published drag", "lift", "published lift", "y+",
        "simpleFoam, CPU s"]


def line(case, kind, row):
    foam, flow = row["foam"], row["flow"]
    start = [case, kind, f"{foam['cells']:,}", f"{100 * row['full']:.1f}", verdict(foam), f"{foam['non_orthogonality']:.0f}", f"{foam['skewness']:.1f}", f"{row['mesh cpu']:.1f}"]
    if "error" in flow:
        return [*start, flow["error"], *[""] * (len(HEAD) - 9)]
    iterations = str(flow["iterations"]) if flow["converged"] else f"{flow['iterations']}, not yet"
    return [*start, iterations, f"{flow['drag']:.4f}", f"{flow['spread']:.4f}", CASES[case][3], f"{flow['lift']:.4f}", CASES[case][4], "".join(f"{float(y):.0f}" for y in flow["yplus"]),
            f"{flow['cpu']:.0f}"]


ABOUT = ("A surface, one command of Octafront's, and OpenFOAM's simpleFoam (v1912) on the case that `--deck` wrote, as it was written: k-omega SST, wall functions, "
         "a fluid of 1.5e-5 m2/s, one core. *Iterations*: until the residuals are below what the case asks for; *in 10 iterations*: by how much the drag changed in the last of them.")


def page(results):
    rows = [line(*key.split("|"), results[key]) for case in CASES for kind in KINDS for key in [f"{case}|{kind}"] if key in results]
    origins = sorted({row["origin"] for row in results.values()})
    few = [c for c in HEAD if c not in ("layers full, %", "meshing, CPU s", "y+", "in 10 iterations", "skewness")]
    shown = [r for r in rows if "60 mm" not in r[0] and "28 mm" not in r[0]]
    tables.write("flows", ["# Bodies in a flow, solved", "", f"{written_by('bench/run.sh flows', origins)}. {ABOUT}", "", *tables.some(HEAD, shown, few), "",
                           f"Two more sizes of the car, and more columns: {tables.put('flows', HEAD, rows)}.", ""])


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--program", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--keep", type=pathlib.Path, help="the cases stay here")
    a = arguments.parse_args()
    program, kept = (a.program or a.build / "cli/octafront").resolve(), a.build / "flows.json"
    known = lambda: json.loads(kept.read_text()) if kept.exists() else {}
    for kind in KINDS:
        for case in CASES:
            if a.only not in (key := f"{case}|{kind}") or key in known():
                continue
            with tempfile.TemporaryDirectory() as temporary:
                folder = (a.keep or pathlib.Path(temporary)).resolve() / re.sub(r"\W+", "-", key)
                shutil.rmtree(folder, ignore_errors=True)
                row = measured(program, case, kind, folder)
            kept.write_text(json.dumps(known() | {key: row}))
            print(tables.row(line(case, kind, row)), flush=True)
    page(known())


if __name__ == "__main__":
    main()
