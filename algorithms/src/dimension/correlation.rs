//! Correlation dimension.

use super::decision::decide;
use super::global::{GlobalDimension, GlobalEstimator, Scale, WholeCloud, median};
use super::jackknife::error_by_ranks;
use super::pairs::Pairs;
use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighborhood, Scalar};
use std::marker::PhantomData;

/// Fewest points of a neighborhood.
const LEAST: usize = 12;
/// Fewest pairs that a slope is read from.
const LEAST_PAIRS: usize = 6;
/// Share of the pairs that the smaller radius keeps.
const KEPT: f64 = 0.25;

/// How the number of pairs closer than r grows with r (P. Grassberger and I. Procaccia, *Measuring the
/// strangeness of strange attractors*, Physica D 9, 1983): C(r) ~ r^d, so d is the slope of log C(r) over
/// log r.
///
/// In a neighborhood of radius R the pairs are those of a point within R/2 of the center with a point
/// closer than R/2 to it: around these all is in sight, and no edge takes pairs away. The slope is
/// read between R/2 and the distance that a quarter of these pairs stay below; its standard error by
/// leaving out an eighth of the points at a time.
///
/// Over a whole cloud the slope is read between two radii: the median distances of the k/2-th and the k-th
/// neighbor, as the R package `ider` and scikit-dimension choose them, or eps/2 and eps. The standard error is the
/// jackknife over single points with the radii held.
///
/// # Limits
/// Pairs run out fast: a neighborhood of k points has about k^2 / 4^d of them (a few up to d = 3 with 50
/// points), and [`Error::SparseNeighborhood`] says so. Too small where density varies, beside edges (whole cloud), and in
/// high dimension. Needs distances alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct CorrelationDimension<S> {
    scalar: PhantomData<S>,
}

impl<S: Scalar> CorrelationDimension<S> {
    /// The estimator; it has no parameters.
    pub fn new() -> Self {
        Self {
            scalar: PhantomData,
        }
    }
}

/// The slope over the points that are kept, and the number of pairs; 0 where there are too few.
fn slope(pairs: &Pairs, kept: impl Fn(usize) -> bool, lengths: &mut Vec<f64>) -> (f64, usize) {
    let half = 0.5 * pairs.reach;
    lengths.clear();
    for a in (0..pairs.count).filter(|&a| pairs.radii[a] < half && kept(a)) {
        let row = pairs.row(a);
        lengths.extend(
            (0..pairs.count)
                .filter(|&b| b != a && row[b] < half && kept(b))
                .map(|b| row[b]),
        );
    }
    let all = lengths.len();
    if all < LEAST_PAIRS {
        return (0.0, all);
    }
    let fewer = ((all as f64 * KEPT).round() as usize).clamp(1, all - 1);
    let (_, &mut small, _) = lengths.select_nth_unstable_by(fewer - 1, f64::total_cmp);
    if small <= 0.0 {
        // A quarter of the pairs are copies.
        return (0.0, all);
    }
    ((all as f64 / fewer as f64).ln() / (half / small).ln(), all)
}

impl<S: Scalar> DimensionEstimator for CorrelationDimension<S> {
    type Scalar = S;

    fn estimate(&self, near: &Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> {
        let pairs = Pairs::of(near, LEAST)?;
        let most = near.neighbors.len() - 1;
        if pairs.radii.last().is_none_or(|&r| r <= 0.0) {
            return Ok(decide(0.0, 0.0, most));
        }
        let mut lengths = Vec::new();
        let (value, count) = slope(&pairs, |_| true, &mut lengths);
        if count < LEAST_PAIRS {
            // Pairs grow with the square of the points.
            let factor = (LEAST_PAIRS as f64 / count.max(1) as f64).sqrt();
            return Err(Error::SparseNeighborhood {
                point: near.center,
                found: near.neighbors.len(),
                needed: (near.neighbors.len() as f64 * factor).ceil() as usize + 1,
                parameter: "eps",
            });
        }
        let error = error_by_ranks(|kept| slope(&pairs, kept, &mut lengths).0);
        Ok(decide(value, error, most))
    }

    fn name(&self) -> &str {
        "correlation"
    }
}

impl<S: Scalar> GlobalEstimator<S> for CorrelationDimension<S> {
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error> {
        space.check(LEAST)?;
        let [small, large] = match space.scale {
            Scale::Within(r) => [0.5 * r, r],
            Scale::Nearest(k) => neighbor_medians(space, k / 2, k),
        };
        if !(small > 0.0 && small < large) {
            return Err(Error::Parameter {
                name: space.scale.parameter(),
                value: format!("(radii {small} and {large})"),
                expected: "two different radii above 0: are most points copies of others?".into(),
            });
        }
        // Pairs of a point with the others, nearer than either radius.
        let counts = space.map(Vec::new, |near, i| {
            space.oracle.within(i, S::of(large), near);
            let fewer = near.partition_point(|x| x.distance.as_f64() < small);
            [
                fewer.saturating_sub(1) as f64,
                near.len().saturating_sub(1) as f64,
            ]
        });
        let total = |k: usize| counts.iter().map(|c| c[k]).sum::<f64>();
        let [fewer, more] = [total(0), total(1)];
        if fewer < LEAST_PAIRS as f64 {
            return Err(Error::SparseNeighborhood {
                point: 0,
                found: counts[0][0] as usize + 1,
                needed: 2,
                parameter: space.scale.parameter(),
            });
        }
        let span = (large / small).ln();
        let value = (more / fewer).ln() / span;
        // Leaving out a point takes its pairs away at both ends.
        let spread: f64 = counts
            .iter()
            .map(|c| (2.0 * (c[1] / more - c[0] / fewer)).powi(2))
            .sum();
        let error = spread.sqrt() / span;
        Ok(GlobalDimension::new(
            value,
            error,
            space.most(),
            [small, large],
            space.len(),
        ))
    }
}

/// Median distances of the `near`-th and of the `far`-th neighbor.
pub(super) fn neighbor_medians<S: Scalar>(
    space: &WholeCloud<'_, S>,
    near: usize,
    far: usize,
) -> [f64; 2] {
    let far = far.min(space.len() - 1);
    let near = near.clamp(1, far);
    let found = space.map(Vec::new, |all, i| {
        space.oracle.nearest(i, far + 1, all);
        let at = |k: usize| all.get(k).map_or(f64::INFINITY, |x| x.distance.as_f64());
        [at(near), at(far)]
    });
    [0, 1].map(|k| median(&mut found.iter().map(|d| d[k]).collect::<Vec<_>>()))
}
