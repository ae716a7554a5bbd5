"""Periodic cells: are opposite faces the same, what do periods cost, beside Gmsh; moduli of a cell of 50 spheres by CalculiX.

Usage: bench/run.sh periodic [--program OCTAFRONT] [--timeout SECONDS] [--no-solver]
Both meshers use one thread. Writes docs/measured/periodic.md.
"""
import argparse
import pathlib
import sys
import tempfile

import meshio
import numpy as np

from bench.models import sector
from bench.models.solids import icosphere
from bench.off import write_off
from bench.ours import mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_measured
from bench.run.inside import block, quality

MATRIX, BALLS = (1.0, 0.3), (10.0, 0.2)  # Young's modulus, Poisson's ratio
BALL = 0.3

GMSH = """
import sys, gmsh
folder, h, r = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
gmsh.initialize(); gmsh.option.setNumber("General.Terminal", 0); gmsh.option.setNumber("General.NumThreads", 1)
occ = gmsh.model.occ
box = occ.addBox(0, 0, 0, 1, 1, 1)
balls = [(3, occ.addSphere(i, j, k, r)) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
inside, _ = occ.intersect(balls, [(3, box)], removeTool=False)
occ.fragment([(3, box)], inside)
occ.synchronize()
near = 1e-6
for axis in range(3):
    low, high = [-near] * 3, [1 + near] * 3
    high[axis] = near
    for master in gmsh.model.getEntitiesInBoundingBox(*low, *high, 2):
        b = list(gmsh.model.getBoundingBox(*master))
        b[axis] += 1; b[axis + 3] += 1
        for copy in gmsh.model.getEntitiesInBoundingBox(*(x - near for x in b[:3]), *(x + near for x in b[3:]), 2):
            if max(abs(x - y) for x, y in zip(gmsh.model.getBoundingBox(*copy), b)) < 1e-5:
                move = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
                move[4 * axis + 3] = 1
                gmsh.model.mesh.setPeriodic(2, [copy[1]], [master[1]], move)
gmsh.option.setNumber("Mesh.MeshSizeMin", h); gmsh.option.setNumber("Mesh.MeshSizeMax", h)
gmsh.model.mesh.generate(3); gmsh.model.mesh.optimize("")
gmsh.model.addPhysicalGroup(3, [t for _, t in gmsh.model.getEntities(3)])
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2); gmsh.write(folder + "/gmsh.msh")
"""


def write_balls(path, places, radius, levels):
    points, faces = icosphere(levels)
    with open(path, "w", encoding="utf-8") as out:
        for i, place in enumerate(places):
            out.write(f"o ball_{i}\n" + "".join("v %.17g %.17g %.17g\n" % tuple(place + radius * p) for p in points))
            out.write("".join("f %d %d %d\n" % tuple(v + 1 + i * len(points) for v in f) for f in faces))


def fifty_places(radius):
    """Apart from each other across faces, and none nearly touching a face."""
    rng, places = np.random.default_rng(3), []
    while len(places) < 50:
        c = rng.uniform(0, 1, 3)
        apart = all(np.linalg.norm((c - d) - np.round(c - d)) > 2.12 * radius for d in places)
        if apart and all(abs(abs(n) - radius) > 0.15 * radius for n in np.minimum(c, 1 - c)):
            places.append(c)
    return places


def ours(folder, program, timeout, name, source, *options, pairs=None):
    pairs = pairs or pairs_of
    outcome = mesh(program, source, folder, timeout, *options, "-o", folder / "ours.inp", out="ours.msh")
    if outcome.error:
        return [name, f"{outcome.error} {outcome.log.strip()[:200]}", *[""] * (len(HEAD) - 2)]
    return row_of(name, outcome.report["tets"], quality(tets_of(folder / "ours.msh")), outcome, pairs(folder / "ours.msh"))


HEAD = ["case", "elements", "mean β", "least angle °", "most °", "CPU s", "pairs", "without", "off by"]


def row_of(name, tets, found, outcome, pairs):
    return [name, f"{tets:,}", f"{found['beta']:.4f}", f"{found['least']:.1f}", f"{found['most']:.1f}", f"{outcome.cpu_seconds:.2f}", *pairs]


def tets_of(file):
    mesh = meshio.read(file)
    return mesh.points[np.concatenate([c.data for c in mesh.cells if c.type == "tetra"])]


