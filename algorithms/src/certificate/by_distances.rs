//! What can be asked of a mesh whose points are known by their distances alone.

use super::cover::Distances;
use super::distance_report::DistanceReport;
use super::incidence::Incidence;
use super::{
    Certificate, CertificateOptions, Place, Violation, ViolationKind, edges, indices, links, within,
};
use crosscap_core::{Mesh, MetricSpace, NeighborhoodOracle, Scalar};

/// Greatest distance of a point to the nearest vertex, in dl: landmarks leave none farther than dl.
const POINTS_TO_VERTICES: f64 = 1.25;

/// Asks a mesh everything that can be decided by distances: that its arrays are those of a complex,
/// the numbers of triangles at its edges, the links of its vertices, folds and needles, and that
/// every point is near a vertex. The levels geometry, cover and quality, which need places, stay
/// out: see [`Certificate::unchecked`].
///
/// The vertices stand for the rows `mesh.point_index` of the space; their places are not looked at.
///
/// O(t log t) for t triangles, and a query a vertex.
pub fn certify_by_distances<S: Scalar>(
    mesh: &Mesh,
    metric: &dyn MetricSpace<Scalar = S>,
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    options: &CertificateOptions<'_>,
) -> Certificate {
    let mut certificate = Certificate::of_indices(indices::arrays(mesh, |_| Vec::new()));
    let rows: Option<Vec<usize>> = (mesh.point_index.iter())
        .map(|&row| usize::try_from(row).ok().filter(|&r| r < metric.len()))
        .collect();
    let (Some(rows), true) = (rows, certificate.indices.usable) else {
        if certificate.indices.usable {
            let what = format!("vertices that stand for no point of the {}", metric.len());
            let fault = Violation::whole(ViolationKind::Shape, what);
            certificate.indices.violations.push(fault);
            certificate.indices.usable = false;
        }
        return certificate;
    };
    let incidence = Incidence::new(&mesh.complex);
    certificate.edges = Some(edges::check(
        mesh,
        &incidence,
        options.closed,
        options.limits.shortest_boundary,
        &|_| false,
    ));
    certificate.links = Some(links::check(
        mesh,
        &incidence,
        options.admissible_links,
        options.special_points,
    ));
    let of_edges = certificate.edges.iter_mut().flat_map(|r| &mut r.violations);
    let of_links = certificate.links.iter_mut().flat_map(|r| &mut r.violations);
    // The mesh is drawn somewhere, but its points have no coordinates.
    of_edges.chain(of_links).for_each(|v| v.coordinates.clear());
    let report = check(mesh, &incidence, &rows, metric, oracle, options);
    certificate.by_distances = Some(report);
    certificate
}

fn check<S: Scalar>(
    mesh: &Mesh,
    incidence: &Incidence,
    rows: &[usize],
    metric: &dyn MetricSpace<Scalar = S>,
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    options: &CertificateOptions<'_>,
) -> DistanceReport {
    let length = |a: u32, b: u32| metric.distance(rows[a as usize], rows[b as usize]).as_f64();
    let mut report = DistanceReport {
        smallest_dihedral: 180.0,
        smallest_angle: 180.0,
        unused_landmarks: options.unused_landmarks.len(),
        ..DistanceReport::default()
    };
    report.look_at_landmarks(mesh, options);
    let lengths = (incidence.edges.iter()).map(|&[a, b]| length(a, b));
    let lengths: Vec<f64> = lengths.collect();
    report.look_at_edges(mesh, incidence, &lengths, &length, options);
    report.look_at_angles(mesh, &length, options);
    let separation = options
        .landmark_separation
        .unwrap_or_else(|| 0.75 * super::statistics::median(lengths));
    report.look_at_points(rows, oracle, separation);
    report
}

/// Length of an edge between two vertices.
type Length<'l> = dyn Fn(u32, u32) -> f64 + 'l;

/// The points have no coordinates.
fn nowhere(_: Place) -> Vec<f64> {
    Vec::new()
}

impl DistanceReport {
    /// Landmarks that are not in the mesh.
    fn look_at_landmarks(&mut self, mesh: &Mesh, options: &CertificateOptions<'_>) {
        let vertices = mesh.complex.vertices as f64;
        let allowed = (options.limits.unused_landmarks * vertices).floor();
        if self.unused_landmarks as f64 > allowed {
            let places = options.unused_landmarks.iter().map(|&r| Place::Point(r));
            let kind = ViolationKind::UnusedLandmarks;
            (self.violations).extend(Violation::at(kind, places.collect(), nowhere));
        }
    }

    /// Vertices at one place, and triangles that are folded onto each other.
    fn look_at_edges(
        &mut self,
        mesh: &Mesh,
        incidence: &Incidence,
        lengths: &[f64],
        length: &Length<'_>,
        options: &CertificateOptions<'_>,
    ) {
        let mut folds = Vec::new();
        let mut at_one_place = Vec::new();
        for (e, (&[a, b], &base)) in incidence.edges.iter().zip(lengths).enumerate() {
            if !within(0.0, base) || base == 0.0 {
                at_one_place.push(Place::Vertices([a, b]));
            }
            let &[s, t] = incidence.at_edge(e) else {
                continue;
            };
            let tip = |t: u32| {
                let mut corners = mesh.complex.triangles[t as usize].into_iter();
                corners.find(|&v| v != a && v != b)
            };
            let (Some(c), Some(d)) = (tip(s), tip(t)) else {
                continue;
            };
            let sides = [c, d].map(|tip| [length(a, tip), length(b, tip)]);
            let angle = dihedral(base, sides[0], sides[1], length(c, d));
            self.smallest_dihedral = self.smallest_dihedral.min(angle);
            if !within(options.limits.fold, angle) {
                folds.push(Place::Edge([a, b]));
            }
        }
        self.folds = folds.len();
        let kind = ViolationKind::CoincidentVertices;
        (self.violations).extend(Violation::at(kind, at_one_place, nowhere));
        let (worst, limit) = (self.smallest_dihedral, options.limits.fold);
        let fold = Violation::at(ViolationKind::Fold, folds, nowhere);
        (self.violations).extend(fold.map(|v| v.measured(worst, limit)));
    }

