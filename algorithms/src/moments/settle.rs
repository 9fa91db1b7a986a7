//! Dimension 2 for all balls about the points of a node at once, with proof.
//!
//! Every ball about a point of the node holds the nodes that are inside of all of them, and is held by
//! these and the fringe together. Scatter about the mean grows with the set in the order of symmetric
//! matrices, so for the scatter B of any of the balls, I of the inner and U of the outer set, and for
//! any plane V and its orthogonal complement W
//!
//! - tr B - l1(B) - l2(B) <= tr_W B <= tr_W U and tr_V B >= tr_V I: what lies outside of two
//!   dimensions is at most the share tr_W U / (tr_V I + tr_W U);
//! - tr B - l1(B) >= l2(I) >= m(I), the smaller eigenvalue of I compressed to V, and l1(B) <= l1(U) <=
//!   tr U - m(U): what lies outside of one dimension is at least the share m(I) / (m(I) + tr U - m(U)).
//!
//! The first below the tolerance and the second not: every ball is 2-dimensional, and none of them has
//! to be summed. Away from curves most nodes of 64 points are settled this way.

use super::packed;
use super::plane::Plane;
use super::reach::Reach;
use crosscap_core::Scalar;

/// Fewest points that a settled ball has.
const LEAST: usize = 16;
/// Rounding must not settle anything.
const MARGIN: f64 = 1e-5;
/// Displacements by rounding, in units of the radius, from which nothing is settled.
const NOISE: f64 = 1e-8;
/// Nodes wider than this, in units of the radius, are not worth a try.
const WIDEST: f64 = 0.3;
/// Up to this many coordinates the points of the fringe are looked at one by one.
const POINTWISE: usize = 3;
/// Points that are added up side by side: a leaf, where there are that few coordinates.
const LANES: usize = 8;

/// What can be said about the balls of a node together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Settled {
    /// All are 2-dimensional; so many points are in the ball about the first one.
    Two(u32),
    /// Smaller nodes may be settled.
    Open,
    /// Some are not 2-dimensional, or nearly so.
    Hopeless,
}

/// Moments about the center of the node.
#[derive(Default)]
struct Moments {
    count: f64,
    sum: Vec<f64>,
    products: Vec<f64>,
}

impl Moments {
    fn reset(&mut self, n: usize) {
        self.count = 0.0;
        self.sum.clear();
        self.sum.resize(n, 0.0);
        self.products.clear();
        self.products.resize(packed::length(n), 0.0);
    }
}

/// Workspace for one node after the other.
pub(super) struct Settler<'a, S: Scalar> {
    reach: &'a Reach<'a, S>,
    stack: Vec<u32>,
    fringe: Vec<u32>,
    /// Points in nodes that are inside of every ball.
    common_count: u32,
    offset: Vec<f64>,
    inner: Moments,
    outer: Moments,
    plane: Plane,
}

impl<'a, S: Scalar> Settler<'a, S> {
    pub(super) fn new(reach: &'a Reach<'a, S>) -> Self {
        Self {
            reach,
            stack: Vec::new(),
            fringe: Vec::new(),
            common_count: 0,
            offset: vec![0.0; reach.tree.n],
            inner: Moments::default(),
            outer: Moments::default(),
            plane: Plane::default(),
        }
    }

    pub(super) fn reach(&self) -> &'a Reach<'a, S> {
        self.reach
    }

    /// Forgets what was kept from the nodes before.
    pub(super) fn forget(&mut self) {
        self.plane.forget();
    }

    /// What can be said about the balls about all points of a node, for the tolerance `dt`.
    #[inline(always)]
    pub(super) fn settle(&mut self, node: u32, dt: f64) -> Settled {
        let tree = self.reach.tree;
        let n = tree.n;
        let center = tree.mean(node as usize);
        let norm = center.iter().map(|x| x * x).sum::<f64>().sqrt();
        let noise = self.reach.noise(norm);
        if n < 2 || tree.scatter_width() == 0 || noise > NOISE {
            return Settled::Hopeless;
        }
        if tree.nodes[node as usize].radius * self.reach.inverse > WIDEST {
            return Settled::Open;
        }
        let shell = self.reach.shell(noise);
        let inner_count = self.gather(node, shell);
        if inner_count < LEAST {
            return Settled::Open;
        }
        let trace = packed::trace(&self.inner.products, n);
        let outer_trace = packed::trace(&self.outer.products, n);
        if !(trace > 0.0 && self.plane.follow(&self.outer.products, n)) {
            return Settled::Open;
        }
        let flat = self.plane.trace_within(&self.inner.products);
        if trace - flat >= dt * trace {
            return Settled::Hopeless;
        }
        let beside = (outer_trace - self.plane.trace_within(&self.outer.products)).max(0.0);
        let second = self.plane.second(&self.inner.products);
        let first = outer_trace - self.plane.second(&self.outer.products);
        if beside < dt * (1.0 - MARGIN) * (flat + beside)
            && second >= dt * (1.0 + MARGIN) * (second + first)
        {
            Settled::Two(self.common_count + self.fringe_count(node, shell))
        } else {
            Settled::Open
        }
    }

