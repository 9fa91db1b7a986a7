//! What is asked of an estimator about one neighborhood, and how the answers must hang together.

use crate::laws::inputs::ranks;
use crate::laws::motion::{Motion, principal};
use crate::laws::reference::{StraightLine, rounding, sort};
use crate::laws::trial::{Outcome, ensure};
use crate::{
    DimensionEstimate, DimensionEstimator, Error, MetricSpace, Neighbor, Neighborhood, PointCloud,
    Scalar,
};

/// The neighborhood of the first point that holds all.
struct Ball<S> {
    metric: StraightLine<S>,
    center: usize,
    radius: f64,
    neighbors: Vec<Neighbor<S>>,
}

impl<S: Scalar> Ball<S> {
    fn new(cloud: &PointCloud<f64>, center: usize) -> Self {
        let metric = StraightLine(cloud.cast::<S>());
        let mut neighbors: Vec<Neighbor<S>> = (0..metric.len())
            .map(|index| Neighbor {
                index,
                distance: metric.distance(center, index),
            })
            .collect();
        sort(&mut neighbors);
        let farthest = neighbors.last().map_or(0.0, |n| n.distance.as_f64());
        Self {
            metric,
            center,
            // Strict, and in proportion to the data.
            radius: farthest * 1.001,
            neighbors,
        }
    }

    fn estimate(
        &self,
        estimator: &dyn DimensionEstimator<Scalar = S>,
    ) -> Result<DimensionEstimate, Error> {
        estimator.estimate(&Neighborhood {
            center: self.center,
            radius: self.radius,
            neighbors: &self.neighbors,
            metric: &self.metric,
            cloud: Some(&self.metric.0),
        })
    }
}

/// Whether two estimates are the same within rounding.
fn same<S: Scalar>(
    before: &Result<DimensionEstimate, Error>,
    after: &Result<DimensionEstimate, Error>,
) -> Outcome {
    let tolerance = 32.0 * rounding::<S>().sqrt();
    match (before, after) {
        (Ok(a), Ok(b)) => {
            // A toss-up may fall either way.
            let toss_up = a.confidence.min(b.confidence) < tolerance;
            let close = |x: f64, y: f64| (x - y).abs() <= tolerance * (1.0 + x.abs());
            let alike = a.dimension == b.dimension && close(a.value, b.value);
            ensure!(
                toss_up || alike && close(a.confidence, b.confidence),
                "dimension {}, value {}, confidence {} became {}, {}, {}",
                a.dimension,
                a.value,
                a.confidence,
                b.dimension,
                b.value,
                b.confidence
            );
        }
        (Err(a), Err(b)) => {
            let kind = std::mem::discriminant;
            ensure!(kind(a) == kind(b), "'{a}' became '{b}'");
        }
        (Ok(a), Err(b)) => return Err(format!("dimension {} became '{b}'", a.dimension)),
        (Err(a), Ok(b)) => return Err(format!("'{a}' became dimension {}", b.dimension)),
    }
    Ok(())
}

/// Which part of a motion and of a factor is applied.
#[derive(Clone, Copy)]
pub(super) enum Change {
    /// The motion alone.
    Motion,
    /// The factor alone.
    Scale,
}

impl Change {
    /// The motion and the factor, a power of ten.
    pub fn of(self, motion: &Motion, exponent: i32) -> (Motion, f64) {
        match self {
            Self::Motion => (motion.clone(), 1.0),
            Self::Scale => {
                let still = Motion {
                    angles: vec![],
                    reflected: false,
                    shift: vec![],
                };
                (still, 10_f64.powi(exponent))
            }
        }
    }
}

/// An estimator that is tried on one neighborhood after another.
pub(super) struct One<'e, S> {
    pub estimator: &'e dyn DimensionEstimator<Scalar = S>,
}

impl<S: Scalar> One<'_, S> {
    fn ask(&self, cloud: &PointCloud<f64>, center: usize) -> Result<DimensionEstimate, Error> {
        Ball::new(cloud, center).estimate(self.estimator)
    }

    /// The law of the same name; so are those that follow.
    pub fn answer(&self, cloud: &PointCloud<f64>) -> Outcome {
        let ball = Ball::new(cloud, 0);
        let first = ball.estimate(self.estimator);
        if let Ok(estimate) = &first {
            let DimensionEstimate {
                value, confidence, ..
            } = estimate;
            ensure!(*value >= 0.0 && value.is_finite(), "the value is {value}");
            ensure!(
                (0.0..=1.0).contains(confidence),
                "the confidence is {confidence}"
            );
        }
        let again = ball.estimate(self.estimator);
        ensure!(first == again, "asked twice: {first:?}, then {again:?}");
        Ok(())
    }

    pub fn rounded(&self, cloud: &PointCloud<f64>) -> Outcome {
        if let Ok(found) = self.ask(cloud, 0) {
            let DimensionEstimate {
                dimension, value, ..
            } = found;
            ensure!(
                (value - dimension as f64).abs() <= 0.5 + 1e-6,
                "dimension {dimension} for the value {value}"
            );
        }
        Ok(())
    }

    /// Motion, scale and embedding: in a space of `more` dimensions more.
    pub fn moved(
        &self,
        cloud: &PointCloud<f64>,
        (motion, factor): &(Motion, f64),
        more: usize,
    ) -> Outcome {
        let image = motion.image(cloud, cloud.dimension() + more, *factor);
        same::<S>(&self.ask(cloud, 0), &self.ask(&image, 0))
    }

    /// Order: the points sorted by their keys.
    pub fn reordered(&self, cloud: &PointCloud<f64>, keys: &[u16]) -> Outcome {
        let order = ranks(&keys[..cloud.len()]);
        let center = order.iter().position(|&k| k == 0).unwrap_or(0);
        same::<S>(
            &self.ask(cloud, 0),
            &self.ask(&cloud.select(&order), center),
        )
    }

    pub fn variances(&self, cloud: &PointCloud<f64>) -> Outcome {
        let rounded = cloud.cast::<S>().cast::<f64>();
        let (n, count) = (cloud.dimension(), cloud.len());
        let rows = principal(n, rounded.coordinates(), count);
        let variance = |axis: usize| {
            let along = rows.iter().skip(axis).step_by(n);
            along.map(|x| x * x).sum::<f64>() / count as f64
        };
        let variances: Vec<f64> = (0..n).map(variance).collect();
        match self.estimator.of_variances(&variances) {
            Some(answer) => same::<S>(&self.ask(cloud, 0), &Ok(answer))
                .map_err(|e| format!("{e}, from the variances {variances:?}")),
            None => Ok(()),
        }
    }
}
