"""The volume front against TetGen, Gmsh's HXT and Netgen on the same kept surfaces: writes docs/measured/volume-bench.md.

Usage: bench/run.sh volume [--counts 100000,1000000] [--models bunny00.off,...] [--threads N] [--timeout SECONDS]
                           [--only-threads]

Each model is triangulated anew at uniform sizes, for about the given numbers of tetrahedra; then every mesher fills that
surface and keeps its triangles. Ours runs without improvement on one thread, with the lattice core and without it.
Times are CPU seconds (user and system) of the whole process, files included (ours and HXT's are MSH 4.1), and of filling
alone as each one reports it. octafront_evaluate reads every mesh back and judges it. --only-threads measures wall times on several threads alone,
for which nothing else may run, and prints them.
"""
import argparse
import json
import math
import pathlib
import tempfile
import time

from bench.ours import evaluated, mesh, stage
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import gmsh, netgen, tetgen
from bench.process import run_measured

MODELS = ["bunny00.off", "refined_elephant.off", "fandisk_large.off"]
COUNTS = [100_000, 1_000_000, 4_000_000, 10_000_000]
PEERS_UP_TO = {"TetGen": 5_000_000, "HXT": 5_000_000, "HXT, not optimised": 5_000_000, "Netgen": 150_000}
EVALUATED_UP_TO = 12_000_000


def surface_of_size(build, model, size, out):
    done = run_measured([build / "cli/octafront", "surface", f"models/clean/{model}", "--size", f"{size:.9g}", "-o", out,
                         "-q", "--threads", "0"], ".", 600)
    if done.error:
        raise SystemExit(f"{model}: {done.error}")


def fill_ours(build, surface, folder, timeout, core, threads):
    outcome = mesh(build / "cli/octafront", surface, folder, timeout, "--keep-surface", "--improve", "none", "--core", core, out="ours.msh", threads=threads)
    if outcome.report:
        filled = stage(outcome.report, "volume front")
        outcome.stage_seconds, outcome.stage_wall_seconds = filled["cpu_seconds"], filled["wall_seconds"]
    return outcome


def meshers(build):
    return {
        "octafront, lattice core": lambda s, f, t: fill_ours(build, s, f, t, "lattice", 1),
        "octafront, front alone": lambda s, f, t: fill_ours(build, s, f, t, "none", 1),
        "HXT": lambda s, f, t: gmsh.fill_hxt(s, f, t, optimize=True),
        "HXT, not optimised": lambda s, f, t: gmsh.fill_hxt(s, f, t, optimize=False),
        "TetGen": tetgen.fill,
        "Netgen": netgen.fill,
    }


def measure(build, name, mesher, surface, count, timeout):
    with tempfile.TemporaryDirectory() as folder:
        outcome = mesher(surface, folder, timeout)
        row = {"mesher": name, "outcome": outcome, "error": outcome.error}
        if outcome.mesh:
            quality, why = evaluated(build, outcome.mesh, surface, "--kept")
            row |= {"tets": quality["tets"], "quality": quality, "error": quality["defect"] or ""} if quality else {"error": why}
    return row


def calibrated_sizes(build, model, counts, folder):
    """Edge lengths for the wanted numbers of elements: what one size makes says what the others will."""
    probe, size = pathlib.Path(folder, "probe.off"), None
    sized = run_measured([build / "cli/octafront", "size", f"models/clean/{model}", "--elements", "100000", "--json",
                          pathlib.Path(folder, "size.json"), "-q"], ".", 600)
    if sized.error:
        raise SystemExit(sized.error)
    report = json.loads(pathlib.Path(folder, "size.json").read_text())
    size = (report["input_volume"] / 100_000 * 7.5) ** (1 / 3)
    for _ in range(2):
        surface_of_size(build, model, size, probe)
        filled = fill_ours(build, probe, folder, 600, "lattice", 0)
        tets = filled.report["tets"] if filled.mesh else 100_000
        size *= (tets / 100_000) ** (1 / 3)
    return [size * (100_000 / count) ** (1 / 3) for count in counts]


def rate(tets, seconds):
    return tets / seconds / 1000 if seconds else 0.0


