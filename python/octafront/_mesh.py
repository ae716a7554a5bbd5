"""Tetrahedral meshes."""

import ctypes
import json
import operator
import os
import types

from . import _cells, _foreign, _html, _meshio, errors
from ._jobs import Job
from ._library import Array, Handle, _View, bytes_of, call, demand, file_of, pointer, spoken, text_of
from ._numpy import np
from ._surface import _or_zeros, array_of, column_of, points_of, rows_of, wanted

_KINDS = ["nodes", "edges", "faces", "elements"]
_ARRAYS = ["points", "tets", "region", "boundary", "patch", "source", "interfaces", "interface_patch", "curve_edges",
           "curve", "mid_nodes", "high_nodes", "wide_cells", "wide_faces", "split_faces", "opened_contacts", "periods",
           "period_rotations", "periodic_nodes"]
_LISTS = ["region_names", "patch_names", "curve_names"]


def mesh_of(source):
    """A Mesh, or the one that an object of another library is; None if it holds no tetrahedra."""
    if isinstance(source, Mesh):
        return source
    said = _foreign.mesh_from(source)
    if said is None:
        return None
    sets = said.pop("sets", {})
    mesh = Mesh(**said)
    for name, members in sets.items():
        mesh.add_set(name, members, kind="elements")
    return mesh


def _signed(numbers):
    return np.asarray(numbers, np.uint32).view(np.int32).astype(np.int64)


