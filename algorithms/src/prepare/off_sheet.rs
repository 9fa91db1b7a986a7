//! Whether a point is on a sheet with its neighbors, or on anything else.

use super::LocalSpacing;
use super::sheet_fit::SheetFit;
use crate::balls::Near;
use crate::tuning::OutlierTuning;
use crosscap_core::{PointCloud, squared_distance};

// What is left here are constants of the estimate, not decisions: how a robust scale is read.

/// Rounds of weighting points by how far they are from the sheet.
const WEIGHTINGS: usize = 4;
/// Weights end at this many times the scale of the residuals (Beaton & Tukey 1974: 95 % efficiency).
const TUKEY: f64 = 4.685;
/// The scale of a normal distribution over its median absolute value.
pub(super) const MEDIAN_TO_SCALE: f64 = 1.4826;

/// What the neighbors say of a point, lengths in spacings of the surface.
pub(super) struct Judgement {
    /// From the sheet, or from the second nearest point where it is away from all of them.
    pub(super) distance: f64,
    /// Noise of the neighbors.
    pub(super) scale: f64,
    /// Whether it is off the sheet, and nothing else is near it.
    pub(super) unsupported: bool,
    /// Whether it is away from all of them.
    pub(super) alone: bool,
}

/// Judges the points of a cloud.
pub(super) struct Judge<'a> {
    cloud: &'a PointCloud<f64>,
    spacing: &'a LocalSpacing,
    tuning: &'a OutlierTuning,
    fit: SheetFit,
    offset: Vec<f64>,
}

/// The neighbors of a point, nearest first, and the sheet's distances from them.
struct Around {
    points: Vec<f64>,
    /// Whether each lies as densely as a surface.
    dense: Vec<bool>,
    distances: Vec<f64>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        cloud: &'a PointCloud<f64>,
        spacing: &'a LocalSpacing,
        tuning: &'a OutlierTuning,
    ) -> Self {
        Self {
            cloud,
            spacing,
            tuning,
            fit: SheetFit::new(cloud.dimension()),
            offset: Vec::new(),
        }
    }

    /// Lays the sheet, and returns the scale of the distances of the dense neighbors from it.
    fn lay(&mut self, around: &mut Around) -> Option<f64> {
        let n = self.cloud.dimension();
        let mut weights: Vec<f64> = (around.dense.iter())
            .map(|&dense| if dense { 1.0 } else { 0.0 })
            .collect();
        let mut scale = 0.0;
        for _ in 0..WEIGHTINGS {
            if !self.fit.fit(&around.points, &weights) {
                return None;
            }
            around.distances.clear();
            for x in around.points.chunks_exact(n) {
                let d = self.fit.distance(x, f64::INFINITY, &mut self.offset);
                around.distances.push(d);
            }
            let dense = || (around.distances.iter().zip(&around.dense)).filter(|x| *x.1);
            let mut sorted: Vec<f64> = dense().map(|x| *x.0).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            scale = MEDIAN_TO_SCALE * sorted[sorted.len() / 2];
            if scale <= 0.0 {
                break;
            }
            for (w, (d, dense)) in
                (weights.iter_mut()).zip(around.distances.iter().zip(&around.dense))
            {
                let u = d / (TUKEY * scale);
                *w = if *dense {
                    (1.0 - u * u).max(0.0).powi(2)
                } else {
                    0.0
                };
            }
        }
        Some(scale)
    }

    /// `None` where there is no sheet.
    pub(super) fn judge(&mut self, at: usize, near: &[Near]) -> Option<Judgement> {
        let (unit, tuning) = (self.spacing.low(at), self.tuning);
        if near.len() < tuning.neighbors || unit <= 0.0 {
            return None;
        }
        let mut near: Vec<Near> = near.to_vec();
        near.sort_unstable();
        let n = self.cloud.dimension();
        let mut around = Around {
            points: Vec::with_capacity(near.len() * n),
            dense: Vec::with_capacity(near.len()),
            distances: Vec::with_capacity(near.len()),
        };
        for x in &near {
            let row = x.index() as usize;
            around.points.extend_from_slice(self.cloud.point(row));
            around
                .dense
                .push(self.spacing.raw(row) <= tuning.sparse * unit);
        }
        let scale = self.lay(&mut around)?;
        let own = self.cloud.point(at);
        let mut reach = 0.0_f64;
        for (x, dense) in around.points.chunks_exact(n).zip(&around.dense) {
            if *dense {
                reach = reach.max(self.fit.out(x, &mut self.offset));
            }
        }
        let distance = self.fit.distance(own, 1.5 * reach, &mut self.offset);
        let limit = (tuning.least_distance * unit).max(tuning.least_deviations * scale);
        let second = near[1].square().sqrt();
        let out = self.fit.out(own, &mut self.offset);
        let alone = out > tuning.alone * reach || second > tuning.empty * unit;
        Some(Judgement {
            distance: if alone {
                distance.max(second)
            } else {
                distance
            } / unit,
            scale: scale / unit,
            unsupported: distance > limit && !around.supports(own, [distance, limit, unit], tuning),
            alone,
        })
    }
}

impl Around {
    /// Whether points off the sheet make a stratum that `own`, at the given distance from the sheet, is on. What is
    /// nearer than the limit is on the sheet; the unit is the spacing of the surface.
    fn supports(
        &self,
        own: &[f64],
        [distance, limit, unit]: [f64; 3],
        tuning: &OutlierTuning,
    ) -> bool {
        let rows = self.points.chunks_exact(own.len()).zip(&self.dense);
        let off: Vec<(&[f64], bool)> = (rows.zip(&self.distances))
            .filter(|x| *x.1 > tuning.off * limit)
            .map(|((x, dense), _)| (x, *dense))
            .collect();
        let beside = distance < tuning.beside * unit;
        let (radius, needed) = if beside {
            (f64::INFINITY, tuning.stratum_beside)
        } else {
            (tuning.stratum_radius * unit, tuning.stratum)
        };
        let dense = (off.iter())
            .filter(|x| x.1 && squared_distance(x.0, own) < radius * radius)
            .count();
        let nearest = &off[..off.len().min(tuning.on_curve)];
        let line = nearest.len() >= 2
            && (nearest.windows(2)).all(|pair| in_line(own, pair[0].0, pair[1].0, tuning.in_line));
        line || dense >= needed
    }
}

/// Whether two points are in line with `own`, on one side or on both, by the least cosine that counts.
fn in_line(own: &[f64], a: &[f64], b: &[f64], least: f64) -> bool {
    let product: f64 = (own.iter().zip(a.iter().zip(b)))
        .map(|(o, (a, b))| (a - o) * (b - o))
        .sum();
    product.abs() > least * (squared_distance(own, a) * squared_distance(own, b)).sqrt()
}
