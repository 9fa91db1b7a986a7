//! The map of a disc that pinches: what a cross-cap is near its end.

use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// Number of terms: 1, v, u^2, u v, v^2, u^2 v, u v^2, v^3.
const TERMS: usize = 8;
/// Coordinates of their coefficients.
const UNKNOWNS: usize = 3 * TERMS;
/// Rounds of assigning parameters to the points and fitting the coefficients to them.
const ROUNDS: usize = 12;
/// Every so many rounds parameters are looked for from the start: a few points near the fold stay on the wrong
/// side of it otherwise, and draw the point 0.1 dl aside.
const AFRESH: usize = 4;
/// What the square of a distance along the sheet counts, 1 across it. With 1 for both the place of the point
/// was 0.1 to 0.4 dl off after as many rounds, with this less than 0.02 on an exact sheet.
const ALONG: f64 = 0.04;
/// Keeps coefficients where the points say nothing, as a share of the trace.
const RIDGE: f64 = 1e-12;
/// Steps towards the nearest place in every round.
const STEPS: usize = 4;
/// Steps in the end.
const LAST_STEPS: usize = 12;
/// Assignments of the principal axes that are tried, the best by the umbrella's equation.
const STARTS: usize = 2;
/// The equation puts the pinch point within this many radii of the middle, or does not start anything.
const START_REACH: f64 = 1.5;

/// A map (u, v) into space, phi = c + v A + u^2 B + u v C + v^2 D + u^2 v E + u v^2 F + v^3 G.
///
/// It takes (u, 0) and (-u, 0) to the same place: the double curve is the image of v = 0, and c its end.
/// Up to smooth changes of (u, v) and of space this is Whitney's umbrella (u v, v, u^2), whatever the higher
/// terms are, as long as A, B, C are independent.
///
/// **Fit.** In axes along A, B, C the umbrella is the surface z^2 = x^2 y / l, with its natural length l. For a
/// pinch point at height y0 it is linear in 1 / l and y0 / l: each assignment of the principal axes
/// of the points to x, y, z is tried, and the best two start. Then parameters are assigned to the points
/// (the nearest place, by damped Newton steps) and coefficients fitted to them by least squares, in turn, with the
/// distances across the sheet weighing most (Wang, Pottmann, Liu 2006, section 3: tangent distance minimization).
#[derive(Clone, Debug)]
pub(super) struct PinchMap {
    coefficients: [Vector3<f64>; TERMS],
    /// The fold is at u = tilt times v.
    tilt: f64,
}

fn terms([u, v]: [f64; 2]) -> SVector<f64, TERMS> {
    let (uu, uv, vv) = (u * u, u * v, v * v);
    SVector::from([1.0, v, uu, uv, vv, uu * v, u * vv, vv * v])
}

/// An assignment of axes.
struct Start {
    /// Share of the squares that the equation leaves.
    rest: f64,
    map: PinchMap,
}

impl PinchMap {
    /// Number of free parameters: 3 for each term, but for the changes of (u, v) that keep the form.
    pub(super) const PARAMETERS: usize = 3 * TERMS - 3;

    /// The map that the points follow best, and the mean of the squared distances. `None` where there is none of
    /// the form near them.
    ///
    /// O(k) for k points, with some two thousand operations each.
    pub(super) fn fit(points: &[Vector3<f64>], radius: f64) -> Option<(Self, f64)> {
        let mut best: Option<(Self, f64)> = None;
        for start in starts(points, radius).into_iter().take(STARTS) {
            let Some((map, square)) = start.map.settled(points) else {
                continue;
            };
            if best.as_ref().is_none_or(|b| square < b.1) {
                best = Some((map, square));
            }
        }
        best
    }

    /// Place of parameters.
    pub(super) fn at(&self, parameters: [f64; 2]) -> Vector3<f64> {
        let terms = terms(parameters);
        (self.coefficients.iter().zip(terms.iter()))
            .map(|(c, t)| c * *t)
            .sum()
    }

    /// The pinch point.
    pub(super) fn point(&self) -> Vector3<f64> {
        self.coefficients[0]
    }

    /// Place on the double curve nearest to `x`.
    pub(super) fn on_double(&self, x: &Vector3<f64>) -> Vector3<f64> {
        let b = self.coefficients[2];
        let along = b.dot(&(x - self.point())) / b.norm_squared();
        self.point() + b * along.max(0.0)
    }

    /// How far parameters are off the fold, in u.
    pub(super) fn off_fold(&self, [u, v]: [f64; 2]) -> f64 {
        u - self.tilt * v
    }

    /// Place on the fold.
    pub(super) fn on_fold(&self, v: f64) -> Vector3<f64> {
        self.at([self.tilt * v, v])
    }

    /// Angle of parameters about the pinch point, 0 on the double curve: in units in which the first terms in u
    /// and v are as long as each other.
    pub(super) fn angle(&self, [u, v]: [f64; 2]) -> f64 {
        let u = self.off_fold([u, v]);
        // Both halves of the double curve are at angle 0 and half a turn.
        let along = self.coefficients[2].norm() * u * u.abs();
        let across = self.coefficients[1].norm() * v;
        libm::atan2(across, along)
    }

