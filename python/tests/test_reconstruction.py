"""Points to surface, as scikit-learn wants it."""

import pickle
import warnings

import numpy as np
import pytest
import scipy.sparse
import scipy.spatial.distance
from sklearn.base import clone
from sklearn.utils.estimator_checks import check_estimator

import crosscap

SPHERE = {"eps": 0.4, "dl": 0.2, "surface": True}


def test_a_sphere_is_a_sphere(sphere):
    surface = crosscap.SurfaceReconstruction(**SPHERE).fit(sphere)
    assert surface.verdict_ == "verified" and surface.refusal_ is None
    assert surface.betti_ == surface.betti_mod2_ == (1, 0, 1) and surface.torsion_ == ()
    (piece,) = surface.pieces_
    assert (piece.name, piece.orientable, piece.genus) == ("sphere", True, 0)
    assert piece.area == pytest.approx(4 * np.pi, rel=0.05)
    # Vertices are points of the input, triangles a closed surface of them.
    assert np.array_equal(surface.vertices_, sphere[surface.point_index_])
    assert len(surface.triangles_) == 2 * len(surface.vertices_) - 4
    assert surface.curve_edges_.shape == (0, 2)
    assert surface.report_["points"] == len(sphere)
    assert surface.certificate_["edges"]["violations"] == []
    assert (surface.eps_, surface.dl_) == (0.4, 0.2)


def test_two_spheres_cross_in_a_circle(spheres):
    assert spheres.betti_ == (1, 0, 3)
    assert [piece.name for piece in spheres.pieces_] == ["sphere", "sphere"]
    assert set(spheres.curve_cells_) == {4} and len(spheres.curve_edges_) > 10
    assert len(spheres.mesh_.triangle_piece) == len(spheres.triangles_)


def test_a_klein_bottle_has_torsion():
    cloud = crosscap.sample("klein-r5", 10_000)
    surface = crosscap.SurfaceReconstruction(surface=True).fit(cloud.points)
    assert (surface.betti_, surface.betti_mod2_, surface.torsion_) == ((1, 1, 0), (1, 2, 1), (2,))
    assert [piece.name for piece in surface.pieces_] == ["Klein bottle"]


def test_lengths_are_found(sphere):
    surface = crosscap.SurfaceReconstruction(surface=True).fit(sphere)
    assert surface.betti_ == (1, 0, 1)
    assert 0 < surface.dl_ < surface.eps_ < 2
    pinned = crosscap.SurfaceReconstruction(dl=0.25, surface=True).fit(sphere)
    assert pinned.dl_ == 0.25 and pinned.betti_ == (1, 0, 1)


def test_who_knows_that_there_is_no_narrow_hole_can_say_so():
    # Points spread evenly over a sphere, without a cap of three spacings: a seam of a scan, or a hole.
    count = 3000
    angle, height = np.pi * (3 - np.sqrt(5)) * np.arange(count), 1 - (2 * np.arange(count) + 1) / count
    across = np.sqrt(1 - height**2)
    points = np.stack([across * np.cos(angle), across * np.sin(angle), height], axis=1)
    points = points[np.linalg.norm(points - [0, 0, 1], axis=1) > 0.1]
    lengths = {"eps": 0.39, "dl": 0.19}
    with pytest.raises(crosscap.Refusal, match="gaps of the points") as refused:
        crosscap.SurfaceReconstruction(**lengths).fit(points)
    assert "(least_hole= 3." in refused.value.advice
    surface = crosscap.SurfaceReconstruction(**lengths, least_hole=4).fit(points)
    assert surface.betti_ == (1, 0, 1)
    assert surface.certificate_["faithful"]["covered"]["gaps"] == 1
    # The mesh tells, and whoever judges it goes by that or by something else.
    assert surface.mesh_.metadata["least_hole"] == 4
    assert crosscap.check(surface.mesh_, points).verified
    assert not crosscap.check(surface.mesh_, points, least_hole=2).verified


