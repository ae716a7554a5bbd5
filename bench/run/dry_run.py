#!/usr/bin/env python3
"""How near `octafront mesh --dry-run` comes: bench/run/dry_run.py BUILD [--fit]

Runs each case dry and in earnest, one thread, and writes the table of docs/use/command-line.md. Time is that of the processor,
which other work on the machine changes little. --fit: prints what an element takes instead, for the constants of
cli/estimate.cpp.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from bench.ours import cpu_seconds
from bench.pages import tables
from bench.pages.origin import written_by

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = [  # model, options
    ("samples/bracket.stl", []),
    ("samples/gear.obj", ["--preset", "draft"]),
    ("samples/torus_knot.ply", ["--curvature", "24", "--interior", "graded"]),
    ("samples/bracket.stl", ["--elements", "1e6"]),
    ("samples/gear.obj", ["--elements", "3e5", "--improve", "fast"]),
    ("samples/bracket.stl", ["--elements", "1e5", "--improve", "best"]),
    ("models/clean/elephant.off", ["--elements", "2e5"]),
    ("models/clean/fandisk.off", []),
    ("models/clean/hand.off", ["--curvature", "16"]),
    ("models/clean/dragknob.off", []),
    ("models/clean/armadillo.off", []),
    ("models/clean/bunny00.off", ["--elements", "5e5", "--improve", "none"]),
]

HEAD = ["model", "options", "elements", "said, elements", "seconds", "said, seconds", "memory", "said, memory"]


def run(octafront, model, options, more):
    done = subprocess.run([octafront, "mesh", ROOT / model, *options, *more, "--threads", "1", "--json", "-"],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def case(octafront, model, options, scratch):
    said = run(octafront, model, options, ["--dry-run"])
    made = run(octafront, model, options, ["-o", scratch / "m.vtu"])
    return said, made, (scratch / "m.vtu").stat().st_size


def off_by(said, made):
    return f"{100 * (said / made - 1):+.0f} %"


def main():
    octafront = pathlib.Path(sys.argv[1]) / "cli/octafront"
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for model, options in CASES:
            if not (ROOT / model).exists():
                print(f"{model} is not there: bench/models/get-models.sh fetches it", file=sys.stderr)
                continue
            said, made, size = case(octafront, model, options, pathlib.Path(scratch))
            if "--fit" in sys.argv:
                n = made["tets"]
                rest = made["cpu_seconds"] - said["cpu_seconds"]
                improve = cpu_seconds(made, "improve")
                print(f"{model} {' '.join(options)}: {n} tets; us/tet: fill etc. {1e6 * (rest - improve) / n:.1f} (improve {1e6 * improve / n:.1f}); "
                      f"dry {said['cpu_seconds']:.2f} s; bytes/tet {made['peak_memory_bytes'] / n:.0f} dry {said['peak_memory_bytes'] / 1e6:.0f} MB; file {size / n:.1f}; "
                      f"boundary {made['boundary_faces']}", flush=True)
                continue
            guess = said["dry_run"]
            rows.append([pathlib.Path(model).stem, " ".join(options) or "-", f"{made['tets']:,}", off_by(guess["expected_tets"], made["tets"]),
                         f"{made['cpu_seconds']:.1f}", off_by(guess["seconds"], made["cpu_seconds"]), f"{made['peak_memory_bytes'] / 1e6:.0f} MB",
                         off_by(guess["memory_bytes"], made["peak_memory_bytes"])])
            print(tables.row(rows[-1]), flush=True)
    if "--fit" not in sys.argv:
        tables.rewrite(ROOT / "docs/use/command-line.md", "dry run", [
            f"{written_by('bench/run.sh dry_run')}.", "",
            *tables.spread(HEAD, rows, ["elements", "said, elements", "said, seconds", "said, memory"])])


if __name__ == "__main__":
    main()
