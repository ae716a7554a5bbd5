"""Surface meshes of every clean model at automatic size and two uniform sizes, side by side with other remeshers.

Usage: bench/run.sh surface [--only SUBSTRING] [--jobs N] [--skip-peers]
Writes docs/measured/surface-status.md. Every surface is judged by
octafront_judge_surface; those of Gmsh, Netgen and CGAL, where they are installed, by the same program.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import subprocess
import tempfile

from bench.pages.origin import ROOT, written_by
from bench.pages.tables import number, put, row, spread_by, table, write
from bench.process import run_measured

SETTINGS = [("automatic", None), ("diagonal / 40", 40), ("diagonal / 100", 100)]
SPEED_MODELS = ["bunny00.off", "elephant.off", "fandisk_large.off", "anchor_dense.off", "armadillo.off", "3torus.off"]
SPEED_TRIANGLES = 500_000
GROWTH_MODELS = ["elephant.off", "3torus.off"]
GROWTH_TRIANGLES = [125_000, 250_000, 500_000, 1_000_000]
PEER_MODELS = ["bunny00.off", "elephant.off", "fandisk_large.off", "anchor_dense.off", "armadillo.off", "3torus.off"]
PEER_DIVISOR = 80
PEER_TIMEOUT = 120
MEAN_TARGET = {"automatic": 0.97}


def judge(build, model, *arguments, timeout=300):
    command = [build / "bench/octafront_judge_surface", model, *map(str, arguments)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        return {"defect": "no end"}
    if done.returncode != 0:
        return {"defect": (done.stderr or f"exit {done.returncode}").strip().splitlines()[0]}
    return json.loads(done.stdout)


def misses(r, name):
    """What a result misses, in words."""
    if r["defect"]:
        return ["DEFECT: " + r["defect"][:70]]
    asked = 0.5 if name == "automatic" else None
    tests = [
        (asked and r["hausdorff_lower_percent"] > asked, "Hausdorff"),
        (r["straight_lines_missing"] > 0, "lines"),
        (not 0.97 <= r["edge_ratio"] <= 1.03, "length"),
        (r["edges_within"] < 0.98, "within"),
        (r["quality_mean"] < MEAN_TARGET.get(name, 0.98), "mean"),
        (r["quality_min_free"] < 0.4, "least"),
    ]
    return [word for is_missed, word in tests if is_missed]


def row_of(file, r, name):
    if r["defect"]:
        return [file, name, " ".join(misses(r, name)), *[""] * 8]
    return [
        file, name, f"{r['triangles']:,}", f"{r['hausdorff_percent']:.3f}", f"{r['edge_ratio']:.3f}",
        f"{100 * r['edges_within']:.1f}", f"{r['quality_mean']:.3f}", f"{r['quality_min_free']:.2f}",
        f"{r['quality_min']:.2f}", f"{r['straight_lines'] - r['straight_lines_missing']} of {r['straight_lines']}",
        ", ".join(misses(r, name)) or "-"]


HEAD = ["model", "size", "triangles", "Hausdorff % of diagonal", "edge length / wanted", "% within .7-1.4", "mean 2r/R",
        "least, not forced", "least of all", "straight lines kept", "missed"]


def summary_row(name, results):
    good = [r for r in results if not r["defect"]]
    missed = {}
    for r in good:
        for word in misses(r, name):
            missed[word] = missed.get(word, 0) + 1
    n = len(results)
    count = lambda word: str(len(good) - missed.get(word, 0))
    return [name, n, len(good), count("lines"), count("Hausdorff") if name == "automatic" else "-", count("length"), count("within"), count("mean"),
            count("least"), f"{sum(r['quality_mean'] for r in good) / max(1, len(good)):.3f}"]


SUMMARY = ["size", "models", "checks passed", "straight lines kept", "Hausdorff ≤ .5 %", "length/wanted .97-1.03",
           "98 % within .7-1.4", "mean 2r/R ≥ .98 (automatic .97)", "least 2r/R ≥ .4 where not forced", "mean of means"]


def all_models(build, rows, pool):
    each, summary = [], []
    for name, divisor in SETTINGS:
        def job(row):
            size = [] if divisor is None else ["--size", float(row["bbox_diagonal"]) / divisor]
            r = judge(build, f"models/clean/{row['file']}", *size)
            print(f"{row['file']:32} {name:16} {', '.join(misses(r, name))}", flush=True)
            return r
        results = list(pool.map(job, rows))
        summary.append(summary_row(name, results))
        each += [row_of(row["file"], r, name) for row, r in zip(rows, results)]
    return summary, each


def quickest(build, file, triangles):
    """The quicker of two runs, and its CPU seconds."""
    runs = [judge(build, f"models/clean/{file}", "--triangles", triangles, "--only", "times") for _ in range(2)]
    seconds = lambda r: r["size_seconds"] + r["front_seconds"]
    best = min(runs, key=seconds)
    return best, seconds(best)


def growth(build, rows):
    """How the time grows with the number of triangles: the exponent of the power law that fits best."""
    made = []
    for file in GROWTH_MODELS:
        if not any(row["file"] == file for row in rows):
            continue
        points, cells = [], []
        for n in GROWTH_TRIANGLES:
            r, seconds = quickest(build, file, n)
            points.append((math.log(r["triangles"]), math.log(seconds)))
            cells.append(f"{seconds:.2f} s")
        mx, my = (sum(p[i] for p in points) / len(points) for i in (0, 1))
        power = sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)
        made.append([file, *cells, f"{power:.2f}"])
        print(row(made[-1]), flush=True)
    return made


SPEED = ["model", "input triangles", "triangles made", "size field CPU s", "surface front CPU s", "triangles per CPU second",
         "share of the size field %"]
GROWTH = ["model", *(f"{n:,}" for n in GROWTH_TRIANGLES), "time grows as triangles to the power"]


def speed(build, rows):
    made = []
    for file in SPEED_MODELS:
        if not any(row["file"] == file for row in rows):
            continue
        r, seconds = quickest(build, file, SPEED_TRIANGLES)
        made.append([file, f"{r['input_triangles']:,}", f"{r['triangles']:,}", f"{r['size_seconds']:.2f}", f"{r['front_seconds']:.2f}",
                     f"{r['triangles'] / seconds / 1000:.0f} k", f"{100 * r['size_seconds'] / seconds:.0f}"])
        print(row(made[-1]), flush=True)
    return made


def cpu_seconds(command, folder):
    """(CPU seconds or None if it failed)"""
    try:
        done = run_measured(command, folder, PEER_TIMEOUT)
    except FileNotFoundError:
        return None
    return None if done.error else done.cpu_seconds


def make_with_gmsh(stl, size, folder, _):
    script = pathlib.Path(folder, "remesh.geo")
    script.write_text(f'Merge "{stl}";\nClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};\nCreateGeometry;\n'
                      f"Surface Loop(1) = Surface{{:}};\nMesh.MeshSizeMin = {size};\nMesh.MeshSizeMax = {size};\n"
                      "Mesh.Binary = 1;\n")
    return cpu_seconds(["gmsh", "-2", "-nt", "1", "-format", "stl", "-o", "gmsh.stl", script], folder), "gmsh.stl"


def make_with_netgen(stl, size, folder, _):
    out = pathlib.Path(folder, "netgen.off")
    return cpu_seconds(["python3", "-m", "bench.peers.netgen_surface", pathlib.Path(folder, "in.off"), out, str(size)], ROOT), out


def make_with_cgal(stl, size, folder, build):
    return cpu_seconds([build / "bench/cgal_remesh", stl, str(size), "cgal.off"], folder), "cgal.off"


def build_cgal(build):
    """The driver of CGAL's remesher, which is under the GPL: built for this comparison only, and only where CGAL is."""
    target = build / "bench/cgal_remesh"
    source = pathlib.Path("bench/peers/cgal_remesh.cpp")
    if target.exists() and target.stat().st_mtime > source.stat().st_mtime:
        return
    subprocess.run(["g++", "-std=c++17", "-O2", "-DNDEBUG", source, "-o", target, "-lgmp", "-lmpfr"])


