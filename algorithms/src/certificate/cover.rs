//! Fifth level: mesh and points are near each other, both ways.

use super::faithful::Search;
use super::mesh_cover::MeshCover;
use super::quality::quantile;
use super::{CertificateOptions, Place, Violation, ViolationKind, within};
use crate::balls::BallTree;
use crosscap_core::{Mesh, PointCloud};
use serde::Serialize;

/// A distribution of distances, in units of the landmark separation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Distances {
    /// How many were measured.
    pub count: usize,
    /// Largest.
    pub max: f64,
    /// 99 percent are below.
    pub q99: f64,
    /// Mean.
    pub mean: f64,
}

impl Distances {
    pub(super) fn of(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self {
            count: values.len(),
            max: quantile(&values, 1.0),
            q99: quantile(&values, 0.99),
            mean: values.iter().sum::<f64>() / values.len().max(1) as f64,
        }
    }
}

/// Distances both ways between mesh and points, and landmarks that were left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CoverReport {
    /// The unit of the other lengths: the landmark separation dl, unit of the data.
    pub landmark_separation: f64,
    /// Whether it was given; otherwise it is guessed as 3/4 of the median edge.
    pub separation_given: bool,
    /// Median over the vertices of the local spacing of the input points, 1 / sqrt(density), in dl.
    pub point_spacing: f64,
    /// Radius of the largest empty disc that a sample like this one has where its spacing is the
    /// median, in dl. Elsewhere it is larger and smaller with the local spacing.
    pub point_gap: f64,
    /// Input points to the mesh, in dl.
    pub points_to_mesh: Option<Distances>,
    /// Places of the mesh (vertices, edge midpoints, inner places of triangles) to the nearest
    /// input point, in dl.
    pub mesh_to_points: Option<Distances>,
    /// The nearest input points of the inner places to the planes of their triangles, in dl.
    pub mesh_off_points: Option<Distances>,
    /// Number of landmarks that are not in the mesh.
    pub unused_landmarks: usize,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// Mixes the bits of a counter, for picks that are spread evenly and always the same.
fn mix(k: u64) -> u64 {
    let mut z = k.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// At most `budget` of `0..n`, one out of each of `budget` equal stretches.
pub(super) fn picks(n: usize, budget: usize) -> impl Iterator<Item = usize> {
    let budget = budget.min(n);
    (0..budget).map(move |k| {
        let cut = |k: usize| (k as u128 * n as u128 / budget as u128) as usize;
        let (from, to) = (cut(k), cut(k + 1));
        from + (mix(k as u64) % (to - from) as u64) as usize
    })
}

/// Whether mesh and points are near each other. `bare` are the edges without a triangle.
///
/// O(n log n) for n points and places of the mesh.
pub(super) fn check(
    mesh: &Mesh,
    search: Option<&Search<'_>>,
    bare: &[[u32; 2]],
    median_edge: f64,
    options: &CertificateOptions<'_>,
) -> CoverReport {
    let separation = options.landmark_separation.unwrap_or(0.75 * median_edge);
    let mut report = CoverReport {
        landmark_separation: separation,
        separation_given: options.landmark_separation.is_some(),
        unused_landmarks: options.unused_landmarks.len(),
        ..CoverReport::default()
    };
    report.look_at_landmarks(mesh, options);
    let (Some(points), Some(search)) = (options.points.filter(|p| !p.is_empty()), search) else {
        return report;
    };
    if separation <= 0.0 {
        // only when every triangle is a point, which has been refused
        return report;
    }
    report.look_at_points(points, search, options);
    report.look_at_mesh(
        &MeshCover {
            mesh,
            points,
            search,
            options,
            separation,
            cloud: BallTree::new(points.dimension(), points.coordinates()),
        },
        bare,
    );
    report
}

impl CoverReport {
    /// Landmarks that are not in the mesh.
    fn look_at_landmarks(&mut self, mesh: &Mesh, options: &CertificateOptions<'_>) {
        let count = options.unused_landmarks.len() as f64;
        let vertices = mesh.complex.vertices as f64;
        let allowed = (options.limits.unused_landmarks * vertices).floor();
        if count <= allowed {
            return;
        }
        let unused = options.unused_landmarks.iter();
        let places = unused.map(|&p| Place::Point(p)).collect();
        let of = |p: usize| {
            let known = options.points.filter(|c| p < c.len());
            known.map(|c| c.point(p).to_vec()).unwrap_or_default()
        };
        let violation = Violation::at(ViolationKind::UnusedLandmarks, places, |p| match p {
            Place::Point(p) => of(p),
            _ => Vec::new(),
        });
        (self.violations).extend(violation.map(|v| v.measured(count, allowed)));
    }

    /// Points that are far from the mesh.
    fn look_at_points(
        &mut self,
        points: &PointCloud<f64>,
        search: &Search<'_>,
        options: &CertificateOptions<'_>,
    ) {
        let feet = search.feet;
        let allowed = |dl: f64| options.limits.points_to_mesh + 4.0 * options.noise / dl;
        let at = |i: usize| options.separation_at(feet.rows[i] as usize, self.landmark_separation);
        let values: Vec<f64> = (0..feet.len()).map(|i| feet.heights[i] / at(i)).collect();
        let far = (0..feet.len()).filter(|&i| !within(values[i], allowed(at(i))));
        let far = far.map(|i| Place::Point(feet.rows[i] as usize)).collect();
        let distances = Distances::of(values);
        let violation = Violation::at(ViolationKind::UncoveredPoints, far, |p| match p {
            Place::Point(p) => points.point(p).to_vec(),
            _ => Vec::new(),
        });
        let limit = allowed(self.landmark_separation);
        (self.violations).extend(violation.map(|v| v.measured(distances.max, limit)));
        self.points_to_mesh = Some(distances);
    }

    /// Places of the mesh that are far from the points, or that the points pass by.
    fn look_at_mesh(&mut self, cover: &MeshCover<'_>, bare: &[[u32; 2]]) {
        self.point_spacing = cover.search.spacing() / cover.separation;
        self.point_gap = cover.search.gap() / cover.separation;
        let (far, off) = cover.measured(bare);
        let distances = Distances::of(far.values);
        let heights = Distances::of(off.values);
        let off_limit = cover.off_limit(cover.separation);
        let at = |p: Place| super::coordinates(cover.mesh, p);
        let is_far = Violation::at(ViolationKind::MeshFarFromPoints, far.places, at);
        let is_off = Violation::at(ViolationKind::MeshOffPoints, off.places, at);
        let [worst, limit] = far.worst;
        (self.violations).extend(is_far.map(|v| v.measured(worst, limit)));
        (self.violations).extend(is_off.map(|v| v.measured(heights.max, off_limit)));
        self.mesh_to_points = Some(distances);
        self.mesh_off_points = Some(heights);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picks_are_within_and_distinct() {
        for (n, budget) in [(10, 3), (1000, 999), (5, 50), (0, 4)] {
            let all: Vec<usize> = picks(n, budget).collect();
            assert_eq!(all.len(), budget.min(n));
            assert!(all.windows(2).all(|w| w[0] < w[1]));
            assert!(all.iter().all(|&i| i < n));
        }
    }
}
