//! What an estimator says of all balls of a cloud together.

use crate::execute::Serial;
use crate::laws::inputs::flat_samples;
use crate::laws::reference::{Scan, StraightLine, rounding};
use crate::laws::trial::{Outcome, ensure};
use crate::{
    BallDimension, Balls, DimensionEstimator, Error, MetricSpace, PointCloud, Radii, Scalar,
};
use proptest::prelude::*;
use std::sync::Mutex;

/// Straight-line distances that say so.
struct Placed<S>(StraightLine<S>);

impl<S: Scalar> MetricSpace for Placed<S> {
    type Scalar = S;
    fn len(&self) -> usize {
        self.0.len()
    }
    fn distance(&self, a: usize, b: usize) -> S {
        self.0.distance(a, b)
    }
    fn places(&self) -> Option<&PointCloud<S>> {
        Some(&self.0.0)
    }
    fn name(&self) -> &str {
        "straight line"
    }
}

/// All balls of a cloud: of one radius or of `each` its own, by distances along straight lines or by half of them,
/// which belong to no places.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    cloud: PointCloud<f64>,
    radius: f64,
    each: bool,
    straight: bool,
}

pub(super) fn batches() -> impl Strategy<Value = Batch> {
    (flat_samples(), 0.3..3.0_f64, any::<bool>(), any::<bool>()).prop_map(
        |(sample, radius, each, straight)| Batch {
            cloud: sample.cloud,
            radius,
            each,
            straight,
        },
    )
}

/// The law of the same name: all balls together and one by one.
pub(super) fn batch<S: Scalar>(
    estimator: &dyn DimensionEstimator<Scalar = S>,
    asked: &Batch,
) -> Outcome {
    let cloud = &asked.cloud;
    let places = cloud.cast::<S>();
    let half = cloud.coordinates().iter().map(|x| S::of(0.5 * x)).collect();
    let half = PointCloud::new(cloud.dimension(), half).map_err(|e| e.to_string())?;
    let placed = Placed(StraightLine(places.clone()));
    let halved = StraightLine(half);
    let (near_placed, near_halved) = (Scan(&placed), Scan(&halved));
    let radii: Vec<f64> = (0..cloud.len())
        .map(|k| asked.radius * (1.0 - 0.5 / (k + 1) as f64))
        .collect();
    let balls = Balls {
        metric: if asked.straight { &placed } else { &halved },
        oracle: if asked.straight {
            &near_placed
        } else {
            &near_halved
        },
        cloud: Some(&places),
        radii: if asked.each {
            Radii::Each(&radii)
        } else {
            Radii::Same(asked.radius)
        },
        least: 4,
    };
    let confidence: Mutex<Vec<f64>> = Mutex::new(Vec::new());
    let alone = balls.one_by_one(estimator.name(), &Serial, |ball| {
        let answer = estimator.estimate(ball)?;
        if let Ok(mut list) = confidence.lock() {
            list.push(answer.confidence);
        }
        Ok(answer)
    });
    let together = estimator.estimate_all(&balls, &Serial).and_then(|found| {
        let counts = found.iter().map(|ball| ball.neighbors as usize);
        let enough = counts.enumerate().try_for_each(|(k, n)| balls.enough(k, n));
        enough.map(|()| found)
    });
    let confidence = confidence.lock().map_or(Vec::new(), |list| list.clone());
    agree::<S>(alone, together, &confidence)
}

/// Answers of each ball alone, with their confidence, and of all together.
fn agree<S: Scalar>(
    alone: Result<Vec<BallDimension>, Error>,
    together: Result<Vec<BallDimension>, Error>,
    confidence: &[f64],
) -> Outcome {
    let (alone, together) = match (alone, together) {
        (Ok(alone), Ok(together)) => (alone, together),
        (Err(_), Err(_)) => return Ok(()),
        (Ok(_), Err(e)) => return Err(format!("each ball has an answer, all together: '{e}'")),
        (Err(e), Ok(_)) => return Err(format!("all together have answers, alone: '{e}'")),
    };
    ensure!(
        together.len() == alone.len(),
        "{} answers for {} balls",
        together.len(),
        alone.len()
    );
    let tolerance = 32.0 * rounding::<S>().sqrt();
    for (k, (a, b)) in alone.iter().zip(&together).enumerate() {
        // A toss-up may fall either way.
        let toss_up = confidence.get(k).is_some_and(|&c| c < tolerance);
        let counted = b.dimension == 2 || a.neighbors == b.neighbors;
        ensure!(
            toss_up || a.dimension == b.dimension && counted,
            "the ball about point {k}: {a:?} alone, {b:?} of all together"
        );
    }
    Ok(())
}
