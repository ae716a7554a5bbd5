"""Improvement against its targets, on our own meshes and on those of others: writes docs/measured/improve-bench.md.

Usage: bench/run.sh improve [--generated N] [--skip-peers]

1. Smooth and CAD models at about 200,000 elements, surface front, levels default and best: every target in a table.
   Sizes as --elements chooses them, following curvature and gaps; smooth models also at one size everywhere.
2. Never worse: all levels on N generated meshes and on every clean model, every pass watched (octafront_never_worse).
3. Start meshes of TetGen, Netgen and Gmsh on kept surfaces, made without their optimisers; then the same start mesh by
   their own optimiser, and by octafront improve with the boundary kept.
CPU time is user and system time of one thread; octafront_evaluate reads every mesh back and judges it.
"""
import argparse
import collections
import csv
import json
import pathlib
import re
import shutil
import sys
import tempfile

from bench import ours
from bench.off import read_off
from bench.pages import tables
from bench.pages.origin import written_by
from bench.peers import gmsh, netgen, surfaces, tetgen
from bench.process import finish, run_measured

SMOOTH = ["bunny00.off", "elephant.off", "refined_elephant.off", "armadillo.off", "hand.off", "knot1.off", "femur.off",
          "bear.off", "homer.off"]
CAD = ["fandisk.off", "joint.off", "anchor.off", "couplingdown.off", "rotor.off", "pinion.off", "part.off", "hinge.stl"]
PEER_MODELS = ["bunny00.off", "elephant.off", "fandisk.off"]
ELEMENTS = 200_000
PEER_ELEMENTS = 60_000
ELEMENTS_OF_UNIT_SIZE = 9.4  # elements of size 1 in a volume of 1, as the lattice makes them, measured
ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT = 300

# (name, better if larger, default, best, as printed)
TARGETS = {
    "smooth": {"default": dict(beta_min=.4, good=94, beta_mean=.925, dihedral_min=22, dihedral_max=142, us=1),
               "best": dict(dihedral_min=28, dihedral_max=135, beta_mean=.92, us=20)},
    "CAD": {"default": dict(beta_min=.2, dihedral_min=10), "best": dict(beta_min=.2, dihedral_min=10)},
}
TARGETS["smooth, one size"] = TARGETS["smooth"]
COLUMNS = {"beta_mean": ("mean β", "{:.3f}", True), "good": ("above .8, %", "{:.1f}", True),
           "beta_min": ("min β", "{:.3f}", True), "dihedral_min": ("min dihedral °", "{:.1f}", True),
           "dihedral_max": ("max dihedral °", "{:.1f}", False), "us": ("µs per element", "{:.2f}", False)}


def octafront(build, *arguments):
    return run_measured([build / "cli/octafront", *arguments], ".", TIMEOUT)


def judged(build, mesh, *surface):
    r, why = ours.evaluated(build, mesh, *surface)
    if why:
        raise SystemExit(f"{mesh}: {why}")
    r["good"] = 100 * r["beta_classes"][4] / r["tets"]
    return r


def cells(r, targets):
    out = []
    for key, (_, form, larger) in COLUMNS.items():
        text = form.format(r[key]) if key in r else "-"
        missed = key in targets and key in r and (r[key] < targets[key] if larger else r[key] > targets[key])
        out.append(f"**{text}**" if missed else text)
    return out


