//! The advancing front: which star is closed next.

use super::Star;
use super::front::Front;
use super::parts::AdvancingFront;
use super::star::Patch;
use crate::audit::{AuditedChart, AuditedRule, AuditedTest, Watch, known_pairs};
use crosscap_core::{
    Complex, CurveEdge, Error, Incomplete, Landmark, Scalar, StratifiedLandmarks, Table,
    Triangulation, TriangulationCounts, Triangulator,
};
use std::collections::VecDeque;
use std::sync::atomic::AtomicU32;

impl<S: Scalar> Triangulator<S> for AdvancingFront<'_> {
    /// Every landmark of a cell is visited and its star closed, the front
    /// advancing from neighbor to neighbor; then the stars of curve landmarks are completed, cell by cell.
    ///
    /// When a star cannot be closed, a repair removes the triangles around it, closes it first
    /// and then every star that lost a triangle; wider and wider, and at last without the landmark or
    /// one of its neighbors. A repair counts only as a whole: one that leaves any star open is
    /// undone, so that a site that cannot be triangulated stays where it is.
    ///
    /// # Errors
    /// Those of the chart; [`Error::Law`], whose point is the landmark, for a chart
    /// of the wrong size or not finite, a test that is not symmetric, a rank that is NaN or depends on the
    /// order of the ends, or a triangle without area that does not rank last.
    ///
    /// O(L k^2) for L landmarks with k members in a neighborhood, plus the charts.
    fn triangulate(&self, input: &StratifiedLandmarks<S>) -> Result<Triangulation, Error> {
        let first = input.neighborhoods().first().and_then(|near| {
            let (&a, &b) = (near.members().first()?, near.members().get(1)?);
            input.distances().get(a, b)
        });
        let size = first.map_or(1.0, Scalar::as_f64);
        known_pairs(self.test, if size > 0.0 { size } else { 1.0 })?;
        let watch = Watch::default();
        let parts = &AdvancingFront {
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
        let mut front = Front::new(parts, input);
        let mut run = Run::new(&watch, &mut front);
        run.all()?;
        let (counts, incomplete) = (run.counts, std::mem::take(&mut run.incomplete));
        let count = input.strata().len();
        let edges: Vec<CurveEdge> = input.curve_edges().to_vec();
        Ok(Triangulation {
            complex: Complex::new(count, front.standing(), edges)?,
            dropped: (front.dropped.ids().filter(|&v| front.dropped[v])).collect(),
            incomplete,
            counts,
        })
    }

    fn name(&self) -> &str {
        "advancing-front"
    }
}

/// One triangulation under way.
pub(super) struct Run<'r, 'a, S: Scalar> {
    /// What the plug-ins did wrong.
    watch: &'r Watch,
    pub(super) front: &'r mut Front<'a, S>,
    /// Neighborhood of each landmark of a cell; none of one on a curve.
    pub(super) home: Table<Landmark, Option<Star>>,
    /// Neighborhoods of each landmark on a curve, one a cell.
    sectors: Table<Landmark, Vec<Star>>,
    pub(super) done: Table<Landmark, bool>,
    pub(super) queue: VecDeque<Landmark>,
    kept: Vec<Landmark>,
    pub(super) counts: TriangulationCounts,
    incomplete: Vec<Incomplete>,
    /// Repairs that may still be tried.
    pub(super) attempts: usize,
}

impl<'r, 'a, S: Scalar> Run<'r, 'a, S> {
    fn new(watch: &'r Watch, front: &'r mut Front<'a, S>) -> Self {
        let (input, tuning) = (front.input, front.parts.tuning);
        let count = input.strata().len();
        let mut home = Table::filled(count, None);
        let mut sectors: Table<Landmark, Vec<Star>> = Table::filled(count, Vec::new());
        for (k, near) in input.neighborhoods().iter().enumerate() {
            let star = Star::new(k);
            if input.strata()[near.center()] == 2 {
                home[near.center()] = Some(star);
            } else {
                sectors[near.center()].push(star);
            }
        }
        Self {
            watch,
            front,
            home,
            sectors,
            done: Table::filled(count, false),
            queue: VecDeque::new(),
            kept: Vec::new(),
            counts: TriangulationCounts::default(),
            incomplete: Vec::new(),
            attempts: tuning.attempts + count / tuning.landmarks_per_attempt.max(1),
        }
    }

