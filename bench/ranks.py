#!/usr/bin/env python3
"""Several processes make one mesh: memory of each, bytes, who waits, what all do alike -> docs/measured/ranks.md.

    bench/ranks.py BUILD [--model FILE] [--elements 2e6] [--ranks 1,2,4,8] [--page]
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

from origin import ROOT, written_by

STAGES = ["size field", "surface front", "volume front", "improve", "check"]
LAUNCH = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
if os.geteuid() == 0:
    LAUNCH.append("--allow-run-as-root")


def run(octafront, model, elements, ranks, folder):
    report = folder / "report.json"
    launch = [*LAUNCH, "-n", str(ranks)] if ranks > 1 else []
    subprocess.run([*launch, octafront, "mesh", model, "-o", folder / "mesh.vtu", "--elements", str(elements), "--threads", "1",
                    "--json", report, "-q"], check=True, capture_output=True)
    return json.loads(report.read_text())


def of_stage(told, name, key):
    """Per rank; tries that were not kept count too."""
    return [sum(s[key] for s in row["stages"] if s["name"].startswith(name)) for row in told["ranks"]]


def wall(told, name):
    return sum(s["wall_seconds"] for s in told["stages"] if s["name"].startswith(name))


def row_of_run(told, ranks):
    rows = told.get("ranks", [])
    memory = [row["peak_memory_bytes"] for row in rows] or [told["peak_memory_bytes"]]
    taken = max((row["bytes_taken"] for row in rows), default=0)
    return (f"| {ranks} | {told['tets']:,} | `{told['hash']}` | {min(memory) / 1e9:.2f} to {max(memory) / 1e9:.2f} | "
            f"{max(memory) / told['tets']:.0f} | {taken / 1e6:.1f} | {taken / told['tets']:.1f} | "
            f"{max((row['rounds_of_talk'] for row in rows), default=0):.0f} | {told['wall_seconds']:.1f} |")


def rows_of_stages(told, ranks):
    for name in STAGES:
        shared, talking = of_stage(told, name, "shared_seconds"), of_stage(told, name, "talking_seconds")
        mean = sum(shared) / len(shared)
        seconds = wall(told, name)
        yield (f"| {ranks} | {name} | {max(of_stage(told, name, 'bytes_taken')) / 1e6:.2f} | "
               f"{max(shared) / mean if mean else 1:.2f} | {mean:.2f} | {sum(talking) / len(talking):.2f} | {seconds:.2f} |")


def seconds_alone(alone):
    """CPU seconds of one process: of all stages, and of what ranks share."""
    counters = {key: value for stage in alone["stages"] for key, value in stage["counters"].items()}
    return alone["cpu_seconds"], sum(counters[f"{what} CPU seconds"] for what in ("core", "advance", "pieces"))


def page(told, model, elements, args):
    alone = told[min(told)]
    whole, shared = seconds_alone(alone)
    serial = 1 - shared / whole
    lines = ["# Ranks: one mesh by several processes", "",
             f"{written_by(args)}: {model}, {elements:,.0f} elements asked for, one thread a process, all on one machine, so "
             "wall times say only who waits: cores are fewer, and others may work beside. How it is used: [ranks](../use/ranks.md).", "",
             "| ranks | elements | hash | peak memory of a rank, GB | B/element | MB taken by a rank | B/element | rounds of talk | s |",
             "| --: | --: | --- | --: | --: | --: | --: | --: | --: |",
             *(row_of_run(told[n], n) for n in sorted(told)), "",
             "Memory does not fall as the number of ranks grows: but for the tetrahedra of the front until it is done, every rank "
             "holds the whole mesh.", "",
             "Of each stage: bytes that a rank takes; the longest share over the mean one; the mean time in shared work and in talk, "
             "waiting included; the whole.", "",
             "| ranks | stage | MB taken | imbalance | s shared | s talk | s |", "| --: | --- | --: | --: | --: | --: | --: |",
             *(row for n in sorted(told) if n > 1 for row in rows_of_stages(told[n], n)), "",
             f"Of the {whole:.1f} CPU seconds of a process alone, lattice, front and pieces of improvement, which ranks share, take "
             f"{shared:.1f}: {100 * serial:.0f} % are done by every rank. Without any cost of talk, that bounds what ranks gain (Amdahl):", "",
             "| ranks | times as fast, at most |", "| --: | --: |",
             *(f"| {p:,} | {1 / (serial + (1 - serial) / p):.2f} |" for p in (2, 4, 16, 64, 1024)), ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--model", default="samples/bracket.stl")
    parser.add_argument("--elements", type=float, default=2e6)
    parser.add_argument("--ranks", default="1,2,4,8")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    told = {}
    with tempfile.TemporaryDirectory() as folder:
        for ranks in map(int, a.ranks.split(",")):
            told[ranks] = run(a.build / "cli/octafront", a.model, a.elements, ranks, pathlib.Path(folder))
            print(row_of_run(told[ranks], ranks), flush=True)
    hashes = {t["hash"] for t in told.values()}
    text = page(told, pathlib.Path(a.model).name, a.elements, "bench/run.sh ranks")
    print(text)
    if a.page:
        (ROOT / "docs/measured/ranks.md").write_text(text)
    assert len(hashes) == 1, hashes


if __name__ == "__main__":
    main()