def test_threads_and_layout_of_memory_change_nothing(sphere):
    first = crosscap.SurfaceReconstruction(**SPHERE, n_jobs=1).fit(sphere)
    for points in (sphere, np.asfortranarray(sphere), sphere.tolist()):
        again = crosscap.SurfaceReconstruction(**SPHERE, n_jobs=2).fit(points)
        assert np.array_equal(first.vertices_, again.vertices_)
        assert np.array_equal(first.triangles_, again.triangles_)


def test_the_seed_chooses_the_landmarks(sphere):
    def rows(seed):
        surface = crosscap.SurfaceReconstruction(**SPHERE, random_state=seed)
        return surface.fit(sphere).point_index_.tolist()

    assert rows(1) == rows(1) != rows(2)
    assert rows(np.random.RandomState(5)) == rows(np.random.RandomState(5))


def test_a_refusal_says_why_and_keeps_the_mesh(sphere):
    cap = sphere[sphere[:, 2] > -0.6]
    # A rim that nobody declared.
    surface = crosscap.SurfaceReconstruction(**SPHERE, models=["two-planes"])
    with pytest.raises(crosscap.Refusal) as caught:
        surface.fit(cap)
    refusal = caught.value
    assert refusal is surface.refusal_ and surface.verdict_ == "refused"
    assert refusal.advice and refusal.advice in str(refusal)
    # Parameters have the names that they have here.
    assert "boundary=" in refusal.advice and 'models="auto"' in refusal.advice
    assert "--" not in str(refusal)
    (attempt,) = refusal.attempts
    assert attempt["parameters"]["eps"] == 0.4
    reason = refusal.reasons[0]
    assert reason.count > 0 and reason.text in str(refusal)
    rows = [place.index for place in refusal.places]
    assert rows and {place.kind for place in refusal.places} == {"point"}
    # The places are on the rim.
    assert np.median(cap[rows, 2]) < -0.3
    assert len(surface.triangles_) > 100 and surface.report_["verified"] is False
    assert "not verified" in surface.mesh_.page()
    kinds = {v["kind"] for v in surface.certificate_["edges"]["violations"]}
    assert "undeclared_boundary" in kinds
    again = pickle.loads(pickle.dumps(refusal))
    assert again.reasons == refusal.reasons and str(again) == str(refusal)


def test_a_refusal_without_a_mesh():
    noise = np.random.default_rng(0).normal(size=(300, 5))
    surface = crosscap.SurfaceReconstruction(eps=1.5, dl=0.7)
    with pytest.raises(crosscap.Refusal) as caught:
        surface.fit(noise)
    assert caught.value.reasons and caught.value.advice
    assert surface.vertices_.shape == (0, 5) and surface.triangles_.shape == (0, 3)
    with pytest.warns(crosscap.RefusalWarning):
        clone(surface).set_params(on_refusal="warn").fit(noise)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        clone(surface).set_params(on_refusal="ignore").fit(noise)


def test_bad_input_is_a_value_error(sphere):
    wrong = [
        ({"eps": -1.0}, "eps"),
        ({"metric": "manhattan"}, "metric"),
        ({"models": ["cusp"]}, "cusp"),
        ({"estimator": "guess"}, "spanning-tree"),
        ({"neighborhoods": "k-nearest:1"}, "k-nearest:K"),
        ({"boundary": [10**6]}, "boundary row"),
        ({"on_refusal": "shrug"}, "on_refusal"),
    ]
    for parameters, said in wrong:
        with pytest.raises(ValueError, match=said):
            crosscap.SurfaceReconstruction(**{**SPHERE, **parameters}).fit(sphere)
    with pytest.raises(ValueError, match="minimum of 8"):
        crosscap.SurfaceReconstruction(**SPHERE).fit(sphere[:5])


def test_a_boundary_that_is_given():
    cloud = crosscap.sample("moebius", 4000, random_state=2, boundary=True)
    assert len(cloud.boundary) > 10
    surface = crosscap.SurfaceReconstruction(
        eps=0.4, dl=0.2, surface=True, models=["two-planes"], boundary=cloud.boundary
    )
    assert surface.fit(cloud.points).betti_ == cloud.betti
    assert set(surface.curve_cells_) == {1}