    fn all(&mut self) -> Result<(), Error> {
        let Some(mut open) = self.advance_everywhere()? else {
            return Ok(());
        };
        // Once more for those that stayed open, now that their surroundings are complete; a
        // landmark is given up only then, since a hole can be closed only from all around.
        for (v, k) in std::mem::take(&mut open) {
            if !self.front.dropped[v] && !self.visit_or_undo(k)? && !self.mend(v, k, true)? {
                open.push((v, k));
            }
        }
        open.extend(self.close_curves()?);
        self.incomplete = open
            .into_iter()
            .map(|(v, _)| Incomplete { landmark: v })
            .collect();
        self.incomplete.sort_unstable_by_key(|i| i.landmark);
        self.incomplete.dedup();
        Ok(())
    }

    /// Visits every landmark of a cell, and tells those whose stars stayed open with their neighborhoods;
    /// `None` where the first of them ends everything.
    fn advance_everywhere(&mut self) -> Result<Option<Vec<(Landmark, Star)>>, Error> {
        let mut open = Vec::new();
        for seed in self.done.ids() {
            self.queue.push_back(seed);
            while let Some(v) = self.queue.pop_front() {
                let Some(k) = self.home[v] else {
                    continue;
                };
                if self.done[v] || self.front.dropped[v] {
                    continue;
                }
                if !self.visit_or_undo(k)? && !self.mend(v, k, false)? {
                    if !self.front.parts.repair {
                        self.incomplete.push(Incomplete { landmark: v });
                        return Ok(None);
                    }
                    open.push((v, k));
                }
                self.done[v] = true;
                self.advance(v);
            }
        }
        Ok(Some(open))
    }

    /// Closes the stars of curve landmarks, which no visit of a cell has to close; those that stayed open.
    fn close_curves(&mut self) -> Result<Vec<(Landmark, Star)>, Error> {
        let mut open = Vec::new();
        let passes = if self.front.parts.rules.curve_stars {
            self.front.parts.tuning.curve_passes
        } else {
            0
        };
        for _ in 0..passes {
            open.clear();
            let before = self.counts.repairs;
            for v in self.done.ids() {
                for k in self.sectors[v].clone() {
                    if !self.visit_or_undo(k)? && !self.mend(v, k, true)? {
                        open.push((v, k));
                    }
                }
            }
            if self.counts.repairs == before {
                break;
            }
        }
        Ok(open)
    }

    /// Queues the neighbors of `v`.
    fn advance(&mut self, v: Landmark) {
        let mut next: Vec<Landmark> = self.front.incident[v]
            .iter()
            .flat_map(|&t| self.front.triangles[t])
            .filter(|&u| !self.done[u])
            .collect();
        next.sort_unstable();
        next.dedup();
        self.queue.extend(next);
    }

    /// Closes the star of a neighborhood's center; `false` when it stays open.
    pub(super) fn visit(&mut self, k: Star) -> Result<bool, Error> {
        self.counts.visits += 1;
        let input = self.front.input;
        let mut kept = std::mem::take(&mut self.kept);
        let near = &input.neighborhoods()[k.index()];
        self.watch.enter(near.center());
        let mut patch = Patch::new(self.front, near, &mut kept)?;
        let closed = patch.close(self.front);
        self.kept = kept;
        self.watch.none()?;
        Ok(closed)
    }

    /// The same, leaving no part of a star behind that stays open.
    fn visit_or_undo(&mut self, k: Star) -> Result<bool, Error> {
        self.front.mark();
        let closed = self.visit(k)?;
        if !closed {
            self.front.roll_back();
        }
        Ok(closed)
    }
}
