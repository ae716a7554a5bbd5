"""Bodies that move in fifty steps, each from the mesh that the step before left: a bar bent and twisted, a punch pressed into a
block, balls that grow until they meet, a ball that goes around in a box, a free surface that sloshes; and a block of foam
pressed with FEniCSx (examples/solve/fenicsx_press.py). Beside them mmg3d -lag 1 and -ls, where MMG3D is its program. Elements,
quality, volumes and integrals after each step. Writes docs/measured/motion.md.

Usage: bench/run.sh motion [--quick]
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

from bench.pages import tables
from bench.pages.origin import ROOT, written_by
from bench.process import run_measured
from bench.run.move import Boxes, bent, twisted

HEAD = ["case", "by", "steps", "of", "elements", "elements at the end", "least β of all steps", "least β", "mean β", "greatest error of the volume %", "integrals off by", "CPU s", "how it ended"]
ROWS = ["case", "by", "step", "elements", "least β", "mean β", "volume", "volume wanted", "CPU s"]


def points_of(vtk):
    """Of a mesh that was written in ASCII."""
    words = vtk.read_text().split("POINTS ")[1].split()
    return numpy.array(words[2:2 + 3 * int(words[0])], float).reshape(-1, 3)


def with_ways(vtk, ways, out):
    text = vtk.read_text().partition("POINT_DATA")[0]
    rows = "\n".join("%r %r %r" % tuple(map(float, w)) for w in ways)
    out.write_text(f"{text}POINT_DATA {len(ways)}\nFIELD f 1\nu 3 {len(ways)} double\n{rows}\n")
    return out


class Medit:
    """A mesh in a .mesh file, for mmg3d."""

    def __init__(self, file):
        self.file, words = file, file.read_text().split()
        at = words.index("Vertices")
        self.points = numpy.array(words[at + 2:at + 2 + 4 * int(words[at + 1])], float).reshape(-1, 4)[:, :3]

    def volume_of(self, reference):
        words = self.file.read_text().split()
        at = words.index("Tetrahedra")
        tets = numpy.array(words[at + 2:at + 2 + 5 * int(words[at + 1])], int).reshape(-1, 5)
        a, b, c, d = (self.points[tets[tets[:, 4] == reference, i] - 1] for i in range(4))
        return float(abs(numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum()) / 6)

    def all_walls_move(self):
        """mmg3d moves what has the reference 10."""
        lines, left = [], 0
        for line in self.file.read_text().splitlines():
            words = line.split()
            if left > 0 and len(words) == 4:
                line, left = " ".join([*words[:3], "10"]), left - 1
            elif lines and lines[-1].strip() == "Triangles" and len(words) == 1:
                left = int(words[0])
            lines.append(line)
        self.file.write_text("\n".join(lines) + "\n")

    def solution(self, values, kind):
        file = self.file.with_suffix(".sol")
        rows = "\n".join(" ".join("%r" % float(x) for x in numpy.atleast_1d(v)) for v in values)
        file.write_text(f"MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n{len(values)}\n1 {kind}\n{rows}\nEnd\n")
        return file


class Steps:
    """What a case came to, step by step."""

    def __init__(self, case, by, rows):
        self.case, self.by, self.rows, self.all = case, by, rows, []
        self.integrals, self.ended = 0.0, "done"

    def add(self, elements, least, mean, volume, wanted, seconds):
        self.all.append((elements, least, mean, volume, wanted, seconds))
        self.rows.append([self.case, self.by, len(self.all), f"{elements:,}", f"{least:.3f}", f"{mean:.3f}", f"{volume:.6f}", f"{wanted:.6f}", f"{seconds:.2f}"])

    def summary(self, steps, first):
        last = self.all[-1] if self.all else (0, 0, 0, 0, 1, 0)
        off = max((abs(s[3] / s[4] - 1) for s in self.all), default=0)
        made = [self.case, self.by, len(self.all), steps, f"{first:,}", f"{last[0]:,}", f"{min((s[1] for s in self.all), default=0):.3f}", f"{last[1]:.3f}", f"{last[2]:.3f}",
                f"{100 * off:.3f}", f"{self.integrals:.1e}" if self.by == "octafront" else "-", f"{sum(s[5] for s in self.all):.1f}", self.ended]
        print(tables.row(made), flush=True)
        return made


def moved(runs, case, start, motion, steps, rows, options=()):
    """`motion(points, i)`: where points of step i - 1 are at step i; and the volume then."""
    made, now = Steps(case, "octafront", rows), start
    before = runs.run("info", start)[0]
    for i in range(1, steps + 1):
        points = points_of(now)
        places, volume = motion(points, i)
        after = runs.folder / f"step{i % 2}.vtk"
        try:
            report, done = runs.run("move", with_ways(now, places - points, runs.folder / "moving.vtk"), "--displacement", "u", "-o", after, "--ascii", *options)
        except SystemExit as refused:
            made.ended = "refused at step %d: %s" % (i, str(refused).split("octafront: ")[-1].splitlines()[0])
            break
        last = report["history"][-1]
        made.add(last["elements"], min(s["beta_min"] for s in report["history"]), last["beta_mean"], last["volume"], volume, done.cpu_seconds)
        mass = [f for f in report["carried"] if f["of"] == "elements" and f["name"] == "m"]
        if i == 1:
            mean = mass[0]["before"]["integral"][0] / before["volume"]
        made.integrals = max(made.integrals, abs(mass[0]["after"]["integral"][0] / last["volume"] / mean - 1))
        now = after
    runs.run("check", now)
    return made.summary(steps, before["tets"])


def moved_by_mmg(runs, mmg, case, start, motion, steps, rows):
    """The same by mmg3d -lag 1: with 2 it divides without end."""
    made, file = Steps(case, "mmg3d -lag 1", rows), runs.folder / "mmg.mesh"
    runs.run("convert", start, "-o", file)
    first, now = runs.run("info", file)[0]["tets"], Medit(file)
    now.all_walls_move()
    for i in range(1, steps + 1):
        places, volume = motion(now.points, i)
        sol = now.solution(places - now.points, 2)
        out = runs.folder / f"mmg{i % 2}.mesh"
        out.unlink(missing_ok=True)
        done = run_measured([mmg, "-v", "0", "-lag", "1", "-in", now.file, "-sol", sol, "-out", out], ".", 60)
        if done.error or not out.exists():
            made.ended = f"ended at step {i}: {(done.error or 'no mesh').splitlines()[0][:60]}"
            break
        try:
            found = runs.run("check", out)[0]
        except SystemExit:
            made.ended = f"not valid at step {i}"
            break
        made.add(found["tets"], found["quality"]["beta_min"], found["quality"]["beta_mean"], runs.run("info", out)[0]["volume"], volume, done.cpu_seconds)
        now = Medit(out)
    return made.summary(steps, first)


def chain(map_of, back, steps, volume):
    """From the place in step i - 1 back to where it was at first, and on to step i. `map_of(i / steps)(x, y, z)`."""
    def motion(points, i):
        at_first = points if i == 1 else numpy.array([back((i - 1) / steps, *p) for p in points])
        place = map_of(i / steps)
        return numpy.array([place(*p) for p in at_first]), volume
    return motion


def bent_back(length):
    def back(part, x, y, z):
        radius = length / (math.pi * part)
        return radius * math.atan2(x, radius + .5 - y), radius + .5 - math.hypot(x, radius + .5 - y), z
    return back


def twisted_back(length):
    def back(part, x, y, z):
        a = -2 * math.pi * part * x / length
        c, s = math.cos(a), math.sin(a)
        return x, .5 + c * (y - .5) - s * (z - .5), .5 + s * (y - .5) + c * (z - .5)
    return back


def punch(steps):
    """Goes half way down into the unit cube; around it the top follows smoothly. What is inside has no say."""
    def motion(points, i):
        x, y, z = points.T
        r = numpy.hypot(x - .5, y - .5)
        depth = numpy.where(r < .2, 1, numpy.where(r > .45, 0, .5 * (1 + numpy.cos(math.pi * (r - .2) / .25))))
        way = numpy.zeros_like(points)
        way[:, 2] = numpy.where(z > .2, -.5 / steps * depth, 0)
        # The bump's volume: 2 pi times the integral of r depth.
        fall = .2**2 / 2 + sum((.2 + .25 * (k + .5) / 1000) * .5 * (1 + math.cos(math.pi * (k + .5) / 1000)) * .25 / 1000 for k in range(1000))
        return points + way, 1 - .5 * i / steps * 2 * math.pi * fall
    return motion


def ball(centre, radius, levels=3):
    """An icosphere's points and triangles."""
    g = (1 + 5**.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middle = {}

        def of(a, b):
            key = min(a, b), max(a, b)
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((u + v) / 2 for u, v in zip(points[a], points[b])))
            return middle[key]
        faces = [t for a, b, c in faces for t in ((a, of(a, b), of(c, a)), (b, of(b, c), of(a, b)), (c, of(c, a), of(b, c)), (of(a, b), of(b, c), of(c, a)))]
    return [tuple(o + radius * x / math.hypot(*p) for o, x in zip(centre, p)) for p in points], faces


