"""The bar of others.py with FEniCSx (DOLFINx 0.5, Debian's): bar_dolfinx.py XDMF ORDER

Regions and sides are the tags of the two files, by the names that stand in them. A mesh of second order keeps its elements."""

import pathlib
import sys
from xml.etree import ElementTree

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

YOUNG, POISSON = {"steel": 200000.0, "alloy": 50000.0}, {"steel": 0.3, "alloy": 0.075}
SUPPORTS = {"steel/fixed": 0, "steel/plane_y": 1, "alloy/plane_y": 1, "steel/plane_z": 2, "alloy/plane_z": 2}


def exact(x):
    return np.vstack([5e-4 * np.minimum(x[0], 30) + 2e-3 * np.maximum(x[0] - 30, 0), -1.5e-4 * x[1], -1.5e-4 * x[2]])


def names_of(path, attribute):
    tag = next(tag for tag in ElementTree.parse(path).iter("Attribute") if tag.get("Name") == attribute)
    return {name: int(key.removeprefix("name_")) for key, name in tag.items() if key.startswith("name_")}


def main(path, order):
    with XDMFFile(MPI.COMM_WORLD, str(path), "r") as file:
        mesh = file.read_mesh(name="mesh")
        regions = file.read_meshtags(mesh, name="mesh")
    mesh.topology.create_connectivity(2, 3)
    patches = path.with_name(path.stem + "_patches.xdmf")
    with XDMFFile(MPI.COMM_WORLD, str(patches), "r") as file:
        sides = file.read_meshtags(mesh, name="patches")
    region, side = names_of(path, "region"), names_of(patches, "patch")
    space = fem.VectorFunctionSpace(mesh, ("CG", order))
    dx = ufl.Measure("dx", domain=mesh, subdomain_data=regions)
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=sides)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    form = 0
    for name, young in YOUNG.items():
        mu, lam = young / (2 * (1 + POISSON[name])), young * POISSON[name] / ((1 + POISSON[name]) * (1 - 2 * POISSON[name]))
        strain = ufl.sym(ufl.grad(u))
        form += ufl.inner(2 * mu * strain + lam * ufl.tr(strain) * ufl.Identity(3), ufl.sym(ufl.grad(v))) * dx(region[name])
    held = [fem.dirichletbc(ScalarType(0), fem.locate_dofs_topological(space.sub(axis), 2, sides.find(side[name])), space.sub(axis)) for name, axis in SUPPORTS.items()]
    pull = fem.Constant(mesh, ScalarType((100, 0, 0)))
    moved = fem.petsc.LinearProblem(form, ufl.dot(pull, v) * ds(side["alloy/pulled"]), held, petsc_options={"ksp_type": "preonly", "pc_type": "lu"}).solve()

    def integral(f):
        return fem.assemble_scalar(fem.form(f))

    one = fem.Constant(mesh, ScalarType(1))
    elongation = integral(moved[0] * ds(side["alloy/pulled"])) / integral(one * ds(side["alloy/pulled"]))
    wanted = fem.Function(space)
    wanted.interpolate(exact)
    worst = abs(moved.x.array - wanted.x.array).max()
    print(f"found {mesh.topology.index_map(3).size_global} {elongation:.17g} {worst:.17g}")


main(pathlib.Path(sys.argv[1]), int(sys.argv[2]))
