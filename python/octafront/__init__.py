"""Octafront: tetrahedral finite element meshes from closed surfaces.

    import octafront
    mesh = octafront.mesh(points, triangles, size=0.5)
    mesh.save("part.vtu")

NumPy arrays go in and come out: points (n, 3) float64 in any unit of length, indices counted from 0. What cannot be done
is raised as one of octafront.errors, with what is wrong, where, and what to do. Functions let other threads of Python
work, tell how far they are by progress=, and end at Ctrl-C.
"""

import inspect as _inspect
import json as _json
import os as _os

from . import _complexes, _fields, _level_sets, errors, metrics
from ._images import is_file as _is_file, surface_of_image as _surface_of_image
from ._intake import opened as _opened
from ._jobs import Job as _Job
from ._fields import CarriedFields
from ._library import bytes_of as _bytes_of, call as _call
from ._mesh import Checked, Mesh, mesh_of as _mesh_of
from ._options import Settings as _Settings, takes_options as _takes_options
from ._pictures import picture
from ._ranks import ranks_of as _ranks_of
from ._sizes import SizeField
from ._surface import OUTSIDE, Surface, surface_of as _surface_of
from .errors import (Cancelled, Error, InputError, InternalError, MeshingError, OpenCavityError, OptionError, OutputError)

__version__ = _call("version").decode()
__all__ = ["Cancelled", "CarriedFields", "Checked", "Error", "InputError", "InternalError", "Mesh", "MeshingError", "OUTSIDE",
           "OpenCavityError", "OptionError", "OutputError", "SizeField", "Surface", "adapt", "carry", "check", "complex_of_walls",
           "errors", "formats", "image_surface", "improve", "join_bodies", "mend", "mesh", "mesh_file", "mesh_image", "metrics", "move", "picture", "read",
           "repair", "size_field", "surface"]


@_takes_options("mesh")
def mesh(points, triangles=None, **keywords):
    """A tetrahedral mesh of what a surface encloses: a Mesh, valid in every element.

    points: (n, 3) float64, any unit of length; triangles: (m, 3) indices. Or alone: a Surface, which may have patches,
    names, and several regions; a file (STL, OBJ, OFF, PLY, CAD, images of voxels, ..., recognised by content); a list of files,
    or {name: Surface or file}, a region each; or an object of another library: of trimesh, Open3D, PyVista, VTK or meshio
    (names of its groups are those of patches), or a shape of CadQuery, FreeCAD or build123d, which goes the way of CAD files.
    Or a body by a formula, "abs(gyroid) < 0.3", or by a function (n, 3) -> (n,) of places in a `box`: where it is below 0.

    All of it goes the way of the command line, to the same mesh, bit for bit: walls and parts inside become regions, a
    soup is mended (repair="none": it is refused, InputError with `defects`). report["intake"] says what was found and
    done: "format", "notes", "regions" with names and volumes, "repair" with places. A Surface that came out of mend(),
    join_bodies(), complex_of_walls() or image_surface() is meshed as it is.

    Without options for sizes they are chosen automatically; where several speak, the smallest wins. The result depends
    on nothing but the input and the options, bit for bit, not on the number of threads.

    Raises OptionError, InputError, MeshingError, Cancelled, MemoryError.

    >>> octafront.mesh(points, triangles, size=0.5, progress=lambda phase, fraction: True)
    >>> octafront.mesh("scan.stl", elements=200_000).save("scan.inp")
    >>> octafront.mesh("part.step", size=2, size_of={"color #ff8000": 0.5}).save("part.inp")
    """
    return _meshed("mesh", points, triangles, keywords)


@_takes_options("mesh")
def mesh_file(path, **keywords):
    """mesh() of a file.

    >>> octafront.mesh_file("part.stl", elements=200_000).save("part.inp")
    """
    return _meshed("mesh_file", path, None, keywords)


