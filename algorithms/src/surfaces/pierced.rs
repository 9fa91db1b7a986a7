//! A cube with a square hole through it.

use super::curves::straight;
use super::flat::{Rectangle, rectangle_rim, square};
use super::surface::SampleSurface;
use super::truth::{ANNULUS, DISC, PieceTruth, plain};
use super::{CurveKind, Jet, Piece, PointKind, RimSegment, Truth};

/// Half of the side of the hole; that of the cube is 1.
const HOLE: f64 = 0.4;

/// A square of side 2 with a square hole in its middle, across the third axis. Parameters: the first two coordinates.
struct Frame {
    name: &'static str,
    height: f64,
}

impl Piece for Frame {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [x, y]: [Jet; 2], place: &mut [Jet]) {
        place.copy_from_slice(&[x, y, Jet::constant(self.height)]);
    }
    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        x.abs().max(y.abs()) >= HOLE
    }
    fn area_element_bound(&self) -> f64 {
        1.0
    }
    fn area(&self) -> f64 {
        4.0 * (1.0 - HOLE * HOLE)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        let around = |half: f64| rectangle_rim([[-half, half]; 2]);
        vec![around(1.0), around(HOLE)]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let [x, y] = [place[0].abs(), place[1].abs()];
        let beside = if x.max(y) < HOLE {
            HOLE - x.max(y)
        } else {
            (x - 1.0).max(0.0).hypot((y - 1.0).max(0.0))
        };
        Some(beside.hypot(place[2] - self.height))
    }
}

/// The corners of the square about the third axis with this half side, in order around it.
fn around(half: f64) -> [[f64; 2]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| p.map(|x| half * x))
}

/// The ends of all creases: around the hole and the cube at both heights, and up.
fn creases() -> Vec<[[f64; 3]; 2]> {
    let mut all = Vec::new();
    for half in [1.0, HOLE] {
        let corners = around(half);
        for (k, [x, y]) in corners.into_iter().enumerate() {
            let [u, v] = corners[(k + 1) % 4];
            all.extend([-1.0, 1.0].map(|z| [[x, y, z], [u, v, z]]));
            all.push([[x, y, -1.0], [x, y, 1.0]]);
        }
    }
    all
}

const FACES: [PieceTruth; 10] = [
    DISC, DISC, DISC, DISC, DISC, DISC, DISC, DISC, ANNULUS, ANNULUS,
];

/// Ten faces: four outer and four inner walls, and two frames.
pub(super) fn cube_with_hole() -> SampleSurface {
    const INNER: [&str; 4] = ["inner left", "inner right", "inner front", "inner back"];
    let wall = |k: usize| -> Box<dyn Piece> {
        let (axis, side) = (k / 2, [-HOLE, HOLE][k % 2]);
        let only = |at: usize, x: f64| [0, 1, 2].map(|i| if i == at { x } else { 0.0 }).to_vec();
        Box::new(Rectangle::new(
            INNER[k],
            only(axis, side),
            [only(1 - axis, HOLE), only(2, 1.0)],
        ))
    };
    let mut pieces = vec![
        square("left", [-1.0, 0.0, 0.0], 1, 2),
        square("right", [1.0, 0.0, 0.0], 1, 2),
        square("front", [0.0, -1.0, 0.0], 0, 2),
        square("back", [0.0, 1.0, 0.0], 0, 2),
    ];
    pieces.extend((0..4).map(wall));
    for (name, height) in [("bottom", -1.0), ("top", 1.0)] {
        pieces.push(Box::new(Frame { name, height }));
    }
    SampleSurface::new(
        "cube_with_hole",
        "the surface of a cube of side 2 with a square hole of side 0.8 through it",
        pieces,
        Truth {
            creases: 24,
            ..plain([1, 2, 1], &FACES, 0)
        },
        12_500,
    )
    .singular(|m| {
        let crease = |[from, to]: [[f64; 3]; 2]| straight(CurveKind::Crease, from, to, m);
        creases().into_iter().map(crease).collect()
    })
    .at(
        PointKind::Corner,
        [1.0, HOLE].into_iter().flat_map(|half| {
            let corners = around(half).into_iter();
            corners.flat_map(|[x, y]| [-1.0, 1.0].map(|z| vec![x, y, z]))
        }),
    )
}