class Mesh:
    """A mesh of tetrahedra, linear or of second order, with its named parts.

    octafront.mesh(), improve() and read() make one. From arrays of another tool: Mesh(points, tets, ...), which turns
    inverted tetrahedra, drops points that no tetrahedron has, and adds what `faces` lack of the boundary.

    points: (n, 3) float64, any unit of length. tets: (m, 4) indices, or (m, 10) of second order in the order of VTK.
    regions: (m,) number of the body that each tetrahedron lies in; region r is called region_names[r].
    faces: (k, 3) triangles of the boundary, or between regions; patches: (k,) their patches; patch p is called
        patch_names[p].

    Arrays given are copied. Those of the object are read-only views of the library's memory, and keep it alive: nothing
    is copied, and nobody changes a mesh behind its own back; np.array(mesh.points) is a copy to work with. Raises
    OptionError for wrong shapes, InputError for indices out of range.
    """

    def __init__(self, points, tets, *, regions=None, region_names=(), faces=None, patches=None, patch_names=()):
        raw = Handle("mesh")
        raw.set("points", points_of(points))
        tets = array_of(tets, "tets")
        second_order = tets.ndim == 2 and tets.shape[1] == 10
        tets = rows_of(tets, 10 if second_order else 4, np.uint32, "tets")
        raw.set("tets", tets[:, :4])
        if second_order:
            mids = np.empty((len(tets), 6), np.uint32)
            mids[:, _cells.VTK_MIDS] = tets[:, 4:]
            raw.set("mid_nodes", mids)
        for name, values in (("region", regions), ("patch", patches)):
            if values is not None:
                raw.set(name, column_of(values, np.uint32, name + "s"))
        if faces is not None:
            raw.set("boundary", rows_of(faces, 3, np.uint32, "faces"))
        raw.set_names("region_names", region_names)
        raw.set_names("patch_names", patch_names)
        job = Job("order_mesh", raw)
        report = job.run()
        self._take(Handle("mesh", job.take("mesh")), report)

    def _take(self, handle, report, sizes=None):
        self._handle, self._quality, self._sizes = handle, report.get("quality"), sizes
        self.report = report
        self.fields = {}  # of adapt() and improve()

    @classmethod
    def _of(cls, address, report, sizes=None):
        mesh = cls.__new__(cls)
        mesh._take(Handle("mesh", address), report, sizes and Handle("sizes", sizes))
        return mesh

    @classmethod
    def read(cls, path):
        """Reads a mesh of any format that octafront.formats() lists so, with its groups. Raises InputError."""
        job = Job("read_mesh", file_of(path))
        report = job.run()
        return cls._of(job.take("mesh"), report)

    @classmethod
    def of(cls, source):
        """The Mesh of an object of meshio, PyVista or VTK that holds tetrahedra; named groups of meshio are regions and
        patches. Raises OptionError."""
        if (mesh := mesh_of(source)) is None:
            raise errors.OptionError(f"a {type(source).__name__} holds no tetrahedra that are known here")
        return mesh

    @property
    def points(self):
        """(n, 3) float64, input units; of second order: corners first, then mid-side nodes."""
        return self._handle.view("points")

    @property
    def tets(self):
        """(m, 4) uint32, indices into points: seen from the last corner, the others turn counter-clockwise."""
        return self._handle.view("tets")

    @property
    def mid_nodes(self):
        """(m, 6) uint32, mid-side nodes on the edges 01 02 03 12 13 23 of each tet; None: the mesh is linear."""
        found = self._handle.view("mid_nodes")
        return found if len(found) else None

    @property
    def high_nodes(self):
        """Of order 3 and 4: (m, 16) or (m, 31) uint32, the nodes of each tet behind its corners, where the barycentric coordinates
        are multiples of 1/order: of the edges 01 02 03 12 13 23 from the first end on, of the faces 123 032 013 021 (of
        order 4 the one nearest to the first corner first), at order 4 one inside. None: there are none."""
        found = self._handle.view("high_nodes")
        return found.reshape(len(self.tets), -1) if len(found) else None

    @property
    def wedges(self):
        """(w, 6) uint32, corners of the wedges that boundary layers are, three of `tets` each: a triangle, counter-clockwise
        seen from the other one, and that one above it."""
        return _cells.wide_nodes(self._handle.view("wide_cells"), 3)

    @property
    def pyramids(self):
        """(p, 5) uint32, corners of the pyramids where layers end, two of `tets` each: the base, counter-clockwise seen from
        the apex, and the apex."""
        return _cells.wide_nodes(self._handle.view("wide_cells"), 2)

    @property
    def split_faces(self):
        """(s, 6) uint32, where the mesh was split: the corners of a face of the element behind it, counter-clockwise seen from
        in front, and their partners in front, the same at the end of a sheet."""
        return self._handle.view("split_faces")[:, :6]

    @property
    def opened_contacts(self):
        """[(first, second, conforming)]: the names of two patches that lie on each other with nodes of their own, and whether
        their triangles are the same."""
        names = self.names["patches"]
        return [(names[a], names[b], bool(same)) for a, b, same in self._handle.view("opened_contacts")]

    @property
    def quads(self):
        """(q, 4) uint32, the quadrilaterals of wedges and pyramids on the boundary, two of `faces` each, counter-clockwise
        seen from outside."""
        return self._handle.view("wide_faces")[:, 1:]

    @property
    def order(self):
        """1: linear elements; 2 to 4: of that order."""
        if self.high_nodes is not None:
            return 3 if self.high_nodes.shape[1] == 16 else 4
        return 1 if self.mid_nodes is None else 2

    @property
    def old_points(self):
        """Of a mesh that adapt() made: (n,) int64, the number in the old mesh of each point; -1: a new one."""
        return _signed(self._handle.view("old_of_new"))

    @property
    def old_tets(self):
        """Of a mesh that adapt() made: (m,) int64, the number in the old mesh of each tetrahedron, if it is the same
        with all corners at the same places; -1: a new one."""
        return _signed(self._handle.view("old_tet_of_new"))

    @property
    def regions(self):
        """(m,) uint32, number of the body that each tet lies in."""
        return _or_zeros(self._handle.view("region"), len(self.tets))

    @property
    def faces(self):
        """(k, 3) uint32, the triangles of the boundary, counter-clockwise seen from outside."""
        return self._handle.view("boundary")

    @property
    def patches(self):
        """(k,) uint32, the patch of each face."""
        return _or_zeros(self._handle.view("patch"), len(self.faces))

    @property
    def sources(self):
        """(k,) uint32, the triangle of the input nearest to each face; None where there was no input."""
        found = self._handle.view("source")
        return found if len(found) else None

    @property
    def interfaces(self):
        """(i, 3) uint32, faces inside that belong to a patch: between regions, or sheets."""
        return self._handle.view("interfaces")

    @property
    def interface_patches(self):
        """(i,) uint32, the patch of each interface."""
        return _or_zeros(self._handle.view("interface_patch"), len(self.interfaces))

    @property
    def curve_edges(self):
        """(e, 2) uint32, the edges that lie on curves."""
        return self._handle.view("curve_edges")

    @property
    def curves(self):
        """(e,) uint32, the curve of each curve edge."""
        return _or_zeros(self._handle.view("curve"), len(self.curve_edges))

    @property
    def periods(self):
        """(k, 3) float64, of a periodic cell the translations that lead from a face to the one that is its copy."""
        return self._handle.view("periods")

    @property
    def period_rotations(self):
        """(k, 3, 3) float64, of each period the matrix R if it is a rotation: x goes to R x + periods[number]. Empty if
        all periods are translations."""
        return self._handle.view("period_rotations").reshape(-1, 3, 3)

    @property
    def periodic_nodes(self):
        """(n, 3) uint32, of a periodic cell: the number of a period, a node that is a copy, and the node that it is a
        copy of; mid-side nodes too. points[copy] == points[original] + periods[number], each coordinate in one rounding;
        by a rotation ((R[:, 0] * x + R[:, 1] * y) + R[:, 2] * z) + periods[number]."""
        return self._handle.view("periodic_nodes")

    @property
    def names(self):
        """{"regions": [...], "patches": [...], "curves": [...]}: number r is called by the r-th name, if there is one."""
        return {name.split("_")[0] + ("es" if name.startswith("patch") else "s"): self._handle.names(name)
                for name in _LISTS}

    @property
    def sets(self):
        """Further named parts, {name: (kind, members)}: kind "nodes", "edges" (of curve_edges), "faces" (interfaces
        count on behind faces) or "elements"; members (s,) uint32, ascending."""
        found = {}
        for i in range(call("mesh_sets", self._handle)):
            kind, name, length, members = ctypes.c_int(), ctypes.c_void_p(), ctypes.c_size_t(), Array()
            demand("mesh_set", self._handle, i, ctypes.byref(kind), ctypes.byref(name), ctypes.byref(length),
                   ctypes.byref(members))
            text = text_of(ctypes.string_at(name.value, length.value))
            found[text] = (_KINDS[kind.value], np.array(_View.array(self._handle, members)))
        return found

    @property
    def quality(self):
        """A summary, as a dict: beta_mean, beta_min, beta_classes, dihedral_min_degrees, dihedral_max_degrees, ...;
        beta = 3 r / R is 1 for the regular tetrahedron. Element by element: element_quality()."""
        if self._quality is None:
            text = call("mesh_summary", self._handle)
            if text is None:
                raise errors.InputError(spoken(text_of(call("last_error"))))
            self._quality = json.loads(text)
        return self._quality

    def element_quality(self, measure="beta"):
        """(m,) float64: "beta" = 3 r / R, or the "min_dihedral" or "max_dihedral" angle in degrees, of each tet."""
        measures = ["beta", "min_dihedral", "max_dihedral"]
        if measure not in measures:
            raise errors.OptionError(f"`measure` is one of {', '.join(measures)}; {measure!r} is none of them")
        out = np.empty(len(self.tets))
        demand("mesh_quality", self._handle, *(pointer(out) if m == measure else None for m in measures))
        return out

    def add_set(self, name, members=None, *, kind="nodes", box=None, sphere=None, patches=None):
        """Adds a named set, for loads and supports: exactly one of
        members: (s,) indices of nodes, faces or elements, by `kind`;
        box: [[x, y, z], [x, y, z]], sphere: ([x, y, z], radius): the nodes in it, or the faces or elements whose corners
        all are; patches: the faces of patches, by names or numbers from 0.
        Returns the mesh. Raises InputError where nothing is found.
        """
        if sum(x is not None for x in (members, box, sphere, patches)) != 1:
            raise TypeError("add_set() needs exactly one of members, box, sphere and patches")
        if kind not in _KINDS:
            raise errors.OptionError(f"`kind` is one of {', '.join(_KINDS)}; {kind!r} is none of them")
        raw, number = bytes_of(name), _KINDS.index(kind)
        if members is not None:
            members = np.unique(column_of(members, np.uint32, "members"))
            demand("mesh_add_set", self._handle, number, raw, len(raw), pointer(members), len(members))
            return self
        corners = None if box is None else np.sort(points_of(box, "box"), axis=0)
        ball = None if sphere is None else array_of([*sphere[0], sphere[1]], "sphere", np.float64)
        # Numbers count from 0 here as everywhere in Python; the library's count from 1 as in files.
        words = [bytes_of(p if isinstance(p, str) else str(int(p) + 1)) for p in (patches or ())]
        note = ctypes.c_char_p()
        demand("mesh_add_group", self._handle, number, raw, len(raw), None if box is None else pointer(corners),
               None if sphere is None else pointer(ball), (ctypes.c_char_p * len(words))(*words) if words else None,
               len(words), ctypes.byref(note))
        if note.value:
            raise errors.InputError(text_of(note.value))
        return self

    def save(self, path, *, format=None, ascii=False, cells_only=False, polyhedral=False, cohesive=False, beams="",
             parts=0, partitioner="curve", split_files=False, job=None, deck=False, speed=None, fluid="air", unit=""):
        """Writes the mesh in the format that the ending tells, or by its name in octafront.formats(). `ascii`: as text, of
        formats that are binary else; `cells_only`: the tetrahedra alone, with regions and sets, without faces and edges,
        which some programs refuse beside them; `polyhedral`: the dual, a polyhedron for each vertex (a folder polyMesh, .cgns,
        .vtu); `cohesive`: cohesive elements between the sides of what was split, `beams`:
        curves that are beams, too, "rod,wire" (both Abaqus). `parts`: divided into so many, for programs on several
        processes (.pvtu, .vtkhdf, .msh, a folder polyMesh), along a curve or by `partitioner` "metis"; `split_files`: a .msh
        for each. `job`: a dict, or a file of it, of materials, supports and loads that make the file a job of a solver
        (.inp, .bdf, .cdb, .med; docs/use/jobs.md). `deck`: around CASE/constant/polyMesh the rest of a case for OpenFOAM's simpleFoam, by the
        `speed` at the inlet, m/s, of a `fluid`, "air", "water" or its kinematic viscosity, and in metres by the `unit` of
        the mesh, "mm". Returns what a user should know, as
        sentences: what the format cannot hold. An older file stays whole if that fails: OutputError; OptionError for what the
        format cannot do."""
        options = {"format": format or "", "ascii": bool(ascii), "cells_only": bool(cells_only),
                   "polyhedral": bool(polyhedral), "cohesive": bool(cohesive), "beams": str(beams), "parts": operator.index(parts),
                   "partitioner": str(partitioner), "split_files": bool(split_files), "job": job if job is None or isinstance(job, dict) else os.fspath(job),
                   "deck": bool(deck), "speed": speed if speed is None else float(speed), "fluid": str(fluid), "unit": str(unit)}
        return Job("write_mesh", self._handle, file_of(path), json.dumps(options).encode()).run()["notes"]

    def adapt(self, *, sizes=None, metric=None, **keywords):
        """octafront.adapt() of this mesh: a new Mesh that fits other sizes, or a metric."""
        import octafront
        return octafront.adapt(self, sizes=sizes, metric=metric, **keywords)

    def move(self, displacement, *, fields=None, **keywords):
        """octafront.move() of this mesh: a new Mesh whose points have gone by (n, 3) displacements."""
        import octafront
        return octafront.move(self, displacement, fields=fields, **keywords)

    def save_page(self, path):
        """Writes a web page that shows the mesh in 3D and its report: one file, which opens without a network. Elements can
        be coloured by their size against the one wanted if mesh() made it. Raises OutputError."""
        report = {"quality": self.quality, **self.report}
        Job("write_page", self._handle, self._sizes, json.dumps(report).encode("utf-8", "replace"), file_of(path)).run()

    def picture(self, path=None, **keywords):
        """octafront.picture() of this mesh: the bytes of a PNG, which is written to `path`, too, if one is given."""
        import octafront
        return octafront.picture(self, path, **keywords)

    def boundary(self):
        """The boundary as a Surface, with its patches."""
        from ._surface import Surface
        used, triangles = np.unique(self.faces, return_inverse=True)
        return Surface(self.points[used], triangles.reshape(-1, 3), patches=self.patches,
                       patch_names=self.names["patches"])

    def to_pyvista(self):
        """A pyvista.UnstructuredGrid with the cell data "region" and "beta", of wedges and pyramids that of their first
        tetrahedron."""
        pyvista = wanted("pyvista")
        rows, types = [], []
        kinds, _ = _cells.elements(self, self._handle.view("wide_cells"))
        for kind in kinds:
            nodes = kind.nodes[:, _cells.VTK_ORDERS.get(kind.name, slice(None))]
            rows.append(np.hstack([np.full((len(nodes), 1), nodes.shape[1]), nodes]).astype(np.int64).ravel())
            types.append(np.full(len(nodes), _cells.VTK_TYPES[kind.name], np.uint8))
        first = np.concatenate([kind.first for kind in kinds])
        grid = pyvista.UnstructuredGrid(np.concatenate(rows), np.concatenate(types), np.array(self.points))
        grid.cell_data["region"] = np.array(self.regions)[first]
        grid.cell_data["beta"] = self.element_quality()[first]
        return grid

    def to_meshio(self):
        """A meshio.Mesh of blocks: tetrahedra, pyramids and wedges with the cell data "region"; triangles and quadrilaterals
        of the boundary, then triangles inside, with "patch"; lines with "curve". Named parts and sets are cell_sets, of nodes
        point_sets; field_data and the cell data "gmsh:physical" (number + 1) are as of a .msh file. Elements of second order
        are so but for faces and lines; points that none has, the middles of diagonals of wedges, are left out."""
        names = self.names
        of_elements, element_at = _cells.elements(self, self._handle.view("wide_cells"))
        of_faces, face_at = _cells.faces(self.faces, self._handle.view("wide_faces"))
        blocks = [_meshio.Block(kind.name, kind.nodes, "region", 3, self.regions[kind.first], names["regions"])
                  for kind in of_elements]
        blocks += [_meshio.Block(kind.name, kind.nodes, "patch", 2, self.patches[kind.first], names["patches"])
                   for kind in of_faces]
        if len(self.interfaces):
            blocks.append(_meshio.Block("triangle", self.interfaces, "patch", 2, self.interface_patches, names["patches"]))
        if len(self.curve_edges):
            blocks.append(_meshio.Block("line", self.curve_edges, "curve", 1, self.curves, names["curves"]))
        point_sets = {name: members.astype(np.int64) for name, (kind, members) in self.sets.items() if kind == "nodes"}
        first = (0, len(of_elements), len(of_elements) + len(of_faces), len(blocks) - 1)
        points = self.points
        if self.order == 2 and len(of_elements) > 1:
            points, number = _cells.used_points(points, [block.cells for block in blocks])
            blocks = [block._replace(cells=number[block.cells]) for block in blocks]
            point_sets = {name: number[found][number[found] >= 0] for name, found in point_sets.items()}
        return _meshio.mesh_of(points, blocks, self._sets_of_blocks(first, element_at, face_at), point_sets)

    def _sets_of_blocks(self, first, element_at, face_at):
        """(name, which block, members) of the sets of cells, in the blocks of to_meshio(): elements, faces, faces inside and
        edges begin at these."""
        for name, (kind, members) in self.sets.items():
            if kind == "elements":
                parts = [(first[0] + block, part) for block, part in _cells.members(element_at, members)]
            elif kind == "faces":
                inside = np.searchsorted(members, len(self.faces))
                parts = [(first[1] + block, part) for block, part in _cells.members(face_at, members[:inside])]
                parts.append((first[2], members[inside:] - len(self.faces)))
            else:
                parts = [(first[3], members)] if kind == "edges" else []
            yield from ((name, block, part) for block, part in parts if len(part))

    def plot(self, clip=(1, 0, 0), **keywords):
        """Shows the mesh by pyvista, coloured by beta and cut open by whole elements: those whose centres lie behind the
        plane through the middle with the normal `clip`; None: not cut. Keywords are those of pyvista's plot()."""
        grid = self.to_pyvista()
        if clip is not None:
            middle = self.points.min(axis=0) / 2 + self.points.max(axis=0) / 2
            kinds, _ = _cells.elements(self, self._handle.view("wide_cells"))
            centres = np.concatenate([self.points[kind.nodes].mean(axis=1) for kind in kinds])
            grid = grid.extract_cells(np.flatnonzero((centres - middle) @ np.asarray(clip, float) <= 0))
        return grid.plot(**{"scalars": "beta", "show_edges": True, **keywords})

    def __getstate__(self):
        return {"arrays": {name: np.array(self._handle.view(name)) for name in _ARRAYS},
                "names": {name: self._handle.names(name) for name in _LISTS}, "sets": self.sets, "report": self.report}

    def __setstate__(self, state):
        handle = Handle("mesh")
        for name, array in state["arrays"].items():
            handle.set(name, array)
        for name, names in state["names"].items():
            handle.set_names(name, names)
        self._take(handle, state["report"])
        for name, (kind, members) in state["sets"].items():
            self.add_set(name, members, kind=kind)

    def __len__(self):
        return len(self.tets)

    def __repr__(self):
        q = self.quality
        return (f"<octafront.Mesh: {len(self)} tetrahedra{' of second order' if self.order == 2 else ''}, "
                f"{len(self.points)} points, beta {q['beta_mean']:.3f} (least {q['beta_min']:.3f})>")

    def _repr_html_(self):
        return _html.of_mesh(self)


class Checked(types.SimpleNamespace):
    """What octafront.check() found; true if all is well.

    Of a surface: clean, defects (a dict of kinds with counts and places), notes (what repair would change), bodies,
    cavities, volume. Of a mesh: valid, defect (a sentence, or None), second_order, groups, solver. `text`: the same in
    words.
    """

    def __bool__(self):
        return getattr(self, "clean", None) or getattr(self, "valid", False)

    def __str__(self):
        return self.text
