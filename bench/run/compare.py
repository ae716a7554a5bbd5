"""Meshes surfaces with several methods at several numbers of elements: table, CSV, JSON and, with matplotlib, charts.

Usage: compare.py OCTAFRONT SURFACE... -o FOLDER [--methods octree-aft,aft,octree] [--elements N,N...] [OPTION OF mesh...]
Writes compare.csv, compare.json, and beta_classes, time_elements, stages as .png and .svg. A method that makes no mesh is a row with its message.
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import tempfile

COLOURS = {"octree-aft": "#0072b2", "aft": "#d55e00", "octree": "#009e73"}
CLASSES = ["0 - 0.2", "0.2 - 0.4", "0.4 - 0.6", "0.6 - 0.8", "0.8 - 1"]
COLUMNS = ["model", "faces", "method", "elements_wanted", "elements", "points", "boundary_faces", "filling_cpu_s", "total_cpu_s", "beta_mean",
           "beta_min", "beta_below_0.2", "beta_0.2_0.4", "beta_0.4_0.6", "beta_0.6_0.8", "beta_from_0.8", "dihedral_min_degrees",
           "dihedral_max_degrees", "volume_over_input", "failure"]


def last_try(report):
    return [s for s in report["stages"] if not s["name"].endswith("(earlier try)")]


def run(octafront, surface, method, elements, options):
    with tempfile.TemporaryDirectory() as folder:
        found, size = pathlib.Path(folder, "report.json"), ["--elements", str(elements)] if elements else []
        faces = json.loads(subprocess.run([octafront, "info", surface, "--json", "-"], capture_output=True, text=True).stdout or "{}").get("triangles", 0)
        done = subprocess.run([octafront, "mesh", surface, "-o", f"{folder}/out.mesh", "--method", method, "-q", "--json", found, *size, *options],
                              capture_output=True, text=True)
        row = {"model": pathlib.Path(surface).stem, "faces": faces, "method": method, "elements_wanted": elements}
        if done.returncode != 0:
            return {**row, "failure": (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[0]}
        report = json.loads(found.read_text())
    filling = sum(s["cpu_seconds"] for s in report["stages"] if s["name"] in ("volume front", "stuffing"))
    total = sum(s["cpu_seconds"] for s in last_try(report))
    return {**row, "failure": "", "filling_cpu_seconds": filling, "total_cpu_seconds": total, "report": report}


def columns_of(row):
    if row["failure"]:
        return [row[c] for c in COLUMNS[:4]] + [""] * 15 + [row["failure"]]
    r, q = row["report"], row["report"]["quality"]
    return [*(row[c] for c in COLUMNS[:4]), r["tets"], r["points"], r["boundary_faces"], f"{row['filling_cpu_seconds']:.6g}",
            f"{row['total_cpu_seconds']:.6g}", f"{q['beta_mean']:.6g}", f"{q['beta_min']:.6g}", *q["beta_classes"], f"{q['dihedral_min_degrees']:.6g}",
            f"{q['dihedral_max_degrees']:.6g}", f"{r['volume'] / r['input_volume']:.8g}", ""]


def exponent_of(times):
    """Of seconds ~ elements^exponent, by least squares of the logarithms; None of too few."""
    points = [(math.log(n), math.log(s)) for n, s in times if n > 0 and s > 0]
    mean_x, mean_y = (sum(p[k] for p in points) / max(len(points), 1) for k in (0, 1))
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread > 0 else None


def totals(rows):
    found = {}
    for method in dict.fromkeys(row["method"] for row in rows):
        made = [row for row in rows if row["method"] == method and not row["failure"]]
        elements = sum(row["report"]["tets"] for row in made)
        classes = [sum(row["report"]["quality"]["beta_classes"][k] for row in made) for k in range(5)]
        found[method] = {"meshes": len(made), "failures": sum(row["method"] == method for row in rows) - len(made), "elements": elements,
                         "filling_cpu_seconds": sum(row["filling_cpu_seconds"] for row in made),
                         "beta_percent": [100 * c / max(elements, 1) for c in classes],
                         "exponent": exponent_of([(row["report"]["tets"], row["filling_cpu_seconds"]) for row in made])}
    return found


def draw(folder, rows, methods):
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot

    def finish(name, title, x, y):
        pyplot.title(title), pyplot.xlabel(x), pyplot.ylabel(y), pyplot.legend()
        for ending in ("png", "svg"):
            pyplot.savefig(folder / f"{name}.{ending}")
        pyplot.close()
    for m, (method, total) in enumerate(methods.items()):
        pyplot.bar([k + m / (len(methods) + 1) for k in range(5)], total["beta_percent"], 1 / (len(methods) + 1), color=COLOURS[method], label=method)
    pyplot.xticks(range(5), CLASSES)
    finish("beta_classes", "Elements by quality beta = 3 r / R, all models together", "beta", "% of elements")
    made = [row for row in rows if not row["failure"]]
    for method, total in methods.items():
        law = f", time ~ elements^{total['exponent']:.2f}" if total["exponent"] else ""
        points = [(row["report"]["tets"], row["filling_cpu_seconds"]) for row in made if row["method"] == method]
        pyplot.loglog(*zip(*points) if points else ([], []), "o", color=COLOURS[method], label=method + law)
    finish("time_elements", "Time to fill the volume", "elements", "CPU seconds")
    below = [0.0] * len(methods)
    for stage in dict.fromkeys(s["name"] for row in made for s in last_try(row["report"])):
        seconds = [sum(s["cpu_seconds"] for row in made if row["method"] == m for s in row["report"]["stages"] if s["name"] == stage)
                   * 1e6 / max(total["elements"], 1) for m, total in methods.items()]
        pyplot.bar(list(methods), seconds, bottom=below, label=stage)
        below = [a + b for a, b in zip(below, seconds)]
    finish("stages", "CPU time of the stages per million elements", "", "seconds")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("octafront")
    parser.add_argument("surfaces", nargs="+")
    parser.add_argument("-o", dest="folder", type=pathlib.Path, required=True)
    parser.add_argument("--methods", default="octree-aft,aft,octree")
    parser.add_argument("--elements", default="0")
    arguments, options = parser.parse_known_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for surface in arguments.surfaces:
        for elements in map(int, arguments.elements.split(",")):
            for method in arguments.methods.split(","):
                rows.append(run(arguments.octafront, surface, method, elements, options))
                print(dict(zip(COLUMNS, columns_of(rows[-1]))), flush=True)
    with (arguments.folder / "compare.csv").open("w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *map(columns_of, rows)])
    methods = totals(rows)
    (arguments.folder / "compare.json").write_text(json.dumps({"runs": rows, "methods": methods}, indent=2))
    print(json.dumps(methods, indent=1))
    try:
        draw(arguments.folder, rows, methods)
    except ImportError:
        print("no charts: python3-matplotlib is not here")


if __name__ == "__main__":
    main()
