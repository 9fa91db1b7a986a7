//! The advancing front: which star is closed next, and what happens when one cannot be.

use super::Rules;
use super::star::Patch;
use crate::audit::{AuditedChart, AuditedRule, AuditedTest, Watch, known_pairs};
use crosscap_core::{
    CompatibilityTest, Complex, CurveEdge, Error, LocalChart, Scalar, StratifiedLandmarks,
    TriangleRule,
};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::sync::atomic::AtomicU32;

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
    /// What a triangle must satisfy beside being compatible.
    pub rules: Rules,
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

/// How many of the nearest members of a chart lose their triangles in a repair, one attempt after
/// another.
const TEARS: [usize; 6] = [0, 4, 8, 12, 18, 26];
/// How many nearest neighbors are tried as the landmark to drop when tearing does not help.
const DROPS: usize = 6;
/// Two landmarks of a curve closer than this many steps along it are joined by chain edges only.
const SHORTCUT_STEPS: usize = 4;
/// Repairs tried in all: a constant and a share of the landmarks. Data that no triangulation fits would
/// otherwise be torn up star by star.
const ATTEMPTS: usize = 400;
const ATTEMPT_SHARE: usize = 4;
/// Passes over the stars of curve landmarks: a repair of one may open another.
const CURVE_PASSES: usize = 4;

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
    /// The round in which a landmark was located last (high half), and its position then.
    at: Vec<u64>,
    round: u64,
    /// Triangles added (`true`) and removed since the last mark.
    log: Vec<(bool, [u32; 3])>,
}

