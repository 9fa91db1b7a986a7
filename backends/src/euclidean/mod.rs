//! Exact Euclidean neighborhoods in any dimension, on kiddo.
//!
//! A kd-tree wants its dimension at compile time and degrades as it grows, the method wants
//! neighborhoods in R^2 to R^72 and beyond. Both are served by one observation: an orthogonal
//! projection never lengthens a distance. The tree holds the cloud projected to its leading
//! principal axes (eight at most, and all of R^N up to eight); a query there with a radius
//! inflated by a bound on the rounding errors misses nobody, and every candidate is then
//! measured from the original coordinates. So the answer is that of a scan over all points, to
//! the bit, and the axes decide nothing but the speed.

mod frame;
mod order;
#[cfg(test)]
mod tests;
mod tree;

use self::frame::Frame;
use self::order::{rank, sort};
use self::tree::{MOST_AXES, Tree, plant};
use crosscap_core::{
    Error, MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar, squared_distance,
};
use std::sync::Arc;

/// Neighborhoods in a [`PointCloud`] under the Euclidean distance, exact at any dimension.
///
/// The metric is the square root of [`PointCloud::squared_distance`], rounded to `S`; all
/// answers are those of a scan with that metric: strict `<`, sorted by distance, ties by index.
/// Any number of points may coincide.
///
/// Building takes `O(n (log n + N))`, a query that finds `k` points about
/// `O(log n + k (N + log k))` when the cloud is of low dimension locally.
///
/// ```
/// use crosscap_backends::euclidean::EuclideanOracle;
/// use crosscap_core::{NeighborhoodOracle, PointCloud};
/// let line = PointCloud::new(1, vec![0.0, 3.0, 1.0, 2.0]).unwrap();
/// let oracle = EuclideanOracle::new(line).unwrap();
/// let mut found = Vec::new();
/// oracle.within(0, 2.0, &mut found); // strict: the point at distance 2 is not in it
/// assert_eq!(found.iter().map(|f| f.index).collect::<Vec<_>>(), [0, 2]);
/// oracle.nearest(2, 2, &mut found); // 0 and 3 are equally near: the smaller index wins
/// assert_eq!(found.iter().map(|f| f.index).collect::<Vec<_>>(), [2, 0]);
/// ```
pub struct EuclideanOracle<S: Scalar> {
    cloud: Arc<PointCloud<S>>,
    tree: Box<dyn Tree>,
    frame: Frame,
    /// Relative and absolute (in units of the tree) bound on rounding errors.
    slack: f64,
    /// Relative spacing of `S`.
    spacing: f64,
    /// A distance below which squares or `S` itself underflow, in units of the data.
    underflow: f64,
}

impl<S: Scalar> EuclideanOracle<S> {
    /// Builds the tree over a cloud, given by value or as an [`Arc`].
    ///
    /// # Errors
    /// [`Error::Shape`] when there are more points than a `u32` can count, and
    /// [`Error::Parameter`] when a coordinate is so large (above 1e36 for `f32`, 1e150 for
    /// `f64`) that distances overflow. An empty cloud is allowed.
    pub fn new(cloud: impl Into<Arc<PointCloud<S>>>) -> Result<Self, Error> {
        let cloud = cloud.into();
        if u32::try_from(cloud.len()).is_err() {
            return Err(Error::Shape {
                found: format!("{} points", cloud.len()),
                expected: format!("at most {} points", u32::MAX),
            });
        }
        let wide = S::of(1e100).is_finite();
        let (limit, underflow) = if wide { (1e150, 1e-150) } else { (1e36, 1e-36) };
        if let Some(at) = (cloud.coordinates().iter()).position(|c| c.as_f64().abs() > limit) {
            let (row, column) = (at / cloud.dimension(), at % cloud.dimension());
            return Err(Error::Parameter {
                name: "coordinates",
                value: format!("{} in row {row}, column {column}", cloud.coordinates()[at]),
                expected: format!("magnitudes up to {limit:e} (rescale the data)"),
            });
        }
        let frame = Frame::of(&cloud);
        let tree = plant(frame.tree_dimension(), &frame.places(&cloud))?;
        Ok(Self {
            slack: (cloud.dimension() + 16) as f64 * 32.0 * f64::EPSILON,
            spacing: S::default_epsilon().as_f64(),
            underflow,
            cloud,
            tree,
            frame,
        })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.cloud.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.cloud.is_empty()
    }

    /// The cloud it serves.
    pub fn cloud(&self) -> &Arc<PointCloud<S>> {
        &self.cloud
    }

    /// Whether a point is closer to `place` than `radius`; `false` for a place with another number of
    /// coordinates. Takes O(log n) where one is.
    ///
    /// ```
    /// use crosscap_backends::euclidean::EuclideanOracle;
    /// use crosscap_core::PointCloud;
    /// let line = PointCloud::new(1, vec![0.0, 3.0]).unwrap();
    /// let oracle = EuclideanOracle::new(line).unwrap();
    /// assert!(oracle.is_near(&[2.5], 0.6));
    /// assert!(!oracle.is_near(&[2.5], 0.5)); // strict
    /// ```
    pub fn is_near(&self, place: &[S], radius: S) -> bool {
        if place.len() != self.cloud.dimension() {
            return false;
        }
        let mut lead = [0.0; MOST_AXES];
        let mut near = false;
        if self.frame.place(place, &mut lead) < 1e100 {
            self.tree.nearest(&lead, 1, &mut |index| {
                near |= self.distance_to(place, index as usize) < radius;
            });
        }
        // The nearest in the tree is a point like any other, but need not be the nearest of all.
        near || {
            let mut found = Vec::new();
            self.within_row(place, radius, &mut found);
            !found.is_empty()
        }
    }

