//! The sheets about a vertex, each with its points.

use super::footprints::Footprints;
use crate::certificate::incidence::Incidence;
use crosscap_core::Mesh;

/// No triangle.
const NONE: u32 = u32::MAX;
/// Points of a sheet that are enough to fit it.
const ENOUGH: usize = 48;
/// Most layers of triangles that are gathered for them.
const LAYERS: usize = 8;
/// Cosine of the greatest angle between two triangles of one sheet. Where a mesh turns by more, at a sharp edge, its two
/// faces lie over each other without being one; a mesh that goes up and down between two sheets, which are nearer
/// to each other than its edges are long, turns by less than 70 degrees.
const TURN: f64 = 0.26;

/// Triangles over ordinary edges, and points of triangles.
pub(super) struct Wings<'a> {
    mesh: &'a Mesh,
    incidence: &'a Incidence,
    /// For every side of a triangle (opposite corner k) the triangle beyond, where that is one sheet.
    beyond: Vec<[u32; 3]>,
    starts: Vec<u32>,
    /// Which footprints are on which triangle.
    feet: Vec<u32>,
    seen: Vec<u32>,
    round: u32,
    /// The corners of the triangles of the sheet that is gathered, all in the same sense.
    sheet: Vec<[u32; 3]>,
}

impl<'a> Wings<'a> {
    pub fn new(mesh: &'a Mesh, incidence: &'a Incidence, feet: &Footprints) -> Self {
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
        let mut starts = vec![0_u32; count + 1];
        let on = |item: u32| (item as usize) < count;
        for &item in feet.items.iter().filter(|&&i| on(i)) {
            starts[item as usize + 1] += 1;
        }
        for t in 0..count {
            starts[t + 1] += starts[t];
        }
        let mut fill = starts.clone();
        let mut order = vec![0; starts[count] as usize];
        for (k, &item) in feet.items.iter().enumerate().filter(|i| on(*i.1)) {
            order[fill[item as usize] as usize] = k as u32;
            fill[item as usize] += 1;
        }
        Self {
            mesh,
            incidence,
            beyond,
            starts,
            feet: order,
            seen: vec![0; count],
            round: 0,
            sheet: Vec::new(),
        }
    }

    /// Calls `each` for every sheet at a vertex with the indices of the footprints about it, as many layers of triangles
    /// as hold enough of them. A sheet does not go around a sharp edge.
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
            self.sheet.clear();
            self.sheet.push(self.mesh.complex.triangles[first as usize]);
            let mut base = 0;
            self.seen[first as usize] = self.round;
            let mut k = 0;
            while k < layer.len() {
                let t = layer[k];
                for side in 0..3 {
                    let own = self.mesh.complex.triangles[t as usize][side] != vertex;
                    if own && self.takes(k, t, side) {
                        layer.push(self.beyond[t as usize][side]);
                    }
                }
                k += 1;
            }
            points.clear();
            for _ in 0..LAYERS {
                for &t in &layer {
                    let t = t as usize;
                    let range = self.starts[t] as usize..self.starts[t + 1] as usize;
                    points.extend_from_slice(&self.feet[range]);
                }
                if points.len() >= ENOUGH || layer.is_empty() {
                    break;
                }
                next.clear();
                for (k, &t) in layer.iter().enumerate() {
                    for side in 0..3 {
                        if self.takes(base + k, t, side) {
                            next.push(self.beyond[t as usize][side]);
                        }
                    }
                }
                base += layer.len();
                std::mem::swap(&mut layer, &mut next);
            }
            each(&points);
        }
    }

    /// Takes the triangle beyond a side of another one into the sheet, if it is in none and turns against no triangle of
    /// it; `place` is that of the other one in the sheet.
    fn takes(&mut self, place: usize, t: u32, side: usize) -> bool {
        let other = self.beyond[t as usize][side];
        if other == NONE || self.seen[other as usize] == self.round {
            return false;
        }
        let triangles = &self.mesh.complex.triangles;
        let opposite = triangles[t as usize][side];
        let known = self.sheet[place];
        // The shared side in the sense of the sheet, and the corner beyond it.
        let at = (0..3).find(|&k| known[k] == opposite).unwrap_or(0);
        let [p, q] = [known[(at + 1) % 3], known[(at + 2) % 3]];
        let mut beyond = triangles[other as usize]
            .into_iter()
            .filter(|&v| v != p && v != q);
        let Some(r) = beyond.next() else {
            return false;
        };
        let new = [q, p, r];
        if self.sheet.iter().any(|&old| self.turns(old, new)) {
            return false;
        }
        self.seen[other as usize] = self.round;
        self.sheet.push(new);
        true
    }

    /// Whether two triangles with corners in the same sense turn against each other by more than those of one
    /// sheet, by the inner product of their bivectors; not for triangles without area.
    fn turns(&self, old: [u32; 3], new: [u32; 3]) -> bool {
        let corner = |v: u32| self.mesh.vertices.point(v as usize);
        let inner = |s: [u32; 3], t: [u32; 3]| {
            let [a, b, c] = s.map(corner);
            let [d, e, f] = t.map(corner);
            let (mut uw, mut ux, mut vw, mut vx) = (0.0, 0.0, 0.0, 0.0);
            for k in 0..a.len() {
                let (u, v) = (b[k] - a[k], c[k] - a[k]);
                let (w, x) = (e[k] - d[k], f[k] - d[k]);
                uw += u * w;
                ux += u * x;
                vw += v * w;
                vx += v * x;
            }
            uw * vx - ux * vw
        };
        inner(old, new) < TURN * (inner(old, old) * inner(new, new)).sqrt()
    }
}
