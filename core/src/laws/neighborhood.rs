//! Laws of [`NeighborhoodOracle`].

use super::inputs::clouds;
use super::reference::Scan;
use super::trial::ensure;
use super::{Failures, Findings, Law, Settings};
use crate::{MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar};
use proptest::prelude::*;

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

/// A query: about a point of the cloud, with the distance of another as its radius.
#[derive(Clone, Debug)]
struct Query {
    cloud: PointCloud<f64>,
    center: usize,
    /// The radius is the distance of this point.
    rim: usize,
    /// Multiplied with that distance: 1 makes ties with the radius.
    factor: f64,
    count: usize,
}

fn queries() -> impl Strategy<Value = Query> {
    let factor = prop_oneof![3 => Just(1.0), 1 => 0.0..3.0_f64];
    let index = any::<prop::sample::Index>;
    (
        clouds(1..=9, 1..=40),
        index(),
        index(),
        factor,
        0..=42_usize,
    )
        .prop_map(|(cloud, center, rim, factor, count)| Query {
            center: center.index(cloud.len()),
            rim: rim.index(cloud.len()),
            cloud,
            factor,
            count,
        })
}

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

/// What an oracle claims to serve.
type Served<'m, S> = Box<dyn MetricSpace<Scalar = S> + 'm>;
/// A metric and an oracle over the points of a cloud.
type Build<'b, 'm, S> =
    dyn Fn(&PointCloud<f64>) -> (Served<'m, S>, Box<dyn NeighborhoodOracle<Scalar = S> + 'm>) + 'b;

