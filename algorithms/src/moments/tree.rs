//! A median-split tree that knows the moments of its nodes.

use super::median::Cut;
use super::node::Node;
use super::packed;
use super::placement::Placement;
use crate::execute::{self, Execute};
use crosscap_core::{PointCloud, Scalar, squared_distance};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// With more coordinates the nodes keep no outer products: they would outgrow the cloud.
pub(super) const WIDEST_MOMENTS: usize = 64;

/// Levels of the tree below which its parts are built side by side.
const SHARED_LEVELS: usize = 5;

/// Points in leaf order, and nodes with mean, scatter and radius.
pub(super) struct Tree {
    pub(super) placement: Placement,
    /// Coordinates of a point.
    pub(super) n: usize,
    /// Row of the cloud at every position.
    pub(super) order: Vec<u32>,
    /// Places in leaf order, `n` each.
    pub(super) places: Vec<f64>,
    pub(super) nodes: Vec<Node>,
    /// Mean of every node, `n` each.
    pub(super) means: Vec<f64>,
    /// Sum of outer products about the mean of every node, packed; empty for wide clouds.
    pub(super) scatters: Vec<f64>,
    /// Most points of a leaf.
    pub(super) leaf: usize,
}

impl Tree {
    /// The tree, which does not depend on what runs its parts.
    pub(super) fn new<S: Scalar>(cloud: &PointCloud<S>, execute: &dyn Execute) -> Self {
        let (placement, unordered) = Placement::of(cloud, execute);
        let n = placement.n;
        let mut order: Vec<u32> = (0..cloud.len() as u32).collect();
        let mut tree = Self {
            placement,
            n,
            order: Vec::new(),
            places: Vec::new(),
            nodes: Vec::new(),
            means: Vec::new(),
            scatters: Vec::new(),
            leaf: if n <= 3 { 8 } else { 16 },
        };
        if !order.is_empty() {
            let cut = Cut {
                unordered: &unordered,
                n,
                leaf: tree.leaf,
                execute,
            };
            cut.share(&mut order, 0, SHARED_LEVELS, &mut tree.nodes);
        }
        tree.places.reserve_exact(unordered.len());
        for &i in &order {
            tree.places
                .extend_from_slice(&unordered[i as usize * n..(i as usize + 1) * n]);
        }
        tree.order = order;
        drop(unordered);
        tree.measure(execute);
        tree
    }

    /// Means, scatters and radii, children first: subtrees side by side, then what is above them.
    fn measure(&mut self, execute: &dyn Execute) {
        let (n, width) = (self.n, self.scatter_width());
        let count = self.nodes.len();
        let mut means = vec![0.0; count * n];
        let mut scatters = vec![0.0; count * width];
        let mut radii = vec![0.0; count];
        let mut above = Vec::new();
        let mut subtrees = Vec::new();
        if count > 0 {
            self.divide(0, count, SHARED_LEVELS, &mut above, &mut subtrees);
        }
        let mut parts = Vec::with_capacity(subtrees.len());
        let mut rest = (&mut means[..], &mut scatters[..], &mut radii[..]);
        let mut from = 0;
        for nodes in &subtrees {
            let skipped = nodes.start - from;
            let (_, m) = rest.0.split_at_mut(skipped * n);
            let (_, s) = rest.1.split_at_mut(skipped * width);
            let (_, r) = rest.2.split_at_mut(skipped);
            let (own_means, m) = m.split_at_mut(nodes.len() * n);
            let (own_scatters, s) = s.split_at_mut(nodes.len() * width);
            let (own_radii, r) = r.split_at_mut(nodes.len());
            parts.push(Mutex::new(Measures {
                first: nodes.start,
                means: own_means,
                scatters: own_scatters,
                radii: own_radii,
            }));
            rest = (m, s, r);
            from = nodes.end;
        }
        execute::few(execute, parts.len(), |k| {
            let mut part = parts[k].lock().unwrap_or_else(PoisonError::into_inner);
            self.measure_nodes(subtrees[k].clone().rev(), &mut part);
        });
        drop(parts);
        let mut whole = Measures {
            first: 0,
            means: &mut means,
            scatters: &mut scatters,
            radii: &mut radii,
        };
        self.measure_nodes(above.into_iter().rev(), &mut whole);
        for (node, radius) in self.nodes.iter_mut().zip(radii) {
            node.radius = radius;
        }
        self.means = means;
        self.scatters = scatters;
    }

