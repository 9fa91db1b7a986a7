//! From a point cloud to a verified surface: the parts put together with good defaults.

use crate::given::GivenSpace;
use crate::spaces::{
    Custom, Engines, MetricName, Neighborhoods, Spaces, Warning, custom, positions,
};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, LinkKind, SpecialPoint, Verdict, certify, certify_by_distances,
};
use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::homology::{Homology, homology};
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::moments::MomentTree;
use crosscap_algorithms::neighborhood::{
    FlatRadius, NearestCount, NeighborhoodPolicy, PolicyOracle, Surroundings,
};
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::singularity::ModelName;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, ChartSpace, Dimensions, Published, Role, Stratification,
    StratifyCounts, StratifyOptions, stratify,
};
use crosscap_algorithms::triangulate::{
    LargestAngle, MinimumCircumradius, Rules, Triangulation, TriangulationCounts, Triangulator,
};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::geodesic::GraphReport;
use crosscap_backends::parallel::Threads;
use crosscap_core::{
    CompatibilityTest, Complex, CurveEdge, DimensionEstimator, Error, LandmarkSelector, LocalChart,
    Mesh, MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, SingularityModel,
    StratifiedLandmarks, TriangleRule,
};
use serde::Serialize;
use std::fmt;
use std::str::FromStr;
use std::time::Instant;

/// Which algorithm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Cells cut along the curves, repairs, refinement: what the measurements say works.
    #[default]
    Cells,
    /// The algorithm of Martin & Watson (2011) to the letter, for comparison: see [`Published`] and
    /// [`Rules::PAPER`]. Models and triangle rule of the builder are not used.
    Paper,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cells => "cells",
            Self::Paper => "paper",
        })
    }
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "cells" => Ok(Self::Cells),
            "paper" => Ok(Self::Paper),
            other => Err(Error::Parameter {
                name: "method",
                value: other.into(),
                expected: "cells or paper".into(),
            }),
        }
    }
}

/// Parameters of a reconstruction, all lengths in the unit of the data.
#[derive(Clone, Debug, Serialize)]
pub struct Parameters {
    /// Radius of the neighborhoods in which dimension and crossings are looked for (strict).
    pub eps: f64,
    /// Largest radius of the charts (strict). Charts reach 3 dl, or less where this is
    /// smaller; beyond that a chart only bends more. A chart with few landmarks is widened.
    /// With the paper's method the radius itself, eps when left out.
    pub tri_eps: Option<f64>,
    /// Dimension tolerance: share of the variance that may lie outside the dimension (strict).
    pub dt: f64,
    /// Fit tolerance: largest root mean squared distance of a neighborhood to its model.
    pub dp: f64,
    /// Curve tolerance eps_p: a point closer than this to both sheets is on the curve (strict).
    pub ep: f64,
    /// Landmark separation.
    pub dl: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
    /// Take every point as 2-dimensional and look for no crossing.
    pub surface: bool,
    /// Rows of points on the boundary.
    pub boundary: Vec<usize>,
    /// Singularity models that compete, by name.
    pub models: Vec<ModelName>,
    /// Which algorithm.
    pub method: Method,
    /// Metrics and neighborhoods.
    #[serde(skip_serializing_if = "Spaces::are_usual")]
    pub spaces: Spaces,
    /// Number of threads, all processors when left out; changes no result.
    pub threads: Option<usize>,
}

impl Parameters {
    /// Parameters with the given radius and separation; dt 0.05, dp eps/5, eps_p eps/10.
    pub fn new(eps: f64, dl: f64) -> Self {
        Self {
            eps,
            tri_eps: None,
            dt: 0.05,
            dp: eps / 5.0,
            ep: eps / 10.0,
            dl,
            seed: 0,
            surface: false,
            boundary: Vec::new(),
            models: vec![ModelName::TwoPlanes],
            method: Method::default(),
            spaces: Spaces::default(),
            threads: None,
        }
    }

    /// The same, taking every point as 2-dimensional.
    pub fn surface(mut self) -> Self {
        self.surface = true;
        self
    }

