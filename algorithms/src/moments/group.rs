//! All balls about a few points that lie together.
//!
//! The nodes inside of every ball are summed once. What some of the spheres may cut, the fringe,
//! is copied to a small frame: origin in the middle of the centers, the radius as unit, turned so
//! that the first directions are those of largest variance. In more than six dimensions only six
//! directions are kept, and of the rest the distance from their span, which brackets both
//! distances and spectra; what a bracket does not settle is looked up in all coordinates.

use super::decide;
use super::frame::Directions;
use super::packed;
use super::reach::Reach;
use super::tree::WIDEST_MOMENTS;
use crate::principal::PrincipalFrame;
use crosscap_core::{BallDimension, Scalar};

/// Most centers of a group.
const MOST_CENTERS: usize = 64;
/// Largest radius of a group, in units of the radius of the balls.
const WIDEST: f64 = 0.5;
/// A leaf is counted from its outsiders where this share of it is inside.
const COMPLEMENT: f64 = 0.6;
/// Relative error of the covariance from which it is computed from the original coordinates.
const ACCURACY: f64 = 1e-10;
/// Where no point is.
const FAR: f32 = f32::INFINITY;

/// Consecutive centers.
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub(super) start: u32,
    pub(super) end: u32,
    /// The node they fill, unless the group is a single point.
    pub(super) node: Option<u32>,
}

/// Groups that cover all positions in order.
pub(super) fn groups<S: Scalar>(reach: &Reach<'_, S>) -> Vec<Group> {
    let tree = reach.tree;
    let mut groups = Vec::new();
    let mut at = 0;
    // Preorder: a node that becomes a group is followed by what comes after its subtree.
    while at < tree.nodes.len() {
        let node = &tree.nodes[at];
        if node.radius <= WIDEST * reach.unit && node.count() <= MOST_CENTERS {
            groups.push(Group {
                start: node.start,
                end: node.end,
                node: Some(at as u32),
            });
            let end = node.end;
            while at < tree.nodes.len() && tree.nodes[at].start < end {
                at += 1;
            }
            continue;
        }
        if node.is_leaf() {
            groups.extend((node.start..node.end).map(|p| Group {
                start: p,
                end: p + 1,
                node: None,
            }));
        }
        at += 1;
    }
    groups
}

/// Which parts of the fringe are in a ball.
#[derive(Default)]
struct Parts {
    /// Units that are inside as a whole.
    inside: Vec<u32>,
    /// Units of which the slots in `minus` are outside.
    most: Vec<u32>,
    /// Single slots that are inside.
    plus: Vec<u32>,
    /// Single slots that are outside, of the units in `most`.
    minus: Vec<u32>,
    straddling: Vec<u32>,
    /// What is used of `plus` and `minus`.
    plus_length: usize,
    minus_length: usize,
    /// Points in the ball.
    count: u32,
}

impl Parts {
    fn plus(&self) -> &[u32] {
        &self.plus[..self.plus_length]
    }

    fn minus(&self) -> &[u32] {
        &self.minus[..self.minus_length]
    }
}

/// Takes a position and the moments of the ball about it, or where they are not accurate its rows.
type Each<'e> = dyn FnMut(usize, Result<Ball<'_>, &[usize]>) + 'e;

/// What is found out about one ball.
pub(super) struct Ball<'a> {
    /// Points in it.
    pub(super) count: u32,
    /// Mean, in all coordinates of the tree about `center`.
    pub(super) mean: &'a [f64],
    /// Covariance, packed.
    pub(super) covariance: &'a [f64],
    pub(super) center: &'a [f64],
}

