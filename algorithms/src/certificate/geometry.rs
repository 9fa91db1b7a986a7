//! Fourth level: triangles meet in common faces only.

use super::crossing::Places;
use super::distance::{separated, triangle_triangle};
use super::frame::Frame;
use super::incidence::Incidence;
use super::pinched::{Pinched, parted};
use super::stacked::Planes;
use super::tree::{Bounds, Tree};
pub(super) use super::triangle::{area, corners};
use super::{Limits, Place, SpecialPoint, Violation, ViolationKind, exceeds};
use crosscap_core::{LinkKind, Mesh};
use serde::Serialize;

/// Folds, overlaps and crossings.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GeometryReport {
    /// Triangles without area.
    pub zero_area: usize,
    /// Smallest angle between two triangles at an ordinary edge, degrees; 180 is flat.
    pub smallest_dihedral: f64,
    /// Ordinary edges with an angle below 45 degrees.
    pub sharp_edges: usize,
    /// Ordinary edges with an angle below the limit.
    pub folds: usize,
    /// Smallest angle between two edges of a curve without triangles, degrees; 180 is straight. None without such curves.
    pub smallest_bend: Option<f64>,
    /// Pairs of triangles on top of each other.
    pub stacked_pairs: usize,
    /// Pairs of triangles that cross (dimension up to 3) or touch (above) outside common faces.
    pub crossings: usize,
    /// Pairs of triangles that were near enough to be looked at.
    pub pairs: usize,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// Pairs to look at, per triangle, before a mesh is called entangled.
const PAIRS_PER_TRIANGLE: usize = 3000;

pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    frame: &Frame,
    tree_of_triangles: &Tree,
    limits: &Limits,
    special: &[SpecialPoint],
) -> GeometryReport {
    let triangles = &mesh.complex.triangles;
    let count = triangles.len();
    let at = |p: Place| super::coordinates(mesh, p);
    let mut report = GeometryReport::default();

    // lengths: the median over all edges of triangles, and over one side of every triangle;
    // the stricter of the two is used
    let length = |a: u32, b: u32| {
        mesh.vertices
            .squared_distance(a as usize, b as usize)
            .sqrt()
    };
    let all = super::statistics::median(
        triangles
            .iter()
            .flat_map(|&[a, b, c]| [length(a, b), length(a, c), length(b, c)])
            .collect(),
    );
    let first = super::statistics::median(triangles.iter().map(|t| length(t[0], t[1])).collect());
    let (small, large) = (all.min(first), all.max(first));

    let flat: Vec<Place> = (0..count as u32)
        .filter(|&t| {
            let [a, b, c] = triangles[t as usize];
            let longest = length(a, b).max(length(a, c)).max(length(b, c)).max(large);
            !exceeds(area(corners(mesh, t)), limits.zero_area * longest * longest)
        })
        .map(Place::Triangle)
        .collect();
    report.zero_area = flat.len();
    report
        .violations
        .extend(Violation::at(ViolationKind::ZeroArea, flat, at));

    folds(mesh, incidence, limits, &mut report);
    let (bend, folded) = super::bends::check(mesh, incidence, limits.bare_fold);
    report.smallest_bend = bend;
    report.violations.extend(folded);

    let dimension = mesh.vertices.dimension();
    let planes = Planes::new(mesh);
    let exact = (dimension <= 3).then(|| Places::new(mesh.vertices.iter()));
    let contact = limits.contact * small;
    let reach = 1.15 * large;
    let apart = limits.stacked_offset * large;
    let budget = PAIRS_PER_TRIANGLE * count + 100_000;
    let mut is_special = vec![false; mesh.complex.vertices];
    let unlike_a_curve = |s: &&SpecialPoint| !LinkKind::GENERIC.contains(&s.link.kind());
    for s in special.iter().filter(unlike_a_curve) {
        if let Some(flag) = is_special.get_mut(s.vertex as usize) {
            *flag = true;
        }
    }
    let pinched: Vec<Pinched> = (special.iter())
        .filter(|s| s.link.kind() == LinkKind::Pinch)
        .map(|s| Pinched::new(mesh, incidence, s.vertex))
        .collect();
    let (mut stacked, mut crossing) = (vec![], vec![]);
    let mut entangled = false;
    // boxes carry the slack of the frame already
    let touch = if dimension <= 3 { 0.0 } else { contact };
    tree_of_triangles.pairs(reach + 2.0 * frame.slack, |s, t, away| {
        report.pairs += 1;
        if report.pairs > budget {
            entangled = true;
            return false;
        }
        let (a, b) = (triangles[s as usize], triangles[t as usize]);
        let mut shared = None;
        let mut common = 0;
        for v in a {
            if b.contains(&v) {
                common += 1;
                shared = Some(v);
            }
        }
        if common >= 2 {
            return true;
        }
        if away <= touch * touch {
            let meet = match &exact {
                Some(places) => places.meet(a, b),
                None => {
                    common == 0 && {
                        let (p, q) = (corners(mesh, s), corners(mesh, t));
                        !separated(p, q, contact) && triangle_triangle(p, q) <= contact * contact
                    }
                }
            };
            if meet {
                crossing.push(Place::Triangles([s, t]));
            }
        }
        let near = away <= apart * apart || planes.centroids_within(s, t, reach);
        let over = || {
            let depth = limits.stacked_depth * small;
            planes.stacked(s, t, limits.stacked_angle, depth, apart)
        };
        if near
            && !shared.is_some_and(|v| is_special[v as usize])
            && over()
            && !shared.is_some_and(|v| parted(mesh, incidence, v, [s, t]))
            && !pinched.iter().any(|p| p.parts([s, t]))
        {
            stacked.push(Place::Triangles([s, t]));
        }
        true
    });
    report.stacked_pairs = stacked.len();
    report.crossings = crossing.len();
    let kind = if dimension <= 3 {
        ViolationKind::SelfIntersection
    } else {
        ViolationKind::NearCrossing
    };
    report
        .violations
        .extend(Violation::at(ViolationKind::Stacked, stacked, at));
    report.violations.extend(Violation::at(kind, crossing, at));
    if entangled {
        report.violations.push(Violation::whole(
            ViolationKind::Entangled,
            format!("more than {budget} pairs of near triangles"),
        ));
    }
    report
}

