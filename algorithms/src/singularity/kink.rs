//! The lowest curve with one kink above points of the plane.

use super::lowest::lowest;
use nalgebra::SVector;
use std::f64::consts::{PI, TAU};

/// The curve `v = a + b t + d |t - k|`, bent a little on both sides of `k`, of least mean height over points `(t, v)` with none of them above it: two
/// arms that meet in a corner. The points are of the size 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kink {
    /// Where the kink is.
    pub(super) place: f64,
    /// Coefficients of 1, t, |t - k|, and of the squares of t - k before and behind it.
    terms: SVector<f64, TERMS>,
    /// Mean height over the points.
    mean: f64,
}

const TERMS: usize = 5;
/// Places at which the kink is tried, each time over a narrower range.
const TRIED: usize = 11;
/// Times that the range is made narrower, and how much of it is left.
const LEVELS: usize = 3;
const LEFT: f64 = 0.25;
/// The arms rise by no more than this: an angle of 11 degrees between them, seen along the line that halves it.
const STEEPEST: f64 = 5.0;

impl Kink {
    fn row(place: f64, t: f64) -> SVector<f64, TERMS> {
        let d = t - place;
        let squares = if d < 0.0 { [d * d, 0.0] } else { [0.0, d * d] };
        SVector::from([1.0, t, d.abs(), squares[0], squares[1]])
    }

    /// The lowest with its kink at a place.
    fn at_place(points: &[[f64; 2]], place: f64, bend: f64) -> Option<Self> {
        let row = |t: f64| Self::row(place, t);
        let bounds = [2.0 * STEEPEST, STEEPEST, STEEPEST, bend, bend];
        let terms = lowest(points, row, &bounds)?;
        let sum = points.iter().map(|p| terms.dot(&row(p[0]))).sum::<f64>();
        Some(Self {
            place,
            terms,
            mean: sum / points.len().max(1) as f64,
        })
    }

    /// The lowest with its kink within `reach` of 0, as near as a search finds it; the arms bend by at most `bend`, half of
    /// their second derivative.
    pub(super) fn above(points: &[[f64; 2]], reach: f64, bend: f64) -> Option<Self> {
        let mut best: Option<Self> = None;
        let (mut middle, mut half) = (0.0, reach);
        for _ in 0..LEVELS {
            let step = |k: usize| half * (2.0 * k as f64 / (TRIED - 1) as f64 - 1.0);
            let tried = (0..TRIED).map(|k| middle + step(k));
            let inside = tried.filter(|place| place.abs() <= reach);
            let found = inside.filter_map(|place| Self::at_place(points, place, bend));
            let both = best.into_iter().chain(found);
            best = both.min_by(|a, b| a.mean.total_cmp(&b.mean));
            middle = best?.place;
            half *= LEFT;
        }
        best
    }

    /// Its height.
    pub(super) fn at(&self, t: f64) -> f64 {
        self.terms.dot(&Self::row(self.place, t))
    }

    /// The corner.
    pub(super) fn corner(&self) -> [f64; 2] {
        [self.place, self.at(self.place)]
    }

    /// Slopes of the arms before and behind the corner, where they meet.
    pub(super) fn slopes(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|side| self.terms[1] + side * self.terms[2])
    }

    /// The angle between the arms where they meet, below them.
    pub(super) fn inner_angle(&self) -> f64 {
        let [before, behind] = self.slopes();
        PI - before.atan() + behind.atan()
    }

    /// Angles from the arms, where they are as far from the corner, down to a point that is given about the corner.
    pub(super) fn below_arms(&self, [t, v]: [f64; 2]) -> [f64; 2] {
        let far = t.hypot(v);
        let slopes = self.slopes();
        // What is beyond the middle of the outside is a rounding above the arm.
        let outside = (TAU + self.inner_angle()) / 2.0;
        [0, 1].map(|arm| {
            let side = [-1.0, 1.0][arm];
            let s = side * far / slopes[arm].hypot(1.0);
            let rise = slopes[arm] + self.terms[3 + arm] * s;
            // Seen from the side on which the arm goes to the right.
            let down = ((side * rise).atan() - v.atan2(side * t)).rem_euclid(TAU);
            if down > outside { 0.0 } else { down }
        })
    }

    /// The place of an arm, 0 before and 1 behind the corner, that is nearest to a point, by Newton's method from the tangent at the corner.
    pub(super) fn foot(&self, arm: usize, [t, v]: [f64; 2]) -> [f64; 2] {
        let side = [-1.0, 1.0][arm];
        let (slope, bend) = (self.slopes()[arm], self.terms[3 + arm]);
        let [t0, v0] = self.corner();
        let [x, y] = [t - t0, v - v0];
        let mut s = (x + slope * y) / (1.0 + slope * slope);
        for _ in 0..8 {
            let (height, rise) = (s * (slope + bend * s) - y, slope + 2.0 * bend * s);
            let second = 1.0 + rise * rise + 2.0 * bend * height;
            if second < 0.1 {
                break;
            }
            s -= (s - x + height * rise) / second;
        }
        let s = side * (side * s).max(0.0);
        [t0 + s, v0 + s * (slope + bend * s)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn finds_the_corner_of_a_wedge() {
        for turn in [-1.0, 1.0] {
            let points: Vec<[f64; 2]> = (0..400)
                .map(|k| {
                    let t = f64::from(k % 40) / 20.0 - 0.975;
                    [t, 0.3 + turn * (t - 0.125).abs() - 0.1 * f64::from(k / 40)]
                })
                .collect();
            let found = Kink::above(&points, 0.7, 0.0).unwrap();
            let [t, v] = found.corner();
            assert!(
                (t - 0.125).abs() < 0.02 && (v - 0.3).abs() < 0.02,
                "{found:?}"
            );
            let [before, behind] = found.slopes();
            assert!((before + turn).abs() < 0.05 && (behind - turn).abs() < 0.05);
        }
    }

    proptest! {
        #[test]
        fn none_of_the_points_is_above(
            points in prop::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 3..60),
        ) {
            let kink = Kink::above(&points, 0.7, 0.3).unwrap();
            prop_assert!(points.iter().all(|p| kink.at(p[0]) - p[1] > -1e-9));
        }

        #[test]
        fn the_foot_is_nearest(x in prop::array::uniform2(-1.0..1.0f64), bend in -0.3..0.3f64) {
            let terms = SVector::from([0.1, 0.2, -0.9, bend, -bend]);
            let kink = Kink { place: 0.1, terms, mean: 0.0 };
            let far = |p: [f64; 2]| (p[0] - x[0]).hypot(p[1] - x[1]);
            let least = [0, 1].map(|arm| far(kink.foot(arm, x))).into_iter().fold(9.0, f64::min);
            let tried = (0..=400).map(|k| f64::from(k) / 100.0 - 1.9).map(|t| far([t, kink.at(t)]));
            prop_assert!(least <= tried.fold(9.0, f64::min) + 1e-9);
        }
    }
}
