"""Fields of element sizes."""

import ctypes

from . import errors
from ._jobs import Job
from ._library import Handle, call, demand, file_of, pointer, text_of
from ._numpy import np
from ._surface import points_of


class SizeField:
    """The edge length wanted at each point: continuous, positive, graded. Call it: field(points) -> (n,).

    Made by octafront.size_field() from a model, or read from a file; given as size= or size_field= to the functions that
    mesh. `report` says what was done, "expected_tets" among it.
    """

    def __init__(self, h):
        """The same size `h` everywhere, > 0."""
        address = call("sizes_uniform", float(h))
        if not address:
            raise errors.OptionError(f"a size must be above 0, but is {h}")
        self._handle, self.report = Handle("sizes", address), {}

    @classmethod
    def _of(cls, address, report):
        field = cls.__new__(cls)
        field._handle, field.report = Handle("sizes", address), report
        return field

    @classmethod
    def read(cls, path, *, gradation=0.4):
        """Reads a grid that save() wrote, edited or not: sizes are cut where they break the gradation."""
        job = Job("read_sizes", file_of(path), float(gradation))
        report = job.run()
        return cls._of(job.take("sizes"), report)

    def save(self, path):
        """Writes the background grid as .vtu. A field without one has nothing to show: OutputError."""
        Job("write_sizes", self._handle, file_of(path)).run()

    def __call__(self, points):
        """Edge lengths wanted (n,) at points (n, 3), in units of the model; outside of it, that of its nearest point."""
        return self._at("sizes_at", points, ())

    def metric_at(self, points):
        """The metrics (n, 3, 3) that ask for these lengths at points (n, 3), in 1 / (unit of the model)^2.

        They are symmetric matrices M: an edge e has the wanted length where e @ M @ e == 1. Sizes are the same in all
        directions: M is the identity / length^2.
        """
        return self._at("sizes_metric_at", points, (3, 3))

    def _at(self, function, points, shape):
        points = points_of(points)
        out = np.empty((len(points), *shape))
        demand(function, self._handle, pointer(points), len(points), pointer(out))
        return out

    @property
    def min(self):
        """The smallest size."""
        return self._bounds()[0]

    @property
    def max(self):
        """The largest size."""
        return self._bounds()[1]

    @property
    def expected_tets(self):
        """How many tetrahedra these sizes would make, about; None of a field that was read."""
        return self.report.get("expected_tets")

    def _bounds(self):
        least, largest = ctypes.c_double(), ctypes.c_double()
        call("sizes_bounds", self._handle, ctypes.byref(least), ctypes.byref(largest))
        return least.value, largest.value

    def __getstate__(self):
        at, length = ctypes.c_void_p(), ctypes.c_size_t()
        demand("sizes_pack", self._handle, ctypes.byref(at), ctypes.byref(length))
        return {"packed": ctypes.string_at(at.value, length.value), "report": self.report}

    def __setstate__(self, state):
        address = call("sizes_unpack", state["packed"], len(state["packed"]))
        if not address:
            raise errors.InputError(text_of(call("last_error")))
        self._handle, self.report = Handle("sizes", address), state["report"]

    def __repr__(self):
        return f"<octafront.SizeField: {self.min:.6g} to {self.max:.6g}>"
