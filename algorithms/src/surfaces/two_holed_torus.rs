//! The two-holed torus: a smooth union of two tori.

use super::{Jet, Piece};
use std::f64::consts::TAU;

/// Core radius, tube radius, and distance of the axes from the plane of symmetry x = 0.
const CORE: f64 = 2.0;
const TUBE: f64 = 1.0;
const OFFSET: f64 = 2.7;
/// Width of the blend, in the unit of distance.
const BLEND: f64 = 0.55;

/// The surface -k log(exp(-a/k) + exp(-b/k)) = 0, with a and b the signed distances to two tori
/// (unit tubes, core circles of radius 2 about vertical axes at x = 2.7 and x = -2.7), k = 0.55.
///
/// Seen from the core circle of its own torus, each half (x > 0, x < 0) is a graph: on a ray normal to the core,
/// the function increases from -1 until it reaches the surface or the plane x = 0. Parameters:
/// angle along the core circle, in 0..2 pi for the right half and in 2 pi..4 pi for the left (mirrored)
/// one, and angle about the core. Parameters whose ray leaves the half have no place on the surface.
#[derive(Clone, Copy, Debug)]
pub struct TwoHoledTorus;

impl TwoHoledTorus {
    /// The function whose zeros are the surface, negative inside, and its gradient. It changes by
    /// at most the distance between two places.
    pub fn level(place: [f64; 3]) -> (f64, [f64; 3]) {
        let torus = |side: f64| {
            let x = place[0] - side * OFFSET;
            let around = libm::hypot(x, place[1]);
            let across = around - CORE;
            let reach = libm::hypot(across, place[2]);
            let (radial, up) = (across / reach, place[2] / reach);
            (
                reach - TUBE,
                [radial * x / around, radial * place[1] / around, up],
            )
        };
        let ((a, da), (b, db)) = (torus(1.0), torus(-1.0));
        // Shifted by the smaller one, the exponentials neither overflow nor both vanish.
        let low = a.min(b);
        let (ea, eb) = (libm::exp((low - a) / BLEND), libm::exp((low - b) / BLEND));
        let (wa, wb) = (ea / (ea + eb), eb / (ea + eb));
        // On an axis or a core circle a gradient does not exist; the value does.
        let gradient = std::array::from_fn(|k| {
            let (x, y) = (wa * da[k], wb * db[k]);
            (if x.is_nan() { 0.0 } else { x }) + if y.is_nan() { 0.0 } else { y }
        });
        (low - BLEND * libm::log(ea + eb), gradient)
    }

    /// Where the ray from `core` along the unit vector `out`, in the right half, meets the
    /// surface: its length, and whether it does so within the half.
    fn reach(core: [f64; 3], out: [f64; 3]) -> (f64, bool) {
        let end = if out[0] < 0.0 {
            CORE.min(-core[0] / out[0])
        } else {
            CORE
        };
        let level = |r: f64| {
            let (level, gradient) = Self::level(std::array::from_fn(|k| core[k] + r * out[k]));
            (level, (0..3).map(|k| gradient[k] * out[k]).sum::<f64>())
        };
        if level(end).0 <= 0.0 {
            return (end, false);
        }
        // Newton steps, and halving where a step would leave the bracket.
        let (mut low, mut high, mut at) = (0.0, end, TUBE.min(0.75 * end));
        for _ in 0..80 {
            let (value, slope) = level(at);
            if value <= 0.0 {
                low = at;
            } else {
                high = at;
            }
            let step = at - value / slope;
            let next = if step > low && step < high {
                step
            } else {
                0.5 * (low + high)
            };
            if (next - at).abs() <= 4.0 * f64::EPSILON {
                return (next, true);
            }
            at = next;
        }
        (at, true)
    }

    fn ray(parameters: [f64; 2]) -> (f64, [f64; 3], [f64; 3]) {
        let side = if parameters[0] < TAU { 1.0 } else { -1.0 };
        let ((s, c), (sv, cv)) = (libm::sincos(parameters[0]), libm::sincos(parameters[1]));
        (
            side,
            [OFFSET + CORE * c, CORE * s, 0.0],
            [cv * c, cv * s, sv],
        )
    }
}