    /// Radius of the charts.
    pub fn chart_radius(&self) -> f64 {
        let usual = CHART_SEPARATIONS * self.dl;
        match self.method {
            Method::Cells if self.spaces.wide_charts => self.tri_eps.unwrap_or(usual),
            Method::Cells => self.tri_eps.map_or(usual, |radius| radius.min(usual)),
            Method::Paper => self.tri_eps.unwrap_or(self.eps),
        }
    }

    /// Checks every parameter alone and against the others.
    ///
    /// # Errors
    /// [`Error::Parameter`] for the first that has no meaning.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |name: &'static str, value: f64, expected: &str| {
            Err(Error::Parameter {
                name,
                value: value.to_string(),
                expected: expected.into(),
            })
        };
        let lengths = [
            ("eps", self.eps),
            ("tri-eps", self.chart_radius()),
            ("dp", self.dp),
            ("ep", self.ep),
            ("dl", self.dl),
        ];
        for (name, value) in lengths {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(name, value, "a positive length");
            }
        }
        if !(self.dt > 0.0 && self.dt < 1.0) {
            return refuse("dt", self.dt, "a number strictly between 0 and 1");
        }
        if self.chart_radius() <= self.dl {
            return refuse(
                "tri-eps",
                self.chart_radius(),
                "more than dl: a chart of one landmark holds no triangle",
            );
        }
        let band = !self.surface || self.models.contains(&ModelName::Boundary);
        if band && self.ep >= self.eps {
            return refuse(
                "ep",
                self.ep,
                "less than eps: the band of the curve lies inside the neighborhood",
            );
        }
        self.spaces.check()
    }
}

/// Charts reach this many landmark separations.
const CHART_SEPARATIONS: f64 = 3.0;
/// A triangle whose middle strays farther than this many dl from the surface gets another landmark.
const STRAY: f64 = 0.4;
/// A landmark that is added keeps at least this many dl to the others.
const ADDED_SEPARATION: f64 = 0.4;
/// Rounds of refinement.
const REFINEMENTS: usize = 4;

/// A step of the way, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Building the neighborhood oracle.
    Index,
    /// Dimension and crossings at every point.
    Neighborhoods,
    /// Landmarks, chains and cells.
    Landmarks,
    /// Stars and repairs.
    Triangulation,
    /// Betti numbers, torsion, pieces.
    Homology,
    /// The verdict.
    Certificate,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Index => "index",
            Self::Neighborhoods => "neighborhoods",
            Self::Landmarks => "landmarks",
            Self::Triangulation => "triangulation",
            Self::Homology => "homology",
            Self::Certificate => "certificate",
        })
    }
}

/// Counts and times of a reconstruction.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of this program.
    pub version: &'static str,
    /// The parameters.
    pub parameters: Parameters,
    /// Points of the input.
    pub points: usize,
    /// N.
    pub dimension: usize,
    /// Points that coincide with an earlier one and were left out.
    pub duplicates: usize,
    /// What told the local dimension; none where every point was taken as 2-dimensional.
    pub estimator: Option<String>,
    /// Mean number of points in a neighborhood.
    pub mean_neighbors: f64,
    /// Points whose neighborhood is not 2-dimensional.
    pub candidates: usize,
    /// Points found on curves.
    pub curve_points: usize,
    /// Points whose neighborhood no model explained.
    pub unexplained: usize,
    /// Landmarks, chains, cells.
    pub landmarks: StratifyCounts,
    /// Landmarks added where triangles strayed from the points.
    pub added_landmarks: usize,
    /// Visits and repairs.
    pub triangulation: TriangulationCounts,
    /// How much the charts lose.
    pub chart_distortion: Distortion,
    /// The graph of geodesic distances, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graph: Option<GraphReport>,
    /// What became of distances that were the only input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub given: Option<GivenSpace>,
    /// What may be wrong although nothing failed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// Seconds spent in each stage, in order.
    pub seconds: Vec<(Stage, f64)>,
}

/// What a reconstruction yields, verified or not.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The mesh; vertices on double curves lie on the curve, beside their input point.
    pub mesh: Mesh,
    /// Betti numbers and torsion.
    pub homology: Homology,
    /// Every level of validity with its violations.
    pub certificate: Certificate,
    /// What the surface is, where the crossing can be undone.
    pub pieces: Result<Pieces, PiecesError>,
    /// Counts and times.
    pub report: Report,
    /// Where the triangulation could not be completed, with the parameter to change.
    pub failures: Vec<Error>,
}