PEERS = [("Gmsh, classified and remeshed", make_with_gmsh), ("Netgen, STL mesher", make_with_netgen),
         ("CGAL, isotropic remeshing", make_with_cgal)]


PEER_HEAD = ["model", "remesher", "checks", "triangles", "CPU s", "Hausdorff %", "edge length / wanted", "% within .7-1.4", "mean 2r/R", "least 2r/R"]


def peers(build, rows):
    build_cgal(build)
    made_by_all = []

    def add(file, name, r, seconds):
        if "triangles" not in r:
            made_by_all.append([file, name, r["defect"][:80], *[""] * 7])
        else:
            made_by_all.append([
                file, name, (r["defect"] or "passed")[:60], f"{r['triangles']:,}", f"{seconds:.2f}",
                f"{r['hausdorff_percent']:.3f}", f"{r['edge_ratio']:.3f}", f"{100 * r['edges_within']:.1f}",
                f"{r['quality_mean']:.3f}", f"{r['quality_min']:.2f}"])
        print(row(made_by_all[-1]), flush=True)

    for model_row in rows:
        file = model_row["file"]
        if file not in PEER_MODELS:
            continue
        model = pathlib.Path("models/clean", file).resolve()
        size = float(model_row["bbox_diagonal"]) / PEER_DIVISOR
        with tempfile.TemporaryDirectory() as folder:
            r = judge(build, model, "--size", size)
            add(file, "Octafront", r, r.get("size_seconds", 0) + r.get("front_seconds", 0))
            stl = pathlib.Path(folder, "in.stl")
            subprocess.run(["python3", "-m", "bench.peers.to_stl", model, stl, stl.with_suffix(".off")], check=True)
            for name, make in PEERS:
                seconds, made = make(stl, size, folder, build.resolve())
                path = pathlib.Path(folder, made)
                if seconds is None or not path.exists():
                    add(file, name, {"defect": "made nothing: an error, a crash or no end"}, 0)
                else:
                    add(file, name, judge(build, model, "--size", size, "--made", path), seconds)
    return made_by_all


