//! Two sheets that cross, laid through a noisy neighborhood.

use crate::balls::Near;
use crate::principal::PrincipalFrame;
use crate::singularity::{PlanePair, QuadraticPatch};
use crate::tuning::ProjectionTuning;
use crosscap_core::PointCloud;
use nalgebra::Vector3;

/// Rounds of fitting both sheets and sharing the points out anew.
const ROUNDS: usize = 4;

/// Two quadratic patches in the three leading principal coordinates of a neighborhood.
pub(super) struct CrossingSheets {
    frame: PrincipalFrame,
    patches: [QuadraticPatch; 2],
    radius: f64,
}

/// Which patch is nearer, and how far.
fn nearer(patches: &[QuadraticPatch; 2], x: &Vector3<f64>) -> (usize, f64) {
    let d = [0, 1].map(|k| patches[k].signed_distance(x).abs());
    let k = usize::from(d[1] < d[0]);
    (k, d[k])
}

/// Sum of the squared distances to the one sheet that fits best.
fn left_by_one(points: &[Vector3<f64>], radius: f64) -> f64 {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut single = QuadraticPatch::plane(Vector3::zeros(), axes);
    single.fit(points.iter().copied(), radius);
    let squares = points.iter().map(|x| single.signed_distance(x).powi(2));
    squares.sum()
}

/// Two planes with the line that they share as first axis; none where the sine of their angle is below `least`.
fn along_the_line(pair: &PlanePair, least: f64) -> Option<[QuadraticPatch; 2]> {
    let along = pair.normals[0].cross(&pair.normals[1]);
    if along.norm() < least {
        return None;
    }
    let along = along.normalize();
    Some([0, 1].map(|k| {
        let normal = pair.normals[k];
        let origin = normal * -pair.offsets[k];
        QuadraticPatch::plane(origin, [along, normal.cross(&along), normal])
    }))
}

/// Fits both patches to the points that are nearer to each, in [`ROUNDS`]. Says whose every point was in the last one, and the
/// sum of the squared distances then; nothing where a patch has too few points.
fn fit_both(
    patches: &mut [QuadraticPatch; 2],
    points: &[Vector3<f64>],
    radius: f64,
) -> Option<(Vec<usize>, f64)> {
    let mut owners = vec![0; points.len()];
    let mut sum = 0.0;
    for _ in 0..ROUNDS {
        sum = 0.0;
        for (owner, x) in owners.iter_mut().zip(points) {
            let (k, d) = nearer(patches, x);
            *owner = k;
            sum += d * d;
        }
        for (k, patch) in patches.iter_mut().enumerate() {
            let own = points.iter().zip(&owners).filter(|x| *x.1 == k);
            if !patch.fit(own.map(|x| *x.0), radius) {
                return None;
            }
        }
    }
    Some((owners, sum))
}

impl CrossingSheets {
    /// Two sheets through the neighbors of a row, where they leave less scatter than `limit` (unit of the
    /// data) and than half of what one sheet leaves.
    pub(super) fn through(
        cloud: &PointCloud<f64>,
        row: usize,
        near: &[Near],
        limit: f64,
        tuning: &ProjectionTuning,
    ) -> Option<Self> {
        let mut near = near.to_vec();
        near.sort_unstable();
        let rows = || std::iter::once(row).chain(near.iter().map(|x| x.index() as usize));
        let mut frame = PrincipalFrame::of(cloud, rows());
        if frame.rank() < 3 {
            return None;
        }
        // Many pairs are kept, and of all N axes only these are used.
        frame.axes.truncate(3 * cloud.dimension());
        let radius = near.last()?.square().sqrt();
        let mut local = Vec::with_capacity(3);
        let points: Vec<Vector3<f64>> = rows()
            .map(|i| {
                local.clear();
                frame.project(cloud.point(i), 3, &mut local);
                Vector3::from_column_slice(&local)
            })
            .collect();
        let pair = PlanePair::direct(points.iter().copied(), radius).ok()?;
        let mut patches = along_the_line(&pair, tuning.sine)?;
        let (owners, sum) = fit_both(&mut patches, &points, radius)?;
        let second: usize = owners.iter().sum();
        let share = second as f64 / points.len() as f64;
        let even = (tuning.sheet_share..=1.0 - tuning.sheet_share).contains(&share);
        let scatter = (sum / points.len() as f64).sqrt();
        let most = tuning.gain * tuning.gain * left_by_one(&points, radius);
        (even && sum <= most && scatter <= limit).then_some(Self {
            frame,
            patches,
            radius,
        })
    }

    /// Radius of the neighborhood that they were laid through.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// `x` moved onto the nearer sheet.
    pub(super) fn projected(&self, x: &[f64]) -> Vec<f64> {
        let mut local = Vec::with_capacity(3);
        self.frame.project(x, 3, &mut local);
        let mut place = Vector3::from_column_slice(&local);
        let patch = &self.patches[nearer(&self.patches, &place).0];
        let start = place;
        for _ in 0..2 {
            let (height, gradient) = patch.height(&place);
            place -= gradient * (height / gradient.norm_squared());
        }
        let shift = self.frame.lift_vector((place - start).as_slice());
        x.iter().zip(&shift).map(|(x, s)| x + s).collect()
    }
}
