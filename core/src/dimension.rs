//! How many dimensions a neighborhood has.

use crate::{Error, Neighborhood, Scalar};
use serde::{Deserialize, Serialize};

/// A local dimension with its evidence.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DimensionEstimate {
    /// The estimate as a whole number, what the pipeline acts on.
    pub dimension: usize,
    /// The estimate before rounding; equal to `dimension` for estimators that count.
    pub value: f64,
    /// How far the decision was from falling otherwise, 0 (a toss-up) to 1.
    pub confidence: f64,
    /// What it was read from; for principal component analysis the variances,
    /// largest first, in squared units of the data. May be empty.
    pub spectrum: Vec<f64>,
}

/// Estimates the dimension of the set that a neighborhood was sampled from.
///
/// # Why it has this shape
/// An estimator sees one neighborhood at a time and keeps nothing, so that neighborhoods can be worked on by many
/// threads in any order. It gets distances and, where the space has them, coordinates; one that works by
/// distances serves every space, and one that needs coordinates says so with an error instead of guessing. It
/// returns more than a number: the value before rounding and a confidence, because a decision that could have
/// fallen either way is treated as such. The radius is part of the neighborhood, because a threshold
/// that is no share of it would give another answer in another unit.
///
/// # Laws
/// - *motion*: the same answer after a rigid motion, within rounding;
/// - *scale*: the same answer after uniform scaling of data and radius;
/// - *embedding*: the same answer after an isometric embedding in a larger space;
/// - *order*: the same answer for any order of the points of the cloud, within rounding.
pub trait DimensionEstimator: Sync {
    /// Type of the coordinates.
    type Scalar: Scalar;

    /// The dimension at the center of `neighborhood`.
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] when there are too few points,
    /// [`Error::Shape`] when coordinates are needed and there are none.
    fn estimate(
        &self,
        neighborhood: &Neighborhood<'_, Self::Scalar>,
    ) -> Result<DimensionEstimate, Error>;

    /// The estimate from the variances along the principal directions of a neighborhood, largest first,
    /// for an estimator that reads nothing else: whoever fits a model to a ball has them at hand. As it
    /// stands `None`, and [`estimate`](Self::estimate) is asked.
    ///
    /// An answer must be that of `estimate` for a neighborhood with these variances.
    fn of_variances(&self, _variances: &[f64]) -> Option<DimensionEstimate> {
        None
    }

    /// Short name for reports.
    fn name(&self) -> &str;
}
