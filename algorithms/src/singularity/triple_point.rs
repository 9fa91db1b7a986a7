//! Three sheets that cross in a point.

use super::flats::{candidates, greedy};
use super::one_fit::{OneFit, located};
use super::patch::PATCH_POINTS;
use super::sheets::Sheets;
use super::tolerance::{Tolerance, at_least, vectors};
use super::vanishing::Vanishing;
use crate::tuning::TriplePointTuning;
use crosscap_core::{
    Decomposition, Error, Label, Link, LinkKind, LocalPoints, Located, Rejection, SingularityModel,
    Stratum,
};
use nalgebra::{Matrix3, Vector3};

/// Three sheets of space in general position: a triple point, from which six arcs of double
/// curves start, with twelve cells between them.
///
/// The planes are those of the cubic that vanishes on the points, read off its gradients
/// (generalized principal component analysis; Vidal, Ma, Sastry 2005), then each becomes a
/// quadratic patch. The triple point is where the patches meet, by Newton's method.
#[derive(Clone, Copy, Debug)]
pub struct TriplePoint {
    tolerance: Tolerance,
    tuning: TriplePointTuning,
}

/// Stratum of the arc on which sheet `k` is crossed by none: the curve of the two others, on
/// the side of sheet k where its distance is negative or not.
fn arc(k: usize, positive: bool) -> u8 {
    1 + 2 * k as u8 + u8::from(positive)
}

/// Stratum of the cell of sheet `k` on the given sides of the two next sheets.
fn cell(k: usize, first: bool, second: bool) -> u8 {
    7 + 4 * k as u8 + 2 * u8::from(first) + u8::from(second)
}

impl TriplePoint {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to two sheets is on a double curve, to all three at the triple point.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: TriplePointTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: TriplePointTuning) -> Self {
        Self { tuning, ..self }
    }
}

/// Three sheets fitted to a neighborhood.
struct Fit {
    all: Vec<Vector3<f64>>,
    sheets: Sheets,
    apex: Vector3<f64>,
    /// How far a point is moved at most.
    reach: f64,
    /// Least sine at which sheets meet.
    sine: f64,
    labels: Vec<u8>,
    residual: f64,
}

impl TriplePoint {
    /// Fits three patches, and labels all points.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(4 * PATCH_POINTS, local)?;
        let count = local.fitted;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        let cubic = Vanishing::fit(points, 3, 1, local.radius).ok_or(Rejection::NoRealSolution)?;
        let found = candidates(points, |x, out| cubic.gradients(x, out));
        let planes = greedy(points, &found, 3, self.tuning.plane * local.radius)
            .ok_or(Rejection::NoRealSolution)?;
        let normals = [0, 1, 2].map(|k| planes[k].normals[0]);
        if Matrix3::from_columns(&normals).determinant().abs() < self.tuning.determinant {
            return Err(Rejection::NoRealSolution);
        }
        let sheets = Sheets::new(&planes, &all, count, local.radius, |_, d, _| d);
        let reach = self.tuning.reach * local.radius;
        let apex = sheets
            .meet(&[0, 1, 2], 3, all[local.center], reach, self.tuning.meet)
            .ok_or(Rejection::NoRealSolution)?;
        let mut fit = Fit {
            labels: vec![0; all.len()],
            all,
            sheets,
            apex,
            reach,
            sine: self.tuning.meet,
            residual: 0.0,
        };
        let (sum, held) = fit.label(count, self.tolerance.ep);
        fit.residual = self.tolerance.residual(sum, count)?;
        self.holds(&held, count)?;
        Ok(fit)
    }

    /// Whether every sheet and enough of the cells hold points.
    fn holds(&self, held: &[usize; 19], count: usize) -> Result<(), Rejection> {
        let least = (self.tuning.sheet_share * count as f64).max(PATCH_POINTS as f64 / 2.0);
        for k in 0..3 {
            let own: usize = held[usize::from(cell(k, false, false))..][..4].iter().sum();
            if (own as f64) < least {
                return Err(Rejection::EmptyStratum {
                    stratum: usize::from(cell(k, false, false)),
                    found: own,
                });
            }
        }
        if held[7..].iter().filter(|&&h| h > 0).count() < self.tuning.cells {
            let stratum = 7 + held[7..].iter().position(|&h| h == 0).unwrap_or(0);
            return Err(Rejection::EmptyStratum { stratum, found: 0 });
        }
        Ok(())
    }
}

impl Fit {
    /// Labels all points; the sum of the squared distances of the first `count` from their sheets, and how many of them
    /// have each label.
    fn label(&mut self, count: usize, ep: f64) -> (f64, [usize; 19]) {
        let mut held = [0usize; 19];
        let mut sum = 0.0;
        for (k, (x, label)) in self.all.iter().zip(&mut self.labels).enumerate() {
            let own = usize::from(self.sheets.owner[k]);
            let others = [(own + 1) % 3, (own + 2) % 3];
            let d = [0, 1, 2].map(|s| self.sheets.patches[s].signed_distance(x));
            let on = others.map(|s| d[own].abs() < ep && d[s].abs() < ep);
            *label = match on {
                [true, true] => 0,
                [true, false] => arc(others[1], d[others[1]] >= 0.0),
                [false, true] => arc(others[0], d[others[0]] >= 0.0),
                [false, false] => cell(own, d[others[0]] >= 0.0, d[others[1]] >= 0.0),
            };
            if k < count {
                sum += d[own] * d[own];
                held[usize::from(*label)] += 1;
            }
        }
        (sum, held)
    }
}

impl OneFit for Fit {
    fn located(&self, row: usize) -> Option<Located> {
        let x = self.all[row];
        let (dimension, place) = match self.labels[row] {
            0 => (0, Some(self.apex)),
            arc @ 1..=6 => {
                let third = usize::from((arc - 1) / 2);
                let pair = [(third + 1) % 3, (third + 2) % 3];
                (
                    1,
                    Some(self.sheets.meet(&pair, 2, x, self.reach, self.sine)?),
                )
            }
            _ => (2, None),
        };
        Some(located(x, dimension, 4 * u8::from(dimension > 0), place))
    }

    fn decomposition(self, center: Located) -> Decomposition {
        let dimensions = [0u8].into_iter().chain([1; 6]).chain([2; 12]);
        Decomposition {
            strata: dimensions.map(|dimension| Stratum { dimension }).collect(),
            cells_at_curve: vec![4; 6],
            residual: self.residual,
            parameters: 24,
            points: vec![self.apex.iter().copied().collect()],
            center: center.place,
            center_offset: center.offset,
            labels: self.labels.into_iter().map(Label::from).collect(),
        }
    }
}

impl SingularityModel for TriplePoint {
    fn local_dimension(&self) -> usize {
        3
    }

    fn link(&self) -> Option<Link> {
        LinkKind::Triple.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        self.fit(local)?.about(local.center, rows)
    }

    fn name(&self) -> &str {
        "triple-point"
    }
}
