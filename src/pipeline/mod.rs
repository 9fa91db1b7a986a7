//! From a point cloud to a verified surface: the parts put together with good defaults.

mod askable;
mod by_tiles;
mod making;
mod mesh;
mod parameters;
mod prepared;
mod progress;
mod report;
mod rows;
mod run;
mod tiled;
mod whole;

pub use parameters::{Method, Parameters};
pub(crate) use prepared::Input;
pub use progress::Stage;
pub use report::{GivenSpace, Outcome, PluginNames, Report};
pub(crate) use rows::{distinct_points, distinct_rows};

use crate::kept::Kept;
use crate::spaces::{Custom, Warning};
use crosscap_algorithms::certificate::Limits;
use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::metric::CheckedMetric;
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::stratify::{Cells, PublishedMethod, Stratifier, Tuning};
use crosscap_algorithms::triangulate::{AdvancingFront, LargestAngle, MinimumCircumradius, Rules};
use crosscap_backends::interrupt::Interrupt;
use crosscap_backends::parallel::Threads;
use crosscap_core::{
    CompatibilityTest, DimensionEstimator, Error, LandmarkSelector, LocalChart, MetricSpace,
    NeighborhoodOracle, PointCloud, SingularityModel, StratifiedLandmarks, TriangleRule,
    Triangulation, Triangulator,
};
use progress::StageObserver;

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
    parts: Parts,
    observer: StageObserver,
    warned: WarningObserver,
}

/// What a reconstruction is put together from.
struct Parts {
    parameters: Parameters,
    tuning: Tuning,
    limits: Limits,
    models: Models,
    estimator: Option<Box<dyn DimensionEstimator<Scalar = f64>>>,
    selector: Box<dyn LandmarkSelector<Scalar = f64>>,
    chart: Box<dyn LocalChart>,
    test: Box<dyn CompatibilityTest>,
    rule: Box<dyn TriangleRule>,
    stratifier: Box<dyn Stratifier<f64>>,
    triangulator: Option<Box<dyn Triangulator<f64>>>,
    oracle: Option<Box<dyn NeighborhoodOracle<Scalar = f64>>>,
    analysis_metric: Option<Custom>,
    chart_metric: Option<Custom>,
    interrupt: Interrupt,
    kept: Kept,
}

impl Parts {
    /// The thresholds of the certificate, with what the parameters say about the surface.
    fn limits(&self) -> Limits {
        Limits {
            least_hole: self.parameters.least_hole.unwrap_or(self.limits.least_hole),
            ..self.limits.clone()
        }
    }
}

/// Models that compete.
enum Models {
    /// Those that the parameters name.
    Named(Vec<Box<dyn SingularityModel>>),
    /// Others.
    Own(Vec<Box<dyn SingularityModel>>),
}

impl Models {
    fn named(parameters: &Parameters, tuning: &Tuning) -> Result<Self, Error> {
        let Parameters { models, dp, ep, .. } = parameters;
        let made = models
            .iter()
            .map(|name| name.tuned(*dp, *ep, &tuning.models));
        Ok(Self::Named(made.collect::<Result<_, _>>()?))
    }

    fn all(&self) -> &[Box<dyn SingularityModel>] {
        match self {
            Self::Named(models) | Self::Own(models) => models,
        }
    }
}

impl Pipeline {
    /// The default parts for these parameters: PCA, two planes, random landmarks, classical
    /// scaling, exact planar predicate, largest angle.
    ///
    /// # Errors
    /// Those of [`Parameters::check`].
    pub fn new(parameters: Parameters) -> Result<Self, Error> {
        parameters.check()?;
        let parts = Parts {
            models: Models::named(&parameters, &Tuning::MEASURED)?,
            estimator: None,
            selector: Box::new(RandomGreedy::new()),
            chart: Box::new(ClassicalScaling),
            test: Box::new(PlanarPredicate),
            rule: Box::new(LargestAngle),
            stratifier: match parameters.method {
                Method::Cells => Box::new(Cells),
                Method::Paper => Box::new(PublishedMethod),
            },
            triangulator: None,
            oracle: None,
            analysis_metric: None,
            chart_metric: None,
            interrupt: Interrupt::default(),
            kept: Kept::default(),
            tuning: Tuning::MEASURED,
            limits: Limits::default(),
            parameters,
        };
        Ok(Self {
            parts,
            observer: Box::new(|_| {}),
            warned: Box::new(|_| {}),
        })
    }

