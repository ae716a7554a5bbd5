"""Meshes whose sizes follow curvature, against HXT and TetGen side by side, and what such meshes are worth: writes docs/measured/graded.md.

Usage: bench/run.sh graded [--counts 1000000,4000000] [--models bunny00.off,...] [--runs N] [--large ELEMENTS] [--cubes 3300000,20000000]

Kept surfaces: each model is triangulated anew at curvature sizes for about so many tetrahedra; then each mesher fills that surface
and keeps its triangles, one thread, in turns, the least CPU seconds (user and system) of N runs of the whole process, files
included. From STL: the same models from a binary STL file, triangulated and filled. --large adds one run of so many
elements, and how CPU time grows from 100,000 to there. --cubes alone fills the unit cube at one size, from its geometry on, and writes its rows only.
"""
import argparse
import pathlib
import tempfile

from bench import ours
from bench.off import read_off
from bench.ours import cpu_seconds, evaluated
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import gmsh, surfaces, tetgen
from bench.process import run_measured
from bench.run.volume import exponent

MODELS = ["bunny00.off", "armadillo.off", "elephant.off", "couplingdown.off", "pinion.off"]
COUNTS = [1_000_000]
SMALLEST = 100_000
PEERS_UP_TO = 5_000_000


def mesh(build, folder, timeout, source, *options, threads=1):
    return ours.mesh(build / "cli/octafront", source, folder, timeout, *options, out="ours.msh", threads=threads)


def meshers(build):
    keep = lambda gradation: lambda s, f, t: mesh(build, f, t, s, "--keep-surface", *gradation)
    by_name = {"octafront": keep([]), "octafront, gradation .2": keep(["--gradation", "0.2"]),
               "HXT": lambda s, f, t: gmsh.fill_hxt(s, f, t, held=False), "HXT, MeshSizeMax": gmsh.fill_hxt, "TetGen": tetgen.fill}
    if gmsh.NEWEST:
        by_name["newest HXT"] = lambda s, f, t: gmsh.fill_hxt(s, f, t, held=False, program=gmsh.NEWEST)
        by_name["newest Delaunay"] = lambda s, f, t: gmsh.fill_delaunay(s, f, t, held=False, program=gmsh.NEWEST)
    return by_name


def least(runs):
    """Every mesher in turns, so that a busy moment hits all of them; the best run of each, its mesh judged."""
    best = {}
    for turn in range(runs["runs"]):
        for name, run in runs["meshers"].items():
            with tempfile.TemporaryDirectory() as folder:
                outcome = run(runs["surface"], folder, runs["timeout"])
                if outcome.error:
                    best[name] = {"error": outcome.error}
                    continue
                row = best.setdefault(name, {"outcome": outcome, "error": ""})
                if turn == 0:
                    row["quality"], why = evaluated(runs["build"], outcome.mesh, runs["surface"], "--kept")
                    row["error"] = why or row["quality"]["defect"] or ""
                if outcome.cpu_seconds < row["outcome"].cpu_seconds:
                    row["outcome"] = outcome
    return best


def kept_rows(model, best):
    octafront = best["octafront"]
    rows = []
    for name, row in best.items():
        if row["error"]:
            rows.append([model, name, row["error"], *[""] * (len(KEPT_HEAD) - 3)])
            continue
        q, outcome = row["quality"], row["outcome"]
        n = q["tets"]
        rate = n / outcome.cpu_seconds
        filled = improved = "–"
        if outcome.report:
            filled = f"{n / cpu_seconds(outcome.report, 'volume front') / 1e3:,.0f}"
            improved = f"{1e6 * cpu_seconds(outcome.report, 'improve') / n:.2f}"
        ratio = "" if row is octafront or octafront["error"] else \
            f"{octafront['quality']['tets'] / octafront['outcome'].cpu_seconds / rate:.2f}"
        rows.append([model, name, f"{n:,}", f"{outcome.cpu_seconds:.2f}", f"{rate / 1e3:,.0f}", ratio, filled, improved, f"{outcome.peak_bytes / n:.0f}",
                     f"{q['beta_mean']:.4f}", f"{100 * q['beta_classes'][4] / n:.1f}", f"{q['dihedral_min']:.1f}", f"{q['dihedral_max']:.1f}"])
    return rows


KEPT_HEAD = ["surface", "mesher", "elements", "CPU s", "k/s", "ours over it", "filled, k/s", "improved, µs", "bytes per element", "mean β", "above .8, %",
             "least angle °", "most °"]


