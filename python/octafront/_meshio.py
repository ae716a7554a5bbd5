"""Objects of meshio with names as its reader of .msh would give them: cell sets, and tags that field_data explains."""

import collections

from ._numpy import np
from ._surface import wanted

# Cells of one kind; `part` is "region", "patch" or "curve": number r of it is called names[r].
Block = collections.namedtuple("Block", "kind cells part dimension numbers names")


def mesh_of(points, blocks, sets=(), point_sets=None):
    """sets: (name, which block, members)."""
    meshio = wanted("meshio")
    blocks = [block._replace(numbers=block.numbers.astype(np.int64)) for block in blocks]
    data = {part: [b.numbers if b.part == part else np.zeros_like(b.numbers) for b in blocks]
            for part in dict.fromkeys(b.part for b in blocks)}
    data["gmsh:physical"] = data["gmsh:geometrical"] = [b.numbers + 1 for b in blocks]
    cell_sets, field_data = {}, {}
    for at, block in enumerate(blocks):
        for number, members in _members_of(block):
            name = _put(cell_sets, block.names[number], at, members, len(blocks))
            field_data.setdefault(name, np.array([number + 1, block.dimension]))
    for name, at, members in sets:
        _put(cell_sets, name, at, members.astype(np.int64), len(blocks))
    return meshio.Mesh(np.array(points), [(b.kind, b.cells.astype(np.int64)) for b in blocks], cell_data=data,
                       cell_sets=cell_sets, field_data=field_data, point_sets=point_sets)


def _members_of(block):
    """(number, cells) of each part of a block that has a name."""
    order = np.argsort(block.numbers, kind="stable")
    ends = np.searchsorted(block.numbers[order], np.arange(len(block.names) + 1))
    for number, name in enumerate(block.names):
        if name and ends[number] < ends[number + 1]:
            yield number, order[ends[number]:ends[number + 1]]


def _put(sets, name, at, members, blocks):
    """One name may stand for cells of several blocks; of the same block a second set gets another one. The name."""
    while name in sets and len(sets[name][at]):
        name += "_"
    sets.setdefault(name, [np.empty(0, np.int64)] * blocks)[at] = members
    return name
