//! Points at which curves end inside a sheet, and corners of boundaries: what is there is asked of models that say so, with balls as
//! wide as it takes, and their answers stand for all points about the end.

mod corners;
mod enter;
mod free;
mod innermost;
mod part;
mod region;
mod wards;

pub(super) use innermost::innermost;
pub(super) use region::{EndFound, EndRegion, Settled};
pub(super) use wards::Wards;

use super::analysis::{Analysis, Analyzer, Fitter, ModelCounts, Scratch};
use super::site::{Site, StratumKind};
use super::strata::Strata;
use crosscap_core::{Error, Row, Scalar};
use free::End;
use part::Answer;

/// Asks what is at the ends of double curves and about points of boundaries that were found, and enters the answers; says what became of
/// the models that were asked. Where no curve was found, or no model knows of ends, nothing is done.
///
/// # Errors
/// [`Error::Law`] for what a model breaks.
pub(super) fn explain<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    strata: &mut Strata,
) -> Result<Vec<ModelCounts>, Error> {
    let all = 0..analyzer.models.len();
    let (corners, ends): (Vec<usize>, Vec<usize>) = all
        .filter(|&m| analyzer.models[m].explains_ends())
        .partition(|&m| analyzer.models[m].finds_boundary());
    let there = |kind| move |site: &Site| site.kind() == Some(kind);
    let any = |kind| strata.sites().iter().any(there(kind));
    let has_ends = !ends.is_empty() && any(StratumKind::Curve);
    let has_corners = !corners.is_empty() && any(StratumKind::Boundary);
    if !has_ends && !has_corners {
        return Ok(Vec::new());
    }
    let fitter = analyzer.fitter("since ends of curves are looked at in them")?;
    let tuning = &analyzer.tuning.ends;
    let mut answers = match has_ends {
        true => of_curves(analyzer, &fitter, strata, &ends),
        false => Vec::new(),
    };
    if has_corners {
        let more = corners::answers(analyzer, &fitter, analysis, strata, &corners, &answers);
        answers.extend(more);
    }
    // A pinch point has no boundary: its balls are wide enough for its sheets to open, and what was seen there before is wrong.
    let sheets_end = |a: &&mut Answer| a.region.fit.cells_at_curve.contains(&1);
    for answer in answers.iter_mut().filter(sheets_end) {
        answer.keep_clear(fitter.cloud, |row| !strata.is_regular(row), tuning.overlap);
    }
    part::part(fitter.cloud, &mut answers, tuning.overlap);
    for answer in answers {
        enter::enter(strata, fitter.cloud, answer, tuning);
    }
    if !strata.regions().is_empty() {
        fitter.continue_boundaries(analysis, strata);
    }
    fitter.faults.none()?;
    Ok(fitter.counts())
}

/// What the `models` say about the ends of double curves.
fn of_curves<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    fitter: &Fitter<'_, S>,
    strata: &Strata,
    models: &[usize],
) -> Vec<Answer> {
    let tuning = &analyzer.tuning.ends;
    let mut scratch = Scratch::default();
    let mut answers: Vec<Answer> = Vec::new();
    for End { row, behind, eps } in free::ends(analyzer, strata) {
        let mut asked =
            |row: Row, radius: f64| fitter.about_end(models, row, radius, eps, &mut scratch);
        let mut about =
            |row: Row| (tuning.radii.iter()).find_map(|factor| asked(row, factor * eps));
        let found = about(row).or_else(|| about(behind?));
        let Some((region, settled)) = found else {
            continue;
        };
        // Two ends may lead to one point; the first of them is an end more than the other.
        let other = |a: &Answer| a.region.distance(&region.place) > eps;
        if answers.iter().all(other) {
            answers.push(Answer {
                region,
                settled,
                eps,
            });
        }
    }
    answers
}
