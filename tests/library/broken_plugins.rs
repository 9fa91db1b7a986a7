//! Plug-ins that break the laws of their traits: the pipeline stops, and names plug-in, law and point.

use crosscap::prelude::*;
use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::singularity::{TriplePoint, TwoPlanes};
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, Cells, Ground, Stratification, Stratifier, Tuning,
    WaistProducer,
};
use crosscap_algorithms::surfaces::Random;
use crosscap_algorithms::triangulate::MinimumCircumradius;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::execute::Execute;
use crosscap_core::{
    BallDimension, Balls, Chart, ChartTriangle, CompatibilityTest, CurveEdge, Decomposition,
    DimensionEstimate, Incomplete, Label, Landmark, LocalPoints, Located, Meeting, Neighbor,
    Neighborhood, Rejection, Row, StratifiedLandmarks, TriangleRule, Triangulation,
    TriangulationCounts, Triangulator,
};

const NAME: &str = "the-broken-one";

/// The error is about this plug-in and this law (the beginning of its words) at one of `count` points.
#[track_caller]
fn names<T>(found: Result<T, Error>, words: &str, count: usize) -> String {
    match found {
        Err(Error::Law {
            plugin,
            law,
            point,
            detail,
        }) => {
            assert_eq!(plugin, NAME);
            assert!(
                law.starts_with(words),
                "'{law}' does not start with '{words}'"
            );
            assert!(point < count && !detail.is_empty());
            format!("{law} at {point}: {detail}")
        }
        Err(other) => panic!("expected '{words}', found: {other}"),
        Ok(_) => panic!("expected '{words}', and nothing was found wrong"),
    }
}

fn sphere() -> PointCloud<f64> {
    let sample = SampleSurface::find("sphere")
        .unwrap()
        .sample(&Sampling::new(1200, 3));
    sample.unwrap().points
}

fn on_sphere() -> Pipeline {
    Pipeline::new(Parameters::new(0.6, 0.3)).unwrap()
}

/// Two squares that cross at a right angle.
fn crossing() -> PointCloud<f64> {
    let mut random = Random::new(8);
    let mut rows = Vec::new();
    for k in 0..3000 {
        let (x, y) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        rows.extend(if k % 2 == 0 { [x, y, 0.0] } else { [x, 0.0, y] });
    }
    PointCloud::new(3, rows).unwrap()
}

// Metrics

/// A metric made from the Euclidean one.
struct Bent<F> {
    straight: Euclidean<f64>,
    count: usize,
    bend: F,
}

impl<F: Fn(f64, usize, usize) -> f64 + Sync> MetricSpace for Bent<F> {
    type Scalar = f64;
    fn len(&self) -> usize {
        self.count
    }
    fn distance(&self, a: usize, b: usize) -> f64 {
        (self.bend)(self.straight.distance(a, b), a, b)
    }
    fn name(&self) -> &str {
        NAME
    }
}

fn bent<F: Fn(f64, usize, usize) -> f64 + Sync>(bend: F) -> Bent<F> {
    let cloud = sphere();
    Bent {
        count: cloud.len(),
        straight: Euclidean::new(cloud),
        bend,
    }
}

fn by_metric(bend: impl Fn(f64, usize, usize) -> f64 + Sync + 'static) -> Result<Outcome, Error> {
    on_sphere()
        .triangulation_metric(Box::new(bent(bend)))
        .reconstruct(&sphere())
}

#[test]
fn a_metric_that_is_one_is_not_refused() {
    assert!(by_metric(|d, _, _| d.sqrt()).is_ok());
    assert!(by_metric(|d, _, _| 2.0 * d).unwrap().is_verified());
}

#[test]
fn metrics() {
    names(by_metric(|d, _, _| d * d), "triangle inequality", 1200);
    let found = by_metric(|d, a, b| if a < b { d } else { 1.01 * d });
    names(found, "symmetry", 1200);
    names(
        by_metric(|d, _, _| d + 0.1),
        "identity: distance(a, a)",
        1200,
    );
    names(
        by_metric(|d, _, _| -d),
        "identity: distances are at least 0",
        1200,
    );
    names(by_metric(|_, _, _| f64::NAN), "never NaN", 1200);
    // One point in seven, so that the spot checks may pass it by: what is used is looked at in any case.
    let found = by_metric(|d, a, b| {
        if a % 7 == 3 && a != b && b % 7 == 5 {
            f64::NAN
        } else {
            d
        }
    });
    names(found, "never NaN", 1200);
    let short = Bent {
        count: 7,
        ..bent(|d, _, _| d)
    };
    let found = on_sphere()
        .triangulation_metric(Box::new(short))
        .reconstruct(&sphere());
    assert!(matches!(found, Err(Error::Shape { .. })));
}

