"""Keywords of the functions: the library's tables of options (octafront/option_table.h), and what takes more than one
value. Nothing is listed twice: a new row of a table is a new keyword here."""

import difflib
import functools
import inspect
import json
import math
import operator
import os
import textwrap

from . import errors
from ._library import Handle, bytes_of, call, demand, file_of, intake_table, option_table, pointer
from ._numpy import np
from ._surface import array_of
from ._units import convert_lengths, is_cad, name_of_unit

# Beside the tables, of the way in: name, what it is.
_OF_INTAKE = [
    ("region", "{name: point or points}: the cell around each point is a region of this name"),
    ("void", "Points whose cells stay empty"),
    ("sheet", "Surfaces, open or closed, whose triangles become faces inside: a file, a list of files, or {name: file, Surface "
              "or (points, triangles)}"),
    ("wire", "Lines that become edges: a file, a list of files, or {name: file, (points, edges), or points of a polygon}"),
    ("inner_points", "Points that become nodes: a file, a list of files, or {name: file or points}"),
    ("labels", "Of an image: {3: \"liver\"}, or a file of names"),
    ("ignore", "Values of an image outside of all regions; () for none [0]"),
    ("merge", "{\"cortex\": (3, 4)}: these values of an image are one region"),
    ("iso", "Of a grey image: what has this value or more is the region \"body\""),
    ("bands", "Of a grey image: {\"skin\": (-200, 226), \"bone\": (226, None)}, values from the first up to below the "
              "second; None: no limit"),
    ("surface_of", "Of an image of labels: {\"grey matter\": \"pial.stl\"}, closed surfaces of labels, by names or numbers, or "
                   "lists of files: near them voxels follow them, and vertices lie on them"),
    ("crop", "Of an image: ((i0, i1), (j0, j1), (k0, k1)), counted from 0, the last ones too; None for an end that stays"),
    ("resample", "Spacing of the voxels to work with, one number or three"),
]
# Beside the table of options: name, which functions heed it, what it is.
_FURTHER = [(name, "mesh surface size", text) for name, text in _OF_INTAKE] + [
    ("regions", "mesh surface size adapt",
     "Places with a size of their own: a list of {\"box\": [[x, y, z], [x, y, z]], \"size\": h}, {\"sphere\": [x, y, "
     "z], \"radius\": r, \"size\": h}, {\"point\": [x, y, z], \"size\": h}, or an array (n, 4) of points and sizes, or "
     "a file with either"),
    ("point_sizes", "mesh surface size adapt",
     "Sizes at the vertices of the surface: an array (n, 4) of points and sizes, or a file: VTU, VTP, a table"),
    ("size_of", "mesh surface size adapt",
     "{name: edge length} of regions (their boundary and inside), patches and curves, by their names"),
    ("size_near", "mesh surface size adapt",
     "{place: (edge length, distance)} in a region, on a patch, along a curve, by their names, or at a point (x, y, z): "
     "rising from there to nothing asked at the distance"),
    ("group", "mesh",
     "{name: place}: sets that the mesh gets, of what lies at a place: a name, \"box:0,0,0,1,1,1\", or of CAD what it is like, "
     "\"cylinders of radius 3\""),
    ("size_field", "mesh surface size adapt",
     "Sizes on a mesh: (points, tetrahedra or triangles, sizes at points or of elements), or a file \"old.vtu:h\" with "
     "the name of its field. Or all sizes, alone: a SizeField, or a file that one wrote"),
    ("unit", "mesh surface size adapt",
     "What the input's coordinates count, for lengths with a unit of their own, such as size=\"2mm\": um, mm, cm, m, in or "
     "ft; files may say it. Of CAD files the mesh counts it, too, and lengths without a unit [mm]"),
    ("after_pass", "mesh improve", "after_pass(name, worst), told of every pass of improvement"),
    ("progress", "mesh surface size improve adapt carry move",
     "progress(phase, fraction), told how far the run is; fraction is None where it is unknown. What returns False ends "
     "the run with Cancelled"),
    ("threads", "mesh surface size improve adapt carry move", "Threads at most; 0: all. The result is the same"),
    ("comm", "mesh", "A communicator of mpi4py, such as MPI.COMM_WORLD: its processes make the mesh together, all call "
     "this with the same arguments, and all get the same mesh, the one that a process alone gets"),
]


def _rows(task):
    return [row for row in option_table() + intake_table() if task in row["tasks"].split()]


@functools.lru_cache(maxsize=None)
def _intake_keywords():
    return {row["name"] for row in intake_table()} | {name for name, _ in _OF_INTAKE}


def _further(task):
    return [(name, text) for name, tasks, text in _FURTHER if task in tasks.split()]


@functools.lru_cache(maxsize=None)
def keywords_of(task):
    """All keywords of a task: "mesh", "surface", "size", "improve", "adapt", "carry" or "move"."""
    return [row["name"] for row in _rows(task)] + [name for name, _ in _further(task)]


