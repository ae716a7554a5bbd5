#!/usr/bin/python3
"""Reads the files of write_samples with programs that are not ours, and compares with expected.json: nodes, tetrahedra,
volumes by quadrature, groups with their sizes, and areas or volumes.

    judges.py FOLDER [FORMAT ...]

Judges: gmsh (msh, msh22, unv, nastran, medit), meshio (abaqus, nastran, vtu, vtk, meditb, netgen, xdmf, tetgen, exodus; cells: the
tetrahedra alone, in what it reads), VTK (vtu, vtk, exodus), CalculiX (abaqus), MFEM (mfem, $MFEM_DIR says where it was built), Netgen itself (netgen of orders 3 and 4, $NETGEN_DIR), DOLFINx (xdmf, and msh22 of order 3), python3-med (med), h5py (xdmf, cgns),
cgnscheck (cgns), checkMesh (openfoam), ideasUnvToFoam (unv), gmshToFoam (msh22 as text), and for what nobody in Debian
reads (ansys, lsdyna, febio, su2), readers of their own in second_readers.py, written from the manuals.
What is not installed is skipped, and said. Exit status 1 if any judge finds a difference.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import second_readers

# Barycentric points and weights exact to degree 3: the Jacobian of a quadratic tetrahedron has that degree.
TET_POINTS = [(0.25, 0.25, 0.25, 0.25)] + [tuple(0.5 if i == k else 1 / 6 for i in range(4)) for k in range(4)]
TET_WEIGHTS = [-0.8 / 6] + [0.45 / 6] * 4
TRI_POINTS = [(2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6), (1 / 6, 1 / 6, 2 / 3)]
MIDS = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]  # VTK


def gradients(bary, second):
    n = len(bary)
    slope = [[-1.0] * (n - 1)] + [[1.0 if i == a else 0.0 for a in range(n - 1)] for i in range(n - 1)]
    rows = [[s * ((4 * l - 1) if second else 1) for s in slope[i]] for i, l in enumerate(bary)]
    if second:
        for i, j in MIDS[: 6 if n == 4 else 3]:
            rows.append([4 * (bary[i] * slope[j][a] + bary[j] * slope[i][a]) for a in range(n - 1)])
    return np.array(rows)


def volumes(points, tets):
    nodes = points[tets]
    out = np.zeros(len(tets))
    for bary, weight in zip(TET_POINTS, TET_WEIGHTS):
        jacobians = np.einsum("nka,kb->nab", nodes, gradients(bary, tets.shape[1] == 10))
        out += weight * np.linalg.det(jacobians)
    return out


def areas(points, triangles):
    nodes = points[triangles]
    out = np.zeros((len(triangles), 3))
    for bary in TRI_POINTS:
        j = np.einsum("nka,kb->nab", nodes, gradients(bary, triangles.shape[1] == 6))
        out += np.cross(j[:, :, 0], j[:, :, 1]) / 6
    return np.linalg.norm(out, axis=1)


class Difference(Exception):
    pass


class Found:
    """What a judge read: tets in the order of VTK; parts: (kind, name) -> indices, or node lists of faces."""

    def __init__(self, points, tets):
        self.points = np.asarray(points, dtype=float)
        self.tets = np.asarray(tets, dtype=np.int64)
        self.parts = {}

    def compare(self, expected, wanted, names=lambda name: name, tolerance=1e-9):
        """`wanted`: pairs of origin (or set kind) and what the judge must have of it: "size", "nodes", "measure"."""
        same("nodes", len(self.points), expected["nodes"])
        same("tetrahedra", len(self.tets), expected["tets"])
        v = volumes(self.points, self.tets)
        if v.min() <= 0:
            raise Difference(f"{(v <= 0).sum()} tetrahedra have no positive volume")
        near("volume", v.sum(), expected["volume"], tolerance)
        checked = 0
        for part in expected["parts"]:
            key = part["origin"] if part["origin"] != "set" else part["kind"] + " set"
            if key not in wanted:
                continue
            if key == "patch" and wanted[key] == "named" and not part["named"]:
                continue
            label = names(part["name"]) if part["named"] or wanted.get("unnamed", True) else None
            if label is None:
                continue
            place = {"elements": "elements", "faces": "faces", "edges": "edges", "nodes": "nodes"}[part["kind"]]
            self.compare_part(part, place, label, wanted[key], v, tolerance)
            checked += 1
        if checked == 0 and any(k != "unnamed" for k in wanted):
            raise Difference("no part was compared")
        return checked

    def compare_part(self, part, kind, label, what, tet_volumes, tolerance):
        if what == "nodes":
            members = self.parts.get(("nodes", label))
            if members is None:
                raise Difference(f"there is no set of nodes {label}; there are {sorted(k[1] for k in self.parts)}")
            return same(f"nodes of {label}", len(set(members)), part["nodes"])
        members = self.parts.get((kind, label))
        if members is None:
            raise Difference(f"there is no set of {kind} {label}; there are {sorted(self.parts)}")
        same(f"{kind} of {label}", len(members), part["size"])
        if kind == "elements":
            near(f"volume of {label}", tet_volumes[np.asarray(members)].sum(), part["measure"], tolerance)
        if kind == "faces":
            triangles = np.asarray(members)
            if self.tets.shape[1] == 10 and triangles.shape[1] == 3:
                return
            near(f"area of {label}", areas(self.points, triangles).sum(), part["measure"], tolerance)


def same(what, found, wanted):
    if found != wanted:
        raise Difference(f"{what}: {found}, not {wanted}")


def near(what, found, wanted, tolerance):
    if abs(found - wanted) > tolerance * abs(wanted):
        raise Difference(f"{what}: {found:.15g}, not {wanted:.15g}")


def cubic_map(p):
    """The derivatives of write_samples' bent_cubically(); p: an array of shape (3, ...)."""
    x, y, z = p
    i = np.ones_like(x)
    return np.array([[i, .008 * y * z, .004 * y * y], [-.002 * z, i, .009 * z * z - .002 * x], [.01 * x * y, .005 * x * x, i]])


