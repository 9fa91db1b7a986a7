//! The boundary of a surface, found where nobody names it.

use super::envelope::Envelope;
use super::patch::{PATCH_POINTS, QuadraticPatch};
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::BoundaryTuning;
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Rejection, SingularityModel, Stratum,
};
use nalgebra::{Matrix2, Vector2, Vector3};
use std::f64::consts::PI;

/// A sheet that ends in a curve.
///
/// Near a boundary the center of a neighborhood is off its middle. The sheet is laid out in its
/// tangent plane, and the boundary is the lowest parabola that has all points on one side (a linear
/// program in three unknowns). It is believed when the part of the ball beyond it, at the density of the
/// points, would hold so many that their absence is no chance.
///
/// The curve runs through the outermost points, so it lies inside the true boundary by less than
/// the spacing of the points. A boundary with corners sharper than a parabola is rounded.
#[derive(Clone, Copy, Debug)]
pub struct Boundary {
    tolerance: Tolerance,
    tuning: BoundaryTuning,
}

/// Times that the parabola is fitted, each time upright over its own tangent.
const ROUNDS: usize = 3;
/// Strips that the area beyond the boundary is summed over.
const STRIPS: usize = 64;

impl Boundary {
    /// Model with fit tolerance `dp` (of the sheet) and curve tolerance `ep`, unit of the data: a
    /// point nearer than `ep` to the boundary is on it.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: BoundaryTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: BoundaryTuning) -> Self {
        Self { tuning, ..self }
    }
}

/// Coordinates in the tangent plane: along the boundary and outward from the center.
pub(super) struct Axes {
    pub(super) along: [f64; 2],
    pub(super) out: [f64; 2],
    origin: [f64; 2],
}

impl Axes {
    pub(super) fn new(origin: [f64; 2], out: [f64; 2]) -> Self {
        let length = out[0].hypot(out[1]);
        let out = [out[0] / length, out[1] / length];
        Self {
            along: [-out[1], out[0]],
            out,
            origin,
        }
    }

    pub(super) fn plane(&self, x: [f64; 2]) -> [f64; 2] {
        let d = [x[0] - self.origin[0], x[1] - self.origin[1]];
        [
            self.along[0] * d[0] + self.along[1] * d[1],
            self.out[0] * d[0] + self.out[1] * d[1],
        ]
    }

    pub(super) fn back(&self, [t, v]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.origin[k] + t * self.along[k] + v * self.out[k])
    }
}

/// Variance of the points within `radius` of the center in the narrowest direction of the tangent plane, as a
/// share of that in the widest: 0 for points on a line, 1 for an even spread.
///
/// A ball whose rim cuts another stratum can have a spread in two dimensions without a sheet at its
/// center; the ball half as wide shows it.
fn breadth(points: &[Vector3<f64>], center: &Vector3<f64>, radius: f64) -> f64 {
    let near = || {
        let inside = move |x: &&Vector3<f64>| (*x - center).norm() < radius;
        points.iter().filter(inside).map(|x| x.xy())
    };
    let count = near().count().max(1) as f64;
    let mean = near().sum::<Vector2<f64>>() / count;
    let spread: Matrix2<f64> = near().map(|x| (x - mean) * (x - mean).transpose()).sum();
    let variances = spread.symmetric_eigenvalues();
    // Where all points are in one place no direction is wider than another.
    if variances.max() > 0.0 {
        variances.min() / variances.max()
    } else {
        0.0
    }
}

/// Area of the disc of `radius` about the origin beyond the curve of the given height.
pub(super) fn area_beyond(height: impl Fn(f64) -> f64, radius: f64) -> f64 {
    let width = 2.0 * radius / STRIPS as f64;
    (0..STRIPS)
        .map(|k| {
            let t = -radius + (k as f64 + 0.5) * width;
            let half = (radius * radius - t * t).max(0.0).sqrt();
            (half - height(t).clamp(-half, half)) * width
        })
        .sum()
}

impl Boundary {
    /// The parabola that no point lies beyond, upright over the place of it nearest to the center, where enough points
    /// are missing behind it.
    fn rim(
        &self,
        points: &[Vector3<f64>],
        center: &Vector3<f64>,
        radius: f64,
    ) -> Result<(Axes, Envelope), Rejection> {
        let mut axes = Axes::new([center.x, center.y], [center.x, center.y]);
        let upright = |axes: &Axes| {
            let flat: Vec<[f64; 2]> = points.iter().map(|x| axes.plane([x.x, x.y])).collect();
            Envelope::above(&flat, radius).ok_or(Rejection::NoRealSolution)
        };
        let mut envelope = upright(&axes)?;
        for _ in 0..ROUNDS {
            let slope = envelope.slope(envelope.foot([0.0, 0.0]));
            let out = [0, 1].map(|k| axes.out[k] - slope * axes.along[k]);
            axes = Axes::new(axes.origin, out);
            envelope = upright(&axes)?;
        }
        if envelope.bend().abs() * radius > self.tuning.bend {
            return Err(Rejection::NoRealSolution);
        }
        let beyond = area_beyond(|t| envelope.at(t), radius);
        let inside = PI * radius * radius - beyond;
        let missing = points.len() as f64 * beyond / inside.max(f64::MIN_POSITIVE);
        if missing < self.tuning.missing {
            return Err(Rejection::EmptyStratum {
                stratum: 0,
                found: 0,
            });
        }
        Ok((axes, envelope))
    }

