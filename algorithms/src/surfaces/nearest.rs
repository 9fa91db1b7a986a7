//! Distance to a parametrized patch without a closed form.

use super::{Jet, first_fundamental_form};
use crosscap_core::{PointCloud, squared_distance};

/// Grid cells along each parameter. The patches of this module bend by less than a quarter turn
/// within two cells, so every nearest place has a grid minimum in its basin.
const CELLS: usize = 80;

/// A patch as the search sees it.
pub(super) struct Patch<'p> {
    /// Number of coordinates of a place.
    pub(super) dimension: usize,
    /// The rectangle of parameters.
    pub(super) domain: [[f64; 2]; 2],
    /// For each parameter whether the patch ends at the ends of its range.
    pub(super) ends: [bool; 2],
    /// Writes the place at the given parameters.
    pub(super) map: &'p dyn Fn([Jet; 2], &mut [Jet]),
}

/// Distance of every point to a patch: from each local minimum of the distance over a grid of
/// parameters, Levenberg-Marquardt steps held inside the domain where the patch ends.
/// O(cells^2) a point.
pub(super) fn nearest_distances(patch: &Patch<'_>, cloud: &PointCloud<f64>) -> Vec<f64> {
    let (n, domain) = (patch.dimension, patch.domain);
    let side = CELLS + 1;
    let parameter = |axis: usize, k: usize| {
        let [low, high] = domain[axis];
        low + (high - low) * k as f64 / CELLS as f64
    };
    let mut place = vec![Jet::default(); n];
    let mut grid = Vec::with_capacity(side * side * n);
    for i in 0..side {
        for j in 0..side {
            let at = [parameter(0, i), parameter(1, j)];
            (patch.map)(at.map(Jet::constant), &mut place);
            grid.extend(place.iter().map(|x| x.value));
        }
    }
    let mut squares = vec![0.0; side * side];
    cloud
        .iter()
        .map(|p| {
            for (square, g) in squares.iter_mut().zip(grid.chunks_exact(n)) {
                *square = squared_distance(p, g);
            }
            let mut best = f64::INFINITY;
            for i in 0..side {
                for j in 0..side {
                    let here = squares[i * side + j];
                    let lowest = (i.saturating_sub(1)..=(i + 1).min(CELLS)).all(|a| {
                        (j.saturating_sub(1)..=(j + 1).min(CELLS))
                            .all(|b| squares[a * side + b] >= here)
                    });
                    if lowest {
                        let start = [parameter(0, i), parameter(1, j)];
                        best = best.min(descend(patch, p, start, here, &mut place));
                    }
                }
            }
            best.sqrt()
        })
        .collect()
}

/// Which parameters are at an end of the patch and pushed out of it. A step out of the domain is no descent: they stay where they are.
fn blocked(patch: &Patch<'_>, at: [f64; 2], push: [f64; 2]) -> [bool; 2] {
    std::array::from_fn(|k| {
        let [low, high] = patch.domain[k];
        patch.ends[k] && ((at[k] <= low && push[k] < 0.0) || (at[k] >= high && push[k] > 0.0))
    })
}

/// Parameters moved into the domain where the patch ends.
fn held(patch: &Patch<'_>, mut at: [f64; 2]) -> [f64; 2] {
    for (k, x) in at.iter_mut().enumerate() {
        if patch.ends[k] {
            *x = x.clamp(patch.domain[k][0], patch.domain[k][1]);
        }
    }
    at
}

/// Squared distance at the local minimum that `start` leads to.
fn descend(
    patch: &Patch<'_>,
    target: &[f64],
    start: [f64; 2],
    square: f64,
    place: &mut [Jet],
) -> f64 {
    let (mut at, mut best, mut damping) = (start, square, 1e-4);
    for _ in 0..60 {
        (patch.map)([Jet::first(at[0]), Jet::second(at[1])], place);
        let [e, f, g] = first_fundamental_form(place);
        let [mut p, mut q] = place.iter().zip(target).fold([0.0; 2], |[p, q], (x, t)| {
            let r = t - x.value;
            [p + x.by_first * r, q + x.by_second * r]
        });
        let mut cross = f;
        let blocked = blocked(patch, at, [p, q]);
        if blocked[0] {
            (p, cross) = (0.0, 0.0);
        }
        if blocked[1] {
            (q, cross) = (0.0, 0.0);
        }
        // Floors keep the system regular where a parameter has no effect (poles, curves).
        let floor = 1e-12 * (e + g) + f64::MIN_POSITIVE;
        let (a, b) = (e * (1.0 + damping) + floor, g * (1.0 + damping) + floor);
        let determinant = a * b - cross * cross;
        let next = held(
            patch,
            [
                at[0] + (b * p - cross * q) / determinant,
                at[1] + (a * q - cross * p) / determinant,
            ],
        );
        (patch.map)(next.map(Jet::constant), place);
        let new: f64 = place
            .iter()
            .zip(target)
            .map(|(x, t)| (x.value - t).powi(2))
            .sum();
        if new < best {
            let gain = best - new;
            (at, best, damping) = (next, new, damping * 0.2);
            if gain <= 1e-15 * best || best < 1e-28 {
                break;
            }
        } else {
            damping *= 8.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    best
}
