"""Meshes the clean models and all surfaces derived from them, and writes docs/measured/derived-status.md: is every element as good
as the input lets it be, is every run as fast as its size says?

Usage: bench/run.sh derived [--only SUBSTRING] [--jobs N] [--timeout SECONDS] [--every N] [--automatic]
Each model at automatic size and, without --automatic, with --elements 100000. The Hausdorff distance is measured by
octafront_evaluate, which reads the file back; forced elements are those that the report counts as forced by the input.
"""
import argparse
import concurrent.futures
import pathlib
import statistics

from bench.ours import counter
from bench.pages.origin import written_by
from bench.pages.tables import put, worst, write
from bench.run.status import mesh_and_judge

RUNS = {"automatic": [], "100 k": ["--elements", "100000"]}
POOR, POOR_FREE, LOW_FREE = ("elements below 0.2 or 10 degrees", "elements below 0.2 or 10 degrees, not forced",
                             "not forced")


def figures(model, row):
    report = row["report"]
    work = counter(report, "repair", "triangles") + report["tets"]
    return {
        "model": model.name, "tets": report["tets"], "beta": row["beta_min"], "angle": row["dihedral_min"],
        "poor": counter(report, "improve", POOR), "poor_free": counter(report, "improve", POOR_FREE),
        "low_free": counter(report, "improve", LOW_FREE), "hausdorff": row["hausdorff_percent"],
        "cpu": report["cpu_seconds"], "us": 1e6 * report["cpu_seconds"] / work,
        "left": counter(report, "surface front", "places left as in the input"), "defect": row["defect"]}


def summary(name, made, failed):
    median = statistics.median(r["us"] for r in made)
    slowest = max(made, key=lambda r: r["us"])
    tets, low = sum(r["tets"] for r in made), sum(r["low_free"] for r in made)
    free = [r for r in made if r["poor_free"]]
    beyond = sorted((r for r in made if r["hausdorff"] > 0.5), key=lambda r: -r["hausdorff"])
    farthest = ", ".join(f"{r['model']} {r['hausdorff']:.2f}" for r in beyond[:10])
    return "\n".join([
        f"**{name}**: {len(made) - sum(bool(r['defect']) for r in made)} of {len(made) + len(failed)} valid.",
        f"Elements below β .2 or 10°: {sum(r['poor'] for r in made):.0f} on {sum(r['poor'] > 0 for r in made)} models, of these "
        f"not forced by the input: **{sum(r['poor_free'] for r in free):.0f} on {len(free)}**.",
        f"Below .4 and not forced: {low:.0f} of {tets:,} elements, {1e5 * low / tets:.2f} in 100,000.",
        f"Hausdorff distance above .5 % of the diagonal: {len(beyond)} models{': ' if beyond else ''}{farthest}.",
        f"CPU time per input triangle and element: median {median:.1f} µs, the slowest {slowest['us'] / median:.1f} times that "
        f"({slowest['model']}, {slowest['cpu']:.1f} s).",
        f"Places where the input's own triangles stay: {sum(r['left'] for r in made):.0f} on {sum(r['left'] > 0 for r in made)} models.",
        *(f"Failed: {model}: {why}" for model, why in failed), ""])


HEAD = ["model", "elements", "least β", "least angle °", "below .2 or 10°", "of these not forced", "below .4, not forced", "Hausdorff %", "CPU s"]


def tables_of(name, made):
    """Each model, the worst first."""
    made = sorted(made, key=lambda r: (-r["poor_free"], -r["low_free"] / r["tets"], r["beta"]))
    rows = [[r["model"], f"{r['tets']:,}", f"{r['beta']:.3f}", f"{r['angle']:.1f}", f"{r['poor']:.0f}", f"{r['poor_free']:.0f}", f"{r['low_free']:.0f}",
             f"{r['hausdorff']:.3f}", f"{r['cpu']:.1f}"] for r in made]
    return ["The worst five:", "", *worst(HEAD, rows, "of these not forced", HEAD, most=True, count=5), "", f"Each: {put('derived-' + name.replace(' ', '-'), HEAD, rows)}.", ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--every", type=int, default=1, help="every Nth model, by size")
    parser.add_argument("--automatic", action="store_true", help="automatic sizes only")
    a = parser.parse_args()
    models = sorted([*pathlib.Path("models/clean").iterdir(), *pathlib.Path("models/derived").iterdir()],
                    key=lambda p: (p.stat().st_size, p.name))
    models = [m for m in models if a.only in m.name][::a.every]
    command = "bench/run.sh derived" + (f" --every {a.every}" if a.every > 1 else "") + (" --automatic" if a.automatic else "")
    text = ["# The clean models and what is derived from them", "",
            f"{written_by(command)} over {len(models)} surfaces "
            f"(`bench/models/get-models.sh`, `bench/models/derive-models.sh`), {a.jobs} at a time. *Forced*: `docs/how/sizes-and-surface.md`. The worst ten at automatic sizes, each around its worst element, forced or not "
            "(`bench/pages/pictures.sh`):", "", "![](../images/derived-worst.png)", ""]
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for name, options in list(RUNS.items())[:1 if a.automatic else 2]:
            rows = list(pool.map(lambda m: mesh_and_judge(a.build, m, options, a.timeout, threads=1), models))
            made = [figures(m, r) for m, r in zip(models, rows) if r["status"] == 0]
            failed = [(m.name, r["message"][:200]) for m, r in zip(models, rows) if r["status"] != 0]
            text += [f"## Sizes: {name}", "", summary(name, made, failed).replace("\n", "\n\n"), *tables_of(name, made)]
            print(summary(name, made, failed), flush=True)
            if not a.only:
                write("derived-status", text)


if __name__ == "__main__":
    main()