def two_balls(runs, size):
    """Of radius .3, their middles 1 apart: they meet when they have grown by two thirds."""
    surface, mesh = runs.folder / "balls.off", runs.folder / "balls.vtk"
    (first, faces), (second, _) = ball((0, 0, 0), .3), ball((1, 0, 0), .3)
    triangles = faces + [tuple(len(first) + v for v in t) for t in faces]
    surface.write_text(f"OFF\n{2 * len(first)} {len(triangles)} 0\n" + "".join("%r %r %r\n" % p for p in first + second) + "".join("3 %d %d %d\n" % t for t in triangles))
    runs.run("mesh", surface, "-o", mesh, "--ascii", "--size", size, "--field", "m=1+x")
    return mesh


def growing(steps, volume):
    """To twice the radius."""
    def motion(points, i):
        before, after = 1 + (i - 1) / steps, 1 + i / steps
        centre = numpy.where(points[:, :1] > .5, numpy.array([[1., 0, 0]]), numpy.zeros((1, 3)))
        return centre + (points - centre) * (after / before), volume * after**3
    return motion


def cut_by_fields(runs, mmg, case, mesh, field, volume, size, steps, rows):
    """Level sets on one mesh: `field(i)` is a formula, `value(points)` the same by numpy."""
    made, theirs = Steps(case, "octafront", rows), Steps(case, "mmg3d -ls", rows)
    first = runs.run("info", mesh)[0]["tets"]
    file = runs.folder / "cut.mesh"
    runs.run("convert", mesh, "-o", file)
    medit = Medit(file)
    for i in range(1, steps + 1):
        formula, value = field(i)
        with_field = runs.folder / "field.vtu"
        runs.run("convert", mesh, "-o", with_field, "--field", f"body={formula}", "--field", "m=1+x")
        report, cut_done = runs.run("adapt", with_field, "--level-set", "body", "-o", runs.folder / "cut.vtu")
        runs.run("check", runs.folder / "cut.vtu")
        region = next(r for r in report["regions"] if r["name"] == "body")
        made.add(report["tets"], report["quality"]["beta_min"], report["quality"]["beta_mean"], region["volume"], volume(i), cut_done.cpu_seconds)
        made.integrals = max([made.integrals, *(f["integral_error"] for f in report["carried"] if f["of"] == "elements")])
        if mmg and theirs.ended == "done":
            out = runs.folder / "cut_mmg.mesh"
            out.unlink(missing_ok=True)
            done = run_measured([mmg, "-v", "0", "-ls", "0", "-hsiz", str(size), "-in", file, "-sol", medit.solution(value(*medit.points.T), 1), "-out", out], ".", 60)
            try:
                found = runs.run("check", out)[0] if out.exists() else None
            except SystemExit:
                found, done.error = None, "not valid"
            if found is None:
                theirs.ended = f"step {i}: {(done.error or 'no mesh')[:80]}"
            else:
                theirs.add(found["tets"], found["quality"]["beta_min"], found["quality"]["beta_mean"], Medit(out).volume_of(3), volume(i), done.cpu_seconds)
    return [made.summary(steps, first)] + ([theirs.summary(steps, first)] if mmg else [])