/// Workspace for one group after the other. `L` is the most points of a leaf, `M` the number of
/// coordinates of the frame, of which those beyond `n` are zero.
pub(super) struct Sweep<'a, S: Scalar, const L: usize, const M: usize> {
    reach: &'a Reach<'a, S>,
    /// Coordinates of the tree.
    n: usize,
    /// Whether there are directions beside those of the frame.
    rest: bool,
    /// Numbers summed over a ball: products, coordinates, squared distance from the span.
    width: usize,
    center: Vec<f64>,
    offset: Vec<f64>,
    shell: f64,
    noise: f64,
    stack: Vec<u32>,
    common: Vec<u32>,
    fringe: Vec<u32>,
    /// Moments of the common nodes about the center in all coordinates, units of the tree.
    common_count: u32,
    common_sum: Vec<f64>,
    common_products: Vec<f64>,
    common_features: Vec<f64>,
    dense: Vec<f64>,
    directions: Directions,
    /// The directions coordinate by coordinate.
    columns: Vec<[f64; M]>,
    /// Coordinates of the fringe, unit by unit, direction by direction, lane by lane.
    lanes: Vec<[f32; L]>,
    /// Middle of every unit, direction by direction, its radius, its largest distance from the span.
    middles: Vec<f32>,
    radii: Vec<f32>,
    rests: Vec<f32>,
    gaps: Vec<f32>,
    features: Vec<f64>,
    unit_features: Vec<f64>,
    sum: Vec<f64>,
    parts: Parts,
    full_sum: Vec<f64>,
    full_products: Vec<f64>,
    /// The place that was looked at last, in the frame, and its distance from the span.
    local: [f64; M],
    beside: f64,
    rows: Vec<usize>,
}

impl<'a, S: Scalar, const L: usize, const M: usize> Sweep<'a, S, L, M> {
    pub(super) fn new(reach: &'a Reach<'a, S>) -> Self {
        let n = reach.tree.n;
        let rest = n > M;
        Self {
            reach,
            n,
            rest,
            width: (packed::length(M) + M + 1).next_multiple_of(2),
            center: vec![0.0; n],
            offset: vec![0.0; n],
            shell: 0.0,
            noise: 0.0,
            stack: Vec::new(),
            common: Vec::new(),
            fringe: Vec::new(),
            common_count: 0,
            common_sum: vec![0.0; n],
            common_products: vec![0.0; reach.tree.scatter_width()],
            common_features: Vec::new(),
            dense: Vec::new(),
            directions: Directions::default(),
            columns: vec![[0.0; M]; n],
            lanes: Vec::new(),
            middles: Vec::new(),
            radii: Vec::new(),
            rests: Vec::new(),
            gaps: Vec::new(),
            features: Vec::new(),
            unit_features: Vec::new(),
            sum: Vec::new(),
            parts: Parts::default(),
            full_sum: Vec::new(),
            full_products: Vec::new(),
            local: [0.0; M],
            beside: 0.0,
            rows: Vec::new(),
        }
    }

    /// Forgets what was kept from the groups before.
    pub(super) fn forget(&mut self) {
        self.directions.forget();
    }

    /// Whether the nodes have outer products.
    fn has_moments(&self) -> bool {
        self.n <= WIDEST_MOMENTS
    }

    /// Count and dimension of every ball of the group, in the order of the tree.
    ///
    /// Those that `out` has already are left alone.
    #[inline(always)]
    pub(super) fn dimensions(&mut self, group: Group, dt: f64, out: &mut [Option<BallDimension>]) {
        if out.iter().all(Option::is_some) {
            return;
        }
        self.prepare(group);
        for (position, out) in (group.start as usize..).zip(out) {
            if out.is_none() {
                self.part(position);
                let count = self.parts.count;
                let dimension = if count <= 1 { 0 } else { self.dimension(dt) };
                *out = Some(BallDimension {
                    neighbors: count,
                    dimension,
                });
            }
        }
    }

    /// Moments of every ball of the group in all coordinates.
    pub(super) fn balls(&mut self, group: Group, each: &mut Each<'_>) {
        self.prepare(group);
        for position in group.start as usize..group.end as usize {
            self.part(position);
            if self.has_moments() && self.full() {
                let ball = Ball {
                    count: self.parts.count,
                    mean: &self.full_sum,
                    covariance: &self.full_products,
                    center: &self.center,
                };
                each(position, Ok(ball));
            } else {
                self.collect();
                each(position, Err(&self.rows));
            }
        }
    }

