#!/usr/bin/python3
"""Reads files that other programs wrote, and compares with what meshio and Gmsh read of them; writes docs/measured/peer-files.md.

  bench/campaigns/peer_files.py FOLDER [--only WORD] [--each N] [--list FILE] [--page] [--verbose]

FOLDER holds a folder for each project. Every N-th file of each project and format is looked at, or those of FILE (a path in FOLDER
a line). For each: the number of solid elements, their volume, and the names of groups and their sizes, ours (`octafront check`) beside
meshio's and Gmsh's. A row is good if the volume is theirs, and all elements and names are there, or a note of ours says what is not.
Needs a built octafront (build/release, or OCTAFRONT=FILE), python3-meshio and python3-gmsh.
"""
import argparse
import collections
import contextlib
import io
import json
import multiprocessing
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.pages import tables
from bench.pages.origin import written_by

OCTAFRONT = os.environ.get("OCTAFRONT", str(ROOT / "build/release/cli/octafront"))
ENDINGS = {".mesh", ".meshb", ".msh", ".vtu", ".vtk", ".inp", ".bdf", ".nas", ".unv", ".med", ".mmed", ".xdmf", ".vol", ".ele", ".dat"}
SECONDS = 60
"""For each reader and file."""
SAME_VOLUME = 1e-6
"""Relative; warped hexahedra, which each divides in its own way, may differ by WARPED."""
WARPED = 2e-2

# The six tetrahedra around a diagonal, the wedge's three, the pyramid's two; corners alone.
PARTS = {
    "tetra": [(0, 1, 2, 3)],
    "wedge": [(0, 1, 2, 5), (0, 1, 5, 4), (0, 4, 5, 3)],
    "pyramid": [(0, 1, 2, 4), (0, 2, 3, 4)],
    "hexahedron": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
}
KINDS = {"tetra": "tetra", "tetra10": "tetra", "wedge": "wedge", "wedge15": "wedge", "wedge18": "wedge", "pyramid": "pyramid",
         "pyramid13": "pyramid", "pyramid14": "pyramid", "hexahedron": "hexahedron", "hexahedron20": "hexahedron",
         "hexahedron27": "hexahedron"}
OF_GMSH = {4: "tetra", 11: "tetra", 5: "hexahedron", 17: "hexahedron", 12: "hexahedron", 6: "wedge", 18: "wedge", 13: "wedge",
           7: "pyramid", 19: "pyramid", 14: "pyramid"}


def volume(points, kind, cells):
    """Of cells of a kind, their corners first."""
    total = 0.0
    for part in PARTS[kind]:
        a, b, c, d = (points[cells[:, k]] for k in part)
        total += numpy.abs(numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a)).sum() / 6
    return total


def by_meshio(file):
    import meshio

    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        form = {".inp": "abaqus", ".dat": "nastran", ".bdf": "nastran", ".mmed": "med", ".ele": "tetgen"}.get(file.suffix)
        mesh = meshio.read(file, file_format=form) if form else meshio.read(file)
    counts, total, names = collections.Counter(), 0.0, {}
    points = numpy.asarray(mesh.points, float)
    for block in mesh.cells:
        kind = KINDS.get(block.type)
        if kind is None:
            continue
        counts[kind] += len(block.data)
        total += volume(points, kind, numpy.asarray(block.data))
    for name, (tag, dimension) in mesh.field_data.items():
        if dimension == 3 and "gmsh:physical" in mesh.cell_data:
            size = sum(int((numpy.asarray(data) == tag).sum()) for block, data in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
                       if block.type in KINDS)
            names[name] = size
    for name, blocks in mesh.cell_sets.items():
        if name.startswith("gmsh:"):
            continue
        size = sum(len(found) for block, found in zip(mesh.cells, blocks) if found is not None and block.type in KINDS)
        if size:
            names[name] = size
    return {"counts": dict(counts), "volume": total, "names": names}


def by_gmsh(file):
    import gmsh

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(file))
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        number = {int(tag): i for i, tag in enumerate(tags)}
        points = numpy.asarray(xyz).reshape(-1, 3)
        counts, total, of_entity = collections.Counter(), 0.0, collections.Counter()
        for dimension, entity in gmsh.model.getEntities(3):
            types, _, nodes = gmsh.model.mesh.getElements(dimension, entity)
            for kind_of, listed in zip(types, nodes):
                kind = OF_GMSH.get(int(kind_of))
                if kind is None:
                    continue
                each = gmsh.model.mesh.getElementProperties(kind_of)[3]
                cells = numpy.array([number[int(v)] for v in listed]).reshape(-1, each)
                counts[kind] += len(cells)
                of_entity[entity] += len(cells)
                total += volume(points, kind, cells)
        names = {}
        for dimension, group in gmsh.model.getPhysicalGroups(3):
            name = gmsh.model.getPhysicalName(dimension, group)
            if name:
                names[name] = sum(of_entity[int(e)] for e in gmsh.model.getEntitiesForPhysicalGroup(dimension, group))
        return {"counts": dict(counts), "volume": total, "names": names}
    finally:
        gmsh.finalize()


