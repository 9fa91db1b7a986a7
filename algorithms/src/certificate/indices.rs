//! First level: the arrays are those of a simplicial complex with distinct places.

use super::{Place, Violation, ViolationKind};
use crosscap_core::{Complex, Mesh};
use serde::Serialize;

/// Whether the arrays describe a simplicial complex with distinct places.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct IndexReport {
    /// Number of vertices.
    pub vertices: usize,
    /// N, the number of coordinates of a vertex.
    pub dimension: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of curve edges.
    pub curve_edges: usize,
    /// What is wrong.
    pub violations: Vec<Violation>,
    /// Whether the later levels can be asked at all.
    pub usable: bool,
}

/// Two vertices nearer than this times the median edge are at one place.
const SAME_PLACE: f64 = 1e-9;

/// The arrays of a mesh, and whether its vertices are at distinct places.
pub(super) fn check(mesh: &Mesh) -> IndexReport {
    let mut report = arrays(mesh, |place| super::coordinates(mesh, place));
    report.dimension = mesh.vertices.dimension();
    if report.usable {
        let at = |place: Place| super::coordinates(mesh, place);
        let kind = ViolationKind::CoincidentVertices;
        report
            .violations
            .extend(Violation::at(kind, coincident(mesh), at));
    }
    report
}

/// The arrays alone, for vertices without coordinates; `at` says where a place is, if that is known.
pub(super) fn arrays(mesh: &Mesh, at: impl Fn(Place) -> Vec<f64>) -> IndexReport {
    let complex = &mesh.complex;
    let n = complex.vertices;
    let mut report = IndexReport {
        vertices: n,
        dimension: 0,
        triangles: complex.triangles.len(),
        curve_edges: complex.curve_edges.len(),
        violations: Vec::new(),
        usable: true,
    };
    if mesh.vertices.len() != n || u32::try_from(n.max(complex.triangles.len())).is_err() {
        report.violations.push(Violation::whole(
            ViolationKind::Shape,
            format!("{n} vertices, {} places", mesh.vertices.len()),
        ));
        report.usable = false;
        return report;
    }
    if complex.triangles.is_empty() {
        report
            .violations
            .push(Violation::whole(ViolationKind::NoTriangles, String::new()));
        report.usable = false;
    }
    corners(complex, &mut report);
    if report.usable {
        let kinds = [
            (ViolationKind::RepeatedTriangle, repeated_triangles(complex)),
            (ViolationKind::RepeatedCurveEdge, repeated_edges(complex)),
            (ViolationKind::IsolatedVertex, isolated(complex)),
        ];
        let found = kinds.into_iter();
        let found = found.filter_map(|(kind, places)| Violation::at(kind, places, &at));
        report.violations.extend(found);
    }
    report
}

/// Corners that are no vertices, and simplices with one corner twice: with either nothing more can be asked.
fn corners(complex: &Complex, report: &mut IndexReport) {
    let (mut outside, mut repeated) = (vec![], vec![]);
    let mut note = |place: Place, corners: &[u32]| {
        if corners.iter().any(|&v| v as usize >= complex.vertices) {
            outside.push(place);
        }
        if (1..corners.len()).any(|k| corners[..k].contains(&corners[k])) {
            repeated.push(place);
        }
    };
    for (t, corners) in complex.triangles.iter().enumerate() {
        note(Place::Triangle(t as u32), corners);
    }
    for (e, edge) in complex.curve_edges.iter().enumerate() {
        note(Place::CurveEdge(e as u32), &edge.ends);
    }
    report.usable &= outside.is_empty() && repeated.is_empty();
    let nowhere = |_: Place| Vec::new();
    let outside = Violation::at(ViolationKind::IndexOutOfRange, outside, nowhere);
    let repeated = Violation::at(ViolationKind::RepeatedCorner, repeated, nowhere);
    report
        .violations
        .extend(outside.into_iter().chain(repeated));
}

/// Triangles that are there before.
fn repeated_triangles(complex: &Complex) -> Vec<Place> {
    let sorted = complex.triangles.iter().map(|&corners| {
        let mut corners = corners;
        corners.sort_unstable();
        corners
    });
    repeated(sorted, Place::Triangle)
}

/// Curve edges that are there before.
fn repeated_edges(complex: &Complex) -> Vec<Place> {
    let ends = complex.curve_edges.iter().map(|e| e.ends);
    let sorted = ends.map(|[a, b]| [a.min(b), a.max(b)]);
    repeated(sorted, Place::CurveEdge)
}

/// The places of all that are equal to an earlier one.
fn repeated<K: Ord>(all: impl Iterator<Item = K>, place: fn(u32) -> Place) -> Vec<Place> {
    let mut sorted: Vec<(K, u32)> = all.zip(0..).collect();
    sorted.sort_unstable();
    let pairs = sorted.windows(2).filter(|w| w[0].0 == w[1].0);
    pairs.map(|w| place(w[1].1)).collect()
}

/// Vertices that neither a triangle nor a curve edge has.
fn isolated(complex: &Complex) -> Vec<Place> {
    let mut used = vec![false; complex.vertices];
    let corners = complex.triangles.iter().flatten();
    for &v in corners.chain(complex.curve_edges.iter().flat_map(|e| &e.ends)) {
        used[v as usize] = true;
    }
    let unused = (0..complex.vertices).filter(|&v| !used[v]);
    unused.map(|v| Place::Vertex(v as u32)).collect()
}

/// Vertices with another one at their place, each with one partner. A sweep along a direction
/// in general position: O(n log n) unless very many vertices lie in one plane across it.
fn coincident(mesh: &Mesh) -> Vec<Place> {
    let cloud = &mesh.vertices;
    let mut lengths: Vec<f64> = mesh
        .complex
        .triangles
        .iter()
        .map(|t| cloud.squared_distance(t[0] as usize, t[1] as usize))
        .collect();
    let middle = lengths.len() / 2;
    let median = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
    // the absolute part: no unit of length makes such a mesh usable elsewhere
    let reach = (SAME_PLACE * median.sqrt()).max(1e-12);
    let direction: Vec<f64> = (0..cloud.dimension())
        .map(|k| 0.3 + ((k as f64 + 1.0) * 0.618_033_988_749_895).fract())
        .collect();
    let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    let mut order: Vec<(f64, u32)> = cloud
        .iter()
        .enumerate()
        .map(|(v, row)| {
            let along: f64 = row.iter().zip(&direction).map(|(x, d)| x * d).sum();
            (along / norm, v as u32)
        })
        .collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let top = order.iter().map(|o| o.0.abs()).fold(0.0, f64::max);
    let window = reach + 8.0 * cloud.dimension() as f64 * f64::EPSILON * top;
    let mut places = Vec::new();
    for (k, &(along, v)) in order.iter().enumerate() {
        let partner = order[k + 1..]
            .iter()
            .take_while(|o| o.0 - along <= window)
            .find(|o| cloud.squared_distance(v as usize, o.1 as usize) <= reach * reach);
        if let Some(&(_, w)) = partner {
            places.push(Place::Vertices([v.min(w), v.max(w)]));
        }
    }
    places
}
