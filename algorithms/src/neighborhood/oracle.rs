//! An oracle that knows how large every neighborhood is.

use super::{NeighborhoodPolicy, Surroundings};
use crosscap_core::{Error, Neighbor, NeighborhoodOracle, Scalar};

/// An oracle with the radii of a policy: the neighborhood of a point needs no radius any more. To
/// everybody else it is the oracle it was made from.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
/// use crosscap_algorithms::neighborhood::{NearestCount, PolicyOracle, Surroundings};
/// use crosscap_core::PointCloud;
/// let metric = Euclidean::new(PointCloud::new(1, vec![0.0, 1.0, 3.0, 7.0])?);
/// let oracle = BruteForceOracle::new(&metric);
/// let space = Surroundings { oracle: &oracle, metric: &metric, cloud: None, execute: &Serial };
/// let near = PolicyOracle::new(&NearestCount::new(1)?, &space)?;
/// let mut found = Vec::new();
/// near.neighborhood(3, &mut found);
/// assert_eq!(found.iter().map(|x| x.index).collect::<Vec<_>>(), [3, 2]);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub struct PolicyOracle<'a, S: Scalar> {
    oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    radii: Vec<f64>,
}

impl<'a, S: Scalar> PolicyOracle<'a, S> {
    /// Asks the policy for all radii.
    ///
    /// # Errors
    /// Those of the policy; [`Error::Law`] when it gives a radius that is not positive and finite,
    /// [`Error::Shape`] when it gives too few or too many.
    pub fn new(
        policy: &dyn NeighborhoodPolicy<S>,
        space: &Surroundings<'a, S>,
    ) -> Result<Self, Error> {
        let radii = policy.radii(space)?;
        if radii.len() != space.oracle.len() {
            return Err(Error::Shape {
                found: format!("{} radii from policy {}", radii.len(), policy.name()),
                expected: format!("{}, one a point", space.oracle.len()),
            });
        }
        if let Some(point) = radii.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
            return Err(Error::Law {
                plugin: policy.name().into(),
                law: "positive",
                point,
                detail: format!("radius {}", radii[point]),
            });
        }
        Ok(Self {
            oracle: space.oracle,
            radii,
        })
    }

    /// The radii, one a point.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// The radii, when nothing else is wanted.
    pub fn into_radii(self) -> Vec<f64> {
        self.radii
    }

    /// Writes the neighborhood of `center` into `out`, sorted by distance, ties by index.
    ///
    /// # Panics
    /// May panic when `center` is not a point.
    pub fn neighborhood(&self, center: usize, out: &mut Vec<Neighbor<S>>) {
        self.oracle.within(center, S::of(self.radii[center]), out);
    }
}

impl<S: Scalar> NeighborhoodOracle for PolicyOracle<'_, S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.oracle.len()
    }

    fn within(&self, center: usize, radius: S, out: &mut Vec<Neighbor<S>>) {
        self.oracle.within(center, radius, out);
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<S>>) {
        self.oracle.nearest(center, count, out);
    }

    fn within_of(&self, place: &[S], radius: S, out: &mut Vec<Neighbor<S>>) -> bool {
        self.oracle.within_of(place, radius, out)
    }

    fn name(&self) -> &str {
        self.oracle.name()
    }
}
