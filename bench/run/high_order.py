"""Orders 2 to 4: how true are curved walls, how good are elements, what does it cost? Meshes are read and measured by Gmsh.

Usage: bench/run.sh high_order [--program OCTAFRONT]
Shapes with known surfaces (a sphere, a torus and a cylinder, made as STEP files by Gmsh's OpenCASCADE) at three sizes, the samples that ship, and
Gmsh's own meshes of some of them (second command of its users: -order N, optimised, HighOrderOptimize 2), whose elements `octafront check` proves or
not. One thread. Writes docs/measured/high-order.md.
"""
import argparse
import json
import math
import pathlib

import subprocess
import tempfile

import gmsh
import numpy as np

from bench.pages import tables
from bench.pages.origin import ROOT, written_by
from bench.process import run_measured

SOLID, FACE = {2: 11, 3: 29, 4: 30}, {2: 9, 3: 21, 4: 23}
SAMPLES = ["bracket.step", "assembly.step", "bend.step", "bracket.stl", "gear.obj", "torus_knot.ply", "gyroid.ply", "shell.off"]
# Name, how Gmsh makes it, distance of points from it, volume, sizes.
SHAPES = {
    "sphere": (lambda occ: occ.addSphere(0, 0, 0, 1), lambda x: np.abs(np.linalg.norm(x, axis=1) - 1), 4 / 3 * math.pi, (0.8, 0.4, 0.2)),
    "torus": (lambda occ: occ.addTorus(0, 0, 0, 2, 0.6), lambda x: np.abs(np.hypot(np.hypot(x[:, 0], x[:, 1]) - 2, x[:, 2]) - 0.6),
              2 * math.pi ** 2 * 2 * 0.6 ** 2, (0.6, 0.3, 0.15)),
    "cylinder": (lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 3, 1),
                 lambda x: np.minimum(np.abs(np.hypot(x[:, 0], x[:, 1]) - 1), np.minimum(np.abs(x[:, 2]), np.abs(x[:, 2] - 3))), 3 * math.pi, (0.8, 0.4, 0.2)),
}
TRUE = ["shape", "order", "size", "elements", "nodes", "farthest", "falls as h to the", "mean", "falls", "volume off", "least scaled Jacobian", "CPU s"]
GOOD = ["model", "order", "elements", "nodes", "edges curved", "eased", "faces eased", "least scaled Jacobian", "proven", "CPU s, order", "CPU s, all"]
PEER = ["shape", "order", "size", "elements", "not proven", "of these undecided", "least scaled Jacobian"]


def write_step(make, file):
    gmsh.clear()
    make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.write(str(file))


def made(program, file, out, *options):
    report = out.with_suffix(".json")
    done = run_measured([program, "mesh", str(file), "-o", str(out), "--threads", "1", "--json", str(report), *map(str, options)], str(out.parent), 600)
    if done.error:
        raise SystemExit(f"{done.command}\n{done.error}")
    return json.loads(report.read_text()), done.cpu_seconds


def read_by_gmsh(file, order, distance):
    """Number of elements, volume by quadrature, the size of the boundary's triangles, and distances of points on them."""
    gmsh.clear()
    gmsh.open(str(file))
    points, weights = gmsh.model.mesh.getIntegrationPoints(SOLID[order], f"Gauss{3 * (order - 1) + 1}")
    _, det, _ = gmsh.model.mesh.getJacobians(SOLID[order], points)
    det = np.array(det).reshape(-1, len(weights))
    places = np.array([(i / 10, j / 10, 0) for i in range(11) for j in range(11 - i)]).ravel()
    _, face_det, x = gmsh.model.mesh.getJacobians(FACE[order], places)
    far = distance(np.array(x).reshape(-1, 3))
    area = np.abs(np.array(face_det)).mean() / 2
    return len(det), float((det * weights).sum()), det.min(), math.sqrt(area), far.max(), far.mean()


def slope(before, now, h_before, h):
    return f"{math.log(before / now) / math.log(h_before / h):.1f}" if before and now > 1e-13 else ""


