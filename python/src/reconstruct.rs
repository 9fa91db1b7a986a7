//! Reconstruction.

use crate::arrays;
use crate::model::PyModel;
use crate::plugins::{PyEstimator, PyMetric};
use crate::refusal::{self, bad_value};
use crate::run::Run;
use crosscap::auto::{Auto, Input, Pinned, Search};
use crosscap::command::estimators::EstimatorName;
use crosscap::command::outcome::{metadata, report};
use crosscap::refusal::Refusal;
use crosscap::{MetricName, Outcome, Parameters, Pipeline, Stage};
use crosscap_algorithms::singularity::ModelName;
use crosscap_backends::files::distances_of_bytes;
use crosscap_core::{Error, PointCloud, SingularityModel};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::sync::mpsc::Sender;
use std::time::Duration;

/// A metric by name, or the function that builds one over an array of points.
#[derive(FromPyObject)]
pub enum Metric {
    Named(String),
    Own(Py<PyAny>),
}

/// A singularity model by name, or what tells about one.
#[derive(FromPyObject)]
pub enum Model {
    Named(String),
    Own(Py<PyAny>),
}

/// A dimension estimator by name, or name and function of one.
#[derive(FromPyObject)]
pub enum Estimator {
    Named(String),
    Own(Py<PyAny>),
}

/// The parameters of a reconstruction as Python hands them over; `None` leaves one to the program.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    eps: Option<f64>,
    dl: Option<f64>,
    tri_eps: Option<f64>,
    dt: Option<f64>,
    dp: Option<f64>,
    ep: Option<f64>,
    models: Option<Vec<Model>>,
    metric: Option<Metric>,
    tri_metric: Option<Metric>,
    neighborhoods: Option<String>,
    estimator: Option<Estimator>,
    boundary: Vec<usize>,
    surface: bool,
    method: Option<String>,
    prepare: Option<bool>,
    least_hole: Option<f64>,
    tries: usize,
    time_limit: Option<f64>,
    seed: u64,
    threads: usize,
}

impl Model {
    fn named(&self) -> Option<Result<ModelName, Error>> {
        match self {
            Self::Named(name) => Some(name.parse()),
            Self::Own(_) => None,
        }
    }
}

impl Metric {
    /// The metric of this program, where it is one.
    pub fn named(&self) -> Option<Result<MetricName, Error>> {
        match self {
            Self::Named(name) => Some(name.parse()),
            Self::Own(_) => None,
        }
    }
}

impl Settings {
    fn has_own_metric(&self) -> bool {
        let own = |metric: &Option<Metric>| matches!(metric, Some(Metric::Own(_)));
        own(&self.metric) || own(&self.tri_metric)
    }

    /// The search for what is left to the program.
    pub fn auto(&self) -> Result<Auto, Error> {
        let named = |metric: &Option<Metric>| metric.as_ref().and_then(Metric::named).transpose();
        let models = match &self.models {
            Some(models) => Some(
                models
                    .iter()
                    .filter_map(Model::named)
                    .collect::<Result<_, _>>()?,
            ),
            // With both lengths given the program would look for double curves alone.
            None => self.eps.and(self.dl).map(|_| ModelName::AUTO.to_vec()),
        };
        let auto = Auto::new(Pinned {
            eps: self.eps,
            tri_eps: self.tri_eps,
            dt: self.dt,
            dp: self.dp,
            ep: self.ep,
            dl: self.dl,
            seed: Some(self.seed),
            surface: self.surface.then_some(true),
            boundary: self.boundary.clone(),
            models,
            method: self.method.as_deref().map(str::parse).transpose()?,
            metric: named(&self.metric)?,
            tri_metric: named(&self.tri_metric)?,
            neighborhoods: self.neighborhoods.as_deref().map(str::parse).transpose()?,
            // A metric of one's own is about the points as they were given.
            prepare: self.has_own_metric().then_some(false).or(self.prepare),
            least_hole: self.least_hole,
            threads: (self.threads > 0).then_some(self.threads),
            ..Pinned::default()
        });
        let auto = auto.tries(self.tries);
        let limit = self.time_limit.map(Duration::try_from_secs_f64).transpose();
        let limit = limit.map_err(|wrong| Error::Parameter {
            name: "time_limit",
            value: self.time_limit.unwrap_or_default().to_string(),
            expected: format!("seconds ({wrong})"),
        })?;
        Ok(match limit {
            Some(limit) => auto.time_limit(limit),
            None => auto,
        })
    }
}

