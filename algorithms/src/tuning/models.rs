//! When the singularity models of the program believe a fit.
//!
//! Names that several models share mean the same in each. Their values differ where the models see
//! different things: the more sheets, the fewer points on each, and the wider a plane has to be while it is looked for.

use super::ends::{BookEndTuning, BookTuning, BoundaryCornerTuning, PinchPointTuning};
use serde::{Deserialize, Serialize};

/// When the models that come with the program believe a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelTuning {
    /// Two sheets that cross.
    pub two_planes: TwoPlanesTuning,
    /// Three sheets that end in a curve.
    pub y_junction: YJunctionTuning,
    /// Three sheets that cross in a point.
    pub triple_point: TriplePointTuning,
    /// Two sheets of R^4 that cross in a point.
    pub isolated_crossing: IsolatedCrossingTuning,
    /// A sheet that ends.
    pub boundary: BoundaryTuning,
    /// A sheet whose boundary has a corner.
    pub boundary_corner: BoundaryCornerTuning,
    /// A curve that pierces a sheet or ends on it.
    pub curve_and_sheet: CurveAndSheetTuning,
    /// A double curve that ends inside a sheet.
    pub pinch_point: PinchPointTuning,
    /// Any number of sheets in a curve.
    pub book: BookTuning,
    /// A curve that ends where its sheets do.
    pub book_end: BookEndTuning,
    /// A surface that is like the tip of a cone.
    pub cone_point: ConePointTuning,
}

impl ModelTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        two_planes: TwoPlanesTuning::MEASURED,
        y_junction: YJunctionTuning::MEASURED,
        triple_point: TriplePointTuning::MEASURED,
        isolated_crossing: IsolatedCrossingTuning::MEASURED,
        boundary: BoundaryTuning::MEASURED,
        boundary_corner: BoundaryCornerTuning::MEASURED,
        curve_and_sheet: CurveAndSheetTuning::MEASURED,
        pinch_point: PinchPointTuning::MEASURED,
        book: BookTuning::MEASURED,
        book_end: BookEndTuning::MEASURED,
        cone_point: ConePointTuning::MEASURED,
    };
}

impl Default for ModelTuning {
    fn default() -> Self {
        Self::MEASURED
    }
}

/// When two sheets that cross are believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoPlanesTuning {
    /// Share of the points that three of the four cells must hold.
    pub cell_share: f64,
    /// Points of a sheet spread in two directions: the lesser variance is at least this share of the
    /// greater, or they are a curve, which lies in many planes.
    pub narrowness: f64,
    /// Greatest share of the points farther than ep from both sheets: more are a third sheet, which
    /// would bend the two that are fitted.
    pub astray: f64,
    /// Farthest that a center is moved, as a share of the radius.
    pub step: f64,
    /// Three cells have a point this close to the crossing, as a share of the radius.
    pub support: f64,
    /// A point off the curve tells where the curve is up to this many ep.
    pub witness: f64,
    /// Patches that meet at a smaller angle (sine) do not locate a curve.
    pub sine: f64,
}

impl TwoPlanesTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        cell_share: 0.03,
        narrowness: 0.01,
        astray: 0.03,
        step: 0.6,
        support: 0.6,
        witness: 3.0,
        sine: 0.15,
    };
}

/// When three sheets on a curve are believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct YJunctionTuning {
    /// Points within this share of the radius of a plane belong to it while planes are looked for.
    pub plane: f64,
    /// Greatest part of the normals along the curve, as a mean square: they lie in one plane.
    pub along: f64,
    /// Two sheets meet at this angle (sine) at least.
    pub sine: f64,
    /// Greatest share of the points of a plane on the half that is not there.
    pub beyond: f64,
    /// Farthest that a center is moved, as a share of the radius.
    pub step: f64,
    /// Each cell has a point this close to the junction, as a share of the radius.
    pub support: f64,
    /// A point off the curve tells where the curve is up to this many ep.
    pub witness: f64,
    /// Patches that meet at a smaller angle (sine) do not locate a curve.
    pub meet: f64,
}

