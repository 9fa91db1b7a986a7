//! Tiles of a cloud: what workers do with one of them, and the run that asks all of them.

use crate::arrays;
use crate::reconstruct::{End, Told, stages, told};
use crate::refusal::{bad_value, raised};
use crate::run::Run;
use crosscap::command::estimators::EstimatorName;
use crosscap::{Parameters, Pipeline};
use crosscap_algorithms::dimension::{Scale, WholeCloud};
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::landmarks;
use crosscap_algorithms::singularity::ModelName;
use crosscap_algorithms::tiles::{Answer, CloudRow, Question, Tile, TileId, Tiles, Tiling};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::Error;
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A value as bytes, for other processes of the same version.
fn packed<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = postcard::to_allocvec(value).map_err(|error| bad_value(&error))?;
    Ok(PyBytes::new(py, &bytes))
}

fn unpacked<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    postcard::from_bytes(bytes).map_err(|error| bad_value(&error))
}

/// Space cut into at most so many tiles at medians of a sample of the points: the tiling, and how many tiles it has.
#[pyfunction]
pub fn tiling<'py>(
    py: Python<'py>,
    sample: PyReadonlyArray2<'py, f64>,
    tiles: usize,
) -> PyResult<(Bound<'py, PyBytes>, usize)> {
    let tiling = Tiling::new(&arrays::cloud(&sample)?, tiles);
    Ok((packed(py, &tiling)?, tiling.bounds().len()))
}

/// For every tile which of some points are in its box or at most `halo` away from it.
#[pyfunction]
pub fn tile_members<'py>(
    py: Python<'py>,
    tiling: &[u8],
    points: PyReadonlyArray2<'py, f64>,
    halo: f64,
) -> PyResult<Vec<Bound<'py, PyArray1<i64>>>> {
    let tiling: Tiling = unpacked(tiling)?;
    let cloud = arrays::cloud(&points)?;
    let members = py.detach(|| {
        let mut members = vec![Vec::new(); tiling.bounds().len()];
        for (row, place) in (0..).zip(cloud.iter()) {
            tiling.near(place, halo, |tile| members[tile.index()].push(row));
        }
        members
    });
    let members = members.into_iter();
    Ok(members.map(|own| PyArray1::from_vec(py, own)).collect())
}

/// The place of every row in the random order in which landmarks are chosen; `barred` rows, given in order, are in none.
#[pyfunction]
pub fn random_ranks<'py>(
    py: Python<'py>,
    count: usize,
    seed: u64,
    barred: PyReadonlyArray1<'py, u32>,
) -> PyResult<Bound<'py, PyArray1<u32>>> {
    let barred = barred.as_slice()?.to_vec();
    let ranks = py.detach(|| landmarks::random_ranks_but(count, &barred, seed));
    Ok(PyArray1::from_vec(py, ranks))
}

/// The answer of a tile, which has number `tile` in the tiling, to a question.
#[pyfunction]
#[allow(
    clippy::too_many_arguments,
    reason = "arrays of a tile, as Python has them"
)]
pub fn tile_answer<'py>(
    py: Python<'py>,
    tiling: &[u8],
    tile: usize,
    halo: f64,
    points: PyReadonlyArray2<'py, f64>,
    rows: PyReadonlyArray1<'py, u32>,
    ranks: PyReadonlyArray1<'py, u32>,
    question: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    let tiling: Tiling = unpacked(tiling)?;
    let question: Question = unpacked(question)?;
    let cloud = arrays::cloud(&points)?;
    let rows: Vec<CloudRow> = rows.as_slice()?.iter().map(|&row| row.into()).collect();
    let ranks = ranks.as_slice()?.to_vec();
    let answer = py.detach(|| {
        let bounds = tiling.bounds()[TileId::new(tile)].clone();
        Tile::new(bounds, halo, cloud, rows, ranks)?.answer(&question)
    });
    packed(py, &answer.map_err(|error| raised(py, error))?)
}