impl Settings {
    /// The pipeline with the plug-ins that were written in Python.
    fn pipeline(
        &self,
        parameters: Parameters,
        cloud: &PointCloud<f64>,
        run: &Run,
    ) -> Result<Pipeline, Error> {
        let dt = parameters.dt;
        let mut pipeline = Pipeline::new(parameters)?.interrupt(run.interrupt());
        if let Some(models) = self.own_models(pipeline.parameters(), run)? {
            pipeline = pipeline.models(models);
        }
        let own = |make: &Py<PyAny>| run.attached(|py| PyMetric::new(make.bind(py), cloud, run));
        if let Some(Metric::Own(make)) = &self.metric {
            pipeline = pipeline.analysis_metric(Box::new(own(make)?));
        }
        if let Some(Metric::Own(make)) = self.tri_metric.as_ref().or(self.metric.as_ref()) {
            pipeline = pipeline.triangulation_metric(Box::new(own(make)?));
        }
        pipeline = match &self.estimator {
            None => pipeline,
            // The pipeline has principal components of its own, of all points together.
            Some(Estimator::Named(name)) if name == EstimatorName::Pca.name() => pipeline,
            Some(Estimator::Named(name)) => {
                pipeline.estimator(EstimatorName::named(name)?.local(dt)?)
            }
            Some(Estimator::Own(plugin)) => {
                let own = run.attached(|py| PyEstimator::new(plugin.bind(py), run))?;
                pipeline.estimator(Box::new(own))
            }
        };
        Ok(pipeline)
    }
}

/// Models that compete.
type Models = Vec<Box<dyn SingularityModel>>;

impl Settings {
    /// All models, in their order, where some of them are written in Python.
    fn own_models(&self, parameters: &Parameters, run: &Run) -> Result<Option<Models>, Error> {
        let models = self.models.as_deref().unwrap_or_default();
        if models.iter().all(|model| matches!(model, Model::Named(_))) {
            return Ok(None);
        }
        let model = |model: &Model| -> Result<Box<dyn SingularityModel>, Error> {
            match model {
                Model::Named(name) => {
                    let name: ModelName = name.parse()?;
                    name.model(parameters.dp, parameters.ep)
                }
                Model::Own(plugin) => {
                    let own = run.attached(|py| PyModel::new(plugin.bind(py), run))?;
                    Ok(Box::new(own))
                }
            }
        };
        models.iter().map(model).collect::<Result<_, _>>().map(Some)
    }
}

/// Where one is, told to the interpreter: the number of the attempt and the stage.
pub fn stages(send: &Sender<String>, attempt: usize) -> impl FnMut(Stage) + use<> {
    let send = send.clone();
    // Nobody listens any more only when the run is being stopped.
    move |stage| drop(send.send(format!("{attempt} {stage}")))
}

/// What is called with an attempt and a stage.
pub fn told(progress: Option<Bound<'_, PyAny>>) -> impl FnMut(String) -> PyResult<()> {
    move |at| match &progress {
        Some(progress) => progress.call1((at,)).map(drop),
        None => Ok(()),
    }
}

/// How a reconstruction ended: what there is of a mesh, and why it is not handed over as good.
pub struct End {
    outcome: Option<Outcome>,
    refusal: Option<Box<Refusal>>,
    /// Whether something was done about outliers and noise.
    prepared: bool,
}

