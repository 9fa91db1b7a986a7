//! The sheets about a vertex, each with its points.

use super::standing::Standing;
use crate::certificate::incidence::Incidence;
use crosscap_core::Mesh;

/// No triangle.
const NONE: u32 = u32::MAX;
/// Points of a sheet that are enough to fit it.
const ENOUGH: usize = 48;
/// Most layers of triangles that are gathered for them.
const LAYERS: usize = 8;

/// Triangles over ordinary edges, and points of triangles.
pub(super) struct Wings<'a> {
    mesh: &'a Mesh,
    incidence: &'a Incidence,
    /// For every side of a triangle (opposite corner k) the triangle beyond, where that is one sheet.
    beyond: Vec<[u32; 3]>,
    standing: &'a Standing,
    seen: Vec<u32>,
    round: u32,
}

impl<'a> Wings<'a> {
    pub fn new(mesh: &'a Mesh, incidence: &'a Incidence, standing: &'a Standing) -> Self {
        let count = mesh.complex.triangles.len();
        let mut beyond = vec![[NONE; 3]; count];
        for (e, ends) in incidence.edges.iter().enumerate() {
            if let (None, &[s, t]) = (incidence.cells[e], incidence.at_edge(e)) {
                for (own, other) in [(s, t), (t, s)] {
                    let corners = mesh.complex.triangles[own as usize];
                    for (beyond, corner) in beyond[own as usize].iter_mut().zip(corners) {
                        if !ends.contains(&corner) {
                            *beyond = other;
                        }
                    }
                }
            }
        }
        Self {
            mesh,
            incidence,
            beyond,
            standing,
            seen: vec![0; count],
            round: 0,
        }
    }

    /// Calls `each` for every sheet at a vertex with the indices of the footprints about it, as many layers of triangles
    /// as hold enough of them.
    pub fn at(&mut self, vertex: u32, mut each: impl FnMut(&[u32])) {
        let (mut layer, mut next, mut points) = (Vec::new(), Vec::new(), Vec::new());
        self.round += 1;
        for &first in self.incidence.at_vertex(vertex as usize) {
            if self.seen[first as usize] == self.round {
                continue;
            }
            // the part of the star that hangs together over ordinary edges at the vertex
            layer.clear();
            layer.push(first);
            self.seen[first as usize] = self.round;
            let mut k = 0;
            while k < layer.len() {
                let t = layer[k] as usize;
                for side in 0..3 {
                    let other = self.beyond[t][side];
                    let own = self.mesh.complex.triangles[t][side] != vertex;
                    if own && other != NONE && self.seen[other as usize] != self.round {
                        self.seen[other as usize] = self.round;
                        layer.push(other);
                    }
                }
                k += 1;
            }
            points.clear();
            for _ in 0..LAYERS {
                for &t in &layer {
                    points.extend_from_slice(self.standing.on(t));
                }
                if points.len() >= ENOUGH || layer.is_empty() {
                    break;
                }
                next.clear();
                for &t in &layer {
                    for other in self.beyond[t as usize] {
                        if other != NONE && self.seen[other as usize] != self.round {
                            self.seen[other as usize] = self.round;
                            next.push(other);
                        }
                    }
                }
                std::mem::swap(&mut layer, &mut next);
            }
            each(&points);
        }
    }
}
