//! A tree of balls over a few places, for queries about many of them at once.

use crate::execute::{self, Execute};
use crosscap_core::squared_distance;

/// Most places of a leaf: more than the neighbors that are asked for, so that a leaf alone bounds
/// how far they are.
const LEAF: usize = 32;
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
    /// Largest distance of a place from the center.
    radius: f64,
}

/// Places of R^N in leaf order under nested balls.
///
/// Built in O(n log n) distances; the neighbors of places that lie together are looked up leaf by leaf.
pub(super) struct BallTree {
    width: usize,
    /// The caller's index at every position.
    order: Vec<u32>,
    /// Places in leaf order, `width` numbers each.
    places: Vec<f64>,
    nodes: Vec<Node>,
    centers: Vec<f64>,
}

/// The nearest places of one, by distance, ties by index, itself left out.
pub(super) struct Nearest {
    /// The caller's index of the place.
    pub(super) index: u32,
    /// Those near it, with their squared distances.
    pub(super) near: Vec<(f64, u32)>,
}

impl BallTree {
    /// A tree over `places`, `width` numbers each; they are named by their position there.
    pub(super) fn new(width: usize, places: &[f64]) -> Self {
        let count = places.len() / width.max(1);
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut tree = Self {
            width,
            order: Vec::new(),
            places: Vec::with_capacity(places.len()),
            nodes: Vec::new(),
            centers: Vec::new(),
        };
        if count > 0 {
            tree.split(places, &mut order, 0, &mut Vec::new());
        }
        for &i in &order {
            tree.places
                .extend_from_slice(&places[i as usize * width..(i as usize + 1) * width]);
        }
        tree.order = order;
        tree.measure();
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
        self.nodes.push(Node {
            start: start as u32,
            end: (start + rows.len()) as u32,
            right: 0,
            radius: 0.0,
        });
        if rows.len() <= LEAF {
            return;
        }
        let width = self.width;
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
        let half = rows.len() / 2;
        keyed.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (row, key) in rows.iter_mut().zip(&*keyed) {
            *row = key.1;
        }
        let (left, right) = rows.split_at_mut(half);
        self.split(places, left, start, keyed);
        self.nodes[at].right = self.nodes.len() as u32;
        self.split(places, right, start + half, keyed);
    }

    /// Centers and radii.
    fn measure(&mut self) {
        let width = self.width;
        self.centers = vec![0.0; self.nodes.len() * width];
        for (node, center) in self
            .nodes
            .iter_mut()
            .zip(self.centers.chunks_exact_mut(width.max(1)))
        {
            let places = &self.places[node.start as usize * width..node.end as usize * width];
            for place in places.chunks_exact(width) {
                for (c, x) in center.iter_mut().zip(place) {
                    *c += x;
                }
            }
            let share = 1.0 / f64::from(node.end - node.start);
            center.iter_mut().for_each(|c| *c *= share);
            node.radius = places
                .chunks_exact(width)
                .map(|place| squared_distance(place, center))
                .fold(0.0, f64::max)
                .sqrt()
                * (1.0 + ROUNDING);
        }
    }

    fn center(&self, node: usize) -> &[f64] {
        &self.centers[node * self.width..(node + 1) * self.width]
    }

    fn place(&self, position: usize) -> &[f64] {
        &self.places[position * self.width..(position + 1) * self.width]
    }

    /// Visits every place closer to `place` than `radius`, with its squared distance.
    pub(super) fn within(&self, place: &[f64], radius: f64, mut visit: impl FnMut(u32, f64)) {
        let limit = radius * radius;
        self.leaves(place, radius, &mut |leaf, _| {
            let node = &self.nodes[leaf];
            for position in node.start as usize..node.end as usize {
                let square = squared_distance(place, self.place(position));
                if square < limit {
                    visit(self.order[position], square);
                }
            }
        });
    }

