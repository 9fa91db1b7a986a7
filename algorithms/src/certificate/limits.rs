//! Thresholds of the certificate.

use serde::Serialize;

/// Thresholds of the certificate. A value at the limit is allowed.
///
/// The dl here is the landmark separation, h the median edge of the mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Least number of edges of a connected part of the boundary. The landmarks around a single
    /// missing one are about six: a boundary of fewer is below the resolution.
    pub shortest_boundary: usize,
    /// Least angle between the two triangles at an ordinary edge, degrees; flat is 180.
    pub fold: f64,
    /// Least angle between two edges of a curve without triangles, at a vertex where nothing else is, degrees. Three landmarks of
    /// a segment that are joined in a circle have angles near 0, those of a round circle 60.
    pub bare_fold: f64,
    /// Least angle between two of the triangles at a curve edge, degrees. Sheets may cross
    /// at a small angle; below this they are the same.
    pub curve_fold: f64,
    /// Greatest angle of two planes whose triangles can be stacked, degrees.
    pub stacked_angle: f64,
    /// Offset below which two triangles can be stacked, in h.
    pub stacked_offset: f64,
    /// Depth of overlap above which two triangles are stacked, in h.
    pub stacked_depth: f64,
    /// Distance up to which two triangles without a common vertex touch, in h; used above
    /// dimension 3, where rounding leaves nothing to cross exactly.
    pub contact: f64,
    /// Area up to which a triangle is called flat, in squares of its longest edge.
    pub zero_area: f64,
    /// Least angle of a triangle, degrees.
    pub min_angle: f64,
    /// Greatest distance of an input point to the mesh, in dl. No point of a surface is further
    /// than dl from a landmark, and a triangulated neighborhood is nearer than that; the middle
    /// of a missing star of triangles is about dl away.
    pub points_to_mesh: f64,
    /// Greatest distance of a place of the mesh to the input points, in dl, beyond the
    /// estimated gap of the points.
    pub mesh_to_points: f64,
    /// Greatest distance of the point nearest to a place of the mesh from the plane of the triangle, in
    /// dl. An edge of 1.9 dl over a bend of radius dl is about that far off.
    pub off_plane: f64,
    /// Greatest number of unused landmarks, as a part of the number of vertices.
    pub unused_landmarks: f64,
    /// How many input points are looked up in the mesh at most; picked evenly and always alike.
    pub points_tested: usize,
    /// Probability of a false alarm, over the whole cloud, at which a finding about the points is
    /// held for no chance. Whoever tries k times until a mesh passes multiplies it by k: the verdict gets stricter.
    pub significance: f64,
    /// Width of the narrowest hole that the surface may have, in local spacings of the points, where that is known from
    /// elsewhere: narrower gaps of the points are no finding. 0 where nothing is known.
    pub least_hole: f64,
    /// Probability that chance leaves a stretch without points as long as that between the end of a curve and what is ahead of
    /// it, below which the end is one: else the curve may be joined to it. Whoever tries k times divides it by k. Less than
    /// `significance`, as an end that is none makes a wrong mesh: of 300 clouds with a curve that touches a sheet and has a
    /// gap on its other side one was handed over with both of them open, at 7e-4.
    pub loose_end: f64,
    /// Greatest distance of a vertex to the quadratic patch through the points of each sheet at it, in local spacings
    /// of the points, beyond four times their scatter.
    pub vertex_offset: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            shortest_boundary: 6,
            fold: 20.0,
            bare_fold: 45.0,
            curve_fold: 2.0,
            stacked_angle: 25.0,
            stacked_offset: 0.35,
            stacked_depth: 0.06,
            contact: 1e-3,
            zero_area: 1e-7,
            min_angle: 0.1,
            points_to_mesh: 0.75,
            mesh_to_points: 0.5,
            off_plane: 0.7,
            unused_landmarks: 0.01,
            points_tested: 200_000,
            significance: 1e-3,
            least_hole: 0.0,
            loose_end: 3e-4,
            vertex_offset: 1.0,
        }
    }
}

/// Whether a value is at most the limit. A NaN, which overflow can make of huge coordinates, is not.
pub(super) fn within(value: f64, limit: f64) -> bool {
    value <= limit
}

/// Whether a value is above the limit; not for a NaN.
pub(super) fn exceeds(value: f64, limit: f64) -> bool {
    value > limit
}
