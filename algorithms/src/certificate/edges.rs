//! Second level: every edge has the number of triangles that its stratum allows.

use super::incidence::Incidence;
use super::{Place, Violation, ViolationKind};
use crosscap_core::Mesh;
use serde::Serialize;
use std::collections::BTreeMap;

/// Edges by their number of triangles and by what they are marked as.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EdgeReport {
    /// Number of edges, of triangles and of curves.
    pub edges: usize,
    /// Number of edges by their number of triangles.
    pub by_triangles: BTreeMap<usize, usize>,
    /// Number of edges that are not marked.
    pub ordinary: usize,
    /// Number of curve edges by the number of cells they are marked with.
    pub curves: BTreeMap<u8, usize>,
    /// Number of edges of every connected part of the boundary, shortest first. Boundaries
    /// that cross each other are one part.
    pub boundaries: Vec<usize>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// Asks all edges; a boundary of fewer edges than `shortest_boundary` is allowed where `is_opening` says so of its vertices.
pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    closed: bool,
    shortest_boundary: usize,
    is_opening: &dyn Fn(&[u32]) -> bool,
) -> EdgeReport {
    let mut report = EdgeReport {
        edges: incidence.edges.len(),
        ..EdgeReport::default()
    };
    let (mut holes, mut curves, mut wrong, mut open) = (vec![], vec![], vec![], vec![]);
    for (e, &ends) in incidence.edges.iter().enumerate() {
        let found = incidence.at_edge(e).len();
        *report.by_triangles.entry(found).or_default() += 1;
        match incidence.cells[e] {
            Some(cells) => {
                *report.curves.entry(cells).or_default() += 1;
                if found != cells as usize {
                    wrong.push(Place::Edge(ends));
                }
                if closed && cells == 1 {
                    open.push(Place::Edge(ends));
                }
            }
            None => {
                report.ordinary += 1;
                match found {
                    2 => {}
                    1 => holes.push(Place::Edge(ends)),
                    _ => curves.push(Place::Edge(ends)),
                }
            }
        }
    }
    let parts = boundary_parts(incidence);
    report.boundaries = parts.iter().map(|p| p.edges).collect();
    let small = parts
        .iter()
        .filter(|p| p.edges < shortest_boundary && !is_opening(&p.vertices))
        .map(|p| Place::Edge(p.first))
        .collect();
    use ViolationKind::*;
    for (kind, places) in [
        (UndeclaredBoundary, holes),
        (UndeclaredCurve, curves),
        (WrongCount, wrong),
        (BoundaryOfClosed, open),
        (SmallHole, small),
    ] {
        report
            .violations
            .extend(Violation::at(kind, places, |p| super::coordinates(mesh, p)));
    }
    report
}

/// A connected part of the declared boundary.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    /// Number of its edges.
    edges: usize,
    first: [u32; 2],
    vertices: Vec<u32>,
}

/// Connected parts of the declared boundary, shortest first.
fn boundary_parts(incidence: &Incidence) -> Vec<Part> {
    let mut ways: Vec<[u32; 2]> = incidence
        .edges
        .iter()
        .zip(&incidence.cells)
        .enumerate()
        .filter(|(e, (_, cells))| **cells == Some(1) && incidence.at_edge(*e).len() == 1)
        .flat_map(|(_, (&[a, b], _))| [[a, b], [b, a]])
        .collect();
    ways.sort_unstable();
    let mut seen = vec![false; ways.len()];
    let mut parts = Vec::new();
    let mut stack = Vec::new();
    for start in 0..ways.len() {
        if seen[start] {
            continue;
        }
        // every edge of the part is met once from either end
        let (mut met, mut vertices) = (0, Vec::new());
        stack.push(ways[start][0]);
        while let Some(v) = stack.pop() {
            vertices.push(v);
            let from = ways.partition_point(|w| w[0] < v);
            for k in (from..ways.len()).take_while(|&k| ways[k][0] == v) {
                if !seen[k] {
                    seen[k] = true;
                    met += 1;
                    stack.push(ways[k][1]);
                }
            }
        }
        vertices.sort_unstable();
        vertices.dedup();
        parts.push(Part {
            edges: met / 2,
            first: ways[start],
            vertices,
        });
    }
    parts.sort_unstable();
    parts
}
