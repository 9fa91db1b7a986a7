//! Laws of [`DimensionEstimator`].

use super::inputs::{FlatSample, flat_samples, ranks};
use super::motion::{Motion, motions, principal};
use super::reference::{Scan, StraightLine, rounding, sort};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
use crate::execute::Serial;
use crate::{
    Balls, DimensionEstimate, DimensionEstimator, Error, MetricSpace, Neighbor, Neighborhood,
    PointCloud, Radii, Scalar,
};
use proptest::prelude::*;
use std::sync::Mutex;

const SUBJECT: &str = "DimensionEstimator";

/// An answer that can be used.
static ANSWER: Law = Law {
    subject: SUBJECT,
    name: "answer",
    says: "the value is finite and at least 0, the confidence between 0 and 1, the same question gets \
           the same answer; few points or copies of one point are refused or answered, without a panic",
    look_for: "the logarithm of a distance 0 (copies of the center); a division by the number of \
               neighbors minus one; a spectrum whose sum is 0; random numbers without a fixed seed",
};

/// A whole number.
static ROUNDED: Law = Law {
    subject: SUBJECT,
    name: "rounded",
    says: "the dimension is the value rounded",
    look_for: "a value that was left at its default (it equals the dimension for estimators that count); \
               rounding up or down where the nearest whole number is meant",
};

/// Motion.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "the same answer after a rigid motion, within rounding",
    look_for: "coordinates that are not centered; a fixed axis or grid (boxes that are counted); \
               random directions",
};

/// Scale.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the same answer after uniform scaling of data and radius",
    look_for: "a threshold in the unit of the data: make it a share of the radius or of the total; a \
               constant that guards a division",
};

/// Embedding.
static EMBEDDING: Law = Law {
    subject: SUBJECT,
    name: "embedding",
    says: "the same answer after an isometric embedding in a larger space",
    look_for: "the dimension of the space in a formula (a mean over coordinates, a share of N)",
};

/// Order.
static ORDER: Law = Law {
    subject: SUBJECT,
    name: "order",
    says: "the same answer for any order of the points, within rounding",
    look_for: "a subset picked by index (the first half, every second one): pick by distance, or all",
};

/// Variances.
static VARIANCES: Law = Law {
    subject: SUBJECT,
    name: "variances",
    says: "where of_variances answers, it says of the variances of a neighborhood what estimate says of the \
           neighborhood, within rounding",
    look_for: "an answer that depends on more than the variances (leave the default); variances taken for their \
               roots, or in rising order; a share of N where fewer variances than coordinates are given",
};

/// Batch.
static BATCH: Law = Law {
    subject: SUBJECT,
    name: "batch",
    says: "of all balls of a cloud together estimate_all says what estimate says of each, with the number of points in \
           it (where the dimension is 2 that of a ball close by will do), and refuses what estimate refuses",
    look_for: "a radius taken for all balls where each has its own; a ball that takes points at distance = radius; the \
               places of a metric that is not the straight line between them (ask MetricSpace::places, not the cloud); \
               answers in the order of a tree",
};

pub(super) static ALL: [&Law; 8] = [
    &ANSWER, &ROUNDED, &MOTION, &SCALE, &EMBEDDING, &ORDER, &VARIANCES, &BATCH,
];

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

/// Puts an estimator through its laws, on neighborhoods of 12 to 60 points of flat pieces of
/// dimension 1 to 4 with and without thickness, and on poor ones.
///
/// What it finds on which data is not judged here: that is for tests of its own.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighborhood};
/// /// Counts doublings: twice the radius, 2^d times the points.
/// struct Doubling;
/// impl DimensionEstimator for Doubling {
///     type Scalar = f64;
///     fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
///         let all = around.neighbors.len() as f64;
///         let inner = around.neighbors.iter().filter(|n| 2.0 * n.distance < around.radius).count();
///         let value = (all / inner.max(1) as f64).log2();
///         Ok(DimensionEstimate { dimension: value.round() as usize, value, ..Default::default() })
///     }
///     fn name(&self) -> &str { "doubling" }
/// }
/// laws::estimator(&Settings::default(), &Doubling).unwrap();
/// ```
pub fn estimator<D: DimensionEstimator>(
    settings: &Settings,
    estimator: &D,
) -> Result<(), Failures> {
    laws(settings, estimator)
}