fn by_analysis_metric(
    bend: impl Fn(f64, usize, usize) -> f64 + Sync + 'static,
    threads: usize,
) -> Result<Outcome, Error> {
    // Every point is looked at, not the landmarks alone.
    let mut parameters = Parameters::new(0.6, 0.3);
    parameters.threads = Some(threads);
    Pipeline::new(parameters)?
        .analysis_metric(Box::new(bent(bend)))
        .reconstruct(&sphere())
}

/// The angle between two points of the sphere as a formula from a book has it: the arc cosine of the inner
/// product, which rounding makes greater than 1 for some points and themselves, and 0 for none but a few.
fn naive_angle() -> impl Fn(f64, usize, usize) -> f64 + Sync {
    let cloud = sphere();
    move |_, a, b| {
        let (p, q) = (cloud.point(a), cloud.point(b));
        (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]).acos()
    }
}

/// An oracle that is built on a metric has nothing right to say when the metric is none: the metric is named,
/// wherever it is used, and whoever meets the answer first.
#[test]
fn a_metric_is_named_before_the_oracle_around_it() {
    assert!(by_analysis_metric(|d, _, _| d, 0).unwrap().is_verified());
    // No number beyond some distance, in a neighborhood and far outside of every one.
    for limit in [0.4, 1.9] {
        let far = move |d: f64, _: usize, _: usize| if d > limit { f64::NAN } else { d };
        let found = names(by_analysis_metric(far, 1), "never NaN", 1200);
        assert_eq!(found, names(by_analysis_metric(far, 2), "never NaN", 1200));
        names(by_metric(far), "never NaN", 1200);
    }
    // None between two points alone.
    let once = |d: f64, a: usize, b: usize| if (a, b) == (701, 13) { f64::NAN } else { d };
    let found = names(by_analysis_metric(once, 2), "never NaN", 1200);
    assert!(found.contains("at 701") && found.contains("to point 13"));
    let below = |d: f64, a: usize, b: usize| if (a, b) == (701, 13) { -d } else { d };
    names(by_analysis_metric(below, 2), "identity: distances", 1200);
    let angle = naive_angle();
    assert!((0..1200).any(|k| angle(0.0, k, k).is_nan()));
    names(by_analysis_metric(naive_angle(), 2), "never NaN", 1200);
    // Nobody looks at the answers of this one but the spot checks.
    let angle = bent(naive_angle());
    let found = analysis(&angle, &BruteForceOracle::new(&angle));
    assert!(matches!(found, Err(Error::Law { plugin, .. }) if plugin == NAME));
}

/// Two spheres that no path joins, one of them with fewer points than a spot check asks for.
#[test]
fn infinity_is_no_fault() {
    let mut apart = bent(|d, a, b| if (a < 5) == (b < 5) { d } else { f64::INFINITY });
    apart.count = 1200;
    assert_eq!(analysis(&apart, &BruteForceOracle::new(&apart)), Ok(()));
}

fn analysis(
    metric: &dyn MetricSpace<Scalar = f64>,
    oracle: &dyn NeighborhoodOracle<Scalar = f64>,
) -> Result<(), Error> {
    let cloud = sphere();
    let options = AnalysisOptions {
        eps: 0.6,
        surface: true,
        boundary: Vec::new(),
        radii: None,
    };
    let estimator = PrincipalComponents::new(0.05)?;
    let analyzer = Analyzer {
        space: Space::new(metric, oracle).with_places(&cloud),
        estimator: &estimator,
        models: &[],
        execute: &Serial,
        tuning: &Tuning::MEASURED,
    };
    analyzer.analyze(&options).map(|_| ())
}

