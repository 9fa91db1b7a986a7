//! The boundary of one of several sheets, towards which a curve runs.

use super::envelope::Envelope;
use super::patch::QuadraticPatch;
use crate::tuning::RimTuning;
use crosscap_core::Rejection;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Times that the parabola is fitted, each time upright over its own tangent.
const ROUNDS: usize = 3;
/// Steps towards the place in which the curve meets the parabola.
const STEPS: usize = 12;
/// Strips that the area beyond the boundary is summed over.
const STRIPS: usize = 64;

/// Share of an interval at which it is cut in a search by golden sections, and how often.
const GOLDEN: f64 = 0.381_966_011_250_105;
const SECTIONS: usize = 32;

/// A sheet that ends on a boundary.
pub(super) struct EndingSheet<'p> {
    pub(super) patch: &'p QuadraticPatch,
    pub(super) points: Vec<Vector3<f64>>,
    /// For a sheet on one side of the curve alone the direction into it.
    pub(super) half: Option<Vector3<f64>>,
}

/// A sheet with directions in its tangent plane: along the boundary, about, and out of it.
struct Laid<'s> {
    points: &'s [Vector3<f64>],
    along: Vector3<f64>,
    out: Vector3<f64>,
}

impl EndingSheet<'_> {
    fn laid(&self, near: Vector3<f64>, out: Vector3<f64>) -> Laid<'_> {
        let normal = self.patch.height(&near).1.normalize();
        let out = (out - normal * normal.dot(&out)).normalize();
        Laid {
            points: &self.points,
            along: normal.cross(&out),
            out,
        }
    }
}

impl Laid<'_> {
    /// The points in the plane, about a place.
    fn flat(&self, origin: Vector3<f64>) -> Vec<[f64; 2]> {
        let at = |x: &Vector3<f64>| [self.along.dot(&(x - origin)), self.out.dot(&(x - origin))];
        self.points.iter().map(at).collect()
    }
}

/// Where a convex function is least, between minus and plus `radius`; it is infinite up to some place.
fn lowest(height: impl Fn(f64) -> f64, radius: f64) -> f64 {
    let [mut low, mut high] = [-radius, radius];
    for _ in 0..SECTIONS {
        let step = GOLDEN * (high - low);
        let [first, second] = [low + step, high - step].map(&height);
        if first.is_infinite() || first > second {
            low += step;
        } else {
            high -= step;
        }
    }
    high
}

/// Where a sheet ends: the lowest parabola in a tangent plane that has all its points on one side.
pub(super) struct Rim {
    origin: Vector3<f64>,
    /// Unit vectors in the tangent plane: along the boundary, and out of the sheet.
    along: Vector3<f64>,
    out: Vector3<f64>,
    /// Direction in which the curve runs.
    way: Vector3<f64>,
    envelope: Envelope,
}

impl Rim {
    /// The boundary of a sheet, within `radius` of the middle; `near` is a place on the curve, `way` its direction towards the
    /// boundary.
    ///
    /// # Errors
    /// [`Rejection::EmptyStratum`] where the points go on beyond any such curve, [`Rejection::NoRealSolution`] where
    /// there is none.
    pub(super) fn of(
        sheet: &EndingSheet<'_>,
        near: Vector3<f64>,
        way: Vector3<f64>,
        radius: f64,
        tuning: &RimTuning,
    ) -> Result<Self, Rejection> {
        let EndingSheet { patch, points, .. } = sheet;
        let normal = patch.height(&near).1.normalize();
        let upright = |out: Vector3<f64>| {
            let along = normal.cross(&out);
            let flat: Vec<[f64; 2]> = (points.iter())
                .map(|x| [along.dot(&(x - near)), out.dot(&(x - near))])
                .collect();
            let envelope = Envelope::above(&flat, radius).ok_or(Rejection::NoRealSolution)?;
            Ok(Self {
                origin: near,
                along,
                out,
                way,
                envelope,
            })
        };
        let mut rim = upright(way)?;
        for _ in 0..ROUNDS {
            let slope = rim.envelope.slope(rim.envelope.foot([0.0, 0.0]));
            rim = upright((rim.out - rim.along * slope).normalize())?;
        }
        if rim.envelope.bend().abs() * radius > tuning.bend {
            return Err(Rejection::NoRealSolution);
        }
        rim.enough(sheet, radius, tuning)?;
        Ok(rim)
    }