OF_VTK = {10: "tetra", 24: "tetra", 13: "wedge", 26: "wedge", 14: "pyramid", 27: "pyramid"}


def by_vtk(file):
    """Numbers of solids and their volume in a VTU."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    types = vtk_to_numpy(grid.GetCellTypesArray())
    offsets, connectivity = (vtk_to_numpy(array) for array in (grid.GetCells().GetOffsetsArray(), grid.GetCells().GetConnectivityArray()))
    counts, total = collections.Counter(), 0.0
    for number, kind in OF_VTK.items():
        first = offsets[:-1][types == number]
        if len(first):
            corners = {"tetra": 4, "wedge": 6, "pyramid": 5}[kind]
            counts[kind] += len(first)
            total += volume(points, kind, numpy.stack([connectivity[first + k] for k in range(corners)], axis=1))
    return counts, total


def in_time(reader, file):
    """What a reader finds, in a process of its own; None with the reason."""

    def work(pipe):
        try:
            pipe.send(reader(file))
        except BaseException as error:
            pipe.send(f"{type(error).__name__}: {error}"[:80])

    here, there = multiprocessing.Pipe()
    process = multiprocessing.Process(target=work, args=(there,))
    process.start()
    found = here.recv() if here.poll(SECONDS) else "no end"
    process.terminate()
    process.join()
    return (found, None) if isinstance(found, dict) else (None, found)


def ours(file):
    """What octafront says, and the volume and elements of what it writes."""
    with tempfile.TemporaryDirectory() as folder:
        told = pathlib.Path(folder) / "told.json"
        mesh = pathlib.Path(folder) / "mesh.vtu"
        run = subprocess.run([OCTAFRONT, "convert", file, "-o", mesh, "-q", "--json", told], capture_output=True, text=True,
                             timeout=SECONDS, check=False)
        found = json.loads(told.read_text()) if told.exists() else {}
        notes = [note["text"] for note in found.get("input_notes", [])]
        if run.returncode or not mesh.exists():
            return {"error": (run.stderr or run.stdout).strip().splitlines()[-1:] or ["?"], "notes": notes}
        check = subprocess.run([OCTAFRONT, "check", mesh, "-q"], capture_output=True, text=True, timeout=SECONDS, check=False)
        subprocess.run([OCTAFRONT, "report", mesh, "-o", pathlib.Path(folder) / "page.html", "-q", "--json", told], capture_output=True,
                       timeout=SECONDS, check=False)
        groups = json.loads(told.read_text()).get("groups", [])
        counts, total = by_vtk(mesh)
        names = {}
        for group in groups or []:
            if group["origin"] in ("region", "elements"):
                names[group["name"]] = group["size"]
        valid = check.returncode == 0
        why = "" if valid else (check.stderr.strip().splitlines() or [""])[-1]
        return {"counts": dict(counts), "volume": total, "names": names, "notes": notes, "valid": valid, "why": why}


def plain(name):
    return re.sub(r"\W", "", name).lower()


def tetrahedra(counts, as_ours):
    """How many tetrahedra of ours elements are: hexahedra are six."""
    n = counts.get("tetra", 0) + 6 * counts.get("hexahedron", 0)
    return n if as_ours else n + 3 * counts.get("wedge", 0) + 2 * counts.get("pyramid", 0)


def verdict(mine, theirs):
    """A list of complaints."""
    bad = []
    has_hexahedra = theirs["counts"].get("hexahedron", 0) > 0
    scale = max(abs(theirs["volume"]), 1e-300)
    off = abs(mine["volume"] - theirs["volume"]) / scale
    if off > (WARPED if has_hexahedra else SAME_VOLUME):
        bad.append(f"volume {mine['volume']:.7g}, theirs {theirs['volume']:.7g}")
    for kind in ("wedge", "pyramid"):
        if mine["counts"].get(kind, 0) != theirs["counts"].get(kind, 0):
            bad.append(f"{mine['counts'].get(kind, 0)} of {theirs['counts'].get(kind, 0)} {kind}s")
    if not has_hexahedra and mine["counts"].get("tetra", 0) != theirs["counts"].get("tetra", 0):
        bad.append(f"{mine['counts'].get('tetra', 0)} of {theirs['counts'].get('tetra', 0)} tetrahedra")
    known = {plain(name) for name in mine["names"]}
    missing = [name for name, size in theirs["names"].items() if size and plain(name) not in known]
    if missing:
        bad.append("no group " + ", ".join(missing[:4]))
    return bad


def look(file, folder):
    row = {"file": file.relative_to(folder), "bad": [], "judges": {}}
    try:
        row["ours"] = mine = ours(file)
    except subprocess.TimeoutExpired:
        row["ours"] = mine = {"error": ["no end"], "notes": []}
    for name, reader in (("meshio", by_meshio), ("Gmsh", by_gmsh)):
        if name == "Gmsh" and file.suffix in (".inp", ".vtu", ".ele", ".vol", ".xdmf"):
            continue
        found, why = in_time(reader, file)
        solids = found is not None and sum(found["counts"].values()) > 0
        row["judges"][name] = found if solids else (why or "no solids")
    judges = {name: found for name, found in row["judges"].items() if isinstance(found, dict)}
    if "error" in mine:
        row["bad"] = [mine["error"][0]] if judges else []
        return row
    complaints = {name: verdict(mine, found) for name, found in judges.items()}
    # One that agrees is enough: others may read less.
    if complaints and all(complaints.values()):
        row["bad"] = min(complaints.values(), key=len)
    if not mine["valid"]:
        row["invalid"] = mine["why"]
    return row


def line(row):
    mine = row["ours"]
    words = [str(row["file"])]
    if "error" in mine:
        words.append("refused: " + mine["error"][0])
    else:
        words.append(" ".join(f"{n} {kind}" for kind, n in mine["counts"].items()))
        words.append(f"V {mine['volume']:.6g}")
        words.append(f"{len(mine['names'])} groups")
    for name, found in row["judges"].items():
        words.append(f"{name}: " + (found if isinstance(found, str) else
                                    f"{sum(found['counts'].values())} solids, V {found['volume']:.6g}, {len(found['names'])} names"))
    if row["bad"]:
        words.append("BAD " + "; ".join(row["bad"]))
    if row.get("invalid"):
        words.append("not valid: " + row["invalid"])
    return " | ".join(words)


def solids_of(found):
    counts = found["counts"]
    return ", ".join(f"{n:,} {kind}" for kind, n in sorted(counts.items())) or "none"


def page(rows, command):
    out = ["# Files of other programs", "", written_by(command) + ".", "",
           "Meshes of public projects as they stand in their repositories, by file name; none of them is part of this one. *Ours*: what",
           "`octafront convert` makes of the file; hexahedra are six tetrahedra, fewer where an edge is a point. *Theirs*: what meshio or Gmsh",
           "reads. A row is good if one of them finds the same volume (to a millionth; hexahedra, which each divides in its own way, to 2 %),",
           "elements and named groups of solids, or where our notes say what is left out.", ""]
    good = sum(not row["bad"] for row in rows)
    judged = sum(any(isinstance(found, dict) for found in row["judges"].values()) for row in rows)
    out.append(f"{len(rows)} files of {len({row['file'].parts[0] for row in rows})} projects, {judged} of which another reader reads as solids: "
               f"{good} are read as there.")
    files = []
    for row in rows:
        mine = row["ours"]
        judge = next(((name, found) for name, found in row["judges"].items() if isinstance(found, dict)), None)
        project, *rest = row["file"].parts
        cells = [project.replace("+", "/"), "/".join(rest)]
        cells += ["refused", "-", "-"] if "error" in mine else [solids_of(mine), f"{mine['volume']:.6g}", str(len(mine["names"]))]
        cells += [f"{judge[0]}: {solids_of(judge[1])}", f"{judge[1]['volume']:.6g}", str(len(judge[1]["names"]))] if judge else ["-", "-", "-"]
        said = "; ".join(row["bad"]) or (mine["error"][0] if "error" in mine else "good")
        files.append([*cells, said[:160]])
    tables.write("peer-files", [*out, "", *shown(files)])


HEAD = ["project", "file", "ours", "volume", "groups", "theirs", "their volume", "names", "verdict"]


def shown(files):
    """Rows of cells: the projects, and what is not good."""
    projects = [f"{project} {sum(f[-1] == 'good' for f in its)} of {len(its)}"
                for project in dict.fromkeys(f[0] for f in files) for its in [[f for f in files if f[0] == project]]]
    bad = [[f[0], f[1], f[2], f[5], f[-1]] for f in files if f[-1] != "good"]
    return [f"Good, of all: {', '.join(projects)}.", "",
            *(["Not good:", "", *tables.table(["project", "file", "ours", "theirs", "verdict"], bad[:20]), ""] if bad else []),
            f"Each: {tables.put('peer-files', HEAD, files)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", default="", help="paths that have this in them")
    parser.add_argument("--each", type=int, default=1, help="every so many-th file of a project and format")
    parser.add_argument("--list", type=pathlib.Path)
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--verbose", action="store_true", help="good rows too, with notes")
    options = parser.parse_args()
    folder = options.folder.resolve()
    if options.list:
        files = [folder / name for name in options.list.read_text().split("\n") if name]
    else:
        kinds = collections.defaultdict(list)
        for file in sorted(folder.rglob("*")):
            if file.suffix in ENDINGS and options.only in str(file):
                kinds[file.relative_to(folder).parts[0], file.suffix].append(file)
        files = [file for of_kind in kinds.values() for file in of_kind[:: options.each]]
    rows = []
    for file in files:
        rows.append(row := look(file, folder))
        if options.verbose or row["bad"] or row.get("invalid"):
            print(line(row), flush=True)
            if options.verbose:
                for note in row["ours"]["notes"]:
                    print("   ", note)
    bad = [row for row in rows if row["bad"]]
    print(f"{len(rows)} files, {len(rows) - len(bad)} good")
    if options.page:
        page(rows, "bench/campaigns/peer_files.py FOLDER --page")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
