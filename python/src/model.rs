//! A singularity model written in Python.

use crate::arrays::rows;
use crate::run::Run;
use crosscap_core::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Stratum};
use pyo3::prelude::*;

/// A singularity model: a function of the points of a neighborhood in their principal coordinates, how many of them
/// the model is fitted to, which is the center, and the radius.
pub struct PyModel {
    told: Told,
    run: Run,
}

/// What `_plugins.py` tells about a model.
#[derive(FromPyObject)]
struct Told {
    name: String,
    local_dimension: usize,
    finds_boundary: bool,
    applies_to: Vec<usize>,
    decompose: Py<PyAny>,
}

/// A decomposition as Python tells it, its fields those of [`Decomposition`].
#[derive(FromPyObject)]
struct ToldDecomposition {
    strata: Vec<u8>,
    labels: Vec<u8>,
    cells_at_curve: Vec<u8>,
    residual: f64,
    parameters: usize,
    points: Vec<Vec<f64>>,
    center: Vec<f64>,
    center_offset: f64,
}

impl PyModel {
    /// The model that `plugin` tells about.
    pub fn new(plugin: &Bound<'_, PyAny>, run: &Run) -> PyResult<Self> {
        Ok(Self {
            told: plugin.extract()?,
            run: run.clone(),
        })
    }

    fn ask(&self, py: Python<'_>, local: &LocalPoints<'_>) -> PyResult<Option<ToldDecomposition>> {
        let points = rows(py, local.dimension, local.coordinates.to_vec())?;
        let arguments = (points, local.fitted, local.center, local.radius);
        self.told.decompose.bind(py).call1(arguments)?.extract()
    }
}

impl SingularityModel for PyModel {
    fn local_dimension(&self) -> usize {
        self.told.local_dimension
    }

    fn applies_to(&self, dimension: usize) -> bool {
        self.told.applies_to.contains(&dimension)
    }

    fn finds_boundary(&self) -> bool {
        self.told.finds_boundary
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let told = match Python::attach(|py| self.ask(py, local)) {
            Ok(told) => told.ok_or(Rejection::NoRealSolution)?,
            Err(exception) => {
                self.run.leave_with(exception);
                return Err(Rejection::NoRealSolution);
            }
        };
        let strata = told.strata.into_iter();
        Ok(Decomposition {
            strata: strata.map(|dimension| Stratum { dimension }).collect(),
            labels: told.labels.into_iter().map(Label::from).collect(),
            cells_at_curve: told.cells_at_curve,
            residual: told.residual,
            parameters: told.parameters,
            points: told.points,
            center: told.center,
            center_offset: told.center_offset,
        })
    }

    fn name(&self) -> &str {
        &self.told.name
    }
}
