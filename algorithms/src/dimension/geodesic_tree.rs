//! Minimum spanning trees of some points of a graph, under the lengths of shortest ways.

use super::global::WholeCloud;
use crosscap_core::Scalar;
use petgraph::unionfind::UnionFind;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The neighborhoods of a cloud as a graph, edges as long as the distances.
pub(super) struct NeighborGraph {
    /// Edges with their lengths, smaller end first, in order.
    edges: Vec<(u32, u32, f64)>,
    starts: Vec<usize>,
    ways: Vec<(u32, f64)>,
}

/// A vertex waiting in the queue, nearest first, ties by index.
#[derive(PartialEq)]
struct Waiting(f64, u32);

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl NeighborGraph {
    /// Joins every point to its neighborhood. O(n k) besides the queries.
    pub(super) fn of<S: Scalar>(space: &WholeCloud<'_, S>) -> Self {
        let rows = space.map(Vec::new, |near, i| {
            space.neighborhood(i, near);
            near.iter()
                .filter(|x| x.index != i)
                .map(|x| {
                    (
                        i.min(x.index) as u32,
                        i.max(x.index) as u32,
                        x.distance.as_f64(),
                    )
                })
                .filter(|e| e.2.is_finite())
                .collect::<Vec<_>>()
        });
        let mut edges: Vec<(u32, u32, f64)> = rows.into_iter().flatten().collect();
        edges.sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
        edges.dedup_by_key(|e| (e.0, e.1));
        let count = space.len();
        let mut starts = vec![0; count + 1];
        for e in &edges {
            starts[e.0 as usize + 1] += 1;
            starts[e.1 as usize + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut ways = vec![(0, 0.0); 2 * edges.len()];
        for &(a, b, length) in &edges {
            for (from, to) in [(a, b), (b, a)] {
                ways[fill[from as usize]] = (to, length);
                fill[from as usize] += 1;
            }
        }
        Self {
            edges,
            starts,
            ways,
        }
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The points of the largest connected piece (of the first, if several), in order.
    pub(super) fn largest_component(&self) -> Vec<u32> {
        let mut pieces = UnionFind::<u32>::new(self.len());
        for e in &self.edges {
            pieces.union(e.0, e.1);
        }
        let names = pieces.into_labeling();
        let mut sizes = vec![0usize; names.len()];
        for &name in &names {
            sizes[name as usize] += 1;
        }
        let most = sizes.iter().copied().max().unwrap_or(0);
        let largest = names.iter().copied().find(|&n| sizes[n as usize] == most);
        (0..names.len() as u32)
            .filter(|&i| Some(names[i as usize]) == largest)
            .collect()
    }

    /// Length of the shortest edge that is not 0.
    pub(super) fn shortest(&self) -> f64 {
        let lengths = self.edges.iter().map(|e| e.2).filter(|&l| l > 0.0);
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Length of the longest edge.
    pub(super) fn longest(&self) -> f64 {
        self.edges.iter().map(|e| e.2).fold(0.0, f64::max)
    }

    /// Length of the minimum spanning tree of `terminals` under the lengths of shortest ways in the graph.
    ///
    /// Exact without all the shortest ways: a search from all terminals at once gives every vertex its nearest
    /// terminal, and the edges of the graph between vertices of different terminals u, v, with length
    /// d(u) + edge + d(v), hold a minimum spanning tree of the complete graph (K. Mehlhorn, *A faster approximation
    /// algorithm for the Steiner problem in graphs*, Information Processing Letters 27, 1988, lemma 1).
    /// O(e log e).
    pub(super) fn tree_length(&self, terminals: &[u32]) -> f64 {
        let count = self.len();
        let mut away = vec![f64::INFINITY; count];
        let mut owner = vec![u32::MAX; count];
        let mut queue = BinaryHeap::with_capacity(count);
        for (k, &t) in terminals.iter().enumerate() {
            away[t as usize] = 0.0;
            owner[t as usize] = k as u32;
            queue.push(Waiting(0.0, t));
        }
        while let Some(Waiting(distance, v)) = queue.pop() {
            if distance > away[v as usize] {
                continue;
            }
            for &(w, length) in &self.ways[self.starts[v as usize]..self.starts[v as usize + 1]] {
                let through = distance + length;
                if through < away[w as usize] {
                    away[w as usize] = through;
                    owner[w as usize] = owner[v as usize];
                    queue.push(Waiting(through, w));
                }
            }
        }
        let mut bridges: Vec<(f64, u32, u32)> = Vec::new();
        for &(a, b, length) in &self.edges {
            let (p, q) = (owner[a as usize], owner[b as usize]);
            if p != q && p != u32::MAX && q != u32::MAX {
                bridges.push((away[a as usize] + length + away[b as usize], p, q));
            }
        }
        bridges.sort_unstable_by(|x, y| x.0.total_cmp(&y.0));
        let mut joined = UnionFind::<u32>::new(terminals.len());
        let mut total = 0.0;
        for (length, p, q) in bridges {
            if joined.union(p, q) {
                total += length;
            }
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::Scale;
    use crate::execute::Serial;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::surfaces::Random;
    use approx::assert_relative_eq;
    use crosscap_core::PointCloud;

    /// All pairs by Floyd and Warshall, then Prim: the definition, without the lemma.
    fn by_all_pairs(graph: &NeighborGraph, terminals: &[u32]) -> f64 {
        let n = graph.len();
        let mut d = vec![vec![f64::INFINITY; n]; n];
        for (i, row) in d.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for &(a, b, l) in &graph.edges {
            d[a as usize][b as usize] = l;
            d[b as usize][a as usize] = l;
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    d[i][j] = d[i][j].min(d[i][k] + d[k][j]);
                }
            }
        }
        let mut left: Vec<usize> = terminals[1..].iter().map(|&t| t as usize).collect();
        let mut reached = vec![terminals[0] as usize];
        let mut total = 0.0;
        while !left.is_empty() {
            let (at, length) = left
                .iter()
                .enumerate()
                .map(|(at, &t)| {
                    (
                        at,
                        reached
                            .iter()
                            .map(|&r| d[r][t])
                            .fold(f64::INFINITY, f64::min),
                    )
                })
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            total += length;
            reached.push(left.swap_remove(at));
        }
        total
    }

    #[test]
    fn one_search_gives_the_tree_of_all_shortest_ways() {
        let mut random = Random::new(5);
        for round in 0..20 {
            let n = 30 + round;
            let rows = (0..2 * n).map(|_| random.uniform()).collect();
            let metric = Euclidean::new(PointCloud::<f64>::new(2, rows).unwrap());
            let oracle = BruteForceOracle::new(metric.clone());
            let graph = NeighborGraph::of(&WholeCloud {
                metric: &metric,
                oracle: &oracle,
                cloud: None,
                scale: Scale::Nearest(4),
                execute: &Serial,
            });
            let members = graph.largest_component();
            for share in [1, 2, 4] {
                let terminals: Vec<u32> = members.iter().copied().step_by(share).collect();
                assert_relative_eq!(
                    graph.tree_length(&terminals),
                    by_all_pairs(&graph, &terminals),
                    max_relative = 1e-12
                );
            }
        }
    }
}
