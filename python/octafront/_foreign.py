"""Objects of other libraries as input, told by what they can do, not by their class: nothing is imported for them.

    surfaces   trimesh and Open3D (vertices, faces or triangles), PyVista and VTK (PolyData, UnstructuredGrid), meshio
    meshes     meshio and UnstructuredGrid with tetrahedra
    CAD        shapes of CadQuery, FreeCAD and build123d, which write themselves as STEP
"""

import os
import sys

from . import errors
from ._numpy import np

_TETRA, _TETRA10 = 10, 24  # VTK's numbers of cells
# Corners of what meshio calls faces, as triangles.
_FACES = {"triangle": [(0, 1, 2)], "triangle6": [(0, 1, 2)], "triangle7": [(0, 1, 2)],
          "quad": [(0, 1, 2), (0, 2, 3)], "quad8": [(0, 1, 2), (0, 2, 3)], "quad9": [(0, 1, 2), (0, 2, 3)]}


def surface_from(source):
    """The arguments of Surface, as a dict; None if it is nothing that is known here."""
    if _is_meshio(source):
        return _surface_of_meshio(source)
    if _is_vtk(source):
        return _surface_of_vtk(source)
    for name in ("faces", "triangles"):
        if hasattr(source, "vertices") and hasattr(source, name):
            return {"points": np.asarray(source.vertices), "triangles": np.asarray(getattr(source, name))}
    return None


def mesh_from(source):
    """The arguments of Mesh, as a dict, and perhaps "sets" of elements by name; None if it holds no tetrahedra."""
    if _is_meshio(source):
        return _mesh_of_meshio(source)
    if _is_vtk(source) and hasattr(source, "GetCellTypesArray"):
        return _mesh_of_vtk(source)
    return None


def is_cad(source):
    return any(hasattr(source, name) for name in ("exportStep", "export_step", "vals", "toCompound")) or _build123d(source)


def write_cad(source, folder):
    """Files that hold the shape, or shapes: the solids of a workplane are one each."""
    shapes = source.vals() if hasattr(source, "vals") else [source]
    shapes = [shape for shape in shapes if is_cad(shape)]
    if not shapes:
        raise errors.InputError(f"{source!r} holds no shapes")
    names = [os.path.join(folder, f"shape_{i + 1}.step" if i else "shape.step") for i in range(len(shapes))]
    for shape, name in zip(shapes, names):
        _write_step(shape, name)
    return names


def _write_step(shape, name):
    for method in ("exportStep", "export_step", "save", "export"):  # the last two: assemblies of CadQuery
        if hasattr(shape, method):
            getattr(shape, method)(name)
            return
    _build123d(shape).export_step(shape, name)


def _build123d(source):
    """Its module, where functions write shapes."""
    return sys.modules.get("build123d") if type(source).__module__.split(".")[0] == "build123d" else None


# ---- meshio ----

def _is_meshio(source):
    return hasattr(source, "points") and hasattr(source, "cells") and hasattr(source, "cell_sets")


def _surface_of_meshio(source):
    chosen = [i for i, block in enumerate(source.cells) if block.type in _FACES]
    if not chosen:
        return None
    names, numbers, _ = _groups_of(source, chosen, 2)
    triangles, patches = [], []
    for at, number in zip(chosen, numbers):
        for corners in _FACES[source.cells[at].type]:
            triangles.append(np.asarray(source.cells[at].data)[:, list(corners)])
            patches.append(number)
    return {"points": np.asarray(source.points), "triangles": np.concatenate(triangles),
            "patches": np.concatenate(patches), "patch_names": names}


def _mesh_of_meshio(source):
    kinds = [block.type for block in source.cells]
    kind = "tetra10" if "tetra10" in kinds and "tetra" not in kinds else "tetra"
    chosen = [i for i, found in enumerate(kinds) if found == kind]
    if not chosen:
        return None
    names, numbers, sets = _groups_of(source, chosen, 3)
    said = {"points": np.asarray(source.points), "tets": np.concatenate([np.asarray(source.cells[i].data) for i in chosen]),
            "regions": np.concatenate(numbers), "region_names": names, "sets": sets}
    if (faces := _surface_of_meshio(source)) is not None:
        said.update(faces=faces["triangles"], patches=faces["patches"], patch_names=faces["patch_names"])
    return said


