//! The tree, and what is within a radius.

use crosscap_core::squared_distance;

/// Most places of a leaf: more than the neighbors that are asked for, so that a leaf alone bounds
/// how far they are. Its distances are computed lane by lane.
pub(super) const LEAF: usize = 32;
/// Lanes that are summed together.
const LANES: usize = 8;
/// Places that the direction of a split is read from.
const SHOWN: usize = 48;
/// Relative bound on the rounding of a distance.
pub(super) const ROUNDING: f64 = 1e-12;
pub(super) struct Node {
    pub(super) start: u32,
    pub(super) end: u32,
    /// The second child; the first one is the next node. 0 for a leaf.
    pub(super) right: u32,
    /// Which leaf it is, or the first one below it.
    pub(super) leaf: u32,
    /// Largest distance of a place from the center.
    pub(super) radius: f64,
}

/// Places of R^N in leaf order under nested balls.
///
/// Built in O(n log n) distances; the neighbors of places that lie together are looked up leaf by leaf.
pub(crate) struct BallTree {
    /// Numbers of a place.
    pub(super) width: usize,
    /// The caller's index at every position.
    pub(super) order: Vec<u32>,
    /// Places leaf by leaf, coordinate by coordinate, one a lane; infinity where no place is.
    pub(super) lanes: Vec<[f64; LEAF]>,
    pub(super) nodes: Vec<Node>,
    centers: Vec<f64>,
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

    pub(super) fn center(&self, node: usize) -> &[f64] {
        &self.centers[node * self.width..(node + 1) * self.width]
    }

    /// Squared distances of the places of a leaf from `place`.
    #[inline]
    pub(super) fn squares(&self, leaf: &Node, place: &[f64]) -> [f64; LEAF] {
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
    pub(super) fn leaves(
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
}
