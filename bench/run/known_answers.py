"""Repairs and meshes damaged models whose answer is known, and judges what came out.

Usage: bench/run.sh known_answers [--cases FIRST:END] [--seed N] [--kinds A,B] [--generated] [--clean]
                                  [--lines FILE] [--keep FOLDER] [--steps repair] [--jobs N] [--timeout SECONDS] [--page]
Cases are those of bench/models/damage_models.py. Each is repaired (`octafront repair`: the surface must be within the tolerance)
and meshed, with default options but --sheets drop (`octafront mesh`: on top of the tolerance the mesher may stray as far as it says itself).
octafront_judge_answer measures both against the undamaged model. One line for each failure; --lines appends a JSON object
for each case to FILE and leaves out those that are there, so that a campaign may stop and go on; --page writes
docs/measured/repair-known.md from it. Files of failed cases are kept in --keep. Ends with status 1 if a case failed.
--clean instead repairs the undamaged models: they must come out bit for bit.
"""
import argparse
import concurrent.futures
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

from bench.models import damage_models as damage, solids
from bench.off import write_off
from bench.pages import tables
from bench.pages.origin import ORIGIN, written_by
from bench.process import run_bounded

TOLERANCE = 1e-3          # of the diagonal: the default of --tolerance
MESH_AT_DAMAGE = 2e-3     # the mesh keeps within the tolerance of what repair moved
MESH_DISTANCE = 5e-3      # elsewhere as near as meshes of clean surfaces stay: .4 % of the diagonal, sampled
VOLUME = 0.5              # percent
VOLUME_OF_LARGEST = 3.0   # with holes of a tenth of the area
EDGES = 1e-6              # of the diagonal


