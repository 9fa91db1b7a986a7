//! Local dimensions, and where they come from.

use super::fitter::{Fitter, Scratch, View};
use crate::audit;
use crate::moments::LocalDimension;
use crate::principal::PrincipalFrame;
use crosscap_core::{DimensionEstimator, Error, Neighbor, Neighborhood, Scalar};

/// Where local dimensions come from: an estimator, which may have answered for the balls of the analysis
/// beforehand.
#[derive(Clone, Copy)]
pub struct Dimensions<'a, S: Scalar> {
    estimator: &'a dyn DimensionEstimator<Scalar = S>,
    known: Option<&'a [LocalDimension]>,
}

impl<'a, S: Scalar> Dimensions<'a, S> {
    /// From an estimator, asked neighborhood by neighborhood.
    pub fn by(estimator: &'a dyn DimensionEstimator<Scalar = S>) -> Self {
        Self {
            estimator,
            known: None,
        }
    }

    /// What the estimator says of the balls of the analysis, one a point, computed for all of them
    /// together. Smaller balls are still asked of the estimator.
    pub fn with_known(self, known: &'a [LocalDimension]) -> Self {
        Self {
            known: Some(known),
            ..self
        }
    }

    /// The estimator.
    pub fn estimator(&self) -> &'a dyn DimensionEstimator<Scalar = S> {
        self.estimator
    }
}

impl<S: Scalar> Fitter<'_, S> {
    /// Number of points in the neighborhood of `i` and its dimension.
    pub(in crate::stratify) fn dimension_at(
        &self,
        i: usize,
        eps: f64,
        scratch: &mut Scratch<S>,
    ) -> Result<(usize, u8), Error> {
        let least = self.tuning.analysis.least_neighbors;
        let enough = |found: usize| {
            if found >= least {
                return Ok(found);
            }
            Err(Error::SparseNeighborhood {
                point: i,
                found,
                needed: least,
                parameter: "eps",
            })
        };
        let (neighbors, dimension) = match self.dimensions.known {
            Some(known) => {
                let known = known.get(i).ok_or_else(|| Error::Shape {
                    found: format!("{} known dimensions", known.len()),
                    expected: format!("{}, one a point", self.cloud.len()),
                })?;
                (enough(known.count as usize)?, known.dimension as usize)
            }
            None => {
                let near = &mut scratch.near;
                self.space.oracle().within(i, S::of(eps), near);
                let found = enough(near.len())?;
                (found, self.estimate(i, eps, near)?)
            }
        };
        Ok((neighbors, dimension.min(255) as u8))
    }

    /// What the estimator says of the points `near` around `i`.
    fn estimate(&self, i: usize, radius: f64, near: &[Neighbor<S>]) -> Result<usize, Error> {
        let estimator = self.dimensions.estimator;
        let estimate = estimator.estimate(&Neighborhood {
            center: i,
            radius,
            neighbors: near,
            metric: self.space.metric(),
            cloud: Some(self.cloud),
        })?;
        let space = self.cloud.dimension();
        audit::dimension(estimator.name(), i, &estimate, near.len(), space)
    }

    /// The dimension of a ball that is smaller than that of the analysis, by the same estimator; `None` where it
    /// has too few points for an answer.
    pub(super) fn dimension_of(&self, i: usize, view: &View) -> Option<usize> {
        self.dimension_by(i, view.radius, &view.frame, view.fitted)
    }

    /// The same for the inner part of a ball, of which `near` has the points that are fitted.
    pub(super) fn inner_dimension(
        &self,
        i: usize,
        radius: f64,
        near: &[Neighbor<S>],
    ) -> Option<usize> {
        let inner = near.iter().filter(|x| x.distance < S::of(radius));
        let rows = inner.map(|x| x.index);
        let count = rows.clone().count();
        self.dimension_by(i, radius, &PrincipalFrame::of(self.cloud, rows), count)
    }

    fn dimension_by(
        &self,
        i: usize,
        radius: f64,
        frame: &PrincipalFrame,
        points: usize,
    ) -> Option<usize> {
        let estimator = self.dimensions.estimator;
        if let Some(estimate) = estimator.of_variances(&frame.variances) {
            return Some(estimate.dimension);
        }
        if points == 0 {
            return None;
        }
        let mut near = Vec::new();
        self.space.oracle().within(i, S::of(radius), &mut near);
        match self.estimate(i, radius, &near) {
            Ok(dimension) => Some(dimension),
            Err(fault @ Error::Law { .. }) => {
                self.faults.add(i, fault);
                None
            }
            Err(_) => None,
        }
    }
}