    /// Singularity models that compete instead of those that the parameters name.
    pub fn models(mut self, models: Vec<Box<dyn SingularityModel>>) -> Self {
        self.parts.models = Models::Own(models);
        self
    }

    /// Other thresholds of the certificate.
    pub fn limits(mut self, limits: Limits) -> Self {
        self.parts.limits = limits;
        self
    }

    /// The same with a certificate that calls a gap or a separation in the points no chance so many times sooner, and an end
    /// of a curve one so many times later.
    pub(crate) fn stricter(mut self, times: usize) -> Self {
        self.parts.limits.significance *= times as f64;
        self.parts.limits.loose_end /= times as f64;
        self
    }

    /// The same with what earlier runs made of the same points alone.
    pub(crate) fn keeping(mut self, kept: &Kept) -> Self {
        self.parts.kept = kept.clone();
        self
    }

    /// Another dimension estimator than principal components with tolerance dt, which is
    /// computed for all points together from the moments of a search tree.
    pub fn estimator(mut self, estimator: Box<dyn DimensionEstimator<Scalar = f64>>) -> Self {
        self.parts.estimator = Some(estimator);
        self
    }

    /// Another landmark selector.
    pub fn selector(mut self, selector: Box<dyn LandmarkSelector<Scalar = f64>>) -> Self {
        self.parts.selector = selector;
        self
    }

    /// Another chart.
    pub fn chart(mut self, chart: Box<dyn LocalChart>) -> Self {
        self.parts.chart = chart;
        self
    }

    /// Another compatibility test.
    pub fn compatibility(mut self, test: Box<dyn CompatibilityTest>) -> Self {
        self.parts.test = test;
        self
    }

    /// Another order in which triangles are tried.
    pub fn rule(mut self, rule: Box<dyn TriangleRule>) -> Self {
        self.parts.rule = rule;
        self
    }

    /// Another way from the cloud to the waist than that of [`Parameters::method`].
    pub fn stratifier(mut self, stratifier: Box<dyn Stratifier<f64>>) -> Self {
        self.parts.stratifier = stratifier;
        self
    }

    /// Another way from the waist to triangles than the advancing front. Chart, compatibility test and triangle rule of
    /// this pipeline are parts of the front, and are not used then.
    ///
    /// An [interrupt](Self::interrupt) is heeded before and after it.
    pub fn triangulator(mut self, triangulator: Box<dyn Triangulator<f64>>) -> Self {
        self.parts.triangulator = Some(triangulator);
        self
    }

    /// What finds neighborhoods in the metric of the analysis, instead of a search tree or a scan: an oracle
    /// of your own over the rows of the input, of which no two may coincide.
    pub fn oracle(mut self, oracle: Box<dyn NeighborhoodOracle<Scalar = f64>>) -> Self {
        self.parts.oracle = Some(oracle);
        self
    }

    /// Other numbers than those that the program runs with. Models of your own have theirs in them.
    pub fn tuning(mut self, tuning: Tuning) -> Self {
        // The parameters were checked at the beginning, so that their models can be made.
        if let (Models::Named(_), Ok(models)) = (
            &self.parts.models,
            Models::named(&self.parts.parameters, &tuning),
        ) {
            self.parts.models = models;
        }
        self.parts.tuning = tuning;
        self
    }