    /// Triangles that are needles.
    fn look_at_angles(
        &mut self,
        mesh: &Mesh,
        length: &Length<'_>,
        options: &CertificateOptions<'_>,
    ) {
        let mut needles = Vec::new();
        for (t, &[a, b, c]) in mesh.complex.triangles.iter().enumerate() {
            let angle = smallest_angle([length(b, c), length(a, c), length(a, b)]);
            self.smallest_angle = self.smallest_angle.min(angle);
            if !within(options.limits.min_angle, angle) {
                needles.push(Place::Triangle(t as u32));
            }
        }
        let (worst, limit) = (self.smallest_angle, options.limits.min_angle);
        let needle = Violation::at(ViolationKind::NeedleTriangle, needles, nowhere);
        (self.violations).extend(needle.map(|v| v.measured(worst, limit)));
    }

    /// Points that no vertex is near to.
    fn look_at_points<S: Scalar>(
        &mut self,
        rows: &[usize],
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        separation: f64,
    ) {
        let mut nearest = vec![f64::INFINITY; oracle.len()];
        let mut near = Vec::new();
        for &row in rows {
            oracle.within(row, S::of(2.0 * separation), &mut near);
            for x in &near {
                nearest[x.index] = nearest[x.index].min(x.distance.as_f64());
            }
        }
        let limit = POINTS_TO_VERTICES * separation;
        let far: Vec<Place> = (0..nearest.len())
            .filter(|&p| !within(nearest[p], limit))
            .map(Place::Point)
            .collect();
        // What is beyond every query is at least that far.
        let in_separations = |d: &f64| d.min(2.0 * separation) / separation;
        self.points_to_vertices = Distances::of(nearest.iter().map(in_separations).collect());
        let worst = self.points_to_vertices.max;
        let uncovered = Violation::at(ViolationKind::UncoveredPoints, far, nowhere);
        (self.violations).extend(uncovered.map(|v| v.measured(worst, POINTS_TO_VERTICES)));
    }
}

/// Angle between two triangles over a common base, degrees, from the sides of each and the distance
/// of their tips. Distances that no tetrahedron has give the nearest angle there is; a triangle
/// without height counts as folded.
fn dihedral(base: f64, [ac, bc]: [f64; 2], [ad, bd]: [f64; 2], cd: f64) -> f64 {
    let foot = |a: f64, b: f64| (base * base + a * a - b * b) / (2.0 * base);
    let (p, q) = (foot(ac, bc), foot(ad, bd));
    let (h, g) = (ac * ac - p * p, ad * ad - q * q);
    let cosine = (h + g + (p - q) * (p - q) - cd * cd) / (2.0 * (h * g).sqrt());
    if h > 0.0 && g > 0.0 && cosine.is_finite() {
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    } else {
        0.0
    }
}

/// Smallest angle of a triangle with the given sides, degrees; 0 for sides that make none.
fn smallest_angle(mut sides: [f64; 3]) -> f64 {
    sides.sort_unstable_by(f64::total_cmp);
    let [a, b, c] = sides;
    let cosine = (b * b + c * c - a * a) / (2.0 * b * c);
    if a > 0.0 && c < a + b && cosine.is_finite() {
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crosscap_core::{Complex, PointCloud};

    #[test]
    fn messages_name_no_coordinates() {
        let faces = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3]];
        let corners = vec![1., 1., 1., 1., -1., -1., -1., 1., -1., -1., -1., 1.];
        let picture = PointCloud::new(3, corners).unwrap();
        let complex = Complex::new(4, faces, vec![]).unwrap();
        let mesh = Mesh::new(complex, picture.clone(), vec![0, 1, 2, 3]).unwrap();
        let metric = Euclidean::new(picture);
        let oracle = BruteForceOracle::new(&metric);
        let options = CertificateOptions::default();
        let certificate = certify_by_distances(&mesh, &metric, &oracle, &options);
        assert!(certificate.violations().count() > 0);
        for violation in certificate.violations() {
            assert_eq!(violation.coordinates, [] as [f64; 0], "{violation}");
        }
    }

    #[test]
    fn angles_of_known_tetrahedra() {
        let root = 2f64.sqrt();
        // Two sides of a unit square's diagonal, flat and folded to a right angle.
        assert!((dihedral(root, [1.0; 2], [1.0; 2], root) - 180.0).abs() < 1e-6);
        assert!((dihedral(root, [1.0; 2], [1.0; 2], 1.0) - 90.0).abs() < 1e-9);
        assert_eq!(dihedral(root, [1.0; 2], [1.0; 2], 0.0), 0.0);
        let regular = dihedral(1.0, [1.0; 2], [1.0; 2], 1.0);
        assert!((regular - (1.0f64 / 3.0).acos().to_degrees()).abs() < 1e-9);
        assert_eq!(dihedral(2.0, [1.0; 2], [1.0; 2], 0.0), 0.0);
        assert!((smallest_angle([3.0, 5.0, 4.0]) - (0.8f64).acos().to_degrees()).abs() < 1e-9);
        assert_eq!(smallest_angle([1.0, 2.0, 4.0]), 0.0);
        assert_eq!(smallest_angle([f64::INFINITY, 1.0, 1.0]), 0.0);
    }
}
