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
    """The arguments of Mesh, as a dict; None if it holds no tetrahedra."""
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
    if not any(block.type in _FACES for block in source.cells):
        return None
    triangles, patches, names = [], [], _names_of(source, 2)
    for at, block in enumerate(source.cells):
        corners = _FACES.get(block.type, ())
        for chosen in corners:
            triangles.append(np.asarray(block.data)[:, list(chosen)])
            patches.append(_numbers_of(source, at, names, 2))
    return {"points": np.asarray(source.points), "triangles": np.concatenate(triangles),
            "patches": np.concatenate(patches), "patch_names": names}


def _mesh_of_meshio(source):
    kinds = [block.type for block in source.cells]
    kind = "tetra10" if "tetra10" in kinds and "tetra" not in kinds else "tetra"
    if kind not in kinds:
        return None
    at = [i for i, found in enumerate(kinds) if found == kind]
    names = _names_of(source, 3)
    said = {"points": np.asarray(source.points), "tets": np.concatenate([np.asarray(source.cells[i].data) for i in at]),
            "regions": np.concatenate([_numbers_of(source, i, names, 3) for i in at]), "region_names": names}
    if (faces := _surface_of_meshio(source)) is not None:
        said.update(faces=faces["triangles"], patches=faces["patches"], patch_names=faces["patch_names"])
    return said


def _dimension(block):
    return 3 if block.type.startswith("tetra") else 2 if block.type in _FACES else None


def _names_of(source, dimension):
    """Of the groups of cells of that dimension: sets, else what field_data calls tags; a last one, "", of the rest."""
    blocks = [i for i, block in enumerate(source.cells) if _dimension(block) == dimension]
    names = [name for name, members in (source.cell_sets or {}).items()
             if not name.startswith("gmsh:") and any(members[i] is not None and len(members[i]) for i in blocks)]
    if not names:
        tags = {int(tag): name for name, (tag, of) in (source.field_data or {}).items() if of == dimension}
        names = [tags[tag] for tag in sorted(tags)]
    return names


def _numbers_of(source, at, names, dimension):
    """Of each cell of a block its place in the names; behind them all where it has none."""
    numbers = np.full(len(source.cells[at].data), len(names), np.uint32)
    sets = source.cell_sets or {}
    for number, name in enumerate(names):
        if name in sets and sets[name][at] is not None:
            numbers[np.asarray(sets[name][at], np.int64)] = number
    if not any(name in sets for name in names) and "gmsh:physical" in (source.cell_data or {}):
        tags = np.asarray(source.cell_data["gmsh:physical"][at])
        for number, name in enumerate(names):
            numbers[tags == int(source.field_data[name][0])] = number
    return numbers if len(names) else np.zeros_like(numbers)


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