def pairs_of(file):
    """Nodes at both ends of each axis: how many there are, how many have a partner, and how far from its place."""
    mesh = meshio.read(file)
    p = mesh.points[np.unique(np.concatenate([c.data for c in mesh.cells if c.type == "tetra"]))]
    words, worst, lonely = [], 0.0, 0
    for axis in range(3):
        low, high = p[p[:, axis] == 0], p[p[:, axis] == 1]
        others = [k for k in range(3) if k != axis]
        at = {}
        for q in low:
            at.setdefault(tuple(np.round(q[others], 9)), []).append(q)
        for q in high:
            near = at.get(tuple(np.round(q[others], 9)), [])
            lonely += not near
            worst = max([worst, *(np.abs(q[others] - n[others]).max() for n in near[:1])])
        words.append(f"{len(high)}")
    return " + ".join(words), lonely, f"{worst:.1g}"


def gmsh(folder, timeout, name, program, *arguments, pairs=None):
    pairs = pairs or pairs_of
    (folder / "by_gmsh.py").write_text(program)
    outcome = run_measured(["/usr/bin/python3", folder / "by_gmsh.py", folder, *arguments], folder, timeout)
    if outcome.error:
        return [name, outcome.error, *[""] * (len(HEAD) - 2)]
    tets = tets_of(folder / "gmsh.msh")
    return row_of(name, len(tets), quality(tets), outcome, pairs(folder / "gmsh.msh"))


class Deck:
    """An Abaqus file of a periodic cell: nodes, elements by region, the nodes of its periods."""

    def __init__(self, path):
        self.path, self.nodes, self.elements, self.region, self.periods = path, {}, {}, {}, []
        rows = name = None
        for line in path.read_text().splitlines():
            if line.startswith("*"):
                rows = {"*NODE": self.nodes, "*ELEMENT": self.elements}.get(line.split(",")[0].upper())
                name = line.split("=")[-1].strip() if "SET=" in line else None
                continue
            if rows is None:
                continue
            values = [w for w in line.split(",") if w.strip()]
            number = int(values[0])
            if rows is self.nodes:
                self.nodes[number] = np.array([float(w) for w in values[1:]])
                if name:
                    self.periods.append(number)
            else:
                self.elements[number] = [int(w) for w in values[1:]]
                self.region[number] = name
        self.sets = list(dict.fromkeys(self.region.values()))
        self.volume = {e: self.volume_of(n) for e, n in self.elements.items()}

    def volume_of(self, nodes):
        a, b, c, d = (self.nodes[n] for n in nodes[:4])
        return abs(np.dot(np.cross(b - a, c - a), d - a)) / 6

    def share_of_balls(self):
        return sum(v for e, v in self.volume.items() if self.region[e] != "matrix") / sum(self.volume.values())

    def mean_stress(self, strain, folder):
        """Of the cell, stretched by this mean strain."""
        held = min((n for n in self.nodes if n not in self.periods), key=lambda n: tuple(np.abs(self.nodes[n])))
        lines = [f"*INCLUDE, INPUT={self.path.name}"]
        for name, (young, poisson) in (("MATRIX", MATRIX), ("BALLS", BALLS)):
            lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young}, {poisson}"]
        lines += [f"*SOLID SECTION, ELSET={s}, MATERIAL={'MATRIX' if s == 'matrix' else 'BALLS'}" for s in self.sets]
        lines += ["*ELSET, ELSET=ALL_OF_IT", *(f"{s}," for s in self.sets), "*BOUNDARY", f"{held}, 1, 3", "*STEP", "*STATIC, SOLVER=SPOOLES",
                  "*BOUNDARY"]
        for period in self.periods:
            lines += [f"{period}, {k + 1}, {k + 1}, {u:.12g}" for k, u in enumerate(strain @ self.nodes[period])]
        lines += ["*EL PRINT, ELSET=ALL_OF_IT", "S", "*END STEP"]
        (folder / "cell.inp").write_text("\n".join(lines) + "\n")
        outcome = run_measured(["ccx", "cell"], folder, 600)
        if outcome.error:
            raise RuntimeError(outcome.error + outcome.log[-500:])
        stress, total = np.zeros(6), 0.0
        for line in (folder / "cell.dat").read_text().splitlines():
            words = line.split()
            if len(words) == 8 and words[0].isdigit():
                v = self.volume[int(words[0])]
                stress += v * np.array([float(w) for w in words[2:]])
                total += v
        return stress / total


