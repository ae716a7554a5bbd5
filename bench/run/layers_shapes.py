"""Boundary layers on bodies whose layers are known: all there, growth exact, ends flat? Judged from the nodes of the mesh files.

Usage: bench/run.sh layers_shapes [--only SUBSTRING] [--program OCTAFRONT]
Generates cube, sphere, pipes, torus, U-bend and wedges, meshes them with 3 layers of 1/10 and 8 of 1/50 of the edge length, and writes a
part of docs/measured/layers.md.
"""
import argparse
import json
import pathlib
import tempfile

import meshio
import numpy as np

from bench.judges.foam_mesh import check_mesh, SINE_OF_60, verdict
from bench.models import layers_bodies as bodies
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_bounded

GROWTH = 1.2
CASES = [(3, 0.1), (8, 0.02)]
# name: body, edge length, patches with layers (None: all)
SHAPES = {
    "cube": (bodies.cube, 0.06, None), "sphere": (bodies.ball, 0.12, None), "pipe, flat ends": (bodies.pipe, 0.15, "wall"),
    "pipe, turned askew": (bodies.turned_pipe, 0.15, "wall"), "torus": (bodies.ring, 0.08, None),
    "U-bend, flat ends": (bodies.u_bend, 0.15, "wall"), "wedge, 90 degrees": (lambda: bodies.wedge(90), 0.06, None),
    "wedge, 45 degrees": (lambda: bodies.wedge(45), 0.05, None), "wedge, 20 degrees": (lambda: bodies.wedge(20), 0.03, None),
    "wedge of 20 degrees in a flow": (lambda: bodies.in_box({"body": bodies.wedge(20)["wall"]}, (-1, -1.5, -1), (3, 1.5, 2)), 0.2, "body"),
}


def wedges_of(mesh):
    found = [block.data for block in mesh.cells if block.type == "wedge"]
    return np.concatenate(found) if found else np.zeros((0, 6), int)


def columns_of(wedges):
    """Nodes from the wall up, for each column of wedges."""
    above = {int(low): int(high) for i in range(3) for low, high in wedges[:, [i, i + 3]]}
    columns = []
    for low in above.keys() - set(above.values()):
        column = [low]
        while column[-1] in above:
            column.append(above[column[-1]])
        columns.append(column)
    return columns


def growth_error(points, columns):
    worst = 0.0
    for column in columns:
        heights = np.linalg.norm(np.diff(points[column], axis=0), axis=1)
        if len(heights) > 1:
            worst = max(worst, float(np.abs(heights[1:] / heights[:-1] / GROWTH - 1).max()))
    return worst


def least_scaled_jacobian(points, wedges):
    least = 2.0
    for base in (0, 3):
        for i in range(3):
            v, a, b, up = (wedges[:, k] for k in (base + i, base + (i + 1) % 3, base + (i + 2) % 3, 3 - base + i))
            u, w, x = points[a] - points[v], points[b] - points[v], points[up] - points[v]
            lengths = np.linalg.norm(u, axis=1) * np.linalg.norm(w, axis=1) * np.linalg.norm(x, axis=1)
            # Both triangles of a wedge turn one way, which is clockwise seen from inside on one of them.
            turn = np.einsum("ij,ij->i", np.cross(u, w), x) * (1 if base == 0 else -1)
            least = min(least, float(np.min(turn / lengths)) / SINE_OF_60)
    return least


def flatness(body, mesh, names):
    """Farthest node of these patches from the planes of the input's, over its diagonal."""
    patch = np.concatenate(mesh.cell_data["patch"]).ravel()
    numbers = {name.split(" ", 1)[1]: int(np.ravel(value)[0]) for name, value in mesh.field_data.items() if name.startswith("patch ")}
    start, worst = 0, 0.0
    every = np.concatenate([p for p, _ in body.values()])
    diagonal = float(np.linalg.norm(np.ptp(every, axis=0)))
    for block in mesh.cells:
        own = patch[start:start + len(block.data)]
        start += len(block.data)
        for name in names:
            nodes = np.unique(block.data[own == numbers[name]])
            p, t = body[name]
            corners = p[np.asarray(t)]
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
            normal /= np.linalg.norm(normal)
            if len(nodes):
                worst = max(worst, float(np.abs((mesh.points[nodes] - p.mean(axis=0)) @ normal).max()))
    return worst / diagonal


