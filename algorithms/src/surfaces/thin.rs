//! Thinning of a cloud to a minimal spacing.

use super::Random;
use crosscap_core::{Error, PointCloud};
use nalgebra::DMatrix;

/// Greedy thinning in row order: a point is kept when no point kept before it is closer than
/// `spacing` (in the unit of the data; a distance equal to `spacing` is allowed).
///
/// The result is a maximal separated subset: kept points are at least `spacing` apart, and every
/// dropped one is closer than `spacing` to a kept one. Returns the kept rows in increasing order.
///
/// Candidates come from a hashed grid in the (up to three) leading principal coordinates: a
/// projection never lengthens a distance, so none is missed. O(n m) for clouds that lie on surfaces, m
/// the number of kept points whose projections are within reach.
///
/// # Errors
/// [`Error::Parameter`] when `spacing` is not a positive finite number.
///
/// ```
/// use crosscap_algorithms::surfaces::thin;
/// use crosscap_core::PointCloud;
/// let line = PointCloud::new(1, vec![0.0, 0.4, 1.0, 1.9]).unwrap();
/// assert_eq!(thin(&line, 1.0).unwrap(), [0, 2]);
/// ```
pub fn thin(cloud: &PointCloud<f64>, spacing: f64) -> Result<Vec<usize>, Error> {
    let order: Vec<usize> = (0..cloud.len()).collect();
    thin_in_order(cloud, spacing, &order)
}

/// As [`thin`], visiting the points in an order drawn from `seed`.
///
/// # Errors
/// As [`thin`].
pub fn thin_randomly(
    cloud: &PointCloud<f64>,
    spacing: f64,
    seed: u64,
) -> Result<Vec<usize>, Error> {
    let order = Random::new(seed).permutation(cloud.len());
    let mut kept = thin_in_order(cloud, spacing, &order)?;
    kept.sort_unstable();
    Ok(kept)
}

fn thin_in_order(
    cloud: &PointCloud<f64>,
    spacing: f64,
    order: &[usize],
) -> Result<Vec<usize>, Error> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(Error::Parameter {
            name: "spacing",
            value: spacing.to_string(),
            expected: "a positive finite number, in the unit of the data".into(),
        });
    }
    let shadow = shadow(cloud);
    // Rounding of the projection must not push a close point two cells away.
    let reach = spacing * (1.0 + 1e-9);
    let cell = |row: usize| shadow[row].map(|x| (x / reach).floor());
    let slots = (2 * order.len()).next_power_of_two().max(2);
    let shift = 64 - slots.trailing_zeros();
    let slot = |c: [f64; 3]| {
        let mut hash = 0u64;
        for x in c {
            // Saturates for coordinates beyond 2^63 cells; such points then share cells, which costs time only.
            hash = (hash ^ (x as i64 as u64)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 29;
        }
        (hash.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> shift) as usize
    };
    const NONE: usize = usize::MAX;
    let mut head = vec![NONE; slots];
    // Per kept point: its row and the one kept before it in the same slot.
    let mut kept: Vec<(usize, usize)> = Vec::new();
    let axes = cloud.dimension().min(3);
    let offsets: Vec<[f64; 3]> = (0..27)
        .map(|k| [k % 3, k / 3 % 3, k / 9].map(|o| f64::from(o) - 1.0))
        .filter(|o| o[axes..].iter().all(|&x| x == 0.0))
        .collect();
    let limit = spacing * spacing;
    let limit_in_shadow = reach * reach;
    for &row in order {
        let home = cell(row);
        let here = shadow[row];
        let close = offsets.iter().any(|o| {
            let mut at = head[slot([home[0] + o[0], home[1] + o[1], home[2] + o[2]])];
            while at != NONE {
                let (other, next) = kept[at];
                let there = shadow[other];
                let d: f64 = (0..3).map(|k| (here[k] - there[k]).powi(2)).sum();
                if d < limit_in_shadow && cloud.squared_distance(row, other) < limit {
                    return true;
                }
                at = next;
            }
            false
        });
        if !close {
            let s = slot(home);
            kept.push((row, head[s]));
            head[s] = kept.len() - 1;
        }
    }
    Ok(kept.into_iter().map(|(row, _)| row).collect())
}