    /// Sums what is in every ball, and copies the fringe to the frame of the group.
    #[inline(always)]
    fn prepare(&mut self, group: Group) {
        let tree = self.reach.tree;
        let (middle, width) = match group.node {
            Some(node) => (tree.mean(node as usize), tree.nodes[node as usize].radius),
            None => (tree.place(group.start as usize), 0.0),
        };
        self.center.copy_from_slice(middle);
        let norm = self.center.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.noise = self.reach.noise(norm);
        self.shell = self.reach.shell(self.noise);
        self.descend(width * self.reach.inverse);
        self.sum_common();
        self.turn();
        for (i, row) in self.directions.rows.chunks_exact(self.n).enumerate() {
            for (column, x) in self.columns.iter_mut().zip(row) {
                column[i] = *x;
            }
        }
        self.copy_fringe();
        self.compress_common();
    }

    #[inline(always)]
    fn descend(&mut self, width: f64) {
        let tree = self.reach.tree;
        let (near, far) = (1.0 - self.shell, 1.0 + self.shell);
        self.common.clear();
        self.fringe.clear();
        self.stack.clear();
        self.stack.push(0);
        while let Some(at) = self.stack.pop() {
            let node = &tree.nodes[at as usize];
            let mean = tree.mean(at as usize);
            let gap = squared_gap(mean, &self.center).sqrt() * self.reach.inverse;
            let radius = node.radius * self.reach.inverse;
            if gap * (1.0 - 1e-9) - width - radius >= far {
                continue;
            }
            if gap + width + radius < near {
                self.common.push(at);
            } else if node.is_leaf() {
                self.fringe.push(at);
            } else {
                self.stack.push(node.right);
                self.stack.push(at + 1);
            }
        }
    }

    #[inline(always)]
    fn sum_common(&mut self) {
        let tree = self.reach.tree;
        self.common_sum.fill(0.0);
        self.common_products.fill(0.0);
        self.common_count = 0;
        for &at in &self.common {
            let count = tree.nodes[at as usize].count();
            self.common_count += count as u32;
            if self.common_products.is_empty() {
                continue;
            }
            let mean = tree.mean(at as usize);
            for ((o, s), (a, b)) in (self.offset.iter_mut().zip(&mut self.common_sum))
                .zip(mean.iter().zip(&self.center))
            {
                *o = a - b;
                *s += count as f64 * *o;
            }
            packed::add_shifted(
                &mut self.common_products,
                tree.scatter(at as usize),
                &self.offset,
                count as f64,
                1.0,
            );
        }
    }

    /// Finds the directions of the frame.
    #[inline(always)]
    fn turn(&mut self) {
        let n = self.n;
        let m = n.min(M);
        if n <= 3 || !self.has_moments() {
            return self.directions.reset(m, n);
        }
        let tree = self.reach.tree;
        self.full_sum.clone_from(&self.common_sum);
        self.full_products.clone_from(&self.common_products);
        let mut count = f64::from(self.common_count);
        if count < 4.0 * n as f64 {
            for &at in &self.fringe {
                let own = tree.nodes[at as usize].count() as f64;
                let mean = tree.mean(at as usize);
                for ((o, s), (a, b)) in (self.offset.iter_mut().zip(&mut self.full_sum))
                    .zip(mean.iter().zip(&self.center))
                {
                    *o = a - b;
                    *s += own * *o;
                }
                packed::add_shifted(
                    &mut self.full_products,
                    tree.scatter(at as usize),
                    &self.offset,
                    own,
                    1.0,
                );
                count += own;
            }
        }
        if count > 0.0 {
            packed::add_square(&mut self.full_products, &self.full_sum, -1.0 / count);
        }
        let trace = packed::trace(&self.full_products, n);
        if trace > 0.0 {
            self.full_products.iter_mut().for_each(|x| *x /= trace);
        }
        packed::unfold(&self.full_products, n, &mut self.dense);
        self.directions.follow(&self.dense, m, n);
    }

    /// Writes a place in the frame to `local` and `beside`.
    #[inline(always)]
    fn localize(&mut self, position: usize) {
        let place = self.reach.tree.place(position);
        for ((o, y), c) in self.offset.iter_mut().zip(place).zip(&self.center) {
            *o = (y - c) * self.reach.inverse;
        }
        self.local = [0.0; M];
        if self.n <= 3 {
            for (z, o) in self.local.iter_mut().zip(&self.offset) {
                *z = *o;
            }
            return;
        }
        // Direction by direction it would be a chain of dependent additions.
        let mut local = [0.0; M];
        for (column, x) in self.columns.iter().zip(&self.offset) {
            for (z, d) in local.iter_mut().zip(column) {
                *z += d * x;
            }
        }
        self.local = local;
        if self.rest {
            let inner: f64 = local.iter().map(|z| z * z).sum();
            self.beside = (sum_of_squares(&self.offset) - inner).max(0.0).sqrt();
        }
    }

