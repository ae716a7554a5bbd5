"""--elements N met within 15 %? And how well sizes predict their number of elements, and are met in the volume.

Usage: bench/run.sh elements [--fast]
Writes its tables into docs/measured/benchmarks.md. --fast leaves out 1 M elements.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

from origin import written_by

MODELS = ["bunny00.off", "elephant.off", "fandisk_large.off", "anchor_dense.off", "armadillo.off", "3torus.off",
          "knot1.off", "rotor.off", "joint.off", "homer.off"]
COUNTS = [10_000, 100_000, 1_000_000]
MARKS = ("<!-- elements: begin -->", "<!-- elements: end -->")


def mesh(build, model, *options):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "r.json")
        subprocess.run([build / "cli/octafront", "mesh", f"models/clean/{model}", "-o", pathlib.Path(folder, "m.vtu"),
                        "--json", report, "-q", *map(str, options)], check=True)
        return json.loads(report.read_text())


def head(titles):
    return ["| " + " | ".join(titles) + " |", "|" + " --- |" * len(titles)]


def targets(build, counts):
    lines, missed = head(["model", *(f"{n:,} wanted" for n in counts)]), 0
    for model in MODELS:
        cells = []
        for n in counts:
            made = mesh(build, model, "--elements", n)["tets"]
            missed += abs(made / n - 1) > 0.15
            cells.append(f"{made:,} ({100 * (made / n - 1):+.0f} %)")
        lines.append(f"| {model} | " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return [f"`--elements`: {len(MODELS) * len(counts) - missed} of {len(MODELS) * len(counts)} within 15 %.", "", *lines]


def predictions(build, diagonals):
    lines, missed, runs = head(["model", "size", "expected", "made", "off %", "surface edges / wanted", "% within .7-1.4",
                                "volume edges / wanted", "% within .7-1.4"]), 0, 0
    for model in MODELS:
        d = diagonals[model]
        for name, options in (("automatic", []), ("diagonal / 25", ["--size", d / 25]),
                              ("diagonal / 60", ["--size", d / 60]),
                              ("diagonal / 25, --max-deviation 0.3 %", ["--size", d / 25, "--max-deviation", d * 0.003])):
            r = mesh(build, model, *options)
            off = 100 * (r["expected_tets"] / r["tets"] - 1)
            runs, missed = runs + 1, missed + (abs(off) > 15)
            s, v = r["surface_edges"], r["volume_edges"]
            lines.append(f"| {model} | {name} | {r['expected_tets']:,.0f} | {r['tets']:,} | {off:+.0f} | "
                         f"{s['mean_ratio']:.3f} | {100 * s['share_within_0.7_1.4']:.1f} | {v['mean_ratio']:.3f} | "
                         f"{100 * v['share_within_0.7_1.4']:.1f} |")
            print(lines[-1], flush=True)
    return [f"Prediction before meshing: {runs - missed} of {runs} within 15 %.", "", *lines]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--fast", action="store_true")
    args = parser.parse_args()
    diagonals = {r["file"]: float(r["bbox_diagonal"]) for r in csv.DictReader(open("bench/models.csv"))}
    text_lines = [f"{written_by('bench/run.sh elements')}.", "", *predictions(args.build, diagonals), "", *targets(args.build, COUNTS[: 2 if args.fast else 3])]
    page = pathlib.Path("docs/measured/benchmarks.md")
    text = page.read_text()
    if MARKS[0] not in text:
        text += f"\n## Numbers of elements, and sizes in the volume\n\n{MARKS[0]}\n{MARKS[1]}\n"
    before, after = text.split(MARKS[0])[0], text.split(MARKS[1])[1]
    page.write_text(before + MARKS[0] + "\n" + "\n".join(text_lines) + "\n" + MARKS[1] + after)


main()
