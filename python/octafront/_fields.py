"""What is known on a mesh, brought to another: one that was made of it, or of the same body anew."""

import ctypes

from . import errors
from ._jobs import Job
from ._library import Array, demand, pointer
from ._numpy import np
from ._surface import array_of


class _Field(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("of_elements", ctypes.c_int), ("components", ctypes.c_size_t),
                ("values", ctypes.c_void_p), ("out", ctypes.c_void_p)]


class CarriedFields(dict):
    """{name: array} on the new mesh. `report` has "carry": how the meshes lie to each other, and "carried": of each
    field its integral, least and greatest value before and after."""

    def __init__(self, fields, report):
        super().__init__(fields)
        self.report = report


def field_on(mesh, name, values):
    """Values at the points or of the tetrahedra of a mesh, as an array of doubles. Raises OptionError."""
    values = np.ascontiguousarray(array_of(values, f"the field {name!r}", np.float64))
    if values.ndim == 0 or len(values) not in (len(mesh.points), len(mesh.tets)):
        raise errors.OptionError(f"the field {name!r} has the shape {values.shape}: it needs a row for each of {len(mesh.points)} points "
                                 f"or {len(mesh.tets)} tetrahedra")
    if not np.isfinite(values).all():
        raise errors.OptionError(f"the field {name!r} has values that are not finite")
    return values


def fields_on(mesh, fields):
    return {name: field_on(mesh, name, values) for name, values in dict(fields or {}).items()}


def carried(old, new, fields, settings, adapted):
    """Fields that fields_on() gave on another mesh: CarriedFields. adapted: it was made of the old one."""
    made = {}
    rows = (_Field * max(1, len(fields)))()
    count = 0
    for name, values in fields.items():
        of_elements = len(values) != len(old.points)
        made[name] = np.zeros((len(new.tets) if of_elements else len(new.points), *values.shape[1:]))
        components = int(np.prod(values.shape[1:], dtype=np.int64))
        if components:
            rows[count] = _Field(str(name).encode(), int(of_elements), components, pointer(values), pointer(made[name]))
            count += 1
    job = Job("carry", old._handle, new._handle, int(adapted), ctypes.cast(rows, ctypes.c_void_p), count, settings.options,
              settings.threads, progress=settings.progress)
    return CarriedFields(made, job.run())


def moved(mesh, displacement, fields, settings, make):
    """The mesh moved by (n, 3) displacements, as make(address, report) has it, with its fields."""
    by = np.ascontiguousarray(array_of(displacement, "the displacement", np.float64))
    if by.shape != (len(mesh.points), 3):
        raise errors.OptionError(f"the displacement has the shape {by.shape}: it needs three numbers for each of {len(mesh.points)} points")
    kept = [(name, values) for name, values in fields.items() if values.size]
    rows = (_Field * max(1, len(kept)))()
    for row, (name, values) in enumerate(kept):
        rows[row] = _Field(str(name).encode(), int(len(values) != len(mesh.points)), int(np.prod(values.shape[1:], dtype=np.int64)),
                           pointer(values), None)
    job = Job("move", mesh._handle, pointer(by), ctypes.cast(rows, ctypes.c_void_p), len(kept), settings.options, settings.threads,
              progress=settings.progress)
    report = job.run()
    new = make(job.take("mesh"), report)
    for row, (name, values) in enumerate(kept):
        found = Array()
        demand("mesh_field", new._handle, row, ctypes.byref(found))
        flat = np.ctypeslib.as_array(ctypes.cast(found.data, ctypes.POINTER(ctypes.c_double)), (found.rows, found.columns))
        new.fields[name] = flat.copy().reshape(-1, *values.shape[1:])
    return new


def take_along(old, new, fields, settings):
    """The same for a mesh that was made of the old one: its `fields` and report have them."""
    if not fields:
        return
    new.fields = carried(old, new, fields, settings, True)
    new.report.update(new.fields.report)