/// Angles between the triangles at every edge.
fn folds(mesh: &Mesh, incidence: &Incidence, limits: &Limits, report: &mut GeometryReport) {
    let n = mesh.vertices.dimension();
    let (mut fold, mut curve_fold) = (vec![], vec![]);
    let (mut worst, mut curve_worst) = (180.0_f64, 180.0_f64);
    // unit vectors from the edge into each of its triangles, perpendicular to the edge
    let mut wings: Vec<f64> = Vec::new();
    for (e, &[a, b]) in incidence.edges.iter().enumerate() {
        let at_edge = incidence.at_edge(e);
        if at_edge.len() < 2 {
            continue;
        }
        let (p, q) = (
            mesh.vertices.point(a as usize),
            mesh.vertices.point(b as usize),
        );
        let along = mesh.vertices.squared_distance(a as usize, b as usize);
        wings.clear();
        for &t in at_edge {
            let tip = mesh.complex.triangles[t as usize]
                .into_iter()
                .find(|&v| v != a && v != b)
                .unwrap_or(a);
            let tip = mesh.vertices.point(tip as usize);
            let k = (0..n).map(|i| (tip[i] - p[i]) * (q[i] - p[i])).sum::<f64>() / along;
            let from = wings.len();
            wings.extend((0..n).map(|i| tip[i] - p[i] - k * (q[i] - p[i])));
            let height = wings[from..].iter().map(|w| w * w).sum::<f64>().sqrt();
            wings[from..].iter_mut().for_each(|w| *w /= height);
        }
        let mut least = 180.0_f64;
        for i in 0..at_edge.len() {
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
        // An edge that is marked with two cells may be a crease.
        if at_edge.len() == 2 && incidence.cells[e] != Some(2) {
            worst = worst.min(least);
            report.sharp_edges += usize::from(least < 45.0);
            if least < limits.fold {
                fold.push(Place::Edge([a, b]));
            }
        } else if least < limits.curve_fold {
            curve_worst = curve_worst.min(least);
            curve_fold.push(Place::Edge([a, b]));
        }
    }
    report.smallest_dihedral = worst;
    report.folds = fold.len();
    let at = |p: Place| super::coordinates(mesh, p);
    report.violations.extend(
        Violation::at(ViolationKind::Fold, fold, at).map(|v| v.measured(worst, limits.fold)),
    );
    report.violations.extend(
        Violation::at(ViolationKind::CurveFold, curve_fold, at)
            .map(|v| v.measured(curve_worst, limits.curve_fold)),
    );
}

/// The tree of triangles in the frame, and of curve edges that no triangle has after them.
pub(super) fn tree(mesh: &Mesh, frame: &Frame, bare: &[[u32; 2]]) -> Tree {
    let spot = |v: u32| frame.spot(mesh.vertices.point(v as usize));
    let spots: Vec<_> = (0..mesh.complex.vertices as u32).map(spot).collect();
    let bounds: Vec<Bounds> = mesh
        .complex
        .triangles
        .iter()
        .map(|t| Bounds::around(&t.map(|v| spots[v as usize]), frame.slack))
        .chain(
            bare.iter()
                .map(|e| Bounds::around(&e.map(|v| spots[v as usize]), frame.slack)),
        )
        .collect();
    Tree::new(&bounds)
}