def shapes(program, folder):
    rows = []
    for name, (make, distance, volume, sizes) in SHAPES.items():
        step = folder / f"{name}.step"
        write_step(make, step)
        for order in SOLID:
            before = None
            for size in sizes:
                mesh = folder / f"{name}.msh"
                report, cpu = made(program, step, mesh, "--size", size, "--order", order)
                elements, found, least, h, most, mean = read_by_gmsh(mesh, order, distance)
                if least <= 0:
                    raise SystemExit(f"{name}, order {order}, size {size}: Gmsh finds a Jacobian of {least}")
                fall = [slope(before[1], most, before[0], h), slope(before[2], mean, before[0], h)] if before else ["", ""]
                rows.append([name, order, size, f"{elements:,}", f"{report['points']:,}", f"{most:.1e}", fall[0], f"{mean:.1e}", fall[1], f"{found / volume - 1:.0e}",
                             f"{report['second_order']['least_scaled_jacobian']:.3f}", f"{cpu:.2f}"])
                print(*rows[-1], sep="  ", flush=True)
                before = h, most, mean
    return rows


def models(program, folder):
    rows = []
    for name in SAMPLES:
        for order in SOLID:
            mesh = folder / "model.msh"
            report, cpu = made(program, ROOT / "samples" / name, mesh, "--order", order)
            told = report["second_order"]
            checked = subprocess.run([program, "check", mesh], capture_output=True, text=True)
            spent = sum(s["cpu_seconds"] for s in report["stages"] if s["name"] == "second order")
            rows.append([name, order, f"{report['tets']:,}", f"{report['points']:,}", told["curved_edges"], told["eased_edges"], told.get("eased_faces", 0),
                         f"{told['least_scaled_jacobian']:.3f}", "all" if checked.returncode == 0 else checked.stderr.splitlines()[0], f"{spent:.2f}", f"{cpu:.2f}"])
            print(*rows[-1], sep="  ", flush=True)
    return rows


def peers(program, folder):
    rows = []
    for name, (_, _, _, sizes) in SHAPES.items():
        for order in SOLID:
            mesh = folder / f"gmsh.msh"
            gmsh.clear()
            gmsh.open(str(folder / f"{name}.step"))
            for key, value in {"Mesh.MeshSizeMax": sizes[0], "Mesh.ElementOrder": order, "Mesh.HighOrderOptimize": 2, "Mesh.MshFileVersion": 4.1}.items():
                gmsh.option.setNumber(key, value)
            gmsh.model.mesh.generate(3)
            gmsh.write(str(mesh))
            done = subprocess.run([program, "check", mesh, "--json", folder / "check.json"], capture_output=True, text=True)
            told = json.loads((folder / "check.json").read_text())
            jacobians = told.get("second_order", {})
            rows.append([name, order, sizes[0], f"{len(gmsh.model.mesh.getElementsByType(SOLID[order])[0]):,}", jacobians.get("invalid", ""), jacobians.get("undecided", ""),
                         f"{jacobians['least_scaled_jacobian']:.3f}" if jacobians else done.stderr.splitlines()[0]])
            print(*rows[-1], sep="  ", flush=True)
    return rows


def page(true, good, peer):
    shown = ["shape", "order", "size", "elements", "farthest", "mean", "falls", "least scaled Jacobian"]
    tables.write("high-order", [
        "# Orders 2, 3 and 4", "",
        f"{written_by('bench/run.sh high_order')}, one thread. Meshes are read by Gmsh, which finds every Jacobian positive at its points of quadrature.", "",
        "## How true walls are", "",
        "STEP files of known surfaces. Distances from them of 66 points of each triangle of the boundary, the farthest and the mean, which *falls* as h, the root of the"
        " triangles' mean area, to this power.", "",
        *tables.some(TRUE, true, shown), "", f"The rows: {tables.put('high-order-shapes', TRUE, true)}.", "",
        "## Models", "", "The samples, automatic sizes, at the three orders.", "",
        *tables.some(GOOD, good, ["model", "order", "elements", "edges curved", "eased", "least scaled Jacobian", "CPU s, order"]), "",
        f"The rows: {tables.put('high-order-models', GOOD, good)}. All are proven valid by `octafront check` of the file.", "",
        "## Beside Gmsh", "", "The same STEP files by Gmsh at the coarsest size, its optimiser of high order on (`Mesh.HighOrderOptimize=2`); `octafront check` of its meshes.", "",
        *tables.some(PEER, peer, ["shape", "order", "elements", "not proven", "least scaled Jacobian"]), "", f"The rows: {tables.put('high-order-gmsh', PEER, peer)}."])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path)
    arguments = parser.parse_args()
    program = (arguments.program or arguments.build / "cli/octafront").resolve()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        true, good = shapes(program, folder), models(program, folder)
        peer = peers(program, folder)
    gmsh.finalize()
    page(true, good, peer)


if __name__ == "__main__":
    main()
