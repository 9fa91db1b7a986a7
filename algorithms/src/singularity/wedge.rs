//! A corner of a boundary in the plane, and the smooth boundary that it is held against.

use super::boundary::{Axes, area_beyond};
use super::kink::Kink;
use super::lowest::lowest;
use crate::tuning::BoundaryCornerTuning;
use nalgebra::SVector;
use std::f64::consts::PI;

/// Times that a curve is fitted, each time upright over its own middle.
const ROUNDS: usize = 4;
/// Turns from the direction outward that the search for a kink begins with, in radians. From one direction alone it stays where it begins: in a ball about a
/// place of one arm, with a chance gap there and the tip of the corner 0.6 radii away, the gap was taken for the corner.
const BEGINNINGS: [f64; 3] = [0.0, -0.7, 0.7];
/// A turn of the axes from one round to the next, in radians, below which nothing more is gained.
const SETTLED: f64 = 0.01;
/// Bounds of the height of a smooth curve over the center, and of its slope there.
const WIDE: [f64; 2] = [2.0, 4.0];

/// Points of a sheet that is laid out in its tangent plane, about the center and in radii of the ball.
pub(super) struct Laid<'l> {
    pub(super) points: &'l [[f64; 2]],
    pub(super) tuning: &'l BoundaryCornerTuning,
}

/// A kink above points, with the axes that it was fitted in.
pub(super) struct Wedge {
    pub(super) axes: Axes,
    pub(super) kink: Kink,
    /// Area of the ball beyond it, in squared radii.
    beyond: f64,
}

/// What there is to say for a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Evidence {
    /// Turn of the boundary at the corner, in radians; negative where it goes inward.
    pub(super) turn: f64,
    /// Points that would have to lie between the corner and the one nearest to it, and the next.
    pub(super) in_tip: [f64; 2],
    /// Points that would have to lie between one of the arms and the points below it.
    pub(super) below_arm: f64,
    /// Points that would have to lie between the corner and the smooth boundary that comes nearest to it.
    pub(super) missing: f64,
}

impl Laid<'_> {
    fn over(&self, axes: &Axes) -> Vec<[f64; 2]> {
        self.points.iter().map(|&p| axes.plane(p)).collect()
    }

    /// The kink that leaves most beyond it.
    pub(super) fn wedge(&self) -> Option<Wedge> {
        let out = self.outward()?;
        let begun = BEGINNINGS.iter().filter_map(|&turn| {
            let (sin, cos) = libm::sincos(turn);
            self.settled([cos * out[0] - sin * out[1], sin * out[0] + cos * out[1]])
        });
        begun.reduce(|best, next| {
            if next.beyond > best.beyond {
                next
            } else {
                best
            }
        })
    }

    /// The same from one direction on, each time over the line that halved the angle of the last.
    fn settled(&self, mut out: [f64; 2]) -> Option<Wedge> {
        let mut best: Option<Wedge> = None;
        for _ in 0..ROUNDS {
            let axes = Axes::new([0.0; 2], out);
            let kink = Kink::above(&self.over(&axes), self.tuning.reach, self.tuning.arm_bend);
            // Over a direction that is too far off no curve is above the points.
            let Some(kink) = kink else { break };
            let [before, behind] = kink.slopes();
            // Upright over the line that halves the angle.
            let turn = (before.atan() + behind.atan()) / 2.0;
            let (sin, cos) = turn.sin_cos();
            out = [0, 1].map(|i| cos * axes.out[i] - sin * axes.along[i]);
            let beyond = area_beyond(|t| kink.at(t), 1.0);
            if best.as_ref().is_none_or(|b| beyond > b.beyond) {
                best = Some(Wedge { axes, kink, beyond });
            }
            if turn.abs() < SETTLED {
                break;
            }
        }
        best
    }

    /// The direction from the mean of the points to the center.
    fn outward(&self) -> Option<[f64; 2]> {
        let count = self.points.len() as f64;
        let mean = [0, 1].map(|i| self.points.iter().map(|p| p[i]).sum::<f64>() / count);
        (mean[0].hypot(mean[1]) > 1e-9).then_some(mean.map(|x| -x))
    }

    /// The largest area beyond a smooth curve, in squared radii, first over the direction `out`, then over its own middle.
    fn beyond_smooth(&self, mut out: [f64; 2]) -> f64 {
        let mut most = 0.0_f64;
        let row = |t: f64| SVector::from([1.0, t, t * t, t * t * t, t * t * t * t]);
        let [bend, change, further] = self.tuning.smooth;
        for _ in 0..ROUNDS {
            let axes = Axes::new([0.0; 2], out);
            let bounds = [WIDE[0], WIDE[1], bend, change, further];
            let Some(terms) = lowest(&self.over(&axes), row, &bounds) else {
                break;
            };
            most = most.max(area_beyond(|t| terms.dot(&row(t)), 1.0));
            out = [0, 1].map(|i| axes.out[i] - terms[1] * axes.along[i]);
        }
        most
    }

    /// What there is to say for a kink.
    pub(super) fn evidence(&self, wedge: &Wedge) -> Evidence {
        let Wedge { axes, kink, beyond } = wedge;
        let density = self.points.len() as f64 / (PI - beyond).max(f64::MIN_POSITIVE);
        let [before, behind] = kink.slopes();
        let inner = kink.inner_angle();
        let [t, v] = kink.corner();
        let about: Vec<[f64; 2]> = self
            .over(axes)
            .iter()
            .map(|p| [p[0] - t, p[1] - v])
            .collect();
        let mut far: Vec<f64> = about.iter().map(|p| p[0].hypot(p[1])).collect();
        far.sort_by(f64::total_cmp);
        let nearest = [0, 1].map(|k| far.get(k).copied().unwrap_or(f64::INFINITY));
        // Over the middle, and over both arms.
        let over = |slope: f64| [0, 1].map(|i| axes.out[i] - slope * axes.along[i]);
        let smooth = [0.0, before, behind].map(|slope| self.beyond_smooth(over(slope)));
        Evidence {
            turn: PI - inner,
            in_tip: nearest.map(|far| density * inner / 2.0 * far * far),
            below_arm: density * empty_below(&about, kink),
            missing: density * (beyond - smooth.into_iter().fold(0.0, f64::max)),
        }
    }
}

/// The largest area below an arm of a kink, from the corner on, that holds none of the points, which are given about the corner: a sector that reaches from the arm to the
/// first of the points nearer to the corner than its radius.
fn empty_below(points: &[[f64; 2]], kink: &Kink) -> f64 {
    let mut polar: Vec<(f64, [f64; 2])> = points
        .iter()
        .map(|p| {
            let far = p[0].hypot(p[1]);
            (far, kink.below_arms(*p))
        })
        .collect();
    polar.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = [kink.inner_angle(); 2];
    let mut most = 0.0_f64;
    for (far, angles) in polar {
        for (free, angle) in free.iter_mut().zip(angles) {
            most = most.max(*free * far * far / 2.0);
            *free = free.min(angle);
        }
    }
    most
}
