//! One radius for all points.

use super::{NeighborhoodPolicy, Surroundings};
use crosscap_core::{Error, Scalar, positive_length};

/// The same radius everywhere (Martin & Watson 2011, section 2).
///
/// ```
/// use crosscap_algorithms::neighborhood::ConstantRadius;
/// assert!(ConstantRadius::new(0.4).is_ok());
/// assert!(ConstantRadius::new(0.0).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantRadius(f64);

impl ConstantRadius {
    /// Radius `eps`, unit of the data.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless it is positive and finite.
    pub fn new(eps: f64) -> Result<Self, Error> {
        positive_length("eps", eps).map(Self)
    }
}

impl<S: Scalar> NeighborhoodPolicy<S> for ConstantRadius {
    fn radii(&self, space: &Surroundings<'_, S>) -> Result<Vec<f64>, Error> {
        Ok(vec![self.0; space.oracle.len()])
    }

    fn name(&self) -> &str {
        "radius"
    }
}
