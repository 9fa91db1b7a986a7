//! A curve that goes through a sheet, or ends on one.

use super::curve_fit::{QuadraticCurve, STRAIGHT_POINTS};
use super::flats::{Flat, candidates, greedy};
use super::patch::{PATCH_POINTS, QuadraticPatch};
use super::sheets::patch_over;
use super::tolerance::{Tolerance, at_least, vectors};
use super::vanishing::Vanishing;
use crate::tuning::CurveAndSheetTuning;
use crosscap_core::{
    Decomposition, Error, Label, Link, LinkKind, LocalPoints, Rejection, SingularityModel, Stratum,
};
use nalgebra::Vector3;
use std::cell::RefCell;

/// A curve that pierces a sheet: a point, two arcs without triangles, one cell.
///
/// Two quadrics vanish on a plane and a line, and at points of the plane their gradients are
/// normal to it; the plane that most points lie near becomes a quadratic patch, the points
/// off it a curve. The point is where the curve meets the patch, by Newton's method.
#[derive(Clone, Copy, Debug)]
pub struct CurveThroughSheet {
    conditions: Conditions,
}

/// A curve that ends on a sheet: a point, one arc without triangles, one cell.
///
/// Fitted like [`CurveThroughSheet`]; the arc is on one side of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct CurveOnSheet {
    conditions: Conditions,
}

impl CurveThroughSheet {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both curve and sheet is where they meet.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            conditions: Conditions::new(dp, ep)?,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(mut self, tuning: CurveAndSheetTuning) -> Self {
        self.conditions.tuning = tuning;
        self
    }
}

impl CurveOnSheet {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both curve and sheet is where they meet.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            conditions: Conditions::new(dp, ep)?,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(mut self, tuning: CurveAndSheetTuning) -> Self {
        self.conditions.tuning = tuning;
        self
    }
}

/// What a fit must satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Conditions {
    tolerance: Tolerance,
    tuning: CurveAndSheetTuning,
}

impl Conditions {
    fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: CurveAndSheetTuning::MEASURED,
        })
    }
}

/// Sheet and curve of a neighborhood.
#[derive(Clone)]
struct Fit {
    curve: QuadraticCurve,
    /// Where they meet.
    apex: Vector3<f64>,
    residual: f64,
    /// For each point 0 for the apex, 1 and 2 for the arcs below and above the sheet, 3 for the sheet.
    labels: Vec<u8>,
    /// Points off the sheet below and above.
    arcs: [usize; 2],
}

/// The points farther than `limit` from the sheet.
fn off_sheet(sheet: &QuadraticPatch, points: &[Vector3<f64>], limit: f64) -> Vec<Vector3<f64>> {
    points
        .iter()
        .filter(|x| sheet.signed_distance(x).abs() > limit)
        .copied()
        .collect()
}

/// A fit with all that it was made from.
struct Kept {
    coordinates: Vec<f64>,
    fitted: usize,
    center: usize,
    radius: f64,
    conditions: Option<Conditions>,
    /// None where it was handed out already.
    fit: Option<Result<Fit, Rejection>>,
}

impl Kept {
    const NOTHING: Self = Self {
        coordinates: Vec::new(),
        fitted: 0,
        center: 0,
        radius: 0.0,
        conditions: None,
        fit: None,
    };

    fn keep(
        &mut self,
        local: &LocalPoints<'_>,
        conditions: &Conditions,
        fit: Result<Fit, Rejection>,
    ) {
        self.coordinates.clear();
        self.coordinates.extend_from_slice(local.coordinates);
        (self.fitted, self.center) = (local.fitted, local.center);
        self.radius = local.radius;
        self.conditions = Some(*conditions);
        self.fit = Some(fit);
    }

    fn is_of(&self, local: &LocalPoints<'_>, conditions: &Conditions) -> bool {
        (self.fitted, self.center) == (local.fitted, local.center)
            && self.radius == local.radius
            && self.conditions.as_ref() == Some(conditions)
            && self.coordinates == local.coordinates
    }
}

