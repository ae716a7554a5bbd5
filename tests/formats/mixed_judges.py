#!/usr/bin/python3
"""Reads the files of write_samples that have wedges, pyramids and quadrilaterals with programs that are not ours, and compares
with expected.json: nodes, elements of each kind, volumes of regions and sets, areas of patches. Volumes are those of the bodies
that the faces of each element bound, mid-side nodes included, all positive; and what the programs themselves compute.

    mixed_judges.py FOLDER [FORMAT ...]

Judges: Gmsh (msh, msh22, nastran), meshio (nastran, medit, meditb, vtu, vtk, xdmf), VTK (vtu, vtk, exodus), CalculiX (abaqus),
python3-med (med), netCDF4 (exodus), h5py (xdmf, cgns), cgnscheck (cgns), checkMesh (openfoam), ideasUnvToFoam (unv), gmshToFoam
(msh22); and, in mixed_readers.py, readers of our own by the manuals (abaqus, unv, ansys, lsdyna, febio, su2). What is not
installed is skipped, and said. Exit status 1 if any of them finds a difference.
"""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import judges
import mixed_readers
from judges import Difference, near, same
from mixed_readers import CORNERS, EDGES, KIND

FACES = {"tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
         "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
         "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]}

GAUSS = np.polynomial.legendre.leggauss(4)
G = [(0.5 * (x + 1), 0.5 * w) for x, w in zip(*GAUSS)]


def triangle_slopes(u, v, second):
    l = [1 - u - v, u, v]
    d = [(-1, -1), (1, 0), (0, 1)]
    if not second:
        return np.array(l), np.array(d, float)
    values = [x * (2 * x - 1) for x in l] + [4 * l[i] * l[j] for i, j in ((0, 1), (1, 2), (2, 0))]
    slopes = [[(4 * x - 1) * g for g in d[i]] for i, x in enumerate(l)]
    slopes += [[4 * (l[i] * d[j][a] + l[j] * d[i][a]) for a in (0, 1)] for i, j in ((0, 1), (1, 2), (2, 0))]
    return np.array(values), np.array(slopes)


def quad_slopes(u, v, second):
    r, s = 2 * u - 1, 2 * v - 1
    values, slopes = [], []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        if second:
            values.append((1 + a * r) * (1 + b * s) * (a * r + b * s - 1) / 4)
            slopes.append((a * (1 + b * s) * (2 * a * r + b * s) / 2, b * (1 + a * r) * (2 * b * s + a * r) / 2))
        else:
            values.append((1 + a * r) * (1 + b * s) / 4)
            slopes.append((a * (1 + b * s) / 2, b * (1 + a * r) / 2))
    if second:
        for a, b in ((0, -1), (1, 0), (0, 1), (-1, 0)):
            if a == 0:
                values.append((1 - r * r) * (1 + b * s) / 2)
                slopes.append((-2 * r * (1 + b * s), b * (1 - r * r)))
            else:
                values.append((1 - s * s) * (1 + a * r) / 2)
                slopes.append((a * (1 - s * s), -2 * s * (1 + a * r)))
    return np.array(values), np.array(slopes, float)


def over_face(points, nodes, count):
    """The volume under a face seen from the origin, and its area."""
    second = len(nodes) > count
    p = points[list(nodes)]
    flux = area = 0.0
    for u, wu in G:
        for v, wv in G:
            y, w = (v * (1 - u), wu * wv * (1 - u)) if count == 3 else (v, wu * wv)
            values, slopes = (triangle_slopes if count == 3 else quad_slopes)(u, y, second)
            x, (a, b) = values @ p, slopes.T @ p
            normal = np.cross(a, b)
            flux += w * (x @ normal) / 3
            area += w * np.linalg.norm(normal)
    return flux, area


def volume(points, nodes):
    kind = KIND[len(nodes)]
    corners = CORNERS[kind]
    mids = {frozenset(e): nodes[corners + i] for i, e in enumerate(EDGES[kind])} if len(nodes) > corners else {}
    total = 0.0
    for face in FACES[kind]:
        around = [frozenset((face[i], face[(i + 1) % len(face)])) for i in range(len(face))]
        total += over_face(points, [nodes[i] for i in face] + [mids[e] for e in around if mids], len(face))[0]
    return total


class Read(mixed_readers.Read):
    @classmethod
    def of(cls, read):
        found = cls(read.points)
        found.cells, found.faces, found.parts = read.cells, read.faces, read.parts
        return found

    def compare(self, expected, wanted=("elements", "faces"), names=lambda n: n, sets=True, tolerance=1e-9):
        same("nodes", len(self.points), expected["nodes"])
        kinds = [KIND[len(c)] for c in self.cells]
        for kind in CORNERS:
            same(f"elements {kind}", kinds.count(kind), expected[kind])
        second = {len(c) > CORNERS[k] for c, k in zip(self.cells, kinds)}
        same("orders", len(second), 1)
        used = {n for c in self.cells for n in c}
        same("nodes of elements", len(used), expected["nodes"])
        volumes = np.array([volume(self.points, c) for c in self.cells])
        if volumes.min() <= 0:
            raise Difference(f"{(volumes <= 0).sum()} elements have no positive volume")
        whole = sum(p["measure"] for p in expected["parts"] if p["kind"] == "elements" and not p["set"])
        near("volume", volumes.sum(), whole, tolerance)
        checked = 0
        for part in expected["parts"]:
            if part["kind"] not in wanted or (part["set"] and not sets):
                continue
            members = self.parts.get((part["kind"], names(part["name"])))
            if members is None:
                raise Difference(f"there is no {names(part['name'])}; there are {sorted(self.parts)}")
            same(f"{part['kind']} of {part['name']}", len(members), part["size"])
            if part["kind"] == "elements":
                near(f"volume of {part['name']}", volumes[list(members)].sum(), part["measure"], tolerance)
            else:
                area = sum(over_face(self.points, self.faces[f], 3 if len(self.faces[f]) in (3, 6) else 4)[1] for f in members)
                near(f"area of {part['name']}", area, part["measure"], 1e-3)
            checked += 1
        return checked


# ---- Gmsh: places of our nodes in its lists

GMSH_CELLS = {4: range(4), 7: range(5), 6: range(6), 11: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
              19: [0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12], 18: [0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11]}


def with_gmsh(file, expected, wanted, names, sets=True, tolerance=1e-9):
    import gmsh
    gmsh.initialize(["", "-v", "1"])
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(file))
        tags, coords, _ = gmsh.model.mesh.getNodes()
        index = {int(t): i for i, t in enumerate(tags)}
        read = Read(coords.reshape(-1, 3))
        entities, own_volume = {}, 0.0
        for dim in (2, 3):
            for d, entity in gmsh.model.getEntities(dim):
                for kind, ids, flat in zip(*gmsh.model.mesh.getElements(dim, entity)):
                    rows = [[index[int(n)] for n in row] for row in flat.reshape(len(ids), -1)]
                    to = read.faces if dim == 2 else read.cells
                    if dim == 3:
                        rows = [[row[k] for k in GMSH_CELLS[kind]] for row in rows]
                        places, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss6")
                        jacobians = gmsh.model.mesh.getJacobians(kind, places, entity)[1]
                        if jacobians.min() <= 0:
                            raise Difference("Gmsh finds a Jacobian that is not positive")
                        if kind not in (7, 19):  # its weights on pyramids are for another purpose
                            own_volume += (jacobians.reshape(-1, len(weights)) @ weights).sum()
                    entities.setdefault((dim, entity), []).extend(range(len(to), len(to) + len(rows)))
                    to.extend(rows)
        kinds = {2: "faces", 3: "elements"}
        for dim, group in gmsh.model.getPhysicalGroups():
            if dim > 1:
                read.parts[kinds[dim], gmsh.model.getPhysicalName(dim, group)] = [
                    m for e in gmsh.model.getEntitiesForPhysicalGroup(dim, group) for m in entities.get((dim, e), [])]
        others = sum(volume(read.points, c) for c in read.cells if KIND[len(c)] != "pyramid")
        near("Gmsh's own volume", own_volume, others, 1e-9)
        return read.compare(expected, wanted, names, sets, tolerance)
    finally:
        gmsh.finalize()


