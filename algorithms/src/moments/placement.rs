//! Where the tree sees the points: centered, turned to principal axes, without null directions.

use crate::execute::{self, Execute};
use crosscap_core::{PointCloud, Scalar};
use nalgebra::{DMatrix, SymmetricEigen};
use std::sync::{Mutex, PoisonError};

/// Up to this many coordinates a cloud is not turned: it would cost more than it saves.
const UNTURNED: usize = 8;
/// Above this many coordinates the eigenvectors cost more than they save.
const WIDEST_TURN: usize = 256;
/// Points that the axes are computed from: they need not be exact.
const SAMPLE: usize = 4096;
/// Points that are turned by one job.
const TURNED_AT_ONCE: usize = 8192;
/// Points that the center is computed from.
const MEDIAN_SAMPLE: usize = 65_536;

/// An affine map from R^N to the coordinates of the tree: an isometry times a power of two, up
/// to rounding. Nothing that is decided depends on which one it is.
pub(super) struct Placement {
    /// N.
    pub(super) ambient: usize,
    /// Coordinates of the tree.
    pub(super) n: usize,
    /// Subtracted from every point: a median, so that a stray point moves nothing.
    pub(super) center: Vec<f64>,
    /// Power of two that brings the cloud to about unit size.
    pub(super) scale: f64,
    /// `n * N`, orthonormal rows; `None` for a permutation.
    pub(super) axes: Option<Vec<f64>>,
    /// Coordinates in the order of the tree, where there are no axes.
    pub(super) permutation: Vec<usize>,
    /// Largest distance of a point from the subspace that the tree sees, in units of the tree.
    pub(super) dropped: f64,
}

impl Placement {
    /// The map, and the places of all points in the order of the cloud.
    pub(super) fn of<S: Scalar>(cloud: &PointCloud<S>, execute: &dyn Execute) -> (Self, Vec<f64>) {
        let ambient = cloud.dimension();
        let center = median(cloud);
        let largest = (cloud.iter())
            .flat_map(|row| row.iter().zip(&center).map(|(x, c)| (x.as_f64() - c).abs()))
            .fold(0.0, f64::max);
        let scale = if largest > 0.0 {
            (-largest.log2().ceil().clamp(-990.0, 990.0)).exp2()
        } else {
            1.0
        };
        let mut places = Vec::with_capacity(cloud.coordinates().len());
        for row in cloud.iter() {
            places.extend(
                row.iter()
                    .zip(&center)
                    .map(|(x, c)| (x.as_f64() - c) * scale),
            );
        }
        let mut placement = Self {
            ambient,
            n: ambient,
            center,
            scale,
            axes: None,
            permutation: (0..ambient).collect(),
            dropped: 0.0,
        };
        if ambient > WIDEST_TURN {
            placement.permute(&mut places);
        } else if ambient > UNTURNED && !cloud.is_empty() {
            placement.turn(&mut places, execute);
        }
        (placement, places)
    }

    /// Puts the coordinates of largest variance first.
    fn permute(&mut self, places: &mut [f64]) {
        let covariance = self.sample(places);
        let spread: Vec<f64> = (0..self.n)
            .map(|k| covariance.column(k).norm_squared())
            .collect();
        self.permutation
            .sort_by(|&a, &b| spread[b].total_cmp(&spread[a]).then(a.cmp(&b)));
        let mut row = vec![0.0; self.n];
        for place in places.chunks_exact_mut(self.n) {
            row.copy_from_slice(place);
            for (p, &k) in place.iter_mut().zip(&self.permutation) {
                *p = row[k];
            }
        }
    }

