//! Whether two triangles of a chart may stand side by side.

use crate::Landmark;

/// How two triangles of the plane meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// Not at all.
    Disjoint,
    /// In a common face (a corner or a side of both, named by shared indices) and nothing else,
    /// or they are the same triangle.
    CommonFace,
    /// In anything else: overlapping interiors, crossing sides, a corner inside the other
    /// triangle or on its side (a T-junction).
    Overlap,
}

/// A triangle of a chart: the landmarks at its corners and where the chart puts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartTriangle {
    /// The landmarks at the corners.
    pub corners: [Landmark; 3],
    /// Their places in the chart.
    pub places: [[f64; 2]; 3],
}

/// Decides how two triangles meet (the paper's linear program (6) is the reference).
///
/// # Why it has this shape
/// The whole triangulation rests on this one question, and there is one right answer to it; it is a trait so that
/// a quick test can stand where the linear program of the paper stood, and be held against it. The answer has
/// three values, because two triangles that share a side must not count as overlapping, and whether they share it is
/// known from their corners, not from their places: a corner is compared by landmark. There is no tolerance to
/// pass, since a tolerance would make the answer depend on the order of the questions.
///
/// # Laws
/// - *symmetry*: `meeting(a, b) == meeting(b, a)`;
/// - *motion, scale*: the same answer after a rigid motion or scaling of the chart;
/// - *reference*: the answer of the linear program, for triangles that are not degenerate.
pub trait CompatibilityTest: Sync {
    /// How `a` and `b` meet. Corners are the same point exactly when their landmark is.
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting;

    /// Whether both may be in one complex: anything but [`Meeting::Overlap`].
    fn compatible(&self, a: &ChartTriangle, b: &ChartTriangle) -> bool {
        self.meeting(a, b) != Meeting::Overlap
    }

    /// Short name for reports.
    fn name(&self) -> &str;
}

/// Ranks the triangles that could stand on a dangling edge.
///
/// # Why it has this shape
/// A rule sees three lengths and nothing else. They are the original distances, which a chart only approximates,
/// and the same for every chart that holds the three landmarks: two stars that meet agree about which
/// triangle is better. A rank is a number because all candidates of an edge are sorted by it; infinity says
/// that a candidate is none.
///
/// # Laws
/// - *symmetry*: the same rank when the ends of the edge are exchanged;
/// - *scale*: the order of two candidates does not change under uniform scaling;
/// - *degenerate*: a triangle without area ranks last (infinity), never NaN.
pub trait TriangleRule: Sync {
    /// Rank of the triangle with sides `edge` (the dangling edge) and `a`, `b` (to the
    /// candidate), all from the original distances: the smallest rank is tried first.
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64;

    /// Short name for reports.
    fn name(&self) -> &str;
}
