//! The quadric cone through points of space.

use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// The cone of a quadric: all points x for which `(x - apex)` lies on a quadratic form of two signs.
pub(super) struct QuadricCone {
    pub(super) apex: Vector3<f64>,
    form: Matrix3<f64>,
    /// Unit vector along the axis: the direction whose sign is alone.
    axis: Vector3<f64>,
    /// How far the quadric itself is from being a cone, unit of the points: half the width of the neck, or of the gap, where
    /// a hyperboloid has its center.
    pub(super) neck: f64,
}

/// Times that the quadric is fitted, each time with weights from the gradient of the last one.
const ROUNDS: usize = 3;
/// Least gradient that a weight is taken from, as a share of the mean: at the apex it vanishes.
const LEAST_GRADIENT: f64 = 0.3;

type Terms = SVector<f64, 10>;

/// The powers of a place up to degree 2.
fn terms(x: &Vector3<f64>) -> Terms {
    let [x, y, z] = [x.x, x.y, x.z];
    Terms::from([
        x * x,
        y * y,
        z * z,
        2.0 * x * y,
        2.0 * x * z,
        2.0 * y * z,
        2.0 * x,
        2.0 * y,
        2.0 * z,
        1.0,
    ])
}

/// A quadric `x F x + 2 b x + c`.
struct Quadric {
    form: Matrix3<f64>,
    linear: Vector3<f64>,
    constant: f64,
}

impl Quadric {
    /// That of the least sum of squared values, each with its weight, over coefficients of norm 1.
    fn fit(points: &[Vector3<f64>], weights: &[f64]) -> Self {
        let mut normal = SMatrix::<f64, 10, 10>::zeros();
        for (x, w) in points.iter().zip(weights) {
            let row = terms(x) * *w;
            normal.syger(1.0, &row, &row, 1.0);
        }
        normal.fill_upper_triangle_with_lower_triangle();
        let eigen = SymmetricEigen::new(normal);
        let a = eigen.eigenvectors.column(eigen.eigenvalues.imin());
        Self {
            form: Matrix3::new(a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2]),
            linear: Vector3::new(a[6], a[7], a[8]),
            constant: a[9],
        }
    }

    fn gradient(&self, x: &Vector3<f64>) -> f64 {
        2.0 * (self.form * x + self.linear).norm()
    }

    /// The cone about its center, where its form has two signs and no eigenvalue below `sharpness` of the greatest.
    fn cone(&self, sharpness: f64) -> Option<QuadricCone> {
        let eigen = SymmetricEigen::new(self.form);
        let values = eigen.eigenvalues;
        let size = values.amax();
        if values.iter().any(|v| v.abs() < sharpness * size) {
            return None;
        }
        let positive = values.iter().filter(|&&v| v > 0.0).count();
        let alone = |v: f64| match positive {
            1 => v > 0.0,
            2 => v < 0.0,
            _ => false,
        };
        let at = (0..3).find(|&k| alone(values[k]))?;
        let apex = -(self.form.try_inverse()? * self.linear);
        let left = self.constant + self.linear.dot(&apex);
        let mean = values.product().abs().cbrt();
        Some(QuadricCone {
            apex,
            form: self.form,
            axis: eigen.eigenvectors.column(at).into(),
            neck: (left.abs() / mean).sqrt(),
        })
    }
}

impl QuadricCone {
    /// The quadric of least distances from the points, to first order, if it is about a cone; `radius` is a length typical of
    /// the points.
    ///
    /// Distances are values over gradients (Taubin 1991): the gradients are those of the round before, so that each round is one
    /// eigenvector. No eigenvalue of the form is below `sharpness` of the greatest, or the cone is a pair of planes or a
    /// cylinder. O(k) for k points.
    pub(super) fn fit(points: &[Vector3<f64>], radius: f64, sharpness: f64) -> Option<Self> {
        let scaled: Vec<Vector3<f64>> = points.iter().map(|x| x / radius).collect();
        let mut weights = vec![1.0; scaled.len()];
        let mut quadric = Quadric::fit(&scaled, &weights);
        for _ in 1..ROUNDS {
            // What is no cone at all is none with other weights.
            quadric.cone(sharpness / 2.0)?;
            let gradients: Vec<f64> = scaled.iter().map(|x| quadric.gradient(x)).collect();
            let mean = gradients.iter().sum::<f64>() / gradients.len() as f64;
            for (w, g) in weights.iter_mut().zip(gradients) {
                *w = 1.0 / g.max(LEAST_GRADIENT * mean).max(f64::MIN_POSITIVE);
            }
            quadric = Quadric::fit(&scaled, &weights);
        }
        let cone = quadric.cone(sharpness)?;
        Some(Self {
            apex: cone.apex * radius,
            neck: cone.neck * radius,
            ..cone
        })
    }

    /// Distance of a place from the cone, to first order; next to the apex the apex is nearest.
    pub(super) fn distance(&self, x: &Vector3<f64>) -> f64 {
        let y = x - self.apex;
        let along = self.form * y;
        let gradient = 2.0 * along.norm();
        match gradient > 0.0 {
            true => (y.dot(&along).abs() / gradient).min(y.norm()),
            false => 0.0,
        }
    }

    /// How far along the axis a place is, negative on the side of one half of the cone.
    pub(super) fn height(&self, x: &Vector3<f64>) -> f64 {
        self.axis.dot(&(x - self.apex))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Points of x^2 + y^2 - z^2 = c about `at`.
    fn hyperboloid(c: f64, at: Vector3<f64>) -> Vec<Vector3<f64>> {
        (0..240)
            .map(|k| {
                let (sin, cos) = (TAU * 0.618 * f64::from(k)).sin_cos();
                let z = f64::from(k % 24) / 12.0 - 0.96;
                let across = (z * z + c).max(0.0).sqrt();
                at + Vector3::new(across * cos, across * sin, z)
            })
            .collect()
    }

    #[test]
    fn a_cone_has_no_neck_and_a_hyperboloid_has() {
        let at = Vector3::new(0.1, -0.2, 0.3);
        for (c, neck) in [(0.0, 0.0), (0.04, 0.2)] {
            let found = QuadricCone::fit(&hyperboloid(c, at), 2.0, 0.05).unwrap();
            assert!((found.apex - at).norm() < 1e-6, "{}", found.apex);
            assert!((found.neck - neck).abs() < 1e-6, "{}", found.neck);
            assert!((found.height(&(at + Vector3::z())).abs() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn planes_and_spheres_are_no_cones() {
        let planes = hyperboloid(0.0, Vector3::zeros());
        let planes: Vec<_> = planes
            .iter()
            .map(|x| Vector3::new(x.x, x.z, x.z.signum() * x.x))
            .collect();
        assert!(QuadricCone::fit(&planes, 1.0, 0.05).is_none());
        let sphere = hyperboloid(0.5, Vector3::zeros());
        let sphere: Vec<_> = sphere.iter().map(|x| x.normalize()).collect();
        assert!(QuadricCone::fit(&sphere, 1.0, 0.05).is_none());
    }
}