BOTH = ("elements", "faces")


def judge_msh(folder, expected):
    yield "gmsh", with_gmsh(folder / "msh.msh", expected, BOTH, lambda n: n)


def judge_msh22(folder, expected):
    yield "gmsh", with_gmsh(folder / "msh22.msh", expected, BOTH, lambda n: n, sets=False)
    text = folder.with_name(folder.name + "_text") / "msh22.msh"
    if folder.name == "mixed_linear":
        yield from into_openfoam("gmshToFoam", text, expected)


# ---- meshio

MESHIO = {"tetra": "cells", "tetra10": "cells", "pyramid": "cells", "pyramid13": "cells", "wedge": "cells", "wedge15": "cells",
          "triangle": "faces", "triangle6": "faces", "quad": "faces", "quad8": "faces"}


def from_meshio(mesh, key=None, region=lambda n: n, patch=lambda n: n, wedge15=range(15)):
    """`key`: of cell data with numbers of regions and patches."""
    read = Read(mesh.points)
    numbers = {"cells": [], "faces": []}
    for b, block in enumerate(mesh.cells):
        to = MESHIO.get(block.type)
        if to is None:
            continue
        rows = [list(row) for row in block.data]
        if block.type == "wedge15":
            rows = [[row[k] for k in wedge15] for row in rows]
        getattr(read, to).extend(rows)
        if key:
            numbers[to].extend(np.asarray(mesh.cell_data[key][b]).ravel().tolist())
    if key:
        for i, name in enumerate(("layers", "volume")):
            read.parts["elements", name] = [c for c, n in enumerate(numbers["cells"]) if n == region(i)]
        for i, name in enumerate(("wall", "top", "low", "high", "end", "steps", "between")):
            read.parts["faces", name] = [c for c, n in enumerate(numbers["faces"]) if n == patch(i)]
    return read


