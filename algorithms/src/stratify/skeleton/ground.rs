//! What the skeleton is laid on.

use crate::orthogonal::dot;
use crate::stratify::analysis::Fitter;
use crate::stratify::site::StratumKind;
use crate::stratify::strata::Strata;
use crate::stretch;
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

    /// The way from the place of one row to that of another.
    pub(super) fn way(&self, from: Row, to: Row) -> Vec<f64> {
        let [from, to] = [from, to].map(|row| self.places.point(row.index()));
        from.iter().zip(to).map(|(a, b)| b - a).collect()
    }

    /// Whether points lead from one place to another, on a curve without a surface: beside the straight way no stretch without
    /// them is too long for chance, next to the spacings of the curve about the other place, where so many ways are `tried`.
    /// O(k log k) for the k points as near to the first place as the other one.
    pub(super) fn is_followed(&self, from: Row, to: Row, tried: usize) -> bool {
        let tuning = self.tuning;
        let length = self.distance(from, to);
        if length <= tuning.bare_gap * self.dl {
            return true;
        }
        let mut near = Vec::new();
        (self.fitter).around(from, length + self.strata.moved(from), &mut near);
        let inside = self
            .along(from, to, &near)
            .filter(|along| (0.0..length).contains(along));
        let mut stops: Vec<f64> = inside.chain([0.0, length]).collect();
        stops.sort_unstable_by(f64::total_cmp);
        let stretches = stops.windows(2).map(|pair| pair[1] - pair[0]);
        let longest = stretches.fold(0.0, f64::max);
        if longest <= tuning.bare_gap * self.dl {
            return true;
        }
        self.fitter.around(to, tuning.join * self.dl, &mut near);
        near.retain(|&row| {
            self.strata.kind(row) == Some(StratumKind::Curve) && self.strata.cells(row) == 0
        });
        let curve = || near.iter().map(|&row| self.distance(to, row));
        let span = curve().fold(0.0, f64::max);
        let chance = stretch::chance(longest, span, near.len().saturating_sub(1));
        tried as f64 * chance >= tuning.bare_chance
    }

    /// How far along the straight way between two places those of the given rows are that lie beside it.
    fn along<'r>(&'r self, from: Row, to: Row, rows: &'r [Row]) -> impl Iterator<Item = f64> + 'r {
        let way = self.way(from, to);
        let (length, beside) = (self.distance(from, to), self.tuning.beside_way * self.dl);
        rows.iter().filter_map(move |&row| {
            let own = self.way(from, row);
            let along = dot(&own, &way) / length;
            let off = (dot(&own, &own) - along * along).max(0.0).sqrt();
            (off <= beside).then_some(along)
        })
    }
}
