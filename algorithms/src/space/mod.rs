//! A finite space as everything behind it sees it: a metric, the neighborhoods in it, and coordinates
//! where there are any.
//!
//! Whoever wants to know how far two points are, what is near a point or which points are joined in
//! the graph that cells are flooded in asks the [`Space`], and nothing else. Whether a search tree over
//! coordinates may answer is decided here alone: it may when the metric says that it is the straight
//! line between places ([`MetricSpace::places`]).

mod nearest;

pub(crate) use nearest::{GRAPH_NEIGHBORS, NearestOfEach};

use crate::audit;
use crate::execute::Execute;
use crate::locality;
use crosscap_core::{
    Error, MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar, squared_distance,
};

/// A metric on `n` points, an oracle that serves it, and coordinates where there are any.
///
/// Coordinates need not belong to the metric: models are fitted and meshes are drawn in them, whatever
/// metric says who is near whom. Distances that were given have none at all.
///
/// ```
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean, GivenDistances};
/// use crosscap_algorithms::space::Space;
/// use crosscap_core::PointCloud;
/// let line = Euclidean::new(PointCloud::new(1, vec![0.0, 1.0, 3.0])?);
/// let oracle = BruteForceOracle::new(&line);
/// let space = Space::new(&line, &oracle);
/// assert!(space.is_straight() && space.places().is_some());
/// let measured = GivenDistances::new(2, vec![0.0, 2.0, 2.0, 0.0])?;
/// let oracle = BruteForceOracle::new(&measured);
/// let space = Space::new(&measured, &oracle);
/// assert!(space.places().is_none());
/// assert_eq!(space.distance(0, 1)?, 2.0);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Space<'a, S: Scalar> {
    metric: &'a dyn MetricSpace<Scalar = S>,
    oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    places: Option<&'a PointCloud<S>>,
}

impl<'a, S: Scalar> Space<'a, S> {
    /// The space of a metric, with the coordinates that the metric names, if it does.
    pub fn new(
        metric: &'a dyn MetricSpace<Scalar = S>,
        oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    ) -> Self {
        Self {
            metric,
            oracle,
            places: metric.places(),
        }
    }

    /// The space of something that is a metric and its own oracle.
    pub fn of<T>(both: &'a T) -> Self
    where
        T: MetricSpace<Scalar = S> + NeighborhoodOracle<Scalar = S>,
    {
        Self::new(both, both)
    }

    /// The same space with coordinates of the points, one row each.
    pub fn with_places(self, places: &'a PointCloud<S>) -> Self {
        Self {
            places: Some(places),
            ..self
        }
    }

    /// The same space with another oracle for its metric.
    pub fn with_oracle(self, oracle: &'a dyn NeighborhoodOracle<Scalar = S>) -> Self {
        Self { oracle, ..self }
    }

    /// What `work` makes of every point, by row; `scratch` makes a workspace for one thread after another.
    ///
    /// Points that are near each other are worked on one after the other where there are coordinates.
    pub(crate) fn map<T: Send + Sync, C>(
        &self,
        execute: &dyn Execute,
        scratch: impl Fn() -> C + Sync,
        work: impl Fn(&mut C, usize) -> T + Sync,
    ) -> Vec<T> {
        locality::map(execute, self.places, self.len(), scratch, work)
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.metric.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The metric.
    pub fn metric(&self) -> &'a dyn MetricSpace<Scalar = S> {
        self.metric
    }

    /// The neighborhoods in the metric.
    pub fn oracle(&self) -> &'a dyn NeighborhoodOracle<Scalar = S> {
        self.oracle
    }

