//! A sheet and a curve that are fitted together.

use crate::singularity::curve_fit::{QuadraticCurve, STRAIGHT_POINTS};
use crate::singularity::flats::{Flat, candidates, greedy};
use crate::singularity::patch::{PATCH_POINTS, QuadraticPatch};
use crate::singularity::sheets::patch_over;
use crate::singularity::tolerance::{Tolerance, at_least, vectors};
use crate::singularity::vanishing::Vanishing;
use crate::tuning::CurveAndSheetTuning;
use crosscap_core::{Decomposition, Error, Label, LocalPoints, Rejection, Stratum};
use nalgebra::Vector3;

/// What a fit must satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Conditions {
    pub tolerance: Tolerance,
    pub tuning: CurveAndSheetTuning,
}

impl Conditions {
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: CurveAndSheetTuning::MEASURED,
        })
    }
}

/// Sheet and curve of a neighborhood.
#[derive(Clone)]
pub(super) struct Fit {
    curve: QuadraticCurve,
    /// Where they meet.
    apex: Vector3<f64>,
    residual: f64,
    /// For each point 0 for the apex, 1 and 2 for the arcs below and above the sheet, 3 for the sheet.
    labels: Vec<u8>,
    /// Points off the sheet below and above.
    pub arcs: [usize; 2],
}

/// The points farther than `limit` from the sheet.
fn off_sheet(sheet: &QuadraticPatch, points: &[Vector3<f64>], limit: f64) -> Vec<Vector3<f64>> {
    points
        .iter()
        .filter(|x| sheet.signed_distance(x).abs() > limit)
        .copied()
        .collect()
}

/// Whether one sheet holds nearly all points, as it mostly does.
fn one_sheet_holds(points: &[Vector3<f64>], radius: f64, ep: f64) -> bool {
    // The plane of the neighborhood is a sheet, too, and asks for no fit.
    if points.iter().all(|x| x.z.abs() <= ep) {
        return true;
    }
    let mut single =
        QuadraticPatch::plane(Vector3::zeros(), [Vector3::x(), Vector3::y(), Vector3::z()]);
    single.fit(points.iter().copied(), radius);
    let off = off_sheet(&single, points, ep);
    off.len() < STRAIGHT_POINTS && off_sheet(&single, points, 2.0 * ep).is_empty()
}

/// The plane that most points lie near, of those normal to gradients of two quadrics and of the `whole` neighborhood.
fn first_plane(
    points: &[Vector3<f64>],
    whole: Flat<3>,
    tuning: &CurveAndSheetTuning,
    radius: f64,
) -> Result<Flat<3>, Rejection> {
    let quadrics = Vanishing::fit(points, 2, 2, radius).ok_or(Rejection::NoRealSolution)?;
    let mut found = candidates(points, |x, out| quadrics.gradients(x, out));
    // With few points on the curve the gradients say little, but then the sheet holds nearly all.
    found.push(whole);
    for plane in &mut found {
        plane.normals.truncate(1);
    }
    greedy(points, &found, 1, tuning.plane * radius)
        .and_then(|mut planes| planes.pop())
        .ok_or(Rejection::NoRealSolution)
}

/// Rounds of fitting sheet and curve, the first of the sheet alone.
const ROUNDS: usize = 4;

/// The patch over a plane and the curve of the points off it, fitted in turn.
fn sheet_and_curve(
    points: &[Vector3<f64>],
    plane: &Flat<3>,
    conditions: &Conditions,
    radius: f64,
) -> Result<(QuadraticPatch, QuadraticCurve), Rejection> {
    let (ep, tuning) = (conditions.tolerance.ep, &conditions.tuning);
    let mut sheet = patch_over(plane);
    let mut curve: Option<QuadraticCurve> = None;
    for round in 0..ROUNDS {
        // The first plane may be tilted by points of the curve: its sheet is taken thicker.
        let thickness = if round == 0 {
            ep.max(tuning.plane * radius)
        } else {
            ep
        };
        // Points of the curve that are near the sheet would bend it.
        let near: Vec<Vector3<f64>> = points
            .iter()
            .filter(|x| {
                let clear = |c: &QuadraticCurve| (c.foot(x) - **x).norm() > tuning.clear * ep;
                sheet.signed_distance(x).abs() < thickness && curve.as_ref().is_none_or(clear)
            })
            .copied()
            .collect();
        // Over the plane of its own points: heights are then small, and exact where the sheet is flat.
        if let Some(plane) = Flat::of(near.iter().copied()) {
            sheet = patch_over(&plane);
        }
        if !sheet.fit(near.iter().copied(), radius) {
            return Err(Rejection::EmptyStratum {
                stratum: 3,
                found: near.len(),
            });
        }
        if round == 0 {
            continue;
        }
        let beside = off_sheet(&sheet, points, ep);
        curve = Some(QuadraticCurve::fit(&beside).ok_or(Rejection::EmptyStratum {
            stratum: 1,
            found: beside.len(),
        })?);
    }
    Ok((sheet, curve.ok_or(Rejection::NoRealSolution)?))
}

