//! Sixth level: shapes of triangles and the pieces they make.

use super::incidence::Incidence;
pub(super) use super::statistics::{median, quantile};
use super::triangle::{area, corners};
use super::{Limits, Place, Violation, ViolationKind, within};
use crosscap_core::Mesh;
use serde::Serialize;

/// Smallest value, 1, 5 and 50 percent quantiles, and largest value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Smallest.
    pub min: f64,
    /// 1 percent are below.
    pub q01: f64,
    /// 5 percent are below.
    pub q05: f64,
    /// Half are below.
    pub median: f64,
    /// Largest.
    pub max: f64,
}

impl Spread {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self {
            min: quantile(&values, 0.0),
            q01: quantile(&values, 0.01),
            q05: quantile(&values, 0.05),
            median: quantile(&values, 0.5),
            max: quantile(&values, 1.0),
        }
    }
}

/// A part of the mesh that hangs together over ordinary edges: a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Its first triangle.
    pub first: u32,
    /// Number of its triangles.
    pub triangles: usize,
    /// Whether its triangles can be given one orientation.
    pub orientable: bool,
    /// Its area.
    pub area: f64,
}

/// Shapes of triangles and the cells they make. Only needles are a violation.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct QualityReport {
    /// Smallest angle of each triangle, degrees.
    pub min_angle: Spread,
    /// Twice the inscribed over the circumscribed radius: 1 for an equilateral triangle.
    pub radius_ratio: Spread,
    /// Length of the edges, each once.
    pub edge_length: Spread,
    /// Area of all triangles.
    pub area: f64,
    /// Parts that hang together by triangles, curves and single vertices.
    pub components: usize,
    /// Parts that hang together over ordinary edges, in the order of their first triangles.
    pub cells: Vec<Cell>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// Smallest angle in degrees, and twice the inscribed over the circumscribed radius.
fn shape(corners: [&[f64]; 3]) -> (f64, f64, f64) {
    let side = |p: &[f64], q: &[f64]| crosscap_core::squared_distance(p, q).sqrt();
    let mut sides = [
        side(corners[1], corners[2]),
        side(corners[0], corners[2]),
        side(corners[0], corners[1]),
    ];
    sides.sort_unstable_by(f64::total_cmp);
    let [a, b, c] = sides;
    let area = area(corners);
    // the smallest angle is opposite of the shortest side
    let angle = if b > 0.0 {
        (2.0 * area)
            .atan2(0.5 * (b * b + c * c - a * a))
            .to_degrees()
    } else {
        0.0
    };
    let around = a * b * c * (a + b + c);
    let ratio = if around > 0.0 {
        16.0 * area * area / around
    } else {
        0.0
    };
    (angle, ratio, area)
}

/// Disjoint sets with a sign: on which of two sides of its root an element is.
struct SignedSets {
    parent: Vec<u32>,
    flip: Vec<bool>,
}

impl SignedSets {
    fn new(n: usize) -> Self {
        Self {
            parent: (0..n as u32).collect(),
            flip: vec![false; n],
        }
    }

    fn root(&mut self, mut a: u32) -> (u32, bool) {
        let mut sign = false;
        while self.parent[a as usize] != a {
            let p = self.parent[a as usize];
            // halve the path
            let flip = self.flip[a as usize] ^ self.flip[p as usize];
            if self.parent[p as usize] != p {
                self.parent[a as usize] = self.parent[p as usize];
                self.flip[a as usize] = flip;
                sign ^= flip;
                a = self.parent[a as usize];
            } else {
                sign ^= self.flip[a as usize];
                a = p;
            }
        }
        (a, sign)
    }

    /// Joins two elements with a relative sign; `false` when they have the other one already.
    fn join(&mut self, a: u32, b: u32, differ: bool) -> bool {
        let ((p, s), (q, t)) = (self.root(a), self.root(b));
        if p == q {
            return s ^ t == differ;
        }
        let (low, high) = (p.min(q), p.max(q));
        self.parent[high as usize] = low;
        self.flip[high as usize] = s ^ t ^ differ;
        true
    }
}

