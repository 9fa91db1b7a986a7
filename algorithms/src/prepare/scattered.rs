//! Points that fill space: outliers far from the surface, which have only each other.

use super::LocalSpacing;
use super::off_sheet::{MEDIAN_TO_SCALE, NEIGHBORS};
use super::sheet_fit::SheetFit;
use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crosscap_core::PointCloud;

/// Spacing, in units of the usual one, from which points are looked at.
const SPARSE: f64 = 2.5;
/// Least mean crowding of a point and its neighbors, between 0.25 of a surface and 0.39 of space. Of 25
/// values it is known to 0.03 to 0.05.
const CROWDED: f64 = 0.32;
/// Least distance of the neighbors from a sheet of their own, as a share of its extent: points in a ball have a
/// third, those of a surface that bends a tenth.
const THICK: f64 = 0.2;

/// The points that lie sparsely and fill space with their neighbors, with their spacing in units of the usual one.
///
/// A sparse part of a surface is a sheet, however sparse, and where two sheets cross their points are
/// crowded no more than on one.
pub(super) fn scattered(
    cloud: &PointCloud<f64>,
    spacing: &LocalSpacing,
    execute: &dyn Execute,
) -> Vec<(usize, f64)> {
    let sparse = |at: usize| spacing.raw(at) > SPARSE * spacing.median();
    if cloud.len() <= NEIGHBORS || !(0..cloud.len()).any(sparse) {
        return Vec::new();
    }
    let tree = BallTree::new(cloud.dimension(), cloud.coordinates());
    let found = tree.nearest_of_each(
        NEIGHBORS,
        |at| sparse(at as usize),
        execute,
        |at, near| {
            let at = at as usize;
            let crowding = near.iter().map(|x| spacing.crowding(x.index() as usize));
            let mean = (spacing.crowding(at) + crowding.sum::<f64>()) / (near.len() + 1) as f64;
            let fills = mean > CROWDED && is_thick(cloud, near);
            fills.then(|| (at, spacing.raw(at) / spacing.median()))
        },
    );
    found.into_iter().flatten().collect()
}

/// Whether points are on no sheet.
fn is_thick(cloud: &PointCloud<f64>, near: &[Near]) -> bool {
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
    MEDIAN_TO_SCALE * distances[distances.len() / 2] > THICK * fit.extent()
}
