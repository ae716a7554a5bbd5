"""Elements per second of every stage on three models at two sizes: writes its table into docs/measured/benchmarks.md.

Usage: bench/run.sh pipeline [--runs N] [--beside PROGRAM]
CPU seconds, one thread, the least of N runs; a size is given so that the count comes out near the one wanted.
--beside: another build of octafront, run in turn with this one; a second table shows this one's figures over its.
"""
import argparse
import pathlib
import tempfile

from bench.ours import mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.pages.tables import MEASURED, put, rewrite, some, spread_by

MODELS = ["bunny00.off", "refined_elephant.off", "fandisk_large.off"]
COUNTS = [100_000, 1_000_000]
PAGE = MEASURED / "benchmarks.md"
HEAD = ["model", "tets", "boundary triangles", "size field s", "surface front s", "triangles/s", "volume front s", "filled tets/s", "improve s",
        "improved tets/s", "all stages tets/s", "mean β", "min β", "peak bytes/tet"]
BESIDE_HEAD = ["model", "elements", "size field", "surface front", "volume front", "improve", "all stages", "peak memory", "same mesh"]


def run_once(program, model, count):
    with tempfile.TemporaryDirectory() as folder:
        run = mesh(program, f"models/clean/{model}", folder, 3600, "--elements", count)
    if run.error:
        raise SystemExit(f"{model}: {run.error}")
    # Earlier tries for the element count are not what is measured here.
    return run.report, {s["name"]: s["cpu_seconds"] for s in run.report["stages"] if "earlier" not in s["name"]}


def measure(programs, model, count, runs):
    """The best run of each program; they take turns, so that a busy moment hits all of them."""
    best = [None] * len(programs)
    for _ in range(runs):
        for i, program in enumerate(programs):
            made = run_once(program, model, count)
            if best[i] is None or sum(made[1].values()) < sum(best[i][1].values()):
                best[i] = made
    return best


def row(model, report, stages):
    tets = report["tets"]
    rate = lambda seconds: f"{tets / seconds / 1e3:,.0f} k" if seconds > 0 else "-"
    surface = stages["surface front"]
    return [
        model, f"{tets:,}", f"{report['boundary_faces']:,}", f"{stages['size field']:.2f}",
        f"{surface:.2f}", f"{report['boundary_faces'] / surface / 1e3:,.0f} k", f"{stages['volume front']:.2f}",
        rate(stages["volume front"]), f"{stages['improve']:.2f}", rate(stages["improve"]), rate(sum(stages.values())),
        f"{report['quality']['beta_mean']:.3f}", f"{report['quality']['beta_min']:.3f}",
        f"{report['peak_memory_bytes'] / tets:.0f}"]


def ratio_row(model, count, ours, other):
    stages = ["size field", "surface front", "volume front", "improve"]
    ratios = [ours[1][stage] / other[1][stage] for stage in stages]
    ratios.append(sum(ours[1].values()) / sum(other[1].values()))
    ratios.append(ours[0]["peak_memory_bytes"] / other[0]["peak_memory_bytes"])
    same = "yes" if ours[0]["hash"] == other[0]["hash"] else "no"
    return [model, f"{count:,}", *(f"{r:.2f}" for r in ratios), same]


def lines_of(rows):
    columns = ["model", "tets", "triangles/s", "filled tets/s", "improved tets/s", "all stages tets/s", "mean β", "peak bytes/tet"]
    return [*some(HEAD, rows, columns), "", f"With all figures: {put('pipeline', HEAD, rows)}."]


def beside_lines(ratios):
    return spread_by("elements", BESIDE_HEAD, ratios, BESIDE_HEAD[2:8])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--beside", type=pathlib.Path)
    args = parser.parse_args()
    programs = [args.build / "cli/octafront"] + ([args.beside] if args.beside else [])
    rows, ratios = [], []
    for model in MODELS:
        for count in COUNTS:
            made = measure(programs, model, count, args.runs)
            rows.append(row(model, *made[0]))
            print(tables.row(rows[-1]), flush=True)
            if args.beside:
                ratios.append(ratio_row(model, count, *made))
                print(tables.row(ratios[-1]), flush=True)
    said = f"{written_by('bench/run.sh pipeline')}, the least of {args.runs} runs."
    rewrite(PAGE, "pipeline", [said, "", *lines_of(rows)])
    if args.beside:
        print(*beside_lines(ratios), sep="\n")


if __name__ == "__main__":
    main()
