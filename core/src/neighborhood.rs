//! Who is near whom.

use crate::{MetricSpace, PointCloud, Row, Scalar};

/// A point and its distance from the center of a neighborhood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor<S> {
    /// The point.
    pub index: usize,
    /// Its distance from the center, in the unit of the data.
    pub distance: S,
}

impl<S> Neighbor<S> {
    /// The point as a row of the cloud.
    #[inline]
    pub fn row(&self) -> Row {
        Row::new(self.index)
    }
}

/// Answers neighborhood queries in a finite metric space, exactly.
///
/// # Why it has this shape
/// An oracle is apart from the metric because one metric can be served in many ways: by a scan, a tree, a search
/// through a graph. The answers must not depend on which it was, to the last tie, or a mesh would change with
/// the engine; this is why order and ties are laws, and why an approximate index is no oracle. Answers are
/// written into a buffer of the caller, so that ten thousand queries allocate once. Two queries are required,
/// since neither can be had from the other at a fair price; those with a default body are there for
/// implementations that can do them in less time, and say the same.
///
/// # Laws
/// - *equals brute force*: the answer is that of a scan over all points with the metric
///   that the oracle claims to serve;
/// - *strictness*: `within` takes points at distance `< radius` (the paper's
///   neighborhood, section 2), the center among them when `radius > 0`;
/// - *order*: both answers come sorted by distance, ties by index;
/// - *ties*: `nearest` breaks ties at the last place by the smaller index.
pub trait NeighborhoodOracle: Sync {
    /// Type that distances are given in.
    type Scalar: Scalar;

    /// Number of points.
    fn len(&self) -> usize;

    /// Whether there is no point.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Writes the points at distance strictly less than `radius` from `center` into
    /// `out`, whose former content is dropped.
    fn within(&self, center: usize, radius: Self::Scalar, out: &mut Vec<Neighbor<Self::Scalar>>);

    /// Writes the `count` points nearest to `center`, itself and its copies among them, into
    /// `out`; fewer when there are fewer.
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<Self::Scalar>>);

    /// Writes the points of [`NeighborhoodOracle::within`] alone into `out`, in any order that is the
    /// same at every call, for loops that need neither distances nor order. An oracle that can
    /// do it in less time than `within` overrides it.
    fn indices_within(&self, center: usize, radius: Self::Scalar, out: &mut Vec<u32>) {
        let mut near = Vec::new();
        self.within(center, radius, &mut near);
        out.clear();
        out.extend(near.iter().map(|x| x.index as u32));
    }

    /// The same two queries about a place that need not be a point of the set, where the
    /// space has coordinates; `false` when it has none.
    fn within_of(
        &self,
        _place: &[Self::Scalar],
        _radius: Self::Scalar,
        _out: &mut Vec<Neighbor<Self::Scalar>>,
    ) -> bool {
        false
    }

    /// Short name for reports: what serves the metric.
    fn name(&self) -> &str {
        "neighborhood oracle"
    }

    /// Whether a point is closer to a place than `radius`; `false` where the space has no coordinates.
    fn is_near(&self, place: &[Self::Scalar], radius: Self::Scalar) -> bool {
        let mut near = Vec::new();
        self.within_of(place, radius, &mut near) && !near.is_empty()
    }
}

/// A neighborhood as a dimension estimator sees it.
#[derive(Clone, Copy)]
pub struct Neighborhood<'a, S: Scalar> {
    /// The center.
    pub center: usize,
    /// The radius it was drawn with (strict), infinite for a k-nearest neighborhood.
    pub radius: f64,
    /// The points in it, the center among them, sorted by distance.
    pub neighbors: &'a [Neighbor<S>],
    /// The metric, for distances between neighbors.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// Coordinates, where the space has any.
    pub cloud: Option<&'a PointCloud<S>>,
}