def table_row(model, row):
    o = row["outcome"]
    if row["error"]:
        return [model, row["mesher"], "", f"{o.cpu_seconds:.1f}", *[""] * 8, row["error"]]
    q, n = row["quality"], row["tets"]
    share = lambda k: 100 * q["beta_classes"][k] / n
    return [model, row["mesher"], f"{n:,}", f"{o.cpu_seconds:.2f}", f"{rate(n, o.cpu_seconds):,.0f}", f"{o.stage_seconds or 0:.2f}",
            f"{rate(n, o.stage_seconds):,.0f}", f"{o.peak_bytes / n:.0f}", f"{q['beta_mean']:.3f}", f"{share(4):.1f}", f"{share(0):.3f}",
            f"{q['dihedral_min']:.1f}", ""]


HEAD = ["surface", "mesher", "tets", "process CPU s", "process, k tets/s", "filling CPU s", "filling, k tets/s", "peak bytes/tet", "mean β", "% above .8",
        "% below .2", "min dihedral °", "fault"]
RATIO_HEAD = ["surface", "wanted", "ours", *(f"over {p}{of}" for p in PEERS_UP_TO for of in ("", ", process"))]


def ratios(rows):
    """Our rates of filling over theirs, per surface."""
    made = []
    for (model, count), group in rows.items():
        by_name = {r["mesher"]: r for r in group if not r["error"]}
        of = lambda name, whole: rate(by_name[name]["tets"], by_name[name]["outcome"].cpu_seconds if whole
                                      else by_name[name]["outcome"].stage_seconds)
        for ours in ("octafront, lattice core", "octafront, front alone"):
            if ours not in by_name:
                continue
            made.append([model, f"{count:,}", ours[11:], *(f"{of(ours, whole) / of(p, whole):.1f}" if p in by_name else ""
                                                           for p in PEERS_UP_TO for whole in (False, True))])
    return made


def exponent(points):
    """Slope of log(seconds) over log(tets) by least squares."""
    xy = [(math.log(n), math.log(s)) for n, s in points if n and s]
    if len(xy) < 2:
        return float("nan")
    mx, my = (sum(v[k] for v in xy) / len(xy) for k in (0, 1))
    return sum((x - mx) * (y - my) for x, y in xy) / sum((x - mx) ** 2 for x, _ in xy)


def exponents(rows, models):
    lines = []
    for model in models:
        for name in ("octafront, lattice core", "octafront, front alone", "HXT", "TetGen"):
            runs = [r for (m, _), group in rows.items() if m == model for r in group
                    if r["mesher"] == name and not r["error"]]
            if len(runs) > 2:
                fits = [exponent([(r["tets"], seconds(r["outcome"])) for r in runs])
                        for seconds in (lambda o: o.stage_seconds, lambda o: o.cpu_seconds)]
                lines.append([model, name, f"{fits[0]:.2f}", f"{fits[1]:.2f}"])
    return lines


EXPONENT_HEAD = ["surface", "mesher", "filling", "whole process"]
LADDER_HEAD = ["surface", "wanted", "ours", "faces left", "cavities", "closing CPU s", "% of filling"]


def ladder_costs(rows):
    """What closing the cavities costs that the front leaves."""
    made = []
    for (model, count), group in rows.items():
        for row in group:
            if row["error"] or not row["outcome"].report:
                continue
            counters = stage(row["outcome"].report, "volume front")["counters"]
            seconds = counters.get("closing CPU seconds", 0)
            made.append([model, f"{count:,}", row["mesher"][11:], f"{counters['faces left']:.0f}", f"{counters.get('cavities', 0):.0f}", f"{seconds:.3f}",
                         f"{100 * seconds / row['outcome'].stage_seconds:.1f}"])
    return made


def speed_up(build, surface, core, threads, pairs, timeout):
    """Wall seconds of filling with one thread and with `threads`, in turns; the best of each."""
    best = {1: float("inf"), threads: float("inf")}
    for _ in range(pairs):
        for n in best:
            with tempfile.TemporaryDirectory() as folder:
                outcome = fill_ours(build, surface, folder, timeout, core, n)
            if not outcome.error:
                best[n] = min(best[n], outcome.stage_wall_seconds)
    return best


