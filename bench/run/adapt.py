#!/usr/bin/env python3
"""Adaptation to metrics: the cases of the Unstructured Grid Adaptation Working Group by their measures, and Poisson's problem
on an L-shaped solid, solved by FEniCSx, adapted, solved again. Writes docs/measured/adapt.md.

    adapt.py BUILD [--output FILE]
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile

from bench.pages import tables
from bench.pages.origin import ROOT, written_by

# Case, body, edges of the mesh that comes, and what was asked: % of edges that fit, least and mean quality.
CASES = [("cube, linear", "cube", 0.5, "linear", 98.5, 0.50, 0.86), ("cube-cylinder, linear", "ring", 0.1, "linear", 94, 0.30, 0.82),
         ("cube-cylinder, polar-1", "ring", 0.1, "polar-1", 90, 0.15, 0.71), ("cube-cylinder, polar-2", "ring", 0.1, "polar-2", 94, 0.30, 0.84)]
ARC = 64


def extruded(path, outline, caps, height):
    """A body over a polygon (counter-clockwise) that is divided into triangles."""
    n = len(outline)
    with open(path, "w", encoding="utf-8") as out:
        for z in (0, height):
            out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y in outline)
        for a, b, c in caps:
            out.write(f"f {a + 1} {c + 1} {b + 1}\nf {a + n + 1} {b + n + 1} {c + n + 1}\n")
        for i in range(n):
            a, b = i + 1, (i + 1) % n + 1
            out.write(f"f {a} {b} {b + n}\nf {a} {b + n} {a + n}\n")


def write_bodies(folder):
    extruded(folder / "cube.obj", [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], [(0, 1, 2), (0, 2, 3)], 1.0)
    # The unit cube without the cylinder of radius .5 around the z axis.
    arc = [(0.5 * math.cos(math.pi / 2 * i / ARC), 0.5 * math.sin(math.pi / 2 * i / ARC)) for i in range(ARC, -1, -1)]
    arc[0], arc[-1] = (0.0, 0.5), (0.5, 0.0)
    outline = arc + [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    corner = ARC + 2
    extruded(folder / "ring.obj", outline, [(i, i + 1, corner) for i in range(ARC + 1)] + [(0, corner, corner + 1)], 1.0)


def rows_of_cases(build):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_bodies(folder)
        for title, body, size, metric, fit, least, mean in CASES:
            mesh = folder / f"{body}.vtu"
            subprocess.run([build / "cli/octafront", "mesh", folder / f"{body}.obj", "-o", mesh, "--size", str(size), "-q"], check=True)
            told = subprocess.run([build / "bench/octafront_adapt_cases", mesh, metric], check=True, capture_output=True, text=True).stdout
            r = json.loads(told)
            part = 100 * r["fitting"] / r["edges"]
            good = part >= fit and r["quality_min"] >= least and r["quality_mean"] >= mean and r["longest"] <= 2
            yield [title, f"{r['tets']:,}", f"{r['tets'] / r['complexity']:.1f}", f"{part:.1f} %", f"≥ {fit} %", f"{r['longest']:.2f}",
                   f"{r['quality_min']:.3f}, {r['quality_mean']:.3f}", f"≥ {least:.2f}, {mean:.2f}", "all" if good else "not all", f"{r['cpu']:.1f}"]


def rows_of_loop(build):
    """None where there is no FEniCSx."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "OCTAFRONT_BIN": str(build.resolve() / "python/octafront/_bin"),
                   "OMP_NUM_THREADS": "1"}
    done = subprocess.run(["/usr/bin/python3", ROOT / "examples/solve/fenicsx_loop.py", "--json"], env=environment, check=False,
                          capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip().splitlines()[-1:]
    return json.loads(done.stdout.strip().splitlines()[-1]), []


def slope(rows):
    """Of the line that fits the logarithms best."""
    x, y = [math.log(r["unknowns"]) for r in rows], [math.log(r["error"]) for r in rows]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


KINDS = ("uniform", "sizes", "metric")
LOOP = ["mesh", "elements", "unknowns", "error"]


def steps(kind, rows):
    return [[kind, f"{r['elements']:,}", f"{r['unknowns']:,}", f"{r['error']:.4f}"] for r in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    options = parser.parse_args()
    lines = ["# Adaptation to metrics", "", f"{written_by('bench/run.sh adapt')}.", "", "## The Working Group's cases", "",
             "The cases and measures of the Unstructured Grid Adaptation Working Group (github.com/UGAWG/adapt-benchmarks), by `adapt_to_metric()` on one thread from a uniform mesh of edges .5 (cube) and .1 (the cube without a cylinder of "
             "radius .5). *fit*: edges from √½ to √2 times as long as is wanted; *longest* in parts of that, at most 2 asked; quality in the metric. *asked*: better than all entries of 2017.", "",
             *tables.table(["case", "elements", "for each unit of complexity", "fit", "asked", "longest", "quality: least, mean", "asked", "met", "CPU s"],
                           rows_of_cases(options.build))]
    print("\n".join(lines))
    loops, why = rows_of_loop(options.build)
    lines += ["", "## A loop with a solver", ""]
    if loops is None:
        lines.append(f"Not run: {' '.join(why)}")
    else:
        lines += ["`examples/solve/fenicsx_loop.py`: Poisson's equation on an L-shaped solid with the solution r^⅔ sin ⅔θ cos πz, whose gradient is infinite at the edge, linear elements of FEniCSx; the metric of the solution in L² for twice as many elements in each "
                  "step; *sizes*: as long in all directions, with the same density. The error is that of the gradient in L².", "",
                  *tables.table(LOOP, [row for kind in KINDS for row in steps(kind, loops[kind])[-2:]])]
        link = tables.put("adapt-loop", LOOP, [row for kind in KINDS for row in steps(kind, loops[kind])])
        lines += ["", f"With coarser ones: {link}. Slopes of the lines that fit best: uniform {slope(loops['uniform']):.3f}, sizes {slope(loops['sizes']):.3f}, metric {slope(loops['metric']):.3f}. By theory they end at -²⁄₉, -⅓ and -⅓. "
                  "Round elements of the density that the metric has gain nothing over uniform ones here; the directions do."]
    tables.write("adapt", lines)


if __name__ == "__main__":
    main()
