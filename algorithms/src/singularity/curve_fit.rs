//! A curve in space as two quadratic deviations from a line.

use nalgebra::{Matrix3, Vector3};

/// `x(t) = origin + t axis + offset + t slope + t^2 bend`, the last three across the axis.
#[derive(Clone, Debug)]
pub(super) struct QuadraticCurve {
    origin: Vector3<f64>,
    axis: Vector3<f64>,
    terms: [Vector3<f64>; 3],
}

/// Fewest points of a straight and of a bent curve.
pub(super) const STRAIGHT_POINTS: usize = 4;
const BENT_POINTS: usize = 9;

impl QuadraticCurve {
    /// Least squares over the principal axis of the points; straight for fewer than nine. `None` for
    /// fewer than four points, or when they have no direction.
    pub(super) fn fit(points: &[Vector3<f64>]) -> Option<Self> {
        if points.len() < STRAIGHT_POINTS {
            return None;
        }
        let origin = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let spread: Matrix3<f64> = points
            .iter()
            .map(|x| (x - origin) * (x - origin).transpose())
            .sum();
        let eigen = spread.symmetric_eigen();
        let top = eigen.eigenvalues.imax();
        let length = (eigen.eigenvalues[top] / points.len() as f64).sqrt();
        if length <= 0.0 || !length.is_finite() {
            return None;
        }
        let axis: Vector3<f64> = eigen.eigenvectors.column(top).into();
        let mut curve = Self {
            origin,
            axis,
            terms: [Vector3::zeros(); 3],
        };
        if points.len() >= BENT_POINTS {
            let mut normal = Matrix3::zeros();
            let mut right = [Vector3::<f64>::zeros(); 3];
            for x in points {
                let d = x - origin;
                let t = axis.dot(&d) / length;
                let across = d - axis * axis.dot(&d);
                let row = Vector3::new(1.0, t, t * t);
                normal += row * row.transpose();
                for k in 0..3 {
                    right[k] += across * row[k];
                }
            }
            let inverse = normal.try_inverse()?;
            for k in 0..3 {
                let scale = length.powi(k as i32);
                curve.terms[k] = (0..3)
                    .map(|j| right[j] * inverse[(k, j)])
                    .sum::<Vector3<f64>>()
                    / scale;
            }
        }
        Some(curve)
    }

    /// Parameter of the foot of `x`, to first order.
    pub(super) fn parameter(&self, x: &Vector3<f64>) -> f64 {
        self.axis.dot(&(x - self.origin))
    }

    pub(super) fn at(&self, t: f64) -> Vector3<f64> {
        self.origin + self.axis * t + self.terms[0] + self.terms[1] * t + self.terms[2] * (t * t)
    }

    pub(super) fn tangent(&self, t: f64) -> Vector3<f64> {
        self.axis + self.terms[1] + self.terms[2] * (2.0 * t)
    }

    /// The point of the curve next to `x`.
    pub(super) fn foot(&self, x: &Vector3<f64>) -> Vector3<f64> {
        let mut t = self.parameter(x);
        for _ in 0..3 {
            let along = self.tangent(t);
            t += along.dot(&(x - self.at(t))) / along.norm_squared();
        }
        self.at(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_a_parabola() {
        let at = |t: f64| Vector3::new(t, 0.3 * t * t, 0.1 - 0.2 * t * t);
        let points: Vec<_> = (0..21).map(|k| at(f64::from(k) / 10.0 - 1.0)).collect();
        let curve = QuadraticCurve::fit(&points).unwrap();
        for t in [-0.8, 0.05, 0.9] {
            assert!((curve.foot(&at(t)) - at(t)).norm() < 1e-9, "{t}");
        }
        assert!(QuadraticCurve::fit(&points[..3]).is_none());
        assert!(QuadraticCurve::fit(&[Vector3::x(); 6]).is_none());
    }
}