def measures_of_cube(n):
    """Of [0, n]^3 under cubic_map(): volumes of its halves by x, and areas of its sides, by x, y, z, and of the plane between."""
    at, weights = np.polynomial.legendre.leggauss(24)
    u, w = n * (at + 1) / 2, n * weights / 2
    volumes = []
    for half in (0, 1):
        grid = np.array(np.meshgrid(half * n / 2 + u / 2, u, u, indexing="ij"))
        det = np.linalg.det(np.moveaxis(cubic_map(grid), (0, 1), (-2, -1)))
        volumes.append(np.einsum("i,j,k,ijk", w / 2, w, w, det))
    areas = []
    for axis, place in ((0, 0), (0, n), (1, 0), (1, n), (2, 0), (2, n), (0, n / 2)):
        a, b = np.meshgrid(u, u, indexing="ij")
        point = np.insert(np.array([a, b]), axis, np.full_like(a, place), axis=0)
        slopes = np.moveaxis(cubic_map(point), (0, 1), (-2, -1))
        others = [k for k in range(3) if k != axis]
        normal = np.cross(slopes[..., others[0]], slopes[..., others[1]])
        areas.append(np.einsum("i,j,ij", w, w, np.linalg.norm(normal, axis=-1)))
    return volumes, areas


def underscored(name):
    return "".join(c if c.isalnum() or c in "_-" else "_" for c in name)


ALL = {"region": "size", "patch": "size", "curve": "size", "nodes set": "size", "edges set": "size", "faces set": "size",
       "elements set": "size", "unnamed": False}
NUMBERED = {"region": "size", "patch": "size", "curve": "size", "unnamed": False}


# ---- Gmsh

GMSH_TET10 = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]


def with_gmsh(file, expected, wanted, names, by_entity=False, tolerance=1e-9, linear=False):
    import gmsh
    gmsh.initialize(["", "-v", "1"])
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(file))
        tags, coords, _ = gmsh.model.mesh.getNodes()
        used = {t: i for i, t in enumerate(tags)}
        points = coords.reshape(-1, 3)
        index = np.zeros(int(max(tags)) + 1, dtype=np.int64)
        index[tags.astype(np.int64)] = np.arange(len(tags))
        places = {}
        lists = {1: [], 2: [], 3: []}
        entities = {}
        for dim in (1, 2, 3):
            for d, tag in gmsh.model.getEntities(dim):
                types, elements, nodes = gmsh.model.mesh.getElements(dim, tag)
                for kind, ids, flat in zip(types, elements, nodes):
                    rows = index[flat.astype(np.int64)].reshape(len(ids), -1)
                    if kind == 11:
                        rows = rows[:, GMSH_TET10]
                    start = len(lists[dim])
                    lists[dim].extend(rows)
                    entities.setdefault((dim, tag), []).extend(range(start, start + len(ids)))
        found = Found(points, np.array(lists[3]))
        kinds = {1: "edges", 2: "faces", 3: "elements"}
        for dim, group in gmsh.model.getPhysicalGroups():
            name = gmsh.model.getPhysicalName(dim, group)
            if dim == 0:
                nodes = [n for e in gmsh.model.getEntitiesForPhysicalGroup(0, group)
                         for n in np.concatenate(gmsh.model.mesh.getElements(0, e)[2])]
                found.parts["nodes", name] = nodes
                continue
            members = [m for e in gmsh.model.getEntitiesForPhysicalGroup(dim, group) for m in entities.get((dim, e), [])]
            found.parts[kinds[dim], name] = [lists[2][m] for m in members] if dim == 2 else members
        if by_entity:
            # No names: entities are the numbers.
            for (dim, tag), members in entities.items():
                origin = {1: "curve", 2: "patch", 3: "region"}[dim]
                label = f"{origin} {tag}"
                found.parts[kinds[dim], label] = [lists[2][m] for m in members] if dim == 2 else members
            by_name = {p["name"]: f"{p['origin']} {p['number'] + 1}" for p in expected["parts"] if p["origin"] != "set"}
            names = by_name.__getitem__
        return found.compare(expected, wanted, names, tolerance)
    finally:
        gmsh.finalize()


