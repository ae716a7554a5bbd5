#!/usr/bin/env python3
"""Several processes make one mesh: memory of each, bytes, who waits, what all do alike -> docs/measured/ranks.md.

    bench/run/ranks.py BUILD [--model FILE] [--elements 1e6] [--larger 1e7] [--ranks 1,2,4,8] [--page]

--larger: a process alone also makes so many, and 4 ranks do: what grows how, for the prediction of many ranks.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile

from bench.ours import stages
from bench.pages import tables
from bench.pages.origin import written_by

RANKS_OF_LARGER = 4
STAGES = ["size field", "surface front", "volume front", "improve", "check"]
LAUNCH = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
if os.geteuid() == 0:
    LAUNCH.append("--allow-run-as-root")


def run(octafront, model, elements, ranks, folder):
    report = folder / "report.json"
    launch = [*LAUNCH, "-n", str(ranks)] if ranks > 1 else []
    subprocess.run([*launch, octafront, "mesh", model, "-o", folder / "mesh.pvtu", "--elements", str(elements), "--threads", "1",
                    "--json", report, "-q"], check=True, capture_output=True)
    return json.loads(report.read_text())


def of_stage(told, name, key):
    """Per rank; tries that were not kept count too."""
    return [sum(s[key] for s in stages(row, name)) for row in told["ranks"]]


def wall(told, name):
    return sum(s["wall_seconds"] for s in stages(told, name))


def row_of_run(told, ranks):
    rows = told.get("ranks", [])
    memory = [row["peak_memory_bytes"] for row in rows] or [told["peak_memory_bytes"]]
    taken = max((row["bytes_taken"] for row in rows), default=0)
    return [ranks, f"{told['tets']:,}", told["hash"], f"{min(memory) / 1e9:.2f}", f"{max(memory) / 1e9:.2f}", f"{max(memory) / told['tets']:.0f}",
            f"{taken / 1e6:.1f}", f"{taken / told['tets']:.1f}", f"{max((row['rounds_of_talk'] for row in rows), default=0):.0f}", f"{told['wall_seconds']:.1f}"]


HEAD = ["ranks", "elements", "hash", "least peak memory of a rank, GB", "peak memory of a rank, GB", "B/element", "MB taken by a rank", "taken, B/element", "rounds of talk", "s"]
STAGE_HEAD = ["ranks", "stage", "MB taken", "imbalance", "s shared", "s talk", "s"]


def rows_of_stages(told, ranks):
    for name in STAGES:
        shared, talking = of_stage(told, name, "shared_seconds"), of_stage(told, name, "talking_seconds")
        mean = sum(shared) / len(shared)
        seconds = wall(told, name)
        yield [ranks, name, f"{max(of_stage(told, name, 'bytes_taken')) / 1e6:.2f}", f"{max(shared) / mean if mean else 1:.2f}", f"{mean:.2f}",
               f"{sum(talking) / len(talking):.2f}", f"{seconds:.2f}"]


def seconds_alone(alone):
    """CPU seconds of one process: of all stages, and of what ranks share."""
    return alone["cpu_seconds"], sum(seconds for (_, shared), seconds in parts_of(alone).items() if shared)


# What ranks share of a stage, by the counters of its CPU seconds; None: all of it.
SHARED = {"volume front": ("core", "advance"), "improve": ("pieces",), "check": None}
# Assumed for the prediction: of a network of 10 Gbit/s.
BYTES_PER_SECOND = 1e9


def parts_of(alone):
    """{(stage, whether ranks share it): CPU seconds} of a process alone."""
    parts = {}
    for stage in alone["stages"]:
        name = next((n for n in STAGES if stage["name"].startswith(n)), "rest")
        of_stage = SHARED.get(name, ())
        shared = stage["cpu_seconds"] if of_stage is None else sum(stage["counters"].get(f"{what} CPU seconds", 0) for what in of_stage)
        for kind, seconds in ((True, shared), (False, max(0, stage["cpu_seconds"] - shared))):
            parts[name, kind] = parts.get((name, kind), 0) + seconds
    return parts


def grown(small, large, ratio, times):
    """A figure measured at two sizes, `ratio` apart, of one that is `times` the larger."""
    return large * times ** (math.log(large / small) / math.log(ratio)) if small > 0 and large > 0 else large


def bytes_taken(told):
    return max(row["bytes_taken"] for row in told["ranks"]) / told["tets"]


def memory_of(told):
    """Bytes an element, of the rank that has most."""
    rows = told.get("ranks", []) or [told]
    return max(row["peak_memory_bytes"] for row in rows) / told["tets"]


class Model:
    """One core a rank. Each part of each stage grows as between two runs of a process alone; what is shared is divided,
    the slowest of the ranks has `imbalance` times the mean, and each rank takes the same bytes an element."""

    def __init__(self, small, large, by_ranks, many, ranks):
        self.small, self.large, self.ratio = small, large, large["tets"] / small["tets"]
        self.bytes = bytes_taken(many) / (1 - 1 / ranks)
        by_stage = [of_stage(many, name, "shared_seconds") for name in STAGES]
        self.imbalance = sum(map(max, by_stage)) * ranks / sum(map(sum, by_stage))
        alone, each, parts = memory_of(large), memory_of(by_ranks), RANKS_OF_LARGER
        self.held_by_all = min(alone, max(0, (parts * each - alone) / (parts - 1)))
        self.held_in_shares = alone - self.held_by_all

    def seconds(self, elements):
        """What every rank does, what ranks share."""
        small, large, sums = parts_of(self.small), parts_of(self.large), [0, 0]
        for (name, shared), seconds in large.items():
            sums[shared] += grown(small.get((name, shared), 0), seconds, self.ratio, elements / self.large["tets"])
        return sums

    def memory(self, elements, ranks):
        return elements * (self.held_by_all + self.held_in_shares / ranks)

    def wall(self, elements, ranks):
        alike, shared = self.seconds(elements)
        return alike + shared * self.imbalance / ranks + elements * self.bytes * (1 - 1 / ranks) / BYTES_PER_SECOND


def rows_of_prediction(model):
    for elements in (1e8, 1e9, 1e10):
        alike, shared = model.seconds(elements)
        cells = [f"{model.wall(elements, p):,.0f} s, {(alike + shared) / model.wall(elements, p):.1f} times; "
                 f"{float(f'{model.memory(elements, p) / 1e9:.2g}'):,g} GB" for p in (16, 64, 1024)]
        yield [f"{elements / 1e6:,.0f} M", f"{alike + shared:,.0f}", f"{alike:,.0f}", f"{elements * model.bytes / 1e9:,.1f}", *cells]


def prediction(told, larger, by):
    small, large, larger_ranks, most = told[min(told)], larger[1], larger[by], max(told)
    model = Model(small, large, larger_ranks, told[most], most)
    million = large["tets"] / 1e6
    in_parts = [parts_of(t) for t in (small, large)]

    def both(name, shared):
        a, b = (parts.get((name, shared), 0) for parts in in_parts)
        return f"{a:.2f}, {b:.2f}" if b >= 0.005 else "-"

    return ["## What many ranks would gain", "",
            f"From the runs above, and {million:.1f} M elements by a process alone and by {by} ranks. CPU seconds of a process alone, at "
            f"{small['tets'] / 1e6:.1f} M and {million:.1f} M elements:", "",
            *tables.table(["stage", "every rank does, s", "ranks share, s"], [[name, both(name, False), both(name, True)] for name in STAGES]), "",
            f"Memory is {memory_of(small):.0f} and {memory_of(large):.0f} bytes an element, with {by} ranks {memory_of(larger_ranks):.0f} on each: so "
            f"{model.held_by_all:.0f} of them are on every rank, and {model.held_in_shares:.0f} are shared. A rank of {by} takes "
            f"{bytes_taken(told[by]):.1f} and {bytes_taken(larger_ranks):.1f}, hashes are one: `{large['hash']}`.", "",
            "The model: one core a rank; each figure of the table grows on as between its two sizes; what is shared is divided by the ranks, of whom the "
            f"slowest has {model.imbalance:.2f} times the mean, as with {most} of them; each takes {model.bytes:.0f} bytes an element times (1 - 1/ranks), by an "
            "assumed 1 GB/s; memory is what is on every rank at the larger size, and the share of the rest, bytes an element. Rounds of talk cost nothing beside that: there are "
            f"{max(row['rounds_of_talk'] for row in larger_ranks['ranks']):.0f}.", "",
            "Measured elsewhere, of another model and by one process: 100 M elements in 428 CPU seconds with writing the file, 62 bytes an element "
            "([graded](graded.md)).", "",
            *tables.table(["elements", "one core, s", "of that every rank does, s", "GB taken by each", "16 ranks", "64 ranks", "1,024 ranks"],
                          rows_of_prediction(model)), "",
            "So what is on every rank decides, twice. In time: sizes, surface and the division into pieces are done by every rank, and vertices that moved come to "
            "every rank. In memory: all vertices, the surface and the octree of sizes have to fit on one machine. Numbers of elements "
            "end at 536,870,912 today: the lower two rows are what it would take.", ""]


def shown(runs, stages):
    """Rows of cells: of all runs; of each stage of those with the first number of elements."""
    columns = [c for c in HEAD if c not in ("hash", "least peak memory of a rank, GB")]
    return [*tables.some(HEAD, [r for r in runs if str(r[0]) != "4"], columns), "", f"Hashes of those of one number of elements are one, 4 ranks too: {tables.put('ranks', HEAD, runs)}.", "",
            f"Of each stage, with 2 ranks and more: {tables.put('ranks-stages', STAGE_HEAD, stages)}."]


def page(told, larger, model, elements, args):
    alone = told[min(told)]
    whole, shared = seconds_alone(alone)
    serial = 1 - shared / whole
    lines = ["# Ranks: one mesh by several processes", "",
             f"{written_by(args)}: {model}, {elements:,.0f} elements asked for, one thread a process, all on one machine, so "
             "wall times say only who waits: cores are fewer, and others may work beside. How it is used: [ranks](../use/ranks.md).", "",
             *shown([row_of_run(runs[n], n) for runs in (told, larger) for n in sorted(runs)],
                    [row for n in sorted(told) if n > 1 for row in rows_of_stages(told[n], n)]), "",
             f"Of the {whole:.1f} CPU seconds of a process alone, lattice, front, pieces of improvement and check, which ranks share, take "
             f"{shared:.1f}: {100 * serial:.0f} % are done by every rank. Without any cost of talk, ranks are at most so many times as fast (Amdahl): "
             + ", ".join(f"{p:,} ranks {1 / (serial + (1 - serial) / p):.2f}" for p in (2, 4, 16, 64, 1024)) + ".", ""]
    if larger:
        lines += prediction(told, larger, RANKS_OF_LARGER)
    return lines


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--model", default="samples/bracket.stl")
    parser.add_argument("--elements", type=float, default=1e6)
    parser.add_argument("--larger", type=float, default=0)
    parser.add_argument("--ranks", default="1,2,4,8")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    told = {}
    with tempfile.TemporaryDirectory() as folder:
        for ranks in map(int, a.ranks.split(",")):
            told[ranks] = run(a.build / "cli/octafront", a.model, a.elements, ranks, pathlib.Path(folder))
            print(tables.row(row_of_run(told[ranks], ranks)), flush=True)
        larger = {}
        for ranks in told if a.larger else []:
            larger[ranks] = run(a.build / "cli/octafront", a.model, a.larger, ranks, pathlib.Path(folder))
            print(tables.row(row_of_run(larger[ranks], ranks)), flush=True)
        assert len({t["hash"] for t in larger.values()}) < 2
    hashes = {t["hash"] for t in told.values()}
    if a.page:
        tables.write("ranks", page(told, larger, pathlib.Path(a.model).name, a.elements, "bench/run.sh ranks"))
    assert len(hashes) == 1, hashes


if __name__ == "__main__":
    main()
