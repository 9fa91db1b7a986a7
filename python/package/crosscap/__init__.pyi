from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator

from . import laws as laws

__all__ = [
    "ComparedRun",
    "Decomposition",
    "Embedding",
    "Findings",
    "Homology",
    "LocalDimension",
    "Mesh",
    "Piece",
    "Place",
    "Reason",
    "Refusal",
    "RefusalWarning",
    "Sample",
    "SurfaceReconstruction",
    "__version__",
    "check",
    "compare",
    "dimension",
    "homology",
    "isomap",
    "laws",
    "read_mesh",
    "read_points",
    "sample",
    "surfaces",
    "write_mesh",
]

__version__: str

_Floats: TypeAlias = NDArray[np.float64]
_Integers: TypeAlias = NDArray[np.int64]
_Path: TypeAlias = str | PathLike[str]
# A name, a function of a point and rows, a class or an object with `distances`.
_Metric: TypeAlias = str | Callable[..., Any] | object

class ComparedRun:
    metric: str
    eps: float
    state: Literal["verified", "other-betti", "refused", "failed"]
    betti: list[int] | None
    betti_mod_2: list[int] | None
    vertices: int | None
    triangles: int | None
    distortion: dict[str, float] | None
    reason: str | None
    plugins: dict[str, str | None] | None
    models: list[str]
    seconds: float | None
    def __init__(
        self,
        metric: str,
        eps: float,
        state: str,
        betti: list[int] | None = None,
        betti_mod_2: list[int] | None = None,
        vertices: int | None = None,
        triangles: int | None = None,
        distortion: dict[str, float] | None = None,
        reason: str | None = None,
        plugins: dict[str, str | None] | None = None,
        models: list[str] = ...,
        seconds: float | None = None,
    ) -> None: ...
    @property
    def works(self) -> bool: ...

class Decomposition:
    strata: Sequence[int]
    labels: Sequence[int] | _Integers
    residual: float
    parameters: int
    center: Sequence[float] | _Floats
    center_offset: float
    cells_at_curve: Sequence[int]
    points: Sequence[Sequence[float]] | _Floats
    def __init__(
        self,
        strata: Sequence[int],
        labels: Sequence[int] | _Integers,
        residual: float,
        parameters: int,
        center: Sequence[float] | _Floats,
        center_offset: float = ...,
        cells_at_curve: Sequence[int] = (),
        points: Sequence[Sequence[float]] | _Floats = (),
    ) -> None: ...

class Embedding(NamedTuple):
    places: _Floats
    residual_variance: float
    components: int

class Homology(NamedTuple):
    betti: tuple[int, ...]
    betti_mod2: tuple[int, ...]
    torsion: tuple[int, ...]
    euler: int

class Findings:
    verified: bool
    reasons: tuple[Reason, ...]
    homology: Homology
    description: str | None
    report: dict[str, Any]
    def __init__(
        self,
        verified: bool,
        reasons: tuple[Reason, ...],
        homology: Homology,
        description: str | None,
        report: dict[str, Any],
    ) -> None: ...

class _Bridges:
    def to_pyvista(self) -> Any: ...
    def to_trimesh(self) -> Any: ...
    def to_meshio(self) -> Any: ...
    def to_open3d(self) -> Any: ...
    def to_gudhi_simplex_tree(self) -> Any: ...
    def to_networkx(self) -> Any: ...

class Mesh(_Bridges):
    vertices: _Floats
    triangles: _Integers
    curve_edges: _Integers
    curve_cells: _Integers
    point_index: _Integers
    triangle_piece: _Integers | None
    metadata: dict[str, Any] | None
    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        curve_edges: ArrayLike | None = None,
        curve_cells: ArrayLike | None = None,
        point_index: ArrayLike | None = None,
        triangle_piece: ArrayLike | None = None,
        metadata: dict[str, Any] | None = None,
    ) -> None: ...
    def places(self) -> _Floats: ...
    def page(
        self, title: str = "mesh", verdict: str | None = None, points: ArrayLike | None = None
    ) -> str: ...

class Piece:
    name: str
    orientable: bool
    genus: int
    boundary_circles: int
    euler: int
    vertices: int
    edges: int
    triangles: int
    area: float
    def __init__(
        self,
        name: str,
        orientable: bool,
        genus: int,
        boundary_circles: int,
        euler: int,
        vertices: int,
        edges: int,
        triangles: int,
        area: float,
    ) -> None: ...

class Place(NamedTuple):
    kind: str
    index: int | tuple[int, int]  # type: ignore[assignment]

