"""Repairs and meshes the defective models of bench/models/models.csv and judges what came out; writes docs/measured/repair-status.md.

Usage: bench/run.sh repair [--only SUBSTRING] [--jobs N] [--timeout SECONDS] [--lines FILE] [--near FACES] [--second-reader]
Each model: `octafront repair MODEL -o SURFACE.obj` and `octafront mesh MODEL -o MESH.vtu`, default options, one thread;
of models of FACES at most another mesh with --max-deviation of a thousandth of the diagonal. All files are read back and
measured by octafront_judge_repair. --lines keeps a JSON object for each model in FILE and leaves out those that are there.
--second-reader has meshio read the meshes, too, and counts anew (python3-meshio).
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile

from bench.pages import tables
from bench.pages.origin import ORIGIN, written_by
from bench.process import run_bounded

TOLERANCE = 1e-3   # of the diagonal
ANGLES = (10, 160)  # degrees that no element should leave, but where the input forces it
# fTetWild on 35 of these models (docs/measured/experiments.md says how others are run): what is to be beaten.
FTETWILD = {"meshed": "34 of 35", "CPU s": 25, "mean beta": 0.766, "angles": (8.7, 163), "farthest": 0.63, "not manifold": "17 of 34"}


def second_opinion(file):
    """What meshio and NumPy count in a mesh: {"tets", "inverted", "faces_of_three", "edges_not_of_two"}."""
    import meshio
    import numpy as np
    mesh = meshio.read(file)
    tets = np.concatenate([c.data for c in mesh.cells if c.type == "tetra"])
    a, b, c, d = (mesh.points[tets[:, k]] for k in range(4))
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)
    faces = np.sort(np.concatenate([tets[:, k] for k in ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])]), axis=1)
    faces, uses = np.unique(faces, axis=0, return_counts=True)
    skin = faces[uses == 1]
    edges = np.concatenate([skin[:, [0, 1]], skin[:, [1, 2]], skin[:, [0, 2]]])
    return {"tets": len(tets), "inverted": int((volume <= 0).sum()), "faces_of_three": int((uses > 2).sum()),
            "edges_not_of_two": int((np.unique(edges, axis=0, return_counts=True)[1] != 2).sum())}


def measure(build, model, result):
    done = subprocess.run([build / "bench/octafront_judge_repair", model, result], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else {"unreadable": done.stderr.strip()}


def do_model(build, row, a):
    model = pathlib.Path("models/dirty", row["file"])
    out = {"file": row["file"], "defects": row["defects"], "faces": row["faces"], "origin": ORIGIN}
    steps = [("repair", "repair", "surface.obj"), ("mesh", "mesh", "mesh.vtu")]
    if int(row["faces"]) <= a.near:
        steps.append(("near", "mesh", "near.vtu"))
    with tempfile.TemporaryDirectory() as folder:
        for step, command, name in steps:
            result, report = pathlib.Path(folder, name), pathlib.Path(folder, step + ".json")
            options = ["--threads", "1"] if command == "mesh" else []
            if step == "near":
                if "boundary_from_input" not in out["repair"]:
                    continue
                options += ["--max-deviation", repr(TOLERANCE * out["repair"]["report"]["repair"]["diagonal"])]
            status, message, seconds, megabytes = run_bounded(
                [build / "cli/octafront", command, model, "-o", result, "--json", report, "-q", *options], a.timeout)
            out[step] = {"status": status, "message": message, "cpu_seconds": seconds, "megabytes": megabytes}
            if status != 0:
                continue
            out[step] |= measure(build, model, result)
            out[step]["report"] = json.loads(report.read_text())
            if step == "mesh" and a.second_reader:
                out[step]["second"] = second_opinion(result)
    return out


# ------------------------------------------------------------------------------------------------------ words


def done_to(row):
    """What repair says it did, in short."""
    report = row["repair"].get("report", {}).get("repair", {})
    if not report:
        return ""
    if report.get("clean"):
        return "nothing to do"
    return "; ".join(report.get("notes", []))[:400]


def verdict(row):
    mesh = row["mesh"]
    if mesh["status"] is None:
        return "**no end**"
    if mesh["status"] == 3:
        return "refused"
    if mesh["status"] != 0:
        return f"**status {mesh['status']}**"
    wrong = mesh.get("defect") or mesh.get("unreadable") or (mesh["bad_edges"] and "edges") or (mesh["bad_vertices"] and "vertices")
    second = mesh.get("second", {})
    wrong = wrong or any(second.get(k) for k in ("inverted", "faces_of_three", "edges_not_of_two"))
    return f"**INVALID: {wrong}**" if wrong else "mesh"


def far_of(made):
    """The farthest point from the input, but for what closes holes."""
    return max(made["boundary_from_input"]["distance"], made["moved_from_input"]["distance"])


def near(made):
    """What it costs to be nearer."""
    if "tets" not in made:
        return [made.get("message", "")[:80], "", ""]
    return [mille(far_of(made)), f"{made['tets']:,}", f"{made['cpu_seconds']:.1f}"]


def mille(value):
    return f"{1e3 * value:.2f}"


HEAD = ["model", "known defects", "faces", "result", "surface from input, ‰", "mesh from input elsewhere, ‰", "near what was moved, ‰",
        "held to 1 ‰: from input, ‰", "held: tets", "held: CPU s", "closed, % of area", "input lost outside, % of area", "lost inside, % of area",
        "only input, only mesh inside, points", "bodies", "tets", "least angle °", "most °", "mean β", "CPU s repair", "CPU s mesh", "MB",
        "what was done, or why not"]


def cells_of(row):
    mesh, surface = row["mesh"], row["repair"]
    cells = [row["file"], row["defects"], row["faces"], verdict(row)]
    if "tets" not in mesh or "boundary_from_input" not in surface:
        words = next((w for w in mesh["message"].replace("octafront: ", "").splitlines() if w.strip()), "")
        return cells + [""] * (len(HEAD) - 5) + [words[:200]]
    sides = mesh["sides"]
    cells += [mille(far_of(surface)), mille(mesh["boundary_from_input"]["distance"]), mille(mesh["moved_from_input"]["distance"]), *near(row.get("near", {})),
              f"{100 * surface['closed_area']:.2f}", f"{100 * surface['lost_outside']:.2f}", f"{100 * surface['lost_inside']:.2f}",
              f"{sides['only_input_inside']}, {sides['only_result_inside']} of {sides['asked']}", mesh["components"],
              f"{mesh['tets']:,}", f"{mesh['dihedral_min']:.1f}", f"{mesh['dihedral_max']:.1f}", f"{mesh['beta_mean']:.3f}", f"{surface['cpu_seconds']:.2f}",
              f"{mesh['cpu_seconds']:.1f}", f"{mesh['megabytes']:.0f}", done_to(row)]
    return cells


def summary(rows):
    made = [r["mesh"] for r in rows if "tets" in r["mesh"]]
    surfaces = [r["repair"] for r in rows if "boundary_from_input" in r["repair"]]
    if not made or not surfaces:
        return ["Nothing was meshed."]

    def far(its):
        return sorted(1e3 * far_of(m) for m in its)

    def counted(distances):
        return (f"median {statistics.median(distances):.2f} ‰, greatest {distances[-1]:.2f} ‰; above {1e3 * TOLERANCE:g} ‰: "
                f"{sum(f > 1e3 * TOLERANCE * 1.0001 for f in distances)}")
    moved = sorted(1e3 * m["moved_from_input"]["distance"] for m in made if m["moved_from_input"]["distance"] > 0)
    both = [r for r in rows if "tets" in r.get("near", {})]
    nearer = [r["near"] for r in both]
    worst = [f"{min(m['dihedral_min'] for m in made):.2f}", f"{max(m['dihedral_max'] for m in made):.2f}"]
    return [
        f"- **{len(made)} of {len(rows)} meshed**, {sum(verdict(r) == 'mesh' for r in rows)} valid and 2-manifold; "
        f"{sum(verdict(r) == 'refused' for r in rows)} refused, {sum('**' in verdict(r) for r in rows)} else.",
        f"- Farthest point from the input, outside what was closed: of the repaired surface {counted(far(surfaces))}.",
        f"- Of the mesh near what repair moved, on {len(moved)} models: {counted(moved)}." if moved else "- Nothing was moved.",
        f"- Of the mesh elsewhere, where it is as near as to a clean surface (4 ‰): "
        f"{counted(sorted(1e3 * m['boundary_from_input']['distance'] for m in made))}.",
        *([f"- With `--max-deviation` of a thousandth of the diagonal, {len(nearer)} meshed: {counted(far(nearer))}; "
           f"CPU s median {statistics.median(m['cpu_seconds'] for m in nearer):.1f}, greatest {max(m['cpu_seconds'] for m in nearer):.1f}; "
           f"elements {sum(m['tets'] for m in nearer) / sum(r['mesh']['tets'] for r in both):.1f} times in all."] if nearer else []),
        f"- Angles over all: {worst[0]}–{worst[1]}°; within {ANGLES[0]}–{ANGLES[1]}°: "
        f"{sum(m['dihedral_min'] >= ANGLES[0] and m['dihedral_max'] <= ANGLES[1] for m in made)} models. "
        f"Mean β: median {statistics.median(m['beta_mean'] for m in made):.3f}.",
        f"- CPU s: repair median {statistics.median(s['cpu_seconds'] for s in surfaces):.2f}, greatest {max(s['cpu_seconds'] for s in surfaces):.1f}; "
        f"all of `mesh` median {statistics.median(m['cpu_seconds'] for m in made):.1f}, greatest {max(m['cpu_seconds'] for m in made):.1f}. Memory: greatest {max(m['megabytes'] for m in made):.0f} MB.",
        f"- fTetWild on 35 of them: {FTETWILD['meshed']} meshed, median {FTETWILD['CPU s']} CPU s, farthest {FTETWILD['farthest']} ‰, "
        f"angles {FTETWILD['angles'][0]}–{FTETWILD['angles'][1]}°, mean β {FTETWILD['mean beta']}, not manifold {FTETWILD['not manifold']}."]


def each(rows):
    """Rows of cells."""
    return [f"Each, and what was done to it: {tables.put('repair-status', HEAD, rows)}."]


def page(rows):
    return ["# Defective models", "",
            f"{written_by('bench/run.sh repair', {r['origin'] for r in rows})}. Models: `bench/models/get-models.sh`. Distances in ‰ of the diagonal, measured by "
            "sampling from the boundary to the input, except where what closes a hole is nearest. *Lost*: the part of the input's area farther than 1 ‰ from the "
            "boundary, and outside of it (sheets, fins) or inside (inner walls, debris). In the rows, defects: O open, E non-manifold edge, V non-manifold vertex, "
            "S self-intersection, R misoriented, I inside out, D degenerate, U unused vertices; *only input, only mesh inside*: random points where the input's generalised winding number is sure and the mesh says else.", "",
            *summary(rows), "", *each([cells_of(r) for r in rows]), "", "![before and after](../images/repair.png)"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=120, help="processor seconds for each run")
    parser.add_argument("--lines", type=pathlib.Path)
    parser.add_argument("--near", type=int, default=0, metavar="FACES",
                        help="models of so many faces at most also with --max-deviation of a thousandth of the diagonal")
    parser.add_argument("--second-reader", action="store_true")
    a = parser.parse_args()
    models = [r for r in csv.DictReader(open("bench/models/models.csv")) if r["set"] == "dirty" and a.only in r["file"]]
    done = {r["file"]: r for r in map(json.loads, a.lines.open())} if a.lines and a.lines.exists() else {}
    left = [r for r in models if r["file"] not in done]
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for row in pool.map(lambda r: do_model(a.build, r, a), left):
            done[row["file"]] = row
            if a.lines:
                with a.lines.open("a") as f:
                    f.write(json.dumps(row) + "\n")
            print(tables.row(cells_of(row)), flush=True)
    rows = [done[r["file"]] for r in models]
    print("\n".join(summary(rows)))
    if not a.only:
        tables.write("repair-status", page(rows))


if __name__ == "__main__":
    main()
