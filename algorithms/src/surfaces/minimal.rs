//! Parts of minimal surfaces that cross themselves.

use super::curves::curve;
use super::round::rim_at_first;
use super::surface::SampleSurface;
use super::truth::{ANNULUS, DISC, crossing};
use super::{CurveKind, Jet, Piece, PointKind, RimSegment, TrueCurve, Truth, place_at};
use std::f64::consts::TAU;

/// Enneper's surface (u - u^3 / 3 + u v^2, v - v^3 / 3 + v u^2, u^2 - v^2) over the disc of radius 2.2, where it crosses itself in two arcs.
/// Parameters: modulus and argument of u + i v.
#[derive(Clone, Copy, Debug)]
struct Enneper;

/// Radius of the disc. Up to the root of 3 nothing crosses.
const DISC_RADIUS: f64 = 2.2;

impl Enneper {
    /// The parameters of one of the two sheets that cross in an arc, `t` from 0 to 1 along it; those of the other one are their reflection.
    ///
    /// (u, v) and (-u, v) have one place where x vanishes off the axis, at u^2 = 3 + 3 v^2; the same with u and v exchanged.
    fn double_parameters(arc: usize, t: f64) -> [f64; 2] {
        let v = (2.0 * t - 1.0) * half_arc();
        let u = (3.0 + 3.0 * v * v).sqrt();
        let argument = match arc {
            0 => libm::atan2(v, u),
            _ => libm::atan2(u, v),
        };
        [libm::hypot(u, v), argument]
    }
}

/// Where the double arcs reach the rim: u^2 + v^2 = 3 + 4 v^2.
fn half_arc() -> f64 {
    ((DISC_RADIUS * DISC_RADIUS - 3.0) / 4.0).sqrt()
}

impl Piece for Enneper {
    fn name(&self) -> &'static str {
        "disc"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, DISC_RADIUS], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [modulus, argument]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = argument.sin_cos();
        let (u, v) = (modulus * c, modulus * s);
        let (uu, vv) = (u * u, v * v);
        place[0] = u - u * uu * (1.0 / 3.0) + u * vv;
        place[1] = v - v * vv * (1.0 / 3.0) + v * uu;
        place[2] = uu - vv;
    }
    fn area_element_bound(&self) -> f64 {
        // The metric is conformal with factor 1 + r^2.
        let factor = 1.0 + DISC_RADIUS * DISC_RADIUS;
        DISC_RADIUS * factor * factor * (1.0 + 1e-12)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rim_at_first(DISC_RADIUS, [0.0, TAU])]
    }
}

/// Catalan's surface (u - sin u cosh v, 1 - cos u cosh v, 4 sin(u / 2) sinh(v / 2)) on a ring about its branch point, around which it winds
/// twice and crosses itself in three arcs. Parameters: modulus and argument of u + i v.
#[derive(Clone, Copy, Debug)]
struct Catalan;

/// Range of the modulus.
const RING: [f64; 2] = [0.8, 1.8];

impl Catalan {
    /// The parameters of one of the two sheets that cross in an arc, `t` from 0 to 1 along it; those of the other one are opposite.
    ///
    /// (u, v) and (-u, -v) have one place where x vanishes: at u = 0, and where cosh v = u / sin u.
    fn double_parameters(arc: usize, t: f64) -> [f64; 2] {
        let modulus = RING[0] + t * (RING[1] - RING[0]);
        let height = |u: f64| libm::acosh((u / libm::sin(u)).max(1.0));
        let (mut low, mut high) = (0.1 * modulus, modulus);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match libm::hypot(middle, height(middle)) < modulus {
                true => low = middle,
                false => high = middle,
            }
        }
        let argument = libm::acos(low / modulus);
        match arc {
            0 => [modulus, 0.25 * TAU],
            1 => [modulus, argument],
            _ => [modulus, -argument],
        }
    }
}

