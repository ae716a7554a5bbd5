#!/usr/bin/env python3
"""What Python costs over the command line: the same file read, meshed and written, in turn. Time is wall time, memory the
peak of the process; ratios are of medians. Prints the table of docs/use/python.md.

    bench/run/python_overhead.py PYTHON PROGRAM [--model FILE] [--elements N ...] [--repeats N] [--threads N]

PYTHON: of an environment that has the wheel; PROGRAM: the command line tool to compare with.
"""
import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.pages.origin import written_by  # noqa: E402

CODE = "import octafront, sys; octafront.mesh_file(sys.argv[1], elements=int(sys.argv[2]), threads=int(sys.argv[3]))" \
       ".save(sys.argv[4])"


def measured(command):
    """Seconds and peak memory in MB of a process."""
    began = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"})
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"failed: {command}")
    return time.monotonic() - began, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("python")
    parser.add_argument("program")
    parser.add_argument("--model", default="samples/torus_knot.ply")
    parser.add_argument("--elements", type=int, nargs="+", default=[1_000_000])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    print(f"{written_by('bench/run/python_overhead.py PYTHON PROGRAM')}.\n")
    print("| elements | wall s: CLI | Python | ratio | CPU s: CLI | Python | ratio | peak MB: CLI | Python | ratio |\n"
          "| ---: |" + " ---: |" * 9)
    with tempfile.TemporaryDirectory() as folder:
        for elements in args.elements:
            outputs = [f"{folder}/cli.vtu", f"{folder}/python.vtu"]
            cli = [args.program, "mesh", args.model, "-o", outputs[0], "-q", "--elements", str(elements), "--threads",
                   str(args.threads)]
            ours = [args.python, "-c", CODE, args.model, str(elements), str(args.threads), outputs[1]]
            runs = {"cli": [], "python": []}
            for _ in range(args.repeats):
                runs["cli"].append(measured(cli))
                runs["python"].append(measured(ours))
            if pathlib.Path(outputs[0]).read_bytes() != pathlib.Path(outputs[1]).read_bytes():
                sys.exit("the two wrote different files")
            row = [f"{elements:,}"]
            for i, digits in ((0, 2), (1, 2), (2, 0)):
                a, b = (statistics.median(run[i] for run in runs[name]) for name in ("cli", "python"))
                row += [f"{a:.{digits}f}", f"{b:.{digits}f}", f"{b / a:.3f}"]
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
