"""From triangles as people have them to what can be meshed: walls, bodies, soups."""

import ctypes
import json

from . import errors
from ._images import is_file
from ._jobs import Job
from ._library import bytes_of
from ._surface import Surface, taken


def of_walls(surface, regions, voids, cells, nested, threads, progress):
    keys = {"regions": seeds_of(regions), "voids": points_in(voids), "cells": cells, "nested": nested}
    made = _made(Job("complex_of_walls", surface._handle, text_of_keys(keys), threads, progress=progress))
    # A plain surface came back as it was, with the defects it may have.
    made._opened = bool(made.report["regions"])
    return made


def of_bodies(bodies, regions, voids, cells, overlap, tolerance, threads, progress):
    handles, names, surfaces = arguments_of(bodies)
    keys = {"regions": seeds_of(regions), "voids": points_in(voids), "cells": cells, "overlap": overlap,
            "tolerance": tolerance}
    return _made(Job("join_bodies", handles, names, len(surfaces), text_of_keys(keys), threads, progress=progress))


def arguments_of(bodies):
    """Addresses and names of {name: Surface or file}, and the surfaces, which must live as long."""
    surfaces = {str(name): Surface.read(body) if is_file(body) else _body(body, name) for name, body in bodies.items()}
    if not surfaces:
        raise errors.OptionError("bodies are {name: Surface or file, ...}, one at least")
    handles = (ctypes.c_void_p * len(surfaces))(*(body._handle.address for body in surfaces.values()))
    return handles, (ctypes.c_char_p * len(surfaces))(*(bytes_of(name) for name in surfaces)), surfaces


def _body(body, name):
    surface = taken(body)
    if surface is None:
        raise errors.OptionError(f"bodies are {{name: Surface or file, ...}}; {name!r} is a {type(body).__name__}")
    return surface


def mended(surface, tolerance, way, distance, threads, progress):
    keys = {"tolerance": tolerance, "way": way, "distance": distance}
    return _made(Job("mend", surface._handle, text_of_keys(keys), threads, progress=progress))


def _made(job):
    report = job.run()
    return Surface._of(job.take("surface"), report, opened=True)


def seeds_of(regions):
    """Points by name, one or several for each, as rows."""
    rows = []
    for name, at in (regions or {}).items():
        points = points_in(at)
        rows += [[str(name), point] for point in ([points] if points and not isinstance(points[0], list) else points)]
    return rows


def points_in(value):
    if value is None:
        return []
    try:
        return [points_in(row) if hasattr(row, "__len__") else float(row) for row in value]
    except (TypeError, ValueError):
        raise errors.OptionError(f"a point has three coordinates, not {value!r}") from None


def text_of_keys(keys):
    try:
        return json.dumps({key: value for key, value in keys.items() if value is not None}, allow_nan=False).encode()
    except ValueError:
        raise errors.OptionError("numbers have to be finite: one of those on the way in is not") from None
