"""Points on surfaces whose topology is known, and points from files."""

import warnings
from dataclasses import dataclass
from os import fspath

import numpy as np

from . import _crosscap, _stores


@dataclass(frozen=True, eq=False)
class Sample:
    """Points drawn from a surface whose topology is known.

    Attributes
    ----------
    points : ndarray of shape (n_points, n_dimensions)
        The points.
    boundary : ndarray of shape (n_boundary,)
        Rows of points on the boundary, where they were asked for.
    betti : tuple of int
        True Betti numbers over the rational numbers.
    name : str
        Name of the surface.
    summary : str
        What it is.
    """

    points: np.ndarray
    boundary: np.ndarray
    betti: tuple
    name: str
    summary: str

    def __repr__(self):
        count, dimension = self.points.shape
        return f"<{self.name}: {count} points in R^{dimension}, Betti numbers {self.betti}>"


def sample(surface, n=None, *, random_state=0, thin=None, noise=0.0, boundary=False):
    """Draw points from a surface of the catalogue, uniformly by area.

    Parameters
    ----------
    surface : str
        Name of the surface, with ``-`` or ``_``: see :func:`surfaces`.
    n : int, optional
        Number of points drawn, before thinning. That of the surface when left out.
    random_state : int, default=0
        Seed. The same seed gives the same points on every machine.
    thin : float, optional
        Least distance of two points that are kept, unit of the surface.
    noise : float, default=0.0
        Standard deviation of normal noise in every coordinate.
    boundary : bool, default=False
        Whether to add points that are exactly on the boundary, and to tell their rows.

    Returns
    -------
    Sample
        The points, with what is known about the surface.

    Examples
    --------
    >>> import crosscap
    >>> crosscap.sample("two-spheres", 5000)
    <two_spheres: 5000 points in R^3, Betti numbers (1, 0, 3)>
    """
    drawn = _crosscap.sample(surface, n, random_state, thin, float(noise), boundary)
    return Sample(**{**drawn, "betti": tuple(drawn["betti"])})


def surfaces():
    """Names of the surfaces of the catalogue, each with what it is.

    Returns
    -------
    dict of str to str

    Examples
    --------
    >>> import crosscap
    >>> "klein_r5" in crosscap.surfaces()
    True
    """
    return dict(_crosscap.surfaces())


def read_points(path, *, array=None, transpose=False, columns=None):
    """Read points from a file, one point a row; the extension names the format.

    Those of the command line, and ``.parquet`` and ``.h5`` (``.hdf5``) where pyarrow and h5py are installed
    (``pip install crosscap[files]``).

    Parameters
    ----------
    path : str or path-like
        The file.
    array : str, optional
        Which array of a ``.npz``, which variable of a ``.mat``, which dataset of a ``.h5``.
    transpose : bool, default=False
        Whether the points are the columns.
    columns : str, optional
        Which columns are coordinates: numbers (from 0), ranges and names between commas, or ``"all"``. When left
        out, columns that are named x, y, z, else all that are no normals and colors; a warning tells what
        looks doubtful.

    Returns
    -------
    ndarray of shape (n_points, n_dimensions)

    Raises
    ------
    ValueError
        With file, line or row, what was found and what was expected.
    ImportError
        With the library that this format needs.

    Examples
    --------
    >>> import crosscap, numpy, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "points.npy")
    >>> numpy.save(path, numpy.eye(3))
    >>> crosscap.read_points(path).shape
    (3, 3)
    """
    if _stores.is_store(path):
        return _stores.read(path, array=array, transpose=transpose, columns=columns)
    points, remarks = _crosscap.read_points(fspath(path), array, transpose, columns)
    for remark in remarks:
        warnings.warn(remark, stacklevel=2)
    return points
