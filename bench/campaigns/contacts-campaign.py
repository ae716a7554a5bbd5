#!/usr/bin/python3
"""Meshes pairs of generated bodies that touch and were faceted apart, beside the same bodies with matched facets, at three sizes.

  bench/campaigns/contacts-campaign.py [FIRST:END[:STRIDE]] [--page] [--keep FOLDER]
  bench/campaigns/contacts-campaign.py --write NUMBER FOLDER       the bodies of a case as files

Cases 0 to 199 by default, one at a time on one thread. A run is good if it ends with a mesh that has all bodies as regions,
no angle between faces of an element below 10 degrees where matched facets have none, 1.5 times the elements of matched facets
and 3 times their CPU seconds at most, and volumes within what the misfit moves. Where meshio is there, volumes are those of
the file as meshio reads it. One line for each run that is not good; status 1 if there are any; --page writes
docs/measured/contacts.md. Needs a built octafront (build/release, or OCTAFRONT=FILE).
"""
import argparse
import collections
import json
import math
import os
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import written_by

try:
    import meshio
    import numpy
except ImportError:
    meshio = None

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
CASES, SIZES = 200, (("coarse", 0.8), ("medium", 0.4), ("fine", 0.2))
"""Sizes in radii, or half edges."""
LEAST_ANGLE, MOST_ELEMENTS, MOST_TIME, FIXED_SECONDS, LONGEST = 10, 1.5, 3, 0.3, 60
FEW = 200
Surface = collections.namedtuple("Surface", "points triangles")
Case = collections.namedtuple("Case", "family given matched misfit")
Run = collections.namedtuple("Run", "number family size angle elements ratio cpu times faults")


def grid(rows, around, at, closed=True, turn=False):
    """Quads between rows of points, each cut in two."""
    points = [at(k, i) for k in range(rows) for i in range(around)]
    triangles = []
    for k in range(rows - 1):
        for i in range(around if closed else around - 1):
            j = (i + 1) % around
            a, b, c, d = k * around + i, k * around + j, (k + 1) * around + j, (k + 1) * around + i
            triangles += [(a, b, d), (b, c, d)] if turn else [(a, b, c), (a, c, d)]
    return points, triangles


def polar(r, angle, z):
    return r * math.cos(angle), r * math.sin(angle), z


def turned_body(profile, n, turn=0.0, radius=None, other_diagonal=False):
    """A profile of (r, z) from the lower end of the axis to the upper one, turned about it; it begins and ends on the axis."""
    radius = radius or (lambda r, z, angle: r)
    inner = profile[1:-1]
    points, triangles = grid(len(inner), n, lambda k, i: polar(
        radius(inner[k][0], inner[k][1], turn + 2 * math.pi * i / n), turn + 2 * math.pi * i / n, inner[k][1]), turn=other_diagonal)
    low, high = len(points), len(points) + 1
    points += [(0.0, 0.0, profile[0][1]), (0.0, 0.0, profile[-1][1])]
    top = (len(inner) - 1) * n
    for i in range(n):
        j = (i + 1) % n
        triangles += [(low, j, i), (high, top + i, top + j)]
    return Surface(points, triangles)


def ring_body(profile, n, turn=0.0, radius=None, other_diagonal=False):
    """A closed profile of (r, z) around the axis, its material on the left."""
    radius = radius or (lambda r, z, angle: r)
    rows = [*profile, profile[0]]
    points, triangles = grid(len(rows), n, lambda k, i: polar(
        radius(rows[k][0], rows[k][1], turn + 2 * math.pi * i / n), turn + 2 * math.pi * i / n, rows[k][1]), turn=other_diagonal)
    first = (len(rows) - 1) * n
    triangles = [tuple(v - first if v >= first else v for v in t) for t in triangles]
    return Surface(points[:first], triangles)