def around(steps):
    def field(i):
        a = 2 * math.pi * i / steps
        x, y = .5 + .25 * math.cos(a), .5 + .25 * math.sin(a)
        return f"sqrt((x-{x!r})^2+(y-{y!r})^2+(z-.5)^2)-.2", lambda px, py, pz: numpy.sqrt((px - x)**2 + (py - y)**2 + (pz - .5)**2) - .2
    return field


def sloshing(steps):
    def field(i):
        h = .15 * math.cos(4 * math.pi * i / steps)
        return f"z-.45-{h!r}*cos(pi*x)", lambda px, py, pz: pz - .45 - h * numpy.cos(math.pi * px)
    return field


def merging(steps):
    """Two balls that grow into one."""
    def field(i):
        r = .12 + .12 * i / steps
        one, two = f"sqrt((x-.3)^2+(y-.5)^2+(z-.5)^2)-{r!r}", f"sqrt((x-.7)^2+(y-.5)^2+(z-.5)^2)-{r!r}"
        return f"min({one},{two})", lambda px, py, pz: numpy.minimum(*(numpy.sqrt((px - c)**2 + (py - .5)**2 + (pz - .5)**2) - r for c in (.3, .7)))
    return field


def merged_volume(steps):
    def volume(i):
        r, d = .12 + .12 * i / steps, .4
        two = 2 * 4 / 3 * math.pi * r**3
        return two - (math.pi * (4 * r + d) * (2 * r - d)**2 / 12 if 2 * r > d else 0)
    return volume


