"""Fills every organic clean model at ten sizes, with the lattice core and without; called by bench/campaigns/front-campaign.sh.

Organic: at most one edge in twenty is a feature. A run is good if the front, with its ladder, closes every cavity: that
the whole surface had to be recovered instead is a failure here.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

COUNTS = [1_000, 1_700, 2_800, 4_600, 7_700, 13_000, 22_000, 36_000, 60_000, 100_000]
CORES = ["lattice", "none"]
MOST_FEATURES = 0.05
TIMEOUT = 120


def run(program, model, count, core, threads):
    """(report or None, what went wrong)"""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "report.json")
        command = [program, "mesh", model, "--elements", str(count), "--core", core, "--improve", "none", "--threads",
                   str(threads), "-o", pathlib.Path(folder, "m.vtu"), "--json", report, "-q"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            return None, f"no end within {TIMEOUT} s"
        if done.returncode != 0:
            return None, f"exit {done.returncode}: {done.stderr.strip().splitlines()[-1][:100]}"
        return json.loads(report.read_text()), ""


def stage(report, name):
    return next((s for s in report["stages"] if s["name"] == name), {"counters": {}, "notes": []})


def is_organic(report):
    edges = 1.5 * stage(report, "repair")["counters"]["triangles"]
    return stage(report, "features")["counters"]["feature edges"] <= MOST_FEATURES * edges


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--from", type=int, default=0, dest="first", help="number of the first model")
    parser.add_argument("--to", type=int, default=10**6, help="number of the model to stop before")
    parser.add_argument("--sizes", type=int, default=len(COUNTS), help="how many of the sizes, evenly")
    args = parser.parse_args()
    counts = COUNTS[::max(1, len(COUNTS) // args.sizes)]
    models = sorted(path.name for path in pathlib.Path("models/clean").glob("*.off"))
    sums = {"runs": 0, "failed": 0, "cavities": 0, "by recovery": 0}
    for model in models[args.first:args.to]:
        line, path = [], f"models/clean/{model}"
        for count in counts:
            for core in CORES:
                report, error = run(args.program, path, count, core, args.threads)
                if report and not is_organic(report):
                    break
                sums["runs"] += 1
                front = stage(report, "volume front") if report else {"counters": {}, "notes": []}
                if front["counters"].get("filled by recovery of the whole surface"):
                    error = "filled without the front"
                sums["cavities"] += front["counters"].get("cavities", 0)
                sums["by recovery"] += front["counters"].get("closed by recovery", 0)
                sums["failed"] += bool(error)
                line.append(f"FAILED at {count}, core {core}: {error}" if error else
                            f"{front['counters'].get('cavities', 0):.0f}")
            else:
                continue
            break
        if line:
            print(f"{model}: cavities, all closed, per run: {' '.join(line)}", flush=True)
    print(", ".join(f"{value:.0f} {name}" for name, value in sums.items()))
    sys.exit(1 if sums["failed"] else 0)


main()