def one_size(build, source, folder):
    """The size that gives about ELEMENTS elements everywhere: measured once coarsely, elements go like its third power."""
    done = ours.mesh(build / "cli/octafront", source, folder, TIMEOUT, "--elements", ELEMENTS // 10, "--improve", "none", threads=0)
    if done.error:
        return None
    volume = done.report["volume"]
    return (ELEMENTS_OF_UNIT_SIZE * volume / ELEMENTS) ** (1 / 3)


HEAD = ["models and level", "model", "elements", *(c[0] for c in COLUMNS.values()), "below .4", "not forced", "edge over wanted", "Hausdorff %", "check"]


def own_meshes(build, kind, models, folder):
    """Rows of the table of models; a figure in bold misses its target."""
    rows = []
    failed = lambda level, model, why: [f"{kind}, {level}", model, *[""] * (len(HEAD) - 3), why]
    for model in models:
        source = f"models/clean/{model}"
        sizes = ["--elements", ELEMENTS]
        if kind == "smooth, one size":
            h = one_size(build, source, folder)
            if h is None:
                rows.append(failed("default", model, "no mesh"))
                continue
            sizes = ["--size", f"{h:.6g}"]
        for level in ("default", "best"):
            done = ours.mesh(build / "cli/octafront", source, folder, TIMEOUT, *sizes, "--improve", level)
            if done.error:
                rows.append(failed(level, model, done.error))
                continue
            r = judged(build, done.mesh, source)
            improve = ours.stage(done.report, "improve")
            r["us"] = 1e6 * improve["cpu_seconds"] / r["tets"]
            count = improve["counters"]
            below = [f"{count['elements below 0.4']:.0f}", f"{count['not forced']:.0f}"]
            ratio = done.report["volume_edges"]["mean_ratio"]
            rows.append([f"{kind}, {level}", model, f"{r['tets']:,}", *cells(r, TARGETS[kind][level]), *below, f"{ratio:.3f}",
                         f"{r['hausdorff_percent']:.3f}", "valid" if not r["defect"] else "INVALID"])
            print(" | ".join(rows[-1]), flush=True)
    return rows


def never_worse(build, generated, folder):
    pairs, refused = [], []
    for row in csv.DictReader(open("bench/models/models.csv")):
        if row["set"] != "clean":
            continue
        source = pathlib.Path("models/clean", row["file"])
        mesh = folder / f"{source.stem}.vtu"
        done = octafront(build, "mesh", source, "-o", mesh, "--improve", "none", "--elements", 20000, "-q")
        (refused if done.error else pairs).append((mesh, source))
    command = [build / "bench/octafront_never_worse", "--generated", generated]
    done = run_measured([*command, *(p for pair in pairs for p in pair)], ".", 3600)
    start = done.log.find("{")
    if start < 0:
        return [f"The campaign did not end: {done.error}", ""]
    r = json.loads(done.log[start:])
    text = [f"{r['meshes']:,} meshes ({len(pairs)} of {len(pairs) + len(refused)} clean models at about 20,000 elements with "
            f"their boundary free to slide, the rest generated: shaken grids, and what boundary recovery makes of nasty "
            f"surfaces; {r['skipped']} surfaces gave no start mesh), four levels each: {r['runs']:,} runs, "
            f"{r['passes']:,} passes. **{len(r['failures'])} failures.**", ""]
    print(text[0], flush=True)
    return text + [f"- {n} times: {failure}" for failure, n in collections.Counter(r["failures"]).most_common(20)] + [""]


def kept_surface(build, model, folder):
    """The surface of the model at a size for about PEER_ELEMENTS elements, as the peers read it."""
    report, out = folder / "size.json", folder / f"{pathlib.Path(model).stem}.off"
    octafront(build, "surface", f"models/clean/{model}", "--elements", PEER_ELEMENTS, "-o", out, "-q")
    return out


def run_tetgen(surface, folder, optimization, out):
    shutil.copy(surface, folder / "in.off")
    h = surfaces.mean_edge(*read_off(surface))
    flags = f"-pYqa{tetgen.VOLUME_FACTOR * h**3 / 72**.5:.9g}O{optimization}"
    done = run_measured(["tetgen", flags, "in.off"], folder, TIMEOUT)
    if not done.error:
        tetgen.to_medit(folder / "in.1", folder / out)
    seconds = re.search(r"(?:Optimization|Mesh optimization|Improvement) seconds:\s*([\d.]+)", done.log, re.IGNORECASE)
    done.stage_seconds = float(seconds[1]) if seconds else None
    return finish(done, folder / out)


def start_tetgen(surface, folder):
    folder.joinpath("surface").write_text(str(surface))
    return run_tetgen(surface, folder, "0/0", "start.mesh")


def optimize_tetgen(start, folder):
    """It optimises only what it has just refined: the same steps again, and then its optimiser."""
    return run_tetgen(folder.joinpath("surface").read_text(), folder, "9/7", "own.mesh")


def start_gmsh(surface, folder):
    done = gmsh.fill_delaunay(surface, folder, TIMEOUT, optimize=False)
    if done.mesh:
        shutil.copy(done.mesh, folder / "start.msh")
    return finish(done, folder / "start.msh")


def optimize_gmsh(start, folder):
    done = run_measured([sys.executable, "-m", "bench.peers.gmsh_optimize", start.resolve(), (folder / "own.msh").resolve()],
                        ROOT, TIMEOUT)
    seconds = re.search(r"Done optimizing mesh \(Wall [\d.e+-]+s, CPU ([\d.e+-]+)s\)", done.log)
    done.stage_seconds = float(seconds[1]) if seconds else None
    return finish(done, folder / "own.msh")


def start_netgen(surface, folder):
    done = netgen.fill(surface, folder, TIMEOUT, optimize=False)
    if done.mesh:
        shutil.copy(done.mesh, folder / "start.mesh")
        folder.joinpath("surface").write_text(str(surface))
        folder.joinpath("seconds").write_text(str(done.stage_seconds))
    return finish(done, folder / "start.mesh")


def optimize_netgen(start, folder):
    """Its library optimises only what it has just meshed: the front again, the same, and then its optimiser."""
    done = netgen.fill(folder.joinpath("surface").read_text(), folder, TIMEOUT)
    if done.stage_seconds:
        done.stage_seconds = max(0.0, done.stage_seconds - float(folder.joinpath("seconds").read_text()))
    return done


PEERS = {"TetGen": (start_tetgen, optimize_tetgen, "TetGen -O9/7"), "Gmsh Delaunay": (start_gmsh, optimize_gmsh, "Gmsh"),
         "Netgen": (start_netgen, optimize_netgen, "Netgen")}


PEER_HEAD = ["model", "start mesh of", "optimiser", "elements", *(c[0] for c in COLUMNS.values())]


def peer_rows(build, model, name, surface, folder):
    make, optimize, own = PEERS[name]
    failed = lambda what, run: [model, name, what, run.error, *[""] * len(COLUMNS)]
    start = make(surface, folder)
    if not start.mesh:
        return [failed("start", start)]
    before = judged(build, start.mesh)
    rows = [[model, name, "start", f"{before['tets']:,}", *cells(before, {})]]
    done = optimize(start.mesh, folder)
    if done.mesh:
        r = judged(build, done.mesh)
        r["us"] = 1e6 * (done.stage_seconds or done.cpu_seconds) / before["tets"]
        rows.append([model, name, own, f"{r['tets']:,}", *cells(r, {})])
    else:
        rows.append(failed(own, done))
    for level in ("default", "best"):
        mesh, report = folder / "ours.vtu", folder / "ours.json"
        run = octafront(build, "improve", start.mesh, "-o", mesh, "--improve", level, "--threads", 1, "--json", report, "-q")
        if run.error:
            rows.append(failed(f"octafront {level}", run))
            continue
        r = judged(build, mesh)
        r["us"] = 1e6 * ours.stage(json.loads(report.read_text()), "improve")["cpu_seconds"] / before["tets"]
        rows.append([model, name, f"octafront {level}", f"{r['tets']:,}", *cells(r, {})])
    for row in rows:
        print(" | ".join(row), flush=True)
    return rows


def others_meshes(build, folder):
    rows = []
    for model in PEER_MODELS:
        surface = kept_surface(build, model, folder).resolve()
        for name in PEERS:
            place = folder / f"{surface.stem}-{name.split()[0]}"
            place.mkdir()
            rows += peer_rows(build, model, name, surface, place)
    return rows


def shown(rows):
    """Rows of cells."""
    wanted = [f"{kind}, {level}: " + ", ".join(f"{COLUMNS[k][0]} {v:g}" for k, v in t.items()) for kind, levels in TARGETS.items() if kind != "smooth, one size"
              for level, t in levels.items()]
    return [f"Targets: {'; '.join(wanted)}. A figure in bold misses its target.", "", *tables.spread_by("models and level", HEAD, rows, [c for c in HEAD[3:-1] if c not in ("edge over wanted", "below .4")]), "",
            f"Median, least and most. Each: {tables.put('improve-bench', HEAD, rows)}."]


def shown_peers(rows):
    kinds = [[f"{r[1]}: {r[2]}", *r[1:]] for r in rows]
    return ["Made without optimisers on kept surfaces; then their own optimiser and ours, which keep the boundary:", "",
            *tables.spread_by("start mesh: optimiser", ["start mesh: optimiser", *PEER_HEAD[1:]], kinds, [c for c in PEER_HEAD[4:] if c != "above .8, %"]), "", f"Each: {tables.put('improve-peers', PEER_HEAD, rows)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--generated", type=int, default=1000, help="generated meshes")
    parser.add_argument("--skip-peers", action="store_true")
    args = parser.parse_args()
    build = args.build.resolve()
    text = ["# Improvement, measured", "", f"{written_by('bench/run.sh improve')}; what is measured, and how, is said at the top of `bench/run/improve.py`. Meshes of "
            f"{ELEMENTS:,} elements, CPU time of one thread.", ""]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        rows = [row for kind, models in (("smooth", SMOOTH), ("smooth, one size", SMOOTH), ("CAD", CAD)) for row in own_meshes(build, kind, models, folder)]
        text += [*shown(rows), "", "## Never worse", "", *never_worse(build, args.generated, folder)]
        if not args.skip_peers:
            text += ["## Start meshes of others", "", *shown_peers(others_meshes(build, folder))]
    tables.write("improve-bench", text)


if __name__ == "__main__":
    main()