def image_surface(image, affine=None, *, spacing=None, series=0, kind="auto", labels=None, ignore=None, merge=None,
                  iso=None, bands=None, islands=None, holes=None, specks=None, contacts=None, close_voxels=None, surface_of=None, crop=None,
                  resample=None, closed_at_box=True, size=None, progress=None, threads=0):
    """The surfaces between the labels of an image, or between bands of its grey values: a Surface with a region for
    each, named. Smooth, volumes of labels kept. report["regions"] has their names and volumes, report["notes"] what was
    decided and changed.

    image: an array (ni, nj, nk) of numbers, which is copied; or a file (NIfTI, NRRD, MetaImage, raw voxels with JSON), a
        folder of DICOM, or a list of its files.
    affine: of an array, (4, 4) from (i, j, k, 1) to the world, as nibabel's image.affine; or spacing: of voxels, one
        number or three. Without either voxels are cubes of 1. Voxel (0, 0, 0) has its middle at the origin of the map.
    series: of a file with several images the one that is meant, counted from 1.
    kind: "labels" or "grey"; "auto" goes by what else is given, or by the values.
    labels: {3: "liver"}, or a file of names. ignore: values outside of all regions [0]; () for none.
    merge: {"cortex": (3, 4)}: these values are one region.
    iso: of a grey image; what has this value or more is the region "body".
    bands: {"skin": (-200, 226), "bone": (226, None)}: values from the first up to below the second; None: no limit.
    islands, holes: pieces of regions, and of the outside, below this volume go to what surrounds them.
    specks: the same, while they are at most 1 % of a region. Without a value what is smaller than an element of
        `size`.
    contacts: where labels touch in spots below this area, or in strips of a voxel or two, a label beside them comes
        between; "keep": nowhere. Without a value below the square of `size`.
    close_voxels: gaps toward the outside close that are up to twice as many voxels wide.
    surface_of: {"grey matter": "pial.stl"}: a file, or several, with closed surfaces of a label, by its name or number, in
        the coordinates of the image: within two voxels of them voxels follow them, and vertices lie on them.
    crop: ((i0, i1), (j0, j1), (k0, k1)), counted from 0, the last ones too; None for an end that stays.
    resample: spacing of the voxels to work with, one number or three.
    closed_at_box: regions that reach the edge of the image end flat there; False: they are refused.
    size: the edge length that elements will have; without it no specks and contacts are removed but those asked for.

    Raises OptionError, InputError, Cancelled.

    >>> octafront.image_surface(labels, spacing=(1, 1, 2)).save("organs.ply")
    """
    regions = {"kind": kind, "labels": labels, "ignore": ignore, "merge": merge, "iso": iso, "bands": bands,
               "islands": islands, "holes": holes, "specks": specks, "contacts": None if contacts is None else str(contacts), "close_voxels": close_voxels, "surface_of": surface_of, "crop": crop, "resample": resample,
               "closed_at_box": closed_at_box, "size": size}
    return _surface_of_image(image, affine, spacing, series, regions, threads, progress)


@_takes_options("mesh", _inspect.signature(image_surface))
def mesh_image(image, affine=None, **keywords):
    """A tetrahedral mesh of an image, one region per label or band: a Mesh. First image_surface(), then mesh(), with the
    keywords of both: a size coarser than voxels rules, thin layers get flat elements. report["image"] is the report of the first step.

    >>> octafront.mesh_image("head.nii.gz", labels={1: "skin", 2: "skull"}, size=4).save("head.msh")
    >>> octafront.mesh_image(nibabel_image.get_fdata(), nibabel_image.affine, elements=500_000)
    """
    spacing, size, ranks = keywords.pop("spacing", None), keywords.get("size"), _ranks_of(keywords.get("comm"))

    def way_in():
        settings = _Settings("mesh_image", "mesh", keywords, image)
        series = settings.intake.pop("series", 0)
        if isinstance(size, (int, float)):
            settings.intake["size"] = size
        made = _surface_of_image(image, affine, spacing, series, {**settings.repeat, **settings.intake}, settings.threads,
                                 settings.progress)
        settings.intake = {}
        return _opened(made, None, settings), settings, made.report

    domain, settings, report = ranks.together(way_in)
    mesh = _filled(domain, made_of=image, settings=settings, ranks=ranks)
    mesh.report["image"] = report
    return mesh


