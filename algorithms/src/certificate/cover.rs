//! Fifth level: mesh and points are near each other, both ways.

use super::chords::Chords;
use super::distance::Products;
use super::faithful::Search;
use super::geometry::corners;
use super::quality::quantile;
use super::{CertificateOptions, Place, Violation, ViolationKind, within};
use crate::balls::BallTree;
use crosscap_core::{Mesh, squared_distance};
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

/// Barycentric steps of a triangle whose sides are sampled at the latter's middle at least.
fn steps(corners: [&[f64]; 3], separation: f64) -> usize {
    let longest = (0..3)
        .map(|k| squared_distance(corners[k], corners[(k + 1) % 3]))
        .fold(0.0, f64::max)
        .sqrt();
    let pieces = (longest / (2.0 * separation)).ceil();
    2 * (pieces.min(12.0) as usize).max(1)
}

/// Places inside an edge, as shares of the way.
fn shares(pieces: usize) -> impl Iterator<Item = f64> {
    (1..pieces).map(move |i| i as f64 / pieces as f64)
}

/// Places of a triangle, as weights of its corners, which are none of them; whether each is inside.
fn weights(pieces: usize) -> impl Iterator<Item = ([f64; 3], bool)> {
    let grid =
        (0..=pieces).flat_map(move |i| (0..=pieces - i).map(move |j| [i, j, pieces - i - j]));
    let weighed = grid.filter_map(move |steps| {
        let zeros = steps.iter().filter(|&&x| x == 0).count();
        (zeros < 2).then(|| (steps.map(|x| x as f64 / pieces as f64), zeros == 0))
    });
    std::iter::once(([1.0 / 3.0; 3], true)).chain(weighed)
}

/// The places of the mesh whose nearest points are asked for, one after the other, where the landmark separation is the
/// same everywhere.
pub(super) fn places(mesh: &Mesh, bare: &[[u32; 2]], separation: f64) -> Vec<f64> {
    let mut all = mesh.vertices.coordinates().to_vec();
    for &ends in bare {
        let [p, q] = ends.map(|v| mesh.vertices.point(v as usize));
        for t in shares(steps([p, q, q], separation)) {
            all.extend(p.iter().zip(q).map(|(p, q)| p * (1.0 - t) + q * t));
        }
    }
    for t in 0..mesh.complex.triangles.len() as u32 {
        let c = corners(mesh, t);
        for (w, _) in weights(steps(c, separation)) {
            let place = (0..c[0].len()).map(|k| w[0] * c[0][k] + w[1] * c[1][k] + w[2] * c[2][k]);
            all.extend(place);
        }
    }
    all
}

