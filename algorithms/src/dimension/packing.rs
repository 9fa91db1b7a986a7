//! Dimension by packing numbers.

use super::correlation::neighbor_medians;
use super::decision::decide;
use super::global::{GlobalDimension, GlobalEstimator, Scale, WholeCloud};
use super::jackknife::{Draws, GROUPS, error_by_ranks, standard_error};
use super::pairs::Pairs;
use crate::execute;
use crate::surfaces::Random;
use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighborhood, Scalar};
use std::marker::PhantomData;

/// Fewest points of a neighborhood.
const LEAST: usize = 12;
/// Orders in which a packing is grown, for the mean of its logarithm.
const ORDERS: usize = 8;
/// The same over a whole cloud.
const GLOBAL_ORDERS: usize = 16;
/// The same without a group, for the standard error.
const GROUP_ORDERS: usize = 4;
/// Seed of the orders; the answer is the same at every call.
const SEED: u64 = 0x7061_636b;
/// Radii in a neighborhood, as shares of its own.
const SHARES: [f64; 2] = [0.5, 1.0];

/// How many points at distance of at least r from each other a set holds, and how that falls with r
/// (B. Kegl, *Intrinsic dimension estimation using packing numbers*, NIPS 15, 2003): M(r) ~ r^-d.
///
/// A packing is grown greedily in random order, and the logarithm of its size is averaged over several
/// orders (the paper stops by the variance of the mean; here their number is fixed). Unlike pairs,
/// packings do not see where points are dense.
///
/// In a neighborhood of radius R the radii are R/2 and R. So few balls fit that its edge matters:
/// centers may be at the edge, and balls of half the radius r around them reach r/2 beyond, so that M(r) is taken to
/// grow with (1 + 2R / r)^d. Orders are drawn on the ranks by distance from the center, not on rows.
/// Over a whole cloud the radii are the median distances of the k-th and the 4k-th neighbor, or
/// eps/2 and eps. Standard errors by leaving out an eighth of the points at a time.
///
/// # Limits
/// Neighborhoods of 50 points are few for it, and in high dimension the sample is too thin to be packed:
/// values fall short from d = 5 on. Needs distances alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackingNumbers<S> {
    scalar: PhantomData<S>,
}

impl<S: Scalar> PackingNumbers<S> {
    /// The estimator; it has no parameters.
    pub fn new() -> Self {
        Self {
            scalar: PhantomData,
        }
    }
}

/// For every point those that cannot be centers beside it at separation `r`, one bit a point.
fn covers(pairs: &Pairs, r: f64) -> Vec<u128> {
    let bits = |row: &[f64]| {
        let apart = row.iter().map(|&d| d >= r);
        apart
            .enumerate()
            .fold(0, |bits, (b, apart)| bits | u128::from(!apart) << b)
    };
    (0..pairs.count).map(|a| bits(pairs.row(a))).collect()
}

/// Mean logarithm of the size of a packing, of the points that are kept.
fn log_size(covers: &[u128], orders: &[Vec<usize>], kept: u128) -> f64 {
    let mut sum = 0.0;
    for order in orders {
        let mut left = kept;
        let mut size = 0_u32;
        for &a in order {
            if left >> a & 1 == 1 {
                left &= !(covers[a] | 1 << a);
                size += 1;
            }
        }
        sum += f64::from(size).ln();
    }
    sum / orders.len() as f64
}

impl<S: Scalar> DimensionEstimator for PackingNumbers<S> {
    type Scalar = S;

    fn estimate(&self, near: &Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> {
        let pairs = Pairs::of(near, LEAST)?;
        let most = near.neighbors.len() - 1;
        if pairs.radii.last().is_none_or(|&r| r <= 0.0) {
            return Ok(decide(0.0, 0.0, most));
        }
        let mut random = Random::new(SEED);
        let orders: Vec<Vec<usize>> = (0..ORDERS)
            .map(|_| random.permutation(pairs.count))
            .collect();
        let span = SHARES.map(|s| (1.0 + 2.0 / s).ln());
        let covers = SHARES.map(|s| covers(&pairs, s * pairs.reach));
        let slope = |kept: &dyn Fn(usize) -> bool| {
            let kept = (0..pairs.count).fold(0, |bits, rank| bits | u128::from(kept(rank)) << rank);
            let sizes = covers.each_ref().map(|c| log_size(c, &orders, kept));
            (sizes[0] - sizes[1]) / (span[0] - span[1])
        };
        Ok(decide(slope(&|_| true), error_by_ranks(slope), most))
    }

    fn name(&self) -> &str {
        "packing"
    }
}

impl<S: Scalar> GlobalEstimator<S> for PackingNumbers<S> {
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error> {
        space.check(2 * GROUPS)?;
        let [small, large] = match space.scale {
            Scale::Within(r) => [0.5 * r, r],
            Scale::Nearest(k) => neighbor_medians(space, k, 4 * k),
        };
        if !(small > 0.0 && small < large) {
            return Err(Error::Parameter {
                name: space.scale.parameter(),
                value: format!("(radii {small} and {large})"),
                expected: "two different radii above 0: are most points copies of others?".into(),
            });
        }
        let count = space.len();
        let draws = Draws::new(SEED, count, GLOBAL_ORDERS, GROUP_ORDERS);
        let jobs: Vec<(usize, usize)> = (0..=GROUPS)
            .flat_map(|g| (0..draws.of(g)).map(move |k| (g, k)))
            .collect();
        let sizes = execute::few(space.execute, 2 * jobs.len(), |job| {
            let ((g, order), radius) = (jobs[job / 2], job % 2);
            let separation = S::of([small, large][radius]);
            let mut covered = vec![false; count];
            let mut near = Vec::new();
            let mut size = 0usize;
            for i in draws.points(g, order) {
                if !covered[i] {
                    size += 1;
                    space.oracle.within(i, separation, &mut near);
                    near.iter().for_each(|x| covered[x.index] = true);
                }
            }
            (size as f64).ln()
        });
        let span = (large / small).ln();
        let mut slopes = [0.0; GROUPS + 1];
        for (&(g, _), pair) in jobs.iter().zip(sizes.chunks_exact(2)) {
            slopes[g] += (pair[0] - pair[1]) / span / draws.of(g) as f64;
        }
        let (without, all) = slopes.split_at(GROUPS);
        let error = standard_error(without);
        Ok(GlobalDimension::new(
            all[0],
            error,
            space.most(),
            [small, large],
            count,
        ))
    }
}
