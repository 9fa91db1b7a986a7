//! The plainest implementations: what others are compared with, and doubles for tests.

use crate::{MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar};

/// Straight-line distances of a cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct StraightLine<S>(pub PointCloud<S>);

impl<S: Scalar> MetricSpace for StraightLine<S> {
    type Scalar = S;
    fn len(&self) -> usize {
        self.0.len()
    }
    fn distance(&self, a: usize, b: usize) -> S {
        S::of(self.0.squared_distance(a, b).sqrt())
    }
    fn name(&self) -> &str {
        "straight line"
    }
}

/// Neighborhoods by a scan over all points of any metric space: the brute force that the law of an
/// oracle speaks of.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan<M>(pub M);

impl<M: MetricSpace> Scan<M> {
    fn sorted(&self, center: usize, out: &mut Vec<Neighbor<M::Scalar>>) {
        out.clear();
        out.extend((0..self.0.len()).map(|index| Neighbor {
            index,
            distance: self.0.distance(center, index),
        }));
        sort(out);
    }
}

impl<M: MetricSpace> NeighborhoodOracle for Scan<M> {
    type Scalar = M::Scalar;
    fn len(&self) -> usize {
        self.0.len()
    }
    fn within(&self, center: usize, radius: M::Scalar, out: &mut Vec<Neighbor<M::Scalar>>) {
        self.sorted(center, out);
        out.retain(|n| n.distance < radius);
    }
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<M::Scalar>>) {
        self.sorted(center, out);
        out.truncate(count);
    }
}

/// Sorts by distance, ties by index.
pub(super) fn sort<S: Scalar>(neighbors: &mut [Neighbor<S>]) {
    neighbors.sort_by(|a, b| {
        let (x, y) = (a.distance.as_f64(), b.distance.as_f64());
        x.total_cmp(&y).then(a.index.cmp(&b.index))
    });
}

/// Half of the relative spacing of the numbers of a type at 1: its rounding error.
pub(super) fn rounding<S: Scalar>() -> f64 {
    let mut error = 0.5;
    while S::of(1.0 + error).as_f64() > 1.0 && error > 1e-20 {
        error /= 2.0;
    }
    error
}
