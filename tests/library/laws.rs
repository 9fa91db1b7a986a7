//! Every model of every trait, put through the laws of the trait.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use crate::FRONT;
use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::{
    CorrelationDimension, MaximumLikelihood, PackingNumbers, PrincipalComponents, SpanningTree,
};
use crosscap_algorithms::landmarks::{MaxMin, RandomGreedy};
use crosscap_algorithms::metric::{
    BruteForceOracle, CheckedMetric, Euclidean, GivenDistances, Lifted,
};
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::singularity::{
    BareCurve, Book, Boundary, BoundaryCorner, ConePoint, CurveOnSheet, CurveThroughSheet,
    IsolatedCrossing, OneSheet, TriplePoint, TwoPlanes, YJunction,
};
use crosscap_algorithms::triangulate::{LargestAngle, MinimumCircumradius};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric};
use crosscap_backends::linear_program::LinearProgramTest;
use crosscap_core::laws::{self, Draw, Instance, Instances, Settings, instances};
use crosscap_core::{
    Decomposition, LocalPoints, Located, MetricSpace, PointCloud, Rejection, Scalar,
    SingularityModel, law_tests,
};

/// More inputs than a plug-in author needs: these models are everybody's.
fn settings() -> Settings {
    Settings {
        cases: 512,
        ..Settings::default()
    }
}

