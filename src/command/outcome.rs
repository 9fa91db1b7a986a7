//! What is said and written of the outcome of a reconstruction.

use super::failure::Failure;
use super::findings::Findings;
use crosscap::GivenSpace;
use crosscap::pipeline::{Outcome, Parameters};
use crosscap_algorithms::certificate::Verdict;
use crosscap_backends::files::{MeshExtras, write_mesh};
use serde_json::{Value, json};
use std::path::Path;

/// How many reasons of a failure are printed.
const REASONS: usize = 8;

/// The verdict on a verified mesh in a line, with what it does not cover.
pub fn verdict(outcome: &Outcome) -> String {
    let faithful = outcome.certificate.faithful.as_ref();
    match faithful.and_then(|told| told.covered) {
        None => checked(outcome),
        Some(covered) => format!("{}, {covered}", checked(outcome)),
    }
}

/// The same without what was taken for granted.
fn checked(outcome: &Outcome) -> String {
    let unchecked = outcome.certificate.unchecked();
    if unchecked.is_empty() {
        return "verified".into();
    }
    let names: Vec<String> = unchecked.iter().map(ToString::to_string).collect();
    let names = names.join(", ");
    if outcome.certificate.by_distances.is_some() {
        format!("verified by distances; not checked for want of coordinates: {names}")
    } else {
        format!("verified; not checked: {names}")
    }
}

/// What became of distances.
pub fn told(given: &GivenSpace) -> String {
    let GivenSpace {
        dimension,
        deviation,
        exact,
    } = given;
    if *exact {
        format!("the distances are those of points in R^{dimension}, within {deviation:.1e}")
    } else {
        format!(
            "no points have these distances: the places written, in R^{dimension}, are a picture, off by up to \
             {deviation:.1e}"
        )
    }
}

/// What is known about the mesh of an outcome.
pub fn findings(outcome: &Outcome) -> Findings<'_> {
    Findings {
        mesh: &outcome.mesh,
        homology: &outcome.homology,
        certificate: &outcome.certificate,
        pieces: &outcome.pieces,
        creases: outcome.creases.as_ref(),
        special_points: &outcome.special_points,
    }
}

/// Why a mesh is not verified: place and parameter to change, the first few.
pub fn reasons(outcome: &Outcome) -> Vec<String> {
    let mut reasons: Vec<String> = outcome.failures.iter().map(ToString::to_string).collect();
    if let Verdict::Refused(violations) = outcome.certificate.verdict() {
        reasons.extend(violations.iter().map(ToString::to_string));
    }
    let more = reasons.len().saturating_sub(REASONS);
    reasons.truncate(REASONS);
    if more > 0 {
        reasons.push(format!(
            "and {more} more (see the report of --keep-unverified)"
        ));
    }
    reasons
}

/// Writes the mesh with its pieces and with what it was made from; nothing in it changes from run to run.
///
/// `prepared` says whether something was done about outliers and noise.
pub fn write_reconstruction(
    path: &Path,
    parameters: &Parameters,
    outcome: &Outcome,
    verified: bool,
    prepared: bool,
) -> Result<(), Failure> {
    let pieces = outcome.pieces.as_ref().ok();
    let extras = MeshExtras {
        metadata: metadata(parameters, outcome, verified, prepared),
        pieces: pieces.map(|p| p.triangle_piece.iter().map(|&k| k.into()).collect()),
    };
    let places = super::convert::places_for(path, &outcome.mesh, None)?;
    write_mesh(path, &outcome.mesh, &extras, places.as_ref())?;
    Ok(())
}

/// What is written beside a mesh of how it was made; [`Origin`](super::origin::Origin) reads it again.
pub fn metadata(
    parameters: &Parameters,
    outcome: &Outcome,
    verified: bool,
    prepared: bool,
) -> Value {
    let mut metadata = json!({
        "crosscap": env!("CARGO_PKG_VERSION"),
        "verified": verified,
        "eps": parameters.eps,
        "tri_eps": parameters.tri_eps,
        "dt": parameters.dt,
        "dp": parameters.dp,
        "ep": parameters.ep,
        "dl": parameters.dl,
        "seed": parameters.seed,
        "surface": parameters.surface,
        "boundary_points": parameters.boundary.len(),
        "models": parameters.models,
        "method": parameters.method.to_string(),
        "estimator": outcome.report.plugins.estimator,
    });
    if let Some(width) = parameters.least_hole {
        metadata["least_hole"] = json!(width);
    }
    if let Some(given) = &outcome.report.given {
        metadata["distances"] = json!(given);
        metadata["unchecked"] = json!(outcome.certificate.unchecked());
    }
    if prepared {
        metadata["prepared"] = json!(true);
    }
    if !outcome.special_points.is_empty() {
        metadata["special_points"] = json!(outcome.special_points);
    }
    if !parameters.spaces.are_usual() {
        metadata["spaces"] = json!(parameters.spaces);
    }
    metadata
}

/// The report for programs.
pub fn report(outcome: &Outcome, input: Value) -> Value {
    let mut all = match json!(outcome.report) {
        Value::Object(map) => map,
        other => [("report".to_string(), other)].into_iter().collect(),
    };
    all.insert("input".into(), input);
    all.extend(findings(outcome).json(outcome.is_verified()));
    let failures: Vec<String> = outcome.failures.iter().map(ToString::to_string).collect();
    all.insert("failures".into(), json!(failures));
    Value::Object(all)
}

/// Number of duplicate points that the pipeline reports.
pub fn duplicates(outcome: &Outcome) -> Option<usize> {
    let count = json!(outcome.report).get("duplicates")?.as_u64()?;
    usize::try_from(count).ok()
}