class Reason:
    kind: str
    text: str
    count: int
    places: tuple[Place, ...]
    coordinates: tuple[float, ...]
    measure: float | None
    level: str | None
    limit: float | None
    advice: str
    def __init__(
        self,
        kind: str,
        text: str,
        count: int = 1,
        places: tuple[Place, ...] = (),
        coordinates: tuple[float, ...] = (),
        measure: float | None = None,
        level: str | None = None,
        limit: float | None = None,
        advice: str = "",
    ) -> None: ...

class Refusal(RuntimeError):
    reasons: tuple[Reason, ...]
    advice: str
    attempts: list[dict[str, Any]]
    def __init__(
        self,
        reasons: Sequence[Reason],
        advice: str = "",
        attempts: Sequence[dict[str, Any]] = (),
    ) -> None: ...
    @property
    def places(self) -> tuple[Place, ...]: ...

class RefusalWarning(UserWarning): ...

class Sample:
    points: _Floats
    boundary: _Integers
    betti: tuple[int, ...]
    name: str
    summary: str
    def __init__(
        self,
        points: _Floats,
        boundary: _Integers,
        betti: tuple[int, ...],
        name: str,
        summary: str,
    ) -> None: ...

class LocalDimension(BaseEstimator):
    estimator: str
    eps: float | None
    n_neighbors: int
    dt: float
    n_jobs: int | None
    dimension_: _Integers
    value_: _Floats
    confidence_: _Floats
    n_features_in_: int
    def __init__(
        self,
        estimator: str = "pca",
        *,
        eps: float | None = None,
        n_neighbors: int = 50,
        dt: float = 0.05,
        n_jobs: int | None = None,
    ) -> None: ...
    def fit(self, X: ArrayLike, y: object = None) -> LocalDimension: ...

class SurfaceReconstruction(_Bridges, BaseEstimator):
    vertices_: _Floats
    triangles_: _Integers
    curve_edges_: _Integers
    curve_cells_: _Integers
    point_index_: _Integers
    mesh_: Mesh
    pieces_: tuple[Piece, ...]
    description_: str | None
    betti_: tuple[int, ...]
    betti_mod2_: tuple[int, ...]
    torsion_: tuple[int, ...]
    verdict_: Literal["verified", "refused"]
    refusal_: Refusal | None
    certificate_: dict[str, Any]
    report_: dict[str, Any]
    eps_: float
    dl_: float
    n_features_in_: int
    def __init__(
        self,
        eps: float | Literal["auto"] = "auto",
        dl: float | Literal["auto"] = "auto",
        *,
        tri_eps: float | None = None,
        dt: float | None = None,
        dp: float | None = None,
        ep: float | None = None,
        models: Any = "auto",
        metric: _Metric = "euclidean",
        tri_metric: _Metric | None = None,
        neighborhoods: str | None = None,
        estimator: Any = "pca",
        boundary: ArrayLike | None = None,
        surface: bool = False,
        method: str = "cells",
        prepare: bool | None = None,
        least_hole: float | None = None,
        tries: int = 7,
        time_limit: float | None = None,
        on_refusal: Literal["raise", "warn", "ignore"] = "raise",
        random_state: Any = 0,
        n_jobs: int | None = None,
        verbose: bool = False,
    ) -> None: ...
    # Points, or distances that may be sparse.
    def fit(self, X: Any, y: object = None) -> SurfaceReconstruction: ...

def check(
    mesh: Mesh,
    points: ArrayLike | None = None,
    *,
    dl: float | None = None,
    closed: bool = False,
    prepare: bool | None = None,
    least_hole: float | None = None,
) -> Findings: ...
def compare(
    points: ArrayLike,
    radii: Sequence[float],
    dl: float,
    *,
    metrics: Sequence[_Metric] = ...,
    **settings: Any,
) -> list[ComparedRun]: ...
def dimension(points: ArrayLike, estimator: str = "pca", **parameters: Any) -> _Integers: ...
def homology(mesh: Mesh) -> Homology: ...
def isomap(mesh: Mesh, dimension: int = 3, *, landmarks: int = 300) -> Embedding: ...
def read_mesh(path: _Path) -> Mesh: ...
def read_points(
    path: _Path, *, array: str | None = None, transpose: bool = False, columns: str | None = None
) -> _Floats: ...
def sample(
    surface: str,
    n: int | None = None,
    *,
    random_state: int = 0,
    thin: float | None = None,
    noise: float = 0.0,
    boundary: bool = False,
) -> Sample: ...
def surfaces() -> dict[str, str]: ...
def write_mesh(path: _Path, mesh: Mesh) -> None: ...
