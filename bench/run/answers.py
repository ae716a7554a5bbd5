"""What are elements worth? Bodies with known answers, meshed by Octafront, Gmsh and Netgen, solved by CalculiX: errors against unknowns and time.

Usage: bench/run.sh answers [--only CASE] [--missing] [--constants] [--program OCTAFRONT]
Each body (answers_cases.py) is meshed from the same STEP file, in first and second order: with each mesher's defaults, with sizes that would give about 500 to
60,000 elements were nothing finer, and, second order, with more elements a turn; a row of runs ends where its stress is good enough or a run would be
too large. --constants: three of the bodies at several sizes, elements a turn and gradations, which automatic sizes choose from.
CPU seconds of whole processes, one thread. What was found is kept in BUILD/experiments/answers.json (--missing: only what is not there), from which
docs/measured/answers.md is written.
"""
import argparse
import dataclasses
import json
import pathlib
import tempfile

from bench.judges.answers_solved import solve
from bench.models.answers_cases import all_cases
from bench.models.answers_planar import write_step
from bench.pages import answers_page as page
from bench.pages.origin import ORIGIN
from bench.run import answers_meshers as meshers
from bench.run.answers_check import check

SOLVE_SECONDS, MESH_SECONDS = 60, 60
MOST_UNKNOWNS = 110_000  # CalculiX's direct solver takes 40 s for 90,000 in the cube about the cavity, where they are the dearest
GOOD_ENOUGH = 0.4  # percent of stress; finer runs of a row would say nothing of 1 %
COUNTS = {1: (2_000, 8_000, 20_000, 60_000), 2: (500, 2_000, 8_000, 20_000)}
TURNS = (18, 24, 36, 48, 72)
REGULAR = 0.118  # volume of a regular tetrahedron of edge 1


@dataclasses.dataclass
class Run:
    """A mesher with options. Runs of one `row` come coarse first."""
    who: str
    what: str
    row: str
    mesher: object


def sizes(volume, order):
    return [(volume / (REGULAR * count)) ** (1 / 3) for count in COUNTS[order]]


def runs(program, order, volume, diagonal):
    octafront, gmsh, netgen = meshers.octafront, meshers.gmsh, meshers.by_netgen
    made = [Run("Octafront", name, "default", octafront(program, *more)) for name, more in
            (("draft", ("--preset", "draft")), ("standard", ()), ("fine", ("--preset", "fine")))]
    made += [Run("Gmsh", "12 a turn", "default", gmsh("-clcurv", 12)), Run("Netgen", "its defaults", "default", netgen(diagonal))]
    for size in sizes(volume, order):
        h = f"{size:.3g}"
        made += [Run("Octafront", "size " + h, "size", octafront(program, "--size", h)), Run("Gmsh", "size " + h, "size", gmsh("-clcurv", 12, "-clmax", h)),
                 Run("Netgen", "size " + h, "size", netgen(h))]
    for turn in TURNS if order == 2 else ():
        made += [Run("Octafront", f"{turn} a turn", "turn", octafront(program, "--curvature", turn)), Run("Gmsh", f"{turn} a turn", "turn", gmsh("-clcurv", turn))]
    return made


CONSTANTS_OF = ("plate, hole of 0.3 of its width", "stepped shaft", "cavity")
PARTS, NOTCH_TURNS, GRADATIONS = (7, 10, 14, 20, 28), (8, 12, 16, 20, 32, 48), (.12, .2, .3, .4, .6, .8)


def constants(program, diagonal):
    """Rows by what stays; along each elements a turn grow."""
    def run(row, part, turn, *more):
        return Run("Octafront", f"{turn} a turn", "constant " + row, meshers.octafront(program, "--size", f"{diagonal / part:.4g}", "--curvature", turn, *more))
    return ([run(f"diagonal/{part}", part, turn) for part in PARTS for turn in NOTCH_TURNS] +
            [run(f"diagonal/14, gradation {g}", 14, turn, "--gradation", g) for g in GRADATIONS for turn in NOTCH_TURNS])


def measured(case, step, run, order):
    outcome, mesh = meshers.meshed(run.mesher, step, order, MESH_SECONDS)
    found = {"mesh": outcome.cpu_seconds}
    if outcome.error:
        return found | {"error": outcome.error}
    problem = case.problem(mesh)
    found |= {"elements": len(mesh.elements), "unknowns": problem.unknowns()}
    if problem.unknowns() > MOST_UNKNOWNS:
        return found | {"error": "not solved: too large"}
    solved, primary, stress = solve(problem, SOLVE_SECONDS)
    found["solve"] = solved.cpu_seconds
    return found | ({"error": "CalculiX: " + solved.error} if solved.error else {k: float(v) for k, v in case.errors(problem, primary, stress).items()})


class Kept:
    def __init__(self, path):
        self.path = path
        self.found = json.loads(path.read_text()) if path.is_file() else {"cases": {}, "runs": {}}

    def keep(self, key, row):
        self.found["runs"][key] = row
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps(self.found, indent=1))


def ended(done, run):
    """Whether a row of runs needs no finer one."""
    before = [r for r in done if (r["who"], r["row"]) == (run.who, run.row)]
    return run.row != "default" and bool(before) and (before[-1].get("error", "").startswith("not solved") or abs(before[-1].get("stress", 100)) < GOOD_ENOUGH)


def campaign(a, kept, case, step, todo, order):
    done = []
    for run in todo:
        key = f"{case.name}|{run.row}|{run.who}|{run.what}|{order}"
        if ended(done, run):
            continue
        if not (a.missing and key in kept.found["runs"]):
            row = {"case": case.name, "who": run.who, "what": run.what, "row": run.row, "order": order, "origin": ORIGIN}
            kept.keep(key, row | measured(case, step, run, order))
            print(*page.cells(kept.found["runs"][key]), flush=True)
        done.append(kept.found["runs"][key])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("--constants", action="store_true")
    parser.add_argument("--program", type=pathlib.Path)
    a = parser.parse_args()
    check()
    program = (a.program or a.build / "cli/octafront").resolve()
    kept = Kept(a.build / "experiments/answers.json")
    for case in all_cases():
        if a.only not in case.name or (a.constants and case.name not in CONSTANTS_OF):
            continue
        kept.found["cases"][case.name] = case.says
        with tempfile.TemporaryDirectory() as folder:
            step = pathlib.Path(folder) / "body.step"
            volume, diagonal = write_step(case.build, step)
            for order in (2,) if a.constants else (1, 2):
                campaign(a, kept, case, step, constants(program, diagonal) if a.constants else runs(program, order, volume, diagonal), order)
    page.write(kept.found, GOOD_ENOUGH, MOST_UNKNOWNS)


if __name__ == "__main__":
    main()