class Settings:
    """The keywords of a call about `source`, taken apart: `options` for the library, `intake` for the way in, and what
    Python serves."""

    def __init__(self, function, task, keywords, source=None):
        keywords = {name: value for name, value in keywords.items() if _is_known(function, task, name)}
        given = {name: value for name, value in keywords.items() if value is not None}
        unit = given.get("unit")
        convert_lengths(given, source)
        if unit is not None and is_cad(source):
            given.setdefault("cad_unit", name_of_unit(unit))
        self.progress, self.after_pass = given.pop("progress", None), given.pop("after_pass", None)
        self.threads = _threads(given.pop("threads", 0))
        given.pop("comm", None)
        self.intake = {name: given.pop(name) for name in list(given) if name in _intake_keywords()}
        self.repeat = {"repeat": given["periodic"]} if given.get("periodic") else {}
        self.options = Handle("options")
        self.size_at = None
        self._set_sizes(given)
        values = {name: _plain(name, value) for name, value in given.items()}
        demand("options_set", self.options, json.dumps(values).encode())
        if self.after_pass:
            call("options_tell_passes", self.options)

    def functions(self):
        return {"progress": self.progress, "after_pass": self.after_pass, "size_at": self.size_at}

    def _set_sizes(self, given):
        from ._sizes import SizeField
        if callable(given.get("size")) and not isinstance(given["size"], SizeField):
            self.size_at = given.pop("size")
            call("options_ask_sizes", self.options)
        elif isinstance(given.get("size"), SizeField):
            given["size_field"] = given.pop("size")
        if "size_field" in given:
            field = given.pop("size_field")
            if _is_file(field):
                if "gradation" in given:
                    demand("options_set", self.options, json.dumps({"gradation": _plain("gradation", given["gradation"])}).encode())
                demand("options_sizes_file", self.options, file_of(field))
            elif isinstance(field, SizeField):
                demand("options_field", self.options, field._handle)
            else:
                self._set_size_mesh(field)
        for place, size in dict(given.pop("size_near", {})).items():
            self._set_near(place, size)
        for name, size in dict(given.pop("size_of", {})).items():
            raw = bytes_of(name)
            demand("options_size_of", self.options, raw, len(raw), float(size))
        for name, place in dict(given.pop("group", {})).items():
            raw = bytes_of(f"{name}={place}")
            demand("options_group", self.options, raw, len(raw))
        for name in ("regions", "point_sizes"):
            if name in given:
                self._set_places(name, given.pop(name))

    def _set_near(self, place, size):
        try:
            h, distance = (float(number) for number in size)
        except (TypeError, ValueError):
            raise errors.OptionError(f"`size_near` of {place!r} is an edge length and a distance, not {size!r}") from None
        if isinstance(place, (str, bytes)):
            raw = bytes_of(place)
            demand("options_size_near", self.options, raw, len(raw), None, h, distance)
            return
        point = np.ascontiguousarray(array_of(place, "a point of `size_near`", np.float64))
        if point.shape != (3,):
            raise errors.OptionError(f"`size_near` names a place by its name or as (x, y, z), not by {place!r}")
        demand("options_size_near", self.options, None, 0, pointer(point), h, distance)

    def _set_size_mesh(self, field):
        try:
            points, elements, sizes = field
        except (TypeError, ValueError):
            raise errors.OptionError("`size_field` is a SizeField, a file, or (points, elements, sizes)") from None
        points = _numbers(points, 3, "size_field", "x, y, z")
        elements = np.ascontiguousarray(array_of(elements, "elements of `size_field`", np.int64))
        if elements.ndim != 2 or elements.shape[1] not in (3, 4):
            raise errors.OptionError(f"elements of `size_field` have the shape (n, 3) or (n, 4), not {elements.shape}")
        if elements.size and not 0 <= elements.min() <= elements.max() < len(points):
            raise errors.OptionError("elements of `size_field` name points that there are not")
        corners = elements.astype(np.uint32)
        sizes = np.ascontiguousarray(array_of(sizes, "sizes of `size_field`", np.float64))
        if sizes.shape not in ((len(points),), (len(elements),)):
            raise errors.OptionError(f"`size_field` has {len(points)} points and {len(elements)} elements, but sizes of the "
                                     f"shape {sizes.shape}")
        demand("options_size_mesh", self.options, pointer(points), len(points), pointer(corners), len(corners),
               corners.shape[1], pointer(sizes), int(len(sizes) != len(points)))

    def _set_places(self, name, value):
        if _is_file(value):
            demand(f"options_{name}_file", self.options, file_of(value))
            return
        rows = _region_rows(value) if name == "regions" else _numbers(value, 4, "point_sizes", "x, y, z, size")
        demand(f"options_{name}", self.options, pointer(rows), len(rows))


