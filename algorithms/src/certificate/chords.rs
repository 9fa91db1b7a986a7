//! Edges that leave the surface: chords through the inside of something thin.
//!
//! A chord of a thin tube may be as near to its points as a gap and what its sheet cuts off a bend allow together. The
//! surface about its ends tells it: a circle that is as steep to the chord as that is high over its middle.

use super::faithful::Search;
use crate::balls::BallTree;
use crate::orthogonal::dot;
use crate::principal::PrincipalFrame;
use crosscap_core::{PointCloud, squared_distance};
use std::f64::consts::PI;

/// Points about an end that its tangent plane is taken from.
const ABOUT: f64 = 16.0;
/// Fewest of them.
const LEAST: usize = 8;
/// Largest standard deviation across the plane, as a share of the radius r: a sheet that bends with the radius R has r / 8 R, two
/// sheets that cross have 0.35.
const FLAT: f64 = 0.2;

/// Tangent planes about the ends of edges, where the points are on one sheet there.
pub(super) struct Chords<'c> {
    pub(super) search: &'c Search<'c>,
    pub(super) points: &'c PointCloud<f64>,
    pub(super) cloud: &'c BallTree,
}

impl Chords<'_> {
    /// How high the surface is over the middle of an edge, as it goes from both ends: the lesser of the two, unit of the data.
    /// None where the points about an end are not on one sheet. O(log n) and a fit to some points for each end.
    pub(super) fn height(&self, ends: [u32; 2]) -> Option<f64> {
        let [a, b] = ends.map(|v| self.search.mesh.vertices.point(v as usize));
        let way: Vec<f64> = a.iter().zip(b).map(|(x, y)| y - x).collect();
        let length = squared_distance(a, b).sqrt();
        let of = |v: u32| Some(arc_height(length, self.steepness(v, &way, length)?));
        Some(of(ends[0])?.min(of(ends[1])?))
    }

    /// Cosine of the angle between a way and the tangent plane at a vertex.
    fn steepness(&self, vertex: u32, way: &[f64], length: f64) -> Option<f64> {
        let density = self.search.ground.density[vertex as usize];
        let reach = (ABOUT / (PI * density)).sqrt();
        if !(reach.is_finite() && length > 0.0) {
            return None;
        }
        let mut about = Vec::new();
        let place = self.search.mesh.vertices.point(vertex as usize);
        self.cloud
            .within(place, reach, |row, _| about.push(row as usize));
        // in the order of the tree, which is that of the machine's input alone
        about.sort_unstable();
        if about.len() < LEAST {
            return None;
        }
        let frame = PrincipalFrame::of(self.points, about.iter().copied());
        let across: f64 = frame.variances.iter().skip(2).sum();
        (across.sqrt() < FLAT * reach).then(|| {
            let along = |k: usize| dot(frame.axis(k), way) / length;
            along(0).hypot(along(1)).min(1.0)
        })
    }
}

/// Height over the middle of a chord of the circle that leaves its end at an angle with that cosine: l / 2 tan(angle / 2).
fn arc_height(length: f64, cosine: f64) -> f64 {
    0.5 * length * ((1.0 - cosine) / (1.0 + cosine)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certificate::{Certificate, CertificateOptions, Place, ViolationKind, certify};
    use crate::surfaces::Random;
    use crosscap_core::{Complex, Mesh};
    use std::f64::consts::TAU;

    #[test]
    fn heights_are_those_of_circles() {
        for angle in [0.1_f64, 0.7, 1.2, 1.57] {
            // of a circle of radius one a chord that meets it at this angle
            let (sin, cos) = angle.sin_cos();
            assert!((arc_height(2.0 * sin, cos) - (1.0 - cos)).abs() < 1e-12);
        }
    }

    /// Random points of a tube of radius one, one in every square of a third of it, and the verdict on a mesh of its
    /// places, given by height and turn.
    fn judged(vertices: &[[f64; 2]], triangles: Vec<[u32; 3]>) -> Certificate {
        let random = &mut Random::new(5);
        let place = |[z, turn]: [f64; 2]| [(TAU * turn).cos(), (TAU * turn).sin(), z];
        let count = (6.0 * TAU * 9.0) as usize;
        let rows = (0..count).flat_map(|_| place([random.between(-3.0, 3.0), random.uniform()]));
        let points = PointCloud::new(3, rows.collect()).unwrap();
        let places = vertices.iter().flat_map(|&v| place(v)).collect();
        let complex = Complex::new(vertices.len(), triangles, Vec::new()).unwrap();
        let places = PointCloud::new(3, places).unwrap();
        let mesh = Mesh::new(complex, places, vec![-1; vertices.len()]).unwrap();
        certify(
            &mesh,
            &CertificateOptions {
                points: Some(&points),
                landmark_separation: Some(0.8),
                ..CertificateOptions::default()
            },
        )
    }

    fn off(certificate: &Certificate) -> Vec<Place> {
        let all = certificate.violations();
        let off = all.filter(|v| v.kind == ViolationKind::MeshOffPoints);
        off.flat_map(|v| v.places.clone()).collect()
    }

    #[test]
    fn an_edge_through_a_tube_is_told_and_edges_along_it_are_not() {
        // around the tube in six steps, seven rings
        let vertices: Vec<[f64; 2]> = (0..42)
            .map(|k| [f64::from(k / 6) * 0.9 - 2.7, f64::from(k % 6) / 6.0])
            .collect();
        let quads = (0..36).map(|k| [k, k / 6 * 6 + (k + 1) % 6]);
        let sides = quads.flat_map(|[a, b]| [[a, b, a + 6], [b, b + 6, a + 6]]);
        let mut triangles: Vec<[u32; 3]> = sides.collect();
        assert_eq!(off(&judged(&vertices, triangles.clone())), []);
        // a wedge whose edge goes from side to side
        triangles.retain(|t| !t.contains(&19));
        triangles.extend([[18, 21, 20], [18, 21, 25]]);
        let found = off(&judged(&vertices, triangles));
        assert!(found.contains(&Place::Edge([18, 21])), "{found:?}");
    }
}
