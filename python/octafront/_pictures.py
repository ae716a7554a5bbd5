"""Pictures of meshes and surfaces, as PNG."""

import json

from . import errors
from ._jobs import Job
from ._images import is_file
from ._library import file_of
from ._surface import Surface, surface_of


def picture(what, path=None, *, color=None, cut=None, edges=None, view=None, up=None, highlight=(), names=False, worst=False,
            size=(1200, 900), bare=False, title="", unit="", progress=None, threads=0):
    """A picture of a mesh or a surface: the bytes of a PNG. No display and no graphics card is needed, and the same pixels
    come out on every machine.

    what: a Mesh, a Surface, the name of a file of either, or an object of another library, as mesh() and improve() take
        them. A surface is shown as it is: the backs of its triangles are violet.
    path: of a file, which is written too; it ends in .png.
    color: "quality" (beta from 0, dark red, to 1, light blue, in every mesh), "region", "size", "patch" or "none". Without a
        value regions where there are several, else quality; of surfaces patches.
    cut: open: "x", "-y", "z=12.5", "x=30%", a normal "NX,NY,NZ" or (nx, ny, nz), or "NX,NY,NZ:X,Y,Z"; what lies beyond goes,
        elements stay whole.
    edges: "elements", "features" or "none". view: "iso", "front", "back", "left", "right", "top", "bottom", or the direction in
        which the viewer is, (x, y, z); up: a direction, or "y" and the like.
    highlight: a place, or several: a region, patch, curve or set by its name, "box:...", "sphere:...".
    names: of faces, or of regions where these are coloured. worst: a close-up of the worst element.
    size: pixels across and down, 64 to 8192. bare: without axes, scale bar, legend and caption. title: the caption begins with
        it; unit: of the scale bar.

    Raises OptionError, InputError, OutputError, Cancelled.

    >>> octafront.picture(mesh, "cut.png", cut="y")
    >>> IPython.display.Image(mesh.picture(highlight=["bolt hole 1"], size=(800, 600)))
    """
    said = {"color": color, "edges": edges, "cut": _words(cut), "view": _words(view), "up": _words(up), "names": bool(names),
            "worst": bool(worst), "highlight": [highlight] if isinstance(highlight, str) else [str(place) for place in highlight],
            "furniture": not bare, "title": str(title), "unit": str(unit), **_pixels(size)}
    mesh, surface = _drawable(what)
    target = None if path is None else _png(path)
    job = Job("picture", mesh, surface, json.dumps(said).encode("utf-8", "replace"), target, threads, progress=progress)
    job.run()
    return job.bytes()


def _words(value):
    """(1, 0, 0) as the command line has it."""
    return value if value is None or isinstance(value, str) else ",".join(repr(float(number)) for number in value)


def _pixels(size):
    try:
        width, height = (int(n) for n in size)
    except (TypeError, ValueError):
        raise errors.OptionError(f"`size` is (pixels across, pixels down), not {size!r}") from None
    return {"width": width, "height": height}


def _png(path):
    name = file_of(path)
    if not name.lower().endswith(b".png"):
        raise errors.OptionError(f"{path}: a picture is written as PNG: give it the ending .png")
    return name


def _drawable(what):
    """Handles of a mesh and of a surface, one of them None."""
    from ._mesh import Mesh, mesh_of
    if is_file(what):
        import octafront
        what = octafront.read(what)
    if not isinstance(what, Surface) and (mesh := mesh_of(what)) is not None:
        return mesh._handle, None
    return None, surface_of(what, None)._handle
