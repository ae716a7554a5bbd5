"""Sheets, lines and points inside of bodies, as the library takes them."""

from collections.abc import Mapping

from . import errors
from ._images import are_files, is_file
from ._library import file_of
from ._numpy import np
from ._surface import array_of, taken


def described(given):
    """Takes the keywords about what lies inside out of `given`; returns the library's own."""
    keys = {}
    for name, kind, row_of in (("sheet", "sheet", _sheet), ("wire", "wire", _wire), ("inner_points", "point", _points)):
        files, rows = _parted(name, given.pop(name, None), row_of)
        keys[f"{kind}_files"], keys[f"inside_{kind}s"] = files or None, rows or None
    return keys


def _parted(keyword, value, row_of):
    """Files, and rows of arrays with their names."""
    if value is None:
        return [], []
    if is_file(value) or are_files(value):
        return [_text(file) for file in ([value] if is_file(value) else value)], []
    if not isinstance(value, Mapping):
        raise errors.OptionError(f"`{keyword}` is a file, a list of files, or {{name: file or arrays}}, not a "
                                 f"{type(value).__name__}")
    files = [f"{name}={_text(one)}" for name, one in value.items() if is_file(one)]
    return files, [[str(name), *row_of(one, name)] for name, one in value.items() if not is_file(one)]


def _text(file):
    return file_of(file).decode("utf-8", "surrogateescape")


def _sheet(value, name):
    surface = taken(value)
    points, triangles = (surface.points, surface.triangles) if surface is not None else _pair(value, name)
    return [_rows(points, name, 3), _whole(triangles, name, 3)]


def _wire(value, name):
    if isinstance(value, tuple) and len(value) == 2 and np.ndim(value[1]) == 2:
        points, edges = value
    else:
        points = value
        edges = [[i, i + 1] for i in range(len(points) - 1)]
    return [_rows(points, name, 3), _whole(edges, name, 2)]


def _points(value, name):
    return [_rows(value, name, 3)]


def _pair(value, name):
    try:
        points, triangles = value
    except (TypeError, ValueError):
        raise errors.OptionError(f"the sheet {name!r} is a file, a Surface or (points, triangles)") from None
    return points, triangles


def _rows(values, name, width):
    rows = array_of(values, f"{name!r}", np.float64)
    if rows.ndim != 2 or rows.shape[1] != width:
        raise errors.OptionError(f"{name!r} needs points as rows of {width} numbers, not an array of shape {rows.shape}")
    return rows.tolist()


def _whole(values, name, width):
    rows = array_of(values, f"{name!r}", np.int64)
    if rows.ndim != 2 or rows.shape[1] != width or (rows.size and rows.min() < 0):
        raise errors.OptionError(f"{name!r} needs rows of {width} numbers of points, not an array of shape {rows.shape}")
    return rows.tolist()
