//! The frame of a group: its directions, and the fringe copied into it.

use super::{FAR, Sweep};
use crate::moments::packed;
use crosscap_core::Scalar;

impl<S: Scalar, const L: usize, const M: usize> Sweep<'_, S, L, M> {
    /// Finds the directions of the frame.
    #[inline(always)]
    pub(super) fn turn(&mut self) {
        let n = self.n;
        let m = n.min(M);
        if n <= 3 || !self.has_moments() {
            return self.directions.reset(m, n);
        }
        let tree = self.reach.tree;
        self.full_sum.clone_from(&self.common_sum);
        self.full_products.clone_from(&self.common_products);
        let mut count = f64::from(self.common_count);
        if count < 4.0 * n as f64 {
            for &at in &self.fringe {
                let own = tree.nodes[at as usize].count() as f64;
                let mean = tree.mean(at as usize);
                for ((o, s), (a, b)) in (self.offset.iter_mut().zip(&mut self.full_sum))
                    .zip(mean.iter().zip(&self.center))
                {
                    *o = a - b;
                    *s += own * *o;
                }
                packed::add_shifted(
                    &mut self.full_products,
                    tree.scatter(at as usize),
                    &self.offset,
                    own,
                    1.0,
                );
                count += own;
            }
        }
        if count > 0.0 {
            packed::add_square(&mut self.full_products, &self.full_sum, -1.0 / count);
        }
        let trace = packed::trace(&self.full_products, n);
        if trace > 0.0 {
            self.full_products.iter_mut().for_each(|x| *x /= trace);
        }
        packed::unfold(&self.full_products, n, &mut self.dense);
        self.directions.follow(&self.dense, m, n);
    }

    /// Writes a place in the frame to `local` and `beside`.
    #[inline(always)]
    pub(super) fn localize(&mut self, position: usize) {
        let place = self.reach.tree.place(position);
        for ((o, y), c) in self.offset.iter_mut().zip(place).zip(&self.center) {
            *o = (y - c) * self.reach.inverse;
        }
        self.local = [0.0; M];
        if self.n <= 3 {
            for (z, o) in self.local.iter_mut().zip(&self.offset) {
                *z = *o;
            }
            return;
        }
        // Direction by direction it would be a chain of dependent additions.
        let mut local = [0.0; M];
        for (column, x) in self.columns.iter().zip(&self.offset) {
            for (z, d) in local.iter_mut().zip(column) {
                *z += d * x;
            }
        }
        self.local = local;
        if self.rest {
            let inner: f64 = local.iter().map(|z| z * z).sum();
            self.beside = (sum_of_squares(&self.offset) - inner).max(0.0).sqrt();
        }
    }

    /// Copies the fringe into the frame, unit by unit.
    #[inline(always)]
    pub(super) fn copy_fringe(&mut self) {
        let width = self.width;
        let units = self.fringe.len();
        let tree = self.reach.tree;
        let tests = M + usize::from(self.rest);
        self.lanes.clear();
        self.lanes.resize(units * tests, [FAR; L]);
        // Units are written as a whole, so nothing old is read; one more keeps all offsets valid.
        self.features
            .resize(self.features.len().max((units + 1) * L * width), 0.0);
        self.unit_features
            .resize(self.unit_features.len().max((units + 1) * width), 0.0);
        self.middles.resize(self.middles.len().max(units * M), 0.0);
        self.radii.clear();
        self.rests.clear();
        self.gaps.resize(units, 0.0);
        for unit in 0..units {
            let node = &tree.nodes[self.fringe[unit] as usize];
            let (start, count) = (node.start as usize, node.count());
            let mut farthest_rest = 0.0_f64;
            let mut places = [[0.0; M]; L];
            let at = unit * L * width;
            self.unit_features[unit * width..(unit + 1) * width].fill(0.0);
            self.features[at + count * width..at + L * width].fill(0.0);
            for (lane, place) in places.iter_mut().enumerate().take(count) {
                self.localize(start + lane);
                *place = self.local;
                let features = &mut self.features[at + lane * width..at + (lane + 1) * width];
                write_features(place, self.beside, features);
                let own = &mut self.unit_features[unit * width..(unit + 1) * width];
                for (s, f) in own.iter_mut().zip(&*features) {
                    *s += f;
                }
                farthest_rest = farthest_rest.max(self.beside);
                if self.rest {
                    self.lanes[unit * tests + M][lane] = self.beside as f32;
                }
            }
            self.copy_lanes(unit, &places[..count]);
            self.rests.push((farthest_rest * (1.0 + 1e-6)) as f32);
        }
    }

    /// Writes the places of a unit lane by lane, with their middle and radius.
    #[inline(always)]
    fn copy_lanes(&mut self, unit: usize, places: &[[f64; M]]) {
        let units = self.fringe.len();
        let tests = M + usize::from(self.rest);
        let lanes = &mut self.lanes[unit * tests..unit * tests + M];
        let mut middle = [0.0; M];
        let share = 1.0 / places.len() as f64;
        for (lane, place) in places.iter().enumerate() {
            for k in 0..M {
                lanes[k][lane] = place[k] as f32;
                middle[k] += place[k] * share;
            }
        }
        let mut farthest = 0.0_f64;
        for place in places {
            let square: f64 = place
                .iter()
                .zip(&middle)
                .map(|(a, b)| (a - b) * (a - b))
                .sum();
            farthest = farthest.max(square);
        }
        for (k, x) in middle.iter().enumerate() {
            self.middles[k * units + unit] = *x as f32;
        }
        self.radii.push((farthest.sqrt() * (1.0 + 1e-6)) as f32);
    }

    /// The common moments in the frame.
    #[inline(always)]
    pub(super) fn compress_common(&mut self) {
        let n = self.n;
        self.common_features.clear();
        self.common_features.resize(self.width, 0.0);
        if self.common_products.is_empty() {
            return;
        }
        let inverse = self.reach.inverse;
        let square = inverse * inverse;
        let length = packed::length(M);
        packed::unfold(&self.common_products, n, &mut self.dense);
        let rows = &self.directions.rows;
        let mut inner = 0.0;
        let mut first = 0;
        for (i, v) in rows.chunks_exact(n).enumerate() {
            self.offset.fill(0.0);
            for (row, x) in self.dense.chunks_exact(n).zip(v) {
                for (o, a) in self.offset.iter_mut().zip(row) {
                    *o += a * x;
                }
            }
            for (j, w) in rows.chunks_exact(n).enumerate().skip(i) {
                let product = w.iter().zip(&self.offset).map(|(a, b)| a * b).sum::<f64>() * square;
                if i == j {
                    inner += product;
                }
                self.common_features[first + j - i] = product;
            }
            first += M - i;
            self.common_features[length + i] = v
                .iter()
                .zip(&self.common_sum)
                .map(|(a, b)| a * b)
                .sum::<f64>()
                * inverse;
        }
        if self.rest {
            let whole = packed::trace(&self.common_products, n) * square;
            self.common_features[length + M] = (whole - inner).max(0.0);
        }
    }
}

/// Products, coordinates and squared distance from the span.
#[inline(always)]
fn write_features<const M: usize>(place: &[f64; M], beside: f64, out: &mut [f64]) {
    let mut at = 0;
    for i in 0..M {
        for j in i..M {
            out[at] = place[i] * place[j];
            at += 1;
        }
    }
    for x in place {
        out[at] = *x;
        at += 1;
    }
    // With three coordinates there is nothing beside them.
    if at < out.len() {
        out[at] = beside * beside;
    }
}

/// Squared length, in four chains of additions.
#[inline(always)]
fn sum_of_squares(v: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let mut p = v.chunks_exact(4);
    for x in &mut p {
        for k in 0..4 {
            lanes[k] += x[k] * x[k];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + p.remainder().iter().map(|x| x * x).sum::<f64>()
}
