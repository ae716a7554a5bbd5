"""How fast should sizes change? Meshes made with gradations from .05 to .5: at one number of elements, at automatic sizes
that grow into the volume, and around a point with a thousandth of the size. Writes docs/measured/gradation.md.

Usage: bench/run.sh gradation [--only SUBSTRING] [--timeout SECONDS] [--parts N]
"""
import argparse
import pathlib
import statistics
import tempfile

from bench.ours import cpu_seconds
from bench.models.cube import CUBE
from bench.pages import tables
from bench.pages.origin import written_by
from bench.run.status import mesh_and_judge

MODELS = ["bunny00.off", "armadillo.off", "couplingdown.off"]
GRADATIONS = [0.05, 0.08, 0.12, 0.2, 0.3, 0.5]
HEAD = ["what", "gradation", "mean β", "above .8, %", "least β", "angles °", "elements", "filled, k/CPU s", "in all, k/CPU s", "Hausdorff %, mean"]


def figures(row):
    report, classes = row["report"], row["beta_classes"]
    fill = cpu_seconds(report, "volume front")
    return {"mean": row["beta_mean"], "above": 100 * classes[-1] / sum(classes), "least": row["beta_min"],
            "low": row["dihedral_min"], "high": row["dihedral_max"], "tets": row["tets"],
            "fill": row["tets"] / fill / 1000, "all": row["tets"] / report["cpu_seconds"] / 1000,
            "hausdorff": row["hausdorff_percent"]}


def line(what, gradation, made):
    mean = lambda key: statistics.mean(m[key] for m in made)
    return [what, f"{gradation:g}", f"{mean('mean'):.4f}", f"{mean('above'):.1f}", f"{min(m['least'] for m in made):.2f}",
            f"{min(m['low'] for m in made):.0f}–{max(m['high'] for m in made):.0f}", f"{mean('tets'):,.0f}", f"{mean('fill'):.0f}", f"{mean('all'):.0f}",
            f"{mean('hausdorff'):.3f}"]


def rows_of(build, what, models, options, timeout):
    rows = []
    for gradation in GRADATIONS:
        made = []
        for model in models:
            row = mesh_and_judge(build, model, [*options, "--gradation", str(gradation)], timeout, threads=1)
            if row["status"] != 0 or row["defect"]:
                raise SystemExit(f"{model.name} at {gradation}: {row['message'] or row['defect']}")
            made.append(figures(row))
        rows.append(line(what, gradation, made))
        print(tables.row(rows[-1]), flush=True)
    return rows


ABOUT = f"""Means over the models, worst of all. *A million elements*: {', '.join(MODELS)}, `--elements
1000000`, so sizes from curvature, walls and features, all scaled until there are about a million. *Sizes 1000 : 1*: a cube with elements of a tenth of its side, and of a thousandth of that at a point inside."""


def shown(rows):
    columns = [c for c in HEAD if c not in ("above .8, %", "least β", "in all, k/CPU s", "Hausdorff %, mean")]
    return [*tables.some(HEAD, [r for r in rows if str(r[1]) not in ("0.08", "0.3") and r[0] != "growing into the volume"], columns), "", f"With all figures, and sizes that grow into the volume: {tables.put('gradation', HEAD, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--parts", type=int, default=3, help="the first so many tables")
    a = parser.parse_args()
    models = [pathlib.Path("models/clean", m) for m in MODELS if a.only in m]
    with tempfile.TemporaryDirectory() as folder:
        cube, point = pathlib.Path(folder, "cube.off"), pathlib.Path(folder, "point.csv")
        cube.write_text(CUBE)
        point.write_text("x,y,z,size\n0.37,0.41,0.45,0.0001\n")
        parts = [("a million elements", models, ["--elements", "1000000"]), ("growing into the volume", models, ["--interior", "graded"]),
                 ("sizes 1000 : 1", [cube], ["--size", "0.1", "--regions", point])]
        rows = [row for what, which, options in parts[:a.parts] for row in rows_of(a.build, what, which, options, a.timeout)]
    if not a.only:
        tables.write("gradation", ["# How fast sizes may change", "", f"{written_by('bench/run.sh gradation')}, one thread. {ABOUT}", "", *shown(rows)])


if __name__ == "__main__":
    main()