def measure(build, known_file, result):
    done = subprocess.run([build / "tests/known_answers/octafront_judge_answer", known_file, result], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else {"unreadable": done.stderr.strip()}


def wrong(known, made, distance, at_damage, edges):
    """What is wrong with a result, in a few words each."""
    if "unreadable" in made or "empty" in made:
        return [f"no result: {made.get('unreadable', 'empty')}"]
    largest = known["kind"] in ("hole-10", "holes-10")
    out = [f"invalid: {made['defect']}"] if made.get("defect") else []
    out += [f"{made[key]} {key.replace('_', ' ')}" for key in ("bad_edges", "bad_vertices") if made[key]]
    if made.get("regions", made["components"]) != made["components"]:  # each body is one
        out.append(f"{made['regions']} regions")
    for key, value in known["expected"].items():
        if value is not None and made[key] != value:
            out.append(f"{key} {made[key]}, not {value}")
    for key, most in (("to_truth", distance), ("from_truth", distance), ("to_damage", at_damage), ("from_damage", at_damage)):
        if made[key]["distance"] > most:
            out.append(f"{key.replace('_', ' ')} {100 * made[key]['distance']:.3f} %")
    if abs(made["volume_percent"]) > (VOLUME_OF_LARGEST if largest else VOLUME):
        out.append(f"volume {made['volume_percent']:+.2f} %")
    if made["sides"]["wrong"]:
        out.append(f"{made['sides']['wrong']} of {made['sides']['asked']} points on the wrong side")
    if edges and made["sharp_edges"]["distance"] > EDGES:
        out.append(f"sharp edges {100 * made['sharp_edges']['distance']:.5f} % off")
    return out


def judge_case(build, folder, known, timeout, wanted):
    """All about one case: what was made, measured, and is wrong."""
    row = {key: known[key] for key in ("case", "seed", "kind", "model", "what", "damaged_triangles")} | {"wrong": []}
    known_file = pathlib.Path(folder, f"{known['case']:04}.json")
    # Sheets in a body stay by default, as cracks; here they are damage.
    drop = ["--sheets", "drop"]
    steps = {"repair": ("repaired.off", TOLERANCE, TOLERANCE, drop),
             "mesh": ("mesh.vtu", MESH_DISTANCE, MESH_AT_DAMAGE, [*drop, "--threads", "1"])}
    for step in wanted:
        name, distance, at_damage, options = steps[step]
        result = pathlib.Path(folder, f"{known['case']:04}-{name}")
        report = result.with_suffix(".json")
        status, message, seconds, megabytes = run_bounded(
            [build / "cli/octafront", step, known["file"], "-o", result, "--json", report, "-q", *options], timeout)
        row[step] = {"status": status, "cpu_seconds": seconds, "megabytes": megabytes}
        if status != 0:
            row["wrong"].append(f"{step}: {'no end' if status is None else f'status {status}'}: {message[:200]}")
            continue
        row[step] |= measure(build, known_file, result)
        row["wrong"] += [f"{step}: {w}" for w in wrong(known, row[step], distance, at_damage, step == "repair")]
    return row


def do_case(build, number, a):
    kind, name, made = damage.make(number, a.seed, a.kinds.split(","), a.generated)
    with tempfile.TemporaryDirectory() as folder:
        known = damage.write(folder, number, kind, name, made, a.seed)
        row = judge_case(build, folder, known, a.timeout, a.steps.split(",")) | {"origin": ORIGIN}
        if row["wrong"] and a.keep:
            kept = pathlib.Path(a.keep)
            kept.mkdir(parents=True, exist_ok=True)
            for file in pathlib.Path(folder).iterdir():
                text = file.suffix == ".json" and len(file.stem) == 4
                if text:  # its paths, too, move
                    (kept / file.name).write_text(file.read_text().replace(str(folder), str(kept.resolve())))
                else:
                    shutil.copy(file, kept)
    return row


def changed(before, after):
    """What of a surface is not the same bit for bit: "" or "points", "triangles" or both, in words."""
    same = [x.shape == y.shape and x.tobytes() == y.astype(x.dtype).tobytes() for x, y in zip(before, after)]
    return "" if all(same) else " and ".join(w for w, s in zip(("points", "triangles"), same) if not s) + " changed"


def do_clean(build, name, a):
    """What is wrong with the repair of an undamaged model; None if it is not to be asked."""
    solid = damage.load(name)
    if solid is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        before, after = pathlib.Path(folder, "in.off"), pathlib.Path(folder, "out.off")
        write_off(before, *solid)
        status, message, _, _ = run_bounded([build / "cli/octafront", "repair", before, "-o", after, "-q"], a.timeout)
        if status != 0:
            return f"status {status}: {message[:200]}"
        return changed(solid, solids.read_off(after))


# -------------------------------------------------------------------------------------------------------- table


HEAD = ["damage", "cases", "meshed", "all right", "topology right", "surface: farthest, % of diagonal, median", "greatest", "mesh: farthest, %",
        "volume off, % (greatest, surface)", "wrong sides, points", "sharp edges off, % (greatest)", "CPU s repair, median", "CPU s mesh, median"]
FAILED_HEAD = ["case", "damage", "model", "what", "wrong"]


def lines_of(rows):
    """A line for each kind of damage, and one for all."""
    kinds = [k for k in damage.damages.KINDS if any(r["kind"] == k for r in rows)]
    return [line(name, its) for name, its in [(k, [r for r in rows if r["kind"] == k]) for k in kinds] + [("all", rows)]]


def measured(rows, step):
    return [r[step] for r in rows if "volume_percent" in r.get(step, {})]


def line(name, rows):
    surfaces, meshes = measured(rows, "repair"), measured(rows, "mesh")

    def far(made, where="truth"):
        return [100 * max(m[f"to_{where}"]["distance"], m[f"from_{where}"]["distance"]) for m in made] or [float("nan")]

    def topology_right(r):
        words = ("components", "shells", "genus", "bad edges", "bad vertices", "regions", "invalid", "status", "no end", "no result")
        return not any(w in text for text in r["wrong"] for w in words)
    return [name, len(rows), len(meshes), sum(not r["wrong"] for r in rows), sum(map(topology_right, rows)),
            f"{statistics.median(far(surfaces)):.4f}", f"{max(far(surfaces)):.3f}", f"{max(far(meshes)):.3f}",
            f"{max((abs(m['volume_percent']) for m in surfaces), default=float('nan')):.3f}",
            sum(m["sides"]["wrong"] for m in meshes),
            f"{100 * max((m['sharp_edges']['distance'] for m in surfaces), default=float('nan')):.6f}",
            *(f"{statistics.median(r[step]['cpu_seconds'] for r in rows if step in r):.2f}" if any(step in r for r in rows) else ""
              for step in ("repair", "mesh"))]


def shown(lines, failed):
    """Rows of cells: the kinds of which not all is right, and the sum."""
    return [*tables.table(HEAD, [c for c in lines if c[HEAD.index("all right")] != c[1] or c[0] == "all"]), "",
            f"Each kind: {tables.put('repair-known', HEAD, lines)}.", "",
            f"The {len(failed)} that failed, and what was wrong: {tables.put('repair-known-failed', FAILED_HEAD, failed)}."]


def page(rows, command):
    failed = [r for r in rows if r["wrong"]]
    return [
        "# Damaged models whose answer is known", "", f"{written_by(command, {r['origin'] for r in rows})}.", "",
        f"{len(rows)} clean models, fetched and generated, damaged in known ways (`bench/models/damage_models.py` says how), repaired and",
        "meshed with default options and `--sheets drop`, and measured against the undamaged model (`bench/judges/judge_answer.cpp`), which repair never sees:", "",
        f"- **All right**: the repaired surface and the mesh pass every test below.",
        "- **topology**: valid, 2-manifold; components, shells and genus those of the undamaged model, where they are known (not the",
        "  genus of united copies that are not convex).",
        f"- **farthest**: two-sided distance to the undamaged model at most {100 * TOLERANCE:g} % of the diagonal for the repaired surface, the tolerance,",
        f"  and {100 * MESH_DISTANCE:g} % for the mesh, as near as to a clean surface, but {100 * MESH_AT_DAMAGE:g} % at the damage: where the nearest triangle of the",
        "  undamaged model was no longer there as it had been. Not in a hole's zone: the convex hull of what was taken away,",
        "  grown by a tenth of its diameter.",
        f"- **volume** within {VOLUME:g} % ({VOLUME_OF_LARGEST:g} % with holes of a tenth of the area).",
        "- **wrong sides**: of 10,000 points a model, half of them near the surface but not within .5 % of the diagonal nor in a",
        "  hole's zone, those that lie inside the one and outside the other.",
        f"- **sharp edges** (over 30°) that no defect touches: at most {EDGES:g} of the diagonal away.", "",
        *shown(lines_of(rows), [[r["case"], r["kind"], r["model"], r["what"], "; ".join(r["wrong"])] for r in failed])]


# --------------------------------------------------------------------------------------------------------- main


def clean_models(build, a):
    failed = asked = 0
    for name in damage.model_names(a.generated):
        what = do_clean(build, name, a)
        asked += what is not None
        if what:
            failed += 1
            print(f"{name}: {what}", flush=True)
    print(f"{asked - failed} of {asked} clean models untouched")
    return failed


def campaign(build, a):
    first, _, end = a.cases.partition(":")
    numbers = range(int(first), int(end or int(first) + 1))
    done = [json.loads(text) for text in a.lines.open()] if a.lines and a.lines.exists() else []
    left = sorted(set(numbers) - {r["case"] for r in done})
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for row in pool.map(lambda n: do_case(build, n, a), left):
            done.append(row)
            if a.lines:
                with a.lines.open("a") as f:
                    f.write(json.dumps(row) + "\n")
            if row["wrong"]:
                print(f"{row['case']:4} {row['kind']} {row['model']}, {row['what']}: {'; '.join(row['wrong'])}", flush=True)
    rows = sorted((r for r in done if r["case"] in numbers), key=lambda r: r["case"])
    print("\n".join(tables.table(HEAD, lines_of(rows))))
    if a.page:
        tables.write("repair-known", page(rows, f"bench/run.sh known_answers --cases {a.cases} --page"))
    return sum(bool(r["wrong"]) for r in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--cases", default=f"0:{damage.CASES}")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kinds", default=",".join(damage.damages.KINDS))
    parser.add_argument("--generated", action="store_true", help="generated shapes only, whatever was fetched")
    parser.add_argument("--clean", action="store_true")
    parser.add_argument("--lines", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--steps", default="repair,mesh", help="or one of them alone")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=60, help="processor seconds for each run")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    sys.exit(1 if (clean_models if a.clean else campaign)(a.build, a) else 0)


if __name__ == "__main__":
    main()
