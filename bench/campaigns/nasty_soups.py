"""Soups on which repair must end: makes them, runs `octafront repair` and `octafront mesh` on each, says how it went.
See bench/campaigns/nasty-soups.sh. Needs NumPy.
"""
import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.off import write_off
from bench.models import damages
from bench.models import solids
from bench.models.solids import Solid
from bench.process import run_bounded

DONE, REFUSED = 0, 3


def rng(seed=0):
    return np.random.default_rng(seed)


def box(lo, hi):
    unit = solids.voxels([(0, 0, 0)], 1, 1)
    return Solid(np.asarray(lo) + unit.points * (np.asarray(hi, float) - lo), unit.triangles)


def joined(parts):
    return Solid(*solids.together(list(parts)))


def soup(corners):
    """Triangles (m, 3, 3), each by itself."""
    return Solid(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def turned(solid, angle, axis):
    """By an angle in radians about an axis through the origin (Rodrigues)."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    p = solid.points
    return Solid(p * math.cos(angle) + np.cross(axis, p) * math.sin(angle) + np.outer(p @ axis, axis) * (1 - math.cos(angle)),
                 solid.triangles)


# ------------------------------------------------------------------------------------------------------- soups


def weave(n):
    """n x n bars that cross: more than 40 pairs of triangles at each crossing."""
    bars = [box((-1, 2 * k, 0), (2 * n, 2 * k + 1, 1)) for k in range(n)]
    return joined(bars + [box((2 * k, -1, 0.1), (2 * k + 1, 2 * n, 0.9)) for k in range(n)])


def random_triangles(n, size):
    r = rng(n)
    return soup(r.uniform(0, 1, (n, 1, 3)) + size * r.normal(size=(n, 3, 3)))


def scan():
    """1.2 million triangles, thirty holes."""
    s = solids.divided(solids.bumps(), 1_000_000)
    centres, r = s.points[s.triangles].mean(axis=1), rng(1)
    keep = np.ones(len(s.triangles), bool)
    for at in s.points[r.choice(len(s.points), 30)]:
        keep &= np.linalg.norm(centres - at, axis=1) > r.uniform(0.005, 0.12)
    return Solid(s.points, s.triangles[keep])


def doubled(offset):
    s = solids.bumps()
    return joined([s, Solid(s.points * (1 + offset), s.triangles), Solid(s.points + offset, s.triangles[:, ::-1])])


def flat_patches():
    """Boxes of one height: their lids overlap in common planes."""
    r = rng(2)
    corners = r.uniform(0, 10, (300, 2))
    return joined(box((x, y, 0), (x + r.uniform(0.1, 2), y + r.uniform(0.1, 2), 1)) for x, y in np.round(corners, 1))


def near_parallel(step):
    """Sixty boxes, each turned a little against the last."""
    return joined(turned(box((-1, -1, -0.1), (1, 1, 0.1)), k * step, (1, 2, 3)) for k in range(60))


def star(n):
    """Tetrahedra that share one vertex."""
    r = rng(3)
    out = r.normal(size=(n, 3))
    out /= np.linalg.norm(out, axis=1)[:, None]
    tets = [Solid(np.concatenate([[(0, 0, 0)], d + 0.3 / math.sqrt(n) * r.normal(size=(3, 3))]),
                  np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])) for d in out]
    return solids.merged(*solids.together(tets))


def hinge(n):
    """Wedges that share one edge."""
    parts = []
    for k in range(n):
        a, b = (2 * math.pi * (k + s) / n for s in (0, 0.5))
        p = [(0, 0, 0), (0, 0, 1), (math.cos(a), math.sin(a), 0.5), (math.cos(b), math.sin(b), 0.5)]
        parts.append(Solid(np.array(p), np.array([(0, 2, 3), (1, 3, 2), (0, 1, 2), (0, 3, 1)])))
    return solids.merged(*solids.together(parts))


def nested(n):
    return joined(solids.sphere(4, 1 + 0.01 * k) if k % 3 else Solid(solids.sphere(4, 1 + 0.01 * k).points,
                                                                    solids.sphere(4).triangles[:, ::-1]) for k in range(n))


def terrain():
    return Solid(*solids.grid(lambda u, v: (u, v, 0.1 * math.sin(9 * u) * math.cos(7 * v)), 100, 100))


def klein():
    """A Klein bottle: no inside by its faces, and it crosses itself."""
    def at(u, v):
        a, b = 2 * math.pi * (u % 1), 2 * math.pi * v
        w = 2 + math.cos(a / 2) * math.sin(b) - math.sin(a / 2) * math.sin(2 * b)
        return w * math.cos(a), w * math.sin(a), math.sin(a / 2) * math.sin(b) + math.cos(a / 2) * math.sin(2 * b)
    return Solid(*solids.grid(at, 60, 60))


def moebius():
    def at(u, v):
        a, w = 2 * math.pi * u, v - 0.5
        return (1 + w * math.cos(a / 2)) * math.cos(a), (1 + w * math.cos(a / 2)) * math.sin(a), w * math.sin(a / 2)
    return Solid(*solids.grid(at, 60, 6))


def scaled(factor, shift=0.0):
    s = damages.torn(solids.torus(24, 12), rng(4), 1e-4).soup
    return Solid(s.points * factor + shift, s.triangles)


def with_value(value):
    s = solids.sphere(4)
    s.points[5, 1] = value
    return s


def crossing_cubes(count):
    """Cubes about one centre, turned at random: every one crosses every other."""
    r = rng(5)
    return joined(turned(box((-1, -1, -1), (1, 1, 1)), r.uniform(0, 3), r.normal(size=3)) for _ in range(count))


EITHER = (DONE, REFUSED)
SOUPS = {  # name: what makes it, statuses of repair that are right, whether it is large
    "weave 90 x 90": (lambda: weave(90), (DONE,), True),
    "random 1,000": (lambda: random_triangles(1000, 0.1), EITHER, False),
    "random 1,000, large": (lambda: random_triangles(1000, 0.4), EITHER, True),
    "random 10,000": (lambda: random_triangles(10_000, 0.05), EITHER, True),
    "random 50,000": (lambda: random_triangles(50_000, 0.03), EITHER, True),
    "scan of 1.2 million": (scan, (DONE,), True),
    "40 cubes about a point": (lambda: crossing_cubes(40), (DONE,), False),
    "doubled, 1e-4 off": (lambda: doubled(1e-4), (DONE,), True),
    "doubled, 1e-7 off": (lambda: doubled(1e-7), (DONE,), True),
    "doubled, 1e-10 off": (lambda: doubled(1e-10), (DONE,), False),
    "doubled, 1e-15 off": (lambda: doubled(1e-15), (DONE,), False),
    "coplanar patches": (flat_patches, (DONE,), False),
    "near parallel, 1e-3": (lambda: near_parallel(1e-3), (DONE,), False),
    "near parallel, 1e-8": (lambda: near_parallel(1e-8), (DONE,), False),
    "near parallel, 1e-14": (lambda: near_parallel(1e-14), (DONE,), False),
    "torn torus": (lambda: scaled(1), (DONE,), False),
    "torn torus times 1e-40": (lambda: scaled(1e-40), EITHER, False),
    "torn torus times 1e40": (lambda: scaled(1e40), EITHER, False),
    "torn torus times 1e200": (lambda: scaled(1e200), (REFUSED,), False),
    "torn torus times 1e-320": (lambda: scaled(1e-320), (REFUSED,), False),
    "torn torus at 1e12": (lambda: scaled(1, 1e12), EITHER, False),
    "large and small": (lambda: joined([scaled(1), scaled(1e-9, 3)]), (DONE,), False),
    "NaN": (lambda: with_value(math.nan), (REFUSED,), False),
    "infinite": (lambda: with_value(math.inf), (REFUSED,), False),
    "one point far away": (lambda: with_value(1e15), EITHER, False),
    "index out of range": (lambda: Solid(np.zeros((3, 3)), np.array([(0, 1, 7)])), (REFUSED,), False),
    "nothing": (lambda: Solid(np.zeros((0, 3)), np.zeros((0, 3), int)), (REFUSED,), False),
    "one triangle": (lambda: Solid(np.eye(3), np.array([(0, 1, 2)])), (REFUSED,), False),
    "triangle from both sides": (lambda: Solid(np.eye(3), np.array([(0, 1, 2), (0, 2, 1)])), (REFUSED,), False),
    "all points equal": (lambda: soup(np.ones((1000, 3, 3))), (REFUSED,), False),
    "all on a line": (lambda: soup(rng(6).uniform(size=(1000, 3, 1)) * np.ones(3)), (REFUSED,), False),
    "all in a plane": (lambda: soup(rng(7).uniform(size=(1000, 3, 3)) * (1, 1, 0)), (REFUSED,), False),
    "box a hundred times": (lambda: joined([solids.voxels([(0, 0, 0)], 1, 4)] * 100), (DONE,), False),
    "5,000 tetrahedra at a point": (lambda: star(5000), EITHER, False),
    "500 wedges at an edge": (lambda: hinge(500), (DONE,), False),
    "200 nested shells": (lambda: nested(200), (DONE,), False),
    "terrain": (terrain, (REFUSED,), False),
    "Moebius strip": (moebius, (REFUSED,), False),
    "Klein bottle": (klein, EITHER, False)}


# -------------------------------------------------------------------------------------------------------- runs


def wrong(program, status, right, output, message):
    """What is wrong with a run, or ""."""
    if status is None:
        return "no end"
    if status not in right:
        return f"status {status}"
    if status != DONE:
        return "half a file" if output.exists() else "no reason" if len(message) < 20 else ""
    if not output.exists():
        return "no file"
    checked = subprocess.run([program, "check", output], capture_output=True, text=True)
    return "" if checked.returncode == DONE else f"what it wrote is not clean: {(checked.stderr + checked.stdout).strip()[:120]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--only", default="", help="soups whose name contains this")
    parser.add_argument("--small", action="store_true", help="without the large ones")
    parser.add_argument("--timeout", type=int, default=600, help="processor seconds for each run")
    parser.add_argument("--no-mesh", action="store_true", help="repair only")
    parser.add_argument("--keep", type=pathlib.Path, help="where the soups stay")
    a = parser.parse_args()
    failures = 0
    print("| soup | triangles | command | status | CPU s | MB | said |\n| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for name, (make, right, large) in SOUPS.items():
        if a.only not in name or (a.small and large):
            continue
        with tempfile.TemporaryDirectory() as folder:
            made = make()
            file = pathlib.Path(a.keep or folder, "".join(c if c.isalnum() else "-" for c in name) + ".off")
            file.parent.mkdir(parents=True, exist_ok=True)
            write_off(file, *made)
            for step, out, options in (("repair", "out.off", []), ("mesh", "out.vtu", ["--elements", "20000"])):
                if step == "mesh" and a.no_mesh:
                    continue
                output = pathlib.Path(folder, out)
                status, message, seconds, megabytes = run_bounded([a.program, step, file, "-o", output, "-q", *options], a.timeout)
                message = message.split("\n")[0][:160]
                bad = wrong(a.program, status, right, output, message)
                failures += bool(bad)
                print(f"| {name} | {len(made.triangles):,} | {step} | {'**' + bad + '**' if bad else status} | {seconds:.2f} | "
                      f"{megabytes:.0f} | {message.replace('octafront: ', '').replace(str(file), 'it').replace('|', '/')} |", flush=True)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