pub(super) fn check(
    mesh: &Mesh,
    search: Option<&Search<'_>>,
    bare: &[[u32; 2]],
    median_edge: f64,
    options: &CertificateOptions<'_>,
) -> CoverReport {
    let limits = &options.limits;
    let separation = options.landmark_separation.unwrap_or(0.75 * median_edge);
    let mut report = CoverReport {
        landmark_separation: separation,
        separation_given: options.landmark_separation.is_some(),
        unused_landmarks: options.unused_landmarks.len(),
        ..CoverReport::default()
    };
    let allowed = (limits.unused_landmarks * mesh.complex.vertices as f64).floor();
    if report.unused_landmarks as f64 > allowed {
        let places = options
            .unused_landmarks
            .iter()
            .map(|&p| Place::Point(p))
            .collect();
        let violation = Violation::at(ViolationKind::UnusedLandmarks, places, |p| match p {
            Place::Point(p) => options
                .points
                .filter(|c| p < c.len())
                .map(|c| c.point(p).to_vec())
                .unwrap_or_default(),
            _ => Vec::new(),
        });
        report
            .violations
            .extend(violation.map(|v| v.measured(options.unused_landmarks.len() as f64, allowed)));
    }
    let (Some(points), Some(search)) = (options.points.filter(|p| !p.is_empty()), search) else {
        return report;
    };
    if separation <= 0.0 {
        // only when every triangle is a point, which has been refused
        return report;
    }
    // The landmark separation at an input point.
    let at = |row: usize| separation * options.separation_scale.map_or(1.0, |scale| scale[row]);

    // points to mesh
    let count = mesh.complex.triangles.len();
    let feet = search.feet;
    let (heights, rows) = (feet.heights.iter(), &feet.rows);
    let values: Vec<f64> = (heights.zip(rows))
        .map(|(h, &row)| h / at(row as usize))
        .collect();
    let limit = |i: usize| limits.points_to_mesh + 4.0 * options.noise / at(feet.rows[i] as usize);
    let far = (0..feet.len()).filter(|&i| !within(values[i], limit(i)));
    let far = far.map(|i| Place::Point(feet.rows[i] as usize)).collect();
    let distances = Distances::of(values);
    report.violations.extend(
        Violation::at(ViolationKind::UncoveredPoints, far, |p| match p {
            Place::Point(p) => points.point(p).to_vec(),
            _ => Vec::new(),
        })
        .map(|v| {
            v.measured(
                distances.max,
                limits.points_to_mesh + 4.0 * options.noise / separation,
            )
        }),
    );
    report.points_to_mesh = Some(distances);

    // mesh to points
    let cloud = BallTree::new(points.dimension(), points.coordinates());
    report.point_spacing = search.spacing() / separation;
    report.point_gap = search.gap() / separation;
    let nearest = |row: &[f64]| cloud.nearest(row, |_| true);
    // The landmark separation at a place of the mesh: that of the input point nearest to it.
    let near = |place: &[f64]| match options.separation_scale {
        None => separation,
        Some(_) => nearest(place).map_or(separation, |n| at(n.0 as usize)),
    };
    let (mut values, mut off_values) = (Vec::new(), Vec::new());
    let (mut far, mut off) = (Vec::new(), Vec::new());
    // the value and the limit of the place that is furthest beyond its limit
    let mut worst = (0.0, f64::INFINITY);
    // whether a place is too far from the points, where gaps of that radius are likely
    let mut too_far = |d: f64, gap: f64, dl: f64| {
        let limit = limits.mesh_to_points + 4.0 * options.noise / dl + gap / dl;
        if worst.1 == f64::INFINITY || d - limit > worst.0 - worst.1 {
            worst = (d, limit);
        }
        !within(d, limit)
    };
    for v in 0..mesh.complex.vertices {
        let dl = near(mesh.vertices.point(v));
        let d = nearest(mesh.vertices.point(v)).map_or(0.0, |n| n.1.sqrt() / dl);
        if too_far(d, search.gap_at_vertex(v as u32), dl) {
            far.push(Place::Vertex(v as u32));
        }
        values.push(d);
    }
    let n = points.dimension();
    let mut place = vec![0.0; n];
    let mut seen: Vec<[u32; 2]> = Vec::new();
    let curve_gap = search.curve_gap(bare);
    for &[a, b] in bare {
        let (p, q) = (
            mesh.vertices.point(a as usize),
            mesh.vertices.point(b as usize),
        );
        let dl = near(p);
        for t in shares(steps([p, q, q], dl)) {
            for k in 0..n {
                place[k] = p[k] * (1.0 - t) + q[k] * t;
            }
            let d = nearest(&place).map_or(0.0, |n| n.1.sqrt() / dl);
            if too_far(d, curve_gap, dl) && seen.last() != Some(&[a, b]) {
                seen.push([a, b]);
                far.push(Place::Edge([a, b]));
            }
            values.push(d);
        }
    }
    for t in 0..count as u32 {
        let c = corners(mesh, t);
        let dl = near(c[0]);
        let pieces = steps(c, dl);
        let off_limit = limits.off_plane + 4.0 * options.noise / dl;
        let mut triangle_far = false;
        let mut triangle_off = 0.0_f64;
        let gap = search.gap_at(t);
        for (weights, inner) in weights(pieces) {
            for k in 0..n {
                place[k] = weights[0] * c[0][k] + weights[1] * c[1][k] + weights[2] * c[2][k];
            }
            if let Some((q, d)) = nearest(&place) {
                let d = d.sqrt() / dl;
                triangle_far |= too_far(d, gap, dl);
                values.push(d);
                if inner {
                    let row = points.point(q as usize);
                    let height = off_plane(row, &place, c) / dl;
                    triangle_off = triangle_off.max(height);
                    off_values.push(height);
                }
            }
        }
        if triangle_far {
            far.push(Place::Triangle(t));
        }
        if !within(triangle_off, off_limit) {
            off.push(Place::Triangle(t));
        }
    }
    // edges that the points are beyond a gap from, where the surface goes another way
    let chords = Chords {
        search,
        points,
        cloud: &cloud,
    };
    for (e, &ends) in search.incidence.edges.iter().enumerate() {
        if search.incidence.at_edge(e).len() < 2 {
            continue;
        }
        let [a, b] = ends.map(|v| mesh.vertices.point(v as usize));
        (place.iter_mut().zip(a.iter().zip(b))).for_each(|(x, (p, q))| *x = 0.5 * (p + q));
        let beyond = ends.map(|v| search.gap_at_vertex(v));
        let away = nearest(&place).map_or(0.0, |n| n.1.sqrt());
        if away <= beyond[0].max(beyond[1]) + 4.0 * options.noise {
            continue;
        }
        let dl = near(a);
        let height = chords.height(ends).map_or(0.0, |height| height / dl);
        if !within(height, limits.off_plane + 4.0 * options.noise / dl) {
            off.push(Place::Edge(ends));
            off_values.push(height);
        }
    }
    let distances = Distances::of(values);
    let heights = Distances::of(off_values);
    let off_limit = limits.off_plane + 4.0 * options.noise / separation;
    let at = |p: Place| super::coordinates(mesh, p);
    report.violations.extend(
        Violation::at(ViolationKind::MeshFarFromPoints, far, at)
            .map(|v| v.measured(worst.0, worst.1)),
    );
    report.violations.extend(
        Violation::at(ViolationKind::MeshOffPoints, off, at)
            .map(|v| v.measured(heights.max, off_limit)),
    );
    report.mesh_to_points = Some(distances);
    report.mesh_off_points = Some(heights);
    report
}

/// Distance of `point` to the plane through `place` that is parallel to the triangle.
fn off_plane(point: &[f64], place: &[f64], triangle: [&[f64]; 3]) -> f64 {
    let products = Products::of(point, place, triangle);
    let Products {
        uu,
        uv,
        vv,
        wu,
        wv,
        ww,
    } = products;
    let along = products.determinant().map_or(0.0, |determinant| {
        (vv * wu * wu - 2.0 * uv * wu * wv + uu * wv * wv) / determinant
    });
    (ww - along).max(0.0).sqrt()
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

    #[test]
    fn height_over_a_plane() {
        let t: [&[f64]; 3] = [&[0., 0., 0.], &[2., 0., 0.], &[0., 2., 0.]];
        assert!((off_plane(&[7., 3., 0.5], &[0.5, 0.5, 0.], t) - 0.5).abs() < 1e-12);
    }
}
