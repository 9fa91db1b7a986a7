//! Laws of [`NeighborhoodOracle`].

mod queries;

#[cfg(test)]
mod tests;

use super::trial::Outcome;
use super::{Failures, Findings, Law, Settings};
use crate::{MetricSpace, NeighborhoodOracle, PointCloud, Scalar};
use queries::{Build, Query, Tried, queries};

const SUBJECT: &str = "NeighborhoodOracle";

/// The buffer.
static BUFFER: Law = Law {
    subject: SUBJECT,
    name: "buffer",
    says: "the former content of the buffer is dropped",
    look_for: "a missing `out.clear()`, also on the way out for an empty answer",
};

/// Strictness.
static STRICTNESS: Law = Law {
    subject: SUBJECT,
    name: "strictness",
    says: "within takes points at distance < radius, the center among them when radius > 0",
    look_for: "<= instead of <: search trees are inclusive by default; a center that is left out",
};

/// Order.
static ORDER: Law = Law {
    subject: SUBJECT,
    name: "order",
    says: "answers come sorted by distance, ties by index",
    look_for: "the order in which a tree is walked; a sort by distance alone, stable or not",
};

/// Ties.
static TIES: Law = Law {
    subject: SUBJECT,
    name: "ties",
    says: "where several points are equally far in the last place, nearest takes the smaller indices",
    look_for: "a heap of fixed size that keeps who came first: ask for all that are as far as the \
               last one, sort, then cut; the center put first by force where a copy of it has a \
               smaller index",
};

/// Equals brute force.
static BRUTE_FORCE: Law = Law {
    subject: SUBJECT,
    name: "equals brute force",
    says: "the answer is that of a scan over all points with the metric that the oracle serves, with \
           the distances of that metric to the bit",
    look_for: "a tree in another precision, or that compares squares rounded differently (query a \
               little wider, measure again); a search that stops too early; copies of a point; an \
               oracle of another metric than the one it was compared with",
};

/// Places.
static PLACES: Law = Law {
    subject: SUBJECT,
    name: "places",
    says: "where within_of answers (returns true), a point's own coordinates give what within gives",
    look_for: "within_of with another strictness, order or metric than within; coordinates that were \
               scaled or centered for the tree and not for the query",
};

/// Indices alone.
static INDICES: Law = Law {
    subject: SUBJECT,
    name: "indices",
    says: "indices_within gives the points of within, each once, in the same order at every call; the former \
           content of the buffer is dropped",
    look_for: "a search that compares squares and does not measure again at the rim; the center, or copies of it, \
               left out; an order that depends on the threads; a missing `out.clear()`",
};

/// Nearness.
static NEARNESS: Law = Law {
    subject: SUBJECT,
    name: "nearness",
    says: "is_near says whether within_of finds a point, and no where the space has no coordinates",
    look_for: "a search that stops before it has measured a point at the rim; another strictness than that of within",
};

pub(super) static ALL: [&Law; 8] = [
    &BUFFER,
    &STRICTNESS,
    &ORDER,
    &TIES,
    &BRUTE_FORCE,
    &PLACES,
    &INDICES,
    &NEARNESS,
];

/// Puts an oracle through its laws, on clouds of 1 to 40 points in R^1 to R^9 with copies and ties, with
/// radii that are distances.
///
/// `build` makes the metric that the oracle claims to serve, and the oracle, over the points that
/// it is given; they may be the same thing twice.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Scan, Settings, StraightLine};
/// laws::oracle(&Settings::default(), |cloud| {
///     let metric = StraightLine(cloud.clone());
///     (metric.clone(), Scan(metric))
/// })
/// .unwrap();
/// ```
pub fn oracle<M: MetricSpace, O: NeighborhoodOracle<Scalar = M::Scalar>>(
    settings: &Settings,
    build: impl Fn(&PointCloud<f64>) -> (M, O),
) -> Result<(), Failures> {
    laws(settings, &|cloud| {
        let (metric, oracle) = build(cloud);
        (Box::new(metric), Box::new(oracle))
    })
}

/// Whether a law holds for one query.
type Test<'m, S> = fn(&Tried<'m, S>, &Query) -> Outcome;

/// The laws themselves, compiled once a type of distances and not for every oracle that is tested.
fn laws<'m, S: Scalar>(settings: &Settings, build: &Build<'_, 'm, S>) -> Result<(), Failures> {
    let tests: [(&'static Law, Test<'m, S>); 8] = [
        (&BUFFER, Tried::buffer),
        (&STRICTNESS, Tried::strictness),
        (&ORDER, Tried::order),
        (&TIES, Tried::ties),
        (&BRUTE_FORCE, Tried::brute_force),
        (&PLACES, Tried::places),
        (&INDICES, Tried::indices),
        (&NEARNESS, Tried::nearness),
    ];
    let mut found = Findings::new(settings, &ALL);
    let queries = queries();
    for (law, test) in tests {
        found.put(law.holds(settings, &queries, |query| {
            let (metric, oracle) = build(&query.cloud);
            test(&Tried { metric, oracle }, query)
        }));
    }
    found.end()
}
