"""How many dimensions points have."""

import joblib
import numpy as np
from sklearn.base import BaseEstimator
from sklearn.utils.validation import validate_data

from . import _crosscap

ESTIMATORS = ("pca", "mle", "correlation", "packing", "spanning-tree")


class LocalDimension(BaseEstimator):
    """The dimension at every point of a cloud, from its neighborhood.

    Parameters
    ----------
    estimator : {"pca", "mle", "correlation", "packing", "spanning-tree"}, default="pca"
        Principal components (Martin and Watson), maximum likelihood (Levina and Bickel), correlation
        dimension (Grassberger and Procaccia), packing numbers (Kegl) or geodesic minimum spanning
        trees (Costa and Hero).
    eps : float, optional
        Radius of the neighborhoods, unit of the data.
    n_neighbors : int, default=50
        Number of nearest other points, where there is no radius.
    dt : float, default=0.05
        Tolerance of ``"pca"``: the share of the variance that may be left over.
    n_jobs : int, optional
        Number of threads, as scikit-learn counts them. It changes no result.

    Attributes
    ----------
    dimension_ : ndarray of shape (n_points,)
        The dimension at every point, -1 where the neighborhood holds too few points.
    value_ : ndarray of shape (n_points,)
        The same before rounding.
    confidence_ : ndarray of shape (n_points,)
        How far the decision was from falling otherwise, 0 to 1.
    n_features_in_ : int
        Number of coordinates of the points.

    Examples
    --------
    >>> import crosscap, numpy
    >>> cloud = crosscap.sample("torus", 3000)
    >>> found = crosscap.LocalDimension().fit(cloud.points)
    >>> int(numpy.median(found.dimension_))
    2
    """

    def __init__(self, estimator="pca", *, eps=None, n_neighbors=50, dt=0.05, n_jobs=None):
        self.estimator = estimator
        self.eps = eps
        self.n_neighbors = n_neighbors
        self.dt = dt
        self.n_jobs = n_jobs

    def fit(self, X, y=None):
        """Estimate the dimension at every row of ``X``.

        Parameters
        ----------
        X : array-like of shape (n_points, n_dimensions)
            The points.
        y : ignored

        Returns
        -------
        LocalDimension
            Itself.
        """
        X = validate_data(self, X, dtype=np.float64, order="C", ensure_min_samples=2)
        found = _crosscap.dimension(
            X,
            self.estimator,
            self.eps,
            min(self.n_neighbors, len(X) - 1),
            self.dt,
            joblib.effective_n_jobs(self.n_jobs),
        )
        self.dimension_ = found["dimension"]
        self.value_ = found["value"]
        self.confidence_ = found["confidence"]
        return self


def dimension(points, estimator="pca", **parameters):
    """The dimension at every point: :class:`LocalDimension` as a function.

    Parameters
    ----------
    points : array-like of shape (n_points, n_dimensions)
        The points.
    estimator : str, default="pca"
        As in :class:`LocalDimension`.
    **parameters
        As in :class:`LocalDimension`.

    Returns
    -------
    ndarray of shape (n_points,)
        The dimensions, -1 where a neighborhood holds too few points.

    Examples
    --------
    >>> import crosscap, numpy
    >>> line = numpy.outer(numpy.arange(100.0), [1.0, 2.0, 3.0])
    >>> int(crosscap.dimension(line, "mle", n_neighbors=10)[50])
    1
    """
    return LocalDimension(estimator, **parameters).fit(points).dimension_
