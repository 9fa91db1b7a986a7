//! Rigid motions, and the principal coordinates that undo them.

use crate::PointCloud;
use nalgebra::{DMatrix, SymmetricEigen};
use proptest::prelude::*;

/// Most coordinates that a motion is drawn for.
pub const MOST_DIMENSIONS: usize = 12;

/// A rigid motion of R^N for any N up to [`MOST_DIMENSIONS`]: rotations in the planes of
/// successive axes, perhaps a reflection, then a shift. Shrinks to no motion at all.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Angles in radians: of the rotation of axes `k` and `k + 1`, twice around.
    pub angles: Vec<f64>,
    /// Whether the first axis is turned round.
    pub reflected: bool,
    /// What is added in the end.
    pub shift: Vec<f64>,
}

impl Motion {
    /// Moves the rows of `dimension` coordinates each.
    pub fn apply(&self, dimension: usize, rows: &mut [f64]) {
        for row in rows.chunks_exact_mut(dimension) {
            if self.reflected {
                row[0] = -row[0];
            }
            if dimension > 1 {
                for (k, angle) in self.angles.iter().enumerate() {
                    let (a, b) = (k % dimension, (k + 1) % dimension);
                    let (sin, cos) = angle.sin_cos();
                    let (x, y) = (row[a], row[b]);
                    row[a] = cos * x - sin * y;
                    row[b] = sin * x + cos * y;
                }
            }
            for (x, s) in row.iter_mut().zip(&self.shift) {
                *x += s;
            }
        }
    }

    /// The cloud after an isometric embedding in a space of `dimension` coordinates (zeros are
    /// appended; never fewer than there are), the motion, and scaling by `factor` about the origin.
    pub fn image(&self, cloud: &PointCloud<f64>, dimension: usize, factor: f64) -> PointCloud<f64> {
        let dimension = dimension.max(cloud.dimension());
        let mut rows = vec![0.0; dimension * cloud.len()];
        for (row, point) in rows.chunks_exact_mut(dimension).zip(cloud.iter()) {
            row[..point.len()].copy_from_slice(point);
        }
        self.apply(dimension, &mut rows);
        rows.iter_mut().for_each(|x| *x *= factor);
        // Moderate numbers stay finite; should a caller's overflow, nothing is moved.
        PointCloud::new(dimension, rows).unwrap_or_else(|_| cloud.clone())
    }
}

/// Motions of all kinds.
pub fn motions() -> impl Strategy<Value = Motion> {
    let angle = -std::f64::consts::PI..std::f64::consts::PI;
    (
        prop::collection::vec(angle, 0..2 * MOST_DIMENSIONS),
        any::<bool>(),
        prop::collection::vec(-2.0..2.0_f64, MOST_DIMENSIONS),
    )
        .prop_map(|(angles, reflected, shift)| Motion {
            angles,
            reflected,
            shift,
        })
}

/// Rows in their principal coordinates: about the mean of the first `counted`, along their
/// principal directions, in order of falling variance. Signs are as they come.
pub(super) fn principal(dimension: usize, rows: &[f64], counted: usize) -> Vec<f64> {
    let counted_rows = rows.chunks_exact(dimension).take(counted);
    let scale = 1.0 / counted.max(1) as f64;
    let mut mean = vec![0.0; dimension];
    for row in counted_rows.clone() {
        mean.iter_mut().zip(row).for_each(|(m, x)| *m += x * scale);
    }
    let mut moments = DMatrix::<f64>::zeros(dimension, dimension);
    for row in counted_rows {
        for a in 0..dimension {
            for b in 0..dimension {
                moments[(a, b)] += (row[a] - mean[a]) * (row[b] - mean[b]) * scale;
            }
        }
    }
    let eigen = SymmetricEigen::new(moments);
    let mut order: Vec<usize> = (0..dimension).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let mut out = Vec::with_capacity(rows.len());
    for row in rows.chunks_exact(dimension) {
        for &axis in &order {
            let direction = eigen.eigenvectors.column(axis);
            let moved = row.iter().zip(&mean).map(|(x, m)| x - m);
            out.push(direction.iter().zip(moved).map(|(d, x)| d * x).sum());
        }
    }
    out
}
