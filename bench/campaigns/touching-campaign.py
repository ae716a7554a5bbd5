#!/usr/bin/python3
"""Meshes random sets of voxels, with cavities and contacts in edges and vertices of all kinds; writes docs/measured/touching.md.

  bench/campaigns/touching-campaign.py [FIRST:END] [--page] [--keep FOLDER]      0:500 by default; about 5 CPU minutes

Each pattern of 6^3 voxels, of a density from 15 to 95 %, is turned, scaled (1e-3 to 1e6), its triangles facing outward, inward or
any way, and meshed in the ways of WAYS in turn; `check` counts its cavities, `repair` draws apart what touches. All must end with a
valid mesh of the exact volume (LOST; repair moves vertices: MOVED), and the cavities that a search of the grid counts. One line for each
that does not; status 1 if there are any. Needs a built octafront (build/release, or OCTAFRONT=FILE), and meshio, which measures.
"""
import argparse
import collections
import itertools
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import meshio
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import written_by

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
N = 6
DENSITIES = (.15, .3, .5, .6, .7, .8, .9, .95)
SCALES = (1, 1e-3, 1e6, .37)
FACING = ("outward", "inward", "any way")
WAYS = {"automatic": [], "size .9": ["--size", .9], "size .45": ["--size", .45], "kept": ["--keep-surface"],
        "merged": ["--cells", "merge", "--keep-surface"], "regions": ["--cells", "regions", "--size", 1]}
"""Options of `mesh`; sizes in voxels."""
LOST, MOVED = 1e-9, 5e-3
Run = collections.namedtuple("Run", "seed way off elements least seconds fault")


def pattern(seed):
    chance = random.Random(seed)
    density = DENSITIES[seed % len(DENSITIES)]
    return {c for c in itertools.product(range(N), repeat=3) if chance.random() < density} | {(0, 0, 0)}


def neighbours(cell):
    for axis, step in itertools.product(range(3), (-1, 1)):
        yield axis, step, tuple(x + step * (k == axis) for k, x in enumerate(cell))


def spaces(cells):
    """Cells that hang together over faces."""
    left, found = set(cells), []
    while left:
        stack = [left.pop()]
        space = set(stack)
        while stack:
            for _, _, other in neighbours(stack.pop()):
                if other in left:
                    left.remove(other)
                    space.add(other)
                    stack.append(other)
        found.append(space)
    return found


def cavities(full):
    around = set(itertools.product(range(-1, N + 1), repeat=3)) - full
    return sum((-1, -1, -1) not in space for space in spaces(around))


def boundary(full, chance):
    """Points on the grid, and triangles that face outward."""
    points, triangles = {}, []
    for cell in sorted(full):
        for axis, step, other in neighbours(cell):
            if other in full:
                continue
            square = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = list(cell)
                corner[axis] += step > 0
                corner[(axis + 1) % 3] += u
                corner[(axis + 2) % 3] += v
                square.append(points.setdefault(tuple(corner), len(points)))
            if step < 0:
                square.reverse()
            if chance.random() < .5:
                square = square[1:] + square[:1]
            triangles += [(square[0], square[1], square[2]), (square[0], square[2], square[3])]
    return numpy.array(list(points), float), triangles


def facing(triangles, way, chance):
    return [(a, c, b) if way == "inward" or (way == "any way" and chance.random() < .5) else (a, b, c) for a, b, c in triangles]


def turned(points, seed, scale):
    """About two axes; every third pattern stays on its grid."""
    if seed % 3:
        for axis, angle in ((0, .3 * seed), (2, .7 * seed)):
            c, s, u, v = math.cos(angle), math.sin(angle), (axis + 1) % 3, (axis + 2) % 3
            turn = numpy.eye(3)
            turn[u, u], turn[u, v], turn[v, u], turn[v, v] = c, -s, s, c
            points = points @ turn
    return points * scale


def octafront(folder, *arguments):
    """(status, error output, report)"""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    done = subprocess.run([OCTAFRONT, *map(str, arguments), "--json", report], capture_output=True, text=True, timeout=300,
                          check=False)
    return done.returncode, done.stderr, json.loads(report.read_text()) if report.exists() else {}


def volume_of_mesh(path):
    mesh = meshio.read(path)
    p = mesh.points[mesh.cells_dict["tetra"]]
    six = numpy.einsum("ij,ij->i", p[:, 1] - p[:, 0], numpy.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 0]))
    return six.sum() / 6 if (six > 0).all() else math.nan


def volume_of_surface(path):
    mesh = meshio.read(path)
    p = mesh.points[mesh.cells_dict["triangle"]]
    p = p - mesh.points.mean(axis=0)
    return numpy.einsum("ij,ij->i", p[:, 0], numpy.cross(p[:, 1], p[:, 2])).sum() / 6


