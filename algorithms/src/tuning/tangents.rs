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
    /// Sine of the steepest angle of the chord of two points with the planes at them, up to which the length along the surface is read from these. *Not measured* against others.
    pub steepest: f64,
    /// A path that is longer than that length by more than this factor goes around something, and is kept. Paths through random points with 20
    /// neighbors each are 1.03 to 1.1 times too long. (A wedge of 45 degrees, landmark seeds 1 to 3: 3 of 3 with 1.12 and with 1.2, one of them
    /// after three attempts rather than five with the latter; the seed 0 that was tried without is refused.)
    pub longer: f64,
    /// Nearest points that the plane of the lifted metric is fitted to. *Not measured* against others.
    pub lifted: usize,
}

impl TangentTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        plane: 16,
        thickness: 0.5,
        steepest: 0.5,
        longer: 1.2,
        lifted: 32,
    };
}
