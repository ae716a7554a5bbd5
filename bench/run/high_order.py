"""Orders 2 to 4: how true are curved walls, how good are elements, what does it cost, and what do solvers say?

Usage: bench/run.sh high_order [STEP...] [--program OCTAFRONT] [--keep-peers: the rows of Gmsh and Netgen stay]; steps: shapes models solved speed (all of them: 20 CPU minutes)
shapes: known surfaces (a sphere, a torus and a cylinder, made as STEP files by Gmsh's OpenCASCADE) at three sizes, meshes read and measured by Gmsh.
models: 30 CAD files and surfaces, beside Gmsh and Netgen (high_order_models.py). solved: Poisson's equation by DOLFINx and MFEM
(high_order_solved.py; MFEM_DIR: where MFEM was built). speed: 500,000 elements. One thread. Writes docs/measured/high-order.md; steps that are
not asked for keep their rows.
"""
import argparse
import functools
import json
import math
import pathlib
import tempfile

import gmsh
import numpy as np

from bench.pages import tables
from bench.pages.origin import ROOT, written_by
from bench.process import run_measured
from bench.run import high_order_models, high_order_solved

SOLID, FACE = {2: 11, 3: 29, 4: 30}, {2: 9, 3: 21, 4: 23}
# Name, how Gmsh makes it, distance of points from it, volume, sizes.
SHAPES = {
    "sphere": (lambda occ: occ.addSphere(0, 0, 0, 1), lambda x: np.abs(np.linalg.norm(x, axis=1) - 1), 4 / 3 * math.pi, (0.8, 0.4, 0.2)),
    "torus": (lambda occ: occ.addTorus(0, 0, 0, 2, 0.6), lambda x: np.abs(np.hypot(np.hypot(x[:, 0], x[:, 1]) - 2, x[:, 2]) - 0.6),
              2 * math.pi ** 2 * 2 * 0.6 ** 2, (0.6, 0.3, 0.15)),
    "cylinder": (lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 3, 1),
                 lambda x: np.minimum(np.abs(np.hypot(x[:, 0], x[:, 1]) - 1), np.minimum(np.abs(x[:, 2]), np.abs(x[:, 2] - 3))), 3 * math.pi, (0.8, 0.4, 0.2)),
}
TRUE = ["shape", "order", "size", "elements", "nodes", "farthest", "falls as h to the", "mean", "falls", "volume off", "least scaled Jacobian", "CPU s"]
FAST = ["model", "order", "elements", "nodes", "CPU s, linear mesh", "CPU s, order", "elements per CPU s, order", "least scaled Jacobian", "memory, MB"]
FAST_MODELS = {"samples/gyroid.ply": 500_000, "samples/bracket.step": 500_000}


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


def speed(program, folder):
    rows = []
    for name, elements in FAST_MODELS.items():
        for order in SOLID:
            report, cpu = made(program, ROOT / name, folder / "fast.msh", "--elements", elements, "--order", order)
            spent = sum(s["cpu_seconds"] for s in report["stages"] if s["name"].startswith(("second order", "order")))
            rows.append([pathlib.Path(name).name, order, f"{report['tets']:,}", f"{report['points']:,}", f"{cpu - spent:.1f}", f"{spent:.2f}", f"{report['tets'] / spent:,.0f}",
                         f"{report['second_order']['least_scaled_jacobian']:.3f}", f"{report.get('peak_memory_bytes', 0) / 1e6:,.0f}"])
            print(*rows[-1], sep="  ", flush=True)
    return rows


def models(program, folder, kept):
    return high_order_models.run(functools.partial(made, program), program, folder, kept)


def solved(program, folder):
    return high_order_solved.run(functools.partial(made, program), folder)


STEPS = {"shapes": (TRUE, shapes), "models": (high_order_models.HEAD, models), "solved": (high_order_solved.HEAD, solved), "speed": (FAST, speed)}


def link(step, rows):
    return f"The rows: [high-order-{step}.csv](rows/high-order-{step}.csv), {len(rows)} rows."


def page(rows):
    shown = ["shape", "order", "size", "elements", "farthest", "mean", "falls", "least scaled Jacobian"]
    models, solved = rows["models"], rows["solved"]
    fine = list({(row[0], row[1]): row for row in rows["shapes"]}.values())  # of each shape and order the last size
    tables.write("high-order", [
        "# Orders 2, 3 and 4", "", f"{written_by('bench/run.sh high_order')}, one thread.", "",
        "## How true walls are", "",
        "STEP files of known surfaces. Distances from them of 66 points of each triangle of the boundary, the farthest and the mean, which *falls* as h, the root of the"
        " triangles' mean area, to this power from the size before. Gmsh reads the meshes, and finds every Jacobian positive at its points of quadrature.", "",
        *tables.some(TRUE, fine, shown), "", link("shapes", rows["shapes"]), "",
        "## Models, beside Gmsh and Netgen", "",
        f"{len(high_order_models.CAD)} CAD files and {len(high_order_models.SURFACES)} surfaces; edges of a sixteenth of the diagonal. Gmsh: its optimiser on (`HighOrderOptimize` 2). Proven, or"
        " not, by `octafront check` of the files. Scaled Jacobians are the least of each element over that of the straight one; *ours nearer*: in so many"
        " of the CAD models that both have walls of ours are nearer to the CAD faces on average. Others were stopped after 60 s (surfaces 40 s) by the clock, at low priority beside other work on two cores,"
        " and did not get to all surfaces: how many they finish says little, how good those are does.", "",
        *tables.table(*high_order_models.page(models)), "", link("models", models) + " Octafront at a tenth and a 25th of the diagonal, too.", "",
        "## Solved", "",
        "Poisson's equation, whose solution is 0 on the walls: (1 - r²) eˣ in a ball of radius 1; waves times r² - 1 in a plate of 4 by 4 by 1 with a hole of radius 1. STEP files;"
        " elements of the solution are of the mesh's order. The L2 error over that of the solution on the finest of three meshes; it *falls* as h to this power.", "",
        *tables.some(high_order_solved.HEAD, high_order_solved.page(solved), ["body", "order", "elements", "unknowns", "error, DOLFINx", "falls", "error, MFEM", "falls, MFEM"]), "",
        link("solved", solved), "",
        "## Speed", "", "What orders cost on top of the linear mesh.", "", *tables.some(FAST, rows["speed"], FAST[:2] + ["elements", "CPU s, linear mesh", "CPU s, order", "elements per CPU s, order"]),
        "", link("speed", rows["speed"])])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("steps", nargs="*", default=list(STEPS), choices=[*STEPS, []])
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--keep-peers", action="store_true")
    arguments = parser.parse_args()
    program = (arguments.program or arguments.build / "cli/octafront").resolve()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    rows = {}
    with tempfile.TemporaryDirectory() as name:
        for step, (head, run) in STEPS.items():
            if step in arguments.steps:
                more = [tables.rows_of(f"high-order-{step}") if arguments.keep_peers else []] if step == "models" else []
                tables.put(f"high-order-{step}", head, run(program, pathlib.Path(name), *more))
            rows[step] = tables.rows_of(f"high-order-{step}")
    gmsh.finalize()
    page(rows)


if __name__ == "__main__":
    main()
