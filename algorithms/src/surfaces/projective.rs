//! Three pictures of the real projective plane: embedded in R^6, Steiner's Roman surface,
//! Boy's surface.

use super::{Jet, Piece, Random, area_element};
use std::f64::consts::{FRAC_PI_2, TAU};

pub(super) fn on_sphere([polar, azimuth]: [Jet; 2]) -> [Jet; 3] {
    let ((sp, cp), (sa, ca)) = (polar.sin_cos(), azimuth.sin_cos());
    [sp * ca, sp * sa, cp]
}

/// Draws from a half sphere uniformly, and accepts by the element relative to the sphere's.
pub(super) fn propose_from_half_sphere<P: Piece>(
    piece: &P,
    random: &mut Random,
    place: &mut [Jet],
    relative_bound: f64,
) -> ([f64; 2], f64) {
    let height = 1.0 - random.uniform();
    let at = [libm::acos(height), random.between(0.0, TAU)];
    piece.map([Jet::first(at[0]), Jet::second(at[1])], place);
    let sphere = libm::sin(at[0]);
    // The pole itself, where azimuth has no effect, has no area: leave it out.
    let acceptance = if sphere > 0.0 {
        area_element(place) / (sphere * relative_bound)
    } else {
        0.0
    };
    (at, acceptance.min(1.0))
}

/// The projective plane in R^6, (xy, xz, yz, x^2, y^2, z^2) of the unit sphere (paper, section 4).
/// Parameters: polar angle up to the equator, azimuth.
#[derive(Clone, Copy, Debug)]
pub struct ProjectivePlane;

impl Piece for ProjectivePlane {
    fn name(&self) -> &'static str {
        "projective plane"
    }
    fn ambient_dimension(&self) -> usize {
        6
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, FRAC_PI_2], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, at: [Jet; 2], place: &mut [Jet]) {
        let [x, y, z] = on_sphere(at);
        place.copy_from_slice(&[x * y, x * z, y * z, x * x, y * y, z * z]);
    }
    fn area_element_bound(&self) -> f64 {
        // The map p -> p p^T stretches lengths by sqrt(2); leaving out half of the mixed
        // products only shortens.
        2.0
    }
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        propose_from_half_sphere(self, random, place, 2.0)
    }
}

/// Steiner's Roman surface, (yz, xz, xy) of the unit sphere: three double segments that meet in a
/// triple point and end in six pinch points, where the map is no immersion.
/// Parameters: polar angle up to the equator, azimuth.
#[derive(Clone, Copy, Debug)]
pub struct RomanSurface;

impl Piece for RomanSurface {
    fn name(&self) -> &'static str {
        "roman surface"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, FRAC_PI_2], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, at: [Jet; 2], place: &mut [Jet]) {
        let [x, y, z] = on_sphere(at);
        place.copy_from_slice(&[y * z, x * z, x * y]);
    }
    fn area_element_bound(&self) -> f64 {
        // p -> p p^T stretches by sqrt(2), and carries each mixed product twice.
        1.0
    }
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        propose_from_half_sphere(self, random, place, 1.0)
    }
}

/// Boy's surface in the form of Bryant and Kusner: immersed, one double curve that passes three
/// times through one triple point (the origin). Parameters: modulus and argument of the
/// complex parameter in the unit disc, whose rim is glued by the antipodal map.
///
/// Source: R. Kusner, Conformal geometry and complete minimal surfaces, Bull. AMS 17 (1987).
#[derive(Clone, Copy, Debug)]
pub struct BoySurface;

#[derive(Clone, Copy)]
struct Complex(Jet, Jet);

impl Complex {
    fn times(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
    fn conjugate(self) -> Self {
        Self(self.0, -self.1)
    }
    fn squared_modulus(self) -> Jet {
        self.0 * self.0 + self.1 * self.1
    }
}

impl Piece for BoySurface {
    fn name(&self) -> &'static str {
        "boy surface"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, [modulus, argument]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = argument.sin_cos();
        let z = Complex(modulus * c, modulus * s);
        let z2 = z.times(z);
        let z3 = z2.times(z);
        let z5 = z3.times(z2);
        let z6 = z3.times(z3);
        let root = 5f64.sqrt();
        let divisor = Complex(z6.0 + z3.0 * root - 1.0, z6.1 + z3.1 * root);
        // The minimal surface (g1, g2, g3) = N / divisor has poles inside the disc; times |divisor|^2
        // it has none, and its inversion is the quotient below, with the poles at the origin.
        let under = divisor.conjugate();
        let g1 = Complex(z.0 - z5.0, z.1 - z5.1).times(under).1 * -1.5;
        let g2 = Complex(z.0 + z5.0, z.1 + z5.1).times(under).0 * -1.5;
        let square = divisor.squared_modulus();
        let g3 = Complex(z6.0 + 1.0, z6.1).times(under).1 - square * 0.5;
        let factor = square / (g1 * g1 + g2 * g2 + g3 * g3);
        place.copy_from_slice(&[g1 * factor, g2 * factor, g3 * factor]);
    }
    fn area_element_bound(&self) -> f64 {
        // Not derived: 1.15 times the largest value on a grid of 2048 x 512 (see the test).
        BOY_BOUND
    }
}

/// Bound of the area element of Boy's surface over modulus and argument.
const BOY_BOUND: f64 = 33.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::piece::place_at;

    #[test]
    fn area_element_of_boys_surface_stays_below_its_bound() {
        let mut place = [Jet::default(); 3];
        let mut largest = 0.0f64;
        for i in 1..=2048 {
            for j in 0..512 {
                let at = [f64::from(i) / 2048.0, TAU * f64::from(j) / 512.0];
                BoySurface.map([Jet::first(at[0]), Jet::second(at[1])], &mut place);
                largest = largest.max(area_element(&place));
            }
        }
        assert!(
            largest * 1.1 < BOY_BOUND && largest * 1.2 > BOY_BOUND,
            "{largest}"
        );
    }

    #[test]
    fn rims_are_glued_by_the_antipodal_map() {
        for t in [0.3, 1.7, 4.0] {
            let pairs: [(&dyn Piece, [f64; 2], [f64; 2]); 3] = [
                (&BoySurface, [1.0, t], [1.0, t + TAU / 2.0]),
                (&ProjectivePlane, [FRAC_PI_2, t], [FRAC_PI_2, t + TAU / 2.0]),
                (&RomanSurface, [FRAC_PI_2, t], [FRAC_PI_2, t + TAU / 2.0]),
            ];
            for (piece, a, b) in pairs {
                for (x, y) in place_at(piece, a).iter().zip(place_at(piece, b)) {
                    assert!((x - y).abs() < 1e-12, "{}", piece.name());
                }
            }
        }
    }

    #[test]
    fn boys_surface_passes_three_times_through_the_origin() {
        // z^6 + sqrt(5) z^3 - 1 = 0 inside the disc: z^3 = (3 - sqrt 5) / 2.
        let modulus = (0.5 * (3.0 - 5f64.sqrt())).cbrt();
        for k in 0..3 {
            let at = [modulus * (1.0 + 1e-9), f64::from(k) * TAU / 3.0];
            assert!(place_at(&BoySurface, at).iter().all(|x| x.abs() < 1e-7));
        }
        let away = [modulus, TAU / 6.0];
        assert!(place_at(&BoySurface, away).iter().any(|x| x.abs() > 0.1));
    }
}