def thread_rows(build, model, count, surface, threads, timeout):
    rows = []
    for core in ("lattice", "none"):
        best = speed_up(build, surface, core, threads, 2, timeout)
        rows.append([model, f"{count:,}", f"core {core}", f"{best[1]:.2f}", f"{best[threads]:.2f}", f"{best[1] / best[threads]:.2f}"])
        print(tables.row(rows[-1]), flush=True)
    return rows


def thread_head(threads):
    return ["surface", "wanted", "ours", "1 thread, wall s", f"{threads} threads, wall s", "times"]


def threads_alone(args):
    lines = []
    for model in args.models:
        with tempfile.TemporaryDirectory() as folder:
            for count, size in zip(args.counts, calibrated_sizes(args.build, model, args.counts, folder)):
                if 1_000_000 <= count <= 5_000_000:
                    surface = pathlib.Path(folder, f"{count}.off")
                    surface_of_size(args.build, model, size, surface)
                    lines += thread_rows(args.build, model, count, surface, args.threads, args.timeout)
    print("\n".join(tables.table(thread_head(args.threads), lines)))


def shown(found, powers, threads, ladder, every, of_threads=2):
    """Rows of cells."""
    kinds = [[f"{r[2]}, {r[1]}", *r[1:]] for r in found]
    by = ["ours, tetrahedra wanted", *RATIO_HEAD[1:]]
    return ["Rates of filling, and of whole processes, ours over theirs:", "",
            *tables.spread_by(by[0], by, [k for k in kinds if any(k[3:]) and not k[0].startswith("front alone")], [c for c in by[3:] if "not optimised" not in c]), "", f"Median, least and most. Each, and of the front alone: {tables.put('volume-ratios', RATIO_HEAD, found)}.", "",
            f"Exponents of CPU time over elements: {tables.put('volume-exponents', EXPONENT_HEAD, powers)}. Threads, the best wall times in turns: "
            f"{tables.put('volume-threads', thread_head(of_threads), threads)}. The closing ladder, what the cavities cost that the front leaves: at most "
            f"{tables.sorted_cells(LADDER_HEAD, ladder, '% of filling')[-1]} % of filling; each: {tables.put('volume-ladder', LADDER_HEAD, ladder)}.", "",
            "All runs:", "", *tables.spread_by("mesher", HEAD, every, HEAD[4:-1]), "", f"Each: {tables.put('volume-bench', HEAD, every)}."]


ABOUT = """Each model is triangulated anew at uniform sizes, for about the given numbers of tetrahedra; then every mesher fills that surface and keeps its
triangles. Ours runs without improvement on one thread, with the lattice core and without it. Times are CPU seconds of the whole process, files included, and of filling alone as each one reports it. Sizes that
follow curvature: [graded](graded.md)."""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--counts", type=lambda s: [int(c) for c in s.split(",")], default=COUNTS)
    parser.add_argument("--models", type=lambda s: s.split(","), default=MODELS)
    parser.add_argument("--threads", type=int, default=2, help="compared with one")
    parser.add_argument("--timeout", type=float, default=120)
    parser.add_argument("--only-threads", action="store_true")
    args = parser.parse_args()
    args.build = args.build.resolve()
    if args.only_threads:
        return threads_alone(args)
    start, rows, threads = time.time(), {}, []
    every = []
    for model in args.models:
        with tempfile.TemporaryDirectory() as folder:
            for count, size in zip(args.counts, calibrated_sizes(args.build, model, args.counts, folder)):
                surface = pathlib.Path(folder, f"{count}.off")
                surface_of_size(args.build, model, size, surface)
                group = rows[model, count] = []
                for name, mesher in meshers(args.build).items():
                    if count > PEERS_UP_TO.get(name, EVALUATED_UP_TO):
                        continue
                    group.append(measure(args.build, name, mesher, surface, count, args.timeout))
                    every.append(table_row(model, group[-1]))
                    print(tables.row(every[-1]), flush=True)
                if 1_000_000 <= count <= 5_000_000:
                    threads += thread_rows(args.build, model, count, surface, args.threads, args.timeout)
    minutes = (time.time() - start) / 60
    tables.write("volume-bench", [
        "# The volume front against others", "", f"{written_by('bench/run.sh volume')} in {minutes:.0f} minutes. {ABOUT}", "",
        *shown(ratios(rows), exponents(rows, args.models), threads, ladder_costs(rows), every, args.threads)])


if __name__ == "__main__":
    main()
