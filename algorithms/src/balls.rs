//! A tree of balls over places of R^N: what is near a place, the nearest of one and of many at once.

use crate::execute::{self, Execute};
use crosscap_core::squared_distance;

/// Most places of a leaf: more than the neighbors that are asked for, so that a leaf alone bounds
/// how far they are. Its distances are computed lane by lane.
const LEAF: usize = 32;
/// Lanes that are summed together.
const LANES: usize = 8;
/// Places that the direction of a split is read from.
const SHOWN: usize = 48;
/// Relative bound on the rounding of a distance.
const ROUNDING: f64 = 1e-12;
/// Leaves that are worked on together.
const LEAVES_AT_ONCE: usize = 8;

struct Node {
    start: u32,
    end: u32,
    /// The second child; the first one is the next node. 0 for a leaf.
    right: u32,
    /// Which leaf it is, or the first one below it.
    leaf: u32,
    /// Largest distance of a place from the center.
    radius: f64,
}

/// Places of R^N in leaf order under nested balls.
///
/// Built in O(n log n) distances; the neighbors of places that lie together are looked up leaf by leaf.
pub(crate) struct BallTree {
    width: usize,
    /// The caller's index at every position.
    order: Vec<u32>,
    /// Places leaf by leaf, coordinate by coordinate, one a lane; infinity where no place is.
    lanes: Vec<[f64; LEAF]>,
    nodes: Vec<Node>,
    centers: Vec<f64>,
}

/// Squared distance of a place, then its index, as one number that orders like the two: the bits of
/// nonnegative numbers are in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Near(u128);

impl Near {
    fn new(square: f64, index: u32) -> Self {
        Self(u128::from(square.to_bits()) << 32 | u128::from(index))
    }

    /// The squared distance.
    pub(crate) fn square(self) -> f64 {
        f64::from_bits((self.0 >> 32) as u64)
    }

    /// The caller's index of the place.
    pub(crate) fn index(self) -> u32 {
        self.0 as u32
    }
}

/// Buffers of one thread.
#[derive(Default)]
struct Search {
    /// Leaves with their gap.
    around: Vec<(f64, u32)>,
    place: Vec<f64>,
    near: Vec<Near>,
}

impl BallTree {
    /// A tree over `places`, `width` numbers each; they are named by their position there.
    pub(crate) fn new(width: usize, places: &[f64]) -> Self {
        let count = places.len() / width.max(1);
        let mut tree = Self {
            width,
            order: (0..count as u32).collect(),
            lanes: Vec::new(),
            nodes: Vec::new(),
            centers: Vec::new(),
        };
        if count > 0 {
            let mut order = std::mem::take(&mut tree.order);
            tree.split(places, &mut order, 0, &mut Vec::new());
            tree.order = order;
        }
        tree
    }

    fn split(
        &mut self,
        places: &[f64],
        rows: &mut [u32],
        start: usize,
        keyed: &mut Vec<(f64, u32)>,
    ) {
        let at = self.nodes.len();
        let width = self.width;
        self.nodes.push(Node {
            start: start as u32,
            end: (start + rows.len()) as u32,
            right: 0,
            leaf: (self.lanes.len() / width) as u32,
            radius: 0.0,
        });
        self.centers.resize((at + 1) * width, 0.0);
        if rows.len() <= LEAF {
            for k in 0..width {
                let mut lanes = [f64::INFINITY; LEAF];
                for (lane, &i) in lanes.iter_mut().zip(&*rows) {
                    *lane = places[i as usize * width + k];
                }
                self.lanes.push(lanes);
            }
            return self.measure_leaf(at, rows.len());
        }
        let mut low = vec![f64::INFINITY; width];
        let mut high = vec![f64::NEG_INFINITY; width];
        for &i in rows.iter().step_by((rows.len() / SHOWN).max(1)) {
            let place = &places[i as usize * width..(i as usize + 1) * width];
            for ((l, h), &x) in low.iter_mut().zip(&mut high).zip(place) {
                *l = l.min(x);
                *h = h.max(x);
            }
        }
        let spread = |k: usize| high[k] - low[k];
        let axis = (1..width).fold(0, |best, k| if spread(k) > spread(best) { k } else { best });
        keyed.clear();
        keyed.extend(rows.iter().map(|&i| (places[i as usize * width + axis], i)));
        // Full leaves, but for the last.
        let half = (rows.len() / 2).div_ceil(LEAF) * LEAF;
        keyed.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (row, key) in rows.iter_mut().zip(&*keyed) {
            *row = key.1;
        }
        let (left, right) = rows.split_at_mut(half);
        self.split(places, left, start, keyed);
        self.nodes[at].right = self.nodes.len() as u32;
        self.split(places, right, start + half, keyed);
        self.measure(at);
    }

