#!/usr/bin/env python3
"""Writes octafront/__init__.pyi: what editors and type checkers see. The keywords come from the library's table of
options; a test compares.

    make_stubs.py [--check] FILE
"""
import pathlib
import sys

from octafront._library import intake_table, option_table
from octafront._options import keywords_of
from octafront._units import lengths

TEMPLATE = '''\
# Made by python/backend/make_stubs.py: edit that.
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Protocol, TypedDict, overload

import numpy as np
import numpy.typing as npt

from . import errors as errors, metrics as metrics
from .errors import (Cancelled as Cancelled, Error as Error, InputError as InputError, InternalError as InternalError,
                     MeshingError as MeshingError, OpenCavityError as OpenCavityError, OptionError as OptionError,
                     OutputError as OutputError)

__version__: str
OUTSIDE: int

Path = str | bytes | os.PathLike[str]
Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.uint32]
SizeFunction = Callable[[Floats], npt.ArrayLike]
Places = Sequence[Mapping[str, Any]] | npt.NDArray[Any] | Path
Progress = Callable[[str, float | None], bool | None]
Report = dict[str, Any]

class Surface:
    report: Report
    def __init__(self, points: npt.ArrayLike, triangles: npt.ArrayLike, *, patches: npt.ArrayLike | None = None,
                 patch_names: Sequence[str] = (), sides: npt.ArrayLike | None = None,
                 region_names: Sequence[str] = ()) -> None: ...
    @classmethod
    def read(cls, path: Path) -> Surface: ...
    @classmethod
    def of(cls, source: Body) -> Surface: ...
    @property
    def points(self) -> Floats: ...
    @property
    def triangles(self) -> Indices: ...
    @property
    def patches(self) -> Indices: ...
    @property
    def sources(self) -> Indices: ...
    @property
    def sides(self) -> Indices: ...
    @property
    def bounds(self) -> Floats: ...
    @property
    def patch_names(self) -> list[str]: ...
    @property
    def region_names(self) -> list[str]: ...
    def picture(self, path: Path | None = None, **keywords: Any) -> bytes: ...
    def save(self, path: Path) -> None: ...
    def to_pyvista(self) -> Any: ...
    def to_meshio(self) -> Any: ...
    def plot(self, **keywords: Any) -> Any: ...

class SizeField:
    report: Report
    def __init__(self, h: float) -> None: ...
    @classmethod
    def read(cls, path: Path, *, gradation: float = 0.4) -> SizeField: ...
    def save(self, path: Path) -> None: ...
    def __call__(self, points: npt.ArrayLike) -> Floats: ...
    @property
    def min(self) -> float: ...
    @property
    def max(self) -> float: ...
    @property
    def expected_tets(self) -> float | None: ...
    def metric_at(self, points: npt.ArrayLike) -> Floats: ...

class Mesh:
    report: Report
    fields: dict[str, Floats]
    def __init__(self, points: npt.ArrayLike, tets: npt.ArrayLike, *, regions: npt.ArrayLike | None = None,
                 region_names: Sequence[str] = (), faces: npt.ArrayLike | None = None,
                 patches: npt.ArrayLike | None = None, patch_names: Sequence[str] = ()) -> None: ...
    @classmethod
    def read(cls, path: Path) -> Mesh: ...
    @classmethod
    def of(cls, source: Tets) -> Mesh: ...
    @property
    def points(self) -> Floats: ...
    @property
    def tets(self) -> Indices: ...
    @property
    def mid_nodes(self) -> Indices | None: ...
    @property
    def wedges(self) -> Indices: ...
    @property
    def pyramids(self) -> Indices: ...
    @property
    def quads(self) -> Indices: ...
    @property
    def split_faces(self) -> Indices: ...
    @property
    def opened_contacts(self) -> list[tuple[str, str, bool]]: ...
    @property
    def order(self) -> int: ...
    @property
    def old_points(self) -> npt.NDArray[np.int64]: ...
    @property
    def old_tets(self) -> npt.NDArray[np.int64]: ...
    @property
    def regions(self) -> Indices: ...
    @property
    def faces(self) -> Indices: ...
    @property
    def patches(self) -> Indices: ...
    @property
    def sources(self) -> Indices | None: ...
    @property
    def interfaces(self) -> Indices: ...
    @property
    def interface_patches(self) -> Indices: ...
    @property
    def curve_edges(self) -> Indices: ...
    @property
    def curves(self) -> Indices: ...
    @property
    def periods(self) -> Floats: ...
    @property
    def period_rotations(self) -> Floats: ...
    @property
    def periodic_nodes(self) -> Indices: ...
    @property
    def names(self) -> dict[str, list[str]]: ...
    @property
    def sets(self) -> dict[str, tuple[str, Indices]]: ...
    @property
    def quality(self) -> dict[str, Any]: ...
    def element_quality(self, measure: Literal["beta", "min_dihedral", "max_dihedral"] = "beta") -> Floats: ...
    def add_set(self, name: str, members: npt.ArrayLike | None = None, *,
                kind: Literal["nodes", "edges", "faces", "elements"] = "nodes", box: npt.ArrayLike | None = None,
                sphere: tuple[Sequence[float], float] | None = None,
                patches: Sequence[str | int] | None = None) -> Mesh: ...
    def save(self, path: Path, *, format: str | None = None, ascii: bool = False,
             cells_only: bool = False, polyhedral: bool = False, cohesive: bool = False, beams: str = "", parts: int = 0,
             partitioner: Literal["curve", "metis"] = "curve", split_files: bool = False,
             job: dict[str, Any] | Path | None = None) -> list[str]: ...
    def adapt(self, *, sizes: npt.ArrayLike | None = None, metric: npt.ArrayLike | None = None,
              **keywords: Any) -> Mesh: ...
    def move(self, displacement: npt.ArrayLike, *, fields: Mapping[str, npt.ArrayLike] | None = None,
             **keywords: Any) -> Mesh: ...
    def save_page(self, path: Path) -> None: ...
    def picture(self, path: Path | None = None, **keywords: Any) -> bytes: ...
    def boundary(self) -> Surface: ...
    def to_pyvista(self) -> Any: ...
    def to_meshio(self) -> Any: ...
    def plot(self, clip: Sequence[float] | None = (1, 0, 0), **keywords: Any) -> Any: ...
    def __len__(self) -> int: ...

class CarriedFields(dict[str, Floats]):
    report: dict[str, Any]

class _OfTrimesh(Protocol):
    @property
    def vertices(self) -> Any: ...
class _OfMeshio(Protocol):
    points: Any
    cells: Any
    cell_sets: Any
class _OfVtk(Protocol):
    def GetPoints(self) -> Any: ...
    def GetCellData(self) -> Any: ...
class _Workplane(Protocol):
    def vals(self) -> Any: ...
class _Shape(Protocol):
    def exportStep(self, name: str, /) -> Any: ...

Tets = Mesh | _OfMeshio | _OfVtk
Body = Surface | Tets | _OfTrimesh | _Workplane | _Shape
Input = Body | Path | Sequence[Path] | Mapping[str, Body | Path] | SizeFunction

class Checked:
    text: str
    def __bool__(self) -> bool: ...
    def __getattr__(self, name: str) -> Any: ...

def mesh(points: npt.ArrayLike | Input, triangles: npt.ArrayLike | None = None, *,
{mesh}) -> Mesh: ...
def mesh_file(path: Path, *,
{mesh}) -> Mesh: ...
def mesh_image(image: npt.ArrayLike | Path | Sequence[Path], affine: npt.ArrayLike | None = None, *,
    spacing: npt.ArrayLike | None = None,
{mesh}) -> Mesh: ...
def image_surface(image: npt.ArrayLike | Path | Sequence[Path], affine: npt.ArrayLike | None = None, *,
{of_images},
    progress: Progress | None = None,
    threads: int = 0) -> Surface: ...
def surface(points: npt.ArrayLike | Input, triangles: npt.ArrayLike | None = None, *,
{surface}) -> Surface: ...
def size_field(points: npt.ArrayLike | Input, triangles: npt.ArrayLike | None = None, *,
{size}) -> SizeField: ...
def improve(mesh: Tets | Path, *, surface: Body | Path | None = None,
    fields: Mapping[str, npt.ArrayLike] | None = None,
{improve}) -> Mesh: ...
def carry(old: Tets | Path, new: Tets | Path, fields: Mapping[str, npt.ArrayLike], *,
{carry}) -> CarriedFields: ...
def move(mesh: Tets | Path, displacement: npt.ArrayLike, *, fields: Mapping[str, npt.ArrayLike] | None = None,
{move}) -> Mesh: ...
@overload
def adapt(mesh: Tets | Path, *, sizes: npt.ArrayLike | None = None, metric: npt.ArrayLike | None = None,
    fields: Mapping[str, npt.ArrayLike] | None = None,
    surface: Body | Path | tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    level_sets: Mapping[str, npt.ArrayLike | tuple[npt.ArrayLike, float]] | None = None,
{adapt}) -> Mesh: ...
@overload
def adapt(mesh: Surface, *, sizes: npt.ArrayLike | None = None, metric: npt.ArrayLike | None = None,
    surface: Body | Path | tuple[npt.ArrayLike, npt.ArrayLike] | None = None, **keywords: Any) -> Surface: ...
def picture(what: Body | Mesh | Path, path: Path | None = None, *,
            color: Literal["quality", "region", "size", "patch", "none"] | None = None,
            cut: str | Sequence[float] | None = None, edges: Literal["elements", "features", "none"] | None = None,
            view: str | Sequence[float] | None = None, up: str | Sequence[float] | None = None,
            highlight: str | Sequence[str] = (), names: bool = False, worst: bool = False,
            size: tuple[int, int] = (1200, 900), bare: bool = False, title: str = "", unit: str = "",
            progress: Progress | None = None, threads: int = 0) -> bytes: ...
def repair(points: npt.ArrayLike | Body, triangles: npt.ArrayLike | None = None) -> Surface: ...
def mend(points: npt.ArrayLike | Body, triangles: npt.ArrayLike | None = None, *,
         tolerance: float | None = None, way: Literal["auto", "wrap"] = "auto", distance: float | None = None,
         progress: Progress | None = None, threads: int = 0) -> Surface: ...
def complex_of_walls(points: npt.ArrayLike | Body, triangles: npt.ArrayLike | None = None, *,
                     regions: Mapping[str, npt.ArrayLike] | None = None, voids: npt.ArrayLike | None = None,
                     cells: Literal["auto", "regions", "merge"] = "auto",
                     nested: Literal["auto", "cavity", "region"] = "auto",
                     progress: Progress | None = None, threads: int = 0) -> Surface: ...
def join_bodies(bodies: Mapping[str, Body | Path], *,
                regions: Mapping[str, npt.ArrayLike] | None = None, voids: npt.ArrayLike | None = None,
                cells: Literal["auto", "regions", "merge"] = "auto",
                overlap: Literal["auto", "first", "later", "new", "regions"] = "auto", tolerance: float | None = None,
                progress: Progress | None = None, threads: int = 0) -> Surface: ...
def check(what: npt.ArrayLike | Body | Path, triangles: npt.ArrayLike | None = None, *,
          solver: Literal["abaqus", "ansys", "nastran", "calculix"] | None = None) -> Checked: ...
def read(path: Path) -> Mesh | Surface: ...
def formats() -> list[dict[str, Any]]: ...
'''

