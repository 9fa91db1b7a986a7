//! Corners of boundaries that were found.

use super::part::Answer;
use super::region::EndFound;
use crate::balls::BallTree;
use crate::stratify::analysis::{Analysis, Analyzer, Fitter, Scratch};
use crate::stratify::site::StratumKind;
use crate::stratify::strata::Strata;
use crosscap_core::{Row, Scalar};

/// Asks the `models` about points of boundaries that were found, and says where they see corners. Where another end is, nothing is
/// asked: its model knows of the boundaries there.
///
/// O(b) fits for boundaries of b balls, and O(m log m) for the m points of boundaries that are looked through.
pub(super) fn answers<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    fitter: &Fitter<'_, S>,
    analysis: &Analysis,
    strata: &Strata,
    models: &[usize],
    others: &[Answer],
) -> Vec<Answer> {
    let tuning = &analyzer.tuning.ends;
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut scratch = Scratch::default();
    let mut out: Vec<Answer> = Vec::new();
    let rows: Vec<Row> = (strata.rows().filter(|&row| is_found(strata, row))).collect();
    let all: Vec<f64> = (rows
        .iter()
        .flat_map(|row| places.point(row.index()))
        .copied())
    .collect();
    let tree = BallTree::new(places.dimension(), &all);
    let mut asked = vec![false; rows.len()];
    for (k, &row) in rows.iter().enumerate() {
        let eps = analysis.radius(row);
        let place = places.point(row.index());
        let known = |a: &Answer| a.region.distance(place) < a.region.reach;
        let spacing = tuning.corner_spacing * eps;
        if tree.any_within(place, spacing, |j, _| asked[j as usize]) || others.iter().any(known) {
            continue;
        }
        // About a corner that is known there is nothing to find.
        if out.iter().any(|a| a.region.distance(place) < spacing) {
            continue;
        }
        asked[k] = true;
        let mut found = |factor: &f64| -> Option<EndFound> {
            fitter.about_end(models, row, factor * eps, eps, &mut scratch)
        };
        let Some((region, settled)) = tuning.corner_radii.iter().find_map(&mut found) else {
            continue;
        };
        // Two balls may show one corner.
        if out.iter().all(|a| a.region.distance(&region.place) > eps) {
            let mut answer = Answer {
                region,
                settled,
                eps,
            };
            answer.cut(fitter.cloud, tuning.corner_reach * eps, tuning.overlap);
            out.push(answer);
        }
    }
    out
}

/// Whether a row is on a boundary that nobody gave.
fn is_found(strata: &Strata, row: Row) -> bool {
    let on = strata.sites()[row].on();
    on.is_some_and(|on| on.kind == StratumKind::Boundary && on.place.is_some())
}