impl Outcome {
    /// Whether the mesh may be handed over as good.
    pub fn is_verified(&self) -> bool {
        self.failures.is_empty() && matches!(self.certificate.verdict(), Verdict::Verified)
    }
}

/// Called at the beginning of every stage.
type StageObserver = Box<dyn FnMut(Stage)>;
/// Called for every warning.
type WarningObserver = Box<dyn FnMut(&Warning)>;

/// A reconstruction put together from parts, each of which can be replaced.
///
/// ```
/// use crosscap::prelude::*;
/// let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
/// let outcome = Pipeline::new(Parameters::new(0.4, 0.2).surface())?.reconstruct(&sample.points)?;
/// assert!(outcome.is_verified());
/// assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Pipeline {
    parameters: Parameters,
    models: Vec<Box<dyn SingularityModel>>,
    estimator: Option<Box<dyn DimensionEstimator<Scalar = f64>>>,
    selector: Box<dyn LandmarkSelector<Scalar = f64>>,
    chart: Box<dyn LocalChart>,
    test: Box<dyn CompatibilityTest>,
    rule: Box<dyn TriangleRule>,
    analysis_metric: Option<Custom>,
    chart_metric: Option<Custom>,
    observer: StageObserver,
    warned: WarningObserver,
}

impl Pipeline {
    /// The default parts for these parameters: PCA, two planes, random landmarks, classical
    /// scaling, exact planar predicate, largest angle.
    ///
    /// # Errors
    /// Those of [`Parameters::check`].
    pub fn new(parameters: Parameters) -> Result<Self, Error> {
        parameters.check()?;
        Ok(Self {
            models: parameters
                .models
                .iter()
                .map(|name| name.model(parameters.dp, parameters.ep))
                .collect::<Result<_, _>>()?,
            estimator: None,
            selector: Box::new(RandomGreedy::new()),
            chart: Box::new(ClassicalScaling),
            test: Box::new(PlanarPredicate),
            rule: Box::new(LargestAngle),
            analysis_metric: None,
            chart_metric: None,
            observer: Box::new(|_| {}),
            warned: Box::new(|_| {}),
            parameters,
        })
    }

    /// Singularity models that compete instead of those that the parameters name.
    pub fn models(mut self, models: Vec<Box<dyn SingularityModel>>) -> Self {
        self.models = models;
        self
    }

    /// Another dimension estimator than principal components with tolerance dt, which is
    /// computed for all points together from the moments of a search tree.
    pub fn estimator(mut self, estimator: Box<dyn DimensionEstimator<Scalar = f64>>) -> Self {
        self.estimator = Some(estimator);
        self
    }

    /// Another landmark selector.
    pub fn selector(mut self, selector: Box<dyn LandmarkSelector<Scalar = f64>>) -> Self {
        self.selector = selector;
        self
    }

    /// Another chart.
    pub fn chart(mut self, chart: Box<dyn LocalChart>) -> Self {
        self.chart = chart;
        self
    }

    /// Another compatibility test.
    pub fn compatibility(mut self, test: Box<dyn CompatibilityTest>) -> Self {
        self.test = test;
        self
    }

    /// Another order in which triangles are tried.
    pub fn rule(mut self, rule: Box<dyn TriangleRule>) -> Self {
        self.rule = rule;
        self
    }

    /// A metric of your own for the analysis, on the rows of the input: neighborhoods, landmarks, cells.
    /// Neighborhoods are found by looking at every point. Coordinates still come from the cloud.
    pub fn analysis_metric(mut self, metric: Box<dyn MetricSpace<Scalar = f64>>) -> Self {
        self.analysis_metric = Some(Custom::new(metric));
        self
    }

    /// A metric of your own for the charts, on the rows of the input: which landmarks are in a chart, and
    /// the distances that it is laid out from.
    pub fn triangulation_metric(mut self, metric: Box<dyn MetricSpace<Scalar = f64>>) -> Self {
        self.chart_metric = Some(Custom::new(metric));
        self
    }

    /// Calls `observer` at the beginning of every stage.
    pub fn on_stage(mut self, observer: impl FnMut(Stage) + 'static) -> Self {
        self.observer = Box::new(observer);
        self
    }

