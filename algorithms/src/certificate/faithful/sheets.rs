//! Sheets of points that the mesh takes for one, and vertices off their points.

use super::crease;
use super::overlay::Overlay;
use super::patch::Patch;
use super::search::Search;
use super::wings::Wings;
use crosscap_core::PointCloud;
use serde::Serialize;

/// Vertices that are looked at, at equal steps where there are more.
const LOOKED_AT: usize = 30_000;

/// Two sheets of points that are one in the mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Merged {
    /// Distance between them, in local spacings.
    pub apart: f64,
    /// The same, unit of the data.
    pub distance: f64,
    /// Probability that one sheet shows such a gap in its heights anywhere.
    pub p: f64,
    /// Vertex in the middle.
    pub vertex: u32,
}

impl Merged {
    /// What sheets over each other say at a vertex, one of `tests` that are looked at.
    fn at(vertex: u32, overlay: &Overlay, spacing: f64, tests: f64) -> Self {
        Self {
            apart: overlay.gap / spacing,
            distance: overlay.gap,
            p: (tests * overlay.chance).min(1.0),
            vertex,
        }
    }
}

/// A vertex that is off the points around it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Offset {
    /// Distance of the vertex to a quadratic patch through the points of a sheet at it, in local spacings.
    pub away: f64,
    /// What is allowed, in local spacings.
    pub allowed: f64,
    /// The vertex.
    pub vertex: u32,
}

/// What the sheets about the vertices say.
#[derive(Default)]
pub(super) struct Found {
    /// The least likely gaps in heights, least likely first.
    pub merged: Vec<Merged>,
    /// The worst offsets beyond what is allowed, worst first; the largest of all when none is.
    pub off: Vec<Offset>,
    /// Median scatter of the points about their patches, in local spacings.
    pub scatter: f64,
}

/// Looks at the sheets of all vertices.
pub(super) fn look(
    search: &Search<'_>,
    points: &PointCloud<f64>,
    level: f64,
    offset: f64,
) -> Found {
    let mesh = search.mesh;
    let mut wings = Wings::new(mesh, search.incidence, &search.standing);
    let mut patch = Patch::default();
    let mut found = Found::default();
    let mut scatters = Vec::new();
    let step = mesh.complex.vertices.div_ceil(LOOKED_AT).max(1);
    let tests = mesh.complex.vertices.div_ceil(step) as f64;
    let mut largest: Option<Offset> = None;
    let mut least: Option<Merged> = None;
    for v in (0..mesh.complex.vertices as u32).step_by(step) {
        let density = search.ground.density[v as usize];
        if density <= 0.0 {
            continue;
        }
        let spacing = 1.0 / density.sqrt();
        wings.at(v, |feet| {
            let rows = feet
                .iter()
                .map(|&k| points.point(search.feet.rows[k as usize] as usize));
            if !patch.fit(mesh.vertices.point(v as usize), rows) {
                return;
            }
            scatters.push(patch.scatter / spacing);
            let here = Offset {
                away: patch.offset / spacing,
                allowed: offset + 4.0 * patch.scatter / spacing * (1.0 + patch.leverage),
                vertex: v,
            };
            let beyond = |o: &Offset| o.away - o.allowed;
            if beyond(&here) > 0.0 {
                found.off.push(here);
            } else if largest.as_ref().is_none_or(|l| here.away > l.away) {
                largest = Some(here);
            }
            let overlay = Overlay::of(&patch.flat, &patch.left, spacing);
            if let Some(here) = overlay.map(|overlay| Merged::at(v, &overlay, spacing, tests)) {
                if here.p < level {
                    if !crease::explains(&patch.flat, &patch.left) {
                        found.merged.push(here);
                    }
                } else if least.as_ref().is_none_or(|l| here.p < l.p) {
                    least = Some(here);
                }
            }
        });
    }
    found.scatter = crate::certificate::quality::median(scatters);
    found
        .merged
        .sort_by(|a, b| a.p.total_cmp(&b.p).then(a.vertex.cmp(&b.vertex)));
    found.off.sort_by(|a, b| {
        let beyond = |o: &Offset| o.away - o.allowed;
        beyond(b)
            .total_cmp(&beyond(a))
            .then(a.vertex.cmp(&b.vertex))
    });
    if found.merged.is_empty() {
        found.merged.extend(least);
    }
    if found.off.is_empty() {
        found.off.extend(largest);
    }
    found
}
