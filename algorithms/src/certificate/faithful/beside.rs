//! How far apart the points of a curve are beside a stretch of it.

use super::ground::{COUNTED, Count};

/// Spacings that are counted at a time on each side.
const BLOCK: usize = 16;
/// Spacings that are counted whatever they are; further ones only where they are not denser.
const LEAST: f64 = 2.0 * BLOCK as f64;

/// The points of a curve from a stretch on, away from it.
pub(super) struct Side<'a> {
    feet: &'a [f64],
    forward: bool,
}

impl<'a> Side<'a> {
    /// Those after the stretch, by how far along the curve they are, increasing.
    pub fn after(feet: &'a [f64]) -> Self {
        Self {
            feet,
            forward: true,
        }
    }

    /// Those before it.
    pub fn before(feet: &'a [f64]) -> Self {
        Self {
            feet,
            forward: false,
        }
    }

    /// Length and number of the spacings of a block, the nearest block first.
    fn block(&self, number: usize) -> Count {
        let Some(last) = self.feet.len().checked_sub(1) else {
            return Count::default();
        };
        let (from, to) = (number * BLOCK, ((number + 1) * BLOCK).min(last));
        if from >= to {
            return Count::default();
        }
        let (low, high) = if self.forward {
            (from, to)
        } else {
            (last - to, last - from)
        };
        Count {
            ground: self.feet[high] - self.feet[low],
            points: (to - from) as f64,
        }
    }
}

/// Mean spacing of the points on all sides of a stretch, and how many spacings it is taken from: as many as a density on a
/// surface is, of the nearest ones, and none that are denser by more than chance.
pub(super) fn spacing(sides: &[Side<'_>]) -> Option<(f64, f64)> {
    let mut all = Count::default();
    for number in 0.. {
        let mut ring = Count::default();
        for side in sides {
            let block = side.block(number);
            ring.ground += block.ground;
            ring.points += block.points;
        }
        if ring.points == 0.0 || !all.take(ring, LEAST, COUNTED) {
            break;
        }
    }
    (all.ground > 0.0).then(|| (all.ground / all.points, all.points))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spacing_is_that_of_the_nearest_points_on_all_sides() {
        let even: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
        let one = spacing(&[Side::after(&even)]).unwrap();
        assert!((one.0 - 0.1).abs() < 1e-12 && one.1 == COUNTED, "{one:?}");
        let (before, after) = even.split_at(10);
        let both = spacing(&[Side::before(before), Side::after(after)]).unwrap();
        assert!(
            (both.0 - 0.1).abs() < 1e-12 && both.1 > 64.0 && both.1 < 80.0,
            "{both:?}"
        );
        assert!(spacing(&[Side::after(&even[..1]), Side::before(&[])]).is_none());
    }

    #[test]
    fn what_is_denser_farther_on_is_left_out() {
        let thin = (0..33).map(f64::from);
        let dense = (1..200).map(|k| 32.0 + 0.1 * f64::from(k));
        let feet: Vec<f64> = thin.chain(dense).collect();
        assert_eq!(spacing(&[Side::after(&feet)]), Some((1.0, 32.0)));
        let back: Vec<f64> = feet.iter().rev().map(|x| -x).collect();
        assert_eq!(spacing(&[Side::before(&back)]), Some((1.0, 32.0)));
    }
}