def cases(runs, mmg, quick, rows):
    steps, fine = (5, 2) if quick else (50, 1)
    field = ("--field", "m=1+x")
    for case, place, back, of in (("bar bent by 180°", lambda part: bent(.5 * part, 8), bent_back(8), .15), ("bar twisted by 360°", lambda part: twisted(part, 8), twisted_back(8), .15)):
        start = runs.box("bar", of * fine, 8, *field)
        yield moved(runs, case, start, chain(place, back, steps, 8), steps, rows)
        if mmg:
            yield moved_by_mmg(runs, mmg, case, start, chain(place, back, steps, 8), steps, rows)
    start = runs.box("block", .08 * fine, 1, *field)
    yield moved(runs, "punch into a block, to half", start, punch(steps), steps, rows, ["--boundary-alone"])
    if mmg:
        yield moved_by_mmg(runs, mmg, "punch into a block, to half", start, punch(steps), steps, rows)
    balls = two_balls(runs, .08 * fine)
    volume = runs.run("info", balls)[0]["volume"]
    yield moved(runs, "balls that grow and meet", balls, growing(steps, volume), steps, rows)
    if mmg:
        yield moved_by_mmg(runs, mmg, "balls that grow and meet", balls, growing(steps, volume), steps, rows)
    box, size = runs.box("cube", .05 * fine, 1), .05 * fine
    yield from cut_by_fields(runs, mmg, "balls that grow into one, by level set", box, merging(steps), merged_volume(steps), size, steps, rows)
    yield from cut_by_fields(runs, mmg, "ball around in a box, by level set", box, around(steps), lambda i: 4 / 3 * math.pi * .008, size, steps, rows)
    yield from cut_by_fields(runs, mmg, "free surface that sloshes, by level set", box, sloshing(steps), lambda i: .45, size, steps, rows)


def press(build):
    """Rows of the heights that both solved."""
    if subprocess.run(["/usr/bin/python3", "-c", "import dolfinx"], stderr=subprocess.DEVNULL).returncode:
        return None
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "OCTAFRONT_BIN": str(build / "python/octafront/_bin"), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(["/usr/bin/python3", ROOT / "examples/solve/fenicsx_press.py", "--compare", "--json"], env=environment, stdout=subprocess.PIPE, text=True, check=True)
    found = json.loads(done.stdout.strip().splitlines()[-1])
    fine = {round(r[0], 6): r for r in found["lagrangian"]}
    made = []
    for height, force, elements, quality in found["moved"]:
        beside = fine.get(round(height, 6))
        made.append([f"{height:.3f}", f"{elements:,}", f"{quality:.3f}", f"{force:.4f}", *([f"{beside[2]:,}", f"{beside[3]:.3f}", f"{beside[1]:.4f}", f"{100 * (force / beside[1] - 1):.2f}"] if beside else ["-"] * 4)])
    return made


NOT_SHOWN = ("bar twisted", "free surface")  # on the page, which has no room for them
PRESS = ["height", "elements", "least β", "force", "fine: elements", "fine: least β", "fine: force", "difference %"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="five steps, coarse, to try; no page")
    a = parser.parse_args()
    mmg, rows = os.environ.get("MMG3D"), []
    with tempfile.TemporaryDirectory() as folder:
        table = list(cases(Boxes(a.build, folder), mmg, a.quick, rows))
    if a.quick:
        return
    pressed = press(a.build.resolve())
    head = f"""{written_by('bench/run.sh motion')}, one thread. *Least β of all steps* counts what was on the way inside of a step, too; *integrals off by*: of moved bodies the mean of a field of elements, of level sets the integrals over
the old regions. CPU seconds are those of all commands, while others used the machine. mmg3d is release 5.8.0 with the elasticity library, `-lag 1` of all walls (with 2, which divides edges, it made a million elements of 3,035 in four steps), `-ls 0 -hsiz` of the mesh's size."""
    lines = ["# Bodies in fifty steps", "", head, "", *tables.some(HEAD, [r for r in table if not r[0].startswith(NOT_SHOWN)], [c for c in HEAD if c not in ("of", "how it ended", "integrals off by")]), "", f"Each step: {tables.put('motion', ROWS, rows)}. Two cases more, how each ended, and integrals: {tables.put('motion-cases', HEAD, table)}."]
    if pressed:
        some = pressed[3::4]
        lines += ["", "## A block of foam, with FEniCSx", "", "`examples/solve/fenicsx_press.py --compare`: a mesh that moves with the body beside a fine Lagrangian one, which ends where it can be solved on no more.", "", *tables.table(PRESS, some), "",
                  f"All: {tables.put('motion-press', PRESS, pressed)}."]
    tables.write("motion", lines)


if __name__ == "__main__":
    sys.exit(main())
