//! Exact instances of singularities: what a model must recognize.

use super::motion::principal;
use crate::LocalPoints;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

/// Random numbers for an instance, the same for the same seed.
pub struct Draw {
    rng: TestRng,
    /// How many points the instance shall have, about.
    pub points: usize,
}

impl Draw {
    /// Numbers from a seed, for an instance of so many points.
    pub fn new(seed: u64, points: usize) -> Self {
        let mut bytes = [0x5c; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        Self {
            rng: TestRng::from_seed(RngAlgorithm::ChaCha, &bytes),
            points,
        }
    }

    /// A number in `low..high`, uniformly; `low` where that holds no number, as in `low..low`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        if low < high {
            self.rng.random_range(low..high)
        } else {
            low
        }
    }

    /// A number of mean 0 and variance 1: the sum of twelve uniform ones, so it is at most 6.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.between(-0.5, 0.5)).sum()
    }

    /// A point of the disc of radius 1, uniformly.
    pub fn disc(&mut self) -> [f64; 2] {
        loop {
            let p = [self.between(-1.0, 1.0), self.between(-1.0, 1.0)];
            if p[0] * p[0] + p[1] * p[1] < 1.0 {
                return p;
            }
        }
    }
}

/// Points around a singularity, with what is known about them. Owns what [`LocalPoints`] borrows.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Coordinates of a point.
    pub dimension: usize,
    /// The points in row order: the neighborhood, the center in its first row, then those that lie
    /// farther out and are only labelled.
    pub coordinates: Vec<f64>,
    /// How many leading rows are the neighborhood.
    pub fitted: usize,
    /// Row of the center, which the neighborhood is about.
    pub center: usize,
    /// Radius of the neighborhood.
    pub radius: f64,
    /// For each point the stratum that it belongs to beyond doubt, under any names: points with the
    /// same one must get one label, points with different ones different labels. Empty, or `None` for
    /// a point, where nothing is asked.
    pub truth: Vec<Option<u8>>,
}

/// Rows farther out than the neighborhood, up to this many radii.
const OUTER: f64 = 1.3;

impl Instance {
    /// Puts the first point at the center, and the others inside or outside of the neighborhood by
    /// their distance from it. Each point comes with its true stratum, where that is beyond doubt.
    pub fn new(dimension: usize, radius: f64, points: &[(Vec<f64>, Option<u8>)]) -> Self {
        let center = points.first().map(|p| p.0.clone()).unwrap_or_default();
        let inside =
            |p: &&(Vec<f64>, Option<u8>)| crate::squared_distance(&p.0, &center) < radius * radius;
        let ordered = || {
            let outside = points.iter().filter(move |p| !inside(p));
            points.iter().filter(inside).chain(outside)
        };
        Self {
            dimension,
            coordinates: ordered().flat_map(|p| p.0.iter().copied()).collect(),
            fitted: points.iter().filter(inside).count(),
            center: 0,
            radius,
            truth: ordered().map(|p| p.1).collect(),
        }
    }

