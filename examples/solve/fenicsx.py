#!/usr/bin/python3
"""The pipe of solve.py with FEniCSx: fenicsx.py OCTAFRONT WORK. Run by /usr/bin/python3; Debian package python3-dolfinx
(a gigabyte, so not among the everyday tests).

octafront writes XDMF; dolfinx reads it with its curved cells of second order, and the names of the input's groups are
its tags. The mean hoop stress on the inner wall, integrated over the curved facets, is compared with Lame's.
"""
import math
import pathlib
import subprocess
import sys
from xml.etree import ElementTree

import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

import bodies

INNER, OUTER, PRESSURE, YOUNG, POISSON = 10.0, 20.0, 100.0, 210000.0, 0.3


def read(path):
    """Mesh, facet tags, and the tag of each name."""
    with XDMFFile(MPI.COMM_WORLD, str(path), "r") as file:
        mesh = file.read_mesh(name="mesh")
    mesh.topology.create_connectivity(2, 3)
    patches = path.with_name(path.stem + "_patches.xdmf")
    with XDMFFile(MPI.COMM_WORLD, str(patches), "r") as file:
        facets = file.read_meshtags(mesh, name="patches")
    numbers = next(tag for tag in ElementTree.parse(patches).iter("Attribute") if tag.get("Name") == "patch")
    names = {name: int(key.removeprefix("name_")) for key, name in numbers.items() if key.startswith("name_")}
    return mesh, facets, names


def solve(mesh, facets, names):
    space = fem.VectorFunctionSpace(mesh, ("CG", 2))
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=facets)
    normal, x = ufl.FacetNormal(mesh), ufl.SpatialCoordinate(mesh)
    mu, lam = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))

    def stress(u):
        strain = ufl.sym(ufl.grad(u))
        return 2 * mu * strain + lam * ufl.tr(strain) * ufl.Identity(3)

    supports = []
    for patch, axis in (("plane_x", 0), ("plane_y", 1), ("bottom", 2), ("top", 2)):
        dofs = fem.locate_dofs_topological(space.sub(axis), 2, facets.find(names[patch]))
        supports.append(fem.dirichletbc(ScalarType(0), dofs, space.sub(axis)))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    load = -PRESSURE * ufl.dot(normal, v) * ds(names["inner"])
    problem = fem.petsc.LinearProblem(ufl.inner(stress(u), ufl.sym(ufl.grad(v))) * ufl.dx, load, supports,
                                      petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    moved = problem.solve()
    around = ufl.as_vector((-x[1], x[0], 0)) / ufl.sqrt(x[0] ** 2 + x[1] ** 2)
    hoop = ufl.dot(around, stress(moved) * around)

    def integral(f):
        return fem.assemble_scalar(fem.form(f))

    inner = names["inner"]
    one = fem.Constant(mesh, ScalarType(1))
    return {"hoop": integral(hoop * ds(inner)) / integral(one * ds(inner)), "area": integral(one * ds(inner)),
            "volume": integral(one * ufl.dx), "cells": mesh.topology.index_map(3).size_global}


def main():
    octafront, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    height = 5.0
    bodies.quarter_pipe(INNER, OUTER, height, 64).write(work / "fenicsx.obj")
    subprocess.run([octafront, "mesh", work / "fenicsx.obj", "-o", work / "fenicsx.xdmf", "--size", "1.2", "--order", "2", "-q"],
                   check=True)
    found = solve(*read(work / "fenicsx.xdmf"))
    expected = {"hoop": PRESSURE * (OUTER**2 + INNER**2) / (OUTER**2 - INNER**2), "area": math.pi / 2 * INNER * height,
                "volume": math.pi / 4 * (OUTER**2 - INNER**2) * height}
    good = True
    for what, bound in (("hoop", 0.02), ("area", 1e-4), ("volume", 1e-4)):
        error = abs(found[what] / expected[what] - 1)
        good = good and error <= bound
        print(f"{what}: {found[what]:.8g} (theory {expected[what]:.8g}), error {error:.2e}, bound {bound:g}")
    print(f"{found['cells']} cells of second order")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
