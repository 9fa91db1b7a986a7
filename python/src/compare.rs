//! Metrics compared.

use crate::arrays;
use crate::plugins::PyMetric;
use crate::reconstruct::{Metric, Settings};
use crate::refusal::bad_value;
use crate::run::Run;
use crosscap::comparison::{Comparison, Contender, compare as compare_all};
use crosscap::{Parameters, Pipeline, Spaces};
use crosscap_core::PointCloud;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use serde_json::json;

/// What is compared, as Python hands it over.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Compared {
    metrics: Vec<(String, Metric)>,
    radii: Vec<f64>,
    dl: f64,
    analysis_eps: Option<f64>,
    betti: Option<[usize; 3]>,
}

/// One metric, named or written in Python, as a contender that heeds the run.
fn contender<'a>(name: &str, metric: &'a Metric, run: &'a Run) -> Contender<'a> {
    Contender::pipeline(name, move |cloud: &PointCloud<f64>, parameters| {
        let own = |make: &Py<PyAny>| run.attached(|py| PyMetric::new(make.bind(py), cloud, run));
        Ok(match metric {
            Metric::Named(name) => Pipeline::new(Parameters {
                spaces: Spaces {
                    metric: name.parse()?,
                    ..parameters.spaces
                },
                ..parameters
            })?,
            Metric::Own(make) => Pipeline::new(parameters)?
                .analysis_metric(Box::new(own(make)?))
                .triangulation_metric(Box::new(own(make)?)),
        }
        .interrupt(run.interrupt()))
    })
}

/// Runs every metric at every radius; the runs as JSON.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    settings: Settings,
    comparison: Compared,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    let cloud = arrays::cloud(&points)?;
    let run = Run::default();
    let auto = settings.auto().map_err(|error| bad_value(&error))?;
    let told = |_| match &progress {
        Some(progress) => progress.call0().map(drop),
        None => Ok(()),
    };
    let runs = run.wait(py, told, |send| {
        for (_, metric) in &comparison.metrics {
            metric.named().transpose()?;
        }
        let first = comparison.radii.first().copied().unwrap_or(comparison.dl);
        let base = auto.pinned().parameters(first, comparison.dl);
        let contenders: Vec<Contender<'_>> = (comparison.metrics.iter())
            .map(|(name, metric)| contender(name, metric, &run))
            .collect();
        let wanted = Comparison {
            analysis_eps: comparison.analysis_eps,
            betti: comparison.betti,
            ..Comparison::new(comparison.radii.clone())
        };
        // Nobody listens any more only when the run is being stopped.
        let done = || drop(send.send(String::new()));
        compare_all(&cloud, &base, &contenders, &wanted, &done)
    })?;
    Ok(json!(runs).to_string())
}
