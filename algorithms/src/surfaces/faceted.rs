//! Solids with creases and corners: a triangle as a piece, and surfaces made of faces.

use super::books::DISCS;
use super::curves::{circle, straight};
use super::flat::axes;
use super::surface::SampleSurface;
use super::truth::{ANNULUS, DISC, plain};
use super::{
    CurveKind, Cylinder, Jet, Piece, PointKind, Random, Rectangle, RimSegment, Ring, Truth,
};
use crosscap_core::squared_distance;
use std::f64::consts::TAU;

/// A flat triangle of space. Parameters: distance from the first corner as a share of that of the opposite side, and where
/// it goes through that side.
#[derive(Clone, Debug)]
pub struct Triangle {
    name: &'static str,
    corners: [[f64; 3]; 3],
}

fn between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| b[k] - a[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

impl Triangle {
    /// The triangle of three corners, not on a line.
    pub fn new(name: &'static str, corners: [[f64; 3]; 3]) -> Self {
        Self { name, corners }
    }

    /// Twice its area.
    fn double_area(&self) -> f64 {
        let [a, b, c] = self.corners;
        let (u, v) = (between(a, b), between(a, c));
        (dot(u, u) * dot(v, v) - dot(u, v).powi(2)).sqrt()
    }
}

impl Piece for Triangle {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [share, across]: [Jet; 2], place: &mut [Jet]) {
        let [a, b, c] = self.corners;
        let (side, out) = (between(b, c), between(a, b));
        for (k, x) in place.iter_mut().enumerate() {
            *x = share * out[k] + share * across * side[k] + a[k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        self.double_area() * (1.0 + 1e-12)
    }
    fn area(&self) -> f64 {
        0.5 * self.double_area()
    }
    /// The squared distance from the first corner is uniform.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let at = [random.uniform().sqrt(), random.uniform()];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        // The first corner is both of the last two.
        let corners = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let rim = [[0, 1], [1, 2], [3, 0]].map(|[from, to]| RimSegment {
            from: corners[from],
            to: corners[to],
        });
        vec![rim.into()]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let [a, b, c] = self.corners;
        let x = [place[0], place[1], place[2]];
        let (u, v, d) = (between(a, b), between(a, c), between(a, x));
        let (uu, uv, vv, du, dv) = (dot(u, u), dot(u, v), dot(v, v), dot(d, u), dot(d, v));
        let scale = uu * vv - uv * uv;
        let (s, t) = ((vv * du - uv * dv) / scale, (uu * dv - uv * du) / scale);
        let squared = if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
            squared_distance(&d, &[0, 1, 2].map(|k| s * u[k] + t * v[k]))
        } else {
            let to_side = |[p, q]: [[f64; 3]; 2]| {
                let (along, off) = (between(p, q), between(p, x));
                let share = (dot(off, along) / dot(along, along)).clamp(0.0, 1.0);
                squared_distance(&off, &along.map(|e| share * e))
            };
            [[a, b], [b, c], [c, a]]
                .map(to_side)
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        Some(squared.sqrt())
    }
}

/// Creases between places.
fn creases(
    sides: Vec<[[f64; 3]; 2]>,
) -> impl Fn(usize) -> Vec<super::TrueCurve> + Send + Sync + 'static {
    move |m| {
        let crease = |&[from, to]: &[[f64; 3]; 2]| straight(CurveKind::Crease, from, to, m);
        sides.iter().map(crease).collect()
    }
}

/// The regular octahedron whose corners are one unit from the origin, on the axes.
fn octahedron() -> SampleSurface {
    const NAMES: [&str; 8] = [
        "face 1", "face 2", "face 3", "face 4", "face 5", "face 6", "face 7", "face 8",
    ];
    let corner = |axis: usize, sign: f64| [0, 1, 2].map(|k| if k == axis { sign } else { 0.0 });
    let sign = |k: usize, axis: usize| if k >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let face = |k: usize| -> Box<dyn Piece> {
        Box::new(Triangle::new(
            NAMES[k],
            [0, 1, 2].map(|axis| corner(axis, sign(k, axis))),
        ))
    };
    let sides = [[0, 1], [1, 2], [0, 2]].into_iter().flat_map(|[a, b]| {
        let signs = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
        signs.map(|[s, t]| [corner(a, s), corner(b, t)])
    });
    SampleSurface::new(
        "octahedron",
        "the surface of a regular octahedron",
        (0..8).map(face).collect(),
        Truth {
            creases: 12,
            ..plain([1, 0, 1], &DISCS, 0)
        },
        8_000,
    )
    .singular(creases(sides.collect()))
    .at(
        PointKind::Corner,
        (0..6).map(|k| corner(k / 2, if k % 2 == 0 { -1.0 } else { 1.0 }).into()),
    )
}

/// A prism over an equilateral triangle.
fn prism() -> SampleSurface {
    let corner = |k: usize, z: f64| {
        let (s, c) = libm::sincos(TAU * k as f64 / 3.0);
        [c, s, z]
    };
    let side = |name, k: usize| -> Box<dyn Piece> {
        let [a, b] = [corner(k, 0.0), corner((k + 1) % 3, 0.0)];
        let middle = [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
        let half = between(middle, b);
        Box::new(Rectangle::new(
            name,
            middle.into(),
            [half.into(), vec![0.0, 0.0, 1.0]],
        ))
    };
    let lid = |name, z| -> Box<dyn Piece> {
        Box::new(Triangle::new(name, [0, 1, 2].map(|k| corner(k, z))))
    };
    let around = |z: f64| (0..3).map(move |k| [corner(k, z), corner((k + 1) % 3, z)]);
    let up = (0..3).map(|k| [corner(k, -1.0), corner(k, 1.0)]);
    SampleSurface::new(
        "prism",
        "the surface of a prism of height 2 over an equilateral triangle",
        vec![
            side("side 1", 0),
            side("side 2", 1),
            side("side 3", 2),
            lid("bottom", -1.0),
            lid("top", 1.0),
        ],
        Truth {
            creases: 9,
            ..plain([1, 0, 1], &DISCS[..5], 0)
        },
        12_000,
    )
    .singular(creases(around(-1.0).chain(around(1.0)).chain(up).collect()))
    .at(
        PointKind::Corner,
        (0..6).map(|k| corner(k % 3, if k < 3 { -1.0 } else { 1.0 }).into()),
    )
}

/// A cylinder with both lids.
fn can() -> SampleSurface {
    let lid = |name, z| -> Box<dyn Piece> {
        Box::new(Ring::new(
            name,
            vec![0.0, 0.0, z],
            axes(3, 0, 1),
            [0.0, 1.0],
        ))
    };
    SampleSurface::new(
        "can",
        "a cylinder of radius 1 and height 2 with both lids",
        vec![
            Box::new(Cylinder::new("side", 1.0, 1.0)),
            lid("bottom", -1.0),
            lid("top", 1.0),
        ],
        Truth {
            creases: 2,
            ..plain([1, 0, 1], &[ANNULUS, DISC, DISC], 0)
        },
        12_000,
    )
    .singular(|m| {
        [-1.0, 1.0]
            .map(|z| circle(CurveKind::Crease, 1.0, z, m))
            .into()
    })
}

/// Surfaces of faces that meet in creases.
pub(super) fn faceted_surfaces() -> Vec<SampleSurface> {
    vec![octahedron(), prism(), can()]
}
