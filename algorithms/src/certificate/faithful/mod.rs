//! Sixth level: the mesh says no more than the points do, in units of their local spacing.
//!
//! The other levels measure in units of the landmark separation, which whoever makes the mesh
//! chooses; what is smaller than it they cannot see. Here the unit is the spacing of the points
//! where they are: s = 1 / sqrt(density).

mod arcs;
mod around;
mod beside;
mod chains;
mod chance;
mod covered;
mod crease;
mod discs;
mod evenness;
pub(super) mod footprints;
mod gaps;
pub(super) mod ground;
mod in_points;
mod loose;
mod nearby;
pub(super) mod opening;
mod overlay;
mod parts;
mod patch;
mod rim;
mod search;
mod several;
mod sheets;
mod slope;
mod standing;
mod tail;
mod tiles;
mod wings;

#[cfg(test)]
mod tests;

pub use arcs::Stretch;
pub use covered::Covered;
pub use discs::Gap;
pub use loose::LooseEnd;
pub(super) use search::Search;
pub use sheets::{Merged, Offset};

use super::quality::quantile;
use super::{CertificateOptions, Place, Violation, ViolationKind};
use crosscap_core::Mesh;
use ground::Ground;
use serde::Serialize;
use std::fmt;

/// What the points say about the mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FaithfulReport {
    /// Points that were looked at.
    pub points: usize,
    /// Points there are. With more than are looked at, spacings are those of the former.
    pub of: usize,
    /// Least, median and greatest local spacing over the vertices, unit of the data.
    pub spacing: [f64; 3],
    /// Probability below which a finding is held for no chance.
    pub significance: f64,
    /// The least likely empty region that the mesh covers.
    pub largest_gap: Option<Gap>,
    /// Width of the widest of the empty regions that are told as violations, in local spacings.
    #[serde(skip)]
    pub widest_bridged: Option<f64>,
    /// These regions, the least likely first.
    #[serde(skip)]
    pub bridged: Vec<Gap>,
    /// Gaps that are no chance, but narrower than the narrowest hole that the surface is said to have; none where nothing was
    /// said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covered: Option<Covered>,
    /// The least likely stretch of a curve without points.
    pub largest_stretch: Option<Stretch>,
    /// The end of a curve that most likely is joined to what is ahead of it, where there is any.
    pub loose_end: Option<LooseEnd>,
    /// The least likely gap in the heights of points over one sheet of the mesh, where there is any.
    pub merged: Option<Merged>,
    /// The vertex that is worst off the points around it.
    pub offset: Option<Offset>,
    /// Median scatter of the points about quadratic patches, in local spacings.
    pub scatter: f64,
    /// Landmark separation below which all that is bridged, joined or merged would stay apart, unit of the data; none where
    /// nothing is.
    pub separation_needed: Option<f64>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

impl FaithfulReport {
    /// Something would stay apart below this landmark separation only.
    fn needs(&mut self, separation: f64) {
        let before = self.separation_needed.unwrap_or(f64::INFINITY);
        self.separation_needed = Some(separation.min(before));
    }
}

/// Width in landmark separations of a gap that a mesh leaves open: its boundary then has six edges and more.
const RESOLVED: f64 = 2.5;
/// Length in landmark separations of a stretch without points that a curve does not bridge.
const ENDED: f64 = 2.0;

pub(super) fn check(
    search: &Search<'_>,
    of: usize,
    options: &CertificateOptions<'_>,
) -> FaithfulReport {
    let significance = options.limits.significance;
    let mut report = FaithfulReport {
        points: search.feet.len(),
        of,
        spacing: spacings(search.ground),
        significance,
        ..FaithfulReport::default()
    };
    gaps_told(
        search.run(significance),
        options.limits.least_hole,
        &mut report,
    );
    let arcs = arcs::arcs(search.mesh, search.incidence, search.feet);
    let even = arcs::evenness(&arcs);
    stretches_told(arcs::stretches(search.mesh, &arcs, &even), &mut report);
    if let Some(points) = options.points {
        let ends = loose::loose_ends(search, points, &arcs, &even);
        ends_told(search.mesh, ends, options.limits.loose_end, &mut report);
        let found = sheets::look(search, points, significance, options.limits.vertex_offset);
        sheets_told(search.mesh, found, &mut report);
        parts_told(search.mesh, &parts::touching(search, points), &mut report);
    }
    report
}

