"""A laminar flow through a pipe, solved by OpenFOAM's simpleFoam on meshes with boundary layers and without, of about equally many cells, against Poiseuille.

Usage: bench/run.sh layers_solved [--program OCTAFRONT]
Writes docs/measured/layers-solved.md.
"""
import pathlib
import re
import subprocess
import tempfile

import numpy as np

from bench.judges.foam_mesh import check_mesh, environment, FoamMesh, write_dictionary
from bench.models import layers_bodies as bodies
from bench.ours import asked_program
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_bounded

RADIUS, LENGTH, MEAN, VISCOSITY = 1.0, 6.0, 1.0, 0.1  # Reynolds number 20
MIDDLE = (0.4 * LENGTH, 0.8 * LENGTH)  # where fields are compared: away from what boundary conditions do
SIZES = (0.3, 0.2, 0.14)
LAYERS = ["--layers", 5, "--first-part", 0.1, "--growth", 1.3, "--on", "wall"]
FIELD = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\ndimensions {dimensions};\ninternalField uniform {start};\nboundaryField\n{{\n{patches}}}\n"
CONTROL = """application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1500; deltaT 1; writeControl timeStep;
writeInterval 1500; writePrecision 12; writeFormat ascii; runTimeModifiable false;
functions { shear { type wallShearStress; libs (fieldFunctionObjects); patches (wall); writeControl writeTime; } }
"""
SCHEMES = """ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) bounded Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }
"""
SOLUTION = """solvers
{
  p { solver GAMG; smoother GaussSeidel; tolerance 1e-10; relTol 0.05; }
  U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-12; relTol 0.05; }
}
SIMPLE { consistent yes; nNonOrthogonalCorrectors 1; residualControl { p 1e-6; U 1e-7; } }
relaxationFactors { equations { U 0.9; } }
"""


class Poiseuille:
    """The flow through a circle of the area of the mesh's section: what straight edges take from the circle is no error of the solver's."""

    def __init__(self, area, mean):
        self.radius, self.mean = float(np.sqrt(area / np.pi)), mean
        self.shear, self.gradient = 4 * VISCOSITY * mean / self.radius, -8 * VISCOSITY * mean / self.radius**2

    def velocity(self, points):
        return 2 * self.mean * (1 - (points[:, 0] ** 2 + points[:, 1] ** 2) / self.radius**2)


def flow_through(mesh, shape):
    """Poiseuille's, as it enters: fluxes through the faces of the inlet."""
    middles, vectors = shape[:2]
    low = np.array(mesh.patches["low"])
    areas = -vectors[low, 2]
    flux = (areas * Poiseuille(areas.sum(), MEAN).velocity(middles[low])).sum()
    return Poiseuille(areas.sum(), flux / areas.sum())


def make_mesh(program, folder, options):
    (folder / "constant").mkdir(parents=True)
    bodies.write_obj(folder / "in.obj", bodies.pipe(480, LENGTH))
    status, said, _, _ = run_bounded([program, "mesh", folder / "in.obj", *options, "-q", "--threads", 1, "-o", folder / "constant/polyMesh"], 200)
    if status != 0:
        raise SystemExit(said)
    boundary = folder / "constant/polyMesh/boundary"
    boundary.write_text(re.sub(r"(\bwall\s*\{\s*type) patch;", r"\1 wall;", boundary.read_text()))


def geometry(mesh):
    """Middles of faces and cells, volumes, as OpenFOAM has them: pyramids over the faces, from the mean of their middles."""
    count = np.array([len(f) for f in mesh.faces])
    start = np.concatenate([[0], np.cumsum(count)[:-1]])
    of = np.repeat(np.arange(len(count)), count)
    here = np.concatenate(mesh.faces)
    after = np.concatenate([np.roll(f, -1) for f in mesh.faces])
    mean = np.add.reduceat(mesh.points[here], start) / count[:, None]
    parts = 0.5 * np.cross(mesh.points[here] - mean[of], mesh.points[after] - mean[of])
    weight = np.linalg.norm(parts, axis=1)[:, None]
    vectors = np.add.reduceat(parts, start)
    middles = np.add.reduceat(weight * (mesh.points[here] + mesh.points[after] + mean[of]) / 3, start) / np.add.reduceat(weight, start)
    sides = np.concatenate([mesh.owner, mesh.neighbour])
    face = np.concatenate([np.arange(len(count)), np.arange(len(mesh.neighbour))])
    sign = np.concatenate([np.ones(len(count)), -np.ones(len(mesh.neighbour))])
    n = mesh.cells()
    tip = np.stack([np.bincount(sides, middles[face, k], n) for k in range(3)], 1) / np.bincount(sides, minlength=n)[:, None]
    volume = sign * np.einsum("ij,ij->i", vectors[face], middles[face] - tip[sides]) / 3
    centre = 0.75 * middles[face] + 0.25 * tip[sides]
    volumes = np.bincount(sides, volume, n)
    return middles, vectors, np.stack([np.bincount(sides, volume * centre[:, k], n) for k in range(3)], 1) / volumes[:, None], volumes


def vectors_of(values):
    return "nonuniform List<vector> {}\n({})".format(len(values), "\n".join(f"(0 0 {v!r})" for v in values.tolist()))