    /// Turns to principal axes and drops directions in which there is nothing but rounding.
    fn turn(&mut self, places: &mut Vec<f64>, execute: &dyn Execute) {
        let n = self.ambient;
        let sample = self.sample(places);
        let eigen = SymmetricEigen::new(sample.tr_mul(&sample));
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let mut axes = Vec::with_capacity(n * n);
        for &k in &order {
            axes.extend(eigen.eigenvectors.column(k).iter());
        }
        let columns: Vec<f64> = (0..n)
            .flat_map(|j| axes.chunks_exact(n).map(move |axis| axis[j]))
            .collect();
        // In place: a second copy of a large cloud is most of the memory there is.
        let block = n * TURNED_AT_ONCE;
        let blocks: Vec<Mutex<&mut [f64]>> = places.chunks_mut(block).map(Mutex::new).collect();
        let found = execute::few(execute, blocks.len(), |b| {
            let mut largest = vec![0.0_f64; n];
            let mut turned = vec![0.0; n];
            let mut rows = blocks[b].lock().unwrap_or_else(PoisonError::into_inner);
            for row in rows.chunks_exact_mut(n) {
                turned.fill(0.0);
                for (column, x) in columns.chunks_exact(n).zip(&*row) {
                    for (y, a) in turned.iter_mut().zip(column) {
                        *y += a * x;
                    }
                }
                for (l, y) in largest.iter_mut().zip(&turned) {
                    *l = l.max(y.abs());
                }
                row.copy_from_slice(&turned);
            }
            largest
        });
        drop(blocks);
        let mut largest = vec![0.0_f64; n];
        for own in found {
            for (l, o) in largest.iter_mut().zip(own) {
                *l = l.max(o);
            }
        }
        let rounding = 16.0 * n as f64 * f64::EPSILON;
        let kept = largest
            .iter()
            .rposition(|&l| l > rounding)
            .map_or(1, |k| k + 1);
        self.dropped = largest[kept..].iter().map(|l| l * l).sum::<f64>().sqrt();
        if kept < n {
            for k in 0..places.len() / n {
                places.copy_within(k * n..k * n + kept, k * kept);
            }
            places.truncate(places.len() / n * kept);
            places.shrink_to_fit();
            axes.truncate(kept * n);
        }
        self.n = kept;
        self.axes = Some(axes);
    }

    /// Some of the places, about their mean.
    fn sample(&self, places: &[f64]) -> DMatrix<f64> {
        let n = self.ambient;
        let count = places.len() / n;
        let rows: Vec<usize> = (0..count).step_by(count.div_ceil(SAMPLE).max(1)).collect();
        let mut sample = DMatrix::from_fn(rows.len(), n, |i, k| places[rows[i] * n + k]);
        for mut column in sample.column_iter_mut() {
            let mean = column.mean();
            column.add_scalar_mut(-mean);
        }
        sample
    }

    /// The vector of R^N that a vector of the tree stands for, in the unit of the data.
    pub(super) fn lift(&self, vector: &[f64], out: &mut [f64]) {
        let unscale = 1.0 / self.scale;
        out.fill(0.0);
        match &self.axes {
            Some(axes) => {
                for (axis, v) in axes.chunks_exact(self.ambient).zip(vector) {
                    for (o, a) in out.iter_mut().zip(axis) {
                        *o += a * v * unscale;
                    }
                }
            }
            None => {
                for (&k, v) in self.permutation.iter().zip(vector) {
                    out[k] = v * unscale;
                }
            }
        }
    }
}

/// Median of every coordinate, of so many points that strays move it no more than that of all.
fn median<S: Scalar>(cloud: &PointCloud<S>) -> Vec<f64> {
    let rows = || (0..cloud.len()).step_by(cloud.len().div_ceil(MEDIAN_SAMPLE).max(1));
    let mut column = Vec::new();
    (0..cloud.dimension())
        .map(|k| {
            column.clear();
            column.extend(rows().map(|row| cloud.point(row)[k].as_f64()));
            let half = column.len() / 2;
            if column.is_empty() {
                0.0
            } else {
                *column.select_nth_unstable_by(half, f64::total_cmp).1
            }
        })
        .collect()
}