def meshed(seed, full, path, way, folder, scale):
    made = folder / "made.vtu"
    options = [scale * o if isinstance(o, float) or o == 1 else o for o in WAYS[way]]
    status, error, report = octafront(folder, "mesh", path, "-o", made, "--threads", 1, *options)
    if status != 0:
        return Run(seed, way, math.nan, 0, math.nan, 0, error.strip())
    off = volume_of_mesh(made) / (len(full) * scale**3) - 1
    fault = "" if abs(off) <= LOST else f"volume off by {off:.3g}"
    regions = len(spaces(full)) if way == "regions" else 1
    if not fault and max(1, len(report.get("regions", []))) != regions:
        fault = f"{len(report['regions'])} regions, not {regions}"
    return Run(seed, way, abs(off), report["tets"], report["quality"]["dihedral_min_degrees"], report["cpu_seconds"], fault)


def checked(seed, full, path, folder):
    status, error, report = octafront(folder, "check", path)
    found, wanted = (report.get("bodies"), report.get("cavities")), (len(spaces(full)), cavities(full))
    fault = error.strip() if status else "" if found == wanted else f"(bodies, cavities) {found}, not {wanted}"
    return Run(seed, "check", 0, 0, math.nan, 0, fault)


def repaired(seed, full, path, folder, scale):
    made = folder / "repaired.off"
    made.unlink(missing_ok=True)
    status, error, _ = octafront(folder, "repair", path, "-o", made)
    if status != 0:
        return Run(seed, "repair", math.nan, 0, math.nan, 0, error.strip())
    off = volume_of_surface(made) / (len(full) * scale**3) - 1
    _, _, report = octafront(folder, "check", made)
    fault = "" if abs(off) <= MOVED else f"volume off by {off:.3g}"
    if not report.get("clean") or report.get("repairs") or report["cavities"] != cavities(full):
        fault = f"not clean, or {report.get('cavities')} cavities, not {cavities(full)}"
    return Run(seed, "repair", abs(off), 0, math.nan, 0, fault)


def judge(seed, folder):
    chance, full = random.Random(-seed), pattern(seed)
    scale = SCALES[seed // 3 % len(SCALES)]
    points, triangles = boundary(full, chance)
    path = folder / f"voxels-{seed:04}.off"
    write_off(path, turned(points, seed, scale), facing(triangles, FACING[seed % len(FACING)], chance))
    ways = list(WAYS)
    chosen = ("automatic", ways[1 + seed % (len(ways) - 1)])
    runs = [meshed(seed, full, path, way, folder, scale) for way in chosen]
    runs += [checked(seed, full, path, folder), repaired(seed, full, path, folder, scale)]
    if not any(r.fault for r in runs):
        path.unlink()
    return runs


def page(runs, arguments):
    patterns = len({r.seed for r in runs})
    lines = ["# Bodies that touch themselves", "",
             f"{written_by(f'bench/campaigns/touching-campaign.py {arguments.cases} --page')}: {patterns} random patterns of {N}³ voxels, "
             f"{sum(1 for s in {r.seed for r in runs} if cavities(pattern(s)))} of them with cavities.", "",
             "Walls touch walls in edges and vertices of all kinds; triangles face outward, inward, or any way; patterns are turned and "
             "scaled by 1e-3 to 1e6. Each is meshed by default and in one other way, counted by `check`, and drawn apart by `repair`. "
             "Volumes are those of the written elements, as meshio reads them.", ""]
    rows = []
    for way in [*WAYS, "check", "repair"]:
        here = [r for r in runs if r.way == way]
        if not here:
            continue
        angles = [r.least for r in here if r.least == r.least]
        rows.append([way, len(here), sum(not r.fault for r in here), f"{max(r.off for r in here if r.off == r.off):.1e}",
                     f"{min(angles):.1f}°" if angles else "", f"{sum(r.elements for r in here):,}", f"{sum(r.seconds for r in here):.1f}"])
    tables.write("touching", [*lines, *tables.table(["way", "runs", "good", "volume off by, worst", "least angle", "elements", "CPU s, all"], rows)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("cases", nargs="?", default="0:500")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    first, end = map(int, arguments.cases.split(":"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        runs = []
        for seed in range(first, end):
            runs += judge(seed, folder)
            for run in runs[-4:]:
                if run.fault:
                    print(f"{seed} {run.way}: {run.fault}", flush=True)
    if arguments.page:
        page(runs, arguments)
    faults = sum(bool(r.fault) for r in runs)
    print(f"{len(runs)} runs of {end - first} patterns, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