    /// Center and radius of a leaf of `count` places.
    fn measure_leaf(&mut self, at: usize, count: usize) {
        let width = self.width;
        let first = self.nodes[at].leaf as usize * width;
        let lanes = &self.lanes[first..first + width];
        let share = 1.0 / count as f64;
        let mean = |row: &[f64; LEAF]| row[..count].iter().sum::<f64>() * share;
        let center: Vec<f64> = lanes.iter().map(mean).collect();
        let squares = self.squares(&self.nodes[at], &center);
        let farthest = squares[..count].iter().fold(0.0_f64, |a, &b| a.max(b));
        self.centers[at * width..].copy_from_slice(&center);
        self.nodes[at].radius = farthest.sqrt() * (1.0 + ROUNDING);
    }

    /// Center and radius of the node `at`, with the nodes below it the last so far: a ball about those of its leaves.
    fn measure(&mut self, at: usize) {
        let width = self.width;
        let count = |node: &Node| f64::from(node.end - node.start);
        let own = count(&self.nodes[at]);
        let (before, below) = self.centers.split_at_mut((at + 1) * width);
        let center = &mut before[at * width..];
        for child in [at + 1, self.nodes[at].right as usize] {
            let share = count(&self.nodes[child]) / own;
            for (c, x) in center.iter_mut().zip(&below[(child - at - 1) * width..]) {
                *c += share * x;
            }
        }
        let leaves = self.nodes[at + 1..].iter().zip(below.chunks_exact(width));
        let farthest = leaves
            .filter(|(leaf, _)| leaf.right == 0)
            .map(|(leaf, other)| squared_distance(other, center).sqrt() + leaf.radius)
            .fold(0.0, f64::max);
        self.nodes[at].radius = farthest * (1.0 + ROUNDING);
    }

