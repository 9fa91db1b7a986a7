//! How many dimensions a neighborhood has.

use crate::execute::Execute;
use crate::{BallDimension, Balls, DimensionEstimate, Error, Neighborhood, Scalar};

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
/// The pipeline asks for [all balls of a cloud](Self::estimate_all) at once. Who implements nothing else is asked ball by ball
/// there; who can share work between balls that overlap, as the default estimator does with moments that it sums in a tree,
/// overrides that one method, and is held to the answers of the other.
///
/// # Laws
/// - *motion*: the same answer after a rigid motion, within rounding;
/// - *scale*: the same answer after uniform scaling of data and radius;
/// - *embedding*: the same answer after an isometric embedding in a larger space;
/// - *order*: the same answer for any order of the points of the cloud, within rounding;
/// - *batch*: of all balls together `estimate_all` says what `estimate` says of each, within rounding.
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

    /// The dimensions of the balls about all points of a space, in the order of the points. As it stands every ball is
    /// asked for on its own.
    ///
    /// The answers must be those of [`estimate`](Self::estimate), whatever runs the jobs of `execute`.
    ///
    /// # Errors
    /// Those of `estimate` and [`Balls::one_by_one`].
    fn estimate_all(
        &self,
        balls: &Balls<'_, Self::Scalar>,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        balls.one_by_one(self.name(), execute, |ball| self.estimate(ball))
    }

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
