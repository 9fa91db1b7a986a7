//! A bounding-volume tree: nearest item, and all pairs of items near each other.

use super::frame::{AXES, Spot};

/// An axis-parallel box in the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: Spot,
    pub high: Spot,
}

impl Bounds {
    /// The box of some places, `slack` larger on every side.
    pub fn around(spots: &[Spot], slack: f64) -> Self {
        let mut b = Self {
            low: [f64::INFINITY; AXES],
            high: [f64::NEG_INFINITY; AXES],
        };
        for s in spots {
            for ((low, high), x) in b.low.iter_mut().zip(&mut b.high).zip(s) {
                *low = low.min(x - slack);
                *high = high.max(x + slack);
            }
        }
        b
    }

    fn join(&mut self, other: &Self) {
        for k in 0..AXES {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
        }
    }

    /// Squared distance to a place.
    fn spot_distance(&self, s: &Spot) -> f64 {
        let mut sum = 0.0;
        for ((low, high), x) in self.low.iter().zip(&self.high).zip(s) {
            let d = (low - x).max(x - high).max(0.0);
            sum += d * d;
        }
        sum
    }

    /// Squared distance of two boxes.
    fn box_distance(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for k in 0..AXES {
            let d = (self.low[k] - other.high[k])
                .max(other.low[k] - self.high[k])
                .max(0.0);
            sum += d * d;
        }
        sum
    }

    fn size(&self) -> f64 {
        (0..AXES)
            .map(|k| self.high[k] - self.low[k])
            .fold(0.0, f64::max)
    }
}

struct Node {
    bounds: Bounds,
    start: u32,
    end: u32,
    /// The second child, 0 for a leaf; the first child follows its parent.
    second: u32,
}

const LEAF: usize = 6;

/// Boxes split at the median of their widest axis. Build O(n log n), a nearest search O(log n)
/// on data of low intrinsic dimension.
pub(super) struct Tree {
    nodes: Vec<Node>,
    items: Vec<u32>,
    boxes: Vec<Bounds>,
}

