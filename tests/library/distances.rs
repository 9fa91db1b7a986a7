//! The same surface by coordinates and by distances; metrics chosen separately.

use crosscap::prelude::*;
use crosscap::{MetricName, Neighborhoods, Spaces};
use crosscap_algorithms::certificate::Level;
use crosscap_backends::files::Distances;
use crosscap_backends::geodesic::EdgeRule;
use crosscap_core::{Row, SparseDistances};

fn points(surface: &str, count: usize) -> PointCloud<f64> {
    let surface = SampleSurface::find(surface).unwrap();
    surface.sample(&Sampling::new(count, 3)).unwrap().points
}

/// All distances, by a function of the straight line.
fn dense(cloud: &PointCloud<f64>, of: impl Fn(f64) -> f64) -> Distances {
    let n = cloud.len();
    let values = (0..n * n)
        .map(|k| of(cloud.squared_distance(k / n, k % n).sqrt()))
        .collect();
    Distances::Dense { count: n, values }
}

/// Those below `radius`.
fn sparse(cloud: &PointCloud<f64>, radius: f64, of: impl Fn(f64) -> f64) -> Distances {
    let n = cloud.len();
    let pairs = (0..n).flat_map(|a| (0..a).map(move |b| (a, b)));
    let near = pairs.filter_map(|(a, b)| {
        let d = of(cloud.squared_distance(a, b).sqrt());
        (d < radius).then_some((Row::new(a), Row::new(b), d))
    });
    Distances::Sparse(SparseDistances::new(n, near).unwrap())
}

#[test]
fn coordinates_and_distances_give_one_complex() {
    let cases = [
        (
            points("sphere", 1500),
            Parameters::new(0.6, 0.3).surface(),
            0.6,
            [1, 0, 1],
        ),
        (
            points("two_spheres", 3500),
            Parameters::new(0.5, 0.3),
            0.55,
            [1, 0, 3],
        ),
    ];
    for (cloud, parameters, radius, betti) in cases {
        let mut pipeline = Pipeline::new(parameters).unwrap();
        let by_coordinates = pipeline.reconstruct(&cloud).unwrap();
        assert!(by_coordinates.is_verified());
        assert_eq!(by_coordinates.homology.betti_rational, betti);
        for distances in [dense(&cloud, |d| d), sparse(&cloud, radius, |d| d)] {
            let by_distances = pipeline.reconstruct_distances(&distances).unwrap();
            let given = by_distances.report.given.as_ref().unwrap();
            assert!(given.exact && given.dimension == 3, "{given:?}");
            assert!(given.deviation < 1e-8, "{given:?}");
            assert!(by_distances.is_verified());
            assert_eq!(by_distances.certificate.unchecked(), []);
            assert_eq!(by_distances.mesh.complex, by_coordinates.mesh.complex);
            assert_eq!(
                by_distances.mesh.point_index,
                by_coordinates.mesh.point_index
            );
        }
    }
}

#[test]
fn distances_of_no_points_are_taken_as_they_are() {
    // Arcs on the unit sphere, between points that are on it within rounding.
    let arc = |chord: f64| 2.0 * (chord / 2.0).min(1.0).asin();
    let cloud = points("sphere", 1500);
    let parameters = Parameters::new(0.6, 0.3).surface();
    let straight = Pipeline::new(parameters.clone())
        .unwrap()
        .reconstruct(&cloud)
        .unwrap();
    for distances in [dense(&cloud, arc), sparse(&cloud, 1.3, arc)] {
        let mut pipeline = Pipeline::new(parameters.clone()).unwrap();
        let outcome = pipeline.reconstruct_distances(&distances).unwrap();
        assert!(outcome.is_verified(), "{}", outcome.certificate);
        assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
        assert!(!outcome.report.given.as_ref().unwrap().exact);
        let unchecked = [
            Level::Geometry,
            Level::Cover,
            Level::Faithful,
            Level::Quality,
        ];
        assert_eq!(outcome.certificate.unchecked(), unchecked);
        assert!(
            outcome
                .certificate
                .to_string()
                .contains("unchecked  geometry, cover, faithful, quality")
        );
        // Arcs stretch a landmark separation of 0.3 by less than half a percent.
        let (a, b) = (
            outcome.mesh.complex.vertices,
            straight.mesh.complex.vertices,
        );
        assert!(a.abs_diff(b) * 20 < b, "{a} and {b}");
        // What needs coordinates is refused, and says why.
        let open = Parameters::new(0.6, 0.3);
        let error = Pipeline::new(open)
            .unwrap()
            .reconstruct_distances(&distances);
        let error = error.unwrap_err();
        assert!(
            error.is_input() && error.to_string().contains("Euclidean space"),
            "{error}"
        );
    }
}

