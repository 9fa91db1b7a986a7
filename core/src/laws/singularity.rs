//! Laws of [`SingularityModel`].

use super::instances::{Draw, Instance};
use super::motion::{Motion, motions};
use super::settings::{Outcome, ensure};
use super::{Law, LawBroken, Settings};
use crate::{Decomposition, Rejection, SingularityModel};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ops::RangeInclusive;

const SUBJECT: &str = "SingularityModel";

/// Partition.
static PARTITION: Law = Law {
    subject: SUBJECT,
    name: "partition",
    says: "every point has exactly one label, which names a stratum; strata come in order of their \
           dimension; continuations name two different cells; every curve has its number of cells; all \
           numbers are numbers; poor data are rejected or decomposed, without a panic",
    look_for: "labels of the fitted rows alone (those behind are labelled too); a curve that comes after \
               the cells; a division by the number of points; indices taken of rows that are not there",
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

pub(super) static ALL: [&Law; 7] = [&PARTITION, &MOTION, &ORDER, &FITTED, &EXACT, &NOISE, &TRUTH];

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

/// Whether a decomposition is one, of so many points in so many coordinates.
fn well_formed(d: &Decomposition, points: usize, dimension: usize) -> Outcome {
    ensure!(
        d.labels.len() == points,
        "{} labels for {points} points",
        d.labels.len()
    );
    let strata = d.strata.len();
    let wild = d.labels.iter().position(|&l| l as usize >= strata);
    ensure!(
        wild.is_none(),
        "the label {:?} of point {wild:?} names none of {strata} strata",
        wild.map(|k| d.labels[k])
    );
    let dimensions: Vec<u8> = d.strata.iter().map(|s| s.dimension).collect();
    ensure!(
        dimensions.is_sorted() && dimensions.iter().all(|&d| d <= 2),
        "the strata have the dimensions {dimensions:?}"
    );
    let is_cell = |c: u8| dimensions.get(c as usize) == Some(&2);
    let pair = d
        .continuations
        .iter()
        .find(|c| !is_cell(c.0) || !is_cell(c.1) || c.0 == c.1);
    ensure!(
        pair.is_none(),
        "the continuation {pair:?} is no pair of cells"
    );
    let curves = dimensions.iter().filter(|&&d| d == 1).count();
    ensure!(
        d.cells_at_curve.len() == curves,
        "{} numbers of cells for {curves} curves",
        d.cells_at_curve.len()
    );
    let points = dimensions.iter().filter(|&&d| d == 0).count();
    ensure!(
        d.points.len() == points
            && d.points
                .iter()
                .all(|p| p.len() == dimension && p.iter().all(|x| x.is_finite())),
        "the places {:?} for {points} strata of dimension 0, in {dimension} coordinates",
        d.points
    );
    ensure!(
        d.residual >= 0.0 && d.residual.is_finite(),
        "the residual is {}",
        d.residual
    );
    ensure!(
        d.center.len() == dimension && d.center.iter().all(|x| x.is_finite()),
        "the center is {:?}, in {dimension} coordinates",
        d.center
    );
    ensure!(
        d.center_offset >= 0.0,
        "the center offset is {}",
        d.center_offset
    );
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
    let mut names: Vec<Option<u8>> = vec![None; a.strata.len()];
    let mut back: Vec<Option<u8>> = vec![None; b.strata.len()];
    for (k, place) in pairs {
        let (old, new) = (a.labels[k], b.labels[place]);
        let to = *names[old as usize].get_or_insert(new);
        let from = *back[new as usize].get_or_insert(old);
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
    // Continuations and curves of strata without points have no names to go by.
    let sorted = |(x, y): (u8, u8)| (x.min(y), x.max(y));
    let mut before: Vec<(u8, u8)> = a
        .continuations
        .iter()
        .filter_map(|&(x, y)| Some(sorted((names[x as usize]?, names[y as usize]?))))
        .collect();
    let known = |c: &&(u8, u8)| back[c.0 as usize].is_some() && back[c.1 as usize].is_some();
    let mut after: Vec<(u8, u8)> = b
        .continuations
        .iter()
        .filter(known)
        .copied()
        .map(sorted)
        .collect();
    before.sort_unstable();
    after.sort_unstable();
    ensure!(
        before == after,
        "continuations {before:?} (in the later names) became {after:?}"
    );
    let first_curve = |d: &Decomposition| d.strata.iter().filter(|s| s.dimension == 0).count();
    let (skip_a, skip_b) = (first_curve(a), first_curve(b));
    for (k, &cells) in a.cells_at_curve.iter().enumerate() {
        if let Some(new) = names[skip_a + k] {
            let now = b.cells_at_curve[new as usize - skip_b];
            ensure!(cells == now, "{cells} cells at a curve became {now}");
        }
    }
    Ok(())
}

/// Puts a model through its laws: on exact and noisy instances given by its author, and on poor data
/// (few points, copies, lattices) where it must not stumble.
///
/// `model` must accept the instances: choose its thresholds for the radius that they have.
///
/// # Errors
/// The first law that does not hold.
///
/// ```
/// use crosscap_core::laws::{self, Instances, Settings, instances};
/// use crosscap_core::{Decomposition, LocalPoints, Rejection, SingularityModel, Stratum};
/// /// Everything is one flat cell.
/// struct Flat;
/// impl SingularityModel for Flat {
///     fn local_dimension(&self) -> usize { 3 }
///     fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
///         let heights = (0..local.fitted).map(|k| local.point(k)[2].powi(2)).sum::<f64>();
///         Ok(Decomposition {
///             strata: vec![Stratum { dimension: 2 }],
///             labels: vec![0; local.len()],
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
) -> Result<(), LawBroken> {
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
            well_formed(d, instance.len(), dimension)?;
        }
        Ok::<Answer, String>(answer)
    };
    let noisy = cases(4.0 * instances.noise);

    let poor = (
        vec(prop::array::uniform12(-2..=2_i8), 1..=30),
        any::<bool>(),
        1..=30_usize,
    );
    PARTITION.holds(settings, &poor, |(rows, far, fitted)| {
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
    })?;
    PARTITION.holds(settings, &noisy, |case| {
        ask(&draw(case)?.principal()).map(|_| ())
    })?;
    MOTION.holds(settings, &noisy, |case| {
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
    })?;
    let keys = vec(any::<u16>(), 512);
    ORDER.holds(
        settings,
        &(cases(4.0 * instances.noise), keys),
        |(case, keys)| {
            let first = draw(case)?.principal();
            let (other, order) = first.reordered(keys);
            let pairs = order.iter().enumerate().map(|(new, &old)| (old, new));
            same(&ask(&first)?, &ask(&other)?, pairs, &[], first.radius)
        },
    )?;
    FITTED.holds(settings, &noisy, |case| {
        let all = draw(case)?.principal();
        let mut alone = all.clone();
        alone.coordinates.truncate(all.fitted * dimension);
        alone.truth.truncate(all.fitted);
        let pairs = (0..all.fitted).map(|k| (k, k));
        same(&ask(&all)?, &ask(&alone)?, pairs, &[], all.radius)
    })?;
    let exact = cases(0.0);
    let accepted = |instance: &Instance| ask(instance)?.map_err(|r| format!("rejected with {r:?}"));
    EXACT.holds(settings, &exact, |case| {
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
    })?;
    NOISE.holds(settings, &exact, |case| {
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
    })?;
    TRUTH.holds(settings, &exact, |case| {
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
            let known = *truth_of[label as usize].get_or_insert(truth);
            ensure!(
                known == truth,
                "point {k} at {place:?} has the label {label} as points of the true stratum {known}; it \
                 is of {truth}"
            );
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::super::instances::flat_sheet;
    use super::super::twins::each_is_caught;
    use super::*;
    use crate::{LocalPoints, Stratum};

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        WildLabel,
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
            let norm = |k: usize| local.point(k).iter().map(|x| x * x).sum::<f64>().sqrt();
            match self.0 {
                Fault::WildLabel => labels[0] = 2,
                Fault::FittedLabels => labels.truncate(fitted),
                Fault::CurvesLast => {
                    strata.reverse();
                    labels.fill(0);
                }
                Fault::SignOfAxis => {
                    for (k, label) in labels.iter_mut().enumerate() {
                        *label = u8::from(local.point(k)[0] < 0.3 * radius);
                    }
                }
                Fault::FirstRowIsCenter => center = local.point(0).to_vec(),
                Fault::Offset => residual += 1e-4 * radius,
                Fault::NoResidual => residual = 0.0,
                Fault::TwoCells => {
                    strata.push(Stratum { dimension: 2 });
                    for (k, label) in labels.iter_mut().enumerate() {
                        *label = 1 + u8::from(norm(k) > 0.6 * radius);
                    }
                }
                Fault::Refusing if heights < 1e-12 => return Err(Rejection::NoRealSolution),
                _ => {}
            }
            Ok(Decomposition {
                strata,
                labels,
                continuations: vec![],
                cells_at_curve: vec![1],
                residual,
                parameters: 3,
                points: Vec::new(),
                center,
                center_offset: f64::INFINITY,
            })
        }
        fn name(&self) -> &str {
            "twin"
        }
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let put = |fault| {
            model(
                &Settings::default(),
                &Twin(fault),
                &Instances::new(&flat_sheet),
            )
        };
        let faults: &[(Fault, &Law)] = &[
            (Fault::WildLabel, &PARTITION),
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
