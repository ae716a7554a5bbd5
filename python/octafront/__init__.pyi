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
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    keep_surface: bool = False,
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    normal_deviation: float | None = None,
    strips: Literal['fine', 'off'] = 'fine',
    patches: bool = False,
    keep_volumes: bool = False,
    volume_tolerance: float | None = None,
    periodic: str = '',
    layers: int = 0,
    first: float | str | None = None,
    first_part: float | None = None,
    growth: float | None = None,
    total: float | str | None = None,
    yplus: float | None = None,
    Re: float | None = None,
    Lref: float | str | None = None,
    speed: float | None = None,
    fluid: str = 'air',
    on: str = '',
    layers_in: str = '',
    layers_outside: bool = False,
    layers_as_tets: bool = False,
    require_coverage: float | None = None,
    method: Literal['octree-aft', 'aft', 'octree', 'recover'] = 'octree-aft',
    ideal_distance: float = 0.75,
    core: Literal['lattice', 'none'] = 'lattice',
    ranking: Literal['solid-angle', 'quality'] = 'solid-angle',
    queue: Literal['layers', 'smallest', 'newest'] = 'layers',
    shell: int = 0,
    improve: Literal['none', 'paper', 'fast', 'default', 'best'] = 'default',
    objective: Literal['balanced', 'beta', 'min-dihedral', 'max-dihedral', 'mean-ratio', 'solver'] = 'balanced',
    relaxation: float = 0.7,
    sweeps: int = 4,
    fix_boundary: bool = False,
    improve_time: float | None = None,
    order: int = 1,
    split: str = '',
    no_bridging: bool = False,
    require_volume: float | None = None,
    require_angle: float | None = None,
    require_size: float | None = None,
    cells: Literal['auto', 'regions', 'merge'] = 'auto',
    nested: Literal['direction', 'cavity', 'region'] = 'direction',
    overlap: Literal['auto', 'first', 'later', 'new', 'regions'] = 'auto',
    tolerance: float | None = None,
    contacts: str = '',
    contact: str = '',
    repeat: str | None = None,
    box: str | npt.ArrayLike = '',
    wind_tunnel: str = '',
    repair: Literal['none', 'auto', 'wrap'] = 'auto',
    sheets: Literal['keep', 'drop'] = 'keep',
    wrap_distance: float | None = None,
    series: int = 0,
    kind: Literal['auto', 'labels', 'grey'] = 'auto',
    islands: float = 0.0,
    holes: float = 0.0,
    specks: float | None = None,
    close_voxels: int = 0,
    closed_at_box: bool = True,
    cad_size: float | None = None,
    cad_elements: int | None = None,
    cad_unit: Literal['um', 'mm', 'cm', 'm', 'in', 'ft'] = 'mm',
    keep_edges: bool = False,
    keep_going: bool = False,
    heal: bool = True,
    cad_seconds: float = 300.0,
    cad_memory: float = 8.0,
    cell: float | None = None,
    resolution: int | None = None,
    region: Mapping[str, npt.ArrayLike] | None = None,
    void: npt.ArrayLike | None = None,
    sheet: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    wire: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    inner_points: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    group: Mapping[str, str] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    after_pass: Callable[[str, dict[str, Any]], object] | None = None,
    progress: Progress | None = None,
    threads: int = 0,
    comm: Any = None) -> Mesh: ...
