#!/usr/bin/python3
"""A block of rubber foam pressed to 40 % of its height, its ends glued, with FEniCSx (Debian: python3-dolfinx): after each step
the mesh moves with the body, and is mended where that is needed (octafront.move). What the material has been through, the
deformation gradient of each element, goes along. Prints the force at each height; beside it, with --compare, that of a
Lagrangian mesh, fine and never mended, as long as it can be solved on. --short: coarser meshes. --json: one line with all.
"""
import json
import sys

import numpy
import octafront
import ufl
from dolfinx import fem, mesh as grids, nls
from mpi4py import MPI
from petsc4py import PETSc

BULK, SHEAR = 1.0, 1.0  # Lamé's first parameter and the shear modulus: a Poisson's ratio of a quarter
LOWEST, STEPS = 0.4, 24


def block(size):
    """A unit cube with the patches "bottom" and "top"."""
    corners = numpy.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    patches = [0, 0, 1, 1] + [2] * 8
    return octafront.mesh(octafront.Surface(corners, faces, patches=patches, patch_names=["bottom", "top", "side"]), size=size)


class Solver:
    """One step of the body as it is: `points` and `tets`, and the deformation gradients that it came by."""

    def __init__(self, points, tets, faces, patches):
        self.grid = grids.create_mesh(MPI.COMM_SELF, tets.astype(numpy.int64), points, ufl.Mesh(ufl.VectorElement("Lagrange", ufl.tetrahedron, 1)))
        self.space = fem.VectorFunctionSpace(self.grid, ("CG", 1))
        self.before = fem.Function(fem.TensorFunctionSpace(self.grid, ("DG", 0)))
        # FEniCSx has orders of its own.
        self.cell = numpy.asarray(self.grid.topology.original_cell_index)
        self.node = numpy.empty(len(points), int)
        corners = self.grid.geometry.dofmap.array.reshape(-1, 4)
        self.node[numpy.asarray(self.grid.geometry.input_global_indices)[corners]] = self.space.dofmap.list.array.reshape(-1, 4)
        self.ends = [self.node[numpy.unique(faces[patches == p])].astype(numpy.int32) for p in (0, 1)]

    def step(self, gradients, down):
        """(displacement, gradients afterwards, force): the top goes down by `down`. RuntimeError where no state is found."""
        self.before.x.array[:] = gradients[self.cell].ravel()
        u, v = fem.Function(self.space), ufl.TestFunction(self.space)
        moved = (ufl.Identity(3) + ufl.grad(u)) * self.before
        volume = ufl.det(moved)
        energy = SHEAR / 2 * (ufl.tr(moved.T * moved) - 3 - 2 * ufl.ln(volume)) + BULK / 2 * ufl.ln(volume) ** 2
        residual = ufl.derivative(energy / ufl.det(self.before) * ufl.dx, u, v)
        held = [fem.dirichletbc(numpy.array(way, float), dofs, self.space) for way, dofs in zip([(0, 0, 0), (0, 0, -down)], self.ends)]
        newton = nls.petsc.NewtonSolver(MPI.COMM_SELF, fem.petsc.NonlinearProblem(residual, u, held))
        newton.rtol, newton.max_it = 1e-9, 20
        linear = newton.krylov_solver
        linear.setType("preonly")
        linear.getPC().setType("lu")
        newton.solve(u)
        forces = fem.petsc.assemble_vector(fem.form(residual)).array.reshape(-1, 3)
        after = fem.Function(self.before.function_space)
        after.interpolate(fem.Expression(moved, after.function_space.element.interpolation_points()))
        made = numpy.empty((len(self.cell), 9))
        made[self.cell] = after.x.array.reshape(-1, 9)
        if not numpy.isfinite(u.x.array).all() or (numpy.linalg.det(made.reshape(-1, 3, 3)) <= 0).any():
            raise RuntimeError("elements turned over")
        return u.x.array.reshape(-1, 3)[self.node], made, float(-forces[self.ends[1], 2].sum())


def quality_of(corners):
    """3 r / R of tetrahedra, (n, 4, 3)."""
    a, b, c = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    volume = numpy.abs(numpy.einsum("ij,ij->i", a, numpy.cross(b, c))) / 6
    area = sum(numpy.linalg.norm(numpy.cross(corners[:, i] - corners[:, k], corners[:, j] - corners[:, k]), axis=1) / 2
               for i, j, k in ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)))
    around = [numpy.sum(v * v, axis=1)[:, None] * numpy.cross(*w) for v, w in ((a, (b, c)), (b, (c, a)), (c, (a, b)))]
    return 3 * (3 * volume / area) / (numpy.linalg.norm(sum(around), axis=1) / (12 * volume))


def unmoved(mesh):
    return numpy.tile(numpy.eye(3).ravel(), (len(mesh.tets), 1))


def pressed(size):
    """Rows of (height, force, elements, least quality): the mesh moves with the body."""
    mesh, rows, down = block(size), [], (1 - LOWEST) / STEPS
    gradients = unmoved(mesh)
    for step in range(STEPS):
        u, gradients, force = Solver(mesh.points, mesh.tets, mesh.faces, mesh.patches).step(gradients, down)
        mesh = octafront.move(mesh, u, fields={"F": gradients}, linear_elements=True, free_integrals=True)
        gradients, quality = mesh.fields["F"], mesh.report["history"][-1]["beta_min"]
        rows.append((1 - (step + 1) * down, force, len(mesh.tets), quality))
    return rows


def lagrangian(size):
    """The same rows on one mesh, as far as it goes."""
    mesh, rows, down = block(size), [], (1 - LOWEST) / STEPS
    points, gradients = mesh.points.copy(), unmoved(mesh)
    for step in range(STEPS):
        try:
            u, gradients, force = Solver(points, mesh.tets, mesh.faces, mesh.patches).step(gradients, down)
        except RuntimeError:
            break
        points = points + u
        rows.append((1 - (step + 1) * down, force, len(mesh.tets), float(quality_of(points[mesh.tets]).min())))
    return rows


def main():
    is_short = "--short" in sys.argv
    found = {"moved": pressed(0.2 if is_short else 0.15)}
    if "--compare" in sys.argv:
        found["lagrangian"] = lagrangian(0.125 if is_short else 0.08)
    if "--json" in sys.argv:
        print(json.dumps(found))
        return
    for name, rows in found.items():
        for height, force, elements, quality in rows:
            print(f"{name}: height {height:.3f}, force {force:.4f}, {elements} elements, least quality {quality:.3f}")


main()
