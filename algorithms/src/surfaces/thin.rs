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
    let mut kept = Kept::new(cloud, spacing, order.len());
    for &row in order {
        if !kept.has_closer(row) {
            kept.add(row);
        }
    }
    Ok(kept.rows.into_iter().map(|(row, _)| row).collect())
}

/// No row.
const NONE: usize = usize::MAX;

/// Kept points, found again by the cell of their shadow in a hashed grid.
struct Kept<'a> {
    cloud: &'a PointCloud<f64>,
    spacing: f64,
    /// Side of a cell.
    reach: f64,
    shadow: Vec<[f64; 3]>,
    /// Steps to the cells in which a closer point can be.
    steps: Vec<[f64; 3]>,
    /// Hashes are shifted right by this.
    shift: u32,
    /// Per slot the last one of `rows` in it.
    head: Vec<usize>,
    /// Per kept point: its row and the one kept before it in the same slot.
    rows: Vec<(usize, usize)>,
}

impl<'a> Kept<'a> {
    fn new(cloud: &'a PointCloud<f64>, spacing: f64, most: usize) -> Self {
        let slots = (2 * most).next_power_of_two().max(2);
        let axes = cloud.dimension().min(3);
        let steps = (0..27)
            .map(|k| [k % 3, k / 3 % 3, k / 9].map(|o| f64::from(o) - 1.0))
            .filter(|o| o[axes..].iter().all(|&x| x == 0.0))
            .collect();
        Self {
            cloud,
            spacing,
            // Rounding of the projection must not push a close point two cells away.
            reach: spacing * (1.0 + 1e-9),
            shadow: shadow(cloud),
            steps,
            shift: 64 - slots.trailing_zeros(),
            head: vec![NONE; slots],
            rows: Vec::new(),
        }
    }

    fn cell(&self, row: usize) -> [f64; 3] {
        self.shadow[row].map(|x| (x / self.reach).floor())
    }

    fn slot(&self, cell: [f64; 3]) -> usize {
        let mut hash = 0u64;
        for x in cell {
            // Saturates for coordinates beyond 2^63 cells; such points then share cells, which costs time only.
            hash = (hash ^ (x as i64 as u64)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 29;
        }
        (hash.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> self.shift) as usize
    }

    /// Whether a kept point is closer to a row than the spacing.
    fn has_closer(&self, row: usize) -> bool {
        let home = self.cell(row);
        let here = self.shadow[row];
        let limit = self.spacing * self.spacing;
        let limit_in_shadow = self.reach * self.reach;
        self.steps.iter().any(|o| {
            let slot = self.slot([home[0] + o[0], home[1] + o[1], home[2] + o[2]]);
            let mut at = self.head[slot];
            while at != NONE {
                let (other, next) = self.rows[at];
                let there = self.shadow[other];
                let d: f64 = (0..3).map(|k| (here[k] - there[k]).powi(2)).sum();
                if d < limit_in_shadow && self.cloud.squared_distance(row, other) < limit {
                    return true;
                }
                at = next;
            }
            false
        })
    }

    fn add(&mut self, row: usize) {
        let slot = self.slot(self.cell(row));
        self.rows.push((row, self.head[slot]));
        self.head[slot] = self.rows.len() - 1;
    }
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
