"""CAD files: meshed at parts of their diagonal? Volumes of solids against the true ones, elements, time; beside Gmsh.

Usage: bench/run.sh cad [--only PART] [--timeout SECONDS] [--fine] [--peers] [--page] [--models FOLDER]
Files of cad-models/ (scripts/get-cad.sh). Each is read by `octafront info`, then meshed at a fortieth of its diagonal, linear, and with
--fine at a hundredth, of second order. Volumes of ours are those of the report, solid by solid against OpenCASCADE's; --peers: the
linear meshes that Gmsh (Delaunay and HXT) and Netgen make of the same files at a fortieth, judged by octafront_evaluate. octafront_judge_cad looks whether nodes are on the geometry. CPU seconds of whole processes, octafront-cad among them, one
thread. --page rewrites docs/measured/cad.md.
"""
import argparse
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from origin import written_by  # noqa: E402
from peers import netgen  # noqa: E402
from peers.process import finish, run_measured  # noqa: E402

MODELS = pathlib.Path("cad-models")
PAGE = pathlib.Path("docs/measured/cad.md")


def info_of(program, file, timeout):
    """What the file holds as JSON, and why not."""
    with tempfile.TemporaryDirectory() as folder:
        told = run_measured([program, "info", file.resolve(), "--json", "info.json"], folder, timeout)
        report = pathlib.Path(folder, "info.json")
        found = json.loads(report.read_text()) if report.is_file() else {}
        return found if found.get("solids") is not None else None, told.error or "no solids"


def off_geometry(build, mesh, file, timeout):
    """How many nodes of the boundary are off the file's geometry, of how many, and the largest distance in diagonals."""
    done = subprocess.run([build / "bench/octafront_judge_cad", mesh, file], capture_output=True, text=True, timeout=timeout, check=False)
    if done.returncode != 0:
        return {}
    judged = json.loads(done.stdout).values()
    return {"nodes": sum(j["nodes"] for j in judged), "astray": sum(j["off"] for j in judged), "farthest": max(j["largest"] for j in judged)}


def ours(build, file, size, order, timeout, look):
    program = (build / "cli/octafront").resolve()
    with tempfile.TemporaryDirectory() as folder:
        run = run_measured([program, "mesh", file.resolve(), "-o", "out.vtu", "--json", "report.json", "--size", repr(size), "--order",
                            order, "--threads", "1"], folder, timeout)
        run = finish(run, pathlib.Path(folder, "out.vtu"))
        if run.error:
            return {"error": run.error, "cpu": run.cpu_seconds}
        report = json.loads(pathlib.Path(folder, "report.json").read_text())
        solids = report.get("regions") or [report]
        off = [100 * (s["volume"] / s["true_volume"] - 1) for s in solids if s.get("true_volume")]
        quality = report["quality"]
        return {"cpu": run.cpu_seconds, "tets": report["tets"], "off": max(off, key=abs) if off else math.nan,
                "beta": quality["beta_mean"], "least": quality["beta_min"], "angle": quality["dihedral_min_degrees"],
                **(off_geometry(build, run.mesh, file, 20 * timeout) if look else {}),
                "held": next((s["counters"].get("vertices held", 0) for s in report["stages"] if s["name"] == "true geometry"), 0)}


