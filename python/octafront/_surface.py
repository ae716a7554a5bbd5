"""Triangle surfaces."""

import importlib

from . import _foreign, errors
from ._jobs import Job
from ._library import Handle, call, file_of
from ._numpy import np

OUTSIDE = 0xFFFFFFFF


def array_of(value, name, dtype=None):
    """`value` as NumPy has it. Raises OptionError where that is no array: rows of unequal length, words for numbers."""
    try:
        return np.asarray(value, dtype)
    except (TypeError, ValueError) as error:
        raise errors.OptionError(f"{name} must be numbers in rows of equal length: {error}") from None


def points_of(value, name="points"):
    return rows_of(value, 3, np.float64, name)


def rows_of(value, columns, dtype, name):
    """`value` as a C-ordered array of a dtype, without a copy if it is one. Raises OptionError."""
    array = array_of(value, name)
    if array.size == 0:
        array = array.reshape(0, columns).astype(dtype)
    if array.ndim != 2 or array.shape[1] != columns:
        raise errors.OptionError(f"{name} must have the shape (n, {columns}), not {array.shape}")
    return np.ascontiguousarray(_numbers(array, dtype, name))


def column_of(value, dtype, name):
    array = array_of(value, name)
    if array.ndim != 1:
        raise errors.OptionError(f"{name} must have the shape (n,), not {array.shape}")
    return np.ascontiguousarray(_numbers(array, dtype, name))


def _numbers(array, dtype, name):
    if array.dtype == dtype:
        return array
    kinds = "iu" if dtype == np.uint32 else "iuf"
    if array.dtype.kind not in kinds and array.size:
        raise errors.OptionError(f"{name} must hold {'whole ' if dtype == np.uint32 else ''}numbers, not {array.dtype}")
    if dtype == np.uint32 and array.size and (array.min() < 0 or array.max() > OUTSIDE):
        worst = array.min() if array.min() < 0 else array.max()
        raise errors.OptionError(f"{name} holds {worst}: indices count from 0 and have 32 bits")
    return array.astype(dtype)


def wanted(library):
    """A library that is imported only when it is asked for."""
    try:
        return importlib.import_module(library)
    except ImportError:
        raise ImportError(f"this needs {library}, which is not installed: pip install {library}") from None


