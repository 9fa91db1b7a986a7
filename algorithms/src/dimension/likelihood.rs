//! Dimension by maximum likelihood.

use super::decision::decide;
use super::global::{GlobalDimension, GlobalEstimator, Scale, WholeCloud};
use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighbor, Neighborhood, Scalar};
use std::marker::PhantomData;

/// Fewest points of a neighborhood, the center among them.
const LEAST: usize = 4;

/// The dimension under which the distances from the center are likeliest (E. Levina and P. Bickel,
/// *Maximum likelihood estimation of intrinsic dimension*, NIPS 17, 2005).
///
/// In a neighborhood of radius R with N points at distances T_j from the center (their equation 7)
/// the inverse of the value is the mean of log(R / T_j); among the k nearest (equation 8) R is T_k and
/// the mean is over the k - 1 others. The standard error is the value over the square root of the number
/// of terms. Copies of the center, at distance 0, are left out: they tell about the sampling, not
/// about the dimension.
///
/// Over a whole cloud the *inverses* are averaged over the points, which is the maximum of the joint
/// likelihood; averaging the values themselves is biased upwards for small k (D. MacKay and
/// Z. Ghahramani, *Comments on "Maximum likelihood estimation of intrinsic dimension"*, 2005).
/// Its standard error is that of a mean over n / 2 points: each pair of neighbors is seen from both ends.
///
/// # Limits
/// Too small beside an edge and where the surface turns within the neighborhood. Many points are needed in
/// high dimension: the number grows with the exponent d. Needs distances alone.
///
/// ```
/// use crosscap_algorithms::dimension::MaximumLikelihood;
/// use crosscap_algorithms::metric::Euclidean;
/// use crosscap_core::{DimensionEstimator, Neighbor, Neighborhood, PointCloud};
/// // 0, 0.1, 0.2, ..., 1: a line.
/// let cloud = PointCloud::new(1, (0..=10).map(|k| f64::from(k) / 10.0).collect()).unwrap();
/// let neighbors: Vec<_> = (0..=10)
///     .map(|index| Neighbor { index, distance: cloud.point(index)[0] })
///     .collect();
/// let metric = Euclidean::new(cloud);
/// let found = MaximumLikelihood::new()
///     .estimate(&Neighborhood { center: 0, radius: 1.05, neighbors: &neighbors, metric: &metric, cloud: None })
///     .unwrap();
/// assert_eq!(found.dimension, 1);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct MaximumLikelihood<S> {
    scalar: PhantomData<S>,
}

impl<S: Scalar> MaximumLikelihood<S> {
    /// The estimator; it has no parameters.
    pub fn new() -> Self {
        Self {
            scalar: PhantomData,
        }
    }
}

/// The inverse of the dimension at a center, and the number of terms that it is the mean of; no term
/// where all points are copies of the center.
fn inverse<S: Scalar>(center: usize, radius: f64, neighbors: &[Neighbor<S>]) -> (f64, usize) {
    let others = || {
        neighbors
            .iter()
            .filter(|x| x.index != center)
            .map(|x| x.distance.as_f64())
            .filter(|&t| t > 0.0)
    };
    let count = others().count();
    let (reach, terms) = if radius.is_finite() {
        (radius, count)
    } else {
        // The farthest one is the radius, and says nothing itself.
        (others().last().unwrap_or(0.0), count.saturating_sub(1))
    };
    if terms == 0 {
        return (0.0, 0);
    }
    let sum: f64 = others().map(|t| (reach / t).ln()).sum();
    (sum / terms as f64, terms)
}

impl<S: Scalar> DimensionEstimator for MaximumLikelihood<S> {
    type Scalar = S;

    fn estimate(&self, near: &Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> {
        let found = near.neighbors.len();
        if found < LEAST {
            return Err(Error::SparseNeighborhood {
                point: near.center,
                found,
                needed: LEAST,
                parameter: "eps",
            });
        }
        let (inverse, terms) = inverse(near.center, near.radius, near.neighbors);
        if terms == 0 {
            return Ok(decide(0.0, 0.0, found - 1));
        }
        let value = 1.0 / inverse;
        Ok(decide(value, value / (terms as f64).sqrt(), found - 1))
    }

    fn name(&self) -> &str {
        "mle"
    }
}

impl<S: Scalar> GlobalEstimator<S> for MaximumLikelihood<S> {
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error> {
        space.check(2 * LEAST)?;
        let radius = match space.scale {
            Scale::Nearest(_) => f64::INFINITY,
            Scale::Within(r) => r,
        };
        let local = space.map(Vec::new, |near, i| {
            space.neighborhood(i, near);
            let nearest = near.iter().map(|x| x.distance.as_f64()).find(|&d| d > 0.0);
            let farthest = near.last().map_or(0.0, |x| x.distance.as_f64());
            let (inverse, terms) = inverse(i, radius, near);
            (inverse, terms, nearest.unwrap_or(f64::INFINITY), farthest)
        });
        let used: Vec<_> = local.iter().filter(|x| x.1 > 0).collect();
        if 2 * used.len() < space.len() {
            let point = local.iter().position(|x| x.1 == 0).unwrap_or(0);
            return Err(Error::SparseNeighborhood {
                point,
                found: 1,
                needed: 2,
                parameter: space.scale.parameter(),
            });
        }
        let count = used.len() as f64;
        let mean = used.iter().map(|x| x.0).sum::<f64>() / count;
        let variance = used.iter().map(|x| (x.0 - mean).powi(2)).sum::<f64>() / count;
        let independent = 0.5 * count;
        let value = 1.0 / mean;
        // The derivative of 1/x is -1/x^2.
        let error = value * value * (variance / independent).sqrt();
        let nearest = used.iter().map(|x| x.2).fold(f64::INFINITY, f64::min);
        let farthest = used.iter().map(|x| x.3).fold(0.0, f64::max);
        let scales = [nearest, if radius.is_finite() { radius } else { farthest }];
        Ok(GlobalDimension::new(
            value,
            error,
            space.most(),
            scales,
            used.len(),
        ))
    }
}
