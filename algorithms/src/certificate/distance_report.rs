//! What distances say of a mesh without places.

use super::cover::Distances;
use super::violation::Violation;
use serde::Serialize;

/// Folds, needles and cover, from distances.
///
/// Whether triangles overlap or cross cannot be told without places, nor how far points lie off
/// the planes of triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DistanceReport {
    /// Smallest angle between two triangles at an ordinary edge, degrees, in the tetrahedron with the
    /// six distances of their corners; 180 is flat.
    pub smallest_dihedral: f64,
    /// Ordinary edges with an angle below the limit.
    pub folds: usize,
    /// Smallest angle of a triangle with the three distances of its corners, degrees.
    pub smallest_angle: f64,
    /// Points to their nearest vertex, in dl.
    pub points_to_vertices: Distances,
    /// Number of landmarks that are not in the mesh.
    pub unused_landmarks: usize,
    /// What is wrong.
    pub violations: Vec<Violation>,
}
