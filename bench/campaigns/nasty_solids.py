#!/usr/bin/python3
"""Meshes generated nasty but legal solids at three sizes, and judges each run; writes docs/measured/nasty-solids.md.

  bench/campaigns/nasty_solids.py [FIRST:END[:STRIDE]] [--seed N] [--families A,B] [--sizes automatic,coarse,fine] [--page] [--keep FOLDER]
  bench/campaigns/nasty_solids.py --thin 0:56                      of bench/models/thin_solids.py: rods, springs, brushes, foams, ...
  bench/campaigns/nasty_solids.py [--thin] --write NUMBER FILE.off a case as a file

Cases 0 to 1999 by default, every STRIDE-th (an odd one, not of 13, meets all 26 families), one at a time on one thread,
each within a limit on its processor time. A run is good if it ends with a mesh that `octafront check` finds valid, in time,
with elements in proportion, and keeps the volume. One line for each that is not; status 1 if there are any. Needs a built
octafront (build/release, or OCTAFRONT=FILE) and nothing else.
"""
import argparse
import collections
import json
import math
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.off import write_off
from bench.models import nasty_solids as solids
from bench.models import thin_solids
from bench.pages import tables
from bench.pages.origin import written_by

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
SIZES = ("automatic", "coarse", "fine")
COARSE = 1 / 8
"""The coarse size, in diagonals."""
FINE = 20_000
"""Elements that the fine size shall make, about."""
PER_CUBE, PER_SQUARE = 8.5, 3.4
"""Elements of size 1 in a unit of volume, and on a unit of area of something thin."""
BUDGET, BUDGET_PER_TRIANGLE, ABOVE_BUDGET = 1_000_000, 20, 1.3
"""What automatic sizes promise, and how nearly. With a given size there may be MANY times as many as it asks for, and FORCED for
each triangle of the input."""
MANY, FORCED, FEW = 4, 40, 2_000
FIXED_SECONDS, TIMES_PLAIN = 5, 20
LONGEST = 100
"""CPU seconds after which a run is ended."""
LOST = 0.01
Run = collections.namedtuple("Run", "number family size status cpu elements volume least smallest largest faults said")


def expected(solid, h):
    return PER_CUBE * solids.volume(solid) / h**3 + PER_SQUARE * solids.area(solid) / h**2


def size_for(solid, elements):
    low, high = 1e-9 * solids.diagonal(solid), solids.diagonal(solid)
    for _ in range(60):
        h = math.sqrt(low * high)
        low, high = (low, h) if expected(solid, h) < elements else (h, high)
    return high