    /// The length l of z^2 = x^2 y / l; `None` where the leading coefficients are dependent.
    pub(super) fn natural_length(&self) -> Option<f64> {
        let [_, a, b, c, ..] = self.coefficients;
        let (x, y) = (a.normalize(), b.normalize());
        let normal = x.cross(&y);
        let sine = normal.norm();
        let out = normal.dot(&c) / sine;
        let length = a.norm_squared() * b.norm() / (out * out);
        (sine > 0.0 && length.is_finite()).then_some(length)
    }

    /// Parameters of the nearest place.
    pub(super) fn foot(&self, x: &Vector3<f64>) -> [f64; 2] {
        let [_, a, b, ..] = self.coefficients;
        let d = x - self.point();
        let v = a.dot(&d) / a.norm_squared();
        let u = (b.dot(&d) / b.norm_squared()).max(0.0).sqrt();
        nearest(&[u, -u, 0.0].map(|u| self.descend(x, [u, v], LAST_STEPS)))
    }

    /// Damped Newton steps of Gauss towards the nearest place; parameters and squared distance.
    fn descend(&self, x: &Vector3<f64>, start: [f64; 2], steps: usize) -> ([f64; 2], f64) {
        let mut at = start;
        let mut rest = x - self.at(at);
        let mut square = rest.norm_squared();
        let mut damping = 1e-6;
        for _ in 0..steps {
            let [u, v] = at;
            let [by_u, by_v] = self.tangents(at);
            // Where u has no effect it stays.
            let floor = 1e-12 * (by_u.norm_squared() + by_v.norm_squared()) + f64::MIN_POSITIVE;
            let uu = by_u.norm_squared() * (1.0 + damping) + floor;
            let vv = by_v.norm_squared() * (1.0 + damping) + floor;
            let uv = by_u.dot(&by_v);
            let (p, q) = (by_u.dot(&rest), by_v.dot(&rest));
            let determinant = uu * vv - uv * uv;
            let next = [
                u + (vv * p - uv * q) / determinant,
                v + (uu * q - uv * p) / determinant,
            ];
            let left = x - self.at(next);
            let reached = left.norm_squared();
            if reached < square {
                (at, rest, square) = (next, left, reached);
                damping *= 0.2;
            } else {
                damping = damping * 20.0 + 1e-3;
            }
        }
        (at, square)
    }

    /// Derivatives by u and by v.
    fn tangents(&self, [u, v]: [f64; 2]) -> [Vector3<f64>; 2] {
        let [_, a, b, c, d, e, f, g] = self.coefficients;
        [
            b * (2.0 * u) + c * v + e * (2.0 * u * v) + f * (v * v),
            a + c * u + d * (2.0 * v) + e * (u * u) + f * (2.0 * u * v) + g * (3.0 * v * v),
        ]
    }

    /// Coefficients fitted to points of given parameters. Distances along the sheet count little: parameters
    /// make up for them, and where they do not have to be kept the steps are those of Newton.
    fn improve(&mut self, points: &[Vector3<f64>], parameters: &[[f64; 2]]) -> Option<()> {
        let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
        let mut right = SVector::<f64, UNKNOWNS>::zeros();
        for (x, &at) in points.iter().zip(parameters) {
            let [by_u, by_v] = self.tangents(at);
            let across = by_u.cross(&by_v);
            let square = across.norm_squared();
            let mut weights = Matrix3::identity() * ALONG;
            if square > 0.0 {
                weights += across * across.transpose() * ((1.0 - ALONG) / square);
            }
            let row = terms(at);
            let pull = weights * x;
            for i in 0..TERMS {
                for k in 0..3 {
                    right[3 * i + k] += row[i] * pull[k];
                }
                for j in 0..=i {
                    let both = row[i] * row[j];
                    for k in 0..3 {
                        for l in 0..3 {
                            normal[(3 * i + k, 3 * j + l)] += both * weights[(k, l)];
                        }
                    }
                }
            }
        }
        let ridge = RIDGE * normal.trace();
        for k in 0..UNKNOWNS {
            normal[(k, k)] += ridge;
        }
        // The factorization reads the lower triangle.
        let solution = normal.cholesky()?.solve(&right);
        for (k, c) in self.coefficients.iter_mut().enumerate() {
            *c = solution.fixed_rows::<3>(3 * k).into_owned();
        }
        Some(())
    }

