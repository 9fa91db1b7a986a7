//! Whether an answer can be true, and whether two are the same.

use crate::laws::instances::Instance;
use crate::laws::trial::{Outcome, ensure};
use crate::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Table};

pub(super) type Answer = Result<Decomposition, Rejection>;

/// Whether what a model says can be true.
pub(super) fn well_formed(
    d: &Decomposition,
    instance: &Instance,
    model: &dyn SingularityModel,
) -> Outcome {
    (d.check(&instance.local())).map_err(|wrong| format!("{}: {}", wrong.law, wrong.found))?;
    ensure!(
        !model.finds_boundary() || d.cells_at_curve.iter().all(|&cells| cells == 1),
        "{:?} cells at the curves of a model that finds boundaries, which have one",
        d.cells_at_curve
    );
    Ok(())
}

/// Rows of a curve nearer than this share of the radius to a stratum of dimension 0 say nothing about its cells.
const CLEAR_OF_POINTS: f64 = 0.5;
/// A cell with a point this close to a curve, as a share of the radius, meets it.
const NEAR_CURVE: f64 = 0.2;

/// Whether the cells near a curve are no more than are said to meet in it.
pub(super) fn cells_are_counted(d: &Decomposition, instance: &Instance) -> Outcome {
    let local = instance.local();
    let far = |a: &[f64], b: &[f64], share: f64| {
        crate::squared_distance(a, b) > (share * instance.radius).powi(2)
    };
    for curve in d.labels_of(1) {
        let Some(said) = d.cells_at(curve) else {
            continue;
        };
        let mut near = [false; 256];
        for k in (0..local.fitted).filter(|&k| d.labels[k] == curve) {
            let own = local.point(k);
            if !d.points.iter().all(|p| far(p, own, CLEAR_OF_POINTS)) {
                continue;
            }
            for (other, &label) in d.labels.iter().enumerate() {
                near[label.index()] |=
                    d.dimension_of(other) == 2 && !far(local.point(other), own, NEAR_CURVE);
            }
        }
        let found: Vec<usize> = (0..256).filter(|&label| near[label]).collect();
        ensure!(
            found.len() <= usize::from(said),
            "{said} cells at the curve {curve}, points of the cells {found:?} are near it"
        );
    }
    Ok(())
}

/// Whether two answers are the same up to the names of strata. Point `k` of the first is point
/// `place(k)` of the second, for the points that are in both; `signs` says which axes were turned round.
pub(super) fn same(
    first: &Answer,
    second: &Answer,
    pairs: impl Iterator<Item = (usize, usize)>,
    signs: &[bool],
    radius: f64,
) -> Outcome {
    let (a, b) = match (first, second) {
        (Ok(a), Ok(b)) => (a, b),
        (Err(a), Err(b)) => {
            let kind = std::mem::discriminant;
            ensure!(kind(a) == kind(b), "rejected with {a:?}, then with {b:?}");
            return Ok(());
        }
        (Ok(_), Err(b)) => return Err(format!("accepted, then rejected with {b:?}")),
        (Err(a), Ok(_)) => return Err(format!("rejected with {a:?}, then accepted")),
    };
    same_numbers(a, b, signs, radius)?;
    same_strata(a, b, pairs)
}

/// Whether residuals, parameters and centers are the same.
fn same_numbers(a: &Decomposition, b: &Decomposition, signs: &[bool], radius: f64) -> Outcome {
    let close = |x: f64, y: f64| x == y || (x - y).abs() <= 1e-6 * radius;
    ensure!(
        close(a.residual, b.residual) && a.parameters == b.parameters,
        "residual {} with {} parameters became {} with {}",
        a.residual,
        a.parameters,
        b.residual,
        b.parameters
    );
    ensure!(
        close(a.center_offset, b.center_offset),
        "the center offset {} became {}",
        a.center_offset,
        b.center_offset
    );
    let turned = |k: usize, x: f64| if signs.get(k) == Some(&true) { -x } else { x };
    let center = a.center.iter().enumerate().zip(&b.center);
    ensure!(
        center
            .into_iter()
            .all(|((k, &x), &y)| close(turned(k, x), y)),
        "the center {:?} became {:?}, axes turned round: {signs:?}",
        a.center,
        b.center
    );
    Ok(())
}

