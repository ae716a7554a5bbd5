"""Octafront beside TetGen (-pqA) and Gmsh (Delaunay, optimised) on complexes of several regions, one thread each.

Usage: bench/run.sh complexes [--models NAME...] [--elements N] [--timeout SECONDS]
       bench/run.sh complexes --regions NAME:SIZE... [--timeout SECONDS]
The complexes of bench/models/make-complexes.sh. Anew: each mesher divides or triangulates the walls itself, to one size. Kept: the
walls that Octafront triangulated to that size are the same for all. Every mesh is written as MEDIT and read back: octafront_evaluate
judges elements, and volumes of the regions, one by one in the order of size, are compared with those of the walls given. Times are
CPU seconds of the whole process, reading and writing included. Writes the tables of docs/measured/complexes.md, and BUILD/complexes.json.
--regions compares with nobody else: each complex is meshed to a size, and then each of its regions by itself, a surface of its own
without neighbours. Times are of the stages, without reading and writing.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

from bench.ours import evaluated, mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import complexes, tetgen
from bench.process import finish, run_measured

ROOT = pathlib.Path(__file__).resolve().parents[2]

MODELS = ["crack", "buried_crack", "edge", "point", "layers", "gears", "shells", "wire", "spheres", "foam_200_1", "planes_20_1"]
CURVED = {"gears", "shells", "wire", "spheres"}  # a triangulation anew cuts across them, so volumes are shown, not judged
DELAUNAY = 1
OURS = "Octafront"
EXACT = 1e-9  # of the volume of each region by itself


def ours(build, complex_file, folder, timeout, size, keep):
    options = ["--keep-surface"] if keep else []
    return mesh(build / "cli/octafront", complex_file, folder, timeout, "--size", f"{size:.9g}", *options, out="out.mesh")


def gmsh(complex_file, folder, timeout, size, keep):
    out = pathlib.Path(folder, "out.mesh").resolve()
    # Debian's own Python has the package.
    outcome = run_measured(["/usr/bin/python3", "-m", "bench.peers.gmsh_complex", complex_file, out, f"{size:.9g}",
                            "kept" if keep else "anew", DELAUNAY], ROOT, timeout)
    return finish(outcome, out)


def meshers(build):
    return {OURS: lambda *a: ours(build, *a), "TetGen 1.5": tetgen.fill_complex, "Gmsh 4.8": gmsh}


def volume_error(found, expected):
    """The largest relative error of a region's volume; None if their number is not right."""
    if len(found) != len(expected):
        return None
    return max(abs(a / b - 1) for a, b in zip(sorted(found.values()), sorted(expected.values())))


def judged(build, run, complex_file, size, keep, expected, timeout):
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(complex_file, folder, timeout, size, keep)
        row = {"error": outcome.error, "cpu_seconds": outcome.cpu_seconds, "peak_mb": outcome.peak_bytes / 1e6}
        if outcome.mesh is None:
            return row
        quality, why = evaluated(build, outcome.mesh)
        if why:
            return row | {"error": f"its mesh cannot be read: {why}"}
        found = complexes.volumes_of_medit(outcome.mesh)
        return row | quality | {"regions": len(found), "volume_error": volume_error(found, expected)}


def right(row, tolerance):
    return "tets" in row and not row["defect"] and row["volume_error"] is not None and row["volume_error"] <= tolerance


def compare(build, folder, names, elements, timeout, save):
    rows = []
    for name in names:
        given = folder / f"{name}.ply"
        expected = complexes.volumes_of_sides(*complexes.read_ply(given))
        size = (sum(expected.values()) * 8.5 / elements) ** (1 / 3)  # a regular tetrahedron of edge h has h^3 / 8.485
        walls = folder / f"{name}-walls.ply"
        subprocess.run([build / "cli/octafront", "surface", given, "-o", walls, "--size", f"{size:.9g}", "-q"], check=True)
        of_walls = complexes.volumes_of_sides(*complexes.read_ply(walls))
        for how, source, volumes in (("anew", given, expected), ("kept", walls, of_walls)):
            tolerance = math.inf if how == "anew" and name in CURVED else EXACT
            for mesher, run in meshers(build).items():
                row = {"model": name, "surface": how, "mesher": mesher, "size": size, "expected_regions": len(volumes)}
                row |= judged(build, run, source, size, how == "kept", volumes, timeout)
                row["right"] = right(row, tolerance)
                rows.append(row)
                save(rows)
                print(tables.row(line(row)), flush=True)
    return rows