def mesh_file(path: Path, *,
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    keep_surface: bool = False,
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    normal_deviation: float | None = None,
    strips: Literal['fine', 'off'] = 'fine',
    patches: bool = False,
    keep_volumes: bool = False,
    volume_tolerance: float | None = None,
    periodic: str = '',
    layers: int = 0,
    first: float | str | None = None,
    first_part: float | None = None,
    growth: float | None = None,
    total: float | str | None = None,
    yplus: float | None = None,
    Re: float | None = None,
    Lref: float | str | None = None,
    speed: float | None = None,
    fluid: str = 'air',
    on: str = '',
    layers_in: str = '',
    layers_outside: bool = False,
    layers_as_tets: bool = False,
    require_coverage: float | None = None,
    method: Literal['octree-aft', 'aft', 'octree', 'recover'] = 'octree-aft',
    ideal_distance: float = 0.75,
    core: Literal['lattice', 'none'] = 'lattice',
    ranking: Literal['solid-angle', 'quality'] = 'solid-angle',
    queue: Literal['layers', 'smallest', 'newest'] = 'layers',
    shell: int = 0,
    improve: Literal['none', 'paper', 'fast', 'default', 'best'] = 'default',
    objective: Literal['balanced', 'beta', 'min-dihedral', 'max-dihedral', 'mean-ratio', 'solver'] = 'balanced',
    relaxation: float = 0.7,
    sweeps: int = 4,
    fix_boundary: bool = False,
    improve_time: float | None = None,
    order: int = 1,
    split: str = '',
    no_bridging: bool = False,
    require_volume: float | None = None,
    require_angle: float | None = None,
    require_size: float | None = None,
    cells: Literal['auto', 'regions', 'merge'] = 'auto',
    nested: Literal['direction', 'cavity', 'region'] = 'direction',
    overlap: Literal['auto', 'first', 'later', 'new', 'regions'] = 'auto',
    tolerance: float | None = None,
    contacts: str = '',
    contact: str = '',
    repeat: str | None = None,
    box: str | npt.ArrayLike = '',
    wind_tunnel: str = '',
    repair: Literal['none', 'auto', 'wrap'] = 'auto',
    sheets: Literal['keep', 'drop'] = 'keep',
    wrap_distance: float | None = None,
    series: int = 0,
    kind: Literal['auto', 'labels', 'grey'] = 'auto',
    islands: float = 0.0,
    holes: float = 0.0,
    specks: float | None = None,
    close_voxels: int = 0,
    closed_at_box: bool = True,
    cad_size: float | None = None,
    cad_elements: int | None = None,
    cad_unit: Literal['um', 'mm', 'cm', 'm', 'in', 'ft'] = 'mm',
    keep_edges: bool = False,
    keep_going: bool = False,
    heal: bool = True,
    cad_seconds: float = 300.0,
    cad_memory: float = 8.0,
    cell: float | None = None,
    resolution: int | None = None,
    region: Mapping[str, npt.ArrayLike] | None = None,
    void: npt.ArrayLike | None = None,
    sheet: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    wire: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    inner_points: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    group: Mapping[str, str] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    after_pass: Callable[[str, dict[str, Any]], object] | None = None,
    progress: Progress | None = None,
    threads: int = 0,
    comm: Any = None) -> Mesh: ...
def mesh_image(image: npt.ArrayLike | Path | Sequence[Path], affine: npt.ArrayLike | None = None, *,
    spacing: npt.ArrayLike | None = None,
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    keep_surface: bool = False,
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    normal_deviation: float | None = None,
    strips: Literal['fine', 'off'] = 'fine',
    patches: bool = False,
    keep_volumes: bool = False,
    volume_tolerance: float | None = None,
    periodic: str = '',
    layers: int = 0,
    first: float | str | None = None,
    first_part: float | None = None,
    growth: float | None = None,
    total: float | str | None = None,
    yplus: float | None = None,
    Re: float | None = None,
    Lref: float | str | None = None,
    speed: float | None = None,
    fluid: str = 'air',
    on: str = '',
    layers_in: str = '',
    layers_outside: bool = False,
    layers_as_tets: bool = False,
    require_coverage: float | None = None,
    method: Literal['octree-aft', 'aft', 'octree', 'recover'] = 'octree-aft',
    ideal_distance: float = 0.75,
    core: Literal['lattice', 'none'] = 'lattice',
    ranking: Literal['solid-angle', 'quality'] = 'solid-angle',
    queue: Literal['layers', 'smallest', 'newest'] = 'layers',
    shell: int = 0,
    improve: Literal['none', 'paper', 'fast', 'default', 'best'] = 'default',
    objective: Literal['balanced', 'beta', 'min-dihedral', 'max-dihedral', 'mean-ratio', 'solver'] = 'balanced',
    relaxation: float = 0.7,
    sweeps: int = 4,
    fix_boundary: bool = False,
    improve_time: float | None = None,
    order: int = 1,
    split: str = '',
    no_bridging: bool = False,
    require_volume: float | None = None,
    require_angle: float | None = None,
    require_size: float | None = None,
    cells: Literal['auto', 'regions', 'merge'] = 'auto',
    nested: Literal['direction', 'cavity', 'region'] = 'direction',
    overlap: Literal['auto', 'first', 'later', 'new', 'regions'] = 'auto',
    tolerance: float | None = None,
    contacts: str = '',
    contact: str = '',
    repeat: str | None = None,
    box: str | npt.ArrayLike = '',
    wind_tunnel: str = '',
    repair: Literal['none', 'auto', 'wrap'] = 'auto',
    sheets: Literal['keep', 'drop'] = 'keep',
    wrap_distance: float | None = None,
    series: int = 0,
    kind: Literal['auto', 'labels', 'grey'] = 'auto',
    islands: float = 0.0,
    holes: float = 0.0,
    specks: float | None = None,
    close_voxels: int = 0,
    closed_at_box: bool = True,
    cad_size: float | None = None,
    cad_elements: int | None = None,
    cad_unit: Literal['um', 'mm', 'cm', 'm', 'in', 'ft'] = 'mm',
    keep_edges: bool = False,
    keep_going: bool = False,
    heal: bool = True,
    cad_seconds: float = 300.0,
    cad_memory: float = 8.0,
    cell: float | None = None,
    resolution: int | None = None,
    region: Mapping[str, npt.ArrayLike] | None = None,
    void: npt.ArrayLike | None = None,
    sheet: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    wire: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    inner_points: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    group: Mapping[str, str] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    after_pass: Callable[[str, dict[str, Any]], object] | None = None,
    progress: Progress | None = None,
    threads: int = 0,
    comm: Any = None) -> Mesh: ...
