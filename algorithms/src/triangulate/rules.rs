//! What a triangle must satisfy beside being compatible with those that are there.

use serde::{Deserialize, Serialize};

/// Switches between what was measured to work and the paper's text.
///
/// Whatever they say, a triangle is compatible with the triangles and curve edges of its chart, and is
/// added once.
///
/// ```
/// use crosscap_algorithms::triangulate::Rules;
/// assert_eq!(Rules::default(), Rules::MEASURED);
/// assert!(Rules::MEASURED.empty && !Rules::PAPER.empty);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rules {
    /// No landmark of the chart lies in a triangle.
    pub empty: bool,
    /// No edge but those of the chain joins landmarks few steps apart on one curve.
    pub shortcuts: bool,
    /// No more triangles at an edge than the cells that meet there: two at an ordinary edge, one
    /// a chart at a curve edge.
    pub edge_counts: bool,
    /// The stars of curve landmarks are completed, cell by cell.
    pub curve_stars: bool,
}

impl Rules {
    /// All of them.
    pub const MEASURED: Self = Self {
        empty: true,
        shortcuts: true,
        edge_counts: true,
        curve_stars: true,
    };
    /// None of them: compatibility alone (Martin & Watson 2011, section 2.2.2).
    pub const PAPER: Self = Self {
        empty: false,
        shortcuts: false,
        edge_counts: false,
        curve_stars: false,
    };
}

impl Default for Rules {
    fn default() -> Self {
        Self::MEASURED
    }
}