impl Tree {
    pub fn new(bounds: &[Bounds]) -> Self {
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * bounds.len() / LEAF + 1),
            items: (0..bounds.len() as u32).collect(),
            boxes: Vec::new(),
        };
        if !bounds.is_empty() {
            tree.split(bounds, 0, bounds.len());
        }
        tree.boxes = tree.items.iter().map(|&i| bounds[i as usize]).collect();
        tree
    }

    fn split(&mut self, bounds: &[Bounds], start: usize, end: usize) -> u32 {
        let mut all = bounds[self.items[start] as usize];
        let mut centers = Bounds::around(&[], 0.0);
        for &i in &self.items[start..end] {
            let b = &bounds[i as usize];
            all.join(b);
            for k in 0..AXES {
                let c = b.low[k] + b.high[k];
                centers.low[k] = centers.low[k].min(c);
                centers.high[k] = centers.high[k].max(c);
            }
        }
        let node = self.nodes.len() as u32;
        self.nodes.push(Node {
            bounds: all,
            start: start as u32,
            end: end as u32,
            second: 0,
        });
        if end - start > LEAF {
            let spread = |k: usize| centers.high[k] - centers.low[k];
            let mut axis = 0;
            for k in 1..AXES {
                if spread(k) > spread(axis) {
                    axis = k;
                }
            }
            let middle = (start + end) / 2;
            self.items[start..end].select_nth_unstable_by(middle - start, |&a, &b| {
                let c = |i: u32| bounds[i as usize].low[axis] + bounds[i as usize].high[axis];
                c(a).total_cmp(&c(b)).then(a.cmp(&b))
            });
            self.split(bounds, start, middle);
            let second = self.split(bounds, middle, end);
            self.nodes[node as usize].second = second;
        }
        node
    }

    /// The item of smallest `distance` (squared, in R^N) below `bound`, with that distance.
    /// `slack` is what rounding may have moved `spot` by.
    pub fn nearest(
        &self,
        spot: &Spot,
        slack: f64,
        bound: f64,
        mut distance: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let mut bound = bound;
        // what a box may be away and still hold the nearest item
        let widen = |b: f64| {
            if slack > 0.0 {
                let r = b.sqrt() + 2.0 * slack;
                r * r
            } else {
                b
            }
        };
        let mut wide = widen(bound);
        let mut stack: Vec<(u32, f64)> = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first() {
            stack.push((0, root.bounds.spot_distance(spot)));
        }
        while let Some((n, away)) = stack.pop() {
            if away > wide {
                continue;
            }
            let node = &self.nodes[n as usize];
            if node.second == 0 {
                for k in node.start as usize..node.end as usize {
                    if self.boxes[k].spot_distance(spot) <= wide {
                        let item = self.items[k];
                        let d = distance(item);
                        if d < bound {
                            bound = d;
                            wide = widen(d);
                            best = Some((item, d));
                        }
                    }
                }
            } else {
                let a = (n + 1, self.nodes[n as usize + 1].bounds.spot_distance(spot));
                let b = (
                    node.second,
                    self.nodes[node.second as usize].bounds.spot_distance(spot),
                );
                let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                stack.push(far);
                stack.push(near);
            }
        }
        best
    }

    /// Every pair of items whose boxes are at most `reach` apart, the smaller item first, with
    /// the squared distance of the boxes; until `visit` says stop.
    pub fn pairs(&self, reach: f64, mut visit: impl FnMut(u32, u32, f64) -> bool) {
        let limit = reach * reach;
        let mut stack: Vec<(u32, u32)> = Vec::with_capacity(128);
        if !self.nodes.is_empty() {
            stack.push((0, 0));
        }
        while let Some((m, n)) = stack.pop() {
            let (a, b) = (&self.nodes[m as usize], &self.nodes[n as usize]);
            if m != n && a.bounds.box_distance(&b.bounds) > limit {
                continue;
            }
            if a.second == 0 && b.second == 0 {
                for i in a.start as usize..a.end as usize {
                    let from = if m == n { i + 1 } else { b.start as usize };
                    for j in from..b.end as usize {
                        let away = self.boxes[i].box_distance(&self.boxes[j]);
                        if away <= limit {
                            let (s, t) = (self.items[i], self.items[j]);
                            if !visit(s.min(t), s.max(t), away) {
                                return;
                            }
                        }
                    }
                }
            } else if m == n {
                stack.extend([(m + 1, m + 1), (m + 1, a.second), (a.second, a.second)]);
            } else if b.second == 0 || (a.second != 0 && a.bounds.size() >= b.bounds.size()) {
                stack.extend([(m + 1, n), (a.second, n)]);
            } else {
                stack.extend([(m, n + 1), (m, b.second)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes(corners: &[(f64, f64, f64)]) -> Vec<Bounds> {
        corners
            .iter()
            .map(|&(x, y, w)| {
                Bounds::around(
                    &[[x, y, 0., 0., 0., 0.], [x + w, y + w, w, 0., 0., 0.]],
                    0.0,
                )
            })
            .collect()
    }

    proptest! {
        #[test]
        fn pairs_and_nearest_equal_brute_force(
            corners in proptest::collection::vec((0.0..9.0_f64, 0.0..9.0_f64, 0.0..1.0_f64), 1..60),
            reach in 0.0..2.0_f64, x in -1.0..10.0_f64,
        ) {
            let b = boxes(&corners);
            let tree = Tree::new(&b);
            let mut found = vec![];
            tree.pairs(reach, |i, j, _| { found.push((i, j)); true });
            found.sort_unstable();
            let mut expected = vec![];
            for i in 0..b.len() { for j in i + 1..b.len() {
                if b[i].box_distance(&b[j]) <= reach * reach { expected.push((i as u32, j as u32)); }
            } }
            prop_assert_eq!(found, expected);
            let spot = [x, 4.0, 0.5, 0., 0., 0.];
            let near = tree.nearest(&spot, 0.0, f64::INFINITY, |i| b[i as usize].spot_distance(&spot)).unwrap();
            let least = b.iter().map(|q| q.spot_distance(&spot)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(near.1, least);
        }
    }
}
