"""Does damage cost more than its place? Clean models, each damaged in every way that bench/models/damages.py knows, are
meshed with default options, and compared with the undamaged model: elements, CPU time, volume, angles.

Usage: bench/run.sh damage [--models N] [--after N] [--only SUBSTRING] [--kinds A,B] [--faces MOST] [--timeout SECONDS]
                           [--lines FILE] [--program OCTAFRONT]
The N smallest clean models of models/clean with 100 faces and more (by default 40, of 8,000 faces at most), but for the
smallest that --after leaves out. Writes docs/measured/damage.md. --lines appends a JSON object for each run to FILE and
leaves out those that are there, so that a campaign may stop and go on.
"""
import argparse
import collections
import json
import pathlib
import statistics
import subprocess
import tempfile
import zlib

import numpy as np

from bench.models import damages, solids
from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import ORIGIN, written_by
from bench.process import run_bounded

ROOT = pathlib.Path(__file__).resolve().parents[2]

KINDS = damages.KINDS | damages.MORE
CLEAN = "undamaged"
MOST = 1.3      # times the elements and the time of the undamaged model
LARGE = 1.0     # damage of a larger part of the surface, in percent, may cost more
LEAST_FACES = 100
NOT_THE_TIME = 0.3  # CPU seconds: where both runs take less, their ratio is that of starting up


def models(most_faces, only):
    """Clean ones, by the number of their faces."""
    found, seen = [], set()
    for file in sorted((ROOT / "models/clean").glob("*.off")):
        if only not in file.name:
            continue
        try:
            solid = solids.read_off(file)
        except (ValueError, IndexError):  # with colours or normals: there are enough others
            continue
        twin = solid.triangles.tobytes() in seen  # the same model from another collection
        if not twin and LEAST_FACES <= len(solid.triangles) <= most_faces and solids.is_strictly_clean(solid):
            seen.add(solid.triangles.tobytes())
            found.append((len(solid.triangles), file.name, solid))
    return [(name, solid) for _, name, solid in sorted(found, key=lambda m: m[:2])]


def damaged_part(made):
    """Of the area, in percent, what is no longer there as it was; which way it faces does not count. 100 where the answer
    is another body."""
    if len(made.truth) > 1:
        return 100.0
    areas = solids.areas(made.truth[0])
    return 100 * areas[damages.lost_triangles(made)[0]].sum() / areas.sum()


def meshed(program, file, folder, timeout):
    report = pathlib.Path(folder, "report.json")
    report.unlink(missing_ok=True)
    status, message, cpu, _ = run_bounded([program, "mesh", file, "-o", pathlib.Path(folder, "mesh.vtu"), "--json", report, "-q",
                                   "--threads", "1", "--sheets", "drop"], timeout)
    if status != 0:
        return {"failed": "no end" if status is None else f"status {status}: {message[:160]}", "cpu": cpu}
    r = json.loads(report.read_text())
    quality = r["quality"]
    return {"cpu": cpu, "tets": r["tets"], "volume": r["volume"], "least": quality["dihedral_min_degrees"],
            "most": quality["dihedral_max_degrees"]}


def undamaged(made, solid):
    """What a damaged model is compared with, by name: the model, or where holes need smaller triangles the model divided."""
    count = len(made.truth[0].triangles)
    return CLEAN if count == len(solid.triangles) else f"{CLEAN}, divided into {count}"


def rows_of(a, name, solid, done):
    """Of one model: each kind, and before it the undamaged one."""
    done = set(done)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "model.off")

        def row(kind, surface, **more):
            write_off(file, *surface)
            done.add((name, kind))
            return {"model": name, "kind": kind, "origin": ORIGIN} | more | meshed(a.program, file, folder, a.timeout)
        for kind in [k for k in a.kinds.split(",") if (name, k) not in done]:
            rng = np.random.default_rng(zlib.crc32(f"{name} {kind}".encode()))
            try:
                made = KINDS[kind](solid, rng)
            except damages.Unsuitable:
                continue
            base = undamaged(made, solid)
            if (name, base) not in done:
                yield row(base, made.truth[0])
            yield row(kind, made.soup, base=base, what=made.what, part=damaged_part(made))


# -------------------------------------------------------------------------------------------------------- page


def compared(rows):
    """Damaged runs with the figures over those of the undamaged model."""
    clean = {(r["model"], r["kind"]): r for r in rows if r["kind"] not in KINDS and "failed" not in r}
    out = []
    for r in rows:
        c = clean.get((r["model"], r.get("base")))
        if not c:
            continue
        if "failed" not in r:
            quick = max(r["cpu"], c["cpu"]) < NOT_THE_TIME
            r = r | {"elements x": r["tets"] / c["tets"], "time x": 1 if quick else r["cpu"] / c["cpu"],
                     "volume %": 100 * (r["volume"] / c["volume"] - 1), "poor": r["least"] < 10 or r["most"] > 160}
        out.append(r)
    return out


