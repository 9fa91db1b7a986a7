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

/// Distances of landmarks in the metric of the charts that were asked for last.
///
/// A waist with a few more landmarks has nearly all of them in common with the one before, and paths are what it takes longest to find.
pub(super) struct Asked<S> {
    rows: Vec<Row>,
    /// Sorted.
    pairs: Vec<(Landmark, Landmark)>,
    lengths: Vec<S>,
}

impl<S> Default for Asked<S> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            pairs: Vec::new(),
            lengths: Vec::new(),
        }
    }
}

impl<S: Scalar> Asked<S> {
    /// Those of sorted pairs of landmarks that stand for `rows`, of which only the new ones are asked for.
    fn lengths(
        &mut self,
        execute: &dyn Execute,
        metric: &dyn MetricSpace<Scalar = S>,
        rows: &Table<Landmark, Row>,
        pairs: &[(Landmark, Landmark)],
    ) -> Result<&[S], Error> {
        if !rows.as_slice().starts_with(&self.rows) {
            *self = Self::default();
        }
        let known = |pair: &(Landmark, Landmark)| self.pairs.binary_search(pair).ok();
        let before: Vec<Option<usize>> = pairs.iter().map(known).collect();
        let unknown = pairs.iter().zip(&before).filter(|(_, at)| at.is_none());
        let fresh: Vec<(Landmark, Landmark)> = unknown.map(|(&pair, _)| pair).collect();
        let mut found = asked(execute, metric, rows, &fresh)?.into_iter();
        let lengths = before.into_iter().filter_map(|at| match at {
            Some(at) => Some(self.lengths[at]),
            None => found.next(),
        });
        *self = Self {
            lengths: lengths.collect(),
            rows: rows.as_slice().to_vec(),
            pairs: pairs.to_vec(),
        };
        Ok(&self.lengths)
    }
}

/// The distances of all members of each neighborhood, of landmarks that stand for `rows`; `before` are those of a waist that was made
/// before of the same cloud.
pub(super) fn within_charts<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    charts: &ChartSpace<'_, S>,
    rows: &Table<Landmark, Row>,
    neighborhoods: &[CellNeighborhood],
    before: &mut Asked<S>,
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
            let asked = before.lengths(analyzer.execute, space.metric(), rows, &pairs)?;
            let mut lengths = asked.to_vec();
            if let Some(planes) = charts.planes() {
                straighten(planes, rows, &pairs, &mut lengths);
            }
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
    let mut lengths = asked(execute, metric, rows, pairs)?;
    if let Some(planes) = planes {
        straighten(planes, rows, pairs, &mut lengths);
    }
    Ok(lengths)
}

/// What a metric says of sorted pairs of landmarks, asked for row by row.
fn asked<S: Scalar>(
    execute: &dyn Execute,
    metric: &dyn MetricSpace<Scalar = S>,
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
    let lengths: Vec<S> = lengths.into_iter().flatten().collect();
    let wrong = |d: &S| !(d.is_finite() && *d >= S::zero());
    if let Some(at) = lengths.iter().position(wrong) {
        let [p, q] = [pairs[at].0, pairs[at].1].map(|k| rows[k].index());
        audit::distance(metric, p, q)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Numbers on a line, which count the distances they are asked for.
    #[derive(Default)]
    struct Line(AtomicUsize);

    impl MetricSpace for Line {
        type Scalar = f64;

        fn len(&self) -> usize {
            100
        }

        fn distance(&self, a: usize, b: usize) -> f64 {
            self.0.fetch_add(1, Ordering::Relaxed);
            a.abs_diff(b) as f64
        }

        fn name(&self) -> &str {
            "line"
        }
    }

    /// Of a waist with one more landmark only the pairs that are new are asked for, wherever they stand among the others; of other landmarks
    /// all of them.
    #[test]
    fn what_was_asked_before_is_not_asked_again() {
        let (line, mut asked) = (Line::default(), Asked::default());
        let mut of = |rows: &[usize], pairs: &[(usize, usize)]| {
            let rows: Table<Landmark, Row> = rows.iter().map(|&k| Row::new(k)).collect();
            let pair = |&(a, b): &(usize, usize)| (Landmark::new(a), Landmark::new(b));
            let pairs: Vec<(Landmark, Landmark)> = pairs.iter().map(pair).collect();
            let before = line.0.load(Ordering::Relaxed);
            let found = asked
                .lengths(&Serial, &line, &rows, &pairs)
                .unwrap()
                .to_vec();
            (found, line.0.load(Ordering::Relaxed) - before)
        };
        let first = of(&[10, 20, 50], &[(0, 1), (0, 2), (1, 2)]);
        assert_eq!(first, (vec![10.0, 40.0, 30.0], 3));
        let more = of(&[10, 20, 50, 45], &[(0, 1), (0, 3), (1, 2), (2, 3)]);
        assert_eq!(more, (vec![10.0, 35.0, 30.0, 5.0], 2));
        let other = of(&[11, 20, 50], &[(0, 1), (1, 2)]);
        assert_eq!(other, (vec![9.0, 30.0], 2));
    }
}
