//! Several sheets in space, each a quadratic patch, and the points shared out among them.

use super::flats::Flat;
use super::patch::QuadraticPatch;
use nalgebra::{Matrix3, Vector3};

/// Rounds of fitting patches and assigning points anew.
const ROUNDS: usize = 3;

/// The plane itself as a patch.
pub(super) fn patch_over(plane: &Flat<3>) -> QuadraticPatch {
    let normal = plane.normals[0];
    let least = normal.iamin();
    let tangent = normal.cross(&Vector3::ith(least, 1.0)).normalize();
    QuadraticPatch::plane(plane.origin, [tangent, normal.cross(&tangent), normal])
}

/// Quadratic patches with the patch that each point is nearest to.
pub(super) struct Sheets {
    pub(super) patches: Vec<QuadraticPatch>,
    /// Owner of each point, those that are only labelled included.
    pub(super) owner: Vec<u8>,
}

impl Sheets {
    /// Patches over the given planes, fitted to the first `fitted` points. `distance(k, d, x)` is how
    /// far `x` is from sheet k when it is `d` (signed) from its patch.
    pub(super) fn new(
        planes: &[Flat<3>],
        points: &[Vector3<f64>],
        fitted: usize,
        radius: f64,
        distance: impl Fn(usize, f64, &Vector3<f64>) -> f64,
    ) -> Self {
        let mut sheets = Self {
            patches: planes.iter().map(patch_over).collect(),
            owner: vec![0; points.len()],
        };
        sheets.assign(points, &distance);
        for _ in 0..ROUNDS {
            for (k, patch) in sheets.patches.iter_mut().enumerate() {
                let own = points[..fitted]
                    .iter()
                    .zip(&sheets.owner)
                    .filter(|&(_, &o)| usize::from(o) == k);
                patch.fit(own.map(|(x, _)| *x), radius);
            }
            sheets.assign(points, &distance);
        }
        sheets
    }

    fn assign(
        &mut self,
        points: &[Vector3<f64>],
        distance: &impl Fn(usize, f64, &Vector3<f64>) -> f64,
    ) {
        for (owner, x) in self.owner.iter_mut().zip(points) {
            let mut best = (f64::INFINITY, 0);
            for (k, patch) in self.patches.iter().enumerate() {
                let d = distance(k, patch.signed_distance(x), x).abs();
                if d < best.0 {
                    best = (d, k as u8);
                }
            }
            *owner = best.1;
        }
    }

    /// The point nearest to `start`, to first order, in which all the patches named meet, normals
    /// spanning `rank` directions: 2 for a curve, 3 for a point. Newton with steps of least norm;
    /// `None` when it wanders farther than `reach`, or when the normals span another number of directions: those at a
    /// smaller sine than `least_sine` are one.
    pub(super) fn meet(
        &self,
        which: &[usize],
        rank: usize,
        start: Vector3<f64>,
        reach: f64,
        least_sine: f64,
    ) -> Option<Vector3<f64>> {
        let mut x = start;
        let mut last = f64::INFINITY;
        for _ in 0..12 {
            let mut normal = Matrix3::zeros();
            let mut right = Vector3::zeros();
            for &k in which {
                let (height, gradient) = self.patches[k].height(&x);
                let length = gradient.norm();
                let n = gradient / length;
                normal += n * n.transpose();
                right += n * (height / length);
            }
            let eigen = normal.symmetric_eigen();
            let mut step = Vector3::zeros();
            let mut used = 0;
            for k in 0..3 {
                let value = eigen.eigenvalues[k];
                if value > least_sine * least_sine {
                    let axis = eigen.eigenvectors.column(k);
                    step += axis * (axis.dot(&right) / value);
                    used += 1;
                }
            }
            if used != rank {
                return None;
            }
            x -= step;
            if (x - start).norm() > reach {
                return None;
            }
            last = step.norm();
            if last < 1e-12 * reach {
                break;
            }
        }
        (last < 1e-3 * reach).then_some(x)
    }
}
