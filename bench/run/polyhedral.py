"""The polyhedral dual beside its tetrahedra and OpenFOAM's polyDualMesh: cells, what checkMesh says, layers, volumes, seconds; and a flow with
a known answer on both.

Usage: bench/run.sh polyhedral [--only SUBSTRING] [--program OCTAFRONT] [--no-flow]
Generates bodies, takes the samples and models/clean, and writes docs/measured/polyhedral.md.
"""
import argparse
import pathlib
import subprocess
import tempfile
import time

from bench.judges.foam_mesh import check_mesh, environment, FoamMesh, new_case, verdict
from bench.models import layers_bodies as bodies
from bench.pages import tables
from bench.pages.origin import ROOT, written_by
from bench.run import layers_solved as flow

LAYERS = 4
LAYERED = ["--layers", LAYERS, "--first-part", 0.1, "--growth", 1.2, "--on"]
BOX = {"far": bodies.in_box({}, (-60, -50, -30), (90, 50, 30))["far"]}
# name: body (generated, or files), options, the layered patch
MODELS = {
    "ball": (bodies.ball, ["--size", 0.12], None),
    "bunny": ([ROOT / "models/clean/bunny00.off"], ["--elements", 50000], None),
    "CAD part (bracket)": ([ROOT / "samples/bracket.stl"], ["--size", 3], None),
    "the same, coarse": ([ROOT / "samples/bracket.stl"], ["--size", 6], None),
    "gear": ([ROOT / "samples/gear.obj"], ["--elements", 30000], None),
    "U-bend, layers": (bodies.u_bend, ["--size", 0.2, *LAYERED, "wall"], "wall"),
    "knot in a box, two regions": ([BOX, ROOT / "samples/torus_knot.ply"], ["--elements", 60000], None),
    "wedge of 20 degrees in a flow, layers": (lambda: bodies.in_box({"body": bodies.wedge(20)["wall"]}, (-1, -1.5, -1), (3, 1.5, 2)),
                                              ["--nested", "cavity", "--elements", 40000, *LAYERED, "body"], "body"),
}


def sources(model, folder):
    """Files of a model, generated ones as in0.obj and so on."""
    files = []
    for i, source in enumerate(model if isinstance(model, list) else [model()]):
        files.append(source)
        if isinstance(source, dict):
            files[-1] = folder / f"in{i}.obj"
            bodies.write_obj(files[-1], source)
    return files


def run(command, folder=".", timeout=600):
    """Its seconds; ends the benchmark if it fails."""
    begin = time.perf_counter()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, env=environment(), cwd=folder)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-1000:]}{done.stderr[-1000:]}")
    return time.perf_counter() - begin


def whole_columns(mesh, patch):
    """The part of the faces of a patch on which all layers stand as prisms; of those amid the patch: at its rim prisms have more corners."""
    faces = mesh.patches[patch]
    inside = [mesh.stack(f, LAYERS) for f in faces]
    return sum(len(stack) == LAYERS for stack in inside) / len(inside)


def measured(kind, case, patch, seconds):
    """A row of a polyMesh."""
    mesh, foam = FoamMesh(case), check_mesh(case)
    volumes = flow.geometry(mesh)[3]
    return {"mesh": kind, "cells": foam["cells"], "checkMesh": verdict(foam), "n-o": foam["non_orthogonality"], "mean n-o": foam["mean_non_orthogonality"],
            "skewness": foam["skewness"], "volume": float(volumes.sum()), "columns": None if patch is None else whole_columns(mesh, patch), "s": seconds}


def rows_of(program, name, folder):
    model, options, patch = MODELS[name]
    files = sources(model, folder)
    run([program, "mesh", *files, *options, "-q", "--threads", 1, "-o", folder / "mesh.vtu"])
    rows = []
    for kind, more in (("tetrahedra", []), ("dual", ["--polyhedral"])):
        case = folder / kind
        (case / "constant").mkdir(parents=True)
        seconds = run([program, "convert", folder / "mesh.vtu", "-q", "--threads", 1, *more, "-o", case / "constant/polyMesh"])
        rows.append(measured(kind, case, patch, seconds))
    for kind, more in (("polyDualMesh", []), ("polyDualMesh, split", ["-concaveMultiCells", "-splitAllFaces"])):
        case = folder / kind.replace(", ", "-")
        (case / "constant").mkdir(parents=True)
        run(["cp", "-r", folder / "tetrahedra/constant/polyMesh", case / "constant"])
        for zones in (case / "constant/polyMesh").glob("*Zones"):
            zones.unlink()  # it cannot carry them
        new_case(case)
        seconds = run(["polyDualMesh", "40", "-overwrite", *more, "-case", case], case)  # leaves files where it is started
        rows.append(measured(kind, case, patch, seconds))
    return rows


