//! Every model of every trait, put through the laws of the trait.

use std::f64::consts::TAU;

use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::{
    CorrelationDimension, MaximumLikelihood, PackingNumbers, PrincipalComponents, SpanningTree,
};
use crosscap_algorithms::landmarks::{MaxMin, RandomGreedy};
use crosscap_algorithms::metric::{BruteForceOracle, Euclidean, GivenDistances, Lifted};
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::singularity::{
    BareCurve, Boundary, CurveOnSheet, CurveThroughSheet, IsolatedCrossing, OneSheet, TriplePoint,
    TwoPlanes, YJunction,
};
use crosscap_algorithms::triangulate::{LargestAngle, MinimumCircumradius};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric};
use crosscap_backends::linear_program::LinearProgramTest;
use crosscap_core::laws::{self, Instances, Settings, instances};
use crosscap_core::{MetricSpace, PointCloud, Scalar};

/// More inputs than a plug-in author needs: these models are everybody's.
fn settings() -> Settings {
    Settings {
        cases: 512,
        ..Settings::default()
    }
}

fn euclidean<S: Scalar>(cloud: &PointCloud<f64>) -> Euclidean<S> {
    Euclidean::new(cloud.cast::<S>())
}

fn given<S: Scalar>(cloud: &PointCloud<f64>) -> GivenDistances<S> {
    let (metric, n) = (euclidean::<S>(cloud), cloud.len());
    let all = (0..n * n).map(|k| metric.distance(k / n, k % n)).collect();
    GivenDistances::new(n, all).unwrap()
}

/// Tangent lines that turn with the index, in the plane of the first two axes.
fn lifted<S: Scalar>(cloud: &PointCloud<f64>) -> Lifted<S> {
    let n = cloud.dimension();
    let mut bases = vec![S::zero(); cloud.len() * n];
    for (k, row) in bases.chunks_exact_mut(n).enumerate() {
        let angle = TAU * 0.17 * k as f64;
        row[0] = S::of(if n == 1 { 1.0 } else { angle.cos() });
        if n > 1 {
            row[1] = S::of(angle.sin());
        }
    }
    Lifted::new(cloud.cast::<S>(), 1, bases, 0.7).unwrap()
}

fn kd_tree<S: Scalar>(cloud: &PointCloud<f64>) -> EuclideanOracle<S> {
    EuclideanOracle::new(cloud.cast::<S>()).unwrap()
}

fn geodesic<S: Scalar>(cloud: &PointCloud<f64>, rule: EdgeRule) -> GeodesicMetric<S> {
    GeodesicMetric::new(&kd_tree::<S>(cloud), rule).unwrap()
}

const RULES: [EdgeRule; 3] = [
    EdgeRule::Nearest(2),
    EdgeRule::Nearest(5),
    EdgeRule::Within(1.0),
];

#[test]
fn metrics() {
    let s = &settings();
    laws::metric(s, euclidean::<f64>).unwrap();
    laws::metric(s, euclidean::<f32>).unwrap();
    laws::metric(s, given::<f64>).unwrap();
    laws::metric(s, given::<f32>).unwrap();
    laws::metric(s, lifted::<f64>).unwrap();
    laws::metric(s, lifted::<f32>).unwrap();
    laws::metric(s, kd_tree::<f64>).unwrap();
    laws::metric(s, kd_tree::<f32>).unwrap();
    for rule in RULES {
        laws::metric(s, |cloud| geodesic::<f64>(cloud, rule)).unwrap();
        laws::metric(s, |cloud| geodesic::<f32>(cloud, rule)).unwrap();
    }
}

#[test]
fn oracles() {
    let s = &settings();
    laws::oracle(s, |c| (kd_tree::<f64>(c), kd_tree::<f64>(c))).unwrap();
    laws::oracle(s, |c| (kd_tree::<f32>(c), kd_tree::<f32>(c))).unwrap();
    laws::oracle(s, |c| (euclidean::<f64>(c), kd_tree::<f64>(c))).unwrap();
    laws::oracle(s, |c| (euclidean::<f32>(c), kd_tree::<f32>(c))).unwrap();
    laws::oracle(s, |c| {
        (given::<f64>(c), BruteForceOracle::new(given::<f64>(c)))
    })
    .unwrap();
    laws::oracle(s, |c| {
        (lifted::<f32>(c), BruteForceOracle::new(lifted::<f32>(c)))
    })
    .unwrap();
}

#[test]
fn geodesic_oracles() {
    let s = &settings();
    for rule in RULES {
        laws::oracle(s, |c| (geodesic::<f64>(c, rule), geodesic::<f64>(c, rule))).unwrap();
        laws::oracle(s, |c| (geodesic::<f32>(c, rule), geodesic::<f32>(c, rule))).unwrap();
    }
}