/// The kit's own number of inputs, for what takes long: estimators that go through the same code as their twins in double precision, and
/// books of 600 points and more.
fn usual() -> Settings {
    Settings::default()
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

/// Which points the graphs join: few nearest, more of them, all within a distance.
const FEW: EdgeRule = EdgeRule::Nearest(2);
const MORE: EdgeRule = EdgeRule::Nearest(5);
const WITHIN: EdgeRule = EdgeRule::Within(1.0);

law_tests! {
    mod euclidean_metric = metric(euclidean::<f64>), settings: settings();
    mod euclidean_metric_f32 = metric(euclidean::<f32>), settings: settings();
    mod given_metric = metric(given::<f64>), settings: settings();
    mod given_metric_f32 = metric(given::<f32>), settings: settings();
    mod lifted_metric = metric(lifted::<f64>), settings: settings();
    mod lifted_metric_f32 = metric(lifted::<f32>), settings: settings();
    mod tree_metric = metric(kd_tree::<f64>), settings: settings();
    mod tree_metric_f32 = metric(kd_tree::<f32>), settings: settings();
    mod geodesic_metric_of_few = metric(|cloud| geodesic::<f64>(cloud, FEW)), settings: settings();
    mod geodesic_metric_of_more = metric(|cloud| geodesic::<f64>(cloud, MORE)), settings: settings();
    mod geodesic_metric_within = metric(|cloud| geodesic::<f64>(cloud, WITHIN)), settings: settings();
    mod geodesic_metric_of_few_f32 = metric(|cloud| geodesic::<f32>(cloud, FEW)), settings: settings();
    mod geodesic_metric_of_more_f32 = metric(|cloud| geodesic::<f32>(cloud, MORE)), settings: settings();
    mod geodesic_metric_within_f32 = metric(|cloud| geodesic::<f32>(cloud, WITHIN)), settings: settings();
    mod checked_metric = metric(|cloud| CheckedMetric::new(euclidean::<f64>(cloud))),
        settings: settings();
}

law_tests! {
    mod tree_oracle = oracle(|c| (kd_tree::<f64>(c), kd_tree::<f64>(c))), settings: settings();
    mod tree_oracle_f32 = oracle(|c| (kd_tree::<f32>(c), kd_tree::<f32>(c))), settings: settings();
    mod tree_of_euclidean = oracle(|c| (euclidean::<f64>(c), kd_tree::<f64>(c))),
        settings: settings();
    mod tree_of_euclidean_f32 = oracle(|c| (euclidean::<f32>(c), kd_tree::<f32>(c))),
        settings: settings();
    mod brute_force_of_given = oracle(|c| (given::<f64>(c), BruteForceOracle::new(given::<f64>(c)))),
        settings: settings();
    mod brute_force_of_lifted_f32 =
        oracle(|c| (lifted::<f32>(c), BruteForceOracle::new(lifted::<f32>(c)))), settings: settings();
    mod geodesic_oracle_of_few = oracle(|c| (geodesic::<f64>(c, FEW), geodesic::<f64>(c, FEW))),
        settings: settings();
    mod geodesic_oracle_of_more = oracle(|c| (geodesic::<f64>(c, MORE), geodesic::<f64>(c, MORE))),
        settings: settings();
    mod geodesic_oracle_within = oracle(|c| (geodesic::<f64>(c, WITHIN), geodesic::<f64>(c, WITHIN))),
        settings: settings();
    mod geodesic_oracle_of_few_f32 = oracle(|c| (geodesic::<f32>(c, FEW), geodesic::<f32>(c, FEW))),
        settings: settings();
    mod geodesic_oracle_of_more_f32 = oracle(|c| (geodesic::<f32>(c, MORE), geodesic::<f32>(c, MORE))),
        settings: settings();
    mod geodesic_oracle_within_f32 =
        oracle(|c| (geodesic::<f32>(c, WITHIN), geodesic::<f32>(c, WITHIN))), settings: settings();
}

law_tests! {
    mod principal_components = estimator(&PrincipalComponents::<f64>::new(0.05).unwrap()),
        settings: settings();
    mod principal_components_f32 = estimator(&PrincipalComponents::<f32>::new(0.05).unwrap()),
        settings: usual();
    mod strict_principal_components = estimator(&PrincipalComponents::<f64>::new(0.01).unwrap()),
        settings: settings();
    mod strict_principal_components_f32 = estimator(&PrincipalComponents::<f32>::new(0.01).unwrap()),
        settings: usual();
    mod maximum_likelihood = estimator(&MaximumLikelihood::<f64>::new()), settings: settings();
    mod maximum_likelihood_f32 = estimator(&MaximumLikelihood::<f32>::new()), settings: usual();
    mod correlation_dimension = estimator(&CorrelationDimension::<f64>::new()), settings: settings();
    mod correlation_dimension_f32 = estimator(&CorrelationDimension::<f32>::new()),
        settings: usual();
    mod packing_numbers = estimator(&PackingNumbers::<f64>::new()), settings: settings();
    mod packing_numbers_f32 = estimator(&PackingNumbers::<f32>::new()), settings: usual();
    mod spanning_tree = estimator(&SpanningTree::<f64>::new()), settings: settings();
    mod spanning_tree_f32 = estimator(&SpanningTree::<f32>::new()), settings: usual();
}

/// Instances of so many points.
fn of(points: RangeInclusive<usize>, draw: &dyn Fn(&mut Draw) -> Instance) -> Instances<'_> {
    Instances {
        points,
        ..Instances::new(draw)
    }
}

fn two_planes() -> TwoPlanes {
    TwoPlanes::new(0.1, 0.05).unwrap()
}

/// With the refinement of the paper's equation (5).
fn refined_planes() -> TwoPlanes {
    let mut model = two_planes();
    model.refinement_rounds = 20;
    model
}

fn flat_planes() -> TwoPlanes {
    let mut model = two_planes();
    model.curved = false;
    model
}