    /// A metric of your own for the analysis, on the rows of the input: neighborhoods, landmarks, cells.
    /// Neighborhoods are found by looking at every point. Coordinates still come from the cloud.
    ///
    /// Charts follow it: their distances are those of this metric too, unless
    /// [`triangulation_metric`](Self::triangulation_metric) says otherwise.
    pub fn analysis_metric(mut self, metric: Box<dyn MetricSpace<Scalar = f64>>) -> Self {
        self.parts.analysis_metric = Some(Custom::new(CheckedMetric::new(metric)));
        self
    }

    /// A metric of your own for the charts, on the rows of the input: which landmarks are in a chart, and
    /// the distances that it is laid out from.
    pub fn triangulation_metric(mut self, metric: Box<dyn MetricSpace<Scalar = f64>>) -> Self {
        self.parts.chart_metric = Some(Custom::new(CheckedMetric::new(metric)));
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

    /// Lets `interrupt` stop a run: between jobs, between charts and between stages. The error is then
    /// [`Error::Interrupted`], and the pipeline should be dropped.
    ///
    /// ```
    /// use crosscap::backends::interrupt::Interrupt;
    /// use crosscap::prelude::*;
    /// let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
    /// let interrupt = Interrupt::default();
    /// interrupt.request(); // By another thread, after a while.
    /// let mut pipeline = Pipeline::new(Parameters::new(0.4, 0.2))?.interrupt(interrupt);
    /// assert!(matches!(pipeline.reconstruct(&sample.points), Err(Error::Interrupted)));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn interrupt(mut self, interrupt: Interrupt) -> Self {
        self.parts.interrupt = interrupt;
        self
    }

    /// Reconstructs the surface that `cloud` was sampled from.
    ///
    /// # Errors
    /// Input that cannot be worked on ([`Error::is_input`]), or a stage that failed before there was
    /// a mesh. A mesh that is not good comes back in the outcome, unverified.
    pub fn reconstruct(&mut self, cloud: &PointCloud<f64>) -> Result<Outcome, Error> {
        self.run(&Input { cloud, given: None })
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        &self.parts.parameters
    }

    /// Triangulates a waist that came from elsewhere: measured distances, another program.
    ///
    /// # Errors
    /// Those of [`Triangulator::triangulate`]; [`Error::Law`] for what a triangulator that was plugged in breaks.
    pub fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
        self.parts.triangulated(waist, self.parts.chart.as_ref())
    }

    /// Does `work`, of which the run is a part, so that it can be stopped.
    pub(crate) fn guarded<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let interrupt = self.parts.interrupt.clone();
        interrupt.guard(|| work(self))
    }

    /// The threads of a run; to be used inside [`Pipeline::guarded`].
    pub(crate) fn threads(&self) -> Result<Threads, Error> {
        self.parts.threads()
    }

    pub(crate) fn warn(&mut self, warning: &Warning) {
        (self.warned)(warning);
    }
}

impl Parts {
    fn threads(&self) -> Result<Threads, Error> {
        Threads::heeding(self.parameters.threads.unwrap_or(0), &self.interrupt)
    }

    /// The triangulation of a waist, looked over.
    fn triangulated(
        &self,
        waist: &StratifiedLandmarks<f64>,
        chart: &dyn LocalChart,
    ) -> Result<Triangulation, Error> {
        let front = self.front(chart);
        let triangulator = self.triangulator(&front);
        let found = triangulator.triangulate(waist)?;
        found.check(waist, triangulator.name())?;
        Ok(found)
    }

    /// The triangulator that was plugged in, or the usual one.
    fn triangulator<'a>(&'a self, usual: &'a AdvancingFront<'a>) -> &'a dyn Triangulator<f64> {
        self.triangulator.as_deref().unwrap_or(usual)
    }

    /// The usual triangulator, which lays stars out in a chart.
    fn front<'a>(&'a self, chart: &'a dyn LocalChart) -> AdvancingFront<'a> {
        let literal = self.parameters.method == Method::Paper;
        AdvancingFront {
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
            tuning: &self.tuning.front,
        }
    }
}