def _groups_of(source, chosen, dimension):
    """Names, the number of each cell of the chosen blocks, and further sets, {name: cells of all these blocks}: groups that
    overlap no earlier one have numbers, as in files. Cells of no group have the number behind the last."""
    names, sets = [], {}
    numbers = [np.full(len(source.cells[i].data), 0xFFFFFFFF, np.uint32) for i in chosen]
    for name, members in _members_of(source, chosen, dimension):
        if any((of_block[at] != 0xFFFFFFFF).any() for of_block, at in zip(numbers, members)):
            first = np.cumsum([0, *(len(of_block) for of_block in numbers)])
            sets[name] = np.concatenate([at + begin for at, begin in zip(members, first)])
        elif any(len(at) for at in members):
            for of_block, at in zip(numbers, members):
                of_block[at] = len(names)
            names.append(name)
    for of_block in numbers:
        of_block[of_block == 0xFFFFFFFF] = len(names)
    return names, numbers, sets


def _members_of(source, chosen, dimension):
    """(name, cells in each chosen block), of sets, or where there are none of the tags that field_data names."""
    sets = {name: members for name, members in (source.cell_sets or {}).items() if not name.startswith("gmsh:")}
    for name, members in sets.items():
        yield name, [np.asarray([] if members[i] is None else members[i], np.int64) for i in chosen]
    tags = (source.cell_data or {}).get("gmsh:physical")
    if sets or tags is None:
        return
    for name, (tag, of) in (source.field_data or {}).items():
        if of == dimension:
            yield name, [np.flatnonzero(np.asarray(tags[i]) == tag) for i in chosen]


# ---- VTK, and PyVista, whose objects are VTK's ----

def _is_vtk(source):
    return hasattr(source, "GetPoints") and hasattr(source, "GetCellData")


def _vtk(module):
    import importlib
    return importlib.import_module("vtkmodules." + module)


def _output_of(a_filter, source):
    a_filter.SetInputData(source)
    a_filter.Update()
    return a_filter.GetOutput()


def _surface_of_vtk(source):
    if not hasattr(source, "GetPolys"):
        source = _output_of(_vtk("vtkFiltersGeometry").vtkGeometryFilter(), source)
    to_triangles = _vtk("vtkFiltersCore").vtkTriangleFilter()
    to_triangles.PassVertsOff()
    to_triangles.PassLinesOff()
    triangles = _output_of(to_triangles, source)
    to_numpy = _vtk("util.numpy_support").vtk_to_numpy
    if triangles.GetPoints() is None or triangles.GetNumberOfPolys() == 0:
        raise errors.InputError("the object holds no triangles")
    said = {"points": to_numpy(triangles.GetPoints().GetData()),
            "triangles": to_numpy(triangles.GetPolys().GetConnectivityArray()).reshape(-1, 3)}
    patch = triangles.GetCellData().GetArray("patch")
    if patch is not None and to_numpy(patch).dtype.kind in "iu" and (to_numpy(patch) >= 0).all():
        said["patches"] = to_numpy(patch)
    return said


def _mesh_of_vtk(source):
    to_numpy = _vtk("util.numpy_support").vtk_to_numpy
    if source.GetNumberOfCells() == 0:
        return None
    kinds = to_numpy(source.GetCellTypesArray())
    kind = _TETRA10 if (kinds == _TETRA10).any() and not (kinds == _TETRA).any() else _TETRA
    chosen = np.flatnonzero(kinds == kind)
    if not len(chosen):
        return None
    first = to_numpy(source.GetCells().GetOffsetsArray())[chosen]
    nodes = to_numpy(source.GetCells().GetConnectivityArray())
    said = {"points": to_numpy(source.GetPoints().GetData()),
            "tets": nodes[first[:, None] + np.arange(4 if kind == _TETRA else 10)]}
    region = source.GetCellData().GetArray("region")
    if region is not None and to_numpy(region).dtype.kind in "iu":
        said["regions"] = to_numpy(region)[chosen]
    return said
