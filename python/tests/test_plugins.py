"""Plug-ins written in Python: the same laws, usable in fit."""

import dataclasses

import numpy as np
import pytest

import crosscap
from crosscap.laws import LawBroken, check

SPHERE = {"eps": 0.6, "dl": 0.3, "surface": True}


def straight(x, rows):
    return np.sqrt(((rows - x) ** 2).sum(axis=1))


class Straight:
    """The same as a class."""

    name = "straight"

    def __init__(self, points):
        self.points = points

    def distances(self, i, rows):
        return straight(self.points[i], self.points[rows])


class Directed(Straight):
    def distances(self, i, rows):
        return super().distances(i, rows) * np.where(rows > i, 1.0, 2.0)


class Spread:
    """Counts directions of large variance."""

    def estimate(self, points, distances, radius):
        if len(points) < 4:
            return None
        values = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) ** 2
        return int(np.sum(np.cumsum(values[::-1])[::-1] > 0.05 * values.sum()))


class FirstPoint:
    """Depends on where the data lie."""

    def estimate(self, points, distances, radius):
        return float(abs(points[0, 0]))


@pytest.fixture(scope="module")
def cloud():
    return crosscap.sample("sphere", 900, random_state=7).points


def test_metrics_that_obey_the_laws():
    check(straight)
    check(Straight)


@pytest.mark.parametrize(
    ("metric", "law"),
    [
        (Directed, "symmetry"),
        (lambda x, rows: ((rows - x) ** 2).sum(axis=1), "triangle inequality"),
        (lambda x, rows: np.abs(rows - x).max(axis=1) + 1, "identity"),
        (lambda x, rows: np.full(len(rows), np.nan), "never NaN"),
    ],
)
def test_metrics_that_break_a_law(metric, law):
    with pytest.raises(LawBroken) as caught:
        check(metric, cases=64)
    assert caught.value.law == law and caught.value.input and law in str(caught.value)


def test_estimators_and_their_laws():
    check(Spread, cases=32)
    with pytest.raises(LawBroken, match="motion"):
        check(FirstPoint, cases=32)


def test_an_exception_in_a_plugin_comes_out():
    def broken(x, rows):
        raise LookupError("no such table")

    with pytest.raises(LookupError, match="no such table"):
        check(broken)
    with pytest.raises(ValueError, match="one for each row"):
        check(lambda x, rows: np.zeros(len(rows) + 1))


@pytest.mark.parametrize("metric", [straight, Straight])
def test_a_metric_of_ones_own_gives_the_same_surface(metric, cloud):
    usual = crosscap.SurfaceReconstruction(**SPHERE).fit(cloud)
    own = crosscap.SurfaceReconstruction(**SPHERE, metric=metric, n_jobs=2).fit(cloud)
    assert own.betti_ == (1, 0, 1)
    assert np.array_equal(own.triangles_, usual.triangles_)


def test_a_metric_that_fails_ends_the_run(cloud):
    calls = 0

    def failing(x, rows):
        nonlocal calls
        calls += 1
        if calls > 50:
            raise LookupError("no such table")
        return straight(x, rows)

    with pytest.raises(LookupError, match="no such table"):
        crosscap.SurfaceReconstruction(**SPHERE, metric=failing).fit(cloud)
    with pytest.raises(ValueError, match="distances"):
        crosscap.SurfaceReconstruction(**SPHERE, metric=3).fit(cloud)


def test_an_estimator_of_ones_own(cloud):
    own = crosscap.SurfaceReconstruction(eps=0.6, dl=0.3, models=["two-planes"], estimator=Spread())
    assert own.fit(cloud).betti_ == (1, 0, 1)
    assert own.report_["estimator"] == "Spread"


class Flat:
    """One sheet, not bent."""

    local_dimension = 3
    name = "flat"

    def decompose(self, points, fitted, center, radius):
        middle = points[:fitted].mean(axis=0)
        _, _, axes = np.linalg.svd(points[:fitted] - middle, full_matrices=False)
        off = (points - middle) @ axes[-1]
        return crosscap.Decomposition(
            strata=[2],
            labels=np.zeros(len(points), int),
            residual=np.sqrt(np.mean(off[:fitted] ** 2)),
            parameters=3,
            center=points[center],
        )


class Bent(Flat):
    """Does not know its own residual."""

    def decompose(self, points, fitted, center, radius):
        flat = super().decompose(points, fitted, center, radius)
        return dataclasses.replace(flat, residual=0.1 * radius)


class Nowhere(Flat):
    """Applies to nothing, and counts how often it was asked."""

    def __init__(self):
        self.asked = 0

    def decompose(self, points, fitted, center, radius):
        assert points.shape[1] == 3 and fitted <= len(points) and 0 <= center < len(points)
        self.asked += 1


def test_models_and_their_laws():
    check(Flat, instances="sheet", cases=32)
    with pytest.raises(LawBroken, match="exact data"):
        check(Bent, instances="sheet", cases=32)
    with pytest.raises(ValueError, match="instances is missing"):
        check(Flat)
    with pytest.raises(ValueError, match="no instances of"):
        check(Flat, instances="cusp")


def test_models_of_ones_own_compete():
    cloud = crosscap.sample("two-spheres", 60_000, random_state=1, thin=0.05).points
    own = Nowhere()
    surface = crosscap.SurfaceReconstruction(eps=0.35, dl=0.17, models=["two-planes", own])
    assert surface.fit(cloud).betti_ == (1, 0, 3)
    assert own.asked > 100
    with pytest.raises(ValueError, match="decompose"):
        surface.set_params(models=[3]).fit(cloud)


def test_metrics_are_compared(cloud):
    def half(x, rows):
        return straight(x, rows) / 2

    runs = crosscap.compare(
        cloud, [0.7, 0.9], 0.3, metrics=["euclidean", Straight, half], surface=True, n_jobs=2
    )
    assert [(run.metric, run.eps) for run in runs] == [
        (name, eps) for name in ("euclidean", "straight", "half") for eps in (0.7, 0.9)
    ]
    assert all(run.works and run.betti == [1, 0, 1] for run in runs[:4])
    # The same distances, so the same meshes; half of them, so others.
    assert [run.triangles for run in runs[:2]] == [run.triangles for run in runs[2:4]]
    assert runs[4].triangles != runs[0].triangles
    # What ran says its own name.
    assert all({"metric", "oracle", "triangulator"} <= run.plugins.keys() for run in runs[:4])
    assert runs[0].plugins["metric"] != runs[2].plugins["metric"]
    (wrong,) = crosscap.compare(
        cloud, [0.7], 0.3, metrics=["euclidean"], betti=(1, 2, 1), surface=True
    )
    assert wrong.state == "other-betti" and "known" in wrong.reason
    with pytest.raises(ValueError, match="metric"):
        crosscap.compare(cloud, [0.7], 0.3, metrics=["manhattan"])


def test_a_metric_that_fails_ends_the_comparison(cloud):
    def failing(x, rows):
        raise LookupError("no such table")

    with pytest.raises(LookupError, match="no such table"):
        crosscap.compare(cloud, [0.7, 0.8, 0.9], 0.3, metrics=[failing], surface=True)
