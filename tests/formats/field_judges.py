#!/usr/bin/python3
"""What others read of fields in the files of write_samples: FOLDER/NAME_fields for linear, second, mixed_linear and
mixed_second. Values are functions of the place (fields_on() of write_samples.cpp): of a node, and of the middle of an
element's corners.

    field_judges.py FOLDER [FORMAT ...]

Judges: meshio (med, exodus, xdmf, vtu), VTK (exodus, cgns, vtu, vtk, pvtu, vtkhdf), libmed (med), Gmsh (msh, msh22,
simnibs), cgnscheck, ncdump. What is not installed is skipped, and said. Exit status 1 if there is a difference.
"""
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
sys.path.append("/usr/lib/python3/dist-packages")
from judges import Difference, same, with_meshio


def wanted(name, at):
    x, y, z = np.asarray(at, dtype=float).T
    return {"T": 1 + 2 * x - 3 * y + z / 2, "flow": np.array([x + 1, 2 * y - 1, 3 * z]).T,
            "heat flux": np.array([y + 4, 2 - z, x / 2]).T}[name]


def check(what, found, name, at, tolerance=1e-12):
    found, right = np.asarray(found, dtype=float), wanted(name, at)
    if found.shape != right.shape:
        raise Difference(f"{what} {name}: {found.shape} values, not {right.shape}")
    worst = np.abs(found - right).max()
    if not worst <= tolerance * 10:
        raise Difference(f"{what} {name}: off by {worst}")
    return len(right)


CORNERS = {"tetra": 4, "tetra10": 4, "pyramid": 5, "pyramid13": 5, "wedge": 6, "wedge15": 6}
VTK_CORNERS = {10: 4, 24: 4, 14: 5, 27: 5, 13: 6, 26: 6}


def solids(read):
    """Blocks of solids in what meshio read, and the middles of their corners."""
    for b, block in enumerate(read.cells):
        if block.type in CORNERS:
            yield b, read.points[np.asarray(block.data)[:, :CORNERS[block.type]]].mean(axis=1)


def columns(data, name, at=None):
    """A vector that is one, or three columns."""
    get = lambda n: data[n] if at is None else data[n][at]
    if name not in data:
        return np.stack([get(f"{name}_{axis}") for axis in "xyz"], axis=-1)
    return np.squeeze(get(name), axis=-1) if get(name).shape[-1] == 1 else get(name)


def by_meshio(file, at_points):
    if "mixed_second" in file.parent.name:
        return 0
    read = with_meshio(file)
    count = sum(check("node", columns(read.point_data, n), n, read.points) for n in ("T", "flow") if at_points)
    for b, middles in solids(read):
        count += sum(check("element", columns(read.cell_data, n, b), n, middles) for n in ("T", "heat flux"))
    return count


def grids_of(data):
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    found, at = [], data.NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        found.append(at.GetCurrentDataObject())
        at.GoToNextItem()
    return found


def by_vtk(reader, file, at_points, names=lambda n: n, tolerance=1e-12):
    from vtk.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(file))
    reader.UpdateInformation()
    for on in ("ReadAllScalarsOn", "ReadAllVectorsOn", "ReadAllFieldsOn", "EnableAllPointArrays", "EnableAllCellArrays"):
        getattr(reader, on, lambda: None)()
    if reader.IsA("vtkExodusIIReader"):
        for code in (reader.NODAL, reader.ELEM_BLOCK):
            reader.SetAllArrayStatus(code, 1)
    reader.Update()
    count = 0
    for grid in grids_of(reader.GetOutputDataObject(0)):
        kinds = np.array([grid.GetCellType(c) for c in range(grid.GetNumberOfCells())])
        if not any(k in VTK_CORNERS for k in kinds):
            continue
        at = vtk_to_numpy(grid.GetPoints().GetData())
        own = [c for c, k in enumerate(kinds) if k in VTK_CORNERS]
        corners = [[grid.GetCell(c).GetPointId(i) for i in range(VTK_CORNERS[kinds[c]])] for c in own]
        middles = np.array([at[nodes].mean(axis=0) for nodes in corners])
        for what, data, chosen, places, fields in (
                ("node", grid.GetPointData(), slice(None), at, ("T", "flow") if at_points else ()),
                ("element", grid.GetCellData(), own, middles, ("T", "heat flux"))):
            for name in fields:
                array = data.GetArray(names(name))
                if array is None:
                    raise Difference(f"no {what} field {names(name)}; there are "
                                     f"{[data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]}")
                count += check(what, vtk_to_numpy(array)[chosen], name, places, tolerance)
    if count == 0:
        raise Difference("no values")
    return count


