//! How near to each other landmarks have to be for what the points leave open.

use super::moves::{ROOMY, SMALLER};
use super::symptoms::Symptom;
use crate::pipeline::Outcome;
use crosscap_core::Error;

/// Part of the separation that is asked for where the mesh has too few edges to follow the end of the points: with what is
/// taken of it, both lengths become those of smaller neighborhoods.
pub(super) const RESOLVING: f64 = SMALLER / ROOMY;

/// The landmark separation that the gaps of the points ask for, where they are what is wrong: they are covered, or their rims
/// have too few landmarks.
pub(super) fn gap_needs(symptom: Option<Symptom>, outcome: &Result<Outcome, Error>) -> Option<f64> {
    let outcome = outcome.as_ref().ok()?;
    let dl = outcome.report.parameters.dl;
    match symptom? {
        Symptom::Gaps => {
            let needed = outcome.certificate.faithful.as_ref()?.separation_needed;
            needed.filter(|&needed| needed < dl)
        }
        Symptom::Coarse => Some(RESOLVING * dl),
        _ => None,
    }
}
