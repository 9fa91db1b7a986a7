//! Moments of one ball, in the coordinates of the data.

use super::group::Ball;
use super::packed;
use super::tree::Tree;
use crosscap_core::{PointCloud, Scalar};

/// Moments of the points in a ball.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallMoments {
    /// Row of the cloud that is the center.
    pub center: usize,
    /// Points in the ball, the center among them.
    pub count: u32,
    /// Their mean, N coordinates.
    pub mean: Vec<f64>,
    /// Their covariance (sums over the number of points, not that less one), N * N in row order.
    pub covariance: Vec<f64>,
}

impl BallMoments {
    /// From the coordinates of the tree, in units of `unit`, to those of the data.
    pub(super) fn lift(&mut self, tree: &Tree, unit: f64, ball: &Ball<'_>) {
        let (n, ambient) = (tree.n, tree.placement.ambient);
        let placement = &tree.placement;
        self.count = ball.count;
        self.mean.resize(ambient, 0.0);
        let middle: Vec<f64> = ball
            .center
            .iter()
            .zip(ball.mean)
            .map(|(c, m)| c + m * unit)
            .collect();
        placement.lift(&middle, &mut self.mean);
        for (m, c) in self.mean.iter_mut().zip(&placement.center) {
            *m += c;
        }
        let mut dense = Vec::new();
        packed::unfold(ball.covariance, n, &mut dense);
        let mut half = vec![0.0; n * ambient];
        for (row, out) in dense.chunks_exact(n).zip(half.chunks_exact_mut(ambient)) {
            placement.lift(row, out);
        }
        self.covariance.resize(ambient * ambient, 0.0);
        let mut column = vec![0.0; n];
        for (k, out) in self.covariance.chunks_exact_mut(ambient).enumerate() {
            for (c, row) in column.iter_mut().zip(half.chunks_exact(ambient)) {
                *c = row[k] * (unit * unit);
            }
            placement.lift(&column, out);
        }
    }

    /// By definition: the mean, then the products about it.
    pub(super) fn sum<S: Scalar>(&mut self, cloud: &PointCloud<S>, rows: &[usize]) {
        let n = cloud.dimension();
        let share = 1.0 / rows.len() as f64;
        self.count = rows.len() as u32;
        self.mean.clear();
        self.mean.resize(n, 0.0);
        for &i in rows {
            for (m, x) in self.mean.iter_mut().zip(cloud.point(i)) {
                *m += x.as_f64();
            }
        }
        self.mean.iter_mut().for_each(|m| *m *= share);
        let mut products = vec![0.0; packed::length(n)];
        let mut from = vec![0.0; n];
        for &i in rows {
            for ((f, x), m) in from.iter_mut().zip(cloud.point(i)).zip(&self.mean) {
                *f = x.as_f64() - m;
            }
            packed::add_square(&mut products, &from, share);
        }
        packed::unfold(&products, n, &mut self.covariance);
    }
}
