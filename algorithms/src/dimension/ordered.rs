//! Minimum spanning trees of subsets of a neighborhood.

use super::pairs::Pairs;

/// Numbers that are worked on at once: rows are filled up to a multiple of it.
const LANES: usize = 4;

/// The distances of a neighborhood in one of the orders that subsets are drawn in: rows and columns follow
/// the order, so that a subset is a beginning of every row.
pub(super) struct Ordered {
    order: Vec<usize>,
    /// Length of a row.
    stride: usize,
    /// Infinite beyond the points.
    distances: Vec<f64>,
    /// Distance of every point from the tree so far.
    away: Vec<f64>,
    /// 0 for a point that the tree should still reach, infinite for others.
    closed: Vec<f64>,
}

impl Ordered {
    /// The distances in this order. O(p^2).
    pub(super) fn new(pairs: &Pairs, order: Vec<usize>) -> Self {
        let stride = order.len().next_multiple_of(LANES);
        let mut distances = vec![f64::INFINITY; order.len() * stride];
        for (own, &a) in distances.chunks_exact_mut(stride).zip(&order) {
            let row = pairs.row(a);
            own.iter_mut().zip(&order).for_each(|(d, &b)| *d = row[b]);
        }
        Self {
            order,
            stride,
            distances,
            away: Vec::with_capacity(stride),
            closed: Vec::with_capacity(stride),
        }
    }

    /// Length of the minimum spanning tree of the first `take` points of the order whose ranks are
    /// kept, by Prim's algorithm. O(p^2).
    pub(super) fn tree_length(&mut self, kept: &dyn Fn(usize) -> bool, take: usize) -> f64 {
        let mut left = take;
        self.closed.clear();
        for &rank in &self.order {
            if left == 0 {
                break;
            }
            let wanted = kept(rank);
            left -= usize::from(wanted);
            self.closed.push(if wanted { 0.0 } else { f64::INFINITY });
        }
        let whole = self.closed.len().next_multiple_of(LANES);
        self.closed.resize(whole, f64::INFINITY);
        self.away.clear();
        self.away.resize(whole, f64::INFINITY);
        let mut length = 0.0;
        let mut last = self.closed.iter().position(|&c| c == 0.0);
        while let Some(at) = last {
            self.closed[at] = f64::INFINITY;
            let least = self.reach_from(at);
            if least == f64::INFINITY {
                // All are reached, or no way leads to the rest.
                break;
            }
            length += least;
            let open = self.away.iter().zip(&self.closed);
            last = open
                .enumerate()
                .position(|(_, (&a, &c))| a == least && c == 0.0);
        }
        length
    }

    /// Adds the ways from point `at` of the tree, and returns the shortest way to a point that is not in it yet.
    fn reach_from(&mut self, at: usize) -> f64 {
        let row = &self.distances[at * self.stride..][..self.away.len()];
        let mut least = [f64::INFINITY; LANES];
        let away = self.away.as_chunks_mut::<LANES>().0;
        let rest = row.as_chunks::<LANES>().0.iter();
        let rest = rest.zip(self.closed.as_chunks::<LANES>().0);
        for (away, (row, closed)) in away.iter_mut().zip(rest) {
            let lanes = least.iter_mut().zip(away).zip(row.iter().zip(closed));
            for ((least, away), (&row, &closed)) in lanes {
                // Comparisons rather than `min` and `max`: one instruction for all lanes.
                let near = if row < *away { row } else { *away };
                *away = near;
                let open = if closed > near { closed } else { near };
                *least = if open < *least { open } else { *least };
            }
        }
        least.into_iter().fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::surfaces::Random;
    use crosscap_core::{Neighborhood, NeighborhoodOracle, PointCloud};
    use petgraph::unionfind::UnionFind;

    /// By Kruskal's algorithm.
    fn by_edges(pairs: &Pairs, points: &[usize]) -> f64 {
        let mut edges: Vec<(f64, usize, usize)> = Vec::new();
        for &a in points {
            edges.extend(points.iter().map(|&b| (pairs.row(a)[b], a, b)));
        }
        edges.sort_unstable_by(|x, y| x.0.total_cmp(&y.0));
        let mut joined = UnionFind::<usize>::new(pairs.count);
        edges
            .iter()
            .map(|&(length, a, b)| if joined.union(a, b) { length } else { 0.0 })
            .sum()
    }

    #[test]
    fn trees_of_subsets_are_those_of_another_algorithm() {
        let mut random = Random::new(9);
        for count in [16, 17, 18, 19, 50, 128] {
            let rows = (0..3 * count).map(|_| random.uniform()).collect();
            let metric = Euclidean::new(PointCloud::<f64>::new(3, rows).unwrap());
            let mut neighbors = Vec::new();
            BruteForceOracle::new(metric.clone()).nearest(0, count, &mut neighbors);
            let near = Neighborhood {
                center: 0,
                radius: f64::INFINITY,
                neighbors: &neighbors,
                metric: &metric,
                cloud: None,
            };
            let pairs = Pairs::of(&near, 16).unwrap();
            let order = random.permutation(count);
            let mut ordered = Ordered::new(&pairs, order.clone());
            for group in 0..=8 {
                let kept = |rank: usize| rank % 8 != group;
                let all: Vec<usize> = order.iter().copied().filter(|&a| kept(a)).collect();
                for take in [0, 1, 2, all.len() / 2, all.len()] {
                    let expected = by_edges(&pairs, &all[..take]);
                    let found = ordered.tree_length(&kept, take);
                    assert!(
                        (found - expected).abs() <= 1e-12 * expected,
                        "{count} {take}"
                    );
                }
            }
        }
    }
}
