//! Laws of [`SingularityModel`].

use super::instances::{Draw, Instance};
use super::motion::{Motion, motions};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
use crate::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Table};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ops::RangeInclusive;

const SUBJECT: &str = "SingularityModel";

/// Partition.
static PARTITION: Law = Law {
    subject: SUBJECT,
    name: "partition",
    says: "what is said can be true (`Decomposition::check`): every point has exactly one label, which names a \
           stratum; strata come in order of their dimension; every curve has its number of cells, of those there \
           are; points lie in the neighborhood; the center is where its label and its offset say; poor data are \
           rejected or decomposed, without a panic",
    look_for: "labels of the fitted rows alone (those behind are labelled too); a curve that comes after \
               the cells; a place in other coordinates than those of the points, or of a fit that ran away; an \
               offset from the mean instead of the center; a division by the number of points",
};

/// Motion.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "the same decomposition, up to the names of the strata, after a motion of the data: the \
           principal coordinates are then the same but for the signs of the axes",
    look_for: "a label, threshold or start value that depends on the sign of a coordinate; an \
               iteration that stops in different places; a center given in other coordinates than \
               those of the points",
};

/// Order.
static ORDER: Law = Law {
    subject: SUBJECT,
    name: "order",
    says: "the same decomposition, up to the names of the strata, for any order of the points",
    look_for: "row 0 taken for the center (`local.center` says which row it is); starts from the first \
               rows; random samples by row",
};

/// Fitted rows.
static FITTED: Law = Law {
    subject: SUBJECT,
    name: "fitted rows",
    says: "the rows behind `fitted` are labelled and change nothing else: without them, the same labels \
           and residual for the others",
    look_for: "a loop over `len()` where it should end at `fitted`: in the fit, the residual, or the \
               counts of a stratum",
};

/// Rows about the center.
static ABOUT: Law = Law {
    subject: SUBJECT,
    name: "about",
    says: "decompose_about gives the decomposition of decompose, and of every row, or None, what decompose says with \
           that row as the center, within rounding",
    look_for: "a place of the center given to all rows; answers in another order than the rows, or fewer; the \
               offset of a row measured from the center; a fit that depends on the center (leave the default)",
};

/// Cells at curves.
static CELLS: Law = Law {
    subject: SUBJECT,
    name: "cells",
    says: "on an exact instance, all cells that come near to a curve, away from its ends, are counted in \
           cells_at_curve",
    look_for: "the number of another curve (the order is that of `strata`); the number of sheets where that of the \
               cells is meant: two sheets that cross are four cells; a curve taken for one that no surface touches",
};

/// Exact data.
static EXACT: Law = Law {
    subject: SUBJECT,
    name: "exact data",
    says: "an exact instance is accepted, with residual 0 within rounding",
    look_for: "a residual that counts points on the curve to one piece alone; a fit caught in a local \
               minimum (start it elsewhere); a regularization that is not small; or an instance that is \
               not exact",
};

/// Noise.
static NOISE: Law = Law {
    subject: SUBJECT,
    name: "noise",
    says: "the residual grows with noise: twice the noise gives at least 1.3 times the residual, or the \
           model rejects",
    look_for: "a residual of the algebraic equation instead of distances; a residual of the points that \
               fit, leaving out those that do not; a constant",
};

/// Truth.
static TRUTH: Law = Law {
    subject: SUBJECT,
    name: "truth",
    says: "on an exact instance, points of one true stratum get one label, those of different strata \
           different ones, wherever the instance says that there is no doubt",
    look_for: "a cell that is two (which side of the other piece is it on?); a curve taken too wide; \
               strata of the instance that the model does not tell apart (leave them out of `truth`)",
};

pub(super) static ALL: [&Law; 9] = [
    &PARTITION, &MOTION, &ORDER, &FITTED, &ABOUT, &EXACT, &NOISE, &CELLS, &TRUTH,
];