impl Piece for Catalan {
    fn name(&self) -> &'static str {
        "annulus"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [RING, [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [modulus, argument]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = argument.sin_cos();
        let (u, v) = (modulus * c, modulus * s);
        let ((su, cu), (_, chv)) = (u.sin_cos(), v.sinh_cosh());
        let ((half, _), (rise, _)) = ((u * 0.5).sin_cos(), (v * 0.5).sinh_cosh());
        place[0] = u - su * chv;
        place[1] = -(cu * chv) + 1.0;
        place[2] = half * rise * 4.0;
    }
    fn area_element_bound(&self) -> f64 {
        // The element by u and v is 2 (sinh^2(v/2) + sin^2(u/2)) (cosh v + 1), on a circle largest where u is 0.
        let sine = libm::sinh(RING[1]);
        RING[1] * sine * sine * (1.0 + 1e-12)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        RING.map(|r| rim_at_first(r, [0.0, TAU])).into()
    }
}

/// Double arcs from the parameters of one of the sheets.
fn arcs<P: Piece>(
    piece: &P,
    arcs: usize,
    count: usize,
    at: impl Fn(usize, f64) -> [f64; 2],
) -> Vec<TrueCurve> {
    let arc = |k| {
        curve(CurveKind::Double, false, count, |t| {
            place_at(piece, at(k, t))
        })
    };
    (0..arcs).map(arc).collect()
}

/// The places at which the arcs end: there the boundary crosses itself.
fn ends<P: Piece>(piece: &P, arcs: usize, at: impl Fn(usize, f64) -> [f64; 2]) -> Vec<Vec<f64>> {
    let both = (0..arcs).flat_map(|k| [(k, 0.0), (k, 1.0)]);
    both.map(|(k, t)| place_at(piece, at(k, t))).collect()
}

/// Both of them.
pub(super) fn minimal_surfaces() -> Vec<SampleSurface> {
    vec![
        SampleSurface::new(
            "enneper",
            "Enneper's surface over a disc so wide that it crosses itself in two arcs",
            vec![Box::new(Enneper)],
            Truth {
                boundary_curves: 1,
                ..crossing([1, 2, 0], &[DISC], 2)
            },
            15_000,
        )
        .singular(|m| arcs(&Enneper, 2, m, Enneper::double_parameters))
        .at(PointKind::CurveEnd, ends(&Enneper, 2, Enneper::double_parameters)),
        SampleSurface::new(
            "catalan",
            "a ring of Catalan's surface about its branch point: it winds twice and crosses itself in three arcs",
            vec![Box::new(Catalan)],
            Truth {
                boundary_curves: 2,
                ..crossing([1, 4, 0], &[ANNULUS], 3)
            },
            10_000,
        )
        .singular(|m| arcs(&Catalan, 3, m, Catalan::double_parameters))
        .at(PointKind::CurveEnd, ends(&Catalan, 3, Catalan::double_parameters)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_meet_in_the_arcs() {
        for step in 0..=10 {
            let t = f64::from(step) / 10.0;
            for arc in 0..3 {
                let [r, a] = Catalan::double_parameters(arc, t);
                let places = [a, a + 0.5 * TAU].map(|a| place_at(&Catalan, [r, a]));
                let off = (places[0].iter().zip(&places[1])).map(|(x, y)| (x - y).abs());
                assert!(off.fold(0.0, f64::max) < 1e-9, "{arc} {t}");
            }
            for (arc, mirror) in [0.5 * TAU, 0.0].into_iter().enumerate() {
                let [r, a] = Enneper::double_parameters(arc, t);
                let places = [a, mirror - a].map(|a| place_at(&Enneper, [r, a]));
                let off = (places[0].iter().zip(&places[1])).map(|(x, y)| (x - y).abs());
                assert!(off.fold(0.0, f64::max) < 1e-9, "{arc} {t}");
                assert!(r <= DISC_RADIUS + 1e-12);
            }
        }
    }
}