def judge_msh(folder, expected):
    yield "gmsh", with_gmsh(folder / "msh.msh", expected, ALL, lambda n: n.replace('"', "_"))


def judge_msh22(folder, expected):
    if expected is None:
        # DOLFINx knows Gmsh's elements up to order 3.
        if folder.name == "third":
            yield "DOLFINx", of_cube(with_dolfinx(folder / "msh22.msh"), 3)
        return
    yield "gmsh", with_gmsh(folder / "msh22.msh", expected, NUMBERED, lambda n: n.replace('"', "_"))
    if folder.name == "linear_text":
        # It loses names with blanks, and those that come after them.
        plain = dict(expected, parts=[p for p in expected["parts"] if p["name"] in ("load-1", "y_max")])
        yield from into_openfoam("gmshToFoam", folder / "msh22.msh", plain, lambda n: n)


def judge_unv(folder, expected):
    # Of an element in several groups Gmsh keeps one: patches that a set overlaps are not compared.
    wanted = {"region": "size", "patch": "size", "curve": "size", "unnamed": False}
    alone = dict(expected, parts=[p for p in expected["parts"] if p["name"] not in ("y_max", "glue", "soft part", 'Stahl "42"',
                                                                                    "edge 0", "edge 1")])
    yield "gmsh", with_gmsh(folder / "unv.unv", alone, wanted, lambda n: n.replace(" ", "_"))
    if folder.name == "linear":
        yield from into_openfoam("ideasUnvToFoam", folder / "unv.unv", expected, lambda n: n.replace(" ", "_"))


def judge_medit(folder, expected):
    yield "gmsh", with_gmsh(folder / "medit.mesh", expected, {"region": "size", "patch": "size", "curve": "size"}, None, by_entity=True)


# ---- DOLFINx

def with_dolfinx(file):
    import dolfinx  # noqa: F401, else there is nothing to ask
    return asked(sys.executable, "DOLFINx", Path(__file__).parent / "dolfinx_judge.py", file)


# ---- MFEM

def mfem_program(work, source=Path(__file__).parent / "mfem_judge.cpp"):
    """Built against MFEM where it was built ($MFEM_DIR) or where the system has it."""
    own, program = os.environ.get("MFEM_DIR"), Path(work) / "mfem_judge"
    places = [f"-I{own}", f"-L{own}"] if own else []
    done = subprocess.run(["g++", "-O1", "-std=c++17", *places[:1], source, "-o", program, *places[1:], "-lmfem", "-lrt"],
                          capture_output=True, check=False)
    if done.returncode != 0:
        raise ImportError("no MFEM ($MFEM_DIR, or libmfem-dev)")
    return program


def asked(program, title, *arguments):
    """What one of these programs prints."""
    done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=240)
    if done.returncode != 0:
        raise Difference(f"{title}: {(done.stdout + done.stderr)[-800:]}")
    read = json.loads(done.stdout[done.stdout.index("{"):])
    if read["least_jacobian"] <= 0:
        raise Difference(f"{title} finds a Jacobian of {read['least_jacobian']}")
    return read


def with_mfem(file, *more):
    with tempfile.TemporaryDirectory() as work:
        return asked(mfem_program(work), "MFEM", file, *more)


def with_netgen(file):
    """By Netgen's sources of April 2026 or later ($NETGEN_DIR), built in their folder build without Python and graphics."""
    own = Path(os.environ.get("NETGEN_DIR", "/nowhere"))
    objects = [*(own / "build/CMakeFiles/nglib.dir").rglob("*.o")]
    core = own / "build/libsrc/core"
    if not objects:
        raise ImportError("no Netgen ($NETGEN_DIR)")
    with tempfile.TemporaryDirectory() as work:
        program = Path(work) / "netgen_judge"
        places = [f"-I{own / place}" for place in ("build", ".", "include", "libsrc", "libsrc/include")]
        subprocess.run(["g++", "-O1", "-std=c++17", *places, Path(__file__).parent / "netgen_judge.cpp", "-o", program, *objects,
                        f"-L{core}", f"-Wl,-rpath,{core}", "-lngcore", "-lz", "-lpthread"], check=True, capture_output=True)
        return asked(program, "Netgen", file)


