"""Clouds that do not fit in memory, on one machine.

What :mod:`crosscap.dask` does on a cluster, with tiles in a folder: in memory are the tiles that threads work on.

>>> import crosscap
>>> import crosscap.tiles
>>> cloud = crosscap.sample("torus", 3000)
>>> surface = crosscap.tiles.reconstruct(cloud.points, 0.6, 0.3, surface=True, tiles=4)
>>> surface.betti_
(1, 2, 1)
"""

import joblib

from . import _holders, _tiled

__all__ = ["local_dimension", "reconstruct"]


def reconstruct(
    points,
    eps,
    dl,
    *,
    surface=False,
    models=("two-planes",),
    tri_eps=None,
    tiles=None,
    random_state=0,
    on_refusal="raise",
    n_jobs=None,
    folder=None,
    verbose=False,
):
    """Reconstruct a surface that may cross itself from points in files.

    Parameters
    ----------
    points : path, memmap, array or dask array of shape (n_points, n_dimensions)
        The points, as :func:`crosscap.dask.reconstruct` takes them.
    eps, dl, tri_eps, surface, models, random_state, on_refusal, verbose
        As there.
    tiles : int, optional
        Number of tiles; by the size of the cloud when left out. It changes no result.
    n_jobs : int, optional
        Number of threads, each of which works on a tile, as scikit-learn counts them. It changes no result.
    folder : path, optional
        Where a folder for the tiles is made, about as large as the cloud; among temporary files when left out. It is removed at the end.

    Returns
    -------
    SurfaceReconstruction
        As it is after ``fit`` on the same points with ``prepare=False``. The advice of a refusal is told by the certificate
        alone.
    """
    return _tiled.reconstruct(
        _holders.Here(joblib.effective_n_jobs(n_jobs), folder),
        points,
        eps,
        dl,
        surface=surface,
        models=models,
        tri_eps=tri_eps,
        tiles=tiles,
        random_state=random_state,
        on_refusal=on_refusal,
        verbose=verbose,
    )


def local_dimension(points, eps, estimator="pca", *, dt=0.05, tiles=None, n_jobs=None, folder=None):
    """The dimension at every point of a cloud in files.

    Parameters
    ----------
    points, tiles, n_jobs, folder
        As in :func:`reconstruct`; points may be at one place.
    eps, estimator, dt
        As in :class:`crosscap.LocalDimension`.

    Returns
    -------
    LocalDimension
        As it is after ``fit`` on the same points.

    Examples
    --------
    >>> import crosscap
    >>> import crosscap.tiles
    >>> cloud = crosscap.sample("torus", 2000)
    >>> found = crosscap.tiles.local_dimension(cloud.points, 0.7, "mle", tiles=3)
    >>> found.dimension_.shape
    (2000,)
    """
    holder = _holders.Here(joblib.effective_n_jobs(n_jobs), folder)
    return _tiled.local_dimension(holder, points, eps, estimator, dt=dt, tiles=tiles)
