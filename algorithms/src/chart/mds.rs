//! Classical multidimensional scaling.

use crate::orthogonal::unit_across;
use crosscap_core::{Chart, Error, LocalChart};
use nalgebra::{DMatrix, SymmetricEigen};

/// Classical scaling: the leading eigenvectors of the doubly centred matrix of squared
/// distances, -1/2 H D^2 H (Martin & Watson 2011, section 2.6; Torgerson 1952).
#[derive(Clone, Copy, Debug, Default)]
pub struct ClassicalScaling;

impl LocalChart for ClassicalScaling {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        if distances.len() != count * count {
            return Err(Error::Shape {
                found: format!("{} distances", distances.len()),
                expected: format!("{count} x {count}"),
            });
        }
        if let Some(at) = distances.iter().position(|d| !d.is_finite()) {
            return Err(Error::NotFinite {
                row: at / count,
                column: at % count,
            });
        }
        if count == 0 {
            return Ok(Chart {
                dimension,
                coordinates: Vec::new(),
                distortion: 0.0,
            });
        }
        let mut gram = DMatrix::<f64>::from_fn(count, count, |i, j| {
            let d = distances[i * count + j];
            d * d
        });
        let means: Vec<f64> = (0..count).map(|i| gram.row(i).mean()).collect();
        let mean = means.iter().sum::<f64>() / count as f64;
        for i in 0..count {
            for j in 0..count {
                gram[(i, j)] = -0.5 * (gram[(i, j)] - means[i] - means[j] + mean);
            }
        }
        let total: f64 = gram.trace();
        let leading = match leading(&gram, dimension) {
            Some(pairs) => pairs,
            None => all(gram, dimension),
        };
        let mut coordinates = vec![0.0; count * dimension];
        let mut carried = 0.0;
        for (k, (value, vector)) in leading.iter().enumerate() {
            let value = value.max(0.0);
            carried += value;
            for (i, x) in vector.iter().enumerate() {
                coordinates[i * dimension + k] = x * value.sqrt();
            }
        }
        Ok(Chart {
            dimension,
            coordinates,
            distortion: if total > 0.0 {
                (1.0 - carried / total).clamp(0.0, 1.0)
            } else {
                0.0
            },
        })
    }

    fn name(&self) -> &str {
        "mds"
    }
}

/// Eigenvalues with unit vectors, largest first.
type Pairs = Vec<(f64, Vec<f64>)>;

/// Vectors beside the wanted ones that a search carries along: it converges like the ratio of
/// the first eigenvalue left out to the last one wanted.
const SPARE: usize = 2;
/// From this size on a search takes less time than all eigenvalues.
const SMALLEST_SEARCH: usize = 12;
/// Most rounds of a search; neighborhoods of a surface need about ten.
const ROUNDS: usize = 60;
/// First round after which convergence is asked for.
const FIRST_LOOK: usize = 5;
/// Error of an eigenvector at which the search ends, as a share of the largest eigenvalue: little more than
/// rounding leaves.
const CONVERGED: f64 = 1e-14;

/// The `wanted` largest eigenvalues by definition, fewer where there are fewer.
fn all(gram: DMatrix<f64>, wanted: usize) -> Pairs {
    let eigen = SymmetricEigen::new(gram);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    order
        .iter()
        .take(wanted)
        .map(|&k| {
            let vector = eigen.eigenvectors.column(k).iter().copied().collect();
            (eigen.eigenvalues[k], vector)
        })
        .collect()
}

