//! Dimension by the length of minimum spanning trees.

use super::decision::decide;
use super::geodesic_tree::NeighborGraph;
use super::global::{GlobalDimension, GlobalEstimator, WholeCloud};
use super::jackknife::{Draws, GROUPS, error_by_ranks, standard_error};
use super::ordered::Ordered;
use super::pairs::Pairs;
use crate::execute;
use crate::surfaces::Random;
use crosscap_core::{DimensionEstimate, DimensionEstimator, Error, Neighborhood, Scalar};
use std::marker::PhantomData;

/// Fewest points of a neighborhood.
const LEAST: usize = 16;
/// Sizes of the subsets, as shares of all points.
const SHARES: [f64; 3] = [0.25, 0.5, 1.0];
/// Subsets of each size in a neighborhood; all points are one subset.
const DRAWN: usize = 4;
/// Sizes of the subsets of a whole cloud.
const GLOBAL_SHARES: [f64; 5] = [0.5, 0.625, 0.75, 0.875, 1.0];
/// Subsets of each size of a whole cloud.
const GLOBAL_DRAWN: usize = 16;
/// The same without a group, for the standard error.
const GROUP_DRAWN: usize = 4;
/// Seed of the subsets; the answer is the same at every call.
const SEED: u64 = 0x7472_6565;

/// How the length of the minimum spanning tree of p points grows with p (J. Costa and A. Hero, *Geodesic
/// entropic graphs for dimension and entropy estimation in manifold learning*, IEEE Transactions on Signal
/// Processing 52, 2004): L ~ p^((d - 1) / d), so that the slope a of log L over log p gives d = 1 / (1 - a).
///
/// Edges have the exponent 1. In a neighborhood the distances are those of its metric, the subsets a quarter, a half
/// and all of its points, drawn on ranks by distance from the center, not on rows. Over a whole cloud distances
/// are lengths of shortest ways in the graph of the scale (k nearest neighbors, or all within eps), as Isomap computes
/// them; the tree over a subset is exact (see the reference in the source). Only the largest connected piece
/// of the graph is used. Standard errors by leaving out an eighth of the points at a time.
///
/// # Limits
/// The slope approaches 1 as d grows, and errors grow with d^2. At the edge of a neighborhood the tree has longer
/// edges, which moves values of small neighborhoods. Needs distances alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpanningTree<S> {
    scalar: PhantomData<S>,
}

impl<S: Scalar> SpanningTree<S> {
    /// The estimator; it has no parameters.
    pub fn new() -> Self {
        Self {
            scalar: PhantomData,
        }
    }
}

/// The dimension that belongs to mean logarithms of lengths at logarithms of sizes.
fn dimension_of(points: &[(f64, f64)], most: usize) -> f64 {
    let count = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = xy / xx;
    if slope < 1.0 {
        (1.0 / (1.0 - slope)).min(most as f64)
    } else {
        most as f64
    }
}

impl<S: Scalar> DimensionEstimator for SpanningTree<S> {
    type Scalar = S;

    fn estimate(&self, near: &Neighborhood<'_, S>) -> Result<DimensionEstimate, Error> {
        let pairs = Pairs::of(near, LEAST)?;
        let most = near.neighbors.len() - 1;
        let mut random = Random::new(SEED);
        let mut orders: Vec<Ordered> = (0..DRAWN)
            .map(|_| Ordered::new(&pairs, random.permutation(pairs.count)))
            .collect();
        let mut flat = false;
        let mut value = |kept: &dyn Fn(usize) -> bool| {
            let left = (0..pairs.count).filter(|&rank| kept(rank)).count();
            let points = SHARES.map(|share| {
                let take = (left as f64 * share).round() as usize;
                let drawn = if share < 1.0 { DRAWN } else { 1 };
                let mut sum = 0.0;
                for order in &mut orders[..drawn] {
                    let length = order.tree_length(kept, take);
                    flat |= length <= 0.0;
                    sum += length.ln();
                }
                ((take as f64).ln(), sum / drawn as f64)
            });
            dimension_of(&points, most)
        };
        let all = value(&|_| true);
        let error = error_by_ranks(value);
        if flat {
            // A tree of length 0: a good part of the points are copies of one.
            return Ok(decide(0.0, 0.0, most));
        }
        Ok(decide(all, error, most))
    }

    fn name(&self) -> &str {
        "spanning-tree"
    }
}

impl<S: Scalar> GlobalEstimator<S> for SpanningTree<S> {
    fn global(&self, space: &WholeCloud<'_, S>) -> Result<GlobalDimension, Error> {
        space.check(4 * GROUPS)?;
        let graph = NeighborGraph::of(space);
        let members = graph.largest_component();
        if members.len() < 4 * GROUPS {
            return Err(Error::SparseNeighborhood {
                point: members.first().map_or(0, |&i| i as usize),
                found: members.len(),
                needed: 4 * GROUPS,
                parameter: space.scale.parameter(),
            });
        }
        let count = members.len();
        let draws = Draws::new(SEED, count, GLOBAL_DRAWN, GROUP_DRAWN);
        let jobs: Vec<(usize, f64, usize)> = (0..=GROUPS)
            .flat_map(|g| GLOBAL_SHARES.map(|share| (g, share)))
            .flat_map(|(g, share)| (0..draws.of(g)).map(move |k| (g, share, k)))
            .collect();
        let found = execute::few(space.execute, jobs.len(), |job| {
            let (g, share, order) = jobs[job];
            let left: Vec<u32> = draws.points(g, order).map(|k| members[k]).collect();
            let take = (left.len() as f64 * share).round() as usize;
            let length = graph.tree_length(&left[..take]);
            ((take as f64).ln(), length.ln())
        });
        if found.iter().any(|x| !x.1.is_finite()) {
            return Err(Error::Parameter {
                name: space.scale.parameter(),
                value: "(a tree of length 0)".into(),
                expected: "points of which fewer than half are copies of others".into(),
            });
        }
        let most = space.most();
        let mut at = 0;
        let values: Vec<f64> = (0..=GROUPS)
            .map(|g| {
                let count = GLOBAL_SHARES.len() * draws.of(g);
                at += count;
                dimension_of(&found[at - count..at], most)
            })
            .collect();
        let (without, all) = values.split_at(GROUPS);
        let error = standard_error(without);
        let scales = [graph.shortest(), graph.longest()];
        Ok(GlobalDimension::new(all[0], error, most, scales, count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn slope_of_a_power_law() {
        for d in 2..=8 {
            let a = 1.0 - 1.0 / f64::from(d);
            let points: Vec<_> = [10.0_f64, 20.0, 40.0]
                .iter()
                .map(|p| (p.ln(), (3.0 * p.powf(a)).ln()))
                .collect();
            assert_relative_eq!(dimension_of(&points, 50), f64::from(d), max_relative = 1e-9);
        }
        assert_eq!(dimension_of(&[(0.0, 0.0), (1.0, 1.5)], 7), 7.0);
    }
}
