//! Two planes that cross: the quadric that factors into them.

use crosscap_core::Rejection;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector4};

/// Two planes `n_k . x + c_k = 0` of space with unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePair {
    /// Unit normals.
    pub normals: [Vector3<f64>; 2],
    /// Offsets.
    pub offsets: [f64; 2],
}

impl PlanePair {
    /// Direct estimate (Martin & Watson 2011, section 2.2): the quadric of least algebraic
    /// residual, brought to rank 2, factored. `scale` is a length typical of the points
    /// (conditioning only).
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] when the two leading eigenvalues of its quadratic part have
    /// the same sign: two complex planes.
    pub fn direct(
        points: impl Iterator<Item = Vector3<f64>>,
        scale: f64,
    ) -> Result<Self, Rejection> {
        let sums = power_sums(points, 1.0 / scale);
        let normal = SMatrix::<f64, 10, 10>::from_fn(|p, q| {
            let ((u, e), (v, f)) = (ENTRIES[p], ENTRIES[q]);
            let exponents = [e[0] + f[0], e[1] + f[1], e[2] + f[2]];
            u * v * sums[position(exponents)]
        });
        let eigen = normal.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let a = eigen.eigenvectors.column(least);
        let quadratic = Matrix3::new(a[0], a[1], a[2], a[1], a[4], a[5], a[2], a[5], a[7]);
        let size = quadratic.norm();
        if size < 1e-12 {
            return Err(Rejection::NoRealSolution);
        }
        let linear = Vector3::new(a[3], a[6], a[8]) / size;
        Self::factored(quadratic / size, linear, scale).ok_or(Rejection::NoRealSolution)
    }

    /// The two planes of a quadric of rank 2 with this quadratic and this linear part, lengths in units of `scale`; `None` for
    /// complex planes.
    fn factored(quadratic: Matrix3<f64>, linear: Vector3<f64>, scale: f64) -> Option<Self> {
        let parts = quadratic.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| {
            parts.eigenvalues[j]
                .abs()
                .total_cmp(&parts.eigenvalues[i].abs())
        });
        let (mut l1, mut l2) = (parts.eigenvalues[order[0]], parts.eigenvalues[order[1]]);
        let mut p1: Vector3<f64> = parts.eigenvectors.column(order[0]).into();
        let mut p2: Vector3<f64> = parts.eigenvectors.column(order[1]).into();
        if l1 * l2 >= 0.0 {
            return None;
        }
        if l1 < 0.0 {
            std::mem::swap(&mut l1, &mut l2);
            std::mem::swap(&mut p1, &mut p2);
        }
        // Least squares of [l1 p1, l2 p2](r, s) = linear; p1, p2 are orthonormal.
        let (r, s) = (p1.dot(&linear) / l1, p2.dot(&linear) / l2);
        let (u, v) = (l1.sqrt(), (-l2).sqrt());
        let plane = |sign: f64| {
            let normal = p1 * u + p2 * (sign * v);
            let length = normal.norm();
            (normal / length, (r * u + sign * s * v) / length * scale)
        };
        let ((n1, c1), (n2, c2)) = (plane(1.0), plane(-1.0));
        Some(Self {
            normals: [n1, n2],
            offsets: [c1, c2],
        })
    }

    /// Refinement by the paper's equation (5): minimizes the sum of squares of the product of the two
    /// plane functions over pairs of planes (unit normals, real by construction), by
    /// Gauss-Newton with damping from this pair on. Returns the pair reached and its sum of squares.
    pub fn refined(
        self,
        points: impl Iterator<Item = Vector3<f64>> + Clone,
        rounds: usize,
    ) -> (Self, f64) {
        let cost = |pair: &Self| -> f64 {
            points
                .clone()
                .map(|x| (pair.distance(0, &x) * pair.distance(1, &x)).powi(2))
                .sum()
        };
        let mut best = self;
        let mut value = cost(&best);
        let mut damping = 1e-3;
        for _ in 0..rounds {
            let Some(next) = best.stepped(points.clone(), damping) else {
                break;
            };
            let reached = cost(&next);
            if reached < value {
                let done = reached > value * (1.0 - 1e-10);
                (best, value) = (next, reached);
                damping = (damping * 0.2).max(1e-12);
                if done {
                    break;
                }
            } else {
                damping *= 8.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        (best, value)
    }

    /// The pair after one damped Gauss-Newton step; `None` where there is none.
    fn stepped(&self, points: impl Iterator<Item = Vector3<f64>>, damping: f64) -> Option<Self> {
        let mut normal = SMatrix::<f64, 8, 8>::zeros();
        let mut right = SVector::<f64, 8>::zeros();
        for x in points {
            let (f, g) = (self.distance(0, &x), self.distance(1, &x));
            let row = [g * x.x, g * x.y, g * x.z, g, f * x.x, f * x.y, f * x.z, f];
            let row = SVector::<f64, 8>::from(row);
            normal.ger(1.0, &row, &row, 1.0);
            right.axpy(-f * g, &row, 1.0);
        }
        let lift = damping * normal.trace() / 8.0 + f64::MIN_POSITIVE;
        for k in 0..8 {
            normal[(k, k)] += lift;
        }
        let step = normal.cholesky().map(|c| c.solve(&right))?;
        let moved = |k: usize| {
            let own = &self.normals[k];
            let q =
                Vector4::new(own.x, own.y, own.z, self.offsets[k]) + step.fixed_rows::<4>(4 * k);
            let length = q.xyz().norm();
            (q.xyz() / length, q.w / length)
        };
        let ((n1, c1), (n2, c2)) = (moved(0), moved(1));
        Some(Self {
            normals: [n1, n2],
            offsets: [c1, c2],
        })
    }

    /// Signed distance of `x` from plane `k`.
    pub fn distance(&self, k: usize, x: &Vector3<f64>) -> f64 {
        self.normals[k].dot(x) + self.offsets[k]
    }

    /// Sine of the angle between the planes.
    pub fn sine(&self) -> f64 {
        self.normals[0].cross(&self.normals[1]).norm()
    }

    /// Unit direction of the line in which the planes meet and the point of it nearest to `x`;
    /// `None` for planes closer to parallel than about half a degree.
    pub fn line(&self, x: &Vector3<f64>) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let [n1, n2] = self.normals;
        let cosine = n1.dot(&n2);
        let square = 1.0 - cosine * cosine;
        if square < 1e-4 {
            return None;
        }
        let (f, g) = (self.distance(0, x), self.distance(1, x));
        let alpha = (f - cosine * g) / square;
        let beta = (g - cosine * f) / square;
        Some((n1.cross(&n2).normalize(), x - n1 * alpha - n2 * beta))
    }
}

