//! Spaces that are no Euclidean ones, and plug-ins that do what the default does.

use crate::FRONT;
use crosscap::prelude::*;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
use crosscap_algorithms::singularity::{TriplePoint, TwoPlanes};
use crosscap_algorithms::stratify::Cells;
use crosscap_algorithms::surfaces::Random;
use crosscap_backends::files::Distances;
use crosscap_core::execute::Execute;
use crosscap_core::{
    BallDimension, Balls, Decomposition, DimensionEstimate, LocalPoints, Neighborhood, Rejection,
    StratifiedLandmarks, Triangulation, Triangulator,
};
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

/// `count` distances a point, by a function of two points.
fn dense(count: usize, distance: impl Fn(usize, usize) -> f64) -> Distances {
    let values = (0..count * count).map(|k| distance(k / count, k % count));
    Distances::Dense {
        count,
        values: values.collect(),
    }
}

fn betti(parameters: Parameters, distances: &Distances) -> Result<[usize; 3], String> {
    let outcome = Pipeline::new(parameters)
        .unwrap()
        .reconstruct_distances(distances)
        .unwrap();
    if outcome.is_verified() {
        Ok(outcome.homology.betti_rational)
    } else {
        Err(outcome.certificate.to_string())
    }
}

/// Unit spheres of `each` points, distances along arcs within a sphere, `apart` between spheres.
fn spheres(count: usize, each: usize, apart: f64) -> Distances {
    let mut random = Random::new(3);
    let points: Vec<[f64; 3]> = (0..count * each)
        .map(|_| {
            let x = [0; 3].map(|_| random.normal());
            let norm = x.iter().map(|c| c * c).sum::<f64>().sqrt();
            x.map(|c| c / norm)
        })
        .collect();
    dense(points.len(), |a, b| {
        if a == b {
            return 0.0;
        }
        if a / each != b / each {
            return apart;
        }
        let (p, q) = (points[a.min(b)], points[a.max(b)]);
        let cosine: f64 = p.iter().zip(&q).map(|(x, y)| x * y).sum();
        cosine.clamp(-1.0, 1.0).acos()
    })
}

#[test]
fn spheres_far_apart_that_lie_in_no_space() {
    for count in [2, 5] {
        let distances = spheres(count, 400, 10.0);
        let found = betti(Parameters::new(0.9, 0.4).surface(), &distances);
        assert_eq!(found, Ok([count, 0, count]));
    }
}

#[test]
fn a_torus_of_two_angles_is_flat() {
    let mut random = Random::new(7);
    let n = 2500;
    let angles: Vec<[f64; 2]> = (0..n)
        .map(|_| [0; 2].map(|_| TAU * random.uniform()))
        .collect();
    let distances = dense(n, |a, b| {
        let around = (0..2).map(|k| {
            let d = (angles[a][k] - angles[b][k]).abs();
            d.min(TAU - d).powi(2)
        });
        around.sum::<f64>().sqrt()
    });
    for dl in [0.2, 0.4, 0.6] {
        let found = betti(Parameters::new(0.9, dl).surface(), &distances);
        assert_eq!(found, Ok([1, 2, 1]), "dl {dl}");
    }
}

fn two_spheres() -> PointCloud<f64> {
    let surface = SampleSurface::find("two_spheres").unwrap();
    surface.sample(&Sampling::new(3500, 3)).unwrap().points
}

fn parameters() -> Parameters {
    Parameters::new(0.5, 0.3)
}

#[test]
fn plug_ins_that_do_what_the_default_does_change_nothing() {
    let cloud = two_spheres();
    let pipeline = || Pipeline::new(parameters()).unwrap();
    let default = pipeline().reconstruct(&cloud).unwrap();
    assert!(default.is_verified());
    assert_eq!(default.homology.betti_rational, [1, 0, 3]);
    let metric = Euclidean::new(cloud.clone());
    let estimator = PrincipalComponents::new(parameters().dt).unwrap();
    let others = [
        pipeline().oracle(Box::new(BruteForceOracle::new(metric.clone()))),
        pipeline().estimator(Box::new(estimator)),
        pipeline().analysis_metric(Box::new(metric)),
        pipeline().stratifier(Box::new(Cells)),
        pipeline().triangulator(Box::new(Front)),
    ];
    for mut other in others {
        let outcome = other.reconstruct(&cloud).unwrap();
        assert_eq!(outcome.mesh, default.mesh);
        assert_eq!(outcome.certificate, default.certificate);
        assert_eq!(outcome.report.models, default.report.models);
        assert_eq!(outcome.report.mean_neighbors, default.report.mean_neighbors);
    }
}

/// The advancing front with its usual parts.
struct Front;

impl Triangulator<f64> for Front {
    fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
        FRONT.triangulate(waist)
    }
    fn name(&self) -> &str {
        "front"
    }
}

/// Principal components that answer for all balls together, and for no more than the spot checks one by one.
struct Together {
    usual: PrincipalComponents<f64>,
    alone: AtomicUsize,
}

impl DimensionEstimator for Together {
    type Scalar = f64;
    fn estimate(&self, ball: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
        assert!(self.alone.fetch_add(1, Ordering::Relaxed) < 16);
        self.usual.estimate(ball)
    }
    fn estimate_all(
        &self,
        balls: &Balls<'_, f64>,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        self.usual.estimate_all(balls, execute)
    }
    fn of_variances(&self, variances: &[f64]) -> Option<DimensionEstimate> {
        self.usual.of_variances(variances)
    }
    fn name(&self) -> &str {
        "together"
    }
}

