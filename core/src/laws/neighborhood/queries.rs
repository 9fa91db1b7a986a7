//! What is asked of an oracle, and what the answers must be.

use crate::laws::inputs::clouds;
use crate::laws::reference::Scan;
use crate::laws::trial::{Outcome, ensure};
use crate::{MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar};
use proptest::prelude::*;

/// A query: about a point of the cloud, with the distance of another as its radius.
#[derive(Clone, Debug)]
pub(super) struct Query {
    pub cloud: PointCloud<f64>,
    center: usize,
    /// The radius is the distance of this point.
    rim: usize,
    /// Multiplied with that distance: 1 makes ties with the radius.
    factor: f64,
    count: usize,
}

pub(super) fn queries() -> impl Strategy<Value = Query> {
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

/// What an oracle claims to serve.
type Served<'m, S> = Box<dyn MetricSpace<Scalar = S> + 'm>;
/// A metric and an oracle over the points of a cloud.
pub(super) type Build<'b, 'm, S> =
    dyn Fn(&PointCloud<f64>) -> (Served<'m, S>, Box<dyn NeighborhoodOracle<Scalar = S> + 'm>) + 'b;

/// An index that no cloud has: what a buffer held before.
const JUNK: usize = 977;

fn junk<S: Scalar>() -> Vec<Neighbor<S>> {
    let neighbor = Neighbor {
        index: JUNK,
        distance: S::of(0.5),
    };
    vec![neighbor; 3]
}

fn show<S: Scalar>(neighbors: &[Neighbor<S>]) -> String {
    let parts: Vec<String> = (neighbors.iter())
        .map(|n| format!("{} at {}", n.index, n.distance.as_f64()))
        .collect();
    format!("[{}]", parts.join(", "))
}

/// A question to an oracle in words, its answer, and that of a scan.
struct Answered<S> {
    question: String,
    found: Vec<Neighbor<S>>,
    expected: Vec<Neighbor<S>>,
}

impl<S: Scalar> Answered<S> {
    fn told(&self) -> String {
        format!("{} is {}", self.question, show(&self.found))
    }

    fn against(&self) -> String {
        format!("{}, expected {}", self.told(), show(&self.expected))
    }
}

/// An oracle that is tried, and the metric that it claims to serve.
pub(super) struct Tried<'m, S> {
    pub metric: Served<'m, S>,
    pub oracle: Box<dyn NeighborhoodOracle<Scalar = S> + 'm>,
}

