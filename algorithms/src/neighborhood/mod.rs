//! How large a neighborhood is: a radius for every point, over any oracle and any metric.
//!
//! | policy | radius of a point | use it when |
//! | --- | --- | --- |
//! | [`ConstantRadius`] | the same everywhere | the sampling is even: the paper's choice |
//! | [`NearestCount`] | reaches the k-th nearest other point | the density varies and the curvature with it |
//! | [`FlatRadius`] | the largest, of those that hold k points, at which the neighborhood is flat | the curvature varies |
//!
//! A policy gives radii, not lists of points: a neighborhood is then what
//! [`NeighborhoodOracle::within`] finds, strictly, so that all laws of the oracle hold for it, and
//! residuals can be compared with its size. [`PolicyOracle`] is an oracle with a policy bound to it.

mod constant;
mod flat;
mod nearest;
mod oracle;
#[cfg(test)]
mod tests;

pub use constant::ConstantRadius;
pub use flat::FlatRadius;
pub use nearest::NearestCount;
pub use oracle::PolicyOracle;

use crate::execute::Execute;
use crate::locality;
use crosscap_core::{Error, MetricSpace, NeighborhoodOracle, PointCloud, Scalar};

/// A finite space as a policy sees it.
#[derive(Clone, Copy)]
pub struct Surroundings<'a, S: Scalar> {
    /// Who is near whom.
    pub oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    /// The metric that the oracle serves.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// Coordinates, where the space has any.
    pub cloud: Option<&'a PointCloud<S>>,
    /// What runs the points.
    pub execute: &'a dyn Execute,
}

impl<S: Scalar> Surroundings<'_, S> {
    /// What `work` makes of every point, by row, with a workspace for each thread.
    pub(super) fn map<T: Send + Sync, C>(
        &self,
        scratch: impl Fn() -> C + Sync,
        work: impl Fn(&mut C, usize) -> T + Sync,
    ) -> Vec<T> {
        locality::map(self.execute, self.cloud, self.oracle.len(), scratch, work)
    }
}

/// Gives every point the radius of its neighborhood.
///
/// # Laws
/// - *positive*: every radius is positive and finite;
/// - *scale*: radii grow with the data (and with the lengths among the parameters);
/// - *order*: the radius of a point does not depend on the order of the points.
pub trait NeighborhoodPolicy<S: Scalar>: Sync {
    /// One radius a point (strict), unit of the data.
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] where there are not enough points at a finite distance.
    fn radii(&self, space: &Surroundings<'_, S>) -> Result<Vec<f64>, Error>;

    /// Short name for reports and the command line.
    fn name(&self) -> &str;
}

/// The smallest radius whose open ball holds the `count` nearest other points of `center`, ties
/// included.
fn reach_of_nearest<S: Scalar>(
    space: &Surroundings<'_, S>,
    center: usize,
    count: usize,
    near: &mut Vec<crosscap_core::Neighbor<S>>,
) -> Result<f64, Error> {
    space.oracle.nearest(center, count.saturating_add(1), near);
    let last = near.last().map_or(0.0, |x| x.distance.as_f64());
    let sparse = |found: usize| Error::SparseNeighborhood {
        point: center,
        found,
        needed: count.saturating_add(1),
        parameter: "the number of nearest points",
    };
    if near.len() <= count || !last.is_finite() {
        return Err(sparse(
            near.iter().filter(|x| x.distance.is_finite()).count(),
        ));
    }
    // The next number of the oracle's own type: the ball is open. Where all of them are copies
    // of the center, the least number that every type has.
    let open = S::of(last * (1.0 + 2.0 * S::default_epsilon().as_f64())).as_f64();
    Ok(open.max(f32::MIN_POSITIVE.into()))
}