ABOUT = ("*Forced* are triangles with a corner between two feature edges that enclose less than 13°, with a feature edge shorter than .35 of the size, or "
         "between two lines that run side by side nearer than .08 of the size asked for: details finer than the size. Straight lines count from 4 sizes on.")


def page(summary, each, rates, growths, compared):
    """Rows of cells: the lines of the page."""
    speeds = sorted((r[SPEED.index("triangles per CPU second")] for r in rates), key=number)
    lines = ["How many of the models reach each target:", "", *table(SUMMARY, summary), "",
             *spread_by("size", HEAD, each, HEAD[2:8]), "", f"Median, least and most. Each: {put('surface-status', HEAD, each)}.", "",
             f"{SPEED_TRIANGLES:,} triangles, one thread: {speeds[0]} to {speeds[-1]} triangles per CPU second on {len(rates)} models.", "",
             f"From {GROWTH[1]} to {GROWTH[-2]} triangles CPU time grows as triangles to the power {', '.join(f'{r[-1]} ({r[0]})' for r in growths)}."]
    if compared:
        lines += ["", f"{len({r[0] for r in compared})} of the models at diagonal / {PEER_DIVISOR} by others too, one thread, judged by the same program (CPU seconds of "
                  "theirs include reading and writing files):", "", *spread_by("remesher", PEER_HEAD, compared, PEER_HEAD[3:]), "",
                  f"Each: {put('surface-peers', PEER_HEAD, compared)}."]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="", help="models whose name contains this; no page is written")
    parser.add_argument("--jobs", type=int, default=2, help="models at a time")
    parser.add_argument("--skip-peers", action="store_true")
    args = parser.parse_args()
    rows = [r for r in csv.DictReader(open("bench/models/models.csv")) if r["set"] == "clean" and args.only in r["file"]]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        summary, each = all_models(args.build, rows, pool)
    print("\n".join(table(SUMMARY, summary)))
    rates, growths = speed(args.build, rows), growth(args.build, rows)
    compared = [] if args.skip_peers else peers(args.build, rows)
    if not args.only:
        write("surface-status", ["# Surface meshes of all clean models", "",
                                 f"{written_by('bench/run.sh surface')}. {ABOUT}", "", *page(summary, each, rates, growths, compared)])


if __name__ == "__main__":
    main()