def box(low, high, tilt=0.0):
    def place(x, y, z):
        x, y, z = (l + (h - l) * f for l, h, f in zip(low, high, (x, y, z)))
        c, s = math.cos(tilt), math.sin(tilt)
        return low[0] + c * (x - low[0]) + s * z, y, -s * (x - low[0]) + c * z
    points = [place(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return Surface(points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def with_cavity(inner, half):
    outer = box((-half,) * 3, (half,) * 3)
    n = len(outer.points)
    return Surface(outer.points + inner.points, outer.triangles + [(n + a, n + c, n + b) for a, b, c in inner.triangles])


def ball(n, m, turn=0.0, other_diagonal=False):
    profile = [(0, -1)] + [(math.sin(math.pi * k / m), -math.cos(math.pi * k / m)) for k in range(1, m)] + [(0, 1)]
    return turned_body(profile, n, turn, other_diagonal=other_diagonal)


def segment(n, inner, outer, low, high, start, end):
    rows = [(inner, low), (outer, low), (outer, high), (inner, high), (inner, low)]
    points, triangles = grid(5, n + 1, lambda k, i: polar(rows[k][0], start + (end - start) * i / n, rows[k][1]), closed=False)
    first = 4 * (n + 1)
    triangles = [tuple(v - first if v >= first else v for v in t) for t in triangles]
    a = [k * (n + 1) for k in range(4)]
    b = [v + n for v in a]
    triangles += [(a[0], a[1], a[2]), (a[0], a[2], a[3]), (b[0], b[2], b[1]), (b[0], b[3], b[2])]
    return Surface(points, triangles)


def sagitta(n):
    return 1 - math.cos(math.pi / n)


def counts(rng, number):
    n = rng.choice((6, 8, 12, 16, 20, 24, 32, 48))
    return (n, n, math.pi / n * rng.uniform(0.2, 1)) if number % 5 == 0 else (n, rng.choice((8, 9, 13, 16, 25, 36, 49)), rng.uniform(0, 1))


def pin(rng, number):
    n, m, turn = counts(rng, number)
    hole = ring_body([(1, 0), (2, 0), (2, 1), (1, 1)], n)
    body = lambda k, t: turned_body([(0, 0), (1, 0), (1, 1), (0, 1)], k, t)
    return [hole, body(m, turn)], [hole, body(n, 0)], sagitta(n) + sagitta(m)


def bolt(rng, number):
    n, m, turn = counts(rng, number)
    hole = ring_body([(1, 0), (2.2, 0), (2.2, 1), (1, 1)], n)
    body = lambda k, t: turned_body([(0, -0.7), (1, -0.7), (1, 1.9), (0, 1.9)], k, t)
    return [hole, body(m, turn)], [hole, body(n, 0)], sagitta(n) + sagitta(m)


def cone(rng, number):
    n, m, turn = counts(rng, number)
    low, high = rng.uniform(0.7, 0.9), rng.uniform(1, 1.2)
    hole = ring_body([(low, 0), (2, 0), (2, 1), (high, 1)], n)
    body = lambda k, t: turned_body([(0, 0), (low, 0), (high, 1), (0, 1)], k, t)
    return [hole, body(m, turn)], [hole, body(n, 0)], 1.2 * (sagitta(n) + sagitta(m))


def sphere(rng, number):
    n, m = rng.choice((8, 12, 16, 24)), rng.choice((9, 12, 15, 20, 30))
    block = with_cavity(ball(n, n // 2), 2)
    return [block, ball(m, max(4, m // 2), rng.uniform(0, 1), True)], [block, ball(n, n // 2)], 2.5 * (sagitta(n) + sagitta(m))


def threads():
    """A hole and a screw of one turn and a half of a round thread, without ends: it fades out; by rows, sides, and a turn."""
    pitch, depth = 0.8, 0.12
    radius = lambda r, z, angle: r if r > 1.5 or r == 0 else 1 + depth * math.sin(math.pi * z / 1.2) ** 2 * math.sin(
        2 * math.pi * z / pitch - angle)
    rows = lambda k: [(1, 1.2 * i / k) for i in range(k + 1)]
    hole = lambda k, n, t: ring_body([(2, 0), (2, 1.2), *reversed(rows(k))], n, t, radius)
    screw = lambda k, n, t, d: turned_body([(0, 0), *rows(k), (0, 1.2)], n, t, radius, d)
    return hole, screw


def thread_counts(rng):
    return rng.choice((16, 24, 32)), rng.choice((18, 25, 36)), rng.choice((12, 18)), rng.choice((14, 21))


def thread(rng, number):
    hole, screw = threads()
    n, m, k, l = thread_counts(rng)
    return [hole(k, n, 0), screw(l, m, 0.1, True)], [hole(k, n, 0), screw(k, n, 0, False)], 0.1


def plane(rng, number):
    off = (1 if number % 2 else -1) * 10 ** rng.uniform(-7, -2)
    inset = 0 if number % 4 < 2 else 0.3
    other = lambda o: box((2 + o, inset, inset), (4 + o, 2 - inset, 2 - inset))
    return [box((0, 0, 0), (2, 2, 2)), other(off)], [box((0, 0, 0), (2, 2, 2)), other(0)], abs(off)


def tilted(rng, number):
    tilt = 10 ** rng.uniform(-6, -2.3)
    inset = 0 if number % 2 else 0.3
    other = lambda t: box((2, inset, 0), (4, 2 - inset, 2 - inset), t)
    return [box((0, 0, 0), (2, 2, 2)), other(tilt)], [box((0, 0, 0), (2, 2, 2)), other(0)], 4 * tilt


def several(rng, number):
    """A pin in a ring of three parts: at their ends three bodies meet in one edge."""
    off = [10 ** rng.uniform(-7, -3) for _ in range(3)]
    sides = [rng.choice((4, 5, 6, 7, 8)) for _ in range(3)]
    third = 2 * math.pi / 3
    parts = lambda n, o: [segment(n[i], 1, 2, o[i], 1 + o[i], i * third + o[i], (i + 1) * third + o[i]) for i in range(3)]
    m = rng.choice((16, 17, 25))
    body = lambda k: turned_body([(0, 0), (1, 0), (1, 1), (0, 1)], k)
    given, matched = [body(m), *parts(sides, off)], [body(18), *parts([6] * 3, [0] * 3)]
    return given, matched, sagitta(m) + sagitta(12) + max(off)


FAMILIES = (pin, bolt, cone, sphere, thread, plane, tilted, several)


def case(number):
    family = FAMILIES[number % len(FAMILIES)]
    rng = random.Random(number)
    given, matched, misfit = family(rng, number // len(FAMILIES))
    scale = (1.0, 1e-3, 1e3)[number // len(FAMILIES) % 3]
    if number // len(FAMILIES) % 2 and family is not several:
        given, matched = given[::-1], matched[::-1]
    if family in (pin, bolt, cone, sphere, thread) and number // len(FAMILIES) % 2:
        matched = [given[0], with_facets_of(family, number, given)]
    sized = lambda bodies: [Surface([tuple(scale * x for x in p) for p in s.points], s.triangles) for s in bodies]
    return Case(family.__name__, sized(given), sized(matched), scale * misfit), scale


def with_facets_of(family, number, given):
    """What fits into the later body's place if the earlier one's facets are given: the second body with these."""
    rng = random.Random(number)
    if family is sphere:
        rng.choice((8, 12, 16, 24)), rng.choice((9, 12, 15, 20, 30)), rng.uniform(0, 1)
        return with_cavity(given[0], 2)
    if family is thread:
        _, m, _, l = thread_counts(rng)
        return threads()[0](l, m, 0.1)
    n, m, turn = counts(rng, number // len(FAMILIES))
    if family is pin:
        return ring_body([(1, 0), (2, 0), (2, 1), (1, 1)], m, turn)
    if family is bolt:
        return ring_body([(1, 0), (2.2, 0), (2.2, 1), (1, 1)], m, turn)
    low, high = rng.uniform(0.7, 0.9), rng.uniform(1, 1.2)
    return ring_body([(low, 0), (2, 0), (2, 1), (high, 1)], m, turn)


def volume(surface):
    p = surface.points
    return sum(p[a][0] * (p[b][1] * p[c][2] - p[b][2] * p[c][1]) + p[a][1] * (p[b][2] * p[c][0] - p[b][0] * p[c][2]) +
               p[a][2] * (p[b][0] * p[c][1] - p[b][1] * p[c][0]) for a, b, c in surface.triangles) / 6


def area(surface):
    total = 0
    for t in surface.triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (surface.points[v] for v in t)
        u, v = (bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az)
        total += math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
    return total


def mesh(bodies, names, size, folder):
    """(status, error output, CPU seconds, report, volumes of regions)"""
    files = []
    for name, body in zip(names, bodies):
        files.append(str(folder / f"{name}.off"))
        write_off(files[-1], *body)
    report, made = folder / "report.json", folder / "made.vtu"
    for old in (report, made):
        old.unlink(missing_ok=True)
    command = [OCTAFRONT, "mesh", *files, "-o", str(made), "--threads", "1", "--json", str(report), "--size", repr(size)]
    confine = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 1))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = subprocess.run(command, capture_output=True, text=True, errors="replace", preexec_fn=confine, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = json.loads(report.read_text()) if report.exists() else {}
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    volumes = read_volumes(made) if ended.returncode == 0 else []
    return ended.returncode, ended.stderr, cpu, told, volumes or [r["volume"] for r in told.get("regions", [])]


def read_volumes(path):
    if meshio is None:
        return []
    read = meshio.read(path)
    volumes = collections.Counter()
    for block, cells in enumerate(read.cells):
        if cells.type != "tetra":
            continue
        p = read.points[cells.data]
        six = numpy.einsum("ij,ij->i", numpy.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0])
        regions = numpy.ravel(read.cell_data["region"][block]) if "region" in read.cell_data else numpy.zeros(len(six), int)
        for r in numpy.unique(regions):
            volumes[int(r)] += float(six[regions == r].sum()) / 6
    return [volumes[r] for r in sorted(volumes)]


def judge(number, folder):
    made, scale = case(number)
    names = [f"body{i}" for i in range(len(made.given))]
    runs = []
    for name, h in SIZES:
        plain = mesh(made.matched, names, h * scale, folder)
        status, error, cpu, report, volumes = mesh(made.given, names, h * scale, folder)
        faults = []
        elements, angle = report.get("tets", 0), report.get("quality", {}).get("dihedral_min_degrees", math.nan)
        ratio = times = math.nan
        if status != 0:
            faults.append(f"status {status}: {(error.strip().splitlines() or [''])[0]}")
        else:
            if plain[0] == 0:
                ratio, times = elements / plain[3]["tets"], cpu / plain[2]
                usual = plain[3]["quality"]["dihedral_min_degrees"]
                if elements > MOST_ELEMENTS * plain[3]["tets"] + FEW:
                    faults.append(f"{elements} elements, {plain[3]['tets']} of matched facets")
                if cpu > MOST_TIME * plain[2] + FIXED_SECONDS:
                    faults.append(f"{cpu:.2f} s, {plain[2]:.2f} s of matched facets")
                if angle < min(LEAST_ANGLE, usual):
                    faults.append(f"least angle {angle:.2f} ({usual:.2f} of matched facets)")
            elif angle < LEAST_ANGLE:
                faults.append(f"least angle {angle:.2f}")
            if len(volumes) != len(made.given):
                faults.append(f"{len(volumes)} regions")
            for body, v, usual in zip(made.given, volumes, plain[4]):
                # Both cut off what coarse elements cut off.
                if abs(v - usual) > 2 * area(body) * made.misfit:
                    faults.append(f"volume {v:.4g}, {usual:.4g} of matched facets")
        runs.append(Run(number, made.family, name, angle, elements, ratio, cpu, times, faults))
    return runs


def table(runs):
    lines = []
    for family in [*(f.__name__ for f in FAMILIES), None]:
        here = [r for r in runs if family in (r.family, None)]
        done = [r for r in here if r.elements > 0]
        beside = [r for r in done if not math.isnan(r.ratio)]
        if not beside:
            continue
        lines.append([family or "all", len(here), sum(not r.faults for r in here), f"{min(r.angle for r in done):.1f}",
                      f"{statistics.median(r.angle for r in done):.1f}", f"{statistics.median(r.ratio for r in beside):.2f}",
                      f"{max(r.ratio for r in beside):.2f}", f"{statistics.median(r.times for r in beside):.2f}", f"{max(r.times for r in beside):.2f}"])
    return tables.table(["bodies", "runs", "good", "least angle, worst", "median", "elements, times those of matched facets: median", "most",
                         "CPU s, times: median", "most"], lines)


def page(runs, cases):
    first = written_by(f"bench/campaigns/contacts-campaign.py {cases} --page")
    words = [
        "# Contacts of bodies that were faceted apart", "", f"{first}: cases {cases}, {len(runs)} runs.", "",
        "Pairs of bodies whose walls are meant to be one and are not: pins, bolts and cones of n sides in holes of m, balls in cavities, "
        "threads, boxes that overlap or gap by 1e-7 to 1e-2 of their size, or are tilted, a pin in a ring of three parts; at scales of "
        "1e-3, 1 and 1e3, in both orders, at three sizes. A run is good if "
        f"all bodies are regions, no dihedral angle is below {LEAST_ANGLE} degrees unless matched facets have one, elements are at most "
        f"{MOST_ELEMENTS} times those of matched facets (and {FEW}), CPU seconds {MOST_TIME} times theirs (and {FIXED_SECONDS}), and "
        "volumes, of the file as meshio reads it, differ by no more than twice the misfit of the facets times the area.", "", *table(runs), ""]
    bad = [r for r in runs if r.faults]
    if bad:
        words += ["What is not good:", "", *(f"- {r.family} {r.number}, {r.size}: {'; '.join(r.faults)}" for r in bad), ""]
    tables.write("contacts", words)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="?", default=f"0:{CASES}")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--write", nargs=2)
    a = parser.parse_args()
    if a.write:
        made, _ = case(int(a.write[0]))
        for kind, bodies in (("given", made.given), ("matched", made.matched)):
            for i, body in enumerate(bodies):
                write_off(pathlib.Path(a.write[1]) / f"{kind}{i}.off", *body)
        return 0
    runs = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(a.keep or temporary)
        for number in range(*(int(n) for n in a.cases.split(":"))):
            for run in judge(number, folder):
                runs.append(run)
                if run.faults:
                    print(f"{run.family} {run.number} {run.size}: {'; '.join(run.faults)}", flush=True)
    print("\n".join(table(runs)))
    if a.page:
        page(runs, a.cases)
    return 1 if any(r.faults for r in runs) else 0


if __name__ == "__main__":
    sys.exit(main())