/// The laws themselves, compiled once a type of distances and not for every oracle that is tested.
fn laws<S: Scalar>(settings: &Settings, build: &Build<'_, '_, S>) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    let queries = queries();
    type Answers<S> = [Vec<Neighbor<S>>; 2];
    let junk = || {
        vec![
            Neighbor {
                index: 977,
                distance: S::of(0.5)
            };
            3
        ]
    };
    let radius_of = |metric: &Served<'_, S>, query: &Query| {
        let rim = metric.distance(query.center, query.rim).as_f64();
        S::of(rim * query.factor)
    };
    // Asks both questions of the oracle and of the scan; the buffers hold `before`.
    let asked = |query: &Query, before: &[Neighbor<S>]| {
        let (metric, oracle) = build(&query.cloud);
        let radius = radius_of(&metric, query);
        let scan = Scan(metric.as_ref());
        let (mut found, mut expected) = ([before.to_vec(), before.to_vec()], [vec![], vec![]]);
        oracle.within(query.center, radius, &mut found[0]);
        oracle.nearest(query.center, query.count, &mut found[1]);
        scan.within(query.center, radius, &mut expected[0]);
        scan.nearest(query.center, query.count, &mut expected[1]);
        (radius.as_f64(), found, expected)
    };
    let show = |n: &[Neighbor<S>]| -> String {
        let parts: Vec<String> = n
            .iter()
            .map(|n| format!("{} at {}", n.index, n.distance.as_f64()))
            .collect();
        format!("[{}]", parts.join(", "))
    };
    let question = |k: usize, radius: f64, query: &Query| match k {
        0 => format!("within({}, {radius})", query.center),
        _ => format!("nearest({}, {})", query.center, query.count),
    };

    found.put(BUFFER.holds(settings, &queries, |query| {
        let (radius, found, _) = asked(query, &junk());
        for (k, found) in found.iter().enumerate() {
            let question = question(k, radius, query);
            let left = found.iter().any(|n| n.index == 977);
            ensure!(
                !left,
                "{question} left what was in the buffer: {}",
                show(found)
            );
        }
        Ok(())
    }));
    found.put(STRICTNESS.holds(settings, &queries, |query| {
        let (radius, [found, _], _) = asked(query, &[]);
        let question = question(0, radius, query);
        for n in &found {
            let d = n.distance.as_f64();
            ensure!(
                d < radius,
                "{question} holds point {} at distance {d}",
                n.index
            );
        }
        let center = found.iter().any(|n| n.index == query.center);
        ensure!(
            center || radius.is_nan() || radius <= 0.0,
            "{question} does not hold its center: {}",
            show(&found)
        );
        Ok(())
    }));
    found.put(ORDER.holds(settings, &queries, |query| {
        let (radius, found, _) = asked(query, &[]);
        for (k, found) in found.iter().enumerate() {
            let key = |n: &Neighbor<S>| (n.distance.as_f64(), n.index);
            let sorted = found.windows(2).all(|w| key(&w[0]) < key(&w[1]));
            ensure!(sorted, "{} is {}", question(k, radius, query), show(found));
        }
        Ok(())
    }));
    let distances = |n: &[Neighbor<S>]| -> Vec<u64> {
        n.iter().map(|n| n.distance.as_f64().to_bits()).collect()
    };
    found.put(TIES.holds(settings, &queries, |query| {
        let (radius, [_, found], [_, expected]): (_, Answers<_>, Answers<_>) = asked(query, &[]);
        // Another set of distances is no matter of ties.
        ensure!(
            found == expected || distances(&found) != distances(&expected),
            "{} is {}, expected {}",
            question(1, radius, query),
            show(&found),
            show(&expected)
        );
        Ok(())
    }));
    found.put(BRUTE_FORCE.holds(settings, &queries, |query| {
        let (metric, oracle) = build(&query.cloud);
        ensure!(
            oracle.len() == metric.len(),
            "the oracle has {} points, the metric {}",
            oracle.len(),
            metric.len()
        );
        let (radius, found, expected) = asked(query, &[]);
        for k in 0..2 {
            ensure!(
                found[k] == expected[k],
                "{} is {}, expected {}",
                question(k, radius, query),
                show(&found[k]),
                show(&expected[k])
            );
        }
        Ok(())
    }));
    found.put(PLACES.holds(settings, &queries, |query| {
        let (metric, oracle) = build(&query.cloud);
        let radius = radius_of(&metric, query);
        let place: Vec<S> = (query.cloud.point(query.center).iter())
            .map(|&x| S::of(x))
            .collect();
        let (mut found, mut expected) = (junk(), vec![]);
        if oracle.within_of(&place, radius, &mut found) {
            oracle.within(query.center, radius, &mut expected);
            ensure!(
                found == expected,
                "within_of the place of point {} with radius {radius} is {}, within gives {}",
                query.center,
                show(&found),
                show(&expected)
            );
        }
        Ok(())
    }));
    found.put(INDICES.holds(settings, &queries, |query| {
        let (metric, oracle) = build(&query.cloud);
        let radius = radius_of(&metric, query);
        let (mut first, mut again, mut near) = (vec![977; 3], vec![], vec![]);
        oracle.indices_within(query.center, radius, &mut first);
        oracle.indices_within(query.center, radius, &mut again);
        ensure!(first == again, "asked twice: {first:?}, then {again:?}");
        oracle.within(query.center, radius, &mut near);
        let mut expected: Vec<u32> = near.iter().map(|n| n.index as u32).collect();
        expected.sort_unstable();
        first.sort_unstable();
        ensure!(
            first == expected,
            "indices_within({}, {radius}) gives {first:?}, within {expected:?}",
            query.center
        );
        Ok(())
    }));
    found.put(NEARNESS.holds(settings, &queries, |query| {
        let (metric, oracle) = build(&query.cloud);
        let radius = radius_of(&metric, query);
        // The point itself, and a place between it and the one at the rim.
        let (p, q) = (
            query.cloud.point(query.center),
            query.cloud.point(query.rim),
        );
        for share in [0.0, 0.5] {
            let between = p.iter().zip(q).map(|(x, y)| x + share * (y - x));
            let place: Vec<S> = between.map(S::of).collect();
            let mut near = vec![];
            let some = oracle.within_of(&place, radius, &mut near) && !near.is_empty();
            let said = oracle.is_near(&place, radius);
            ensure!(
                said == some,
                "is_near({place:?}, {radius}) is {said}, within_of finds {}",
                show(&near)
            );
        }
        Ok(())
    }));
    found.end()
}

