//! Plug-ins written in Python. `package/crosscap/_plugins.py` gives them the one form that is called here.
//!
//! They are called from the threads of a run, one at a time, as the interpreter lets them. An exception ends
//! the run, and comes out of it.

use crate::arrays::rows;
use crate::run::Run;
use crosscap_core::{
    DimensionEstimate, DimensionEstimator, Error, MetricSpace, Neighborhood, PointCloud,
};
use numpy::{PyArray1, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A metric: a function of a point and an array of points, all by their rows, to an array of distances.
pub struct PyMetric {
    distances: Py<PyAny>,
    count: usize,
    name: String,
    run: Run,
}

impl PyMetric {
    /// The metric that `make` builds over an array of points.
    pub fn new(make: &Bound<'_, PyAny>, cloud: &PointCloud<f64>, run: &Run) -> PyResult<Self> {
        let py = make.py();
        let points = rows(py, cloud.dimension(), cloud.coordinates().to_vec())?;
        let (name, distances) = make.call1((points,))?.extract()?;
        Ok(Self {
            distances,
            count: cloud.len(),
            name,
            run: run.clone(),
        })
    }

    fn ask(&self, py: Python<'_>, from: usize, to: &[usize], out: &mut Vec<f64>) -> PyResult<()> {
        let to_rows = PyArray1::from_iter(py, to.iter().map(|&row| row as i64));
        let found = self.distances.call1(py, (from, to_rows))?;
        let found: PyReadonlyArray1<'_, f64> = found.extract(py)?;
        if found.len() != to.len() {
            let wrong = format!(
                "metric {}: found {} distances, expected {}, one for each row",
                self.name,
                found.len(),
                to.len()
            );
            return Err(PyValueError::new_err(wrong));
        }
        out.extend_from_slice(found.as_slice()?);
        Ok(())
    }
}

impl MetricSpace for PyMetric {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.count
    }

    fn distance(&self, a: usize, b: usize) -> f64 {
        let mut one = Vec::with_capacity(1);
        self.distances_to(a, &[b], &mut one);
        one[0]
    }

    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<f64>) {
        out.clear();
        if let Err(exception) = Python::attach(|py| self.ask(py, from, to, out)) {
            self.run.leave_with(exception);
        }
    }

    fn name(&self) -> &str {
        &self.name
    }
}

/// A dimension estimator: a function of the points of a neighborhood, nearest first, their distances from its
/// center and its radius to dimension, value and confidence, or to `None` where there are too few points.
pub struct PyEstimator {
    estimate: Py<PyAny>,
    name: String,
    run: Run,
}

impl PyEstimator {
    /// The estimator that the pair of name and function stands for.
    pub fn new(plugin: &Bound<'_, PyAny>, run: &Run) -> PyResult<Self> {
        let (name, estimate) = plugin.extract()?;
        Ok(Self {
            estimate,
            name,
            run: run.clone(),
        })
    }

    fn ask(
        &self,
        py: Python<'_>,
        near: &Neighborhood<'_, f64>,
    ) -> PyResult<Option<DimensionEstimate>> {
        let points = near.cloud.map(|cloud| {
            let indices: Vec<usize> = near.neighbors.iter().map(|x| x.index).collect();
            let points = cloud.select(&indices);
            rows(py, points.dimension(), points.coordinates().to_vec())
        });
        let distances = PyArray1::from_iter(py, near.neighbors.iter().map(|x| x.distance));
        let told = self
            .estimate
            .call1(py, (points.transpose()?, distances, near.radius))?;
        let told: Option<(usize, f64, f64)> = told.extract(py)?;
        Ok(
            told.map(|(dimension, value, confidence)| DimensionEstimate {
                dimension,
                value,
                confidence,
                spectrum: Vec::new(),
            }),
        )
    }
}

impl DimensionEstimator for PyEstimator {
    type Scalar = f64;

    fn estimate(&self, near: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
        match Python::attach(|py| self.ask(py, near)) {
            Ok(Some(estimate)) => Ok(estimate),
            Ok(None) => Err(Error::SparseNeighborhood {
                point: near.center,
                found: near.neighbors.len(),
                needed: near.neighbors.len() + 1,
                parameter: "eps",
            }),
            Err(exception) => {
                self.run.leave_with(exception);
                Err(Error::Interrupted)
            }
        }
    }

    fn name(&self) -> &str {
        &self.name
    }
}
