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