def _meshed(function, points, triangles, keywords):
    ranks = _ranks_of(keywords.get("comm"))

    def way_in():
        settings = _Settings(function, "mesh", keywords, points)
        return _opened(points, triangles, settings), settings

    domain, settings = ranks.together(way_in)
    return _filled(domain, points, settings, ranks)


def _filled(domain, made_of, settings, ranks):
    job, report = _generated("generate", domain, made_of, settings, **ranks.join(settings))
    return Mesh._of(job.take("mesh"), report, job.take("sizes"))


def _generated(how, domain, made_of, settings, **ranks):
    """A job that has ended, and its report with that of the way in. What is wrong with a file is said with its name."""
    job = _Job(how, domain._handle, settings.options, settings.threads, **settings.functions(), **ranks)
    try:
        report = job.run()
    except InputError as error:
        if _is_file(made_of):
            error.args = (f"{_os.fsdecode(made_of)}: {error}",)
        raise
    report["intake"] = domain.report
    return job, report


@_takes_options("surface")
def surface(points, triangles=None, **keywords):
    """The surface triangulated anew, to size: what the boundary of the mesh would be. A Surface with its report.

    points, triangles: as for mesh(). Raises OptionError, InputError, MeshingError, Cancelled.
    """
    settings = _Settings("surface", "surface", keywords, points)
    job, report = _generated("generate_surface", _opened(points, triangles, settings), points, settings)
    return Surface._of(job.take("surface"), report, opened=True)


@_takes_options("size")
def size_field(points, triangles=None, **keywords):
    """The sizes that mesh() would work by: a SizeField, which predicts the number of elements.

    points, triangles: as for mesh(). Raises OptionError, InputError, MeshingError, Cancelled.
    """
    settings = _Settings("size_field", "size", keywords, points)
    job, report = _generated("generate_sizes", _opened(points, triangles, settings), points, settings)
    return SizeField._of(job.take("sizes"), report)


@_takes_options("improve")
def improve(mesh, *, surface=None, fields=None, **keywords):
    """The same mesh with better elements: a new Mesh. report["before"] is the quality of the old one.

    mesh: a valid Mesh of any tool, the name of its file, or an object of meshio, PyVista or VTK. Regions, patches, names and sets stay. The boundary stays
    too, triangle for triangle, unless `surface` is given, the Surface on which it may slide (or the name of its file).
    fields: {name: array}, go along as those of adapt().

    No worse by least beta, smallest and largest dihedral angle. Raises OptionError, InputError (the first defect of the
    mesh, or that the boundary does not lie on the surface), MeshingError, Cancelled.

    >>> octafront.improve("of-another-tool.msh", improve="best").save("better.vtu")
    """
    settings = _Settings("improve", "improve", keywords)
    old = Mesh.read(mesh) if _is_file(mesh) else Mesh.of(mesh)
    values = _fields.fields_on(old, fields)
    ground = Surface.read(surface) if _is_file(surface) else surface and _surface_of(surface, None)
    job = _Job("improve", old._handle, ground and ground._handle, settings.options, settings.threads,
               **settings.functions())
    report = job.run()
    new = Mesh._of(job.take("mesh"), report)
    _fields.take_along(old, new, values, settings)
    return new


_SIZES_OF_ADAPT = {"size", "size_field", "size_of", "size_near", "elements", "curvature", "gap", "through", "regions", "point_sizes",
                   "automatic_factor", "interior", "chord_error", "feature_elements", "facets"}


