//! The growing complex: triangles at every landmark, and a log that takes steps back.

use super::parts::AdvancingFront;
use crosscap_core::{Scalar, StratifiedLandmarks};

/// The growing complex.
pub(super) struct Front<'a, S: Scalar> {
    pub(super) parts: &'a AdvancingFront<'a>,
    pub(super) input: &'a StratifiedLandmarks<S>,
    pub(super) triangles: Vec<[u32; 3]>,
    free: Vec<u32>,
    /// Triangles at each landmark.
    pub(super) incident: Vec<Vec<u32>>,
    /// Chain neighbors of each landmark, with the cells that meet in the edge.
    pub(super) curve: Vec<Vec<(u32, u8)>>,
    pub(super) dropped: Vec<bool>,
    /// The round in which a landmark was located last (high half), and its position then.
    at: Vec<u64>,
    round: u64,
    /// Triangles added (`true`) and removed since the last mark.
    log: Vec<(bool, [u32; 3])>,
}

impl<'a, S: Scalar> Front<'a, S> {
    /// No triangle yet.
    pub(super) fn new(parts: &'a AdvancingFront<'a>, input: &'a StratifiedLandmarks<S>) -> Self {
        let count = input.strata.len();
        let mut curve = vec![Vec::new(); count];
        for e in &input.curve_edges {
            let [a, b] = e.ends;
            curve[a as usize].push((b, e.cells));
            curve[b as usize].push((a, e.cells));
        }
        Self {
            parts,
            input,
            triangles: Vec::new(),
            free: Vec::new(),
            incident: vec![Vec::new(); count],
            curve,
            dropped: vec![false; count],
            at: vec![0; count],
            round: 0,
            log: Vec::new(),
        }
    }

    /// The triangles that are there.
    pub(super) fn standing(&self) -> Vec<[u32; 3]> {
        let all = self.triangles.iter().copied();
        all.filter(|t| t[0] != u32::MAX).collect()
    }

    /// Forgets what was done so far: a roll back goes no farther than this.
    pub(super) fn mark(&mut self) {
        self.log.clear();
    }

    /// Corners of all triangles that were added or removed since the mark.
    pub(super) fn moved(&self) -> Vec<u32> {
        self.log.iter().flat_map(|l| l.1).collect()
    }

    /// Makes `position` answer for these members.
    pub(super) fn locate(&mut self, members: &[u32]) {
        self.round += 1;
        for (i, &m) in (0_u64..).zip(members) {
            self.at[m as usize] = (self.round << 32) + i;
        }
    }

    pub(super) fn position(&self, landmark: u32) -> Option<usize> {
        let at = self.at[landmark as usize].wrapping_sub(self.round << 32);
        (at <= u64::from(u32::MAX)).then_some(at as usize)
    }

    /// Number of triangles on an edge.
    pub(super) fn count(&self, a: u32, b: u32) -> usize {
        self.incident[a as usize]
            .iter()
            .filter(|&&t| self.triangles[t as usize].contains(&b))
            .count()
    }

    /// Cells that meet in a chain edge; `None` for any other edge.
    pub(super) fn cells(&self, a: u32, b: u32) -> Option<u8> {
        self.curve[a as usize]
            .iter()
            .find(|x| x.0 == b)
            .map(|x| x.1)
    }

    pub(super) fn holds(&self, sorted: [u32; 3]) -> bool {
        self.incident[sorted[0] as usize]
            .iter()
            .any(|&t| self.triangles[t as usize] == sorted)
    }

    /// Whether two landmarks of one curve are few steps apart along it: an edge between them
    /// would cut the corner of the chain. Steps do not run through points (stratum 0).
    pub(super) fn shortcut(&self, a: u32, b: u32) -> bool {
        if self.input.strata[a as usize] > 1 || self.input.strata[b as usize] > 1 {
            return false;
        }
        let mut reached = vec![a];
        let mut from = 0;
        for _ in 0..self.parts.tuning.shortcut_steps {
            let until = reached.len();
            for k in from..until {
                let v = reached[k];
                if v != a && self.input.strata[v as usize] == 0 {
                    continue;
                }
                for &(next, _) in &self.curve[v as usize] {
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

    pub(super) fn add(&mut self, mut corners: [u32; 3]) {
        corners.sort_unstable();
        let t = match self.free.pop() {
            Some(t) => {
                self.triangles[t as usize] = corners;
                t
            }
            None => {
                self.triangles.push(corners);
                (self.triangles.len() - 1) as u32
            }
        };
        for c in corners {
            self.incident[c as usize].push(t);
        }
        self.log.push((true, corners));
    }

    fn remove(&mut self, t: u32) {
        self.log.push((false, self.triangles[t as usize]));
        for c in self.triangles[t as usize] {
            self.incident[c as usize].retain(|&x| x != t);
        }
        self.triangles[t as usize] = [u32::MAX; 3];
        self.free.push(t);
    }

    /// Removes the triangles at `v` whose corners all satisfy `within`; the landmarks that lost one are
    /// appended to `touched`.
    pub(super) fn clear(&mut self, v: u32, within: impl Fn(u32) -> bool, touched: &mut Vec<u32>) {
        for t in self.incident[v as usize].clone() {
            let corners = self.triangles[t as usize];
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
                let t = self.incident[corners[0] as usize]
                    .iter()
                    .copied()
                    .find(|&t| self.triangles[t as usize] == corners);
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