#[cfg(test)]
mod tests {
    use super::super::StraightLine;
    use super::super::reference::sort;
    use super::super::twins::{each_is_caught, quick};
    use super::*;

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        Buffer,
        Inclusive,
        Centerless,
        Unsorted,
        LargerIndex,
        Forgetful,
        Rounded,
        WideAtPlaces,
        InclusiveIndices,
        KeptIndices,
        NearAtRim,
    }

    struct Twin(Scan<StraightLine<f64>>, Fault);

    impl NeighborhoodOracle for Twin {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
            let mut answer = vec![];
            let wide = if self.1 == Fault::Inclusive {
                radius.next_up()
            } else {
                radius
            };
            self.0.within(center, wide, &mut answer);
            match self.1 {
                Fault::Centerless => answer.retain(|n| n.index != center),
                Fault::Unsorted => answer.sort_by_key(|n| n.index),
                Fault::Forgetful if answer.len() > 3 => {
                    answer.pop();
                }
                Fault::Rounded => {
                    answer
                        .iter_mut()
                        .for_each(|n| n.distance = f64::from(n.distance as f32));
                }
                _ => {}
            }
            if self.1 != Fault::Buffer {
                out.clear();
            }
            out.extend(answer);
        }
        fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
            if self.1 == Fault::LargerIndex {
                self.0.nearest(center, usize::MAX, out);
                out.sort_by(|a, b| {
                    a.distance
                        .total_cmp(&b.distance)
                        .then(b.index.cmp(&a.index))
                });
                out.truncate(count);
                sort(out);
            } else {
                self.0.nearest(center, count, out);
            }
        }
        fn indices_within(&self, center: usize, radius: f64, out: &mut Vec<u32>) {
            if self.1 != Fault::KeptIndices {
                out.clear();
            }
            let mut near = vec![];
            let wide = if self.1 == Fault::InclusiveIndices {
                radius.next_up()
            } else {
                radius
            };
            self.within(center, wide, &mut near);
            out.extend(near.iter().rev().map(|n| n.index as u32));
        }
        fn is_near(&self, place: &[f64], radius: f64) -> bool {
            let d = |k: usize| crate::squared_distance(place, self.0.0.0.point(k)).sqrt();
            let wide = self.1 == Fault::NearAtRim;
            (0..self.len()).any(|k| d(k) < radius || wide && d(k) <= radius)
        }
        fn within_of(&self, place: &[f64], radius: f64, out: &mut Vec<Neighbor<f64>>) -> bool {
            out.clear();
            for index in 0..self.len() {
                let distance = crate::squared_distance(place, self.0.0.0.point(index)).sqrt();
                if distance < radius || self.1 == Fault::WideAtPlaces && distance == radius {
                    out.push(Neighbor { index, distance });
                }
            }
            sort(out);
            true
        }
    }

    fn put(fault: Fault) -> Result<(), Failures> {
        oracle(&quick(), |cloud| {
            let metric = StraightLine(cloud.clone());
            (metric.clone(), Twin(Scan(metric), fault))
        })
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let faults: &[(Fault, &Law)] = &[
            (Fault::Buffer, &BUFFER),
            (Fault::Inclusive, &STRICTNESS),
            (Fault::Centerless, &STRICTNESS),
            (Fault::Unsorted, &ORDER),
            (Fault::LargerIndex, &TIES),
            (Fault::Forgetful, &BRUTE_FORCE),
            (Fault::Rounded, &BRUTE_FORCE),
            (Fault::WideAtPlaces, &PLACES),
            (Fault::InclusiveIndices, &INDICES),
            (Fault::KeptIndices, &INDICES),
            (Fault::NearAtRim, &NEARNESS),
        ];
        each_is_caught(put, Fault::None, faults);
    }
}