/// Number of powers x^i y^j z^k up to degree 4.
const POWERS: usize = 35;

/// The entries of the paper's row of M: factor and exponents.
const ENTRIES: [(f64, [usize; 3]); 10] = [
    (1.0, [2, 0, 0]),
    (2.0, [1, 1, 0]),
    (2.0, [1, 0, 1]),
    (2.0, [1, 0, 0]),
    (1.0, [0, 2, 0]),
    (2.0, [0, 1, 1]),
    (2.0, [0, 1, 0]),
    (1.0, [0, 0, 2]),
    (2.0, [0, 0, 1]),
    (1.0, [0, 0, 0]),
];

/// Where x^i y^j z^k is among the powers: by degree, then by falling i, then by falling j.
const fn position([i, j, k]: [usize; 3]) -> usize {
    let degree = i + j + k;
    let before = degree * (degree + 1) * (degree + 2) / 6;
    let rest = j + k;
    before + rest * (rest + 1) / 2 + k
}

/// Sums of x^i y^j z^k up to degree 4, coordinates multiplied by `inverse`, from which the normal matrix is read.
fn power_sums(points: impl Iterator<Item = Vector3<f64>>, inverse: f64) -> [f64; POWERS] {
    let mut sums = [0.0; POWERS];
    for x in points {
        for (s, p) in sums.iter_mut().zip(&powers(&x, inverse)) {
            *s += p;
        }
    }
    sums
}

/// All x^i y^j z^k up to degree 4, in the order of [`position`].
#[rustfmt::skip]
fn powers(x: &Vector3<f64>, inverse: f64) -> [f64; POWERS] {
    let [x, y, z] = [x.x * inverse, x.y * inverse, x.z * inverse];
    let [xx, xy, xz, yy, yz, zz] = [x * x, x * y, x * z, y * y, y * z, z * z];
    [
        1.0,
        x, y, z,
        xx, xy, xz, yy, yz, zz,
        xx * x, xx * y, xx * z, xy * y, xy * z, xz * z, yy * y, yy * z, yz * z, zz * z,
        xx * xx, xx * xy, xx * xz, xx * yy, xx * yz, xx * zz, xy * yy, xy * yz, xy * zz, xz * zz,
        yy * yy, yy * yz, yy * zz, yz * zz, zz * zz,
    ]
}