HEAD = ["model", "mesh", "cells", "checkMesh", "n-o", "mean n-o", "skewness", "volume, %", "columns, %", "s"]


def cells_of(name, rows):
    """Rows as they are shown; volumes beside that of the tetrahedra."""
    whole = rows[0]["volume"]
    share = lambda x: "" if x is None else f"{100 * x:.0f}"
    return [[name, r["mesh"], f"{r['cells']:,}", r["checkMesh"], f"{r['n-o']:.0f}", f"{r['mean n-o']:.1f}", f"{r['skewness']:.2f}",
             f"{100 * (r['volume'] / whole - 1):+.2f}", share(r["columns"]), f"{r['s']:.2f}"] for r in rows]


def shown(rows):
    """Without those of the split dual and of some models, which a page has no room for."""
    few = [row for row in rows if "split" not in row[1] and row[0] not in ("ball", "gear", "the same, coarse", "knot in a box, two regions")]
    return [*tables.some(HEAD, few, [column for column in HEAD if column != "s"]), "", f"All models, with seconds: {tables.put('polyhedral', HEAD, rows)}."]


FLOW_SIZES = (0.3, 0.2)
FLOW_HEAD = flow.HEAD


def flow_rows(program):
    """Poiseuille's flow: dual and tetrahedra on one surface, and tetrahedra of as many cells as the dual has."""
    rows = []
    for size in FLOW_SIZES:
        options = ["--size", size, *flow.LAYERS]
        dual = flow.solved(program, [*options, "--polyhedral"])
        for what, row in ((f"edges {size}, dual", dual), (f"edges {size}, tetrahedra and wedges", flow.solved(program, options)),
                          ("as many cells, tetrahedra", flow.solved(program, ["--elements", dual["cells"]]))):
            rows.append(flow.line(what, row))
            print(tables.row(rows[-1]), flush=True)
    return rows


ABOUT = ("`octafront convert --polyhedral` from the tetrahedra (and wedges of 4 layers, 1/10 of the edges, growth 1.2) of one mesh, beside OpenFOAM's polyDualMesh "
         "(v1912, feature angle 40; *split*: -concaveMultiCells -splitAllFaces), which cannot carry zones. *n-o*: non-orthogonality in degrees, most and "
         "mean; *skewness*: checkMesh wants at most 4; *volume*: beside that of the tetrahedra, whose chords lie inside of convex bodies; *columns*: faces of the layered patch on which all layers stand as prisms one over the other.")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--program", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--no-flow", action="store_true")
    a = arguments.parse_args()
    program = (a.program or a.build / "cli/octafront").resolve()
    rows = []
    for name, (model, *_) in MODELS.items():
        if a.only not in name or (isinstance(model, list) and not all(isinstance(m, dict) or m.exists() for m in model)):
            continue
        with tempfile.TemporaryDirectory() as folder:
            rows += cells_of(name, rows_of(program, name, pathlib.Path(folder)))
        for row in rows[-4:]:
            print(tables.row(row), flush=True)
    if a.only:
        return
    lines = ["# The polyhedral dual", "", f"{written_by('bench/run.sh polyhedral')}. {ABOUT}", "", *shown(rows)]
    if not a.no_flow:
        solved = flow_rows(program)
        lines += ["", "## A laminar pipe", "", "Poiseuille's flow as on [the page of layers](layers-solved.md), whose words these are.", "",
                  *tables.some(FLOW_HEAD, solved[3:], [c for c in FLOW_HEAD if c not in ("iterations", "s")]), "", f"With edges of .3: {tables.put('polyhedral-flow', FLOW_HEAD, solved)}."]
    tables.write("polyhedral", lines)


if __name__ == "__main__":
    main()
