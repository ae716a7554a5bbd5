"""References: plane strain or axial symmetry, second order, far finer at a notch than meshes in space can be. And bodies drawn from the same outlines."""
import contextlib
import dataclasses
import functools
import math
import os
import sys
import typing

import gmsh
import numpy as np

from bench.judges.answers_solved import first_principal, ON_FACE, Problem, solve

FINE, COARSER = 60, 30  # edges to a radius of the notch, of the reference and of what it is held against
SECONDS = 60


def raised(outline, thick):
    return lambda occ: occ.extrude([(2, outline(occ))], 0, 0, thick)


def turned(outline):
    return lambda occ: occ.revolve([(2, outline(occ))], 0, 0, 0, 0, 1, 0, math.pi / 2)


@functools.cache
def start_gmsh():
    gmsh.initialize(["", "-nt", "1"])
    gmsh.option.setNumber("General.Terminal", 0)


def drawn(draw):
    """A new model of Gmsh's, in this process; what bounds nothing (centres of arcs) is dropped."""
    start_gmsh()
    gmsh.clear()
    gmsh.model.add("body")
    draw(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    top = gmsh.model.getDimension()
    used = {(d, abs(t)) for d, t in gmsh.model.getBoundary(gmsh.model.getEntities(top), recursive=True)}
    gmsh.model.occ.remove([e for e in gmsh.model.getEntities(0) if e not in used])
    gmsh.model.occ.synchronize()


@contextlib.contextmanager
def silence():
    """For OpenCASCADE, which tells standard output that it writes."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def write_step(draw, path):
    """Returns volume and diagonal of the body."""
    drawn(draw)
    with silence():
        gmsh.write(str(path))
    (dim, tag), = gmsh.model.getEntities(3)
    box = gmsh.model.occ.getBoundingBox(dim, tag)
    return gmsh.model.occ.getMass(dim, tag), math.dist(box[:3], box[3:])


@dataclasses.dataclass
class Flat:
    """Points in the plane z = 0, triangles of six nodes, sides of three: both ends, then the middle."""
    points: np.ndarray
    elements: np.ndarray
    sides: np.ndarray

    def sides_where(self, on):
        return self.sides[on(self.points[self.sides].reshape(-1, 3)).reshape(-1, 3).all(axis=1)]


def nodes_of(dim, kind):
    made = (gmsh.model.mesh.getElements(*entity) for entity in gmsh.model.getEntities(dim))
    return np.concatenate([np.array(n, int) for kinds, _, nodes in made for k, n in zip(kinds, nodes) if k == kind])


def meshed(outline, notch, size):
    """The outline in triangles of `size` at curves where `notch`(points), ten times that far away."""
    drawn(outline)
    lines = [t for _, t in gmsh.model.getEntities(1) if notch(middle_of(t))[0]]
    field = gmsh.model.mesh.field
    field.add("Distance", 1)
    field.setNumbers(1, "EdgesList", lines)
    field.setNumber(1, "NNodesByEdge", 400)
    field.add("MathEval", 2)
    field.setString(2, "F", f"{size} + 0.08 * F1")
    field.setAsBackgroundMesh(2)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber("Mesh.MeshSize" + option, 0)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.model.mesh.generate(2)
    tags, at, _ = gmsh.model.mesh.getNodes()
    triangles, sides = nodes_of(2, 9).reshape(-1, 6), nodes_of(1, 8).reshape(-1, 3)
    used = np.unique(triangles)
    where = np.zeros(int(max(tags)) + 1, int)
    where[used] = np.arange(len(used))
    place = np.zeros((int(max(tags)) + 1, 3))
    place[np.array(tags, int)] = np.array(at).reshape(-1, 3)
    return Flat(place[used], turned_left(place[used], where[triangles]), where[sides])


def turned_left(points, triangles):
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    return triangles if np.cross(b - a, c - a)[0] > 0 else triangles[:, [0, 2, 1, 5, 4, 3]]


def middle_of(line):
    low, high = gmsh.model.getParametrizationBounds(1, line)
    return np.array(gmsh.model.getValue(1, line, [(low[0] + high[0]) / 2])).reshape(1, 3)


@dataclasses.dataclass(eq=False)
class Model:
    """`held`: (where, degree of freedom); `loads`: (where, traction); displacement of `place` along an axis; the largest principal stress of nodes
    at the `notch`, whose radius is given. `around`: about the y axis."""
    outline: typing.Callable
    held: list
    loads: list
    place: tuple
    along: int
    notch: typing.Callable
    radius: float
    around: bool = False
    fixed: tuple = ()
    nominal: float = 100.0  # stress that factors refer to

    @functools.cached_property
    def answers(self):
        """(displacement, work of loads of a unit of thickness or of a full turn, peak stress), finer one first."""
        return [self.solved(parts) for parts in (FINE, COARSER)]

    def right(self, share):
        displacement, work, peak = self.answers[0]
        return displacement, work * share, peak

    def told(self):
        fine, coarse = (a[2] / self.nominal for a in self.answers)
        kind = "an axially symmetric" if self.around else "a plane"
        return f"{kind} model with {FINE} edges to the notch's radius says {fine:.4f}, and that is taken (with {COARSER}: {coarse:.4f})"

    def forces(self, mesh):
        forces = np.zeros((len(mesh.points), 2))
        for where, traction in self.loads:
            for side in mesh.sides_where(where):
                np.add.at(forces, side, self.weights(mesh.points[side])[:, None] * np.array(traction))
        return forces

    def weights(self, at):
        """Of the three nodes of a straight side; about an axis the radius rises along it."""
        length, r = math.dist(at[0], at[1]), 2 * math.pi * at[:, 0]
        if not self.around:
            return length * np.array([1, 1, 4]) / 6
        return length / 6 * np.array([r[0], r[1], 2 * (r[0] + r[1])])

    def solved(self, parts):
        mesh = meshed(self.outline, self.notch, self.radius / parts)
        held = {(int(n), k): 0.0 for where, k in self.held for n in np.flatnonzero(where(mesh.points))}
        held |= {(self.node_at(mesh, place), k): 0.0 for place, k in self.fixed}
        problem = Problem(mesh, self.forces(mesh), held, "CAX" if self.around else "CPE")
        outcome, moved, stress = solve(problem, SECONDS)
        if outcome.error:
            raise SystemExit(f"the reference has no answer: {outcome.error}")
        there = self.notch(mesh.points) & ~np.isnan(stress).any(axis=1)
        return (moved[self.node_at(mesh, self.place), self.along], (problem.forces * moved[:, :2]).sum() / 2, first_principal(stress[there]).max())

    def node_at(self, mesh, place):
        far = np.hypot(mesh.points[:, 0] - place[0], mesh.points[:, 1] - place[1])
        if far.min() > ON_FACE:
            raise ValueError(f"no node at {place}")
        return int(far.argmin())
