//! Pieces without curvature: rectangles, the Swiss roll, segments.

use super::round::cross;
use super::{Jet, Piece, Random, RimSegment};
use std::f64::consts::PI;

pub(super) fn rectangle_rim([[a, b], [c, d]]: [[f64; 2]; 2]) -> Vec<RimSegment> {
    let corners = [[a, c], [b, c], [b, d], [a, d]];
    (0..4)
        .map(|k| RimSegment {
            from: corners[k],
            to: corners[(k + 1) % 4],
        })
        .collect()
}

/// A rectangle in R^N, center plus u times one half side plus v times the other, |u|, |v| <= 1.
#[derive(Clone, Debug)]
pub struct Rectangle {
    name: &'static str,
    center: Vec<f64>,
    half_sides: [Vec<f64>; 2],
}

impl Rectangle {
    /// A rectangle with two orthogonal half sides.
    pub fn new(name: &'static str, center: Vec<f64>, half_sides: [Vec<f64>; 2]) -> Self {
        Self {
            name,
            center,
            half_sides,
        }
    }

    fn lengths(&self) -> [f64; 2] {
        [0, 1].map(|k| self.half_sides[k].iter().map(|x| x * x).sum::<f64>().sqrt())
    }
}

impl Piece for Rectangle {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        self.center.len()
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [u, v]: [Jet; 2], place: &mut [Jet]) {
        for (k, out) in place.iter_mut().enumerate() {
            *out = u * self.half_sides[0][k] + v * self.half_sides[1][k] + self.center[k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        let [a, b] = self.lengths();
        a * b * (1.0 + 1e-12)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rectangle_rim(self.domain())]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let mut rest: Vec<f64> = place.iter().zip(&self.center).map(|(x, c)| x - c).collect();
        for (side, length) in self.half_sides.iter().zip(self.lengths()) {
            let along: f64 = rest.iter().zip(side).map(|(r, s)| r * s).sum();
            let clamped = (along / (length * length)).clamp(-1.0, 1.0);
            rest.iter_mut()
                .zip(side)
                .for_each(|(r, s)| *r -= clamped * s);
        }
        Some(rest.iter().map(|r| r * r).sum::<f64>().sqrt())
    }
}

/// A flat polygon of space, in the plane of the first two coordinates, which are its parameters.
#[derive(Clone, Debug)]
pub struct Polygon {
    name: &'static str,
    corners: Vec<[f64; 2]>,
}

impl Polygon {
    /// The polygon with the given corners, in their order around it.
    pub fn new(name: &'static str, corners: Vec<[f64; 2]>) -> Self {
        Self { name, corners }
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(&a, &b)| [a, b])
    }
}

impl Piece for Polygon {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| {
            let all = || self.corners.iter().map(|c| c[k]);
            let least = all().fold(f64::INFINITY, f64::min);
            [least, all().fold(f64::NEG_INFINITY, f64::max)]
        })
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [x, y]: [Jet; 2], place: &mut [Jet]) {
        place.copy_from_slice(&[x, y, x * 0.0]);
    }
    /// Whether a ray to one side leaves it an odd number of times.
    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let crossed = self.sides().filter(|[a, b]| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
        });
        crossed.count() % 2 == 1
    }
    fn area_element_bound(&self) -> f64 {
        1.0
    }
    /// Gauss's formula.
    fn area(&self) -> f64 {
        let double = self.sides().map(|[a, b]| a[0] * b[1] - a[1] * b[0]);
        (double.sum::<f64>() / 2.0).abs()
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        let sides = self.sides();
        vec![sides.map(|[from, to]| RimSegment { from, to }).collect()]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let at = [place[0], place[1]];
        let beside = self.sides().map(|[a, b]| {
            let [way, from] = [[b[0] - a[0], b[1] - a[1]], [at[0] - a[0], at[1] - a[1]]];
            let length = way[0] * way[0] + way[1] * way[1];
            let share = ((from[0] * way[0] + from[1] * way[1]) / length).clamp(0.0, 1.0);
            libm::hypot(from[0] - share * way[0], from[1] - share * way[1])
        });
        let off = match self.holds(at) {
            true => 0.0,
            false => beside.fold(f64::INFINITY, f64::min),
        };
        Some(libm::hypot(off, place[2]))
    }
}

/// Half of a flat disc of space, on one side of a diameter. Parameters: distance from the middle of the
/// diameter, angle from it.
#[derive(Clone, Debug)]
pub struct HalfDisc {
    name: &'static str,
    radius: f64,
    along: [f64; 3],
    out: [f64; 3],
}

impl HalfDisc {
    /// The half disc of `radius` about the origin with its diameter in the direction `along`, on the side
    /// of `out`; both are unit vectors, at a right angle.
    pub fn new(name: &'static str, radius: f64, along: [f64; 3], out: [f64; 3]) -> Self {
        Self {
            name,
            radius,
            along,
            out,
        }
    }
}