/// Dimension, value before rounding and confidence at the points in the box of a tile, and which of its points these
/// are; -1 and NaN where there are too few.
#[pyfunction]
pub fn tile_dimension<'py>(
    py: Python<'py>,
    tiling: &[u8],
    tile: usize,
    points: PyReadonlyArray2<'py, f64>,
    estimator: &str,
    eps: f64,
    dt: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let tiling: Tiling = unpacked(tiling)?;
    let cloud = arrays::cloud(&points)?;
    let found = py.detach(|| {
        let bounds = &tiling.bounds()[TileId::new(tile)];
        let own: Vec<usize> = (0..cloud.len())
            .filter(|&row| bounds.hold(cloud.point(row)))
            .collect();
        let estimator = EstimatorName::named(estimator)?.local(dt)?;
        let oracle = EuclideanOracle::new(cloud.clone())?;
        let space = WholeCloud {
            metric: &oracle,
            oracle: &oracle,
            cloud: Some(&cloud),
            scale: Scale::Within(eps),
            execute: &Serial,
        };
        let wanted = |row: usize| bounds.hold(cloud.point(row));
        let (answers, _) = space.local_where(estimator.as_ref(), &wanted)?;
        let found: Vec<_> = own.iter().map(|&row| answers[row].clone()).collect();
        Ok((own, found))
    });
    let (own, found) = found.map_err(|error: Error| raised(py, error))?;
    let all = arrays::of_estimates(py, &found)?;
    let own = own.into_iter().map(|row| row as i64).collect();
    all.set_item("own", PyArray1::<i64>::from_vec(py, own))?;
    Ok(all)
}

/// The parameters of a reconstruction from tiles, as Python hands them over.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct TileSettings {
    eps: f64,
    dl: f64,
    tri_eps: Option<f64>,
    surface: bool,
    models: Vec<String>,
    seed: u64,
}

impl TileSettings {
    fn pipeline(&self) -> Result<Pipeline, Error> {
        let models = self.models.iter().map(|name| name.parse::<ModelName>());
        let pipeline = Pipeline::new(Parameters {
            tri_eps: self.tri_eps,
            surface: self.surface,
            models: models.collect::<Result<_, _>>()?,
            seed: self.seed,
            ..Parameters::new(self.eps, self.dl)
        })?;
        pipeline.takes_tiles()?;
        Ok(pipeline)
    }
}

/// How far the points of tiles have to go beyond their boxes.
#[pyfunction]
pub fn tile_halo(settings: TileSettings) -> PyResult<f64> {
    let pipeline = settings.pipeline().map_err(|error| bad_value(&error))?;
    Ok(pipeline.tile_halo())
}

/// Tiles that a function of Python asks.
struct Asked<'a> {
    ask: &'a Py<PyAny>,
    bar: &'a Py<PyAny>,
    run: &'a Run,
    points: usize,
    dimension: usize,
    halo: f64,
}

impl Tiles for Asked<'_> {
    fn points(&self) -> usize {
        self.points
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn halo(&self) -> f64 {
        self.halo
    }

    fn bar(&self, rows: &[CloudRow]) -> Result<(), Error> {
        let rows: Vec<u32> = rows.iter().map(|row| row.index() as u32).collect();
        self.run.attached(|py| {
            let rows = PyArray1::from_vec(py, rows);
            self.bar.bind(py).call1((rows,)).map(drop)
        })
    }

    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error> {
        self.run.attached(|py| {
            let answers = self.ask.bind(py).call1((packed(py, question)?,))?;
            let answers: Vec<Bound<'_, PyBytes>> = answers.extract()?;
            answers.iter().map(|one| unpacked(one.as_bytes())).collect()
        })
    }
}

/// Reconstructs a surface from tiles: `ask` takes a question, and returns what [`tile_answer`] says of every tile; `bar` takes rows, and makes
/// the tiles anew with [`random_ranks`] that these are not in.
#[pyfunction]
pub fn reconstruct_tiles(
    py: Python<'_>,
    points: usize,
    dimension: usize,
    settings: TileSettings,
    ask: Py<PyAny>,
    bar: Py<PyAny>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Told> {
    let run = Run::default();
    let end = run.wait(py, told(progress), |send| {
        let mut pipeline = settings.pipeline()?.interrupt(run.interrupt());
        let asked = Asked {
            ask: &ask,
            bar: &bar,
            run: &run,
            points,
            dimension,
            halo: pipeline.tile_halo(),
        };
        pipeline = pipeline.on_stage(stages(&send, 1));
        Ok(End::of_outcome(pipeline.reconstruct_tiles(&asked)?))
    })?;
    end.told(py)
}
