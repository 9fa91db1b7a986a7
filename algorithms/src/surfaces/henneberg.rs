//! Henneberg's minimal surface.

use super::round::rim_at_first;
use super::{Jet, Piece, RimSegment};
use std::f64::consts::{PI, TAU};

/// The ring 0.4 <= r <= 0.6 of Henneberg's surface (paper, section 4): an annulus that crosses
/// itself in four arcs. Parameters: r, t.
#[derive(Clone, Copy, Debug)]
pub struct Henneberg;

/// Range of r.
const RANGE: [f64; 2] = [0.4, 0.6];

impl Henneberg {
    /// The pairs of parameters with the same place, along the four double arcs, at radius `r`.
    ///
    /// With w = 3 r^2 / (r^4 + r^2 + 1): the reflection t -> pi - t changes the sign of x alone, and x
    /// vanishes off the axis of that reflection where cos 2t = (1 + w) / 2; t -> -t does the
    /// same with y, where cos 2t = -(1 + w) / 2.
    pub fn double_parameters(r: f64) -> [[[f64; 2]; 2]; 4] {
        let square = r * r;
        let w = 3.0 * square / (square * square + square + 1.0);
        let a = 0.5 * libm::acos(0.5 * (1.0 + w));
        let b = 0.5 * libm::acos(-0.5 * (1.0 + w));
        [[a, PI - a], [-a, PI + a], [b, -b], [PI - b, PI + b]].map(|pair| pair.map(|t| [r, t]))
    }

    /// Range of the radius.
    pub fn range() -> [f64; 2] {
        RANGE
    }
}

impl Piece for Henneberg {
    fn name(&self) -> &'static str {
        "annulus"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [RANGE, [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [r, t]: [Jet; 2], place: &mut [Jet]) {
        let ((s, c), (s2, c2)) = (t.sin_cos(), (t * 2.0).sin_cos());
        let (s3, c3) = (s2 * c + c2 * s, c2 * c - s2 * s);
        let inverse = Jet::constant(1.0) / r;
        let (cube, inverse_cube) = (r * r * r, inverse * inverse * inverse);
        let (first, third) = ((r - inverse) * 2.0, (cube - inverse_cube) * (2.0 / 3.0));
        place[0] = first * c - third * c3;
        place[1] = -(first * s + third * s3);
        place[2] = (r * r + inverse * inverse) * c2 * 2.0;
    }
    fn area_element_bound(&self) -> f64 {
        // The metric is conformal with factor 2 |1 - z^-4| (1 + r^2), z = r e^(it); the element
        // 4 r (1 + r^2)^2 |1 - z^-4|^2 is largest at the inner rim, where z^4 < 0.
        let r = RANGE[0];
        let square = r * r;
        let factor = (1.0 + square) * (1.0 + 1.0 / (square * square));
        4.0 * r * factor * factor * (1.0 + 1e-12)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        RANGE.map(|r| rim_at_first(r, [0.0, TAU])).into()
    }
}
