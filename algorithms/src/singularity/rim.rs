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
    /// The boundary of the sheet that holds `points`, within `radius` of the middle; `near` is a place on the curve, `way` its
    /// direction towards the boundary. A sheet on one side of the curve alone is on that of `half`.
    ///
    /// # Errors
    /// [`Rejection::EmptyStratum`] where the points go on beyond any such curve, [`Rejection::NoRealSolution`] where
    /// there is none.
    pub(super) fn of(
        patch: &QuadraticPatch,
        points: Vec<Vector3<f64>>,
        near: Vector3<f64>,
        way: Vector3<f64>,
        half: Option<Vector3<f64>>,
        radius: f64,
        tuning: &RimTuning,
    ) -> Result<Self, Rejection> {
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
        let side = half.map(|out| rim.along.dot(&out));
        let beyond = rim.area_beyond(radius, side);
        let whole = PI * radius * radius * if half.is_some() { 0.5 } else { 1.0 };
        let inside = (whole - beyond).max(f64::MIN_POSITIVE);
        if points.len() as f64 * beyond / inside < tuning.missing {
            return Err(Rejection::EmptyStratum {
                stratum: 0,
                found: 0,
            });
        }
        Ok(rim)
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