/// Regions without points that the mesh covers, as a figure and a violation.
fn gaps_told(gaps: Vec<Gap>, least_hole: f64, report: &mut FaithfulReport) {
    let no_chance = gaps.iter().filter(|g| g.p < report.significance);
    let (bridged, covered) = Covered::split(no_chance.collect(), least_hole);
    report.covered = (least_hole > 0.0).then_some(covered);
    for gap in &bridged {
        report.needs(gap.size / RESOLVED);
    }
    let widths = bridged.iter().map(|gap| gap.width);
    report.widest_bridged = widths.max_by(f64::total_cmp);
    report.bridged = bridged.iter().map(|&gap| gap.clone()).collect();
    if let Some(worst) = bridged.first() {
        let triangles = covered::places(&bridged).into_iter();
        let places = triangles.map(Place::Triangle).collect();
        let detail = if worst.together > 1 {
            let narrowest = |size: f64, gap: &&Gap| size.min(gap.size);
            let size = bridged.iter().fold(f64::INFINITY, narrowest);
            format!(
                "{} are no chance together, the largest is {:.1} spacings wide, p = {:.1e}; with dl = {:.3} they would stay open",
                worst.together,
                worst.width,
                worst.p,
                size / RESOLVED
            )
        } else {
            format!(
                "the largest is {:.1} spacings wide, {:.0} points are expected in it, p = {:.1e}; with dl = {:.3} it would stay open",
                worst.width,
                worst.expected,
                worst.p,
                worst.size / RESOLVED
            )
        };
        let violation = Violation::at(ViolationKind::BridgedGap, places, |_| worst.place.clone());
        report
            .violations
            .extend(violation.map(|v| v.measured(worst.p, report.significance).detailed(detail)));
    }
    report.largest_gap = gaps.into_iter().next();
}

/// Stretches of curves without points, as a figure and a violation.
fn stretches_told(stretches: Vec<Stretch>, report: &mut FaithfulReport) {
    let bare: Vec<&Stretch> = stretches
        .iter()
        .filter(|s| s.p < s.limit(report.significance))
        .collect();
    for stretch in &bare {
        report.needs(stretch.size / ENDED);
    }
    if let Some(worst) = bare.first() {
        let places = bare.iter().map(|s| Place::Edge(s.edge)).collect();
        let detail = format!(
            "the worst is {:.1} times as long as its points are apart ({:.4}){}, p = {:.1e}",
            worst.length,
            worst.size,
            if worst.joint {
                ", where the curve is joined to something else"
            } else {
                ""
            },
            worst.p
        );
        let violation = Violation::at(ViolationKind::BareStretch, places, |_| worst.place.clone());
        let told = violation.map(|v| {
            v.measured(worst.p, worst.limit(report.significance))
                .detailed(detail)
        });
        report.violations.extend(told);
    }
    report.largest_stretch = stretches.into_iter().next();
}

/// Ends of curves that may be joined to what is ahead of them, as a figure and a violation.
fn ends_told(mesh: &Mesh, ends: Vec<LooseEnd>, limit: f64, report: &mut FaithfulReport) {
    let undecided = ends.iter().filter(|end| end.p > limit);
    let places: Vec<Place> = undecided.map(|end| Place::Vertex(end.vertex)).collect();
    if let Some(worst) = ends.first().filter(|end| end.p > limit) {
        let detail = format!(
            "the worst leaves {:.1} times the distance of its points ({:.4}) to what is ahead of it; in that many chance \
             leaves as much with p = {:.1e}, and a curve that is joined is held to be none at {:.1e}",
            worst.length, worst.size, worst.p, limit
        );
        let violation = Violation::at(ViolationKind::UndecidedEnd, places, |place| {
            super::coordinates(mesh, place)
        });
        let told = violation.map(|v| v.measured(worst.p, limit).detailed(detail));
        report.violations.extend(told);
    }
    report.loose_end = ends.into_iter().next();
}

