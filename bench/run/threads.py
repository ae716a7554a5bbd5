#!/usr/bin/env python3
"""What is serial in each stage, and what that predicts for 2, 16 and 64 threads -> docs/measured/threads.md.

    bench/run/threads.py BUILD [--model FILE] [--elements 1e6,4e6,2e7] [--runs 3] [--page]

One thread does all, and every task of parallel.h is timed (bench/run/forecast.h), so any machine will do. Of several
runs the one of least time counts.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from bench.pages import tables
from bench.pages.origin import ROOT, written_by

STAGES = ["repair", "detail", "features", "size field", "surface front", "volume front", "improve", "check"]
REST = "reading, writing"
THREADS = (2, 16, 64)
KEYS = ("seconds", "serial seconds", "regions", *(f"seconds with {n} threads" for n in THREADS))


def run(program, model, elements):
    """The forecast of each stage, of the rest, and of the process."""
    with tempfile.TemporaryDirectory() as folder:
        told = json.loads(subprocess.run([program, model, f"{elements:.0f}", pathlib.Path(folder, "mesh.vtu")], check=True,
                                         capture_output=True, text=True).stdout)
    stages, whole = {}, told["whole"]
    for named, found in told["stages"]:  # several tries for a number of elements belong to one stage
        name = next((s for s in STAGES if named.startswith(s)), named)
        stages[name] = {key: stages.get(name, {}).get(key, 0) + found[key] for key in KEYS}
    stages[REST] = {key: whole[key] - sum(s[key] for s in stages.values()) for key in KEYS}
    return {**told, "stages": stages}


def row(name, of_stage, whole):
    seconds = of_stage["seconds"]
    speedups = (f"{seconds / of_stage[f'seconds with {n} threads']:.2f}" for n in THREADS)
    return [name, f"{seconds:.2f}", f"{of_stage['serial seconds']:.3f}", f"{100 * of_stage['serial seconds'] / seconds:.1f}",
            f"{100 * of_stage['serial seconds'] / whole['seconds']:.1f}", f"{of_stage['regions']:,.0f}", *speedups,
            f"{of_stage[f'seconds with {THREADS[-1]} threads']:.3f}"]


HEAD = ["stage", "CPU s", "serial s", "of the stage, %", "of the process, %", "regions", *(f"times as fast: {n} threads" for n in THREADS), f"s with {THREADS[-1]}"]


def rows(told):
    whole = told["whole"]
    stages = [row(name, of_stage, whole) for name, of_stage in told["stages"].items() if of_stage["seconds"] > 0.001 * whole["seconds"]]
    return tables.table(HEAD, [*stages, row("**process**", whole, whole)])


def page(told, model, args):
    """Whole processes, and the stages of the middle one; all rows are in a file beside."""
    text = (ROOT / "bench/pages/threads.md.in").read_text()
    of_process = [[f"{one['tets']:,}", *row("", one["whole"], one["whole"])[1:]] for one in told]
    all_rows = [[one["tets"], *row(name, of_stage, one["whole"])] for one in told for name, of_stage in one["stages"].items()]
    shown = told[len(told) // 2]
    lines = [*tables.table(["elements", *HEAD[1:]], of_process), "", f"{shown['tets']:,} elements:", "", *rows(shown), "",
             f"All stages: {tables.put('threads', ['elements', *HEAD], all_rows)}."]
    said = f"{written_by(args)}: {model} from its file, `--elements`, on one thread."
    return text.replace("@SAID@", said).replace("@TABLES@", "\n".join(lines).rstrip())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--model", default="models/clean/bunny00.off")
    parser.add_argument("--elements", default="1e6,4e6,2e7")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    told = []
    for elements in map(float, a.elements.split(",")):
        runs = [run(a.build / "bench/octafront_threads", a.model, elements) for _ in range(a.runs)]
        assert len({r["hash"] for r in runs}) == 1, runs
        told.append(min(runs, key=lambda r: r["whole"]["seconds"]))
        print("\n".join([f"{told[-1]['tets']:,} elements, hash {told[-1]['hash']}", *rows(told[-1]), ""]), flush=True)
    if a.page:
        tables.write("threads", [page(told, pathlib.Path(a.model).name, "bench/run.sh threads --page")])


if __name__ == "__main__":
    main()
