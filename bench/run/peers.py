"""Octafront beside TetGen, Gmsh (Delaunay, Frontal, HXT), Netgen and CGAL Mesh_3, on the same models, one thread each.

Usage: bench/run.sh peers [--models NAME...] [--elements N] [--timeout SECONDS]
Two comparisons: the surface kept (one that Octafront triangulated to the size, the same for all), and the surface
triangulated anew by each mesher to the same size. Every mesh is written to a file, and octafront_evaluate judges the
file. Times are CPU seconds of the whole process, reading and writing included, and of meshing alone where a mesher
tells it. Prints the tables' rows and writes BUILD/experiments/peers.json, from which docs/measured/peers.md is made.
"""
import argparse
import collections
import json
import pathlib
import platform
import subprocess
import tempfile

from bench.ours import evaluated, mesh
from bench.pages.tables import spread_by
from bench.peers import cgal, gmsh, netgen, tetgen

MODELS = ["bunny00", "elephant", "armadillo", "fandisk_large", "anchor_dense"]


def ours(build, method, surface, folder, timeout, *options):
    outcome = mesh(build / "cli/octafront", surface, folder, timeout, "--method", method, *options, out="out.mesh")
    if outcome.report:
        outcome.stage_seconds = sum(s["cpu_seconds"] for s in outcome.report["stages"])
    return outcome


def kept_runs(build):
    return {"Octafront octree-aft": lambda s, f, t: ours(build, "octree-aft", s, f, t, "--keep-surface"),
            "Octafront aft": lambda s, f, t: ours(build, "aft", s, f, t, "--keep-surface"),
            "TetGen 1.5 -pYq": tetgen.fill,
            "Gmsh 4.8 HXT": gmsh.fill_hxt,
            "Gmsh 4.8 Delaunay": gmsh.fill_delaunay,
            "Gmsh 4.8 Frontal": gmsh.fill_frontal,
            "Netgen 6.2": netgen.fill}


def anew_runs(build, size):
    size_option = ("--size", f"{size:.9g}")
    runs = {f"Octafront {m}": lambda s, f, t, m=m: ours(build, m, s, f, t, *size_option)
            for m in ("octree-aft", "aft", "octree")}
    for name, algorithm in (("HXT", gmsh.HXT), ("Delaunay", gmsh.DELAUNAY), ("Frontal", gmsh.FRONTAL)):
        runs[f"Gmsh 4.8 {name}"] = lambda s, f, t, a=algorithm: gmsh.remesh(s, f, t, size, a)
    runs["Netgen 6.2"] = lambda s, f, t: netgen.remesh(s, f, t, size)
    program = build / "bench/peer_cgal_mesh"
    if program.exists():
        runs["CGAL 5.5 Mesh_3"] = lambda s, f, t: cgal.remesh(s, f, t, size, program)
    return runs


def judged(build, run, surface, timeout, kept):
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(surface, folder, timeout)
        row = {"command": pathlib.Path(outcome.command.split()[0]).name, "error": outcome.error,
               "cpu_seconds": outcome.cpu_seconds, "meshing_seconds": outcome.stage_seconds,
               "peak_mb": outcome.peak_bytes / 1e6}
        if outcome.mesh is None:
            return row
        found, why = evaluated(build, outcome.mesh, surface, *(["--kept"] if kept else []))
        return row | (found or {"error": f"its mesh cannot be read: {why}"})


def uniform_surface(build, model, elements, folder):
    """The model triangulated to one size, chosen so that `elements` tetrahedra of that size fill it; and the size."""
    report, surface = pathlib.Path(folder, "size.json"), pathlib.Path(folder, "surface.off")
    octafront = build / "cli/octafront"
    subprocess.run([octafront, "surface", model, "-o", surface, "--elements", str(elements), "-q", "--json", report],
                   check=True)
    volume = json.loads(report.read_text())["volume"]
    size = (volume * 8.5 / elements) ** (1 / 3)  # a regular tetrahedron of edge h has h^3 / 8.485
    subprocess.run([octafront, "surface", model, "-o", surface, "--size", f"{size:.9g}", "-q"], check=True)
    return surface, size


def compare(build, names, elements, timeout):
    rows = []
    for name in names:
        model = pathlib.Path(f"models/clean/{name}.off")
        with tempfile.TemporaryDirectory() as folder:
            surface, size = uniform_surface(build, model, elements, folder)
            for what, source, runs in (("kept", surface, kept_runs(build)), ("anew", model, anew_runs(build, size))):
                for mesher, run in runs.items():
                    row = {"model": name, "surface": what, "mesher": mesher, "size": size}
                    row |= judged(build, run, source, timeout, what == "kept")
                    rows.append(row)
                    print(*line(row), sep=" | ", flush=True)
    return rows


def line(row):
    """A row of the tables."""
    cells = [row["surface"], row["model"], row["mesher"]]
    if "tets" not in row:
        return cells + [""] * 10 + [f"no mesh: {row['error']}"]
    n, classes = row["tets"], row["beta_classes"]
    seconds = row["meshing_seconds"] or row["cpu_seconds"]
    defect = row["defect"]
    return cells + [
        f"{n:,}", f"{row['cpu_seconds']:.1f}", f"{n / seconds / 1e3:,.0f} k", f"{row['peak_mb']:.0f}",
        f"{row['beta_mean']:.3f}", f"{row['beta_min']:.3f}", f"{100 * classes[0] / n:.3f}", f"{100 * classes[4] / n:.1f}",
        f"{row['dihedral_min']:.1f}", f"{row['dihedral_max']:.1f}", f"{row['hausdorff_percent']:.3f}",
        "valid" if not defect else "not valid: " + defect[:60]]


HEAD = ["surface", "model", "mesher", "elements", "process s", "elements/s of meshing", "MB", "mean β", "min β", "% β < .2", "% β > .8", "least angle °",
        "most °", "deviation, % of diagonal", "judged"]


def shown(rows, surface):
    """Rows of cells: each mesher over the models."""
    its = [r for r in rows if r[0] == surface]
    failed = collections.Counter(r[2] for r in its if r[-1] != "valid")
    said = f" Without a valid mesh: {', '.join(f'{mesher} {n}' for mesher, n in failed.items())}." if failed else ""
    made = {r[2] for r in its if r[-1] == "valid"}
    return [*spread_by("mesher", HEAD, [r for r in its if r[2] in made], [c for c in HEAD[5:-1] if c not in ("MB", "most °")]), "", f"Median, least and most of the meshes that there are.{said}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--models", nargs="+", default=MODELS)
    parser.add_argument("--elements", type=int, default=60_000)
    parser.add_argument("--timeout", type=float, default=90)
    parser.add_argument("--data", type=pathlib.Path)
    args = parser.parse_args()
    rows = compare(args.build.resolve(), args.models, args.elements, args.timeout)
    data = args.data or args.build / "experiments/peers.json"
    data.parent.mkdir(parents=True, exist_ok=True)
    data.write_text(json.dumps({"machine": platform.processor() or platform.machine(), "elements": args.elements,
                                     "timeout": args.timeout, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
