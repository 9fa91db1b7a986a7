//! What the certificate is told beside the mesh.

use super::kinds::ViolationKind;
use super::limits::Limits;
use super::links::SpecialPoint;
use super::violation::Violation;
use crosscap_core::{LinkKind, Mesh, PointCloud};

/// A part of the points that says as much of a mesh as all of them: those that are looked at one by one
/// ([`evidence_rows`](super::evidence_rows)), and the nearest to each of the places that are asked about
/// ([`evidence_places`](super::evidence_places)).
#[derive(Clone, Copy, Debug)]
pub struct Excerpt<'a> {
    /// How many points there are.
    pub of: usize,
    /// Rows of the part that are looked at one by one.
    pub looked_at: &'a [usize],
}

/// What is known beside the mesh.
#[derive(Clone, Debug)]
pub struct CertificateOptions<'a> {
    /// The input points, all of them; without them the distances are not measured.
    pub points: Option<&'a PointCloud<f64>>,
    /// What the points are, where they are a part of the input.
    pub excerpt: Option<Excerpt<'a>>,
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
            excerpt: None,
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
    /// The landmark separation at an input point, where it is `separation` in the middle.
    pub(super) fn separation_at(&self, row: usize, separation: f64) -> f64 {
        separation * self.separation_scale.map_or(1.0, |scale| scale[row])
    }

    /// What is wrong with the options, if anything.
    pub(super) fn fault(&self, mesh: &Mesh) -> Option<Violation> {
        (self.fault_of_numbers()).or_else(|| self.fault_of_points(mesh))
    }

    fn fault_of_numbers(&self) -> Option<Violation> {
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
            ("mesh_to_points", l.mesh_to_points),
            ("off_plane", l.off_plane),
            ("unused_landmarks", l.unused_landmarks),
            ("significance", l.significance),
            ("least_hole", l.least_hole),
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
        None
    }

    fn fault_of_points(&self, mesh: &Mesh) -> Option<Violation> {
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
        if let Some(row) =
            (self.excerpt).and_then(|part| part.looked_at.iter().find(|&&r| r >= rows))
        {
            return Some(Violation::whole(
                ViolationKind::Options,
                format!("row {row} of a part of the points that has {rows}"),
            ));
        }
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
