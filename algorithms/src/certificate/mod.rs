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
mod cover;
mod crossing;
mod display;
mod distance;
mod edges;
mod faithful;
mod frame;
mod geometry;
mod heights;
mod incidence;
mod indices;
mod links;
mod pinched;
mod quality;
mod stacked;
mod tree;
mod violation;

#[cfg(test)]
mod tests;

pub use by_distances::{DistanceReport, certify_by_distances};
pub use cover::{CoverReport, Distances};
pub use crosscap_core::{Link, LinkKind};
pub use edges::EdgeReport;
pub use faithful::{FaithfulReport, Gap, Merged, Offset, Stretch};
pub use geometry::GeometryReport;
pub use heights::distances_to_mesh;
pub use indices::IndexReport;
pub use links::{LinkReport, SpecialPoint};
pub use quality::{Cell, QualityReport, Spread};
pub use violation::{Level, Place, Verdict, Violation, ViolationKind};

use crosscap_core::{Mesh, PointCloud};
use faithful::Search;
use faithful::footprints::Footprints;
use faithful::ground::Ground;
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
    /// The same for a point whose nearest place is on a triangle and not where the mesh ends: at a crease the surface between the points is
    /// further from the mesh than any of them.
    pub points_above_mesh: f64,
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
            points_above_mesh: 0.65,
            mesh_to_points: 0.5,
            off_plane: 0.7,
            unused_landmarks: 0.01,
            points_tested: 200_000,
            significance: 1e-3,
            vertex_offset: 1.0,
        }
    }
}

/// What is known beside the mesh.
#[derive(Clone, Debug)]
pub struct CertificateOptions<'a> {
    /// The input points, all of them; without them the distances are not measured.
    pub points: Option<&'a PointCloud<f64>>,
    /// Landmark separation dl, unit of the data; 3/4 of the median edge when left out.
    pub landmark_separation: Option<f64>,
    /// How many times that the separation at each input point is, where landmarks follow the spacing of the points;
    /// once everywhere when left out. Distances between mesh and points are measured in the separation where they are.
    pub separation_scale: Option<&'a [f64]>,
    /// Rows of the input that were selected as landmarks and are not in the mesh.
    pub unused_landmarks: &'a [usize],
    /// Strata of dimension 0: vertices whose link is declared.
    pub special_points: &'a [SpecialPoint],
    /// Kinds of link that need no declaration.
    pub admissible_links: &'a [LinkKind],
    /// Whether the surface is known to have no boundary.
    pub closed: bool,
    /// How far input points lie off the surface, typically; unit of the data. Four times this is
    /// added to the limits of the cover.
    pub noise: f64,
    /// Whether the level *faithful* is asked. It takes the spacing of the points for that of a sample of the surface,
    /// which it is not where coordinates hold more than places: the tangent planes of the lifted metric are estimates,
    /// and beside a crossing they open gaps that no surface has.
    pub faithful: bool,
    /// Thresholds.
    pub limits: Limits,
}

impl Default for CertificateOptions<'_> {
    fn default() -> Self {
        Self {
            points: None,
            landmark_separation: None,
            separation_scale: None,
            unused_landmarks: &[],
            special_points: &[],
            admissible_links: &LinkKind::GENERIC,
            closed: false,
            noise: 0.0,
            faithful: true,
            limits: Limits::default(),
        }
    }
}

impl CertificateOptions<'_> {
    /// What is wrong with the options, if anything.
    fn fault(&self, mesh: &Mesh) -> Option<Violation> {
        let l = &self.limits;
        let named = [
            ("fold", l.fold),
            ("bare_fold", l.bare_fold),
            ("curve_fold", l.curve_fold),
            ("stacked_angle", l.stacked_angle),
            ("stacked_offset", l.stacked_offset),
            ("stacked_depth", l.stacked_depth),
            ("contact", l.contact),
            ("zero_area", l.zero_area),
            ("min_angle", l.min_angle),
            ("points_to_mesh", l.points_to_mesh),
            ("points_above_mesh", l.points_above_mesh),
            ("mesh_to_points", l.mesh_to_points),
            ("off_plane", l.off_plane),
            ("unused_landmarks", l.unused_landmarks),
            ("significance", l.significance),
            ("vertex_offset", l.vertex_offset),
            ("noise", self.noise),
        ];
        if let Some((name, value)) = named.iter().find(|n| !(n.1 >= 0.0 && n.1.is_finite())) {
            return Some(Violation::whole(
                ViolationKind::Options,
                format!("{name} is {value}, expected a finite number of at least 0"),
            ));
        }
        if let Some(dl) = self
            .landmark_separation
            .filter(|d| !(*d > 0.0 && d.is_finite()))
        {
            return Some(Violation::whole(
                ViolationKind::Options,
                format!("the landmark separation is {dl}, expected a finite number above 0"),
            ));
        }
        if let Some(points) = self
            .points
            .filter(|p| p.dimension() != mesh.vertices.dimension())
        {
            return Some(Violation::whole(
                ViolationKind::Shape,
                format!(
                    "vertices in dimension {}, points in dimension {}",
                    mesh.vertices.dimension(),
                    points.dimension()
                ),
            ));
        }
        let rows = self.points.map_or(0, PointCloud::len);
        if let Some(scale) = self.separation_scale
            && !(scale.len() == rows && scale.iter().all(|s| *s > 0.0 && s.is_finite()))
        {
            return Some(Violation::whole(
                ViolationKind::Options,
                format!(
                    "a scale of the landmark separation of {} numbers, expected {rows} positive ones",
                    scale.len()
                ),
            ));
        }
        if self.points.is_some_and(|p| u32::try_from(p.len()).is_err()) {
            return Some(Violation::whole(
                ViolationKind::Options,
                "more than 2^32 points".into(),
            ));
        }
        None
    }
}

