//! The lowest parabola above points of the plane.

use nalgebra::{Matrix3, Vector3};

/// The parabola `v = a + b t + c t^2` of least mean height over the points with none of them above it.
///
/// A linear program in three unknowns. Solved by exchange: the parabola stands on three points, the
/// point farthest above it comes in, and the ratio test of the dual simplex method says which
/// one goes. O(k) an exchange, few exchanges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Envelope {
    terms: Vector3<f64>,
}

/// Exchanges tried.
const EXCHANGES: usize = 200;

impl Envelope {
    /// `None` for fewer than three different `t`, or when rounding stands in the way.
    pub(super) fn above(points: &[[f64; 2]], scale: f64) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let power = |t: f64| Vector3::new(1.0, t / scale, (t / scale).powi(2));
        let mean = points.iter().map(|p| power(p[0])).sum::<Vector3<f64>>() / points.len() as f64;
        // The moments of the points are a mean of those of the outermost and the middle one.
        let by = |f: &dyn Fn(f64) -> f64| {
            (0..points.len()).min_by(|&a, &b| f(points[a][0]).total_cmp(&f(points[b][0])))
        };
        let middle = mean[1] * scale;
        let mut base = [by(&|t| t)?, by(&|t| -t)?, by(&|t| (t - middle).abs())?];
        for _ in 0..EXCHANGES {
            let columns = base.map(|k| power(points[k][0]));
            let inverse = Matrix3::from_columns(&columns).try_inverse()?;
            let heights = Vector3::from(base.map(|k| points[k][1]));
            let terms = inverse.transpose() * heights;
            let mut worst = (1e-12 * scale, None);
            for (k, p) in points.iter().enumerate() {
                let above = p[1] - terms.dot(&power(p[0]));
                if above > worst.0 && !base.contains(&k) {
                    worst = (above, Some(k));
                }
            }
            let Some(enter) = worst.1 else {
                let [a, b, c] = terms.into();
                return Some(Self {
                    terms: Vector3::new(a, b / scale, c / (scale * scale)),
                });
            };
            let shares = inverse * mean;
            let change = inverse * power(points[enter][0]);
            let leave = (0..3)
                .filter(|&j| change[j] > 1e-12)
                .min_by(|&a, &b| (shares[a] / change[a]).total_cmp(&(shares[b] / change[b])))?;
            base[leave] = enter;
        }
        None
    }

    /// The parabola through the origin, `v = b t + c t^2`, of least mean height over the points with none of them above it,
    /// no steeper at the origin than `slope` and no more bent than `bend` (of `c`); `None` where there is none.
    ///
    /// A linear program in two unknowns: one constraint after the other is taken in, and where it is not met the answer is on its
    /// line (Seidel 1991). O(k^2) for k points.
    pub(super) fn through_origin(points: &[[f64; 2]], slope: f64, bend: f64) -> Option<Self> {
        // In units of the greatest slope and bend: both unknowns are from -1 to 1.
        let row = |t: f64| [t * slope, t * t * bend];
        let sum = (points.iter()).fold([0.0; 2], |sum, p| {
            let [a, b] = row(p[0]);
            [sum[0] + a, sum[1] + b]
        });
        let inner = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let rounding = 1e-12 * points.iter().map(|p| p[0].abs()).fold(0.0, f64::max) * slope;
        let mut best = sum.map(|s| if s > 0.0 { -1.0 } else { 1.0 });
        let walls = [
            ([1.0, 0.0], -1.0),
            ([-1.0, 0.0], -1.0),
            ([0.0, 1.0], -1.0),
            ([0.0, -1.0], -1.0),
        ];
        for (k, &[t, v]) in points.iter().enumerate() {
            let a = row(t);
            if inner(a, best) >= v - rounding {
                continue;
            }
            let square = inner(a, a);
            if square <= rounding * rounding {
                return None;
            }
            let foot = a.map(|x| x * v / square);
            let along = [-a[1] / square.sqrt(), a[0] / square.sqrt()];
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            let before = points[..k].iter().map(|&[t, v]| (row(t), v - rounding));
            for (b, least) in before.chain(walls) {
                let (rate, left) = (inner(b, along), least - inner(b, foot));
                if rate > 0.0 {
                    low = low.max(left / rate);
                } else if rate < 0.0 {
                    high = high.min(left / rate);
                } else if left > rounding {
                    return None;
                }
            }
            if low > high {
                return None;
            }
            let at = if inner(sum, along) > 0.0 { low } else { high };
            best = [0, 1].map(|i| foot[i] + at * along[i]);
        }
        Some(Self {
            terms: Vector3::new(0.0, best[0] * slope, best[1] * bend),
        })
    }

    pub(super) fn at(&self, t: f64) -> f64 {
        self.terms[0] + t * (self.terms[1] + t * self.terms[2])
    }

    pub(super) fn slope(&self, t: f64) -> f64 {
        self.terms[1] + 2.0 * t * self.terms[2]
    }

    /// Second derivative.
    pub(super) fn bend(&self) -> f64 {
        2.0 * self.terms[2]
    }

    /// Parameter of the foot of a point, by Newton's method from straight above.
    pub(super) fn foot(&self, [t, v]: [f64; 2]) -> f64 {
        let mut s = t;
        for _ in 0..20 {
            let (height, slope) = (self.at(s) - v, self.slope(s));
            let first = (s - t) + height * slope;
            let second = 1.0 + slope * slope + height * self.bend();
            if second < 0.1 {
                break;
            }
            let step = first / second;
            s -= step;
            if step.abs() < 1e-14 * (1.0 + s.abs()) {
                break;
            }
        }
        s
    }

    /// Distance of a point below the parabola, negative above.
    pub(super) fn depth(&self, point: [f64; 2]) -> f64 {
        let s = self.foot(point);
        let d = (point[0] - s).hypot(point[1] - self.at(s));
        if point[1] <= self.at(point[0]) { d } else { -d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lies_above_and_stands_on_points(
            points in prop::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 3..60),
        ) {
            let Some(e) = Envelope::above(&points, 1.0) else { return Ok(()) };
            let gaps: Vec<f64> = points.iter().map(|p| e.at(p[0]) - p[1]).collect();
            // Relative to the size of the terms: three points of nearly equal t bend it widely.
            let size = 1.0 + e.terms.amax();
            prop_assert!(gaps.iter().all(|g| *g > -1e-9 * size));
            prop_assert!(gaps.iter().filter(|g| **g < 1e-9 * size).count() >= 3);
        }

        #[test]
        fn no_parabola_above_is_lower(
            points in prop::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 8..40),
            other in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let Some(e) = Envelope::above(&points, 1.0) else { return Ok(()) };
            // Any other one, lifted until it is above all.
            let raw = |t: f64| other[0] + t * (other[1] + t * other[2]);
            let lift = points.iter().map(|p| p[1] - raw(p[0])).fold(f64::NEG_INFINITY, f64::max);
            let mean = |f: &dyn Fn(f64) -> f64| points.iter().map(|p| f(p[0])).sum::<f64>();
            prop_assert!(mean(&|t| e.at(t)) <= mean(&|t| raw(t) + lift) + 1e-6 * (1.0 + e.terms.amax()));
        }

        #[test]
        fn through_the_origin_none_above_is_lower(
            points in prop::collection::vec([0.0..1.0f64, -1.0..0.2f64], 2..40),
            other in prop::array::uniform2(-1.0..1.0f64),
        ) {
            let (slope, bend) = (2.0, 1.5);
            let other = [other[0] * slope, other[1] * bend];
            let above = |b: f64, c: f64| points.iter().all(|p| p[0] * (b + c * p[0]) >= p[1] - 1e-9);
            let mean = |b: f64, c: f64| points.iter().map(|p| p[0] * (b + c * p[0])).sum::<f64>();
            match Envelope::through_origin(&points, slope, bend) {
                Some(e) => {
                    let [b, c] = [e.terms[1], e.terms[2]];
                    prop_assert!(e.at(0.0) == 0.0 && above(b, c));
                    prop_assert!(b.abs() <= slope * (1.0 + 1e-9) && c.abs() <= bend * (1.0 + 1e-9));
                    if above(other[0], other[1]) {
                        prop_assert!(mean(b, c) <= mean(other[0], other[1]) + 1e-6);
                    }
                }
                None => prop_assert!(!points.iter().all(|p| p[0] * (slope + bend * p[0]) >= p[1] + 1e-9)),
            }
        }
    }

    #[test]
    fn foot_of_the_apex() {
        let points: Vec<[f64; 2]> = (0..41)
            .map(|k| f64::from(k) / 20.0 - 1.0)
            .map(|t| [t, 0.5 - t * t])
            .collect();
        let e = Envelope::above(&points, 1.0).unwrap();
        assert!((e.depth([0.0, 0.2]) - 0.3).abs() < 1e-9);
        assert!((e.depth([0.0, 0.6]) + 0.1).abs() < 1e-9);
        assert!(Envelope::above(&points[..2], 1.0).is_none());
    }
}
