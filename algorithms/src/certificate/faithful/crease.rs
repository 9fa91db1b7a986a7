//! Heights that a crease explains: two sheets that meet along a line, and not one over the other.

use super::patch::{TERMS, terms};
use crate::orthogonal::{dot, unit_across};

/// Directions that a crease is tried in, and places in each.
const DIRECTIONS: usize = 24;
const PLACES: usize = 15;
/// A crease is believed where it leaves less than this share of what a quadratic height leaves, root mean square. On the
/// edges of a cube sampled on its grid 0.17 to 0.41 were seen; on parallel plates, concentric spheres and lines beside a
/// plate, 500 places in all, never less than 0.73.
const LEAVES: f64 = 0.6;

/// Whether a crease explains what a quadratic height leaves of the heights over a plane: a term |w|, with w the
/// distance from a line in the plane, is fitted to `left` as well, for lines in all directions.
///
/// `left` is what least squares left, so that it is at right angles to the quadratic terms. O(m) for m points.
pub(super) fn explains(flat: &[[f64; 2]], left: &[f64]) -> bool {
    let scale = flat.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    let all: f64 = left.iter().map(|h| h * h).sum();
    if scale <= 0.0 || all <= 0.0 {
        return false;
    }
    let flat: Vec<[f64; 2]> = flat.iter().map(|p| p.map(|x| x / scale)).collect();
    let quadratic = quadratic(&flat);
    let mut most = 0.0_f64;
    let mut sorted = Vec::with_capacity(flat.len());
    for k in 0..DIRECTIONS {
        let (sin, cos) = (std::f64::consts::PI * k as f64 / DIRECTIONS as f64).sin_cos();
        let along: Vec<f64> = flat.iter().map(|p| p[0] * cos + p[1] * sin).collect();
        sorted.clone_from(&along);
        sorted.sort_unstable_by(f64::total_cmp);
        for place in 1..=PLACES {
            let line = sorted[place * (sorted.len() - 1) / (PLACES + 1)];
            let mut fold: Vec<f64> = along.iter().map(|w| (w - line).abs()).collect();
            let before = dot(&fold, &fold);
            (quadratic.chunks_exact(flat.len())).for_each(|term| take_off(&mut fold, term));
            let square = dot(&fold, &fold);
            if square > 1e-9 * before {
                most = most.max(dot(&fold, left).powi(2) / square);
            }
        }
    }
    all - most < LEAVES * LEAVES * all
}

/// The quadratic terms at the points, orthonormal, one after the other; fewer where they depend on each other.
fn quadratic(flat: &[[f64; 2]]) -> Vec<f64> {
    let count = flat.len();
    let mut found: Vec<f64> = Vec::with_capacity(TERMS * count);
    for i in 0..TERMS {
        let before = found.len();
        found.extend(flat.iter().map(|&place| terms(place)[i]));
        if !unit_across(&mut found, count, before / count, 1, 1e-12) {
            found.truncate(before);
        }
    }
    found
}

/// Takes off the part of `x` along a vector of length one.
fn take_off(x: &mut [f64], unit: &[f64]) {
    let along = dot(x, unit);
    x.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::Random;

    /// What a quadratic leaves of heights at 60 random points of a square.
    fn left(seed: u64, height: impl Fn(&mut Random, [f64; 2]) -> f64) -> (Vec<[f64; 2]>, Vec<f64>) {
        let mut random = Random::new(seed);
        let place = |_| [random.between(-4.0, 4.0), random.between(-4.0, 4.0)];
        let flat: Vec<[f64; 2]> = (0..60).map(place).collect();
        let mut left: Vec<f64> = flat.iter().map(|&p| height(&mut random, p)).collect();
        for term in quadratic(&flat).chunks_exact(flat.len()) {
            take_off(&mut left, term);
        }
        (flat, left)
    }

    #[test]
    fn a_roof_is_explained_in_any_direction_and_two_sheets_are_not() {
        for seed in 1..20 {
            let turn = 0.3 * seed as f64;
            let roof =
                |_: &mut Random, p: [f64; 2]| (p[0] * turn.cos() + p[1] * turn.sin() - 1.0).abs();
            let (flat, heights) = left(seed, roof);
            assert!(explains(&flat, &heights), "{seed}");
            let (flat, heights) = left(seed, |random, _| {
                f64::from(u8::from(random.uniform() < 0.4))
            });
            assert!(!explains(&flat, &heights), "{seed}");
            // A sheet over one half of another.
            let (flat, heights) = left(seed, |random, p| {
                f64::from(u8::from(p[0] > 0.0 && random.uniform() < 0.5))
            });
            assert!(!explains(&flat, &heights), "{seed}");
        }
    }

    #[test]
    fn nothing_is_explained_where_nothing_is_left() {
        let (flat, _) = left(1, |_, _| 0.0);
        assert!(!explains(&flat, &[0.0; 60]));
    }
}
