"""Second order: is every element proven, how true is the curved boundary, what does it cost?

Usage: bench/run.sh second_order [--shapes]
Writes its tables into docs/measured/second-order.md, each model into rows/second-order.csv, each shape and size into
rows/second-order-shapes.csv. --shapes leaves out the models.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess

from bench.pages import tables
from bench.pages.origin import written_by

PAGE = tables.MEASURED / "second-order.md"
SHAPES = ["surface and its triangles", "size", "elements", "straight: mean", "straight: mean falls", "curved: mean", "curved: mean falls",
          "order, straight and curved", "straight: largest", "straight: largest falls", "curved: largest", "curved: largest falls",
          "least scaled Jacobian", "proven"]
MODELS = ["model", "elements", "edges curved", "eased", "corners moved", "held back", "least scaled Jacobian", "proven", "crossings", "CPU s, first order",
          "second order costs"]


def run(build, *arguments):
    done = subprocess.run([build / "bench/octafront_second_order", *map(str, arguments)], stdout=subprocess.PIPE, text=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def fall(before, now):
    return f"{before / now:.1f}" if before else ""


def shapes(build):
    rows = run(build, "shapes")
    made, before = [], {}
    for r in rows:
        if before.get("shape") != r["shape"]:
            before = {}
        order = ""
        if before:
            # Edges are not quite halved: the order is what does not depend on that, straight boundaries have two.
            halved = math.sqrt(before["linear_mean"] / r["linear_mean"])
            order = f"2 and {math.log(before['curved_mean'] / r['curved_mean']) / math.log(halved):.1f}"
        cells = [r["shape"], r["size"], f"{r['tets']:,}"]
        for key in ("linear_mean", "curved_mean"):
            cells += [f"{r[key]:.1e}", fall(before.get(key), r[key])]
        cells.append(order)
        for key in ("linear_most", "curved_most"):
            cells += [f"{r[key]:.1e}", fall(before.get(key), r[key])]
        cells += [f"{r['least_scaled_jacobian']:.2f}", proven(r)]
        made.append(cells)
        print(tables.row(cells), flush=True)
        before = r
    return shown(made)


def shown(rows):
    """The finest size of each shape."""
    finest = list({r[0]: r for r in rows}.values())
    all_proven = " all their elements are proven." if all(r[-1] == "all" for r in rows) else ""
    return [*tables.some(SHAPES, finest, [c for c in SHAPES if "falls" not in c and c != "proven"]), "",
            f"The finest of three sizes;{all_proven} Each: {tables.put('second-order-shapes', SHAPES, rows)}."]


def proven(r):
    return "all" if r["valid"] and r["not_proven"] == 0 else f"**all but {r['not_proven']}**"


def models(build):
    rows, results, costs = [], [], []
    for file in sorted(pathlib.Path("models/clean").iterdir()):
        r = run(build, file)[0]
        if "error" in r:
            rows.append([file.name, r["error"].splitlines()[0], *[""] * (len(MODELS) - 2)])
            continue
        results.append(r)
        costs.append(100 * (r["cpu_seconds"] / r["linear_cpu_seconds"] - 1))
        rows.append([file.name, r["tets"], r["curved"], r["eased"], r["moved"], r["held"], f"{r['least_scaled_jacobian']:.3f}",
                     proven(r), r["crossings"], f"{r['linear_cpu_seconds']:.2f}", f"{costs[-1]:+.0f} %"])
        print(*rows[-1], flush=True)
    good = sum(r["valid"] and r["not_proven"] == 0 for r in results)
    curved, eased = (sum(r[key] for r in results) for key in ("curved", "eased"))
    return [f"{good} of {len(results)} meshes have every element proven, {sum(r['tets'] for r in results):,} elements in all. Of the edges that "
            f"want to bend, {curved:,} do and {eased:,} ({100 * eased / (curved + eased):.2f} %) had to be eased. Second order costs "
            f"{statistics.median(costs):.0f} % of a linear run in the median, {max(costs):.0f} % at most. Each: {tables.put('second-order', MODELS, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--shapes", action="store_true")
    args = parser.parse_args()
    said = [f"{written_by('bench/run.sh second_order')}.", ""]
    tables.rewrite(PAGE, "shapes", said + shapes(args.build))
    if not args.shapes:
        tables.rewrite(PAGE, "models", said + models(args.build))


if __name__ == "__main__":
    main()
