//! Laws of [`SingularityModel`].

mod answers;

use super::instances::{Draw, Instance};
use super::motion::{Motion, motions};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
use crate::{Decomposition, SingularityModel};
use answers::{Answer, about, cells_are_counted, is_true, same, well_formed};
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
    look_for: "row 0 taken for the center (`local.center` says which row it is, `local.middle` which the ball is about); starts from the first \
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
               offset of a row measured from the center; a fit that depends on the \
               center (leave the default), or that measures the ball from `local.center` where `local.middle` is meant",
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
    let test = Test { model, instances };
    let settings = &settings.at_most(256);
    let noisy = test.cases(4.0 * instances.noise);
    let exact = test.cases(0.0);
    let poor = (
        vec(prop::array::uniform12(-2..=2_i8), 1..=30),
        any::<bool>(),
        1..=30_usize,
    );
    found.put(PARTITION.holds(settings, &poor, |(rows, far, fitted)| {
        let fitted = if *far {
            (*fitted).min(rows.len())
        } else {
            rows.len()
        };
        test.ask(&test.poor(rows, fitted).principal()).map(|_| ())
    }));
    found.put(PARTITION.holds(settings, &noisy, |case| {
        test.ask(&test.draw(case)?.principal()).map(|_| ())
    }));
    found.put(MOTION.holds(settings, &noisy, |case| test.moved(case)));
    let keys = vec(any::<u16>(), 512);
    let ordered = (test.cases(4.0 * instances.noise), keys);
    found.put(ORDER.holds(settings, &ordered, |(case, keys)| {
        let first = test.draw(case)?.principal();
        let (other, order) = first.reordered(keys);
        let pairs = order.iter().enumerate().map(|(new, &old)| (old, new));
        let (a, b) = (test.ask(&first)?, test.ask(&other)?);
        same(&a, &b, pairs, &[], first.radius)
    }));
    found.put(FITTED.holds(settings, &noisy, |case| {
        let all = test.draw(case)?.principal();
        let mut alone = all.clone();
        alone.coordinates.truncate(all.fitted * all.dimension);
        alone.truth.truncate(all.fitted);
        let pairs = (0..all.fitted).map(|k| (k, k));
        same(&test.ask(&all)?, &test.ask(&alone)?, pairs, &[], all.radius)
    }));
    let some = vec(any::<prop::sample::Index>(), 1..=6);
    let rows = (test.cases(4.0 * instances.noise), some);
    found.put(ABOUT.holds(settings, &rows, |(case, rows)| {
        let instance = test.draw(case)?.principal();
        let rows: Vec<usize> = rows.iter().map(|k| k.index(instance.len())).collect();
        about(model, &instance, &rows)
    }));
    found.put(EXACT.holds(settings, &exact, |case| {
        let (residual, limit) = {
            let (instance, fit) = test.accepted(case)?;
            (fit.residual, instances.exact * instance.radius)
        };
        ensure!(
            residual <= limit,
            "the residual is {residual}, above {limit}"
        );
        Ok(())
    }));
    found.put(NOISE.holds(settings, &exact, |case| test.grows(case)));
    found.put(CELLS.holds(settings, &exact, |case| {
        let (instance, fit) = test.accepted(case)?;
        cells_are_counted(&fit, &instance)
    }));
    found.put(TRUTH.holds(settings, &exact, |case| {
        let (instance, fit) = test.accepted(case)?;
        is_true(&fit, &instance)
    }));
    found.end()
}

/// A model, and the instances that it is asked about.
struct Test<'t> {
    model: &'t dyn SingularityModel,
    instances: &'t Instances<'t>,
}

