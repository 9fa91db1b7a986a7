//! Coordinates from distances.
//!
//! | from | way | exact for |
//! | --- | --- | --- |
//! | [`scale_metric`] | classical scaling of a few points, all others placed by their distances to these | points of R^m, every distance known |
//! | [`scale_patches`] | classical scaling of overlapping patches, moved onto each other | points of R^m, near distances known |
//!
//! Whether the result *is* the data or only a picture of it is measured, not assumed:
//! [`Scaled::deviation`] is the largest difference to a known distance. Distances that are not
//! those of points in a Euclidean space (geodesic ones, say) have no exact places.

mod patches;
mod pivots;

pub use patches::scale_patches;
pub use pivots::{picture_of_metric, scale_metric};

use crosscap_core::PointCloud;

/// Places of points that were known by their distances.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaled {
    /// One place a point, in the unit of the distances.
    pub places: PointCloud<f64>,
    /// Largest difference between a known distance and that of the places, unit of the data.
    pub deviation: f64,
}

/// Most dimensions that are sought.
const MOST_DIMENSIONS: usize = 64;

/// Number of leading eigenvalues (largest first) that stand out of the rounding, which shows in the
/// negative ones; at least 1.
fn significant(eigenvalues: &[f64]) -> usize {
    let top = eigenvalues.first().copied().unwrap_or(0.0);
    let noise = eigenvalues.last().map_or(0.0, |&least| -least).max(0.0);
    let limit = (4.0 * noise).max(1e-11 * top);
    let count = eigenvalues.iter().take_while(|&&v| v > limit).count();
    count.clamp(1, MOST_DIMENSIONS)
}
