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

impl Offset {
    /// How much more than allowed, in local spacings.
    fn beyond(&self) -> f64 {
        self.away - self.allowed
    }
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
    let step = mesh.complex.vertices.div_ceil(LOOKED_AT).max(1);
    let mut tally = Tally {
        level,
        offset,
        tests: mesh.complex.vertices.div_ceil(step) as f64,
        scatters: Vec::new(),
        found: Found::default(),
        largest: None,
        least: None,
    };
    for v in (0..mesh.complex.vertices as u32).step_by(step) {
        let density = search.ground.density[v as usize];
        if density <= 0.0 {
            continue;
        }
        wings.at(v, |feet| {
            let rows = feet
                .iter()
                .map(|&k| points.point(search.feet.rows[k as usize] as usize));
            if patch.fit(mesh.vertices.point(v as usize), rows) {
                tally.count(v, &patch, 1.0 / density.sqrt());
            }
        });
    }
    tally.found()
}

/// What the sheets have said so far.
struct Tally {
    /// Sheets over each other that are less likely than this are told.
    level: f64,
    /// What a vertex may be off without scatter, in local spacings.
    offset: f64,
    /// How many vertices are looked at.
    tests: f64,
    scatters: Vec<f64>,
    found: Found,
    /// The largest offset within what is allowed.
    largest: Option<Offset>,
    /// The least likely of the gaps that are likely enough.
    least: Option<Merged>,
}

impl Tally {
    /// Counts a sheet at a vertex, with the patch through its points and their spacing.
    fn count(&mut self, vertex: u32, patch: &Patch, spacing: f64) {
        self.scatters.push(patch.scatter / spacing);
        let here = Offset {
            away: patch.offset / spacing,
            allowed: self.offset + 4.0 * patch.scatter / spacing * (1.0 + patch.leverage),
            vertex,
        };
        if here.beyond() > 0.0 {
            self.found.off.push(here);
        } else if self.largest.as_ref().is_none_or(|l| here.away > l.away) {
            self.largest = Some(here);
        }
        let Some(overlay) = Overlay::of(&patch.flat, &patch.left, spacing) else {
            return;
        };
        let here = Merged::at(vertex, &overlay, spacing, self.tests);
        if here.p < self.level {
            if !crease::explains(&patch.flat, &patch.left) {
                self.found.merged.push(here);
            }
        } else if self.least.as_ref().is_none_or(|l| here.p < l.p) {
            self.least = Some(here);
        }
    }

    /// What was found, the worst first, and what comes nearest to it where nothing was.
    fn found(self) -> Found {
        let mut found = self.found;
        found.scatter = crate::certificate::quality::median(self.scatters);
        found
            .merged
            .sort_by(|a, b| a.p.total_cmp(&b.p).then(a.vertex.cmp(&b.vertex)));
        found.off.sort_by(|a, b| {
            let worse = b.beyond().total_cmp(&a.beyond());
            worse.then(a.vertex.cmp(&b.vertex))
        });
        if found.merged.is_empty() {
            found.merged.extend(self.least);
        }
        if found.off.is_empty() {
            found.off.extend(self.largest);
        }
        found
    }
}