#[test]
fn dimension_estimators() {
    for dt in [0.01, 0.05] {
        laws::estimator(&settings(), &PrincipalComponents::<f64>::new(dt).unwrap()).unwrap();
        laws::estimator(&settings(), &PrincipalComponents::<f32>::new(dt).unwrap()).unwrap();
    }
}

#[test]
fn dimension_estimators_from_distances() {
    let s = &settings();
    laws::estimator(s, &MaximumLikelihood::<f64>::new()).unwrap();
    laws::estimator(s, &MaximumLikelihood::<f32>::new()).unwrap();
    laws::estimator(s, &CorrelationDimension::<f64>::new()).unwrap();
    laws::estimator(s, &CorrelationDimension::<f32>::new()).unwrap();
    laws::estimator(s, &PackingNumbers::<f64>::new()).unwrap();
    laws::estimator(s, &PackingNumbers::<f32>::new()).unwrap();
    laws::estimator(s, &SpanningTree::<f64>::new()).unwrap();
    laws::estimator(s, &SpanningTree::<f32>::new()).unwrap();
}

/// Instances as a generator draws them, for a model that fits them to this share of the radius.
fn exact_to(
    exact: f64,
    draw: &dyn Fn(&mut instances::Draw) -> instances::Instance,
) -> Instances<'_> {
    Instances {
        exact,
        ..Instances::new(draw)
    }
}

#[test]
fn one_sheet() {
    laws::model(
        &settings(),
        &OneSheet,
        &Instances::new(&instances::flat_sheet),
    )
    .unwrap();
}

#[test]
fn two_planes() {
    let curved = TwoPlanes::new(0.1, 0.05).unwrap();
    let (mut refined, mut flat) = (curved, curved);
    refined.refinement_rounds = 20;
    flat.curved = false;
    for model in [curved, refined, flat] {
        laws::model(&settings(), &model, &exact_to(1e-6, &instances::two_planes)).unwrap();
    }
}

#[test]
fn boundary() {
    let model = Boundary::new(0.1, 0.05).unwrap();
    let instances = Instances {
        // The curve is as sharp as the sample: with fewer points the outermost ones leave wide notches.
        points: 400..=800,
        ..Instances::new(&instances::boundary)
    };
    laws::model(&settings(), &model, &instances).unwrap();
}

#[test]
fn y_junction() {
    let model = YJunction::new(0.1, 0.05).unwrap();
    laws::model(&settings(), &model, &exact_to(1e-6, &instances::y_junction)).unwrap();
}

#[test]
fn triple_point() {
    let model = TriplePoint::new(0.1, 0.05).unwrap();
    let instances = Instances {
        // Two thirds of them are the neighborhood, and the model asks for 48.
        points: 150..=300,
        ..exact_to(1e-6, &instances::triple_point)
    };
    laws::model(&settings(), &model, &instances).unwrap();
}

#[test]
fn isolated_crossing() {
    let model = IsolatedCrossing::new(0.1, 0.05).unwrap();
    let instances = exact_to(1e-6, &instances::crossing_in_four_dimensions);
    laws::model(&settings(), &model, &instances).unwrap();
}

#[test]
fn curve_through_sheet() {
    let model = CurveThroughSheet::new(0.1, 0.05).unwrap();
    let instances = Instances {
        // A fifth of them are on the line, and two thirds of those in the neighborhood.
        points: 150..=400,
        ..exact_to(1e-6, &instances::line_through_plane)
    };
    laws::model(&settings(), &model, &instances).unwrap();
}

#[test]
fn curve_on_sheet() {
    let model = CurveOnSheet::new(0.1, 0.05).unwrap();
    let instances = Instances {
        // A fifth of them are on the line, and two thirds of those in the neighborhood.
        points: 150..=400,
        ..exact_to(1e-6, &instances::line_on_plane)
    };
    laws::model(&settings(), &model, &instances).unwrap();
}

#[test]
fn bare_curve() {
    let model = BareCurve::new(0.1, 0.05).unwrap();
    laws::model(&settings(), &model, &exact_to(1e-6, &instances::curve)).unwrap();
}

#[test]
fn charts() {
    laws::chart(&settings(), &ClassicalScaling).unwrap();
}

#[test]
fn landmark_selectors() {
    laws::selector(&settings(), &RandomGreedy::<f64>::new()).unwrap();
    laws::selector(&settings(), &RandomGreedy::<f32>::new()).unwrap();
    laws::selector(&settings(), &MaxMin::<f64>::new()).unwrap();
    laws::selector(&settings(), &MaxMin::<f32>::new()).unwrap();
}

#[test]
fn compatibility_tests() {
    let s = Settings {
        cases: 3000,
        ..settings()
    };
    laws::compatibility(&s, &PlanarPredicate).unwrap();
    laws::compatibility(&s, &LinearProgramTest).unwrap();
}

#[test]
fn triangle_rules() {
    laws::rule(&settings(), &MinimumCircumradius).unwrap();
    laws::rule(&settings(), &LargestAngle).unwrap();
}
