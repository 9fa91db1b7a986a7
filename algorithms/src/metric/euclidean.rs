//! The straight-line distance.

use std::sync::Arc;

use crosscap_core::{MetricSpace, PointCloud, Scalar};

/// Straight-line distances between the points of a cloud, in its unit: the square root of
/// [`PointCloud::squared_distance`], rounded to `S`. `O(N)` a distance.
///
/// ```
/// use crosscap_algorithms::metric::Euclidean;
/// use crosscap_core::{MetricSpace, PointCloud};
/// let cloud = PointCloud::new(2, vec![0.0, 0.0, 3.0, 4.0]).unwrap();
/// assert_eq!(Euclidean::new(cloud).distance(0, 1), 5.0);
/// ```
#[derive(Clone, Debug)]
pub struct Euclidean<S> {
    cloud: Arc<PointCloud<S>>,
}

impl<S: Scalar> Euclidean<S> {
    /// Distances in a cloud, given by value or as an [`Arc`].
    pub fn new(cloud: impl Into<Arc<PointCloud<S>>>) -> Self {
        Self {
            cloud: cloud.into(),
        }
    }

    /// The cloud.
    pub fn cloud(&self) -> &Arc<PointCloud<S>> {
        &self.cloud
    }
}

impl<S: Scalar> MetricSpace for Euclidean<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn distance(&self, a: usize, b: usize) -> S {
        S::of(self.cloud.squared_distance(a, b).sqrt())
    }

    fn places(&self) -> Option<&PointCloud<S>> {
        Some(&self.cloud)
    }

    fn name(&self) -> &str {
        "euclidean"
    }
}