def judge_mfem(folder, expected):
    read = with_mfem(folder / "mfem.msh")
    if expected is None:
        yield "MFEM", of_cube(read, ORDERS[folder.name])
        return
    for part in expected["parts"]:
        if part["origin"] in ("region", "patch") and part["named"]:
            names = read["names" if part["origin"] == "region" else "boundary_names"]
            same(f"numbers of {part['name']}", names[part["name"]], [part["number"] + 1])
    yield "MFEM", by_number(read, expected)


def by_number(read, expected):
    """Volumes and areas of regions and patches, which have their numbers."""
    same("nodes", read["nodes"], expected["nodes"])
    same("elements", read["elements"], expected["tets"])
    near("volume", read["volume"], expected["volume"], 1e-13)
    parts = [part for part in expected["parts"] if part["origin"] in ("region", "patch")]
    for part in parts:
        is_region = part["origin"] == "region"
        found = read["regions" if is_region else "patches"][str(part["number"] + 1)]
        same(f"size of {part['name']}", found["size"], part["size"])
        # The area of a curved face is no polynomial: quadratures differ by little.
        near(f"measure of {part['name']}", found["measure"], part["measure" if is_region else "area"], 1e-12 if is_region else 1e-7)
    return len(parts)


def of_cube(read, order, n=4, nodes=None):
    same("order", read["order"], order)
    same("nodes", read["nodes"], nodes or (n * order + 1) ** 3)
    same("elements", read["elements"], 6 * n ** 3)
    volumes, areas = measures_of_cube(n)
    for number, volume in enumerate(volumes, 1):
        near(f"volume of region {number}", read["regions"][str(number)]["measure"], volume, 1e-13)
    for number, area in enumerate(areas, 1):
        near(f"area of patch {number}", read["patches"][str(number)]["measure"], area, 1e-12)
    return len(volumes) + len(areas)


# ---- meshio

def with_meshio(file, **kwargs):
    import contextlib
    import io

    import meshio
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        try:
            return meshio.read(str(file), **kwargs)
        except SystemExit as error:  # so it ends where it cannot read
            raise Difference(f"meshio cannot read {file}") from error


def blocks_of(mesh, *kinds):
    """Rows of all blocks of these kinds, and where each block begins."""
    rows, starts = [], {}
    for b, block in enumerate(mesh.cells):
        if block.type in kinds:
            starts[b] = len(rows)
            rows.extend(block.data)
    return rows, starts


def from_meshio(mesh):
    tets, starts = blocks_of(mesh, "tetra", "tetra10")
    return Found(mesh.points, np.array(tets)), starts


def parts_by_number(found, mesh, expected, key):
    """Cell data `key` holds numbers from 1 of regions, patches and curves."""
    for kind, kinds in (("elements", ("tetra", "tetra10")), ("faces", ("triangle", "triangle6")), ("edges", ("line", "line3"))):
        rows, starts = blocks_of(mesh, *kinds)
        numbers = np.concatenate([np.asarray(mesh.cell_data[key][b]).ravel() for b in starts]) if starts else []
        origin = {"elements": "region", "faces": "patch", "edges": "curve"}[kind]
        for part in expected["parts"]:
            if part["origin"] == origin:
                members = np.flatnonzero(np.asarray(numbers) == part["number"] + 1)
                found.parts[kind, part["name"]] = [rows[m] for m in members] if kind == "faces" else members


def judge_abaqus(folder, expected):
    mesh = with_meshio(folder / "abaqus.inp")
    found, starts = from_meshio(mesh)
    for name, blocks in mesh.cell_sets.items():
        found.parts["elements", name] = [starts[b] + m for b, members in enumerate(blocks) if b in starts for m in members]
    for name, nodes in mesh.point_sets.items():
        found.parts["nodes", name] = nodes
    for name in ("elements", "nodes"):
        found.parts.update({(name, k[1].lower()): v for k, v in list(found.parts.items()) if k[0] == name})
    yield "meshio", found.compare(
        expected, {"patch": "nodes", "curve": "nodes", "nodes set": "nodes"},
        lambda n: underscored(n).lower(), 1e-9)
    yield "calculix", with_calculix(folder, expected)


def judge_nastran(folder, expected):
    mesh = with_meshio(folder / "nastran.bdf")
    found, _ = from_meshio(mesh)
    last = max(p["number"] for p in expected["parts"] if p["origin"] == "region") + 1
    for kind, kinds, shift in (("elements", ("tetra", "tetra10"), 0), ("faces", ("triangle", "triangle6"), last)):
        rows, starts = blocks_of(mesh, *kinds)
        numbers = np.concatenate([np.asarray(mesh.cell_data["nastran:ref"][b]).ravel() for b in starts])
        for part in expected["parts"]:
            if part["origin"] == ("region" if kind == "elements" else "patch"):
                members = np.flatnonzero(numbers == part["number"] + 1 + shift)
                found.parts[kind, part["name"]] = [rows[m] for m in members] if kind == "faces" else members
    yield "meshio", found.compare(expected, {"region": "size", "patch": "size"}, tolerance=1e-6)
    yield "gmsh", with_gmsh(folder / "nastran.bdf", expected, {}, None, tolerance=1e-6)


