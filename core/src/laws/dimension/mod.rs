//! Laws of [`DimensionEstimator`].

mod batch;
mod one;

#[cfg(test)]
mod tests;

use super::inputs::{clouds, flat_samples};
use super::motion::motions;
use super::{Failures, Findings, Law, Settings};
use crate::{DimensionEstimator, Scalar};
use batch::{batch, batches};
use one::{Change, One};
use proptest::prelude::*;

const SUBJECT: &str = "DimensionEstimator";

/// An answer that can be used.
static ANSWER: Law = Law {
    subject: SUBJECT,
    name: "answer",
    says: "the value is finite and at least 0, the confidence between 0 and 1, the same question gets \
           the same answer; few points or copies of one point are refused or answered, without a panic",
    look_for: "the logarithm of a distance 0 (copies of the center); a division by the number of \
               neighbors minus one; a spectrum whose sum is 0; random numbers without a fixed seed",
};

/// A whole number.
static ROUNDED: Law = Law {
    subject: SUBJECT,
    name: "rounded",
    says: "the dimension is the value rounded",
    look_for: "a value that was left at its default (it equals the dimension for estimators that count); \
               rounding up or down where the nearest whole number is meant",
};

/// Motion.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "the same answer after a rigid motion, within rounding",
    look_for: "coordinates that are not centered; a fixed axis or grid (boxes that are counted); \
               random directions",
};

/// Scale.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the same answer after uniform scaling of data and radius",
    look_for: "a threshold in the unit of the data: make it a share of the radius or of the total; a \
               constant that guards a division",
};

/// Embedding.
static EMBEDDING: Law = Law {
    subject: SUBJECT,
    name: "embedding",
    says: "the same answer after an isometric embedding in a larger space",
    look_for: "the dimension of the space in a formula (a mean over coordinates, a share of N)",
};

/// Order.
static ORDER: Law = Law {
    subject: SUBJECT,
    name: "order",
    says: "the same answer for any order of the points, within rounding",
    look_for: "a subset picked by index (the first half, every second one): pick by distance, or all",
};

/// Variances.
static VARIANCES: Law = Law {
    subject: SUBJECT,
    name: "variances",
    says: "where of_variances answers, it says of the variances of a neighborhood what estimate says of the \
           neighborhood, within rounding",
    look_for: "an answer that depends on more than the variances (leave the default); variances taken for their \
               roots, or in rising order; a share of N where fewer variances than coordinates are given",
};

/// Batch.
static BATCH: Law = Law {
    subject: SUBJECT,
    name: "batch",
    says: "of all balls of a cloud together estimate_all says what estimate says of each, with the number of points in \
           it (where the dimension is 2 that of a ball close by will do), and refuses what estimate refuses",
    look_for: "a radius taken for all balls where each has its own; a ball that takes points at distance = radius; the \
               places of a metric that is not the straight line between them (ask MetricSpace::places, not the cloud); \
               answers in the order of a tree",
};

pub(super) static ALL: [&Law; 8] = [
    &ANSWER, &ROUNDED, &MOTION, &SCALE, &EMBEDDING, &ORDER, &VARIANCES, &BATCH,
];

/// Puts an estimator through its laws, on neighborhoods of 12 to 60 points of flat pieces of
/// dimension 1 to 4 with and without thickness, and on poor ones.
///
/// What it finds on which data is not judged here: that is for tests of its own.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighborhood};
/// /// Counts doublings: twice the radius, 2^d times the points.
/// struct Doubling;
/// impl DimensionEstimator for Doubling {
///     type Scalar = f64;
///     fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
///         let all = around.neighbors.len() as f64;
///         let inner = around.neighbors.iter().filter(|n| 2.0 * n.distance < around.radius).count();
///         let value = (all / inner.max(1) as f64).log2();
///         Ok(DimensionEstimate { dimension: value.round() as usize, value, ..Default::default() })
///     }
///     fn name(&self) -> &str { "doubling" }
/// }
/// laws::estimator(&Settings::default(), &Doubling).unwrap();
/// ```
pub fn estimator<D: DimensionEstimator>(
    settings: &Settings,
    estimator: &D,
) -> Result<(), Failures> {
    laws(settings, estimator)
}

/// The laws themselves, compiled once a type of coordinates and not for every estimator that is tested.
fn laws<S: Scalar>(
    settings: &Settings,
    estimator: &dyn DimensionEstimator<Scalar = S>,
) -> Result<(), Failures> {
    let one = One { estimator };
    let mut found = Findings::new(settings, &ALL);
    let all_kinds = prop_oneof![clouds(1..=4, 1..=8), flat_samples().prop_map(|s| s.cloud)];
    found.put(ANSWER.holds(settings, &all_kinds, |cloud| one.answer(cloud)));
    found.put(ROUNDED.holds(settings, &all_kinds, |cloud| one.rounded(cloud)));
    let changes = [
        (&MOTION, 0_usize, Change::Motion),
        (&SCALE, 0, Change::Scale),
        (&EMBEDDING, 6, Change::Motion),
    ];
    for (law, more, change) in changes {
        let inputs = (flat_samples(), motions(), -6..=6_i32, 0..=more);
        found.put(
            law.holds(settings, &inputs, |(sample, motion, exponent, more)| {
                one.moved(&sample.cloud, &change.of(motion, *exponent), *more)
            }),
        );
    }
    let keys = prop::collection::vec(any::<u16>(), 60);
    found.put(
        ORDER.holds(settings, &(flat_samples(), keys), |(sample, keys)| {
            one.reordered(&sample.cloud, keys)
        }),
    );
    found.put(VARIANCES.holds(settings, &flat_samples(), |sample| {
        one.variances(&sample.cloud)
    }));
    found.put(BATCH.holds(settings, &batches(), |asked| batch(estimator, asked)));
    found.end()
}