#[test]
fn metrics_of_the_analysis() {
    let oracle = EuclideanOracle::new(sphere()).unwrap();
    assert!(analysis(&oracle, &oracle).is_ok());
    let lopsided = bent(|d, a, b| if a < b { (1.0 + 1e-12) * d } else { d });
    let found = analysis(&lopsided, &oracle);
    names(found.map_err(as_plugin), "symmetry", 1200);
    let short = Bent {
        count: 7,
        ..bent(|d, _, _| d)
    };
    assert!(matches!(
        analysis(&short, &oracle),
        Err(Error::Shape { .. })
    ));
}

/// Oracles have no name of their own.
fn as_plugin(error: Error) -> Error {
    match error {
        Error::Law {
            plugin,
            law,
            point,
            detail,
        } => {
            assert!(["neighborhood oracle", NAME].contains(&plugin.as_str()));
            Error::Law {
                plugin: NAME.into(),
                law,
                point,
                detail,
            }
        }
        other => other,
    }
}

// Oracles

/// An oracle whose answers are spoilt.
struct Spoilt<F> {
    oracle: EuclideanOracle<f64>,
    spoil: F,
}

impl<F: Fn(&mut Vec<Neighbor<f64>>, bool) + Sync> NeighborhoodOracle for Spoilt<F> {
    type Scalar = f64;
    fn len(&self) -> usize {
        self.oracle.len()
    }
    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        self.oracle.within(center, radius, out);
        (self.spoil)(out, true);
    }
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        self.oracle.nearest(center, count, out);
        (self.spoil)(out, false);
    }
}

#[test]
fn oracles() {
    let oracle = EuclideanOracle::new(sphere()).unwrap();
    let spoilt = |words: &str, spoil: fn(&mut Vec<Neighbor<f64>>, bool)| {
        let oracle_of = Spoilt {
            oracle: EuclideanOracle::new(sphere()).unwrap(),
            spoil,
        };
        names(
            analysis(&oracle, &oracle_of).map_err(as_plugin),
            words,
            1200,
        );
    };
    spoilt("order", |out, _| out.reverse());
    spoilt("equals brute force", |out, _| {
        if let Some(x) = out.last_mut() {
            x.index = 99_999;
        }
    });
    spoilt("strictness: within", |out, within| {
        if within && let Some(x) = out.last_mut() {
            x.distance = 7.0;
        }
    });
    spoilt("strictness: the center", |out, within| {
        if within {
            out.remove(0);
        }
    });
    // A box around the ball is searched too small.
    spoilt("equals brute force", |out, within| {
        if within && out.len() > 4 {
            out.remove(4);
        }
    });
    spoilt("equals brute force", |out, within| {
        if !within {
            out.pop();
        }
    });
    // Squares of distances.
    spoilt("equals brute force", |out, _| {
        out.iter_mut().for_each(|x| x.distance *= 0.5)
    });
}

// Estimators

struct Says(fn(usize) -> DimensionEstimate);

impl DimensionEstimator for Says {
    type Scalar = f64;
    fn estimate(&self, near: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
        Ok((self.0)(near.center))
    }
    fn name(&self) -> &str {
        NAME
    }
}

fn estimate(dimension: usize, value: f64, confidence: f64) -> DimensionEstimate {
    DimensionEstimate {
        dimension,
        value,
        confidence,
        spectrum: Vec::new(),
    }
}

#[test]
fn estimators() {
    let by = |says: fn(usize) -> DimensionEstimate| {
        on_sphere()
            .estimator(Box::new(Says(says)))
            .reconstruct(&sphere())
    };
    assert!(by(|_| estimate(2, 2.2, 0.5)).unwrap().is_verified());
    // More than the space has, by chance, counts as much as the space has: no surface, but no broken law.
    assert!(matches!(
        by(|_| estimate(4, 3.6, 0.1)),
        Ok(_) | Err(Error::Dimension { .. })
    ));
    names(
        by(|_| estimate(2, f64::NAN, 1.0)),
        "answer: the value",
        1200,
    );
    names(by(|_| estimate(0, -0.2, 1.0)), "answer: the value", 1200);
    names(
        by(|_| estimate(2, 2.0, 1.5)),
        "answer: the confidence",
        1200,
    );
    names(
        by(|_| estimate(2, 2.0, f64::NAN)),
        "answer: the confidence",
        1200,
    );
    names(
        by(|_| estimate(3, 2.0, 1.0)),
        "rounded: the dimension is",
        1200,
    );
    names(
        by(|_| estimate(5000, 5000.0, 1.0)),
        "answer: k points",
        1200,
    );
    // A single point.
    let found = by(|i| estimate(if i == 700 { 1 } else { 2 }, 2.0, 1.0));
    assert!(names(found, "rounded", 1200).contains(" at 700: "));
}