def meshio_read(file):
    from meshio import _mesh
    for kind in ("pyramid13", "wedge15"):  # which it knows, and forgets there
        _mesh.topological_dimension.setdefault(kind, 3)
    return judges.with_meshio(file)


def judge_medit(folder, expected):
    read = from_meshio(meshio_read(folder / "medit.mesh"), "medit:ref", lambda i: i + 1, lambda i: i + 1)
    yield "meshio", read.compare(expected, sets=False)


def judge_nastran(folder, expected):
    read = from_meshio(meshio_read(folder / "nastran.bdf"), "nastran:ref", lambda i: i + 1, lambda i: i + 3)
    yield "meshio", read.compare(expected, sets=False, tolerance=1e-6)
    if folder.name == "mixed_linear":  # it drops mid-side nodes of pyramids
        yield "gmsh", with_gmsh(folder / "nastran.bdf", expected, (), None, tolerance=1e-6)


def judge_abaqus(folder, expected):
    text = (folder / "abaqus.inp").read_text()
    yield "second reader", Read.of(mixed_readers.abaqus(text)).compare(expected, tolerance=1e-9)
    yield "calculix", with_calculix(folder, expected)


def judge_meditb(folder, expected):
    read = from_meshio(meshio_read(folder / "meditb.meshb"), "medit:ref", lambda i: i + 1, lambda i: i + 1)
    yield "meshio", read.compare(expected, sets=False)


def judge_xdmf(folder, expected):
    yield "h5py", Read.of(mixed_readers.xdmf(folder / "xdmf.xdmf")).compare(expected)
    if folder.name == "mixed_linear":  # of second order it knows no mixed elements
        mesh = meshio_read(folder / "xdmf.xdmf")
        yield "meshio", from_meshio(mesh, "region", lambda i: i + 1).compare(expected, ("elements",), sets=False)


def judge_med(folder, expected):
    yield "python3-med", Read.of(mixed_readers.med(folder / "med.med")).compare(expected)


# ---- VTK

VTK_CELLS = {10: range(4), 14: range(5), 13: [0, 2, 1, 3, 5, 4], 24: range(10), 27: range(13),
             26: [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]}
VTK_FACES = (5, 9, 22, 23)


def rows_of(grid):
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        yield cell.GetCellType(), [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]


def with_vtk(reader, file, expected):
    from vtk.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(file))
    if hasattr(reader, "ReadAllFieldsOn"):
        reader.ReadAllFieldsOn()
        reader.ReadAllScalarsOn()
    reader.Update()
    grid = reader.GetOutput()
    read = Read(vtk_to_numpy(grid.GetPoints().GetData()))
    place = []
    for kind, nodes in rows_of(grid):
        if kind in VTK_CELLS:
            place.append(("elements", len(read.cells)))
            read.cells.append([nodes[k] for k in VTK_CELLS[kind]])
        elif kind in VTK_FACES:
            place.append(("faces", len(read.faces)))
            read.faces.append(nodes)
        else:
            place.append(("edges", 0))
    data = grid.GetCellData()
    for part in expected["parts"]:
        kind = part["kind"]
        array, value = f"{kind} {part['name']}", 1
        if not part["set"]:
            array = "region" if kind == "elements" else "patch"
            value = grid.GetFieldData().GetArray(f"{array} {part['name']}").GetValue(0)
        values = vtk_to_numpy(data.GetArray(array))
        read.parts[kind, part["name"]] = [i for (k, i), v in zip(place, values) if k == kind and v == value]
    vtk_volume(grid, expected)
    outward_faces(grid)
    return read.compare(expected)