impl<S: Scalar> Tried<'_, S> {
    fn radius(&self, query: &Query) -> S {
        let rim = self.metric.distance(query.center, query.rim).as_f64();
        S::of(rim * query.factor)
    }

    /// Asks who is within the radius; the buffer holds `before`.
    fn within(&self, query: &Query, before: Vec<Neighbor<S>>) -> Answered<S> {
        let radius = self.radius(query);
        let (mut found, mut expected) = (before, vec![]);
        self.oracle.within(query.center, radius, &mut found);
        Scan(self.metric.as_ref()).within(query.center, radius, &mut expected);
        Answered {
            question: format!("within({}, {})", query.center, radius.as_f64()),
            found,
            expected,
        }
    }

    /// Asks for the nearest ones; the buffer holds `before`.
    fn nearest(&self, query: &Query, before: Vec<Neighbor<S>>) -> Answered<S> {
        let (mut found, mut expected) = (before, vec![]);
        self.oracle.nearest(query.center, query.count, &mut found);
        Scan(self.metric.as_ref()).nearest(query.center, query.count, &mut expected);
        Answered {
            question: format!("nearest({}, {})", query.center, query.count),
            found,
            expected,
        }
    }

    /// Both questions.
    fn both(&self, query: &Query, before: fn() -> Vec<Neighbor<S>>) -> [Answered<S>; 2] {
        [self.within(query, before()), self.nearest(query, before())]
    }

    /// The law of the same name; so are those that follow.
    pub fn buffer(&self, query: &Query) -> Outcome {
        for answered in self.both(query, junk) {
            let left = answered.found.iter().any(|n| n.index == JUNK);
            ensure!(
                !left,
                "{} left what was in the buffer: {}",
                answered.question,
                show(&answered.found)
            );
        }
        Ok(())
    }

    pub fn strictness(&self, query: &Query) -> Outcome {
        let radius = self.radius(query).as_f64();
        let Answered {
            question, found, ..
        } = self.within(query, vec![]);
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
    }

    pub fn order(&self, query: &Query) -> Outcome {
        let key = |n: &Neighbor<S>| (n.distance.as_f64(), n.index);
        for answered in self.both(query, Vec::new) {
            let sorted = answered.found.windows(2).all(|w| key(&w[0]) < key(&w[1]));
            ensure!(sorted, "{}", answered.told());
        }
        Ok(())
    }

    pub fn ties(&self, query: &Query) -> Outcome {
        let distances = |n: &[Neighbor<S>]| -> Vec<u64> {
            n.iter().map(|n| n.distance.as_f64().to_bits()).collect()
        };
        let answered = self.nearest(query, vec![]);
        // Another set of distances is no matter of ties.
        let other = distances(&answered.found) != distances(&answered.expected);
        ensure!(
            other || answered.found == answered.expected,
            "{}",
            answered.against()
        );
        Ok(())
    }

    pub fn brute_force(&self, query: &Query) -> Outcome {
        ensure!(
            self.oracle.len() == self.metric.len(),
            "the oracle has {} points, the metric {}",
            self.oracle.len(),
            self.metric.len()
        );
        for answered in self.both(query, Vec::new) {
            ensure!(
                answered.found == answered.expected,
                "{}",
                answered.against()
            );
        }
        Ok(())
    }

    pub fn places(&self, query: &Query) -> Outcome {
        let radius = self.radius(query);
        let place: Vec<S> = (query.cloud.point(query.center).iter())
            .map(|&x| S::of(x))
            .collect();
        let (mut found, mut expected) = (junk(), vec![]);
        if self.oracle.within_of(&place, radius, &mut found) {
            self.oracle.within(query.center, radius, &mut expected);
            ensure!(
                found == expected,
                "within_of the place of point {} with radius {radius} is {}, within gives {}",
                query.center,
                show(&found),
                show(&expected)
            );
        }
        Ok(())
    }

    pub fn indices(&self, query: &Query) -> Outcome {
        let radius = self.radius(query);
        let (mut first, mut again, mut near) = (vec![JUNK as u32; 3], vec![], vec![]);
        (self.oracle).indices_within(query.center, radius, &mut first);
        (self.oracle).indices_within(query.center, radius, &mut again);
        ensure!(first == again, "asked twice: {first:?}, then {again:?}");
        self.oracle.within(query.center, radius, &mut near);
        let mut expected: Vec<u32> = near.iter().map(|n| n.index as u32).collect();
        expected.sort_unstable();
        first.sort_unstable();
        ensure!(
            first == expected,
            "indices_within({}, {radius}) gives {first:?}, within {expected:?}",
            query.center
        );
        Ok(())
    }

    pub fn nearness(&self, query: &Query) -> Outcome {
        let radius = self.radius(query);
        let (p, q) = (
            query.cloud.point(query.center),
            query.cloud.point(query.rim),
        );
        // The point itself, and a place between it and the one at the rim.
        for share in [0.0, 0.5] {
            let between = p.iter().zip(q).map(|(x, y)| x + share * (y - x));
            let place: Vec<S> = between.map(S::of).collect();
            let mut near = vec![];
            let some = self.oracle.within_of(&place, radius, &mut near) && !near.is_empty();
            let said = self.oracle.is_near(&place, radius);
            ensure!(
                said == some,
                "is_near({place:?}, {radius}) is {said}, within_of finds {}",
                show(&near)
            );
        }
        Ok(())
    }
}
