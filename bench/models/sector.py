"""A sector of a ring: written, meshed by Gmsh with paired sides, its pairs looked at, turned until it is stretched and solved by CalculiX."""
import math
import pathlib
import sys

import meshio
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples" / "solve"))
import ccx  # noqa: E402

INNER, OUTER, HIGH, DEGREES = 1.0, 2.0, 0.1, 30.0
YOUNG, POISSON, DENSITY, SPEED = 1000.0, 0.3, 1.0, 1.0

GMSH = """
import sys, math, gmsh
folder, h = sys.argv[1], float(sys.argv[2])
inner, outer, high, degrees = (float(a) for a in sys.argv[3:7])
gmsh.initialize(); gmsh.option.setNumber("General.Terminal", 0); gmsh.option.setNumber("General.NumThreads", 1)
occ = gmsh.model.occ
angle = math.radians(degrees)
whole = [(3, occ.addCylinder(0, 0, 0, 0, 0, high, outer, angle=angle))]
occ.cut(whole, [(3, occ.addCylinder(0, 0, 0, 0, 0, high, inner))])
occ.synchronize()
def middle(tag):
    return gmsh.model.occ.getCenterOfMass(2, tag)
sides = {}
for _, tag in gmsh.model.getEntities(2):
    x, y, _ = middle(tag)
    if abs(y) < 1e-9: sides["low"] = tag
    if abs(math.atan2(y, x) - angle) < 1e-9: sides["high"] = tag
c, s = math.cos(angle), math.sin(angle)
gmsh.model.mesh.setPeriodic(2, [sides["high"]], [sides["low"]], [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
gmsh.option.setNumber("Mesh.MeshSizeMin", h); gmsh.option.setNumber("Mesh.MeshSizeMax", h)
gmsh.model.mesh.generate(3); gmsh.model.mesh.optimize("")
gmsh.model.addPhysicalGroup(3, [t for _, t in gmsh.model.getEntities(3)])
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2); gmsh.write(folder + "/gmsh.msh")
"""


def write_sector(path, twist=0.0, high=HIGH, around=120):
    """An OBJ; `twist`: radians by which the sector turns over its height and, with its square, over the radius."""
    radial, up = around // 4, max(1, round(around * high / 2))
    numbers, points, faces = {}, [], []

    def at(i, j, k):
        if (i, j, k) not in numbers:
            r, z = INNER + (OUTER - INNER) * i / radial, high * k / up
            angle = math.radians(DEGREES) * j / around + twist * (z / high + (r - INNER) ** 2)
            points.append((r * math.cos(angle), r * math.sin(angle), z))
            numbers[i, j, k] = len(points)
        return numbers[i, j, k]

    def quad(a, b, c, d):
        faces.extend([(a, b, c), (a, c, d)])

    for i in range(radial):
        for k in range(up):
            quad(at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1))
            # The same diagonals on both sides.
            a, b, c, d = at(i, around, k), at(i + 1, around, k), at(i + 1, around, k + 1), at(i, around, k + 1)
            faces.extend([(a, c, b), (a, d, c)])
    for j in range(around):
        for k in range(up):
            quad(at(radial, j, k), at(radial, j + 1, k), at(radial, j + 1, k + 1), at(radial, j, k + 1))
            quad(at(0, j, k), at(0, j, k + 1), at(0, j + 1, k + 1), at(0, j + 1, k))
        for i in range(radial):
            quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0))
            quad(at(i, j, up), at(i + 1, j, up), at(i + 1, j + 1, up), at(i, j + 1, up))
    path.write_text("".join("v %.17g %.17g %.17g\n" % p for p in points) + "".join("f %d %d %d\n" % f for f in faces))


def pairs_of(file):
    """Nodes on the straight side that is turned: how many have no partner, and how far off it is."""
    mesh = meshio.read(file)
    p = mesh.points[np.unique(np.concatenate([c.data for c in mesh.cells if c.type.startswith("tetra")]))]
    a = math.radians(DEGREES)
    low = p[np.abs(p[:, 1]) < 1e-9]
    high = p[np.abs(p[:, 0] * math.sin(a) - p[:, 1] * math.cos(a)) < 1e-9]
    back = np.stack([high[:, 0] * math.cos(a) + high[:, 1] * math.sin(a), high[:, 1] * math.cos(a) - high[:, 0] * math.sin(a), high[:, 2]], axis=1)
    off = [np.abs(low - q).max(axis=1).min() for q in back]
    near = [d for d in off if d < 1e-6]
    return len(high), len(off) - len(near), f"{max(near, default=0):.1g}"


def stretched(r):
    """How far a thin ring that turns grows at this radius (S. Timoshenko, J. N. Goodier, Theory of Elasticity, art. 32)."""
    a, b, nu = INNER, OUTER, POISSON
    return (DENSITY * SPEED**2 * (3 + nu) * (1 - nu) / (8 * YOUNG) * r *
            (a * a + b * b + (1 + nu) / (1 - nu) * a * a * b * b / (r * r) - (1 + nu) / (3 + nu) * r * r))


def solved(folder, inp):
    """The ring by one sector: by how much of theory it grows at both rims."""
    mesh = ccx.Mesh(folder / inp)
    middle = min(mesh.nodes, key=lambda n: abs(mesh.nodes[n][2]) + abs(mesh.nodes[n][1]) + abs(mesh.nodes[n][0] - INNER))
    (folder / "ring.inp").write_text("\n".join([
        f"*INCLUDE, INPUT={inp}", "*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{DENSITY}",
        *(f"*SOLID SECTION, ELSET={s}, MATERIAL=M" for s in mesh.element_sets), "*BOUNDARY", f"{middle}, 2, 3", "*STEP",
        "*STATIC, SOLVER=SPOOLES", "*DLOAD", *(f"{s}, CENTRIF, {SPEED**2}, 0, 0, 0, 0, 0, 1" for s in mesh.element_sets),
        "*NODE FILE", "U", "*END STEP"]) + "\n")
    ccx.run(folder / "ring.inp")
    moved = ccx.frd(folder / "ring.frd")["DISP"]
    parts = []
    for radius in (INNER, OUTER):
        grown = []
        for n, (x, y, _) in mesh.nodes.items():
            r = math.hypot(x, y)
            if n in moved and abs(r - radius) < 1e-4:
                grown.append((moved[n][0] * x + moved[n][1] * y) / r)
        parts.append(np.mean(grown) / stretched(radius))
    return parts