def judge_meditb(folder, expected):
    if expected["nodes"] > 200:
        # meshio knows elements of second order in this format, but does not hand them out.
        read = second_readers.medit_binary(folder / "meditb.meshb", expected)
        yield "second reader", found_from(read).compare(expected, {"region": "size", "patch": "size", "curve": "size"})
        return
    mesh = with_meshio(folder / "meditb.meshb")
    found, _ = from_meshio(mesh)
    if found.tets.size == 0:
        raise Difference("meshio reads no tetrahedra")
    parts_by_number(found, mesh, expected, "medit:ref")
    yield "meshio", found.compare(expected, {"region": "size", "patch": "size", "curve": "size"})


def judge_netgen(folder, expected):
    if expected is None:
        yield "Netgen", of_cube(with_netgen(folder / "netgen.vol"), ORDERS[folder.name], nodes=5 ** 3)
        return
    mesh = with_meshio(folder / "netgen.vol")
    found, _ = from_meshio(mesh)
    parts_by_number(found, mesh, expected, "netgen:index")
    yield "meshio", found.compare(expected, {"region": "size", "patch": "size"})


def judge_tetgen(folder, expected):
    if expected["nodes"] > 200:
        # meshio reads linear TetGen only: TetGen itself reads its own files.
        yield "tetgen", with_tetgen(folder, expected)
        return
    mesh = with_meshio(folder / "tetgen.ele")
    found, _ = from_meshio(mesh)
    rows, starts = blocks_of(mesh, "tetra")
    key = next(k for k in mesh.cell_data)
    numbers = np.concatenate([np.asarray(mesh.cell_data[key][b]).ravel() for b in starts])
    for part in expected["parts"]:
        if part["origin"] == "region":
            found.parts["elements", part["name"]] = np.flatnonzero(numbers == part["number"] + 1)
    yield "meshio", found.compare(expected, {"region": "size"})
    yield "tetgen", with_tetgen(folder, expected)


def with_tetgen(folder, expected):
    """Reconstructs (-r) the mesh; its statistics count corners and tetrahedra. It does so for linear meshes only."""
    with tempfile.TemporaryDirectory() as work:
        for ending in ("node", "ele", "face"):
            shutil.copy(folder / f"tetgen.{ending}", Path(work) / f"m.{ending}")
        out = subprocess.run(["tetgen", "-rNEFQC", "m.ele"], cwd=work, capture_output=True, text=True, timeout=60)
        if out.returncode != 0 or "rror" in out.stdout + out.stderr:
            raise Difference("tetgen -r: " + (out.stdout + out.stderr).strip()[-300:])
    return 1


# ---- VTK

def with_vtk(reader, file, expected, names=lambda n: n):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(file))
    if hasattr(reader, "ReadAllFieldsOn"):
        reader.ReadAllFieldsOn()
        reader.ReadAllScalarsOn()
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    kinds = {10: "elements", 24: "elements", 5: "faces", 22: "faces", 3: "edges", 21: "edges"}
    rows = {"elements": [], "faces": [], "edges": []}
    place = []
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        kind = kinds[cell.GetCellType()]
        place.append((kind, len(rows[kind])))
        rows[kind].append([cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())])
    found = Found(points, rows["elements"])
    cells, nodes = grid.GetCellData(), grid.GetPointData()

    def members(values, kind, wanted):
        at = [i for (k, i), v in zip(place, values) if k == kind and v == wanted]
        return [rows["faces"][i] for i in at] if kind == "faces" else at

    for part in expected["parts"]:
        kind = part["kind"]
        if part["origin"] == "set":
            array = (nodes if kind == "nodes" else cells).GetArray(f"{kind} {part['name']}")
            if array is None:
                raise Difference(f"there is no array for the set {part['name']}")
            values = vtk_to_numpy(array)
            found.parts[kind, part["name"]] = np.flatnonzero(values) if kind == "nodes" else members(values, kind, 1)
        else:
            values = vtk_to_numpy(cells.GetArray(part["origin"]))
            found.parts[kind, part["name"]] = members(values, kind, part["number"])
            if part["named"]:
                field = grid.GetFieldData().GetArray(f"{part['origin']} {part['name']}")
                if field is None or field.GetValue(0) != part["number"]:
                    raise Difference(f"the name {part['name']} is lost")
    return found.compare(expected, ALL, names)


