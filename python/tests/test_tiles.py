"""Clouds in tiles: the same surface, whatever the tiles are and whoever holds them."""

import os
import pickle
import signal

import numpy as np
import pytest

import crosscap
import crosscap.dask
import crosscap.tiles
from crosscap import _holders

EPS, DL = 0.6, 0.3
SURFACE = {"surface": True, "random_state": 3}


@pytest.fixture(scope="module")
def torus():
    return crosscap.sample("torus", 4000, random_state=7).points


@pytest.fixture(scope="module")
def whole(torus):
    return crosscap.SurfaceReconstruction(EPS, DL, prepare=False, **SURFACE).fit(torus)


def told(surface):
    """All that must not depend on tiles."""
    report = surface.report_
    mesh = surface.mesh_
    arrays = (mesh.vertices, mesh.triangles, mesh.curve_edges, mesh.point_index)
    return (
        [array.tobytes() for array in arrays],
        report["certificate"],
        report["homology"],
        report["pieces"],
        surface.verdict_,
    )


@pytest.mark.parametrize("tiles", [1, 3, 8])
def test_tiles_in_files_give_the_same_bytes(torus, whole, tiles, tmp_path):
    found = crosscap.tiles.reconstruct(torus, EPS, DL, tiles=tiles, n_jobs=2, folder=tmp_path, **SURFACE)
    assert whole.verdict_ == "verified"
    assert told(found) == told(whole)
    assert list(tmp_path.iterdir()) == []


def test_points_come_from_files_in_chunks_as_they_are(torus, whole, tmp_path):
    for number, part in enumerate(np.array_split(torus, 3)):
        np.save(tmp_path / f"part-{number}.npy", part)
    assert told(crosscap.tiles.reconstruct(tmp_path, EPS, DL, tiles=2, **SURFACE)) == told(whole)
    file = tmp_path / "part-0.npy"
    one = crosscap.tiles.local_dimension(file, 0.6, tiles=2)
    mapped = crosscap.tiles.local_dimension(np.load(file, mmap_mode="r"), 0.6, tiles=3)
    assert (one.dimension_ == mapped.dimension_).all()
    wrong = torus.copy()
    wrong[3000, 1] = np.nan
    with pytest.raises(ValueError, match="row 3000, column 1 is not a finite number"):
        crosscap.tiles.reconstruct(wrong, EPS, DL, **SURFACE)
    with pytest.raises(ValueError, match=r"no \.npy or \.parquet"):
        (tmp_path / "empty").mkdir()
        crosscap.tiles.reconstruct(tmp_path / "empty", EPS, DL, **SURFACE)


@pytest.mark.parametrize("estimator", ["pca", "mle", "spanning-tree"])
def test_local_dimensions_are_the_same(torus, estimator):
    cloud = np.vstack([torus[:1200], torus[:3], [[50.0, 0.0, 0.0]]])
    expected = crosscap.LocalDimension(estimator, eps=0.9).fit(cloud)
    found = crosscap.tiles.local_dimension(cloud, 0.9, estimator, tiles=5)
    for name in ("dimension_", "value_", "confidence_"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    assert found.dimension_[-1] == -1
    with pytest.raises(ValueError, match="increase it"):
        crosscap.tiles.local_dimension(cloud, 1e-6, estimator, tiles=5)


def test_what_tiles_cannot_be_asked_is_refused(torus):
    with pytest.raises(ValueError, match="expected a list of names"):
        crosscap.tiles.reconstruct(torus, EPS, DL, models="auto")
    with pytest.raises(ValueError, match="without copies"):
        crosscap.tiles.reconstruct(np.vstack([torus, torus[:1]]), EPS, DL, **SURFACE)
    lone = np.vstack([torus, [[50.0, 0.0, 0.0]]])
    with pytest.raises(crosscap.Refusal) as refused:
        crosscap.tiles.reconstruct(lone, EPS, DL, **SURFACE)
    # As it comes from the process of a worker.
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)
    assert "4000" in str(refused.value)


CROSSING = {"models": ["two-planes"], "random_state": 3}
BOUNDED = {"models": ["two-planes", "boundary", "curve-through-sheet", "boundary-corner"], "random_state": 3}
CURVED = [("two_spheres", 8000, CROSSING, (1, 0, 3)), ("moebius", 5000, BOUNDED, (1, 1, 0))]


@pytest.fixture(scope="module", params=CURVED, ids=["crossing", "bounded"])
def curved(request):
    name, count, given, betti = request.param
    points = crosscap.sample(name, count, random_state=7).points
    whole = crosscap.SurfaceReconstruction(0.3, 0.15, prepare=False, **given).fit(points)
    assert (whole.verdict_, whole.betti_) == ("verified", betti)
    return points, given, whole


def test_surfaces_with_curves_give_the_same_bytes(curved):
    points, given, whole = curved
    found = crosscap.tiles.reconstruct(points, 0.3, 0.15, tiles=5, n_jobs=2, **given)
    assert told(found) == told(whole)
    assert found.report_["models"] == whole.report_["models"]


def test_workers_give_the_same_bytes_of_surfaces_with_curves(curved, cluster):
    points, given, whole = curved
    found = crosscap.dask.reconstruct(points, 0.3, 0.15, tiles=4, **given)
    assert told(found) == told(whole)


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster),
    ):
        yield cluster


def test_workers_give_the_same_bytes_and_one_may_be_killed(torus, whole, cluster, monkeypatch):
    array = pytest.importorskip("dask.array")
    points = array.from_array(torus, chunks=(900, 2))
    assert told(crosscap.dask.reconstruct(points, EPS, DL, tiles=3, **SURFACE)) == told(whole)
    asked = []
    ask = _holders.There.ask

    def ask_and_kill(self, function, arguments):
        asked.append(function)
        if len(asked) == 3:
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)
        return ask(self, function, arguments)

    monkeypatch.setattr(_holders.There, "ask", ask_and_kill)
    assert told(crosscap.dask.reconstruct(torus, EPS, DL, tiles=5, **SURFACE)) == told(whole)
    assert len(asked) > 5


def test_local_dimensions_of_workers_are_the_same(torus, cluster):
    expected = crosscap.LocalDimension(eps=0.6).fit(torus)
    found = crosscap.dask.local_dimension(torus, 0.6, tiles=4)
    np.testing.assert_array_equal(found.value_, expected.value_)
