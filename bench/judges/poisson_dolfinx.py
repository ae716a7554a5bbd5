"""Poisson's equation with a known solution, solved by DOLFINx on a mesh of any order; the error in L2.

Usage: /usr/bin/python3 -m bench.judges.poisson_dolfinx CASE MESH.msh  (prints a line of JSON). Debian: python3-dolfinx, python3-gmsh.
Gmsh reads the file and says where the nodes of its elements are on the unit tetrahedron, Basix where DOLFINx wants them: so elements of every
order come in by arrays. Elements of the solution are of the mesh's own order (isoparametric). Solutions are 0 on the walls, where they are fixed
as 0: what a wall is off the true one counts.
"""
import json
import sys
import time

import basix
import gmsh
import numpy as np
import ufl
from dolfinx import fem, mesh as dolfinx_mesh
from mpi4py import MPI
from petsc4py import PETSc

TETS = {4: 1, 11: 2, 29: 3, 30: 4}  # Gmsh's types of elements, their orders


def read(file):
    """(points, elements in DOLFINx's order of nodes, order)."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(file))
    kind = next(t for t in gmsh.model.mesh.getElementTypes(3) if t in TETS)
    order = TETS[kind]
    _, _, _, nodes, local, _ = gmsh.model.mesh.getElementProperties(kind)
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    place[tags.astype(np.int64)] = np.arange(len(tags))
    elements = place[gmsh.model.mesh.getElementsByType(kind)[1].astype(np.int64)].reshape(-1, nodes)
    gmsh.finalize()
    theirs = basix.create_element(basix.ElementFamily.P, basix.CellType.tetrahedron, order, basix.LagrangeVariant.equispaced).points
    far = np.linalg.norm(theirs[:, None, :] - np.array(local).reshape(-1, 3)[None, :, :], axis=2)
    assert far.min(axis=1).max() < 1e-6
    return xyz.reshape(-1, 3), elements[:, far.argmin(axis=1)], order


def solutions(x):
    pi, sin = ufl.pi, ufl.sin
    waves = sin(pi * x[0] / 4) * sin(pi * x[1] / 4) * sin(pi * x[2])
    return {"ball": (1 - ufl.dot(x, x)) * ufl.exp(x[0]), "plate": waves * ((x[0] - 2) ** 2 + (x[1] - 2) ** 2 - 1)}


def solved(case, file):
    points, elements, order = read(file)
    element = ufl.VectorElement(ufl.FiniteElement("Lagrange", ufl.Cell("tetrahedron", geometric_dimension=3), order, variant="equispaced"))
    mesh = dolfinx_mesh.create_mesh(MPI.COMM_SELF, elements, points, ufl.Mesh(element))
    space = fem.FunctionSpace(mesh, ("Lagrange", order))
    exact = solutions(ufl.SpatialCoordinate(mesh))[case]
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    dx = ufl.dx(degree=2 * order + 3)
    mesh.topology.create_connectivity(2, 3)
    walls = fem.locate_dofs_topological(space, 2, dolfinx_mesh.exterior_facet_indices(mesh.topology))
    problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * dx, -ufl.div(ufl.grad(exact)) * v * dx,
                                      [fem.dirichletbc(PETSc.ScalarType(0), walls, space)],
                                      petsc_options={"ksp_type": "cg", "pc_type": "hypre", "ksp_rtol": 1e-12})
    found = problem.solve()
    integral = lambda f: fem.assemble_scalar(fem.form(f * dx))
    return {"order": order, "elements": len(elements), "unknowns": space.dofmap.index_map.size_global, "volume": integral(fem.Constant(mesh, PETSc.ScalarType(1))),
            "error": integral((found - exact) ** 2) ** 0.5, "of": integral(exact ** 2) ** 0.5, "steps": problem.solver.getIterationNumber()}


if __name__ == "__main__":
    start = time.process_time()
    print(json.dumps({**solved(sys.argv[1], sys.argv[2]), "cpu": time.process_time() - start}))