/// The laws themselves, compiled once a type of coordinates and not for every estimator that is tested.
fn laws<S: Scalar>(
    settings: &Settings,
    estimator: &dyn DimensionEstimator<Scalar = S>,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    let usable = |estimate: &DimensionEstimate| -> Outcome {
        ensure!(
            estimate.value >= 0.0 && estimate.value.is_finite(),
            "the value is {}",
            estimate.value
        );
        ensure!(
            (0.0..=1.0).contains(&estimate.confidence),
            "the confidence is {}",
            estimate.confidence
        );
        Ok(())
    };
    let all_kinds = prop_oneof![
        super::inputs::clouds(1..=4, 1..=8),
        flat_samples().prop_map(|s| s.cloud)
    ];
    found.put(ANSWER.holds(settings, &all_kinds, |cloud| {
        let ball = Ball::new(cloud, 0);
        let first = ball.estimate(estimator);
        first.as_ref().map_or(Ok(()), usable)?;
        let again = ball.estimate(estimator);
        ensure!(first == again, "asked twice: {first:?}, then {again:?}");
        Ok(())
    }));
    found.put(ROUNDED.holds(settings, &all_kinds, |cloud| {
        if let Ok(found) = Ball::new(cloud, 0).estimate(estimator) {
            let DimensionEstimate {
                dimension, value, ..
            } = found;
            ensure!(
                (value - dimension as f64).abs() <= 0.5 + 1e-6,
                "dimension {dimension} for the value {value}"
            );
        }
        Ok(())
    }));
    let ask = |cloud: &PointCloud<f64>, center| Ball::new(cloud, center).estimate(estimator);
    let moved =
        |law: &'static Law, dimensions: usize, change: fn(&Motion, f64) -> (Motion, f64)| {
            let inputs = (flat_samples(), motions(), -6..=6_i32, 0..=dimensions);
            law.holds(settings, &inputs, |(sample, motion, exponent, more)| {
                let FlatSample { cloud, .. } = sample;
                let (motion, factor) = change(motion, 10_f64.powi(*exponent));
                let dimension = cloud.dimension() + more;
                let image = motion.image(cloud, dimension, factor);
                same::<S>(&ask(cloud, 0), &ask(&image, 0))
            })
        };
    let still = |_: &Motion, factor: f64| {
        let none = Motion {
            angles: vec![],
            reflected: false,
            shift: vec![],
        };
        (none, factor)
    };
    found.put(moved(&MOTION, 0, |motion, _| (motion.clone(), 1.0)));
    found.put(moved(&SCALE, 0, still));
    found.put(moved(&EMBEDDING, 6, |motion, _| (motion.clone(), 1.0)));
    let keys = prop::collection::vec(any::<u16>(), 60);
    found.put(
        ORDER.holds(settings, &(flat_samples(), keys), |(sample, keys)| {
            let cloud = &sample.cloud;
            let order = ranks(&keys[..cloud.len()]);
            let center = order.iter().position(|&k| k == 0).unwrap_or(0);
            same::<S>(&ask(cloud, 0), &ask(&cloud.select(&order), center))
        }),
    );
    found.put(VARIANCES.holds(settings, &flat_samples(), |sample| {
        let cloud = sample.cloud.cast::<S>().cast::<f64>();
        let (n, count) = (cloud.dimension(), cloud.len());
        let rows = principal(n, cloud.coordinates(), count);
        let variance = |axis: usize| {
            let along = rows.iter().skip(axis).step_by(n);
            along.map(|x| x * x).sum::<f64>() / count as f64
        };
        let variances: Vec<f64> = (0..n).map(variance).collect();
        match estimator.of_variances(&variances) {
            Some(answer) => same::<S>(&ask(&sample.cloud, 0), &Ok(answer))
                .map_err(|e| format!("{e}, from the variances {variances:?}")),
            None => Ok(()),
        }
    }));
    let inputs = (flat_samples(), 0.3..3.0_f64, any::<bool>(), any::<bool>());
    found.put(
        BATCH.holds(settings, &inputs, |(sample, radius, each, straight)| {
            batch(estimator, &sample.cloud, *radius, *each, *straight)
        }),
    );
    found.end()
}

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

