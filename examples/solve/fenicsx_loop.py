#!/usr/bin/python3
"""Mesh, solve, adapt, solve again: Poisson's equation on an L-shaped solid with FEniCSx (Debian: python3-dolfinx). Prints the
error of the gradient beside the number of unknowns; --json: as bench/run/adapt.py reads it, --short: small meshes alone.
"""
import json
import sys

import numpy
import octafront
import ufl
from dolfinx import fem, mesh as grids
from mpi4py import MPI


def l_shaped_solid(height=1.0):
    """The square from -1 to 1 without its fourth quadrant, extruded."""
    outline = [(0, 0), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1)]
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 6), (0, 6, 7)]
    n = len(outline)
    points = [(x, y, z) for z in (0, height) for x, y in outline]
    triangles = [(a, c, b) for a, b, c in caps] + [(a + n, b + n, c + n) for a, b, c in caps]
    for a in range(n):
        b = (a + 1) % n
        triangles += [(a, b, b + n), (a, b + n, a + n)]
    return numpy.array(points, float), numpy.array(triangles)


def exact(x):
    """r^(2/3) sin(2/3 angle) cos(pi z): its gradient is infinite at the edge; minus its Laplacian is pi^2 times itself."""
    angle = numpy.arctan2(x[1], x[0])
    angle = numpy.where(angle < -1e-12, angle + 2 * numpy.pi, angle)
    return numpy.hypot(x[0], x[1]) ** (2 / 3) * numpy.sin(2 / 3 * angle) * numpy.cos(numpy.pi * x[2])


def solved(mesh):
    """The solution at the points of the mesh, and the error of its gradient in L^2."""
    element = ufl.VectorElement("Lagrange", ufl.tetrahedron, 1)
    grid = grids.create_mesh(MPI.COMM_SELF, mesh.tets.astype(numpy.int64), mesh.points, ufl.Mesh(element))
    space = fem.FunctionSpace(grid, ("CG", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    grid.topology.create_connectivity(2, 3)
    wall = fem.Function(space)
    wall.interpolate(exact)
    dofs = fem.locate_dofs_topological(space, 2, grids.exterior_facet_indices(grid.topology))
    x = ufl.SpatialCoordinate(grid)
    angle = ufl.atan_2(x[1], x[0])
    angle = ufl.conditional(ufl.lt(angle, -1e-12), angle + 2 * ufl.pi, angle)
    r, along, across = ufl.sqrt(x[0] ** 2 + x[1] ** 2), ufl.cos(ufl.pi * x[2]), ufl.sin(ufl.pi * x[2])
    load = ufl.pi**2 * r ** (2 / 3) * ufl.sin(2 / 3 * angle) * along
    problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, load * v * ufl.dx(metadata={"quadrature_degree": 4}), [fem.dirichletbc(wall, dofs)],
                                      petsc_options={"ksp_type": "cg", "pc_type": "gamg", "ksp_rtol": 1e-9})
    found = problem.solve()
    slope = 2 / 3 * r ** (-1 / 3)
    gradient = ufl.as_vector((-slope * ufl.sin(angle / 3) * along, slope * ufl.cos(angle / 3) * along,
                              -ufl.pi * r ** (2 / 3) * ufl.sin(2 / 3 * angle) * across))
    off = ufl.grad(found) - gradient
    error = numpy.sqrt(fem.assemble_scalar(fem.form(ufl.inner(off, off) * ufl.dx(metadata={"quadrature_degree": 5}))))
    # FEniCSx has an order of its own: values go back to the points by the corners of each cell.
    values = numpy.empty(len(mesh.points))
    corners = grid.geometry.dofmap.array.reshape(-1, 4)
    values[numpy.asarray(grid.geometry.input_global_indices)[corners]] = found.x.array[space.dofmap.list.array.reshape(-1, 4)]
    return values, float(error)


def row(mesh, error):
    return {"elements": len(mesh.tets), "unknowns": len(mesh.points), "error": error}


def loop(body, most, is_round):
    """Twice as many elements in each step, and two solutions for each number of them. `is_round`: as long in all directions."""
    mesh, steps, elements = octafront.mesh(*body, size=0.2), [], 16_000
    u, error = solved(mesh)
    while elements <= most:
        for again in range(2):
            metric = octafront.metrics.of_field(mesh, u, elements=elements)
            wanted = {"sizes": numpy.linalg.det(metric) ** (-1 / 6)} if is_round else {"metric": metric}
            mesh = octafront.adapt(mesh, **wanted)
            u, error = solved(mesh)
        steps.append(row(mesh, error))
        elements *= 2
    return steps


def main():
    body, uniform = l_shaped_solid(), []
    is_short = "--short" in sys.argv
    for size in (0.2, 0.1) if is_short else (0.2, 0.14, 0.1, 0.07):
        mesh = octafront.mesh(*body, size=size)
        uniform.append(row(mesh, solved(mesh)[1]))
    most = 32_000 if is_short else 128_000
    rounds, adapted = loop(body, most, True), loop(body, most, False)
    if "--json" in sys.argv:
        print(json.dumps({"uniform": uniform, "sizes": rounds, "metric": adapted}))
        return
    for name, rows in (("uniform", uniform), ("sizes", rounds), ("metric", adapted)):
        for r in rows:
            print(f"{name}: {r['elements']} elements, {r['unknowns']} unknowns, error {r['error']:.4f}")


main()