impl Piece for TwoHoledTorus {
    fn name(&self) -> &'static str {
        "two-holed torus"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 2.0 * TAU], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn holds(&self, parameters: [f64; 2]) -> bool {
        let (_, core, out) = Self::ray(parameters);
        Self::reach(core, out).1
    }
    fn map(&self, [u, v]: [Jet; 2], place: &mut [Jet]) {
        let (side, core, out) = Self::ray([u.value, v.value]);
        let (reach, _) = Self::reach(core, out);
        let ((s, c), (sv, cv)) = (u.sin_cos(), v.sin_cos());
        let direction = [cv * c, cv * s, sv];
        // The length of the ray as a jet, from the implicit function theorem.
        let fixed = [c * CORE + OFFSET, s * CORE, Jet::default()];
        let still: [Jet; 3] = std::array::from_fn(|k| fixed[k] + direction[k] * reach);
        let (_, gradient) = Self::level(still.map(|x| x.value));
        let along: f64 = (0..3).map(|k| gradient[k] * direction[k].value).sum();
        let by = |part: fn(&Jet) -> f64| {
            -(0..3).map(|k| gradient[k] * part(&still[k])).sum::<f64>() / along
        };
        let length = Jet {
            value: reach,
            by_first: by(|j| j.by_first),
            by_second: by(|j| j.by_second),
        };
        for k in 0..3 {
            place[k] = fixed[k] + direction[k] * length;
        }
        place[0] = place[0] * side;
    }
    fn area_element_bound(&self) -> f64 {
        // Not derived: 1.15 times the largest value on a fine grid (see the test).
        BOUND
    }
    /// From a midpoint rule on 4000 x 4000 parameters; the rim of the domain keeps [`Piece::area`]'s
    /// quadrature from converging.
    fn area(&self) -> f64 {
        AREA
    }
    /// Steps along the gradient onto the surface, then along the surface towards the place, in turns.
    /// The distance of the nearest place for places within about 0.3 of the surface; farther away,
    /// that of a place where the surface faces them.
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let target = [place[0], place[1], place[2]];
        let mut at = target;
        let mut best = f64::INFINITY;
        for _ in 0..60 {
            let mut normal = [0.0; 3];
            for _ in 0..20 {
                let (level, gradient) = Self::level(at);
                let square: f64 = gradient.iter().map(|g| g * g).sum();
                if square < 1e-12 {
                    // On an axis or a core circle: no direction is better than another.
                    at = [at[0] + 1e-3, at[1] + 2e-3, at[2] + 3e-3];
                    continue;
                }
                normal = gradient.map(|g| g / square.sqrt());
                at = std::array::from_fn(|k| at[k] - level * gradient[k] / square);
                if level.abs() < 1e-14 {
                    break;
                }
            }
            let rest: [f64; 3] = std::array::from_fn(|k| target[k] - at[k]);
            let distance = rest.iter().map(|r| r * r).sum::<f64>().sqrt();
            if best - distance <= 1e-13 {
                return Some(best.min(distance));
            }
            best = distance;
            let off: f64 = (0..3).map(|k| rest[k] * normal[k]).sum();
            at = std::array::from_fn(|k| at[k] + rest[k] - off * normal[k]);
        }
        Some(best)
    }
}

const BOUND: f64 = 8.9;
const AREA: f64 = 151.525_859;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::area_element;

    #[test]
    fn area_and_bound_agree_with_a_midpoint_rule() {
        let (rows, columns) = (600, 600);
        let mut place = [Jet::default(); 3];
        let (mut sum, mut largest) = (0.0, 0.0f64);
        for i in 0..rows {
            for j in 0..columns {
                let at = [
                    TAU * (i as f64 + 0.5) / rows as f64,
                    TAU * (j as f64 + 0.5) / columns as f64,
                ];
                if TwoHoledTorus.holds(at) {
                    TwoHoledTorus.map([Jet::first(at[0]), Jet::second(at[1])], &mut place);
                    let element = area_element(&place);
                    sum += 2.0 * element * TAU * TAU / (rows * columns) as f64;
                    largest = largest.max(element);
                }
            }
        }
        assert!((sum / AREA - 1.0).abs() < 2e-4, "{sum} {largest}");
        assert!(largest * 1.1 < BOUND && largest * 1.2 > BOUND, "{largest}");
    }

    #[test]
    fn gradient_agrees_with_differences() {
        let (at, h) = ([0.4, 1.9, 0.7], 1e-6);
        let (_, gradient) = TwoHoledTorus::level(at);
        for k in 0..3 {
            let (mut up, mut down) = (at, at);
            up[k] += h;
            down[k] -= h;
            let slope = (TwoHoledTorus::level(up).0 - TwoHoledTorus::level(down).0) / (2.0 * h);
            assert!((slope - gradient[k]).abs() < 1e-8);
        }
    }

    #[test]
    fn distance_where_the_gradient_vanishes_is_a_number() {
        for at in [
            [0.0; 3],
            [OFFSET, 0.0, 0.0],
            [OFFSET + CORE, 0.0, 0.0],
            [-OFFSET, CORE, 0.0],
        ] {
            let found = TwoHoledTorus.closed_form_distance(&at).unwrap();
            assert!(found.is_finite() && found > 0.2, "{at:?} {found}");
        }
    }

    #[test]
    fn distance_of_places_off_the_surface() {
        let mut place = [Jet::default(); 3];
        for (u, v) in [(0.3, 1.0), (2.0, 4.0), (9.0, 2.5), (2.9, 1.4)] {
            TwoHoledTorus.map([Jet::constant(u), Jet::constant(v)], &mut place);
            let on = [0, 1, 2].map(|k| place[k].value);
            let gradient = TwoHoledTorus::level(on).1;
            let length = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
            for off in [-0.2, 0.05, 0.2] {
                let at: Vec<f64> = (0..3).map(|k| on[k] + off * gradient[k] / length).collect();
                let found = TwoHoledTorus.closed_form_distance(&at).unwrap();
                assert!((found - off.abs()).abs() < 1e-9, "{found} {off}");
            }
        }
    }
}
