//! Ends of curves that point at something the mesh does not join them to.
//!
//! That a curve is joined to a sheet is held against the points: a stretch without points that is no chance speaks against it. That a
//! curve ends before a sheet, or before another curve, is a statement as well. It would be wrong where chance has left out the
//! last points before a joint, so it is made only where that is too rare.

use super::arcs::Arc;
use super::beside::{Side, spacing};
use super::chance;
use super::evenness::Evenness;
use super::footprints::nearest_weights;
use super::search::Search;
use crate::certificate::geometry::corners;
use crosscap_core::PointCloud;
use serde::Serialize;

/// Cosine of the greatest angle between the curve at its end and the way to what it points at.
const AHEAD: f64 = 0.5;

/// An end of a curve with something ahead.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LooseEnd {
    /// The way to what is ahead, in mean spacings of the points along the curve.
    pub length: f64,
    /// The same, unit of the data.
    pub size: f64,
    /// Probability that chance leaves such a stretch before a joint.
    pub p: f64,
    /// The vertex.
    pub vertex: u32,
}

/// The ends of curves with something ahead, the likeliest joint first.
///
/// O(triangles) for every end.
pub(super) fn loose_ends(
    search: &Search<'_>,
    points: &PointCloud<f64>,
    arcs: &[Arc],
    even: &Evenness,
) -> Vec<LooseEnd> {
    let mut all = Vec::new();
    for arc in arcs.iter().filter(|arc| !arc.closed) {
        let count = arc.vertices.len();
        let sides = [
            ([arc.vertices[0], arc.vertices[1]], Side::after(&arc.feet)),
            (
                [arc.last(), arc.vertices[count - 2]],
                Side::before(&arc.feet),
            ),
        ];
        for ((edge, side), _) in sides.into_iter().zip(arc.joined).filter(|end| !end.1) {
            let found = spacing(&[side]).zip(Heading::of(search, points, edge).ahead(search));
            if let Some(((spacing, counted), size)) = found {
                let length = size / spacing;
                all.push((
                    chance::known(even.random(length), counted),
                    length,
                    size,
                    edge[0],
                ));
            }
        }
    }
    let tried = 2.0 * all.len() as f64;
    let told = |(measure, length, size, vertex): (f64, f64, f64, u32)| LooseEnd {
        length,
        size,
        p: (tried * (-measure).exp()).min(1.0),
        vertex,
    };
    let mut all: Vec<LooseEnd> = all.into_iter().map(told).collect();
    all.sort_by(|a, b| b.p.total_cmp(&a.p).then(a.vertex.cmp(&b.vertex)));
    all
}

/// Where a curve ends, and where it would go on.
struct Heading {
    from: Vec<f64>,
    direction: Vec<f64>,
}

impl Heading {
    /// That of the edge of a curve from its end on; it begins at the last of the points, which may be beyond the vertex.
    fn of(search: &Search<'_>, points: &PointCloud<f64>, [end, before]: [u32; 2]) -> Self {
        let [end, before] = [end, before].map(|v| search.mesh.vertices.point(v as usize));
        let along: Vec<f64> = end.iter().zip(before).map(|(x, y)| x - y).collect();
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let direction: Vec<f64> = along.iter().map(|x| x / length).collect();
        let first = search.mesh.complex.triangles.len() as u32;
        let mut beyond = 0.0_f64;
        for (k, &item) in search.feet.items.iter().enumerate() {
            if item >= first && item < u32::MAX && search.feet.place(k) == end {
                let point = points.point(search.feet.rows[k] as usize);
                beyond = beyond.max(dot(&direction, point, end));
            }
        }
        let from = end.iter().zip(&direction).map(|(x, d)| x + beyond * d);
        Self {
            from: from.collect(),
            direction,
        }
    }

    /// How far it is to the nearest part of the mesh ahead.
    fn ahead(&self, search: &Search<'_>) -> Option<f64> {
        let mesh = search.mesh;
        let triangles = (0..mesh.complex.triangles.len() as u32).map(|t| corners(mesh, t));
        let bare = search.incidence.bare_edges();
        let edges = bare
            .iter()
            .map(|&[a, b]| [a, b, b].map(|v| mesh.vertices.point(v as usize)));
        let ways = triangles.chain(edges).filter_map(|sides| self.way(sides));
        ways.min_by(f64::total_cmp)
    }

    /// How far along its direction the nearest place of a triangle is, where it is ahead.
    fn way(&self, sides: [&[f64]; 3]) -> Option<f64> {
        let weights = nearest_weights(&self.from, sides);
        let place: Vec<f64> = (0..self.from.len())
            .map(|k| (0..3).map(|i| weights[i] * sides[i][k]).sum())
            .collect();
        let away = crosscap_core::squared_distance(&place, &self.from).sqrt();
        let cosine = dot(&self.direction, &place, &self.from) / away;
        (cosine > AHEAD).then(|| away / cosine)
    }
}

/// How far along a direction a place is, seen from another one.
fn dot(direction: &[f64], place: &[f64], from: &[f64]) -> f64 {
    let steps = place.iter().zip(from).map(|(x, y)| x - y);
    steps.zip(direction).map(|(x, d)| x * d).sum()
}
