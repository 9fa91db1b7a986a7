//! The dimension test, with as much of the spectrum as it takes.
//!
//! Covariances come from sums over a tree, and what a tree sums first changes their last digits. So an answer is given
//! only where it would be the same with a tolerance that is a little smaller or larger; within this band around it whoever asks
//! sums the points of the ball in the order of their rows. Then the answer is a matter of the ball alone: the same in the cloud, and in any part of it
//! that holds the ball.

use crate::spectrum::VarianceTolerance;
use nalgebra::SMatrix;

/// Directions that a ball is looked at in.
pub(super) const LEADING: usize = 6;

/// Half of the width of the band, a share of the variance: ten times what a tree may be wrong by.
pub(super) const BAND: f64 = 1e-9;

/// The answer at a tolerance where it is the same at both ends of the band about it.
pub(super) fn sure(dt: f64, answer: impl Fn(f64) -> u32) -> Option<u32> {
    let least = answer(dt + BAND);
    (answer(dt - BAND) == least).then_some(least)
}

/// Smallest d whose tail share is below `dt`, for a symmetric matrix of order `n` up to 3, given
/// as packed upper triangle.
///
/// No eigenvalue is computed: the tail behind the first is below the share when the largest
/// eigenvalue exceeds (1 - dt) of the trace, the last is the tail behind the second, and both are
/// questions about the signs of pivots (Sylvester's law of inertia).
pub(super) fn small(c: &[f64], n: usize, dt: f64) -> u32 {
    match n {
        1 => 1,
        2 => {
            let most = (1.0 - dt) * (c[0] + c[2]);
            if semidefinite([most - c[0], -c[1], 0.0, most - c[2], 0.0, 0.0]) {
                2
            } else {
                1
            }
        }
        _ => {
            let trace = c[0] + c[3] + c[5];
            let (least, most) = (dt * trace, (1.0 - dt) * trace);
            if !semidefinite([most - c[0], -c[1], -c[2], most - c[3], -c[4], most - c[5]]) {
                1
            } else if !semidefinite([c[0] - least, c[1], c[2], c[3] - least, c[4], c[5] - least]) {
                2
            } else {
                3
            }
        }
    }
}

/// Whether no eigenvalue of a symmetric matrix of order 3 is negative.
fn semidefinite([a, b, c, d, e, f]: [f64; 6]) -> bool {
    if a <= 0.0 {
        // The first entry is a Rayleigh quotient.
        return a == 0.0 && b == 0.0 && c == 0.0 && (d >= 0.0 && f >= 0.0 && d * f >= e * e);
    }
    let second = a * d - b * b;
    if second <= 0.0 {
        return second == 0.0 && a * e == b * c && a * f >= c * c;
    }
    // a * determinant.
    let (x, y) = (a * e - b * c, a * f - c * c);
    second * y - x * x >= 0.0
}

/// The same from a compression: `c` is the covariance in `m` orthonormal directions, packed, and
/// `rest` bounds the variance in all others from above and is 0 when there is none.
///
/// The sum of the d largest eigenvalues is at least that of the compression and exceeds it by no
/// more than `rest` (Ky Fan; the whole is positive semidefinite). So every tail share lies in a
/// bracket, and `None` is returned where the band about `dt` touches it.
pub(super) fn compressed(c: &[f64], m: usize, rest: f64, dt: f64) -> Option<u32> {
    let mut full = [[0.0; LEADING]; LEADING];
    let pairs = (0..m).flat_map(|i| (i..m).map(move |j| (i, j)));
    for ((i, j), x) in pairs.zip(c) {
        full[i][j] = *x;
        full[j][i] = *x;
    }
    let inner: f64 = (0..m).map(|i| full[i][i]).sum();
    let total = inner + rest;
    // The first two directions alone, which nearly always lie well, often say enough.
    if m >= 2 {
        let (a, b, d) = (full[0][0], full[0][1], full[1][1]);
        let outside = (inner - a - d).max(0.0) + rest;
        let half = 0.5 * (a + d);
        let second = half - (0.25 * (a - d) * (a - d) + b * b).sqrt();
        if outside < (dt - BAND) * total && second >= (dt + BAND) * total {
            return Some(2);
        }
    }
    let mut values = SMatrix::<f64, LEADING, LEADING>::from_fn(|i, j| full[i][j] / total)
        .symmetric_eigenvalues();
    values.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
    let mut tail = inner / total;
    for d in 0..m {
        tail -= values[d];
        let low = tail.max(0.0);
        if low + rest / total < dt - BAND {
            return Some(d as u32 + 1);
        }
        if low < dt + BAND {
            return None;
        }
    }
    None
}

/// The dimension test on a spectrum, largest variance first.
pub(super) fn dimension_of(variances: &[f64], dt: f64) -> u32 {
    VarianceTolerance::new(dt).map_or(0, |test| test.dimension_of(variances).0 as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::VarianceTolerance;
    use nalgebra::{DMatrix, SymmetricEigen};
    use proptest::prelude::*;

    fn naive(full: &DMatrix<f64>, dt: f64) -> (u32, bool) {
        let mut values: Vec<f64> = SymmetricEigen::new(full.clone())
            .eigenvalues
            .iter()
            .copied()
            .collect();
        values.sort_by(|a, b| b.total_cmp(a));
        let total: f64 = values.iter().sum();
        let mut tail = total;
        let near = values.iter().any(|v| {
            tail -= v;
            (tail / total - dt).abs() < 2.0 * BAND
        });
        let found = VarianceTolerance::new(dt).unwrap().dimension_of(&values);
        (found.0 as u32, near)
    }

    /// A covariance whose spectrum falls by `ratio`.
    fn covariance(n: usize, ratio: f64, entries: &[f64]) -> DMatrix<f64> {
        let rows = DMatrix::from_fn(2 * n, n, |i, j| entries[i * n + j] * ratio.powi(j as i32));
        rows.tr_mul(&rows)
    }

    proptest! {
        #[test]
        fn pivots_agree_with_eigenvalues(
            n in 1_usize..=3, ratio in 0.05_f64..1.0, dt in 0.001_f64..0.9,
            entries in prop::collection::vec(-1.0_f64..1.0, 18),
        ) {
            let full = covariance(n, ratio, &entries);
            let (expected, near) = naive(&full, dt);
            let packed: Vec<f64> = (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).map(|at| full[at]).collect();
            prop_assert!(near || small(&packed, n, dt) == expected);
            prop_assert!(near || sure(dt, |dt| small(&packed, n, dt)) == Some(expected));
            prop_assert!(near || compressed(&packed, n, 0.0, dt) == Some(expected));
        }

        #[test]
        fn a_compression_never_lies(
            n in 7_usize..=10, ratio in 0.2_f64..1.0, dt in 0.001_f64..0.6,
            entries in prop::collection::vec(-1.0_f64..1.0, 200),
        ) {
            let full = covariance(n, ratio, &entries);
            let packed: Vec<f64> = (0..LEADING).flat_map(|i| (i..LEADING).map(move |j| (i, j))).map(|at| full[at]).collect();
            let rest: f64 = (LEADING..n).map(|i| full[(i, i)]).sum();
            if let Some(found) = compressed(&packed, LEADING, rest, dt) {
                let (expected, near) = naive(&full, dt);
                prop_assert!(near || found == expected);
            }
        }
    }
}
