//! Points: samples, files, dimensions.

use crate::arrays;
use crate::refusal::{bad_value, in_python, raised};
use crate::run::Run;
use crosscap::command::estimators::EstimatorName;
use crosscap_algorithms::dimension::{Scale, WholeCloud};
use crosscap_algorithms::surfaces::{SampleSurface, catalogue};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::{self, ColumnChoice, PointOptions};
use crosscap_backends::parallel::Threads;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The names of the sample surfaces, with a sentence each.
#[pyfunction]
pub fn surfaces() -> Vec<(&'static str, &'static str)> {
    let all = catalogue();
    all.iter().map(|s| (s.name(), s.summary())).collect()
}

/// Draws points from a surface of the catalogue.
#[pyfunction]
pub fn sample<'py>(
    py: Python<'py>,
    surface: &str,
    count: Option<usize>,
    seed: u64,
    thinning: Option<f64>,
    noise: f64,
    boundary: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let surface = SampleSurface::find(surface).map_err(|error| bad_value(&error))?;
    let mut sampling = surface.default_sampling(seed);
    if let Some(count) = count {
        sampling.count = count;
        sampling.thinning = None;
    }
    sampling.thinning = thinning.or(sampling.thinning);
    sampling.noise = noise;
    sampling.boundary = boundary;
    let drawn = py.detach(|| surface.sample(&sampling));
    let drawn = drawn.map_err(|error| raised(py, error))?;
    let all = PyDict::new(py);
    all.set_item("name", surface.name())?;
    all.set_item("summary", surface.summary())?;
    all.set_item("betti", surface.truth().betti)?;
    all.set_item("points", arrays::of_cloud(py, &drawn.points)?)?;
    let rows = drawn.boundary.iter().map(|&row| row as i64).collect();
    all.set_item("boundary", PyArray1::<i64>::from_vec(py, rows))?;
    Ok(all)
}

/// Points from a file, and what whoever reads it ought to know about how they were taken.
type Read<'py> = (Bound<'py, PyArray2<f64>>, Vec<String>);

/// Reads points from a file.
#[pyfunction]
pub fn read_points<'py>(
    py: Python<'py>,
    path: PathBuf,
    array: Option<String>,
    transpose: bool,
    columns: Option<&str>,
) -> PyResult<Read<'py>> {
    let columns: Result<Option<ColumnChoice>, _> = columns.map(str::parse).transpose();
    let options = PointOptions {
        array,
        transpose,
        columns: columns
            .map_err(|wrong| bad_value(&wrong))?
            .unwrap_or_default(),
    };
    let file = py.detach(|| files::read_point_file(path, &options));
    let file = file.map_err(|error| bad_value(&error))?;
    let remarks = file
        .remarks
        .iter()
        .map(|r| in_python(&r.to_string()))
        .collect();
    Ok((arrays::of_cloud(py, &file.points.into_f64())?, remarks))
}

/// Dimension, value before rounding and confidence at every point; -1 and NaN where there are too few.
#[pyfunction]
pub fn dimension<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    estimator: &str,
    eps: Option<f64>,
    neighbors: usize,
    dt: f64,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let cloud = arrays::cloud(&points)?;
    let run = Run::default();
    let interrupt = run.interrupt();
    let found = run.wait(
        py,
        |_| Ok(()),
        |_send| {
            interrupt.guard(|| {
                let estimator = EstimatorName::named(estimator)?.local(dt)?;
                let oracle = EuclideanOracle::new(cloud.clone())?;
                let threads = Threads::heeding(threads, &interrupt)?;
                let space = WholeCloud {
                    metric: &oracle,
                    oracle: &oracle,
                    cloud: Some(&cloud),
                    scale: eps.map_or(Scale::Nearest(neighbors), Scale::Within),
                    execute: &threads,
                };
                space.local(estimator.as_ref())
            })
        },
    )?;
    arrays::of_estimates(py, &found)
}
