//! A point cloud in the precision it is stored in.

use super::error::{Flaw, Parsed};
use super::npy::Numbers;
use crosscap_core::{Error, PointCloud, Scalar};

/// A point cloud in the precision that its file stores.
///
/// Files in `f32` are read in half of the memory; reconstruction itself works in `f64`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AnyCloud {
    /// Single precision.
    F32(PointCloud<f32>),
    /// Double precision; integers and texts come out as this, too.
    F64(PointCloud<f64>),
}

impl AnyCloud {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(cloud) => cloud.len(),
            Self::F64(cloud) => cloud.len(),
        }
    }

    /// Whether there is no point; readers refuse such files.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// N, the dimension of the space that the points lie in.
    pub fn dimension(&self) -> usize {
        match self {
            Self::F32(cloud) => cloud.dimension(),
            Self::F64(cloud) => cloud.dimension(),
        }
    }

    /// Name of the stored type, `f32` or `f64`.
    pub fn scalar_name(&self) -> &'static str {
        match self {
            Self::F32(_) => f32::NAME,
            Self::F64(_) => f64::NAME,
        }
    }

    /// The points in double precision, exactly; shares the memory of points that are stored so.
    pub fn to_f64(&self) -> PointCloud<f64> {
        match self {
            Self::F32(cloud) => cloud.cast(),
            Self::F64(cloud) => cloud.clone(),
        }
    }

    /// The points in double precision (exact; free of cost when they are stored so).
    pub fn into_f64(self) -> PointCloud<f64> {
        match self {
            Self::F32(cloud) => cloud.cast(),
            Self::F64(cloud) => cloud,
        }
    }
}

/// Numbers in row order become points: at least one row, at least two columns, all finite.
pub(crate) fn cloud(rows: usize, columns: usize, numbers: Numbers) -> Parsed<AnyCloud> {
    if rows == 0 || columns == 0 {
        return Err(Flaw::new(
            format!("{rows} rows of {columns} columns"),
            "at least one point",
        ));
    }
    if columns == 1 {
        return Err(Flaw::new(
            format!("{rows} rows of one column"),
            "at least 2 coordinates a point: a surface needs room",
        ));
    }
    match numbers {
        Numbers::F32(v) => points(columns, v).map(AnyCloud::F32),
        numbers => points(columns, numbers.into_f64()).map(AnyCloud::F64),
    }
}

/// A cloud of any size; a number that is not finite is named by row and column.
pub(crate) fn points<S: Scalar>(columns: usize, coordinates: Vec<S>) -> Parsed<PointCloud<S>> {
    let shown: Option<String> = coordinates
        .iter()
        .find(|c| !c.is_finite())
        .map(|c| c.as_f64().to_string());
    PointCloud::new(columns, coordinates).map_err(|e| match e {
        Error::NotFinite { row, column } => Flaw::row(
            "",
            row,
            Some(column),
            shown.unwrap_or_default(),
            "a finite number",
        ),
        other => Flaw::new(other.to_string(), "points in rows of equal length"),
    })
}
