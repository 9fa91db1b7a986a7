"""The extension module: see the modules of the package for what its functions mean."""

from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

__version__: str

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Mesh = Mapping[str, Any]

def check(
    mesh: _Mesh,
    metadata: str,
    points: _Floats | None,
    known: Mapping[str, Any],
) -> str: ...
def compare(
    points: _Floats,
    settings: Mapping[str, Any],
    comparison: Mapping[str, Any],
    progress: Callable[[str], object] | None,
) -> str: ...
def curves(triangles: _Integers) -> tuple[_Integers, _Integers]: ...
def dimension(
    points: _Floats,
    estimator: str,
    eps: float | None,
    neighbors: int,
    dt: float,
    threads: int,
) -> dict[str, Any]: ...
def homology(mesh: _Mesh) -> str: ...
def isomap(mesh: _Mesh, dimension: int, landmarks: int) -> dict[str, Any]: ...
def laws_of_estimator(
    plugin: tuple[str, Callable[..., Any]], cases: int, seed: int
) -> list[tuple[str, str, str, str]]: ...
def laws_of_metric(
    make: Callable[[_Floats], tuple[str, Callable[..., Any]]], cases: int, seed: int
) -> list[tuple[str, str, str, str]]: ...
def laws_of_model(
    plugin: object, of: str, cases: int, seed: int
) -> list[tuple[str, str, str, str]]: ...
def main(arguments: list[str]) -> int: ...
def page(mesh: _Mesh, title: str, verdict: str, points: _Floats | None) -> str: ...
def random_ranks(count: int, seed: int, barred: NDArray[np.uint32]) -> NDArray[np.uint32]: ...
def read_mesh(path: str | PathLike[str]) -> dict[str, Any]: ...
def read_points(
    path: str | PathLike[str], array: str | None, transpose: bool, columns: str | None
) -> tuple[_Floats, list[str]]: ...
def reconstruct(
    points: _Floats,
    settings: Mapping[str, Any],
    progress: Callable[[str], object] | None,
) -> tuple[dict[str, Any] | None, str | None]: ...
def reconstruct_distances(
    name: str,
    bytes: bytes,
    settings: Mapping[str, Any],
    progress: Callable[[str], object] | None,
) -> tuple[dict[str, Any] | None, str | None]: ...
def reconstruct_tiles(
    points: int,
    dimension: int,
    settings: Mapping[str, Any],
    ask: Callable[[bytes], list[bytes]],
    bar: Callable[[NDArray[np.uint32]], object],
    progress: Callable[[str], object] | None,
) -> tuple[dict[str, Any] | None, str | None]: ...
def sample(
    surface: str,
    count: int | None,
    seed: int,
    thinning: float | None,
    noise: float,
    boundary: bool,
) -> dict[str, Any]: ...
def surfaces() -> list[tuple[str, str]]: ...
def tile_answer(
    tiling: bytes,
    tile: int,
    halo: float,
    points: _Floats,
    rows: NDArray[np.uint32],
    ranks: NDArray[np.uint32],
    question: bytes,
) -> bytes: ...
def tile_dimension(
    tiling: bytes, tile: int, points: _Floats, estimator: str, eps: float, dt: float
) -> dict[str, Any]: ...
def tile_halo(settings: Mapping[str, Any]) -> float: ...
def tile_members(tiling: bytes, points: _Floats, halo: float) -> list[_Integers]: ...
def tiling(sample: _Floats, tiles: int) -> tuple[bytes, int]: ...
def write_mesh(
    path: str | PathLike[str],
    mesh: _Mesh,
    triangle_piece: list[int] | None,
    metadata: str,
) -> None: ...
