"""Meshes every model of bench/models/models.csv and writes docs/measured/status.md: what works, what does not, and why.

Usage: bench/run.sh status [--only SUBSTRING] [--jobs N] [--timeout SECONDS]
Each mesh is written to a file and judged by octafront_evaluate, which reads it back.
"""
import argparse
import collections
import concurrent.futures
import csv
import pathlib
import tempfile

from bench.ours import evaluated, mesh
from bench.pages.origin import written_by
from bench.pages.tables import put, spread, write

SKULLS = ["skull_119k.off", "skull_204k.off", "skull_534k.off"]  # isosurfaces of CT volumes, only kept
SKULL_TIMEOUT = 1200


def mesh_and_judge(build, model, options, timeout, threads=0):
    with tempfile.TemporaryDirectory() as folder:
        run = mesh(build / "cli/octafront", model, folder, timeout, *options, threads=threads)
        row = {"status": run.status, "message": run.log.strip() if run.status is not None else run.error, "seconds": run.wall_seconds, "report": run.report}
        if run.mesh:
            found, why = evaluated(build, run.mesh, model, *(["--kept"] if "--keep-surface" in options else []), timeout=timeout)
            row |= found or {"defect": why}
        return row


def verdict(row, need_truth):
    if row["status"] is None:
        return "no end"
    if row["status"] != 0:
        return f"exit {row['status']}"
    if row["defect"]:
        return "INVALID"
    if need_truth and (row["hausdorff_percent"] > 0.5 or abs(row["volume_percent"]) > 0.5):
        return "valid, boundary off"
    return "valid"


def first_line(message, limit=110):
    lines = [line for line in message.replace("octafront: ", "").splitlines() if line.strip()]
    text = lines[0] if lines else ""
    if text.startswith("models/"):
        text = text.partition(": ")[2]
    return (text[: limit - 3] + "..." if len(text) > limit else text).replace("|", "/")


def clean_tables(build, rows, timeout, pool):
    def job(row):
        model = pathlib.Path("models/clean", row["file"])
        a = mesh_and_judge(build, model, [], timeout)
        print(f"{row['file']:32} {verdict(a, True):20} {a['seconds']:.1f} s {first_line(a['message'])}", flush=True)
        k = mesh_and_judge(build, model, ["--keep-surface"], timeout)
        print(f"{row['file'] + ' kept':32} {verdict(k, False):20} {k['seconds']:.1f} s {first_line(k['message'])}",
              flush=True)
        return a, k

    results = list(zip(rows, pool.map(job, rows)))
    return [(row, a) for row, (a, _) in results], [(row, k) for row, (_, k) in results]


def skulls(build, only):
    """The kept isosurfaces, one after the other: they are large."""
    pairs = []
    for name in SKULLS:
        file = pathlib.Path("models/ct", name)
        if only not in name or not file.exists():
            continue
        k = mesh_and_judge(build, file, ["--keep-surface"], SKULL_TIMEOUT)
        print(f"{name + ' kept':32} {verdict(k, False):20} {k['seconds']:.1f} s {first_line(k['message'])}", flush=True)
        pairs.append(({"file": name, "faces": str(k.get("boundary_faces", ""))}, k))
    return pairs


HEAD = ["model", "faces", "result", "tets", "mean β", "min β", "min dihedral °", "Hausdorff % of diagonal", "volume %", "s", "MB"]


def cells(row, r, need_truth):
    cells = [row["file"], row["faces"], verdict(r, need_truth)]
    if r["status"] == 0 and not r["defect"]:
        cells += [f"{r['tets']:,}", f"{r['beta_mean']:.3f}", f"{r['beta_min']:.3f}", f"{r['dihedral_min']:.1f}"]
        cells += [f"{r['hausdorff_percent']:.3f}", f"{r['volume_percent']:+.3f}"]
        return cells + [f"{r['seconds']:.1f}", f"{r['report']['peak_memory_bytes'] / 1e6:.0f}"]
    return cells + [first_line(r["message"] or str(r.get("defect")))] + [""] * 5 + [f"{r['seconds']:.1f}", ""]


def rungs(report):
    """How many cavities each rung of the closing ladder closed; counters of the stage that filled the volume."""
    counters = {}
    for stage in report["stages"]:
        counters |= stage["counters"]
    names = ["cavities", "closed by backtracking", "closed by kernel points", "closed by recovery"]
    return [f"{counters.get(name, 0):.0f}" for name in names] + [
        "yes" if counters.get("filled by recovery of the whole surface") else ""]


KEPT_HEAD = ["model", "faces", "result", "tets", "points added", "mean β", "min β", "surface allows β", "β < .1 forced", "beside these", "other",
             "min dihedral °", "surface allows °", "cavities", "by backtracking", "by kernel points", "by recovery", "whole surface recovered", "s", "MB"]


