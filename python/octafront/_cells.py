"""The elements and faces of a mesh as other libraries take them: tetrahedra that are part of no wedge or pyramid, pyramids,
wedges; triangles and quadrilaterals."""

import collections

from ._numpy import np

# Edges in the order of their mid-side nodes in meshio, as corners.
_EDGES = {"pyramid": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
          "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]}
_SECOND = {"tetra": "tetra10", "pyramid": "pyramid13", "wedge": "wedge15"}
_TET_EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
# Where the mid-side nodes of a tetrahedron stand in VTK and meshio, as columns of `mid_nodes`.
VTK_MIDS = [0, 3, 1, 2, 4, 5]
# The same of orders 3 and 4, as columns of `high_nodes`.
_VTK_HIGH = {3: [0, 1, 6, 7, 3, 2, 4, 5, 8, 9, 10, 11, 14, 12, 13, 15],
             4: [0, 1, 2, 9, 10, 11, 5, 4, 3, 6, 7, 8, 12, 13, 14, 15, 16, 17, 24, 25, 26,
                 19, 20, 18, 21, 22, 23, 27, 28, 29, 30]}
_HIGH_TETRA = "VTK_LAGRANGE_TETRAHEDRON"
# VTK's types; the first triangle of its wedges faces outward.
VTK_TYPES = {"tetra": 10, "pyramid": 14, "wedge": 13, "tetra10": 24, "pyramid13": 27, "wedge15": 26, _HIGH_TETRA: 71}
VTK_ORDERS = {"wedge": [0, 2, 1, 3, 5, 4], "wedge15": [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]}

# Cells of one kind, by meshio's name: their nodes, and the first tetrahedron or face of each.
Kind = collections.namedtuple("Kind", "name nodes first")


def wide_nodes(wide, count):
    """The corners of the wedges (count 3) or pyramids (2) among rows of the library's array "wide_cells"."""
    return wide[wide[:, 1] == count][:, 2:5 + count]


def elements(mesh, wide):
    """Kinds of elements, none of them empty but perhaps the only one; and of each tetrahedron its kind and place there. Of orders 3 and 4
    tetrahedra alone."""
    tets = _with_mids(mesh, "tetra", mesh.tets, None)
    if not len(wide) or mesh.order > 2:
        return [Kind(_name(mesh, "tetra"), tets, np.arange(len(tets)))], None
    alone = np.ones(len(mesh.tets), bool)
    for k in range(3):
        alone[(wide[:, 0] + k)[wide[:, 1] > k]] = False
    kinds = [Kind("tetra", tets[alone], np.flatnonzero(alone))]
    middles = _Middles(mesh) if mesh.order == 2 else None
    for name, count in (("pyramid", 2), ("wedge", 3)):
        kinds.append(Kind(name, _with_mids(mesh, name, wide_nodes(wide, count), middles), wide[wide[:, 1] == count, 0]))
    kinds = [kind._replace(name=_name(mesh, kind.name)) for kind in kinds if len(kind.nodes)]
    place = np.empty((len(mesh.tets), 2), np.int64)
    for at, kind in enumerate(kinds):
        parts = {"p": 2, "w": 3}.get(kind.name[0], 1)
        for k in range(parts):
            place[kind.first + k] = np.stack([np.full(len(kind.first), at), np.arange(len(kind.first))], 1)
    return kinds, place


def faces(triangles, wide):
    """The same of faces of the boundary, with linear nodes."""
    if not len(wide):
        return [Kind("triangle", triangles, np.arange(len(triangles)))], None
    alone = np.ones(len(triangles), bool)
    alone[wide[:, 0]] = alone[wide[:, 0] + 1] = False
    kinds = [Kind("triangle", triangles[alone], np.flatnonzero(alone)), Kind("quad", wide[:, 1:], wide[:, 0])]
    kinds = [kind for kind in kinds if len(kind.nodes)]
    place = np.empty((len(triangles), 2), np.int64)
    for at, kind in enumerate(kinds):
        for k in range(1 if kind.name == "triangle" else 2):
            place[kind.first + k] = np.stack([np.full(len(kind.first), at), np.arange(len(kind.first))], 1)
    return kinds, place


def members(place, of):
    """(kind, places there) of a set of tetrahedra or faces."""
    if place is None:
        yield 0, of
        return
    found = np.unique(place[of], axis=0)
    for at in np.unique(found[:, 0]):
        yield int(at), found[found[:, 0] == at, 1]


def used_points(points, lists):
    """The points that occur in lists of cells, and the number of each there; -1: it does not."""
    used = np.unique(np.concatenate([cells.ravel() for cells in lists]))
    number = np.full(len(points), -1, np.int64)
    number[used] = np.arange(len(used))
    return points[used], number


def _name(mesh, name):
    return name if mesh.order == 1 else _SECOND[name] if mesh.order == 2 else _HIGH_TETRA


def _with_mids(mesh, name, nodes, middles):
    if mesh.order == 1:
        return nodes
    if mesh.order > 2:
        return np.hstack([nodes, mesh.high_nodes[:, _VTK_HIGH[mesh.order]]])
    if name == "tetra":
        return np.hstack([nodes, mesh.mid_nodes[:, VTK_MIDS]])
    return np.column_stack([nodes, *(middles(nodes[:, i], nodes[:, j]) for i, j in _EDGES[name])])


class _Middles:
    """Of edges, by their ends."""

    def __init__(self, mesh):
        ends = np.concatenate([mesh.tets[:, [i, j]] for i, j in _TET_EDGES])
        keys, first = np.unique(self._keys(ends[:, 0], ends[:, 1]), return_index=True)
        self._sorted, self._nodes = keys, mesh.mid_nodes.T.ravel()[first]

    @staticmethod
    def _keys(a, b):
        a, b = a.astype(np.uint64), b.astype(np.uint64)
        return (np.minimum(a, b) << np.uint64(32)) | np.maximum(a, b)

    def __call__(self, a, b):
        return self._nodes[np.searchsorted(self._sorted, self._keys(a, b))]
