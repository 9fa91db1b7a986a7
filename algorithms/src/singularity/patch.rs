//! A sheet as a quadratic height field.

use nalgebra::{SMatrix, SVector, Vector3};

/// The surface `h = q(a, b)` in space, q a polynomial of degree 2, with `a`, `b`, `h`
/// coordinates in an orthonormal frame at an origin.
///
/// Second order is what a plane lacks: over a ball of radius eps a plane is off by about
/// eps^2 / 4R for a surface of curvature radius R, a patch only by terms of third order.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadraticPatch {
    origin: Vector3<f64>,
    /// First tangent, second tangent, normal.
    frame: [Vector3<f64>; 3],
    /// Coefficients of 1, a, b, a^2, a b, b^2.
    coefficients: [f64; 6],
}

/// Which power a^i b^j the product of two of the first six is, 1, a, b, a^2, a b, b^2.
const PRODUCT: [[usize; 6]; 6] = [
    [0, 1, 2, 3, 4, 5],
    [1, 3, 4, 6, 7, 8],
    [2, 4, 5, 7, 8, 9],
    [3, 6, 7, 10, 11, 12],
    [4, 7, 8, 11, 12, 13],
    [5, 8, 9, 12, 13, 14],
];

/// Fewest points that a patch is fitted to: twice its coefficients.
pub(crate) const PATCH_POINTS: usize = 12;

impl QuadraticPatch {
    /// The plane through `origin` with the given orthonormal frame (two tangents, normal).
    pub fn plane(origin: Vector3<f64>, frame: [Vector3<f64>; 3]) -> Self {
        Self {
            origin,
            frame,
            coefficients: [0.0; 6],
        }
    }

    /// Fits the coefficients to points by least squares of heights, keeping origin and
    /// frame; `scale` is a length typical of the points (conditioning). `false` and
    /// unchanged when there are fewer than 12 points or they leave a coefficient open.
    pub fn fit(&mut self, points: impl Iterator<Item = Vector3<f64>>, scale: f64) -> bool {
        // Sums of a^i b^j up to degree 4, from which all normal equations are read.
        let mut sums = [0.0; 15];
        let mut heights = [0.0; 6];
        let mut count = 0;
        let inverse = 1.0 / scale;
        for x in points {
            let (a, b, h) = self.local(&x);
            let (a, b, h) = (a * inverse, b * inverse, h * inverse);
            let (aa, ab, bb) = (a * a, a * b, b * b);
            let powers = [
                1.0,
                a,
                b,
                aa,
                ab,
                bb,
                aa * a,
                aa * b,
                a * bb,
                bb * b,
                aa * aa,
                aa * ab,
                aa * bb,
                ab * bb,
                bb * bb,
            ];
            for (s, p) in sums.iter_mut().zip(&powers) {
                *s += p;
            }
            for (s, p) in heights.iter_mut().zip(&powers) {
                *s += h * p;
            }
            count += 1;
        }
        let mut normal = SMatrix::<f64, 6, 6>::from_fn(|i, j| sums[PRODUCT[i][j]]);
        let right = SVector::<f64, 6>::from(heights);
        if count < PATCH_POINTS {
            return false;
        }
        // A ridge far below the signal keeps directions without points flat.
        let ridge = 1e-9 * normal.trace();
        for k in 0..6 {
            normal[(k, k)] += ridge;
        }
        let Some(solution) = normal.cholesky().map(|c| c.solve(&right)) else {
            return false;
        };
        let s = scale;
        self.coefficients = [
            solution[0] * s,
            solution[1],
            solution[2],
            solution[3] / s,
            solution[4] / s,
            solution[5] / s,
        ];
        true
    }

    /// Coefficients of 1, a, b, a^2, a b, b^2.
    pub(super) fn coefficients(&self) -> [f64; 6] {
        self.coefficients
    }

    fn local(&self, x: &Vector3<f64>) -> (f64, f64, f64) {
        let d = x - self.origin;
        (
            self.frame[0].dot(&d),
            self.frame[1].dot(&d),
            self.frame[2].dot(&d),
        )
    }

    /// Height of `x` above the patch and its gradient.
    pub fn height(&self, x: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let (a, b, h) = self.local(x);
        let [c0, ca, cb, caa, cab, cbb] = self.coefficients;
        let value = h - (c0 + ca * a + cb * b + caa * a * a + cab * a * b + cbb * b * b);
        let gradient = self.frame[2]
            - self.frame[0] * (ca + 2.0 * caa * a + cab * b)
            - self.frame[1] * (cb + cab * a + 2.0 * cbb * b);
        (value, gradient)
    }

    /// Signed distance of `x` from the patch, to first order: height over slope.
    pub fn signed_distance(&self, x: &Vector3<f64>) -> f64 {
        let mut out = [0.0];
        self.signed_distances([&[x.x], &[x.y], &[x.z]], &mut out);
        out[0]
    }

    /// The signed distances of many points, given and written coordinate by coordinate.
    pub(crate) fn signed_distances(&self, places: [&[f64]; 3], out: &mut [f64]) {
        let [first, second, normal] = self.frame;
        let origin = self.frame.map(|axis| axis.dot(&self.origin));
        let [c0, ca, cb, caa, cab, cbb] = self.coefficients;
        let [xs, ys, zs] = places;
        for (((o, &x), &y), &z) in out.iter_mut().zip(xs).zip(ys).zip(zs) {
            let a = first.x * x + first.y * y + first.z * z - origin[0];
            let b = second.x * x + second.y * y + second.z * z - origin[1];
            let h = normal.x * x + normal.y * y + normal.z * z - origin[2];
            let value = h - (c0 + a * (ca + caa * a + cab * b) + b * (cb + cbb * b));
            // The frame is orthonormal, so the gradient is (-slopes, 1) in it.
            let along = ca + 2.0 * caa * a + cab * b;
            let across = cb + cab * a + 2.0 * cbb * b;
            *o = value / (1.0 + along * along + across * across).sqrt();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_a_paraboloid() {
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut patch = QuadraticPatch::plane(Vector3::new(0.1, 0.2, 0.0), frame);
        let at = |x: f64, y: f64| Vector3::new(x, y, 0.3 + x * y - 0.5 * x * x + 0.25 * y * y);
        let points = (0..49).map(|k| at(f64::from(k % 7) - 3.0, f64::from(k / 7) - 3.0));
        assert!(patch.fit(points, 3.0));
        assert!(patch.signed_distance(&at(0.4, -0.7)).abs() < 1e-7);
        assert!(patch.signed_distance(&(at(0.0, 0.0) + Vector3::z())) > 0.5);
    }

    #[test]
    fn too_few_points_leave_the_plane() {
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut patch = QuadraticPatch::plane(Vector3::zeros(), frame);
        assert!(!patch.fit((0..11).map(|_| Vector3::z()), 1.0));
        assert_eq!(patch.signed_distance(&Vector3::z()), 1.0);
    }
}