def vtk_volume(grid, expected):
    """What VTK computes, by dividing: of curved cells it is near only."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    found = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    kinds = [kind for kind, _ in rows_of(grid)]
    own = np.array([v for v, k in zip(found, kinds) if k in VTK_CELLS])
    if own.min() <= 0:
        raise Difference("VTK finds volumes of 0 and less")
    whole = sum(p["measure"] for p in expected["parts"] if p["kind"] == "elements" and not p["set"])
    near("VTK's own volume", own.sum(), whole, 1e-6 if 13 in kinds else 0.02)


def outward_faces(grid):
    """The faces that VTK draws of a wedge or pyramid look outward."""
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        if cell.GetCellType() not in (13, 14, 26, 27):
            continue
        points = np.array([cell.GetPoints().GetPoint(i) for i in range(cell.GetNumberOfPoints())])
        middle = points[:6 if cell.GetCellType() in (13, 26) else 5].mean(axis=0)
        for f in range(cell.GetNumberOfFaces()):
            face = cell.GetFace(f)
            p = np.array([face.GetPoints().GetPoint(i) for i in range(3)])
            if np.cross(p[1] - p[0], p[2] - p[0]) @ (p.mean(axis=0) - middle) <= 0:
                raise Difference(f"face {f} of VTK's cell {c} looks inward")


def judge_vtu(folder, expected):
    import vtk
    yield "vtk", with_vtk(vtk.vtkXMLUnstructuredGridReader(), folder / "vtu.vtu", expected)
    wedge15 = VTK_CELLS[26]  # meshio leaves these as VTK has them
    yield "meshio", from_meshio(meshio_read(folder / "vtu.vtu"), wedge15=wedge15).compare(expected, ())


def judge_vtk(folder, expected):
    import vtk
    yield "vtk", with_vtk(vtk.vtkUnstructuredGridReader(), folder / "vtk.vtk", expected)
    yield "meshio", from_meshio(meshio_read(folder / "vtk.vtk"), wedge15=VTK_CELLS[26]).compare(expected, ())


def judge_exodus(folder, expected):
    """Blocks and side sets as VTK reads them; the order of nodes by netCDF4, with the manual's."""
    yield "netCDF4", Read.of(mixed_readers.exodus(folder / "exodus.exo")).compare(expected)
    import vtk
    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(str(folder / "exodus.exo"))
    reader.UpdateInformation()
    for code in (reader.SIDE_SET, reader.ELEM_BLOCK):
        for i in range(reader.GetNumberOfObjects(code)):
            reader.SetObjectStatus(code, i, 1)
    reader.Update()
    blocks, sides = reader.GetOutput().GetBlock(0), reader.GetOutput().GetBlock(4)
    grids = [blocks.GetBlock(b) for b in range(blocks.GetNumberOfBlocks())]
    vtk_cells(grids, expected, ("tetra", "pyramid", "wedge"))
    for s in range(sides.GetNumberOfBlocks()):
        name = sides.GetMetaData(s).Get(vtk.vtkCompositeDataSet.NAME()).split(" ID: ")[0]
        part = next(p for p in expected["parts"] if p["name"] == name and p["kind"] == "faces")
        grid = sides.GetBlock(s)
        points = np.array([grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())])
        area = sum(over_face(points, nodes, 3 if kind in (5, 22) else 4)[1] for kind, nodes in rows_of(grid))
        same(f"sides of {name}", grid.GetNumberOfCells(), part["size"])
        near(f"area of {name} by VTK", area, part["measure"], 1e-3)
    yield "vtk", sides.GetNumberOfBlocks()


def vtk_cells(grids, expected, kinds):
    """Elements that VTK's readers of other formats make, whose wedges they leave as those formats have them: the first
    triangle faces inward."""
    read = [(KIND[len(nodes)], volume(points, nodes)) for points, nodes in
            ((np.array([g.GetPoint(i) for i in range(g.GetNumberOfPoints())]), nodes)
             for g in grids for kind, nodes in rows_of(g) if kind in VTK_CELLS)]
    for kind in kinds:
        same(f"VTK's elements {kind}", sum(k == kind for k, _ in read), expected[kind])
    if min(v for _, v in read) <= 0:
        raise Difference("of what VTK reads not all has a positive volume")
    whole = sum(p["measure"] for p in expected["parts"] if p["kind"] == "elements" and not p["set"])
    if len(kinds) == 3:
        near("volume by VTK", sum(v for _, v in read), whole, 1e-6)


