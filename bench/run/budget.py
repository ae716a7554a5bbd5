"""Meshes models at automatic size, and writes docs/measured/budget-status.md: the budget of elements, what was made of it, how long
that took, and what was given up.

Usage: bench/run.sh budget [--only SUBSTRING] [--timeout CPU_SECONDS] [--before PROGRAM] [--gmsh] [--page NAME] [--title TITLE]
                           [FOLDER_OR_FILE ...]
Without folders: models/clean, models/dirty, and models/derived where there is one. One model at a time, on one thread.
--before: another octafront on the same models. --gmsh: Gmsh on CAD files, as its users run it, with 12 elements a turn.
"""
import argparse
import collections
import json
import pathlib
import shutil
import statistics
import tempfile

from bench.ours import counter
from bench.pages.origin import written_by
from bench.pages.tables import put, spread, write
from bench.process import run_bounded, run_measured

CAD = (".step", ".stp", ".brep", ".iges", ".igs")
OVER = 1.3  # met within 30 %


def mesh(program, model, seconds):
    """The report, or the exit status as a word."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "report.json")
        status, _, _, _ = run_bounded([program, "mesh", model, "-o", pathlib.Path(folder, "mesh.msh"), "--json", report, "-q", "--threads", "1"], seconds)
        if status is None:
            return f"no end in {seconds} CPU s"
        return json.loads(report.read_text()) if status == 0 else f"exit {status}"


def gmsh(model, seconds):
    """Tetrahedra and CPU seconds, or None."""
    with tempfile.TemporaryDirectory() as folder:
        part = pathlib.Path(folder, "part" + {".stp": ".step", ".igs": ".iges"}.get(model.suffix, model.suffix))
        shutil.copy(model, part)
        run = run_measured(["gmsh", "-3", part, "-clcurv", "12", "-nt", "1", "-o", "out.mesh"], folder, seconds)
        out = pathlib.Path(folder, "out.mesh")
        lines = out.read_text().split("\n") if not run.error and out.exists() else []
        at = next((i for i, line in enumerate(lines) if line.strip() == "Tetrahedra"), None)
        return None if at is None else (int(lines[at + 1]), run.cpu_seconds)


def figures(model, report):
    triangles = counter(report, "surface front", "triangles")
    notes = [n for s in report["stages"] for n in s["notes"]]
    return {
        "model": model.name, "faces": int(counter(report, "repair", "triangles")),
        "budget": counter(report, "size field", "budget of elements"), "said": report["expected_tets"],
        "tets": report["tets"], "cpu": report["cpu_seconds"], "memory": report["peak_memory_bytes"],
        "rounds": int(counter(report, "surface front", "rounds")),
        "beta": report["quality"]["beta_min"], "angle": report["quality"]["dihedral_min_degrees"],
        "work": counter(report, "surface front", "triangles of all rounds") / max(1, triangles),
        "spent": any("has a budget of" in n for n in notes),
        "raised": any("automatic sizes are no smaller than" in n for n in notes)}


def given_up(row):
    return "strips or nearness" if row["spent"] else "details" if row["raised"] else ""


def beside(rows, key, name):
    """What others made of the models that they could mesh, too."""
    both = [r for r in rows if r.get(key)]
    if not both:
        return []
    times = sorted(r["tets"] / r[key][0] for r in both)
    ours, theirs, cpu = sum(r["tets"] for r in both), sum(r[key][0] for r in both), [r["cpu"] / max(.01, r[key][1]) for r in both]
    return ["", f"Beside {name}, {len(both)} models: {ours:,} elements against {theirs:,} ({ours / theirs:.2f} times); by model {statistics.median(times):.2f} "
            f"times in the median, {times[int(.95 * (len(times) - 1))]:.2f} at 95 %, {times[-1]:.2f} at most, above 8 times: {sum(t > 8 for t in times)}; "
            f"CPU seconds {statistics.median(cpu):.2f} times in the median."]


HEAD = ["model", "triangles", "budget", "said", "made", "before", "Gmsh", "least β", "least angle", "rounds", "work", "CPU s", "MB", "given up"]


def cells(r):
    before, other = (f"{r[key][0]:,}" if r.get(key) else "" for key in ("before", "gmsh"))
    return [r["model"], f"{r['faces']:,}", f"{r['budget']:,.0f}", f"{r['said']:,.0f}", f"{r['tets']:,}", before, other, f"{r['beta']:.3f}", f"{r['angle']:.1f}",
            r["rounds"], f"{r['work']:.1f}", f"{r['cpu']:.1f}", f"{r['memory'] / 1e6:.0f}", given_up(r)]


def tables(name, rows, failed):
    """Rows of cells, and (model, why) of those that were not meshed."""
    refused = collections.defaultdict(list)
    for model, why in failed:
        refused[why].append(model)
    lines = [*spread(HEAD, rows, [c for c in HEAD[1:-1] if c not in ("triangles", "before", "rounds", "work") and any(r[HEAD.index(c)] for r in rows)]), "", f"Each: {put(name, HEAD, rows)}."]
    return lines + (["", "Not meshed:", "", *(f"- {why}: {', '.join(models)}" for why, models in sorted(refused.items()))] if failed else [])


def page(options, rows, failed, command):
    over = [r for r in rows if r["budget"] and r["tets"] > OVER * r["budget"]]
    off = [r for r in rows if abs(r["said"] / r["tets"] - 1) > OVER - 1]
    lines = [
        f"# {options.title}", "",
        f"{written_by(command)}, on one thread; the budget: `docs/how/sizes-and-surface.md`. *Said* is the prediction once the surface is made, which is what `--dry-run` "
        "says; *least β* and *least angle* (dihedral, degrees) are of the worst element, forced by the input or not.", "",
        f"{len(rows)} models meshed, {len(failed)} not. Above 1.3 times the budget: **{len(over)}**"
        + (" (" + ", ".join(r["model"] for r in over) + ")" if over else "")
        + f". Said and made more than 30 % apart: **{len(off)}**"
        + (" (" + ", ".join(r["model"] for r in off) + ")" if off else "")
        + f". Budget spent: {sum(r['spent'] for r in rows)}. Most elements: {max(r['tets'] for r in rows):,}. "
        f"Most CPU time: {max(r['cpu'] for r in rows):.1f} s. Most memory: {max(r['memory'] for r in rows) / 1e6:.0f} MB.",
        f"Least angle: {sum(r['angle'] < 5 for r in rows)} models below 5°, {sum(r['angle'] < 15 for r in rows)} below 15°, "
        f"{statistics.median(r['angle'] for r in rows):.1f}° in the median."]
    print(*beside(rows, "before", "the program before"), sep="\n")
    lines += beside(rows, "gmsh", "Gmsh with 12 elements a turn")
    return [*lines, "", *tables(options.page, [cells(r) for r in rows], failed)]


def models(paths):
    for path in map(pathlib.Path, paths):
        yield from sorted(path.iterdir()) if path.is_dir() else [path]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=int, default=300)
    parser.add_argument("--page", default="budget-status", help="which page of docs/measured is written")
    parser.add_argument("--title", default="The budget of automatic sizes")
    parser.add_argument("--before", type=pathlib.Path)
    parser.add_argument("--gmsh", action="store_true")
    options = parser.parse_args()
    paths = options.paths or [f for f in ("models/clean", "models/dirty", "models/derived") if pathlib.Path(f).is_dir()]
    command = " ".join(["bench/run.sh budget", *(["--page", options.page] if options.page != "budget-status" else []), *options.paths])
    rows, failed = [], []
    for model in models(paths):
        if options.only not in model.name:
            continue
        report = mesh(options.build / "cli/octafront", model, options.timeout)
        if isinstance(report, str):
            failed.append((model.name, report))
            print(f"{model.name:32} {report}", flush=True)
        else:
            rows.append(figures(model, report))
            if options.before:
                other = mesh(options.before, model, options.timeout)
                rows[-1]["before"] = None if isinstance(other, str) else (other["tets"], other["cpu_seconds"])
            if options.gmsh and model.suffix in CAD:
                rows[-1]["gmsh"] = gmsh(model, options.timeout)
            print(f"{model.name:32} {rows[-1]['tets']:>10,} of {rows[-1]['budget']:>10,.0f} {rows[-1]['cpu']:6.1f} s "
                  f"{given_up(rows[-1])}", flush=True)
        if rows and not options.only:
            write(options.page, page(options, rows, failed, command))


if __name__ == "__main__":
    main()
