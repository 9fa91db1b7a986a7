//! From the mesh to the points: is there one near every place, and does the surface go through them.

use super::chords::Chords;
use super::distance::Products;
use super::faithful::Search;
use super::geometry::corners;
use super::mesh_places::{shares, steps, weights};
use super::{CertificateOptions, Place, within};
use crate::balls::BallTree;
use crosscap_core::{Mesh, PointCloud};

/// A mesh beside its points.
pub(super) struct MeshCover<'c> {
    pub mesh: &'c Mesh,
    pub points: &'c PointCloud<f64>,
    pub search: &'c Search<'c>,
    pub options: &'c CertificateOptions<'c>,
    /// The landmark separation, unit of the data.
    pub separation: f64,
    /// The points.
    pub cloud: BallTree,
}

/// Places that are farther from the points than they may be.
pub(super) struct Far {
    pub places: Vec<Place>,
    /// All distances, in dl.
    pub values: Vec<f64>,
    /// Distance and limit of the place that is furthest beyond its limit.
    pub worst: [f64; 2],
}

impl Far {
    /// Takes a distance; whether it is beyond its limit.
    fn is_beyond(&mut self, distance: f64, limit: f64) -> bool {
        let [worst, allowed] = self.worst;
        if allowed == f64::INFINITY || distance - limit > worst - allowed {
            self.worst = [distance, limit];
        }
        self.values.push(distance);
        !within(distance, limit)
    }
}

/// Places that the points pass by at a height.
#[derive(Default)]
pub(super) struct Off {
    pub places: Vec<Place>,
    /// Heights in dl.
    pub values: Vec<f64>,
}

impl MeshCover<'_> {
    /// What is far from the points, and what they pass by. `bare` are the edges without a triangle.
    pub fn measured(&self, bare: &[[u32; 2]]) -> (Far, Off) {
        let mut far = Far {
            places: Vec::new(),
            values: Vec::new(),
            worst: [0.0, f64::INFINITY],
        };
        let mut off = Off::default();
        self.vertices(&mut far);
        self.bare_edges(bare, &mut far);
        self.triangles(&mut far, &mut off);
        self.chords(&mut off);
        (far, off)
    }

    /// Height in dl above which the points pass a place by.
    pub fn off_limit(&self, dl: f64) -> f64 {
        self.options.limits.off_plane + 4.0 * self.options.noise / dl
    }

    fn nearest(&self, place: &[f64]) -> Option<(u32, f64)> {
        self.cloud.nearest(place, |_| true)
    }

    /// The landmark separation at a place of the mesh: that of the input point nearest to it.
    fn separation_near(&self, place: &[f64]) -> f64 {
        match self.options.separation_scale {
            None => self.separation,
            Some(_) => self.nearest(place).map_or(self.separation, |n| {
                self.options.separation_at(n.0 as usize, self.separation)
            }),
        }
    }

    /// The largest distance in dl of a place where gaps of that radius are likely.
    fn limit(&self, gap: f64, dl: f64) -> f64 {
        self.options.limits.mesh_to_points + 4.0 * self.options.noise / dl + gap / dl
    }

    fn vertices(&self, far: &mut Far) {
        for v in 0..self.mesh.complex.vertices {
            let place = self.mesh.vertices.point(v);
            let dl = self.separation_near(place);
            let d = self.nearest(place).map_or(0.0, |n| n.1.sqrt() / dl);
            if far.is_beyond(d, self.limit(self.search.gap_at_vertex(v as u32), dl)) {
                far.places.push(Place::Vertex(v as u32));
            }
        }
    }

    fn bare_edges(&self, bare: &[[u32; 2]], far: &mut Far) {
        let gap = self.search.curve_gap(bare);
        let mut place = vec![0.0; self.points.dimension()];
        for &ends in bare {
            let [p, q] = ends.map(|v| self.mesh.vertices.point(v as usize));
            let dl = self.separation_near(p);
            let mut is_far = false;
            for t in shares(steps([p, q, q], dl)) {
                for (x, (p, q)) in place.iter_mut().zip(p.iter().zip(q)) {
                    *x = p * (1.0 - t) + q * t;
                }
                let d = self.nearest(&place).map_or(0.0, |n| n.1.sqrt() / dl);
                is_far |= far.is_beyond(d, self.limit(gap, dl));
            }
            if is_far {
                far.places.push(Place::Edge(ends));
            }
        }
    }

    fn triangles(&self, far: &mut Far, off: &mut Off) {
        let mut place = vec![0.0; self.points.dimension()];
        for t in 0..self.mesh.complex.triangles.len() as u32 {
            let c = corners(self.mesh, t);
            let dl = self.separation_near(c[0]);
            let limit = self.limit(self.search.gap_at(t), dl);
            let mut is_far = false;
            let mut highest = 0.0_f64;
            for (weights, inner) in weights(steps(c, dl)) {
                for (k, x) in place.iter_mut().enumerate() {
                    *x = weights[0] * c[0][k] + weights[1] * c[1][k] + weights[2] * c[2][k];
                }
                let Some((q, d)) = self.nearest(&place) else {
                    continue;
                };
                is_far |= far.is_beyond(d.sqrt() / dl, limit);
                if inner {
                    let height = off_plane(self.points.point(q as usize), &place, c) / dl;
                    highest = highest.max(height);
                    off.values.push(height);
                }
            }
            if is_far {
                far.places.push(Place::Triangle(t));
            }
            if !within(highest, self.off_limit(dl)) {
                off.places.push(Place::Triangle(t));
            }
        }
    }

    /// Edges that the points are beyond a gap from, where the surface goes another way.
    fn chords(&self, off: &mut Off) {
        let chords = Chords {
            search: self.search,
            points: self.points,
            cloud: &self.cloud,
        };
        let incidence = &self.search.incidence;
        let mut place = vec![0.0; self.points.dimension()];
        for (e, &ends) in incidence.edges.iter().enumerate() {
            if incidence.at_edge(e).len() < 2 {
                continue;
            }
            let [a, b] = ends.map(|v| self.mesh.vertices.point(v as usize));
            (place.iter_mut().zip(a.iter().zip(b))).for_each(|(x, (p, q))| *x = 0.5 * (p + q));
            let beyond = ends.map(|v| self.search.gap_at_vertex(v));
            let away = self.nearest(&place).map_or(0.0, |n| n.1.sqrt());
            if away <= beyond[0].max(beyond[1]) + 4.0 * self.options.noise {
                continue;
            }
            let dl = self.separation_near(a);
            let height = chords.height(ends).map_or(0.0, |height| height / dl);
            if !within(height, self.off_limit(dl)) {
                off.places.push(Place::Edge(ends));
                off.values.push(height);
            }
        }
    }
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
    fn height_over_a_plane() {
        let t: [&[f64]; 3] = [&[0., 0., 0.], &[2., 0., 0.], &[0., 2., 0.]];
        assert!((off_plane(&[7., 3., 0.5], &[0.5, 0.5, 0.], t) - 0.5).abs() < 1e-12);
    }
}
