"""Boundary layers beside snappyHexMesh and Gmsh: how much of the wall has all of them, at what cost, how good are they?

Usage: bench/run.sh layers_peers [--only SUBSTRING] [--by MESHER] [--program OCTAFRONT] [--timeout SECONDS] [--keep FOLDER]
All get the same surface, edge length, number of layers, first height and growth, and one thread; every mesh becomes an OpenFOAM case and is judged
by bench/judges/foam_mesh.py and checkMesh. Writes a part of docs/measured/layers-flows.md.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from bench.judges.foam_mesh import check_mesh, environment, FoamMesh, layers_on, new_case, verdict
from bench.models import layers_bodies as bodies, solids
from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import gmsh, snappy
from bench.process import run_measured

ROOT = pathlib.Path(__file__).resolve().parents[2]
GROWTH = 1.2
HEAD = ["body", "mesher", "wall faces", "cells", "all layers, % of area", "whole", "thickness, %", "SJ", "checkMesh", "n-o", "faces > 70", "CPU s"]
ABOUT = """The same surface, edge length at the wall and far from it, number of layers, first height and growth (1.2), one thread. A layer counts where a prism stands on the face, or on the layer below, with a height between half and twice what was asked. *All
layers*: part of the wall's area that has them all; *whole*: with at least 99 % of the height asked. snappyHexMesh (OpenFOAM 1912): cubes as large as triangles are long, sharp edges extracted, its `meshQualityDict.cfg` with `minTetQuality -1e30`. Gmsh 4.8.4: `extrudeBoundaryLayer` on Octafront's triangles of the wall, whose making is not in its time, HXT between."""


class Case:
    """A body, what lies around it or inside, and what is asked of its layers."""

    def __init__(self, body, walls, size, far, layers, first, box=None, place=(0, 0, 0)):
        self.body, self.walls, self.size, self.far, self.place = body, walls, size, far, place
        self.layers, self.first, self.box = layers, first, box
        self.heights = [first * GROWTH**k for k in range(layers)]

    def around(self):
        """The box that snappyHexMesh cuts: that of the flow, or one a cube larger than the body."""
        if self.box:
            return self.box
        points = np.concatenate([p for p, _ in self.body.values()])
        low, high = points.min(axis=0) - 0.731 * self.far, points.max(axis=0) + 0.617 * self.far
        return low, low + np.ceil((high - low) / self.far) * self.far


def model(name):
    solid = solids.read_off(ROOT / "models/clean" / name)
    return {"body": tuple(solid)}


def flow(name):
    solid = solids.read_off(ROOT / "models/flows" / name)
    return {"body": tuple(solid)}


def cases():
    def in_flow(body, margin, **more):
        points = np.concatenate([p for p, _ in body.values()])
        low, high = points.min(axis=0), points.max(axis=0)
        reach = margin * float(np.linalg.norm(high - low))
        box = (low - reach, high + reach)
        return Case(body, ["body"], box=box, place=tuple(low - 0.97 * reach), **more)
    return {
        "sphere in a box": lambda: in_flow({"body": bodies.ball()["wall"]}, 1.0, size=0.1, far=0.8, layers=3, first=0.01),
        "pipe with flat ends": lambda: Case(bodies.pipe(), ["wall"], 0.12, 0.12, 5, 0.01, place=(0.013, 0.017, 3.021)),
        "elephant, inside": lambda: Case(model("elephant.off"), ["body"], 0.015, 0.015, 3, 0.0015, place=(0.013, 0.017, 0.021)),
        "propeller tip in a box": lambda: in_flow(flow("propellerTip.off"), 1.0, size=0.003, far=0.048, layers=3, first=0.0003),
    }


def by_octafront(program, case, folder, timeout):
    body = bodies.in_box(case.body, *case.box) if case.box else case.body
    bodies.write_obj(folder / "in.obj", body)
    (folder / "constant").mkdir()
    flow = ["--nested", "cavity", "--size-of", f"body={case.size}"] if case.box else []
    return run_measured([program, "mesh", "in.obj", "--size", case.far if case.box else case.size, *flow, "--on", ",".join(case.walls), "--gradation", 0.3,
                         "--layers", case.layers, "--first", case.first, "--growth", GROWTH, "--threads", 1, "-q", "-o", "constant/polyMesh"],
                        folder, timeout), case.walls


def by_snappy(case, folder, timeout):
    bodies.write_obj(folder / "given.obj", case.body)
    return snappy.run(folder / "given.obj", folder, timeout, list(case.body), case.walls, (case.layers, case.first, GROWTH), case.size, case.far,
                      case.around(), case.place), case.walls


def by_gmsh(program, case, folder, timeout):
    """It gets Octafront's triangles, and keeps them where the surface is closed: it draws out discrete surfaces, but parametrises none
    without a rim."""
    has_ends = len(case.body) > 1
    bodies.write_obj(folder / "in.obj", case.body)
    subprocess.run([program, "surface", "in.obj", "--size", str(case.size), "-q", "-o", "anew.obj"], cwd=folder, check=True, timeout=timeout)
    write_off(folder / "wall.off", *bodies.merged(*bodies.together([bodies.read_obj(folder / "anew.obj")[wall] for wall in case.walls])))
    asked = {"surface": "wall.off", "flat_ends": has_ends, "box": [list(map(float, c)) for c in case.box] if case.box else None, "algorithm": gmsh.HXT,
             "tops": [(1 if case.box else -1) * top for top in np.cumsum(case.heights)], "size": case.size, "far": case.far, "out": "out.msh"}
    (folder / "in.json").write_text(json.dumps(asked))
    outcome = run_measured(["env", f"PYTHONPATH={ROOT}", "/usr/bin/python3", "-m", "bench.peers.gmsh_layers", "in.json"], folder, timeout)
    if not outcome.error and not (folder / "out.msh").exists():
        outcome.error = "it ended without a mesh"
    if not outcome.error:
        new_case(folder)
        subprocess.run(["gmshToFoam", "-case", folder, folder / "out.msh"], capture_output=True, env=environment(), timeout=timeout)
    return outcome, ["walls"]


def judged(case, run, timeout, keep=None):
    with tempfile.TemporaryDirectory() as temporary:
        folder = keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        outcome, walls = run(case, folder, timeout)
        if outcome.error:
            return ["", "", f"no mesh: {outcome.error[:70]}", *[""] * 6, f"{outcome.cpu_seconds:.1f}"]
        foam, mesh = check_mesh(folder), FoamMesh(folder)
        found = layers_on(mesh, walls, case.heights)
        least = found["least_scaled_jacobian"]
        return [f"{found['faces']:,}", f"{foam['cells']:,}", f"{100 * found['full_area']:.1f}", f"{100 * found['whole_area']:.1f}", f"{100 * found['thickness']:.1f}",
                "-" if least is None else f"{least:.3f}", verdict(foam), f"{foam['non_orthogonality']:.1f}", foam["severe"], f"{outcome.cpu_seconds:.1f}"]


def shown(rows):
    columns = ["body", "mesher", "cells", "all layers, % of area", "whole", "SJ", "n-o", "CPU s"]
    return [*tables.some(HEAD, [r for r in rows if r[0] != "sphere in a box"], columns), "", f"And what checkMesh says: {tables.put('layers-peers', HEAD, rows)}."]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--by", default="")
    arguments.add_argument("--program", type=pathlib.Path)
    arguments.add_argument("--timeout", type=float, default=600)
    arguments.add_argument("--keep", type=pathlib.Path)
    a = arguments.parse_args()
    program = (a.program or a.build / "cli/octafront").resolve()
    runs = {"Octafront": lambda *more: by_octafront(program, *more), "snappyHexMesh": by_snappy,
            "Gmsh": lambda *more: by_gmsh(program, *more)}
    lines = []
    for name, make in cases().items():
        if a.only not in name:
            continue
        case = make()
        for mesher, run in runs.items():
            if a.by not in mesher:
                continue
            lines.append([name, mesher, *judged(case, run, a.timeout, a.keep and a.keep / f"{name.split()[0]}-{mesher}")])
            print(tables.row(lines[-1]), flush=True)
    if not (a.only or a.by):
        tables.rewrite(tables.MEASURED / "layers-flows.md", "peers", [f"{written_by('bench/run.sh layers_peers')}. {ABOUT}", "", *shown(lines)])


if __name__ == "__main__":
    main()