#[test]
fn an_estimator_that_is_plugged_in_can_answer_for_all_balls_together() {
    let cloud = two_spheres();
    let default = Pipeline::new(parameters()).unwrap().reconstruct(&cloud);
    let estimator = Together {
        usual: PrincipalComponents::new(parameters().dt).unwrap(),
        alone: AtomicUsize::new(0),
    };
    let outcome = Pipeline::new(parameters())
        .unwrap()
        .estimator(Box::new(estimator))
        .reconstruct(&cloud)
        .unwrap();
    assert_eq!(outcome.mesh, default.unwrap().mesh);
    assert_eq!(
        outcome.report.plugins.estimator.as_deref(),
        Some("together")
    );
}

/// Half of the straight line.
struct Half(Euclidean<f64>);

impl MetricSpace for Half {
    type Scalar = f64;
    fn len(&self) -> usize {
        self.0.len()
    }
    fn distance(&self, a: usize, b: usize) -> f64 {
        0.5 * self.0.distance(a, b)
    }
    fn name(&self) -> &str {
        "half"
    }
}

#[test]
fn charts_follow_the_metric_of_the_analysis() {
    let surface = SampleSurface::find("sphere").unwrap();
    let cloud = surface.sample(&Sampling::new(2000, 3)).unwrap().points;
    let half = || Box::new(Half(Euclidean::new(cloud.clone())));
    let by = |pipeline: Pipeline| {
        let outcome = { pipeline }.reconstruct(&cloud).unwrap();
        let names = outcome.report.plugins.clone();
        assert_eq!(names.metric, "half");
        (names.chart_metric, outcome)
    };
    // Half the distances, half the lengths.
    let p = Parameters::new(0.3, 0.12).surface();
    let pipeline = |p: &Parameters| Pipeline::new(p.clone()).unwrap().analysis_metric(half());
    let (charts, followed) = by(pipeline(&p));
    assert_eq!(charts, "half");
    let (charts, told) = by(pipeline(&p).triangulation_metric(half()));
    assert_eq!((charts.as_str(), &told.mesh), ("half", &followed.mesh));
    let mut straight = p.clone();
    straight.spaces.tri_metric = Some(MetricName::Euclidean);
    assert_eq!(by(pipeline(&straight)).0, "places");
}

/// A model that asks for everything and explains nothing.
struct Nothing;

impl SingularityModel for Nothing {
    fn local_dimension(&self) -> usize {
        3
    }
    fn applies_to(&self, _dimension: usize) -> bool {
        true
    }
    fn decompose(&self, _local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Err(Rejection::NoRealSolution)
    }
    fn name(&self) -> &str {
        "nothing"
    }
}

#[test]
fn neither_the_order_of_models_nor_those_that_refuse_change_anything() {
    let surface = SampleSurface::find("three_spheres").unwrap();
    let cloud = surface.sample(&Sampling::new(9000, 3)).unwrap().points;
    let p = Parameters::new(0.45, 0.22);
    let planes = || Box::new(TwoPlanes::new(p.dp, p.ep).unwrap()) as Box<dyn SingularityModel>;
    let triple = || Box::new(TriplePoint::new(p.dp, p.ep).unwrap()) as Box<dyn SingularityModel>;
    let run = |models: Vec<Box<dyn SingularityModel>>| {
        let pipeline = Pipeline::new(p.clone()).unwrap().models(models);
        { pipeline }.reconstruct(&cloud).unwrap()
    };
    let one = run(vec![planes(), triple()]);
    let two = run(vec![Box::new(Nothing), triple(), planes()]);
    assert!(one.report.models.iter().all(|m| m.won > 0));
    assert_eq!(two.mesh, one.mesh);
    let [nothing, triple, planes] = &two.report.models[..] else {
        panic!("{:?}", two.report.models);
    };
    assert!(nothing.asked > 0 && nothing.no_real_solution == nothing.asked);
    assert_eq!(
        [planes, triple],
        [&one.report.models[0], &one.report.models[1]]
    );
}

#[test]
fn the_report_names_what_ran() {
    let cloud = two_spheres();
    let p = parameters();
    let models: Vec<Box<dyn SingularityModel>> =
        vec![Box::new(TwoPlanes::new(p.dp, p.ep).unwrap())];
    let outcome = Pipeline::new(Parameters {
        models: Vec::new(),
        ..p.clone()
    })
    .unwrap()
    .models(models)
    .reconstruct(&cloud)
    .unwrap();
    let [counts] = &outcome.report.models[..] else {
        panic!("{:?}", outcome.report.models);
    };
    assert_eq!(counts.name, TwoPlanes::new(p.dp, p.ep).unwrap().name());
    assert!(counts.won > 0 && counts.broken == 0, "{counts:?}");
    let refused = counts.too_few_points
        + counts.no_real_solution
        + counts.poor_fit
        + counts.simpler_model_fits
        + counts.empty_stratum
        + counts.other;
    assert_eq!(
        counts.asked,
        counts.won + counts.lost + refused,
        "{counts:?}"
    );
    let names = &outcome.report.plugins;
    let three = [&names.metric, &names.stratifier, &names.triangulator];
    assert_eq!(three, ["euclidean", "cells", "advancing-front"]);
    assert_eq!(names.estimator.as_deref(), Some("pca"));
}