    fn distance_to(&self, row: &[S], index: usize) -> S {
        S::of(squared_distance(row, self.cloud.point(index)).sqrt())
    }

    /// Visits every point whose distance from `row`, rounded to `S`, is at most `reach`, and
    /// perhaps some more, with its squared distance in the tree (NaN if not known).
    fn candidates(&self, row: &[S], reach: f64, visit: &mut dyn FnMut(u32, f64)) {
        let mut place = [0.0; MOST_AXES];
        let norm = self.frame.place(row, &mut place);
        // Outside of this window the tree cannot save anything, or its arithmetic could overflow.
        if norm < 1e100 {
            let reach = (reach * (1.0 + 2.0 * self.spacing) + self.underflow) * self.frame.scale;
            let reach = reach * (1.0 + self.slack) + self.slack * norm.max(1.0);
            if reach < 2.0 {
                return self.tree.within(&place, reach * reach, visit);
            }
        }
        for index in 0..self.cloud.len() {
            visit(index as u32, f64::NAN);
        }
    }

    fn within_row(&self, row: &[S], radius: S, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        if radius.as_f64().is_nan() || radius <= S::zero() {
            return;
        }
        self.candidates(row, radius.as_f64(), &mut |index, _| {
            let index = index as usize;
            let distance = self.distance_to(row, index);
            if distance < radius {
                out.push(Neighbor { index, distance });
            }
        });
        sort(out);
    }
}

impl<S: Scalar> MetricSpace for EuclideanOracle<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn distance(&self, a: usize, b: usize) -> S {
        self.distance_to(self.cloud.point(a), b)
    }

    fn places(&self) -> Option<&PointCloud<S>> {
        Some(&self.cloud)
    }

    fn name(&self) -> &str {
        "euclidean"
    }
}

impl<S: Scalar> NeighborhoodOracle for EuclideanOracle<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn within(&self, center: usize, radius: S, out: &mut Vec<Neighbor<S>>) {
        self.within_row(self.cloud.point(center), radius, out);
    }

    /// As the trait says. The center is not the first where a copy of it has a smaller index.
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        if count == 0 {
            return;
        }
        let row = self.cloud.point(center);
        let reach = if count < self.cloud.len() {
            // The farthest of `count` points, whichever they are, bounds the answer.
            let mut place = [0.0; MOST_AXES];
            self.frame.place(row, &mut place);
            let mut reach = 0.0_f64;
            self.tree.nearest(&place, count, &mut |index| {
                reach = reach.max(squared_distance(row, self.cloud.point(index as usize)));
            });
            reach.sqrt()
        } else {
            f64::INFINITY
        };
        let limit = S::of(reach);
        self.candidates(row, reach, &mut |index, _| {
            let index = index as usize;
            let distance = self.distance_to(row, index);
            if distance <= limit {
                out.push(Neighbor { index, distance });
            }
        });
        if count < out.len() {
            out.select_nth_unstable_by_key(count, rank);
            out.truncate(count);
        }
        sort(out);
    }

    fn is_near(&self, place: &[S], radius: S) -> bool {
        EuclideanOracle::is_near(self, place, radius)
    }

    /// As the trait says, in the order of the tree.
    ///
    /// # Panics
    /// When `center` is not a point.
    fn indices_within(&self, center: usize, radius: S, out: &mut Vec<u32>) {
        out.clear();
        if radius.as_f64().is_nan() || radius <= S::zero() {
            return;
        }
        let row = self.cloud.point(center);
        let limit = radius.as_f64();
        // Where the tree holds all of R^N its own distances decide, but for a thin shell.
        let sure = if self.frame.axes.is_none() {
            let inner = (limit * (1.0 - 2.0 * self.spacing) - self.underflow) * self.frame.scale;
            let inner = inner * (1.0 - self.slack) - self.slack;
            if inner > 0.0 { inner * inner } else { -1.0 }
        } else {
            -1.0
        };
        self.candidates(row, limit, &mut |index, tree_squared| {
            if tree_squared < sure || self.distance_to(row, index as usize) < radius {
                out.push(index);
            }
        });
    }

    /// As the trait says; `false`, and nothing in `out`, when `place` does not have as many
    /// coordinates as the cloud. A place that is not finite is near no point.
    fn within_of(&self, place: &[S], radius: S, out: &mut Vec<Neighbor<S>>) -> bool {
        out.clear();
        if place.len() != self.cloud.dimension() {
            return false;
        }
        self.within_row(place, radius, out);
        true
    }

    fn name(&self) -> &str {
        "search-tree"
    }
}
