"""What is known on a mesh, brought along when it is adapted."""

from . import errors
from ._library import demand, pointer
from ._numpy import np
from ._surface import array_of


def field_on(mesh, name, values):
    """Values at the points or of the tetrahedra of a mesh, as an array of doubles. Raises OptionError."""
    values = np.ascontiguousarray(array_of(values, f"the field {name!r}", np.float64))
    if values.ndim == 0 or len(values) not in (len(mesh.points), len(mesh.tets)):
        raise errors.OptionError(f"the field {name!r} has the shape {values.shape}: it needs a row for each of {len(mesh.points)} points "
                                 f"or {len(mesh.tets)} tetrahedra")
    if not np.isfinite(values).all():
        raise errors.OptionError(f"the field {name!r} has values that are not finite")
    return values


def carried(old, new, values):
    """The same on the mesh that adapt() made of the old one."""
    of_elements = len(values) != len(old.points)
    made = np.zeros((len(new.tets) if of_elements else len(new.points), *values.shape[1:]))
    components = int(np.prod(values.shape[1:], dtype=np.int64))
    if components:
        demand("carry_field", old._handle, new._handle, int(of_elements), components, pointer(values), pointer(made))
    return made