def judge_vtu(folder, expected):
    import vtk
    yield "vtk", with_vtk(vtk.vtkXMLUnstructuredGridReader(), folder / "vtu.vtu", expected)
    mesh = with_meshio(folder / "vtu.vtu")
    yield "meshio", from_meshio(mesh)[0].compare(expected, {})


def judge_vtk(folder, expected):
    import vtk
    yield "vtk", with_vtk(vtk.vtkUnstructuredGridReader(), folder / "vtk.vtk", expected)
    mesh = with_meshio(folder / "vtk.vtk")
    yield "meshio", from_meshio(mesh)[0].compare(expected, {})


def judge_exodus(folder, expected):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(str(folder / "exodus.exo"))
    reader.UpdateInformation()
    kinds = ((vtk.vtkExodusIIReader.NODE_SET, "nodes"), (vtk.vtkExodusIIReader.SIDE_SET, "faces"),
             (vtk.vtkExodusIIReader.ELEM_SET, "elements"), (vtk.vtkExodusIIReader.ELEM_BLOCK, "elements"))
    sizes = {}
    for code, kind in kinds:
        for i in range(reader.GetNumberOfObjects(code)):
            name = reader.GetObjectName(code, i)
            name = name.split(" ID: ")[0] if " ID: " in name else name
            sizes[kind, name] = reader.GetNumberOfEntriesInObject(code, i)
            reader.SetObjectStatus(code, i, 1 if code != vtk.vtkExodusIIReader.ELEM_SET else 0)
    reader.Update()
    blocks, side_sets = reader.GetOutput().GetBlock(0), reader.GetOutput().GetBlock(4)
    single = 1e-6  # VTK hands out floats
    lists = {}
    for b in range(blocks.GetNumberOfBlocks()):
        grid = blocks.GetBlock(b)
        name = blocks.GetMetaData(b).Get(vtk.vtkCompositeDataSet.NAME()).split(" ID: ")[0]
        local = vtk_to_numpy(grid.GetPoints().GetData())
        rows = [[grid.GetCell(c).GetPointId(k) for k in range(grid.GetCell(c).GetNumberOfPoints())]
                for c in range(grid.GetNumberOfCells())]
        lists[name] = volumes(local, np.array(rows))
    same("tetrahedra", sum(len(v) for v in lists.values()), expected["tets"])
    near("volume", sum(v.sum() for v in lists.values()), expected["volume"], single)
    checked = 0
    for part in expected["parts"]:
        name, kind = part["name"], part["kind"]
        if part["origin"] == "region":
            near(f"volume of {name}", lists[name].sum(), part["measure"], single)
        elif kind == "edges":
            if part["origin"] == "curve":
                same(f"nodes of {name}", sizes.get(("nodes", name)), part["nodes"])
        else:
            same(f"{kind} of {name}", sizes.get((kind, name)), part["size"])
        checked += 1
    for b in range(side_sets.GetNumberOfBlocks()):
        name = side_sets.GetMetaData(b).Get(vtk.vtkCompositeDataSet.NAME()).split(" ID: ")[0]
        grid = side_sets.GetBlock(b)
        local = vtk_to_numpy(grid.GetPoints().GetData())
        rows = np.array([[grid.GetCell(c).GetPointId(k) for k in range(grid.GetCell(c).GetNumberOfPoints())]
                         for c in range(grid.GetNumberOfCells())])
        part = next(p for p in expected["parts"] if p["name"] == name and p["kind"] == "faces")
        near(f"area of {name}", areas(local, rows).sum(), part["measure"], single)
    yield "vtk", checked
    header = subprocess.run(["ncdump", "-h", str(folder / "exodus.exo")], capture_output=True, text=True, check=True).stdout
    for text in (f"num_nodes = {expected['nodes']} ;", f"num_elem = {expected['tets']} ;"):
        if text not in header:
            raise Difference(f"ncdump does not show {text}")
    yield "ncdump", 2
    yield "meshio", from_meshio(with_meshio(folder / "exodus.exo"))[0].compare(expected, {})


# ---- CalculiX: a stretched mesh has a known strain energy only for the right order of nodes