/// Leading three principal coordinates of every point, or the coordinates themselves in up to
/// three dimensions.
fn shadow(cloud: &PointCloud<f64>) -> Vec<[f64; 3]> {
    let n = cloud.dimension();
    if n <= 3 {
        return cloud
            .iter()
            .map(|p| std::array::from_fn(|k| p.get(k).copied().unwrap_or(0.0)))
            .collect();
    }
    let count = cloud.len().max(1) as f64;
    let mut mean = vec![0.0; n];
    for p in cloud.iter() {
        for (m, x) in mean.iter_mut().zip(p) {
            *m += x / count;
        }
    }
    // Any orthonormal axes are correct; a few thousand rows find good ones.
    let step = cloud.len().div_ceil(4096).max(1);
    let mut covariance = DMatrix::<f64>::zeros(n, n);
    for p in cloud.iter().step_by(step) {
        for i in 0..n {
            for j in 0..=i {
                covariance[(i, j)] += (p[i] - mean[i]) * (p[j] - mean[j]);
            }
        }
    }
    covariance.fill_upper_triangle_with_lower_triangle();
    let eigen = covariance.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    cloud
        .iter()
        .map(|p| {
            std::array::from_fn(|k| {
                let axis = eigen.eigenvectors.column(order[k]);
                p.iter()
                    .zip(&mean)
                    .zip(axis.iter())
                    .map(|((x, m), a)| (x - m) * a)
                    .sum()
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute(cloud: &PointCloud<f64>, spacing: f64) -> Vec<usize> {
        let mut kept: Vec<usize> = Vec::new();
        for i in 0..cloud.len() {
            if kept
                .iter()
                .all(|&k| cloud.squared_distance(i, k) >= spacing * spacing)
            {
                kept.push(i);
            }
        }
        kept
    }

    proptest! {
        #[test]
        fn equals_brute_force(
            dimension in 1usize..8,
            raw in prop::collection::vec(-3.0..3.0f64, 0..1200),
            spacing in 0.05..2.0f64,
            lattice in any::<bool>(),
        ) {
            let mut raw = raw;
            raw.truncate(raw.len() / dimension * dimension);
            if lattice {
                // Ties: distances that equal the spacing exactly.
                raw.iter_mut().for_each(|x| *x = (*x * 2.0).round() / 2.0);
            }
            let spacing = if lattice { 0.5 } else { spacing };
            let cloud = PointCloud::new(dimension, raw).unwrap();
            prop_assert_eq!(thin(&cloud, spacing).unwrap(), brute(&cloud, spacing));
        }

        #[test]
        fn random_order_is_separated_and_maximal(
            raw in prop::collection::vec(-1.0..1.0f64, 0..600), seed in any::<u64>(),
        ) {
            let mut raw = raw;
            raw.truncate(raw.len() / 3 * 3);
            let cloud = PointCloud::new(3, raw).unwrap();
            let kept = thin_randomly(&cloud, 0.4, seed).unwrap();
            for i in 0..cloud.len() {
                let nearest = kept.iter().filter(|&&k| k != i)
                    .map(|&k| cloud.squared_distance(i, k).sqrt()).fold(f64::INFINITY, f64::min);
                prop_assert_eq!(kept.binary_search(&i).is_ok(), nearest >= 0.4);
            }
        }
    }

    #[test]
    fn refuses_a_spacing_without_meaning() {
        let cloud = PointCloud::new(1, vec![0.0, 1.0]).unwrap();
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(thin(&cloud, spacing).unwrap_err().is_input());
        }
    }

    #[test]
    fn far_from_the_origin_and_beyond_integers() {
        let cloud = PointCloud::new(2, vec![1e300, 0.0, 1e300, 0.0, -1e300, 5.0]).unwrap();
        assert_eq!(thin(&cloud, 1e-3).unwrap(), [0, 2]);
    }
}
