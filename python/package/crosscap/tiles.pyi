from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal

from . import LocalDimension, SurfaceReconstruction

__all__ = ["local_dimension", "reconstruct"]

def reconstruct(
    points: Any,
    eps: float,
    dl: float,
    *,
    surface: bool = False,
    models: Sequence[str] = ("two-planes",),
    tri_eps: float | None = None,
    tiles: int | None = None,
    random_state: Any = 0,
    on_refusal: Literal["raise", "warn", "ignore"] = "raise",
    n_jobs: int | None = None,
    folder: str | PathLike[str] | None = None,
    verbose: bool = False,
) -> SurfaceReconstruction: ...
def local_dimension(
    points: Any,
    eps: float,
    estimator: str = "pca",
    *,
    dt: float = 0.05,
    tiles: int | None = None,
    n_jobs: int | None = None,
    folder: str | PathLike[str] | None = None,
) -> LocalDimension: ...
