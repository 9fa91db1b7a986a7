//! Distances of landmarks that are in one chart.

use super::analysis::Analyzer;
use super::charts::ChartSpace;
use super::strata::Strata;
use crate::audit;
use crate::execute::{self, Execute};
use crate::tangents::TangentField;
use crosscap_core::{
    CellNeighborhood, Error, Landmark, MetricSpace, Row, Scalar, SparseDistances, Table,
};

/// The distances of all members of each neighborhood, of landmarks that stand for `rows`.
pub(super) fn within_charts<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    charts: &ChartSpace<'_, S>,
    rows: &Table<Landmark, Row>,
    neighborhoods: &[CellNeighborhood],
) -> Result<SparseDistances<S>, Error> {
    match charts.space() {
        None => {
            let places = strata.places().ok_or_else(|| Error::Shape {
                found: "points without coordinates".into(),
                expected: "coordinates, or a metric for the charts".into(),
            })?;
            SparseDistances::within(rows.len(), neighborhoods, |a, b| {
                let [p, q] = [a, b].map(|k| rows[k].index());
                S::of(places.squared_distance(p, q).sqrt())
            })
        }
        Some(space) => {
            let pairs = pairs(neighborhoods.iter().map(|x| x.members()));
            let (execute, planes) = (analyzer.execute, charts.planes());
            let mut lengths = lengths(execute, space.metric(), planes, rows, &pairs)?;
            add_moves(analyzer, strata, rows, &pairs, &mut lengths);
            let entries = pairs.iter().zip(&lengths).map(|(&(a, b), &d)| (a, b, d));
            SparseDistances::new(rows.len(), entries)
        }
    }
}

/// All pairs of members of the same neighborhood, sorted.
pub(super) fn pairs<'m>(
    neighborhoods: impl Iterator<Item = &'m [Landmark]>,
) -> Vec<(Landmark, Landmark)> {
    let mut pairs: Vec<(Landmark, Landmark)> = Vec::new();
    for members in neighborhoods {
        for (i, &a) in members.iter().enumerate() {
            pairs.extend(members[..i].iter().map(|&b| (a.min(b), a.max(b))));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Distances of sorted pairs of landmarks in a metric, asked for row by row, and made better by tangent planes where there are any.
///
/// # Errors
/// [`Error::Law`] for one that is NaN or negative.
pub(super) fn lengths<S: Scalar>(
    execute: &dyn Execute,
    metric: &dyn MetricSpace<Scalar = S>,
    planes: Option<&TangentField>,
    rows: &Table<Landmark, Row>,
    pairs: &[(Landmark, Landmark)],
) -> Result<Vec<S>, Error> {
    let runs: Vec<&[(Landmark, Landmark)]> = pairs.chunk_by(|x, y| x.0 == y.0).collect();
    let lengths = execute::map(execute, runs.len(), Vec::new, |targets, k| {
        targets.clear();
        targets.extend(runs[k].iter().map(|&(_, b)| rows[b].index()));
        let mut lengths = Vec::with_capacity(targets.len());
        metric.distances_to(rows[runs[k][0].0].index(), targets, &mut lengths);
        lengths
    });
    let mut lengths: Vec<S> = lengths.into_iter().flatten().collect();
    let wrong = |d: &S| !(d.is_finite() && *d >= S::zero());
    if let Some(at) = lengths.iter().position(wrong) {
        let [p, q] = [pairs[at].0, pairs[at].1].map(|k| rows[k].index());
        audit::distance(metric, p, q)?;
    }
    if let Some(planes) = planes {
        straighten(planes, rows, pairs, &mut lengths);
    }
    Ok(lengths)
}

/// Takes away what paths are too long by, where the tangent planes tell; from the others what they are usually too long by, so that the two
/// kinds go together in one chart.
fn straighten<S: Scalar>(
    planes: &TangentField,
    rows: &Table<Landmark, Row>,
    pairs: &[(Landmark, Landmark)],
    lengths: &mut [S],
) {
    let told: Vec<Option<f64>> = (pairs.iter().zip(&*lengths))
        .map(|(&(a, b), path)| planes.length(rows[a].index(), rows[b].index(), path.as_f64()))
        .collect();
    let ratios = (told.iter().zip(&*lengths)).filter_map(|(t, path)| Some((*t)? / path.as_f64()));
    let mut ratios: Vec<f64> = ratios.collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let usual = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0);
    for (length, told) in lengths.iter_mut().zip(told) {
        *length = S::of(told.unwrap_or(usual * length.as_f64()));
    }
}

/// Where a landmark was moved onto a curve, adds what the move does to the straight line: a metric knows the
/// points as they were.
fn add_moves<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    rows: &Table<Landmark, Row>,
    pairs: &[(Landmark, Landmark)],
    lengths: &mut [S],
) {
    let (Some(cloud), Some(places)) = (analyzer.space.places(), strata.places()) else {
        return;
    };
    for (length, &(a, b)) in lengths.iter_mut().zip(pairs) {
        let [p, q] = [a, b].map(|k| rows[k]);
        if strata.moved(p) > 0.0 || strata.moved(q) > 0.0 {
            let (p, q) = (p.index(), q.index());
            let moved = places.squared_distance(p, q).sqrt();
            let straight = cloud.squared_distance(p, q).sqrt();
            *length = S::of((length.as_f64() + moved - straight).max(0.0));
        }
    }
}