def by_gmsh(file, at_points):
    """Views by name and kind: values by the tags of nodes or elements."""
    import gmsh
    gmsh.initialize(["", "-v", "1"])
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(file))
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        place = dict(zip(map(int, tags), xyz.reshape(-1, 3)))
        corners = {}
        for kind, ids, nodes in zip(*gmsh.model.mesh.getElements(3)):
            first = {4: 4, 11: 4, 7: 5, 19: 5, 6: 6, 18: 6}[kind]
            for tag, row in zip(ids, nodes.reshape(len(ids), -1)):
                corners[int(tag)] = row[:first]
        count, seen = 0, set()
        for view in gmsh.view.getTags():
            name = gmsh.option.getString(f"View[{gmsh.view.getIndex(view)}].Name")
            kind, ids, values, _, components = gmsh.view.getModelData(view, 0)
            values = np.array([v[:components] for v in values])
            values = values[:, 0] if components == 1 else values
            of_nodes = kind == "NodeData"
            at = [place[int(t)] if of_nodes else np.mean([place[int(n)] for n in corners[int(t)]], axis=0) for t in ids]
            count += check("node" if of_nodes else "element", values, name, at)
            same(f"{kind} of {name}", len(ids), len(place) if of_nodes else len(corners))
            seen.add((name, of_nodes))
        want = {("T", False), ("heat flux", False)} | ({("T", True), ("flow", True)} if at_points else set())
        same("views", sorted(seen), sorted(want))
        return count
    finally:
        gmsh.finalize()


def by_libmed(file, at_points):
    from med import medenum as e
    from med.medfield import MEDfieldnValue, MEDfieldValueRd
    from med.medfile import MEDfileClose, MEDfileOpen
    from med.medmesh import MEDFLOAT
    import mixed_readers
    mesh = mixed_readers.med(file)
    points = np.asarray(mesh.points)
    f, count = MEDfileOpen(str(file), e.MED_ACC_RDONLY), 0

    def values_of(name, each, *place):
        n = MEDfieldnValue(f, name, e.MED_NO_DT, e.MED_NO_IT, *place)
        n = n[0] if isinstance(n, (list, tuple)) else n
        values = MEDFLOAT(n * each)
        MEDfieldValueRd(f, name, e.MED_NO_DT, e.MED_NO_IT, *place, e.MED_FULL_INTERLACE, e.MED_ALL_CONSTITUENT, values)
        return np.array(values) if each == 1 else np.array(values).reshape(-1, each)

    for name, each in (("T", 1), ("flow", 3)) if at_points else ():
        count += check("node", values_of(name, each, e.MED_NODE, e.MED_NONE), name, points)
    second = max(map(len, mesh.cells)) > 6
    for kind, nodes, corners in ((e.MED_TETRA10, 10, 4), (e.MED_PYRA13, 13, 5), (e.MED_PENTA15, 15, 6)) if second else (
            (e.MED_TETRA4, 4, 4), (e.MED_PYRA5, 5, 5), (e.MED_PENTA6, 6, 6)):
        middles = [points[row[:corners]].mean(axis=0) for row in mesh.cells if len(row) == nodes]
        for name, each in (("T", 1), ("heat flux", 3)) if middles else ():
            count += check("element", values_of(name, each, e.MED_CELL, kind), name, middles)
    MEDfileClose(f)
    return count