/// Exact instances of what a model describes, given by its author.
pub struct Instances<'a> {
    /// Draws one; all its randomness from [`Draw`], about [`Draw::points`] points.
    pub draw: &'a dyn Fn(&mut Draw) -> Instance,
    /// How many points instances have.
    pub points: RangeInclusive<usize>,
    /// Largest residual on exact data, as a share of the radius.
    pub exact: f64,
    /// Least noise that must show in the residual, as a share of the radius; twice and four times as
    /// much is tried as well.
    pub noise: f64,
}

impl<'a> Instances<'a> {
    /// Instances of 100 to 300 points, exact to a millionth, with noise of half a percent and more.
    pub fn new(draw: &'a dyn Fn(&mut Draw) -> Instance) -> Self {
        Self {
            draw,
            points: 100..=300,
            exact: 1e-6,
            noise: 0.005,
        }
    }
}

/// Which instance, and what is done with it.
#[derive(Clone, Debug)]
struct Case {
    seed: u64,
    points: usize,
    /// A share of the radius.
    noise: f64,
    motion: Motion,
    /// Whether each axis is turned round.
    signs: Vec<bool>,
}

type Answer = Result<Decomposition, Rejection>;

/// Whether what a model says can be true.
fn well_formed(d: &Decomposition, instance: &Instance, model: &dyn SingularityModel) -> Outcome {
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
fn cells_are_counted(d: &Decomposition, instance: &Instance) -> Outcome {
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
fn same(
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
fn about(model: &dyn SingularityModel, instance: &Instance, rows: &[usize]) -> Outcome {
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

/// Puts a model through its laws: on exact and noisy instances given by its author, and on poor data
/// (few points, copies, lattices) where it must not stumble.
///
/// `model` must accept the instances: choose its thresholds for the radius that they have.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Instances, Settings, instances};
/// use crosscap_core::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Stratum};
/// /// Everything is one flat cell.
/// struct Flat;
/// impl SingularityModel for Flat {
///     fn local_dimension(&self) -> usize { 3 }
///     fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
///         let heights = (0..local.fitted).map(|k| local.point(k)[2].powi(2)).sum::<f64>();
///         Ok(Decomposition {
///             strata: vec![Stratum { dimension: 2 }],
///             labels: vec![Label::new(0); local.len()],
///             residual: (heights / local.fitted as f64).sqrt(),
///             parameters: 3,
///             center: local.point(local.center).to_vec(),
///             center_offset: f64::INFINITY,
///             ..Decomposition::default()
///         })
///     }
///     fn name(&self) -> &str { "flat" }
/// }
/// laws::model(&Settings::default(), &Flat, &Instances::new(&instances::flat_sheet)).unwrap();
/// ```
pub fn model(
    settings: &Settings,
    model: &impl SingularityModel,
    instances: &Instances<'_>,
) -> Result<(), Failures> {
    laws(settings, model, instances)
}

/// The laws themselves, compiled once and not for every model that is tested.
fn laws(
    settings: &Settings,
    model: &dyn SingularityModel,
    instances: &Instances<'_>,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    let dimension = model.local_dimension();
    let settings = &settings.at_most(256);
    let cases = |noise: f64| {
        let noise = prop_oneof![Just(0.0), 0.0..noise.max(f64::MIN_POSITIVE)];
        let signs = vec(any::<bool>(), dimension);
        (
            any::<u64>(),
            instances.points.clone(),
            noise,
            motions(),
            signs,
        )
            .prop_map(|(seed, points, noise, motion, signs)| Case {
                seed,
                points,
                noise,
                motion,
                signs,
            })
    };
    let draw = |case: &Case| {
        let instance = (instances.draw)(&mut Draw::new(case.seed, case.points));
        ensure!(
            instance.dimension == dimension,
            "instances have {} coordinates, the model wants {dimension}",
            instance.dimension
        );
        Ok(instance.with_noise(case.seed, case.noise))
    };
    let ask = |instance: &Instance| {
        let answer = model.decompose(&instance.local());
        if let Ok(d) = &answer {
            well_formed(d, instance, model)?;
        }
        Ok::<Answer, String>(answer)
    };
    let noisy = cases(4.0 * instances.noise);

    let poor = (
        vec(prop::array::uniform12(-2..=2_i8), 1..=30),
        any::<bool>(),
        1..=30_usize,
    );
    found.put(PARTITION.holds(settings, &poor, |(rows, far, fitted)| {
        let rows: Vec<_> = rows
            .iter()
            .map(|row| {
                (0..dimension)
                    .map(|k| f64::from(row[k % 12]) / 3.0)
                    .collect::<Vec<f64>>()
            })
            .collect();
        let mut instance = Instance {
            dimension,
            coordinates: rows.concat(),
            fitted: (*fitted).min(rows.len()),
            center: 0,
            radius: 1.5,
            truth: vec![],
        };
        if !far {
            instance.fitted = rows.len();
        }
        ask(&instance.principal()).map(|_| ())
    }));
    found.put(PARTITION.holds(settings, &noisy, |case| {
        ask(&draw(case)?.principal()).map(|_| ())
    }));
    found.put(MOTION.holds(settings, &noisy, |case| {
        let raw = draw(case)?;
        let first = raw.principal();
        // Signs by themselves, to the bit.
        let mut mirrored = first.clone();
        for row in mirrored.coordinates.chunks_exact_mut(dimension) {
            for (x, &turned) in row.iter_mut().zip(&case.signs) {
                *x = if turned { -*x } else { *x };
            }
        }
        let before = ask(&first)?;
        let all = || (0..first.len()).map(|k| (k, k));
        same(&before, &ask(&mirrored)?, all(), &case.signs, raw.radius)?;
        let mut moved = raw.clone();
        case.motion.apply(dimension, &mut moved.coordinates);
        let moved = moved.principal();
        let signs: Vec<bool> = (0..dimension)
            .map(|axis| {
                let product: f64 = (0..raw.len())
                    .map(|k| first.local().point(k)[axis] * moved.local().point(k)[axis])
                    .sum();
                product < 0.0
            })
            .collect();
        // Principal directions of nearly equal variance are not determined: nothing to compare.
        let unturned = (0..raw.len()).all(|k| {
            let (p, q) = (first.local(), moved.local());
            (0..dimension).all(|a| {
                let x = if signs[a] {
                    -p.point(k)[a]
                } else {
                    p.point(k)[a]
                };
                (x - q.point(k)[a]).abs() < 1e-9 * raw.radius
            })
        });
        if unturned {
            same(&before, &ask(&moved)?, all(), &signs, raw.radius)?;
        }
        Ok(())
    }));
    let keys = vec(any::<u16>(), 512);
    found.put(ORDER.holds(
        settings,
        &(cases(4.0 * instances.noise), keys),
        |(case, keys)| {
            let first = draw(case)?.principal();
            let (other, order) = first.reordered(keys);
            let pairs = order.iter().enumerate().map(|(new, &old)| (old, new));
            same(&ask(&first)?, &ask(&other)?, pairs, &[], first.radius)
        },
    ));
    found.put(FITTED.holds(settings, &noisy, |case| {
        let all = draw(case)?.principal();
        let mut alone = all.clone();
        alone.coordinates.truncate(all.fitted * dimension);
        alone.truth.truncate(all.fitted);
        let pairs = (0..all.fitted).map(|k| (k, k));
        same(&ask(&all)?, &ask(&alone)?, pairs, &[], all.radius)
    }));
    let some = vec(any::<prop::sample::Index>(), 1..=6);
    found.put(ABOUT.holds(
        settings,
        &(cases(4.0 * instances.noise), some),
        |(case, rows)| {
            let instance = draw(case)?.principal();
            let rows: Vec<usize> = rows.iter().map(|k| k.index(instance.len())).collect();
            about(model, &instance, &rows)
        },
    ));
    let exact = cases(0.0);
    let accepted = |instance: &Instance| ask(instance)?.map_err(|r| format!("rejected with {r:?}"));
    found.put(EXACT.holds(settings, &exact, |case| {
        let instance = draw(&Case {
            noise: 0.0,
            ..case.clone()
        })?
        .principal();
        let residual = accepted(&instance)?.residual;
        let limit = instances.exact * instance.radius;
        ensure!(
            residual <= limit,
            "the residual is {residual}, above {limit}"
        );
        Ok(())
    }));
    found.put(NOISE.holds(settings, &exact, |case| {
        let mut before = 0.0;
        for noise in [1.0, 2.0, 4.0].map(|k| k * instances.noise) {
            let instance = draw(&Case {
                noise,
                ..case.clone()
            })?
            .principal();
            let Ok(d) = ask(&instance)? else {
                return Ok(());
            };
            let least = if before == 0.0 {
                0.1 * noise * instance.radius
            } else {
                1.3 * before
            };
            ensure!(
                d.residual >= least,
                "with noise of {noise} radii the residual is {}, expected {least} or more",
                d.residual
            );
            before = d.residual;
        }
        Ok(())
    }));
    found.put(CELLS.holds(settings, &exact, |case| {
        let instance = draw(&Case {
            noise: 0.0,
            ..case.clone()
        })?
        .principal();
        cells_are_counted(&accepted(&instance)?, &instance)
    }));
    found.put(TRUTH.holds(settings, &exact, |case| {
        let instance = draw(&Case { noise: 0.0, ..case.clone() })?.principal();
        let d = accepted(&instance)?;
        let mut label_of = [None; 256];
        let mut truth_of = [None; 256];
        for (k, truth) in instance.truth.iter().enumerate() {
            let (Some(truth), label) = (*truth, d.labels[k]) else {
                continue;
            };
            let place = instance.local().point(k).to_vec();
            let known = *label_of[truth as usize].get_or_insert(label);
            ensure!(
                known == label,
                "point {k} at {place:?} is of the true stratum {truth}, others of which have the label \
                 {known}; it has {label}"
            );
            let known = *truth_of[label.index()].get_or_insert(truth);
            ensure!(
                known == truth,
                "point {k} at {place:?} has the label {label} as points of the true stratum {known}; it \
                 is of {truth}"
            );
        }
        Ok(())
    }));
    found.end()
}

#[cfg(test)]
mod tests {
    use super::super::instances::flat_sheet;
    use super::super::twins::{each_is_caught, quick};
    use super::*;
    use crate::{Located, Stratum};

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        WildLabel,
        FarPlace,
        NoCells,
        NineCells,
        LostRow,
        CenterForAll,
        UncountedCell,
        FittedLabels,
        CurvesLast,
        Unchecked,
        SignOfAxis,
        FirstRowIsCenter,
        AllRowsFitted,
        Offset,
        Refusing,
        NoResidual,
        TwoCells,
    }

    /// One flat cell, and a curve without points.
    struct Twin(Fault);

    impl SingularityModel for Twin {
        fn local_dimension(&self) -> usize {
            3
        }
        fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
            let (fitted, radius) = (local.fitted, local.radius);
            if fitted < 4 && self.0 != Fault::Unchecked {
                return Err(Rejection::TooFewPoints {
                    found: fitted,
                    needed: 4,
                });
            }
            let counted = if self.0 == Fault::AllRowsFitted {
                local.len()
            } else {
                fitted
            };
            let heights: f64 = (0..counted).map(|k| local.point(k)[2].powi(2)).sum();
            let free = if self.0 == Fault::Unchecked {
                counted as f64 - 3.0
            } else {
                counted as f64
            };
            let mut residual = (heights / free).sqrt();
            let mut labels = vec![1; local.len()];
            let mut strata = vec![Stratum { dimension: 1 }, Stratum { dimension: 2 }];
            let mut center = local.point(local.center).to_vec();
            let (mut cells, mut offset) = (1, f64::INFINITY);
            let norm = |k: usize| local.point(k).iter().map(|x| x * x).sum::<f64>().sqrt();
            match self.0 {
                Fault::WildLabel => labels[0] = 2,
                Fault::FarPlace => center[0] += 5.0 * radius,
                Fault::NineCells => cells = 9,
                Fault::NoCells => {
                    // Two cells, and a curve that none of them meets.
                    strata.push(Stratum { dimension: 2 });
                    cells = 0;
                }
                Fault::UncountedCell => {
                    cells = 0;
                    for (k, label) in labels.iter_mut().enumerate() {
                        *label = usize::from(norm(k) > 0.2 * radius);
                    }
                }
                Fault::FittedLabels => labels.truncate(fitted),
                Fault::CurvesLast => {
                    strata.reverse();
                    labels.fill(0);
                }
                Fault::SignOfAxis => {
                    for (k, label) in labels.iter_mut().enumerate() {
                        *label = usize::from(local.point(k)[0] < 0.3 * radius);
                    }
                }
                Fault::FirstRowIsCenter => center = local.point(0).to_vec(),
                Fault::Offset => residual += 1e-4 * radius,
                Fault::NoResidual => residual = 0.0,
                Fault::TwoCells => {
                    strata.push(Stratum { dimension: 2 });
                    cells = 2;
                    for (k, label) in labels.iter_mut().enumerate() {
                        *label = 1 + usize::from(norm(k) > 0.6 * radius);
                    }
                }
                Fault::Refusing if heights < 1e-12 => return Err(Rejection::NoRealSolution),
                _ => {}
            }
            let labels: Vec<Label> = labels.into_iter().map(Label::new).collect();
            let own = labels.get(local.center).map(|l| l.index());
            if own.and_then(|l| strata.get(l)) == Some(&Stratum { dimension: 1 }) {
                offset = 0.0;
            }
            Ok(Decomposition {
                strata,
                labels,
                cells_at_curve: vec![cells],
                residual,
                parameters: 3,
                points: Vec::new(),
                center,
                center_offset: offset,
            })
        }
        fn decompose_about(
            &self,
            local: &LocalPoints<'_>,
            rows: &[usize],
        ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
            let fit = self.decompose(local)?;
            let located = rows.iter().map(|&row| {
                let as_center = LocalPoints {
                    center: row,
                    ..*local
                };
                let fit = self.decompose(&as_center).ok()?;
                (row < fit.labels.len()).then(|| fit.located(row))
            });
            let mut located: Vec<Option<Located>> = located.collect();
            match self.0 {
                Fault::LostRow => drop(located.pop()),
                Fault::CenterForAll => {
                    let center = fit.located(local.center);
                    located.fill(Some(center));
                }
                _ => {}
            }
            Ok((fit, located))
        }
        fn name(&self) -> &str {
            "twin"
        }
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let put = |fault| model(&quick(), &Twin(fault), &Instances::new(&flat_sheet));
        let faults: &[(Fault, &Law)] = &[
            (Fault::WildLabel, &PARTITION),
            (Fault::FarPlace, &PARTITION),
            (Fault::NoCells, &PARTITION),
            (Fault::NineCells, &PARTITION),
            (Fault::LostRow, &ABOUT),
            (Fault::CenterForAll, &ABOUT),
            (Fault::UncountedCell, &CELLS),
            (Fault::FittedLabels, &PARTITION),
            (Fault::CurvesLast, &PARTITION),
            (Fault::Unchecked, &PARTITION),
            (Fault::SignOfAxis, &MOTION),
            (Fault::FirstRowIsCenter, &ORDER),
            (Fault::AllRowsFitted, &FITTED),
            (Fault::Offset, &EXACT),
            (Fault::Refusing, &EXACT),
            (Fault::NoResidual, &NOISE),
            (Fault::TwoCells, &TRUTH),
        ];
        each_is_caught(put, Fault::None, faults);
    }
}