/// The same by subspace iteration with Rayleigh-Ritz steps; `None` where that is not faster, does
/// not converge, or where eigenvalues that large are negative, as they are far from Euclidean distances.
fn leading(gram: &DMatrix<f64>, wanted: usize) -> Option<Pairs> {
    let count = gram.nrows();
    let mut block = wanted + SPARE;
    let mut exhausted = false;
    if count < SMALLEST_SEARCH.max(2 * block) {
        return None;
    }
    // A fixed start that leans on no direction (Knuth's linear congruential generator).
    let mut state = 1_u64;
    let mut basis = DMatrix::from_fn(count, block, |_, _| {
        state =
            (state.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    });
    let mut image = DMatrix::zeros(count, block);
    for round in 1..=ROUNDS {
        // Distances in R^3 have no more than three directions to offer: then these are all there is, and
        // nothing is left to converge to.
        let independent = orthonormalize(&mut basis);
        if independent < block {
            exhausted = true;
            block = independent;
            if block < wanted {
                return None;
            }
            basis.resize_horizontally_mut(block, 0.0);
            image.resize_horizontally_mut(block, 0.0);
        }
        gram.mul_to(&basis, &mut image);
        // Charts of a surface have converged after a few rounds, and asking is not cheap.
        if !exhausted && (round < FIRST_LOOK || round % 2 == 0) {
            std::mem::swap(&mut basis, &mut image);
            continue;
        }
        let eigen = SymmetricEigen::new(basis.tr_mul(&image));
        let mut order: Vec<usize> = (0..block).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let turned = DMatrix::from_fn(block, block, |i, k| eigen.eigenvectors[(i, order[k])]);
        basis = &basis * &turned;
        image = &image * &turned;
        let value = |k: usize| eigen.eigenvalues[order[k]];
        let scale = value(0).abs().max(value(block - 1).abs());
        let error = |k: usize| (image.column(k) - basis.column(k) * value(k)).norm();
        if (0..wanted).all(|k| error(k) <= CONVERGED * scale) {
            // Those left out are no larger than the smallest carried along, or have not shown yet.
            let sound = value(wanted - 1) > 0.0 && value(block - 1) > -value(wanted - 1);
            return sound.then(|| {
                (0..wanted)
                    .map(|k| (value(k), basis.column(k).iter().copied().collect()))
                    .collect()
            });
        }
        std::mem::swap(&mut basis, &mut image);
    }
    None
}

/// Gram-Schmidt, twice; returns how many columns there are before the first that depends on those
/// before it within rounding.
fn orthonormalize(basis: &mut DMatrix<f64>) -> usize {
    let (rows, columns) = basis.shape();
    let data = basis.as_mut_slice();
    let dependent = (0..columns).find(|&k| !unit_across(data, rows, k, 2, 1e-24));
    dependent.unwrap_or(columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_search_finds_what_all_eigenvalues_say(
            count in 12_usize..40,
            bend in 0.0_f64..0.4,
            noise in prop_oneof![Just(0.0), 0.0_f64..0.3],
            entries in prop::collection::vec(-1.0_f64..1.0, 160),
        ) {
            // Points of a bent sheet, their distances disturbed.
            let place = |i: usize| {
                let (a, b) = (entries[4 * i], entries[4 * i + 1]);
                [a, b, bend * (a * a - a * b)]
            };
            let mut distances = vec![0.0; count * count];
            for i in 0..count {
                for j in 0..i {
                    let (p, q) = (place(i), place(j));
                    let d = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
                    let d = d * (1.0 + noise * entries[4 * j + 2] * entries[4 * i + 3]);
                    distances[i * count + j] = d;
                    distances[j * count + i] = d;
                }
            }
            let mut gram = DMatrix::from_fn(count, count, |i, j| distances[i * count + j].powi(2));
            let means: Vec<f64> = (0..count).map(|i| gram.row(i).mean()).collect();
            let mean = means.iter().sum::<f64>() / count as f64;
            for i in 0..count {
                for j in 0..count {
                    gram[(i, j)] = -0.5 * (gram[(i, j)] - means[i] - means[j] + mean);
                }
            }
            let expected = all(gram.clone(), 2);
            if let Some(found) = leading(&gram, 2) {
                let scale = expected[0].0;
                for k in 0..2 {
                    prop_assert!((found[k].0 - expected[k].0).abs() <= 1e-10 * scale);
                }
                // What the chart depends on: the product of the two leading parts.
                let part = |pairs: &Pairs, i: usize, j: usize| -> f64 {
                    pairs.iter().map(|(value, v)| value * v[i] * v[j]).sum()
                };
                // Where the third is as large as the second, either is as good.
                let third = all(gram, 3)[2].0;
                if expected[1].0 > 1.01 * third {
                    for i in 0..count {
                        for j in 0..count {
                            prop_assert!((part(&found, i, j) - part(&expected, i, j)).abs() <= 1e-8 * scale);
                        }
                    }
                }
            } else {
                prop_assert!(noise > 0.0 || bend > 0.0 || expected[1].0 < 1e-3 * expected[0].0);
            }
        }
    }
}