#[test]
fn too_few_distances_are_named() {
    let cloud = points("sphere", 400);
    let few = sparse(&cloud, 0.15, |d| d);
    let mut warned = Vec::new();
    let parameters = Parameters::new(0.9, 0.45).surface();
    let result = Pipeline::new(parameters)
        .unwrap()
        .reconstruct_distances(&few);
    match result {
        Ok(outcome) => {
            warned.extend(outcome.report.warnings.iter().map(ToString::to_string));
            assert!(
                warned.iter().any(|w| w.contains("lengths of paths")),
                "{warned:?}"
            );
        }
        // A graph in pieces has infinite distances.
        Err(error) => assert!(error.to_string().contains("not a finite number"), "{error}"),
    }
}

fn with(metric: MetricName, tri_metric: Option<MetricName>) -> Parameters {
    Parameters {
        spaces: Spaces {
            metric,
            tri_metric,
            ..Spaces::default()
        },
        ..Parameters::new(0.35, 0.2)
    }
}

#[test]
fn lifting_takes_crossing_spheres_apart() {
    let cloud = points("two_spheres", 12_000);
    let mut pipeline = Pipeline::new(with(MetricName::Lifted, None)).unwrap();
    let outcome = pipeline.reconstruct(&cloud).unwrap();
    assert!(outcome.is_verified(), "{}", outcome.certificate);
    assert_eq!(outcome.homology.betti_rational, [2, 0, 2]);
    assert_eq!(outcome.pieces.unwrap().pieces.len(), 2);
    assert_eq!(outcome.report.curve_points, 0);
    // Lifted points are no sample whose gaps speak.
    assert_eq!(outcome.certificate.unchecked(), [Level::Faithful]);
    // The mesh is where the points are, not in the lifted space.
    assert_eq!(outcome.mesh.vertices.dimension(), 3);
    for (k, &row) in outcome.mesh.point_index.iter().enumerate() {
        assert_eq!(outcome.mesh.vertices.point(k), cloud.point(row as usize));
    }
}

#[test]
fn metrics_are_chosen_separately() {
    use MetricName::{Euclidean, Geodesic, Lifted};
    let cloud = points("two_spheres", 12_000);
    for (metric, charts, betti) in [
        (Euclidean, Some(Geodesic), [1, 0, 3]),
        (Geodesic, Some(Euclidean), [1, 0, 3]),
        (Geodesic, None, [1, 0, 3]),
        (Lifted, Some(Euclidean), [2, 0, 2]),
    ] {
        let mut pipeline = Pipeline::new(with(metric, charts)).unwrap();
        let outcome = pipeline.reconstruct(&cloud).unwrap();
        assert!(
            outcome.is_verified(),
            "{metric} {charts:?}: {}",
            outcome.certificate
        );
        assert_eq!(
            outcome.homology.betti_rational, betti,
            "{metric} {charts:?}"
        );
        let graph = metric == Geodesic || charts == Some(Geodesic);
        assert_eq!(outcome.report.graph.is_some(), graph);
    }
}

#[test]
fn policies_of_neighborhoods_find_the_crossing() {
    let cloud = points("two_spheres", 12_000);
    for neighborhoods in [Neighborhoods::Nearest(60), Neighborhoods::Adaptive(60)] {
        let mut parameters = with(MetricName::Euclidean, None);
        parameters.spaces.neighborhoods = neighborhoods;
        let outcome = Pipeline::new(parameters)
            .unwrap()
            .reconstruct(&cloud)
            .unwrap();
        assert!(
            outcome.is_verified(),
            "{neighborhoods}: {}",
            outcome.certificate
        );
        assert_eq!(outcome.homology.betti_rational, [1, 0, 3]);
    }
}

#[test]
fn a_graph_that_misleads_is_named() {
    let cloud = points("sphere", 3000);
    let said = std::rc::Rc::new(std::cell::RefCell::new(Vec::new()));
    let heard = said.clone();
    let mut parameters = with(MetricName::Geodesic, None).surface();
    parameters.spaces.graph = EdgeRule::Nearest(2);
    let outcome = Pipeline::new(parameters)
        .unwrap()
        .on_warning(move |w| heard.borrow_mut().push(w.to_string()))
        .reconstruct(&cloud);
    let said = said.borrow();
    assert!(
        said.iter().any(|w| w.contains("times the spacing")),
        "{said:?}"
    );
    if let Ok(outcome) = outcome {
        assert!(!outcome.is_verified());
        assert_eq!(outcome.report.warnings.len(), said.len());
    }
}
