//! Decompositions by singularity models.

use super::{Faults, broken};
use crosscap_core::{Decomposition, Error, LocalPoints, Located, Rejection, SingularityModel};

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
    match check(&fit, local, model.name(), point) {
        Ok(()) => Some(fit),
        Err(error) => {
            faults.add(point, error);
            None
        }
    }
}

/// What was found of rows around `point`; what cannot be used is remembered and left out.
pub(crate) fn placed(
    found: Vec<Option<Located>>,
    local: &LocalPoints<'_>,
    model: &dyn SingularityModel,
    point: usize,
    faults: &Faults,
) -> Vec<Option<Located>> {
    let sound = |x: &Located| {
        let place = x.place.len() == local.dimension && x.place.iter().all(|c| c.is_finite());
        let offset = x.offset >= 0.0 && (x.offset.is_finite() || x.dimension == 2);
        if place && offset && x.dimension <= 2 {
            return true;
        }
        let law = "decompose_about says of rows what decompose says of the center";
        if let Err(error) = broken::<()>(model.name(), law, point, format!("{x:?}")) {
            faults.add(point, error);
        }
        false
    };
    found.into_iter().map(|x| x.filter(sound)).collect()
}

fn check(
    fit: &Decomposition,
    local: &LocalPoints<'_>,
    plugin: &str,
    point: usize,
) -> Result<(), Error> {
    let partition = "partition: every point has exactly one label";
    if fit.labels.len() != local.len() {
        let detail = format!("{} labels for {} points", fit.labels.len(), local.len());
        return broken(plugin, partition, point, detail);
    }
    let strata = fit.strata.len();
    if let Some(k) = fit.labels.iter().position(|&l| l as usize >= strata) {
        let detail = format!("label {} of {strata} strata", fit.labels[k]);
        return broken(plugin, partition, point, detail);
    }
    let order = "strata of lowest dimension first, none above 2";
    let dimensions: Vec<u8> = fit.strata.iter().map(|s| s.dimension).collect();
    if !dimensions.is_sorted() || dimensions.iter().any(|&d| d > 2) {
        return broken(plugin, order, point, format!("dimensions {dimensions:?}"));
    }
    let curves = dimensions.iter().filter(|&&d| d == 1).count();
    let cells = "cells_at_curve: the number of cells at every curve";
    if fit.cells_at_curve.len() != curves {
        let detail = format!("{:?} for {curves} curves", fit.cells_at_curve);
        return broken(plugin, cells, point, detail);
    }
    let cell = |l: u8| dimensions.get(l as usize) == Some(&2);
    let pairs = &fit.continuations;
    if let Some(&(a, b)) = pairs
        .iter()
        .find(|c| !cell(c.0) || !cell(c.1) || c.0 == c.1)
    {
        let law = "continuations pair different cells";
        return broken(
            plugin,
            law,
            point,
            format!("strata {a} and {b} of {dimensions:?}"),
        );
    }
    let apexes = dimensions.iter().filter(|&&d| d == 0).count();
    let placed = |p: &Vec<f64>| p.len() == local.dimension && p.iter().all(|x| x.is_finite());
    if fit.points.len() != apexes || !fit.points.iter().all(placed) {
        let law = "points: a place for every stratum of dimension 0";
        let detail = format!(
            "{:?} for {apexes} strata, in {} coordinates",
            fit.points, local.dimension
        );
        return broken(plugin, law, point, detail);
    }
    if !(fit.residual.is_finite() && fit.residual >= 0.0) {
        let law = "the residual is finite and at least 0";
        return broken(plugin, law, point, format!("{}", fit.residual));
    }
    // In a cell the singular stratum may be out of sight.
    let on_it = dimensions[fit.labels[local.center] as usize] < 2;
    if !(fit.center_offset >= 0.0 && (fit.center_offset.is_finite() || !on_it)) {
        let law =
            "the center offset is at least 0, and finite where the center is on a curve or point";
        return broken(plugin, law, point, format!("{}", fit.center_offset));
    }
    if fit.center.len() != local.dimension || fit.center.iter().any(|c| !c.is_finite()) {
        let law = "the center has finite coordinates, local_dimension of them";
        return broken(plugin, law, point, format!("{:?}", fit.center));
    }
    Ok(())
}
