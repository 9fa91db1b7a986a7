//! The dimension of one ball in many coordinates, from as few directions as prove it.
//!
//! A covariance of order N takes O(k N^2) to sum and O(N^3) to solve. A few directions that the points themselves
//! spread in are found by subspace iteration on the k centered points in O(k N) a round; what they leave is the trace
//! less theirs, and the brackets of [`compressed`] turn that into a proof or into no answer.

use super::decide::{LEADING, compressed};
use crate::orthogonal::unit_across;
use crosscap_core::{PointCloud, Scalar};

/// Rounds of subspace iteration after which a proof is looked for. Where the spectrum falls off behind the surface's
/// two directions the first is enough; noise that nearly fills the tolerance takes more.
const LOOKS: [usize; 3] = [2, 3, 5];
/// Share of a direction that must be left across the others for it to be one.
const INDEPENDENT: f64 = 1e-20;

/// The dimension of the points `rows` by their tail shares of variance, where `LEADING` directions prove it.
///
/// O(k N) for k points.
pub(super) fn dimension<S: Scalar>(cloud: &PointCloud<S>, rows: &[usize], dt: f64) -> Option<u32> {
    let n = cloud.dimension();
    if rows.len() <= LEADING || n <= LEADING {
        return None;
    }
    let points = centered(cloud, rows);
    let total: f64 = points.iter().map(|x| x * x).sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mut basis = start(&points, n)?;
    let mut along = vec![0.0; rows.len() * LEADING];
    for rounds in LOOKS {
        for _ in 0..rounds {
            project(&points, &basis, n, &mut along);
            gather(&points, &along, n, &mut basis);
            for k in 0..LEADING {
                if !unit_across(&mut basis, n, k, 2, INDEPENDENT) {
                    return None;
                }
            }
        }
        project(&points, &basis, n, &mut along);
        let mut products = [0.0; LEADING * (LEADING + 1) / 2];
        for row in along.chunks_exact(LEADING) {
            let mut at = 0;
            for i in 0..LEADING {
                for j in i..LEADING {
                    products[at] += row[i] * row[j];
                    at += 1;
                }
            }
        }
        let inner: f64 = along.iter().map(|x| x * x).sum();
        // Rounding of the sums must not make the rest too small.
        let rest = (total - inner).max(0.0) + 1e-12 * total;
        if let Some(found) = compressed(&products, LEADING, rest, dt) {
            return Some(found);
        }
    }
    None
}

/// The points less their mean, in row order.
fn centered<S: Scalar>(cloud: &PointCloud<S>, rows: &[usize]) -> Vec<f64> {
    let n = cloud.dimension();
    let mut mean = vec![0.0; n];
    for &row in rows {
        for (m, x) in mean.iter_mut().zip(cloud.point(row)) {
            *m += x.as_f64();
        }
    }
    let share = 1.0 / rows.len() as f64;
    mean.iter_mut().for_each(|m| *m *= share);
    let mut points = Vec::with_capacity(rows.len() * n);
    for &row in rows {
        points.extend((cloud.point(row).iter().zip(&mean)).map(|(x, m)| x.as_f64() - m));
    }
    points
}

/// Directions to start from: points that are evenly apart in the list.
fn start(points: &[f64], n: usize) -> Option<Vec<f64>> {
    let count = points.len() / n;
    let mut basis = Vec::with_capacity(LEADING * n);
    for k in 0..LEADING {
        let row = k * count / LEADING;
        basis.extend_from_slice(&points[row * n..(row + 1) * n]);
    }
    (0..LEADING)
        .all(|k| unit_across(&mut basis, n, k, 2, INDEPENDENT))
        .then_some(basis)
}

/// Coordinates of the points along the directions.
fn project(points: &[f64], basis: &[f64], n: usize, along: &mut [f64]) {
    for (point, out) in points.chunks_exact(n).zip(along.chunks_exact_mut(LEADING)) {
        for (direction, o) in basis.chunks_exact(n).zip(out) {
            *o = dot(point, direction);
        }
    }
}

/// Directions as sums of the points, weighted with their coordinates along them.
fn gather(points: &[f64], along: &[f64], n: usize, basis: &mut [f64]) {
    basis.fill(0.0);
    for (point, weights) in points.chunks_exact(n).zip(along.chunks_exact(LEADING)) {
        for (direction, w) in basis.chunks_exact_mut(n).zip(weights) {
            for (d, x) in direction.iter_mut().zip(point) {
                *d += w * x;
            }
        }
    }
}

/// Inner product, in four chains of additions.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (mut p, mut q) = (a.chunks_exact(4), b.chunks_exact(4));
    for (x, y) in (&mut p).zip(&mut q) {
        for k in 0..4 {
            lanes[k] += x[k] * y[k];
        }
    }
    let rest: f64 = (p.remainder().iter().zip(q.remainder()))
        .map(|(x, y)| x * y)
        .sum();
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::principal::PrincipalFrame;
    use crate::surfaces::Random;
    use proptest::prelude::*;

    /// Points of R^n that spread in `flat` directions, and by `noise` in all.
    fn cloud(n: usize, flat: usize, noise: f64, seed: u64) -> PointCloud<f64> {
        let mut random = Random::new(seed);
        let mut rows = Vec::new();
        for _ in 0..2 * n {
            for k in 0..n {
                let spread = if k < flat { 1.0 } else { noise };
                rows.push(spread * random.normal());
            }
        }
        PointCloud::new(n, rows).unwrap()
    }

    proptest! {
        #[test]
        fn an_answer_is_that_of_the_full_spectrum(
            n in 66_usize..110, flat in 1_usize..4, noise in 0.0_f64..0.2, dt in 0.01_f64..0.3, seed in any::<u64>(),
        ) {
            let cloud = cloud(n, flat, noise, seed);
            let rows: Vec<usize> = (0..cloud.len()).collect();
            let frame = PrincipalFrame::of(&cloud, rows.iter().copied());
            let total: f64 = frame.variances.iter().sum();
            let mut tail = total;
            let near = frame.variances.iter().any(|v| {
                tail -= v;
                (tail / total - dt).abs() < 1e-9
            });
            if let Some(found) = dimension(&cloud, &rows, dt) {
                prop_assert!(near || found as usize == frame.dimension(dt));
            }
        }
    }

    #[test]
    fn a_noisy_plane_is_proved_to_be_one() {
        let cloud = cloud(100, 2, 0.02, 3);
        let rows: Vec<usize> = (0..cloud.len()).collect();
        assert_eq!(dimension(&cloud, &rows, 0.05), Some(2));
    }
}