impl YJunctionTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 0.12,
        along: 0.05,
        sine: 0.2,
        beyond: 0.2,
        step: 0.6,
        support: 0.6,
        witness: 3.0,
        meet: 0.15,
    };
}

/// When three sheets through a point are believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriplePointTuning {
    /// Points within this share of the radius of a plane belong to it while planes are looked for.
    pub plane: f64,
    /// Least share of the points that a sheet must hold.
    pub sheet_share: f64,
    /// Least determinant of the three unit normals.
    pub determinant: f64,
    /// The triple point lies within this share of the radius.
    pub reach: f64,
    /// Cells that must hold points, of twelve.
    pub cells: usize,
    /// Patches that meet at a smaller angle (sine) locate neither curve nor point.
    pub meet: f64,
}

impl TriplePointTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 0.12,
        sheet_share: 0.06,
        determinant: 0.15,
        reach: 0.85,
        cells: 8,
        meet: 0.15,
    };
}

/// When two sheets through a point of R^4 are believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IsolatedCrossingTuning {
    /// Points within this share of the radius of a plane belong to it while planes are looked for.
    pub plane: f64,
    /// Least share of the points on each sheet.
    pub sheet_share: f64,
    /// Least product of the sines of the two angles between the sheets.
    pub determinant: f64,
    /// The crossing lies within this share of the radius.
    pub reach: f64,
    /// Least variance of the points in the fourth of the principal directions, as a share of the squared radius.
    /// The smallest second sheet that is accepted, with 6 % of the points at the least angle and the greatest distance, has
    /// three times as much off the first one; two sheets in a space of three dimensions, which cross in curves, have none.
    pub fourth: f64,
}

impl IsolatedCrossingTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 0.15,
        sheet_share: 0.06,
        determinant: 0.1,
        reach: 0.9,
        fourth: 1e-5,
    };
}

/// When the end of a sheet is believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundaryTuning {
    /// Least distance of the center from the middle of the neighborhood, as a share of the radius: it is
    /// 0.42 on a straight boundary.
    pub shift: f64,
    /// Least share of the variance across the widest direction that the half ball about the center has: it is
    /// 0.28 on a straight boundary, and 0 where the center is on a curve.
    pub breadth: f64,
    /// Points that would have to lie beyond the boundary.
    pub missing: f64,
    /// Greatest curvature of the parabola, in units of one over the radius.
    pub bend: f64,
    /// Farthest that a center in the band is moved, in ep: a band's width across and one up or down.
    pub step: f64,
    /// A point off the boundary tells where it is up to this many ep.
    pub witness: f64,
}

impl BoundaryTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        shift: 0.2,
        breadth: 0.05,
        missing: 10.0,
        bend: 3.0,
        step: 1.5,
        witness: 3.0,
    };
}

/// When a curve that meets a sheet in a point is believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveAndSheetTuning {
    /// Points within this share of the radius of a plane belong to it while it is looked for.
    pub plane: f64,
    /// Farthest that the point may be, as a share of the radius.
    pub reach: f64,
    /// The sheet is fitted to points farther than this many ep from the curve.
    pub clear: f64,
    /// Fewest points of an arc.
    pub arc: usize,
}

impl CurveAndSheetTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 0.1,
        reach: 0.95,
        clear: 1.5,
        arc: 2,
    };
}

/// When the tip of a cone is believed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConePointTuning {
    /// Least eigenvalue of the quadratic form as a share of the greatest, in size: half angles from 13 to 77 degrees for round cones.
    pub sharpness: f64,
    /// The tip lies within this share of the radius.
    pub reach: f64,
    /// Greatest half width of a neck, or of a gap between two sheets, in spacings of the points: a neck of one spacing has six points
    /// around. Measured at nodes of cubic and quartic surfaces, which the quadric follows to second order alone: up to 0.4.
    pub neck: f64,
    /// Greatest share of the points farther than ep from the cone.
    pub astray: f64,
}

impl ConePointTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        sharpness: 0.05,
        reach: 0.7,
        neck: 0.6,
        astray: 0.03,
    };
}