    /// The caller's indices in the order of the tree.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    fn center(&self, node: usize) -> &[f64] {
        &self.centers[node * self.width..(node + 1) * self.width]
    }

    /// Squared distances of the places of a leaf from `place`.
    #[inline]
    fn squares(&self, leaf: &Node, place: &[f64]) -> [f64; LEAF] {
        let first = leaf.leaf as usize * self.width;
        let rows = &self.lanes[first..first + self.width];
        let mut squares = [0.0; LEAF];
        for (k, sums) in squares.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            for (row, x) in rows.iter().zip(place) {
                let row = &row.as_chunks::<LANES>().0[k];
                for (sum, y) in sums.iter_mut().zip(row) {
                    *sum += (y - x) * (y - x);
                }
            }
        }
        squares
    }

    /// Visits every place closer to `place` than `radius`, with its squared distance.
    pub(crate) fn within(&self, place: &[f64], radius: f64, mut visit: impl FnMut(u32, f64)) {
        self.any_within(place, radius, |index, square| {
            visit(index, square);
            false
        });
    }

    /// Whether `test` holds for a place closer to `place` than `radius`; it gets the squared distance, and
    /// is not asked any further once it held.
    pub(crate) fn any_within(
        &self,
        place: &[f64],
        radius: f64,
        mut test: impl FnMut(u32, f64) -> bool,
    ) -> bool {
        let limit = radius * radius;
        self.leaves(place, radius, &mut |at, _| {
            let node = &self.nodes[at];
            let order = &self.order[node.start as usize..node.end as usize];
            (order.iter().zip(&self.squares(node, place)))
                .any(|(&index, &square)| square < limit && test(index, square))
        })
    }

    /// Visits the leaves whose balls come as close to `place` as `reach`, with that gap, until `visit` says so.
    fn leaves(
        &self,
        place: &[f64],
        reach: f64,
        visit: &mut impl FnMut(usize, f64) -> bool,
    ) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let mut stack = [0u32; 96];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let at = stack[height] as usize;
            let node = &self.nodes[at];
            let gap =
                squared_distance(place, self.center(at)).sqrt() * (1.0 - ROUNDING) - node.radius;
            if gap > reach {
                continue;
            }
            if node.right == 0 {
                if visit(at, gap) {
                    return true;
                }
            } else {
                // About halves, so the tree is not higher than the bits of an index.
                stack[height] = node.right;
                stack[height + 1] = at as u32 + 1;
                height += 2;
            }
        }
        false
    }

    /// The place nearest to `place` of those that `accept`, by their squared distance, with that distance;
    /// ties by index.
    pub(crate) fn nearest(
        &self,
        place: &[f64],
        accept: impl Fn(f64) -> bool,
    ) -> Option<(u32, f64)> {
        let gap = |at: usize| {
            squared_distance(place, self.center(at)).sqrt() * (1.0 - ROUNDING)
                - self.nodes[at].radius
        };
        let mut best: Option<Near> = None;
        let (mut reach, mut limit) = (f64::INFINITY, f64::INFINITY);
        let mut stack = [(0.0, 0_u32); 96];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (away, at) = stack[height];
            if away > reach {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.right == 0 {
                let order = &self.order[node.start as usize..node.end as usize];
                for (&index, &square) in order.iter().zip(&self.squares(node, place)) {
                    if square > limit {
                        continue;
                    }
                    let found = Near::new(square, index);
                    if accept(square) && best.is_none_or(|b| found < b) {
                        best = Some(found);
                        limit = square;
                        reach = square.sqrt() * (1.0 + ROUNDING);
                    }
                }
            } else {
                let first = (gap(at as usize + 1), at + 1);
                let second = (gap(node.right as usize), node.right);
                let (near, far) = if first.0 <= second.0 {
                    (first, second)
                } else {
                    (second, first)
                };
                stack[height] = far;
                stack[height + 1] = near;
                height += 2;
            }
        }
        best.map(|found| (found.index(), found.square()))
    }

    /// What `each` makes of every place that `wanted` names and its `count` nearest, in the order of the
    /// tree: with squared distances, ties by index, in no order but that the last of `count` is the farthest; the
    /// place itself is left out.
    pub(crate) fn nearest_of_each<T: Send + Sync>(
        &self,
        count: usize,
        wanted: impl Fn(u32) -> bool + Sync,
        execute: &dyn Execute,
        each: impl Fn(u32, &[Near]) -> T + Sync,
    ) -> Vec<T> {
        let leaves: Vec<usize> = (0..self.nodes.len())
            .filter(|&at| self.nodes[at].right == 0)
            .collect();
        execute::map_blocks(
            execute,
            LEAVES_AT_ONCE,
            leaves.len(),
            Search::default,
            |search, k| self.nearest_of_leaf(leaves[k], count, &wanted, search, &each),
        )
        .into_iter()
        .flatten()
        .collect()
    }

    fn nearest_of_leaf<T>(
        &self,
        leaf: usize,
        count: usize,
        wanted: &impl Fn(u32) -> bool,
        search: &mut Search,
        each: &impl Fn(u32, &[Near]) -> T,
    ) -> Vec<T> {
        let own = &self.nodes[leaf];
        let positions = own.start as usize..own.end as usize;
        if !self.order[positions.clone()].iter().any(|&i| wanted(i)) {
            return Vec::new();
        }
        // Its own leaf bounds how far the neighbors of a place are.
        let bound = if positions.len() > count {
            2.0 * own.radius
        } else {
            f64::INFINITY
        };
        let Search {
            around,
            place,
            near,
        } = search;
        let center = self.center(leaf);
        around.clear();
        self.leaves(center, own.radius + bound, &mut |at, gap| {
            if at != leaf {
                around.push((gap, at as u32));
            }
            false
        });
        around.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let lanes = &self.lanes[own.leaf as usize * self.width..][..self.width];
        let mut out = Vec::with_capacity(positions.len());
        for (lane, &index) in self.order[positions].iter().enumerate() {
            if !wanted(index) {
                continue;
            }
            place.clear();
            place.extend(lanes.iter().map(|row| row[lane]));
            near.clear();
            self.add_closer(own, place, f64::INFINITY, near);
            near.swap_remove(lane);
            let mut farthest = keep_nearest(near, count);
            let mut reach = farthest.sqrt() * (1.0 + ROUNDING);
            let beside = squared_distance(place, center).sqrt() * (1.0 + ROUNDING);
            for &(gap, at) in around.iter() {
                if gap - beside > reach {
                    break;
                }
                let node = &self.nodes[at as usize];
                let outer = reach + node.radius;
                if squared_distance(place, self.center(at as usize)) > outer * outer {
                    continue;
                }
                self.add_closer(node, place, farthest, near);
                if near.len() >= 2 * count {
                    farthest = keep_nearest(near, count);
                    reach = farthest.sqrt() * (1.0 + ROUNDING);
                }
            }
            keep_nearest(near, count);
            out.push(each(index, near));
        }
        out
    }

    /// Adds the places of a leaf that are no farther from `place` than the root of `limit`.
    fn add_closer(&self, leaf: &Node, place: &[f64], limit: f64, near: &mut Vec<Near>) {
        let order = &self.order[leaf.start as usize..leaf.end as usize];
        for (&other, &square) in order.iter().zip(&self.squares(leaf, place)) {
            if square <= limit {
                near.push(Near::new(square, other));
            }
        }
    }
}

/// Keeps the `count` nearest, ties by index, the farthest of them last, and returns how far it is; infinity,
/// and nothing changed, where there are fewer.
fn keep_nearest(near: &mut Vec<Near>, count: usize) -> f64 {
    if near.len() < count {
        return f64::INFINITY;
    }
    let farthest = near.select_nth_unstable(count - 1).1.square();
    near.truncate(count);
    farthest
}

#[cfg(test)]
mod tests;