    /// Coordinates of the points, where there are any.
    pub fn places(&self) -> Option<&'a PointCloud<S>> {
        self.places
    }

    /// Coordinates of the points, for a task that cannot do without.
    ///
    /// # Errors
    /// [`Error::Shape`] where there are none.
    pub fn coordinates(&self, task: &str) -> Result<&'a PointCloud<S>, Error> {
        self.places.ok_or_else(|| Error::Shape {
            found: format!(
                "the metric {} on points without coordinates",
                self.metric.name()
            ),
            expected: format!("coordinates, {task}"),
        })
    }

    /// Whether the distance of two points is the straight line between their coordinates.
    pub fn is_straight(&self) -> bool {
        self.metric.places().is_some()
    }

    /// Distance of two points.
    ///
    /// # Errors
    /// [`Error::Law`], put to the metric, for NaN and for a negative distance.
    pub fn distance(&self, a: usize, b: usize) -> Result<S, Error> {
        audit::distance(self.metric, a, b)
    }

    /// Squared distance of two points, for comparisons; NaN where the metric says so.
    pub(crate) fn square(&self, a: usize, b: usize) -> f64 {
        match self.metric.places() {
            Some(places) => squared_distance(places.point(a), places.point(b)),
            None => self.metric.distance(a, b).as_f64().powi(2),
        }
    }

    /// Checks on the data at hand that the metric obeys its laws and that the oracle serves it, `eps`
    /// being the radius of the neighborhoods that will be asked for. The metric comes first: an oracle
    /// cannot answer well for a metric that is none.
    ///
    /// # Errors
    /// [`Error::Shape`] for numbers of points that differ, [`Error::Law`] for what is broken, put to the
    /// metric or to the oracle.
    pub fn audit(&self, eps: f64) -> Result<(), Error> {
        self.audit_metric()?;
        audit::oracle(self.oracle, self.metric, eps)
    }

    /// The part of [`audit`](Self::audit) that looks at the metric.
    ///
    /// # Errors
    /// Those of [`audit`](Self::audit).
    pub fn audit_metric(&self) -> Result<(), Error> {
        let count = self.len();
        if let Some(places) = self.places.filter(|p| p.len() != count) {
            return Err(Error::Shape {
                found: format!("coordinates of {} points", places.len()),
                expected: format!("{count}, as many as the metric {} has", self.metric.name()),
            });
        }
        audit::metric(self.metric, self.oracle)
    }

    /// Whether both ask the same metric and the same oracle; what was found of one then holds for the other.
    pub(crate) fn is_same_as(&self, other: &Self) -> bool {
        // What has no size has no place of its own.
        let [a, b] = [self, other].map(|space| (space.metric, space.oracle));
        size_of_val(a.0) > 0
            && size_of_val(a.1) > 0
            && std::ptr::addr_eq(a.0, b.0)
            && std::ptr::addr_eq(a.1, b.1)
    }

    /// What an oracle told, if all of it are distances.
    ///
    /// # Errors
    /// [`Error::Law`], put to the metric, for the first that is NaN or negative.
    pub(crate) fn sound(&self, center: usize, near: &[Neighbor<S>]) -> Result<(), Error> {
        match near
            .iter()
            .find(|x| x.distance < S::zero() || x.distance.as_f64().is_nan())
        {
            None => Ok(()),
            Some(x) => self.distance(center, x.index).map(|_| ()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::metric::{BruteForceOracle, Euclidean, GivenDistances};
    use crosscap_core::Row;
    use proptest::prelude::*;

    /// The nearest others of every point, by a space.
    fn nearest(space: &Space<'_, f64>, margin: f64) -> Vec<Vec<Row>> {
        let rows: Vec<Row> = (0..space.len()).map(Row::new).collect();
        let search = NearestOfEach::new(space, &rows, margin);
        let found = search.each(&|_| true, &Serial, |row, near| {
            let mut near = near.to_vec();
            near.sort_unstable();
            (row, near)
        });
        let mut found = found.unwrap();
        found.sort_unstable();
        found.into_iter().map(|x| x.1).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn a_tree_and_the_metric_alone_join_the_same_points(
            places in prop::collection::vec(-1.0_f64..1.0, 2 * 80),
            margin in prop_oneof![Just(1e-3), Just(10.0)],
        ) {
            let cloud = PointCloud::new(2, places).unwrap();
            let n = cloud.len();
            let straight = Euclidean::new(cloud.clone());
            let by_tree = BruteForceOracle::new(&straight);
            let matrix = (0..n * n).map(|k| straight.distance(k / n, k % n)).collect();
            let given = GivenDistances::new(n, matrix).unwrap();
            let by_scan = BruteForceOracle::new(&given);
            let (one, two) = (Space::new(&straight, &by_tree), Space::new(&given, &by_scan));
            prop_assert!(one.is_straight() && !two.is_straight());
            prop_assert_eq!(nearest(&one, margin), nearest(&two, margin));
        }
    }

    #[test]
    fn a_distance_that_is_no_number_is_the_metric_s_fault() {
        struct Far(Euclidean<f64>);
        impl MetricSpace for Far {
            type Scalar = f64;
            fn len(&self) -> usize {
                self.0.len()
            }
            fn distance(&self, a: usize, b: usize) -> f64 {
                let d = self.0.distance(a, b);
                if d > 10.0 { f64::NAN } else { d }
            }
            fn name(&self) -> &str {
                "far"
            }
        }
        let line = (0..40).map(f64::from).collect();
        let metric = Far(Euclidean::new(PointCloud::new(1, line).unwrap()));
        let oracle = BruteForceOracle::new(&metric);
        let space = Space::new(&metric, &oracle);
        let law = |error| matches!(error, Error::Law { plugin, law, .. } if plugin == "far" && law == "never NaN");
        assert!(law(space.audit(2.0).unwrap_err()));
        assert!(law(space.distance(0, 39).unwrap_err()));
        // The ends of the line have fewer than twelve others at a distance that is a number.
        let rows: Vec<Row> = (0..40).map(Row::new).collect();
        let found = NearestOfEach::new(&space, &rows, 1.0).each(&|_| true, &Serial, |_, _| ());
        assert!(law(found.unwrap_err()));
        assert_eq!(space.distance(3, 5), Ok(2.0));
    }
}
