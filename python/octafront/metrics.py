"""Metrics at the points of a mesh, for octafront.adapt(mesh, metric=...).

A metric M is a symmetric positive definite 3 x 3 matrix in 1 / (unit of the points)^2: an edge e has the wanted length where
e @ M @ e == 1. Its eigenvectors are directions, its eigenvalues 1 / length^2. Functions take (n, 3, 3), or (n, 6) as
xx, xy, xz, yy, yz, zz, and return (n, 3, 3). They raise InputError for tensors that are no metrics, with the first places,
OptionError, Cancelled.

    >>> metric = octafront.metrics.of_field(mesh, u, elements=100_000)
    >>> mesh = octafront.adapt(mesh, metric=metric)
"""

import json as _json

from . import errors as _errors
from ._jobs import Job as _Job
from ._library import pointer as _pointer
from ._mesh import Mesh as _Mesh
from ._numpy import np as _np

__all__ = ["bounded", "complexity", "graded", "hessians", "implied", "intersected", "of_field", "of_sizes", "with_complexity"]

# Where each entry of a matrix stands among six.
_ROWS = [[0, 1, 2], [1, 3, 4], [2, 4, 5]]


def _tensors(metric):
    metric = _np.asarray(metric, dtype=_np.float64)
    if metric.ndim == 2 and metric.shape[1] == 6:
        metric = metric[:, _ROWS]
    if metric.ndim != 3 or metric.shape[1:] != (3, 3):
        raise _errors.OptionError(f"a metric has the shape (n, 3, 3) or (n, 6), not {metric.shape}")
    return _np.ascontiguousarray(metric)


def _values(values):
    values = _np.ascontiguousarray(values, dtype=_np.float64)
    if values.ndim != 1:
        raise _errors.OptionError(f"a field has the shape (n,), not {values.shape}")
    return values


class _Adapting(_Job):
    """The job of adapt() by a metric, which lives as long as it; of surfaces also without one."""

    def __init__(self, how, old, ground, metric, settings):
        self._metric = None if metric is None else _tensors(metric)
        values, count = (None, 0) if self._metric is None else (_pointer(self._metric), len(self._metric))
        super().__init__(how, old._handle, ground, values, count, settings.options, settings.threads, **settings.functions())


def _adapting(how, old, ground, metric, sizes, settings):
    if sizes is not None and metric is not None:
        raise _errors.OptionError("`sizes` and `metric` both say all lengths; give one")
    return _Adapting(how, old, ground, metric, settings)


def _run(task, mesh, values=None, others=None, count=None, threads=0, progress=None, **options):
    n = len(values) if count is None else count
    out = _np.empty((n, 3, 3))
    asked = _json.dumps({"task": task, **{k: float(v) for k, v in options.items() if v is not None}}).encode()
    job = _Job("metrics", None if mesh is None else _Mesh.of(mesh)._handle, asked,
               None if values is None else _pointer(values), None if others is None else _pointer(others), n,
               _pointer(out), threads, progress=progress)
    return out, job.run()


def of_sizes(sizes):
    """The metric that asks for the edge lengths (n,) in all directions."""
    sizes = _values(sizes)
    return _np.eye(3) / (sizes * sizes)[:, None, None]


def implied(mesh):
    """The metric in which the edges of the mesh are 1, as nearly as the elements around each point agree."""
    return _run("implied", mesh, count=len(_Mesh.of(mesh).points))[0]


def hessians(mesh, values, *, threads=0, progress=None):
    """Second derivatives (n, 3, 3) of a field (n,) at the points, from the quadratic that fits best around each; exact for
    quadratic fields, at the boundary too."""
    return _run("hessians", mesh, _values(values), threads=threads, progress=progress)[0]


def of_field(mesh, values, *, elements, norm=2, gradation=0.4, min_size=None, max_size=None, threads=0, progress=None):
    """The metric for which the linear interpolant of a field (n,) has the least error in the norm of L^`norm` for about
    this number of elements; graded, and lengths between the bounds."""
    return _run("of_field", mesh, _values(values), elements=elements, norm=norm, gradation=gradation, min_size=min_size,
                max_size=max_size, threads=threads, progress=progress)[0]


def graded(mesh, metric, *, gradation=0.4, threads=0, progress=None):
    """The same metric made finer until lengths grow by no more than `gradation` from one element to the next."""
    return _run("graded", mesh, _tensors(metric), gradation=gradation, threads=threads, progress=progress)[0]


def intersected(a, b):
    """What asks for no longer edges than both."""
    a, b = _tensors(a), _tensors(b)
    if len(a) != len(b):
        raise _errors.OptionError(f"{len(a)} and {len(b)} metrics: both must have one for each point")
    return _run("intersected", None, a, b)[0]


def bounded(metric, *, min_size=None, max_size=None):
    """Lengths cut to the bounds, in each direction."""
    return _run("bounded", None, _tensors(metric), min_size=min_size, max_size=max_size)[0]


def with_complexity(mesh, metric, complexity, *, min_size=None, max_size=None):
    """The same metric with all lengths scaled by one number, so that complexity() becomes this one."""
    return _run("with_complexity", mesh, _tensors(metric), complexity=complexity, min_size=min_size, max_size=max_size)[0]


def complexity(mesh, metric):
    """The integral of sqrt(det M) over the mesh; a mesh that fits the metric has about 10 elements for each 1 of it."""
    return _run("complexity", mesh, _tensors(metric))[1]["complexity"]
