"""Sheets, lines and points inside of a block, beside Gmsh and TetGen: is every part of them in the mesh, at what cost, how good are the elements?

Usage: bench/run.sh inside [--only SUBSTRING] [--program OCTAFRONT] [--timeout SECONDS]
All at one size, one thread; meshes are read by meshio and judged alike. Writes docs/measured/inside.md.
"""
import argparse
import math
import pathlib
import sys
import tempfile

import meshio
import numpy as np

from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_measured


def block():
    points = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def frame(normal):
    normal = normal / np.linalg.norm(normal)
    u = np.cross(normal, (1, 0, 0) if abs(normal[0]) < 0.5 else (0, 1, 0))
    u /= np.linalg.norm(u)
    return u, np.cross(normal, u)


def discs(count, radius, seed, inside):
    """Hexagons as a network of fractures: centre, two axes."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        low, high = (radius, 1 - radius) if inside else (0, 1)
        made.append((rng.uniform(low, high, 3), *frame(rng.normal(size=3))))
    return made


def corners(disc, radius, sides=6):
    centre, u, v = disc
    angles = 2 * math.pi * np.arange(sides) / sides
    return np.array([centre + radius * (math.cos(a) * u + math.sin(a) * v) for a in angles])


def clipped_area(polygon):
    """Of a convex polygon, inside of the unit cube."""
    for axis in range(3):
        for sign, at in ((1, 0.0), (-1, -1.0)):
            kept = []
            for p, q in zip(polygon, np.roll(polygon, -1, axis=0)):
                a, b = sign * p[axis] - at, sign * q[axis] - at
                if a >= 0:
                    kept.append(p)
                if (a >= 0) != (b >= 0):
                    kept.append(p + a / (a - b) * (q - p))
            polygon = np.array(kept)
            if len(polygon) < 3:
                return 0.0
    total = sum(np.cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]) for i in range(1, len(polygon) - 1))
    return np.linalg.norm(total) / 2


def helix(turns=3, steps=240):
    t = np.linspace(0, 1, steps + 1)
    a = 2 * math.pi * turns * t
    return np.stack([0.5 + 0.3 * np.cos(a), 0.5 + 0.3 * np.sin(a), 0.1 + 0.8 * t], axis=1)


class Case:
    def __init__(self, name, size, sheets=(), lines=(), points=()):
        self.name, self.size, self.sheets, self.lines, self.points = name, size, list(sheets), list(lines), points

    def area(self):
        return sum(clipped_area(polygon) for polygon in self.sheets)

    def length(self):
        return sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in self.lines)


def cases():
    rng = np.random.default_rng(7)
    bars = [np.array([[x, 0.15, 0.5], [x, 0.85, 0.5]]) for x in np.linspace(0.2, 0.8, 5)]
    return [
        Case("nothing", 0.05),
        Case("10 fractures inside", 0.05, [corners(d, 0.25) for d in discs(10, 0.25, 1, True)]),
        Case("30 fractures, cut by the sides", 0.05, [corners(d, 0.3) for d in discs(30, 0.3, 2, False)]),
        Case("helix of 240 edges", 0.05, lines=[helix()]),
        Case("5 bars", 0.05, lines=bars),
        Case("100 points", 0.05, points=rng.uniform(0.1, 0.9, (100, 3))),
    ]


def run_ours(case, program, folder, timeout):
    write_off(folder / "block.off", *block())
    command = [program, "mesh", folder / "block.off", "--size", case.size, "--threads", 1, "-q", "-o", folder / "ours.msh"]
    for i, polygon in enumerate(case.sheets):
        write_off(folder / f"sheet{i}.off", polygon, [tuple(range(len(polygon)))])
        command += ["--sheet", folder / f"sheet{i}.off"]
    for i, line in enumerate(case.lines):
        np.savetxt(folder / f"line{i}.txt", line, fmt="%.17g")
        command += ["--wire", folder / f"line{i}.txt"]
    if len(case.points):
        np.savetxt(folder / "points.csv", case.points, fmt="%.17g", delimiter=",")
        command += ["--points", folder / "points.csv"]
    outcome = run_measured(command, folder, timeout)
    return outcome, folder / "ours.msh"


GMSH = """
import sys, numpy as np, gmsh
folder, size = sys.argv[1], float(sys.argv[2])
data = np.load(folder + "/case.npz", allow_pickle=True)
gmsh.initialize(); gmsh.option.setNumber("General.Terminal", 0); gmsh.option.setNumber("General.NumThreads", 1)
occ = gmsh.model.occ
box = [(3, occ.addBox(0, 0, 0, 1, 1, 1))]
tools = []
for polygon in data["sheets"]:
    p = [occ.addPoint(*x) for x in polygon]
    l = [occ.addLine(p[i], p[(i + 1) % len(p)]) for i in range(len(p))]
    tools.append((2, occ.addPlaneSurface([occ.addCurveLoop(l)])))
for line in data["lines"]:
    p = [occ.addPoint(*x) for x in line]
    tools += [(1, occ.addLine(p[i], p[i + 1])) for i in range(len(p) - 1)]