    /// Visits the leaves whose balls come as close to `place` as `reach`, with that gap.
    fn leaves(&self, place: &[f64], reach: f64, visit: &mut impl FnMut(usize, f64)) {
        if self.nodes.is_empty() {
            return;
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
                visit(at, gap);
            } else {
                // Halves, so the tree is not higher than the bits of an index.
                stack[height] = node.right;
                stack[height + 1] = at as u32 + 1;
                height += 2;
            }
        }
    }

    /// The `count` nearest of every place that `wanted` names, in the order of the tree.
    pub(super) fn nearest_of_each(
        &self,
        count: usize,
        wanted: impl Fn(u32) -> bool + Sync,
        execute: &dyn Execute,
    ) -> Vec<Nearest> {
        let leaves: Vec<usize> = (0..self.nodes.len())
            .filter(|&at| self.nodes[at].right == 0)
            .collect();
        execute::map_blocks(
            execute,
            LEAVES_AT_ONCE,
            leaves.len(),
            Vec::new,
            |around, k| self.nearest_of_leaf(leaves[k], count, &wanted, around),
        )
        .into_iter()
        .flatten()
        .collect()
    }

    fn nearest_of_leaf(
        &self,
        leaf: usize,
        count: usize,
        wanted: &impl Fn(u32) -> bool,
        around: &mut Vec<(f64, u32)>,
    ) -> Vec<Nearest> {
        let node = &self.nodes[leaf];
        let own = node.start as usize..node.end as usize;
        if !own.clone().any(|p| wanted(self.order[p])) {
            return Vec::new();
        }
        // Its own leaf bounds how far the neighbors of a place are.
        let bound = if own.len() > count {
            2.0 * node.radius
        } else {
            f64::INFINITY
        };
        around.clear();
        self.leaves(self.center(leaf), node.radius + bound, &mut |at, gap| {
            around.push((gap, at as u32));
        });
        around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut out = Vec::with_capacity(own.len());
        for position in own.filter(|&p| wanted(self.order[p])) {
            let place = self.place(position);
            let mut near: Vec<(f64, u32)> = Vec::with_capacity(count + 1);
            for &(_, at) in around.iter() {
                let node = &self.nodes[at as usize];
                if near.len() == count {
                    let gap = squared_distance(place, self.center(at as usize)).sqrt()
                        * (1.0 - ROUNDING)
                        - node.radius;
                    let farthest = near[count - 1].0;
                    if gap > 0.0 && gap * gap > farthest {
                        continue;
                    }
                }
                for other in node.start as usize..node.end as usize {
                    let square = squared_distance(place, self.place(other));
                    if near.len() == count && square > near[count - 1].0 || other == position {
                        continue;
                    }
                    let entry = (square, self.order[other]);
                    let slot = near.partition_point(|x| (x.0, x.1) < entry);
                    near.insert(slot, entry);
                    near.truncate(count);
                }
            }
            out.push(Nearest {
                index: self.order[position],
                near,
            });
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn answers_equal_a_scan(
            width in 1_usize..5,
            // A small lattice, so that distances are equal and places coincide.
            lattice in prop::collection::vec(0_i32..6, 4..600),
            radius in 0.5_f64..4.0,
            count in 1_usize..16,
        ) {
            let n = lattice.len() / width;
            let places: Vec<f64> = lattice[..n * width].iter().map(|&x| f64::from(x)).collect();
            let tree = BallTree::new(width, &places);
            let square = |a: usize, b: usize| {
                squared_distance(&places[a * width..(a + 1) * width], &places[b * width..(b + 1) * width])
            };
            let found = tree.nearest_of_each(count, |i| i % 3 != 1, &Serial);
            prop_assert_eq!(found.len(), (0..n).filter(|i| i % 3 != 1).count());
            for one in found {
                let i = one.index as usize;
                let mut all: Vec<(f64, u32)> =
                    (0..n).filter(|&j| j != i).map(|j| (square(i, j), j as u32)).collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap());
                all.truncate(count);
                prop_assert_eq!(one.near, all);
            }
            for i in (0..n).step_by(7) {
                let mut inside = Vec::new();
                tree.within(&places[i * width..(i + 1) * width], radius, |j, _| inside.push(j as usize));
                inside.sort_unstable();
                let expected: Vec<usize> = (0..n).filter(|&j| square(i, j) < radius * radius).collect();
                prop_assert_eq!(inside, expected);
            }
        }
    }
}
