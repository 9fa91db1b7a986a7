//! A foam: four soap bubbles of one size, each of which touches the three others.

use super::curves::{curve, straight};
use super::flat::rectangle_rim;
use super::surface::SampleSurface;
use super::truth::{DISC, plain};
use super::{CurveKind, Jet, Piece, PieceTruth, PointKind, RimSegment, TrueCurve, Truth};
use std::f64::consts::{FRAC_PI_3, TAU};

type Place = [f64; 3];

/// Directions from the middle into the bubbles: the corners of a tetrahedron, of length sqrt(3).
const CORNERS: [Place; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];
/// Pairs of bubbles.
const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// The outer walls are parts of unit spheres whose centers are one unit from each other: so they meet at 120 degrees.
/// How far the centers are from the middle, squared.
const CENTER_SQUARE: f64 = 3.0 / 8.0;
/// In the plane of a film: how far the center of its outer arc is from the middle, squared, and the radius of the arc, squared.
const ARC: [f64; 2] = [1.0 / 8.0, 3.0 / 4.0];
/// Largest area elements: of a film the squared distance of its farthest place; of an outer wall measured on a grid, with a margin (see the test).
const BOUNDS: [f64; 2] = [1.4875, 2.6];

fn dot(a: Place, b: Place) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn unit(a: Place) -> Place {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn distance(a: Place, b: Place) -> f64 {
    let d = [0, 1, 2].map(|k| a[k] - b[k]);
    dot(d, d).sqrt()
}

fn corner(k: usize) -> Place {
    unit(CORNERS[k])
}

/// The center of the outer wall of a bubble.
fn center(bubble: usize) -> Place {
    corner(bubble).map(|x| x * CENTER_SQUARE.sqrt())
}

/// Half of the angle of a film in the middle, that of two corners of a tetrahedron.
fn half_angle() -> f64 {
    libm::acos(1.0 / 3f64.sqrt())
}

/// How far the outer arc of a film is from the middle, at the angle of this cosine from its own middle.
fn to_arc(cosine: Jet) -> Jet {
    let [middle, radius] = ARC;
    let sine_square = -(cosine * cosine) + 1.0;
    cosine * middle.sqrt() + (-(sine_square * middle) + radius).sqrt()
}

/// The place where the three films beyond a bubble and three outer walls meet.
fn outer_vertex(beyond: usize) -> Place {
    let far = to_arc(Jet::constant(1.0 / 3f64.sqrt())).value;
    corner(beyond).map(|x| -x * far)
}

/// The flat film between two bubbles. Parameters: distance from the middle as a share of that of the outer arc, and angle.
#[derive(Clone, Debug)]
struct Film {
    name: &'static str,
    /// The direction of the middle of the film, and the one in the film at right angles to it.
    frame: [Place; 2],
    normal: Place,
}

impl Film {
    fn of(name: &'static str, [a, b]: [usize; 2]) -> Self {
        let sum = |sign: f64| unit([0, 1, 2].map(|k| CORNERS[a][k] + sign * CORNERS[b][k]));
        let (along, normal) = (sum(1.0), sum(-1.0));
        Self {
            name,
            frame: [along, super::round::cross(normal, along)],
            normal,
        }
    }

    /// A place of its plane by its coordinates.
    fn at(&self, [a, b]: [f64; 2]) -> Place {
        let [x, y] = self.frame;
        [0, 1, 2].map(|k| a * x[k] + b * y[k])
    }

    /// A place on the outer arc, `turn` about its center.
    fn on_arc(&self, turn: f64) -> Place {
        let (s, c) = libm::sincos(turn);
        let [middle, radius] = ARC.map(f64::sqrt);
        self.at([middle + radius * c, radius * s])
    }

    /// Half of the angle of the outer arc about its center.
    fn half_arc() -> f64 {
        let far = to_arc(Jet::constant(1.0 / 3f64.sqrt())).value;
        let (s, c) = libm::sincos(half_angle());
        libm::atan2(far * s, far * c - ARC[0].sqrt())
    }

    /// Distance of a place from the outer arc.
    fn distance_to_arc(&self, place: Place) -> f64 {
        let [x, y] = self.frame.map(|axis| dot(axis, place));
        let most = Self::half_arc();
        let turn = libm::atan2(y, x - ARC[0].sqrt());
        distance(self.on_arc(turn.clamp(-most, most)), place)
    }

    /// The outer arc.
    fn arc(&self, count: usize) -> TrueCurve {
        let most = Self::half_arc();
        curve(CurveKind::Junction, false, count, |t| {
            self.on_arc((2.0 * t - 1.0) * most).into()
        })
    }
}

impl Piece for Film {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-half_angle(), half_angle()]]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [share, angle]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = angle.sin_cos();
        let far = share * to_arc(c);
        let (a, b) = (far * c, far * s);
        for (k, x) in place.iter_mut().enumerate() {
            *x = a * self.frame[0][k] + b * self.frame[1][k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        BOUNDS[0]
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rectangle_rim(self.domain())]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let place = [place[0], place[1], place[2]];
        let [x, y] = self.frame.map(|axis| dot(axis, place));
        let turn = libm::atan2(y, x);
        let inside = turn.abs() <= half_angle()
            && libm::hypot(x, y) <= to_arc(Jet::constant(libm::cos(turn))).value;
        if inside {
            return Some(dot(self.normal, place).abs());
        }
        let to_side = |side: f64| {
            let (s, c) = libm::sincos(side * half_angle());
            let way = self.at([c, s]);
            let far = dot(way, place).clamp(0.0, to_arc(Jet::constant(c)).value);
            distance(way.map(|w| w * far), place)
        };
        let sides = to_side(1.0).min(to_side(-1.0));
        Some(sides.min(self.distance_to_arc(place)))
    }
}

