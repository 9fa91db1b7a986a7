//! The conformations as a graph over the tangent plane at one of them.

use super::conformations::RingConformations;
use nalgebra::DVector;

/// The surface as a graph over the tangent plane at one of its places.
pub(super) struct Chart {
    pub center: Vec<f64>,
    pub tangent: [Vec<f64>; 2],
    /// Second derivatives of the graph: coefficients of a^2, ab, b^2.
    bend: [Vec<f64>; 3],
    /// For each fixed distance the direction, in the normal space, that changes it and no other one.
    normal_step: Vec<Vec<f64>>,
    /// Radius of its disc, in units of that of the largest discs: 1, or a power of 1/2 where the surface is bent more.
    pub scale: f64,
    /// Bound on what the second-order approximation leaves, per cubed distance.
    third_order: f64,
}

/// Bound, per cubed distance and squared bond length, of what the second-order approximation leaves; another sheet
/// that is nearer than that counts as the same one.
const THIRD_ORDER: f64 = 28.0;

/// How often the disc of a chart may be halved.
const HALVINGS: i32 = 4;
/// Places on the rim of a disc at which its chart is tried.
const RIM: u8 = 12;

/// What a lift works on.
pub(super) struct Scratch {
    pub place: Vec<f64>,
    pub guess: Vec<f64>,
    next: Vec<f64>,
    residual: Vec<f64>,
    next_residual: Vec<f64>,
}

impl Scratch {
    pub fn new(ring: &RingConformations) -> Self {
        let (n, fixed) = (ring.fixed.coordinates(), ring.fixed.pairs.len());
        Self {
            place: vec![0.0; n],
            guess: vec![0.0; n],
            next: vec![0.0; n],
            residual: vec![0.0; fixed],
            next_residual: vec![0.0; fixed],
        }
    }
}

fn add(to: &mut [f64], factor: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(x, y)| *x += factor * y);
}

#[inline]
pub(super) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    squared_distance(a, b).sqrt()
}

/// A chart covers nothing farther from its center than this times the radius asked for.
pub(super) const COVER: f64 = 1.25;

impl Chart {
    /// The chart at a place of the surface; `None` where the fixed distances depend on each other, as they do where
    /// two sheets cross.
    pub fn at(ring: &RingConformations, center: Vec<f64>) -> Option<Self> {
        let slice = &ring.position.slice;
        let jacobian = ring.fixed.jacobian(&center) * slice;
        let eigen = (jacobian.transpose() * &jacobian).symmetric_eigen();
        let size = eigen.eigenvalues.len();
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        // Third smallest singular value against the largest: its zeros are the double curves.
        let largest = eigen.eigenvalues[order[size - 1]];
        let third = eigen.eigenvalues[order[2]];
        if third.is_nan() || third <= 1e-9 * largest {
            return None;
        }
        let column = |v: DVector<f64>| v.as_slice().to_vec();
        let tangent = [0, 1].map(|k| column(slice * eigen.eigenvectors.column(order[k])));
        let inverse = (&jacobian * jacobian.transpose()).cholesky()?.inverse();
        let step = slice * (jacobian.transpose() * inverse);
        let normal_step: Vec<Vec<f64>> = step
            .column_iter()
            .map(|c| c.iter().copied().collect())
            .collect();
        let [t, u] = &tangent;
        let bend = [(t, t, 1.0), (t, u, 2.0), (u, u, 1.0)].map(|(v, w, factor)| {
            let mut bend = vec![0.0; center.len()];
            for (r, step) in ring.fixed.polar(v, w).into_iter().zip(&normal_step) {
                add(&mut bend, -factor * r, step);
            }
            bend
        });
        Some(Self {
            center,
            tangent,
            bend,
            normal_step,
            scale: 1.0,
            third_order: THIRD_ORDER / ring.fixed.scale.powi(2),
        })
    }

