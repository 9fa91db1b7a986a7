//! The advancing front: which star is closed next, and what happens when one cannot be.

use super::star::Patch;
use crosscap_core::{
    CompatibilityTest, Complex, CurveEdge, Error, LocalChart, Scalar, StratifiedLandmarks,
    TriangleRule,
};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Triangulates the waist.
pub struct Triangulator<'a> {
    /// Lays neighborhoods out in the plane.
    pub chart: &'a dyn LocalChart,
    /// Decides whether two triangles can stand side by side.
    pub test: &'a dyn CompatibilityTest,
    /// Ranks the candidates for a dangling edge.
    pub rule: &'a dyn TriangleRule,
    /// No triangle has a larger circumradius, unit of the data; infinite for no limit.
    pub largest_circumradius: f64,
    /// Whether stars that cannot be closed are repaired; without it the first one ends the
    /// triangulation, as in the paper.
    pub repair: bool,
}

/// A star that stayed open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Incomplete {
    /// The landmark.
    pub landmark: u32,
}

/// What the triangulation counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TriangulationCounts {
    /// Stars visited, with repetitions.
    pub visits: usize,
    /// Repairs: stars that could not be closed at once.
    pub repairs: usize,
    /// Landmarks given up.
    pub dropped: usize,
}

/// The result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangulation {
    /// The complex on the landmarks; a dropped landmark is an isolated vertex.
    pub complex: Complex,
    /// Landmarks given up.
    pub dropped: Vec<u32>,
    /// Stars that stayed open.
    pub incomplete: Vec<Incomplete>,
    /// Counts for the report.
    pub counts: TriangulationCounts,
}

/// How often the surroundings of a star are torn up before the landmark is dropped, and how
/// many of its neighbors lose their triangles each time.
const TEARS: [usize; 4] = [0, 6, 12, 19];
/// Two landmarks of a curve closer than this many steps along it are joined by chain edges only.
const SHORTCUT_STEPS: usize = 4;
/// Repairs allowed: a constant and a share of the landmarks.
const REPAIR_BASE: usize = 100;

/// The growing complex.
pub(super) struct Front<'a, S: Scalar> {
    pub(super) parts: &'a Triangulator<'a>,
    pub(super) input: &'a StratifiedLandmarks<S>,
    pub(super) triangles: Vec<[u32; 3]>,
    free: Vec<u32>,
    /// Triangles at each landmark.
    pub(super) incident: Vec<Vec<u32>>,
    /// Chain neighbors of each landmark, with the cells that meet in the edge.
    pub(super) curve: Vec<Vec<(u32, u8)>>,
    pub(super) dropped: Vec<bool>,
    stamp: Vec<u32>,
    at: Vec<u32>,
    round: u32,
}

impl<S: Scalar> Front<'_, S> {
    pub(super) fn distance(&self, a: u32, b: u32) -> f64 {
        // Neighborhoods keep the distances of all their pairs.
        self.input.distances.get(a, b).map_or(f64::INFINITY, Scalar::as_f64)
    }

    /// Makes `position` answer for these members.
    pub(super) fn locate(&mut self, members: &[u32]) {
        self.round += 1;
        for (i, &m) in members.iter().enumerate() {
            self.stamp[m as usize] = self.round;
            self.at[m as usize] = i as u32;
        }
    }

    pub(super) fn position(&self, landmark: u32) -> Option<usize> {
        (self.stamp[landmark as usize] == self.round).then(|| self.at[landmark as usize] as usize)
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
        self.curve[a as usize].iter().find(|x| x.0 == b).map(|x| x.1)
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
        for _ in 0..SHORTCUT_STEPS {
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
    }

    fn remove(&mut self, t: u32) {
        for c in self.triangles[t as usize] {
            self.incident[c as usize].retain(|&x| x != t);
        }
        self.triangles[t as usize] = [u32::MAX; 3];
        self.free.push(t);
    }

    /// Removes all triangles at `v`; the landmarks that lost one are appended to `touched`.
    fn clear(&mut self, v: u32, touched: &mut Vec<u32>) {
        for t in self.incident[v as usize].clone() {
            touched.extend(self.triangles[t as usize]);
            self.remove(t);
        }
    }
}