@_takes_options("adapt")
def adapt(mesh, *, sizes=None, metric=None, fields=None, surface=None, level_sets=None, **keywords):
    """The mesh changed until its edges are as long as the sizes want: a new Mesh. report["fit"] says how well it fits.

    mesh: a valid Mesh of any tool, the name of its file, or an object of meshio, PyVista or VTK. Its boundary stays on the smooth surface that it stands
    for; patches, regions, sheets, curves and sets stay. A Surface, or the file of one, is adapted alone: a new Surface.
    sizes: edge lengths wanted at its own points, (n,); else what the keywords ask for, as for mesh().
    metric: at its own points, (n, 3, 3), or (n, 6) as xx, xy, xz, yy, yz, zz: other lengths in other directions, see
        octafront.metrics. Sizes have no say beside it.
    only: what may change, a place or several: "box:X0,Y0,Z0,X1,Y1,Z1", "sphere:X,Y,Z,R", or a region, patch, curve or set
    by its name; all but it and a `halo` of layers around keeps its bits and numbers.
    keep: what stays as it is, a name or several: of patches, curves and sets, of a region for the walls around it, or numbers
        of patches. `fix_boundary`: the triangles of the outer boundary stay.

    surface: what walls stand for instead, where it is near them: a Surface, the name of its file, of a CAD file, whose true
        geometry they go to, or (points, triangles). It need not be closed.
    fields: {name: array}, values at the points, (n,) or (n, k), or of the tetrahedra, (m,) or (m, k): mesh.fields of the
    new mesh has them there, its report what they came to before and after, as carry() has it. At points linear in the old
    elements, bit for bit where a point stays; of elements such that the sum of value times volume in each region stays.

    level_sets: {name: values at the points, or (values, level)}: the surface where they have the level [0] becomes faces, a
    region of the name below it, a patch NAME_surface; the first that holds a place names its region. Sizes stay unless
    others are asked for. report["level_sets"] says what was cut; old_points and old_tets are then of the mesh that was cut.

    The mesh made tells by old_points and old_tets what its points and tetrahedra were in the old one.

    Raises OptionError, InputError (the first defect of the mesh; wedges, pyramids, periodic faces), MeshingError,
    Cancelled.

    >>> octafront.adapt(mesh, sizes=0.5 * wanted).save("next.vtu")
    >>> octafront.adapt(mesh, metric=octafront.metrics.of_field(mesh, u, elements=100_000))
    """
    old = read(mesh) if _is_file(mesh) else mesh if isinstance(mesh, Surface) else Mesh.of(mesh)
    is_surface = isinstance(old, Surface)
    if level_sets:
        if is_surface or sizes is not None and "size_field" in keywords:
            raise OptionError("`level_sets` are for meshes of tetrahedra, beside one field of sizes")
        if sizes is None and metric is None and not set(keywords) & _SIZES_OF_ADAPT:
            sizes = _level_sets.lengths_at_points(old)
    if sizes is not None:
        if "size_field" in keywords:
            raise OptionError("`sizes` and `size_field` are two fields of sizes; give one")
        keywords["size_field"] = (old.points, old.triangles if is_surface else old.tets, sizes)
    if is_surface and fields:
        raise OptionError("`fields` go along with meshes of tetrahedra; this is a surface alone")
    for names in ("only", "keep"):
        if not isinstance(keywords.get(names, ""), str):
            keywords[names] = ";".join(keywords[names])
    settings = _Settings("adapt", "adapt", keywords)
    values = {} if is_surface else _fields.fields_on(old, fields)
    report_of_cut = {}
    if level_sets:
        whole, old = old, _level_sets.cut(old, level_sets, settings, Mesh._of)
        values, report_of_cut = _level_sets.carried_to(whole, old, values, settings), old.report
        if metric is not None:
            metric = _level_sets.carried_to(whole, old, {"metric": _fields.field_on(whole, "metric", metric)}, settings)["metric"]
    if isinstance(surface, tuple):
        surface = _surface_of(*surface)
    ground = Surface.read(surface) if _is_file(surface) else None if surface is None else _surface_of(surface, None)
    ground = ground and ground._handle
    if is_surface:
        job = metrics._adapting("adapt_surface", old, ground, metric, sizes, settings)
        report = job.run()
        return Surface._of(job.take("surface"), report)
    if metric is None:
        job = _Job("adapt", old._handle, ground, settings.options, settings.threads, **settings.functions())
    else:
        job = metrics._adapting("adapt_to_metric", old, ground, metric, sizes, settings)
    report = job.run()
    new = Mesh._of(job.take("mesh"), report)
    _fields.take_along(old, new, values, settings)
    new.report.update(report_of_cut)
    return new


