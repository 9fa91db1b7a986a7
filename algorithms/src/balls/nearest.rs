//! The nearest place, and the nearest few of many places.

use super::tree::{BallTree, Node, ROUNDING};
use crate::execute::{self, Execute};
use crosscap_core::squared_distance;

/// Leaves that are worked on together.
const LEAVES_AT_ONCE: usize = 8;

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
        self.look_around(leaf, count, &mut search.around);
        let lanes = &self.lanes[own.leaf as usize * self.width..][..self.width];
        let mut out = Vec::with_capacity(positions.len());
        for (lane, &index) in self.order[positions].iter().enumerate() {
            if wanted(index) {
                search.place.clear();
                search.place.extend(lanes.iter().map(|row| row[lane]));
                self.nearest_of_lane(leaf, lane, count, search);
                out.push(each(index, &search.near));
            }
        }
        out
    }

    /// The leaves that can hold one of the `count` nearest of a place of a leaf, nearest first.
    #[inline]
    fn look_around(&self, leaf: usize, count: usize, around: &mut Vec<(f64, u32)>) {
        let own = &self.nodes[leaf];
        // Its own leaf bounds how far the neighbors of a place are.
        let bound = if (own.end - own.start) as usize > count {
            2.0 * own.radius
        } else {
            f64::INFINITY
        };
        around.clear();
        self.leaves(self.center(leaf), own.radius + bound, &mut |at, gap| {
            if at != leaf {
                around.push((gap, at as u32));
            }
            false
        });
        around.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// The `count` nearest of the place in a lane of a leaf, from the leaves that were found around it.
    #[inline]
    fn nearest_of_lane(&self, leaf: usize, lane: usize, count: usize, search: &mut Search) {
        let Search {
            around,
            place,
            near,
        } = search;
        near.clear();
        self.add_closer(&self.nodes[leaf], place, f64::INFINITY, near);
        near.swap_remove(lane);
        let mut farthest = keep_nearest(near, count);
        let mut reach = farthest.sqrt() * (1.0 + ROUNDING);
        let beside = squared_distance(place, self.center(leaf)).sqrt() * (1.0 + ROUNDING);
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
