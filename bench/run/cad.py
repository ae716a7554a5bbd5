"""CAD files: meshed at parts of their diagonal? Is what comes out what the file says? Beside Gmsh and Netgen.

Usage: bench/run.sh cad [--only PART] [--timeout SECONDS] [--fine] [--peers | --peers-alone] [--page] [--models FOLDER] [--missing]
Files of cad-models/ (bench/models/get-cad.sh). Each is read by `octafront info`, then meshed at a fortieth of its diagonal, linear, and with
--fine at a hundredth, of second order. Volumes of ours are those of the report, solid by solid against OpenCASCADE's; areas, boxes, counts,
nodes that are off the geometry and what the shape forces on poor elements are octafront_judge_cad's. --peers: the linear meshes that Gmsh
(Delaunay and HXT) and Netgen make of the same files at a fortieth, judged by octafront_evaluate. --models: other files, ours alone, with at
most 20,000 nodes of each kind looked at. CPU seconds of whole processes, octafront-cad among them, one thread.
What was found is kept in BUILD/experiments/cad-*.json, from which --page writes docs/measured/cad.md; --missing: only what is not there.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

from bench.judges import cad_names
from bench.ours import evaluated
from bench.pages import cad_page, tables
from bench.pages.origin import ORIGIN
from bench.peers import netgen
from bench.process import finish, run_measured

MODELS = pathlib.Path("cad-models")
NODES_OF_OTHERS = 20_000


class Kept:
    """What was found of a set of files, in a JSON file that is written after each."""

    def __init__(self, path):
        self.path = path
        found = json.loads(path.read_text()) if path.is_file() else {}
        self.files, self.runs = found.get("files", {}), found.get("runs", {})

    def save(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps({"files": self.files, "runs": self.runs}, indent=1))


def info_of(program, file, timeout):
    """What the file holds, or why it cannot be meshed."""
    with tempfile.TemporaryDirectory() as folder:
        told = run_measured([program, "info", file.resolve(), "--json", "info.json"], folder, timeout)
        report = pathlib.Path(folder, "info.json")
        found = json.loads(report.read_text()) if report.is_file() else {}
    if not found.get("solids"):
        return {"why": (told.error or "no solids").replace(str(file.resolve()), file.name)[:120]}
    return {"solids": found["solids"], "faces": len(found["faces"]), "diagonal": math.dist(*found["box"])}


def judged_by_occ(build, mesh, file, nodes):
    """See octafront_judge_cad; {} where OpenCASCADE finds no end."""
    try:
        done = subprocess.run([build / "bench/octafront_judge_cad", mesh, file, *(["--nodes", str(nodes)] if nodes else [])],
                              capture_output=True, text=True, timeout=900, check=False)
    except subprocess.TimeoutExpired:
        return {}
    return json.loads(done.stdout) if done.returncode == 0 else {}


def worst(pairs):
    """The largest deviation of what was made from what is true, in percent."""
    off = [100 * (made / true - 1) for made, true in pairs if true]
    return max(off, key=abs) if off else math.nan


def against_the_file(judge, info):
    """What of the judge's figures goes into tables. A file of other solids than the mesh has regions has no areas solid by solid."""
    if not judge:
        return {}
    solids, areas = info["solids"], judge["areas"]
    pairs = zip(areas, [s["area"] for s in solids]) if len(areas) == len(solids) else [(sum(areas), sum(s["area"] for s in solids))]
    nodes = [judge["vertices"], judge["mid_side"]]
    return {"area": worst(pairs), "box": 100 * judge["box"], "regions": len(areas), "patches": judge["patches"], "true": judge["true"],
            "nodes": sum(n["nodes"] for n in nodes), "astray": sum(n["off"] for n in nodes),
            "farthest": max(n["largest"] for n in nodes), "poor": judge["poor"]}


def names_that_arrive(program, mesh, file):
    """In files of Gmsh and of Abaqus."""
    names = cad_names.names_in_step(file)
    if not names:
        return {}
    msh, inp = mesh.with_name("names.msh"), mesh.with_name("names.inp")
    subprocess.run([program, "convert", mesh, "-o", msh, "-o", inp], capture_output=True, check=True)
    return {"names": {"msh": cad_names.arrived(names, cad_names.groups_in_gmsh(msh)),
                      "inp": cad_names.arrived(names, cad_names.groups_in_abaqus(inp))}}