@_takes_options("carry")
def carry(old, new, fields, **keywords):
    """Fields of one mesh on another, of the same body or of one that differs: {name: array}, a CarriedFields, whose
    `report` has of each field the integral, least and greatest value before and after ("carried"), and how the meshes lie
    to each other ("carry").

    old, new: valid Meshes, names of files, or objects of meshio, PyVista or VTK.
    fields: {name: array}, values at the points of the old one, (n,) or (n, k), or of its tetrahedra, (m,) or (m, k).

    At points linear in the old element that holds the point, outside the value at the nearest place of the old boundary.
    Of elements conservative, by intersection: the sum of value times volume stays in each region, and no value leaves the
    range that its region had, as long as the region's volume allows that.

    Raises OptionError, InputError (the first defect of a mesh), Cancelled.

    >>> octafront.carry(old, new, {"T": temperature})["T"]
    """
    settings = _Settings("carry", "carry", keywords)
    old, new = (Mesh.read(mesh) if _is_file(mesh) else Mesh.of(mesh) for mesh in (old, new))
    return _fields.carried(old, new, _fields.fields_on(old, fields), settings, False)


@_takes_options("move")
def move(mesh, displacement, *, fields=None, **keywords):
    """The mesh moved by a displacement, (n, 3) at its points, and mended on the way: a new Mesh. report["history"] has the
    steps: which part of the motion was done, whether the mesh was "moved", "improved" or "adapted", and how good it is.

    mesh: a valid Mesh, the name of its file, or an object of meshio, PyVista or VTK. Names, sets and `fields`, {name: array}
    as of adapt(), go along: mesh.fields of the new mesh. Steps are as long as elements stay positive and sound; below
    `least_quality` they are improved, then the mesh is adapted to the lengths that it had.

    Raises OptionError, InputError, MeshingError (the body would touch itself: where, and how far it can go), Cancelled.

    >>> octafront.move(mesh, 0.1 * u, fields={"T": temperature}).fields["T"]
    """
    settings = _Settings("move", "move", keywords)
    old = Mesh.read(mesh) if _is_file(mesh) else Mesh.of(mesh)
    return _fields.moved(old, displacement, _fields.fields_on(old, fields), settings, Mesh._of)


def repair(points, triangles=None):
    """What is made of a surface without moving or inventing anything: a Surface. Its report tells what was done
    ("notes", and a count of each kind), whether it is "clean", and if not, its "defects".

    points, triangles: as for mesh(). Raises InputError for indices out of range and coordinates that are not finite.
    """
    job = _Job("repair", _surface_of(points, triangles)._handle)
    report = job.run()
    return Surface._of(job.take("surface"), report)


def mend(points, triangles=None, *, tolerance=None, way="auto", distance=None, progress=None, threads=0):
    """A clean surface from any soup of triangles: what is torn within `tolerance` (default: a thousandth of the diagonal)
    is brought together, holes are closed, what crosses is divided, overlapping parts are united, and what bounds nothing
    is gone. A Surface; its report says what was done, with places. A clean surface comes back as it was.

    points, triangles: as for mesh(). way: "wrap" makes a closed skin at a `distance` around everything instead (default:
    a hundredth of the diagonal). mesh() mends by itself; this is for the surface alone.

    Raises InputError where the soup encloses nothing, OptionError, Cancelled.

    >>> octafront.mesh(octafront.mend(octafront.Surface.read("scan.ply")))
    """
    return _complexes.mended(_surface_of(points, triangles), tolerance, way, distance, threads, progress)


