#!/usr/bin/python3
"""What others read of polyhedra in the files of write_samples: FOLDER/linear_polyhedra and FOLDER/mixed_linear_polyhedra, beside
expected.json: volumes of regions and areas of patches, by the faces of the cells, all cells closed and positive; values of cells
lie between those of their points.

    poly_judges.py FOLDER

Judges: VTK (vtu), h5py and cgnscheck (cgns), checkMesh and a reader by its manual (openfoam). What is not installed is skipped,
and said. Exit status 1 if there is a difference.
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import judges
from judges import Difference, same
from second_readers import foam_body, foam_labels


def volume(points, faces):
    """Of a body by its faces, seen from outside; which must be closed."""
    edges = Counter((a, b) for face in faces for a, b in zip(face, face[1:] + face[:1]))
    if any(n != 1 or edges[b, a] != 1 for (a, b), n in edges.items()):
        raise Difference("a polyhedron is not closed")
    total = 0
    for face in faces:
        p = points[face]
        middle = p.mean(axis=0)
        total += np.einsum("i,ki->", middle, np.cross(p, np.roll(p, -1, axis=0))) / 6
    if not total > 0:
        raise Difference("a polyhedron is inside out")
    return total


def area(points, face):
    p = points[face] - points[face].mean(axis=0)
    return np.linalg.norm(np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)) / 2


def compare(expected, points, cells_of_regions, faces_of_patches):
    """Sums of regions and patches, whatever their names."""
    wanted = {kind: sorted(p["measure"] for p in expected["parts"] if p["kind"] == kind and not is_set(p))
              for kind in ("elements", "faces")}
    found = {"elements": sorted(sum(volume(points, c) for c in cells) for cells in cells_of_regions),
             "faces": sorted(sum(area(points, f) for f in faces) for faces in faces_of_patches)}
    for kind, values in wanted.items():
        same(f"number of parts of {kind}", len(found[kind]), len(values))
        if not np.allclose(found[kind], values, rtol=1e-12):
            raise Difference(f"{kind}: {found[kind]}, not {values}")
    return sum(map(len, cells_of_regions))


def is_set(part):
    return part["set"] if "set" in part else part["origin"] == "set"


def grouped(items, numbers):
    groups = {}
    for item, number in zip(items, numbers):
        groups.setdefault(number, []).append(item)
    return list(groups.values())


def with_vtk(folder, expected):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / "vtu.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    data = {name: vtk_to_numpy(grid.GetCellData().GetArray(name)) for name in ("region", "patch", "T", "flow")}
    cells, faces = [], []
    for c in range(grid.GetNumberOfCells()):
        if grid.GetCellType(c) == vtk.VTK_POLYGON:
            ids = vtk.vtkIdList()
            grid.GetCellPoints(c, ids)
            faces.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
            continue
        same("type", grid.GetCellType(c), vtk.VTK_POLYHEDRON)
        stream = vtk.vtkIdList()
        grid.GetFaceStream(c, stream)
        rest, polyhedron = [stream.GetId(i) for i in range(1, stream.GetNumberOfIds())], []
        while rest:
            polyhedron.append(rest[1:rest[0] + 1])
            rest = rest[rest[0] + 1:]
        cells.append(polyhedron)
        check_value(points[sorted({p for f in polyhedron for p in f})], data["T"][c])
    n = len(cells)
    same("patches of cells", set(data["patch"][:n]), {-1})
    return compare(expected, points, grouped(cells, data["region"][:n]), grouped(faces, data["patch"][n:]))


def check_value(points, value):
    at_points = 1 + 2 * points[:, 0] - 3 * points[:, 1] + points[:, 2] / 2
    if not at_points.min() - 1e-9 <= value <= at_points.max() + 1e-9:
        raise Difference(f"T of a cell is {value}, that of its points from {at_points.min()} to {at_points.max()}")


def with_h5py(folder, expected):
    import h5py
    out = subprocess.run(["cgnscheck", str(folder / "cgns.cgns")], capture_output=True, text=True, timeout=60)
    log = out.stdout + out.stderr
    if "ERROR" in log or "checking complete" not in log:
        raise Difference("cgnscheck: " + log[-600:])
    with h5py.File(folder / "cgns.cgns") as file:
        zone = file["Base/Zone"]
        points = np.array([zone[f"GridCoordinates/Coordinate{axis}/ data"] for axis in "XYZ"]).T
        sections = {}
        for name, node in zone.items():
            if node.attrs.get("label") != b"Elements_t":
                continue
            first = int(node["ElementRange/ data"][0])
            starts, members = node["ElementStartOffset/ data"][:], node["ElementConnectivity/ data"][:]
            sections[name] = (int(node[" data"][0]), {first + i: members[a:b] for i, (a, b) in enumerate(zip(starts, starts[1:]))})
        polygons = {n: [int(p) - 1 for p in f] for kind, s in sections.values() if kind == 22 for n, f in s.items()}
        cells = [[[polygons[f] if f > 0 else polygons[-f][::-1] for f in cell] for cell in s.values()]
                 for kind, s in sections.values() if kind == 23]
        numbers = sorted(n for _, s in sections.values() for n in s)
        same("numbers", numbers, list(range(1, len(numbers) + 1)))
        patches = [[polygons[n] for n in range(*(node["PointRange/ data"][:].ravel() + [0, 1]))]
                   for node in zone["ZoneBC"].values() if node.attrs.get("label") == b"BC_t"]
        order = [cell for region in cells for cell in region]
        for cell, value in zip(order, zone["Cell solution/T/ data"][:]):
            check_value(points[sorted({p for f in cell for p in f})], value)
    return compare(expected, points, cells, patches)


def with_foam(folder, expected):
    mesh = folder / "case/constant/polyMesh"
    points = np.array([[float(x) for x in m.split()] for m in re.findall(r"\(([^()]+)\)", foam_body(mesh / "points"))])
    faces = [[int(x) for x in m.split()] for m in re.findall(r"\d+\(([^()]+)\)", foam_body(mesh / "faces"))]
    owner, neighbour = foam_labels(foam_body(mesh / "owner")), foam_labels(foam_body(mesh / "neighbour"))
    pairs = list(zip(owner, neighbour))
    same("order of faces", pairs, sorted(pairs))
    cells = [[] for _ in range(max(owner + neighbour) + 1)]
    for f, c in enumerate(owner):
        cells[c].append(faces[f])
    for f, c in enumerate(neighbour):
        cells[c].append(faces[f][::-1])
    patches = []
    for block in re.findall(r"\S+\s*\{([^}]*)\}", foam_body(mesh / "boundary")):
        count, start = (int(re.search(rf"{key}\s+(\d+)", block).group(1)) for key in ("nFaces", "startFace"))
        patches.append(faces[start:start + count])
    zones = {name: [foam_labels(m) for m in re.findall(r"Labels\s+List<label>\s+\d+\s*(\([^)]*\))", foam_body(mesh / name))]
             for name in ("cellZones", "faceZones")}
    patches += [[faces[f] for f in zone] for zone in zones["faceZones"]]
    if judges.has_openfoam("checkMesh"):
        with tempfile.TemporaryDirectory() as work:
            shutil.copytree(folder / "case", Path(work) / "case")
            case = judges.new_case(work)
            out = subprocess.run(["checkMesh", "-allTopology", "-case", str(case)], capture_output=True, text=True, timeout=120)
            if "Mesh OK" not in out.stdout:
                raise Difference("checkMesh: " + (out.stdout + out.stderr)[-1500:])
    return compare(expected, points, [[cells[c] for c in zone] for zone in zones["cellZones"]], patches)


def main():
    failed = False
    for folder in sorted(Path(sys.argv[1]).glob("*_polyhedra")):
        expected = json.loads((folder / "expected.json").read_text())
        for name, judge, needs in (("VTK", with_vtk, "vtk"), ("h5py, cgnscheck", with_h5py, "h5py"), ("checkMesh", with_foam, None)):
            try:
                if needs:
                    __import__(needs)
            except ImportError:
                print(f"  {folder.name}: {name} is not installed: skipped")
                continue
            try:
                print(f"  {folder.name}: {name}: {judge(folder, expected)} polyhedra")
            except Difference as difference:
                failed = True
                print(f"  {folder.name}: {name}: {difference}")
    sys.exit(failed)


main()
