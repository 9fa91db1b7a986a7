//! What a triangulation is made with, and what it yields.

use super::Rules;
use crosscap_core::{CompatibilityTest, Complex, LocalChart, TriangleRule};
use serde::{Deserialize, Serialize};

/// Triangulates the waist.
pub struct Triangulator<'a> {
    /// Lays neighborhoods out in the plane.
    pub chart: &'a dyn LocalChart,
    /// Decides whether two triangles can stand side by side.
    pub test: &'a dyn CompatibilityTest,
    /// Ranks the candidates for a dangling edge.
    pub rule: &'a dyn TriangleRule,
    /// No triangle has a larger circumradius, unit of the data; infinite for no limit.
    pub largest_circumradius: f64,
    /// Whether stars that cannot be closed are repaired; without it the first one ends the
    /// triangulation, as in the paper.
    pub repair: bool,
    /// What a triangle must satisfy beside being compatible.
    pub rules: Rules,
}

/// A star that stayed open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Incomplete {
    /// The landmark.
    pub landmark: u32,
}

/// What the triangulation counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TriangulationCounts {
    /// Stars visited, with repetitions.
    pub visits: usize,
    /// Repairs: stars that could not be closed at once.
    pub repairs: usize,
    /// Landmarks given up.
    pub dropped: usize,
}

/// The result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangulation {
    /// The complex on the landmarks; a dropped landmark is an isolated vertex.
    pub complex: Complex,
    /// Landmarks given up.
    pub dropped: Vec<u32>,
    /// Stars that stayed open.
    pub incomplete: Vec<Incomplete>,
    /// Counts for the report.
    pub counts: TriangulationCounts,
}