    /// The subtrees so many levels below a node, whose own nodes end before `end`, and the nodes above them,
    /// both in order.
    fn divide(
        &self,
        at: usize,
        end: usize,
        levels: usize,
        above: &mut Vec<usize>,
        subtrees: &mut Vec<Range<usize>>,
    ) {
        let node = &self.nodes[at];
        if node.is_leaf() || levels == 0 {
            return subtrees.push(at..end);
        }
        above.push(at);
        let right = node.right as usize;
        self.divide(at + 1, right, levels - 1, above, subtrees);
        self.divide(right, end, levels - 1, above, subtrees);
    }

    /// Measures nodes, every one after its children.
    fn measure_nodes(&self, nodes: impl Iterator<Item = usize>, out: &mut Measures<'_>) {
        let n = self.n;
        let width = self.scatter_width();
        let first = out.first;
        let mut offset = vec![0.0; n];
        for at in nodes {
            let node = &self.nodes[at];
            let places = &self.places[node.start as usize * n..node.end as usize * n];
            let (before, after) = out.means.split_at_mut((at - first + 1) * n);
            let mean = &mut before[(at - first) * n..];
            let (_, scatters_from) = out.scatters.split_at_mut((at - first) * width);
            let (scatter, scatters_after) = scatters_from.split_at_mut(width);
            if node.is_leaf() {
                for place in places.chunks_exact(n) {
                    for (m, y) in mean.iter_mut().zip(place) {
                        *m += y;
                    }
                }
                mean.iter_mut().for_each(|m| *m /= node.count() as f64);
            } else {
                for child in [at + 1, node.right as usize] {
                    let share = self.nodes[child].count() as f64 / node.count() as f64;
                    for (m, c) in mean.iter_mut().zip(&after[(child - at - 1) * n..]) {
                        *m += share * c;
                    }
                }
                for child in [at + 1, node.right as usize] {
                    if width > 0 {
                        let child_mean = &after[(child - at - 1) * n..(child - at) * n];
                        for ((o, c), m) in offset.iter_mut().zip(child_mean).zip(&*mean) {
                            *o = c - m;
                        }
                        let from = &scatters_after[(child - at - 1) * width..][..width];
                        let count = self.nodes[child].count() as f64;
                        packed::add_shifted(scatter, from, &offset, count, 1.0);
                    }
                }
            }
            let mut farthest = 0.0_f64;
            for place in places.chunks_exact(n) {
                farthest = farthest.max(squared_distance(place, mean));
                if node.is_leaf() && width > 0 {
                    for ((o, y), m) in offset.iter_mut().zip(place).zip(&*mean) {
                        *o = y - m;
                    }
                    packed::add_square(scatter, &offset, 1.0);
                }
            }
            out.radii[at - first] = farthest.sqrt();
        }
    }

    /// Numbers that a node keeps of its outer products.
    pub(super) fn scatter_width(&self) -> usize {
        if self.n <= WIDEST_MOMENTS {
            packed::length(self.n)
        } else {
            0
        }
    }

    pub(super) fn mean(&self, node: usize) -> &[f64] {
        &self.means[node * self.n..(node + 1) * self.n]
    }

    pub(super) fn scatter(&self, node: usize) -> &[f64] {
        let width = self.scatter_width();
        &self.scatters[node * width..(node + 1) * width]
    }

    pub(super) fn place(&self, position: usize) -> &[f64] {
        &self.places[position * self.n..(position + 1) * self.n]
    }
}

/// Means, scatters and radii of the nodes from `first` on.
struct Measures<'a> {
    first: usize,
    means: &'a mut [f64],
    scatters: &'a mut [f64],
    radii: &'a mut [f64],
}
