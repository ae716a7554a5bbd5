"""The way in: what a function is given becomes the Surface that is meshed, as the command line makes it of files."""

import ctypes
from collections.abc import Mapping

from . import _complexes, _foreign, _functions, _images, _inside
from ._jobs import Job
from ._library import file_of
from ._numpy import np
from ._surface import Surface, surface_of


def opened(source, triangles, settings):
    """source: points, with triangles; a Surface, a file, a list of files, {name: Surface or file}, or an object of another
    library. A Surface that the library made is taken as it is, unless keywords ask for something on the way in."""
    if triangles is None and _foreign.is_cad(source):
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            return opened(_foreign.write_cad(source, folder), None, settings)
    keys, threads = _complexes.text_of_keys(_described(settings.intake)), settings.threads
    if triangles is None and (_images.is_file(source) or _images.are_files(source)):
        files = [source] if _images.is_file(source) else source
        names = (ctypes.c_char_p * len(files))(*(file_of(file) for file in files))
        job = Job("open_files", names, len(files), keys, settings.options, threads, progress=settings.progress)
    elif triangles is None and _functions.is_function(source):
        job = _functions.open_job(source, settings)
    elif triangles is None and isinstance(source, Mapping):
        handles, names, surfaces = _complexes.arguments_of(source)
        keys = _complexes.text_of_keys(_described({**settings.repeat, **settings.intake}))
        job = Job("open_bodies", handles, names, len(surfaces), keys, threads, progress=settings.progress)
    else:
        surface = surface_of(source, triangles)
        if surface._opened and not settings.intake:
            return surface
        job = Job("open_surface", surface._handle, keys, threads, progress=settings.progress)
    report = job.run()
    return Surface._of(job.take("surface"), report, opened=True)


def _described(given):
    given = dict(given)
    seeds, voids = given.pop("region", None), given.pop("void", None)
    if not isinstance(given.get("box", ""), str):
        given["box"] = ",".join(repr(float(number)) for number in np.ravel(given["box"]))
    return {"regions": _complexes.seeds_of(seeds) or None, "voids": _complexes.points_in(voids) or None,
            **_inside.described(given), **_images.described(given)}
