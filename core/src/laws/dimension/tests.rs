use super::*;
use crate::execute::Execute;
use crate::laws::motion::principal;
use crate::laws::reference::StraightLine;
use crate::laws::twins::{catches, quick};
use crate::{BallDimension, Balls, DimensionEstimate, Error, MetricSpace, Neighbor, Neighborhood};

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

#[test]
fn a_batch_with_answers_of_its_own_is_caught() {
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