/// The outer wall of a bubble, a part of a unit sphere. Parameters: distance from the middle of the triangle that it is seen in from the middle of
/// the foam as a share of that of its side, and angle.
#[derive(Clone, Debug)]
struct Bubble {
    name: &'static str,
    which: usize,
    /// Two directions at right angles to that of the bubble, the first away from that of another bubble.
    frame: [Place; 2],
}

impl Bubble {
    fn of(name: &'static str, which: usize) -> Self {
        let (own, other) = (corner(which), corner((which + 1) % 4));
        let first = unit([0, 1, 2].map(|k| other[k] - dot(own, other) * own[k]));
        Self {
            name,
            which,
            frame: [first, super::round::cross(own, first)],
        }
    }
}

impl Piece for Bubble {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    /// A whole number of panels of the quadrature between two corners of the triangle.
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-FRAC_PI_3, TAU - FRAC_PI_3]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [share, angle]: [Jet; 2], place: &mut [Jet]) {
        let side = (angle.value / (2.0 * FRAC_PI_3)).round() * 2.0 * FRAC_PI_3;
        let (_, beside) = (angle - side).sin_cos();
        let (s, c) = angle.sin_cos();
        let out = share * (Jet::constant(2f64.sqrt()) / beside);
        // Along the way to the place in the triangle up to the sphere: a quadratic equation.
        let square = out * out + 1.0;
        let middle = CENTER_SQUARE.sqrt();
        let root = (square * (1.0 - CENTER_SQUARE) + CENTER_SQUARE).sqrt();
        let far = (root + middle) / square;
        let (a, b) = (out * c * far, out * s * far);
        let own = corner(self.which);
        for (k, x) in place.iter_mut().enumerate() {
            *x = a * self.frame[0][k] + b * self.frame[1][k] + far * own[k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        BOUNDS[1]
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        let [_, [low, high]] = self.domain();
        vec![super::round::rim_at_first(1.0, [low, high])]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let place = [place[0], place[1], place[2]];
        let from = center(self.which);
        let off = distance(place, from);
        let foot = [0, 1, 2].map(|k| from[k] + (place[k] - from[k]) / off);
        let height = |k: usize| dot(CORNERS[k], foot);
        let inside = (0..4).all(|k| height(k) <= height(self.which) + 1e-15);
        if inside {
            return Some((off - 1.0).abs());
        }
        let beside = PAIRS.into_iter().filter(|pair| pair.contains(&self.which));
        let arcs = beside.map(|pair| Film::of("", pair).distance_to_arc(place));
        Some(arcs.fold(f64::INFINITY, f64::min))
    }
}

/// Truths of the films and walls.
const WALLS: [PieceTruth; 10] = [DISC; 10];

/// Six films and four outer walls.
pub(super) fn foam() -> SampleSurface {
    const FILMS: [&str; 6] = ["film 1", "film 2", "film 3", "film 4", "film 5", "film 6"];
    const OUTER: [&str; 4] = ["wall 1", "wall 2", "wall 3", "wall 4"];
    let film = |k: usize| Film::of(FILMS[k], PAIRS[k]);
    let mut pieces: Vec<Box<dyn Piece>> = Vec::new();
    pieces.extend((0..6).map(|k| Box::new(film(k)) as Box<dyn Piece>));
    pieces.extend((0..4).map(|k| Box::new(Bubble::of(OUTER[k], k)) as Box<dyn Piece>));
    SampleSurface::new(
        "foam",
        "four soap bubbles of one size: six films and four outer walls, in ten junctions that meet in five points",
        pieces,
        Truth {
            junction_curves: 10,
            ..plain([1, 0, 4], &WALLS, 0)
        },
        20_000,
    )
    .singular(move |m| {
        let inner = (0..4).map(|k| straight(CurveKind::Junction, [0.0; 3], outer_vertex(k), m));
        inner.chain((0..6).map(|k| film(k).arc(m))).collect()
    })
    .at(
        PointKind::QuadrupleJunction,
        std::iter::once(vec![0.0; 3]).chain((0..4).map(|k| outer_vertex(k).into())),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::{area_element, place_at};

    #[test]
    fn area_elements_stay_below_their_bounds() {
        let pieces: [Box<dyn Piece>; 2] = [
            Box::new(Film::of("", PAIRS[0])),
            Box::new(Bubble::of("", 0)),
        ];
        let mut place = [Jet::default(); 3];
        for (piece, bound) in pieces.iter().zip(BOUNDS) {
            let [[a, b], [c, d]] = piece.domain();
            let mut largest = 0.0f64;
            for k in 0..400 * 400 {
                let [u, v] = [k / 400, k % 400].map(|i| f64::from(i) / 399.0);
                let at = [a + u * (b - a), c + v * (d - c)];
                piece.map([Jet::first(at[0]), Jet::second(at[1])], &mut place);
                largest = largest.max(area_element(&place));
            }
            assert!(
                largest < bound && 1.2 * largest > bound,
                "{largest} {bound}"
            );
        }
    }

    #[test]
    fn three_walls_meet_at_120_degrees() {
        for vertex in 0..4 {
            let place = outer_vertex(vertex);
            let normals = (0..4).filter(|&k| k != vertex).map(|k| {
                let from = center(k);
                let out = [0, 1, 2].map(|i| place[i] - from[i]);
                assert!((dot(out, out) - 1.0).abs() < 1e-12);
                out
            });
            let normals: Vec<Place> = normals.collect();
            for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                // Outward normals are 60 degrees apart where the walls bend by 120.
                assert!((dot(normals[a], normals[b]) - 0.5).abs() < 1e-12);
            }
        }
        let rim = place_at(&Bubble::of("", 2), [1.0, 0.4]);
        let on_film = PAIRS.map(|pair| Film::of("", pair).closed_form_distance(&rim));
        assert_eq!(on_film.iter().flatten().filter(|&&d| d < 1e-12).count(), 1);
    }
}
