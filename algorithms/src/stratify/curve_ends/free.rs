//! Where double curves end.

use crate::stratify::analysis::Analyzer;
use crate::stratify::site::StratumKind;
use crate::stratify::strata::Strata;
use crosscap_core::{Neighbor, Row, Scalar};

/// A point of a curve that may be its end.
struct Candidate {
    row: Row,
    /// How far the middle of the curve about it is off.
    shift: f64,
    /// Radius of the analysis there.
    eps: f64,
}

/// Ends of double curves that stop at nothing, each with the radius of the analysis there: those that are ends
/// most come first, and no two are in one ball.
///
/// O(c n) for c points of double curves with n neighbors each.
pub(super) fn ends<S: Scalar>(analyzer: &Analyzer<'_, S>, strata: &Strata) -> Vec<(Row, f64)> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut near: Vec<Neighbor<S>> = Vec::new();
    let mut mean = vec![0.0; places.dimension()];
    let mut found: Vec<Candidate> = (strata.rows())
        .filter(|&row| is_double(strata, row))
        .filter_map(|row| candidate(analyzer, strata, row, &mut near, &mut mean))
        .collect();
    found.sort_by(|a, b| b.shift.total_cmp(&a.shift).then(a.row.cmp(&b.row)));
    let mut ends: Vec<(Row, f64)> = Vec::new();
    for Candidate { row, eps, .. } in found {
        let free = |x: &(Row, f64)| places.squared_distance(row.index(), x.0.index()) > eps * eps;
        if ends.iter().all(free) {
            ends.push((row, eps));
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
    mean: &mut [f64],
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
    mean.fill(0.0);
    let mut count = 0.0;
    for x in near.iter().filter(|x| is_double(strata, x.row())) {
        count += 1.0;
        let places = places.point(x.index).iter().zip(places.point(row.index()));
        for (m, (o, p)) in mean.iter_mut().zip(places) {
            *m += o - p;
        }
    }
    let shift = mean.iter().map(|m| m * m).sum::<f64>().sqrt() / count;
    (shift > analyzer.tuning.ends.shift * eps).then_some(Candidate { row, shift, eps })
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
