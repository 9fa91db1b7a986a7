//! All balls about a few points that lie together.
//!
//! The nodes inside of every ball are summed once. What some of the spheres may cut, the fringe,
//! is copied to a small frame: origin in the middle of the centers, the radius as unit, turned so
//! that the first directions are those of largest variance. In more than six dimensions only six
//! directions are kept, and of the rest the distance from their span, which brackets both
//! distances and spectra; what a bracket does not settle is looked up in all coordinates.

mod cut;
mod fringe;
mod sums;

use super::frame::Directions;
use super::packed;
use super::reach::Reach;
use super::tree::WIDEST_MOMENTS;
use crosscap_core::{BallDimension, Scalar};

/// Most centers of a group.
const MOST_CENTERS: usize = 64;
/// Largest radius of a group, in units of the radius of the balls.
const WIDEST: f64 = 0.5;
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