def ours(build, file, info, part, timeout, nodes):
    program = (build / "cli/octafront").resolve()
    with tempfile.TemporaryDirectory() as folder:
        run = run_measured([program, "mesh", file.resolve(), "-o", "out.vtu", "--json", "report.json", "--size", repr(info["diagonal"] / part),
                            "--order", 1 if part == 40 else 2, "--threads", "1"], folder, timeout)  # not quiet: its notes are read
        run = finish(run, pathlib.Path(folder, "out.vtu"))
        if run.error:
            return {"error": run.error, "cpu": run.cpu_seconds}
        report = json.loads(pathlib.Path(folder, "report.json").read_text())
        solids = report.get("regions") or [report]
        quality = report["quality"]
        return {"cpu": run.cpu_seconds, "tets": report["tets"], "off": worst((s["volume"], s.get("true_volume")) for s in solids),
                "beta": quality["beta_mean"], "least": quality["beta_min"], "angle": quality["dihedral_min_degrees"],
                **cad_page.faces_left_out(run.log), **against_the_file(judged_by_occ(build, run.mesh, file, nodes), info),
                **(names_that_arrive(program, run.mesh, file) if part == 40 else {})}


def judged(build, run, info):
    if run.error:
        return {"error": run.error, "cpu": run.cpu_seconds}
    found, why = evaluated(build, run.mesh)
    if why or found["defect"]:
        return {"error": "not a valid mesh: " + (why or found["defect"])[:80], "cpu": run.cpu_seconds}
    return {"cpu": run.cpu_seconds, "tets": found["tets"], "off": worst([(found["volume"], sum(s["volume"] for s in info["solids"]))]),
            "beta": found["beta_mean"], "least": found["beta_min"], "angle": found["dihedral_min"]}


def with_names(made, file, groups, mesh):
    names = cad_names.names_in_step(file)
    if names and mesh.is_file():
        made["names"] = {"own": cad_names.arrived(names, groups(mesh))}
    return made


def by_gmsh(algorithm):
    def mesh(build, file, info, timeout):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "out.msh")
            run = run_measured(["gmsh", "-3", file.resolve(), "-o", "out.msh", "-format", "msh41", "-bin", "-clmax",
                                repr(info["diagonal"] / 40), "-nt", "1", "-algo", algorithm], folder, timeout)
            return with_names(judged(build, finish(run, out), info), file, cad_names.groups_in_gmsh, out)
    return mesh


def by_netgen(build, file, info, timeout):
    with tempfile.TemporaryDirectory() as folder:
        run = netgen.mesh_cad(file.resolve(), folder, timeout, repr(info["diagonal"] / 40), cad_names.is_step(file))
        return with_names(judged(build, run, info), file, cad_names.groups_in_netgen, pathlib.Path(folder, "out.vol"))


PEERS = {"Gmsh": by_gmsh("del3d"), "Gmsh's HXT": by_gmsh("hxt"), "Netgen": by_netgen}


def peers_origin():
    """Their versions and the day: what their rows depend on."""
    told = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}, ", "gmsh", "netgen"], capture_output=True, text=True, check=False)
    return told.stdout + ORIGIN.split(", ", 1)[1]


def campaign(a, kept, file, others):
    """Runs what is asked for of one file."""
    if not (a.missing and file.name in kept.files):
        kept.files[file.name] = info_of((a.build / "cli/octafront").resolve(), file, a.timeout)
    info = kept.files[file.name]
    if "why" in info:
        print(tables.row(cad_page.refused_row(file.name, info)), flush=True)
        return
    own = [] if a.peers_alone else [(40, "ours")] + [(100, "ours")] * a.fine
    for part, who in own + [(40, peer) for peer in PEERS] * (a.peers or a.peers_alone):
        key = f"{file.name}|{who}|{part}"
        if a.missing and key in kept.runs:
            continue
        made = (ours(a.build, file, info, part, a.timeout, NODES_OF_OTHERS if others else 0) if who == "ours" else
                PEERS[who](a.build, file, info, a.timeout))
        kept.runs[key] = {"file": file.name, "who": who, "part": part, "origin": ORIGIN if who == "ours" else peers_origin(), **made}
        print(tables.row(cad_page.row(kept.runs[key], info)), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=float, default=60)
    parser.add_argument("--fine", action="store_true")
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--peers-alone", action="store_true")
    parser.add_argument("--models", type=pathlib.Path, default=MODELS)
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    sets = {name: Kept(a.build / f"experiments/cad-{name}.json") for name in ("debian", "others")}
    others = a.models != MODELS
    kept = sets["others" if others else "debian"]
    for file in sorted(a.models.iterdir()):
        if a.only in file.name:
            campaign(a, kept, file, others)
            kept.save()
    print("\n".join(tables.table(cad_page.SUMMARY, cad_page.summaries(kept))))
    if a.page:
        cad_page.write(sets["debian"], sets["others"], a.timeout)


if __name__ == "__main__":
    main()
