"""From triangles as people have them to what can be meshed: walls, bodies, soups."""

import ctypes
import json

from . import errors
from ._jobs import Job
from ._library import bytes_of
from ._surface import Surface


def of_walls(surface, regions, voids, cells, nested, threads, progress):
    keys = {"regions": _seeds(regions), "voids": _points(voids), "cells": cells, "nested": nested}
    return _made(Job("complex_of_walls", surface._handle, _text(keys), threads, progress=progress))


def of_bodies(bodies, regions, voids, cells, tolerance, threads, progress):
    surfaces = {str(name): body if isinstance(body, Surface) else Surface.read(body) for name, body in bodies.items()}
    if not surfaces:
        raise errors.OptionError("join_bodies() needs bodies: {name: Surface or file, ...}")
    handles = (ctypes.c_void_p * len(surfaces))(*(body._handle.address for body in surfaces.values()))
    names = (ctypes.c_char_p * len(surfaces))(*(bytes_of(name) for name in surfaces))
    keys = {"regions": _seeds(regions), "voids": _points(voids), "cells": cells, "tolerance": tolerance}
    return _made(Job("join_bodies", handles, names, len(surfaces), _text(keys), threads, progress=progress))


def mended(surface, tolerance, way, distance, threads, progress):
    keys = {"tolerance": tolerance, "way": way, "distance": distance}
    return _made(Job("mend", surface._handle, _text(keys), threads, progress=progress))


def _made(job):
    report = job.run()
    return Surface._of(job.take("surface"), report)


def _seeds(regions):
    """Points by name, one or several for each, as rows."""
    rows = []
    for name, at in (regions or {}).items():
        points = _points(at)
        rows += [[str(name), point] for point in ([points] if points and not isinstance(points[0], list) else points)]
    return rows


def _points(value):
    if value is None:
        return []
    try:
        return [_points(row) if hasattr(row, "__len__") else float(row) for row in value]
    except (TypeError, ValueError):
        raise errors.OptionError(f"a point has three coordinates, not {value!r}") from None


def _text(keys):
    return json.dumps({key: value for key, value in keys.items() if value is not None}).encode()
