//! Choosing a well-separated subset.

use crate::{Error, NeighborhoodOracle, Scalar};

/// Chooses landmarks: a subset with pairwise distance at least the separation.
///
/// # Why it has this shape
/// Landmarks become the vertices of the mesh. Two properties make a subset fit for that, and they pull in opposite
/// directions: no two too close, no point too far from all. The trait asks for both and leaves open which of
/// the many such subsets it is. `taken` is there because landmarks on curves are laid first, by other rules; the
/// seed, because a random choice must be the same at every run. Distances come from an oracle, so that a selector
/// works in any space.
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