@pytest.fixture(scope="module")
def few():
    return crosscap.sample("sphere", 900, random_state=7).points


def test_distances_instead_of_points(few):
    distances = scipy.spatial.distance.squareform(scipy.spatial.distance.pdist(few))
    settings = {"eps": 0.6, "dl": 0.3, "surface": True, "metric": "precomputed"}
    dense = crosscap.SurfaceReconstruction(**settings).fit(distances)
    assert dense.betti_ == (1, 0, 1) and dense.report_["given"]["exact"]
    assert dense.vertices_.shape[1] == 3 and dense.n_features_in_ == len(few)
    near = scipy.sparse.csr_array(np.where(distances < 1.0, distances, 0.0))
    for sparse in (near, near.tocsc(), near.tocoo()):
        assert crosscap.SurfaceReconstruction(**settings).fit(sparse).betti_ == (1, 0, 1)


def test_distances_that_are_none_are_refused(few):
    settings = {"eps": 0.6, "dl": 0.3, "metric": "precomputed"}
    distances = scipy.spatial.distance.squareform(scipy.spatial.distance.pdist(few[:20]))
    for place, value, said in [((3, 4), 9.0, "other direction"), ((2, 2), 1.0, "itself")]:
        wrong = distances.copy()
        wrong[place] = value
        with pytest.raises(ValueError, match=said):
            crosscap.SurfaceReconstruction(**settings).fit(wrong)
    with pytest.raises(ValueError, match="square"):
        crosscap.SurfaceReconstruction(**settings).fit(few)
    with pytest.raises(TypeError, match="[Ss]parse"):
        crosscap.SurfaceReconstruction().fit(scipy.sparse.csr_array(distances))


NOISE = "random numbers are no sample of a surface: fit refuses them, as it must"
# Checks that fit random numbers. With on_refusal="warn" they pass.
REFUSED = {
    "check_dict_unchanged",
    "check_dont_overwrite_parameters",
    "check_dtype_object",
    "check_estimators_dtypes",
    "check_estimators_fit_returns_self",
    "check_estimators_nan_inf",
    "check_estimators_overwrite_params",
    "check_estimators_pickle",
    "check_f_contiguous_array_estimator",
    "check_fit2d_predict1d",
    "check_fit_check_is_fitted",
    "check_fit_idempotent",
    "check_fit_score_takes_y",
    "check_methods_sample_order_invariance",
    "check_methods_subset_invariance",
    "check_n_features_in",
    "check_n_features_in_after_fitting",
    "check_pipeline_consistency",
    "check_positive_only_tag_during_fit",
    "check_readonly_memmap_input",
}


@pytest.mark.parametrize("on_refusal", ["raise", "warn"])
def test_the_checks_of_scikit_learn(on_refusal):
    estimator = crosscap.SurfaceReconstruction(on_refusal=on_refusal)
    expected = dict.fromkeys(REFUSED, NOISE) if on_refusal == "raise" else {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # What fails and is not expected to is raised.
        results = check_estimator(estimator, expected_failed_checks=expected)
    failed = [result for result in results if result["status"] == "xfail"]
    assert len(results) - len(failed) >= 20
    for result in failed:
        told = result["exception"]
        assert isinstance(told, crosscap.Refusal) or "Refusal" in str(told), result


def test_local_dimension_passes_the_checks_of_scikit_learn():
    results = check_estimator(crosscap.LocalDimension())
    assert {r["status"] for r in results} <= {"passed", "skipped"}


@pytest.mark.parametrize("estimator", ["pca", "mle", "correlation", "packing", "spanning-tree"])
def test_every_estimator_finds_a_surface(estimator, sphere):
    found = crosscap.LocalDimension(estimator, n_neighbors=40).fit(sphere)
    assert np.median(found.dimension_) == 2 and np.mean(found.dimension_ == 2) > 0.6
    assert found.value_.shape == found.confidence_.shape == (len(sphere),)
    assert np.array_equal(crosscap.dimension(sphere, estimator, n_neighbors=40), found.dimension_)