def as_stl(model, folder):
    path = pathlib.Path(folder, pathlib.Path(model).stem + ".stl")
    surfaces.write_stl(path, *read_off(f"models/clean/{model}"))
    return path


STL_HEAD = ["model", "elements", "CPU s", "k/s", "sizes, %", "surface, %", "filled, %", "improved, %", "made over expected", "length over wanted, mean",
            "% within .7–1.4", "mean β", "above .8, %", "least angle °", "most °", "2 threads, times", "same bits"]


def stl_row(build, model, count, runs, timeout):
    best, wall = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        stl = as_stl(model, folder)
        for _ in range(runs):
            for threads in (1, 2):
                outcome = mesh(build, folder, timeout, stl, "--elements", str(count), threads=threads)
                if outcome.error:
                    return [model, outcome.error, *[""] * (len(STL_HEAD) - 2)]
                wall[threads] = min(wall.get(threads, 1e9), outcome.wall_seconds)
                if threads not in best or outcome.cpu_seconds < best[threads].cpu_seconds:
                    best[threads] = outcome
    one = best[1]
    report, n = one.report, one.report["tets"]
    share = lambda stage: f"{100 * cpu_seconds(one.report, stage) / one.cpu_seconds:.0f}"
    quality, edges = report["quality"], report["volume_edges"]
    return [model, f"{n:,}", f"{one.cpu_seconds:.2f}", f"{n / one.cpu_seconds / 1e3:,.0f}", share("size field"), share("surface front"), share("volume front"),
            share("improve"), f"{n / report['expected_tets']:.3f}", f"{edges['mean_ratio']:.3f}", f"{100 * edges['share_within_0.7_1.4']:.1f}",
            f"{quality['beta_mean']:.4f}", f"{100 * quality['beta_classes'][4] / n:.1f}", f"{quality['dihedral_min_degrees']:.1f}",
            f"{quality['dihedral_max_degrees']:.1f}", f"{wall[1] / wall[2]:.2f}", "yes" if report["hash"] == best[2].report["hash"] else "NO"]


GROWTH_HEAD = ["elements", "CPU s", "k/s", "bytes per element", "mean β", "above .8, %", "least angle °", "most °"]


def growth(build, model, counts, timeout):
    """How the whole run from STL grows with the number of elements."""
    rows, points = [], []
    with tempfile.TemporaryDirectory() as folder:
        stl = as_stl(model, folder)
        for count in counts:
            outcome = mesh(build, folder, timeout, stl, "--elements", str(count))
            if outcome.error:
                rows.append([f"{count:,}", outcome.error, *[""] * (len(GROWTH_HEAD) - 2)])
                continue
            quality, n = outcome.report["quality"], outcome.report["tets"]
            points.append((n, outcome.cpu_seconds))
            rows.append([f"{n:,}", f"{outcome.cpu_seconds:.2f}", f"{n / outcome.cpu_seconds / 1e3:,.0f}", f"{outcome.peak_bytes / n:.0f}",
                         f"{quality['beta_mean']:.4f}", f"{100 * quality['beta_classes'][4] / n:.1f}", f"{quality['dihedral_min_degrees']:.1f}",
                         f"{quality['dihedral_max_degrees']:.1f}"])
            print(tables.row(rows[-1]), flush=True)
    return [*tables.table(GROWTH_HEAD, rows), "", f"CPU time grows as elements to the power {exponent(points):.2f}."]


CUBE = "OFF\n8 12 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n" + "".join(
    f"3 {a} {b} {c}\n" for a, b, c in [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7),
                                     (2, 7, 6), (3, 0, 4), (3, 4, 7)])
CUBE_HEAD = ["elements asked", "mesher", "size", "elements", "CPU s", "k/s", "bytes per element", "mean β", "least β", "above .8, %", "least angle °", "most °"]


