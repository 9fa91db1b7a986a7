//! Two sheets of points over each other, told from one sheet by the gap in its heights.

use std::f64::consts::{PI, TAU};

/// Least number of points of a sheet, and least share of those that are looked at together.
const FEWEST: usize = 5;
const LEAST_SHARE: f64 = 0.08;
/// Least gap between sheets, in local spacings: below it rounding and bending are no less likely.
const LEAST_GAP: f64 = 0.05;
/// A gap is this many times the scatter of the heights on its two sides, root mean square.
const CLEAR: f64 = 2.5;
/// Points of the larger sheet that a point of the smaller one is to lie among.
const AMONG: usize = 8;
/// How far away these may be, in spacings of the larger sheet: a disc of that radius holds 20 of its points.
const REACH: f64 = 2.5;
/// Widest angle without one of them, seen from the point. It is 180 degrees and more for a point beside the others.
const OPEN: f64 = 160.0 / 180.0 * PI;
/// Least share of the points of the smaller sheet that lie among those of the larger. Seven of ten do where two sheets
/// lie over each other and reach beyond what is looked at; beyond an edge, none.
const MOST: f64 = 0.5;

/// Heights over a patch that fall into two, each with its points, one lot over the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Overlay {
    /// Gap in the heights, unit of the data.
    pub gap: f64,
    /// How likely heights that fill their range show it anywhere.
    pub chance: f64,
}

impl Overlay {
    /// Cuts the heights at their largest inner gap. None where it is small beside the spacing of the points or the scatter
    /// on its sides, or where the two lots lie side by side.
    ///
    /// O(m^2) for m points.
    pub fn of(flat: &[[f64; 2]], heights: &[f64], spacing: f64) -> Option<Self> {
        let count = heights.len();
        if count < 4 * FEWEST {
            return None;
        }
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_unstable_by(|&a, &b| heights[a].total_cmp(&heights[b]).then(a.cmp(&b)));
        let height = |k: usize| heights[order[k]];
        let fewest = FEWEST.max((LEAST_SHARE * count as f64).ceil() as usize);
        let (mut gap, mut cut) = (0.0, 0);
        for k in fewest..=count - fewest {
            let here = height(k) - height(k - 1);
            if here > gap {
                (gap, cut) = (here, k);
            }
        }
        let sides = order.split_at(cut);
        let large = gap > LEAST_GAP * spacing && gap > CLEAR * scatter(heights, sides);
        (large && among(flat, sides, spacing)).then(|| Self {
            gap,
            chance: chance(heights, sides, gap),
        })
    }
}

/// Root mean square of the heights about the mean of their side.
fn scatter(heights: &[f64], (low, high): (&[usize], &[usize])) -> f64 {
    let mut sum = 0.0;
    for side in [low, high] {
        let mean = side.iter().map(|&k| heights[k]).sum::<f64>() / side.len() as f64;
        sum += side
            .iter()
            .map(|&k| (heights[k] - mean).powi(2))
            .sum::<f64>();
    }
    (sum / heights.len() as f64).sqrt()
}

/// How likely the gap is in heights of one sheet.
///
/// Heights that are uniform over a range leave a share x of it empty, between two of m points, with probability
/// m (1 - x)^(m - 2): that is asked of all points. The points of each side leave the gap empty, which is the end of their range then,
/// with probability (1 - x)^(m - 1), x the share of their own range and the gap: beyond an edge a sheet climbs, and the few
/// points of it that are in sight have a range as wide as the gap below them.
fn chance(heights: &[f64], (low, high): (&[usize], &[usize]), gap: f64) -> f64 {
    let height = |at: Option<&usize>| at.map_or(0.0, |&k| heights[k]);
    let range = |side: &[usize]| height(side.last()) - height(side.first());
    let filled = |range: f64, points: usize| (range / (range + gap)).powi(points as i32);
    let count = heights.len();
    let all = count as f64 * filled(range(low) + range(high), count - 2);
    let own = |side: &[usize]| filled(range(side), side.len() - 1);
    all.max(own(low)).max(own(high))
}