/// All balls of a cloud together and one by one: of one radius or of `each` its own, by distances along straight
/// lines or by half of them, which belong to no places.
fn batch<S: Scalar>(
    estimator: &dyn DimensionEstimator<Scalar = S>,
    cloud: &PointCloud<f64>,
    radius: f64,
    each: bool,
    straight: bool,
) -> Outcome {
    let places = cloud.cast::<S>();
    let half = cloud.coordinates().iter().map(|x| S::of(0.5 * x)).collect();
    let half = PointCloud::new(cloud.dimension(), half).map_err(|e| e.to_string())?;
    let placed = Placed(StraightLine(places.clone()));
    let halved = StraightLine(half);
    let (near_placed, near_halved) = (Scan(&placed), Scan(&halved));
    let radii: Vec<f64> = (0..cloud.len())
        .map(|k| radius * (1.0 - 0.5 / (k + 1) as f64))
        .collect();
    let balls = Balls {
        metric: if straight { &placed } else { &halved },
        oracle: if straight { &near_placed } else { &near_halved },
        cloud: Some(&places),
        radii: if each {
            Radii::Each(&radii)
        } else {
            Radii::Same(radius)
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
    let confidence = confidence.lock().map_or(Vec::new(), |list| list.clone());
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

#[cfg(test)]
mod tests {
    use super::super::twins::{catches, quick};
    use super::*;
    use crate::BallDimension;
    use crate::execute::Execute;

    /// Reads the dimension off a number made from the neighborhood.
    struct Read(fn(&Neighborhood<'_, f64>) -> f64);

    impl DimensionEstimator for Read {
        type Scalar = f64;
        fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
            let value = (self.0)(around);
            Ok(DimensionEstimate {
                dimension: value.round() as usize,
                value,
                confidence: 1.0,
                spectrum: vec![],
            })
        }
        fn name(&self) -> &str {
            "read"
        }
    }

    /// Mean distance of the neighbors as a share of the radius, or what else of one.
    fn mean(around: &Neighborhood<'_, f64>, of: impl Fn(&Neighbor<f64>) -> f64) -> f64 {
        let total: f64 = around.neighbors.iter().map(of).sum();
        total / around.neighbors.len() as f64
    }

    fn put(read: fn(&Neighborhood<'_, f64>) -> f64) -> Result<(), Failures> {
        estimator(&quick(), &Read(read))
    }

    fn share(around: &Neighborhood<'_, f64>) -> f64 {
        if around.radius > 0.0 {
            8.0 * mean(around, |n| n.distance) / around.radius
        } else {
            0.0
        }
    }

    #[test]
    fn an_invariant_estimator_passes() {
        put(share).unwrap();
        struct Coarse;
        impl DimensionEstimator for Coarse {
            type Scalar = f32;
            fn estimate(&self, around: &Neighborhood<'_, f32>) -> Result<DimensionEstimate, Error> {
                let near = |n: &&Neighbor<f32>| n.distance.as_f64() > 0.5 * around.radius;
                let value = around.neighbors.iter().filter(near).count() as f64;
                // Counting is a toss-up whenever a point is at the limit.
                let margin = |n: &Neighbor<f32>| (n.distance.as_f64() / around.radius - 0.5).abs();
                let confidence = around.neighbors.iter().map(margin).fold(1.0, f64::min);
                Ok(DimensionEstimate {
                    dimension: value as usize,
                    value,
                    confidence,
                    spectrum: vec![],
                })
            }
            fn name(&self) -> &str {
                "coarse"
            }
        }
        estimator(&quick(), &Coarse).unwrap();
    }

    #[test]
    fn nonsense_is_caught() {
        // The logarithm of the distance of a copy.
        catches(
            put(|around| mean(around, |n| n.distance.ln().abs())),
            &ANSWER,
        );
    }

    #[test]
    fn a_dimension_that_is_not_the_value_is_caught() {
        struct Up(f64);
        impl DimensionEstimator for Up {
            type Scalar = f64;
            fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
                let value = self.0 * around.neighbors.len() as f64;
                Ok(DimensionEstimate {
                    dimension: value.ceil() as usize,
                    value,
                    ..Default::default()
                })
            }
            fn name(&self) -> &str {
                "up"
            }
        }
        catches(estimator(&quick(), &Up(0.05)), &ROUNDED);
    }

    #[test]
    fn a_fixed_axis_is_caught() {
        let along_x = |around: &Neighborhood<'_, f64>| {
            let cloud = around.cloud.unwrap();
            let x = |i: usize| cloud.point(i)[0];
            let spread = mean(around, |n| (x(n.index) - x(around.center)).abs());
            share(around)
                + if around.radius > 0.0 {
                    spread / around.radius
                } else {
                    0.0
                }
        };
        catches(put(along_x), &MOTION);
    }

    #[test]
    fn a_fixed_length_is_caught() {
        catches(
            put(|around| share(around) + mean(around, |n| n.distance).min(1.0)),
            &SCALE,
        );
    }

    #[test]
    fn the_dimension_of_the_space_is_caught() {
        let broken = put(|around| share(around) + around.cloud.unwrap().dimension() as f64);
        catches(broken, &EMBEDDING);
    }

    #[test]
    fn other_variances_are_caught() {
        /// Axes along which points spread by more than a tenth of the longest.
        struct Spread {
            of_roots: bool,
        }
        impl Spread {
            fn count(&self, variances: &[f64], share: f64) -> DimensionEstimate {
                let most = variances.iter().fold(0.0, |m: f64, v| m.max(*v));
                let dimension = variances.iter().filter(|&&v| v > share * most).count();
                // How far the nearest is from the limit.
                let off = |v: &f64| (v / (share * most) - 1.0).abs();
                DimensionEstimate {
                    dimension,
                    value: dimension as f64,
                    confidence: variances.iter().map(off).fold(1.0, f64::min),
                    spectrum: vec![],
                }
            }
        }
        impl DimensionEstimator for Spread {
            type Scalar = f64;
            fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
                let (cloud, count) = (around.cloud.unwrap(), around.neighbors.len());
                if count < 4 {
                    return Ok(DimensionEstimate::default());
                }
                let rows: Vec<usize> = around.neighbors.iter().map(|n| n.index).collect();
                let rows = principal(cloud.dimension(), cloud.select(&rows).coordinates(), count);
                let along = |axis: usize| rows.iter().skip(axis).step_by(cloud.dimension());
                let variance = |axis| along(axis).map(|x| x * x).sum::<f64>() / count as f64;
                let variances: Vec<f64> = (0..cloud.dimension()).map(variance).collect();
                if variances[0] > 0.0 {
                    Ok(self.count(&variances, 0.01))
                } else {
                    Ok(DimensionEstimate::default())
                }
            }
            fn of_variances(&self, variances: &[f64]) -> Option<DimensionEstimate> {
                Some(self.count(variances, if self.of_roots { 0.1 } else { 0.01 }))
            }
            fn name(&self) -> &str {
                "spread"
            }
        }
        estimator(&quick(), &Spread { of_roots: false }).unwrap();
        catches(estimator(&quick(), &Spread { of_roots: true }), &VARIANCES);
    }

    #[test]
    fn a_batch_with_answers_of_its_own_is_caught() {
        #[derive(Clone, Copy)]
        enum Fault {
            None,
            /// One radius for balls that have radii of their own.
            Radius,
            /// The cloud in place of the metric.
            Cloud,
            /// Answers from the last to the first.
            Order,
        }
        /// Half of the points of a ball, at most 3; the dimension is never 2.
        struct Counted(Fault);
        impl Counted {
            fn of(neighbors: usize) -> usize {
                if neighbors > 9 { 3 } else { 1 }
            }
        }
        impl DimensionEstimator for Counted {
            type Scalar = f64;
            fn estimate(&self, around: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
                let dimension = Self::of(around.neighbors.len());
                Ok(DimensionEstimate {
                    dimension,
                    value: dimension as f64,
                    confidence: 1.0,
                    spectrum: vec![],
                })
            }
            fn estimate_all(
                &self,
                balls: &Balls<'_, f64>,
                _execute: &dyn Execute,
            ) -> Result<Vec<BallDimension>, Error> {
                let straight = StraightLine(balls.cloud.unwrap().clone());
                let own = |k: usize| {
                    let radius = match self.0 {
                        Fault::Radius => balls.radii.of(0),
                        _ => balls.radii.of(k),
                    };
                    let all = 0..balls.len();
                    let near = |&j: &usize| match self.0 {
                        Fault::Cloud => straight.distance(k, j) < radius,
                        _ => balls.metric.distance(k, j) < radius,
                    };
                    let neighbors = all.filter(near).count();
                    balls.enough(k, neighbors)?;
                    Ok(BallDimension {
                        neighbors: neighbors as u32,
                        dimension: Self::of(neighbors) as u32,
                    })
                };
                let mut all: Vec<_> = (0..balls.len()).map(own).collect::<Result<_, Error>>()?;
                if matches!(self.0, Fault::Order) {
                    all.reverse();
                }
                Ok(all)
            }
            fn name(&self) -> &str {
                "counted"
            }
        }
        let put = |fault| {
            let settings = Settings {
                only: Some("batch"),
                ..quick()
            };
            estimator(&settings, &Counted(fault))
        };
        put(Fault::None).unwrap();
        for fault in [Fault::Radius, Fault::Cloud, Fault::Order] {
            catches(put(fault), &BATCH);
        }
    }

    #[test]
    fn a_subset_by_index_is_caught() {
        let half = |around: &Neighborhood<'_, f64>| {
            let count = around.neighbors.len();
            let r = around.radius.max(f64::MIN_POSITIVE);
            let early = |n: &Neighbor<f64>| f64::from(u8::from(n.index < count / 2));
            mean(around, |n| early(n) * n.distance / r)
        };
        catches(put(half), &ORDER);
    }
}
