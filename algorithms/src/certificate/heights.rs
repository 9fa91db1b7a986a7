//! How far points are from a mesh.

use super::distance::point_triangle;
use super::frame::Frame;
use super::geometry::tree;
use super::triangle::corners;
use crosscap_core::{Mesh, PointCloud};

/// The distance of every point to the nearest place of the mesh, in the unit of the data; infinite where the mesh has
/// neither a triangle nor a curve.
///
/// Curves count, also where no triangle touches them. Each point walks down a tree of boxes: O(log t) for t triangles.
///
/// # Panics
/// When points and mesh differ in dimension.
///
/// ```
/// use crosscap_algorithms::certificate::distances_to_mesh;
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// let corners = PointCloud::new(3, vec![0., 0., 0., 1., 0., 0., 0., 1., 0.]).unwrap();
/// let complex = Complex::new(3, vec![[0, 1, 2]], vec![]).unwrap();
/// let mesh = Mesh::new(complex, corners, vec![-1; 3]).unwrap();
/// // Above the triangle, and beside a corner.
/// let points = PointCloud::new(3, vec![0.25, 0.25, 0.5, 4.0, 0.0, 4.0]).unwrap();
/// assert_eq!(distances_to_mesh(&mesh, &points), [0.5, 5.0]);
/// ```
pub fn distances_to_mesh(mesh: &Mesh, points: &PointCloud<f64>) -> Vec<f64> {
    assert_eq!(mesh.vertices.dimension(), points.dimension());
    let frame = Frame::new(&mesh.vertices, Some(points));
    let bare: Vec<[u32; 2]> = mesh.complex.curve_edges.iter().map(|e| e.ends).collect();
    let tree = tree(mesh, &frame, &bare);
    let count = mesh.complex.triangles.len();
    let shape = |item: usize| match item.checked_sub(count) {
        None => corners(mesh, item as u32),
        Some(edge) => {
            let [a, b] = bare[edge].map(|v| mesh.vertices.point(v as usize));
            [a, b, b]
        }
    };
    let distance = |row: &[f64]| {
        let nearest = tree.nearest(&frame.spot(row), frame.slack, f64::INFINITY, |item| {
            let [a, b, c] = shape(item as usize);
            point_triangle(row, a, b, c)
        });
        nearest.map_or(f64::INFINITY, |(_, square)| square.sqrt())
    };
    points.iter().map(distance).collect()
}