/// What is wrong with answers for all balls together.
#[derive(Clone, Copy)]
enum Batch {
    Good,
    Short,
    Other,
    Many,
}

struct SaysOfAll(Batch);

impl DimensionEstimator for SaysOfAll {
    type Scalar = f64;
    fn estimate(&self, _near: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
        Ok(estimate(2, 2.0, 1.0))
    }
    fn estimate_all(
        &self,
        balls: &Balls<'_, f64>,
        _execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        let (count, dimension) = match self.0 {
            Batch::Good => (balls.len(), 2),
            Batch::Short => (balls.len() - 1, 2),
            Batch::Other => (balls.len(), 3),
            Batch::Many => (balls.len(), 40),
        };
        let ball = BallDimension {
            neighbors: 40,
            dimension,
        };
        Ok(vec![ball; count])
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn estimators_of_all_balls_together() {
    let by = |batch| {
        on_sphere()
            .estimator(Box::new(SaysOfAll(batch)))
            .reconstruct(&sphere())
    };
    assert!(by(Batch::Good).unwrap().is_verified());
    names(by(Batch::Short), "batch: an answer for every ball", 1200);
    names(by(Batch::Other), "batch: of all balls together", 1200);
    names(by(Batch::Many), "answer: k points", 1200);
}

// Triangulators and stratifiers

/// A triangulator that gives up everywhere, with what is wrong.
struct Lost(fn(&mut Triangulation));

impl Triangulator<f64> for Lost {
    fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
        let count = waist.strata().len();
        let open = waist.strata().ids().map(|landmark| Incomplete { landmark });
        let mut found = Triangulation {
            complex: Complex::new(count, vec![], waist.curve_edges().to_vec())?,
            dropped: vec![],
            incomplete: open.collect(),
            counts: TriangulationCounts::default(),
        };
        (self.0)(&mut found);
        Ok(found)
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn triangulators() {
    let by = |wrong| {
        on_sphere()
            .triangulator(Box::new(Lost(wrong)))
            .reconstruct(&sphere())
    };
    // Without a triangle there is no surface, but no law is broken.
    assert!(!matches!(by(|_| ()), Err(Error::Law { .. })));
    let far = by(|t| {
        let last = t.complex.vertices as u32 - 1;
        t.complex.triangles.push([0, 1, last]);
    });
    names(far, "answer: the corners of a triangle", 1200);
    names(by(|t| t.complex.vertices += 1), "answer: the complex", 1200);
    let edge = by(|t| t.complex.curve_edges.push(CurveEdge::new(0, 1, 4)));
    names(edge, "answer: the curve edges", 1200);
    names(
        by(|t| t.dropped = [3, 2].map(Landmark::new).to_vec()),
        "answer: what was dropped",
        1200,
    );
}

/// The usual way to the waist with a last step that spoils it.
struct Astray(fn(&mut Stratification<f64>));

struct Spoiling<'p> {
    usual: Box<dyn WaistProducer<f64> + 'p>,
    spoil: fn(&mut Stratification<f64>),
}

impl Stratifier<f64> for Astray {
    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, f64>,
        analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<f64> + 'p>, Error> {
        Ok(Box::new(Spoiling {
            usual: Cells.cut(ground, analysis)?,
            spoil: self.0,
        }))
    }
    fn name(&self) -> &str {
        NAME
    }
}

impl WaistProducer<f64> for Spoiling<'_> {
    fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error> {
        let mut waist = self.usual.waist(extra)?;
        (self.spoil)(&mut waist);
        Ok(waist)
    }
}