def bulk_and_shear(material):
    young, poisson = material
    return young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))


def hashin_shtrikman(soft, stiff, share):
    """Bounds of bulk and shear modulus (Z. Hashin, S. Shtrikman, 1963); `share`: of the stiff one."""
    def bound(a, b, part):
        (ka, ga), (kb, gb) = a, b
        return (ka + part / (1 / (kb - ka) + 3 * (1 - part) / (3 * ka + 4 * ga)),
                ga + part / (1 / (gb - ga) + 6 * (1 - part) * (ka + 2 * ga) / (5 * ga * (3 * ka + 4 * ga))))
    return bound(soft, stiff, share), bound(stiff, soft, 1 - share)


def moduli(folder):
    deck = Deck(folder / "ours.inp")
    unit = 1e-3
    bulk = deck.mean_stress(unit * np.eye(3), folder)[:3].sum() / (9 * unit)
    shears = []
    for (i, j), component in (((0, 1), 3), ((0, 2), 4), ((1, 2), 5)):
        strain = np.zeros((3, 3))
        strain[i, j] = strain[j, i] = unit / 2
        shears.append(deck.mean_stress(strain, folder)[component] / unit)
    share = deck.share_of_balls()
    (k_low, g_low), (k_high, g_high) = hashin_shtrikman(bulk_and_shear(MATRIX), bulk_and_shear(BALLS), share)
    return (f"{len(deck.elements):,} elements, balls are {100 * share:.2f} % of the volume. Bulk modulus {bulk:.4f}, bounds {k_low:.4f} and "
            f"{k_high:.4f}; shear moduli {', '.join(f'{g:.4f}' for g in shears)}, bounds {g_low:.4f} and {g_high:.4f}.")


def voronoi(path, n=40, seeds=12):
    """A label image that goes on at its other side."""
    places = np.random.default_rng(5).uniform(0, n, (seeds, 3))
    at = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), -1).astype(float)
    away = [at - place for place in places]
    labels = np.argmin([((v - n * np.round(v / n)) ** 2).sum(-1) for v in away], 0).astype(np.uint8) + 1
    with open(path, "wb") as out:
        out.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {n} {n} {n}\nspacings: 1 1 1\nencoding: raw\n\n".encode())
        out.write(labels.astype(np.uint8).transpose(2, 1, 0).tobytes())


def file_pairs(deck):
    """By the equations of an Abaqus file, for what lies on no straight faces."""
    copies = set()
    lines = iter(deck.read_text().splitlines())
    for line in lines:
        if line == "*EQUATION":
            break
    for line in lines:
        words = line.split(",")
        if len(words) > 2 and words[2].strip() == "1.":
            copies.add(int(words[0]))
    return (f"{len(copies)} in the file", "", "") if copies else ("", "", "")


def turned_ring(folder, program):
    done = run_measured([program, "mesh", folder / "sector.obj", "--periodic", f"{sector.DEGREES:g}@z", "--size", 0.05, "--order", 2, "-q", "-o",
                         folder / "turned.inp"], folder, 600)
    if done.error:
        return done.error
    inner, outer = sector.solved(folder, "turned.inp")
    return (f"12 sectors of 30 degrees, radius 1 to 2, .1 thick, second order at size .05, by CalculiX with the equations of the file "
            f"(u(copy) = R u(original)). It grows by {100 * inner:.2f} % of what theory says at the inner rim, by {100 * outer:.2f} % at the outer "
            "one (plane stress: S. Timoshenko, J. N. Goodier, Theory of Elasticity).")


ABOUT = """# Periodic cells

{written}: a unit cell, one thread, CPU seconds of whole processes; meshes are read by meshio.
*With*, *without*: `--periodic xyz` or not. In the columns: nodes at the high end that have no partner at the low end within 1e-9, and the largest difference of coordinates that should be equal. The ball of radius .3 sits at a corner of the cell. Gmsh 4.8.4 cuts spheres by OpenCASCADE and pairs faces with `setPeriodic`. A sector of 30 degrees of a ring of radius 1 to 2, .1 thick, is paired by `--periodic 30@z`.
"""


