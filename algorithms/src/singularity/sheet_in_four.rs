//! A sheet of R^4 as two quadratic height fields over its tangent plane.

use super::flats::Flat;
use super::patch::PATCH_POINTS;
use nalgebra::{Matrix2x4, Matrix4x2, SMatrix, SVector, Vector2, Vector4};

/// The surface `h = q(a, b)` of R^4, q two polynomials of degree 2.
#[derive(Clone, Debug)]
pub(super) struct SheetInFour {
    origin: Vector4<f64>,
    tangents: [Vector4<f64>; 2],
    normals: [Vector4<f64>; 2],
    /// For each normal the coefficients of 1, a, b, a^2, a b, b^2.
    coefficients: SMatrix<f64, 6, 2>,
}

impl SheetInFour {
    /// The plane itself.
    pub(super) fn plane(flat: &Flat<4>) -> Self {
        let normals = [flat.normals[0], flat.normals[1]];
        // The coordinate axes least in the normal space, made orthonormal to it.
        let mut order = [0, 1, 2, 3];
        let inside = |k: usize| normals.iter().map(|n| n[k] * n[k]).sum::<f64>();
        order.sort_by(|&a, &b| inside(a).total_cmp(&inside(b)));
        let mut found: Vec<Vector4<f64>> = normals.to_vec();
        for k in order {
            let mut axis = Vector4::ith(k, 1.0);
            for other in &found {
                axis -= other * other.dot(&axis);
            }
            if found.len() < 4 && axis.norm() > 0.1 {
                found.push(axis.normalize());
            }
        }
        found.resize(4, Vector4::zeros());
        Self {
            origin: flat.origin,
            tangents: [found[2], found[3]],
            normals,
            coefficients: SMatrix::zeros(),
        }
    }

    fn row(a: f64, b: f64) -> SVector<f64, 6> {
        SVector::from([1.0, a, b, a * a, a * b, b * b])
    }

    /// Fits the heights by least squares; `scale` is a length typical of the points. Unchanged for
    /// too few points.
    pub(super) fn fit(&mut self, points: impl Iterator<Item = Vector4<f64>>, scale: f64) {
        let mut normal = SMatrix::<f64, 6, 6>::zeros();
        let mut right = SMatrix::<f64, 6, 2>::zeros();
        let mut count = 0;
        for x in points {
            let d = (x - self.origin) / scale;
            let row = Self::row(self.tangents[0].dot(&d), self.tangents[1].dot(&d));
            let heights = Vector2::new(self.normals[0].dot(&d), self.normals[1].dot(&d));
            normal += row * row.transpose();
            right += row * heights.transpose();
            count += 1;
        }
        if count < PATCH_POINTS {
            return;
        }
        let ridge = 1e-9 * normal.trace();
        for k in 0..6 {
            normal[(k, k)] += ridge;
        }
        if let Some(solved) = normal.cholesky().map(|c| c.solve(&right)) {
            let powers = [scale, 1.0, 1.0, 1.0 / scale, 1.0 / scale, 1.0 / scale];
            self.coefficients = SMatrix::from_fn(|r, c| solved[(r, c)] * powers[r]);
        }
    }

    /// Heights of `x` above the sheet, and their gradients as rows.
    pub(super) fn heights(&self, x: &Vector4<f64>) -> (Vector2<f64>, Matrix2x4<f64>) {
        let d = x - self.origin;
        let (a, b) = (self.tangents[0].dot(&d), self.tangents[1].dot(&d));
        let mut values = Vector2::zeros();
        let mut gradients = Matrix2x4::zeros();
        for k in 0..2 {
            let c = self.coefficients.column(k);
            values[k] = self.normals[k].dot(&d) - c.dot(&Self::row(a, b));
            let gradient = self.normals[k]
                - self.tangents[0] * (c[1] + 2.0 * c[3] * a + c[4] * b)
                - self.tangents[1] * (c[2] + c[4] * a + 2.0 * c[5] * b);
            gradients.set_row(k, &gradient.transpose());
        }
        (values, gradients)
    }

    /// Distance of `x` from the sheet, to first order.
    pub(super) fn distance(&self, x: &Vector4<f64>) -> f64 {
        let (values, gradients) = self.heights(x);
        let gram = gradients * gradients.transpose();
        let across: Matrix4x2<f64> = gradients.transpose();
        gram.try_inverse().map_or(values.norm(), |inverse| {
            (across * (inverse * values)).norm()
        })
    }
}