law_tests! {
    mod one_sheet = model(&OneSheet, &Instances::new(&instances::flat_sheet)), settings: settings();
    mod two_curved_planes = model(&two_planes(), &Instances::new(&instances::two_planes)),
        settings: settings();
    mod two_refined_planes = model(&refined_planes(), &Instances::new(&instances::two_planes)),
        settings: settings();
    mod two_flat_planes = model(&flat_planes(), &Instances::new(&instances::two_planes)),
        settings: settings();
    // The curve is as sharp as the sample: with fewer points the outermost ones leave wide notches.
    mod boundary = model(&Boundary::new(0.1, 0.05).unwrap(), &of(400..=800, &instances::boundary)),
        settings: settings();
    mod boundary_corner =
        model(&BoundaryCorner::new(0.1, 0.05).unwrap(), &of(CORNERS, &instances::boundary_corner)),
        settings: few();
    mod y_junction =
        model(&YJunction::new(0.1, 0.05).unwrap(), &Instances::new(&instances::y_junction)),
        settings: settings();
    // Pages are read from the normals of small pieces, and two thirds of the points are the neighborhood.
    mod t_junction = model(&Book::new(0.1, 0.05).unwrap(), &of(300..=500, &instances::t_junction)),
        settings: settings();
    mod book = model(&Book::new(0.1, 0.05).unwrap(), &of(600..=900, &instances::book)),
        settings: usual();
    // Two thirds of them are the neighborhood, and the model asks for 48.
    mod triple_point =
        model(&TriplePoint::new(0.1, 0.05).unwrap(), &of(150..=300, &instances::triple_point)),
        settings: settings();
    mod isolated_crossing =
        model(
            &IsolatedCrossing::new(0.1, 0.05).unwrap(),
            &Instances::new(&instances::crossing_in_four_dimensions)
        ),
        settings: settings();
    mod cone_point =
        model(&ConePoint::new(0.1, 0.05).unwrap(), &of(150..=300, &instances::cone_point)),
        settings: settings();
    // A fifth of them are on the line, and two thirds of those in the neighborhood.
    mod curve_through_sheet =
        model(
            &CurveThroughSheet::new(0.1, 0.05).unwrap(),
            &of(150..=400, &instances::line_through_plane)
        ),
        settings: settings();
    mod curve_on_sheet =
        model(&CurveOnSheet::new(0.1, 0.05).unwrap(), &of(150..=400, &instances::line_on_plane)),
        settings: settings();
    mod bare_curve = model(&BareCurve::new(0.1, 0.05).unwrap(), &Instances::new(&instances::curve)),
        settings: settings();
}

/// A corner is told by the points that are not there: a sector with few of them might as well be round. Two thirds of them are the neighborhood.
const CORNERS: RangeInclusive<usize> = 300..=500;

/// A fit is two dozen linear programs.
fn few() -> Settings {
    Settings {
        cases: 64,
        ..settings()
    }
}

/// As corners were told once: empty places of the ball are measured from the row that is asked about.
struct MeasuredFromCenter(BoundaryCorner);

impl MeasuredFromCenter {
    fn about_center<'a>(local: &LocalPoints<'a>) -> LocalPoints<'a> {
        LocalPoints {
            middle: local.center,
            ..*local
        }
    }
}

impl SingularityModel for MeasuredFromCenter {
    fn local_dimension(&self) -> usize {
        self.0.local_dimension()
    }
    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        self.0.decompose(&Self::about_center(local))
    }
    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        self.0.decompose_about(&Self::about_center(local), rows)
    }
    fn name(&self) -> &str {
        "measured-from-center"
    }
}

#[test]
fn a_ball_measured_from_the_center_breaks_a_law() {
    let model = MeasuredFromCenter(BoundaryCorner::new(0.1, 0.05).unwrap());
    let found = laws::model(&few(), &model, &of(CORNERS, &instances::boundary_corner));
    let found = found.unwrap_err();
    let broken: Vec<&str> = found.broken().map(|b| b.law.name).collect();
    assert_eq!(broken, ["about"]);
}

/// Pairs of triangles are quickly tried.
fn many() -> Settings {
    Settings {
        cases: 3000,
        ..settings()
    }
}

law_tests! {
    mod classical_scaling = chart(&ClassicalScaling), settings: settings();
    mod random_greedy = selector(&RandomGreedy::<f64>::new()), settings: settings();
    mod random_greedy_f32 = selector(&RandomGreedy::<f32>::new()), settings: settings();
    mod max_min = selector(&MaxMin::<f64>::new()), settings: settings();
    mod max_min_f32 = selector(&MaxMin::<f32>::new()), settings: settings();
    mod planar_predicate = compatibility(&PlanarPredicate), settings: many();
    mod linear_program = compatibility(&LinearProgramTest), settings: many();
    mod minimum_circumradius = rule(&MinimumCircumradius), settings: settings();
    mod largest_angle = rule(&LargestAngle), settings: settings();
    mod advancing_front = triangulator(&FRONT);
}