def cube_rows(build, count, timeout):
    """The unit cube at the edge length of so many regular tetrahedra; of twice as many for Gmsh, which makes half of them."""
    size = {times: (6 * 2 ** .5 / count / times) ** (1 / 3) for times in (1, 2)}
    gmshs = {"Gmsh 4.8": gmsh.PROGRAM, **({"newest Gmsh": gmsh.NEWEST} if gmsh.NEWEST else {})}
    meshers = {"octafront": lambda f: mesh(build, f, timeout, pathlib.Path(f, "cube.off"), "--size", f"{size[1]:.9g}")}
    for name, program in gmshs.items():
        for algorithm in ("HXT", "DELAUNAY"):
            if algorithm == "HXT" or count <= PEERS_UP_TO or program != gmsh.PROGRAM:
                meshers[f"{name}, {algorithm}"] = lambda f, p=program, a=algorithm: gmsh.cube(f, timeout, size[2], getattr(gmsh, a), program=p)
    for name, run in meshers.items():
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "cube.off").write_text(CUBE)
            outcome = run(folder)
            q, why = (None, outcome.error) if outcome.error else evaluated(build, outcome.mesh)
            if q is None:
                yield [f"{count:,}", name, why, *[""] * (len(CUBE_HEAD) - 3)]
                continue
            n = q["tets"]
            yield [f"{count:,}", name, f"{size[1 if name == 'octafront' else 2]:.5f}", f"{n:,}", f"{outcome.cpu_seconds:.2f}", f"{n / outcome.cpu_seconds / 1e3:,.0f}",
                   f"{outcome.peak_bytes / n:.0f}", f"{q['beta_mean']:.4f}", f"{q['beta_min']:.3f}", f"{100 * q['beta_classes'][4] / n:.1f}",
                   f"{q['dihedral_min']:.1f}", f"{q['dihedral_max']:.1f}"]


def write_cubes(args):
    rows = []
    for count in args.cubes:
        for row in cube_rows(args.build, count, args.timeout):
            rows.append(row)
            print(tables.row(row), flush=True)
    print(tables.put("graded-cubes", CUBE_HEAD, rows))


def kept_tables(args):
    rows = []
    for model in args.models:
        for count in args.counts:
            with tempfile.TemporaryDirectory() as folder:
                surface = pathlib.Path(folder, "kept.off").resolve()
                made = run_measured([args.build / "cli/octafront", "surface", f"models/clean/{model}", "--elements", str(count), "-o",
                                     surface, "-q"], ".", args.timeout)
                if made.error:
                    raise SystemExit(f"{model}: {made.error}")
                wanted = {name: run for name, run in meshers(args.build).items()
                          if count <= PEERS_UP_TO or name.startswith("octafront")}
                best = least({"build": args.build, "surface": surface, "meshers": wanted, "runs": args.runs,
                              "timeout": args.timeout})
            for row in kept_rows(f"{model}, {count:,}", best):
                rows.append(row)
                print(tables.row(row), flush=True)
    return rows


def stl_tables(args):
    rows = []
    for model in args.models:
        for count in args.counts:
            rows.append(stl_row(args.build, model, count, args.runs, args.timeout))
            print(tables.row(rows[-1]), flush=True)
    return rows


def shown(kept, stl):
    """Rows of cells."""
    return ["## Kept surfaces", "", *tables.spread_by("mesher", KEPT_HEAD, kept, KEPT_SHOWN), "",
            f"Median, least and most. Each: {tables.put('graded-kept', KEPT_HEAD, kept)}.", "",
            "## From STL", "", *tables.spread(STL_HEAD, stl, [c for c in STL_HEAD if c in STL_SHOWN]), "", f"Each: {tables.put('graded-stl', STL_HEAD, stl)}."]


KEPT_SHOWN = ["elements", "CPU s", "k/s", "ours over it", "bytes per element", "mean β", "least angle °"]
STL_SHOWN = ("elements", "CPU s", "k/s", "made over expected", "% within .7–1.4", "mean β", "least angle °", "2 threads, times")
ABOUT = """Kept surfaces: each model is triangulated anew at curvature sizes for about so many tetrahedra; then each mesher fills that surface and keeps its
triangles, one thread, in turns, the least CPU seconds of the whole process, files included. HXT extends sizes from the boundary, as its users run it;
held by `Mesh.MeshSizeMax`, the mean edge, too, it makes more elements where sizes grow, and asks for sizes in another way. From STL: triangulated and filled."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--counts", type=lambda s: [int(c) for c in s.split(",")], default=COUNTS)
    parser.add_argument("--models", type=lambda s: s.split(","), default=MODELS)
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--large", type=int)
    parser.add_argument("--cubes", type=lambda s: [int(c) for c in s.split(",")])
    parser.add_argument("--timeout", type=float, default=600)
    args = parser.parse_args()
    args.build = args.build.resolve()
    if args.cubes:
        return write_cubes(args)
    lines = shown(kept_tables(args), stl_tables(args))
    if args.large:
        counts = [SMALLEST, *(c for c in args.counts if SMALLEST < c < args.large), args.large]
        lines += ["", f"## {args.models[0]}, how it grows", "", *growth(args.build, args.models[0], counts, args.timeout)]
    tables.write("graded", ["# Sizes that follow curvature, against others", "", f"{written_by('bench/run.sh graded')}. {ABOUT}", "", *lines])


if __name__ == "__main__":
    main()
