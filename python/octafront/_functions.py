"""Bodies by a function of space in Python: sampled in a box, on equal cells and a layer around them."""

import ctypes
import json
import math

from . import errors
from ._images import described
from ._jobs import Job
from ._library import pointer
from ._numpy import np
from ._surface import Surface, array_of

_CELLS, _AT_ONCE = 64, 1 << 18


def is_function(source):
    return callable(source) and not isinstance(source, (Surface, type))


def open_job(function, settings):
    """The job that makes a domain of where function(points (n, 3)) -> (n,) is below 0."""
    intake = dict(settings.intake)
    box, resolution = intake.pop("box", None), intake.pop("resolution", None)
    if box is None:
        raise errors.OptionError("a function needs the box that the body lies in or is cut by: box=((x0, y0, z0), (x1, y1, "
                                 "z1))")
    lo, hi = array_of(box, "`box`", np.float64).reshape(2, 3)
    if not (np.isfinite(lo).all() and np.isfinite(hi).all() and (lo < hi).all()):
        raise errors.OptionError(f"`box` from {lo.tolist()} to {hi.tolist()} is no box")
    along = _CELLS if resolution is None else int(resolution)
    side = (hi - lo).max() / max(along, 1)
    size = np.maximum(4, np.rint((hi - lo) / side)).astype(int) if along >= 4 else np.full(3, along)
    if math.prod(int(n) for n in size) > 4e8:
        raise errors.OptionError(f"`resolution` {along} makes {' x '.join(str(n) for n in size)} cells, more than can be "
                                 "looked at")
    values = _samples(function, lo, hi, size)
    corners = np.ascontiguousarray(np.concatenate([lo, hi]))
    return Job("open_samples", pointer(values), (ctypes.c_uint32 * 3)(*(int(n) for n in size)), pointer(corners),
               json.dumps(described(intake)).encode(), settings.threads, progress=settings.progress)


def _samples(function, lo, hi, size):
    """Its values at the middles of the cells and of one more layer around them, the first axis fastest."""
    axes = [lo[axis] + (np.arange(-1, size[axis] + 1) + 0.5) * ((hi[axis] - lo[axis]) / size[axis]) for axis in range(3)]
    values, layer = [], len(axes[0]) * len(axes[1])
    layers = max(1, _AT_ONCE // layer)
    for first in range(0, len(axes[2]), layers):
        z, y, x = np.meshgrid(axes[2][first:first + layers], axes[1], axes[0], indexing="ij")
        points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        got = np.asarray(function(points), dtype=np.float64)
        if got.shape != (len(points),):
            raise errors.OptionError(f"the function has to return one value for each of {len(points)} points, not the shape "
                                     f"{got.shape}")
        values.append(got)
    return np.ascontiguousarray(np.concatenate(values))
