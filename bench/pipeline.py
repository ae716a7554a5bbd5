"""Elements per second of every stage on three models at two sizes: writes its table into docs/benchmarks.md.

Usage: bench/run.sh pipeline [--runs N]
CPU seconds, one thread, the least of N runs; a size is given so that the count comes out near the one wanted.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

MODELS = ["bunny00.off", "refined_elephant.off", "fandisk_large.off"]
COUNTS = [100_000, 1_000_000]
MARKS = ("<!-- pipeline: begin -->", "<!-- pipeline: end -->")


def measure(build, model, count, runs):
    best = None
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder, "report.json")
            subprocess.run([build / "cli/octafront", "mesh", f"models/clean/{model}", "-o", pathlib.Path(folder, "m.vtu"),
                            "--elements", str(count), "--threads", "1", "--json", report, "-q"], check=True)
            r = json.loads(report.read_text())
        # Earlier tries for the element count are not what is measured here.
        stages = {s["name"]: s["cpu_seconds"] for s in r["stages"] if "earlier" not in s["name"]}
        if best is None or sum(stages.values()) < sum(best[1].values()):
            best = (r, stages)
    return best


def row(model, report, stages):
    tets = report["tets"]
    rate = lambda seconds: f"{tets / seconds / 1e3:,.0f} k" if seconds > 0 else "-"
    surface = stages["surface front"]
    return "| " + " | ".join([
        model, f"{tets:,}", f"{report['boundary_faces']:,}", f"{stages['size field']:.2f}",
        f"{surface:.2f}", f"{report['boundary_faces'] / surface / 1e3:,.0f} k", f"{stages['volume front']:.2f}",
        rate(stages["volume front"]), f"{stages['improve']:.2f}", rate(stages["improve"]), rate(sum(stages.values())),
        f"{report['quality']['beta_mean']:.3f}", f"{report['quality']['beta_min']:.3f}",
        f"{report['peak_memory_bytes'] / tets:.0f}"]) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    args = parser.parse_args()
    head = ["model", "tets", "boundary triangles", "size field s", "surface front s", "triangles/s", "volume front s",
            "tets/s", "improve s", "tets/s", "all stages tets/s", "mean β", "min β", "peak bytes/tet"]
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for model in MODELS:
        for count in COUNTS:
            lines.append(row(model, *measure(args.build, model, count, args.runs)))
            print(lines[-1], flush=True)
    page = pathlib.Path("docs/benchmarks.md")
    text = page.read_text()
    before, after = text.split(MARKS[0])[0], text.split(MARKS[1])[1]
    page.write_text(before + MARKS[0] + "\n" + "\n".join(lines) + "\n" + MARKS[1] + after)


main()
