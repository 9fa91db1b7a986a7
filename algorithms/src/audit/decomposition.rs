//! Decompositions by singularity models.

use super::{Faults, broken};
use crosscap_core::{
    Contradiction, Decomposition, Error, LocalPoints, Located, Rejection, SingularityModel,
};

/// Refuses a model whose coordinates could not be given to it.
///
/// # Errors
/// [`Error::Law`] for a local dimension of 0.
pub(crate) fn local_dimension(model: &dyn SingularityModel) -> Result<(), Error> {
    if model.local_dimension() > 0 {
        return Ok(());
    }
    let law = "local_dimension is the number of coordinates that the model works in";
    broken(model.name(), law, 0, "0 coordinates".into())
}

/// The decomposition of the neighborhood of `point`, if the model has one that can be used; what is wrong with one
/// that cannot is remembered.
pub(crate) fn sound(
    found: Result<Decomposition, Rejection>,
    local: &LocalPoints<'_>,
    model: &dyn SingularityModel,
    point: usize,
    faults: &Faults,
) -> Option<Decomposition> {
    let fit = found.ok()?;
    if let Err(wrong) = fit.check(local) {
        remember(wrong, model, point, faults);
        return None;
    }
    if model.finds_boundary() && fit.cells_at_curve.iter().any(|&cells| cells != 1) {
        let wrong = Contradiction {
            law: "cells_at_curve: one at every curve of a model that finds boundaries",
            found: format!("{:?}", fit.cells_at_curve),
        };
        remember(wrong, model, point, faults);
        return None;
    }
    Some(fit)
}

/// What was found of `rows` around `point`; what cannot be used is remembered and left out.
pub(crate) fn placed(
    found: Vec<Option<Located>>,
    rows: &[usize],
    local: &LocalPoints<'_>,
    model: &dyn SingularityModel,
    point: usize,
    faults: &Faults,
) -> Vec<Option<Located>> {
    let law = "decompose_about says of rows what decompose says of the center";
    if found.len() != rows.len() {
        let found = format!("{} answers for {} rows", found.len(), rows.len());
        remember(Contradiction { law, found }, model, point, faults);
        return vec![None; rows.len()];
    }
    let sound = |&row: &usize, x: &Located| match x.check(local.point(row), local.radius) {
        Ok(()) => true,
        Err(wrong) => {
            let found = format!("{}: {}", wrong.law, wrong.found);
            remember(Contradiction { law, found }, model, point, faults);
            false
        }
    };
    let pairs = found.into_iter().zip(rows);
    pairs.map(|(x, row)| x.filter(|x| sound(row, x))).collect()
}

fn remember(wrong: Contradiction, model: &dyn SingularityModel, point: usize, faults: &Faults) {
    if let Err(error) = broken::<()>(model.name(), wrong.law, point, wrong.found) {
        faults.add(point, error);
    }
}