#[test]
fn stratifiers() {
    let by = |wrong| {
        on_sphere()
            .stratifier(Box::new(Astray(wrong)))
            .reconstruct(&sphere())
    };
    assert!(by(|_| ()).unwrap().is_verified());
    const FIFTH: Landmark = Landmark::new(5);
    let law = "answer: every landmark stands for a row";
    names(by(|s| s.rows[FIFTH] = s.rows[Landmark::new(4)]), law, 1200);
    names(by(|s| s.rows[FIFTH] = Row::new(1200)), law, 1200);
    names(by(|s| s.rows.truncate(5)), law, 1200);
}

// Singularity models

/// Two planes with a last step that spoils the answer.
struct Tampered<M> {
    model: M,
    tamper: fn(&mut Decomposition, &LocalPoints<'_>),
}

impl<M: SingularityModel> SingularityModel for Tampered<M> {
    fn local_dimension(&self) -> usize {
        3
    }
    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let mut found = self.model.decompose(local)?;
        (self.tamper)(&mut found, local);
        Ok(found)
    }
    fn name(&self) -> &str {
        NAME
    }
}

fn by_model(
    tamper: fn(&mut Decomposition, &LocalPoints<'_>),
    threads: usize,
) -> Result<Outcome, Error> {
    let mut parameters = Parameters::new(0.3, 0.15);
    parameters.threads = Some(threads);
    let model = TwoPlanes::new(parameters.dp, parameters.ep)?;
    Pipeline::new(parameters)?
        .models(vec![Box::new(Tampered { model, tamper })])
        .reconstruct(&crossing())
}

/// Three squares that cross in a point.
fn triple() -> PointCloud<f64> {
    let mut random = Random::new(9);
    let mut rows = Vec::new();
    for k in 0..4000 {
        let mut row = [random.between(-0.6, 0.6), random.between(-0.6, 0.6), 0.0];
        row.rotate_right(k % 3);
        rows.extend(row);
    }
    PointCloud::new(3, rows).unwrap()
}

fn by_point_model(tamper: fn(&mut Decomposition, &LocalPoints<'_>)) -> Result<Outcome, Error> {
    let parameters = Parameters::new(0.3, 0.15);
    let planes = TwoPlanes::new(parameters.dp, parameters.ep)?;
    let model = TriplePoint::new(parameters.dp, parameters.ep)?;
    Pipeline::new(parameters)?
        .models(vec![Box::new(planes), Box::new(Tampered { model, tamper })])
        .reconstruct(&triple())
}

#[test]
fn models_of_points() {
    assert!(by_point_model(|_, _| {}).is_ok());
    let spoilt = |words: &str, tamper: fn(&mut Decomposition, &LocalPoints<'_>)| {
        names(by_point_model(tamper), words, 4000)
    };
    spoilt("points: no farther", |fit, local| {
        fit.points[0][0] += 5.0 * local.radius
    });
    spoilt("points: a place", |fit, _| fit.points.clear());
    spoilt("cells_at_curve", |fit, _| fit.cells_at_curve[3] = 25);
    // The place of the center is not that of the point that it is said to be on.
    spoilt("a center on a stratum of dimension 0", |fit, local| {
        fit.points[0][1] += 0.1 * local.radius
    });
}

#[test]
fn a_model_that_is_not_tampered_with_is_not_refused() {
    assert!(by_model(|_, _| {}, 0).is_ok());
}

#[test]
fn models() {
    let spoilt = |words: &str, tamper: fn(&mut Decomposition, &LocalPoints<'_>)| {
        let found = names(by_model(tamper, 1), words, 3000);
        // The same point for any number of threads.
        assert_eq!(found, names(by_model(tamper, 2), words, 3000));
    };
    // Points missed, counted twice, in a stratum that is not there.
    spoilt("partition", |fit, _| {
        fit.labels.pop();
    });
    spoilt("partition", |fit, _| fit.labels.push(Label::new(1)));
    spoilt("partition", |fit, _| {
        if let Some(label) = fit.labels.last_mut() {
            *label = Label::new(200);
        }
    });
    spoilt("partition", |fit, _| fit.strata.truncate(2));
    // The points that are only labelled, forgotten.
    spoilt("partition", |fit, local| fit.labels.truncate(local.fitted));
    spoilt("strata of lowest dimension first", |fit, _| {
        fit.strata.reverse()
    });
    spoilt("strata of lowest dimension first", |fit, _| {
        if let Some(stratum) = fit.strata.last_mut() {
            stratum.dimension = 3;
        }
    });
    spoilt("cells_at_curve", |fit, _| fit.cells_at_curve.clear());
    spoilt("cells_at_curve", |fit, _| fit.cells_at_curve.push(4));
    spoilt("cells_at_curve", |fit, _| fit.cells_at_curve[0] = 0);
    spoilt("cells_at_curve", |fit, _| fit.cells_at_curve[0] = 9);
    spoilt("points", |fit, _| fit.points.push(vec![0.0; 3]));
    spoilt("the residual", |fit, _| fit.residual = -1e-3);
    spoilt("the residual", |fit, _| fit.residual = f64::NAN);
    spoilt("the center offset", |fit, _| fit.center_offset = f64::NAN);
    spoilt("the center has", |fit, _| fit.center[1] = f64::NAN);
    spoilt("the center has", |fit, _| fit.center.push(0.0));
    spoilt("the center offset is how far", |fit, local| {
        fit.center[0] += 5.0 * local.radius
    });
    spoilt("the center offset of a center on", |fit, local| {
        fit.center[0] += 5.0 * local.radius;
        if fit.center_offset.is_finite() {
            let own = local.point(local.center);
            fit.center_offset = crosscap_core::squared_distance(own, &fit.center).sqrt();
        } else {
            fit.center = local.point(local.center).to_vec();
        }
    });
    // A place for one in a cell where nothing is known.
    spoilt("the center offset is how far", |fit, local| {
        if fit.center_offset == f64::INFINITY {
            fit.center[0] += 0.1 * local.radius
        }
    });
}

#[test]
fn a_model_without_coordinates() {
    struct Nowhere;
    impl SingularityModel for Nowhere {
        fn local_dimension(&self) -> usize {
            0
        }
        fn decompose(&self, _: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
            Err(Rejection::NoRealSolution)
        }
        fn name(&self) -> &str {
            NAME
        }
    }
    let found = Pipeline::new(Parameters::new(0.3, 0.15))
        .unwrap()
        .models(vec![Box::new(Nowhere)])
        .reconstruct(&crossing());
    names(found, "local_dimension", 3000);
}

#[test]
fn a_model_that_locates_rows_nowhere() {
    struct Lost(TwoPlanes);
    impl SingularityModel for Lost {
        fn local_dimension(&self) -> usize {
            3
        }
        fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
            self.0.decompose(local)
        }
        fn decompose_about(
            &self,
            local: &LocalPoints<'_>,
            rows: &[usize],
        ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
            let (fit, mut found) = self.0.decompose_about(local, rows)?;
            for x in found.iter_mut().flatten() {
                x.place[2] = f64::NAN;
            }
            Ok((fit, found))
        }
        fn name(&self) -> &str {
            NAME
        }
    }
    let parameters = Parameters::new(0.3, 0.15);
    let planes = TwoPlanes::new(parameters.dp, parameters.ep).unwrap();
    let found = Pipeline::new(parameters)
        .unwrap()
        .models(vec![Box::new(Lost(planes))])
        .reconstruct(&crossing());
    names(found, "decompose_about", 3000);
}

// Charts

struct Torn(fn(&mut Chart));

impl LocalChart for Torn {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        let mut chart = ClassicalScaling.chart(count, distances, dimension)?;
        (self.0)(&mut chart);
        Ok(chart)
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn charts() {
    let by = |tear: fn(&mut Chart)| {
        on_sphere()
            .chart(Box::new(Torn(tear)))
            .reconstruct(&sphere())
    };
    assert!(by(|_| {}).unwrap().is_verified());
    names(by(|chart| chart.coordinates[3] = f64::NAN), "finite", 1200);
    names(
        by(|chart| chart.coordinates[3] = f64::INFINITY),
        "finite",
        1200,
    );
    names(by(|chart| chart.coordinates.truncate(6)), "finite", 1200);
    names(by(|chart| chart.coordinates.push(0.0)), "finite", 1200);
    names(by(|chart| chart.dimension = 3), "finite", 1200);
    names(by(|chart| chart.distortion = f64::NAN), "distortion", 1200);
    names(by(|chart| chart.distortion = 1.5), "distortion", 1200);
}

// Selectors

struct Chooses(fn(Vec<usize>, &[usize]) -> Vec<usize>);

impl LandmarkSelector for Chooses {
    type Scalar = f64;
    fn select(
        &self,
        oracle: &dyn NeighborhoodOracle<Scalar = f64>,
        candidates: &[usize],
        taken: &[usize],
        separation: f64,
        seed: u64,
    ) -> Result<Vec<usize>, Error> {
        let good = RandomGreedy::new().select(oracle, candidates, taken, separation, seed)?;
        Ok((self.0)(good, candidates))
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn selectors() {
    let by = |choose: fn(Vec<usize>, &[usize]) -> Vec<usize>| {
        on_sphere()
            .selector(Box::new(Chooses(choose)))
            .reconstruct(&sphere())
    };
    assert!(by(|good, _| good).unwrap().is_verified());
    names(by(|_, all| all.to_vec()), "separation", 1200);
    let too_many = |good: Vec<usize>, all: &[usize]| {
        let one_more = all.iter().copied().find(|i| !good.contains(i));
        good.into_iter().chain(one_more).collect()
    };
    names(by(too_many), "separation", 1200);
    names(
        by(|mut good, _| {
            good.pop();
            good
        }),
        "covering",
        1200,
    );
    names(by(|_, _| Vec::new()), "covering", 1200);
    names(
        by(|mut good, _| {
            good.push(good[0]);
            good
        }),
        "landmarks are different",
        1200,
    );
    let beyond = by(|mut good, _| {
        good.push(99_999);
        good
    });
    names(beyond, "landmarks are different", usize::MAX);
}

// Compatibility tests and triangle rules

struct Answers(fn(&ChartTriangle, &ChartTriangle) -> Meeting);

impl CompatibilityTest for Answers {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        (self.0)(a, b)
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn compatibility_tests() {
    let by = |answer: fn(&ChartTriangle, &ChartTriangle) -> Meeting| {
        on_sphere()
            .compatibility(Box::new(Answers(answer)))
            .reconstruct(&sphere())
    };
    assert!(
        by(|a, b| PlanarPredicate.meeting(a, b))
            .unwrap()
            .is_verified()
    );
    // A corner of the first in the second is looked for, not the other way round.
    let half = |a: &ChartTriangle, b: &ChartTriangle| {
        if a.corners.iter().min() < b.corners.iter().min() {
            PlanarPredicate.meeting(a, b)
        } else {
            Meeting::CommonFace
        }
    };
    names(by(half), "symmetry", 1200);
    names(by(|_, _| Meeting::Disjoint), "reference", 1200);
    names(by(|_, _| Meeting::Overlap), "reference", 1200);
    // Right but for triangles with large numbers, which no known pair has.
    let late = |a: &ChartTriangle, b: &ChartTriangle| {
        if a.corners[0].index() > 20 && b.corners[1].index() > 40 {
            Meeting::Overlap
        } else {
            PlanarPredicate.meeting(a, b)
        }
    };
    names(by(late), "symmetry", 1200);
}

struct Ranks(fn(f64, f64, f64) -> f64);

impl TriangleRule for Ranks {
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
        (self.0)(edge, a, b)
    }
    fn name(&self) -> &str {
        NAME
    }
}

#[test]
fn triangle_rules() {
    let by = |rank: fn(f64, f64, f64) -> f64| {
        on_sphere()
            .rule(Box::new(Ranks(rank)))
            .reconstruct(&sphere())
    };
    assert!(by(|e, a, b| MinimumCircumradius.rank(e, a, b)).is_ok());
    names(by(|_, _, _| f64::NAN), "degenerate: never NaN", 1200);
    // The square root of what rounding makes negative.
    names(by(|e, a, b| (a + b - 1.2 * e).sqrt()), "degenerate", 1200);
    names(
        by(|e, a, b| if e < a + b { a } else { f64::INFINITY }),
        "symmetry",
        1200,
    );
    names(
        by(|_, a, b| a + b),
        "degenerate: a triangle without area",
        1200,
    );
}
