"""Adapts meshes of real models to a small size and to a large one in turn, ten times, and writes docs/measured/adapt-isotropic.md: how
fast, how good, and what is left of the body.

Usage: bench/run.sh adapt_loops [--loops N] [--only SUBSTRING] [--no-surface]
On one thread; times are CPU seconds of a whole call, with the checks before and after.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from bench.pages import tables
from bench.pages.origin import written_by

# name, surface, small and large size in parts of the diagonal of its box
MODELS = [("bunny", "models/clean/bunny00.off", 1 / 60, 1 / 30), ("armadillo", "models/clean/armadillo.off", 1 / 80, 1 / 40),
          ("pinion", "models/clean/pinion.off", 1 / 60, 1 / 30), ("bracket", "samples/bracket.stl", 1 / 80, 1 / 30),
          ("knot", "samples/torus_knot.ply", 1 / 70, 1 / 45)]


def rows_of(build, surface, small, large, loops, is_given):
    """The volume of the mesh that all begins with, or of the surface where that is given, and a record for each adaptation; `before`:
    elements that came."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder, "mesh.msh")
        subprocess.run([build / "cli/octafront", "mesh", surface, "-o", mesh, "--elements", "20000", "-q"], check=True)
        told = subprocess.run([build / "bench/octafront_adapt_loops", mesh, str(small), str(large), str(loops), *([surface] if is_given else [])],
                              capture_output=True, text=True, check=True)
    lines = [json.loads(line) for line in told.stdout.splitlines()]
    for before, record in zip(lines, lines[1:]):
        record["before"] = before["tets"]
    return lines[0]["volume"], lines[1:]


def row(name, which, record, volume):
    return [name, which, f"{record['tets']:,}", f"{max(record['tets'], record['before']) / record['cpu'] / 1000:.0f}",
            f"{100 * record['fitting'] / record['edges']:.1f} %", f"{record['longest']:.2f}", f"{record['beta_mean']:.3f}", f"{record['beta_min']:.3f}",
            record["poor"], f"{100 * (record['volume'] / volume - 1):+.2f} %", f"{record['deviation'] / record['bound']:.2f}"]


HEAD = ["model", "adaptation", "elements", "k/s", "fit", "longest", "mean β", "least β", "poor", "volume", "off"]


def shown(rows):
    """Rows of cells."""
    return [*tables.spread_by("adaptation", HEAD, rows, HEAD[2:]), "", f"Median, least and most of the models. Each: {tables.put('adapt-isotropic', HEAD, rows)}."]


def page(results, loops):
    lines = ["# Adaptation to sizes, and ten times in turn", "",
             f"{written_by('bench/run.sh adapt_loops')}, on one thread: a mesh of about 20,000 elements is adapted to a small uniform size, what comes of it to a large "
             f"one, and so on, {loops} loops, each from the mesh that the one before made and nothing else. *k/s*: thousand elements for each CPU second of a whole call. *fit*, *longest*: edges from √½ to √2 times as long as is wanted, and the longest, in parts of what is wanted. "
             "*poor*: elements with β < .3, forced or not. *volume* against that of the mesh that all began with. *on its surface*: with `--surface`, the surface "
             "that was meshed: volumes against that of the surface. *off*: the distance of walls and their ground, both ways, in parts of the bound (the larger of .4 % of the "
             "diagonal and what the walls that came had).", ""]
    chosen = {"first, small": 0, "first, large": 1, "last, small": -2, "last, large": -1}
    return lines + shown([row(name, which, records[at], volume) for name, volume, records in results for which, at in chosen.items()])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--loops", type=int, default=10)
    parser.add_argument("--only", default="")
    parser.add_argument("--no-surface", action="store_true", help="not on the surfaces that were meshed")
    options = parser.parse_args()
    results = []
    for name, surface, small, large in MODELS:
        if options.only not in name:
            continue
        for is_given in (False,) if options.no_surface else (False, True):
            volume, records = rows_of(options.build, surface, small, large, options.loops, is_given)
            title = name + (", on its surface" if is_given else "")
            results.append((title, volume, records))
            for record in records:
                print(tables.row(row(title, f"{record['size']:.3g}", record, volume)), flush=True)
    if not options.only:
        tables.write("adapt-isotropic", page(results, options.loops))


if __name__ == "__main__":
    main()
