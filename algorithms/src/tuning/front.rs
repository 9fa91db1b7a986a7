//! What decides how the front goes on where a star cannot be closed.

use serde::Serialize;

/// Numbers of the advancing front. None of them was varied on its own before the ablation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrontTuning {
    /// How many of the nearest members of a chart lose their triangles in a repair, one attempt after another: wider and
    /// wider, since most stars are closed by the first ones.
    pub tears: [usize; 6],
    /// The same for an attempt that gives a landmark up.
    pub tears_of_drop: [usize; 2],
    /// A tear is tried where it reaches fewer than this many members beyond the chart.
    pub beyond_chart: usize,
    /// How many nearest neighbors are tried as the landmark to give up where tearing does not help.
    pub drops: usize,
    /// Repairs tried in all, beside the share of the landmarks below: data that no triangulation fits would otherwise be torn
    /// up star by star.
    pub attempts: usize,
    /// One repair more for so many landmarks.
    pub landmarks_per_attempt: usize,
    /// Passes over the stars of curve landmarks: a repair of one may open another.
    pub curve_passes: usize,
    /// Two landmarks of a curve closer than this many steps along it are joined by chain edges only.
    pub shortcut_steps: usize,
}

impl FrontTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        tears: [0, 4, 8, 12, 18, 26],
        tears_of_drop: [0, 8],
        beyond_chart: 4,
        drops: 6,
        attempts: 400,
        landmarks_per_attempt: 4,
        curve_passes: 4,
        shortcut_steps: 4,
    };
}

impl Default for FrontTuning {
    fn default() -> Self {
        Self::MEASURED
    }
}
