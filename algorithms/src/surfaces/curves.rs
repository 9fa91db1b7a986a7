//! The true curves of the sample surfaces, from closed forms.

use super::round::frame_about;
use super::{CurveKind, Henneberg, KleinFigureEight, Piece, Torus, TrueCurve, place_at};
use crosscap_core::PointCloud;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Points `at(0), at(1/m), ..` of a curve over 0..1.
pub(super) fn curve(
    kind: CurveKind,
    closed: bool,
    count: usize,
    at: impl Fn(f64) -> Vec<f64>,
) -> TrueCurve {
    let steps = if closed {
        count
    } else {
        count.saturating_sub(1).max(1)
    };
    let places: Vec<Vec<f64>> = (0..count).map(|k| at(k as f64 / steps as f64)).collect();
    let dimension = places.first().map_or(3, Vec::len);
    TrueCurve {
        kind,
        closed,
        points: PointCloud::new(dimension, places.concat())
            .expect("closed forms of curves are finite"),
    }
}

/// The circle in which two spheres of the given centers and radii meet.
pub(super) fn circle_of_spheres(
    kind: CurveKind,
    [a, b]: [[f64; 3]; 2],
    [r, s]: [f64; 2],
    count: usize,
) -> TrueCurve {
    let apart: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
    let square: f64 = apart.iter().map(|x| x * x).sum();
    let share = 0.5 * (1.0 + (r * r - s * s) / square);
    let radius = (r * r - share * share * square).sqrt();
    let [x, y, _] = frame_about(apart);
    curve(kind, true, count, |t| {
        let (sine, cosine) = libm::sincos(TAU * t);
        (0..3)
            .map(|k| a[k] + share * apart[k] + radius * (cosine * x[k] + sine * y[k]))
            .collect()
    })
}

pub(super) fn klein_circle(count: usize) -> Vec<TrueCurve> {
    let piece = KleinFigureEight::immersed();
    vec![curve(CurveKind::Double, true, count, |t| {
        place_at(&piece, [TAU * t, 0.0])
    })]
}

pub(super) fn henneberg_arcs(count: usize) -> Vec<TrueCurve> {
    let [inner, outer] = Henneberg::range();
    (0..4)
        .map(|arc| {
            curve(CurveKind::Double, false, count, |t| {
                let r = inner + (outer - inner) * t;
                place_at(&Henneberg, Henneberg::double_parameters(r)[arc][0])
            })
        })
        .collect()
}

/// The three axes of the Roman surface between their pinch points.
pub(super) fn roman_segments(count: usize) -> Vec<TrueCurve> {
    (0..3)
        .map(|axis| {
            curve(CurveKind::Double, false, count, |t| {
                (0..3)
                    .map(|k| if k == axis { t - 0.5 } else { 0.0 })
                    .collect()
            })
        })
        .collect()
}

/// Where a torus about the vertical axis (core radius `core`, tube radius `tube`) meets a sphere about
/// (`core`, 0, 0) that is wider than the tube: at each angle v about the tube the two azimuths at which
/// the distance to the center is the radius.
pub(super) fn torus_sphere_circles(
    core: f64,
    tube: f64,
    radius: f64,
    count: usize,
) -> Vec<TrueCurve> {
    [1.0, -1.0]
        .into_iter()
        .map(|side| {
            curve(CurveKind::Double, true, count, |t| {
                let (s, c) = libm::sincos(TAU * t);
                let (around, z) = (core + tube * c, tube * s);
                let cosine = (around * around + z * z + core * core - radius * radius)
                    / (2.0 * around * core);
                let azimuth = side * libm::acos(cosine);
                vec![around * libm::cos(azimuth), around * libm::sin(azimuth), z]
            })
        })
        .collect()
}

/// Where the thin torus `thin` runs through the tube of `wide`, entering and leaving: along each line of
/// the thin tube the angle about its axis at which it lies on `wide`, by bisection between
/// `inside` and `inside` plus or minus `beyond`.
pub(super) fn torus_through_torus(
    wide: &Torus,
    thin: &Torus,
    inside: f64,
    beyond: f64,
    count: usize,
) -> Vec<TrueCurve> {
    [1.0, -1.0]
        .into_iter()
        .map(|side| {
            curve(CurveKind::Double, true, count, |t| {
                let place = |angle: f64| place_at(thin, [angle, TAU * t]);
                let (mut low, mut high) = (inside, inside + side * beyond);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if wide.signed_distance(&place(middle)) < 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                place(low)
            })
        })
        .collect()
}

/// The two points where three unit spheres meet whose centers are the corners of an equilateral
/// triangle of side 1 about the origin in the plane z = 0.
pub(super) fn triple_points_of_three_spheres() -> Vec<Vec<f64>> {
    let height = (2.0f64 / 3.0).sqrt();
    vec![vec![0.0, 0.0, height], vec![0.0, 0.0, -height]]
}

/// Corners of an equilateral triangle of side 1 about the origin.
pub(super) fn equilateral_centers() -> [[f64; 3]; 3] {
    let radius = 1.0 / 3f64.sqrt();
    [0.0, 1.0, 2.0].map(|k| {
        let (s, c) = libm::sincos(FRAC_PI_2 + k * TAU / 3.0);
        [radius * c, radius * s, 0.0]
    })
}

/// The standard double bubble with given outer radii: centers on the x axis, the first at the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoubleBubble {
    /// x coordinates of the centers of the two bubbles and of the film between them.
    pub centers: [f64; 3],
    /// Radii of the three spheres.
    pub radii: [f64; 3],
    /// Half opening angles of the three caps: about -x, +x, -x.
    pub angles: [f64; 3],
}

