//! The balls about all points of a space, for estimators that answer for all of them together.

use crate::execute::{self, Execute};
use crate::{
    DimensionEstimate, Error, MetricSpace, Neighborhood, NeighborhoodOracle, PointCloud, Scalar,
};

/// Radii of the balls about the points of a space, strict, in the unit of the data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radii<'a> {
    /// One for all.
    Same(f64),
    /// One a point.
    Each(&'a [f64]),
}

impl Radii<'_> {
    /// Radius of the ball about a point.
    pub fn of(&self, point: usize) -> f64 {
        match self {
            Self::Same(radius) => *radius,
            Self::Each(radii) => radii[point],
        }
    }
}

/// The balls about all points of a space.
#[derive(Clone, Copy)]
pub struct Balls<'a, S: Scalar> {
    /// Distances. Where they are those of straight lines between places, the metric
    /// [names the places](MetricSpace::places), and whoever has a structure over places may use it.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// The neighborhoods in that metric.
    pub oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    /// Coordinates, where the space has any. They need not belong to the metric.
    pub cloud: Option<&'a PointCloud<S>>,
    /// How large the balls are.
    pub radii: Radii<'a>,
    /// Fewest points, the center among them, that a ball must hold.
    pub least: usize,
}

/// How many points a ball holds, and of what dimension it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BallDimension {
    /// Points in the ball, its center among them. Where the dimension is 2, the most common case by far, the
    /// number may be that of a ball close by.
    pub neighbors: u32,
    /// The dimension, as a whole number.
    pub dimension: u32,
}

impl<S: Scalar> Balls<'_, S> {
    /// Number of balls.
    pub fn len(&self) -> usize {
        self.metric.len()
    }

    /// Whether there is no ball.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether so many points are enough for the ball about `point`.
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] where they are not.
    pub fn enough(&self, point: usize, found: usize) -> Result<(), Error> {
        if found >= self.least {
            return Ok(());
        }
        Err(Error::SparseNeighborhood {
            point,
            found,
            needed: self.least,
            parameter: "eps",
        })
    }

    /// Asks `estimate` about one ball after another, on the threads of `execute`, and checks every answer.
    /// `plugin` is the name of whoever answers.
    ///
    /// # Errors
    /// The first in the order of the points: a ball with too few points, what `estimate` fails with, or an answer
    /// that cannot be used ([`DimensionEstimate::check`]).
    pub fn one_by_one(
        &self,
        plugin: &str,
        execute: &dyn Execute,
        estimate: impl Fn(&Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> + Sync,
    ) -> Result<Vec<BallDimension>, Error> {
        let answers = execute::map(execute, self.len(), Vec::new, |neighbors, center| {
            let radius = self.radii.of(center);
            self.oracle.within(center, S::of(radius), neighbors);
            self.enough(center, neighbors.len())?;
            let answer = estimate(&Neighborhood {
                center,
                radius,
                neighbors,
                metric: self.metric,
                cloud: self.cloud,
            })?;
            answer.check(plugin, center, neighbors.len())?;
            Ok(BallDimension {
                neighbors: neighbors.len() as u32,
                dimension: answer.dimension as u32,
            })
        });
        answers.into_iter().collect()
    }
}
