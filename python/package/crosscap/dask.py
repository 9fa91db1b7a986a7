"""Clouds that one machine does not hold, on the workers of a cluster of Dask.

A cloud is cut into tiles, each with a halo of the points around it, and every step asks the tiles: no step holds all points. What comes
out is the same as of the cloud in memory, to the last bit, whatever the tiles are and however many workers there are. A worker that is
lost is replaced by Dask, which makes its tiles anew.

Needs the library ``distributed``. :mod:`crosscap.tiles` does the same on one machine without it.
"""

from . import _holders, _tiled

__all__ = ["local_dimension", "reconstruct"]


def _holder(client):
    from distributed import default_client

    return _holders.There(default_client() if client is None else client)


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
    client=None,
    verbose=False,
):
    """Reconstruct a surface that may cross itself from points that workers hold.

    In one place there are the landmarks and their mesh, the 200,000 points that the certificate looks at one by one, the points about
    curves and boundaries, and four bytes for every point.

    Parameters
    ----------
    points : dask array, path, memmap or array of shape (n_points, n_dimensions)
        The points: an array of Dask, in chunks of rows; the path of an ``.npy``, ``.parquet`` or ``.h5`` file, or of a folder of them, chunks in
        the order of their names, which all workers can read (pyarrow and h5py read the latter two); a memory-mapped array, likewise. No two points at one place.
    eps, dl, tri_eps, surface, random_state, on_refusal, verbose
        As in :class:`crosscap.SurfaceReconstruction`. Lengths have to be given.
    models : sequence of str, optional
        Names of models, such as ``["two-planes", "boundary"]``; with ``surface`` those of boundaries alone are asked. A model of your own is not taken.
    tiles : int, optional
        Number of tiles; by the size of the cloud when left out. It changes no result.
    client : distributed.Client, optional
        Whose workers; the one that was made last when left out.

    Returns
    -------
    SurfaceReconstruction
        As it is after ``fit`` on the same points with ``prepare=False``. The advice of a refusal is told by the certificate
        alone.

    Raises
    ------
    Refusal
        There is no mesh that may be handed over as good, or points are so sparse somewhere that a neighborhood may reach beyond
        the halo of its tile.
    ValueError
        A parameter or the points make no sense.
    """
    return _tiled.reconstruct(
        _holder(client),
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


def local_dimension(points, eps, estimator="pca", *, dt=0.05, tiles=None, client=None):
    """The dimension at every point of a cloud that workers hold.

    In one place there are three numbers a point, those of the answer.

    Parameters
    ----------
    points, tiles, client
        As in :func:`reconstruct`; points may be at one place.
    eps, estimator, dt
        As in :class:`crosscap.LocalDimension`.

    Returns
    -------
    LocalDimension
        As it is after ``fit`` on the same points.

    Raises
    ------
    ValueError
        A parameter or the points make no sense, or no point has enough others near it.
    """
    return _tiled.local_dimension(_holder(client), points, eps, estimator, dt=dt, tiles=tiles)
