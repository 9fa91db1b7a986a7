//! Verdict on a mesh: levels of validity, each a typed report with the places of what is wrong.
//!
//! Betti numbers are no acceptance test: thick or folded complexes can have the right ones. A
//! mesh is verified when all of these hold.
//!
//! | level | asks | report |
//! | --- | --- | --- |
//! | indices | a simplicial complex with distinct places | [`IndexReport`] |
//! | edges | every edge has the triangles that its stratum allows | [`EdgeReport`] |
//! | links | every vertex looks like a point of a surface that may cross itself | [`LinkReport`] |
//! | geometry | no folds, no overlaps, no crossings off the declared curves | [`GeometryReport`] |
//! | cover | mesh and points are near each other, all landmarks are used | [`CoverReport`] |
//! | faithful | no gap of the points is bridged, in units of their local spacing | [`FaithfulReport`] |
//! | quality | no needles; figures for the reader | [`QualityReport`] |
//!
//! Nothing here knows the true surface. What cannot be decided without it (the right Betti
//! numbers, a handle too small for the landmarks) is not decided.

mod bends;
mod by_distances;
mod chords;
mod cover;
mod crossing;
mod display;
mod distance;
mod distance_report;
mod edges;
mod evidence;
mod faithful;
mod folds;
mod frame;
mod geometry;
mod geometry_report;
mod heights;
mod incidence;
mod indices;
mod kinds;
mod levels;
mod limits;
mod links;
mod mesh_cover;
mod mesh_places;
mod near_pairs;
mod options;
mod pinched;
mod places;
mod quality;
mod stacked;
mod statistics;
mod tree;
mod triangle;
mod violation;

#[cfg(test)]
mod tests;

pub use by_distances::certify_by_distances;
pub use cover::{CoverReport, Distances};
pub use crosscap_core::{Link, LinkKind};
pub use distance_report::DistanceReport;
pub use edges::EdgeReport;
pub use evidence::{evidence_places, evidence_rows};
pub use faithful::{Covered, FaithfulReport, Gap, LooseEnd, Merged, Offset, Stretch};
pub use geometry_report::GeometryReport;
pub use heights::distances_to_mesh;
pub use indices::IndexReport;
pub use kinds::{Level, ViolationKind};
pub use levels::Certificate;
pub use limits::Limits;
pub use links::{LinkReport, SpecialPoint};
pub use options::{CertificateOptions, Excerpt};
pub use places::Place;
pub use quality::{Cell, QualityReport, Spread};
pub use violation::{Verdict, Violation};

use crosscap_core::{Mesh, PointCloud};
use faithful::Search;
use faithful::footprints::Footprints;
use faithful::ground::Ground;
use frame::Frame;
use incidence::Incidence;
use limits::{exceeds, within};
use places::coordinates;
use tree::Tree;

/// Asks a mesh everything that can be decided without knowing the true surface.
///
/// Never panics, whatever the arrays say. O((t + p) log t) for t triangles and p points
/// of bounded density; memory O(t + p). The same input gives the same certificate.
///
/// ```
/// use crosscap_algorithms::certificate::{CertificateOptions, ViolationKind, certify};
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// let faces = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
/// let corners = vec![1., 1., 1., 1., -1., -1., -1., 1., -1., -1., -1., 1.];
/// let mesh = |faces| {
///     let complex = Complex::new(4, faces, vec![]).unwrap();
///     Mesh::new(complex, PointCloud::new(3, corners.clone()).unwrap(), vec![-1; 4]).unwrap()
/// };
/// let options = CertificateOptions::default();
/// assert!(certify(&mesh(faces.clone()), &options).verdict().is_verified());
/// let certificate = certify(&mesh(faces[1..].to_vec()), &options);
/// assert_eq!(certificate.violations().next().unwrap().kind, ViolationKind::UndeclaredBoundary);
/// ```
pub fn certify(mesh: &Mesh, options: &CertificateOptions<'_>) -> Certificate {
    let mut certificate = Certificate::of_indices(indices::check(mesh));
    if let Some(fault) = options.fault(mesh) {
        certificate.indices.violations.push(fault);
        certificate.indices.usable = false;
    }
    if !certificate.indices.usable {
        return certificate;
    }
    let incidence = Incidence::new(&mesh.complex);
    let bare = incidence.bare_edges();
    let frame = Frame::new(&mesh.vertices, options.points);
    let quality = quality::check(mesh, &incidence, &options.limits);
    certificate.links = Some(links::check(
        mesh,
        &incidence,
        options.admissible_links,
        options.special_points,
    ));
    let triangles = geometry::tree(mesh, &frame, &[]);
    certificate.geometry = Some(geometry::check(
        mesh,
        &incidence,
        &frame,
        &triangles,
        &options.limits,
        options.special_points,
    ));
    let all = if bare.is_empty() {
        triangles
    } else {
        geometry::tree(mesh, &frame, &bare)
    };
    let parts = Parts {
        mesh,
        incidence: &incidence,
        bare: &bare,
        frame: &frame,
        tree: &all,
    };
    ask_points(
        &mut certificate,
        &parts,
        quality.edge_length.median,
        options,
    );
    certificate.quality = Some(quality);
    certificate
}

/// A mesh as the levels that have the points look at it.
struct Parts<'a> {
    mesh: &'a Mesh,
    incidence: &'a Incidence,
    /// Edges without triangles.
    bare: &'a [[u32; 2]],
    frame: &'a Frame,
    /// Of triangles and of these edges.
    tree: &'a Tree,
}

/// The levels to which points have something to say, where there are any: edges (is a boundary an opening of the points?), cover, faithful.
fn ask_points(
    certificate: &mut Certificate,
    parts: &Parts<'_>,
    median_edge: f64,
    options: &CertificateOptions<'_>,
) {
    let Parts {
        mesh,
        incidence,
        bare,
        frame,
        tree,
    } = *parts;
    let points = options.points.filter(|p| !p.is_empty());
    let of = (options.excerpt).map_or(points.map_or(0, PointCloud::len), |part| part.of);
    let feet = points.map(|points| {
        let rows = looked_at(of, options).into_iter();
        Footprints::new(mesh, incidence, frame, tree, bare, points, rows)
    });
    let ground = feet.as_ref().map(|f| Ground::new(mesh, incidence, f));
    let search = feet
        .as_ref()
        .zip(ground.as_ref())
        .zip(points)
        .map(|((feet, ground), points)| Search::new(mesh, incidence, feet, ground, points, of));
    let opening = options
        .faithful
        .then_some(())
        .and(search.as_ref())
        .zip(points);
    let is_opening = |part: &[u32]| {
        opening.is_some_and(|(search, points)| {
            search.is_opening(points, part, options.limits.significance)
        })
    };
    certificate.edges = Some(edges::check(
        mesh,
        incidence,
        options.closed,
        options.limits.shortest_boundary,
        &is_opening,
    ));
    certificate.cover = Some(cover::check(
        mesh,
        search.as_ref(),
        bare,
        median_edge,
        options,
    ));
    certificate.faithful = search
        .filter(|_| options.faithful)
        .map(|search| faithful::check(&search, of, options));
}

/// The points whose places on the mesh are looked up, of so many.
fn looked_at(of: usize, options: &CertificateOptions<'_>) -> Vec<usize> {
    match options.excerpt {
        Some(part) => part.looked_at.to_vec(),
        None => evidence_rows(of, &options.limits),
    }
}
