//! Dimension by principal component analysis with a tolerance.

use super::global::{GlobalDimension, GlobalEstimator, WholeCloud};
use crate::moments::MomentTree;
use crate::principal::PrincipalFrame;
use crate::spectrum::VarianceTolerance;
use crosscap_core::execute::Execute;
use crosscap_core::{
    BallDimension, Balls, DimensionEstimate, DimensionEstimator, Error, Neighborhood, Radii, Scalar,
};
use std::marker::PhantomData;

/// The smallest d for which the variances after the d-th are less than the share `dt` of all
/// (Martin & Watson 2011, section 2.1).
///
/// ```
/// use crosscap_algorithms::dimension::PrincipalComponents;
/// let estimator = PrincipalComponents::<f64>::new(0.05).unwrap();
/// let (dimension, _, confidence) = estimator.dimension_of(&[1.0, 0.9, 0.01]);
/// assert_eq!(dimension, 2);
/// assert!(confidence > 0.5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PrincipalComponents<S> {
    tolerance: VarianceTolerance,
    scalar: PhantomData<S>,
}

impl<S: Scalar> PrincipalComponents<S> {
    /// Estimator with tolerance `dt`, a share of the total variance (strict).
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `0 < dt < 1`.
    pub fn new(dt: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: VarianceTolerance::new(dt)?,
            scalar: PhantomData,
        })
    }

    /// Dimension of a spectrum of variances, largest first, with its value (the dimension
    /// as a number) and its confidence: how far the deciding shares are from `dt`, on a
    /// logarithmic scale, 1 from a factor of ten on.
    pub fn dimension_of(&self, variances: &[f64]) -> (usize, f64, f64) {
        self.tolerance.dimension_of(variances)
    }
}

impl<S: Scalar> DimensionEstimator for PrincipalComponents<S> {
    type Scalar = S;

    fn estimate(&self, neighborhood: &Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> {
        let cloud = neighborhood.cloud.ok_or_else(|| Error::Shape {
            found: "distances without coordinates".into(),
            expected: "coordinates, principal component analysis needs them".into(),
        })?;
        if neighborhood.neighbors.len() < 3 {
            return Err(Error::SparseNeighborhood {
                point: neighborhood.center,
                found: neighborhood.neighbors.len(),
                needed: 3,
                parameter: "eps",
            });
        }
        let frame = PrincipalFrame::of(cloud, neighborhood.neighbors.iter().map(|x| x.index));
        let (dimension, value, confidence) = self.dimension_of(&frame.variances);
        Ok(DimensionEstimate {
            dimension,
            value,
            confidence,
            spectrum: frame.variances,
        })
    }

    /// Where distances are straight lines and balls are of one size, from the moments of a search tree
    /// ([`MomentTree::settled_dimensions`]).
    fn estimate_all(
        &self,
        balls: &Balls<'_, S>,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        match (balls.metric.places(), balls.radii) {
            (Some(places), Radii::Same(radius)) => {
                let tree = MomentTree::with(places, execute)?;
                tree.settled_dimensions(radius, self.tolerance.share(), execute)
            }
            _ => balls.one_by_one(self.name(), execute, |ball| self.estimate(ball)),
        }
    }

    fn of_variances(&self, variances: &[f64]) -> Option<DimensionEstimate> {
        let (dimension, value, confidence) = self.dimension_of(variances);
        Some(DimensionEstimate {
            dimension,
            value,
            confidence,
            spectrum: variances.to_vec(),
        })
    }

    fn name(&self) -> &str {
        "pca"
    }
}

impl<S: Scalar> GlobalEstimator<S> for PrincipalComponents<S> {
    /// The dimension of the flat that holds the cloud but for the share dt of its variance: one more
    /// than that of a round sphere. The scale of the space is not used.
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error> {
        let cloud = space.cloud.ok_or_else(|| Error::Shape {
            found: "distances without coordinates".into(),
            expected: "coordinates, principal component analysis needs them".into(),
        })?;
        if cloud.len() < 3 {
            return Err(Error::Shape {
                found: format!("{} points", cloud.len()),
                expected: "at least 3, to tell the dimension of a cloud".into(),
            });
        }
        let frame = PrincipalFrame::of(cloud, 0..cloud.len());
        let (dimension, value, confidence) = self.dimension_of(&frame.variances);
        Ok(GlobalDimension {
            dimension,
            value,
            standard_error: None,
            confidence,
            scales: [0.0, f64::INFINITY],
            points: cloud.len(),
        })
    }
}
