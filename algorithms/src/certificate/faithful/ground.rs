//! How dense the points stand on every part of the mesh.

use super::footprints::Footprints;
use crate::certificate::geometry::{area, corners};
use crate::certificate::incidence::Incidence;
use crosscap_core::Mesh;

/// Points that a density is counted from, where it varies little. Its relative error is then about
/// 1 / sqrt(64); with fewer, that error makes chance gaps look unlikely.
pub(super) const COUNTED: f64 = 64.0;
/// Points that are counted about a vertex in any case.
pub(super) const LEAST_COUNTED: f64 = 12.0;
/// Standard errors by which a ring may be denser than what it goes round; a ring denser than that is another
/// density. One that is thinner is taken in: gaps are then thought likely rather than unlikely.
const DENSER: f64 = 1.25;

/// Area and points of growing rings.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Count {
    pub ground: f64,
    pub points: f64,
}

impl Count {
    /// Takes a ring in, or says that it must not: when it is another density and there are `least` points, or
    /// there are as many as `wanted`.
    pub fn take(&mut self, ring: Self, least: f64, wanted: f64) -> bool {
        if self.points >= wanted {
            return false;
        }
        if self.points >= least && ring.ground > 0.0 {
            let (inside, outside) = (self.points / self.ground, ring.points / ring.ground);
            let pooled = (self.points + ring.points) / (self.ground + ring.ground);
            let error =
                pooled * (1.0 / (pooled * self.ground) + 1.0 / (pooled * ring.ground)).sqrt();
            if outside > inside + DENSER * error {
                return false;
            }
        }
        self.ground += ring.ground;
        self.points += ring.points;
        true
    }

    /// Points a unit of area; zero where there are none.
    pub fn density(&self) -> f64 {
        if self.ground > 0.0 {
            self.points / self.ground
        } else {
            0.0
        }
    }
}

/// Area, points and density of points by place.
pub(in crate::certificate) struct Ground {
    /// Area of every triangle.
    pub areas: Vec<f64>,
    /// Points that stand on every triangle, those on the boundary of the mesh left out.
    pub counts: Vec<u32>,
    /// Points a unit of area about every vertex; zero where there are none far and wide.
    pub density: Vec<f64>,
}

impl Ground {
    /// Counts the points of the triangles, and those of rings of triangles about every vertex, as many
    /// rings as hold enough. O(rings) for every vertex.
    pub fn new(mesh: &Mesh, incidence: &Incidence, feet: &Footprints) -> Self {
        let triangles = &mesh.complex.triangles;
        let areas: Vec<f64> = (0..triangles.len() as u32)
            .map(|t| area(corners(mesh, t)))
            .collect();
        let mut counts = vec![0_u32; triangles.len()];
        for (&item, &beyond) in feet.items.iter().zip(&feet.on_boundary) {
            if (item as usize) < triangles.len() && !beyond {
                counts[item as usize] += 1;
            }
        }
        let mut rings = Rings::new(mesh.complex.vertices, triangles.len());
        let mut density = Vec::with_capacity(mesh.complex.vertices);
        for v in 0..mesh.complex.vertices as u32 {
            rings.start(v);
            let mut count = Count::default();
            let mut from = 0;
            while rings.grow(mesh, incidence) {
                let mut ring = Count::default();
                for &t in &rings.triangles[from..] {
                    ring.points += f64::from(counts[t as usize]);
                    ring.ground += areas[t as usize];
                }
                from = rings.triangles.len();
                if !count.take(ring, LEAST_COUNTED, COUNTED) || count.points >= COUNTED {
                    break;
                }
            }
            density.push(count.density());
        }
        Self {
            areas,
            counts,
            density,
        }
    }

    /// Points a unit of area at a place of a triangle, between the values of its corners.
    pub fn density_at(&self, corners: [u32; 3], weights: [f64; 3]) -> f64 {
        (0..3)
            .map(|k| weights[k] * self.density[corners[k] as usize])
            .sum()
    }

    /// Expected number of points of a triangle.
    pub fn expected(&self, mesh: &Mesh, t: u32) -> f64 {
        self.areas[t as usize] * self.density_at(mesh.complex.triangles[t as usize], [1.0 / 3.0; 3])
    }
}

/// Rings of triangles about a vertex, across all edges.
pub(in crate::certificate) struct Rings {
    /// The triangles so far, ring by ring.
    pub triangles: Vec<u32>,
    front: Vec<u32>,
    seen_vertex: Vec<u32>,
    seen_triangle: Vec<u32>,
    round: u32,
}

impl Rings {
    /// Buffers for a mesh of that size.
    pub fn new(vertices: usize, triangles: usize) -> Self {
        Self {
            triangles: Vec::new(),
            front: Vec::new(),
            seen_vertex: vec![0; vertices],
            seen_triangle: vec![0; triangles],
            round: 0,
        }
    }

    /// Begins anew, at a vertex and without triangles.
    pub fn start(&mut self, vertex: u32) {
        self.round += 1;
        self.triangles.clear();
        self.front.clear();
        self.front.push(vertex);
        self.seen_vertex[vertex as usize] = self.round;
    }

    /// Adds the next ring; `false` when nothing is left.
    pub fn grow(&mut self, mesh: &Mesh, incidence: &Incidence) -> bool {
        let before = self.triangles.len();
        for v in std::mem::take(&mut self.front) {
            for &t in incidence.at_vertex(v as usize) {
                if self.seen_triangle[t as usize] != self.round {
                    self.seen_triangle[t as usize] = self.round;
                    self.triangles.push(t);
                }
            }
        }
        for &t in &self.triangles[before..] {
            for v in mesh.complex.triangles[t as usize] {
                if self.seen_vertex[v as usize] != self.round {
                    self.seen_vertex[v as usize] = self.round;
                    self.front.push(v);
                }
            }
        }
        self.triangles.len() > before
    }
}
