//! What a complex is made of: undoing the immersion and naming the pieces.
//!
//! A surface that crosses itself is the image of a surface that does not. [`pieces`] finds it:
//! 1. Across an edge with two triangles they continue each other.
//! 2. At an edge with four triangles two sheets cross. Which triangles continue each other is
//!    decided by a vote: along a *chain* of such edges the same four rims of surface lie beside
//!    all of them (found by walking around the vertices between them), so one pairing holds for
//!    the whole chain, the straightest one in the mean over its length. Around a closed chain
//!    only pairings that return to themselves are considered.
//! 3. Elsewhere (one triangle, a Y-junction of three, five and more) the surface ends, or is cut.
//! 4. The corners at a vertex that hang together through glued sides are a local sheet, and
//!    each local sheet becomes a vertex of its own: two on a double curve, three at a triple point.
//!
//! What results is the *normalization*, a surface with boundary, whose components are named by
//! the classification theorem. Curve marks are not consulted: what counts are triangles.
//!
//! Time O(v + t log t), linear memory.

mod corners;
mod curves;
mod description;
mod error;
mod found;
mod gluing;
mod normalization;
mod reading;
mod straightness;
mod surface;
mod winding;

pub use corners::{BoundaryCorners, CornerVertex};
pub use error::PiecesError;
pub use found::{
    BareCurve, CrossingAngle, CurveEnd, CurveMeeting, DoubleCurve, Junction, MultiplePoint, Piece,
    Pieces, PointContact, Preimage, Sidedness,
};
pub use reading::Reading;
pub use straightness::LEAST_MARGIN;
pub use surface::Surface;
pub use winding::wound_triangles;

use crosscap_core::{Error, Mesh};
use gluing::Gluing;
use normalization::Normalization;
/// Takes a mesh apart into surfaces.
///
/// See the [module](self) for the method.
///
/// # Errors
/// [`PiecesError::Mesh`] when the mesh is not as [`crosscap_core::Complex::new`] and
/// [`Mesh::new`] leave it; [`PiecesError::Ambiguous`] and [`PiecesError::Twisted`] when the sheets
/// at a double curve cannot be told apart.
///
/// ```
/// use crosscap_algorithms::pieces::pieces;
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// // Two squares that cross in the edge 0 1.
/// let places = vec![
///     0., 0., 0.,  0., 0., 1.,  1., 0., 0.,  -1., 0., 0.,  0., 1., 0.,  0., -1., 0.,
/// ];
/// let triangles = vec![[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 5]];
/// let complex = Complex::new(6, triangles, vec![]).unwrap();
/// let mesh = Mesh::new(complex, PointCloud::new(3, places).unwrap(), vec![-1; 6]).unwrap();
/// let found = pieces(&mesh).unwrap();
/// assert_eq!(found.triangle_piece, [0, 0, 1, 1]);
/// assert_eq!(found.to_string(), "Two discs. Disc 1 and disc 2 meet in one arc (crossing angle 90 degrees).");
/// ```
pub fn pieces(mesh: &Mesh) -> Result<Pieces, PiecesError> {
    let count = mesh.complex.vertices;
    if mesh.vertices.len() != count || mesh.point_index.len() != count {
        return Err(PiecesError::Mesh(Error::Shape {
            found: format!(
                "{} places and {} rows",
                mesh.vertices.len(),
                mesh.point_index.len()
            ),
            expected: format!("{count} of each, one a vertex"),
        }));
    }
    let gluing = Gluing::new(mesh)?;
    let normal = Normalization::new(&gluing);
    let (curves, multiple_points) = curves::double_curves(&gluing, &normal);
    let junctions = curves::junctions(&gluing, &normal);
    let contacts = curves::point_contacts(&gluing, &normal);
    let bare_curves = curves::bare_curves(&gluing, &normal);
    let (normalization, original_triangle) = normal.mesh(&gluing)?;
    let mut touched = vec![false; normalization.complex.vertices];
    let corners = normalization.complex.triangles.iter().flatten();
    let ends = normalization
        .complex
        .curve_edges
        .iter()
        .flat_map(|e| &e.ends);
    corners
        .chain(ends)
        .for_each(|&v| touched[v as usize] = true);
    Ok(Pieces {
        pieces: normal.pieces,
        curves,
        junctions,
        multiple_points,
        contacts,
        bare_curves,
        bare_edges: normal.bare.len(),
        isolated_vertices: touched.iter().filter(|&&t| !t).count(),
        normalization,
        original_vertex: normal.original_vertex,
        original_triangle,
        triangle_piece: normal.triangle_piece,
    })
}

#[cfg(test)]
mod tests;
