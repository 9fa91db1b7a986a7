//! What plug-ins return, checked before it is believed.
//!
//! The law kit tries a plug-in on drawn inputs before it is used; these checks see what it returns on
//! the data at hand. Each is cheap beside the call that it follows: what costs little is checked
//! whole, the rest at places spread over the data. All of it together is within 1.5 % of the time of a run (measured; the
//! chapter on laws has the table).
//!
//! | plug-in | checked | where |
//! | --- | --- | --- |
//! | metric | never NaN, identity, symmetry, triangle inequality | among the neighbors of 64 points; every distance used for NaN and sign |
//! | oracle | range, order, strictness, agreement of both queries and with the metric | at 64 points |
//! | estimator | finite value, confidence, rounding, bound | every answer |
//! | estimator, all balls together | an answer for each, bound; the same as one by one | every answer; the last at 16 points |
//! | singularity model | partition, order of strata, cells at curves, points, residual, center, offset | every decomposition |
//! | selector | candidates only, separation, covering | whole |
//! | chart | size, finite coordinates, distortion | every chart |
//! | compatibility test | symmetry, known pairs | once; every "no", and every 16th answer |
//! | triangle rule | never NaN, symmetry, a triangle without area last | every rank; the last two every 16th |
//!
//! A fault is put to the plug-in that made it. An oracle is compared with a metric and may be built on it, so that the
//! metric is asked first, and an answer of the metric that is no distance is never held against the oracle.
//!
//! What was found is an [`Error::Law`](crosscap_core::Error::Law) with the plug-in, the law as the trait words it, and the
//! point.

mod decomposition;
mod distances;
mod estimate;
mod faults;
mod oracle;
mod selection;
mod triangulation;

pub(crate) use decomposition::{local_dimension, placed, sound};
pub(crate) use distances::{distance, metric, no_distance};
pub(crate) use estimate::{dimension, dimensions};
pub(crate) use faults::Faults;
pub(crate) use oracle::oracle;
pub(crate) use selection::{Question, selection};
pub(crate) use triangulation::{AuditedChart, AuditedRule, AuditedTest, Watch, known_pairs};

use crosscap_core::{Error, Scalar};

fn broken<T>(plugin: &str, law: &'static str, point: usize, detail: String) -> Result<T, Error> {
    Err(Error::Law {
        plugin: plugin.into(),
        law,
        point,
        detail,
    })
}

/// Points at which spot checks are made.
const SAMPLES: usize = 64;

/// Rows spread evenly over `count`.
fn spread(count: usize, samples: usize) -> impl Iterator<Item = usize> {
    let samples = samples.min(count);
    (0..samples).map(move |k| k * count / samples)
}

/// Relative difference that rounding of `S` is allowed to make.
fn slack<S: Scalar>() -> f64 {
    S::default_epsilon().as_f64().sqrt()
}