tools += [(0, occ.addPoint(*x)) for x in data["points"]]
found = occ.fragment(box, tools)[1] if tools else [box]
occ.synchronize()
inside = {}
for dim, number, parts in ((2, len(data["sheets"]), []), (1, len(tools) - len(data["sheets"]) - len(data["points"]), [])):
    pass
volumes = [tag for _, tag in gmsh.model.getEntities(3)]
walls = {abs(t) for _, t in gmsh.model.getBoundary(gmsh.model.getEntities(3), oriented=False)}
first = 1
groups = {"sheets": [], "lines": [], "points": []}
for (dim, tag), parts in zip(tools, found[1:]):
    groups[("points", "lines", "sheets")[dim]] += [t for d, t in parts if d == dim]
eps = 1e-9
def is_in(dim, tag):
    lo, hi = np.array(gmsh.model.getBoundingBox(dim, tag)).reshape(2, 3)
    return (lo > -1e-6).all() and (hi < 1 + 1e-6).all()
for name, dim in (("sheets", 2), ("lines", 1), ("points", 0)):
    tags = sorted({t for t in groups[name] if is_in(dim, t)})
    if tags: gmsh.model.addPhysicalGroup(dim, tags)
gmsh.model.addPhysicalGroup(3, volumes)
gmsh.option.setNumber("Mesh.CharacteristicLengthMin", size); gmsh.option.setNumber("Mesh.CharacteristicLengthMax", size)
gmsh.option.setNumber("Mesh.Algorithm3D", 10)
gmsh.model.mesh.generate(3); gmsh.model.mesh.optimize("")
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2); gmsh.write(folder + "/gmsh.msh")
"""


def run_gmsh(case, folder, timeout):
    def as_objects(rows):
        array = np.empty(len(rows), dtype=object)
        for i, row in enumerate(rows):
            array[i] = np.asarray(row)
        return array
    np.savez(folder / "case.npz", sheets=as_objects(case.sheets), lines=as_objects(case.lines),
             points=np.asarray(case.points, dtype=float).reshape(-1, 3))
    (folder / "by_gmsh.py").write_text(GMSH)
    return run_measured(["/usr/bin/python3", folder / "by_gmsh.py", folder, case.size], folder, timeout), folder / "gmsh.msh"


def fitting_walls(case, program, folder):
    """What TetGen wants: facets that fit together. Fractures cross, so theirs are the triangles that we make of them and of the cube."""
    if not case.sheets:
        points, faces = block()
        return np.array(points, dtype=float), faces
    command = [program, "surface", folder / "block.off", "--size", case.size, "-q", "-o", folder / "walls.off"]
    for i in range(len(case.sheets)):
        command += ["--sheet", folder / f"sheet{i}.off"]
    run_measured(command, folder, 300)
    mesh = meshio.read(folder / "walls.off")
    return mesh.points, mesh.cells_dict["triangle"]


def run_tetgen(case, program, folder, timeout):
    points, faces = fitting_walls(case, program, folder)
    facets = [list(face) for face in faces]
    points = list(points)
    for line in case.lines:
        first = len(points)
        points += list(line)
        facets += [[first + i, first + i + 1] for i in range(len(line) - 1)]
    points += list(case.points)
    rows = [f"{len(points)} 3 0 0"] + ["%d %.17g %.17g %.17g" % (i, *p) for i, p in enumerate(points)] + [f"{len(facets)} 0"]
    for facet in facets:
        rows += ["1", f"{len(facet)} {' '.join(map(str, facet))}"]
    (folder / "case.poly").write_text("\n".join([*rows, "0", "0"]) + "\n")
    # No element is larger than 1.5 regular ones of that edge (peers/tetgen.py); -Y: the walls of fractures stay as they are.
    outcome = run_measured(["tetgen", f"-pq1.2/10a{1.5 * case.size**3 / 72**0.5:.6g}efQ" + ("Y" if case.sheets else ""), folder / "case.poly"],
                           folder, timeout)
    file = folder / "tetgen.vtu"
    if not outcome.error and (folder / "case.1.ele").exists():
        nodes, *cells = (np.loadtxt(folder / f"case.1.{end}", skiprows=1, comments="#") for end in ("node", "ele", "face", "edge"))
        tets, triangles, edges = (c[:, 1:1 + n].astype(int) for c, n in zip(cells, (4, 3, 2)))
        on = nodes[:, 1:4]
        kept = {"tetra": tets, "triangle": triangles[marked(folder / "case.1.face", 3)]}
        if case.lines:
            kept["line"] = edges[marked(folder / "case.1.edge", 2)]
        meshio.write_points_cells(file, on, kept)
    return outcome, file


def marked(file, corners):
    """Which rows of a file of TetGen's are of what was given: they have a marker."""
    rows = np.loadtxt(file, skiprows=1, comments="#")
    return rows[:, 1 + corners] != 0


