//! How far points are from a mesh.

use super::faithful::footprints::Footprints;
use super::incidence::Incidence;
use super::{frame, geometry};
use crosscap_core::{Mesh, PointCloud};

/// Distances of all points to the nearest place of the triangles of a mesh, unit of the data; infinite where it has none.
/// Curve edges without triangles do not count.
///
/// O((t + p) log t) for t triangles and p points of bounded density.
///
/// # Panics
/// Where points and vertices have different numbers of coordinates.
///
/// ```
/// use crosscap_algorithms::certificate::heights;
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// let corners = PointCloud::new(3, vec![0., 0., 0., 1., 0., 0., 0., 1., 0.])?;
/// let triangle = Mesh::new(Complex::new(3, vec![[0, 1, 2]], vec![])?, corners, vec![-1; 3])?;
/// let points = PointCloud::new(3, vec![0.2, 0.2, 3., 0.5, -2., 0.])?;
/// assert_eq!(heights(&triangle, &points), [3.0, 2.0]);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub fn heights(mesh: &Mesh, points: &PointCloud<f64>) -> Vec<f64> {
    assert_eq!(mesh.vertices.dimension(), points.dimension(), "coordinates");
    let incidence = Incidence::new(&mesh.complex);
    let frame = frame::Frame::new(&mesh.vertices, Some(points));
    let tree = geometry::tree(mesh, &frame, &[]);
    let rows = 0..points.len();
    Footprints::new(mesh, &incidence, &frame, &tree, &[], points, rows).heights
}
