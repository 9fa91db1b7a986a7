//! Laws of the traits, for plug-ins written in Python.

use crate::model::PyModel;
use crate::plugins::{PyEstimator, PyMetric};
use crate::run::Run;
use crosscap_core::PointCloud;
use crosscap_core::laws::{
    self, Draw, Failures, Instance, Instances, LawBroken, Settings, instances,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// A law that does not hold: its name, what was found, on which input, and all of it in a text.
type Broken = (&'static str, String, String, String);

fn settings(cases: u32, seed: u64) -> Settings {
    Settings {
        cases,
        seed,
        ..Settings::default()
    }
}

/// What the kit found, or the exception that a plug-in raised meanwhile.
fn told(run: &Run, found: Result<(), Failures>) -> PyResult<Vec<Broken>> {
    if let Some(exception) = run.take_exception() {
        return Err(exception);
    }
    let told = |broken: &LawBroken| {
        let text = broken.to_string();
        (
            broken.law.name,
            broken.found.clone(),
            broken.input.clone(),
            text,
        )
    };
    Ok(match found {
        Ok(()) => Vec::new(),
        Err(failures) => failures.broken().map(told).collect(),
    })
}

/// Puts metrics, built by `make` over drawn points, through the laws.
#[pyfunction]
pub fn laws_of_metric(
    py: Python<'_>,
    make: Py<PyAny>,
    cases: u32,
    seed: u64,
) -> PyResult<Vec<Broken>> {
    let run = Run::default();
    let build = |cloud: &PointCloud<f64>| {
        let metric = Python::attach(|py| PyMetric::new(make.bind(py), cloud, &run));
        metric.unwrap_or_else(|exception| {
            run.stop_with(exception);
            resume_unwind(Box::new("an exception in Python"))
        })
    };
    let found = py.detach(|| {
        catch_unwind(AssertUnwindSafe(|| {
            laws::metric(&settings(cases, seed), build)
        }))
    });
    // Only an exception leaves the kit by unwinding.
    told(&run, found.unwrap_or(Ok(())))
}

/// Puts an estimator through the laws.
#[pyfunction]
pub fn laws_of_estimator(
    py: Python<'_>,
    plugin: Bound<'_, PyAny>,
    cases: u32,
    seed: u64,
) -> PyResult<Vec<Broken>> {
    let run = Run::default();
    let estimator = PyEstimator::new(&plugin, &run)?;
    let found = py.detach(|| {
        catch_unwind(AssertUnwindSafe(|| {
            laws::estimator(&settings(cases, seed), &estimator)
        }))
    });
    told(&run, found.unwrap_or(Ok(())))
}

/// Exact instances of what the models of the program describe, by the name of the model.
fn instances_of(name: &str) -> PyResult<fn(&mut Draw) -> Instance> {
    Ok(match name {
        "boundary" => instances::boundary,
        "curve" => instances::curve,
        "curve-on-sheet" => instances::line_on_plane,
        "curve-through-sheet" => instances::line_through_plane,
        "isolated-crossing" => instances::crossing_in_four_dimensions,
        "sheet" => instances::flat_sheet,
        "triple-point" => instances::triple_point,
        "two-planes" => instances::two_planes,
        "y-junction" => instances::y_junction,
        other => {
            let wrong = format!(
                "there are no instances of {other:?}: expected \"sheet\" or the name of a model that finds curves or \
                 points, such as \"two-planes\""
            );
            return Err(PyValueError::new_err(wrong));
        }
    })
}

/// Puts a model through the laws, on exact instances of what it describes.
#[pyfunction]
pub fn laws_of_model(
    py: Python<'_>,
    plugin: Bound<'_, PyAny>,
    of: &str,
    cases: u32,
    seed: u64,
) -> PyResult<Vec<Broken>> {
    let run = Run::default();
    let model = PyModel::new(&plugin, &run)?;
    let draw = instances_of(of)?;
    let found = py.detach(|| {
        catch_unwind(AssertUnwindSafe(|| {
            laws::model(&settings(cases, seed), &model, &Instances::new(&draw))
        }))
    });
    told(&run, found.unwrap_or(Ok(())))
}