/// Where a curve meets a sheet, by Newton's method from the place of the curve nearest to the center.
fn meeting(
    sheet: &QuadraticPatch,
    curve: &QuadraticCurve,
    center: &Vector3<f64>,
    tuning: &CurveAndSheetTuning,
    radius: f64,
) -> Option<Vector3<f64>> {
    let mut t = curve.parameter(center);
    let mut height = f64::INFINITY;
    for _ in 0..12 {
        let x = curve.at(t);
        let (value, gradient) = sheet.height(&x);
        t -= value / gradient.dot(&curve.tangent(t));
        height = value.abs();
        if !t.is_finite() || t.abs() > 4.0 * radius {
            return None;
        }
    }
    let apex = curve.at(t);
    let far = height > 1e-6 * radius || (apex - center).norm() > tuning.reach * radius;
    (!far).then_some(apex)
}

impl Fit {
    /// The fit of a neighborhood.
    pub fn new(local: &LocalPoints<'_>, conditions: &Conditions) -> Result<Self, Rejection> {
        let Conditions { tolerance, tuning } = conditions;
        at_least(PATCH_POINTS + STRAIGHT_POINTS, local)?;
        let (count, ep) = (local.fitted, tolerance.ep);
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        if one_sheet_holds(points, local.radius, ep) {
            return Err(Rejection::SimplerModelFits {
                residual: ep,
                simpler: ep,
            });
        }
        let whole = Flat::of(points.iter().copied()).ok_or(Rejection::NoRealSolution)?;
        let plane = first_plane(points, whole, tuning, local.radius)?;
        let (sheet, curve) = sheet_and_curve(points, &plane, conditions, local.radius)?;
        let beside = off_sheet(&sheet, points, ep);
        // The center need not be among the points that were fitted.
        let center = all[local.center];
        let astray = off_sheet(&sheet, &[center], ep)
            .iter()
            .chain(&beside)
            .map(|x| (curve.foot(x) - x).norm())
            .fold(0.0, f64::max);
        if astray >= ep {
            return Err(Rejection::PoorFit {
                residual: astray,
                limit: ep,
            });
        }
        let apex = meeting(&sheet, &curve, &center, tuning, local.radius)
            .ok_or(Rejection::NoRealSolution)?;
        let mut fit = Self {
            curve,
            apex,
            residual: 0.0,
            labels: Vec::with_capacity(all.len()),
            arcs: [0; 2],
        };
        let sum = fit.label(&sheet, &all, local, ep);
        fit.residual = tolerance.residual(sum, count)?;
        Ok(fit)
    }

    /// Labels all points, counts those of the arcs, and gives the sum of the squared distances of the fitted ones.
    fn label(
        &mut self,
        sheet: &QuadraticPatch,
        all: &[Vector3<f64>],
        local: &LocalPoints<'_>,
        ep: f64,
    ) -> f64 {
        let center = all[local.center];
        let mut sum = 0.0;
        for (k, x) in all.iter().enumerate() {
            let to_sheet = sheet.signed_distance(x);
            let to_curve = (self.curve.foot(x) - x).norm();
            let label = if to_sheet.abs() < ep && to_curve < ep {
                0
            } else if to_sheet.abs() <= to_curve {
                3
            } else {
                1 + u8::from(to_sheet > 0.0)
            };
            self.labels.push(label);
            if k < local.fitted {
                sum += to_sheet.abs().min(to_curve).powi(2);
            }
            // Of the few points of a curve the fitted ones can leave out all of an arc.
            if matches!(label, 1 | 2) && (x - center).norm() < local.radius {
                self.arcs[usize::from(label) - 1] += 1;
            }
        }
        sum
    }

    /// What is said of the points, with `relabel` saying which stratum each of the four labels names.
    pub fn into_decomposition(
        self,
        local: &LocalPoints<'_>,
        arcs: u8,
        relabel: [u8; 4],
    ) -> Decomposition {
        let center = Vector3::from_column_slice(local.point(local.center));
        let place = match self.labels[local.center] {
            0 => Some(self.apex),
            1 | 2 => Some(self.curve.foot(&center)),
            _ => None,
        };
        Decomposition {
            strata: [0u8]
                .into_iter()
                .chain(std::iter::repeat_n(1, usize::from(arcs)))
                .chain([2])
                .map(|dimension| Stratum { dimension })
                .collect(),
            labels: self
                .labels
                .iter()
                .map(|&l| Label::from(relabel[usize::from(l)]))
                .collect(),
            cells_at_curve: vec![0; usize::from(arcs)],
            residual: self.residual,
            parameters: 17,
            points: vec![self.apex.iter().copied().collect()],
            center: place.unwrap_or(center).iter().copied().collect(),
            center_offset: place.map_or(f64::INFINITY, |p| (p - center).norm()),
        }
    }
}
