//! Stretches of curves without points: a curve in two, and a curve that ends before what the mesh joins it to.

use super::beside::{Side, spacing};
use super::chance;
use super::evenness::Evenness;
use super::footprints::Footprints;
use crate::certificate::incidence::Incidence;
use crosscap_core::{Mesh, squared_distance};
use serde::Serialize;
use std::collections::BTreeMap;

/// A curve is joined to a sheet or to other curves in few places, and each says more than a place along it: a stretch
/// without points there is no chance at this multiple of the significance.
const JOINTS: f64 = 10.0;

/// A stretch of a curve that the mesh has and the points have not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stretch {
    /// Its length, in mean spacings of the points along the curve.
    pub length: f64,
    /// The same, unit of the data.
    pub size: f64,
    /// Whether it is where the curve meets a sheet or other curves.
    pub joint: bool,
    /// Probability that chance leaves such a stretch anywhere in a sample like this one.
    pub p: f64,
    /// Edge of the mesh in its middle.
    pub edge: [u32; 2],
    /// Its middle.
    pub place: Vec<f64>,
}

impl Stretch {
    /// The probability below which chance is no explanation, where it is `significance` for everything else.
    pub(super) fn limit(&self, significance: f64) -> f64 {
        if self.joint {
            JOINTS * significance
        } else {
            significance
        }
    }
}

/// A curve of the mesh from one end, or one place where more meets, to the next.
pub(super) struct Arc {
    /// Its vertices in order; the first is the last of a loop.
    pub vertices: Vec<u32>,
    /// How far along every vertex is.
    along: Vec<f64>,
    /// Where the points are along it, increasing.
    pub feet: Vec<f64>,
    /// Whether more is at the first and the last vertex.
    pub joined: [bool; 2],
    /// Whether it is a loop that nothing else is at.
    pub closed: bool,
}

/// All stretches between points of the curves without triangles, the least likely first.
///
/// O(p log p) for p points on curves.
pub(super) fn stretches(mesh: &Mesh, arcs: &[Arc], even: &Evenness) -> Vec<Stretch> {
    let points: usize = arcs.iter().map(|arc| arc.feet.len()).sum();
    let joints = arcs
        .iter()
        .flat_map(|arc| arc.joined)
        .filter(|&j| j)
        .count();
    let mut all = Vec::new();
    for arc in arcs {
        for k in 0..=arc.feet.len() {
            let Some((from, to, joint)) = arc.between(k) else {
                continue;
            };
            let Some((spacing, counted)) = spacing(&arc.sides(k, arcs)) else {
                continue;
            };
            let length = (to - from) / spacing;
            let measure = chance::known(even.random(length), counted);
            let tried = if joint { joints } else { points } as f64;
            let (edge, place) = arc.at(mesh, 0.5 * (from + to));
            all.push(Stretch {
                length,
                size: to - from,
                joint,
                p: (2.0 * tried * (-measure).exp()).min(1.0),
                edge,
                place,
            });
        }
    }
    let rank = |s: &Stretch| s.p / s.limit(1.0);
    all.sort_by(|a, b| rank(a).total_cmp(&rank(b)).then(a.edge.cmp(&b.edge)));
    all
}

/// How even the points along the curves are: the spacings of a random sample have an exponential law, as the empty discs of a
/// surface.
pub(super) fn evenness(arcs: &[Arc]) -> Evenness {
    let mut lengths = Vec::new();
    for arc in arcs {
        for k in 1..arc.feet.len() {
            if let Some((spacing, _)) = spacing(&arc.sides(k, arcs)) {
                lengths.push((arc.feet[k] - arc.feet[k - 1]) / spacing);
            }
        }
    }
    let points = lengths.len();
    Evenness::of(lengths, points, 1.0)
}

impl Arc {
    fn at_vertex(start: u32) -> Self {
        Self {
            vertices: vec![start],
            along: vec![0.0],
            feet: Vec::new(),
            joined: [false; 2],
            closed: false,
        }
    }

    pub fn last(&self) -> u32 {
        self.vertices[self.vertices.len() - 1]
    }

    /// Goes on over an edge at its last vertex, to the one that is returned.
    fn extend(&mut self, mesh: &Mesh, [a, b]: [u32; 2]) -> u32 {
        let next = if a == self.last() { b } else { a };
        let length = mesh
            .vertices
            .squared_distance(a as usize, b as usize)
            .sqrt();
        self.along.push(self.along[self.along.len() - 1] + length);
        self.vertices.push(next);
        next
    }

    /// Puts points on its last edge.
    fn stand(&mut self, mesh: &Mesh, feet: &Footprints, on: &[usize]) {
        let k = self.vertices.len() - 2;
        let from = mesh.vertices.point(self.vertices[k] as usize);
        let away = |&foot: &usize| squared_distance(feet.place(foot), from).sqrt();
        self.feet
            .extend(on.iter().map(|foot| self.along[k] + away(foot)));
    }