def image_surface(image: npt.ArrayLike | Path | Sequence[Path], affine: npt.ArrayLike | None = None, *,
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
    size: float | None = None,
    progress: Progress | None = None,
    threads: int = 0) -> Surface: ...
def surface(points: npt.ArrayLike | Input, triangles: npt.ArrayLike | None = None, *,
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    keep_surface: bool = False,
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    normal_deviation: float | None = None,
    strips: Literal['fine', 'off'] = 'fine',
    patches: bool = False,
    keep_volumes: bool = False,
    periodic: str = '',
    cells: Literal['auto', 'regions', 'merge'] = 'auto',
    nested: Literal['direction', 'cavity', 'region'] = 'direction',
    overlap: Literal['auto', 'first', 'later', 'new', 'regions'] = 'auto',
    tolerance: float | None = None,
    contacts: str = '',
    contact: str = '',
    repeat: str | None = None,
    box: str | npt.ArrayLike = '',
    wind_tunnel: str = '',
    repair: Literal['none', 'auto', 'wrap'] = 'auto',
    sheets: Literal['keep', 'drop'] = 'keep',
    wrap_distance: float | None = None,
    series: int = 0,
    kind: Literal['auto', 'labels', 'grey'] = 'auto',
    islands: float = 0.0,
    holes: float = 0.0,
    specks: float | None = None,
    close_voxels: int = 0,
    closed_at_box: bool = True,
    cad_size: float | None = None,
    cad_elements: int | None = None,
    cad_unit: Literal['um', 'mm', 'cm', 'm', 'in', 'ft'] = 'mm',
    keep_edges: bool = False,
    keep_going: bool = False,
    heal: bool = True,
    cad_seconds: float = 300.0,
    cad_memory: float = 8.0,
    cell: float | None = None,
    resolution: int | None = None,
    region: Mapping[str, npt.ArrayLike] | None = None,
    void: npt.ArrayLike | None = None,
    sheet: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    wire: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    inner_points: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    progress: Progress | None = None,
    threads: int = 0) -> Surface: ...
def size_field(points: npt.ArrayLike | Input, triangles: npt.ArrayLike | None = None, *,
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    keep_surface: bool = False,
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    normal_deviation: float | None = None,
    strips: Literal['fine', 'off'] = 'fine',
    patches: bool = False,
    periodic: str = '',
    cells: Literal['auto', 'regions', 'merge'] = 'auto',
    nested: Literal['direction', 'cavity', 'region'] = 'direction',
    overlap: Literal['auto', 'first', 'later', 'new', 'regions'] = 'auto',
    tolerance: float | None = None,
    contacts: str = '',
    contact: str = '',
    repeat: str | None = None,
    box: str | npt.ArrayLike = '',
    wind_tunnel: str = '',
    repair: Literal['none', 'auto', 'wrap'] = 'auto',
    sheets: Literal['keep', 'drop'] = 'keep',
    wrap_distance: float | None = None,
    series: int = 0,
    kind: Literal['auto', 'labels', 'grey'] = 'auto',
    islands: float = 0.0,
    holes: float = 0.0,
    specks: float | None = None,
    close_voxels: int = 0,
    closed_at_box: bool = True,
    cad_size: float | None = None,
    cad_elements: int | None = None,
    cad_unit: Literal['um', 'mm', 'cm', 'm', 'in', 'ft'] = 'mm',
    keep_edges: bool = False,
    keep_going: bool = False,
    heal: bool = True,
    cad_seconds: float = 300.0,
    cad_memory: float = 8.0,
    cell: float | None = None,
    resolution: int | None = None,
    region: Mapping[str, npt.ArrayLike] | None = None,
    void: npt.ArrayLike | None = None,
    sheet: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    wire: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    inner_points: Path | Sequence[Path] | Mapping[str, Any] | None = None,
    labels: Mapping[int, str] | Path | None = None,
    ignore: Sequence[int] | int | None = None,
    merge: Mapping[str, Sequence[int]] | None = None,
    iso: float | None = None,
    bands: Mapping[str, tuple[float | None, float | None]] | None = None,
    surface_of: Mapping[str | int, Path | Sequence[Path]] | None = None,
    crop: Sequence[Sequence[int | None]] | None = None,
    resample: float | Sequence[float] | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    progress: Progress | None = None,
    threads: int = 0) -> SizeField: ...
