//! A few orthonormal directions of R^N in which bounding boxes are kept.

use crosscap_core::PointCloud;

/// Number of directions. A surface seldom needs more to tell its parts apart, and six doubles
/// twice are the box that a tree node can afford.
pub(super) const AXES: usize = 6;

/// A place in the frame; unused axes are zero.
pub(super) type Spot = [f64; AXES];

/// Orthogonal projection to the leading principal axes. It never lengthens a distance, so a
/// distance of boxes in the frame is a lower bound for one in R^N. Up to `AXES` dimensions it is
/// the identity, and exact.
pub(super) struct Frame {
    dimension: usize,
    center: Vec<f64>,
    /// `AXES` rows of `dimension`; empty for the identity.
    axes: Vec<f64>,
    /// By how much rounding may move a projected coordinate.
    pub slack: f64,
}

impl Frame {
    /// Axes of `shape`, good for places of `shape` and of `other`. Block power iteration on at most 2000 rows: O(N) memory.
    pub fn new(shape: &PointCloud<f64>, other: Option<&PointCloud<f64>>) -> Self {
        let n = shape.dimension();
        if n <= AXES || shape.is_empty() {
            return Self {
                dimension: n,
                center: vec![0.0; n],
                axes: Vec::new(),
                slack: 0.0,
            };
        }
        let rows: Vec<&[f64]> = shape.iter().step_by(shape.len().div_ceil(2000)).collect();
        let mut center = vec![0.0; n];
        for row in &rows {
            for (c, x) in center.iter_mut().zip(*row) {
                *c += x / rows.len() as f64;
            }
        }
        let mut axes = vec![0.0; AXES * n];
        for (k, a) in axes.iter_mut().enumerate() {
            // any start in general position; fixed, so that results repeat
            *a = ((k as f64 + 1.0) * 1.618_033_988_749_895).fract() - 0.5;
        }
        orthonormalize(&mut axes, n);
        let mut next = vec![0.0; AXES * n];
        for _ in 0..12 {
            next.fill(0.0);
            for row in &rows {
                for (axis, image) in axes.chunks_exact(n).zip(next.chunks_exact_mut(n)) {
                    let along: f64 = centered_dot(row, &center, axis);
                    for ((i, x), c) in image.iter_mut().zip(*row).zip(&center) {
                        *i += along * (x - c);
                    }
                }
            }
            std::mem::swap(&mut axes, &mut next);
            orthonormalize(&mut axes, n);
        }
        let mut reach = 0.0_f64;
        for row in shape.iter().chain(other.into_iter().flat_map(|o| o.iter())) {
            let r: f64 = row
                .iter()
                .zip(&center)
                .map(|(x, c)| (x - c) * (x - c))
                .sum();
            let size: f64 = row.iter().map(|x| x * x).sum();
            reach = reach.max(r.sqrt() + size.sqrt());
        }
        Self {
            dimension: n,
            center,
            axes,
            slack: 4.0 * n as f64 * f64::EPSILON * reach,
        }
    }

    /// The place of a row of N coordinates.
    pub fn spot(&self, row: &[f64]) -> Spot {
        let mut spot = [0.0; AXES];
        if self.axes.is_empty() {
            spot[..self.dimension.min(AXES)].copy_from_slice(row);
        } else {
            for (s, axis) in spot.iter_mut().zip(self.axes.chunks_exact(self.dimension)) {
                *s = centered_dot(row, &self.center, axis);
            }
        }
        spot
    }
}

fn centered_dot(row: &[f64], center: &[f64], axis: &[f64]) -> f64 {
    row.iter()
        .zip(center)
        .zip(axis)
        .map(|((x, c), a)| (x - c) * a)
        .sum()
}

/// Gram-Schmidt, twice for accuracy; a direction that vanishes is replaced by zero, which keeps
/// the projection a contraction.
fn orthonormalize(axes: &mut [f64], n: usize) {
    for k in 0..AXES {
        let (before, rest) = axes.split_at_mut(k * n);
        let axis = &mut rest[..n];
        let first: f64 = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        for _ in 0..2 {
            for earlier in before.chunks_exact(n) {
                let along: f64 = axis.iter().zip(earlier).map(|(a, e)| a * e).sum();
                for (a, e) in axis.iter_mut().zip(earlier) {
                    *a -= along * e;
                }
            }
        }
        let left: f64 = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        if left > 1e-10 * first && left > 0.0 {
            axis.iter_mut().for_each(|a| *a /= left);
        } else {
            axis.fill(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn never_lengthens(rows in proptest::collection::vec(-10.0..10.0_f64, 9 * 12)) {
            let cloud = PointCloud::new(9, rows).unwrap();
            let frame = Frame::new(&cloud, None);
            for a in 0..cloud.len() {
                for b in 0..a {
                    let (p, q) = (frame.spot(cloud.point(a)), frame.spot(cloud.point(b)));
                    let short: f64 = p.iter().zip(&q).map(|(x, y)| (x - y) * (x - y)).sum();
                    prop_assert!(short.sqrt() <= cloud.squared_distance(a, b).sqrt() + 2.0 * frame.slack);
                }
            }
        }
    }

    #[test]
    fn a_flat_cloud_keeps_its_distances() {
        let rows: Vec<f64> = (0..30)
            .flat_map(|i| {
                let (s, t) = ((i % 6) as f64, (i / 6) as f64);
                (0..8).map(move |k| s * (k as f64).cos() + t * (1.7 * k as f64).sin())
            })
            .collect();
        let cloud = PointCloud::new(8, rows).unwrap();
        let frame = Frame::new(&cloud, None);
        let (p, q) = (frame.spot(cloud.point(0)), frame.spot(cloud.point(29)));
        let kept: f64 = p.iter().zip(&q).map(|(x, y)| (x - y) * (x - y)).sum();
        assert!((kept - cloud.squared_distance(0, 29)).abs() < 1e-9 * kept);
    }
}
