//! Angles between the triangles at every edge.

use super::geometry_report::GeometryReport;
use super::incidence::Incidence;
use super::limits::Limits;
use super::{Place, Violation, ViolationKind};
use crosscap_core::Mesh;

/// The smallest angles at ordinary edges and at curve edges, with those below the limits.
#[derive(Default)]
struct Folds {
    fold: Vec<Place>,
    curve_fold: Vec<Place>,
    worst: f64,
    curve_worst: f64,
}

/// Enters the angles between the triangles at every edge.
pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    limits: &Limits,
    report: &mut GeometryReport,
) {
    let mut found = Folds {
        worst: 180.0,
        curve_worst: 180.0,
        ..Folds::default()
    };
    let mut wings: Vec<f64> = Vec::new();
    for (e, &ends) in incidence.edges.iter().enumerate() {
        let at_edge = incidence.at_edge(e);
        if at_edge.len() < 2 {
            continue;
        }
        spread(mesh, ends, at_edge, &mut wings);
        let least = least_angle(&wings, at_edge.len());
        // An edge that is marked with two cells may be a crease.
        if at_edge.len() == 2 && incidence.cells[e] != Some(2) {
            found.worst = found.worst.min(least);
            report.sharp_edges += usize::from(least < 45.0);
            if least < limits.fold {
                found.fold.push(Place::Edge(ends));
            }
        } else if least < limits.curve_fold {
            found.curve_worst = found.curve_worst.min(least);
            found.curve_fold.push(Place::Edge(ends));
        }
    }
    report.smallest_dihedral = found.worst;
    report.folds = found.fold.len();
    let at = |p: Place| super::coordinates(mesh, p);
    let fold = Violation::at(ViolationKind::Fold, found.fold, at);
    let curve_fold = Violation::at(ViolationKind::CurveFold, found.curve_fold, at);
    let violations = &mut report.violations;
    violations.extend(fold.map(|v| v.measured(found.worst, limits.fold)));
    violations.extend(curve_fold.map(|v| v.measured(found.curve_worst, limits.curve_fold)));
}

/// Unit vectors from an edge into each of its triangles, perpendicular to the edge, one after another.
fn spread(mesh: &Mesh, [a, b]: [u32; 2], at_edge: &[u32], wings: &mut Vec<f64>) {
    let [p, q] = [a, b].map(|v| mesh.vertices.point(v as usize));
    let along = mesh.vertices.squared_distance(a as usize, b as usize);
    wings.clear();
    for &t in at_edge {
        let corners = mesh.complex.triangles[t as usize].into_iter();
        let tip = corners.into_iter().find(|&v| v != a && v != b).unwrap_or(a);
        let tip = mesh.vertices.point(tip as usize);
        let n = p.len();
        let k = (0..n).map(|i| (tip[i] - p[i]) * (q[i] - p[i])).sum::<f64>() / along;
        let from = wings.len();
        wings.extend((0..n).map(|i| tip[i] - p[i] - k * (q[i] - p[i])));
        let height = wings[from..].iter().map(|w| w * w).sum::<f64>().sqrt();
        wings[from..].iter_mut().for_each(|w| *w /= height);
    }
}

/// The smallest angle between two of so many wings, degrees.
fn least_angle(wings: &[f64], count: usize) -> f64 {
    let n = wings.len() / count;
    let mut least = 180.0_f64;
    for i in 0..count {
        for j in 0..i {
            let cosine: f64 = (0..n).map(|k| wings[i * n + k] * wings[j * n + k]).sum();
            // a triangle without area has no wing: count it as folded
            let angle = if cosine.is_nan() {
                0.0
            } else {
                cosine.clamp(-1.0, 1.0).acos().to_degrees()
            };
            least = least.min(angle);
        }
    }
    least
}
