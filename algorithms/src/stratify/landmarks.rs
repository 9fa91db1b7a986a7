//! Landmarks inside cells.

use super::analysis::Analyzer;
use super::curve_ends;
use super::skeleton::Skeleton;
use super::strata::Strata;
use crate::audit;
use crosscap_core::{Error, LandmarkSelector, Row, Scalar, Table};

/// Landmarks that a selector chooses among the regular points, the skeleton's being taken.
///
/// # Errors
/// Those of the selector; [`Error::Law`] for what it breaks.
pub(super) fn choose<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    skeleton: &Skeleton,
    selector: &dyn LandmarkSelector<Scalar = S>,
    dl: f64,
    seed: u64,
) -> Result<Vec<Row>, Error> {
    let barred = barred(analyzer, strata, skeleton);
    let free = barred.each().filter(|x| !x.1);
    let candidates: Vec<usize> = free.map(|x| x.0.index()).collect();
    let innermost = innermost(analyzer, strata, dl);
    let taken = skeleton.rows().iter().chain(&innermost);
    let taken: &Vec<usize> = &taken.map(|row| row.index()).collect();
    let oracle = analyzer.space.oracle();
    let chosen = selector.select(oracle, &candidates, taken, dl, seed)?;
    let question = audit::Question {
        plugin: selector.name(),
        candidates: &candidates,
        taken,
        separation: dl,
    };
    audit::selection(oracle, analyzer.execute, &question, &chosen)?;
    let chosen = chosen.into_iter().map(Row::new);
    Ok(innermost.into_iter().chain(chosen).collect())
}

/// Landmarks next to the ends of curves, which are there before any is chosen.
pub(super) fn innermost<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    dl: f64,
) -> Vec<Row> {
    curve_ends::innermost(strata, analyzer.tuning.ends.innermost * dl)
}

/// Whether a row cannot be chosen: it is on a curve, or in the diametral ball of a chain edge, where a landmark would
/// make the edge no edge of a Delaunay triangulation, and on a convex boundary may even lie
/// beyond it.
pub(super) fn barred<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    skeleton: &Skeleton,
) -> Table<Row, bool> {
    let regular = strata.rows().map(|row| strata.is_regular(row));
    let mut barred: Table<Row, bool> = regular.map(|regular| !regular).collect();
    if let Some(places) = strata.places() {
        let mut near = Vec::new();
        for e in skeleton.edges().iter().filter(|e| e.cells > 0) {
            let [a, b] = e.landmarks().map(|k| skeleton.rows()[k]);
            let length = places.squared_distance(a.index(), b.index());
            let reach = length.sqrt() + strata.moved(a);
            analyzer
                .space
                .oracle()
                .within(a.index(), S::of(reach), &mut near);
            for x in &near {
                let [to_a, to_b] = [a, b].map(|end| places.squared_distance(end.index(), x.index));
                barred[x.row()] |= to_a + to_b < length;
            }
        }
    }
    barred
}