    #[inline(always)]
    fn copy_fringe(&mut self) {
        let width = self.width;
        let units = self.fringe.len();
        let tree = self.reach.tree;
        let tests = M + usize::from(self.rest);
        self.lanes.clear();
        self.lanes.resize(units * tests, [FAR; L]);
        // Units are written as a whole, so nothing old is read; one more keeps all offsets valid.
        self.features
            .resize(self.features.len().max((units + 1) * L * width), 0.0);
        self.unit_features
            .resize(self.unit_features.len().max((units + 1) * width), 0.0);
        self.middles.resize(self.middles.len().max(units * M), 0.0);
        self.radii.clear();
        self.rests.clear();
        self.gaps.resize(units, 0.0);
        for unit in 0..units {
            let node = &tree.nodes[self.fringe[unit] as usize];
            let (start, count) = (node.start as usize, node.count());
            let mut farthest_rest = 0.0_f64;
            let mut places = [[0.0; M]; L];
            let at = unit * L * width;
            self.unit_features[unit * width..(unit + 1) * width].fill(0.0);
            self.features[at + count * width..at + L * width].fill(0.0);
            for (lane, place) in places.iter_mut().enumerate().take(count) {
                self.localize(start + lane);
                *place = self.local;
                let features = &mut self.features[at + lane * width..at + (lane + 1) * width];
                write_features(place, self.beside, features);
                let own = &mut self.unit_features[unit * width..(unit + 1) * width];
                for (s, f) in own.iter_mut().zip(&*features) {
                    *s += f;
                }
                farthest_rest = farthest_rest.max(self.beside);
                if self.rest {
                    self.lanes[unit * tests + M][lane] = self.beside as f32;
                }
            }
            let lanes = &mut self.lanes[unit * tests..unit * tests + M];
            let mut middle = [0.0; M];
            let share = 1.0 / count as f64;
            for (lane, place) in places.iter().enumerate().take(count) {
                for k in 0..M {
                    lanes[k][lane] = place[k] as f32;
                    middle[k] += place[k] * share;
                }
            }
            let mut farthest = 0.0_f64;
            for place in &places[..count] {
                let square: f64 = place
                    .iter()
                    .zip(&middle)
                    .map(|(a, b)| (a - b) * (a - b))
                    .sum();
                farthest = farthest.max(square);
            }
            for (k, x) in middle.iter().enumerate() {
                self.middles[k * units + unit] = *x as f32;
            }
            self.radii.push((farthest.sqrt() * (1.0 + 1e-6)) as f32);
            self.rests.push((farthest_rest * (1.0 + 1e-6)) as f32);
        }
    }

    /// The common moments in the frame.
    #[inline(always)]
    fn compress_common(&mut self) {
        let n = self.n;
        self.common_features.clear();
        self.common_features.resize(self.width, 0.0);
        if self.common_products.is_empty() {
            return;
        }
        let inverse = self.reach.inverse;
        let square = inverse * inverse;
        let length = packed::length(M);
        packed::unfold(&self.common_products, n, &mut self.dense);
        let rows = &self.directions.rows;
        let mut inner = 0.0;
        let mut first = 0;
        for (i, v) in rows.chunks_exact(n).enumerate() {
            self.offset.fill(0.0);
            for (row, x) in self.dense.chunks_exact(n).zip(v) {
                for (o, a) in self.offset.iter_mut().zip(row) {
                    *o += a * x;
                }
            }
            for (j, w) in rows.chunks_exact(n).enumerate().skip(i) {
                let product = w.iter().zip(&self.offset).map(|(a, b)| a * b).sum::<f64>() * square;
                if i == j {
                    inner += product;
                }
                self.common_features[first + j - i] = product;
            }
            first += M - i;
            self.common_features[length + i] = v
                .iter()
                .zip(&self.common_sum)
                .map(|(a, b)| a * b)
                .sum::<f64>()
                * inverse;
        }
        if self.rest {
            let whole = packed::trace(&self.common_products, n) * square;
            self.common_features[length + M] = (whole - inner).max(0.0);
        }
    }