/// The reports of all levels. A level that could not be asked, because an earlier one found
/// the arrays unusable, is missing.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Certificate {
    /// Whether the arrays are those of a simplicial complex with distinct places.
    pub indices: IndexReport,
    /// Triangles at every edge.
    pub edges: Option<EdgeReport>,
    /// Links of all vertices.
    pub links: Option<LinkReport>,
    /// Folds, overlaps and crossings.
    pub geometry: Option<GeometryReport>,
    /// Distances between mesh and points.
    pub cover: Option<CoverReport>,
    /// What the points say about the mesh, in units of their spacing; only with points.
    pub faithful: Option<FaithfulReport>,
    /// Shapes of triangles.
    pub quality: Option<QualityReport>,
    /// What distances say instead, where there are no places.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_distances: Option<DistanceReport>,
}

impl Certificate {
    /// Everything that is wrong, in the order of the levels.
    pub fn violations(&self) -> impl Iterator<Item = &Violation> {
        let later = [
            self.edges.as_ref().map(|r| &r.violations),
            self.links.as_ref().map(|r| &r.violations),
            self.geometry.as_ref().map(|r| &r.violations),
            self.cover.as_ref().map(|r| &r.violations),
            self.faithful.as_ref().map(|r| &r.violations),
            self.quality.as_ref().map(|r| &r.violations),
            self.by_distances.as_ref().map(|r| &r.violations),
        ];
        self.indices
            .violations
            .iter()
            .chain(later.into_iter().flatten().flatten())
    }

    /// The levels that were not asked: those that need places, where there are distances alone, and
    /// all later ones, where the arrays are unusable.
    pub fn unchecked(&self) -> Vec<Level> {
        let asked = [
            (Level::Edges, self.edges.is_some()),
            (Level::Links, self.links.is_some()),
            (Level::Geometry, self.geometry.is_some()),
            (Level::Cover, self.cover.is_some()),
            (Level::Faithful, self.faithful.is_some()),
            (Level::Quality, self.quality.is_some()),
        ];
        let not = asked.into_iter().filter(|a| !a.1);
        not.map(|a| a.0).collect()
    }

    /// Whether the mesh may be handed over as good, as far as its levels were asked.
    pub fn verdict(&self) -> Verdict {
        let all: Vec<Violation> = self.violations().cloned().collect();
        if all.is_empty() {
            Verdict::Verified
        } else {
            Verdict::Refused(all)
        }
    }
}

/// Whether a value is at most the limit. A NaN, which overflow can make of huge coordinates, is not.
fn within(value: f64, limit: f64) -> bool {
    value <= limit
}

/// Whether a value is above the limit; not for a NaN.
fn exceeds(value: f64, limit: f64) -> bool {
    value > limit
}

/// Coordinates of a place of the mesh: of its first vertex.
fn coordinates(mesh: &Mesh, place: Place) -> Vec<f64> {
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
    let mut certificate = Certificate {
        indices: indices::check(mesh),
        edges: None,
        links: None,
        geometry: None,
        cover: None,
        faithful: None,
        quality: None,
        by_distances: None,
    };
    if let Some(fault) = options.fault(mesh) {
        certificate.indices.violations.push(fault);
        certificate.indices.usable = false;
    }
    if !certificate.indices.usable {
        return certificate;
    }
    let incidence = incidence::Incidence::new(&mesh.complex);
    let bare: Vec<[u32; 2]> = (0..incidence.edges.len())
        .filter(|&e| incidence.at_edge(e).is_empty())
        .map(|e| incidence.edges[e])
        .collect();
    let frame = frame::Frame::new(&mesh.vertices, options.points);
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
    let points = options.points.filter(|p| !p.is_empty());
    let feet = points.map(|points| {
        let rows = cover::picks(points.len(), options.limits.points_tested);
        Footprints::new(mesh, &incidence, &frame, &all, &bare, points, rows)
    });
    let ground = feet.as_ref().map(|f| Ground::new(mesh, &incidence, f));
    let of = points.map_or(0, PointCloud::len);
    let search = feet
        .as_ref()
        .zip(ground.as_ref())
        .map(|(feet, ground)| Search::new(mesh, &incidence, feet, ground, of));
    let opening = options
        .faithful
        .then_some(())
        .and(search.as_ref())
        .zip(points);
    certificate.edges = Some(edges::check(
        mesh,
        &incidence,
        options.closed,
        options.limits.shortest_boundary,
        &|part| {
            opening.is_some_and(|(search, points)| {
                search.is_opening(points, part, options.limits.significance)
            })
        },
    ));
    certificate.cover = Some(cover::check(
        mesh,
        search.as_ref(),
        &bare,
        quality.edge_length.median,
        options,
    ));
    certificate.faithful = search
        .filter(|_| options.faithful)
        .map(|search| faithful::check(&search, of, options));
    certificate.quality = Some(quality);
    certificate
}
