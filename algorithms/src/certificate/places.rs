//! Places of a mesh, and of its points.

use crosscap_core::Mesh;
use serde::Serialize;
use std::fmt;

/// Where it is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// A vertex of the mesh.
    Vertex(u32),
    /// Two vertices.
    Vertices([u32; 2]),
    /// An edge by its ends.
    Edge([u32; 2]),
    /// A triangle by its place in the list of triangles.
    Triangle(u32),
    /// Two triangles by their places in the list of triangles.
    Triangles([u32; 2]),
    /// A curve edge by its place in the list of curve edges.
    CurveEdge(u32),
    /// A row of the input.
    Point(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "vertex {v}"),
            Self::Vertices([a, b]) => write!(f, "vertices {a} and {b}"),
            Self::Edge([a, b]) => write!(f, "edge {a}-{b}"),
            Self::Triangle(t) => write!(f, "triangle {t}"),
            Self::Triangles([s, t]) => write!(f, "triangles {s} and {t}"),
            Self::CurveEdge(e) => write!(f, "curve edge number {e}"),
            Self::Point(p) => write!(f, "point {p}"),
        }
    }
}

/// Coordinates of a place of the mesh: of its first vertex.
pub(super) fn coordinates(mesh: &Mesh, place: Place) -> Vec<f64> {
    let vertex = match place {
        Place::Vertex(v) | Place::Vertices([v, _]) | Place::Edge([v, _]) => Some(v),
        Place::Triangle(t) | Place::Triangles([t, _]) => {
            mesh.complex.triangles.get(t as usize).map(|t| t[0])
        }
        Place::CurveEdge(e) => mesh.complex.curve_edges.get(e as usize).map(|e| e.ends[0]),
        Place::Point(_) => None,
    };
    vertex
        .filter(|&v| (v as usize) < mesh.vertices.len())
        .map(|v| mesh.vertices.point(v as usize).to_vec())
        .unwrap_or_default()
}
