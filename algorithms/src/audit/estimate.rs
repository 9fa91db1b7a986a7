//! Estimates of the dimension.

use super::{broken, slack, spread};
use crosscap_core::{
    BallDimension, Balls, DimensionEstimate, DimensionEstimator, Error, Neighborhood, Scalar,
};

/// Balls that are asked about for a second time, each on its own.
const ASKED_AGAIN: usize = 16;

/// The dimension that an estimator found at `point` from so many `neighbors`, at most `space`.
///
/// # Errors
/// Those of [`DimensionEstimate::check`].
pub(crate) fn dimension(
    plugin: &str,
    point: usize,
    estimate: &DimensionEstimate,
    neighbors: usize,
    space: usize,
) -> Result<usize, Error> {
    estimate.check(plugin, point, neighbors)?;
    // A value above the dimension of the space is an error of chance.
    Ok(estimate.dimension.min(space))
}

/// What an estimator said of all balls together: an answer for each, enough points, no more dimensions than
/// these span, and, of balls spread over the data, what it says of them one by one.
///
/// # Errors
/// [`Error::SparseNeighborhood`] for the first ball with too few points, [`Error::Law`] for what does not hold.
pub(crate) fn dimensions<S: Scalar>(
    estimator: &dyn DimensionEstimator<Scalar = S>,
    balls: &Balls<'_, S>,
    answers: &[BallDimension],
) -> Result<(), Error> {
    let (plugin, count) = (estimator.name(), balls.len());
    let law = "batch: an answer for every ball";
    if answers.len() != count {
        let detail = format!("{} answers for {count} balls", answers.len());
        return broken(plugin, law, 0, detail);
    }
    for (point, answer) in answers.iter().enumerate() {
        balls.enough(point, answer.neighbors as usize)?;
        if answer.dimension >= answer.neighbors.max(1) {
            let law = "answer: k points span at most k - 1 dimensions";
            let detail = format!("dimension {} from {}", answer.dimension, answer.neighbors);
            return broken(plugin, law, point, detail);
        }
    }
    let mut neighbors = Vec::new();
    for center in spread(count, ASKED_AGAIN) {
        let radius = balls.radii.of(center);
        balls.oracle.within(center, S::of(radius), &mut neighbors);
        let alone = estimator.estimate(&Neighborhood {
            center,
            radius,
            neighbors: &neighbors,
            metric: balls.metric,
            cloud: balls.cloud,
        })?;
        let (together, alone_is) = (answers[center].dimension as usize, alone.dimension);
        // A toss-up may fall either way.
        if together != alone_is && alone.confidence > slack::<S>() {
            let law = "batch: of all balls together what is said of each";
            let detail = format!("dimension {together} of all together, {alone_is} alone");
            return broken(plugin, law, center, detail);
        }
    }
    Ok(())
}