def judge_med(folder, at_points):
    yield "libmed", by_libmed(folder / "med.med", at_points)
    # It wants values of all elements, also of faces and edges.
    yield "meshio", by_meshio(folder.with_name(folder.name + "_cells") / "med.med", at_points)


def judge_exodus(folder, at_points):
    import vtk
    yield "vtk", by_vtk(vtk.vtkExodusIIReader(), folder / "exodus.exo", at_points, lambda n: n + "_" if n != "T" else n, 1e-6)
    yield "meshio", by_meshio(folder / "exodus.exo", at_points)
    out = subprocess.run(["ncdump", "-v", "time_whole", str(folder / "exodus.exo")], capture_output=True, text=True, check=True).stdout
    if "time_whole = 0 ;" not in out:
        raise Difference("ncdump shows no time step")
    yield "ncdump", 1


def judge_cgns(folder, at_points):
    out = subprocess.run(["cgnscheck", str(folder / "cgns.cgns")], capture_output=True, text=True, timeout=60)
    if "ERROR" in out.stdout + out.stderr:
        raise Difference("cgnscheck: " + (out.stdout + out.stderr)[-900:])
    yield "cgnscheck", 1
    if "mixed_second" in folder.name:
        return  # VTK knows no PYRA_13
    import vtk
    yield "vtk", by_vtk(vtk.vtkCGNSReader(), folder / "cgns.cgns", at_points)


def judge_vtu(folder, at_points):
    import vtk
    yield "vtk", by_vtk(vtk.vtkXMLUnstructuredGridReader(), folder / "vtu.vtu", at_points)
    yield "meshio", by_meshio(folder / "vtu.vtu", at_points)


def judge_pvtu(folder, at_points):
    import vtk
    yield "vtk", by_vtk(vtk.vtkXMLPUnstructuredGridReader(), folder / "pvtu.pvtu", at_points)


def judge_vtk(folder, at_points):
    import vtk
    # Legacy files write blanks in names as %20, which VTK takes back.
    yield "vtk", by_vtk(vtk.vtkUnstructuredGridReader(), folder / "vtk.vtk", at_points)


def judge_vtkhdf(folder, at_points):
    import vtk
    yield "vtk", by_vtk(vtk.vtkHDFReader(), folder / "vtkhdf.vtkhdf", at_points)


def judge_xdmf(folder, at_points):
    yield "meshio", by_meshio(folder / "xdmf.xdmf", at_points)


def judge_msh(folder, at_points):
    yield "gmsh", by_gmsh(folder / "msh.msh", at_points)


def judge_msh22(folder, at_points):
    yield "gmsh", by_gmsh(folder / "msh22.msh", at_points)


def judge_simnibs(folder, at_points):
    yield "gmsh", by_gmsh(folder / "simnibs.msh", at_points)


JUDGES = {name[6:]: judge for name, judge in globals().items() if name.startswith("judge_")}


def main():
    failed = 0
    for name in sys.argv[2:] or JUDGES:
        for order in ("linear", "second", "mixed_linear", "mixed_second"):
            folder = Path(sys.argv[1]) / (order + "_fields")
            if not any(folder.glob(name + ".*")):
                print(f"skipped  {name:9} {order}: not in this build, or in parts")
                continue
            try:
                # Wedges of second order are written without the fields at nodes.
                for judge, checked in JUDGES[name](folder, order != "mixed_second"):
                    print(f"skipped  {name:9} {order:12} by {judge}: it knows no pyramids of second order" if checked == 0 else
                          f"agrees   {name:9} {order:12} by {judge}: {checked} values")
            except (Difference, KeyError, ValueError, IndexError, OSError, subprocess.SubprocessError, TypeError,
                    AttributeError) as error:
                failed += 1
                print(f"DIFFERS  {name:9} {order}: {type(error).__name__}: {error}")
            except ImportError as error:
                print(f"skipped  {name:9} {order}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
