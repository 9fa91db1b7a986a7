//! How many dimensions a neighborhood has.

use crate::execute::Execute;
use crate::{BallDimension, Balls, Error, Neighborhood, Scalar};
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

impl DimensionEstimate {
    /// Whether this can be the answer of an estimator named `plugin` about the ball of so many `neighbors` around
    /// `point`.
    ///
    /// # Errors
    /// [`Error::Law`] for a value that is not finite or negative, a confidence outside 0 to 1, a dimension
    /// that is not the value rounded, or more dimensions than the points span.
    pub fn check(&self, plugin: &str, point: usize, neighbors: usize) -> Result<(), Error> {
        let Self {
            dimension,
            value,
            confidence,
            ..
        } = *self;
        let broken = |law: &'static str, detail: String| {
            Err(Error::Law {
                plugin: plugin.into(),
                law,
                point,
                detail,
            })
        };
        if !(value.is_finite() && value >= 0.0) {
            let law = "answer: the value is finite and at least 0";
            return broken(law, format!("{value}"));
        }
        if !(0.0..=1.0).contains(&confidence) {
            let law = "answer: the confidence is between 0 and 1";
            return broken(law, format!("{confidence}"));
        }
        if (value - dimension as f64).abs() > 0.5 + ROUNDING {
            let law = "rounded: the dimension is the value rounded";
            return broken(law, format!("dimension {dimension} for the value {value}"));
        }
        if dimension >= neighbors.max(1) {
            let law = "answer: k points span at most k - 1 dimensions";
            return broken(
                law,
                format!("dimension {dimension} from {neighbors} points"),
            );
        }
        Ok(())
    }
}

/// A value this far beyond a half may be rounded either way.
const ROUNDING: f64 = 1e-6;

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
