//! Polynomials that vanish on the points: what unions of flat pieces are told apart by.

use nalgebra::{DMatrix, SVector, SymmetricEigen};

/// The polynomials of at most a given degree that vanish on points best, in the least-squares
/// sense of their values.
///
/// Points on k planes are zeros of a polynomial of degree k, the product of the planes'
/// equations, and its gradient at a point of one plane alone is normal to that plane
/// (generalized principal component analysis; Vidal, Ma, Sastry 2005). Nothing has to be factored.
pub(super) struct Vanishing<const D: usize> {
    exponents: Vec<[u8; D]>,
    /// One polynomial after the other.
    coefficients: Vec<f64>,
    scale: f64,
}

/// Highest degree.
const MOST_DEGREE: usize = 3;

impl<const D: usize> Vanishing<D> {
    /// The `count` best polynomials of degree at most `degree`, which is at most 3; `scale` is a length typical of the
    /// points (conditioning only). `None` for fewer points than monomials.
    ///
    /// O(k m^2 + m^3) for k points and m monomials.
    pub(super) fn fit(
        points: &[SVector<f64, D>],
        degree: u8,
        count: usize,
        scale: f64,
    ) -> Option<Self> {
        let exponents = monomials::<D>(degree);
        let m = exponents.len();
        if points.len() < m || count > m {
            return None;
        }
        let mut normal = DMatrix::<f64>::zeros(m, m);
        let mut row = vec![0.0; m];
        for x in points {
            let powers = powers(x, scale);
            for (value, exponent) in row.iter_mut().zip(&exponents) {
                *value = product(&powers, exponent);
            }
            for a in 0..m {
                for b in 0..=a {
                    normal[(a, b)] += row[a] * row[b];
                }
            }
        }
        for a in 0..m {
            for b in 0..a {
                normal[(b, a)] = normal[(a, b)];
            }
        }
        let eigen = SymmetricEigen::new(normal);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let coefficients = order[..count]
            .iter()
            .flat_map(|&k| {
                eigen
                    .eigenvectors
                    .column(k)
                    .iter()
                    .copied()
                    .collect::<Vec<_>>()
            })
            .collect();
        Some(Self {
            exponents,
            coefficients,
            scale,
        })
    }

    /// Gradients of the polynomials at `x`, in their order, per unit of the scale.
    pub(super) fn gradients(&self, x: &SVector<f64, D>, out: &mut Vec<SVector<f64, D>>) {
        out.clear();
        let powers = powers(x, self.scale);
        for polynomial in self.coefficients.chunks_exact(self.exponents.len()) {
            let mut gradient = SVector::<f64, D>::zeros();
            for (c, exponent) in polynomial.iter().zip(&self.exponents) {
                for axis in 0..D {
                    if exponent[axis] > 0 {
                        let mut lower = *exponent;
                        lower[axis] -= 1;
                        gradient[axis] += c * f64::from(exponent[axis]) * product(&powers, &lower);
                    }
                }
            }
            out.push(gradient);
        }
    }
}

/// Powers 0 to 3 of every coordinate, in units of `scale`: all that monomials of degree 3 need.
fn powers<const D: usize>(x: &SVector<f64, D>, scale: f64) -> [[f64; MOST_DEGREE + 1]; D] {
    std::array::from_fn(|axis| {
        let x = x[axis] / scale;
        [1.0, x, x * x, x * (x * x)]
    })
}

fn product<const D: usize>(powers: &[[f64; MOST_DEGREE + 1]; D], exponent: &[u8; D]) -> f64 {
    let factors = powers.iter().zip(exponent);
    factors.map(|(p, &e)| p[usize::from(e)]).product()
}

/// Exponents of all monomials of at most the given degree.
fn monomials<const D: usize>(degree: u8) -> Vec<[u8; D]> {
    let mut out = vec![[0; D]];
    for axis in 0..D {
        let mut more = Vec::new();
        for exponent in &out {
            let used: u8 = exponent.iter().sum();
            for power in 1..=degree - used {
                let mut next = *exponent;
                next[axis] = power;
                more.push(next);
            }
        }
        out.extend(more);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector3, Vector4};

    #[test]
    fn counts_monomials() {
        assert_eq!(monomials::<3>(3).len(), 20);
        assert_eq!(monomials::<4>(2).len(), 15);
        assert_eq!(monomials::<3>(1).len(), 4);
    }

    #[test]
    fn gradients_are_normals() {
        let grid = || (0..9).flat_map(|a| (0..9).map(move |b| [a as f64 - 3.5, b as f64 - 4.2]));
        let mut points = Vec::new();
        for [a, b] in grid() {
            points.extend([
                Vector3::new(a, b, 0.0),
                Vector3::new(a, 0.3, b),
                Vector3::new(0.2 * a + 1.0, a, b),
            ]);
        }
        let cubic = Vanishing::fit(&points, 3, 1, 4.0).unwrap();
        let mut out = Vec::new();
        cubic.gradients(&Vector3::new(2.3, -1.9, 0.0), &mut out);
        assert!(out[0].normalize().z.abs() > 1.0 - 1e-9);
        cubic.gradients(&Vector3::new(-2.0, 0.3, 3.0), &mut out);
        assert!(out[0].normalize().y.abs() > 1.0 - 1e-9);
    }

    #[test]
    fn four_quadrics_vanish_on_two_planes_of_four_dimensions() {
        let mut points = Vec::new();
        for a in 0..7 {
            for b in 0..7 {
                let (a, b) = (f64::from(a) - 2.6, f64::from(b) - 3.3);
                points.extend([Vector4::new(a, b, 0.0, 0.0), Vector4::new(0.1, 0.2, a, b)]);
            }
        }
        let quadrics = Vanishing::fit(&points, 2, 4, 3.0).unwrap();
        let mut out = Vec::new();
        quadrics.gradients(&Vector4::new(2.0, 1.0, 0.0, 0.0), &mut out);
        assert!(out.iter().all(|g| g.x.abs() < 1e-9 && g.y.abs() < 1e-9));
        assert!(out.iter().any(|g| g.norm() > 0.1));
    }

    #[test]
    fn too_few_points_say_nothing() {
        assert!(Vanishing::fit(&[Vector3::new(1.0, 2.0, 3.0); 19], 3, 1, 1.0).is_none());
    }
}