impl Triangulator<'_> {
    /// Triangulates: every landmark of a cell is visited and its star closed, the front
    /// advancing from neighbor to neighbor; then the stars of curve landmarks are completed, cell by cell.
    ///
    /// When a star cannot be closed the triangles around it are removed, wider each time,
    /// and it is closed first; after four times the landmark is dropped.
    ///
    /// # Errors
    /// Those of [`StratifiedLandmarks::check`]; [`Error::Law`] for a chart that is not finite.
    ///
    /// O(L k^2) for L landmarks with k members in a neighborhood, plus the charts.
    pub fn triangulate<S: Scalar>(&self, input: &StratifiedLandmarks<S>) -> Result<Triangulation, Error> {
        input.check()?;
        let count = input.strata.len();
        let mut curve = vec![Vec::new(); count];
        for e in &input.curve_edges {
            let [a, b] = e.ends;
            curve[a as usize].push((b, e.cells));
            curve[b as usize].push((a, e.cells));
        }
        let mut front = Front {
            parts: self,
            input,
            triangles: Vec::new(),
            free: Vec::new(),
            incident: vec![Vec::new(); count],
            curve,
            dropped: vec![false; count],
            stamp: vec![0; count],
            at: vec![0; count],
            round: 0,
        };
        let mut home = vec![usize::MAX; count];
        let mut sectors: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (k, near) in input.neighborhoods.iter().enumerate() {
            if input.strata[near.center as usize] == 2 {
                home[near.center as usize] = k;
            } else {
                sectors[near.center as usize].push(k);
            }
        }
        let mut run = Run {
            front: &mut front,
            home,
            sectors,
            done: vec![false; count],
            tries: vec![0; count],
            queue: VecDeque::new(),
            kept: Vec::new(),
            counts: TriangulationCounts::default(),
            incomplete: Vec::new(),
        };
        run.all()?;
        let (counts, incomplete) = (run.counts, std::mem::take(&mut run.incomplete));
        let triangles = front.triangles.iter().copied().filter(|t| t[0] != u32::MAX).collect();
        let edges: Vec<CurveEdge> = input.curve_edges.clone();
        Ok(Triangulation {
            complex: Complex::new(count, triangles, edges)?,
            dropped: (0..count as u32).filter(|&v| front.dropped[v as usize]).collect(),
            incomplete,
            counts,
        })
    }
}

/// One triangulation under way.
struct Run<'r, 'a, S: Scalar> {
    front: &'r mut Front<'a, S>,
    /// Neighborhood of each landmark of a cell.
    home: Vec<usize>,
    /// Neighborhoods of each landmark on a curve, one a cell.
    sectors: Vec<Vec<usize>>,
    done: Vec<bool>,
    tries: Vec<usize>,
    queue: VecDeque<u32>,
    kept: Vec<u32>,
    counts: TriangulationCounts,
    incomplete: Vec<Incomplete>,
}

impl<S: Scalar> Run<'_, '_, S> {
    fn all(&mut self) -> Result<(), Error> {
        let count = self.home.len();
        let budget = REPAIR_BASE + count / 2;
        for seed in 0..count as u32 {
            self.queue.push_back(seed);
            self.drain(budget)?;
        }
        // Stars of curve landmarks, which no visit of a cell has to close.
        for v in 0..count as u32 {
            for k in self.sectors[v as usize].clone() {
                if !self.visit(k)? {
                    self.give_up_or_tear(v, k, budget)?;
                }
            }
        }
        Ok(())
    }

    fn drain(&mut self, budget: usize) -> Result<(), Error> {
        while let Some(v) = self.queue.pop_front() {
            let k = self.home[v as usize];
            if self.done[v as usize] || self.front.dropped[v as usize] || k == usize::MAX {
                continue;
            }
            if self.visit(k)? {
                self.done[v as usize] = true;
                let mut next: Vec<u32> = self.front.incident[v as usize]
                    .iter()
                    .flat_map(|&t| self.front.triangles[t as usize])
                    .filter(|&u| !self.done[u as usize])
                    .collect();
                next.sort_unstable();
                next.dedup();
                self.queue.extend(next);
            } else {
                self.give_up_or_tear(v, k, budget)?;
            }
        }
        Ok(())
    }

    fn visit(&mut self, k: usize) -> Result<bool, Error> {
        self.counts.visits += 1;
        let input = self.front.input;
        let mut kept = std::mem::take(&mut self.kept);
        let mut patch = Patch::new(self.front, &input.neighborhoods[k], &mut kept)?;
        let closed = patch.close(self.front);
        self.kept = kept;
        Ok(closed)
    }

    /// A star that cannot be closed: tears up its surroundings, or drops the landmark.
    fn give_up_or_tear(&mut self, v: u32, k: usize, budget: usize) -> Result<(), Error> {
        let on_curve = self.front.input.strata[v as usize] < 2;
        let spent = self.counts.repairs >= budget || !self.front.parts.repair;
        let level = self.tries[v as usize];
        if spent || (on_curve && level >= TEARS.len()) {
            self.incomplete.push(Incomplete { landmark: v });
            self.done[v as usize] = true;
            return Ok(());
        }
        self.tries[v as usize] += 1;
        self.counts.repairs += 1;
        let mut touched = Vec::new();
        self.front.clear(v, &mut touched);
        let members = &self.front.input.neighborhoods[k].members;
        let reach = if level < TEARS.len() { TEARS[level] } else { 0 };
        for &m in members.iter().skip(1).take(reach) {
            self.front.clear(m, &mut touched);
        }
        if level >= TEARS.len() {
            self.front.dropped[v as usize] = true;
            self.counts.dropped += 1;
            touched.extend(members.iter().skip(1).take(6));
        }
        touched.sort_unstable();
        touched.dedup();
        let far: Vec<u32> = members.iter().copied().filter(|m| touched.binary_search(m).is_ok()).collect();
        for &u in touched.iter().filter(|u| !far.contains(u)).chain(far.iter().rev()) {
            self.done[u as usize] = false;
            self.queue.push_front(u);
        }
        self.queue.push_front(v);
        self.done[v as usize] = false;
        if on_curve {
            // Its own cell is not visited by the front: close it now, before the others.
            if self.visit(k)? {
                return self.drain(budget);
            }
            return self.give_up_or_tear(v, k, budget);
        }
        Ok(())
    }
}
