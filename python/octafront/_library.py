"""The compiled library (include/octafront/octafront_c.h), by ctypes: which lets go of the GIL in every call."""

import ctypes
import functools
import json
import os
import pathlib

from . import errors
from ._numpy import np

FOLDER = pathlib.Path(os.environ.get("OCTAFRONT_BIN", pathlib.Path(__file__).parent / "_bin"))

_TYPES = {1: "float64", 2: "uint32"}
_NONE = 0xFFFFFFFF


class Array(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("rows", ctypes.c_size_t), ("columns", ctypes.c_uint32),
                ("type", ctypes.c_uint32)]


class Event(ctypes.Structure):
    _fields_ = [("kind", ctypes.c_int), ("text", ctypes.c_char_p), ("values", ctypes.c_double * 4),
                ("points", ctypes.POINTER(ctypes.c_double)), ("sizes", ctypes.POINTER(ctypes.c_double)),
                ("count", ctypes.c_size_t), ("out", ctypes.c_void_p), ("into", ctypes.c_void_p),
                ("out_sizes", ctypes.POINTER(ctypes.c_size_t)), ("in_sizes", ctypes.POINTER(ctypes.c_size_t))]


def _load():
    file = FOLDER / "liboctafront.so"
    try:
        return ctypes.CDLL(str(file))
    except OSError as error:
        raise ImportError(f"the compiled part of octafront cannot be loaded: {error}; install the package with "
                          f"'pip install .', or say by OCTAFRONT_BIN in which folder {file.name} lies") from None


_lib = _load()
_handle, _text, _size, _whole = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t, ctypes.c_int
_number, _pointer = ctypes.c_double, ctypes.c_void_p
_length = ctypes.POINTER(ctypes.c_size_t)

