//! The growing complex: triangles at every landmark, and a log that takes steps back.

use super::Triangle;
use super::parts::AdvancingFront;
use crosscap_core::{Landmark, Scalar, StratifiedLandmarks, Table};

/// The growing complex.
pub(super) struct Front<'a, S: Scalar> {
    pub(super) parts: &'a AdvancingFront<'a>,
    pub(super) input: &'a StratifiedLandmarks<S>,
    pub(super) triangles: Table<Triangle, [Landmark; 3]>,
    free: Vec<Triangle>,
    /// Triangles at each landmark.
    pub(super) incident: Table<Landmark, Vec<Triangle>>,
    /// Chain neighbors of each landmark, with the cells that meet in the edge.
    pub(super) curve: Table<Landmark, Vec<(Landmark, u8)>>,
    pub(super) dropped: Table<Landmark, bool>,
    /// The round in which a landmark was located last (high half), and its position then.
    at: Table<Landmark, u64>,
    round: u64,
    /// Triangles added (`true`) and removed since the last mark.
    log: Vec<(bool, [Landmark; 3])>,
}

impl Triangle {
    /// Corners of a triangle that was removed, until its number is given to another.
    const GONE: [Landmark; 3] = [Landmark::new(u32::MAX as usize); 3];
}

impl<'a, S: Scalar> Front<'a, S> {
    /// No triangle yet.
    pub(super) fn new(parts: &'a AdvancingFront<'a>, input: &'a StratifiedLandmarks<S>) -> Self {
        let count = input.strata().len();
        let mut curve: Table<Landmark, _> = Table::filled(count, Vec::new());
        for e in input.curve_edges() {
            let [a, b] = e.landmarks();
            curve[a].push((b, e.cells));
            curve[b].push((a, e.cells));
        }
        Self {
            parts,
            input,
            triangles: Table::default(),
            free: Vec::new(),
            incident: Table::filled(count, Vec::new()),
            curve,
            dropped: Table::filled(count, false),
            at: Table::filled(count, 0),
            round: 0,
            log: Vec::new(),
        }
    }

    /// The triangles that are there, as a complex has them.
    pub(super) fn standing(&self) -> Vec<[u32; 3]> {
        let all = self.triangles.iter().copied();
        let there = all.filter(|t| *t != Triangle::GONE);
        there.map(|t| t.map(u32::from)).collect()
    }

    /// Forgets what was done so far: a roll back goes no farther than this.
    pub(super) fn mark(&mut self) {
        self.log.clear();
    }

    /// Corners of all triangles that were added or removed since the mark.
    pub(super) fn moved(&self) -> Vec<Landmark> {
        self.log.iter().flat_map(|l| l.1).collect()
    }

    /// Makes `position` answer for these members.
    pub(super) fn locate(&mut self, members: &[Landmark]) {
        self.round += 1;
        for (i, &m) in (0_u64..).zip(members) {
            self.at[m] = (self.round << 32) + i;
        }
    }

    pub(super) fn position(&self, landmark: Landmark) -> Option<usize> {
        let at = self.at[landmark].wrapping_sub(self.round << 32);
        (at <= u64::from(u32::MAX)).then_some(at as usize)
    }

    /// Number of triangles on an edge.
    pub(super) fn count(&self, a: Landmark, b: Landmark) -> usize {
        self.incident[a]
            .iter()
            .filter(|&&t| self.triangles[t].contains(&b))
            .count()
    }

    /// Cells that meet in a chain edge; `None` for any other edge.
    pub(super) fn cells(&self, a: Landmark, b: Landmark) -> Option<u8> {
        self.curve[a].iter().find(|x| x.0 == b).map(|x| x.1)
    }

    pub(super) fn holds(&self, sorted: [Landmark; 3]) -> bool {
        self.incident[sorted[0]]
            .iter()
            .any(|&t| self.triangles[t] == sorted)
    }

    /// Whether two landmarks of one curve are few steps apart along it: an edge between them
    /// would cut the corner of the chain. Steps do not run through points (stratum 0).
    pub(super) fn shortcut(&self, a: Landmark, b: Landmark) -> bool {
        if self.input.strata()[a] > 1 || self.input.strata()[b] > 1 {
            return false;
        }
        let mut reached = vec![a];
        let mut from = 0;
        for _ in 0..self.parts.tuning.shortcut_steps {
            let until = reached.len();
            for k in from..until {
                let v = reached[k];
                if v != a && self.input.strata()[v] == 0 {
                    continue;
                }
                for &(next, _) in &self.curve[v] {
                    if next == b {
                        return true;
                    }
                    if !reached.contains(&next) {
                        reached.push(next);
                    }
                }
            }
            from = until;
        }
        false
    }

    pub(super) fn add(&mut self, mut corners: [Landmark; 3]) {
        corners.sort_unstable();
        let t = match self.free.pop() {
            Some(t) => {
                self.triangles[t] = corners;
                t
            }
            None => self.triangles.push(corners),
        };
        for c in corners {
            self.incident[c].push(t);
        }
        self.log.push((true, corners));
    }

    fn remove(&mut self, t: Triangle) {
        self.log.push((false, self.triangles[t]));
        for c in self.triangles[t] {
            self.incident[c].retain(|&x| x != t);
        }
        self.triangles[t] = Triangle::GONE;
        self.free.push(t);
    }

    /// Removes the triangles at `v` whose corners all satisfy `within`; the landmarks that lost one are
    /// appended to `touched`.
    pub(super) fn clear(
        &mut self,
        v: Landmark,
        within: impl Fn(Landmark) -> bool,
        touched: &mut Vec<Landmark>,
    ) {
        for t in self.incident[v].clone() {
            let corners = self.triangles[t];
            if corners.iter().all(|&c| within(c)) {
                touched.extend(corners);
                self.remove(t);
            }
        }
    }

    /// Undoes everything since the mark.
    pub(super) fn roll_back(&mut self) {
        while let Some((added, corners)) = self.log.pop() {
            if added {
                let t = self.incident[corners[0]]
                    .iter()
                    .copied()
                    .find(|&t| self.triangles[t] == corners);
                if let Some(t) = t {
                    self.remove(t);
                }
            } else {
                self.add(corners);
            }
            self.log.pop();
        }
    }
}
