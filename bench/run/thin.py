"""Plates, discs, tubes and shells from 1:10 to 1:1e6: volume, elements, angles, time; beside another build, Gmsh, TetGen.

Usage: bench/run.sh thin [--before PROGRAM] [--timeout SECONDS] [--page]
Every mesh is written to a file, and octafront_evaluate judges the file. CPU seconds of the whole process, one thread.
--before: another build of octafront, whose meshes are judged too. --page rewrites docs/measured/thin-bodies.md; without --before its rows
of another build stay as they are.
"""
import argparse
import math
import pathlib
import tempfile

from bench.off import write_off
from bench.ours import evaluated, mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import gmsh, tetgen

THICKNESS = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
HEAD = ["body", "thickness", "mesher", "volume, %", "elements", "least angle", "most angle", "CPU s"]
BEFORE = "before"
SHOWN = ("0.1", "0.001", "1e-06")  # thicknesses whose volumes the page shows
SIZE = 0.05  # of those that are asked for a size: bodies are 1 to 2 across


def turned(points):
    """No round coordinates: real parts have none."""
    c, s = math.cos(0.7), math.sin(0.7)
    return [(c * x - s * y, 0.6 * (s * x + c * y) - 0.8 * z, 0.8 * (s * x + c * y) + 0.6 * z) for x, y, z in points]


def quad(p, q, r, s):
    return [(p, q, r), (p, r, s)]


def plate(t):
    points = [(x, y, z) for z in (0, t) for y in (0, 1) for x in (0, 1)]
    return points, (quad(0, 2, 3, 1) + quad(4, 5, 7, 6) + quad(0, 1, 5, 4) + quad(1, 3, 7, 5) + quad(3, 2, 6, 7) +
                    quad(2, 0, 4, 6))


def ring(n, radius, z):
    return [(radius * math.cos(2 * math.pi * i / n), radius * math.sin(2 * math.pi * i / n), z) for i in range(n)]


def disc(t, n=48):
    points = [(0, 0, 0), (0, 0, t)] + ring(n, 1, 0) + ring(n, 1, t)
    triangles = []
    for i in range(n):
        a, b = 2 + i, 2 + (i + 1) % n
        triangles += [(0, b, a), (1, a + n, b + n)] + quad(a, b, b + n, a + n)
    return points, triangles


def tube(t, n=48, rows=8):
    points, triangles = [], []
    for radius in (1, 1 - t):
        for j in range(rows + 1):
            points += ring(n, radius, 2 * j / rows)
    at = lambda inner, j, i: (inner * (rows + 1) + j) * n + i % n
    for i in range(n):
        for j in range(rows):
            triangles += quad(at(0, j, i), at(0, j, i + 1), at(0, j + 1, i + 1), at(0, j + 1, i))
            triangles += quad(at(1, j, i), at(1, j + 1, i), at(1, j + 1, i + 1), at(1, j, i + 1))
        triangles += quad(at(0, 0, i), at(1, 0, i), at(1, 0, i + 1), at(0, 0, i + 1))
        triangles += quad(at(0, rows, i), at(0, rows, i + 1), at(1, rows, i + 1), at(1, rows, i))
    return points, triangles


def sphere(levels):
    g = (1 + 5**0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
              (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                 (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                 (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middle, finer = {}, []
        def half(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((points[a][k] + points[b][k]) / 2 for k in range(3)))
            return middle[key]
        for a, b, c in triangles:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return [tuple(x / math.dist(p, (0, 0, 0)) for x in p) for p in points], triangles


def shell(t):
    points, triangles = sphere(4)
    n = len(points)
    return points + [tuple(x * (1 - t) for x in p) for p in points], triangles + [(a + n, c + n, b + n) for a, b, c in triangles]


def octafront(program, *options):
    return lambda surface, folder, timeout: mesh(program, surface, folder, timeout, *options, out="out.mesh")


def judged(build, run, surface, timeout):
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(surface, folder, timeout)
        if outcome.mesh is None:
            return f"no mesh: {outcome.error[:60]}", "", "", "", f"{outcome.cpu_seconds:.1f}"
        j, why = evaluated(build, outcome.mesh, surface)
        if why:
            return "not readable", "", "", "", f"{outcome.cpu_seconds:.1f}"
        volume = f"{j['volume_percent']:+.3f}" + (" **not valid**" if j["defect"] else "")
        return volume, f"{j['tets']:,}", f"{j['dihedral_min']:.3g}", f"{j['dihedral_max']:.5g}", f"{outcome.cpu_seconds:.1f}"


def shown(rows):
    """Rows of cells: volumes side by side, the spread of the rest."""
    link = tables.put("thin-bodies", HEAD, rows)
    rows = [r for r in rows if r[2] != BEFORE]
    meshers = list(dict.fromkeys(r[2] for r in rows))
    bodies = list(dict.fromkeys((r[0], r[1]) for r in rows if r[1] in SHOWN and r[0] != "disc"))
    volume = {(r[0], r[1], r[2]): r[3] if tables.number(r[3]) is not None else "-" for r in rows}
    return ["Volume against the input's, in percent (-: no mesh, or one that is not valid):", "",
            *tables.table([*HEAD[:2], *meshers], [[*body, *(volume.get((*body, m), "") for m in meshers)] for body in bodies]), "",
            *tables.spread_by("mesher", HEAD, rows, HEAD[4:]), "", f"Median, least and most. Each: {link}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--before", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=60)
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    program = (a.build / "cli/octafront").resolve()
    runs = {}
    if a.before:
        runs[BEFORE] = octafront(a.before.resolve())
    runs |= {"automatic": octafront(program), f"`--size {SIZE}`": octafront(program, "--size", str(SIZE)),
             "Gmsh HXT": lambda s, f, t: gmsh.remesh(s, f, t, SIZE, gmsh.HXT), "TetGen -pYq": tetgen.fill}
    kept = [] if a.before or not a.page else [r for r in tables.rows_of("thin-bodies") if r[2] == BEFORE]
    rows = []
    for make in (plate, disc, tube, shell):
        for t in THICKNESS:
            with tempfile.TemporaryDirectory() as folder:
                surface = pathlib.Path(folder, "body.off")
                points, triangles = make(t)
                write_off(surface, turned(points), triangles)
                rows += [r for r in kept if r[:2] == [make.__name__, f"{t:g}"]]
                for name, run in runs.items():
                    rows.append([make.__name__, f"{t:g}", name, *judged(a.build, run, surface, a.timeout)])
                    print(tables.row(rows[-1]), flush=True)
    if a.page:
        tables.write("thin-bodies", [
            "# Thin bodies", "", f"{written_by('bench/run.sh thin --page')}, one thread.", "",
            "Plates of 1 x 1, discs of radius 1 (48 corners), tubes of radius 1 and height 2 (48 corners), shells of spheres of radius 1 (10,240 triangles), turned by some angles. Gmsh: surface anew at size "
            f"{SIZE}; TetGen keeps the input's triangles, and fills the cavities of shells, as no hole is marked. At most {a.timeout:.0f} s.", "", *shown(rows)])


if __name__ == "__main__":
    main()