COARSER = ("block, size 0.1,", "ball at a corner, size 0.06", "the same, Gmsh, size 0.06", "sector of a ring, size 0.05", "the same, Gmsh, size 0.05")
NOT_SHOWN = ("sector with curved sides", "image of 12 labels")


def shown(rows):
    """Rows of cells."""
    finer = [r for r in rows if not r[0].startswith(COARSER + NOT_SHOWN)]
    return [*tables.some(HEAD, finer, [c for c in HEAD if c not in ("most °", "pairs")]), "", f"With coarser sizes, a sector with curved sides, an image of 12 labels, and the numbers of pairs: {tables.put('periodic', HEAD, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--no-solver", action="store_true")
    options = parser.parse_args()
    program = (options.program or options.build / "cli" / "octafront").resolve()
    rows = []

    def add(line):
        rows.append(line)
        print(tables.row(line), flush=True)

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_off(folder / "block.off", *block())
        write_balls(folder / "corner.obj", [np.zeros(3)], BALL, 5)
        write_balls(folder / "fifty.obj", fifty_places(0.085), 0.085, 3)
        cell = ("--box", "0,0,0,1,1,1")
        for size in (0.1, 0.05):
            for word, more in (("with", ("--periodic", "xyz")), ("without", ())):
                add(ours(folder, program, options.timeout, f"block, size {size}, {word}", folder / "block.off", "--size", size, *more))
        for size in (0.06, 0.04):
            for word, more in (("with", ("--periodic", "xyz")), ("without", ("--repeat", "xyz"))):
                add(ours(folder, program, options.timeout, f"ball at a corner, size {size}, {word}", folder / "corner.obj", *cell, "--size", size,
                         *more))
            add(gmsh(folder, options.timeout, f"the same, Gmsh, size {size}", GMSH, size, BALL))
        add(ours(folder, program, options.timeout, "abs(gyroid) < .4, size .05, with", "abs(gyroid) < 0.4", "--size", 0.05, "--periodic", "xyz"))
        for word, more in (("without", ("--repeat", "xyz")), ("with", ("--periodic", "xyz"))):
            add(ours(folder, program, options.timeout, f"50 balls, size .05, {word}", folder / "fifty.obj", *cell, "--size", 0.05, *more))
        solved = "" if options.no_solver else moduli(folder)
        print(solved)
        sector.write_sector(folder / "sector.obj")
        for size in (0.05, 0.025):
            for word, more in (("with", ("--periodic", f"{sector.DEGREES:g}@z")), ("without", ())):
                add(ours(folder, program, options.timeout, f"sector of a ring, size {size}, {word}", folder / "sector.obj", "--size", size, *more,
                         pairs=sector.pairs_of))
            add(gmsh(folder, options.timeout, f"the same, Gmsh, size {size}", sector.GMSH, size, sector.INNER, sector.OUTER, sector.HIGH,
                     sector.DEGREES, pairs=sector.pairs_of))
        sector.write_sector(folder / "blade.obj", twist=0.4, high=1.0, around=60)
        for word, more in (("with", ("--periodic", f"{sector.DEGREES:g}@z")), ("without", ())):
            add(ours(folder, program, options.timeout, f"sector with curved sides, size .05, {word}", folder / "blade.obj", "--size", 0.05, *more,
                     pairs=lambda file: file_pairs(file.with_suffix(".inp"))))
        voronoi(folder / "cells.nrrd")
        for word, more in (("with", ("--periodic", "xyz")), ("without", ())):
            add(ours(folder, program, options.timeout, f"image of 12 labels, 40³ voxels, size 2, {word}", folder / "cells.nrrd", "--image", "labels",
                     "--size", 2, *more, pairs=lambda file: file_pairs(file.with_suffix(".inp"))))
        ring = "" if options.no_solver else turned_ring(folder, program)
        print(ring)
    lines = [ABOUT.format(written=written_by("bench/run.sh periodic")), *shown(rows)]
    if solved:
        lines += ["", "**Moduli of the cell with 50 balls**, matrix and balls with Young's moduli 1 and 10, Poisson's ratios .3 and .2, by CalculiX with the equations "
                  f"of the file, stretched four ways; bounds of Hashin and Shtrikman: {solved}"]
    if ring:
        lines += ["", f"**A ring that turns**, by a sector of it: {ring}"]
    tables.write("periodic", lines)


if __name__ == "__main__":
    sys.exit(main())
