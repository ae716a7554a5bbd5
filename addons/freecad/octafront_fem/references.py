"""What objects of an analysis refer to, as faces, edges, points and solids of the shape that is meshed."""
from femtools import geomtools

from .program import Refused

KINDS = ("Solid", "Face", "Edge", "Vertex")


def elements_of(obj, part):
    """{"Face1", "Solid2", ...} of the shape of `part`, sorted, that `obj`.References name; those of another object, of which `part` was made, are
    looked for by their geometry. Raises Refused."""
    found = []
    for parent, names in getattr(obj, "References", []):
        is_own = parent == part or parent.Shape.isSame(part.Shape)
        for name in [names] if isinstance(names, str) else names:
            found.append(name if is_own and name else element_in(part, parent, name, obj))
    return sorted(set(found), key=lambda name: (kind_of(name), number_of(name)))


def element_in(part, parent, name, obj):
    wanted = geomtools.get_element(parent, name) if name else parent.Shape
    at = geomtools.find_element_in_shape(part.Shape, wanted)
    if at is None:
        raise Refused(f"{obj.Label} refers to {parent.Label}:{name}, which is not in {part.Label}: refer to the shape that is meshed")
    return at


def kind_of(name):
    return next(kind for kind in KINDS if name.startswith(kind))


def number_of(name):
    return int(name[len(kind_of(name)):])