def judge_cgns(folder, expected):
    out = subprocess.run(["cgnscheck", str(folder / "cgns.cgns")], capture_output=True, text=True, timeout=60)
    log = out.stdout + out.stderr
    if "ERROR" in log or "error" in log.lower().replace("0 errors", ""):
        raise Difference("cgnscheck: " + log[-600:])
    yield "cgnscheck", 1
    yield "h5py", Read.of(mixed_readers.cgns(folder / "cgns.cgns")).compare(expected, sets=False)
    import vtk
    reader = vtk.vtkCGNSReader()
    reader.SetFileName(str(folder / "cgns.cgns"))
    reader.Update()
    grids, at = [], reader.GetOutput().NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        grids.append(at.GetCurrentDataObject())
        at.GoToNextItem()
    # It knows no PYRA_13.
    kinds = ("tetra", "pyramid", "wedge") if folder.name == "mixed_linear" else ("tetra", "wedge")
    vtk_cells(grids, expected, kinds)
    yield "vtk", len(kinds)


# ---- CalculiX: volumes, and a stretch that must be the same everywhere

def with_calculix(folder, expected):
    """The displacement u = 0.01 x on all of the boundary makes the stress the same in all elements."""
    text = (folder / "abaqus.inp").read_text()
    if "C3D5" in text:
        # CalculiX has no pyramids: the wedges and tetrahedra alone, which lose a block of their neighbours.
        lines, keep = [], True
        for line in text.split("\n"):
            if line.startswith("*ELEMENT"):
                keep = "C3D5" not in line
            elif line.startswith("*"):
                keep = not line.startswith(("*ELSET", "*SURFACE"))
            if keep:
                lines.append(line)
        text = "\n".join(lines)
    with tempfile.TemporaryDirectory() as work:
        (Path(work) / "mesh.inp").write_text(text + "\n")
        points = Read.of(mixed_readers.abaqus(text)).points
        deck = ["*INCLUDE, INPUT=mesh.inp", "*MATERIAL, NAME=M", "*ELASTIC", "1000., 0."]
        deck += [f"*SOLID SECTION, ELSET={r}, MATERIAL=M" for r in ("layers", "volume")] + ["*STEP", "*STATIC", "*BOUNDARY"]
        for i, p in enumerate(points):
            deck += [f"{i + 1}, 1, 1, {0.01 * p[0]:.10e}", f"{i + 1}, 2, 3, 0."]
        deck += ["*EL PRINT, ELSET=layers, TOTALS=YES", "EVOL", "*EL PRINT, ELSET=volume, TOTALS=YES", "EVOL",
                 "*EL PRINT, ELSET=layers", "S", "*END STEP"]
        (Path(work) / "job.inp").write_text("\n".join(deck) + "\n")
        out = subprocess.run(["ccx", "-i", "job"], cwd=work, capture_output=True, text=True, timeout=120)
        log = out.stdout + out.stderr
        if "Job finished" not in log or "*ERROR" in log:
            raise Difference("ccx: " + log[-600:])
        lines = (Path(work) / "job.dat").read_text().split("\n")
        totals = [float(lines[i + 2].split()[-1]) for i, l in enumerate(lines) if "total volume" in l.lower()]
        same("totals", len(totals), 2)
        near("ccx volume", totals[1], next(p["measure"] for p in expected["parts"] if p["name"] == "volume"), 1e-5)
        layers = next(p["measure"] for p in expected["parts"] if p["name"] == "layers")
        if "C3D5" in (folder / "abaqus.inp").read_text():
            layers -= 6 * 0.25 * 0.5 / 3  # pyramids: base 1 x 1/4, height 1/2
        near("ccx volume of layers", totals[0], layers, 3e-4)  # its sum over curved pyramids is not exact
        at = next(i for i, l in enumerate(lines) if "stresses" in l)
        rows = [[float(x) for x in l.split()[2:]] for l in lines[at + 2:] if len(l.split()) == 8]
        strain = 0.01
        for row in rows:
            near("stress", row[0], 1000 * strain, 1e-4)
        same("stresses", len(rows) > 0, True)
    return 2


# ---- OpenFOAM

