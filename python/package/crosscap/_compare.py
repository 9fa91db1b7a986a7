"""Which metric works up to which radius."""

import json
from dataclasses import dataclass, field

import numpy as np

from . import _crosscap, _plugins
from ._reconstruction import SurfaceReconstruction, _progress_of


@dataclass(frozen=True)
class ComparedRun:
    """One metric at one radius.

    Attributes
    ----------
    metric : str
        Metric of analysis and charts.
    eps : float
        Radius of analysis and charts.
    state : {"verified", "other-betti", "refused", "failed"}
        How it ended.
    betti, betti_mod_2 : list of int or None
        Betti numbers of the mesh, where there is one.
    vertices, triangles : int or None
        Numbers of them.
    distortion : dict or None
        What the charts lose, mean and largest.
    reason : str or None
        Why there is no verified mesh, or what speaks against one that is verified.
    plugins : dict or None
        What worked on the points, by the names that the plug-ins give themselves; None where there is no mesh.
    models : list of str
        The singularity models that took part, by their own names.
    seconds : float
        Time on one thread.
    """

    metric: str
    eps: float
    state: str
    betti: list | None = None
    betti_mod_2: list | None = None
    vertices: int | None = None
    triangles: int | None = None
    distortion: dict | None = field(default=None, repr=False)
    reason: str | None = None
    plugins: dict | None = field(default=None, repr=False)
    models: list = field(default_factory=list, repr=False)
    seconds: float | None = field(default=None, repr=False)

    @property
    def works(self):
        """Whether it gave a verified mesh, and not with Betti numbers known to be wrong."""
        return self.state == "verified"


def compare(points, radii, dl, *, metrics=("euclidean", "geodesic", "lifted"), **settings):
    """Reconstruct with several metrics at several radii: which one works up to which radius.

    The radius of a run is that of the neighborhoods and of the charts.

    Parameters
    ----------
    points : array-like of shape (n_points, n_dimensions)
        The points.
    radii : sequence of float
        The radii.
    dl : float
        Separation of the landmarks.
    metrics : sequence of str and metrics of your own
        The metrics: see :class:`SurfaceReconstruction`.
    **settings
        ``analysis_eps``, a radius of the neighborhoods that is not to be that of the charts; ``betti``, Betti numbers
        that the surface is known to have; and parameters of :class:`SurfaceReconstruction`. Runs are shared among
        ``n_jobs`` threads.

    Returns
    -------
    list of ComparedRun
        By metric, then by radius.

    Examples
    --------
    >>> import crosscap, numpy
    >>> points = crosscap.sample("sphere", 800).points
    >>> def angle(x, rows):
    ...     return 2 * numpy.arcsin(numpy.minimum(numpy.linalg.norm(rows - x, axis=1) / 2, 1))
    >>> runs = crosscap.compare(points, [0.9], 0.35, metrics=["euclidean", angle], surface=True)
    >>> [(run.metric, run.works) for run in runs]
    [('euclidean', True), ('angle', True)]
    """
    comparison = {
        "analysis_eps": settings.pop("analysis_eps", None),
        "betti": settings.pop("betti", None),
        "metrics": [_named(metric) for metric in metrics],
        "radii": [float(radius) for radius in radii],
        "dl": float(dl),
    }
    base = SurfaceReconstruction(**settings)
    points = np.ascontiguousarray(points, dtype=np.float64)
    count = len(comparison["metrics"]) * len(comparison["radii"])
    with _progress_of(base.verbose, count, "runs") as bar:
        done = None if bar is None else bar.update
        told = _crosscap.compare(points, base._settings(), comparison, done)
    return [ComparedRun(**run) for run in json.loads(told)]


def _named(metric):
    if isinstance(metric, str):
        return metric, metric
    return _plugins._name(metric), _plugins.metric(metric)