/// Whether the labels are the same but for their names, and so are the cells at the curves.
fn same_strata(
    a: &Decomposition,
    b: &Decomposition,
    pairs: impl Iterator<Item = (usize, usize)>,
) -> Outcome {
    // Names in the second of the strata of the first, and back.
    let mut names: Table<Label, Option<Label>> = Table::filled(a.strata.len(), None);
    let mut back: Table<Label, Option<Label>> = Table::filled(b.strata.len(), None);
    for (k, place) in pairs {
        let (old, new) = (a.labels[k], b.labels[place]);
        let to = *names[old].get_or_insert(new);
        let from = *back[new].get_or_insert(old);
        ensure!(
            to == new && from == old,
            "point {k} (then {place}) had the label {old} and has {new}, while others of {old} have {to} \
             and others of {new} had {from}"
        );
        let dimensions = (a.dimension_of(k), b.dimension_of(place));
        ensure!(
            dimensions.0 == dimensions.1,
            "the stratum of point {k} (then {place}) had dimension {}, and has {}",
            dimensions.0,
            dimensions.1
        );
    }
    // Curves without points have no names to go by.
    for old in a.labels_of(1) {
        if let (Some(new), Some(cells)) = (names[old], a.cells_at(old)) {
            let now = b.cells_at(new);
            ensure!(
                now == Some(cells),
                "{cells} cells at a curve became {now:?}"
            );
        }
    }
    Ok(())
}

/// Whether a model says of rows what it says of them as the center.
pub(super) fn about(model: &dyn SingularityModel, instance: &Instance, rows: &[usize]) -> Outcome {
    let local = instance.local();
    let (whole, together) = (model.decompose(&local), model.decompose_about(&local, rows));
    let (fit, located) = match (whole, together) {
        (Ok(whole), Ok((fit, located))) => {
            ensure!(
                fit == whole,
                "{whole:?} alone, {fit:?} with the rows {rows:?}"
            );
            (fit, located)
        }
        (whole, together) => {
            let (alone, with_rows) = (whole.err(), together.err());
            ensure!(
                alone == with_rows,
                "rejected with {alone:?} alone, with {with_rows:?} with the rows {rows:?}"
            );
            return Ok(());
        }
    };
    well_formed(&fit, instance, model)?;
    ensure!(
        located.len() == rows.len(),
        "{} answers for the rows {rows:?}",
        located.len()
    );
    for (&row, found) in rows.iter().zip(&located) {
        let Some(found) = found else { continue };
        let own = LocalPoints {
            center: row,
            ..local
        };
        (found.check(own.point(row), local.radius))
            .map_err(|wrong| format!("of row {row}: {}: {}", wrong.law, wrong.found))?;
        // As the center it may be rejected: it need not be where the model is to be asked.
        let Ok(alone) = model.decompose(&own).map(|fit| fit.located(row)) else {
            continue;
        };
        let close = |x: f64, y: f64| x == y || (x - y).abs() <= 1e-6 * local.radius;
        let places = found.place.iter().zip(&alone.place);
        ensure!(
            (found.dimension, found.cells) == (alone.dimension, alone.cells)
                && close(found.offset, alone.offset)
                && places.into_iter().all(|(&x, &y)| close(x, y)),
            "row {row} is {found:?}, as the center {alone:?}"
        );
    }
    Ok(())
}

/// Whether points of one true stratum have one label, and those of different ones different labels.
pub(super) fn is_true(d: &Decomposition, instance: &Instance) -> Outcome {
    let mut label_of = [None; 256];
    let mut truth_of: Table<Label, Option<u8>> = Table::filled(256, None);
    for (k, truth) in instance.truth.iter().enumerate() {
        let (Some(truth), label) = (*truth, d.labels[k]) else {
            continue;
        };
        let place = instance.local().point(k).to_vec();
        let known = *label_of[usize::from(truth)].get_or_insert(label);
        ensure!(
            known == label,
            "point {k} at {place:?} is of the true stratum {truth}, others of which have the label \
             {known}; it has {label}"
        );
        let known = *truth_of[label].get_or_insert(truth);
        ensure!(
            known == truth,
            "point {k} at {place:?} has the label {label} as points of the true stratum {known}; it \
             is of {truth}"
        );
    }
    Ok(())
}
