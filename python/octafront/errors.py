"""What octafront raises. Messages say what is wrong, where, and what to do; evidence comes along as attributes."""


class Error(Exception):
    """Base of all of them."""


class OptionError(Error, ValueError):
    """Options that contradict each other or lie outside their range, or arrays of a wrong shape."""


class InputError(Error, ValueError):
    """The input cannot be read or meshed as it is.

    defects: of a surface that cannot be meshed, else None. A dict of kinds, such as "open_edges" and
        "self_intersections", each with a "count" and the "first" ten places: {"at": [x, y, z], "faces": [...]}, faces
        counted from 0 in the order of the triangles that were given.
    leak: where regions are joined through a hole, points of a way from one to the other, else None.
    """

    defects = leak = None


class MeshingError(Error, RuntimeError):
    """The run ended without a valid mesh, which on valid input is a bug of octafront; or with one that is not what
    `require_volume`, `require_angle` or `require_size` want.

    report: of the mesh that was not what was required, else None.
    """

    report = None


class OpenCavityError(MeshingError):
    """A cavity of the volume front that nothing could close.

    cavity: the evidence, a small closed Surface.
    """

    cavity = None


class OutputError(Error, OSError):
    """The output could not be written. An older file of that name is as it was."""


class Cancelled(Error):
    """A progress function returned False. Nothing was written."""


class InternalError(Error, RuntimeError):
    """A bug of octafront."""