/// What was found about sheets and places, as figures and violations.
fn sheets_told(mesh: &Mesh, found: sheets::Found, report: &mut FaithfulReport) {
    let at = |place| super::coordinates(mesh, place);
    let significance = report.significance;
    report.scatter = found.scatter;
    let merged: Vec<&Merged> = found.merged.iter().filter(|m| m.p < significance).collect();
    for sheets in &merged {
        report.needs(sheets.distance);
    }
    if let Some(worst) = merged.first() {
        let places = merged.iter().map(|m| Place::Vertex(m.vertex)).collect();
        let detail = format!(
            "{:.2} spacings apart, p = {:.1e}; dl below {:.3} would keep them apart",
            worst.apart, worst.p, worst.distance
        );
        let violation = Violation::at(ViolationKind::MergedSheets, places, at);
        let told = violation.map(|v| v.measured(worst.p, significance).detailed(detail));
        report.violations.extend(told);
    }
    let off: Vec<&Offset> = found.off.iter().filter(|o| o.away > o.allowed).collect();
    if let Some(worst) = off.first() {
        let places = off.iter().map(|o| Place::Vertex(o.vertex)).collect();
        let violation = Violation::at(ViolationKind::VertexOffPoints, places, at);
        let detail = "in local spacings of the points".into();
        let told = violation.map(|v| v.measured(worst.away, worst.allowed).detailed(detail));
        report.violations.extend(told);
    }
    report.merged = found.merged.into_iter().next();
    report.offset = found.off.into_iter().next();
}

/// Places where parts of the mesh touch, as a violation.
fn parts_told(mesh: &Mesh, touches: &[parts::Touch], report: &mut FaithfulReport) {
    let Some(nearest) = touches.first() else {
        return;
    };
    let places = touches.iter().map(|t| Place::Vertex(t.vertex)).collect();
    let detail = format!("{:.2} spacings apart", nearest.apart);
    let violation = Violation::at(ViolationKind::TouchingParts, places, |place| {
        super::coordinates(mesh, place)
    });
    report
        .violations
        .extend(violation.map(|v| v.detailed(detail)));
}

fn spacings(ground: &Ground) -> [f64; 3] {
    let mut all: Vec<f64> = ground
        .density
        .iter()
        .filter(|&&d| d > 0.0)
        .map(|d| 1.0 / d.sqrt())
        .collect();
    all.sort_unstable_by(f64::total_cmp);
    [0.0, 0.5, 1.0].map(|q| quantile(&all, q))
}

impl fmt::Display for FaithfulReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [least, median, most] = self.spacing;
        write!(f, "points {median:.4} apart")?;
        if most > 1.5 * least {
            write!(f, " ({least:.4} to {most:.4})")?;
        }
        if self.points < self.of {
            write!(
                f,
                ", as {} of {} points are looked at",
                self.points, self.of
            )?;
        }
        match &self.largest_gap {
            Some(gap) => write!(
                f,
                "; largest gap bridged: {:.1} spacings ({:.4}), p = {:.1e}",
                gap.width, gap.size, gap.p
            ),
            None => f.write_str("; no gap bridged"),
        }?;
        if let Some(covered) = &self.covered {
            write!(f, ", {covered}")?;
        }
        if let Some(stretch) = &self.largest_stretch {
            write!(
                f,
                "; longest bare stretch of a curve: {:.1} spacings ({:.4}), p = {:.1e}",
                stretch.length, stretch.size, stretch.p
            )?;
        }
        if let Some(off) = &self.offset {
            write!(
                f,
                "\n           vertices up to {:.2} spacings off the points around them, which scatter by {:.2}",
                off.away, self.scatter
            )?;
        }
        if let Some(merged) = &self.merged {
            write!(
                f,
                "\n           heights over a sheet have a gap of {:.2} spacings, p = {:.1e}",
                merged.apart, merged.p
            )?;
        }
        Ok(())
    }
}
