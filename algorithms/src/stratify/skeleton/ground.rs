//! What the skeleton is laid on.

use crate::stratify::analysis::Fitter;
use crate::stratify::strata::Strata;
use crate::tuning::SkeletonTuning;
use crosscap_core::{PointCloud, Row, Scalar};

/// The strata, with what is at hand to lay chains over them.
pub(super) struct Ground<'g, 'a, S: Scalar> {
    pub(super) fitter: &'g Fitter<'a, S>,
    pub(super) strata: &'g Strata,
    pub(super) places: &'g PointCloud<f64>,
    pub(super) tuning: &'g SkeletonTuning,
    pub(super) dl: f64,
}

impl<S: Scalar> Ground<'_, '_, S> {
    /// Distance of the places of two rows.
    pub(super) fn distance(&self, a: Row, b: Row) -> f64 {
        self.places.squared_distance(a.index(), b.index()).sqrt()
    }
}
