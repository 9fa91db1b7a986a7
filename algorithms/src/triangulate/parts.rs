//! What the advancing front is put together from.

use super::Rules;
use crate::tuning::FrontTuning;
use crosscap_core::{CompatibilityTest, LocalChart, TriangleRule};

/// Triangulates the waist by an advancing front of stars (Martin & Watson 2011, section 2.2.2, with repairs).
///
/// One model of [`Triangulator`](crosscap_core::Triangulator); its parts are plug-ins of their own.
pub struct AdvancingFront<'a> {
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
    /// The numbers that decide.
    pub tuning: &'a FrontTuning,
}
