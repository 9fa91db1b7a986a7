//! What is told of folds, overlaps and crossings.

use super::violation::Violation;
use serde::Serialize;

/// Folds, overlaps and crossings.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GeometryReport {
    /// Triangles without area.
    pub zero_area: usize,
    /// Smallest angle between two triangles at an ordinary edge, degrees; 180 is flat.
    pub smallest_dihedral: f64,
    /// Ordinary edges with an angle below 45 degrees.
    pub sharp_edges: usize,
    /// Ordinary edges with an angle below the limit.
    pub folds: usize,
    /// Smallest angle between two edges of a curve without triangles, degrees; 180 is straight. None without such curves.
    pub smallest_bend: Option<f64>,
    /// Pairs of triangles on top of each other.
    pub stacked_pairs: usize,
    /// Pairs of triangles that cross (dimension up to 3) or touch (above) outside common faces.
    pub crossings: usize,
    /// Pairs of triangles that were near enough to be looked at.
    pub pairs: usize,
    /// What is wrong.
    pub violations: Vec<Violation>,
}