def into_openfoam(converter, file, expected):
    if not judges.has_openfoam(converter):
        return
    whole = sum(p["measure"] for p in expected["parts"] if p["kind"] == "elements" and not p["set"])
    with tempfile.TemporaryDirectory() as work:
        case = judges.new_case(work)
        out = subprocess.run([converter, "-case", str(case), str(file)], capture_output=True, text=True, timeout=120)
        if not (case / "constant/polyMesh/boundary").exists():
            raise Difference(f"{converter}: " + (out.stdout + out.stderr)[-1500:])
        yield converter, check_mesh(case, whole, expected)


def check_mesh(case, whole, expected):
    out = subprocess.run(["checkMesh", "-allTopology", "-case", str(case)], capture_output=True, text=True, timeout=120)
    log = out.stdout + out.stderr
    if "Mesh OK" not in log:
        raise Difference("checkMesh: " + log[-1500:])
    near("checkMesh volume", float(log.split("Total volume = ")[1].split()[0].rstrip(".")), whole, 1e-4)
    for kind, words in (("tetra", "tetrahedra:"), ("pyramid", "pyramids:"), ("wedge", "prisms:")):
        same(f"checkMesh's {words}", int(log.split(words)[1].split()[0]), expected[kind])
    return 3


def judge_openfoam(folder, expected):
    if not (folder / "case").exists() or not judges.has_openfoam("checkMesh"):
        return
    whole = sum(p["measure"] for p in expected["parts"] if p["kind"] == "elements" and not p["set"])
    with tempfile.TemporaryDirectory() as work:
        shutil.copytree(folder / "case", Path(work) / "case")
        yield "checkMesh", check_mesh(judges.new_case(work), whole, expected)


def judge_unv(folder, expected):
    yield "second reader", Read.of(mixed_readers.unv(folder / "unv.unv")).compare(expected)
    if folder.name == "mixed_linear":
        yield from into_openfoam("ideasUnvToFoam", folder / "unv.unv", expected)


def judge_ansys(folder, expected):
    read = Read.of(mixed_readers.ansys(folder / "ansys.cdb"))
    yield "second reader", read.compare(expected, ("elements",), str.upper)


def judge_lsdyna(folder, expected):
    yield "second reader", Read.of(mixed_readers.lsdyna(folder / "lsdyna.k")).compare(expected, tolerance=1e-6)


def judge_febio(folder, expected):
    yield "second reader", Read.of(mixed_readers.febio(folder / "febio.feb")).compare(expected)


def judge_su2(folder, expected):
    outside = dict(expected, parts=[p for p in expected["parts"] if p["kind"] == "faces" and p["name"] != "between"
                                    or p["kind"] == "elements"])
    yield "second reader", Read.of(mixed_readers.su2(folder / "su2.su2")).compare(outside, ("faces",), sets=False)


def judge_mfem(folder, expected):
    read = judges.with_mfem(folder / "mfem.msh")
    same("nodes", read["nodes"], expected["nodes"])
    same("elements", read["elements"], sum(expected[kind] for kind in CORNERS))
    same("boundary", read["boundary"], expected["triangle"] + expected["quad"])
    parts = [p for p in expected["parts"] if not p["set"]]
    for kind, names, measures in (("elements", "names", "regions"), ("faces", "boundary_names", "patches")):
        for part in (p for p in parts if p["kind"] == kind):
            number, = read[names][part["name"]]
            same(f"size of {part['name']}", read[measures][str(number)]["size"], part["size"])
            near(f"measure of {part['name']}", read[measures][str(number)]["measure"], part["measure"], 1e-12)
    yield "MFEM", len(parts)


JUDGES = {name[6:]: judge for name, judge in globals().items() if name.startswith("judge_")}


def main():
    folder = Path(sys.argv[1])
    failed = 0
    for name in sys.argv[2:] or JUDGES:
        for order in ("mixed_linear", "mixed_second"):
            expected = json.loads((folder / order / "expected.json").read_text())
            if not any((folder / order).glob(name + ".*")) and name != "openfoam":
                print(f"skipped  {name:9} {order}: not in this build, or of tetrahedra")
                continue
            try:
                for judge, checked in JUDGES[name](folder / order, expected):
                    print(f"agrees   {name:9} {order:6} by {judge}: volumes, counts, {checked} parts")
            except (Difference, KeyError, ValueError, IndexError, StopIteration, OSError, subprocess.SubprocessError,
                    TypeError, AttributeError) as error:
                failed += 1
                print(f"DIFFERS  {name:9} {order}: {type(error).__name__}: {error}")
            except ImportError as error:
                print(f"skipped  {name:9} {order}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