impl<S: Scalar> Front<'_, S> {
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
    fn clear(&mut self, v: u32, within: impl Fn(u32) -> bool, touched: &mut Vec<u32>) {
        for t in self.incident[v as usize].clone() {
            let corners = self.triangles[t as usize];
            if corners.iter().all(|&c| within(c)) {
                touched.extend(corners);
                self.remove(t);
            }
        }
    }

    /// Undoes everything since the log had `length` entries.
    fn roll_back(&mut self, length: usize) {
        while self.log.len() > length {
            let Some((added, corners)) = self.log.pop() else {
                break;
            };
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

impl Triangulator<'_> {
    /// Triangulates: every landmark of a cell is visited and its star closed, the front
    /// advancing from neighbor to neighbor; then the stars of curve landmarks are completed, cell by cell.
    ///
    /// When a star cannot be closed, a repair removes the triangles around it, closes it first
    /// and then every star that lost a triangle; wider and wider, and at last without the landmark or
    /// one of its neighbors. A repair counts only as a whole: one that leaves any star open is
    /// undone, so that a site that cannot be triangulated stays where it is.
    ///
    /// # Errors
    /// Those of [`StratifiedLandmarks::check`] and of the chart; [`Error::Law`], whose point is the landmark, for a chart
    /// of the wrong size or not finite, a test that is not symmetric, a rank that is NaN or depends on the
    /// order of the ends, or a triangle without area that does not rank last.
    ///
    /// O(L k^2) for L landmarks with k members in a neighborhood, plus the charts.
    pub fn triangulate<S: Scalar>(
        &self,
        input: &StratifiedLandmarks<S>,
    ) -> Result<Triangulation, Error> {
        input.check()?;
        let first = input.neighborhoods.first().and_then(|near| {
            let (&a, &b) = (near.members.first()?, near.members.get(1)?);
            input.distances.get(a, b)
        });
        let size = first.map_or(1.0, Scalar::as_f64);
        known_pairs(self.test, if size > 0.0 { size } else { 1.0 })?;
        let watch = Watch::default();
        let parts = &Triangulator {
            chart: &AuditedChart {
                chart: self.chart,
                watch: &watch,
            },
            test: &AuditedTest {
                test: self.test,
                watch: &watch,
                calls: AtomicU32::new(0),
            },
            rule: &AuditedRule {
                rule: self.rule,
                watch: &watch,
                calls: AtomicU32::new(0),
            },
            ..*self
        };
        let count = input.strata.len();
        let mut curve = vec![Vec::new(); count];
        for e in &input.curve_edges {
            let [a, b] = e.ends;
            curve[a as usize].push((b, e.cells));
            curve[b as usize].push((a, e.cells));
        }
        let mut front = Front {
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
            watch: &watch,
            front: &mut front,
            home,
            sectors,
            done: vec![false; count],
            queue: VecDeque::new(),
            kept: Vec::new(),
            counts: TriangulationCounts::default(),
            incomplete: Vec::new(),
            attempts: ATTEMPTS + count / ATTEMPT_SHARE,
        };
        run.all()?;
        let (counts, incomplete) = (run.counts, std::mem::take(&mut run.incomplete));
        let triangles = front
            .triangles
            .iter()
            .copied()
            .filter(|t| t[0] != u32::MAX)
            .collect();
        let edges: Vec<CurveEdge> = input.curve_edges.clone();
        Ok(Triangulation {
            complex: Complex::new(count, triangles, edges)?,
            dropped: (0..count as u32)
                .filter(|&v| front.dropped[v as usize])
                .collect(),
            incomplete,
            counts,
        })
    }
}

/// One triangulation under way.
struct Run<'r, 'a, S: Scalar> {
    /// What the plug-ins did wrong.
    watch: &'r Watch,
    front: &'r mut Front<'a, S>,
    /// Neighborhood of each landmark of a cell.
    home: Vec<usize>,
    /// Neighborhoods of each landmark on a curve, one a cell.
    sectors: Vec<Vec<usize>>,
    done: Vec<bool>,
    queue: VecDeque<u32>,
    kept: Vec<u32>,
    counts: TriangulationCounts,
    incomplete: Vec<Incomplete>,
    /// Repairs that may still be tried.
    attempts: usize,
}

impl<S: Scalar> Run<'_, '_, S> {
    fn all(&mut self) -> Result<(), Error> {
        let count = self.home.len();
        let mut open = Vec::new();
        for seed in 0..count as u32 {
            self.queue.push_back(seed);
            while let Some(v) = self.queue.pop_front() {
                let k = self.home[v as usize];
                if self.done[v as usize] || self.front.dropped[v as usize] || k == usize::MAX {
                    continue;
                }
                if !self.visit_or_undo(k)? && !self.mend(v, k, false)? {
                    if !self.front.parts.repair {
                        self.incomplete.push(Incomplete { landmark: v });
                        return Ok(());
                    }
                    open.push((v, k));
                }
                self.done[v as usize] = true;
                self.advance(v);
            }
        }
        // Once more for those that stayed open, now that their surroundings are complete; a
        // landmark is given up only then, since a hole can be closed only from all around.
        for (v, k) in std::mem::take(&mut open) {
            if !self.front.dropped[v as usize]
                && !self.visit_or_undo(k)?
                && !self.mend(v, k, true)?
            {
                open.push((v, k));
            }
        }
        // Stars of curve landmarks, which no visit of a cell has to close.
        let mut curve_open = Vec::new();
        let passes = if self.front.parts.rules.curve_stars {
            CURVE_PASSES
        } else {
            0
        };
        for _ in 0..passes {
            curve_open.clear();
            let before = self.counts.repairs;
            for v in 0..count as u32 {
                for k in self.sectors[v as usize].clone() {
                    if !self.visit_or_undo(k)? && !self.mend(v, k, true)? {
                        curve_open.push((v, k));
                    }
                }
            }
            if self.counts.repairs == before {
                break;
            }
        }
        open.extend(curve_open);
        self.incomplete = open
            .into_iter()
            .map(|(v, _)| Incomplete { landmark: v })
            .collect();
        self.incomplete.sort_unstable_by_key(|i| i.landmark);
        self.incomplete.dedup();
        Ok(())
    }

    /// Queues the neighbors of `v`.
    fn advance(&mut self, v: u32) {
        let mut next: Vec<u32> = self.front.incident[v as usize]
            .iter()
            .flat_map(|&t| self.front.triangles[t as usize])
            .filter(|&u| !self.done[u as usize])
            .collect();
        next.sort_unstable();
        next.dedup();
        self.queue.extend(next);
    }

    /// Closes the star of a neighborhood's center; `false` when it stays open.
    fn visit(&mut self, k: usize) -> Result<bool, Error> {
        self.counts.visits += 1;
        let input = self.front.input;
        let mut kept = std::mem::take(&mut self.kept);
        self.watch.enter(input.neighborhoods[k].center);
        let mut patch = Patch::new(self.front, &input.neighborhoods[k], &mut kept)?;
        let closed = patch.close(self.front);
        self.kept = kept;
        self.watch.none()?;
        Ok(closed)
    }

    /// The same, leaving no part of a star behind that stays open.
    fn visit_or_undo(&mut self, k: usize) -> Result<bool, Error> {
        self.front.log.clear();
        let closed = self.visit(k)?;
        if !closed {
            self.front.roll_back(0);
        }
        Ok(closed)
    }

    /// Tries to close the star of `v` by repairs, with `drop` also by giving up a landmark.
    /// `true` when one succeeded.
    fn mend(&mut self, v: u32, k: usize, drop: bool) -> Result<bool, Error> {
        if !self.front.parts.repair || self.attempts == 0 {
            return Ok(false);
        }
        let members: Vec<u32> = self.front.input.neighborhoods[k]
            .members
            .iter()
            .copied()
            .filter(|&m| !self.front.dropped[m as usize])
            .collect();
        for reach in TEARS {
            if reach < members.len() + 4 && self.attempt(v, k, &members, reach, None)? {
                return Ok(true);
            }
        }
        if !drop {
            return Ok(false);
        }
        let cell = |u: &u32| self.front.input.strata[*u as usize] == 2;
        let droppable: Vec<u32> = members
            .iter()
            .copied()
            .filter(cell)
            .take(1 + DROPS)
            .collect();
        for u in droppable {
            for reach in [0, 8] {
                if self.attempt(v, k, &members, reach, Some(u))? {
                    self.counts.dropped += 1;
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// One repair, all or nothing.
    fn attempt(
        &mut self,
        v: u32,
        k: usize,
        members: &[u32],
        reach: usize,
        drop: Option<u32>,
    ) -> Result<bool, Error> {
        self.attempts = match self.attempts.checked_sub(1) {
            Some(left) => left,
            None => return Ok(false),
        };
        self.front.log.clear();
        let mut touched = Vec::new();
        // A landmark on a curve has triangles in other cells, which are none of this chart's business.
        let mut sorted = members.to_vec();
        sorted.sort_unstable();
        let inside = |c: u32| sorted.binary_search(&c).is_ok();
        let on_curve = self.front.input.strata[v as usize] < 2;
        let within = |c: u32| !on_curve || inside(c);
        self.front.clear(v, within, &mut touched);
        for &m in members.iter().skip(1).take(reach) {
            if self.front.input.strata[m as usize] == 2 {
                self.front.clear(m, |_| true, &mut touched);
            } else {
                self.front.clear(m, inside, &mut touched);
            }
        }
        if let Some(u) = drop {
            self.front.clear(u, |_| true, &mut touched);
            self.front.dropped[u as usize] = true;
        }
        let mut order: Vec<u32> = members.to_vec();
        touched.sort_unstable();
        touched.dedup();
        order.retain(|m| touched.binary_search(m).is_ok() && *m != v);
        let far: Vec<u32> = touched
            .into_iter()
            .filter(|m| !members.contains(m))
            .collect();
        order.extend(far);
        let mut good = drop == Some(v) || self.visit(k)?;
        for u in order {
            if !good {
                break;
            }
            let home = self.home[u as usize];
            if self.done[u as usize] && home != usize::MAX && !self.front.dropped[u as usize] {
                good = self.visit(home)?;
            }
        }
        if good {
            self.counts.repairs += 1;
            // Landmarks that gained triangles and are not visited yet are on the front.
            let reached: Vec<u32> = self.front.log.iter().flat_map(|l| l.1).collect();
            self.queue
                .extend(reached.into_iter().filter(|&u| !self.done[u as usize]));
        } else {
            self.front.roll_back(0);
            if let Some(u) = drop {
                self.front.dropped[u as usize] = false;
            }
        }
        Ok(good)
    }
}
