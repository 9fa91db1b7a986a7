//! Curves without triangles that turn back on themselves.

use super::incidence::Incidence;
use super::{Place, Violation, ViolationKind};
use crosscap_core::Mesh;
use std::collections::BTreeMap;

/// The smallest angle between two edges of a curve at a vertex where nothing else is, degrees, and the vertices where it
/// is below `limit`.
pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    limit: f64,
) -> (Option<f64>, Option<Violation>) {
    let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (e, &[a, b]) in incidence.edges.iter().enumerate() {
        if incidence.at_edge(e).is_empty() {
            beside.entry(a).or_default().push(b);
            beside.entry(b).or_default().push(a);
        }
    }
    let mut smallest: Option<f64> = None;
    let mut folded = Vec::new();
    for (&v, neighbors) in &beside {
        let &[a, b] = neighbors.as_slice() else {
            continue;
        };
        if !incidence.at_vertex(v as usize).is_empty() {
            continue;
        }
        let angle = angle(mesh, v, [a, b]);
        smallest = Some(smallest.map_or(angle, |s| s.min(angle)));
        if angle < limit {
            folded.push(Place::Vertex(v));
        }
    }
    let worst = smallest.unwrap_or(180.0);
    let violation = Violation::at(ViolationKind::BareFold, folded, |p| {
        super::coordinates(mesh, p)
    });
    (smallest, violation.map(|v| v.measured(worst, limit)))
}

/// The angle at `v` between the directions to two others, degrees.
fn angle(mesh: &Mesh, v: u32, ends: [u32; 2]) -> f64 {
    let at = |v: u32| mesh.vertices.point(v as usize);
    let (mut dot, mut squares) = (0.0, [0.0; 2]);
    for k in 0..mesh.vertices.dimension() {
        let [x, y] = ends.map(|end| at(end)[k] - at(v)[k]);
        dot += x * y;
        squares[0] += x * x;
        squares[1] += y * y;
    }
    let length = (squares[0] * squares[1]).sqrt();
    if length > 0.0 {
        (dot / length).clamp(-1.0, 1.0).acos().to_degrees()
    } else {
        0.0
    }
}
