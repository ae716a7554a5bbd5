"""Meshes solved by CalculiX: sides of a mesh, consistent loads, the deck, what it finds. The same for the meshes of all meshers.

Linear elasticity, or heat that is steady; bodies of one material. Lengths are millimetres, stresses N/mm².
"""
import dataclasses
import pathlib
import tempfile
import typing

import numpy as np

from bench.process import run_measured

YOUNG, POISSON, CONDUCTIVITY = 210000.0, 0.3, 50.0
SHEAR = YOUNG / (2 * (1 + POISSON))
ON_FACE = 1e-4  # of 10 to 100 mm: what a reader of STEP and its own tolerances may move a node; edges are a thousand times longer

# Corners and mid-side nodes as C3D4 and C3D10 (and VTK) have them; faces look outward.
EDGES = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
SIX_POINTS = [(0.109951743655322, 0.091576213509771), (0.223381589678011, 0.445948490915965)]  # weight, the two equal coordinates: degree 4


class Mesh:
    """Points and tetrahedra of 4 or 10 nodes, positive, without points of none; its boundary."""

    def __init__(self, points, tets):
        used, numbers = np.unique(tets, return_inverse=True)
        self.points, self.elements = np.asarray(points, float)[used], numbers.reshape(tets.shape)
        self.turn_positive()
        self.faces = self.boundary()

    def turn_positive(self):
        a, b, c, d = (self.points[self.elements[:, k]] for k in range(4))
        wrong = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
        mirrored = [1, 0, 2, 3] if self.elements.shape[1] == 4 else [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]
        self.elements[wrong] = self.elements[wrong][:, mirrored]

    def boundary(self):
        """Faces of one element alone: 3 nodes, or 6 with those between corners 0-1, 1-2, 2-0."""
        columns = [[*f, *(EDGES[tuple(sorted((f[i], f[(i + 1) % 3])))] for i in range(3))] for f in FACES]
        wide = 3 if self.elements.shape[1] == 4 else 6
        all_faces = np.concatenate([self.elements[:, c[:wide]] for c in columns])
        _, first, count = np.unique(np.sort(all_faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True)
        return all_faces[np.sort(first[count == 1])]

    def faces_where(self, on):
        """Boundary faces whose three corners are there; what lies between them follows the mesher."""
        return self.faces[on(self.points[self.faces[:, :3]].reshape(-1, 3)).reshape(-1, 3).all(axis=1)]

    def nodes_where(self, on):
        return np.unique(self.faces_where(on))

    def corners_where(self, on):
        corners = np.unique(self.elements[:, :4])
        return corners[on(self.points[corners])]

    def node_at(self, place):
        far = np.linalg.norm(self.points - place, axis=1)
        if far.min() > ON_FACE:
            raise ValueError(f"no node at {tuple(place)}: the nearest is {far.min():.2g} away")
        return int(far.argmin())


def shapes(bary, wide):
    """Shape functions of a triangle of 3 or 6 nodes, and their derivatives by the first two of its coordinates."""
    a, b, c = bary
    if wide == 3:
        return np.array([a, b, c]), np.array([[1, 0, -1], [0, 1, -1]], float)
    values = [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a]
    return np.array(values), np.array([[4 * a - 1, 0, 1 - 4 * c, 4 * b, -4 * b, 4 * (c - a)], [0, 4 * b - 1, 1 - 4 * c, 4 * a, 4 * (c - b), -4 * a]])


def quadrature():
    for weight, s in SIX_POINTS:
        for k in range(3):
            yield weight, tuple(1 - 2 * s if i == k else s for i in range(3))


def consistent(mesh, faces, traction):
    """Forces on all nodes: the integral of shape functions times traction(points, unit normals), on faces as curved as they are."""
    corners, total = mesh.points[faces], None
    for weight, bary in quadrature():
        values, slopes = shapes(bary, faces.shape[1])
        at = np.einsum("n,fni->fi", values, corners)
        u, v = (np.einsum("n,fni->fi", s, corners) for s in slopes)
        normal = np.cross(u, v)
        area = np.linalg.norm(normal, axis=1)
        force = traction(at, normal / area[:, None]) * (0.5 * weight * area)[:, None]
        part = values[None, :, None] * force[:, None, :]
        total = part if total is None else total + part
    forces = np.zeros((len(mesh.points), total.shape[2]))
    np.add.at(forces, faces.ravel(), total.reshape(-1, total.shape[2]))
    return forces


@dataclasses.dataclass
class Problem:
    """What CalculiX is given: forces (nodes by degrees of freedom), held values {(node, degree of freedom from 0): value}, the name of its elements
    but for their nodes: C3D, DC3D (heat), CPE (plane strain), CAX (axial symmetry, about y)."""
    mesh: typing.Any
    forces: np.ndarray
    held: dict
    element: str = "C3D"

    @property
    def heat(self):
        return self.element == "DC3D"

    def unknowns(self):
        return len(self.mesh.points) * (1 if self.heat else 3) - len(self.held)


def rows(numbers, values, form):
    return "".join(form % (n + 1, *v) for n, v in zip(numbers, values))


ELASTIC = f"*ELASTIC\n{YOUNG},{POISSON}\n"
KINDS = {"C3D": (ELASTIC, "*STEP\n*STATIC, SOLVER=SPOOLES\n", "*CLOAD\n", "*NODE FILE\nU\n*EL FILE\nS\n"),
         "CPE": (ELASTIC, "1.\n*STEP\n*STATIC, SOLVER=SPOOLES\n", "*CLOAD\n", "*NODE FILE, OUTPUT=2D\nU\n*EL FILE, OUTPUT=2D\nS\n"),  # of thickness 1
         "CAX": (ELASTIC, "*STEP\n*STATIC, SOLVER=SPOOLES\n", "*CLOAD\n", "*NODE FILE, OUTPUT=2D\nU\n*EL FILE, OUTPUT=2D\nS\n"),
         "DC3D": (f"*CONDUCTIVITY\n{CONDUCTIVITY}\n", "*STEP\n*HEAT TRANSFER, STEADY STATE\n", "*CFLUX\n", "*NODE FILE\nNT\n*EL FILE\nHFL\n")}


def deck(problem):
    """Fields of at most 20 characters: CalculiX reads no more of them."""
    mesh, elements = problem.mesh, problem.mesh.elements
    material, step, load, output = KINDS[problem.element]
    width, first = elements.shape[1], 11 if problem.heat else 1  # 11: CalculiX's number of the temperature
    return "".join([
        "*NODE, NSET=ALL\n", rows(range(len(mesh.points)), mesh.points, "%d,%.12e,%.12e,%.12e\n"),
        f"*ELEMENT, TYPE={problem.element}{width}, ELSET=BODY\n", rows(range(len(elements)), elements + 1, "%d" + ",%d" * width + "\n"),
        "*MATERIAL, NAME=M\n", material, "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n", step,
        "*BOUNDARY\n", *(f"{n + 1},{k + first},{k + first},{v:.12e}\n" for (n, k), v in problem.held.items()),
        load, *(f"{n + 1},{k + first},{problem.forces[n, k]:.12e}\n" for n, k in zip(*np.nonzero(problem.forces))), output, "*END STEP\n"])


def fields(path, count):
    """{name: values by node} of a result file, NaN where it has none."""
    found, rows_of = {}, None
    for line in open(path, errors="replace"):
        mark = line[:3]
        if mark == " -1" and rows_of is not None:
            rows_of[0].append(int(line[3:13]) - 1)
            rows_of[1].append([float(line[k:k + 12]) for k in range(13, len(line.rstrip()), 12)])
        elif mark == " -4":
            rows_of = found[line[5:13].strip()] = ([], [])
        elif mark == " -3":
            rows_of = None
    return {name: spread(*pair, count) for name, pair in found.items()}


def spread(numbers, values, count):
    out = np.full((count, len(values[0])), np.nan)
    out[numbers] = values
    return out


def solve(problem, timeout):
    """(Outcome, primary values by node and degree of freedom, stresses or heat flux averaged at nodes); (Outcome, None, None) where CalculiX fails."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "job.inp").write_text(deck(problem))
        outcome = run_measured(["ccx", "job"], folder, timeout)
        if not outcome.error and "Job finished" not in outcome.log:
            outcome.error = next((line.strip() for line in outcome.log.splitlines() if "*ERROR" in line), "no end of the job")[:120]
        if outcome.error:
            return outcome, None, None
        found = fields(folder / "job.frd", len(problem.mesh.points))
    return outcome, found["NDTEMP" if problem.heat else "DISP"], found["FLUX" if problem.heat else "STRESS"]


def first_principal(stress):
    xx, yy, zz, xy, yz, zx = stress.T
    return np.linalg.eigvalsh(np.stack([xx, xy, zx, xy, yy, yz, zx, yz, zz], axis=1).reshape(-1, 3, 3))[:, 2]