FURTHER = {
    "sheet": "Path | Sequence[Path] | Mapping[str, Any] | None = None",
    "wire": "Path | Sequence[Path] | Mapping[str, Any] | None = None",
    "inner_points": "Path | Sequence[Path] | Mapping[str, Any] | None = None",
    "region": "Mapping[str, npt.ArrayLike] | None = None", "void": "npt.ArrayLike | None = None",
    "labels": "Mapping[int, str] | Path | None = None", "ignore": "Sequence[int] | int | None = None",
    "merge": "Mapping[str, Sequence[int]] | None = None", "iso": "float | None = None",
    "bands": "Mapping[str, tuple[float | None, float | None]] | None = None",
    "surface_of": "Mapping[str | int, Path | Sequence[Path]] | None = None",
    "crop": "Sequence[Sequence[int | None]] | None = None", "resample": "float | Sequence[float] | None = None",
    "box": "str | npt.ArrayLike = ''",
    "regions": "Places | None = None", "point_sizes": "npt.ArrayLike | Path | None = None",
    "group": "Mapping[str, str] | None = None",
    "size_of": "Mapping[str, float] | None = None", 
    "size_near": "Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None",
    "size_field": "SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None",
    "unit": "str | None = None", "after_pass": "Callable[[str, dict[str, Any]], object] | None = None", "progress": "Progress | None = None",
    "threads": "int = 0", "comm": "Any = None", "only": "str | Sequence[str] = ''",
    "keep": "str | Sequence[str] = ''",
}
OF_IMAGES = """\
    spacing: npt.ArrayLike | None = None,
    series: int = 0,
    kind: Literal["auto", "labels", "grey"] = "auto",
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    islands: float | None = None,
    holes: float | None = None,
    specks: float | None = None,
    contacts: float | str | None = None,
    close_voxels: int | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    closed_at_box: bool = True,
    size: float | None = None"""
KINDS = {"number": "float", "whole": "int", "flag": "bool", "text": "str"}


def declared(row):
    kind = f"Literal[{', '.join(map(repr, row['choices']))}]" if row["kind"] == "choice" else KINDS[row["kind"]]
    if row["name"] in lengths():
        kind += " | str"
    if row["name"] == "size":
        kind += " | SizeFunction | SizeField"
    return f"{kind} | None = None" if row["default"] is None else f"{kind} = {row['default']!r}"


def keywords(task):
    table = {row["name"]: declared(row) for row in option_table() + intake_table()}
    lines = [f"    {name}: {FURTHER.get(name) or table[name]}" for name in keywords_of(task)]
    return ",\n".join(lines)


def stubs():
    text = TEMPLATE.replace("{of_images}", OF_IMAGES)
    for task in ("mesh", "surface", "size", "improve", "adapt", "carry", "move"):
        text = text.replace("{" + task + "}", keywords(task))
    return text


def main():
    file = pathlib.Path(sys.argv[-1])
    if "--check" in sys.argv:
        return 0 if file.read_text() == stubs() else f"{file} is old: run python/backend/make_stubs.py {file}"
    file.write_text(stubs())
    return 0


if __name__ == "__main__":
    sys.exit(main())
