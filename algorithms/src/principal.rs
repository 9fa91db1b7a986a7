//! Principal axes of a set of points: the affine frame that everything local is measured in.

use crosscap_core::{PointCloud, Scalar};
use nalgebra::{DMatrix, SymmetricEigen};

/// Mean, principal directions and variances of a set of points of R^N.
#[derive(Clone, Debug, PartialEq)]
pub struct PrincipalFrame {
    /// The mean, N coordinates.
    pub mean: Vec<f64>,
    /// Principal directions in order of falling variance, `count * N` in row order; there are
    /// `min(N, k)` of them for k points.
    pub axes: Vec<f64>,
    /// Variances along them (sums of squares over the number of points), largest first.
    pub variances: Vec<f64>,
}

impl PrincipalFrame {
    /// Frame of the points of `cloud` with the given indices. O(k N^2 + N^3), or
    /// O(k^2 N + k^3) where there are fewer points than coordinates.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        indices: impl Iterator<Item = usize> + Clone,
    ) -> Self {
        let n = cloud.dimension();
        let mut mean = vec![0.0; n];
        let mut count = 0usize;
        for i in indices.clone() {
            for (m, x) in mean.iter_mut().zip(cloud.point(i)) {
                *m += x.as_f64();
            }
            count += 1;
        }
        let scale = 1.0 / count.max(1) as f64;
        mean.iter_mut().for_each(|m| *m *= scale);
        if count < n {
            return Self::from_gram(cloud, indices, mean, count);
        }
        let mut covariance = DMatrix::<f64>::zeros(n, n);
        let mut centered = vec![0.0; n];
        for i in indices {
            for ((c, x), m) in centered.iter_mut().zip(cloud.point(i)).zip(&mean) {
                *c = x.as_f64() - m;
            }
            // Column by column, as the matrix lies in memory.
            let columns = covariance.as_mut_slice().chunks_exact_mut(n);
            for (b, column) in columns.enumerate() {
                let weight = centered[b];
                for (c, x) in column[b..].iter_mut().zip(&centered[b..]) {
                    *c += weight * x;
                }
            }
        }
        for a in 0..n {
            for b in 0..=a {
                let value = covariance[(a, b)] * scale;
                covariance[(a, b)] = value;
                covariance[(b, a)] = value;
            }
        }
        let eigen = SymmetricEigen::new(covariance);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let mut axes = Vec::with_capacity(n * n);
        for &k in &order {
            axes.extend(eigen.eigenvectors.column(k).iter());
        }
        Self {
            mean,
            axes,
            variances: order
                .iter()
                .map(|&k| eigen.eigenvalues[k].max(0.0))
                .collect(),
        }
    }

    /// The same from the matrix of inner products, for fewer points than coordinates.
    fn from_gram<S: Scalar>(
        cloud: &PointCloud<S>,
        indices: impl Iterator<Item = usize>,
        mean: Vec<f64>,
        count: usize,
    ) -> Self {
        let n = mean.len();
        let mut rows = DMatrix::<f64>::zeros(count, n);
        for (r, i) in indices.enumerate() {
            for (c, x) in cloud.point(i).iter().enumerate() {
                rows[(r, c)] = x.as_f64() - mean[c];
            }
        }
        let eigen = SymmetricEigen::new(&rows * rows.transpose());
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let mut axes = Vec::new();
        let mut variances = Vec::new();
        let top = order.first().map_or(0.0, |&k| eigen.eigenvalues[k]);
        for &k in &order {
            let value = eigen.eigenvalues[k];
            if value <= top * 1e-14 {
                break;
            }
            let axis = rows.transpose() * eigen.eigenvectors.column(k) / value.sqrt();
            axes.extend(axis.iter());
            variances.push(value / count as f64);
        }
        Self {
            mean,
            axes,
            variances,
        }
    }

    /// N.
    pub fn ambient_dimension(&self) -> usize {
        self.mean.len()
    }

    /// Smallest d such that less than the share `dt` of the variance lies outside d directions.
    pub fn dimension(&self, dt: f64) -> usize {
        let total: f64 = self.variances.iter().sum();
        let mut rest = total;
        let mut d = 0;
        while d < self.variances.len() && rest >= dt * total && rest > 0.0 {
            rest -= self.variances[d];
            d += 1;
        }
        d
    }

    /// Whether the points spread beyond the first `d` directions: half as much as in the last of them.
    pub fn spreads_beyond(&self, d: usize) -> bool {
        let beyond: f64 = self.variances.iter().skip(d).sum();
        d > 0 && beyond > 0.5 * self.variances.get(d - 1).copied().unwrap_or(0.0)
    }

    /// Direction `k`.
    pub fn axis(&self, k: usize) -> &[f64] {
        let n = self.mean.len();
        &self.axes[k * n..(k + 1) * n]
    }

    /// Number of directions with a variance.
    pub fn rank(&self) -> usize {
        self.variances.len()
    }

    /// Coordinates of `point` along the leading `dimension` axes, appended to `out`; zeros
    /// where there are fewer axes.
    pub fn project<S: Scalar>(&self, point: &[S], dimension: usize, out: &mut Vec<f64>) {
        for k in 0..dimension {
            out.push(if k < self.rank() {
                self.axis(k)
                    .iter()
                    .zip(point)
                    .zip(&self.mean)
                    .map(|((a, x), m)| a * (x.as_f64() - m))
                    .sum()
            } else {
                0.0
            });
        }
    }

    /// The vector of R^N with the given coordinates along the leading axes.
    pub fn lift_vector(&self, local: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.mean.len()];
        for (k, &c) in local.iter().enumerate().take(self.rank()) {
            for (o, a) in out.iter_mut().zip(self.axis(k)) {
                *o += c * a;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn plane_in_space_has_two_variances() {
        let mut rows = Vec::new();
        for i in 0..5 {
            for j in 0..3 {
                rows.extend([f64::from(i) * 2.0, f64::from(j), 7.0]);
            }
        }
        let cloud = PointCloud::new(3, rows).unwrap();
        let frame = PrincipalFrame::of(&cloud, 0..15);
        assert_relative_eq!(frame.variances[0], 8.0, epsilon = 1e-12);
        assert_relative_eq!(frame.variances[1], 2.0 / 3.0, epsilon = 1e-12);
        assert!(frame.variances[2] < 1e-20);
        assert_relative_eq!(frame.axis(0)[0].abs(), 1.0, epsilon = 1e-12);
    }

    #[test]
    fn fewer_points_than_coordinates_agree_with_more() {
        let few = PointCloud::new(6, (0..24).map(|k| f64::from(k * k % 17)).collect()).unwrap();
        let gram = PrincipalFrame::of(&few, 0..4);
        let twice: Vec<usize> = (0..4).chain(0..4).collect();
        let covariance = PrincipalFrame::of(&few, twice.iter().copied());
        for k in 0..3 {
            assert_relative_eq!(
                gram.variances[k],
                covariance.variances[k],
                max_relative = 1e-9
            );
        }
    }
}
