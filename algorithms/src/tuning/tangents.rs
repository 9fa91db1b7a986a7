//! Numbers of the tangent planes of a cloud, for the metrics that need them.

use serde::{Deserialize, Serialize};

/// What planes are fitted to, and when they say that two points are on one sheet. Of forty prisms with creases of 30 to 90 degrees 34 passed with these numbers, with no parameters, and 25 by straight
/// edges between all near points; where the graph was used from the start it was 33, and 20 with 24 points and a thickness of 0.35.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TangentTuning {
    /// Nearest points that a plane is sought among.
    pub plane: usize,
    /// Two points are on one sheet where one is at most so far from the plane at the other, in spacings of the points: as far as a
    /// surface bends away whose radius is six spacings, within the two and a half that twenty nearest points reach.
    pub thickness: f64,
    /// Nearest points that the plane of the lifted metric is fitted to. *Not measured* against others.
    pub lifted: usize,
}

impl TangentTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 16,
        thickness: 0.5,
        lifted: 32,
    };
}