    /// Finds which parts of the fringe are in the ball about a position.
    #[inline(always)]
    fn part(&mut self, position: usize) {
        self.localize(position);
        let units = self.fringe.len();
        let tree = self.reach.tree;
        let tests = M + usize::from(self.rest);
        let query = self.local.map(|z| z as f32);
        let beside = self.beside as f32;
        let shell = self.shell as f32;
        // Where the shell is everything: NaN refuses every comparison.
        let (near_limit, far_limit) = if shell < 0.1 {
            (1.0 - 2.0 * shell, 1.0 + 4.0 * shell)
        } else {
            (f32::NAN, f32::INFINITY)
        };

        self.gaps.fill(0.0);
        for (q, middles) in query.iter().zip(self.middles.chunks_exact(units.max(1))) {
            for (g, c) in self.gaps.iter_mut().zip(middles) {
                *g += (c - q) * (c - q);
            }
        }
        self.gaps.iter_mut().for_each(|g| *g = g.sqrt());

        let parts = &mut self.parts;
        parts.inside.resize(units, 0);
        parts.straddling.resize(units, 0);
        parts.most.clear();
        for list in [&mut parts.plus, &mut parts.minus] {
            list.resize(list.len().max((units + 1) * L), 0);
        }
        let (mut inside, mut straddling) = (0, 0);
        for unit in 0..units {
            let (gap, radius) = (self.gaps[unit], self.radii[unit]);
            let (outer, across) = (gap + radius, self.rests[unit] + beside);
            let within = outer * outer + across * across < near_limit;
            let without = gap - radius > far_limit;
            parts.inside[inside] = unit as u32;
            inside += usize::from(within);
            parts.straddling[straddling] = unit as u32;
            straddling += usize::from(!within & !without);
        }
        parts.inside.truncate(inside);

        let mut count = self.common_count;
        for &unit in &parts.inside {
            count += tree.nodes[self.fringe[unit as usize] as usize].count() as u32;
        }
        let (mut plus, mut minus) = (0, 0);
        for &unit in &parts.straddling[..straddling] {
            let lanes = &self.lanes[unit as usize * tests..(unit as usize + 1) * tests];
            let mut low = [0.0_f32; L];
            for (row, q) in lanes.iter().zip(&query) {
                for (s, x) in low.iter_mut().zip(row) {
                    *s += (x - q) * (x - q);
                }
            }
            let mut high = low;
            if self.rest {
                for ((l, h), x) in low.iter_mut().zip(&mut high).zip(&lanes[M]) {
                    *l += (x - beside) * (x - beside);
                    *h += (x + beside) * (x + beside);
                }
            }
            let mut within = 0_u32;
            let mut reached = 0_u32;
            for (l, h) in low.iter().zip(&high) {
                within += u32::from(*h < near_limit);
                reached += u32::from(*l <= far_limit);
            }
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            let own = node.count();
            let mut limit = near_limit;
            if within != reached {
                limit = 0.5;
                within = settle(
                    self.reach,
                    position,
                    node.start as usize,
                    &low[..own],
                    &mut high,
                    [near_limit, far_limit],
                );
            }
            count += within;
            let first = unit * L as u32;
            // Subtracting from a unit that reaches far out would lose what is left.
            let compact = self.radii[unit as usize] < 2.0;
            if f64::from(within) >= COMPLEMENT * own as f64 && compact {
                parts.most.push(unit);
                for (lane, h) in (first..).zip(&high[..own]) {
                    parts.minus[minus] = lane;
                    minus += usize::from(*h >= limit);
                }
            } else {
                for (lane, h) in (first..).zip(&high) {
                    parts.plus[plus] = lane;
                    plus += usize::from(*h < limit);
                }
            }
        }
        parts.plus_length = plus;
        parts.minus_length = minus;
        parts.count = count;
    }

