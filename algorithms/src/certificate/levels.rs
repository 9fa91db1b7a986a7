//! The reports of all levels together.

use super::cover::CoverReport;
use super::distance_report::DistanceReport;
use super::edges::EdgeReport;
use super::faithful::FaithfulReport;
use super::geometry_report::GeometryReport;
use super::indices::IndexReport;
use super::kinds::Level;
use super::links::LinkReport;
use super::quality::QualityReport;
use super::violation::{Verdict, Violation};
use serde::Serialize;

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
    /// Nothing asked yet but the indices.
    pub(super) fn of_indices(indices: IndexReport) -> Self {
        Self {
            indices,
            edges: None,
            links: None,
            geometry: None,
            cover: None,
            faithful: None,
            quality: None,
            by_distances: None,
        }
    }

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

    /// Every place that is told, to be told in other coordinates. Those that are empty are none.
    pub fn places_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let faithful = self.faithful.as_mut();
        let (gaps, stretches, theirs) = match faithful {
            Some(report) => (
                report.largest_gap.as_mut(),
                report.largest_stretch.as_mut(),
                Some(&mut report.violations),
            ),
            None => (None, None, None),
        };
        let later = [
            self.edges.as_mut().map(|r| &mut r.violations),
            self.links.as_mut().map(|r| &mut r.violations),
            self.geometry.as_mut().map(|r| &mut r.violations),
            self.cover.as_mut().map(|r| &mut r.violations),
            theirs,
            self.quality.as_mut().map(|r| &mut r.violations),
            self.by_distances.as_mut().map(|r| &mut r.violations),
        ];
        let violations = self.indices.violations.iter_mut();
        violations
            .chain(later.into_iter().flatten().flatten())
            .map(|violation| &mut violation.coordinates)
            .chain(gaps.map(|gap| &mut gap.place))
            .chain(stretches.map(|stretch| &mut stretch.place))
            .filter(|place| !place.is_empty())
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
