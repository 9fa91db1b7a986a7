//! A neighborhood as a singularity model sees it.

/// A neighborhood in its own principal coordinates, as a singularity model sees it.
///
/// The origin is the mean of the neighborhood, axes are principal directions in order of
/// falling variance.
#[derive(Clone, Copy, Debug)]
pub struct LocalPoints<'a> {
    /// Number of coordinates a point has, [`SingularityModel::local_dimension`](crate::SingularityModel::local_dimension) of them.
    pub dimension: usize,
    /// `count * dimension` coordinates in row order, in the unit of the data.
    pub coordinates: &'a [f64],
    /// How many leading rows the model is fitted to: the neighborhood. Rows behind them lie
    /// a little farther out and are only labelled.
    pub fitted: usize,
    /// Which row is the center: the point that is asked about. It may be one behind those that are fitted.
    pub center: usize,
    /// Which row the ball of `radius` is about. The fitted rows fill this ball as far as the surface does, so where it is empty tells something.
    ///
    /// The pipeline asks about points in balls about them, and then this is the center as well. A fit that stands for more points
    /// ([`SingularityModel::decompose_about`](crate::SingularityModel::decompose_about)) is asked about other centers, and the ball stays
    /// where it is: a model that measures its ball does so from here, and so its fit is the same whoever is the center.
    pub middle: usize,
    /// Radius of the neighborhood.
    pub radius: f64,
}

impl LocalPoints<'_> {
    /// Number of points, those that are only labelled included.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dimension
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// Coordinates of point `k`.
    pub fn point(&self, k: usize) -> &[f64] {
        &self.coordinates[k * self.dimension..(k + 1) * self.dimension]
    }
}
