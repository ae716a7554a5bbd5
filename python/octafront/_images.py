"""Images of voxels: arrays or files, and what of them becomes regions."""

import ctypes
import json
import os

from . import errors
from ._jobs import Job
from ._library import Handle, bytes_of, call, file_of, pointer, text_of
from ._numpy import np
from ._surface import Surface, array_of

_U8, _I16, _U16, _I32, _F32 = 3, 4, 5, 6, 7
_WHOLE = (("uint8", _U8), ("int16", _I16), ("uint16", _U16), ("int32", _I32))

# Keywords that the library takes in other words.
_REWORDED = ("labels", "merge", "iso", "bands", "crop", "surface_of")


def surface_of_image(image, affine, spacing, series, regions, threads=0, progress=None):
    """The complex of an image as a Surface; its report has the notes of the reader too."""
    handle, read = _image_of(image, affine, spacing, series)
    job = Job("image_surface", handle, json.dumps(described(regions)).encode(), threads, progress=progress)
    try:
        report = job.run()
    except errors.InputError as error:
        if is_file(image):
            error.args = (f"{os.fsdecode(image)}: {error}",)
        raise
    report.update({key: read[key] for key in ("format", "unit", "frame") if key in read})
    return Surface._of(job.take("surface"), report, opened=True)


def is_file(image):
    return isinstance(image, (str, bytes, os.PathLike))


def _image_of(image, affine, spacing, series):
    if is_file(image) or are_files(image):
        if affine is not None or spacing is not None:
            raise errors.OptionError("`affine` and `spacing` are for arrays: files say where their voxels lie")
        return _read([image] if is_file(image) else image, series)
    if series:
        raise errors.OptionError("`series` is for files that hold several images")
    return _of_array(image, affine, spacing), {}


def are_files(image):
    return isinstance(image, (list, tuple)) and len(image) > 0 and all(is_file(one) for one in image)


def _read(files, series):
    names = (ctypes.c_char_p * len(files))(*(file_of(file) for file in files))
    job = Job("read_image", names, len(files), int(series))
    report = job.run()
    return Handle("image", job.take("image")), report


def _of_array(values, affine, spacing):
    values = array_of(values, "an image")
    if values.ndim != 3 or values.size == 0:
        raise errors.OptionError(f"an image has the shape (ni, nj, nk), not {values.shape}")
    typed, code = _typed(values)
    # The library counts voxels along i first.
    flat = np.ascontiguousarray(typed.ravel(order="F"))
    size = (ctypes.c_uint32 * 3)(*values.shape)
    made = call("image_new", code, size, pointer(flat), pointer(_map_of(affine, spacing)))
    if not made:
        raise errors.InputError(text_of(call("last_error")))
    return Handle("image", made)


def _typed(values):
    """The values in a type of the library that holds them all, and its code."""
    if values.dtype.kind not in "biuf":
        raise errors.OptionError(f"an image holds numbers, not {values.dtype}")
    if values.dtype.kind == "b":
        return values.astype(np.uint8), _U8
    if values.dtype.kind == "f" and not _are_large_labels(values):
        return values.astype(np.float32), _F32
    least, largest = int(values.min()), int(values.max())
    for name, code in _WHOLE:
        limits = np.iinfo(name)
        if limits.min <= least and largest <= limits.max:
            return values.astype(name), code
    raise errors.OptionError(f"the image holds values from {least} to {largest}: whole numbers of 32 bits are the largest")


def _are_large_labels(values):
    """Whole numbers that single precision would round."""
    if values.dtype.itemsize < 8 or not np.isfinite(values).all() or (np.abs(values) < 2**24).all():
        return False
    return bool((values == np.rint(values)).all())


def _map_of(affine, spacing):
    if affine is not None and spacing is not None:
        raise errors.OptionError("give `affine` or `spacing`, not both")
    if affine is None:
        steps = array_of(1.0 if spacing is None else spacing, "`spacing`", np.float64)
        if steps.shape not in ((), (3,)):
            raise errors.OptionError(f"`spacing` is one number or three, not of shape {steps.shape}")
        return np.ascontiguousarray(np.hstack([np.diag(np.broadcast_to(steps, 3)), np.zeros((3, 1))]))
    rows = array_of(affine, "`affine`", np.float64)
    if rows.shape not in ((4, 4), (3, 4)):
        raise errors.OptionError(f"`affine` is a matrix (4, 4) from (i, j, k, 1) to the world, not of shape {rows.shape}")
    if rows.shape == (4, 4) and not np.array_equal(rows[3], (0, 0, 0, 1)):
        raise errors.OptionError(f"the last row of `affine` is {rows[3].tolist()}: it has to be 0, 0, 0, 1")
    return np.ascontiguousarray(rows[:3])


def described(regions):
    """The keywords about images and regions as the library takes them."""
    said = {name: _plain(value) for name, value in regions.items() if value is not None and name not in _REWORDED}
    if "ignore" in said and not isinstance(said["ignore"], list):
        said["ignore"] = [said["ignore"]]
    said.update(_names(regions.get("labels")))
    if regions.get("merge"):
        said["merge"] = [[name, _plain(list(values))] for name, values in dict(regions["merge"]).items()]
    if regions.get("surface_of"):
        said["surface_of"] = [[str(label), text_of(file_of(file))] for label, files in dict(regions["surface_of"]).items()
                              for file in ([files] if is_file(files) else files)]
    bands = [] if regions.get("iso") is None else [["", _plain(regions["iso"]), None]]
    for name, (lo, hi) in dict(regions.get("bands") or {}).items():
        bands.append([name, _finite(lo), _finite(hi)])
    if bands:
        said["bands"] = bands
    if regions.get("crop") is not None:
        said["crop"] = [[_plain(end) for end in both] for both in regions["crop"]]
    return said


def _names(labels):
    if labels is None:
        return {}
    if is_file(labels):
        return {"names_file": text_of(file_of(labels))}
    return {"names": [[int(value), str(name)] for value, name in dict(labels).items()]}


def _finite(end):
    """None for an end that is missing or infinite."""
    return None if end is None or end in (np.inf, -np.inf) else _plain(end)


def _plain(value):
    """Numbers and arrays of NumPy as JSON knows them."""
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value.tolist() if hasattr(value, "tolist") else value