impl End {
    fn of(search: Search, points: Option<&PointCloud<f64>>) -> Self {
        let prepared = search.preparation.is_some();
        match search.into_verified(points) {
            Ok(outcome) => Self {
                outcome: Some(outcome),
                refusal: None,
                prepared,
            },
            Err(refusal) => Self {
                outcome: None,
                refusal: Some(refusal),
                prepared,
            },
        }
    }

    /// That of an outcome whose points are not at hand.
    pub fn of_outcome(outcome: Outcome) -> Self {
        if outcome.is_verified() {
            return Self {
                outcome: Some(outcome),
                refusal: None,
                prepared: false,
            };
        }
        Self {
            outcome: None,
            refusal: Some(Box::new(Refusal::of(Ok(outcome), None, None))),
            prepared: false,
        }
    }

    /// The arrays of the mesh and `triangle_piece`, as JSON the `report` and the `metadata`, and the `refusal`; `None` where
    /// there is no mesh, and where it is verified.
    pub fn told(&self, py: Python<'_>) -> PyResult<Told> {
        let refusal = self.refusal.as_deref();
        let outcome = self.outcome.as_ref();
        let outcome = outcome.or_else(|| refusal.and_then(|r| r.outcome.as_ref().ok()));
        let mesh = outcome.map(|outcome| of_outcome(py, outcome)).transpose()?;
        if let (Some(mesh), Some(outcome)) = (&mesh, outcome) {
            // An attempt can be verified that others speak against.
            let verified = refusal.is_none();
            let parameters = &outcome.report.parameters;
            let metadata = metadata(parameters, outcome, verified, self.prepared);
            mesh.set_item("metadata", metadata.to_string())?;
        }
        let refusal = refusal.map(|r| refusal::told(r).to_string());
        Ok((mesh.map(Bound::unbind), refusal))
    }
}

/// A mesh, where there is one, and why it is not handed over, where it is not.
pub type Told = (Option<Py<PyDict>>, Option<String>);

/// Reconstructs a surface from points: see [`End::told`].
#[pyfunction]
pub fn reconstruct(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    settings: Settings,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Told> {
    let cloud = arrays::cloud(&points)?;
    let run = Run::default();
    let end = run.wait(py, told(progress), |send| {
        let mut attempt = 0;
        let mut make = |parameters: Parameters| -> Result<Pipeline, Error> {
            attempt += 1;
            let pipeline = settings.pipeline(parameters, &cloud, &run)?;
            Ok(pipeline.on_stage(stages(&send, attempt)))
        };
        let search = settings.auto()?.search(Input::Points(&cloud), &mut make)?;
        Ok(End::of(search, Some(&cloud)))
    })?;
    end.told(py)
}

/// The same from distances alone: the bytes of a file of NumPy or SciPy, whose name tells the format.
#[pyfunction]
pub fn reconstruct_distances(
    py: Python<'_>,
    name: &str,
    bytes: &[u8],
    settings: Settings,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Told> {
    let distances = distances_of_bytes(name, bytes).map_err(|error| bad_value(&error))?;
    let run = Run::default();
    let end = run.wait(py, told(progress), |send| {
        let mut attempt = 0;
        let mut make = |parameters: Parameters| -> Result<Pipeline, Error> {
            attempt += 1;
            let pipeline = Pipeline::new(parameters)?.interrupt(run.interrupt());
            Ok(pipeline.on_stage(stages(&send, attempt)))
        };
        let input = Input::Distances(&distances);
        let search = settings.auto()?.search(input, &mut make)?;
        Ok(End::of(search, None))
    })?;
    end.told(py)
}

fn of_outcome<'py>(py: Python<'py>, outcome: &Outcome) -> PyResult<Bound<'py, PyDict>> {
    let all = arrays::of_mesh(py, &outcome.mesh)?;
    let pieces = outcome.pieces.as_ref().ok();
    let pieces: Option<Vec<i64>> =
        pieces.map(|p| p.triangle_piece.iter().map(|&k| k.into()).collect());
    all.set_item("triangle_piece", pieces)?;
    all.set_item("report", report(outcome, json!(null)).to_string())?;
    Ok(all)
}