def improve(mesh: Tets | Path, *, surface: Body | Path | None = None,
    fields: Mapping[str, npt.ArrayLike] | None = None,
    feature_angle: float | None = None,
    improve: Literal['none', 'paper', 'fast', 'default', 'best'] = 'default',
    objective: Literal['balanced', 'beta', 'min-dihedral', 'max-dihedral', 'mean-ratio', 'solver'] = 'balanced',
    relaxation: float = 0.7,
    sweeps: int = 4,
    fix_boundary: bool = False,
    improve_time: float | None = None,
    order: int = 1,
    no_bridging: bool = False,
    linear_elements: bool = False,
    free_integrals: bool = False,
    quadratic_nodes: bool = False,
    integration_points: str = '',
    require_volume: float | None = None,
    require_angle: float | None = None,
    after_pass: Callable[[str, dict[str, Any]], object] | None = None,
    progress: Progress | None = None,
    threads: int = 0) -> Mesh: ...
def carry(old: Tets | Path, new: Tets | Path, fields: Mapping[str, npt.ArrayLike], *,
    linear_elements: bool = False,
    free_integrals: bool = False,
    quadratic_nodes: bool = False,
    integration_points: str = '',
    progress: Progress | None = None,
    threads: int = 0) -> CarriedFields: ...
def move(mesh: Tets | Path, displacement: npt.ArrayLike, *, fields: Mapping[str, npt.ArrayLike] | None = None,
    size: float | str | SizeFunction | SizeField | None = None,
    linear_elements: bool = False,
    free_integrals: bool = False,
    quadratic_nodes: bool = False,
    integration_points: str = '',
    least_quality: float = 0.2,
    boundary_alone: bool = False,
    remesh: bool = False,
    progress: Progress | None = None,
    threads: int = 0) -> Mesh: ...
@overload
def adapt(mesh: Tets | Path, *, sizes: npt.ArrayLike | None = None, metric: npt.ArrayLike | None = None,
    fields: Mapping[str, npt.ArrayLike] | None = None,
    surface: Body | Path | tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    level_sets: Mapping[str, npt.ArrayLike | tuple[npt.ArrayLike, float]] | None = None,
    size: float | str | SizeFunction | SizeField | None = None,
    elements: int | None = None,
    curvature: float | None = None,
    gap: float | None = None,
    through: float | None = None,
    feature_elements: float | None = None,
    chord_error: float | None = None,
    facets: bool = False,
    min_size: float | str | None = None,
    max_size: float | str | None = None,
    automatic_factor: float = 1.0,
    gradation: float | None = None,
    interior: Literal['uniform', 'graded'] = 'uniform',
    feature_angle: float | None = None,
    max_deviation: float | str | None = None,
    fix_boundary: bool = False,
    no_bridging: bool = False,
    only: str | Sequence[str] = '',
    halo: int = 2,
    keep: str | Sequence[str] = '',
    least_piece: float = 0.0,
    linear_elements: bool = False,
    free_integrals: bool = False,
    quadratic_nodes: bool = False,
    integration_points: str = '',
    require_volume: float | None = None,
    require_angle: float | None = None,
    require_size: float | None = None,
    regions: Places | None = None,
    point_sizes: npt.ArrayLike | Path | None = None,
    size_of: Mapping[str, float] | None = None,
    size_near: Mapping[str | tuple[float, float, float], tuple[float, float]] | None = None,
    size_field: SizeField | Path | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
    unit: str | None = None,
    progress: Progress | None = None,
    threads: int = 0) -> Mesh: ...
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