    /// As a model sees it.
    pub fn local(&self) -> LocalPoints<'_> {
        LocalPoints {
            dimension: self.dimension,
            coordinates: &self.coordinates,
            fitted: self.fitted,
            center: self.center,
            middle: self.center,
            radius: self.radius,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dimension.max(1)
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// The same points with normal noise of standard deviation `noise * radius` in every coordinate;
    /// the same seed gives the same noise but for its size.
    pub fn with_noise(&self, seed: u64, noise: f64) -> Self {
        let mut draw = Draw::new(!seed, 0);
        let mut noisy = self.clone();
        for x in &mut noisy.coordinates {
            *x += noise * self.radius * draw.normal();
        }
        noisy
    }

    /// The same points in principal coordinates of the neighborhood, as the pipeline hands them on.
    pub fn principal(&self) -> Self {
        let coordinates = principal(self.dimension, &self.coordinates, self.fitted);
        Self {
            coordinates,
            ..self.clone()
        }
    }

    /// The same points in another order: of the neighborhood, and of those farther out. `keys` are
    /// sorted, one a point.
    pub(super) fn reordered(&self, keys: &[u16]) -> (Self, Vec<usize>) {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by_key(|&k| (k >= self.fitted, keys[k % keys.len().max(1)]));
        let row = |k: &usize| &self.coordinates[k * self.dimension..(k + 1) * self.dimension];
        let moved = Self {
            coordinates: order.iter().flat_map(row).copied().collect(),
            center: order.iter().position(|&k| k == self.center).unwrap_or(0),
            truth: if self.truth.is_empty() {
                vec![]
            } else {
                order.iter().map(|&k| self.truth[k]).collect()
            },
            ..self.clone()
        };
        (moved, order)
    }
}

/// A point of a piece at the place `p` of the disc; `margin` is how far it is from where pieces meet.
struct Placed {
    point: Vec<f64>,
    stratum: u8,
    margin: f64,
}

/// Points nearer than this share of the radius to where pieces meet are left open in the truth.
const MARGIN: f64 = 0.2;

/// Draws points of pieces in turn, all about the origin and of radius 1; the first is the origin.
fn pieces(
    draw: &mut Draw,
    dimension: usize,
    count: usize,
    mut place: impl FnMut(usize, [f64; 2]) -> Placed,
) -> Instance {
    let mut points = vec![(vec![0.0; dimension], None)];
    for k in 0..draw.points {
        let p = draw.disc().map(|x| x * OUTER);
        let placed = place(k % count, p);
        let clear = placed.margin > MARGIN;
        points.push((placed.point, clear.then_some(placed.stratum)));
    }
    Instance::new(dimension, 1.0, &points)
}

/// A flat sheet in space.
pub fn flat_sheet(draw: &mut Draw) -> Instance {
    pieces(draw, 3, 1, |_, [x, y]| Placed {
        point: vec![x, y, 0.0],
        stratum: 0,
        margin: 1.0,
    })
}

/// Half planes in space on a common line, at the given angles about it (radians). The center is on
/// the line. The strata of the truth are the half planes.
pub fn half_planes(draw: &mut Draw, angles: &[f64]) -> Instance {
    pieces(draw, 3, angles.len(), |k, [x, y]| {
        let (sin, cos) = angles[k].sin_cos();
        Placed {
            point: vec![x, y.abs() * cos, y.abs() * sin],
            stratum: k as u8,
            margin: y.abs(),
        }
    })
}

/// Two planes that cross in a line of space at 60 to 90 degrees.
pub fn two_planes(draw: &mut Draw) -> Instance {
    use std::f64::consts::PI;
    let angle = draw.between(PI / 3.0, PI / 2.0);
    half_planes(draw, &[0.0, angle, PI, PI + angle])
}

/// A half plane: a surface that ends at a line. The center is on the line.
pub fn boundary(draw: &mut Draw) -> Instance {
    half_planes(draw, &[0.0])
}

/// A plane sector of 50 to 95 degrees: a surface whose boundary has a corner. The center is the corner. The stratum of the truth is the cell.
pub fn boundary_corner(draw: &mut Draw) -> Instance {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let angle = draw.between(50.0, 95.0).to_radians();
    pieces(draw, 3, 1, |_, [x, y]| {
        let (radius, turn) = (x.hypot(y), y.atan2(x) * angle / TAU);
        let (sin, cos) = turn.sin_cos();
        let to_arm = (angle / 2.0 - turn.abs()).min(FRAC_PI_2);
        Placed {
            point: vec![radius * cos, radius * sin, 0.0],
            stratum: 0,
            margin: radius * to_arm.sin(),
        }
    })
}

/// Three half planes on a line, any two of them at 100 degrees or more, as in soap films.
pub fn y_junction(draw: &mut Draw) -> Instance {
    let spread = std::f64::consts::PI / 9.0;
    let third = std::f64::consts::TAU / 3.0;
    let [a, b] = [0, 1].map(|_| draw.between(-0.5, 0.5) * spread);
    half_planes(draw, &[0.0, third + a, 2.0 * third + b])
}

/// A half plane on a plane, at 60 to 90 degrees.
pub fn t_junction(draw: &mut Draw) -> Instance {
    use std::f64::consts::PI;
    let angle = draw.between(PI / 3.0, 2.0 * PI / 3.0);
    half_planes(draw, &[0.0, angle, PI])
}

/// Half planes on a line, any two of them at 40 degrees or more: five, or three or four planes that go through the line. No two
/// are nearly opposite and not quite: these could as well be one sheet that bends.
pub fn book(draw: &mut Draw) -> Instance {
    use std::f64::consts::{PI, TAU};
    let pages = [5, 6, 8][(draw.between(0.0, 3.0) as usize).min(2)];
    let turn = TAU / pages as f64;
    let angles: Vec<f64> = match pages {
        5 => (0..5)
            .map(|k| (k as f64 + draw.between(-0.1, 0.1)) * turn)
            .collect(),
        _ => (0..pages / 2)
            .map(|k| k as f64 * turn + draw.between(-0.02, 0.02))
            .flat_map(|angle| [angle, angle + PI])
            .collect(),
    };
    half_planes(draw, &angles)
}

/// Three planes that meet in one point, a little off right angles. The strata of the truth are the
/// twelve quarter planes.
pub fn triple_point(draw: &mut Draw) -> Instance {
    let shear: [f64; 3] = std::array::from_fn(|_| draw.between(-0.2, 0.2));
    pieces(draw, 3, 3, |k, [a, b]| {
        let mut q = [0.0; 3];
        q[(k + 1) % 3] = a;
        q[(k + 2) % 3] = b;
        let quarter = 2 * u8::from(a > 0.0) + u8::from(b > 0.0);
        Placed {
            point: vec![
                q[0] + shear[0] * q[1] + shear[1] * q[2],
                q[1] + shear[2] * q[2],
                q[2],
            ],
            stratum: 4 * k as u8 + quarter,
            margin: a.abs().min(b.abs()),
        }
    })
}

/// Two planes of R^4 that have one point in common, the center.
pub fn crossing_in_four_dimensions(draw: &mut Draw) -> Instance {
    let shear: [f64; 4] = std::array::from_fn(|_| draw.between(-0.3, 0.3));
    pieces(draw, 4, 2, |k, [a, b]| Placed {
        point: if k == 0 {
            vec![a, b, 0.0, 0.0]
        } else {
            vec![
                shear[0] * a + shear[1] * b,
                shear[2] * a + shear[3] * b,
                a,
                b,
            ]
        },
        stratum: k as u8,
        margin: a.hypot(b),
    })
}

/// Both halves of an elliptic cone, or one of them, a little less wide than high to nearly twice as wide. The center is the tip. The strata of the truth are
/// the halves.
pub fn cone_point(draw: &mut Draw) -> Instance {
    let wide = [0, 1].map(|_| draw.between(0.7, 1.8));
    let both = draw.between(-1.0, 1.0) > 0.0;
    let halves = if both { 2 } else { 1 };
    pieces(draw, 3, halves, |k, [x, y]| {
        let z = (x / wide[0]).hypot(y / wide[1]);
        Placed {
            point: vec![x, y, if k == 0 { z } else { -z }],
            stratum: k as u8,
            margin: z.min(x.hypot(y)),
        }
    })
}

/// A line that goes through a plane of space, within 30 degrees of its normal; a fifth of the points
/// are on the line. The strata of the truth are the plane and the two halves of the line.
pub fn line_through_plane(draw: &mut Draw) -> Instance {
    line_and_plane(draw, |a| a)
}

/// A line that ends on a plane of space, within 30 degrees of its normal; a fifth of the points are on
/// the line. The strata of the truth are the plane and the line.
pub fn line_on_plane(draw: &mut Draw) -> Instance {
    line_and_plane(draw, |a| -a.abs())
}

/// A plane and a line whose points are at heights that `height` gives.
fn line_and_plane(draw: &mut Draw, height: impl Fn(f64) -> f64) -> Instance {
    let lean = draw.between(0.0, 0.5);
    pieces(draw, 3, 5, |k, [a, b]| {
        if k == 0 {
            let z = height(a);
            Placed {
                point: vec![lean * z, 0.0, z],
                stratum: 1 + u8::from(z > 0.0),
                margin: z.abs(),
            }
        } else {
            Placed {
                point: vec![a, b, 0.0],
                stratum: 0,
                margin: a.hypot(b),
            }
        }
    })
}

/// A curve of space by itself, a parabola that bends by up to 0.3 in a radius. Its points lie in pairs on both
/// sides of the center, so that their longest principal direction is the tangent there.
pub fn curve(draw: &mut Draw) -> Instance {
    let bend = draw.between(0.0, 0.3);
    draw.points -= draw.points % 2;
    let mut other = None;
    pieces(draw, 3, 1, |_, [x, _]| {
        let t = match other.take() {
            Some(t) => t,
            None => {
                other = Some(-x);
                x
            }
        };
        Placed {
            point: vec![t, bend * t * t, 0.0],
            stratum: 0,
            margin: 1.0,
        }
    })
}

#[cfg(test)]
mod tests;
