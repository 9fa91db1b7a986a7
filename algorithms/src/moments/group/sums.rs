//! Moments of a ball, from the parts that are in it, and what follows from them.

use super::Sweep;
use crate::moments::{decide, packed, wide};
use crate::principal::PrincipalFrame;
use crosscap_core::Scalar;

/// Relative error of the covariance from which it is computed from the original coordinates.
const ACCURACY: f64 = 1e-10;

impl<S: Scalar, const L: usize, const M: usize> Sweep<'_, S, L, M> {
    /// The dimension of the ball whose parts were found last.
    #[inline(always)]
    pub(super) fn dimension(&mut self, dt: f64) -> u32 {
        if !self.has_moments() {
            return self.naive(dt);
        }
        let mut sum = std::mem::take(&mut self.sum);
        sum.clone_from(&self.common_features);
        if M <= 3 {
            self.add_features::<10>(&mut sum)
        } else {
            self.add_features::<14>(&mut sum)
        }
        self.sum = sum;
        let length = packed::length(M);
        let share = 1.0 / f64::from(self.parts.count);
        self.sum.iter_mut().for_each(|x| *x *= share);
        let (products, tail) = self.sum.split_at_mut(length);
        let rest = if self.rest { tail[M].max(0.0) } else { 0.0 };
        let second_moment = packed::trace(products, M) + rest;
        packed::add_square(products, &tail[..M], -1.0);
        let trace = packed::trace(products, M);
        if !self.accurate(trace, second_moment) {
            return self.naive(dt);
        }
        let products = &self.sum[..length];
        let found = if M <= 3 {
            decide::sure(dt, |dt| decide::small(products, M, dt))
        } else {
            decide::compressed(products, M, rest, dt).or_else(|| self.spectrum(dt))
        };
        match found {
            Some(dimension) => dimension,
            None => self.naive(dt),
        }
    }

    /// Whether the covariance is not lost in the moments (both in units of the radius).
    #[inline(always)]
    pub(super) fn accurate(&self, trace: f64, second_moment: f64) -> bool {
        let lost = 0.5 * self.noise * trace.sqrt() + 4.0 * f64::EPSILON * second_moment;
        trace > 0.0 && lost <= ACCURACY * trace
    }

    #[inline(always)]
    pub(super) fn add_features<const W: usize>(&self, sum: &mut [f64]) {
        let width = self.width;
        for at in (0..width).step_by(W) {
            let mut own = [0.0; W];
            own.copy_from_slice(&sum[at..at + W]);
            add_rows::<W, true>(
                &mut own,
                &self.unit_features[at..],
                width,
                &self.parts.inside,
            );
            add_rows::<W, true>(&mut own, &self.unit_features[at..], width, &self.parts.most);
            add_rows::<W, true>(&mut own, &self.features[at..], width, self.parts.plus());
            add_rows::<W, false>(&mut own, &self.features[at..], width, self.parts.minus());
            sum[at..at + W].copy_from_slice(&own);
        }
    }

    /// Mean and covariance in all coordinates, in units of the radius; `false` when they are not
    /// as accurate as they should be.
    #[cold]
    pub(super) fn full(&mut self) -> bool {
        let n = self.n;
        let tree = self.reach.tree;
        let mut sum = std::mem::take(&mut self.full_sum);
        let mut products = std::mem::take(&mut self.full_products);
        sum.clone_from(&self.common_sum);
        products.clone_from(&self.common_products);
        let parts = &self.parts;
        for &unit in parts.inside.iter().chain(&parts.most) {
            let at = self.fringe[unit as usize] as usize;
            let count = tree.nodes[at].count() as f64;
            for ((o, s), (a, b)) in
                (self.offset.iter_mut().zip(&mut sum)).zip(tree.mean(at).iter().zip(&self.center))
            {
                *o = a - b;
                *s += count * *o;
            }
            packed::add_shifted(&mut products, tree.scatter(at), &self.offset, count, 1.0);
        }
        for (list, sign) in [(parts.plus(), 1.0), (parts.minus(), -1.0)] {
            for &slot in list {
                let node = &tree.nodes[self.fringe[slot as usize / L] as usize];
                let position = node.start as usize + slot as usize % L;
                if position >= node.end as usize {
                    continue;
                }
                for ((o, s), (a, b)) in (self.offset.iter_mut().zip(&mut sum))
                    .zip(tree.place(position).iter().zip(&self.center))
                {
                    *o = a - b;
                    *s += sign * *o;
                }
                packed::add_square(&mut products, &self.offset, sign);
            }
        }
        let share = self.reach.inverse / f64::from(parts.count);
        sum.iter_mut().for_each(|s| *s *= share);
        let share = share * self.reach.inverse;
        products.iter_mut().for_each(|p| *p *= share);
        let second_moment = packed::trace(&products, n);
        packed::add_square(&mut products, &sum, -1.0);
        let trace = packed::trace(&products, n);
        self.full_sum = sum;
        self.full_products = products;
        self.parts.count == 1 || self.accurate(trace, second_moment)
    }

    /// The dimension from all eigenvalues, where they are accurate and sure.
    #[cold]
    fn spectrum(&mut self, dt: f64) -> Option<u32> {
        if !self.full() {
            return None;
        }
        let n = self.n;
        packed::unfold(&self.full_products, n, &mut self.dense);
        let mut values =
            nalgebra::DMatrix::from_row_slice(n, n, &self.dense).symmetric_eigenvalues();
        values.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
        decide::sure(dt, |dt| decide::dimension_of(values.as_slice(), dt))
    }

    /// The rows of the ball, from first to last.
    pub(super) fn collect(&mut self) {
        let tree = self.reach.tree;
        self.rows.clear();
        let mut add = |start: u32, end: u32| {
            self.rows.extend(
                tree.order[start as usize..end as usize]
                    .iter()
                    .map(|&i| i as usize),
            );
        };
        for &at in &self.common {
            add(tree.nodes[at as usize].start, tree.nodes[at as usize].end);
        }
        for &unit in &self.parts.inside {
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            add(node.start, node.end);
        }
        for &slot in self.parts.plus() {
            let position =
                tree.nodes[self.fringe[slot as usize / L] as usize].start + slot % L as u32;
            add(position, position + 1);
        }
        for &unit in &self.parts.most {
            let node = &tree.nodes[self.fringe[unit as usize] as usize];
            for position in node.start..node.end {
                if !self
                    .parts
                    .minus()
                    .contains(&(unit * L as u32 + position - node.start))
                {
                    add(position, position + 1);
                }
            }
        }
        self.rows.sort_unstable();
    }

    /// The dimension by its definition: a matter of the ball alone.
    #[cold]
    pub(super) fn naive(&mut self, dt: f64) -> u32 {
        self.collect();
        let cloud = self.reach.cloud;
        if !self.has_moments()
            && let Some(found) = wide::dimension(cloud, &self.rows, dt)
        {
            return found;
        }
        let frame = PrincipalFrame::of(cloud, self.rows.iter().copied());
        decide::dimension_of(&frame.variances, dt)
    }
}

/// Adds or subtracts the rows in the list.
#[inline(always)]
fn add_rows<const W: usize, const ADD: bool>(
    sum: &mut [f64; W],
    rows: &[f64],
    width: usize,
    list: &[u32],
) {
    for &r in list {
        if let Some(row) = rows[r as usize * width..].first_chunk::<W>() {
            for (s, x) in sum.iter_mut().zip(row) {
                *s = if ADD { *s + x } else { *s - x };
            }
        }
    }
}