    /// Sums the moments about the means of the inner and the outer set; returns the count of the inner.
    #[inline(always)]
    fn gather(&mut self, node: u32, shell: f64) -> usize {
        let n = self.reach.tree.n;
        let inverse = self.reach.inverse;
        let width = self.reach.tree.nodes[node as usize].radius * inverse;
        let (near, far) = (1.0 - shell, 1.0 + shell);
        let inner_count = self.gather_nodes(node, [near, far]);
        self.common_count = inner_count as u32;
        self.outer.count = self.inner.count;
        self.outer.sum.clone_from(&self.inner.sum);
        self.outer.products.clone_from(&self.inner.products);
        if n <= POINTWISE {
            let limits = [(near - width) / inverse, (far + width) / inverse];
            return inner_count + self.gather_points(node, limits);
        }
        self.gather_leaves(node);
        self.center_moments();
        inner_count
    }

    /// Adds the nodes that are inside of every ball to the inner set, and lists the leaves that are inside of some of them as the
    /// fringe. Returns how many points are in the inner set.
    #[inline(always)]
    fn gather_nodes(&mut self, node: u32, [near, far]: [f64; 2]) -> usize {
        let tree = self.reach.tree;
        let inverse = self.reach.inverse;
        let center = tree.mean(node as usize);
        let width = tree.nodes[node as usize].radius * inverse;
        self.inner.reset(tree.n);
        self.fringe.clear();
        self.stack.clear();
        self.stack.push(0);
        let mut inner_count = 0;
        while let Some(at) = self.stack.pop() {
            let other = &tree.nodes[at as usize];
            let mut square = 0.0;
            for ((o, a), b) in self
                .offset
                .iter_mut()
                .zip(tree.mean(at as usize))
                .zip(center)
            {
                *o = a - b;
                square += *o * *o;
            }
            let gap = square.sqrt() * inverse;
            let radius = other.radius * inverse;
            if gap * (1.0 - 1e-9) - width - radius >= far {
                continue;
            }
            if gap + width + radius < near {
                inner_count += other.count();
                add(
                    &mut self.inner,
                    other.count() as f64,
                    &self.offset,
                    tree.scatter(at as usize),
                );
            } else if other.is_leaf() {
                self.fringe.push(at);
            } else {
                self.stack.push(other.right);
                self.stack.push(at + 1);
            }
        }
        inner_count
    }

    /// Adds the leaves of the fringe to the outer set.
    #[inline(always)]
    fn gather_leaves(&mut self, node: u32) {
        let tree = self.reach.tree;
        let center = tree.mean(node as usize);
        for &at in &self.fringe {
            for ((o, a), b) in self
                .offset
                .iter_mut()
                .zip(tree.mean(at as usize))
                .zip(center)
            {
                *o = a - b;
            }
            add(
                &mut self.outer,
                tree.nodes[at as usize].count() as f64,
                &self.offset,
                tree.scatter(at as usize),
            );
        }
    }

