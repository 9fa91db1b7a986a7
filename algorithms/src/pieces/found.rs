//! What is told of the pieces of a mesh and of how they meet.

use super::surface::Surface;
use crosscap_core::Mesh;
use serde::Serialize;

/// A connected component of the normalization.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Piece {
    /// Name of the surface, such as "Klein bottle".
    pub name: String,
    /// Which surface it is.
    pub surface: Surface,
    /// Euler characteristic.
    pub euler: i64,
    /// Number of its vertices; those on double curves count once for each sheet.
    pub vertices: usize,
    /// Number of its edges.
    pub edges: usize,
    /// Number of its triangles.
    pub triangles: usize,
    /// Sum of the areas of its triangles, in the squared unit of the data.
    pub area: f64,
}

/// Whether a neighborhood of a circle in a surface is an annulus or a Moebius strip.
///
/// For a circle that crosses itself: whether orientation is kept when one goes round it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sidedness {
    /// A Moebius strip.
    OneSided,
    /// An annulus.
    TwoSided,
}

/// A component of what lies over a double curve in the normalization.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[non_exhaustive]
pub struct Preimage {
    /// Index of the piece that it lies on.
    pub piece: u32,
    /// Whether it is closed. Over an arc it can be, when it turns back at both ends.
    pub circle: bool,
    /// How often it runs along the double curve: 1 or 2.
    pub covers: u32,
    /// For a circle, its sides on the piece.
    pub sidedness: Option<Sidedness>,
}

/// Why a double curve ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CurveEnd {
    /// The two sheets are one there: a pinch point, as of Whitney's umbrella.
    Pinch,
    /// One of the sheets ends.
    Boundary,
    /// Anything else.
    Singular,
}

/// Angle at which sheets meet, in degrees: 0 to 90 where two of them cross, 0 to 180 where they end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CrossingAngle {
    /// Mean over the length of the curve.
    pub mean: f64,
    /// Least over its edges.
    pub min: f64,
    /// Largest over its edges.
    pub max: f64,
}

/// A curve in which two sheets cross. It runs straight through triple points.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DoubleCurve {
    /// Closed, or an arc.
    pub circle: bool,
    /// Length, in the unit of the data.
    pub length: f64,
    /// Vertices of the mesh along it; the first one is not repeated at the end of a circle.
    pub vertices: Vec<u32>,
    /// What lies over it: two components that cover it once, or one that covers it twice; in the
    /// order of their pieces.
    pub preimages: Vec<Preimage>,
    /// For an arc, why it ends: at its first and at its last vertex.
    pub ends: Option<[CurveEnd; 2]>,
    /// Crossing angle; `None` when all edges lie beside triangles without area.
    pub angle: Option<CrossingAngle>,
    /// Triple points (and points of more sheets) on it, as vertices of the mesh, once for each
    /// passage.
    pub multiple_points: Vec<u32>,
}

impl DoubleCurve {
    /// The pieces that cross in it: two, or one that crosses itself.
    pub fn pieces(&self) -> Vec<u32> {
        let mut pieces: Vec<u32> = self.preimages.iter().map(|p| p.piece).collect();
        pieces.dedup();
        pieces
    }
}

/// A curve at which the surface is cut because no two sheets cross in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Junction {
    /// Closed, or an arc.
    pub circle: bool,
    /// How many cells meet in it, 3 or at least 5.
    pub cells: u32,
    /// Length, in the unit of the data.
    pub length: f64,
    /// Vertices of the mesh along it; the first one is not repeated at the end of a circle.
    pub vertices: Vec<u32>,
    /// The pieces that end there, increasing, each once.
    pub pieces: Vec<u32>,
    /// Angles between each two of its three cells; `None` for more cells, and beside triangles without area.
    pub angle: Option<CrossingAngle>,
}

/// A curve of edges without a triangle: no surface is beside it, except in points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BareCurve {
    /// Closed, or an arc. Where three or more such curves meet each of them ends.
    pub circle: bool,
    /// Length, in the unit of the data.
    pub length: f64,
    /// Vertices of the mesh along it; the first one is not repeated at the end of a circle.
    pub vertices: Vec<u32>,
    /// Where it meets the surface, in the order of its vertices.
    pub meetings: Vec<CurveMeeting>,
}

/// A point in which a curve without a surface meets the surface.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct CurveMeeting {
    /// Vertex of the mesh.
    pub vertex: u32,
    /// The pieces of the sheets there, increasing, each once.
    pub pieces: Vec<u32>,
    /// Whether the curve ends there, rather than going through.
    pub end: bool,
}

/// A point where three or more sheets cross along double curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct MultiplePoint {
    /// Vertex of the mesh.
    pub vertex: u32,
    /// Number of sheets: 3 for a triple point.
    pub sheets: u32,
}

/// A vertex in which sheets touch away from all curves, as two surfaces cross in R^4.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct PointContact {
    /// Vertex of the mesh.
    pub vertex: u32,
    /// The piece of each sheet, increasing.
    pub pieces: Vec<u32>,
}

/// The pieces of a mesh and how they meet. `Display` says it in a paragraph; serialized is the
/// summary, without the normalization.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pieces {
    /// The pieces, in the order of their first triangles.
    pub pieces: Vec<Piece>,
    /// Double curves, arcs first.
    pub curves: Vec<DoubleCurve>,
    /// Curves at which the surface was cut.
    pub junctions: Vec<Junction>,
    /// Triple points and beyond, by vertex.
    pub multiple_points: Vec<MultiplePoint>,
    /// Points in which sheets touch, by vertex.
    pub contacts: Vec<PointContact>,
    /// Curves of edges without a triangle.
    pub bare_curves: Vec<BareCurve>,
    /// Number of edges without a triangle.
    pub bare_edges: usize,
    /// Vertices that neither a triangle nor a curve edge touches.
    pub isolated_vertices: usize,
    /// The surface with its crossings taken apart. Boundary and cut edges are its curve edges;
    /// bare edges and isolated vertices are in it too, apart from the surface. It is a surface
    /// with boundary, except over a double or cut edge whose sheets hang together at both ends:
    /// there it keeps an edge with more triangles, marked with their number.
    #[serde(skip)]
    pub normalization: Mesh,
    /// For each vertex of the normalization the vertex of the mesh over which it lies.
    #[serde(skip)]
    pub original_vertex: Vec<u32>,
    /// For each triangle of the normalization the triangle of the mesh over which it lies.
    #[serde(skip)]
    pub original_triangle: Vec<u32>,
    /// For each triangle of the mesh its piece.
    #[serde(skip)]
    pub triangle_piece: Vec<u32>,
}