def line(row):
    cells = [row["model"], row["surface"], row["mesher"]]
    if "tets" not in row:
        return [*cells, f"**no mesh**: {row['error']}", *[""] * 6]
    n, error = row["tets"], row["volume_error"]
    regions = f"{row['regions']} of {row['expected_regions']}"
    volumes = "" if error is None else f"{error:.0e}"
    said = regions + (", " + volumes if volumes else "")
    if row["defect"]:
        said += ", **not valid**: " + row["defect"][:60]
    return [*cells, said if row["right"] else f"**{said}**" if not row["defect"] else said, f"{n:,}",
            f"{row['cpu_seconds']:.2f}", f"{n / row['cpu_seconds'] / 1e3:,.0f} k", f"{row['beta_mean']:.3f}",
            f"{100 * (row['beta_classes'][0] + row['beta_classes'][1]) / n:.2f}",
            f"{row['dihedral_min']:.1f} - {row['dihedral_max']:.1f}"]


PAGE = tables.MEASURED / "complexes.md"
REGIONS_HEAD = ["complex", "regions", "size", "elements", "us each", "mean β", "least angle", "alone: elements", "us each", "mean β", "least angle", "time, ratio"]
HEAD = ["complex", "walls", "mesher", "regions, worst volume", "elements", "CPU s", "elements/s", "mean β", "% β < .4",
        "dihedral angles"]


def summary(rows):
    """For each mesher: how many are right, and ratios over those that it and Octafront have right."""
    lines = []
    mean = lambda values: sum(values) / len(values)
    for how in ("anew", "kept"):
        of = {(r["model"], r["mesher"]): r for r in rows if r["surface"] == how}
        models = sorted({model for model, _ in of})
        for mesher in dict.fromkeys(m for _, m in of):
            mine = [of[model, mesher] for model in models]
            both = [(of[m, OURS], of[m, mesher]) for m in models if of[m, OURS]["right"] and of[m, mesher]["right"]]
            cells = [how, mesher, f"{sum(r['right'] for r in mine)} of {len(mine)}"]
            if both:
                speed = lambda r: r["tets"] / r["cpu_seconds"]
                cells += [f"{math.exp(mean([math.log(speed(a) / speed(b)) for a, b in both])):.2f}",
                          f"{mean([a['beta_mean'] for a, _ in both]):.3f} / {mean([b['beta_mean'] for _, b in both]):.3f}",
                          f"{sum(a['dihedral_min'] >= b['dihedral_min'] for a, b in both)} of {len(both)}"]
            else:
                cells += ["", "", ""]
            lines.append(cells)
    return tables.table(["faces", "mesher", "right", "our elements per second over its", "mean β, ours / its", "our least angle no smaller"], lines)


def by_regions(build, folder, name, size, timeout):
    """A row of the table: the complex, and its regions one by one."""
    given = folder / f"{name}.ply"
    points, triangles, sides = complexes.read_ply(given)
    together = [mesh(build / "cli/octafront", given, folder, timeout, "--size", size).report]
    alone = []
    for region in sorted({r for pair in sides for r in pair if r >= 0}):
        own = folder / "region.off"
        complexes.write_off(own, points, complexes.boundary_of(triangles, sides, region))
        alone.append(mesh(build / "cli/octafront", own, folder, timeout, "--size", size).report)
    row = [name, f"{len(alone)}", size]
    each = []
    for reports in (together, alone):
        tets = sum(r["tets"] for r in reports)
        seconds = sum(stage["cpu_seconds"] for r in reports for stage in r["stages"])
        beta = sum(r["tets"] * r["quality"]["beta_mean"] for r in reports) / tets
        each.append(seconds / tets)
        row += [f"{tets:,}", f"{1e6 * seconds / tets:.2f}", f"{beta:.3f}",
                f"{min(r['quality']['dihedral_min_degrees'] for r in reports):.1f}"]
    return [*row, f"{each[0] / each[1]:.2f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--models", nargs="+", default=MODELS)
    parser.add_argument("--elements", type=int, default=20_000)
    parser.add_argument("--timeout", type=float, default=300)
    parser.add_argument("--regions", nargs="+", metavar="NAME:SIZE")
    args = parser.parse_args()
    build = args.build.resolve()
    data = build / "complexes.json"
    save = lambda rows: data.write_text(json.dumps(rows, indent=1) + "\n")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        subprocess.run([build / "tests/support/make_complexes", folder], check=True, stdout=subprocess.DEVNULL)
        if args.regions:
            alone = [by_regions(build, folder, name, size, args.timeout) for name, size in (spec.split(":") for spec in args.regions)]
            tables.rewrite(PAGE, "regions", [f"{written_by('bench/run.sh complexes --regions ...')}.", "", *tables.table(REGIONS_HEAD, alone)])
            return
        rows = compare(build, folder, args.models, args.elements, args.timeout, save)
    each = tables.put("complexes", HEAD, [line(row) for row in rows])
    tables.rewrite(PAGE, "beside", [f"{written_by('bench/run.sh complexes')}. Each run: {each}.", "", *summary(rows)])


if __name__ == "__main__":
    main()
