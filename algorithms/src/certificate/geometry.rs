//! Fourth level: triangles meet in common faces only.

use super::frame::Frame;
use super::geometry_report::GeometryReport;
use super::incidence::Incidence;
use super::near_pairs::Pairs;
use super::tree::{Bounds, Tree};
pub(super) use super::triangle::{area, corners};
use super::{Limits, Place, SpecialPoint, Violation, ViolationKind, exceeds};
use crosscap_core::Mesh;

/// Folds, overlaps and crossings of a mesh; `special` are vertices at which triangles may lie as they do nowhere else.
pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    frame: &Frame,
    tree_of_triangles: &Tree,
    limits: &Limits,
    special: &[SpecialPoint],
) -> GeometryReport {
    let mut report = GeometryReport::default();
    let lengths = lengths(mesh);
    let flat = flat(mesh, limits, lengths[1]);
    report.zero_area = flat.len();
    let at = |p: Place| super::coordinates(mesh, p);
    let flat = Violation::at(ViolationKind::ZeroArea, flat, at);
    report.violations.extend(flat);
    super::folds::check(mesh, incidence, limits, &mut report);
    let (bend, folded) = super::bends::check(mesh, incidence, limits.bare_fold);
    report.smallest_bend = bend;
    report.violations.extend(folded);
    let mut pairs = Pairs::new(mesh, incidence, limits, lengths, special);
    // boxes carry the slack of the frame already
    let reach = pairs.reach + 2.0 * frame.slack;
    tree_of_triangles.pairs(reach, |s, t, away| pairs.look(s, t, away));
    pairs.tell(&mut report);
    report
}

/// The usual length of an edge: the lesser and the larger of the median over all edges of triangles and that over one side
/// of every triangle; whichever of the two is stricter is used.
fn lengths(mesh: &Mesh) -> [f64; 2] {
    let triangles = &mesh.complex.triangles;
    let length = |a: u32, b: u32| edge_length(mesh, a, b);
    let sides = triangles.iter();
    let sides = sides.flat_map(|&[a, b, c]| [length(a, b), length(a, c), length(b, c)]);
    let all = super::statistics::median(sides.collect());
    let first = triangles.iter().map(|t| length(t[0], t[1]));
    let first = super::statistics::median(first.collect());
    [all.min(first), all.max(first)]
}

fn edge_length(mesh: &Mesh, a: u32, b: u32) -> f64 {
    let square = mesh.vertices.squared_distance(a as usize, b as usize);
    square.sqrt()
}

/// Triangles without area, where edges are usually `large`.
fn flat(mesh: &Mesh, limits: &Limits, large: f64) -> Vec<Place> {
    let length = |a: u32, b: u32| edge_length(mesh, a, b);
    let is_flat = |&t: &u32| {
        let [a, b, c] = mesh.complex.triangles[t as usize];
        let longest = length(a, b).max(length(a, c)).max(length(b, c)).max(large);
        !exceeds(area(corners(mesh, t)), limits.zero_area * longest * longest)
    };
    let all = 0..mesh.complex.triangles.len() as u32;
    all.filter(is_flat).map(Place::Triangle).collect()
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