/// Whether the points of the smaller side have points of the larger all around them, along the surface.
fn among(flat: &[[f64; 2]], (low, high): (&[usize], &[usize]), spacing: f64) -> bool {
    let (few, many) = if low.len() < high.len() {
        (low, high)
    } else {
        (high, low)
    };
    let share = many.len() as f64 / flat.len() as f64;
    let reach = REACH * spacing / share.sqrt();
    let mut near: Vec<[f64; 2]> = Vec::with_capacity(many.len());
    let mut is_among = |&k: &usize| {
        let offsets = many.iter().map(|&other| {
            let [u, v] = [flat[other][0] - flat[k][0], flat[other][1] - flat[k][1]];
            [u.hypot(v), v.atan2(u)]
        });
        near.clear();
        near.extend(offsets.filter(|x| x[0] < reach));
        near.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        near.truncate(AMONG);
        near.sort_unstable_by(|a, b| a[1].total_cmp(&b[1]));
        let Some((first, last)) = near.first().zip(near.last()) else {
            return false;
        };
        let round = first[1] + TAU - last[1];
        let between = near.windows(2).map(|x| x[1][1] - x[0][1]);
        between.fold(round, f64::max) < OPEN
    };
    let inside = few.iter().filter(|k| is_among(k)).count();
    inside as f64 >= MOST * few.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::Random;

    /// Points of a disc of radius 4, 50 of them, with heights over it.
    fn sheet(
        seed: u64,
        height: impl Fn(&mut Random, [f64; 2]) -> f64,
    ) -> (Vec<[f64; 2]>, Vec<f64>) {
        let mut random = Random::new(seed);
        let mut flat = Vec::new();
        while flat.len() < 50 {
            let place = [random.between(-4.0, 4.0), random.between(-4.0, 4.0)];
            if place[0].hypot(place[1]) < 4.0 {
                flat.push(place);
            }
        }
        let heights = flat.iter().map(|&p| height(&mut random, p)).collect();
        (flat, heights)
    }

    /// At the rim of what is in sight points have others on one side alone, so that not every place tells.
    #[test]
    fn sheets_over_each_other_are_told_at_most_places() {
        for share in [0.5, 0.3, 0.25] {
            let is_told = |seed: &u64| {
                let (flat, heights) = sheet(*seed, |random, _| {
                    let upper = random.uniform() < share;
                    f64::from(u8::from(upper)) * 0.6 + random.between(0.0, 0.1)
                });
                let found = Overlay::of(&flat, &heights, 1.0);
                found.is_some_and(|x| x.gap > 0.5 && x.chance < 1e-6)
            };
            let told = (1..41).filter(is_told).count();
            assert!(told > 14, "{share}: {told} of 40");
        }
    }

    #[test]
    fn sheets_of_noisy_points_are_told_too() {
        let is_told = |seed: &u64| {
            let (flat, heights) = sheet(*seed, |random, _| {
                let upper = random.uniform() < 0.5;
                f64::from(u8::from(upper)) * 0.8 + 0.1 * random.normal()
            });
            Overlay::of(&flat, &heights, 1.0).is_some_and(|x| x.chance < 1e-5)
        };
        assert!((1..41).filter(is_told).count() > 10);
    }

    #[test]
    fn a_step_lies_side_by_side() {
        for seed in 1..9 {
            let (flat, heights) = sheet(seed, |_, p| f64::from(u8::from(p[0] > 2.0)) * 0.6);
            assert_eq!(Overlay::of(&flat, &heights, 1.0), None, "{seed}");
        }
    }

    #[test]
    fn a_sheet_that_climbs_explains_the_gap_below_its_points() {
        for seed in 1..40 {
            let (flat, heights) = sheet(seed, |_, p| (p[0] - 2.0).max(0.0));
            let found = Overlay::of(&flat, &heights, 1.0);
            assert!(found.is_none_or(|x| x.chance > 1e-3), "{found:?}");
        }
    }
}
