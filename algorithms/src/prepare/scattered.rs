//! Points that fill space: outliers far from the surface, which have only each other.

use super::LocalSpacing;
use super::off_sheet::MEDIAN_TO_SCALE;
use super::sheet_fit::SheetFit;
use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crate::tuning::OutlierTuning;
use crosscap_core::PointCloud;

/// The points that lie sparsely and fill space with their neighbors, with their spacing in units of the usual one.
///
/// A sparse part of a surface is a sheet, however sparse, and where two sheets cross their points are
/// crowded no more than on one.
pub(super) fn scattered(
    cloud: &PointCloud<f64>,
    spacing: &LocalSpacing,
    tuning: &OutlierTuning,
    execute: &dyn Execute,
) -> Vec<(usize, f64)> {
    let sparse = |at: usize| spacing.raw(at) > tuning.scattered * spacing.median();
    if cloud.len() <= tuning.neighbors || !(0..cloud.len()).any(sparse) {
        return Vec::new();
    }
    let tree = BallTree::new(cloud.dimension(), cloud.coordinates());
    let found = tree.nearest_of_each(
        tuning.neighbors,
        |at| sparse(at as usize),
        execute,
        |at, near| {
            let at = at as usize;
            let crowding = near.iter().map(|x| spacing.crowding(x.index() as usize));
            let mean = (spacing.crowding(at) + crowding.sum::<f64>()) / (near.len() + 1) as f64;
            let fills = mean > tuning.crowded && is_thick(cloud, near, tuning.thick);
            fills.then(|| (at, spacing.raw(at) / spacing.median()))
        },
    );
    found.into_iter().flatten().collect()
}

/// Whether points are on no sheet: they are as far from one as the given share of its extent.
fn is_thick(cloud: &PointCloud<f64>, near: &[Near], thick: f64) -> bool {
    let mut near = near.to_vec();
    near.sort_unstable();
    let rows = || near.iter().map(|x| cloud.point(x.index() as usize));
    let points: Vec<f64> = rows().flatten().copied().collect();
    let mut fit = SheetFit::new(cloud.dimension());
    if !fit.fit(&points, &vec![1.0; near.len()]) {
        return false;
    }
    let mut offset = Vec::new();
    let mut distances: Vec<f64> = rows()
        .map(|x| fit.distance(x, f64::INFINITY, &mut offset))
        .collect();
    distances.sort_unstable_by(f64::total_cmp);
    MEDIAN_TO_SCALE * distances[distances.len() / 2] > thick * fit.extent()
}
