//! Where double curves end.

use crate::stratify::analysis::Analyzer;
use crate::stratify::site::StratumKind;
use crate::stratify::strata::Strata;
use crosscap_core::{Neighbor, Row, Scalar};

/// An end of a double curve that stops at nothing.
pub(super) struct End {
    /// The row that is out farthest.
    pub(super) row: Row,
    /// One of the curve some way behind it: sheets that end are taken to cross a little beyond their ends as well.
    pub(super) behind: Option<Row>,
    /// Radius of the analysis there.
    pub(super) eps: f64,
}

/// A point of a curve that may be its end.
struct Candidate {
    row: Row,
    behind: Option<Row>,
    /// How far the middle of the curve about it is off: half way between where it reaches to both sides.
    shift: f64,
    /// Radius of the analysis there.
    eps: f64,
}

/// Ends of double curves that stop at nothing: those that are ends most come first, and no two are in one ball.
///
/// O(c n) for c points of double curves with n neighbors each.
pub(super) fn ends<S: Scalar>(analyzer: &Analyzer<'_, S>, strata: &Strata) -> Vec<End> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut near: Vec<Neighbor<S>> = Vec::new();
    let mut found: Vec<Candidate> = (strata.rows())
        .filter(|&row| is_double(strata, row))
        .filter_map(|row| candidate(analyzer, strata, row, &mut near))
        .collect();
    found.sort_by(|a, b| b.shift.total_cmp(&a.shift).then(a.row.cmp(&b.row)));
    let mut ends: Vec<End> = Vec::new();
    for Candidate {
        row, behind, eps, ..
    } in found
    {
        let free = |x: &End| places.squared_distance(row.index(), x.row.index()) > eps * eps;
        if ends.iter().all(free) {
            ends.push(End { row, behind, eps });
        }
    }
    ends
}

fn is_double(strata: &Strata, row: Row) -> bool {
    strata.kind(row) == Some(StratumKind::Curve) && strata.cells(row) > 2
}

/// Whether the curve ends about a row: it lies to one side, and no point is near in which it could stop.
fn candidate<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    row: Row,
    near: &mut Vec<Neighbor<S>>,
) -> Option<Candidate> {
    let (places, oracle) = (strata.places()?, analyzer.space.oracle());
    // The fit of the row itself may have shrunk.
    let mut eps = strata.radius(row).unwrap_or(0.0);
    for _ in 0..2 {
        oracle.within(row.index(), S::of(eps), near);
        let radii = near.iter().filter_map(|x| strata.radius(x.row()));
        eps = radii.fold(eps, f64::max);
    }
    oracle.within(row.index(), S::of(eps), near);
    if near.iter().any(|x| stops(analyzer, strata, x.row())) {
        return None;
    }
    // Points of the curve lie unevenly along it: how far they reach tells more than their mean.
    let curve = || {
        near.iter()
            .map(|x| x.row())
            .filter(|&x| is_double(strata, x))
    };
    let square = |x: Row| places.squared_distance(row.index(), x.index());
    let farthest = curve().max_by(|&a, &b| square(a).total_cmp(&square(b)).then(b.cmp(&a)))?;
    let ahead = square(farthest).sqrt();
    let behind = curve().map(|x| {
        // Along the way to the farthest point, by the law of cosines.
        let across = places.squared_distance(farthest.index(), x.index());
        (square(x) + ahead * ahead - across) / (2.0 * ahead)
    });
    let shift = (ahead + behind.fold(0.0, f64::min)) / 2.0;
    let away = |x: Row| (square(x).sqrt() - analyzer.tuning.ends.behind * eps).abs();
    let behind = curve().min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)));
    (shift > analyzer.tuning.ends.shift * eps).then_some(Candidate {
        row,
        behind: behind.filter(|&other| other != row),
        shift,
        eps,
    })
}

/// Whether a row is a point in which double curves stop. One at which only curves without a surface do is
/// none: near a pinch point a narrow strip of the sheet passes for such a curve.
fn stops<S: Scalar>(analyzer: &Analyzer<'_, S>, strata: &Strata, row: Row) -> bool {
    let Some(on) = (strata.sites()[row].on()).filter(|on| on.kind == StratumKind::Point) else {
        return false;
    };
    let link = (on.fit).and_then(|used| analyzer.models[usize::from(used.model)].link());
    link.is_none_or(|link| (0..link.nodes() as u8).any(|node| link.degree(node) > 2))
}