    /// Calls `observer` for every warning as soon as it is known, also where there is no outcome later.
    pub fn on_warning(mut self, observer: impl FnMut(&Warning) + 'static) -> Self {
        self.warned = Box::new(observer);
        self
    }

    /// Reconstructs the surface that `cloud` was sampled from.
    ///
    /// # Errors
    /// Input that cannot be worked on ([`Error::is_input`]), or a stage that failed before there was
    /// a mesh. A mesh that is not good comes back in the outcome, unverified.
    pub fn reconstruct(&mut self, cloud: &PointCloud<f64>) -> Result<Outcome, Error> {
        self.run(cloud, None)
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// With `given` distances, those of the places of the cloud are used for nothing.
    pub(crate) fn run(
        &mut self,
        cloud: &PointCloud<f64>,
        given: Option<ChartSpace<'_, f64>>,
    ) -> Result<Outcome, Error> {
        let mut clock = Clock::default();
        let parameters = self.parameters.clone();
        self.enter(Stage::Index, &mut clock);
        if cloud.dimension() < 2 {
            return Err(Error::Shape {
                found: format!("points of R^{}", cloud.dimension()),
                expected: "at least 2 coordinates".into(),
            });
        }
        let kept = first_of_each(cloud);
        let duplicates = cloud.len() - kept.len();
        let whole = cloud;
        // The metric knows the rows as they are, copies included.
        let own_metric =
            given.is_some() || self.analysis_metric.is_some() || self.chart_metric.is_some();
        for custom in [&self.analysis_metric, &self.chart_metric]
            .into_iter()
            .flatten()
        {
            let count = custom.metric().len();
            if count != cloud.len() {
                return Err(Error::Shape {
                    found: format!("a metric on {count} points"),
                    expected: format!("{}, as many as there are", cloud.len()),
                });
            }
        }
        let (cloud, rows) = if duplicates == 0 || own_metric {
            (cloud.clone(), (0..cloud.len()).collect())
        } else {
            (cloud.select(&kept), kept)
        };
        if cloud.len() < LEAST_POINTS {
            return Err(Error::Shape {
                found: format!("{} different points", cloud.len()),
                expected: format!("at least {LEAST_POINTS}"),
            });
        }
        let boundary = boundary_rows(&parameters.boundary, &rows, whole)?;
        let threads = Threads::new(parameters.threads.unwrap_or(0))?;
        let flat_dimension = cloud.dimension();
        let engines = Engines::new(&parameters.spaces, parameters.eps, &cloud, &threads)?;
        let warnings = engines.warnings();
        warnings.iter().for_each(|warning| self.warn(warning));

        self.enter(Stage::Neighborhoods, &mut clock);
        // From here on the points as the analysis sees them.
        let cloud = &engines.cloud;
        let oracle = &engines.euclidean;
        let own_space = given.or(self.analysis_metric.as_ref().map(custom));
        let space = own_space.unwrap_or_else(|| engines.analysis());
        let own_charts = self.chart_metric.as_ref().map(custom).or(given);
        let charts = own_charts.or_else(|| engines.charts());
        // Balls of one radius in straight lines are what the moments are of.
        let usual = self.analysis_metric.is_none()
            && parameters.spaces.metric != MetricName::Geodesic
            && parameters.spaces.neighborhoods == Neighborhoods::Radius;
        let known = match self.estimator {
            None if !parameters.surface && usual => MomentTree::with(cloud, &threads)?
                .settled_dimensions(parameters.eps, parameters.dt, &threads)?,
            _ => Vec::new(),
        };
        let principal = PrincipalComponents::new(parameters.dt)?;
        let estimator: &dyn DimensionEstimator<Scalar = f64> =
            self.estimator.as_deref().unwrap_or(&principal);
        let analyzer = Analyzer {
            cloud,
            metric: space.metric,
            oracle: space.oracle,
            dimensions: if known.is_empty() {
                Dimensions::Estimator(estimator)
            } else {
                Dimensions::Known(&known)
            },
            models: &self.models,
            execute: &threads,
        };
        let literal = (parameters.method == Method::Paper).then(|| Published {
            eps: parameters.eps,
            tri_eps: parameters.chart_radius(),
            dp: parameters.dp,
            ep: parameters.ep,
            dl: parameters.dl,
            seed: parameters.seed,
            surface: parameters.surface,
            boundary: boundary.clone(),
        });
        let analysis = match &literal {
            Some(published) => published.analyze(&analyzer)?,
            None => analyzer.analyze(&AnalysisOptions {
                eps: parameters.eps,
                radii: radii(&parameters, &space, cloud, estimator, &threads)?,
                surface: parameters.surface,
                boundary,
                dt: parameters.dt,
            })?,
        };

        let mut extra: Vec<usize> = Vec::new();
        let mut observer = std::mem::replace(&mut self.observer, Box::new(|_| {}));
        let watched = Watched::new(self.chart.as_ref());
        let (analysis, stratification, triangulation) = loop {
            clock.enter(Stage::Landmarks);
            observer(Stage::Landmarks);
            let mut analysis = analysis.clone();
            let stratification = match &literal {
                Some(published) => published.stratify(
                    &analyzer,
                    &analysis,
                    charts.as_ref().map(|charts| charts.metric),
                    self.selector.as_ref(),
                    self.chart.as_ref(),
                )?,
                None => stratify(
                    &analyzer,
                    &mut analysis,
                    charts.as_ref(),
                    self.selector.as_ref(),
                    &StratifyOptions {
                        dl: parameters.dl,
                        tri_eps: parameters.chart_radius(),
                        seed: parameters.seed,
                        extra: extra.clone(),
                    },
                )?,
            };
            clock.enter(Stage::Triangulation);
            observer(Stage::Triangulation);
            let triangulation = self
                .triangulator(&watched)
                .triangulate(&stratification.waist)
                .map_err(|error| at_input_row(error, &stratification.rows, &rows))?;
            let before = extra.len();
            // What cannot be triangulated is not mended by more landmarks.
            let sound = triangulation.incomplete.len() * 100 <= stratification.rows.len();
            let rounds = clock.rounds(Stage::Triangulation);
            if sound && literal.is_none() && given.is_none() && rounds <= REFINEMENTS {
                add_where_astray(
                    oracle,
                    &analysis,
                    &stratification,
                    &triangulation.complex,
                    parameters.dl,
                    &mut extra,
                );
            }
            if extra.len() == before {
                break (analysis, stratification, triangulation);
            }
        };
        self.observer = observer;
        let chart_distortion = watched.distortion();

        self.enter(Stage::Homology, &mut clock);
        let mesh = mesh_of(&triangulation.complex, &stratification, &analysis, &rows)?;
        let betti = homology(&mesh.complex)?;
        let parts = pieces(&mesh);
        self.enter(Stage::Certificate, &mut clock);
        let points = cloud.cast::<f64>();
        let unused: Vec<usize> = triangulation
            .dropped
            .iter()
            .map(|&k| rows[stratification.rows[k as usize]])
            .collect();
        let special = special_points(&mesh, &stratification, &rows);
        let options = CertificateOptions {
            points: Some(&points),
            landmark_separation: Some(parameters.dl),
            unused_landmarks: &unused,
            special_points: &special,
            closed: parameters.boundary.is_empty()
                && !self.models.iter().any(|m| m.finds_boundary()),
            ..CertificateOptions::default()
        };
        let certificate = match &given {
            None => certify(&mesh, &options),
            Some(space) => certify_by_distances(&mesh, space.metric, space.oracle, &options),
        };
        // A star that stayed open in its own chart may be complete all the same; whether it is, the
        // certificate has seen edge by edge and link by link.
        let complete = literal.is_none() && matches!(certificate.verdict(), Verdict::Verified);
        let failures = if complete {
            Vec::new()
        } else {
            failures(&triangulation, &stratification, &rows)
        };
        let curve_points = analysis
            .roles
            .iter()
            .filter(|r| matches!(r, Role::Curve | Role::Corner))
            .count();
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            points: whole.len(),
            dimension: flat_dimension,
            duplicates,
            estimator: (!parameters.surface).then(|| {
                let own = self.estimator.as_ref().map(|e| e.name().to_string());
                own.unwrap_or_else(|| "pca".into())
            }),
            mean_neighbors: analysis.mean_neighbors,
            candidates: analysis.candidates,
            curve_points,
            unexplained: analysis.unexplained.len(),
            landmarks: stratification.counts,
            added_landmarks: extra.len(),
            triangulation: triangulation.counts,
            chart_distortion,
            graph: engines.graph().cloned(),
            given: None,
            warnings,
            seconds: clock.finish(),
            parameters,
        };
        let mesh = Mesh {
            vertices: positions(&mesh.vertices, flat_dimension)?,
            ..mesh
        };
        Ok(Outcome {
            failures,
            mesh,
            homology: betti,
            certificate,
            pieces: parts,
            report,
        })
    }