def with_calculix(folder, expected):
    """A linear displacement on the patches must be the displacement everywhere (patch test), and the volume of each set
    must be that expected: *EL PRINT of EVOL."""
    with tempfile.TemporaryDirectory() as work:
        regions = [underscored(p["name"]) for p in expected["parts"] if p["origin"] == "region"]
        patches = [underscored(p["name"]) for p in expected["parts"] if p["origin"] == "patch"]
        deck = [f"*INCLUDE, INPUT={folder / 'abaqus.inp'}", "*MATERIAL, NAME=M", "*ELASTIC", "1000., .3"]
        shutil.copy(folder / "abaqus.inp", Path(work) / "abaqus.inp")
        deck[0] = "*INCLUDE, INPUT=abaqus.inp"
        deck += [f"*SOLID SECTION, ELSET={r}, MATERIAL=M" for r in regions]
        deck += ["*BOUNDARY", "fixed_end, 1, 3", "*STEP", "*STATIC", "*DLOAD"]
        deck = deck[:-1] + ["*DSLOAD", "load-1, P, -1.", "*EL PRINT, ELSET=" + regions[0] + ", TOTALS=YES", "EVOL",
                            "*EL PRINT, ELSET=" + regions[1] + ", TOTALS=YES", "EVOL",
                            "*NODE PRINT, NSET=fixed_end, TOTALS=ONLY", "RF", "*END STEP"]
        (Path(work) / "job.inp").write_text("\n".join(deck) + "\n")
        out = subprocess.run(["ccx", "-i", "job"], cwd=work, capture_output=True, text=True, timeout=120)
        log = out.stdout + out.stderr
        if "Job finished" not in log or "*ERROR" in log:
            raise Difference("ccx: " + log[-600:])
        lines = (Path(work) / "job.dat").read_text().split("\n")
        # "total volume"
        totals = [float(lines[i + 2].split()[-1]) for i, l in enumerate(lines) if "total volume" in l.lower()]
        if len(totals) < 2:
            raise Difference("ccx printed no volumes: " + "\n".join(lines)[:400])
        for total, part in zip(totals, [p for p in expected["parts"] if p["origin"] == "region"]):
            near(f"ccx volume of {part['name']}", total, part["measure"], 1e-5)
        forces = next(lines[i + 2].split() for i, l in enumerate(lines) if "total force" in l)
        # The pressure of -1 on the patch pulls along its vector area; supports answer.
        area = next(p["measure"] for p in expected["parts"] if p["name"] == "load-1")
        size = float(np.linalg.norm([float(f) for f in forces[:3]]))
        if not 0.9 * area < size < 1.0001 * area:
            raise Difference(f"ccx: the supports answer with {size}, the load has an area of {area}")
    return len(totals)


# ---- HDF5

def judge_med(folder, expected):
    found = second_readers.med(folder / "med.med")
    yield "python3-med", found_from(found).compare(expected, dict(ALL, unnamed=True))


def judge_xdmf(folder, expected):
    found = second_readers.xdmf(folder / "xdmf.xdmf")
    yield "h5py", found_from(found).compare(expected, ALL)
    mesh = with_meshio(folder / "xdmf.xdmf")
    yield "meshio", from_meshio(mesh)[0].compare(expected, {})
    yield "DOLFINx", by_number(with_dolfinx(folder / "xdmf.xdmf"), expected)


def judge_cgns(folder, expected):
    out = subprocess.run(["cgnscheck", str(folder / "cgns.cgns")], capture_output=True, text=True, timeout=60)
    log = out.stdout + out.stderr
    if "ERROR" in log or "error" in log.lower().replace("0 errors", ""):
        raise Difference("cgnscheck: " + log[-600:])
    yield "cgnscheck", 1
    found = second_readers.cgns(folder / "cgns.cgns")
    yield "h5py", found_from(found).compare(expected, {"region": "size", "patch": "size"}, second_readers.cgns_name)


# ---- second readers

def found_from(read):
    found = Found(read["points"], read["tets"])
    found.parts = read["parts"]
    return found


def judge_ansys(folder, expected):
    read = second_readers.ansys(folder / "ansys.cdb")
    upper = lambda n: "".join(c if c.isalnum() or c == "_" else "_" for c in n).upper()
    yield "second reader", found_from(read).compare(
        expected, {"region": "size", "patch": "nodes", "curve": "nodes", "nodes set": "nodes", "elements set": "size"}, upper)


def judge_lsdyna(folder, expected):
    read = second_readers.lsdyna(folder / "lsdyna.k")
    yield "second reader", found_from(read).compare(
        expected, {"region": "size", "patch": "size", "curve": "nodes", "nodes set": "nodes", "faces set": "size",
                   "elements set": "size"}, tolerance=1e-6)


def judge_febio(folder, expected):
    read = second_readers.febio(folder / "febio.feb")
    yield "second reader", found_from(read).compare(expected, dict(ALL, unnamed=True))


def judge_su2(folder, expected):
    if expected["nodes"] > 200:
        return  # linear only: compared in the folder linear
    read = second_readers.su2(folder / "su2.su2")
    outside = json.loads(json.dumps(expected))
    outside["parts"] = [p for p in outside["parts"] if p["name"] != "glue"]
    yield "second reader", found_from(read).compare(outside, {"patch": "size"}, underscored)


