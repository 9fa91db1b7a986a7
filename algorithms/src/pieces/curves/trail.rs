//! Curves from edges: which edge continues which.

use crate::pieces::gluing::Gluing;
use crosscap_core::{Mesh, squared_distance};

/// A link from one end of an edge to an end of another: the number of the edge in its list and
/// which end.
pub(super) type Links = Vec<[Option<(u32, usize)>; 2]>;

/// Edges in the order in which a curve runs through them, each with the end it is entered by.
pub(super) struct Trail {
    pub steps: Vec<(u32, usize)>,
    pub circle: bool,
}

/// Follows the links: open curves first, each from the end that comes first in the list.
pub(super) fn trails(links: &Links) -> Vec<Trail> {
    let mut done = vec![false; links.len()];
    let mut found = Vec::new();
    let open = (0..links.len()).flat_map(|d| [(d, 0), (d, 1)]);
    let open = open.filter(|&(d, end)| links[d][end].is_none());
    let any = (0..links.len()).map(|d| (d, 0));
    for (first, end) in open.chain(any) {
        if done[first] {
            continue;
        }
        let mut steps = Vec::new();
        let mut at = Some((first as u32, end));
        while let Some((d, entered)) = at {
            if std::mem::replace(&mut done[d as usize], true) {
                break;
            }
            steps.push((d, entered));
            at = links[d as usize][1 - entered];
        }
        found.push(Trail {
            steps,
            circle: at.is_some(),
        });
    }
    found
}

/// The vertices along a trail, the first one not repeated for a circle, and its length.
pub(super) fn vertices_and_length(
    gluing: &Gluing<'_>,
    edges: &[u32],
    trail: &Trail,
) -> (Vec<u32>, f64) {
    let ends = |d: u32| gluing.sides.edges[edges[d as usize] as usize];
    let mut vertices: Vec<u32> = trail.steps.iter().map(|&(d, end)| ends(d)[end]).collect();
    if let Some(&(d, end)) = trail.steps.last().filter(|_| !trail.circle) {
        vertices.push(ends(d)[1 - end]);
    }
    let length = trail
        .steps
        .iter()
        .map(|&(d, _)| edge_length(gluing.mesh, ends(d)));
    (vertices, length.sum())
}

pub(super) fn edge_length(mesh: &Mesh, [a, b]: [u32; 2]) -> f64 {
    let point = |v: u32| mesh.vertices.point(v as usize);
    squared_distance(point(a), point(b)).sqrt()
}