def measured(command, limit):
    """(status, its error output, processor time)."""
    def confine():
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = subprocess.run(command, capture_output=True, text=True, errors="replace", preexec_fn=confine, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return ended.returncode, ended.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def mesh(path, folder, size, limit):
    """(status, error output, seconds, report)"""
    report, made = folder / "report.json", folder / "made.vtu"
    for old in (report, made):
        old.unlink(missing_ok=True)
    command = [OCTAFRONT, "mesh", str(path), "-o", str(made), "--threads", "1", "--json", str(report)]
    status, error, cpu = measured(command + ([] if size is None else ["--size", repr(size)]), limit)
    return status, error, cpu, json.loads(report.read_text()) if report.exists() else {}


def plain_seconds(folder):
    """Per element of a ball, about as many as the cases have."""
    ball = solids.sphere(1.0, 48)
    path = folder / "ball.off"
    write_off(path, *ball)
    _, _, cpu, report = mesh(path, folder, size_for(ball, FINE), 60)
    return cpu / report["tets"]


def judge(number, family, solid, name, folder, plain):
    path = folder / f"{number:04}.off"
    h = {"automatic": None, "coarse": COARSE * solids.diagonal(solid), "fine": size_for(solid, FINE)}[name]
    triangles = len(solid.triangles)
    most = (ABOVE_BUDGET * (BUDGET + BUDGET_PER_TRIANGLE * triangles) if h is None
            else MANY * expected(solid, h) + FORCED * triangles + FEW)
    limit = min(FIXED_SECONDS + TIMES_PLAIN * plain * most, LONGEST)
    status, error, cpu, report = mesh(path, folder, h, limit)
    notes = [n for stage in report.get("stages", []) for n in stage["notes"]]
    faults, elements, quality = [], report.get("tets", 0), report.get("quality", {})
    change = report["volume"] / solids.volume(solid) - 1 if status == 0 else math.nan
    said = any("change the volume" in n for n in notes)
    if status in (-24, -9):
        faults.append(f"no end in {limit:.0f} s")
    elif status != 0:
        faults.append(f"status {status}: {error.strip().splitlines()[0] if error.strip() else ''}")
    else:
        if cpu > FIXED_SECONDS + TIMES_PLAIN * plain * elements:
            faults.append(f"{cpu:.1f} s for {elements} elements")
        if elements > most:
            faults.append(f"{elements} elements, where {most:.0f} are many")
        if abs(change) > LOST and not (said and h is not None):
            faults.append(f"volume {100 * change:+.2f} %")
        if "valid" not in subprocess.run([OCTAFRONT, "check", str(folder / "made.vtu")], capture_output=True, text=True,
                                         check=False).stdout:
            faults.append("not valid")
    return Run(number, family, name, status, cpu, elements, change, quality.get("beta_min", math.nan),
               quality.get("dihedral_min_degrees", math.nan), quality.get("dihedral_max_degrees", math.nan), faults, said)


HEAD = ["family", "runs", "good", "refused", "no end", "CPU s, median", "CPU s, worst", "elements, median", "elements, most", "volume off by, worst",
        "worst where nothing is said"]


def table(runs):
    lines = []
    for family in [*solids.FAMILIES, None]:
        here = [r for r in runs if family in (r.family, None)]
        done = [r for r in here if r.status == 0]
        if not done:
            continue
        unsaid = [abs(r.volume) for r in done if not r.said]
        lines.append([(family or "all").replace("_", " "), len(here), sum(not r.faults for r in here), sum(r.status not in (0, -24, -9) for r in here),
                      sum(r.status in (-24, -9) for r in here), f"{statistics.median(r.cpu for r in here):.2f}", f"{max(r.cpu for r in here):.1f}",
                      f"{statistics.median(r.elements for r in done):,.0f}", f"{max(r.elements for r in done):,}",
                      f"{100 * max(abs(r.volume) for r in done):.2f} %", f"{100 * max(unsaid, default=0):.2f} %"])
    return lines


def shown(rows):
    """Rows of cells: the families that take longest, and the sum."""
    return ["The five families that take longest, and all:", "", *tables.worst(HEAD, rows[:-1], "CPU s, worst", HEAD, most=True, count=5), tables.row(rows[-1]), "",
            f"Each family: {tables.put('nasty-solids', HEAD, rows)}."]


def page(runs, arguments, plain):
    command = f"bench/campaigns/nasty_solids.py {arguments.cases} --page"
    faulty = [r for r in runs if r.faults]
    tables.write("nasty-solids", [
        "# Nasty solids", "",
        f"{written_by(command)}: cases {arguments.cases}, seed {arguments.seed}, {len(runs)} runs.", "",
        "Generated closed solids that are legal and awkward: `bench/models/nasty_solids.py` says which. Each is meshed with automatic sizes, with"
        f" `--size` of an eighth of its diagonal (coarse), and with one for about {FINE:,} elements (fine), on one thread. A run is good if"
        f" it ends with a valid mesh, in {FIXED_SECONDS} CPU s and {TIMES_PLAIN} times what a ball takes for as many elements"
        f" ({1e6 * plain:.1f} us each), with at most {ABOVE_BUDGET} times the budget that automatic sizes promise (or, where a size is given, {MANY} times what it asks for,"
        f" {FORCED} for each triangle of the input and {FEW:,}), and within {100 * LOST:.0f} % of the exact volume. Where a given size cannot keep the volume a note says so.", "",
        *shown(table(runs)), "",
        f"What was not good ({len(faulty)} of {len(runs)}):", "",
        *(f"- {r.number} {r.family}, {r.size}: {'; '.join(r.faults)}" for r in faulty[:20]),
        *([f"- and {len(faulty) - 20} more"] if len(faulty) > 20 else [])])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="?", default="0:2000", metavar="FIRST:END[:STRIDE]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--thin", action="store_true", help="thin and many-fold solids")
    parser.add_argument("--families")
    parser.add_argument("--sizes", default=",".join(SIZES))
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no further case after so many")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--json", metavar="FILE", help="each run as a line")
    parser.add_argument("--keep", metavar="FOLDER", help="leave the solids that failed there")
    parser.add_argument("--write", nargs=2, metavar=("NUMBER", "FILE.off"))
    arguments = parser.parse_args()
    generated = thin_solids if arguments.thin else solids
    if arguments.write:
        write_off(arguments.write[1], *generated.make(int(arguments.write[0]), arguments.seed)[1])
        return 0
    cases = range(*(int(x) for x in arguments.cases.split(":")))
    families = arguments.families.split(",") if arguments.families else list(generated.FAMILIES)
    runs, begun = [], time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        plain = plain_seconds(folder)
        for number in cases:
            family, solid = generated.make(number, arguments.seed)
            if family not in families:
                continue
            if time.monotonic() - begun > arguments.seconds:
                arguments.cases = f"{cases.start}:{number}:{cases.step}"
                break
            path = folder / f"{number:04}.off"
            write_off(path, *solid)
            for size in arguments.sizes.split(","):
                runs.append(judge(number, family, solid, size, folder, plain))
                if arguments.json:
                    with open(arguments.json, "a") as lines:
                        lines.write(json.dumps(runs[-1]._asdict()) + "\n")
                if runs[-1].faults:
                    print(f"{number} {family}, {size}: {'; '.join(runs[-1].faults)}", flush=True)
                    if arguments.keep:
                        pathlib.Path(arguments.keep, path.name).write_bytes(path.read_bytes())
            path.unlink()
    bad = sum(bool(r.faults) for r in runs)
    print(f"{len(runs) - bad} of {len(runs)} good; {sum(r.cpu for r in runs):.0f} CPU s, the longest {max(r.cpu for r in runs):.1f}")
    if arguments.page:
        page(runs, arguments, plain)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