    /// Adds the points of the fringe one by one: to the inner set those closer to the center of
    /// the node than the first limit, to the outer set those closer than the second. Returns how many
    /// are in the inner set.
    #[inline(always)]
    fn gather_points(&mut self, node: u32, limits: [f64; 2]) -> usize {
        let tree = self.reach.tree;
        let n = tree.n;
        let center = tree.mean(node as usize);
        // Relative rounding of a distance is far below this.
        let near = (limits[0].max(0.0) * (1.0 - 1e-9)).powi(2);
        let far = (limits[1] * (1.0 + 1e-9)).powi(2);
        // Count, coordinates and products, a leaf at a time: eight points are eight lanes.
        let mut sums = [[[0.0; LANES]; 10]; 2];
        let mut middle = [0.0; POINTWISE];
        middle[..n].copy_from_slice(center);
        for &at in &self.fringe {
            let other = &tree.nodes[at as usize];
            let places = &tree.places[other.start as usize * n..other.end as usize * n];
            for places in places.chunks(LANES * n) {
                let mut offsets = [[0.0; LANES]; POINTWISE];
                // Lanes without a point are nowhere.
                let mut squares = [f64::INFINITY; LANES];
                for (lane, place) in places.chunks_exact(n).enumerate() {
                    squares[lane] = 0.0;
                    for ((o, y), c) in offsets.iter_mut().zip(place).zip(&middle) {
                        o[lane] = y - c;
                    }
                }
                for o in &offsets {
                    for (s, x) in squares.iter_mut().zip(o) {
                        *s += x * x;
                    }
                }
                for (sums, limit) in sums.iter_mut().zip([near, far]) {
                    let weights = squares.map(|s| if s < limit { 1.0 } else { 0.0 });
                    add_weighted(sums, &weights, &offsets);
                }
            }
        }
        let total = |lanes: &[f64; LANES]| lanes.iter().sum::<f64>();
        let [within, reached] = sums.map(|set| set.each_ref().map(total));
        let slots: &[usize] = match n {
            2 => &[4, 5, 7],
            _ => &[4, 5, 6, 7, 8, 9],
        };
        for (moments, extra) in [(&mut self.inner, within), (&mut self.outer, reached)] {
            moments.count += extra[0];
            for (s, x) in moments.sum.iter_mut().zip(&extra[1..4]) {
                *s += x;
            }
            for (p, &slot) in moments.products.iter_mut().zip(slots) {
                *p += extra[slot];
            }
        }
        self.center_moments();
        within[0] as usize
    }

    /// From moments about the center of the node to those about the means.
    #[inline(always)]
    fn center_moments(&mut self) {
        for moments in [&mut self.inner, &mut self.outer] {
            if moments.count > 0.0 {
                let weight = -1.0 / moments.count;
                packed::add_square(&mut moments.products, &moments.sum, weight);
            }
        }
    }

    /// How many points of the fringe are in the ball about the first point of the node.
    fn fringe_count(&self, node: u32, shell: f64) -> u32 {
        let tree = self.reach.tree;
        let n = tree.n;
        let first = tree.nodes[node as usize].start as usize;
        let place = tree.place(first);
        let unit = self.reach.unit;
        let near = (unit * (1.0 - shell)).powi(2);
        let far = (unit * (1.0 + shell)).powi(2);
        let mut count = 0;
        for &at in &self.fringe {
            let other = &tree.nodes[at as usize];
            let own = other.start as usize..other.end as usize;
            let places = &tree.places[own.start * n..own.end * n];
            for (position, other) in own.zip(places.chunks_exact(n)) {
                let square: f64 = place
                    .iter()
                    .zip(other)
                    .map(|(a, b)| (a - b) * (a - b))
                    .sum();
                let inside = square < near || square < far && self.reach.holds(first, position);
                count += u32::from(inside);
            }
        }
        count
    }
}

/// Adds weights, weighted coordinates and weighted products of coordinates, lane by lane.
#[inline(always)]
fn add_weighted(
    sums: &mut [[f64; LANES]; 10],
    weights: &[f64; LANES],
    offsets: &[[f64; LANES]; POINTWISE],
) {
    let [x, y, z] = offsets;
    for lane in 0..LANES {
        let w = weights[lane];
        let (wx, wy, wz) = (w * x[lane], w * y[lane], w * z[lane]);
        let row = [
            w,
            wx,
            wy,
            wz,
            wx * x[lane],
            wx * y[lane],
            wx * z[lane],
            wy * y[lane],
            wy * z[lane],
            wz * z[lane],
        ];
        for (sum, term) in sums.iter_mut().zip(row) {
            sum[lane] += term;
        }
    }
}

#[inline(always)]
fn add(moments: &mut Moments, count: f64, offset: &[f64], scatter: &[f64]) {
    moments.count += count;
    for (s, o) in moments.sum.iter_mut().zip(offset) {
        *s += count * o;
    }
    packed::add_shifted(&mut moments.products, scatter, offset, count, 1.0);
}