_PROTOTYPES = {
    "version": (_text,), "last_error": (_text,), "option_table": (_text,), "intake_table": (_text,), "formats": (_text,),
    "units": (_text,), "unit_of_file": (_text, _text),
    "surface_new": (_handle,), "surface_free": (None, _handle),
    "surface_array": (_whole, _handle, _text, ctypes.POINTER(Array)),
    "surface_set_array": (_whole, _handle, _text, _pointer, _size),
    "surface_add_name": (_whole, _handle, _text, _text, _size),
    "surface_name": (_pointer, _handle, _text, _size, _length),
    "surface_voxel": (_number, _handle), "surface_set_voxel": (None, _handle, _number),
    "mesh_new": (_handle,), "mesh_free": (None, _handle),
    "mesh_array": (_whole, _handle, _text, ctypes.POINTER(Array)),
    "mesh_set_array": (_whole, _handle, _text, _pointer, _size),
    "mesh_add_name": (_whole, _handle, _text, _text, _size),
    "mesh_name": (_pointer, _handle, _text, _size, _length),
    "mesh_sets": (_size, _handle),
    "mesh_set": (_whole, _handle, _size, ctypes.POINTER(_whole), ctypes.POINTER(_pointer), _length,
                 ctypes.POINTER(Array)),
    "mesh_add_set": (_whole, _handle, _whole, _text, _size, _pointer, _size),
    "mesh_add_group": (_whole, _handle, _whole, _text, _size, _pointer, _pointer, ctypes.POINTER(_text), _size,
                       ctypes.POINTER(_text)),
    "mesh_quality": (_whole, _handle, _pointer, _pointer, _pointer),
    "mesh_summary": (_text, _handle),
    "image_new": (_handle, _whole, ctypes.POINTER(ctypes.c_uint32), _pointer, _pointer), "image_free": (None, _handle),
    "sizes_free": (None, _handle), "sizes_at": (_whole, _handle, _pointer, _size, _pointer),
    "sizes_metric_at": (_whole, _handle, _pointer, _size, _pointer),
    "sizes_bounds": (None, _handle, ctypes.POINTER(_number), ctypes.POINTER(_number)),
    "sizes_uniform": (_handle, _number),
    "sizes_pack": (_whole, _handle, ctypes.POINTER(_pointer), _length), "sizes_unpack": (_handle, _text, _size),
    "options_new": (_handle,), "options_free": (None, _handle), "options_set": (_whole, _handle, _text),
    "options_regions": (_whole, _handle, _pointer, _size), "options_point_sizes": (_whole, _handle, _pointer, _size),
    "options_regions_file": (_whole, _handle, _text), "options_point_sizes_file": (_whole, _handle, _text),
    "options_group": (_whole, _handle, _text, _size),
    "options_size_of": (_whole, _handle, _text, _size, _number),
    "options_size_near": (_whole, _handle, _text, _size, _pointer, _number, _number),
    "options_sizes_file": (_whole, _handle, _text),
    "options_size_mesh": (_whole, _handle, _pointer, _size, _pointer, _size, ctypes.c_uint32, _pointer, _whole),
    "options_field": (_whole, _handle, _handle), "options_ask_sizes": (None, _handle),
    "options_tell_passes": (None, _handle), "options_ranks": (_whole, _handle, _whole, _whole),
    "is_cad": (_whole, _text), "read_surface": (_handle, _text), "write_surface": (_handle, _handle, _text),
    "read_mesh": (_handle, _text), "write_mesh": (_handle, _handle, _text, _text),
    "read_image": (_handle, ctypes.POINTER(_text), _size, ctypes.c_uint32),
    "image_surface": (_handle, _handle, _text, _whole),
    "open_files": (_handle, ctypes.POINTER(_text), _size, _text, _handle, _whole), "open_surface": (_handle, _handle, _text, _whole),
    "open_samples": (_handle, _pointer, ctypes.POINTER(ctypes.c_uint32), _pointer, _text, _whole),
    "is_formula": (_whole, _text),
    "open_bodies": (_handle, ctypes.POINTER(_handle), ctypes.POINTER(_text), _size, _text, _whole),
    "complex_of_walls": (_handle, _handle, _text, _whole),
    "join_bodies": (_handle, ctypes.POINTER(_handle), ctypes.POINTER(_text), _size, _text, _whole),
    "mend": (_handle, _handle, _text, _whole),
    "read_sizes": (_handle, _text, _number), "write_sizes": (_handle, _handle, _text),
    "generate": (_handle, _handle, _handle, _whole), "generate_surface": (_handle, _handle, _handle, _whole),
    "generate_sizes": (_handle, _handle, _handle, _whole), "improve": (_handle, _handle, _handle, _handle, _whole),
    "adapt": (_handle, _handle, _handle, _handle, _whole),
    "carry_field": (_whole, _handle, _handle, _whole, _size, _pointer, _pointer),
    "move": (_handle, _handle, _pointer, _pointer, _size, _handle, _whole),
    "mesh_field": (_whole, _handle, _size, ctypes.POINTER(Array)),
    "cut": (_handle, _handle, _pointer, _size, _handle, _whole),
    "carry": (_handle, _handle, _handle, _whole, _pointer, _size, _handle, _whole),
    "adapt_surface": (_handle, _handle, _handle, _pointer, _size, _handle, _whole),
    "adapt_to_metric": (_handle, _handle, _handle, _pointer, _size, _handle, _whole),
    "metrics": (_handle, _handle, _text, _pointer, _pointer, _size, _pointer, _whole),
    "repair": (_handle, _handle), "check": (_handle, _handle, _text), "order_mesh": (_handle, _handle),
    "write_page": (_handle, _handle, _handle, _text, _text),
    "picture": (_handle, _handle, _handle, _text, _text, _whole), "job_bytes": (_pointer, _handle, _length),
    "job_wait": (_whole, _handle, _number, ctypes.POINTER(Event)), "job_answer": (None, _handle),
    "job_cancel": (None, _handle), "job_free": (None, _handle), "job_status": (_whole, _handle),
    "job_message": (_text, _handle), "job_report": (_text, _handle), "job_take_surface": (_handle, _handle),
    "job_take_mesh": (_handle, _handle), "job_take_sizes": (_handle, _handle),
    "job_take_image": (_handle, _handle),
}
for _name, (_result, *_arguments) in _PROTOTYPES.items():
    _function = getattr(_lib, "octafront_" + _name)
    _function.restype, _function.argtypes = _result, _arguments


