//! Laws of [`SingularityModel`].

mod answers;
mod asked;
#[cfg(test)]
mod tests;

use super::trial::ensure;
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::SingularityModel;
use answers::{about, cells_are_counted, is_true, same};
use asked::{Asked, Case};
use proptest::collection::vec;
use proptest::prelude::*;

pub use asked::Instances;

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
    let tried = Tried {
        settings: settings.at_most(256),
        asked: Asked { model, instances },
    };
    found.put(tried.poor_partition());
    found.put(tried.partition());
    found.put(tried.motion());
    found.put(tried.order());
    found.put(tried.fitted());
    found.put(tried.about());
    found.put(tried.exact());
    found.put(tried.noise());
    found.put(tried.cells());
    found.put(tried.truth());
    found.end()
}

/// A model that is put through its laws.
struct Tried<'t> {
    settings: Settings,
    asked: Asked<'t>,
}

impl Tried<'_> {
    /// Instances with noise up to the most that is tried.
    fn noisy(&self) -> impl Strategy<Value = Case> + use<> {
        self.asked.cases(4.0 * self.asked.instances.noise)
    }

    /// Instances without noise.
    fn clean(&self) -> impl Strategy<Value = Case> + use<> {
        self.asked.cases(0.0)
    }

    fn poor_partition(&self) -> Result<(), LawBroken> {
        let rows = vec(prop::array::uniform12(-2..=2_i8), 1..=30);
        let poor = (rows, any::<bool>(), 1..=30_usize);
        PARTITION.holds(&self.settings, &poor, |(rows, far, fitted)| {
            let fitted = if *far {
                (*fitted).min(rows.len())
            } else {
                rows.len()
            };
            let instance = self.asked.poor(rows, fitted).principal();
            self.asked.ask(&instance).map(|_| ())
        })
    }

    fn partition(&self) -> Result<(), LawBroken> {
        PARTITION.holds(&self.settings, &self.noisy(), |case| {
            let instance = self.asked.draw(case)?.principal();
            self.asked.ask(&instance).map(|_| ())
        })
    }

    fn motion(&self) -> Result<(), LawBroken> {
        MOTION.holds(&self.settings, &self.noisy(), |case| self.asked.moved(case))
    }

    fn order(&self) -> Result<(), LawBroken> {
        let ordered = (self.noisy(), vec(any::<u16>(), 512));
        ORDER.holds(&self.settings, &ordered, |(case, keys)| {
            let first = self.asked.draw(case)?.principal();
            let (other, order) = first.reordered(keys);
            let pairs = order.iter().enumerate().map(|(new, &old)| (old, new));
            let (a, b) = (self.asked.ask(&first)?, self.asked.ask(&other)?);
            same(&a, &b, pairs, &[], first.radius)
        })
    }

    fn fitted(&self) -> Result<(), LawBroken> {
        FITTED.holds(&self.settings, &self.noisy(), |case| {
            let all = self.asked.draw(case)?.principal();
            let mut alone = all.clone();
            alone.coordinates.truncate(all.fitted * all.dimension);
            alone.truth.truncate(all.fitted);
            let pairs = (0..all.fitted).map(|k| (k, k));
            let (a, b) = (self.asked.ask(&all)?, self.asked.ask(&alone)?);
            same(&a, &b, pairs, &[], all.radius)
        })
    }

    fn about(&self) -> Result<(), LawBroken> {
        let some = vec(any::<prop::sample::Index>(), 1..=6);
        ABOUT.holds(&self.settings, &(self.noisy(), some), |(case, rows)| {
            let instance = self.asked.draw(case)?.principal();
            let rows: Vec<usize> = rows.iter().map(|k| k.index(instance.len())).collect();
            about(self.asked.model, &instance, &rows)
        })
    }

    fn exact(&self) -> Result<(), LawBroken> {
        EXACT.holds(&self.settings, &self.clean(), |case| {
            let (instance, fit) = self.asked.accepted(case)?;
            let limit = self.asked.instances.exact * instance.radius;
            ensure!(
                fit.residual <= limit,
                "the residual is {}, above {limit}",
                fit.residual
            );
            Ok(())
        })
    }

    fn noise(&self) -> Result<(), LawBroken> {
        NOISE.holds(&self.settings, &self.clean(), |case| self.asked.grows(case))
    }

    fn cells(&self) -> Result<(), LawBroken> {
        CELLS.holds(&self.settings, &self.clean(), |case| {
            let (instance, fit) = self.asked.accepted(case)?;
            cells_are_counted(&fit, &instance)
        })
    }

    fn truth(&self) -> Result<(), LawBroken> {
        TRUTH.holds(&self.settings, &self.clean(), |case| {
            let (instance, fit) = self.asked.accepted(case)?;
            is_true(&fit, &instance)
        })
    }
}
