//! Plates that meet in a common side: books, and plates that stand on others.

use super::curves::{path, straight};
use super::flat::square;
use super::surface::SampleSurface;
use super::truth::{DISC, plain};
use super::{CurveKind, Piece, PieceTruth, PointKind, Rectangle, Truth};
use std::f64::consts::TAU;

/// The ends of the common side of the pages of a book.
const SPINE: [[f64; 3]; 2] = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];

/// Names of the pages of a book.
pub(super) const PAGES: [&str; 8] = [
    "page 1", "page 2", "page 3", "page 4", "page 5", "page 6", "page 7", "page 8",
];
/// Truths of as many flat pieces as there are in one surface at most.
pub(super) const DISCS: [PieceTruth; 8] = [DISC; 8];

/// Directions of the pages of a book about the y axis.
fn page(k: usize, pages: usize) -> [f64; 3] {
    let (s, c) = libm::sincos(TAU * k as f64 / pages as f64);
    [c, 0.0, s]
}

/// `pages` rectangles, 1 wide and 2 high, with one side in common, at equal angles.
pub(super) fn book(name: &'static str, summary: &'static str, pages: usize) -> SampleSurface {
    let piece = |k: usize| -> Box<dyn Piece> {
        let half = page(k, pages).map(|x| 0.5 * x).to_vec();
        let sides = [half.clone(), vec![0.0, 1.0, 0.0]];
        Box::new(Rectangle::new(PAGES[k], half, sides))
    };
    let cells = pages as u8;
    SampleSurface::new(
        name,
        summary,
        (0..pages).map(piece).collect(),
        Truth {
            books: 1,
            ..plain([1, 0, 0], &DISCS[..pages], pages)
        },
        2_500 * pages,
    )
    .singular(move |m| vec![straight(CurveKind::Book { cells }, SPINE[0], SPINE[1], m)])
    .bounded_by(move |m| {
        let around = |k: usize| {
            let [x, _, z] = page(k, pages);
            vec![SPINE[0], [x, -1.0, z], [x, 1.0, z], SPINE[1]]
        };
        let rim = |k| path(CurveKind::Boundary, around(k), m);
        (0..pages).map(rim).collect()
    })
    .at(PointKind::CurveEnd, SPINE.map(Vec::from))
}

/// A plate that stands on a horizontal square of side 2, `half_width` to either side of the middle.
pub(super) fn plate_on_plate(
    name: &'static str,
    summary: &'static str,
    half_width: f64,
) -> SampleSurface {
    let sides = [vec![0.0, half_width, 0.0], vec![0.0, 0.0, 0.5]];
    let ends = [[0.0, -half_width, 0.0], [0.0, half_width, 0.0]];
    let across = half_width == 1.0;
    let kind = if across {
        PointKind::CurveEnd
    } else {
        PointKind::SideSheetEnd
    };
    SampleSurface::new(
        name,
        summary,
        vec![
            square("lying plate", [0.0; 3], 0, 1),
            Box::new(Rectangle::new("standing plate", vec![0.0, 0.0, 0.5], sides)),
        ],
        Truth {
            junction_curves: 1,
            ..plain([1, 0, 0], &[DISC, DISC], if across { 3 } else { 2 })
        },
        7_500,
    )
    .singular(move |m| vec![straight(CurveKind::Junction, ends[0], ends[1], m)])
    .bounded_by(move |m| {
        let up = |[x, y, _]: [f64; 3]| [x, y, 1.0];
        let side = |x: f64| vec![ends[0], [x, -1.0, 0.0], [x, 1.0, 0.0], ends[1]];
        let mut rims = vec![vec![ends[0], up(ends[0]), up(ends[1]), ends[1]]];
        if across {
            rims.extend([side(-1.0), side(1.0)]);
        } else {
            let corners = [
                [-1.0, -1.0],
                [1.0, -1.0],
                [1.0, 1.0],
                [-1.0, 1.0],
                [-1.0, -1.0],
            ];
            rims.push(corners.map(|[x, y]| [x, y, 0.0]).into());
        }
        let rims = rims.into_iter();
        rims.map(|rim| path(CurveKind::Boundary, rim, m)).collect()
    })
    .at(kind, ends.map(Vec::from))
}
