//! The dimension of a whole cloud.

use super::decision::{confidence, decide};
use crate::execute::Execute;
use crate::locality;
use crosscap_core::{
    DimensionEstimate, DimensionEstimator, Error, MetricSpace, Neighbor, Neighborhood,
    NeighborhoodOracle, PointCloud, Scalar, positive_length,
};

/// At which distances a dimension is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Up to so many nearest neighbors of a point, itself not counted.
    Nearest(usize),
    /// Up to this distance (strict), unit of the data.
    Within(f64),
}

impl Scale {
    /// Checks that the scale has a meaning.
    ///
    /// # Errors
    /// [`Error::Parameter`] for fewer than 4 neighbors or a radius that is not positive.
    pub fn check(&self) -> Result<(), Error> {
        match *self {
            Self::Nearest(k) if k < 4 => Err(Error::Parameter {
                name: "k",
                value: k.to_string(),
                expected: "at least 4 neighbors".into(),
            }),
            Self::Nearest(_) => Ok(()),
            Self::Within(r) => positive_length("eps", r).map(drop),
        }
    }

    /// The parameter that sets it.
    pub fn parameter(&self) -> &'static str {
        match self {
            Self::Nearest(_) => "k",
            Self::Within(_) => "eps",
        }
    }
}

/// A cloud with all that an estimator of it may ask.
pub struct WholeCloud<'a, S: Scalar> {
    /// The metric.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// Neighborhoods in that metric.
    pub oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    /// Coordinates, where the space has any.
    pub cloud: Option<&'a PointCloud<S>>,
    /// At which distances the dimension is read.
    pub scale: Scale,
    /// What runs the points.
    pub execute: &'a dyn Execute,
}

impl<S: Scalar> WholeCloud<'_, S> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.oracle.len()
    }

    /// What `work` makes of every point, by row, with a workspace for each thread.
    pub(super) fn map<T: Send + Sync, C>(
        &self,
        scratch: impl Fn() -> C + Sync,
        work: impl Fn(&mut C, usize) -> T + Sync,
    ) -> Vec<T> {
        locality::map(self.execute, self.cloud, self.oracle.len(), scratch, work)
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The dimension at every point, by an estimator of neighborhoods; `None` where a neighborhood holds too
    /// few points for it.
    ///
    /// # Errors
    /// The first error that is not [`Error::SparseNeighborhood`]; that one too when no point has an answer.
    pub fn local(
        &self,
        estimator: &dyn DimensionEstimator<Scalar = S>,
    ) -> Result<Vec<Option<DimensionEstimate>>, Error> {
        match self.local_where(estimator, &|_| true)? {
            (answers, Some(sparse)) if answers.iter().all(Option::is_none) => Err(sparse),
            (answers, _) => Ok(answers),
        }
    }

    /// The same at the points that are `wanted`, `None` at all others; and why the first that is wanted and has no answer has none.
    ///
    /// # Errors
    /// The first error that is not [`Error::SparseNeighborhood`].
    pub fn local_where(
        &self,
        estimator: &dyn DimensionEstimator<Scalar = S>,
        wanted: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<(Vec<Option<DimensionEstimate>>, Option<Error>), Error> {
        self.scale.check()?;
        let radius = match self.scale {
            Scale::Nearest(_) => f64::INFINITY,
            Scale::Within(r) => r,
        };
        let found = self.map(Vec::new, |near, center| {
            if !wanted(center) {
                return Ok(None);
            }
            self.neighborhood(center, near);
            let neighborhood = Neighborhood {
                center,
                radius,
                neighbors: near,
                metric: self.metric,
                cloud: self.cloud,
            };
            estimator.estimate(&neighborhood).map(Some)
        });
        let mut sparse = None;
        let mut answers = Vec::with_capacity(found.len());
        for answer in found {
            answers.push(match answer {
                Ok(estimate) => estimate,
                Err(error @ Error::SparseNeighborhood { .. }) => {
                    sparse.get_or_insert(error);
                    None
                }
                Err(error) => return Err(error),
            });
        }
        Ok((answers, sparse))
    }

    /// Writes the neighborhood of `i` at the scale into `out`, nearest first, `i` among them.
    pub(super) fn neighborhood(&self, i: usize, out: &mut Vec<Neighbor<S>>) {
        match self.scale {
            Scale::Nearest(k) => self.oracle.nearest(i, k + 1, out),
            Scale::Within(r) => self.oracle.within(i, S::of(r), out),
        }
    }

    /// Refuses a scale without a meaning, and fewer than `needed` points.
    pub(super) fn check(&self, needed: usize) -> Result<(), Error> {
        self.scale.check()?;
        if self.len() < needed {
            return Err(Error::Shape {
                found: format!("{} points", self.len()),
                expected: format!("at least {needed}, to tell the dimension of a cloud"),
            });
        }
        Ok(())
    }

    /// Most dimensions that an answer can have.
    pub(super) fn most(&self) -> usize {
        let points = self.len().saturating_sub(1);
        self.cloud.map_or(points, |c| c.dimension().min(points))
    }
}

/// The dimension of a cloud with its evidence.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GlobalDimension {
    /// The estimate as a whole number.
    pub dimension: usize,
    /// The estimate before rounding.
    pub value: f64,
    /// Standard error of the value; none for estimators that count.
    pub standard_error: Option<f64>,
    /// 0 for a toss-up to 1, see [the module](super).
    pub confidence: f64,
    /// Smallest and largest distance that it was read at, unit of the data; the second is infinite
    /// where the cloud was taken as a whole.
    pub scales: [f64; 2],
    /// Number of points that it was read from.
    pub points: usize,
}

impl GlobalDimension {
    pub(super) fn new(
        value: f64,
        error: f64,
        most: usize,
        scales: [f64; 2],
        points: usize,
    ) -> Self {
        let DimensionEstimate {
            dimension, value, ..
        } = decide(value, error, most);
        Self {
            dimension,
            value,
            standard_error: Some(error),
            confidence: confidence(value, error),
            scales,
            points,
        }
    }
}

/// Estimates one dimension for a whole cloud.
pub trait GlobalEstimator<S: Scalar>: Sync {
    /// The dimension of the set that the cloud was sampled from.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a scale without a meaning, [`Error::Shape`] for too few points or for
    /// missing coordinates, [`Error::SparseNeighborhood`] where the scale finds no neighbors.
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error>;
}

/// The middle value, the mean of the two middle ones for an even number of them.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[half],
        _ => 0.5 * (values[half - 1] + values[half]),
    }
}
