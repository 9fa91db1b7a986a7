//! Second level: every edge has the number of triangles that its stratum allows.

use super::incidence::Incidence;
use super::{Place, Violation, ViolationKind};
use crosscap_core::Mesh;
use serde::Serialize;
use std::collections::BTreeMap;

/// Edges by their number of triangles and by what they are marked as.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EdgeReport {
    /// Number of edges, of triangles and of curves.
    pub edges: usize,
    /// Number of edges by their number of triangles.
    pub by_triangles: BTreeMap<usize, usize>,
    /// Number of edges that are not marked.
    pub ordinary: usize,
    /// Number of curve edges by the number of cells they are marked with.
    pub curves: BTreeMap<u8, usize>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

pub(super) fn check(mesh: &Mesh, incidence: &Incidence, closed: bool) -> EdgeReport {
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
    use ViolationKind::*;
    for (kind, places) in [
        (UndeclaredBoundary, holes),
        (UndeclaredCurve, curves),
        (WrongCount, wrong),
        (BoundaryOfClosed, open),
    ] {
        report
            .violations
            .extend(Violation::at(kind, places, |p| super::coordinates(mesh, p)));
    }
    report
}