def _is_file(value):
    return isinstance(value, (str, bytes, os.PathLike))


def _is_known(function, task, name):
    if name in keywords_of(task):
        return True
    others = [other for other in ("mesh", "surface", "size", "improve", "adapt", "carry", "move") if name in keywords_of(other)]
    near = difflib.get_close_matches(name, keywords_of(task), n=1, cutoff=0.6)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    if others:
        functions = " and ".join(("size_field" if other == "size" else other) + "()" for other in others)
        hint = f": it is an option of {functions}"
    raise TypeError(f"{function}() got an unexpected keyword argument '{name}'{hint}")


def _threads(value):
    try:
        whole = -1 if isinstance(value, bool) else operator.index(value)
    except TypeError:
        whole = -1
    if not 0 <= whole <= 1024:
        raise errors.OptionError(f"`threads` is {value!r}: it must be a whole number from 0 (all) to 1024")
    # More than the machine has only get in each other's way.
    return min(whole, os.cpu_count() or 1)


def _plain(name, value):
    # Numbers of NumPy too.
    value = value.item() if getattr(value, "shape", None) == () else value
    if not isinstance(value, (bool, int, float, str)):
        raise errors.OptionError(f"`{name}` needs a single value, not {type(value).__name__}")
    if isinstance(value, float) and not math.isfinite(value):
        raise errors.OptionError(f"`{name}` is {value}: it must be finite")
    return value


def _numbers(value, columns, name, what):
    rows = np.ascontiguousarray(array_of(value, f"`{name}`, rows of {what},", np.float64))
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise errors.OptionError(f"`{name}` are rows of {what}: an array of shape (n, {columns}), not {rows.shape}")
    return rows


def _region_rows(regions):
    if isinstance(regions, np.ndarray):
        rows = _numbers(regions, 4, "regions", "x, y, z, size")
        return np.ascontiguousarray(np.hstack([rows[:, :3], rows[:, :3], np.zeros((len(rows), 1)), rows[:, 3:]]))
    return np.array([_region_row(i, region) for i, region in enumerate(regions)], dtype=np.float64).reshape(-1, 8)


def _region_row(i, region):
    places = [key for key in ("box", "sphere", "point") if key in dict(region)]
    if len(places) != 1 or "size" not in region or set(region) - {places[0], "radius", "size"}:
        raise errors.OptionError(f"region {i} needs exactly one of \"box\", \"sphere\" and \"point\", a \"size\", and "
                                 f"at most a \"radius\" beside; it has {sorted(region)}")
    corners = array_of(region[places[0]], f"\"{places[0]}\" of region {i}", np.float64)
    if corners.shape != ((2, 3) if places[0] == "box" else (3,)):
        raise errors.OptionError(f"region {i} needs " + ("[[x, y, z], [x, y, z]]" if places[0] == "box" else "[x, y, z]")
                                 + f" in \"{places[0]}\"")
    lo, hi = corners if places[0] == "box" else (corners, corners)
    return [*lo, *hi, region.get("radius", 0.0), region["size"]]


def takes_options(task, further=None):
    """For functions whose last parameter is **keywords: help() and editors see the keywords of the task; and those of
    the signature `further`, which go first."""

    def dress(function):
        signature = inspect.signature(function)
        fixed = [p for p in signature.parameters.values() if p.kind != p.VAR_KEYWORD]
        if further:
            known = {p.name for p in fixed}.union(keywords_of(task))
            fixed += [p for p in further.parameters.values() if p.name not in known]
        defaults = {row["name"]: row["default"] for row in _rows(task)}
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY,
                                  default=0 if name == "threads" else defaults.get(name))
                for name in keywords_of(task)]
        function.__signature__ = signature.replace(parameters=[*fixed, *more])
        function.__doc__ = inspect.cleandoc(function.__doc__) + "\n\n" + _described(task)
        return function

    return dress


def _described(task):
    lines, group = [], None
    for row in _rows(task):
        if row["group"] != group:
            group = row["group"]
            lines.append(f"{group}:")
        without = row["without"] or ("" if row["default"] is None or row["kind"] == "flag" else row["default"])
        default = f" [{without}]" if without != "" else ""
        bounds = f"; {row['range']}" if row["range"] and not row["choices"] else ""
        choices = f" One of {', '.join(row['choices'])}." if row["choices"] else ""
        more = " Or a function: sizes (n,) at points (n, 3)." if row["name"] == "size" else ""
        lines += _entry(row["name"], f"{row['help']}{bounds}.{choices}{more}{default}")
    lines.append("Further:")
    for name, text in _further(task):
        lines += _entry(name, text + ".")
    return "\n".join(lines)


def _entry(name, text):
    return textwrap.wrap(f"{name}: {text}", 100, initial_indent="    ", subsequent_indent="        ")