impl Piece for HalfDisc {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, self.radius], [0.0, PI]]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [distance, angle]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = angle.sin_cos();
        for (k, x) in place.iter_mut().enumerate() {
            *x = distance * c * self.along[k] + distance * s * self.out[k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        self.radius * (1.0 + 1e-12)
    }
    fn area(&self) -> f64 {
        0.5 * PI * self.radius * self.radius
    }
    /// The squared distance from the middle is uniform.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let at = [
            self.radius * random.uniform().sqrt(),
            random.between(0.0, PI),
        ];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        let corners = [
            [self.radius, 0.0],
            [self.radius, PI],
            [0.0, PI],
            [self.radius, 0.0],
        ];
        let way = |from: [f64; 2], to: [f64; 2]| RimSegment { from, to };
        vec![vec![
            way(corners[0], corners[1]),
            way(corners[1], corners[2]),
            way([0.0, 0.0], corners[3]),
        ]]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let dot = |axis: [f64; 3]| (0..3).map(|k| axis[k] * place[k]).sum::<f64>();
        let off = dot(cross(self.along, self.out));
        let (x, y) = (dot(self.along), dot(self.out));
        let within = if y > 0.0 {
            (libm::hypot(x, y) - self.radius).max(0.0)
        } else {
            libm::hypot((x.abs() - self.radius).max(0.0), y)
        };
        Some(libm::hypot(off, within))
    }
}

/// The Swiss roll: a strip wound along the spiral of Archimedes, (t cos t, y, t sin t) times a scale.
/// Parameters: t, y.
#[derive(Clone, Debug)]
pub struct SwissRoll {
    scale: f64,
    turns: [f64; 2],
    half_width: f64,
}

impl SwissRoll {
    /// The roll with angles in `turns` (radians) and widths |y| <= `half_width` before scaling.
    pub fn new(scale: f64, turns: [f64; 2], half_width: f64) -> Self {
        Self {
            scale,
            turns,
            half_width,
        }
    }
}

impl Piece for SwissRoll {
    fn name(&self) -> &'static str {
        "roll"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.turns, [-self.half_width, self.half_width]]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [t, y]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = t.sin_cos();
        place.copy_from_slice(&[t * c * self.scale, y * self.scale, t * s * self.scale]);
    }
    fn area_element_bound(&self) -> f64 {
        // scale^2 sqrt(1 + t^2), largest at the outer end.
        let t = self.turns[1].abs().max(self.turns[0].abs());
        self.scale * self.scale * (1.0 + t * t).sqrt() * (1.0 + 1e-12)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rectangle_rim(self.domain())]
    }
}

/// A straight segment of R^N: a piece of dimension 1. First parameter: 0 at one end, 1 at the other.
#[derive(Clone, Debug)]
pub struct Segment {
    name: &'static str,
    ends: [Vec<f64>; 2],
}

impl Segment {
    /// The segment between two places.
    pub fn new(name: &'static str, ends: [Vec<f64>; 2]) -> Self {
        Self { name, ends }
    }
}

impl Piece for Segment {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        self.ends[0].len()
    }
    fn dimension(&self) -> u8 {
        1
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [0.0, 0.0]]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [t, _]: [Jet; 2], place: &mut [Jet]) {
        for (k, out) in place.iter_mut().enumerate() {
            *out = t * (self.ends[1][k] - self.ends[0][k]) + self.ends[0][k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        self.area()
    }
    fn area(&self) -> f64 {
        crosscap_core::squared_distance(&self.ends[0], &self.ends[1]).sqrt()
    }
    fn propose(&self, random: &mut super::Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let at = [random.uniform(), 0.0];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let (a, b) = (&self.ends[0], &self.ends[1]);
        let along: f64 = (0..a.len())
            .map(|k| (place[k] - a[k]) * (b[k] - a[k]))
            .sum();
        let t = (along / crosscap_core::squared_distance(a, b)).clamp(0.0, 1.0);
        let square: f64 = (0..a.len())
            .map(|k| (place[k] - a[k] - t * (b[k] - a[k])).powi(2))
            .sum();
        Some(square.sqrt())
    }
}

/// Axis vectors `a` and `b` of R^`n`.
pub(super) fn axes(n: usize, a: usize, b: usize) -> [Vec<f64>; 2] {
    [a, b].map(|axis| (0..n).map(|k| if k == axis { 1.0 } else { 0.0 }).collect())
}

/// The square of side 2 about a center, in the plane of two coordinate axes.
pub(super) fn square(name: &'static str, center: [f64; 3], a: usize, b: usize) -> Box<dyn Piece> {
    Box::new(Rectangle::new(name, center.to_vec(), axes(3, a, b)))
}
