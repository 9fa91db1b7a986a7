//! Which points a verdict depends on.
//!
//! Of a large cloud the certificate looks at a part: a fixed number of points one by one, and at the nearest point of places
//! of the mesh. Whoever does not hold all points at once gathers these ([`Excerpt`](super::Excerpt)), and the certificate is the same.

use super::faithful::opening::places_amid;
use super::incidence::Incidence;
use super::{CertificateOptions, Limits, cover, edges, mesh_places};
use crosscap_core::Mesh;
use std::cell::RefCell;

/// The rows of a cloud of so many points that are looked at one by one, in order.
pub fn evidence_rows(points: usize, limits: &Limits) -> Vec<usize> {
    cover::picks(points, limits.points_tested).collect()
}

/// The places whose nearest points the verdict on a mesh depends on, one after the other: its vertices, places of its triangles and
/// bare edges, and places amid short boundaries. `separation` is the landmark separation, the same everywhere.
///
/// About 13 places a triangle.
pub fn evidence_places(mesh: &Mesh, separation: f64, options: &CertificateOptions<'_>) -> Vec<f64> {
    let incidence = Incidence::new(&mesh.complex);
    let bare = incidence.bare_edges();
    let all = RefCell::new(mesh_places::places(mesh, &bare, separation));
    let shortest = options.limits.shortest_boundary;
    edges::check(mesh, &incidence, options.closed, shortest, &|part| {
        places_amid(mesh, part).for_each(|place| all.borrow_mut().extend(place));
        false
    });
    all.into_inner()
}