    /// The dimension of the ball whose parts were found last.
    #[inline(always)]
    fn dimension(&mut self, dt: f64) -> u32 {
        if !self.has_moments() {
            return self.naive(dt);
        }
        let mut sum = std::mem::take(&mut self.sum);
        sum.clone_from(&self.common_features);
        if M <= 3 {
            self.add_features::<10>(&mut sum)
        } else {
            self.add_features::<14>(&mut sum)
        }
        self.sum = sum;
        let length = packed::length(M);
        let share = 1.0 / f64::from(self.parts.count);
        self.sum.iter_mut().for_each(|x| *x *= share);
        let (products, tail) = self.sum.split_at_mut(length);
        let rest = if self.rest { tail[M].max(0.0) } else { 0.0 };
        let second_moment = packed::trace(products, M) + rest;
        packed::add_square(products, &tail[..M], -1.0);
        let trace = packed::trace(products, M);
        if !self.accurate(trace, second_moment) {
            return self.naive(dt);
        }
        let products = &self.sum[..length];
        if M <= 3 {
            return decide::small(products, M, dt);
        }
        if let Some(dimension) = decide::compressed(products, M, rest, dt) {
            return dimension;
        }
        if self.full() {
            self.spectrum(dt)
        } else {
            self.naive(dt)
        }
    }

    /// Whether the covariance is not lost in the moments (both in units of the radius).
    #[inline(always)]
    fn accurate(&self, trace: f64, second_moment: f64) -> bool {
        let lost = 0.5 * self.noise * trace.sqrt() + 4.0 * f64::EPSILON * second_moment;
        trace > 0.0 && lost <= ACCURACY * trace
    }

    #[inline(always)]
    fn add_features<const W: usize>(&self, sum: &mut [f64]) {
        let width = self.width;
        for at in (0..width).step_by(W) {
            let mut own = [0.0; W];
            own.copy_from_slice(&sum[at..at + W]);
            add_rows::<W, true>(
                &mut own,
                &self.unit_features[at..],
                width,
                &self.parts.inside,
            );
            add_rows::<W, true>(&mut own, &self.unit_features[at..], width, &self.parts.most);
            add_rows::<W, true>(&mut own, &self.features[at..], width, self.parts.plus());
            add_rows::<W, false>(&mut own, &self.features[at..], width, self.parts.minus());
            sum[at..at + W].copy_from_slice(&own);
        }
    }

    /// Mean and covariance in all coordinates, in units of the radius; `false` when they are not
    /// as accurate as they should be.
    #[cold]
    fn full(&mut self) -> bool {
        let n = self.n;
        let tree = self.reach.tree;
        let mut sum = std::mem::take(&mut self.full_sum);
        let mut products = std::mem::take(&mut self.full_products);
        sum.clone_from(&self.common_sum);
        products.clone_from(&self.common_products);
        let parts = &self.parts;
        for &unit in parts.inside.iter().chain(&parts.most) {
            let at = self.fringe[unit as usize] as usize;
            let count = tree.nodes[at].count() as f64;
            for ((o, s), (a, b)) in
                (self.offset.iter_mut().zip(&mut sum)).zip(tree.mean(at).iter().zip(&self.center))
            {
                *o = a - b;
                *s += count * *o;
            }
            packed::add_shifted(&mut products, tree.scatter(at), &self.offset, count, 1.0);
        }
        for (list, sign) in [(parts.plus(), 1.0), (parts.minus(), -1.0)] {
            for &slot in list {
                let node = &tree.nodes[self.fringe[slot as usize / L] as usize];
                let position = node.start as usize + slot as usize % L;
                if position >= node.end as usize {
                    continue;
                }
                for ((o, s), (a, b)) in (self.offset.iter_mut().zip(&mut sum))
                    .zip(tree.place(position).iter().zip(&self.center))
                {
                    *o = a - b;
                    *s += sign * *o;
                }
                packed::add_square(&mut products, &self.offset, sign);
            }
        }
        let share = self.reach.inverse / f64::from(parts.count);
        sum.iter_mut().for_each(|s| *s *= share);
        let share = share * self.reach.inverse;
        products.iter_mut().for_each(|p| *p *= share);
        let second_moment = packed::trace(&products, n);
        packed::add_square(&mut products, &sum, -1.0);
        let trace = packed::trace(&products, n);
        self.full_sum = sum;
        self.full_products = products;
        self.parts.count == 1 || self.accurate(trace, second_moment)
    }

