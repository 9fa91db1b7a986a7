//! Numbers that carry their two first derivatives, so that a parametrization is written once.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value with its derivatives by the two parameters of a surface (forward differentiation).
///
/// ```
/// use crosscap_algorithms::surfaces::Jet;
/// let (u, v) = (Jet::first(2.0), Jet::second(3.0));
/// let w = u * u * v;
/// assert_eq!((w.value, w.by_first, w.by_second), (12.0, 12.0, 4.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// Derivative by the first parameter.
    pub by_first: f64,
    /// Derivative by the second parameter.
    pub by_second: f64,
}

impl Jet {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            by_first: 0.0,
            by_second: 0.0,
        }
    }

    /// The first parameter, at `value`.
    pub fn first(value: f64) -> Self {
        Self {
            value,
            by_first: 1.0,
            by_second: 0.0,
        }
    }

    /// The second parameter, at `value`.
    pub fn second(value: f64) -> Self {
        Self {
            value,
            by_first: 0.0,
            by_second: 1.0,
        }
    }

    fn chain(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            by_first: slope * self.by_first,
            by_second: slope * self.by_second,
        }
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = libm::sincos(self.value);
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    /// Hyperbolic sine and cosine.
    pub fn sinh_cosh(self) -> (Self, Self) {
        let (sine, cosine) = (libm::sinh(self.value), libm::cosh(self.value));
        (self.chain(sine, cosine), self.chain(cosine, sine))
    }

    /// Cosine of the square root, hyperbolic cosine of that of the negative: one function, with no singularity at 0.
    pub fn cos_of_root(self) -> Self {
        let x = self.value;
        let root = x.abs().sqrt();
        let (value, sine) = match x >= 0.0 {
            true => (libm::cos(root), libm::sin(root)),
            false => (libm::cosh(root), libm::sinh(root)),
        };
        // Beside 0 the quotient is its series.
        let slope = match root > 1e-4 {
            true => -0.5 * sine / root,
            false => x / 12.0 - 0.5,
        };
        self.chain(value, slope)
    }

    /// Square root; the derivative at 0 is infinite.
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            by_first: self.by_first + other.by_first,
            by_second: self.by_second + other.by_second,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            by_first: self.by_first * other.value + self.value * other.by_first,
            by_second: self.by_second * other.value + self.value * other.by_second,
        }
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Self {
            value: quotient,
            by_first: (self.by_first - quotient * other.by_first) / other.value,
            by_second: (self.by_second - quotient * other.by_second) / other.value,
        }
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, shift: f64) -> Self {
        self.chain(self.value + shift, 1.0)
    }
}

impl Sub<f64> for Jet {
    type Output = Self;
    fn sub(self, shift: f64) -> Self {
        self + -shift
    }
}

/// Lengths and angle of the two tangent vectors: the coefficients E, F, G of the first
/// fundamental form at a place with the given jets.
pub fn first_fundamental_form(place: &[Jet]) -> [f64; 3] {
    place.iter().fold([0.0; 3], |[e, f, g], j| {
        [
            e + j.by_first * j.by_first,
            f + j.by_first * j.by_second,
            g + j.by_second * j.by_second,
        ]
    })
}

/// Area of the surface for each unit of parameter area, sqrt(EG - F^2).
pub fn area_element(place: &[Jet]) -> f64 {
    let [e, f, g] = first_fundamental_form(place);
    (e * g - f * f).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_agree_with_differences() {
        let f = |u: Jet, v: Jet| {
            let (s, c) = (u * v).sin_cos();
            let (sh, ch) = (u * v * 0.5).sinh_cosh();
            (s * s + c * 2.0 + sh * ch * ch + 3.0).sqrt() / (u * u + 1.0)
                - ((v * u).cos_of_root() + (v * -2.0).cos_of_root()) * 0.5
        };
        let (u, v, h) = (0.7, 1.3, 1e-6);
        let at = |u, v| f(Jet::constant(u), Jet::constant(v)).value;
        let jet = f(Jet::first(u), Jet::second(v));
        assert!((jet.by_first - (at(u + h, v) - at(u - h, v)) / (2.0 * h)).abs() < 1e-8);
        assert!((jet.by_second - (at(u, v + h) - at(u, v - h)) / (2.0 * h)).abs() < 1e-8);
    }
}
