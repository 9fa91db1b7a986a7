//! Landmarks inside cells.

use super::analysis::Analyzer;
use super::curve_ends;
use super::skeleton::Skeleton;
use super::strata::Strata;
use crate::audit;
use crosscap_core::{Error, LandmarkSelector, Scalar};

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
) -> Result<Vec<usize>, Error> {
    let candidates = free_of_edges(analyzer, strata, skeleton);
    let innermost = curve_ends::innermost(strata, analyzer.tuning.ends.innermost * dl);
    let taken = &[skeleton.rows(), &innermost].concat();
    let oracle = analyzer.space.oracle();
    let chosen = selector.select(oracle, &candidates, taken, dl, seed)?;
    let question = audit::Question {
        plugin: selector.name(),
        candidates: &candidates,
        taken,
        separation: dl,
    };
    audit::selection(oracle, analyzer.execute, &question, &chosen)?;
    Ok([innermost, chosen].concat())
}

/// Regular rows outside the diametral ball of every chain edge: a landmark inside it would
/// make the edge no edge of a Delaunay triangulation, and on a convex boundary may even lie
/// beyond it.
fn free_of_edges<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &Strata,
    skeleton: &Skeleton,
) -> Vec<usize> {
    let mut barred = vec![false; strata.len()];
    if let Some(places) = strata.places() {
        let mut near = Vec::new();
        for e in skeleton.edges().iter().filter(|e| e.cells > 0) {
            let [a, b] = e.ends.map(|k| skeleton.rows()[k as usize]);
            let length = places.squared_distance(a, b);
            let reach = length.sqrt() + strata.moved(a);
            analyzer.space.oracle().within(a, S::of(reach), &mut near);
            for x in &near {
                let [to_a, to_b] = [a, b].map(|end| places.squared_distance(end, x.index));
                barred[x.index] |= to_a + to_b < length;
            }
        }
    }
    (0..strata.len())
        .filter(|&i| strata.is_regular(i) && !barred[i])
        .collect()
}