    /// The dimension from all eigenvalues of the covariance that `full` left.
    fn spectrum(&mut self, dt: f64) -> u32 {
        let n = self.n;
        packed::unfold(&self.full_products, n, &mut self.dense);
        let mut values =
            nalgebra::DMatrix::from_row_slice(n, n, &self.dense).symmetric_eigenvalues();
        values.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
        decide::dimension_of(values.as_slice(), dt)
    }

    /// The rows of the ball, from first to last.
    fn collect(&mut self) {
        let tree = self.reach.tree;
        self.rows.clear();
        let mut add = |start: u32, end: u32| {
            self.rows.extend(
                tree.order[start as usize..end as usize]
                    .iter()
                    .map(|&i| i as usize),
            );
        };
        for &at in &self.common {
            add(tree.nodes[at as usize].start, tree.nodes[at as usize].end);
        }
        for &unit in &self.parts.inside {
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            add(node.start, node.end);
        }
        for &slot in self.parts.plus() {
            let position =
                tree.nodes[self.fringe[slot as usize / L] as usize].start + slot % L as u32;
            add(position, position + 1);
        }
        for &unit in &self.parts.most {
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            for position in node.start..node.end {
                if !self
                    .parts
                    .minus()
                    .contains(&(unit * L as u32 + position - node.start))
                {
                    add(position, position + 1);
                }
            }
        }
        self.rows.sort_unstable();
    }

    /// The dimension by its definition.
    #[cold]
    fn naive(&mut self, dt: f64) -> u32 {
        self.collect();
        let cloud = self.reach.cloud;
        if !self.has_moments()
            && let Some(found) = super::wide::dimension(cloud, &self.rows, dt)
        {
            return found;
        }
        let frame = PrincipalFrame::of(cloud, self.rows.iter().copied());
        decide::dimension_of(&frame.variances, dt)
    }
}

/// Decides about the points of a unit that are too near to the sphere, sets all entries of `high`
/// to 0 or infinity, and returns how many points of the unit are inside.
#[cold]
fn settle<S: Scalar>(
    reach: &Reach<'_, S>,
    position: usize,
    start: usize,
    low: &[f32],
    high: &mut [f32],
    [near_limit, far_limit]: [f32; 2],
) -> u32 {
    let mut within = 0;
    for (lane, (l, h)) in low.iter().zip(high).enumerate() {
        let inside = *h < near_limit || (*l <= far_limit && reach.holds(position, start + lane));
        *h = if inside { 0.0 } else { FAR };
        within += u32::from(inside);
    }
    within
}

/// Squared distance, in four chains of additions.
#[inline(always)]
fn squared_gap(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (mut p, mut q) = (a.chunks_exact(4), b.chunks_exact(4));
    for (x, y) in (&mut p).zip(&mut q) {
        for k in 0..4 {
            lanes[k] += (x[k] - y[k]) * (x[k] - y[k]);
        }
    }
    let rest: f64 = p
        .remainder()
        .iter()
        .zip(q.remainder())
        .map(|(x, y)| (x - y) * (x - y))
        .sum();
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

/// Squared length, in four chains of additions.
#[inline(always)]
fn sum_of_squares(v: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let mut p = v.chunks_exact(4);
    for x in &mut p {
        for k in 0..4 {
            lanes[k] += x[k] * x[k];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + p.remainder().iter().map(|x| x * x).sum::<f64>()
}

/// Products, coordinates and squared distance from the span.
#[inline(always)]
fn write_features<const M: usize>(place: &[f64; M], beside: f64, out: &mut [f64]) {
    let mut at = 0;
    for i in 0..M {
        for j in i..M {
            out[at] = place[i] * place[j];
            at += 1;
        }
    }
    for x in place {
        out[at] = *x;
        at += 1;
    }
    // With three coordinates there is nothing beside them.
    if at < out.len() {
        out[at] = beside * beside;
    }
}

/// Adds or subtracts the rows in the list.
#[inline(always)]
fn add_rows<const W: usize, const ADD: bool>(
    sum: &mut [f64; W],
    rows: &[f64],
    width: usize,
    list: &[u32],
) {
    for &r in list {
        if let Some(row) = rows[r as usize * width..].first_chunk::<W>() {
            for (s, x) in sum.iter_mut().zip(row) {
                *s = if ADD { *s + x } else { *s - x };
            }
        }
    }
}