class Surface:
    """A surface of triangles: the boundary of a body, or of several regions.

    points: (n, 3) float64, any unit of length. triangles: (m, 3) indices, counter-clockwise seen from outside.
    patches: (m,) number of the named part that each triangle belongs to; patch p is called patch_names[p].
    sides: (m, 2) numbers of the regions in front of each triangle (where its normal points) and behind it,
        octafront.OUTSIDE for none; without it one region, 0, lies behind all. Region r is called region_names[r].

    Arrays given are copied; those of the object are read-only views of the library's memory. Raises OptionError for
    wrong shapes.
    """

    def __init__(self, points, triangles, *, patches=None, patch_names=(), sides=None, region_names=()):
        handle = Handle("surface")
        handle.set("points", points_of(points))
        handle.set("triangles", rows_of(triangles, 3, np.uint32, "triangles"))
        if patches is not None:
            handle.set("patch", column_of(patches, np.uint32, "patches"))
        if sides is not None:
            handle.set("sides", rows_of(_with_outside(sides), 2, np.uint32, "sides"))
        handle.set_names("patch_names", patch_names)
        handle.set_names("region_names", region_names)
        self._take(handle, {})

    # Whether the library has opened it: then it is meshed as it is.
    _opened = False

    def _take(self, handle, report):
        self._handle, self.report = handle, report

    @classmethod
    def _of(cls, address, report=None, opened=False):
        surface = cls.__new__(cls)
        surface._take(Handle("surface", address), report or {})
        surface._opened = opened
        return surface

    @classmethod
    def read(cls, path):
        """Reads STL, OBJ, OFF or PLY, recognised by content, or CAD (STEP, IGES, BREP) as triangles for elements of a
        fortieth of the diagonal; mesh("part.step", size=...) makes those that suit it. Raises InputError with line or byte."""
        job = Job("read_surface", file_of(path))
        report = job.run()
        return cls._of(job.take("surface"), report)

    @classmethod
    def of(cls, source):
        """The Surface of an object of trimesh, Open3D, PyVista, VTK or meshio (whose named groups are patches), of a Mesh
        (with the walls between its regions), or of a shape of CadQuery, FreeCAD or build123d. Raises TypeError."""
        return surface_of(source, None)

    @property
    def points(self):
        """(n, 3) float64, input units."""
        return self._handle.view("points")

    @property
    def triangles(self):
        """(m, 3) uint32, indices into points, counter-clockwise seen from outside."""
        return self._handle.view("triangles")

    @property
    def patches(self):
        """(m,) uint32, the patch of each triangle."""
        return _or_zeros(self._handle.view("patch"), len(self.triangles))

    @property
    def sources(self):
        """(m,) uint32, the triangle of the input that each one came from."""
        found = self._handle.view("source")
        return found if len(found) else np.arange(len(self.triangles), dtype=np.uint32)

    @property
    def sides(self):
        """(m, 2) uint32, the regions in front of and behind each triangle; OUTSIDE: none."""
        found = self._handle.view("sides")
        if len(found):
            return found
        return np.broadcast_to(np.array([OUTSIDE, 0], dtype=np.uint32), (len(self.triangles), 2))

    @property
    def bounds(self):
        """(m,) float64, of a mended surface: how near a mesh of automatic sizes stays to each triangle where repair moved
        something; infinite where that is no nearer than elsewhere."""
        found = self._handle.view("bound")
        return found if len(found) else np.broadcast_to(np.float64(np.inf), (len(self.triangles),))

    @property
    def patch_names(self):
        """Patch p is called patch_names[p]; may be shorter than the number of patches."""
        return self._handle.names("patch_names")

    @property
    def region_names(self):
        """Region r is called region_names[r]."""
        return self._handle.names("region_names")

    def picture(self, path=None, **keywords):
        """octafront.picture() of this surface: the bytes of a PNG, which is written to `path`, too, if one is given."""
        import octafront
        return octafront.picture(self, path, **keywords)

    def save(self, path):
        """Writes by the ending: .stl, .obj, .off, .ply. An older file stays whole if that fails: OutputError."""
        Job("write_surface", self._handle, file_of(path)).run()

    def to_pyvista(self):
        """A pyvista.PolyData with the cell data "patch"."""
        pyvista = wanted("pyvista")
        faces = np.hstack([np.full((len(self.triangles), 1), 3), self.triangles]).astype(np.int64)
        data = pyvista.PolyData(np.array(self.points), faces.ravel())
        data.cell_data["patch"] = np.array(self.patches)
        return data

    def to_meshio(self):
        """A meshio.Mesh of triangles with the cell data "patch"; patches that have names are cell_sets, and field_data and
        the cell data "gmsh:physical" (number + 1) as of a .msh file."""
        from . import _meshio
        return _meshio.mesh_of(self.points, [_meshio.Block("triangle", self.triangles, "patch", 2, self.patches,
                                                           self.patch_names)])

    def plot(self, **keywords):
        """Shows the surface by pyvista; keywords are those of pyvista's plot()."""
        return self.to_pyvista().plot(**{"show_edges": True, **keywords})

    def __getstate__(self):
        return {"arrays": {name: np.array(self._handle.view(name))
                           for name in ("points", "triangles", "patch", "source", "sides", "bound")},
                "patch_names": self.patch_names, "region_names": self.region_names, "report": self.report,
                "voxel": call("surface_voxel", self._handle), "opened": self._opened}

    def __setstate__(self, state):
        handle = Handle("surface")
        for name, array in state["arrays"].items():
            handle.set(name, array)
        for name in ("patch_names", "region_names"):
            handle.set_names(name, state[name])
        call("surface_set_voxel", handle, state["voxel"])
        self._take(handle, state["report"])
        self._opened = state["opened"]

    def __repr__(self):
        return f"<octafront.Surface: {len(self.triangles)} triangles, {len(self.points)} points>"


def _with_outside(sides):
    """-1 says OUTSIDE too."""
    sides = array_of(sides, "sides")
    return np.where(sides == -1, OUTSIDE, sides) if sides.dtype.kind == "i" else sides


def _or_zeros(found, n):
    return found if len(found) else np.broadcast_to(np.uint32(0), (n,))


def surface_of(points, triangles):
    """The Surface that a function was given: itself, or as two arrays."""
    if isinstance(points, Surface):
        if triangles is not None:
            raise TypeError("give a Surface, or points and triangles, not both")
        return points
    if triangles is not None:
        return Surface(points, triangles)
    if (surface := taken(points)) is None:
        raise TypeError("give points (n, 3) and triangles (m, 3), a Surface, or an object of trimesh, PyVista, meshio or "
                        f"a CAD library, not a {type(points).__name__}")
    return surface


def taken(source):
    """The Surface of an object of another library, or of a Mesh; None if it is no such thing."""
    from ._mesh import mesh_of
    if isinstance(source, Surface):
        return source
    mesh, is_cad = mesh_of(source), _foreign.is_cad(source)
    if mesh is not None or is_cad:
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            # A file of a mesh is read with the walls between its regions.
            files = _foreign.write_cad(source, folder) if is_cad else [folder + "/mesh.vtu"]
            if mesh is not None:
                mesh.save(files[0])
            if len(files) > 1:
                raise errors.OptionError("a body is one shape; mesh() takes several as they are")
            return Surface.read(files[0])
    said = _foreign.surface_from(source)
    return None if said is None else Surface(**said)