    /// Triangulates a waist that came from elsewhere: measured distances, another program.
    ///
    /// # Errors
    /// Those of [`Triangulator::triangulate`].
    pub fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
        self.triangulator(self.chart.as_ref()).triangulate(waist)
    }

    fn triangulator<'a>(&'a self, chart: &'a dyn LocalChart) -> Triangulator<'a> {
        let literal = self.parameters.method == Method::Paper;
        Triangulator {
            chart,
            test: self.test.as_ref(),
            rule: if literal {
                &MinimumCircumradius
            } else {
                self.rule.as_ref()
            },
            largest_circumradius: f64::INFINITY,
            repair: !literal,
            rules: if literal {
                Rules::PAPER
            } else {
                Rules::MEASURED
            },
        }
    }

    pub(crate) fn warn(&mut self, warning: &Warning) {
        (self.warned)(warning);
    }

    fn enter(&mut self, stage: Stage, clock: &mut Clock) {
        clock.enter(stage);
        (self.observer)(stage);
    }
}

/// The radii of the neighborhoods, where they are not eps everywhere.
fn radii(
    parameters: &Parameters,
    space: &ChartSpace<'_, f64>,
    cloud: &PointCloud<f64>,
    estimator: &dyn DimensionEstimator<Scalar = f64>,
    threads: &Threads,
) -> Result<Option<Vec<f64>>, Error> {
    let around = Surroundings {
        oracle: space.oracle,
        metric: space.metric,
        cloud: Some(cloud),
        execute: threads,
    };
    let of = |policy: &dyn NeighborhoodPolicy<f64>| {
        Ok(Some(PolicyOracle::new(policy, &around)?.into_radii()))
    };
    match parameters.spaces.neighborhoods {
        // Nothing is looked for in neighborhoods.
        _ if parameters.surface => Ok(None),
        Neighborhoods::Radius => Ok(None),
        Neighborhoods::Nearest(count) => of(&NearestCount::new(count)?),
        Neighborhoods::Adaptive(count) => of(&FlatRadius::new(parameters.eps, count, estimator)?),
    }
}

