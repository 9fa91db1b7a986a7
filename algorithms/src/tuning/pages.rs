//! How the pages of a book are read from points.

use serde::{Deserialize, Serialize};

/// What tells the half sheets that meet in a curve from the points around it. *Not measured* apart from each other: with these,
/// books of 3 to 8 pages, T-junctions and the ends of both came out as `docs/src/models/book.md` says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PagesTuning {
    /// Greatest share of the second variance that the third one has where the nearest points lie on one page.
    pub flat: f64,
    /// Distance of the plane of a piece of a page from the curve, in radii, from which the piece counts less.
    pub aside: f64,
    /// Part of the normal of a piece along the curve from which the piece counts less.
    pub tilt: f64,
    /// Least mean square of the normals in the second direction: with less the pages are one sheet.
    pub across: f64,
    /// Points nearer to the curve than this share of the radius do not tell their page.
    pub near: f64,
    /// Least angle between two pages in which there is no point, in radians.
    pub gap: f64,
    /// Greatest angle under which one page is seen, in radians.
    pub widest: f64,
    /// Least share of the points that a page holds.
    pub share: f64,
    /// Two pages at an angle that is straight up to this, in radians, are one sheet.
    pub straight: f64,
    /// The same of three pages of which no two are: the two sides of a sheet that bends by a quarter of the ball's radius are seen to turn by
    /// 0.4 from the line. Where three sheets meet at such an angle, the Y-junction competes.
    pub bent: f64,
    /// Sheets that meet at an angle of a smaller sine do not locate a curve.
    pub sine: f64,
    /// Where the sides of a sheet are told apart, in radii from the curve.
    pub out: f64,
}

impl PagesTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        flat: 0.05,
        aside: 0.05,
        tilt: 0.15,
        across: 0.04,
        near: 0.3,
        gap: 0.2,
        widest: 0.6,
        share: 0.03,
        straight: 0.3,
        bent: 0.6,
        sine: 0.15,
        out: 0.5,
    };
}