def judge_openfoam(folder, expected):
    if expected["nodes"] > 200:
        return
    read = second_readers.openfoam(folder / "case/constant/polyMesh")
    yield "second reader", found_from(read).compare(expected, {"region": "size", "patch": "size"}, underscored)
    if not has_openfoam("checkMesh"):
        return
    with tempfile.TemporaryDirectory() as work:
        shutil.copytree(folder / "case", Path(work) / "case")
        check_mesh(new_case(work), expected)
    yield "checkMesh", 1


def has_openfoam(program):
    # Debian's package leaves the environment to the user.
    if Path("/usr/share/openfoam/etc/controlDict").exists():
        os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    if shutil.which(program) is None:
        print(f"  openfoam: {program} is not installed: skipped")
    return shutil.which(program) is not None


def new_case(work):
    system = Path(work) / "case/system"
    system.mkdir(parents=True)
    head = "FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }\n"
    (system / "controlDict").write_text(head + "application x; startFrom startTime; startTime 0; stopAt endTime; endTime 1; "
                                        "deltaT 1; writeControl timeStep; writeInterval 1; writePrecision 16;\n")
    (system / "fvSchemes").write_text(head + "ddtSchemes{} gradSchemes{} divSchemes{} laplacianSchemes{} "
                                      "interpolationSchemes{} snGradSchemes{}\n")
    (system / "fvSolution").write_text(head)
    return system.parent


def check_mesh(case, expected):
    out = subprocess.run(["checkMesh", "-allTopology", "-case", str(case)], capture_output=True, text=True, timeout=120)
    log = out.stdout + out.stderr
    if "Mesh OK" not in log:
        raise Difference("checkMesh: " + log[-1500:])
    volume = float(log.split("Total volume = ")[1].split()[0].rstrip("."))
    near("checkMesh volume", volume, expected["volume"], 1e-4)


def into_openfoam(converter, file, expected, names):
    """A converter of OpenFOAM makes a polyMesh of the file: named patches on the boundary are patches there."""
    if not has_openfoam(converter):
        return
    with tempfile.TemporaryDirectory() as work:
        case = new_case(work)
        out = subprocess.run([converter, "-case", str(case), str(file)], capture_output=True, text=True, timeout=120)
        if not (case / "constant/polyMesh/boundary").exists():
            raise Difference(f"{converter}: " + (out.stdout + out.stderr)[-1500:])
        check_mesh(case, expected)
        read = found_from(second_readers.openfoam(case / "constant/polyMesh"))
        outside = [p for p in expected["parts"] if p["origin"] == "patch" and p["name"] != "glue"]
        yield converter, read.compare(dict(expected, parts=outside), {"patch": "size", "unnamed": False}, names)


CELLS = {"vtu": "vtu.vtu", "vtk": "vtk.vtk", "msh": "msh.msh", "msh22": "msh22.msh", "medit": "medit.mesh", "xdmf": "xdmf.xdmf"}


def judge_cells(folder, expected):
    """The tetrahedra alone: programs that take one kind of cell find one."""
    for name, file in CELLS.items():
        alone = folder.with_name(folder.name + "_cells") / file
        if not alone.exists() or (name == "medit" and folder.name == "second"):  # meshio knows no second order there
            continue
        mesh = with_meshio(alone)
        kinds = sorted({block.type for block in mesh.cells})
        same(f"kinds of cells in {name}", kinds, ["tetra" if folder.name == "linear" else "tetra10"])
        yield f"meshio ({name})", from_meshio(mesh)[0].compare(expected, {})


OF_HIGH_ORDER = ("mfem", "msh22", "netgen")
ORDERS = {"third": 3, "fourth": 4}
JUDGES = {name[6:]: judge for name, judge in globals().items() if name.startswith("judge_")}


def main():
    folder = Path(sys.argv[1])
    failed = 0
    for name in sys.argv[2:] or JUDGES:
        for order in ("linear", "second", *ORDERS, "linear_text", "second_text"):
            if order in ORDERS and name not in OF_HIGH_ORDER:
                continue
            file = folder / order / "expected.json"
            expected = json.loads(file.read_text()) if file.exists() else None
            if order.endswith("_text") and not any((folder / order).glob(name + ".*")):
                continue
            if not any((folder / order).glob(name + ".*")) and name not in ("openfoam", "cells"):
                print(f"skipped  {name:9} {order}: not in this build")
                continue
            try:
                for judge, checked in JUDGES[name](folder / order, expected):
                    print(f"agrees   {name:9} {order:6} by {judge}: volume, counts, {checked} parts")
            except (Difference, KeyError, ValueError, IndexError, StopIteration, OSError, subprocess.SubprocessError,
                    TypeError, AttributeError) as error:
                failed += 1
                print(f"DIFFERS  {name:9} {order}: {type(error).__name__}: {error}")
            except ImportError as error:
                print(f"skipped  {name:9} {order}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
