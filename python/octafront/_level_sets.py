"""Meshes that are cut where fields at their points have a value, before they are adapted."""

import ctypes

from . import _fields, errors
from ._jobs import Job
from ._library import pointer
from ._numpy import np
from ._surface import array_of


class _LevelSet(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("values", ctypes.c_void_p), ("level", ctypes.c_double)]


def _values_and_level(mesh, name, given):
    values, level = given if isinstance(given, tuple) else (given, 0.0)
    values = np.ascontiguousarray(array_of(values, f"the level set {name!r}", np.float64))
    if values.shape != (len(mesh.points),):
        raise errors.OptionError(f"the level set {name!r} has the shape {values.shape}: it needs a value for each of {len(mesh.points)} points")
    return values, float(level)


def lengths_at_points(mesh):
    """The mean length of the edges at each point, as the elements have them."""
    sums, counts = np.zeros(len(mesh.points)), np.zeros(len(mesh.points))
    for a, b in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
        lengths = np.linalg.norm(mesh.points[mesh.tets[:, a]] - mesh.points[mesh.tets[:, b]], axis=1)
        for end in (a, b):
            np.add.at(sums, mesh.tets[:, end], lengths)
            np.add.at(counts, mesh.tets[:, end], 1)
    return sums / np.maximum(counts, 1)


def cut(mesh, level_sets, settings, make):
    """(the mesh that is cut, as make(address, report) has it; its fields may be asked for by carried_to())."""
    kept = [(name, *_values_and_level(mesh, name, given)) for name, given in dict(level_sets).items()]
    rows = (_LevelSet * max(1, len(kept)))(*[_LevelSet(str(name).encode(), pointer(values), level) for name, values, level in kept])
    job = Job("cut", mesh._handle, ctypes.cast(rows, ctypes.c_void_p), len(kept), settings.options, settings.threads,
              progress=settings.progress)
    report = job.run()
    return make(job.take("mesh"), report)


def carried_to(old, new, fields, settings):
    return dict(_fields.carried(old, new, fields, settings, False)) if fields else {}