thread_local! {
    /// The last fit of this thread. Whether the curve ends on the sheet is asked right after whether it goes
    /// through, about the same points, and the fit is the same; comparing the points takes a hundredth of
    /// the time of fitting.
    static LAST: RefCell<Kept> = const { RefCell::new(Kept::NOTHING) };
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
        let steepest = |x: &Vector3<f64>| sheet.height(x).1.norm() > tuning.steepest;
        if near.iter().any(steepest) {
            return Err(Rejection::NoRealSolution);
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
        let slope = gradient.dot(&curve.tangent(t));
        if slope.abs() < tuning.sine * gradient.norm() {
            return None;
        }
        t -= value / slope;
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
    fn of(local: &LocalPoints<'_>, conditions: &Conditions) -> Result<Self, Rejection> {
        LAST.with_borrow_mut(|last| {
            if last.is_of(local, conditions)
                && let Some(fit) = last.fit.take()
            {
                return fit;
            }
            let fit = Self::new(local, conditions);
            last.keep(local, conditions, fit.clone());
            fit
        })
    }

    fn new(local: &LocalPoints<'_>, conditions: &Conditions) -> Result<Self, Rejection> {
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
        let mut labels = vec![0u8; all.len()];
        let mut arcs = [0usize; 2];
        let mut sum = 0.0;
        for (k, (x, label)) in all.iter().zip(&mut labels).enumerate() {
            let to_sheet = sheet.signed_distance(x);
            let to_curve = (curve.foot(x) - x).norm();
            *label = if to_sheet.abs() < ep && to_curve < ep {
                0
            } else if to_sheet.abs() <= to_curve {
                3
            } else {
                1 + u8::from(to_sheet > 0.0)
            };
            if k < count {
                sum += to_sheet.abs().min(to_curve).powi(2);
            }
            // Of the few points of a curve the fitted ones can leave out all of an arc.
            if matches!(*label, 1 | 2) && (x - center).norm() < local.radius {
                arcs[usize::from(*label) - 1] += 1;
            }
        }
        let lengths = beside.iter().map(|x| curve.parameter(x));
        let span = lengths.clone().fold(f64::NEG_INFINITY, f64::max)
            - lengths.fold(f64::INFINITY, f64::min);
        if span < tuning.length * ep {
            return Err(Rejection::NoRealSolution);
        }
        Ok(Self {
            curve,
            apex,
            residual: tolerance.residual(sum, count)?,
            labels,
            arcs,
        })
    }

    fn into_decomposition(
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

impl SingularityModel for CurveThroughSheet {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        (1..=3).contains(&dimension)
    }

    fn looks_behind(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::CurveThroughSheet.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let fit = Fit::of(local, &self.conditions)?;
        if let Some(side) = (0..2).find(|&side| fit.arcs[side] < self.conditions.tuning.arc) {
            return Err(Rejection::EmptyStratum {
                stratum: 1 + side,
                found: fit.arcs[side],
            });
        }
        Ok(fit.into_decomposition(local, 2, [0, 1, 2, 3]))
    }

    fn name(&self) -> &str {
        "curve-through-sheet"
    }
}

impl SingularityModel for CurveOnSheet {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        (1..=3).contains(&dimension)
    }

    fn looks_behind(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::CurveOnSheet.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let fit = Fit::of(local, &self.conditions)?;
        if fit.arcs[0].max(fit.arcs[1]) < self.conditions.tuning.arc {
            return Err(Rejection::EmptyStratum {
                stratum: 1,
                found: fit.arcs[0].max(fit.arcs[1]),
            });
        }
        if fit.arcs[0].min(fit.arcs[1]) >= self.conditions.tuning.arc {
            return Err(Rejection::NoRealSolution);
        }
        Ok(fit.into_decomposition(local, 1, [0, 1, 1, 2]))
    }

    fn name(&self) -> &str {
        "curve-on-sheet"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.35;

    /// What a ball at `height` over a disc holds of it and of a segment across it, coordinates about the mean.
    /// The segment comes first, the center before all.
    fn ball(height: f64, segment: usize, disc: usize) -> Vec<f64> {
        let step = 2.0 * RADIUS / segment as f64;
        let cap = (RADIUS * RADIUS - height * height).max(0.0).sqrt();
        let mut points = vec![[height, 0.0, 0.0]];
        points.extend((0..segment).map(|k| [height - RADIUS + (k as f64 + 0.5) * step, 0.0, 0.0]));
        points.extend((0..disc).map(|k| {
            let r = cap * ((k as f64 + 0.5) / disc as f64).sqrt();
            let angle = 2.4 * k as f64;
            [0.0, r * angle.cos(), r * angle.sin()]
        }));
        let count = points.len() as f64;
        let mean: Vec<f64> = (0..3)
            .map(|i| points.iter().map(|x| x[i]).sum::<f64>() / count)
            .collect();
        points
            .iter()
            .flat_map(|x| [0, 1, 2].map(|i| x[i] - mean[i]))
            .collect()
    }

    fn local(coordinates: &[f64], fitted: usize) -> LocalPoints<'_> {
        LocalPoints {
            dimension: 3,
            coordinates,
            fitted,
            center: 0,
            middle: 0,
            radius: RADIUS,
        }
    }

    #[test]
    fn the_sheet_does_not_bend_to_the_curve() {
        let model = CurveOnSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
        for tenth in 1..9 {
            // Farther out the segment spreads more than the part of the disc.
            let height = 0.1 * f64::from(tenth) * RADIUS;
            let disc = (160.0 * (1.0 - (height / RADIUS).powi(2))) as usize;
            let mut points = ball(height, 36, disc);
            // Without the arc on the other side.
            let below = points
                .chunks(3)
                .skip(1)
                .take(36)
                .filter(|x| points[0] - x[0] > height)
                .count();
            points.drain(3..3 * (1 + below));
            let fit = model.decompose(&local(&points, points.len() / 3)).unwrap();
            assert!(
                fit.dimension_of(0) < 2,
                "height {height}: the center is in the sheet"
            );
            assert!(
                fit.center_offset < 1e-6 || fit.dimension_of(0) == 0,
                "{height}"
            );
            let apex = &fit.points[0];
            assert!(
                (apex[0] - points[0] + height).abs() < 1e-6,
                "{height}: {apex:?}"
            );
        }
    }

    #[test]
    fn an_arc_that_is_not_fitted_is_there() {
        let mut points = ball(0.0, 40, 160);
        // The arc above goes to the end.
        let above: Vec<f64> = points.drain(3 * 21..3 * 41).collect();
        points.extend(above);
        let fitted = points.len() / 3 - 20;
        let on = CurveOnSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
        let through = CurveThroughSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
        assert!(on.decompose(&local(&points, fitted)).is_err());
        assert!(through.decompose(&local(&points, fitted)).is_ok());
        assert!(on.decompose(&local(&points[..3 * fitted], fitted)).is_ok());
        assert!(
            through
                .decompose(&local(&points[..3 * fitted], fitted))
                .is_err()
        );
    }
}
