//! When the models of the ends of curves, and of curves by themselves, believe a fit.

use super::PagesTuning;
use serde::{Deserialize, Serialize};

/// What the models of the ends of curves have in common.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveEndTuning {
    /// Greatest share of the points farther than ep from the surface.
    pub astray: f64,
    /// The end lies within this share of the radius.
    pub reach: f64,
    /// A point off the curves tells where they are up to this many ep.
    pub witness: f64,
}

impl CurveEndTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        astray: 0.03,
        reach: 0.7,
        witness: 3.0,
    };
}

/// When a pinch point is believed. *Not measured* apart from each other: with these, 13 of 13 cross-caps of 10,000 points
/// came out right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PinchPointTuning {
    /// What it has in common with other ends.
    pub end: CurveEndTuning,
    /// How far the fold must be followed, in square roots of ep times the natural length of the map: there the
    /// sheet opens wide enough for charts of some four ep to be laid flat across it.
    pub fold_length: f64,
    /// How far at least, in ep: as far as a chart of three dl reaches, at some four ep each.
    pub fold: f64,
}

impl PinchPointTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        end: CurveEndTuning::MEASURED,
        fold_length: 2.5,
        fold: 14.0,
    };
}

/// When the rim of a sheet that another one crosses is believed. They mean what those of
/// [`BoundaryTuning`](super::BoundaryTuning) do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RimTuning {
    /// Points that would have to lie beyond the rim.
    pub missing: f64,
    /// Greatest curvature of the parabola, in units of one over the radius.
    pub bend: f64,
    /// Points that a sheet would have about the end before it has one, at most: that many are missing by chance in one of e^6 places.
    pub open: f64,
}

impl RimTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        missing: 10.0,
        bend: 3.0,
        open: 6.0,
    };
}

/// When any number of pages in a curve are believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BookTuning {
    /// Share of the points that may be farther than ep from the sheets.
    pub astray: f64,
    /// How its pages are read.
    pub pages: PagesTuning,
    /// Least share of the points that a page holds.
    pub share: f64,
    /// Farthest that a point is moved, in radii.
    pub step: f64,
    /// A point off the curve tells where it is up to this many ep.
    pub witness: f64,
    /// Every page has a point this close to a place on the curve, in radii.
    pub support: f64,
}

impl BookTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        astray: CurveEndTuning::MEASURED.astray,
        pages: PagesTuning::MEASURED,
        share: 0.04,
        step: 0.6,
        witness: 3.0,
        support: 0.6,
    };
}

/// When the end of a curve of pages is believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BookEndTuning {
    /// What it has in common with other ends.
    pub end: CurveEndTuning,
    /// How its pages are read.
    pub pages: PagesTuning,
    /// Boundaries of the sheets.
    pub rim: RimTuning,
    /// Least cosine of the angle of the curve and the way out of a sheet.
    pub crossing: f64,
    /// The curve meets the boundaries at most so many spacings of the points of a page apart: each runs inside the true
    /// one by about half a spacing, and a page on one side has nothing to hold its parabola beyond the curve.
    pub apart: f64,
    /// The same in ep.
    pub apart_ep: f64,
    /// Farthest that the center is from the curve, as a share of the radius.
    pub step: f64,
}

impl BookEndTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        end: CurveEndTuning::MEASURED,
        pages: PagesTuning::MEASURED,
        rim: RimTuning::MEASURED,
        crossing: 0.5,
        apart: 2.0,
        apart_ep: 3.0,
        step: 0.6,
    };
}

/// When a corner of a boundary is believed. Lengths are in radii of the ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundaryCornerTuning {
    /// Farthest that the corner is from the center.
    pub reach: f64,
    /// Greatest bend of the arms, half of their second derivative.
    pub arm_bend: f64,
    /// Greatest coefficients of the square, the cube and the fourth power in a smooth boundary over its tangent. The first is half of its
    /// curvature, 0.4 radii of curvature; with the third a circle of such a radius is followed for most of the ball.
    pub smooth: [f64; 3],
    /// Points that would have to lie between the smooth boundary and the corner. In balls of 2 and 2.8 eps about points of discs, ellipses of 2:1 and 3:1,
    /// holes and a square with round corners there were up to 7, at nearly all corners of 36 to 110 degrees, and of 235 and 270, more.
    pub missing: f64,
    /// Most points that may be missing between the corner and the point nearest to it: so many are by chance in one of 50 places.
    /// Between it and the next, at most twice as many: a point that lies off the boundary by itself is no corner.
    pub tip: f64,
    /// Most points that may be missing below an arm of a corner that goes inward, in any sector from the corner to the first point. The lowest curve over a notch of less than
    /// 80 degrees can lie in the air beside one of its sides (60 degrees: 56 of 200 random ones, the corner up to 0.56 radii off). So many are missing by chance in one of 500 corners.
    pub arm: f64,
    /// A point off the boundary tells where it is up to this many ep.
    pub witness: f64,
}

impl BoundaryCornerTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        reach: 0.7,
        arm_bend: 0.35,
        smooth: [1.25, 0.5, 0.3],
        missing: 8.0,
        tip: 4.0,
        arm: 12.0,
        witness: 3.0,
    };
}