    /// The stretch before foot number `k`, and whether it is at a joint; none beyond a free end.
    fn between(&self, k: usize) -> Option<(f64, f64, bool)> {
        let whole = *self.along.last()?;
        let before = k.checked_sub(1).map(|k| self.feet[k]);
        match (before, self.feet.get(k).copied()) {
            (Some(from), Some(to)) => Some((from, to, false)),
            // around a loop, from its last point to its first
            (None, Some(to)) if self.closed => {
                Some((self.feet[self.feet.len() - 1] - whole, to, false))
            }
            (None, Some(to)) => self.joined[0].then_some((0.0, to, true)),
            (Some(from), None) => self.joined[1].then_some((from, whole, true)),
            (None, None) => None,
        }
    }

    /// The points on both sides of the stretch before foot number `k`; beyond a joint those of the other curves there.
    fn sides<'a>(&'a self, k: usize, arcs: &'a [Self]) -> Vec<Side<'a>> {
        let (before, after) = self.feet.split_at(k);
        let mut sides = vec![Side::before(before), Side::after(after)];
        let joint = if k == 0 && self.joined[0] {
            self.vertices[0]
        } else if k == self.feet.len() && self.joined[1] {
            self.last()
        } else {
            return sides;
        };
        for arc in arcs.iter().filter(|arc| !std::ptr::eq(*arc, self)) {
            if arc.vertices[0] == joint {
                sides.push(Side::after(&arc.feet));
            }
            if arc.last() == joint {
                sides.push(Side::before(&arc.feet));
            }
        }
        sides
    }

    /// Leaves out the points beyond an end that nothing is joined to, but one: they all stand at the end, and how far
    /// from each other they are is not known.
    fn trim(&mut self) {
        let (low, high) = (0.0, self.along[self.along.len() - 1]);
        if !self.joined[0] {
            let beyond = self.feet.partition_point(|&x| x <= low);
            self.feet.drain(..beyond.saturating_sub(1));
        }
        if !self.joined[1] {
            let within = self.feet.partition_point(|&x| x < high);
            self.feet.truncate(within + 1);
        }
    }

    /// Edge and place so far along; before the start of a loop is its end.
    fn at(&self, mesh: &Mesh, along: f64) -> ([u32; 2], Vec<f64>) {
        let whole = self.along[self.along.len() - 1];
        let along = if along < 0.0 { along + whole } else { along };
        let k = self.along.partition_point(|&x| x <= along);
        let k = k.clamp(1, self.along.len() - 1);
        let (a, b) = (self.vertices[k - 1], self.vertices[k]);
        let length = self.along[k] - self.along[k - 1];
        let share = if length > 0.0 {
            (along - self.along[k - 1]) / length
        } else {
            0.0
        };
        let [from, to] = [a, b].map(|v| mesh.vertices.point(v as usize));
        let place = from
            .iter()
            .zip(to)
            .map(|(x, y)| x + share * (y - x))
            .collect();
        ([a.min(b), a.max(b)], place)
    }
}

/// The edges without triangles as arcs, each with the points that stand on it.
pub(super) fn arcs(mesh: &Mesh, incidence: &Incidence, feet: &Footprints) -> Vec<Arc> {
    let bare = incidence.bare_edges();
    let mut at_vertex: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (k, ends) in bare.iter().enumerate() {
        for v in ends {
            at_vertex.entry(*v).or_default().push(k as u32);
        }
    }
    let first = mesh.complex.triangles.len();
    let mut on = vec![Vec::new(); bare.len()];
    for (k, &item) in feet.items.iter().enumerate() {
        let edge = (item as usize).checked_sub(first);
        if let Some(on) = edge.and_then(|e| on.get_mut(e)) {
            on.push(k);
        }
    }
    let alone = |v: u32| incidence.at_vertex(v as usize).is_empty();
    let inner = |v: u32| at_vertex[&v].len() == 2 && alone(v);
    let mut seen = vec![false; bare.len()];
    let mut arcs = Vec::new();
    // from the ends first; what is left are loops
    let ends = at_vertex.keys().copied().filter(|&v| !inner(v));
    for start in ends.chain(at_vertex.keys().copied()) {
        for &edge in &at_vertex[&start] {
            let mut arc = Arc::at_vertex(start);
            let mut next = Some(edge);
            while let Some(e) = next.filter(|&e| !std::mem::replace(&mut seen[e as usize], true)) {
                let v = arc.extend(mesh, bare[e as usize]);
                arc.stand(mesh, feet, &on[e as usize]);
                let others = at_vertex[&v].iter().copied();
                next = others.filter(|_| inner(v)).find(|&other| other != e);
            }
            if arc.vertices.len() > 1 {
                arc.feet.sort_unstable_by(f64::total_cmp);
                let ends = [start, arc.last()];
                arc.closed = inner(start);
                arc.joined = ends.map(|v| at_vertex[&v].len() > 1 && !inner(v) || !alone(v));
                if !arc.closed {
                    arc.trim();
                }
                arcs.push(arc);
            }
        }
    }
    arcs
}