/// Fewest different points that are worked on.
const LEAST_POINTS: usize = 8;

/// A number for the place of a row, equal for equal places.
fn fingerprint(row: &[f64]) -> u64 {
    let mut sum = 0u64;
    for x in row {
        // Negative and positive zero are equal.
        sum = (sum.rotate_left(5) ^ (x + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        sum ^= sum >> 29;
    }
    sum
}

/// The first row of every place, in order.
fn first_of_each(cloud: &PointCloud<f64>) -> Vec<usize> {
    let mut marks: Vec<(u64, u32)> = cloud
        .iter()
        .zip(0..)
        .map(|(row, i)| (fingerprint(row), i))
        .collect();
    marks.sort_unstable();
    let mut copy = vec![false; cloud.len()];
    for like in marks.chunk_by(|a, b| a.0 == b.0) {
        // Rows of one fingerprint are nearly always copies, a few at most.
        for (at, &(_, row)) in like.iter().enumerate() {
            copy[row as usize] = like[..at].iter().any(|&(_, first)| {
                !copy[first as usize] && cloud.point(first as usize) == cloud.point(row as usize)
            });
        }
    }
    (0..cloud.len()).filter(|&row| !copy[row]).collect()
}

/// Positions of the boundary rows, or of the rows that they are copies of, among the kept ones.
fn boundary_rows(
    boundary: &[usize],
    rows: &[usize],
    cloud: &PointCloud<f64>,
) -> Result<Vec<usize>, Error> {
    let mut out = Vec::with_capacity(boundary.len());
    let mut by_place: Vec<usize> = if boundary.is_empty() {
        Vec::new()
    } else {
        (0..rows.len()).collect()
    };
    by_place.sort_by(|&a, &b| order_of_places(cloud, rows[a], rows[b]));
    for &row in boundary {
        if row >= cloud.len() {
            return Err(Error::Index {
                what: "boundary row",
                index: row,
                limit: cloud.len(),
            });
        }
        let at = by_place.binary_search_by(|&k| order_of_places(cloud, rows[k], row));
        out.extend(at.ok().map(|at| by_place[at]));
    }
    out.sort_unstable();
    out.dedup();
    Ok(out)
}

/// Lexicographic order of the coordinates of two rows; negative and positive zero are equal.
fn order_of_places(cloud: &PointCloud<f64>, a: usize, b: usize) -> std::cmp::Ordering {
    let pairs = cloud.point(a).iter().zip(cloud.point(b));
    pairs
        .map(|(x, y)| (x + 0.0).total_cmp(&(y + 0.0)))
        .find(|o| o.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}

/// Adds a landmark where the middle of a triangle or of an edge is far from every point: where
/// the surface bends more than triangles of this size can follow.
fn add_where_astray(
    oracle: &EuclideanOracle<f64>,
    analysis: &Analysis,
    stratification: &Stratification<f64>,
    complex: &Complex,
    dl: f64,
    extra: &mut Vec<usize>,
) {
    if stratification.rows.len() == analysis.roles.len() {
        return; // every point is a landmark already
    }
    let place = |v: u32| analysis.places.point(stratification.rows[v as usize]);
    let mut near: Vec<Neighbor<f64>> = Vec::new();
    let mut middle: Vec<f64> = Vec::new();
    for t in &complex.triangles {
        let [a, b, c] = *t;
        for corners in [&[a, b][..], &[a, c], &[b, c], &[a, b, c]] {
            middle.clear();
            middle.extend((0..analysis.places.dimension()).map(|k| {
                let sum: f64 = corners.iter().map(|&v| place(v)[k]).sum();
                sum / corners.len() as f64
            }));
            let mut reach = STRAY * dl;
            if oracle.is_near(&middle, reach) {
                continue;
            }
            near.clear();
            while near.is_empty() && reach < 8.0 * dl {
                reach *= 1.5;
                oracle.within_of(&middle, reach, &mut near);
            }
            let off = |row: usize| off_plane(t.map(place), &middle, analysis.places.point(row));
            if near.first().is_none_or(|x| off(x.index) < STRAY * dl) {
                continue;
            }
            let free = |row: usize| {
                let limit = (ADDED_SEPARATION * dl).powi(2);
                analysis.roles[row] == Role::Regular
                    && stratification
                        .rows
                        .iter()
                        .chain(extra.iter())
                        .all(|&r| analysis.places.squared_distance(r, row) >= limit)
            };
            if let Some(row) = near.iter().map(|x| x.index).find(|&r| free(r)) {
                extra.push(row);
            }
        }
    }
}

/// Distance of `x` from the plane through `middle` that is parallel to a triangle, in R^N.
fn off_plane(corners: [&[f64]; 3], middle: &[f64], x: &[f64]) -> f64 {
    let minus =
        |p: &[f64], q: &[f64]| -> Vec<f64> { p.iter().zip(q).map(|(a, b)| a - b).collect() };
    let dot = |p: &[f64], q: &[f64]| -> f64 { p.iter().zip(q).map(|(a, b)| a * b).sum() };
    let (u, v) = (minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    let w: Vec<f64> = x.iter().zip(middle).map(|(a, m)| a - m).collect();
    let (uu, uv, vv, uw, vw) = (
        dot(&u, &u),
        dot(&u, &v),
        dot(&v, &v),
        dot(&u, &w),
        dot(&v, &w),
    );
    let area = uu * vv - uv * uv;
    if area <= 1e-12 * uu * vv {
        return dot(&w, &w).sqrt();
    }
    let (s, t) = ((uw * vv - vw * uv) / area, (vw * uu - uw * uv) / area);
    let inside: f64 = s * uw + t * vw;
    (dot(&w, &w) - inside).max(0.0).sqrt()
}

/// The mesh of a triangulation: landmarks that were dropped leave no vertex.
fn mesh_of(
    complex: &Complex,
    stratification: &Stratification<f64>,
    analysis: &Analysis,
    rows: &[usize],
) -> Result<Mesh, Error> {
    let mut used = vec![false; complex.vertices];
    for &v in complex
        .triangles
        .iter()
        .flatten()
        .chain(complex.curve_edges.iter().flat_map(|e| &e.ends))
    {
        used[v as usize] = true;
    }
    let kept: Vec<u32> = (0..complex.vertices as u32)
        .filter(|&v| used[v as usize])
        .collect();
    let mut name = vec![0u32; complex.vertices];
    for (k, &v) in kept.iter().enumerate() {
        name[v as usize] = k as u32;
    }
    let triangles = complex
        .triangles
        .iter()
        .map(|t| t.map(|v| name[v as usize]))
        .collect();
    let edges = complex
        .curve_edges
        .iter()
        .map(|e| CurveEdge::new(name[e.ends[0] as usize], name[e.ends[1] as usize], e.cells))
        .collect();
    let landmark_rows: Vec<usize> = kept
        .iter()
        .map(|&v| stratification.rows[v as usize])
        .collect();
    Mesh::new(
        Complex::new(kept.len(), triangles, edges)?,
        analysis.places.select(&landmark_rows),
        landmark_rows.iter().map(|&r| rows[r] as i64).collect(),
    )
}

/// The vertices at points in which sheets meet and nothing else, with the link they must have.
fn special_points(
    mesh: &Mesh,
    stratification: &Stratification<f64>,
    rows: &[usize],
) -> Vec<SpecialPoint> {
    stratification
        .points
        .iter()
        .filter(|p| (p.curves, p.cells) == (0, 2))
        .filter_map(|p| {
            let row = rows[stratification.rows[p.landmark as usize]] as i64;
            let vertex = mesh.point_index.iter().position(|&r| r == row)?;
            Some(SpecialPoint {
                vertex: vertex as u32,
                link: LinkKind::IsolatedCrossing,
            })
        })
        .collect()
}

/// A broken law of a plug-in of the triangulation, with the row of the input instead of the landmark.
fn at_input_row(error: Error, landmarks: &[usize], rows: &[usize]) -> Error {
    match error {
        Error::Law {
            plugin,
            law,
            point,
            detail,
        } => Error::Law {
            plugin,
            law,
            point: landmarks.get(point).map_or(point, |&row| rows[row]),
            detail,
        },
        other => other,
    }
}

/// The stars that stayed open, as errors.
fn failures(
    triangulation: &Triangulation,
    stratification: &Stratification<f64>,
    rows: &[usize],
) -> Vec<Error> {
    triangulation
        .incomplete
        .iter()
        .map(|open| {
            let landmark = open.landmark as usize;
            let on_curve = stratification.waist.strata[landmark] < 2;
            Error::Triangulation {
                reason: if on_curve {
                    "a cell at a curve could not be filled".into()
                } else {
                    "a star could not be closed".into()
                },
                landmark,
                point: Some(rows[stratification.rows[landmark]]),
                parameter: if on_curve {
                    "ep, eps or dl"
                } else {
                    "dl or tri-eps"
                },
            }
        })
        .collect()
}

/// Seconds by stage.
#[derive(Default)]
struct Clock {
    stages: Vec<(Stage, f64, usize)>,
    running: Option<(Stage, Instant)>,
}

impl Clock {
    fn enter(&mut self, stage: Stage) {
        self.stop();
        self.running = Some((stage, Instant::now()));
    }

    fn stop(&mut self) {
        if let Some((stage, since)) = self.running.take() {
            let spent = since.elapsed().as_secs_f64();
            match self.stages.iter_mut().find(|s| s.0 == stage) {
                Some(s) => {
                    s.1 += spent;
                    s.2 += 1;
                }
                None => self.stages.push((stage, spent, 1)),
            }
        }
    }

    /// How often a stage was entered, now included.
    fn rounds(&self, stage: Stage) -> usize {
        let now = self.running.is_some_and(|(s, _)| s == stage);
        usize::from(now) + self.stages.iter().find(|s| s.0 == stage).map_or(0, |s| s.2)
    }

    fn finish(mut self) -> Vec<(Stage, f64)> {
        self.stop();
        self.stages.into_iter().map(|(s, t, _)| (s, t)).collect()
    }
}
