"""Boundary layers on every clean model: are they there, is the mesh valid, at what cost?

Usage: bench/run.sh layers [--only SUBSTRING] [--timeout SECONDS] [--program OCTAFRONT] [--again]
Meshes the clean models of models/clean with 3 and 8 layers whose first one is a tenth and a fiftieth of the local edge length, by
default sizes, and has `octafront check` look at each mesh. Keeps each result in BUILD/layers.json as soon as it is there (--again: does it anew);
writes docs/measured/layers.md.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

from bench import ours
from bench.pages.origin import written_by
from bench.pages.tables import MEASURED, put, rewrite, table
from bench.process import run_bounded

ROOT = pathlib.Path(__file__).resolve().parents[2]

CASES = [(3, 0.1), (8, 0.1), (3, 0.02), (8, 0.02)]
GROWTH = 1.2
HEAD = ["layers x first height", "total", "valid", "full, %: mean", "median", "worst", "none, %", "SJ, median", "SJ, worst", "angles inside, median",
        "angles inside, worst", "β inside", "k prisms/CPU s"]
WORST_HEAD = ["model", "layers", "full, %", "stopped by"]


def name_of(case):
    return f"{case[0]} x 1/{round(1 / case[1])}"


def measure(program, model, case, timeout):
    layers, part = case
    with tempfile.TemporaryDirectory() as folder:
        mesh, report = pathlib.Path(folder, "out.vtu"), pathlib.Path(folder, "out.json")
        status, said, cpu, memory = run_bounded([program, "mesh", model, "--layers", str(layers), "--first-part", str(part), "-q",
                                         "--threads", "1", "-o", mesh, "--json", report], timeout)
        row = {"status": status, "said": said.splitlines()[-1] if said else "", "cpu": cpu, "memory": memory}
        if status != 0:
            return row
        made = json.loads(report.read_text())
        checked = subprocess.run([program, "check", mesh], capture_output=True, text=True)
        stage = ours.stage(made, "boundary layers")
        return row | {"valid": checked.returncode == 0, "tets": made["tets"], "layers": made["layers"],
                      "stage": stage["cpu_seconds"], "rounds": dict(stage["counters"]).get("rounds")
                      if isinstance(stage["counters"], dict) else None, "regions": made["regions"]}


def faces_weighted(row, key):
    faces = sum(w["faces"] for w in row["layers"])
    return sum(w["faces"] * w[key] for w in row["layers"]) / faces


def least_jacobian(row):
    return min(w["least_scaled_jacobian"] for w in row["layers"])


def prisms(row):
    return sum(w["faces"] * w["mean_layers"] for w in row["layers"])


def line(case, rows):
    done = [r for r in rows if r["status"] == 0]
    full = [100 * faces_weighted(r, "share_full") for r in done]
    none = [100 * (1 - faces_weighted(r, "share_with_some")) for r in done]
    inside = [next(q["quality"] for q in r["regions"] if q["name"] != "layers") for r in done]
    speed = sum(map(prisms, done)) / sum(r["stage"] for r in done)
    return [name_of(case), f"{total_over_size(case):.2f}", f"{sum(r['valid'] for r in done)} of {len(rows)}", f"{statistics.mean(full):.1f}",
            f"{statistics.median(full):.1f}", f"{min(full):.1f}", f"{statistics.mean(none):.2f}", f"{statistics.median(map(least_jacobian, done)):.3f}",
            f"{min(map(least_jacobian, done)):.3f}", f"{statistics.median(q['dihedral_min_degrees'] for q in inside):.1f}",
            f"{min(q['dihedral_min_degrees'] for q in inside):.1f}", f"{statistics.median(q['beta_mean'] for q in inside):.3f}", f"{speed / 1000:,.0f}"]


def total_over_size(case):
    return case[1] * (GROWTH ** case[0] - 1) / (GROWTH - 1)


def each(results):
    rows = []
    for key, row in results.items():
        model, case = key.split("|")
        if row["status"] != 0:
            rows.append((-1, [model, case, f"status {row['status']}", row["said"]]))
            continue
        full = 100 * faces_weighted(row, "share_full")
        stopped = {}
        for wall in row["layers"]:
            for why, part in wall["stopped"].items():
                stopped[why] = stopped.get(why, 0) + 100 * part * wall["faces"]
        faces = sum(w["faces"] for w in row["layers"])
        words = ", ".join(f"{why} {part / faces:.1f} %" for why, part in sorted(stopped.items(), key=lambda s: -s[1]))
        rows.append((full, [model, case, f"{full:.1f}", words]))
    return [cells for _, cells in sorted(rows)]


def shown(sums, rows):
    """Rows of cells."""
    return [*table(HEAD, sums), "", f"Each: {put('layers', WORST_HEAD, rows)}."]


def lines_of(results):
    by_case = {name_of(c): [r for key, r in results.items() if key.endswith("|" + name_of(c))] for c in CASES}
    return [f"{written_by('bench/run.sh layers')}.", "",
            f"{len({k.split('|')[0] for k in results})} clean models, by default sizes, layers on the whole surface: `--layers N --first-part P`, growth "
            f"{GROWTH:g}, one thread. *Total*: height of all layers over the edge length at the wall. *Full*: faces that have all layers, as high as asked, at "
            "their three corners. *None*: faces with a corner without any. *SJ*: least scaled Jacobian of whole prisms over all layers. *Inside*: what lies "
            "between the layers.", "", *shown([line(c, by_case[name_of(c)]) for c in CASES if by_case[name_of(c)]], each(results))]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--timeout", type=float, default=120)
    arguments.add_argument("--program", type=pathlib.Path)
    arguments.add_argument("--again", action="store_true")
    a = arguments.parse_args()
    kept = a.build / "layers.json"
    results = json.loads(kept.read_text()) if kept.exists() and not a.again else {}
    for model in sorted((ROOT / "models/clean").iterdir()):
        if a.only not in model.name:
            continue
        for case in CASES:
            key = f"{model.name}|{name_of(case)}"
            if key in results:
                continue
            results[key] = measure(a.program or a.build / "cli/octafront", model, case, a.timeout)
            kept.write_text(json.dumps(results))
            row = results[key]
            print(key, row["status"], f"{row['cpu']:.1f} s", *([f"{100 * faces_weighted(row, 'share_full'):.1f} %", row["valid"]] if row["status"] == 0 else
                  [row["said"]]), flush=True)
    if not a.only:
        rewrite(MEASURED / "layers.md", "clean models", lines_of(results))


if __name__ == "__main__":
    main()
