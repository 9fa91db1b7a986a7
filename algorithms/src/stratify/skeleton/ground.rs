//! What the skeleton is laid on.

use crate::orthogonal::dot;
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

    /// Whether points lead from one place to another: beside the straight way no stretch without them is longer than what a
    /// curve without a surface is joined over. O(k log k) for the k points as near to the first place as the other one.
    pub(super) fn is_followed(&self, a: Row, b: Row) -> bool {
        let SkeletonTuning {
            bare_gap,
            beside_way,
            ..
        } = *self.tuning;
        let length = self.distance(a, b);
        if length <= bare_gap * self.dl {
            return true;
        }
        let from = self.places.point(a.index());
        let way_to = |row: Row| -> Vec<f64> {
            let to = self.places.point(row.index());
            to.iter().zip(from).map(|(x, o)| x - o).collect()
        };
        let way = way_to(b);
        let mut near = Vec::new();
        (self.fitter).around(a, length + self.strata.moved(a), &mut near);
        let along = near.iter().filter_map(|&row| {
            let own = way_to(row);
            let along = dot(&own, &way) / length;
            let beside = (dot(&own, &own) - along * along).max(0.0).sqrt();
            (beside <= beside_way * self.dl && along > 0.0 && along < length).then_some(along)
        });
        let mut stops: Vec<f64> = along.chain([0.0, length]).collect();
        stops.sort_unstable_by(f64::total_cmp);
        (stops.windows(2)).all(|stretch| stretch[1] - stretch[0] <= bare_gap * self.dl)
    }
}