def judged(file, case):
    """Elements, least dihedral angle, mean beta, area and length found, points that are nodes."""
    mesh = meshio.read(file)
    points = mesh.points
    cells = {kind: np.concatenate([c.data for c in mesh.cells if c.type == kind]) for kind in {c.type for c in mesh.cells}}
    tets = points[cells["tetra"]]
    return {"tets": len(tets), **quality(tets), "area": sheet_area(points, cells, case), "length": line_length(points, cells),
            "points": points_found(points, case)}


def quality(t):
    faces = np.array([(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)])
    normals = np.stack([np.cross(t[:, b] - t[:, a], t[:, c] - t[:, a]) for a, b, c in faces], axis=1)
    areas = np.linalg.norm(normals, axis=2)
    unit = normals / areas[:, :, None]
    angles = np.stack([180 - np.degrees(np.arccos(np.clip((unit[:, i] * unit[:, j]).sum(axis=1), -1, 1)))
                       for i in range(4) for j in range(i)])
    volume = np.abs(np.einsum("ij,ij->i", np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), t[:, 3] - t[:, 0])) / 6
    inner = 3 * volume / (areas.sum(axis=1) / 2)
    a, b, c = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0], t[:, 3] - t[:, 0]
    sums = (np.cross(b, c) * (a * a).sum(axis=1)[:, None] + np.cross(c, a) * (b * b).sum(axis=1)[:, None] +
            np.cross(a, b) * (c * c).sum(axis=1)[:, None])
    outer = np.linalg.norm(sums, axis=1) / (12 * volume)
    return {"least": angles.min(), "most": angles.max(), "beta": (3 * inner / outer).mean(), "volume": volume.sum()}


def sheet_area(points, cells, case):
    """Triangles of the file that are no faces of the cube: all faces of sheets, for none lies in a side."""
    if not case.sheets or "triangle" not in cells:
        return 0.0
    t = points[cells["triangle"]]
    on_side = ((np.abs(t - 0) < 1e-9).all(axis=1) | (np.abs(t - 1) < 1e-9).all(axis=1)).any(axis=1)
    t = t[~on_side]
    return np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum() / 2


def line_length(points, cells):
    if "line" not in cells:
        return 0.0
    e = points[cells["line"]]
    inside = ((e > 1e-9) & (e < 1 - 1e-9)).all(axis=(1, 2))
    e = e[inside]
    return np.linalg.norm(e[:, 1] - e[:, 0], axis=1).sum()


def points_found(points, case):
    there = {tuple(p) for p in np.round(points, 12)}
    return sum(tuple(p) in there for p in np.round(np.asarray(case.points), 12)) if len(case.points) else 0


def row(case, name, outcome, file):
    if outcome.error or not file.exists():
        return [case.name, name, outcome.error or "no mesh", *[""] * 5, f"{outcome.cpu_seconds:.1f}", ""]
    found = judged(file, case)
    parts = []
    if case.sheets:
        parts.append(f"area {found['area']:.6g} of {case.area():.6g}")
    if case.lines:
        parts.append(f"length {found['length']:.6g} of {case.length():.6g}")
    if len(case.points):
        parts.append(f"{found['points']} of {len(case.points)} points")
    return [case.name, name, ", ".join(parts), f"{abs(found['volume'] - 1):.0e}", f"{found['tets']:,}", f"{found['beta']:.3f}", f"{found['least']:.1f}",
            f"{found['most']:.1f}", f"{outcome.cpu_seconds:.2f}", f"{found['tets'] / outcome.cpu_seconds / 1e3:.0f} k"]


HEAD = ["case", "mesher", "found", "volume off", "elements", "mean β", "least angle °", "most °", "CPU s", "elements / CPU s"]
ABOUT = """# Sheets, lines and points inside

{written}: a unit cube at size .05, one thread, CPU seconds of whole processes. Gmsh 4.8.4 cuts the cube by OpenCASCADE (`fragment`), meshes with HXT and optimises. *Found*: area of the
faces that are no sides of the cube, length of the edges inside, points that are nodes at their place. TetGen 1.5.0 gets the triangles that Octafront makes of fractures and of the cube, whose making is not in its time, and keeps them (`-pqYa`).
"""


def shown(rows):
    """Rows of cells."""
    return [*tables.some(HEAD, [r for r in rows if r[0] != "5 bars"], [c for c in HEAD if c not in ("volume off", "most °", "elements / CPU s")]), "", f"With volumes, and 5 bars: {tables.put('inside', HEAD, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=300)
    options = parser.parse_args()
    program = (options.program or options.build / "cli" / "octafront").resolve()
    rows = []
    for case in cases():
        if options.only not in case.name:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for mesher, made in (("Octafront", run_ours(case, program, folder, options.timeout)),
                                 ("Gmsh", run_gmsh(case, folder, options.timeout)),
                                 ("TetGen", run_tetgen(case, program, folder, options.timeout))):
                rows.append(row(case, mesher, *made))
                print(tables.row(rows[-1]), flush=True)
    if options.only:
        return
    tables.write("inside", [ABOUT.format(written=written_by("bench/run.sh inside")), *shown(rows)])


if __name__ == "__main__":
    sys.exit(main())