def write_case(folder, inlet):
    def field(name, kind, dimensions, start, **patches):
        lines = "".join(f"  {patch} {{ {what} }}\n" for patch, what in patches.items())
        path = folder / "0" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(FIELD.format(name=name, kind=kind, dimensions=dimensions, start=start, patches=lines))
    field("U", "volVectorField", "[0 1 -1 0 0 0 0]", f"(0 0 {MEAN})", wall="type noSlip;", low=f"type fixedValue; value {vectors_of(inlet)};",
          high="type zeroGradient;")
    field("p", "volScalarField", "[0 2 -2 0 0 0 0]", 0, wall="type zeroGradient;", low="type zeroGradient;", high="type fixedValue; value uniform 0;")
    write_dictionary(folder, "constant/transportProperties", f"transportModel Newtonian; nu {VISCOSITY};\n")
    write_dictionary(folder, "constant/turbulenceProperties", "simulationType laminar;\n")
    write_dictionary(folder, "system/controlDict", CONTROL)
    write_dictionary(folder, "system/fvSchemes", SCHEMES)
    write_dictionary(folder, "system/fvSolution", SOLUTION)


def values_of(text, width):
    """The first list in it, rows of so many numbers."""
    inside = re.search(r"List<\w+>\s*\d+\s*\((.*?)\)\s*;", text, re.S)[1]
    return np.array(inside.replace("(", " ").replace(")", " ").split(), float).reshape(-1, width)


def weighted(values, weights):
    return float(np.sqrt((weights * values**2).sum() / weights.sum()))


def compare(folder, mesh, shape, flow):
    middles, vectors, centres, volumes = shape
    last = max((p for p in folder.iterdir() if p.name.isdigit() and p.name != "0"), key=lambda p: int(p.name))
    velocity = values_of((last / "U").read_text(), 3)
    pressure = values_of((last / "p").read_text(), 1)[:, 0]
    shear_text = (last / "wallShearStress").read_text()
    shear = np.linalg.norm(values_of(shear_text[shear_text.index("boundaryField"):], 3), axis=1)
    inside = (centres[:, 2] > MIDDLE[0]) & (centres[:, 2] < MIDDLE[1])
    wall = np.array(mesh.patches["wall"])
    beside = (middles[wall, 2] > MIDDLE[0]) & (middles[wall, 2] < MIDDLE[1])
    exact = np.stack([0 * centres[:, 0], 0 * centres[:, 0], flow.velocity(centres)], 1)
    slope = np.polyfit(centres[inside, 2], pressure[inside], 1, w=np.sqrt(volumes[inside]))[0]
    area = np.linalg.norm(vectors[wall], axis=1)[beside]
    return {"iterations": int(last.name), "gradient": slope / flow.gradient - 1,
            "velocity": weighted(np.linalg.norm(velocity - exact, axis=1)[inside], volumes[inside]) / weighted(exact[inside, 2], volumes[inside]),
            "shear": weighted(shear[beside] / flow.shear - 1, area), "shear_mean": float((area * shear[beside]).sum() / area.sum()) / flow.shear - 1,
            "section": flow.radius**2 / RADIUS**2 - 1}


def solved(program, options):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        make_mesh(program, folder, options)
        mesh = FoamMesh(folder)
        shape = geometry(mesh)
        flow = flow_through(mesh, shape)
        write_case(folder, Poiseuille(np.pi * flow.radius**2, MEAN).velocity(shape[0][np.array(mesh.patches["low"])]))
        done = subprocess.run(["simpleFoam", "-case", folder], capture_output=True, text=True, env=environment(), timeout=900)
        if done.returncode != 0:
            raise SystemExit(done.stdout[-1500:] + done.stderr[-1500:])
        seconds = float(re.findall(r"ExecutionTime = ([\d.]+)", done.stdout)[-1])
        return compare(folder, mesh, shape, flow) | {"cells": mesh.cells(), "seconds": seconds, "n-o": check_mesh(folder)["non_orthogonality"]}


def line(what, row):
    return [what, f"{row['cells']:,}", f"{row['n-o']:.0f}", f"{100 * row['section']:+.2f}", f"{100 * row['velocity']:.2f}", f"{100 * row['gradient']:+.2f}",
            f"{100 * row['shear_mean']:+.2f}", f"{100 * row['shear']:.2f}", row["iterations"], f"{row['seconds']:.0f}"]


HEAD = ["mesh", "cells", "n-o", "section off, %", "velocity off, %", "dp/dz off, %", "shear, mean off, %", "shear off, %", "iterations", "s"]


ABOUT = (f"A pipe of radius 1 and length {LENGTH:g}, Reynolds number {2 * MEAN * RADIUS / VISCOSITY:.0f}, Poiseuille's profile at the inlet; 5 layers of 1/10, growth 1.3, on "
         "its wall. OpenFOAM's simpleFoam (v1912), second order throughout, until residuals fall below 1e-6; compared from .4 to .8 of the length, with "
         "Poiseuille's flow of the same flux through a circle as large as the mesh's section (*section*: that over pi). *Velocity*: root mean square over the "
         "volume; *dp/dz*: slope of the pressure; *shear*: on the wall, mean, and root mean square over its area.")


def shown(rows):
    return [*tables.table(HEAD, rows[:3] + rows[-3:]), "", f"With edges between: {tables.put('layers-solved', HEAD, rows)}."]


def main():
    program = asked_program()
    lines = []
    for size in SIZES:
        layered = solved(program, ["--size", size, *LAYERS])
        lines.append(line(f"edges {size}, 5 layers", layered))
        print(tables.row(lines[-1]), flush=True)
        lines.append(line("as many cells, no layers", solved(program, ["--elements", layered["cells"]])))
        print(tables.row(lines[-1]), flush=True)
        lines.append(line(f"edges {size}, no layers", solved(program, ["--size", size])))
        print(tables.row(lines[-1]), flush=True)
    tables.write("layers-solved", ["# A laminar pipe, with layers and without", "", f"{written_by('bench/run.sh layers_solved')}. {ABOUT}", "", *shown(lines)])


if __name__ == "__main__":
    main()
