//! Flat plates with corners.

use super::flat::Polygon;
use super::surface::SampleSurface;
use super::truth::{DISC, plain};
use super::{Piece, PointKind};
use std::f64::consts::PI;

/// Radii of the tips and of the notches of the star.
const STAR: [f64; 2] = [1.0, 0.5];

pub(super) fn plates() -> Vec<SampleSurface> {
    let l = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    let star = (0..10).map(|k| {
        let (sin, cos) = libm::sincos(PI * f64::from(k) / 5.0);
        [cos, sin].map(|x| STAR[k as usize % 2] * x)
    });
    vec![
        plate(
            "l_plate",
            "a flat plate like an L: five corners, and one that goes inward",
            l.to_vec(),
        ),
        plate(
            "star_plate",
            "a flat star: five tips of 53 degrees, five corners that go inward",
            star.collect(),
        ),
    ]
}

/// A plate with a corner at each of the given places, in their order around it.
fn plate(name: &'static str, summary: &'static str, corners: Vec<[f64; 2]>) -> SampleSurface {
    let places: Vec<Vec<f64>> = corners.iter().map(|&[x, y]| vec![x, y, 0.0]).collect();
    let piece: Box<dyn Piece> = Box::new(Polygon::new("plate", corners));
    SampleSurface::new(
        name,
        summary,
        vec![piece],
        plain([1, 0, 0], &[DISC], 1),
        3_000,
    )
    .at(PointKind::BoundaryCorner, places)
}
