"""Octafront: tetrahedral finite element meshes from closed surfaces.

    import octafront
    mesh = octafront.mesh(points, triangles, size=0.5)
    mesh.save("part.vtu")

NumPy arrays go in and come out: points (n, 3) float64 in any unit of length, indices counted from 0. What cannot be done
is raised as one of octafront.errors, with what is wrong, where, and what to do. Functions let other threads of Python
work, tell how far they are by progress=, and end at Ctrl-C.
"""

import json as _json

from . import errors
from ._jobs import Job as _Job
from ._library import bytes_of as _bytes_of, call as _call
from ._mesh import Checked, Mesh
from ._options import Settings as _Settings, takes_options as _takes_options
from ._sizes import SizeField
from ._surface import OUTSIDE, Surface, surface_of as _surface_of
from .errors import (Cancelled, Error, InputError, InternalError, MeshingError, OpenCavityError, OptionError, OutputError)

__version__ = _call("version").decode()
__all__ = ["Cancelled", "Checked", "Error", "InputError", "InternalError", "Mesh", "MeshingError", "OUTSIDE",
           "OpenCavityError", "OptionError", "OutputError", "SizeField", "Surface", "check", "errors", "formats",
           "improve", "mesh", "mesh_file", "read", "repair", "size_field", "surface"]


@_takes_options("mesh")
def mesh(points, triangles=None, **keywords):
    """A tetrahedral mesh of what a closed surface encloses: a Mesh, valid in every element.

    points: (n, 3) float64, any unit of length; triangles: (m, 3) indices. Or a Surface alone, which may have patches,
    names, and several regions. The surface may be any soup of triangles: what can be mended without moving a vertex is
    mended, and said in the report; what cannot is refused: InputError, with `defects`.

    Without options for sizes they are chosen automatically; where several speak, the smallest wins. The result depends
    on nothing but the input and the options, bit for bit, not on the number of threads.

    Raises OptionError, InputError, MeshingError, Cancelled, MemoryError.

    >>> octafront.mesh(points, triangles, size=0.5, progress=lambda phase, fraction: True)
    """
    given, settings = _surface_of(points, triangles), _Settings("mesh", "mesh", keywords)
    return _meshed(given, settings)


@_takes_options("mesh")
def mesh_file(path, **keywords):
    """The same of a file: STL, OBJ, OFF or PLY, recognised by content.

    >>> octafront.mesh_file("part.stl", elements=200_000).save("part.inp")
    """
    settings = _Settings("mesh_file", "mesh", keywords)
    return _meshed(Surface.read(path), settings, path)


def _meshed(surface, settings, path=None):
    job = _Job("generate", surface._handle, settings.options, settings.threads, **settings.functions())
    report = _run(job, path)
    return Mesh._of(job.take("mesh"), report, job.take("sizes"))


def _run(job, path=None):
    """What is wrong with a file is said with its name."""
    try:
        return job.run()
    except InputError as error:
        if path is not None:
            error.args = (f"{path}: {error}",)
        raise


@_takes_options("surface")
def surface(points, triangles=None, **keywords):
    """The surface triangulated anew, to size: what the boundary of the mesh would be. A Surface with its report.

    points, triangles: as for mesh(). Raises OptionError, InputError, MeshingError, Cancelled.
    """
    given, settings = _surface_of(points, triangles), _Settings("surface", "surface", keywords)
    job = _Job("generate_surface", given._handle, settings.options, settings.threads, **settings.functions())
    report = _run(job)
    return Surface._of(job.take("surface"), report)


@_takes_options("size")
def size_field(points, triangles=None, **keywords):
    """The sizes that mesh() would work by: a SizeField, which predicts the number of elements.

    points, triangles: as for mesh(). Raises OptionError, InputError, MeshingError, Cancelled.
    """
    given, settings = _surface_of(points, triangles), _Settings("size_field", "size", keywords)
    job = _Job("generate_sizes", given._handle, settings.options, settings.threads, **settings.functions())
    report = _run(job)
    return SizeField._of(job.take("sizes"), report)


@_takes_options("improve")
def improve(mesh, *, surface=None, **keywords):
    """The same mesh with better elements: a new Mesh. report["before"] is the quality of the old one.

    mesh: a valid Mesh of any tool, or the name of its file. Regions, patches, names and sets stay. The boundary stays
    too, triangle for triangle, unless `surface` is given, the Surface on which it may slide (or the name of its file).

    No worse by least beta, smallest and largest dihedral angle. Raises OptionError, InputError (the first defect of the
    mesh, or that the boundary does not lie on the surface), MeshingError, Cancelled.

    >>> octafront.improve("of-another-tool.msh", improve="best").save("better.vtu")
    """
    settings = _Settings("improve", "improve", keywords)
    old = mesh if isinstance(mesh, Mesh) else Mesh.read(mesh)
    ground = surface if surface is None or isinstance(surface, Surface) else Surface.read(surface)
    job = _Job("improve", old._handle, ground and ground._handle, settings.options, settings.threads,
               **settings.functions())
    report = _run(job)
    return Mesh._of(job.take("mesh"), report)


def repair(points, triangles=None):
    """What mesh() makes of a surface before it begins: a Surface, no vertex moved. Its report tells what was done
    ("notes", and a count of each kind), whether it is "clean", and if not, its "defects".

    points, triangles: as for mesh(). Raises InputError for indices out of range and coordinates that are not finite.
    """
    job = _Job("repair", _surface_of(points, triangles)._handle)
    report = job.run()
    return Surface._of(job.take("surface"), report)


def check(what, triangles=None, *, solver=None):
    """What is wrong with a Surface (or points and triangles), a Mesh, or a file of either: a Checked, true if nothing
    is.

    solver: "abaqus", "ansys", "nastran" or "calculix": list the elements of a mesh that it would warn of or refuse.
    """
    if isinstance(what, (str, bytes)) or hasattr(what, "__fspath__"):
        what = read(what)
    if isinstance(what, Mesh):
        report = _Job("check", what._handle, _bytes_of(solver or "")).run()
        return Checked(text=report["defect"] or "a valid mesh", **{"solver": None, "second_order": None, **report})
    if solver:
        raise OptionError("`solver` looks at tetrahedral meshes; this is a surface")
    report = repair(what, triangles).report
    return Checked(text=report.pop("described") or "a clean surface", **{"volume": None, **report})


def read(path):
    """A Mesh, or a Surface, as the file has it: of a format that formats() lists.

    Which of the two the ending says; STL, OBJ, OFF and PLY are surfaces. Raises InputError with line or byte.
    """
    endings = {ending for f in formats() if f["reads_mesh"] for ending in f["endings"].split()}
    name = path.decode(errors="replace") if isinstance(path, bytes) else str(path)
    ending = "." + name.lower().rpartition(".")[2] if "." in name else ""
    return Mesh.read(path) if ending in endings else Surface.read(path)


def formats():
    """The file formats: a list of dicts with name, title, endings, and what can be read and written."""
    return _json.loads(_call("formats"))
