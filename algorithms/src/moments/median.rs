//! How a cloud is cut into the nodes of a tree: at medians, across the direction in which a node is widest.

use super::node::Node;
use crate::execute::{self, Execute};
use std::sync::{Mutex, PoisonError};

/// Coordinates that nodes are split along.
const SPLIT_AXES: usize = 8;

/// What nodes are cut from.
pub(super) struct Cut<'a> {
    /// Places in the order of the cloud.
    pub(super) unordered: &'a [f64],
    /// Numbers of a place.
    pub(super) n: usize,
    /// Most points of a leaf.
    pub(super) leaf: usize,
    pub(super) execute: &'a dyn Execute,
}

impl Cut<'_> {
    /// Cuts rows into nodes, in the order of a walk that comes to a node before its children. The two
    /// halves of the first levels are cut side by side.
    pub(super) fn share(&self, rows: &mut [u32], start: u32, levels: usize, nodes: &mut Vec<Node>) {
        if levels == 0 || rows.len() <= self.leaf {
            return self.cut(rows, start, nodes, &mut Vec::new());
        }
        let half = self.halve(rows, &mut Vec::new());
        nodes.push(Node::of(start, rows.len()));
        let at = nodes.len() - 1;
        let (left, right) = rows.split_at_mut(half);
        let halves = [(left, start), (right, start + half as u32)].map(Mutex::new);
        let parts = execute::few(self.execute, 2, |k| {
            let mut part = halves[k].lock().unwrap_or_else(PoisonError::into_inner);
            let (rows, start) = &mut *part;
            let mut nodes = Vec::new();
            self.share(rows, *start, levels - 1, &mut nodes);
            nodes
        });
        for (k, part) in parts.into_iter().enumerate() {
            let shift = nodes.len() as u32;
            if k == 1 {
                nodes[at].right = shift;
            }
            nodes.extend(part.into_iter().map(|mut node| {
                if !node.is_leaf() {
                    node.right += shift;
                }
                node
            }));
        }
    }

    fn cut(
        &self,
        rows: &mut [u32],
        start: u32,
        nodes: &mut Vec<Node>,
        keyed: &mut Vec<(f64, u32)>,
    ) {
        let at = nodes.len();
        nodes.push(Node::of(start, rows.len()));
        if rows.len() <= self.leaf {
            return;
        }
        let half = self.halve(rows, keyed);
        let (left, right) = rows.split_at_mut(half);
        self.cut(left, start, nodes, keyed);
        nodes[at].right = nodes.len() as u32;
        self.cut(right, start + half as u32, nodes, keyed);
    }

    /// Sorts rows to either side of a plane, and returns how many come first.
    fn halve(&self, rows: &mut [u32], keyed: &mut Vec<(f64, u32)>) -> usize {
        let (n, count) = (self.n, rows.len());
        let direction = widest(self.unordered, rows, n);
        // Full leaves, but for the last.
        let mut half = (count / 2).div_ceil(self.leaf) * self.leaf;
        if half >= count {
            half -= self.leaf;
        }
        keyed.clear();
        keyed.extend(rows.iter().map(|&i| {
            let lead = &self.unordered[i as usize * n..][..n.min(SPLIT_AXES)];
            (
                lead.iter().zip(&direction).map(|(y, d)| y * d).sum::<f64>(),
                i,
            )
        }));
        keyed.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (row, key) in rows.iter_mut().zip(&*keyed) {
            *row = key.1;
        }
        half
    }
}

/// The direction that a node is split along: the widest coordinate in R^3 and below, else near
/// the leading principal direction, because sheets that lie askew to all coordinates would be
/// cut into slivers.
fn widest(unordered: &[f64], rows: &[u32], n: usize) -> [f64; SPLIT_AXES] {
    let axes = n.min(SPLIT_AXES);
    let lead = |i: &u32| &unordered[*i as usize * n..][..axes];
    let mut low = [f64::INFINITY; SPLIT_AXES];
    let mut high = [f64::NEG_INFINITY; SPLIT_AXES];
    for i in rows {
        for (k, &y) in lead(i).iter().enumerate() {
            low[k] = low[k].min(y);
            high[k] = high[k].max(y);
        }
    }
    let mut axis = 0;
    for k in 1..axes {
        if high[k] - low[k] > high[axis] - low[axis] {
            axis = k;
        }
    }
    let mut direction = [0.0; SPLIT_AXES];
    direction[axis] = 1.0;
    let extent = high[axis] - low[axis];
    if axes <= 3 || extent <= 0.0 {
        return direction;
    }
    // A few points show the direction; a few rounds from the widest coordinate find it.
    let mut products = [[0.0; SPLIT_AXES]; SPLIT_AXES];
    let mut middle = [0.0; SPLIT_AXES];
    let shown = || rows.iter().step_by((rows.len() / 64).max(1));
    let share = 1.0 / shown().count() as f64;
    for i in shown() {
        for (m, y) in middle.iter_mut().zip(lead(i)) {
            *m += share * y;
        }
    }
    for i in shown() {
        let mut from = [0.0; SPLIT_AXES];
        for ((f, y), m) in from.iter_mut().zip(lead(i)).zip(&middle) {
            *f = (y - m) / extent;
        }
        for (row, x) in products.iter_mut().zip(&from) {
            for (p, y) in row.iter_mut().zip(&from) {
                *p += x * y;
            }
        }
    }
    for _ in 0..6 {
        let mut image = [0.0; SPLIT_AXES];
        for (row, x) in products.iter().zip(&direction) {
            for (o, p) in image.iter_mut().zip(row) {
                *o += p * x;
            }
        }
        let length = image.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length.is_nan() || length <= 0.0 {
            break;
        }
        direction = image.map(|x| x / length);
    }
    direction
}