/// Whether a triangle runs through the edge `a`-`b` from `a` to `b`.
fn runs(corners: [u32; 3], [a, b]: [u32; 2]) -> bool {
    (0..3).any(|k| corners[k] == a && corners[(k + 1) % 3] == b)
}

/// Shapes of all triangles, and what they hang together in.
pub(super) fn check(mesh: &Mesh, incidence: &Incidence, limits: &Limits) -> QualityReport {
    let count = mesh.complex.triangles.len();
    let (mut angles, mut ratios) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut areas = Vec::with_capacity(count);
    for t in 0..count as u32 {
        let (angle, ratio, area) = shape(corners(mesh, t));
        angles.push(angle);
        ratios.push(ratio);
        areas.push(area);
    }
    let needles: Vec<Place> = (0..count)
        .filter(|&t| !within(limits.min_angle, angles[t]))
        .map(|t| Place::Triangle(t as u32))
        .collect();
    let edges = incidence.edges.iter();
    let squares = edges.map(|e| mesh.vertices.squared_distance(e[0] as usize, e[1] as usize));
    let lengths = squares.map(f64::sqrt).collect();
    let mut parts = SignedSets::new(mesh.complex.vertices);
    for &[a, b] in &incidence.edges {
        parts.join(a, b, false);
    }
    let components = (0..mesh.complex.vertices as u32)
        .filter(|&v| parts.root(v).0 == v)
        .count();
    let min_angle = Spread::of(angles);
    let at = |p: Place| super::coordinates(mesh, p);
    let needles = Violation::at(ViolationKind::NeedleTriangle, needles, at);
    QualityReport {
        violations: needles
            .map(|v| v.measured(min_angle.min, limits.min_angle))
            .into_iter()
            .collect(),
        min_angle,
        radius_ratio: Spread::of(ratios),
        edge_length: Spread::of(lengths),
        area: areas.iter().sum(),
        components,
        cells: cells(mesh, incidence, &areas),
    }
}

/// The parts that hang together over ordinary edges.
fn cells(mesh: &Mesh, incidence: &Incidence, areas: &[f64]) -> Vec<Cell> {
    let triangles = &mesh.complex.triangles;
    let mut sets = SignedSets::new(triangles.len());
    let mut twisted = Vec::new();
    for (e, &ends) in incidence.edges.iter().enumerate() {
        if let (None, &[s, t]) = (incidence.cells[e], incidence.at_edge(e)) {
            // one orientation runs through a common edge both ways
            let same = runs(triangles[s as usize], ends) == runs(triangles[t as usize], ends);
            if !sets.join(s, t, same) {
                twisted.push(s);
            }
        }
    }
    let mut cells: Vec<Cell> = Vec::new();
    let mut cell_of: Vec<Option<usize>> = vec![None; triangles.len()];
    for (t, area) in (0..).zip(areas) {
        // roots are the smallest members
        let root = sets.root(t).0 as usize;
        let own = *cell_of[root].get_or_insert_with(|| {
            cells.push(Cell {
                first: t,
                triangles: 0,
                orientable: true,
                area: 0.0,
            });
            cells.len() - 1
        });
        cells[own].triangles += 1;
        cells[own].area += area;
    }
    for t in twisted {
        if let Some(own) = cell_of[sets.root(t).0 as usize] {
            cells[own].orientable = false;
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_of_known_triangles() {
        let (angle, ratio, area) =
            shape([&[0., 0., 0.], &[1., 0., 0.], &[0.5, 0.75_f64.sqrt(), 0.]]);
        assert!((angle - 60.0).abs() < 1e-9 && (ratio - 1.0).abs() < 1e-12);
        assert!((area - 0.75_f64.sqrt() / 2.0).abs() < 1e-12);
        let (angle, ..) = shape([&[0.0, 0.0], &[1.0, 0.0], &[0.0, 1.0]]);
        assert!((angle - 45.0).abs() < 1e-9);
        let (angle, ratio, area) = shape([&[0., 0.], &[1., 0.], &[2., 0.]]);
        assert_eq!((angle, ratio, area), (0.0, 0.0, 0.0));
    }
}