impl Test<'_> {
    /// Instances with up to so much noise.
    fn cases(&self, noise: f64) -> impl Strategy<Value = Case> + use<> {
        let noise = prop_oneof![Just(0.0), 0.0..noise.max(f64::MIN_POSITIVE)];
        let signs = vec(any::<bool>(), self.model.local_dimension());
        let points = self.instances.points.clone();
        (any::<u64>(), points, noise, motions(), signs).prop_map(
            |(seed, points, noise, motion, signs)| Case {
                seed,
                points,
                noise,
                motion,
                signs,
            },
        )
    }

    /// The instance of a case, in the coordinates in which its author drew it.
    fn draw(&self, case: &Case) -> Result<Instance, String> {
        let instance = (self.instances.draw)(&mut Draw::new(case.seed, case.points));
        let dimension = self.model.local_dimension();
        ensure!(
            instance.dimension == dimension,
            "instances have {} coordinates, the model wants {dimension}",
            instance.dimension
        );
        Ok(instance.with_noise(case.seed, case.noise))
    }

    /// A few points on a lattice, which no model need explain.
    fn poor(&self, rows: &[[i8; 12]], fitted: usize) -> Instance {
        let dimension = self.model.local_dimension();
        let all = rows.iter();
        let coordinates = all.flat_map(|row| (0..dimension).map(|k| f64::from(row[k % 12]) / 3.0));
        Instance {
            dimension,
            coordinates: coordinates.collect(),
            fitted,
            center: 0,
            radius: 1.5,
            truth: vec![],
        }
    }

    /// What the model says, if it can be true.
    fn ask(&self, instance: &Instance) -> Result<Answer, String> {
        let answer = self.model.decompose(&instance.local());
        if let Ok(d) = &answer {
            well_formed(d, instance, self.model)?;
        }
        Ok(answer)
    }

    /// What the model says of a case without noise, which it must accept.
    fn accepted(&self, case: &Case) -> Result<(Instance, Decomposition), String> {
        let exact = Case {
            noise: 0.0,
            ..case.clone()
        };
        let instance = self.draw(&exact)?.principal();
        let fit = self
            .ask(&instance)?
            .map_err(|r| format!("rejected with {r:?}"))?;
        Ok((instance, fit))
    }

    /// Whether the answer moves with the data.
    fn moved(&self, case: &Case) -> Outcome {
        let dimension = self.model.local_dimension();
        let raw = self.draw(case)?;
        let first = raw.principal();
        // Signs by themselves, to the bit.
        let mut mirrored = first.clone();
        for row in mirrored.coordinates.chunks_exact_mut(dimension) {
            for (x, &turned) in row.iter_mut().zip(&case.signs) {
                *x = if turned { -*x } else { *x };
            }
        }
        let before = self.ask(&first)?;
        let all = || (0..first.len()).map(|k| (k, k));
        same(
            &before,
            &self.ask(&mirrored)?,
            all(),
            &case.signs,
            raw.radius,
        )?;
        let mut moved = raw.clone();
        case.motion.apply(dimension, &mut moved.coordinates);
        let moved = moved.principal();
        let (p, q) = (first.local(), moved.local());
        let signs: Vec<bool> = (0..dimension)
            .map(|axis| {
                let products = (0..raw.len()).map(|k| p.point(k)[axis] * q.point(k)[axis]);
                products.sum::<f64>() < 0.0
            })
            .collect();
        // Principal directions of nearly equal variance are not determined: nothing to compare.
        let unturned = (0..raw.len()).all(|k| {
            (0..dimension).all(|a| {
                let x = p.point(k)[a];
                let x = if signs[a] { -x } else { x };
                (x - q.point(k)[a]).abs() < 1e-9 * raw.radius
            })
        });
        if unturned {
            same(&before, &self.ask(&moved)?, all(), &signs, raw.radius)?;
        }
        Ok(())
    }

    /// Whether the residual grows with the noise.
    fn grows(&self, case: &Case) -> Outcome {
        let mut before = 0.0;
        for noise in [1.0, 2.0, 4.0].map(|k| k * self.instances.noise) {
            let noisy = Case {
                noise,
                ..case.clone()
            };
            let instance = self.draw(&noisy)?.principal();
            let Ok(d) = self.ask(&instance)? else {
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
    }
}

#[cfg(test)]
mod tests;