    /// The sheet through the points, with what it leaves; the center is on it.
    fn sheet(
        &self,
        points: &[Vector3<f64>],
        center: &Vector3<f64>,
        radius: f64,
    ) -> Result<(QuadraticPatch, f64), Rejection> {
        let mut sheet =
            QuadraticPatch::plane(Vector3::zeros(), [Vector3::x(), Vector3::y(), Vector3::z()]);
        if !sheet.fit(points.iter().copied(), radius) {
            return Err(Rejection::NoRealSolution);
        }
        let sum = points
            .iter()
            .map(|x| sheet.signed_distance(x).powi(2))
            .sum();
        let residual = self.tolerance.residual(sum, points.len())?;
        let off = sheet.signed_distance(center).abs();
        if off >= self.tolerance.ep {
            return Err(Rejection::PoorFit {
                residual: off,
                limit: self.tolerance.ep,
            });
        }
        Ok((sheet, residual))
    }
}

impl SingularityModel for Boundary {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        dimension == 2
    }

    fn finds_boundary(&self) -> bool {
        true
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        at_least(PATCH_POINTS, local)?;
        let count = local.fitted;
        let center = Vector3::from_column_slice(local.point(local.center));
        // The mean is the origin.
        if center.x.hypot(center.y) < self.tuning.shift * local.radius {
            return Err(Rejection::NoRealSolution);
        }
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        let breadth = breadth(points, &center, 0.5 * local.radius);
        if breadth < self.tuning.breadth {
            return Err(Rejection::EmptyStratum {
                stratum: 1,
                found: 0,
            });
        }
        let (axes, envelope) = self.rim(points, &center, local.radius)?;
        let (sheet, residual) = self.sheet(points, &center, local.radius)?;
        // Beyond the neighborhood the parabola is mere extrapolation.
        let labels: Vec<u8> = all
            .iter()
            .enumerate()
            .map(|(k, x)| {
                let place = axes.plane([x.x, x.y]);
                let outside = k >= count && place[0].abs() > local.radius;
                u8::from(outside || envelope.depth(place) >= self.tolerance.ep)
            })
            .collect();
        let foot = envelope.foot([0.0, 0.0]);
        let [x, y] = axes.back([foot, envelope.at(foot)]);
        let below = Vector3::new(x, y, 0.0);
        let place = Vector3::new(x, y, -sheet.height(&below).0);
        let offset = (place - center).norm();
        // In the band of the curve and on the sheet, the center is next to its place.
        if labels[local.center] == 0 && offset > self.tuning.step * self.tolerance.ep {
            return Err(Rejection::NoRealSolution);
        }
        let (moved, center_offset) =
            if labels[local.center] == 0 || offset < self.tuning.witness * self.tolerance.ep {
                (place, offset)
            } else {
                (center, f64::INFINITY)
            };
        Ok(Decomposition {
            strata: [1, 2].map(|dimension| Stratum { dimension }).to_vec(),
            labels: labels.into_iter().map(Label::from).collect(),
            cells_at_curve: vec![1],
            residual,
            parameters: 11,
            points: Vec::new(),
            center: moved.iter().copied().collect(),
            center_offset,
        })
    }

    fn name(&self) -> &str {
        "boundary"
    }
}

#[cfg(test)]
mod tests {
    use super::super::about_first;
    use super::*;

    fn decompose(points: &[[f64; 3]]) -> Result<Decomposition, Rejection> {
        let count = points.len() as f64;
        let mean = [0, 1, 2].map(|i| points.iter().map(|x| x[i]).sum::<f64>() / count);
        let coordinates: Vec<f64> = points
            .iter()
            .flat_map(|x| [0, 1, 2].map(|i| x[i] - mean[i]))
            .collect();
        Boundary::new(0.2, 0.1)
            .unwrap()
            .decompose(&about_first(&coordinates, 1.0))
    }

    fn spiral(count: usize, radius: f64) -> impl Iterator<Item = [f64; 2]> {
        (0..count).map(move |k| {
            let r = radius * ((k as f64 + 0.5) / count as f64).sqrt();
            let angle = 2.4 * k as f64;
            [r * angle.cos(), r * angle.sin()]
        })
    }

    #[test]
    fn half_a_disc_ends_at_its_center() {
        let mut points = vec![[0.0; 3]];
        points.extend(
            spiral(200, 1.0)
                .map(|[x, y]| [x, y, 0.0])
                .filter(|x| x[0] < 0.0),
        );
        let fit = decompose(&points).unwrap();
        assert_eq!(fit.dimension_of(0), 1);
        assert!(fit.center_offset < 0.1, "{}", fit.center_offset);
    }

    #[test]
    fn a_curve_over_a_sheet_is_no_boundary() {
        // The ball is wide, but about its center there is only the curve.
        for height in [0.9, 0.95, 0.98] {
            let cap = f64::sqrt(1.0 - height * height);
            let mut points = vec![[0.0; 3]];
            points.extend((0..24).map(|k| [f64::from(k) / 12.0 - 0.98, 0.0, 0.0]));
            points.extend(spiral(40, cap).map(|[x, y]| [height, x, y]));
            assert!(decompose(&points).is_err(), "{height}");
        }
    }
}
