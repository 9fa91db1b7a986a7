//! Coordinates in which points are searched.

use super::tree::MOST_AXES;
use crosscap_core::{PointCloud, Scalar};
use nalgebra::DMatrix;

/// Points that the axes are computed from: they need not be exact.
const AXES_SAMPLE: usize = 2048;
/// Rounds of subspace iteration for the axes.
const AXES_ROUNDS: usize = 10;

/// The coordinates of the tree: centered at the mean, scaled into the unit ball, and projected
/// when R^N has more than [`MOST_AXES`] dimensions.
pub(super) struct Frame {
    mean: Vec<f64>,
    /// A power of two, so scaling rounds nothing.
    pub(super) scale: f64,
    /// Orthonormal axes one after the other, N numbers each.
    pub(super) axes: Option<Vec<f64>>,
}

impl Frame {
    /// That of a cloud. O(n N).
    pub(super) fn of<S: Scalar>(cloud: &PointCloud<S>) -> Self {
        let n = cloud.dimension();
        let mut mean = vec![0.0; n];
        for row in cloud.iter() {
            for (m, x) in mean.iter_mut().zip(row) {
                *m += x.as_f64();
            }
        }
        let count = cloud.len().max(1) as f64;
        mean.iter_mut().for_each(|m| *m /= count);
        let radius = (cloud.iter())
            .map(|row| {
                let square = |(x, m): (&S, &f64)| (x.as_f64() - m) * (x.as_f64() - m);
                row.iter().zip(&mean).map(square).sum::<f64>()
            })
            .fold(0.0, f64::max)
            .sqrt();
        let exponent = if radius > 0.0 {
            -radius.log2().ceil().max(-990.0) - 1.0
        } else {
            0.0
        };
        let mut frame = Self {
            mean,
            scale: exponent.exp2(),
            axes: None,
        };
        if n > MOST_AXES {
            frame.axes = Some(principal_axes(&frame.sample(cloud)));
        }
        frame
    }

    /// Some points of the cloud, in the unit ball.
    fn sample<S: Scalar>(&self, cloud: &PointCloud<S>) -> DMatrix<f64> {
        let stride = cloud.len().div_ceil(AXES_SAMPLE).max(1);
        let rows: Vec<usize> = (0..cloud.len()).step_by(stride).collect();
        DMatrix::from_fn(rows.len(), cloud.dimension(), |i, j| {
            (cloud.point(rows[i])[j].as_f64() - self.mean[j]) * self.scale
        })
    }

    /// Number of coordinates in the tree.
    pub(super) fn tree_dimension(&self) -> usize {
        self.mean.len().min(MOST_AXES)
    }

    /// Writes the tree's coordinates of a row, and returns the row's norm in R^N in units of the tree.
    pub(super) fn place<S: Scalar>(&self, row: &[S], place: &mut [f64; MOST_AXES]) -> f64 {
        let centered = |j: usize| (row[j].as_f64() - self.mean[j]) * self.scale;
        let mut square = 0.0;
        match &self.axes {
            None => {
                for (j, p) in place[..row.len()].iter_mut().enumerate() {
                    *p = centered(j);
                    square += *p * *p;
                }
            }
            Some(axes) => {
                *place = [0.0; MOST_AXES];
                for j in 0..row.len() {
                    let x = centered(j);
                    square += x * x;
                    for (k, p) in place.iter_mut().enumerate() {
                        *p += x * axes[k * row.len() + j];
                    }
                }
            }
        }
        square.sqrt()
    }

    /// The tree's coordinates of all points, [`tree_dimension`](Self::tree_dimension) of them each.
    pub(super) fn places<S: Scalar>(&self, cloud: &PointCloud<S>) -> Vec<f64> {
        let width = self.tree_dimension();
        let mut place = [0.0; MOST_AXES];
        let mut all = Vec::with_capacity(cloud.len() * width);
        for row in cloud.iter() {
            self.place(row, &mut place);
            all.extend_from_slice(&place[..width]);
        }
        all
    }
}

/// Leading principal axes of a sample by subspace iteration. They are orthonormal whatever the data are, and that is all that
/// exactness needs.
fn principal_axes(sample: &DMatrix<f64>) -> Vec<f64> {
    // A fixed start that leans on no direction.
    let mut axes = DMatrix::from_fn(sample.ncols(), MOST_AXES, |i, k| {
        ((i + 1) as f64 * (k as f64 + 1.7)).cos()
    });
    axes = axes.qr().q();
    for _ in 0..AXES_ROUNDS {
        let projected = sample * &axes;
        axes = sample.tr_mul(&projected).qr().q();
    }
    axes.as_slice().to_vec()
}