def judged(build, run, volume):
    if run.error:
        return {"error": run.error, "cpu": run.cpu_seconds}
    done = subprocess.run([build / "bench/octafront_evaluate", run.mesh], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return {"error": "not a valid mesh: " + (done.stderr.strip().splitlines() or [""])[-1][:80], "cpu": run.cpu_seconds}
    found = json.loads(done.stdout)
    if found["defect"]:
        return {"error": "not a valid mesh: " + found["defect"][:80], "cpu": run.cpu_seconds}
    return {"cpu": run.cpu_seconds, "tets": found["tets"], "off": 100 * (found["volume"] / volume - 1) if volume else math.nan,
            "beta": found["beta_mean"], "least": found["beta_min"], "angle": found["dihedral_min"]}


def by_gmsh(algorithm):
    def mesh(build, file, size, volume, timeout):
        with tempfile.TemporaryDirectory() as folder:
            run = run_measured(["gmsh", "-3", file.resolve(), "-o", "out.msh", "-format", "msh41", "-bin", "-clmax", repr(size), "-nt", "1",
                                "-algo", algorithm], folder, timeout)
            return judged(build, finish(run, pathlib.Path(folder, "out.msh")), volume)
    return mesh


def by_netgen(build, file, size, volume, timeout):
    with tempfile.TemporaryDirectory() as folder:
        return judged(build, netgen.mesh_cad(file.resolve(), folder, timeout, repr(size)), volume)


PEERS = {"Gmsh": by_gmsh("del3d"), "Gmsh's HXT": by_gmsh("hxt"), "Netgen": by_netgen}


def without_folders(sentence):
    return re.sub(r"/\S*/", "", sentence)


def cells(made):
    if "error" in made:
        return f"{without_folders(made['error'])[:90]} | | | | | {made['cpu']:.1f}"
    astray = f"{made['astray']:,}" + (f" ({made['farthest']:.1g})" if made["astray"] else "") if "astray" in made else ""
    return (f"{made['tets']:,} | {made['off']:+.3f} | {astray} | {made['beta']:.3f}, {made['least']:.3f} | {made['angle']:.1f} | "
            f"{made['cpu']:.1f}")


def nodes_in_words(done):
    judged = [m for m in done if "astray" in m]
    if not judged:
        return ""
    return (f"; off the geometry are {sum(m['astray'] for m in judged):,} of {sum(m['nodes'] for m in judged):,} nodes of the boundary, "
            f"in {sum(m['astray'] > 0 for m in judged)} files")


def summary(name, all_made):
    done = [m for m in all_made if "error" not in m]
    if not done:
        return f"{name}: none of {len(all_made)}"
    off = [abs(m["off"]) for m in done if not math.isnan(m["off"])]
    return (f"{name}: {len(done)} of {len(all_made)} meshed; worst solid within .1 % in {sum(o <= .1 for o in off)}, within 1 % in "
            f"{sum(o <= 1 for o in off)} of {len(off)}; smallest angle in the median {statistics.median(m['angle'] for m in done):.1f} "
            f"degrees, below 10 in {sum(m['angle'] < 10 for m in done)}{nodes_in_words(done)}; mean beta {statistics.mean(m['beta'] for m in done):.3f}; "
            f"{sum(m['tets'] for m in done):,} elements, {sum(m['cpu'] for m in all_made):.0f} CPU s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=float, default=120)
    parser.add_argument("--fine", action="store_true")
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--models", type=pathlib.Path, default=MODELS)
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    program = (a.build / "cli/octafront").resolve()
    sizes = [(40, "1")] + ([(100, "2")] if a.fine else [])
    rows, refused = [], []
    made = {(part, who): [] for part, _ in sizes for who in ("ours", *PEERS)}
    for file in sorted(a.models.iterdir()):
        if a.only not in file.name:
            continue
        info, why = info_of(program, file, a.timeout)
        if not info or not info["solids"]:
            refused.append(f"| {file.name} | {why.replace(str(file.resolve()), file.name)[:120]} |")
            print(refused[-1], flush=True)
            continue
        lo, hi = info["box"]
        diagonal = math.dist(lo, hi)
        volume = sum(s["volume"] for s in info["solids"])
        for part, order in sizes:
            mesh = ours(a.build, file, diagonal / part, order, a.timeout, part == 40)
            made[part, "ours"].append(mesh)
            rows.append(f"| {file.name} | {len(info['solids'])}, {len(info['faces'])} | 1/{part}, {order} | ours | {cells(mesh)} |")
            print(rows[-1], flush=True)
        for who, peer in PEERS.items() if a.peers else ():
            mesh = peer(a.build, file, diagonal / 40, volume, a.timeout)
            made[40, who].append(mesh)
            rows.append(f"| {file.name} | | 1/40, 1 | {who} | {cells(mesh)} |")
            print(rows[-1], flush=True)
    lines = ["- " + summary(f"{who}, diagonal / {part}", m) + "." for (part, who), m in made.items() if m]
    print("\n".join(lines))
    if a.page:
        PAGE.write_text("\n".join([
            "# CAD files", "",
            f"{written_by('bench/run.sh cad' + ' --fine' * a.fine + ' --peers' * a.peers + ' --page')}, one thread; at most {a.timeout:.0f} s a run.",
            "",
            "Files of Debian's occt-misc, netgen-doc, gmsh-doc and freecad-common (`scripts/get-cad.sh`), meshed at a part of their diagonal. "
            "*Volume*: the solid that is worst off, against OpenCASCADE's volume of it, in percent; of curved elements as they are curved. Of "
            "Gmsh and Netgen the sum of all, linear. *Astray*: nodes of the boundary, corners and mid-side nodes, that OpenCASCADE, which reads the file once "
            "more, finds farther from its nearest face or edge than 1e-9 of the diagonal and than the tolerance there; the farthest, in diagonals. "
            "Solids that touch share faces here, and do not in theirs.", "",
            *lines, "",
            "| file | solids, faces | size, order | mesher | elements | volume, % | astray | beta mean, least | least angle | CPU s |",
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |", *rows, "",
            "## Not meshed", "", "Without solids, or refused as they were read:", "", "| file | why |", "| --- | --- |", *refused, ""]))


main()