def is_too_much(r):
    return r["part"] <= LARGE and max(r["elements x"], r["time x"]) > MOST


HEAD = ["damage", "cases", "meshed", "damaged, % of the area (median)", "elements, times, median", "elements, most", "CPU time, times, median",
        "CPU time, most", f"at most {MOST} times, of damage up to {LARGE:g} %", "volume, % (most)", "outside 10-160°"]
LEFT_HEAD = ["model", "damage", "what", "result"]


def line(name, its):
    made = [r for r in its if "failed" not in r]
    if not made:
        return [name, len(its), 0, *[""] * (len(HEAD) - 3)]
    small = [r for r in made if r["part"] <= LARGE]
    worst = [f"{take(r[key] for r in made):.2f}" for key in ("elements x", "time x") for take in (statistics.median, max)]
    return [name, len(its), len(made), f"{statistics.median(r['part'] for r in made):.2f}", *worst, f"{sum(not is_too_much(r) for r in small)} of {len(small)}",
            f"{max((abs(r['volume %']) for r in made)):.2f}", sum(r["poor"] for r in made)]


def lines_of(rows):
    return [*(line(kind, [r for r in rows if r["kind"] == kind]) for kind in KINDS if any(r["kind"] == kind for r in rows)), line("all", rows)]


def left_of(rows):
    return [[r["model"], r["kind"], r["what"], r["failed"] if "failed" in r else
             f"damaged {r['part']:.2f} %: elements {r['elements x']:.2f} times, time {r['time x']:.2f} times"]
            for r in rows if "failed" in r or is_too_much(r)]


def shown(lines, left):
    """Rows of cells: the kinds that cost most, and the sum."""
    return [*tables.worst(HEAD, lines[:-1], "elements, most", HEAD, most=True, count=3), tables.row(lines[-1]), "",
            f"Each kind: {tables.put('damage', HEAD, lines)}. Refused, or more than {MOST} times as much: {tables.put('damage-left', LEFT_HEAD, left)}, "
            f"by kind {', '.join(f'{kind} {n}' for kind, n in collections.Counter(r[1] for r in left).items()) or 'none'}."]


def page(rows, command, version):
    return ["# What damage costs", "", f"{written_by(command, {r['origin'] for r in rows})}, by {version}.", "",
            f"{len({r['model'] for r in rows})} clean models, each damaged in up to {len({r['kind'] for r in rows})} ways (`bench/models/damages.py`), meshed with default "
            "options (and `--sheets drop`, on one thread), over the undamaged model (divided into as small triangles, where holes need them). CPU times of runs that "
            f"take less than {NOT_THE_TIME} s do not count. *Damaged*: the area of what is no longer there as it was, whichever way it faces; all of it where the "
            "answer is another body. The three kinds that cost most elements, and all:", "", *shown(lines_of(rows), left_of(rows))]


def command(a):
    after = f" --after {a.after}" if a.after else ""
    return f"bench/run.sh damage --models {a.models}{after}" + (f" --kinds {a.kinds}" if a.kinds != ",".join(KINDS) else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--models", type=int, default=40)
    parser.add_argument("--after", type=int, default=0, help="leave out so many of the smallest")
    parser.add_argument("--only", default="", help="models whose name has this")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--faces", type=int, default=8000, help="of a model, at most")
    parser.add_argument("--timeout", type=float, default=100, help="CPU seconds for each run")
    parser.add_argument("--lines", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, help="another build of octafront")
    a = parser.parse_args()
    a.program = a.program or a.build / "cli/octafront"
    old = [json.loads(text) for text in a.lines.open()] if a.lines and a.lines.exists() else []
    rows, done = list(old), {(r["model"], r["kind"]) for r in old}
    for name, solid in models(a.faces, a.only)[a.after:a.models]:
        for row in rows_of(a, name, solid, done):
            rows.append(row)
            if a.lines:
                with a.lines.open("a") as f:
                    f.write(json.dumps(row) + "\n")
    rows = compared(rows)
    version = subprocess.run([a.program, "--version"], capture_output=True, text=True).stdout.strip()
    print("\n".join(tables.table(HEAD, lines_of(rows))))
    if not a.only:
        tables.write("damage", page(rows, command(a), version))


if __name__ == "__main__":
    main()
