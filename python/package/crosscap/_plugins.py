"""Metrics and estimators written in Python, in the one form that the extension module calls."""

import math
from dataclasses import dataclass
from numbers import Real

import numpy as np


def _name(plugin):
    name = getattr(plugin, "name", None)
    if isinstance(name, str):
        return name
    return getattr(plugin, "__name__", type(plugin).__name__)


def is_metric(plugin):
    """Whether this is a metric, or a class of metrics."""
    return callable(getattr(plugin, "distances", None))


def is_estimator(plugin):
    """Whether this is a dimension estimator, or a class of them."""
    return callable(getattr(plugin, "estimate", None))


def metric(plugin):
    """What builds a metric over an array of points: its name, and distances by rows.

    ``plugin`` is a class whose instances are made of the points and have ``distances(i, rows)``,
    such an instance, or a function of a point and an array of points.
    """
    if not (is_metric(plugin) or callable(plugin)):
        raise ValueError(
            f"metric is {plugin!r}, expected a name, a function of a point and an array of points, "
            "or something with distances(i, rows)"
        )

    def over(points):
        points.flags.writeable = False
        if is_metric(plugin):
            ask = (plugin(points) if isinstance(plugin, type) else plugin).distances
        else:

            def ask(i, rows):
                return plugin(points[i], points[rows])

        def distances(i, rows):
            return np.ascontiguousarray(ask(i, rows), dtype=np.float64)

        return _name(plugin), distances

    return over


def estimator(plugin):
    """Name of an estimator, and the function from a neighborhood to dimension, value, confidence."""
    if isinstance(plugin, type):
        plugin = plugin()
    if not (is_estimator(plugin) or callable(plugin)):
        raise ValueError(
            f"estimator is {plugin!r}, expected a name, or something with "
            "estimate(points, distances, radius)"
        )
    ask = plugin.estimate if is_estimator(plugin) else plugin

    def estimate(points, distances, radius):
        return _decided(ask(points, distances, radius))

    return _name(plugin), estimate


def _decided(told):
    if told is None:
        return None
    if isinstance(told, Real):
        value = float(told)
        if not math.isfinite(value) or value < 0:
            raise ValueError(f"a dimension of {value}, expected a finite number of at least 0")
        dimension = math.floor(value + 0.5)
        return dimension, value, 1 - 2 * abs(value - dimension)
    dimension, value, confidence = told
    return int(dimension), float(value), float(confidence)


@dataclass(frozen=True)
class Decomposition:
    """A neighborhood cut into strata, as a singularity model returns it.

    Attributes
    ----------
    strata : sequence of int
        Dimensions of the strata, in rising order: 0 a point, 1 a curve, 2 a cell, an open piece of surface
        that no curve runs through.
    labels : sequence of int
        For each point of the neighborhood the stratum that it is in.
    residual : float
        Root mean squared distance of the fitted points to the model, in the unit of the data.
    parameters : int
        Number of free parameters of the fit.
    center : sequence of float
        The center moved onto its stratum; a center in a cell onto the first curve, where there is one.
    center_offset : float, default=inf
        Distance of the center to that place; infinite for a center in a cell that tells nothing about a curve.
    cells_at_curve : sequence of int, default=()
        For each curve the number of cells that meet in it.
    points : sequence of sequence of float, default=()
        Places of the strata of dimension 0.
    """

    strata: object
    labels: object
    residual: float
    parameters: int
    center: object
    center_offset: float = math.inf
    cells_at_curve: object = ()
    points: object = ()


@dataclass(frozen=True)
class _Model:
    name: str
    local_dimension: int
    finds_boundary: bool
    applies_to: list
    decompose: object


def is_model(plugin):
    """Whether this is a singularity model, or a class of them."""
    return callable(getattr(plugin, "decompose", None))


def model(plugin):
    """What the extension module has to know about a model: its answers as plain lists."""
    if isinstance(plugin, type):
        plugin = plugin()
    if not is_model(plugin):
        raise ValueError(
            f"models has {plugin!r}, expected a name, or something with local_dimension and "
            "decompose(points, fitted, center, radius)"
        )

    def decompose(points, fitted, center, radius):
        told = plugin.decompose(points, fitted, center, radius)
        if told is None:
            return None
        return Decomposition(
            strata=_plain(told.strata, int),
            labels=_plain(told.labels, int),
            residual=float(told.residual),
            parameters=int(told.parameters),
            center=_plain(told.center, float),
            center_offset=float(told.center_offset),
            cells_at_curve=_plain(told.cells_at_curve, int),
            points=[_plain(point, float) for point in told.points],
        )

    # Dimensions beyond what a model works in are never asked about.
    asked = getattr(plugin, "applies_to", lambda dimension: dimension > 2)
    return _Model(
        name=_name(plugin),
        local_dimension=int(plugin.local_dimension),
        finds_boundary=bool(getattr(plugin, "finds_boundary", False)),
        applies_to=[dimension for dimension in range(64) if asked(dimension)],
        decompose=decompose,
    )


def _plain(values, kind):
    return [kind(value) for value in values]