HEAD = ["body", "layers x first height", "faces", "full, %", "stopped by", "growth off by", "ends off by", "SJ", "checkMesh", "n-o", "skewness", "CPU s"]


def measure(program, name, case, folder):
    make, size, on = SHAPES[name]
    layers, part = case
    body = make()
    bodies.write_obj(folder / "in.obj", body)
    (folder / "case/constant").mkdir(parents=True)
    flow = ["--nested", "cavity", "--size-of", f"body={size / 4}"] if on == "body" else []
    status, said, cpu, _ = run_bounded([program, "mesh", folder / "in.obj", "--size", size, *flow, "--layers", layers, "--first-part", part,
                                "--growth", GROWTH, *(["--on", on] if on else []), "-q", "--threads", 1, "--json", folder / "out.json",
                                "-o", folder / "out.vtu", "-o", folder / "case/constant/polyMesh"], 120)
    if status != 0:
        return [name, f"{layers} x 1/{round(1 / part)}", "", "", f"no mesh: {said.splitlines()[-1]}", *[""] * (len(HEAD) - 5)]
    wall = json.loads((folder / "out.json").read_text())["layers"][0]
    mesh = meshio.read(folder / "out.vtu")
    wedges = wedges_of(mesh)
    bare = [n for n in body if on == "wall" and n != "wall"]
    foam = check_mesh(folder / "case")
    stopped = ", ".join(f"{why} {100 * share:.2g} %" for why, share in wall["stopped"].items())
    return [name, f"{layers} x 1/{round(1 / part)}", f"{wall['faces']:,}", f"{100 * wall['share_full']:.2f}", stopped or "-",
            f"{growth_error(mesh.points, columns_of(wedges)):.1e}", f"{flatness(body, mesh, bare):.1e}" if bare else "-",
            f"{least_scaled_jacobian(mesh.points, wedges):.3f}", verdict(foam), f"{foam['non_orthogonality']:.1f}", f"{foam['skewness']:.1f}", f"{cpu:.1f}"]


ABOUT = ("Generated bodies, growth 1.2, layers on all of it or, where ends are flat, on the wall alone. *Growth*: the most that the height of a layer over the one "
         "below is off, measured between the nodes of all columns. *Ends*: the farthest that a node of a flat end is off its plane, over the diagonal. *SJ*: least "
         "scaled Jacobian of all wedges, computed from their nodes. *n-o*: most non-orthogonality, degrees; *skewness*: the most, checkMesh wants at most 4 of it.")


def shown(rows):
    return [*tables.spread_by("layers x first height", HEAD, rows, ["full, %", "growth off by", "ends off by", "SJ", "n-o", "skewness", "CPU s"]), "",
            f"Each: {tables.put('layers-shapes', HEAD, rows)}."]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--program", type=pathlib.Path)
    a = arguments.parse_args()
    lines = []
    for name in SHAPES:
        for case in CASES:
            if a.only in name:
                with tempfile.TemporaryDirectory() as folder:
                    lines.append(measure((a.program or a.build / "cli/octafront").resolve(), name, case, pathlib.Path(folder)))
                print(tables.row(lines[-1]), flush=True)
    if not a.only:
        tables.rewrite(tables.MEASURED / "layers.md", "shapes", [f"{written_by('bench/run.sh layers_shapes')}. {ABOUT}", "", *shown(lines)])


if __name__ == "__main__":
    main()