    /// Makes the disc smaller until the surface over it and a little beyond is a graph that the chart follows; false when
    /// the smallest is still too large. The places around the rim of a disc of `radius` are tried.
    pub fn fit(&mut self, ring: &RingConformations, radius: f64, scratch: &mut Scratch) -> bool {
        for halvings in 0..=HALVINGS {
            self.scale = 0.5f64.powi(halvings);
            // What is bent more strongly looks the same at its own scale.
            self.third_order = THIRD_ORDER / (ring.fixed.scale * self.scale).powi(2);
            let reach = 1.1 * self.scale * radius;
            let good = (0..RIM).all(|k| {
                let (s, c) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(RIM));
                self.lift(ring, [reach * c, reach * s], scratch)
            });
            if good {
                return true;
            }
        }
        false
    }

    pub fn coordinates(&self, place: &[f64]) -> [f64; 2] {
        let mut at = [0.0; 2];
        let [t, u] = &self.tangent;
        for (((x, c), t), u) in place.iter().zip(&self.center).zip(t).zip(u) {
            let from = x - c;
            at[0] += from * t;
            at[1] += from * u;
        }
        at
    }

    /// Second-order approximation of the graph.
    fn guess(&self, [a, b]: [f64; 2], out: &mut [f64]) {
        let ([t, u], [p, q, r]) = (&self.tangent, &self.bend);
        let (aa, ab, bb) = (a * a, a * b, b * b);
        for (k, x) in out.iter_mut().enumerate() {
            *x = self.center[k] + a * t[k] + b * u[k] + aa * p[k] + ab * q[k] + bb * r[k];
        }
    }

    /// How far the graph may be from the guess at coordinates.
    fn slack(&self, [a, b]: [f64; 2]) -> f64 {
        let square = a * a + b * b;
        self.third_order * square * square.sqrt() + 1e-7
    }

    /// Whether a place of the surface is on the sheet of this chart, within `radius` (for a disc of full size) of its
    /// center in coordinates.
    pub fn covers(&self, place: &[f64], radius: f64, scratch: &mut [f64]) -> bool {
        let radius = self.scale * radius;
        if squared_distance(place, &self.center) > (COVER * radius).powi(2) {
            return false;
        }
        let at = self.coordinates(place);
        let square = at[0] * at[0] + at[1] * at[1];
        square < radius * radius && {
            self.guess(at, scratch);
            distance(place, scratch) <= self.slack(at)
        }
    }

    /// The place of the surface over coordinates, into `scratch.place`: steps with the chart's own derivative while they
    /// at least halve the residual, then Newton steps within the normal space. `false` when they do not settle on
    /// this sheet.
    pub fn lift(&self, ring: &RingConformations, at: [f64; 2], scratch: &mut Scratch) -> bool {
        let tolerance = 1e-12 * ring.fixed.scale.powi(2);
        self.guess(at, &mut scratch.guess);
        scratch.place.copy_from_slice(&scratch.guess);
        let mut size = ring.fixed.residual(&scratch.place, &mut scratch.residual);
        let mut newton = false;
        for _ in 0..40 {
            if size < tolerance {
                // Farther than the third order allows: the solver has changed sheets.
                return distance(&scratch.place, &scratch.guess) <= self.slack(at);
            }
            scratch.next.copy_from_slice(&scratch.place);
            if newton {
                let jacobian = ring.fixed.jacobian(&scratch.place);
                let fixed = self.normal_step.len();
                let matrix = nalgebra::DMatrix::from_fn(fixed, fixed, |i, j| {
                    let step = self.normal_step[j].iter();
                    jacobian.row(i).iter().zip(step).map(|(x, y)| x * y).sum()
                });
                let Some(weights) = matrix
                    .lu()
                    .solve(&DVector::from_column_slice(&scratch.residual))
                else {
                    return false;
                };
                for (&w, step) in weights.iter().zip(&self.normal_step) {
                    add(&mut scratch.next, -w, step);
                }
            } else {
                for (&r, step) in scratch.residual.iter().zip(&self.normal_step) {
                    add(&mut scratch.next, -r, step);
                }
            }
            let new = ring
                .fixed
                .residual(&scratch.next, &mut scratch.next_residual);
            if new < 0.5 * size || (newton && new < size) {
                std::mem::swap(&mut scratch.place, &mut scratch.next);
                std::mem::swap(&mut scratch.residual, &mut scratch.next_residual);
                size = new;
            } else if newton {
                return false;
            } else {
                newton = true;
            }
        }
        false
    }
}