def complex_of_walls(points, triangles=None, *, regions=None, voids=None, cells="auto", nested="auto", progress=None,
                     threads=0):
    """The regions that the walls of a surface enclose: a Surface with sides, for mesh(). A plain closed surface comes
    back as it is. report["regions"] has names and volumes, report["notes"] what was decided.

    points, triangles: as for mesh(); which way triangles face does not matter.
    regions: {"steel": (x, y, z)}: the cell around the point, or the points, has this name.
    voids: points whose cells stay empty.
    cells: "regions": every enclosed cell is one, also where walls lie double or cross; "merge": all are one body.
    nested: closed shells inside others: "cavity" or "region"; "auto" goes by the way they face.

    Raises InputError, with `leak` where regions are joined through a hole; OptionError, Cancelled.

    >>> foam = octafront.complex_of_walls(octafront.Surface.read("foam.ply"), regions={"core": (0.5, 0.5, 0.5)})
    >>> octafront.mesh(foam, size=0.05)
    """
    return _complexes.of_walls(_surface_of(points, triangles), regions, voids, cells, nested, threads, progress)


def join_bodies(bodies, *, regions=None, voids=None, cells="auto", overlap="auto", tolerance=None, progress=None,
                threads=0):
    """Several closed bodies as one complex, which mesh() fills with one mesh: where they touch they share faces, where
    they overlap the later one has its way. A Surface with a region for each, report as of complex_of_walls().

    bodies: {name: Surface, or its file}, in order. tolerance: walls nearer to each other are one (default: what facets
    explain, or a small part of the size). regions and voids name and empty what bodies enclose but none fills; cells="merge": one region of all.
    overlap: who has what bodies share: "first", "later", or "new": it is a region of its own, "a&b".

    Raises InputError, with the name of the body at fault; OptionError, Cancelled.

    >>> octafront.mesh(octafront.join_bodies({"plate": "plate.stl", "bolt": "bolt.stl"})).save("bolted.msh")
    """
    return _complexes.of_bodies(bodies, regions, voids, cells, overlap, tolerance, threads, progress)


def _checked_as_walls(what, triangles):
    """The report of a surface that is clean as the walls of regions, or touches itself in edges and vertices; or None."""
    try:
        report = repair(complex_of_walls(what, triangles)).report
    except InputError:
        return None
    return report if report["clean"] else None


def check(what, triangles=None, *, solver=None):
    """What is wrong with a Surface (or points and triangles), a Mesh, or a file of either: a Checked, true if nothing
    is.

    solver: "abaqus", "ansys", "nastran" or "calculix": list the elements of a mesh that it would warn of or refuse.
    """
    if _is_file(what):
        what = read(what)
    mesh = _mesh_of(what) if triangles is None else None
    if mesh is not None:
        what = mesh
        report = _Job("check", what._handle, _bytes_of(solver or "")).run()
        return Checked(text=report["defect"] or "a valid mesh", **{"solver": None, "second_order": None, **report})
    if solver:
        raise OptionError("`solver` looks at tetrahedral meshes; this is a surface")
    report = repair(what, triangles).report
    if not report["clean"]:
        report = _checked_as_walls(what, triangles) or report
    return Checked(text=report.pop("described") or "a clean surface", **{"volume": None, **report})


def read(path):
    """A Mesh, or a Surface, as the file has it: of a format that formats() lists.

    Which of the two the ending says; STL, OBJ, OFF and PLY are surfaces. Who knows, and type checkers, have
    Surface.read() and Mesh.read(). Raises InputError with line or byte.
    """
    endings = {ending for f in formats() if f["reads_mesh"] for ending in f["endings"].split()}
    name = path.decode(errors="replace") if isinstance(path, bytes) else str(path)
    ending = "." + name.lower().rpartition(".")[2] if "." in name else ""
    return Mesh.read(path) if ending in endings else Surface.read(path)


def formats():
    """The file formats: a list of dicts with name, title, endings, and what can be read and written."""
    return _json.loads(_call("formats"))
