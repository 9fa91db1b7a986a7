//! Local coordinates for a neighborhood.

use crate::Error;

/// Coordinates of `k` points in a chart of dimension `dimension`.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Dimension of the chart.
    pub dimension: usize,
    /// `k * dimension` coordinates in row order, in the unit of the data.
    pub coordinates: Vec<f64>,
    /// Share of the squared distances that the chart does not carry, 0 (flat data) to 1.
    pub distortion: f64,
}

/// Lays a neighborhood out in a space of low dimension, from its distances alone.
///
/// # Why it has this shape
/// A chart gets distances and no coordinates, because behind the waist there are none: what is triangulated may
/// have been measured in a laboratory. The matrix is full, since a chart holds a few dozen landmarks and every
/// method of scaling needs all pairs. A chart says how much it loses and does not refuse for it: how much is too
/// much is for the certificate, which sees the mesh.
///
/// # Laws
/// - *flat data*: distances of points of a flat `dimension`-space are reproduced within rounding;
/// - *distortion*: 0 for flat data, and growing with the share that is lost;
/// - *motion*: a chart depends on the distances only;
/// - *finite*: finite distances give finite coordinates.
///
/// Orientation is arbitrary: callers must not rely on it.
pub trait LocalChart: Sync {
    /// Chart of `count` points from their symmetric matrix of distances (row order, the
    /// unit of the data). Point 0 is the center of the neighborhood.
    ///
    /// # Errors
    /// [`Error::Shape`] when `distances` is not `count * count` long, [`Error::NotFinite`] for
    /// one that is not a finite number.
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error>;

    /// Short name for reports.
    fn name(&self) -> &str;
}