def kept_cells(row, r):
    cells = [row["file"], row["faces"], verdict(r, False)]
    if r["status"] == 0 and not r["defect"]:
        cells += [f"{r['tets']:,}", f"{r['points'] - r['boundary_points']:,}", f"{r['beta_mean']:.3f}"]
        cells += [f"{r['beta_min']:.1e}", f"{r['surface_beta']:.1e}"]
        poor = r["poor"]
        cells += [f"{poor['forced']:,}", f"{poor['beside']:,}", f"{poor['all'] - poor['forced'] - poor['beside']:,}"]
        cells += [f"{r['dihedral_min']:.1f}", f"{r['surface_dihedral']:.1f}", *rungs(r["report"])]
        return cells + [f"{r['seconds']:.1f}", f"{r['report']['peak_memory_bytes'] / 1e6:.0f}"]
    return cells + [first_line(r["message"] or str(r.get("defect")))] + [""] * 14 + [f"{r['seconds']:.1f}", ""]


DIRTY_HEAD = ["model", "known defects", "result", "message"]


def dirty_rows(build, rows, timeout, pool):
    def job(row):
        return mesh_and_judge(build, pathlib.Path("models/dirty", row["file"]), [], timeout)

    made = []
    for row, r in zip(rows, pool.map(job, rows)):
        made.append([row["file"], row["defects"], verdict(r, False), first_line(r["message"], 160)])
        print(f"{row['file']:32} {made[-1][2]:20} {r['seconds']:.1f} s {made[-1][3]}", flush=True)
    return made


def page(auto, kept, dirty):
    """Rows of cells: the lines of the page."""
    valid, good = sum(r[2].startswith("valid") for r in auto), sum(r[2] == "valid" for r in auto)
    counts = collections.Counter(r[2] for r in dirty)
    recovered = sum(r[KEPT_HEAD.index("whole surface recovered")] == "yes" for r in kept)
    return [f"- Automatic size: **{valid} of {len(auto)}** clean models give a valid mesh, {good} of them with both Hausdorff distance and volume "
            "within 0.5 %.",
            f"- `--keep-surface`, raw: **{sum(r[2] == 'valid' for r in kept)} of {len(kept)}** valid, with the input triangles as the boundary, one for "
            f"one; in {recovered} of them all was filled by recovery of the whole surface (docs/how/recovery.md).",
            f"- Dirty models: {', '.join(f'{n} × {v}' for v, n in sorted(counts.items()))}. Exit 3 is a refusal with a message; what repair can mend is "
            "meshed.", "",
            "## Clean models, automatic size", "", *spread(HEAD, auto, HEAD[3:]), "", f"Each: {put('status-automatic', HEAD, auto)}.", "",
            "## Clean models and CT isosurfaces, surface kept", "",
            "What the surface allows: the best β of any element inside on its worst triangle, and its smallest angle inside between two triangles. "
            "Elements below β = .1: on a triangle that allows no better one (*forced*); with an edge of such a triangle, which the same needle makes poor; "
            "others. Then how many cavities the front left, and which rung of the closing ladder closed how many.", "",
            *spread(KEPT_HEAD, kept, [c for c in KEPT_HEAD[3:] if not c.startswith(("whole", "by "))]), "", f"Each: {put('status-kept', KEPT_HEAD, kept)}.", "",
            "## Dirty models", "",
            f"Each, with its known defects and the first line of what was said: {put('status-dirty', DIRTY_HEAD, dirty)} (O open, E non-manifold edge, V "
            "non-manifold vertex, S self-intersection, R misoriented, I inside out, D degenerate, U unused vertices)."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="", help="models whose name contains this; docs/measured/status.md is not written")
    parser.add_argument("--jobs", type=int, default=2, help="models at a time")
    parser.add_argument("--timeout", type=float, default=300, help="seconds per model")
    args = parser.parse_args()
    rows = [r for r in csv.DictReader(open("bench/models/models.csv")) if args.only in r["file"]]
    pool = concurrent.futures.ThreadPoolExecutor(args.jobs)
    auto, kept = clean_tables(args.build, [r for r in rows if r["set"] == "clean"], args.timeout, pool)
    kept += skulls(args.build, args.only)
    dirty = dirty_rows(args.build, [r for r in rows if r["set"] == "dirty"], args.timeout, pool)
    if not args.only:
        write("status", ["# Status over all test models", "",
                         f"{written_by('bench/run.sh status')}. Models: `bench/models/get-models.sh`. Every file is read "
                         "back and judged by `bench/judges/evaluate.cpp`: validity by exact signs, two-sided Hausdorff distance to the input by sampling, volume "
                         "against the enclosed volume of the input.", "",
                         *page([cells(row, r, True) for row, r in auto], [kept_cells(row, r) for row, r in kept], dirty)])


if __name__ == "__main__":
    main()