def call(name, *arguments):
    """Calls octafront_`name`, whatever it returns."""
    return getattr(_lib, "octafront_" + name)(*arguments)


def demand(name, *arguments):
    """The same of a function that returns 0 for success. Raises OptionError."""
    if call(name, *arguments) != 0:
        raise errors.OptionError(spoken(text_of(call("last_error"))))


@functools.lru_cache(maxsize=None)
def option_table():
    """What include/octafront/option_table.h knows: a list of dicts."""
    return json.loads(call("option_table"))


@functools.lru_cache(maxsize=None)
def intake_table():
    """The same of what is asked on the way in."""
    return json.loads(call("intake_table"))


@functools.lru_cache(maxsize=None)
def _spoken_names():
    rows = option_table() + intake_table()
    names = {row["name"] for row in rows}
    fields = {row["field"]: row["name"] for row in rows if row["field"] not in names}
    return {**fields, "field": "size_field", "band": "bands"}


def spoken(text):
    """A message in which options are called as here: the library names fields, in backquotes."""
    for field, name in _spoken_names().items():
        text = text.replace(f"`{field}`", f"`{name}`")
    return text


def text_of(raw):
    """Names of files and groups may hold bytes that no text has: they come and go unharmed."""
    return raw.decode("utf-8", "surrogateescape")


def bytes_of(text):
    return text.encode("utf-8", "surrogateescape")


def file_of(path):
    raw = os.fsencode(path)
    if b"\0" in raw:
        raise errors.OptionError(f"{path!r} is no name of a file: it holds a zero byte")
    return raw


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


class Handle:
    """An object of the library, freed with this one. `kind` is "surface", "mesh", "image", "sizes" or "options"."""

    def __init__(self, kind, address=None):
        self.kind, self.address = kind, address if address is not None else call(kind + "_new")
        if not self.address:
            raise MemoryError(text_of(call("last_error")) or "out of memory")

    def __del__(self, call=call):
        if getattr(self, "address", None):
            call(self.kind + "_free", self.address)

    def __reduce_ex__(self, protocol):
        # A copy of the address would be freed twice.
        raise TypeError(f"the {self.kind} of the library cannot be copied or pickled by themselves")

    @property
    def _as_parameter_(self):
        return ctypes.c_void_p(self.address)

    def view(self, name):
        """An array of the object as NumPy sees it, without a copy: read-only, and it keeps the object alive."""
        found = Array()
        demand(self.kind + "_array", self, name.encode(), ctypes.byref(found))
        return _View.array(self, found)

    def set(self, name, array):
        array = np.ascontiguousarray(array)
        demand(self.kind + "_set_array", self, name.encode(), pointer(array), len(array))

    def names(self, which):
        length, names = ctypes.c_size_t(), []
        while True:
            at = call(self.kind + "_name", self, which.encode(), len(names), ctypes.byref(length))
            if not at:
                return names
            names.append(text_of(ctypes.string_at(at, length.value)))

    def set_names(self, which, names):
        for name in names:
            raw = bytes_of(str(name))
            demand(self.kind + "_add_name", self, which.encode(), raw, len(raw))


class _View:
    """What NumPy asks for the memory of an array that the library owns."""

    def __init__(self, owner, found, dtype):
        self._owner = owner
        shape = (found.rows,) if found.columns == 1 else (found.rows, found.columns)
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": np.dtype(dtype).str,
                                    "data": (found.data, True)}

    @staticmethod
    def array(owner, found):
        dtype = _TYPES[found.type]
        if found.rows == 0:
            return np.empty((0,) if found.columns == 1 else (0, found.columns), dtype)
        return np.asarray(_View(owner, found, dtype))
