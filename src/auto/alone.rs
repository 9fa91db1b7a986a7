//! Points that lie alone, as a mesh tells that is right but for them.

use crosscap_algorithms::certificate::{
    Certificate, Place, Violation, ViolationKind, distances_to_mesh,
};
use crosscap_algorithms::stratify::has_company;
use crosscap_algorithms::tuning::RefinementTuning;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{Mesh, Neighbor, NeighborhoodOracle, PointCloud};

/// Rounds of leaving out points that a mesh shows to be alone.
pub(super) const ROUNDS: usize = 2;

/// Share of the points that may be left out so. More are no few outliers that were overlooked, but something that the mesh
/// lacks.
const MOST: f64 = 0.005;

/// The rows of the input that are all that is wrong with a mesh, where each of them is far from it and has no company there;
/// none otherwise. `kept` are the rows that the mesh was made from, all when left out.
///
/// A curve, a rim or a sheet that the mesh lacks has company: see [`has_company`].
pub(super) fn rows(
    certificate: &Certificate,
    mesh: &Mesh,
    given: &PointCloud<f64>,
    kept: Option<&[usize]>,
    tuning: &RefinementTuning,
) -> Vec<usize> {
    let violations: Vec<&Violation> = certificate.violations().collect();
    let [only] = violations[..] else {
        return Vec::new();
    };
    let count = kept.map_or(given.len(), <[usize]>::len);
    let few = only.count as f64 <= (MOST * count as f64).max(1.0);
    let listed = only.count == only.places.len();
    let far = only.kind == ViolationKind::UncoveredPoints;
    if !(far && few && listed) {
        return Vec::new();
    }
    let row = |place: &Place| match place {
        Place::Point(row) => Some(*row),
        _ => None,
    };
    let far: Vec<usize> = only.places.iter().filter_map(row).collect();
    match are_alone(mesh, given, kept, &far, tuning) {
        Some(true) => far,
        _ => Vec::new(),
    }
}

/// Whether none of the rows `far` has company; nothing where that cannot be told.
fn are_alone(
    mesh: &Mesh,
    given: &PointCloud<f64>,
    kept: Option<&[usize]>,
    far: &[usize],
    tuning: &RefinementTuning,
) -> Option<bool> {
    let cloud = kept.map_or_else(|| given.clone(), |rows| given.select(rows));
    let position = |row: usize| kept.map_or(Some(row), |rows| rows.binary_search(&row).ok());
    let oracle = EuclideanOracle::new(cloud).ok()?;
    let mut near: Vec<Neighbor<f64>> = Vec::new();
    for &row in far {
        let row = position(row)?;
        oracle.nearest(row, tuning.company + 1, &mut near);
        near.retain(|x| x.index != row);
        let looked_at: Vec<usize> = std::iter::once(row)
            .chain(near.iter().map(|x| x.index))
            .collect();
        let heights = distances_to_mesh(mesh, &oracle.cloud().select(&looked_at));
        let others = near.iter().zip(&heights[1..]);
        let others = others.map(|(x, &height)| (x.distance, height));
        if has_company(heights[0], others, tuning) {
            return Some(false);
        }
    }
    Some(true)
}
