//! As large as the surface is flat.

use super::{NeighborhoodPolicy, Surroundings, reach_of_nearest};
use crosscap_core::{DimensionEstimator, Error, Neighbor, Neighborhood, Scalar, positive_length};

/// The largest radius of a falling ladder at which an estimator calls the neighborhood
/// 2-dimensional: eps, 3/4 eps, 9/16 eps, ... down to the radius of the `least` nearest other points.
///
/// A ball that sees a fold, or a second sheet that only comes near, is made smaller until it is
/// flat; on a crossing no ball is, and it ends with the ladder, where the sheets bend least. A
/// neighborhood of fewer than `least` points at eps is widened until it holds them. The estimator
/// decides by its own tolerance.
pub struct FlatRadius<'a, S: Scalar> {
    eps: f64,
    least: usize,
    estimator: &'a dyn DimensionEstimator<Scalar = S>,
}

/// A step of the ladder.
const STEP: f64 = 0.75;
/// Most points that are looked at: every few of a larger ball, by distance.
const MOST: usize = 256;

impl<'a, S: Scalar> FlatRadius<'a, S> {
    /// Radii from that of the `least` nearest other points to `eps`, unit of the data.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `eps` is positive and finite and `least` at least 1.
    pub fn new(
        eps: f64,
        least: usize,
        estimator: &'a dyn DimensionEstimator<Scalar = S>,
    ) -> Result<Self, Error> {
        let eps = positive_length("eps", eps)?;
        if least == 0 {
            return Err(Error::Parameter {
                name: "nearest points",
                value: "0".into(),
                expected: "at least 1".into(),
            });
        }
        Ok(Self {
            eps,
            least,
            estimator,
        })
    }

    fn radius(
        &self,
        space: &Surroundings<'_, S>,
        center: usize,
        near: &mut Vec<Neighbor<S>>,
    ) -> Result<f64, Error> {
        let floor = reach_of_nearest(space, center, self.least, near)?;
        let mut radius = self.eps;
        if floor >= radius {
            return Ok(floor);
        }
        space.oracle.within(center, S::of(radius), near);
        loop {
            let stride = near.len().div_ceil(MOST);
            let thinned: Vec<Neighbor<S>>;
            let neighbors = if stride > 1 {
                thinned = near.iter().step_by(stride).copied().collect();
                &thinned
            } else {
                &*near
            };
            let estimate = self.estimator.estimate(&Neighborhood {
                center,
                radius,
                neighbors,
                metric: space.metric,
                cloud: space.cloud,
            })?;
            if estimate.dimension <= 2 {
                return Ok(radius);
            }
            if radius * STEP <= floor {
                return Ok(floor);
            }
            radius *= STEP;
            let limit = S::of(radius);
            let inside = near.partition_point(|x| x.distance < limit);
            near.truncate(inside);
        }
    }
}

impl<S: Scalar> NeighborhoodPolicy<S> for FlatRadius<'_, S> {
    fn radii(&self, space: &Surroundings<'_, S>) -> Result<Vec<f64>, Error> {
        space
            .map(Vec::new, |near, i| self.radius(space, i, near))
            .into_iter()
            .collect()
    }

    fn name(&self) -> &str {
        "adaptive"
    }
}
