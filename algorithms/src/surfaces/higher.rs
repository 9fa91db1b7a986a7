//! Surfaces of four and five dimensions that cross themselves or each other.

use super::curves::curve;
use super::surface::SampleSurface;
use super::truth::{KLEIN, SPHERE, crossing, plain};
use super::{CurveKind, Jet, KleinFigureEight, Piece, PointKind, Truth};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Whitney's sphere in R^4, (x, y, x z, y z) / (1 + z^2) of the unit sphere: immersed, with both poles in the origin. Parameters: polar
/// angle, azimuth.
struct WhitneySphere;

impl Piece for WhitneySphere {
    fn name(&self) -> &'static str {
        "sphere"
    }
    fn ambient_dimension(&self) -> usize {
        4
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, PI], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, at: [Jet; 2], place: &mut [Jet]) {
        let [x, y, z] = super::projective::on_sphere(at);
        let under = z * z + 1.0;
        place.copy_from_slice(&[x / under, y / under, x * z / under, y * z / under]);
    }
    fn area_element_bound(&self) -> f64 {
        // The metric is that of the sphere over 1 + z^2.
        1.0 + 1e-12
    }
}

/// An ellipsoid of R^5 on the middle line of the Klein bottle of R^5: (3 cos t cos p, 3 sin t cos p, 0, sin t cos p, 1 + sin p). Parameters: latitude p, t.
struct Ellipsoid;

impl Piece for Ellipsoid {
    fn name(&self) -> &'static str {
        "sphere"
    }
    fn ambient_dimension(&self) -> usize {
        5
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, [latitude, around]: [Jet; 2], place: &mut [Jet]) {
        let ((sp, cp), (s, c)) = (latitude.sin_cos(), around.sin_cos());
        let zero = Jet::constant(0.0);
        place.copy_from_slice(&[c * cp * 3.0, s * cp * 3.0, zero, s * cp, sp + 1.0]);
    }
    fn area_element_bound(&self) -> f64 {
        // Half axes 3, sqrt(10) and 1: no area is larger than that of the two greatest.
        90f64.sqrt() * (1.0 + 1e-12)
    }
}

/// A sphere of R^4 whose poles are one point.
fn whitney_sphere() -> SampleSurface {
    SampleSurface::new(
        "whitney_sphere",
        "Whitney's sphere in R^4: immersed, it meets itself in one point",
        vec![Box::new(WhitneySphere)],
        Truth {
            isolated_crossings: 1,
            ..plain([1, 1, 1], &[SPHERE], 0)
        },
        8_000,
    )
    .at(PointKind::Isolated, [vec![0.0; 4]])
}

/// A Klein bottle of R^5 and a sphere on the circle in which its figures of 8 have their middles. Nothing else is in both: the last coordinate of
/// the Klein bottle is a cosine, and where it is that of the sphere the others differ.
fn sphere_klein_r5() -> SampleSurface {
    SampleSurface::new(
        "sphere_klein_r5",
        "a Klein bottle and a sphere in R^5 that cross in a circle, one-sided on the Klein bottle",
        vec![Box::new(KleinFigureEight::embedded()), Box::new(Ellipsoid)],
        Truth {
            betti_mod_2: [1, 1, 2],
            torsion: &[2],
            ..crossing([1, 0, 1], &[KLEIN, SPHERE], 1)
        },
        30_000,
    )
    .singular(|m| {
        vec![curve(CurveKind::Double, true, m, |t| {
            let (s, c) = libm::sincos(TAU * t);
            vec![3.0 * c, 3.0 * s, 0.0, s, 1.0]
        })]
    })
}

/// Both of them.
pub(super) fn higher_surfaces() -> Vec<SampleSurface> {
    vec![whitney_sphere(), sphere_klein_r5()]
}
