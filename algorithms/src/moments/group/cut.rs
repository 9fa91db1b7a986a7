//! Which parts of the fringe are in a ball.

use super::{FAR, Sweep};
use crate::moments::reach::Reach;
use crosscap_core::Scalar;

/// A leaf is counted from its outsiders where this share of it is inside.
const COMPLEMENT: f64 = 0.6;

impl<S: Scalar, const L: usize, const M: usize> Sweep<'_, S, L, M> {
    /// Finds which parts of the fringe are in the ball about a position.
    #[inline(always)]
    pub(super) fn part(&mut self, position: usize) {
        self.localize(position);
        let tree = self.reach.tree;
        let tests = M + usize::from(self.rest);
        let query = self.local.map(|z| z as f32);
        let beside = self.beside as f32;
        let limits = self.limits();
        self.find_gaps(&query);
        let straddling = self.sort_units(beside, limits);

        let parts = &mut self.parts;
        let mut count = self.common_count;
        for &unit in &parts.inside {
            count += tree.nodes[self.fringe[unit as usize] as usize].count() as u32;
        }
        let (mut plus, mut minus) = (0, 0);
        for &unit in &parts.straddling[..straddling] {
            let lanes = &self.lanes[unit as usize * tests..(unit as usize + 1) * tests];
            let (low, mut high) = squares(lanes, &query, self.rest.then_some(beside));
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            let own = node.count();
            let (mut within, reached) = counts(&low, &high, limits);
            let mut limit = limits[0];
            if within != reached {
                limit = 0.5;
                within = settle(
                    self.reach,
                    position,
                    node.start as usize,
                    &low[..own],
                    &mut high,
                    limits,
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

    /// Squared distances below which a point is inside, and above which it is outside, in units of the radius.
    #[inline(always)]
    fn limits(&self) -> [f32; 2] {
        let shell = self.shell as f32;
        // Where the shell is everything: NaN refuses every comparison.
        if shell < 0.1 {
            [1.0 - 2.0 * shell, 1.0 + 4.0 * shell]
        } else {
            [f32::NAN, f32::INFINITY]
        }
    }

    /// How far the middle of every unit is away.
    #[inline(always)]
    fn find_gaps(&mut self, query: &[f32; M]) {
        let units = self.fringe.len();
        self.gaps.fill(0.0);
        for (q, middles) in query.iter().zip(self.middles.chunks_exact(units.max(1))) {
            for (g, c) in self.gaps.iter_mut().zip(middles) {
                *g += (c - q) * (c - q);
            }
        }
        self.gaps.iter_mut().for_each(|g| *g = g.sqrt());
    }

    /// Empties the parts, and lists the units that are inside as a whole and those that are neither inside nor outside; returns the
    /// number of the latter.
    #[inline(always)]
    fn sort_units(&mut self, beside: f32, [near_limit, far_limit]: [f32; 2]) -> usize {
        let units = self.fringe.len();
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
        straddling
    }
}

/// Least and greatest squared distance of every lane of a unit: the same number where the frame is all there is, else with the distances
/// from the frame on one side or on two.
#[inline(always)]
fn squares<const L: usize, const M: usize>(
    lanes: &[[f32; L]],
    query: &[f32; M],
    beside: Option<f32>,
) -> ([f32; L], [f32; L]) {
    let mut low = [0.0_f32; L];
    for (row, q) in lanes.iter().zip(query) {
        for (s, x) in low.iter_mut().zip(row) {
            *s += (x - q) * (x - q);
        }
    }
    let mut high = low;
    if let Some(beside) = beside {
        for ((l, h), x) in low.iter_mut().zip(&mut high).zip(&lanes[M]) {
            *l += (x - beside) * (x - beside);
            *h += (x + beside) * (x + beside);
        }
    }
    (low, high)
}

/// How many lanes are inside for certain, and how many may be.
#[inline(always)]
fn counts<const L: usize>(low: &[f32; L], high: &[f32; L], limits: [f32; 2]) -> (u32, u32) {
    let mut within = 0_u32;
    let mut reached = 0_u32;
    for (l, h) in low.iter().zip(high) {
        within += u32::from(*h < limits[0]);
        reached += u32::from(*l <= limits[1]);
    }
    (within, reached)
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
