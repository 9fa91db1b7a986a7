//! Choosing a well-separated subset.

use crate::{Error, NeighborhoodOracle, Scalar};

/// Chooses landmarks: a subset with pairwise distance at least the separation.
///
/// # Laws
/// - *separation*: two chosen points are at distance at least `separation`;
/// - *covering*: a candidate that was not chosen has a chosen point (or one of `taken`)
///   at distance less than `separation`;
/// - *reproducible*: the same answer for the same seed.
pub trait LandmarkSelector: Sync {
    /// Type of the distances.
    type Scalar: Scalar;

    /// Landmarks among `candidates`, in the order in which they were chosen, keeping
    /// `separation` to `taken` as well.
    ///
    /// # Errors
    /// [`Error::Parameter`] when `separation` is not positive.
    fn select(
        &self,
        oracle: &dyn NeighborhoodOracle<Scalar = Self::Scalar>,
        candidates: &[usize],
        taken: &[usize],
        separation: f64,
        seed: u64,
    ) -> Result<Vec<usize>, Error>;

    /// Short name for reports.
    fn name(&self) -> &str;
}
