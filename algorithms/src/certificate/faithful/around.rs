//! Parts of the mesh about an empty region, and the points on them.

use super::ground::Count;
use super::search::Search;
use super::tiles::{Cut, Shape, TILE};
use crate::certificate::geometry::corners;
use std::collections::BTreeSet;

impl Search<'_> {
    /// Area of the part of a triangle that is `inside`.
    pub(super) fn part(
        &self,
        t: u32,
        spacing: f64,
        inside: &(impl Fn(&[f64]) -> bool + ?Sized),
    ) -> f64 {
        let shape = Shape::new(corners(self.mesh, t));
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let (mut area, finest) = (0.0, self.finest());
        shape.cut(&mut place, &mut |tile, place| {
            let scale = tile.scale();
            if scale > finest && shape.longest * scale > TILE * spacing {
                return Cut::Further;
            }
            if inside(place) {
                area += self.ground.areas[t as usize] * scale * scale;
            }
            Cut::Leave
        });
        area
    }

    /// Triangles connected with `from` over those that are `near`.
    pub(super) fn grown(&self, from: &[u32], mut near: impl FnMut(u32) -> bool) -> Vec<u32> {
        let mut seen: BTreeSet<u32> = from.iter().copied().collect();
        let mut all: Vec<u32> = seen.iter().copied().collect();
        let mut k = 0;
        while k < all.len() {
            for v in self.mesh.complex.triangles[all[k] as usize] {
                for &t in self.incidence.at_vertex(v as usize) {
                    if seen.insert(t) && near(t) {
                        all.push(t);
                    }
                }
            }
            k += 1;
        }
        all
    }

    /// Area and points of rings about triangles that hold twice as many points as are `wanted`, where `counts` holds, for a density that
    /// does not vary: rings that are denser by chance would be taken for another density.
    pub(super) fn around(
        &self,
        from: &[u32],
        wanted: f64,
        counts: impl Fn(&[f64]) -> bool,
    ) -> Count {
        let mut seen: BTreeSet<u32> = from.iter().copied().collect();
        let mut ring: Vec<u32> = seen.iter().copied().collect();
        let mut all = Count::default();
        while !ring.is_empty() {
            let mut own = Count::default();
            for &t in &ring {
                let corner = self.mesh.complex.triangles[t as usize];
                let density = self.ground.density_at(corner, [1.0 / 3.0; 3]);
                own.points += f64::from(self.ground.counts[t as usize]);
                own.ground += self.part(t, 1.0 / density.sqrt(), &counts);
            }
            if !all.take(own, f64::INFINITY, 2.0 * wanted) || all.points >= 2.0 * wanted {
                break;
            }
            let mut next = Vec::new();
            for &t in &ring {
                for v in self.mesh.complex.triangles[t as usize] {
                    let at = self.incidence.at_vertex(v as usize);
                    next.extend(at.iter().filter(|&&t| seen.insert(t)));
                }
            }
            ring = next;
        }
        all
    }
}