impl DoubleBubble {
    /// The larger bubble first. Sheets meet at 120 degrees, so centers and junction form triangles
    /// with an angle of 60 degrees, and curvatures add up: 1/r1 + 1/r3 = 1/r2.
    pub(super) fn new(large: f64, small: f64) -> Self {
        let apart = (large * large + small * small - large * small).sqrt();
        let plane = (apart * apart + large * large - small * small) / (2.0 * apart);
        let height = (large * large - plane * plane).sqrt();
        let film = 1.0 / (1.0 / small - 1.0 / large);
        // The smaller bubble has the higher pressure: the film bulges into the larger one.
        let center = plane + (film * film - height * height).sqrt();
        Self {
            centers: [0.0, apart, center],
            radii: [large, small, film],
            angles: [
                PI - libm::atan2(height, plane),
                libm::atan2(height, plane - apart),
                libm::asin(height / film),
            ],
        }
    }

    /// The circle in which the three caps meet.
    pub(super) fn junction(&self, count: usize) -> Vec<TrueCurve> {
        let [a, b, _] = self.centers.map(|x| [x, 0.0, 0.0]);
        let radii = [self.radii[0], self.radii[1]];
        vec![circle_of_spheres(CurveKind::Junction, [a, b], radii, count)]
    }
}

/// The rims of a piece, each as `count` points at equal steps of arc length.
pub(super) fn rim_curves(piece: &dyn Piece, count: usize) -> Vec<TrueCurve> {
    piece
        .rims()
        .iter()
        .map(|rim| {
            let walk = RimWalk::new(piece, rim);
            curve(CurveKind::Boundary, true, count, |t| {
                place_at(piece, walk.parameters(t * walk.length()))
            })
        })
        .collect()
}

/// A rim with its arc length tabulated.
pub(super) struct RimWalk {
    /// Arc length and parameters at the knots; the parameters jump where a segment ends on a seam.
    knots: Vec<(f64, [f64; 2], [f64; 2])>,
    length: f64,
}

impl RimWalk {
    /// Tabulates 2000 steps a segment: chords of such steps miss the length by a few millionths.
    pub(super) fn new(piece: &dyn Piece, rim: &[super::RimSegment]) -> Self {
        const STEPS: usize = 2000;
        let mut knots = Vec::with_capacity(STEPS * rim.len());
        let mut length = 0.0;
        for segment in rim {
            let at = |k: usize| -> [f64; 2] {
                let share = k as f64 / STEPS as f64;
                [0, 1].map(|a| segment.from[a] + share * (segment.to[a] - segment.from[a]))
            };
            let mut here = place_at(piece, at(0));
            for k in 0..STEPS {
                knots.push((length, at(k), at(k + 1)));
                let next = place_at(piece, at(k + 1));
                length += crosscap_core::squared_distance(&here, &next).sqrt();
                here = next;
            }
        }
        Self { knots, length }
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Parameters at an arc length from the start.
    pub(super) fn parameters(&self, length: f64) -> [f64; 2] {
        let k = self
            .knots
            .partition_point(|knot| knot.0 <= length)
            .saturating_sub(1);
        let (start, from, to) = self.knots[k];
        let end = self.knots.get(k + 1).map_or(self.length, |knot| knot.0);
        let share = if end > start {
            ((length - start) / (end - start)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        [0, 1].map(|a| from[a] + share * (to[a] - from[a]))
    }
}

/// A straight curve.
pub(super) fn straight(kind: CurveKind, from: [f64; 3], to: [f64; 3], count: usize) -> TrueCurve {
    curve(kind, false, count, |t| {
        (0..3).map(|k| from[k] + t * (to[k] - from[k])).collect()
    })
}

/// A curve of straight parts, `count` points at equal steps of its parameter.
pub(super) fn path(kind: CurveKind, corners: Vec<[f64; 3]>, count: usize) -> TrueCurve {
    let closed = corners.first() == corners.last();
    curve(kind, closed, count, move |t| {
        let at = t * (corners.len() - 1) as f64;
        let k = (at as usize).min(corners.len() - 2);
        let share = at - k as f64;
        (0..3)
            .map(|i| corners[k][i] + share * (corners[k + 1][i] - corners[k][i]))
            .collect()
    })
}

/// The circle of `radius` about the z axis at a height.
pub(super) fn circle(kind: CurveKind, radius: f64, height: f64, count: usize) -> TrueCurve {
    curve(kind, true, count, |t| {
        let (s, c) = libm::sincos(TAU * t);
        vec![radius * c, radius * s, height]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::round::cross;

    #[test]
    fn caps_of_the_double_bubble_meet_at_120_degrees() {
        let bubble = DoubleBubble::new(1.0, 0.8);
        let junction = bubble.junction(8);
        for p in junction[0].points.iter() {
            let tangent = {
                let [_, y, z] = [p[0], p[1], p[2]];
                [0.0, -z, y]
            };
            // Unit conormals, each pointing into its cap: they add up to nothing.
            let mut sum = [0.0; 3];
            for k in 0..3 {
                let out: [f64; 3] = [p[0] - bubble.centers[k], p[1], p[2]];
                let radius = out.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!((radius - bubble.radii[k]).abs() < 1e-12);
                let mut conormal = cross(out, tangent);
                let length = conormal.iter().map(|x| x * x).sum::<f64>().sqrt();
                let pole = bubble.centers[k] + [-1.0, 1.0, -1.0][k] * bubble.radii[k];
                let towards = conormal[0] * (pole - p[0]) - conormal[1] * p[1] - conormal[2] * p[2];
                conormal = conormal.map(|x| x / length * towards.signum());
                (0..3).for_each(|k| sum[k] += conormal[k]);
            }
            assert!(sum.iter().all(|x| x.abs() < 1e-12), "{sum:?}");
        }
    }
}
