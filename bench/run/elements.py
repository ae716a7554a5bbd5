"""--elements N met within 15 %? And how well sizes predict their number of elements, and are met in the volume.

Usage: bench/run.sh elements [--fast]
Writes its tables into docs/measured/benchmarks.md. --fast leaves out 1 M elements.
"""
import argparse
import csv
import pathlib
import tempfile

from bench.ours import mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.pages.tables import MEASURED, put, rewrite, spread_by

TARGET_HEAD = ["model", "wanted", "made", "off"]
MODELS = ["bunny00.off", "elephant.off", "fandisk_large.off", "anchor_dense.off", "armadillo.off", "3torus.off",
          "knot1.off", "rotor.off", "joint.off", "homer.off"]
COUNTS = [10_000, 100_000, 1_000_000]
HEAD = ["model", "size", "expected", "made", "off %", "surface edges / wanted", "surface: % within .7-1.4", "volume edges / wanted",
        "volume: % within .7-1.4"]


def report_of(build, model, *options):
    with tempfile.TemporaryDirectory() as folder:
        run = mesh(build / "cli/octafront", f"models/clean/{model}", folder, 3600, *options, threads=0)
    if run.error:
        raise SystemExit(f"{model}: {run.error}")
    return run.report


def targets(build, counts):
    rows, missed = [], 0
    for model in MODELS:
        for n in counts:
            made = report_of(build, model, "--elements", n)["tets"]
            missed += abs(made / n - 1) > 0.15
            rows.append([model, f"{n:,}", f"{made:,}", f"{100 * (made / n - 1):+.0f} %"])
            print(tables.row(rows[-1]), flush=True)
    return [f"`--elements`: {len(rows) - missed} of {len(rows)} within 15 %.", "", *target_lines(rows)]


def target_lines(rows):
    return [*spread_by("wanted", TARGET_HEAD, rows, TARGET_HEAD[2:]), "", f"Each: {put('elements-wanted', TARGET_HEAD, rows)}."]


def predictions(build, diagonals):
    rows, missed = [], 0
    for model in MODELS:
        d = diagonals[model]
        for name, options in (("automatic", []), ("diagonal / 25", ["--size", d / 25]),
                              ("diagonal / 60", ["--size", d / 60]),
                              ("diagonal / 25, --max-deviation 0.3 %", ["--size", d / 25, "--max-deviation", d * 0.003])):
            r = report_of(build, model, *options)
            off = 100 * (r["expected_tets"] / r["tets"] - 1)
            missed += abs(off) > 15
            s, v = r["surface_edges"], r["volume_edges"]
            rows.append([model, name, f"{r['expected_tets']:,.0f}", f"{r['tets']:,}", f"{off:+.0f}", f"{s['mean_ratio']:.3f}",
                         f"{100 * s['share_within_0.7_1.4']:.1f}", f"{v['mean_ratio']:.3f}", f"{100 * v['share_within_0.7_1.4']:.1f}"])
            print(tables.row(rows[-1]), flush=True)
    return [f"Prediction before meshing: {len(rows) - missed} of {len(rows)} within 15 %.", "", *prediction_lines(rows)]


def prediction_lines(rows):
    return [*spread_by("size", HEAD, rows, HEAD[4:]), "", f"Median, least and most. Each: {put('elements-predicted', HEAD, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--fast", action="store_true")
    args = parser.parse_args()
    diagonals = {r["file"]: float(r["bbox_diagonal"]) for r in csv.DictReader(open("bench/models/models.csv"))}
    lines = [f"{written_by('bench/run.sh elements')}.", "", *predictions(args.build, diagonals), "", *targets(args.build, COUNTS[: 2 if args.fast else 3])]
    rewrite(MEASURED / "benchmarks.md", "elements", lines)


if __name__ == "__main__":
    main()