    /// The boundaries of several sheets, which all meet the curve in one place, and that place; `near` is a place on the curve, `way`
    /// its direction towards the end.
    ///
    /// A sheet on one side of the curve does not hold a parabola of its own: nothing keeps it down beyond the curve. All sheets
    /// together do, for no point of any of them lies beyond the end. Of all places on the curve it is the one for which the parabolas through it
    /// have the least mean height over all points: a linear program with one unknown in common, convex in that one, over which
    /// it is searched by golden sections.
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] where there are no such parabolas, or a sheet has no point near the end where chance does not explain it;
    /// [`Rejection::EmptyStratum`] where points go on beyond one of them.
    pub(super) fn all_through(
        sheets: &[EndingSheet<'_>],
        near: Vector3<f64>,
        way: Vector3<f64>,
        radius: f64,
        least: f64,
        tuning: &RimTuning,
    ) -> Result<(Vector3<f64>, Vec<Self>), Rejection> {
        let slope = (1.0 / (least * least) - 1.0).sqrt();
        let bend = 0.5 * tuning.bend / radius;
        let laid: Vec<Laid> = sheets.iter().map(|sheet| sheet.laid(near, way)).collect();
        let height = |end: f64| -> f64 {
            let each = laid.iter().map(|sheet| {
                let flat = sheet.flat(near + way * end);
                let found = Envelope::through_origin(&flat, slope, bend);
                found.map_or(f64::INFINITY, |e| {
                    flat.iter().map(|p| end + e.at(p[0])).sum::<f64>()
                })
            });
            each.sum()
        };
        let end = near + way * lowest(height, radius);
        let mut rims = Vec::with_capacity(sheets.len());
        for (sheet, mut laid) in sheets.iter().zip(laid) {
            let mut envelope = None;
            for _ in 0..=ROUNDS {
                let flat = laid.flat(end);
                let found = Envelope::through_origin(&flat, slope, bend)
                    .ok_or(Rejection::NoRealSolution)?;
                let tangent = found.slope(0.0);
                let rim = Self {
                    origin: end,
                    along: laid.along,
                    out: laid.out,
                    way,
                    envelope: found,
                };
                envelope = Some(rim);
                laid = sheet.laid(end, (laid.out - laid.along * tangent).normalize());
            }
            let rim = envelope.ok_or(Rejection::NoRealSolution)?;
            // Each round turns the boundary: at last it may run along the curve.
            if rim.crossing(least).is_none() {
                return Err(Rejection::NoRealSolution);
            }
            let inside = rim.enough(sheet, radius, tuning)?;
            let nearest = (sheet.points.iter())
                .map(|x| (x - end).norm())
                .fold(f64::INFINITY, f64::min);
            let share = if sheet.half.is_some() { 0.25 } else { 0.5 };
            let about = share * PI * nearest * nearest;
            if sheet.points.len() as f64 * about / inside > tuning.open {
                return Err(Rejection::NoRealSolution);
            }
            rims.push(rim);
        }
        Ok((end, rims))
    }

    /// The area of the sheet inside, where points are missing beyond.
    fn enough(
        &self,
        sheet: &EndingSheet<'_>,
        radius: f64,
        tuning: &RimTuning,
    ) -> Result<f64, Rejection> {
        let side = sheet.half.map(|out| self.along.dot(&out));
        let beyond = self.area_beyond(radius, side);
        let whole = PI * radius * radius * if sheet.half.is_some() { 0.5 } else { 1.0 };
        let inside = (whole - beyond).max(f64::MIN_POSITIVE);
        match (sheet.points.len() as f64 * beyond / inside) < tuning.missing {
            true => Err(Rejection::EmptyStratum {
                stratum: 0,
                found: 0,
            }),
            false => Ok(inside),
        }
    }

    /// Area of the disc of `radius` about the place on the curve beyond the parabola, or of its half on the side of the
    /// given sign.
    fn area_beyond(&self, radius: f64, side: Option<f64>) -> f64 {
        let width = 2.0 * radius / STRIPS as f64;
        let strip = |k: usize| {
            let t = -radius + (k as f64 + 0.5) * width;
            let half = (radius * radius - t * t).max(0.0).sqrt();
            (half - self.envelope.at(t).clamp(-half, half)) * width
        };
        let counts =
            |k: &usize| side.is_none_or(|s| s * (*k as f64 + 0.5 - STRIPS as f64 / 2.0) > 0.0);
        (0..STRIPS).filter(counts).map(strip).sum()
    }

    fn flat(&self, x: &Vector3<f64>) -> [f64; 2] {
        let d = x - self.origin;
        [self.along.dot(&d), self.out.dot(&d)]
    }

    /// How far a point is inside, negative outside.
    pub(super) fn depth(&self, x: &Vector3<f64>) -> f64 {
        self.envelope.depth(self.flat(x))
    }

    /// The nearest place on the boundary, on the sheet.
    pub(super) fn place(&self, patch: &QuadraticPatch, x: &Vector3<f64>) -> Vector3<f64> {
        let foot = self.envelope.foot(self.flat(x));
        let flat = self.origin + self.along * foot + self.out * self.envelope.at(foot);
        let (height, gradient) = patch.height(&flat);
        flat - gradient * (height / gradient.norm_squared())
    }

    /// Where the curve, taken for straight, meets the boundary; `None` where it does not at an angle to
    /// the way out whose cosine is at least `least`.
    pub(super) fn crossing(&self, least: f64) -> Option<Vector3<f64>> {
        let [across, up] = [self.along.dot(&self.way), self.out.dot(&self.way)];
        let mut s = 0.0;
        for _ in 0..STEPS {
            let height = s * up - self.envelope.at(s * across);
            let slope = up - self.envelope.slope(s * across) * across;
            if slope < least {
                return None;
            }
            s -= height / slope;
        }
        s.is_finite().then(|| self.origin + self.way * s)
    }
}