    /// Parameters and coefficients fitted in turn.
    fn settled(mut self, points: &[Vector3<f64>]) -> Option<(Self, f64)> {
        let mut parameters: Vec<[f64; 2]> = points.iter().map(|x| self.foot(x)).collect();
        for round in 1..=ROUNDS {
            for (at, x) in parameters.iter_mut().zip(points) {
                let [u, v] = *at;
                let mut found = [u, -u, 0.5 * u, u].map(|u| ([u, v], f64::INFINITY));
                for (at, square) in &mut found[..3] {
                    (*at, *square) = self.descend(x, *at, STEPS);
                }
                if round % AFRESH == 0 {
                    let anew = self.foot(x);
                    found[3] = (anew, (self.at(anew) - x).norm_squared());
                }
                *at = nearest(&found);
            }
            self.improve(points, &parameters)?;
        }
        let [_, _, b, c, ..] = self.coefficients;
        // u may be measured from any line u = t v; the fold is where the part of C along B vanishes.
        self.tilt = -b.dot(&c) / (2.0 * b.norm_squared());
        if !self.tilt.is_finite() {
            return None;
        }
        let sum: f64 = (points.iter().zip(&parameters))
            .map(|(x, &at)| self.descend(x, at, STEPS).1)
            .sum();
        Some((self, sum / points.len() as f64))
    }
}

/// Parameters of the least distance.
fn nearest(found: &[([f64; 2], f64)]) -> [f64; 2] {
    let mut best = found[0];
    for other in &found[1..] {
        if other.1 < best.1 {
            best = *other;
        }
    }
    best.0
}

/// The umbrella in every assignment of the principal axes, that which leaves least of the squares first.
fn starts(points: &[Vector3<f64>], radius: f64) -> Vec<Start> {
    let count = points.len().max(1) as f64;
    let mean = points.iter().sum::<Vector3<f64>>() / count;
    let spread: Matrix3<f64> = points
        .iter()
        .map(|x| (x - mean) * (x - mean).transpose())
        .sum();
    let axes = SymmetricEigen::new(spread).eigenvectors;
    let mut all = Vec::new();
    for (across, along) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
        let x: Vector3<f64> = axes.column(across).into();
        let y: Vector3<f64> = axes.column(along).into();
        let z = y.cross(&x);
        // z^2 = g x^2 y + h x^2 in units of the radius.
        let (mut gg, mut gh, mut hh, mut gz, mut hz, mut zz) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for p in points {
            let d = (p - mean) / radius;
            let (s, t) = (x.dot(&d).powi(2), z.dot(&d).powi(2));
            let first = s * y.dot(&d);
            gg += first * first;
            gh += first * s;
            hh += s * s;
            gz += first * t;
            hz += s * t;
            zz += t * t;
        }
        let determinant = gg * hh - gh * gh;
        if determinant <= 1e-12 * gg * hh || zz <= 0.0 {
            continue;
        }
        let (g, h) = (
            (gz * hh - hz * gh) / determinant,
            (hz * gg - gz * gh) / determinant,
        );
        let rest = 1.0 - (g * gz + h * hz) / zz;
        let height = -h / g;
        if g == 0.0 || height.abs() > START_REACH {
            continue;
        }
        let mut coefficients = [Vector3::zeros(); TERMS];
        coefficients[0] = mean + y * (height * radius);
        coefficients[1] = x * radius;
        coefficients[2] = y * (radius * g.signum());
        coefficients[3] = z * (radius * g.abs().sqrt());
        let map = PinchMap {
            coefficients,
            tilt: 0.0,
        };
        all.push(Start { rest, map });
    }
    all.sort_by(|a, b| a.rest.total_cmp(&b.rest));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places of a bent umbrella in a turned frame, u and v in -1..1.
    fn umbrella(length: f64) -> Vec<Vector3<f64>> {
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.8, 1.1);
        let grid = || (0..18).map(|k| f64::from(k) / 8.5 - 1.0);
        grid()
            .flat_map(|u| grid().map(move |v| (u, v)))
            .map(|(u, v)| {
                let x = Vector3::new(v, u * u + 0.2 * v * v, u * v / length.sqrt());
                turn * x + Vector3::new(0.1, 0.2, -0.3)
            })
            .filter(|x| (x - Vector3::new(0.1, 0.2, -0.3)).norm() < 0.8)
            .collect()
    }

    #[test]
    fn finds_the_point_of_a_bent_umbrella() {
        for length in [0.8, 2.0, 10.0] {
            let points = umbrella(length);
            let (map, square) = PinchMap::fit(&points, 0.8).unwrap();
            assert!(square.sqrt() < 1e-3, "{length}: {square:e}");
            let off = (map.point() - Vector3::new(0.1, 0.2, -0.3)).norm();
            assert!(off < 0.01, "{length}: {off}");
            let found = map.natural_length().unwrap();
            assert!((found / length - 1.0).abs() < 0.1, "{length}: {found}");
            for x in &points {
                let place = map.at(map.foot(x));
                assert!((place - x).norm() < 5e-3, "{length}");
            }
        }
    }

    #[test]
    fn one_plane_starts_nothing() {
        let flat: Vec<_> = (0..100)
            .map(|k| Vector3::new(f64::from(k % 10), f64::from(k / 10), 0.0))
            .collect();
        assert!(PinchMap::fit(&flat, 5.0).is_none());
    }
}
