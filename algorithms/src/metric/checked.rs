//! A metric whose answers are looked at one by one.

use crate::audit::no_distance;
use crosscap_core::{Error, MetricSpace, PointCloud, Scalar};
use std::sync::{Mutex, PoisonError};

/// A metric that remembers the first of its answers that is no distance: NaN, or a negative number.
///
/// An oracle built on a metric has no way to say that the metric is at fault; what it answers then is wrong in
/// some way of its own, and it would be blamed. Around the metric this stands between the two: it answers infinity
/// for NaN, so that every comparison behind it has an answer, and [`CheckedMetric::sound`] tells afterwards what
/// was wrong. Costs a comparison a distance.
///
/// ```
/// use crosscap_algorithms::metric::{BruteForceOracle, CheckedMetric, Euclidean};
/// use crosscap_core::{Error, MetricSpace, NeighborhoodOracle, PointCloud};
/// /// The angle between two directions, computed without care.
/// struct Angle(PointCloud<f64>);
/// impl MetricSpace for Angle {
///     type Scalar = f64;
///     fn len(&self) -> usize { self.0.len() }
///     fn distance(&self, a: usize, b: usize) -> f64 {
///         let (p, q) = (self.0.point(a), self.0.point(b));
///         (p[0] * q[0] + p[1] * q[1]).acos()
///     }
///     fn name(&self) -> &str { "angle" }
/// }
/// // The square of the cosine and that of the sine add up to a little more than 1.
/// let cloud = PointCloud::new(2, vec![1.0, 0.0, 0.08_f64.cos(), 0.08_f64.sin()]).unwrap();
/// let oracle = BruteForceOracle::new(CheckedMetric::new(Angle(cloud)));
/// let mut near = Vec::new();
/// oracle.within(0, 2.0, &mut near);
/// assert!(oracle.metric().sound().is_ok());
/// oracle.within(1, 2.0, &mut near);
/// let error = oracle.metric().sound().unwrap_err();
/// assert!(matches!(error, Error::Law { plugin, point: 1, .. } if plugin == "angle"));
/// ```
#[derive(Debug)]
pub struct CheckedMetric<M> {
    metric: M,
    /// Of all pairs with such an answer the first, whichever thread asked first.
    first: Mutex<Option<(usize, usize, f64)>>,
}

impl<M: MetricSpace> CheckedMetric<M> {
    /// Looks at the answers of `metric`, given by value or by reference.
    pub fn new(metric: M) -> Self {
        Self {
            metric,
            first: Mutex::new(None),
        }
    }

    /// Whether all answers so far were distances.
    ///
    /// # Errors
    /// [`Error::Law`] about the first pair, in the order of indices, with an answer that was none.
    pub fn sound(&self) -> Result<(), Error> {
        let first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        match *first {
            None => Ok(()),
            Some((a, b, answer)) => Err(no_distance(self.metric.name(), a, b, answer)),
        }
    }

    #[inline]
    fn looked_at(&self, a: usize, b: usize, answer: M::Scalar) -> M::Scalar {
        if answer >= M::Scalar::of(0.0) {
            return answer;
        }
        self.remember(a, b, answer.as_f64());
        if answer.as_f64().is_nan() {
            M::Scalar::of(f64::INFINITY)
        } else {
            answer
        }
    }

    #[cold]
    fn remember(&self, a: usize, b: usize, answer: f64) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none_or(|(x, y, _)| (a, b) < (x, y)) {
            *first = Some((a, b, answer));
        }
    }
}

impl<M: MetricSpace> MetricSpace for CheckedMetric<M> {
    type Scalar = M::Scalar;

    fn len(&self) -> usize {
        self.metric.len()
    }

    fn distance(&self, a: usize, b: usize) -> M::Scalar {
        self.looked_at(a, b, self.metric.distance(a, b))
    }

    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<M::Scalar>) {
        self.metric.distances_to(from, to, out);
        for (x, &b) in out.iter_mut().zip(to) {
            *x = self.looked_at(from, b, *x);
        }
    }

    fn places(&self) -> Option<&PointCloud<M::Scalar>> {
        self.metric.places()
    }

    fn name(&self) -> &str {
        self.metric.name()
    }
}
