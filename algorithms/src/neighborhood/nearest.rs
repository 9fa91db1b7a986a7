//! As many points for every point.

use super::{NeighborhoodPolicy, Surroundings, reach_of_nearest};
use crosscap_core::{Error, Scalar};

/// The radius that reaches the `count` nearest other points, ties included (named as the
/// alternative to a radius by Martin & Watson 2011, section 2). `O(count)` a point after the query.
///
/// Radii change no faster than distances: those of two points differ by at most their distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NearestCount(usize);

impl NearestCount {
    /// So many other points in every neighborhood.
    ///
    /// # Errors
    /// [`Error::Parameter`] for 0.
    pub fn new(count: usize) -> Result<Self, Error> {
        if count > 0 {
            return Ok(Self(count));
        }
        Err(Error::Parameter {
            name: "nearest points",
            value: "0".into(),
            expected: "at least 1".into(),
        })
    }
}

impl<S: Scalar> NeighborhoodPolicy<S> for NearestCount {
    fn radii(&self, space: &Surroundings<'_, S>) -> Result<Vec<f64>, Error> {
        space
            .map(Vec::new, |near, i| reach_of_nearest(space, i, self.0, near))
            .into_iter()
            .collect()
    }

    fn name(&self) -> &str {
        "k-nearest"
    }
}
