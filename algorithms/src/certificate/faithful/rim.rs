//! Where the mesh ends far from every point: an edge of its boundary across the end of a slit, a tongue into a hole.
//!
//! For the largest empty disc the end of the mesh counts as a point, since a gap that the mesh leaves open is right. So the
//! end itself is asked whether it is where the points end.

use super::chance;
use super::discs::Gap;
use super::ground::COUNTED;
use super::search::{CHORD, Search};
use super::slope::{Expected, Hole};
use super::tiles::Shape;
use crate::balls::BallTree;
use crate::certificate::geometry::corners;
use crosscap_core::squared_distance;

/// Places of an edge of the boundary that are looked at.
const PLACES: u32 = 8;
/// Edges that are measured, those farthest from the points first.
const MEASURED: usize = 12;

/// The place of an edge of the boundary that is farthest from the points.
struct End {
    triangle: u32,
    place: Vec<f64>,
    /// Distance to the nearest point without the arc over the chord, unit of the data.
    away: f64,
    /// The same in spacings.
    spacings: f64,
}

impl Search<'_> {
    /// The least likely empty part of the mesh about a place of its boundary.
    pub(super) fn overhang(&self) -> Option<Gap> {
        let mut ends = Vec::new();
        let mut length = 0.0;
        for (e, &edge) in self.incidence.edges.iter().enumerate() {
            if let &[triangle] = self.incidence.at_edge(e) {
                let (end, own) = self.end(edge, triangle);
                ends.extend(end);
                length += own;
            }
        }
        ends.sort_by(|a, b| {
            b.spacings
                .total_cmp(&a.spacings)
                .then(a.triangle.cmp(&b.triangle))
        });
        ends.truncate(MEASURED);
        let gaps = ends.iter().map(|end| self.empty_about(end, length));
        gaps.min_by(|a, b| a.p.total_cmp(&b.p))
    }

    /// The place of an edge that is farthest from the points, and the length of the edge in spacings.
    fn end(&self, edge: [u32; 2], triangle: u32) -> (Option<End>, f64) {
        let density = edge.map(|v| self.ground.density[v as usize]);
        let [a, b] = edge.map(|v| self.mesh.vertices.point(v as usize));
        let scale = (0.5 * (density[0] + density[1])).sqrt();
        let length = squared_distance(a, b).sqrt();
        let mut best: Option<End> = None;
        for k in 0..PLACES {
            let share = (f64::from(k) + 0.5) / f64::from(PLACES);
            let place: Vec<f64> = a.iter().zip(b).map(|(x, y)| x + share * (y - x)).collect();
            let away = self.distances(&place).0 - CHORD * length;
            if away > 0.0 && away.is_finite() && best.as_ref().is_none_or(|b| away > b.away) {
                best = Some(End {
                    triangle,
                    place,
                    away,
                    spacings: away * scale,
                });
            }
        }
        (best, length * scale)
    }

    /// The mesh within that distance of the place as a gap, where the boundary is `length` spacings long.
    fn empty_about(&self, end: &End, length: f64) -> Gap {
        let square = end.away * end.away;
        let inside = |p: &[f64]| squared_distance(p, &end.place) < square;
        let fine = end.away / end.spacings;
        let found = if self.varies {
            let hole = Hole {
                tree: &BallTree::new(end.place.len(), &end.place),
                triangles: &[end.triangle],
                reach: end.away,
                spacing: fine,
                inside: &inside,
            };
            self.expected_in(&hole).unwrap_or(Expected::nothing(fine))
        } else {
            self.empty_of_one_density(end, fine, &inside)
        };
        let measure = chance::known(self.even.random(found.points), found.counted);
        Gap {
            width: 2.0 * end.away * found.density.sqrt(),
            size: 2.0 * end.away,
            expected: found.points,
            p: chance::disc(length.max(1.0), measure),
            together: 1,
            triangle: end.triangle,
            place: end.place.clone(),
            inner: Vec::new(),
            depth: 0.0,
        }
    }

    /// What is expected in the empty part of the mesh about an end where the density does not vary.
    fn empty_of_one_density(
        &self,
        end: &End,
        fine: f64,
        inside: &dyn Fn(&[f64]) -> bool,
    ) -> Expected {
        let width = self.mesh.vertices.dimension();
        let near = |t: u32| {
            let shape = Shape::new(corners(self.mesh, t));
            let mut middle = vec![0.0; width];
            shape.place([1.0 / 3.0; 3], &mut middle);
            squared_distance(&middle, &end.place).sqrt() < end.away + shape.radius
        };
        let region = self.grown(&[end.triangle], near);
        let empty: f64 = region.iter().map(|&t| self.part(t, fine, inside)).sum();
        let around = self.around(&[end.triangle], COUNTED, |p| !inside(p));
        Expected {
            points: empty * around.density(),
            density: around.density(),
            counted: around.points,
        }
    }
}
