//! Two sheets that cross in a curve: the quadric that factors into two planes.

use super::patch::{PATCH_POINTS, QuadraticPatch};
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::TwoPlanesTuning;
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Located, Rejection, SingularityModel, Stratum,
};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3, Vector4};

/// Two planes `n_k . x + c_k = 0` of space with unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePair {
    /// Unit normals.
    pub normals: [Vector3<f64>; 2],
    /// Offsets.
    pub offsets: [f64; 2],
}

impl PlanePair {
    /// Direct estimate (Martin & Watson 2011, section 2.2): the quadric of least algebraic
    /// residual, brought to rank 2, factored. `scale` is a length typical of the points
    /// (conditioning only).
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] when the two leading eigenvalues of its quadratic part have
    /// the same sign: two complex planes.
    pub fn direct(
        points: impl Iterator<Item = Vector3<f64>>,
        scale: f64,
    ) -> Result<Self, Rejection> {
        // Sums of x^i y^j z^k up to degree 4, from which the normal matrix is read.
        let mut sums = [0.0; POWERS];
        let inverse = 1.0 / scale;
        for x in points {
            let [x, y, z] = [x.x * inverse, x.y * inverse, x.z * inverse];
            let second = [x * x, x * y, x * z, y * y, y * z, z * z];
            let [xx, xy, xz, yy, yz, zz] = second;
            let powers = [
                1.0,
                x,
                y,
                z,
                xx,
                xy,
                xz,
                yy,
                yz,
                zz,
                xx * x,
                xx * y,
                xx * z,
                xy * y,
                xy * z,
                xz * z,
                yy * y,
                yy * z,
                yz * z,
                zz * z,
                xx * xx,
                xx * xy,
                xx * xz,
                xx * yy,
                xx * yz,
                xx * zz,
                xy * yy,
                xy * yz,
                xy * zz,
                xz * zz,
                yy * yy,
                yy * yz,
                yy * zz,
                yz * zz,
                zz * zz,
            ];
            for (s, p) in sums.iter_mut().zip(&powers) {
                *s += p;
            }
        }
        let normal = SMatrix::<f64, 10, 10>::from_fn(|p, q| {
            let ((u, e), (v, f)) = (ENTRIES[p], ENTRIES[q]);
            let exponents = [e[0] + f[0], e[1] + f[1], e[2] + f[2]];
            u * v * sums[position(exponents)]
        });
        let eigen = normal.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let a = eigen.eigenvectors.column(least);
        let quadratic = Matrix3::new(a[0], a[1], a[2], a[1], a[4], a[5], a[2], a[5], a[7]);
        let size = quadratic.norm();
        if size < 1e-12 {
            return Err(Rejection::NoRealSolution);
        }
        let quadratic = quadratic / size;
        let linear = Vector3::new(a[3], a[6], a[8]) / size;
        let parts = quadratic.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| {
            parts.eigenvalues[j]
                .abs()
                .total_cmp(&parts.eigenvalues[i].abs())
        });
        let (mut l1, mut l2) = (parts.eigenvalues[order[0]], parts.eigenvalues[order[1]]);
        let mut p1: Vector3<f64> = parts.eigenvectors.column(order[0]).into();
        let mut p2: Vector3<f64> = parts.eigenvectors.column(order[1]).into();
        if l1 * l2 >= 0.0 {
            return Err(Rejection::NoRealSolution);
        }
        if l1 < 0.0 {
            std::mem::swap(&mut l1, &mut l2);
            std::mem::swap(&mut p1, &mut p2);
        }
        // Least squares of [l1 p1, l2 p2](r, s) = linear; p1, p2 are orthonormal.
        let (r, s) = (p1.dot(&linear) / l1, p2.dot(&linear) / l2);
        let (u, v) = (l1.sqrt(), (-l2).sqrt());
        let plane = |sign: f64| {
            let normal = p1 * u + p2 * (sign * v);
            let length = normal.norm();
            (normal / length, (r * u + sign * s * v) / length * scale)
        };
        let ((n1, c1), (n2, c2)) = (plane(1.0), plane(-1.0));
        Ok(Self {
            normals: [n1, n2],
            offsets: [c1, c2],
        })
    }

    /// Refinement by the paper's equation (5): minimizes the sum of squares of the product of the two
    /// plane functions over pairs of planes (unit normals, real by construction), by
    /// Gauss-Newton with damping from this pair on. Returns the pair reached and its sum of squares.
    pub fn refined(
        self,
        points: impl Iterator<Item = Vector3<f64>> + Clone,
        rounds: usize,
    ) -> (Self, f64) {
        let cost = |pair: &Self| -> f64 {
            points
                .clone()
                .map(|x| (pair.distance(0, &x) * pair.distance(1, &x)).powi(2))
                .sum()
        };
        let mut best = self;
        let mut value = cost(&best);
        let mut damping = 1e-3;
        for _ in 0..rounds {
            let mut normal = SMatrix::<f64, 8, 8>::zeros();
            let mut right = SVector::<f64, 8>::zeros();
            for x in points.clone() {
                let (f, g) = (best.distance(0, &x), best.distance(1, &x));
                let row = SVector::<f64, 8>::from([
                    g * x.x,
                    g * x.y,
                    g * x.z,
                    g,
                    f * x.x,
                    f * x.y,
                    f * x.z,
                    f,
                ]);
                normal.ger(1.0, &row, &row, 1.0);
                right.axpy(-f * g, &row, 1.0);
            }
            let lift = damping * normal.trace() / 8.0 + f64::MIN_POSITIVE;
            for k in 0..8 {
                normal[(k, k)] += lift;
            }
            let Some(step) = normal.cholesky().map(|c| c.solve(&right)) else {
                break;
            };
            let moved = |k: usize| {
                let q = Vector4::new(
                    best.normals[k].x,
                    best.normals[k].y,
                    best.normals[k].z,
                    best.offsets[k],
                ) + step.fixed_rows::<4>(4 * k);
                let length = q.xyz().norm();
                (q.xyz() / length, q.w / length)
            };
            let ((n1, c1), (n2, c2)) = (moved(0), moved(1));
            let next = Self {
                normals: [n1, n2],
                offsets: [c1, c2],
            };
            let reached = cost(&next);
            if reached < value {
                let done = reached > value * (1.0 - 1e-10);
                (best, value) = (next, reached);
                damping = (damping * 0.2).max(1e-12);
                if done {
                    break;
                }
            } else {
                damping *= 8.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        (best, value)
    }

    /// Signed distance of `x` from plane `k`.
    pub fn distance(&self, k: usize, x: &Vector3<f64>) -> f64 {
        self.normals[k].dot(x) + self.offsets[k]
    }

    /// Sine of the angle between the planes.
    pub fn sine(&self) -> f64 {
        self.normals[0].cross(&self.normals[1]).norm()
    }

    /// Unit direction of the line in which the planes meet and the point of it nearest to `x`;
    /// `None` for planes closer to parallel than about half a degree.
    pub fn line(&self, x: &Vector3<f64>) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let [n1, n2] = self.normals;
        let cosine = n1.dot(&n2);
        let square = 1.0 - cosine * cosine;
        if square < 1e-4 {
            return None;
        }
        let (f, g) = (self.distance(0, x), self.distance(1, x));
        let alpha = (f - cosine * g) / square;
        let beta = (g - cosine * f) / square;
        Some((n1.cross(&n2).normalize(), x - n1 * alpha - n2 * beta))
    }
}

/// Number of powers x^i y^j z^k up to degree 4.
const POWERS: usize = 35;

/// The entries of the paper's row of M: factor and exponents.
const ENTRIES: [(f64, [usize; 3]); 10] = [
    (1.0, [2, 0, 0]),
    (2.0, [1, 1, 0]),
    (2.0, [1, 0, 1]),
    (2.0, [1, 0, 0]),
    (1.0, [0, 2, 0]),
    (2.0, [0, 1, 1]),
    (2.0, [0, 1, 0]),
    (1.0, [0, 0, 2]),
    (2.0, [0, 0, 1]),
    (1.0, [0, 0, 0]),
];

/// Where x^i y^j z^k is among the powers: by degree, then by falling i, then by falling j.
const fn position([i, j, k]: [usize; 3]) -> usize {
    let degree = i + j + k;
    let before = degree * (degree + 1) * (degree + 2) / 6;
    let rest = j + k;
    before + rest * (rest + 1) / 2 + k
}

/// Two sheets that cross along a double curve.
///
/// The planes are the paper's quadric; from their labels one quadratic patch a sheet is
/// fitted (three rounds of hard reassignment), because a plane pair is off by the sag of
/// the sheets, about eps^2 / 4R, and its line by as much over the sine of the angle. The
/// center, when it is singular, is moved onto the curve in which the patches meet, by Newton's method.
#[derive(Clone, Copy, Debug)]
pub struct TwoPlanes {
    tolerance: Tolerance,
    tuning: TwoPlanesTuning,
    /// Rounds of the refinement by equation (5); 0 is the direct estimate alone.
    pub refinement_rounds: usize,
    /// Whether sheets are curved (quadratic patches) or the planes themselves, as in the paper.
    pub curved: bool,
}

impl TwoPlanes {
    /// Model with fit tolerance `dp` (root mean squared distance of the points to the nearer sheet,
    /// unit of the data) and curve tolerance `ep` (a point closer than this to both sheets is
    /// on the curve, unit of the data).
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: TwoPlanesTuning::MEASURED,
            refinement_rounds: 0,
            curved: true,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: TwoPlanesTuning) -> Self {
        Self { tuning, ..self }
    }

    /// Fits planes, then patches, and labels all points.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Sheets, Rejection> {
        let count = local.fitted;
        at_least(2 * PATCH_POINTS, local)?;
        let Tolerance { ep, .. } = self.tolerance;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        let mut planes = PlanePair::direct(points.iter().copied(), local.radius)?;
        if self.refinement_rounds > 0 {
            planes = planes
                .refined(points.iter().copied(), self.refinement_rounds)
                .0;
        }
        let center = all[local.center];
        let (tangent, origin) = planes.line(&center).ok_or(Rejection::NoRealSolution)?;
        // The plane itself, through the line.
        let mut sheets = planes
            .normals
            .map(|normal| QuadraticPatch::plane(origin, [tangent, normal.cross(&tangent), normal]));
        let columns = [0, 1, 2].map(|axis| all.iter().map(|x| x[axis]).collect::<Vec<f64>>());
        let columns = columns.each_ref().map(Vec::as_slice);
        let mut distances = [vec![0.0; all.len()], vec![0.0; all.len()]];
        let nearer = |d: &[Vec<f64>; 2], k: usize| usize::from(d[1][k].abs() < d[0][k].abs());
        // Only the fitted rows matter until the patches are final.
        let first = columns.map(|c| &c[..count]);
        if self.curved {
            for _ in 0..3 {
                for (patch, out) in sheets.iter().zip(&mut distances) {
                    patch.signed_distances(first, &mut out[..count]);
                }
                for (own, patch) in sheets.iter_mut().enumerate() {
                    let points = points
                        .iter()
                        .enumerate()
                        .filter(|&(k, _)| nearer(&distances, k) == own)
                        .map(|(_, x)| *x);
                    patch.fit(points, local.radius);
                }
            }
        }
        for (patch, out) in sheets.iter().zip(&mut distances) {
            patch.signed_distances(columns, out);
        }
        let mut labels = vec![0u8; all.len()];
        let mut sum = 0.0;
        let mut astray = 0usize;
        let mut held = [0usize; 5];
        for (k, label) in labels.iter_mut().enumerate() {
            let sheet = nearer(&distances, k);
            let (own, other) = (distances[sheet][k], distances[1 - sheet][k]);
            // Cells in cyclic order around the curve: 1, 2, 3, 4.
            let cell = match (sheet, other >= 0.0) {
                (0, true) => 1,
                (1, true) => 2,
                (0, false) => 3,
                _ => 4,
            };
            *label = if own.abs() < ep && other.abs() < ep {
                0
            } else {
                cell
            };
            if k < count {
                sum += own * own;
                astray += usize::from(own.abs() > ep);
                held[*label as usize] += 1;
            }
        }
        let residual = self.tolerance.residual(sum, count)?;
        if self.curved && astray as f64 > self.tuning.astray * count as f64 {
            return Err(Rejection::PoorFit {
                residual,
                limit: ep,
            });
        }
        let least = (self.tuning.cell_share * (count - held[0]) as f64).max(3.0);
        // One cell may hold less, where the sample has a hole; none may be empty.
        let mut cells = [1, 2, 3, 4];
        cells.sort_by_key(|&c| held[c]);
        let thin = |c: usize, least: f64| (held[c] as f64) < least;
        let short = if thin(cells[0], 1.0) {
            Some(cells[0])
        } else {
            thin(cells[1], least).then_some(cells[1])
        };
        if let Some(stratum) = short {
            return Err(Rejection::EmptyStratum {
                stratum,
                found: held[stratum],
            });
        }
        for (own, normal) in planes.normals.iter().enumerate() {
            let across = normal.cross(&tangent);
            let own = (0..count)
                .filter(|&k| labels[k] != 0 && nearer(&distances, k) == own)
                .map(|k| points[k]);
            if narrowness(own, &tangent, &across) < self.tuning.narrowness {
                return Err(Rejection::NoRealSolution);
            }
        }
        Ok(Sheets {
            tuning: self.tuning,
            ep,
            radius: local.radius,
            all,
            fitted: count,
            sheets,
            labels,
            residual,
        })
    }
}

/// Two sheets fitted to a neighborhood.
struct Sheets {
    tuning: TwoPlanesTuning,
    ep: f64,
    radius: f64,
    all: Vec<Vector3<f64>>,
    fitted: usize,
    sheets: [QuadraticPatch; 2],
    labels: Vec<u8>,
    residual: f64,
}

impl Sheets {
    /// Where a row is, `None` where it is in the band of the curve and no curve can be found.
    fn locate(&self, row: usize) -> Option<Located> {
        let x = self.all[row];
        let singular = self.labels[row] == 0;
        let (points, labels) = (&self.all[..self.fitted], &self.labels[..self.fitted]);
        let tuning = &self.tuning;
        let reached = meet(&self.sheets, x, tuning.step * self.radius, tuning.sine)
            .filter(|place| supported(place, points, labels, tuning.support * self.radius));
        let (place, offset) = match reached {
            Some(place) if singular || (place - x).norm() < tuning.witness * self.ep => {
                (place, (place - x).norm())
            }
            None if singular => return None,
            _ => (x, f64::INFINITY),
        };
        Some(Located {
            dimension: if singular { 1 } else { 2 },
            cells: 4,
            place: place.iter().copied().collect(),
            offset,
        })
    }
}

/// Variance of points of a plane across their main direction, as a share of that along it.
fn narrowness(
    points: impl Iterator<Item = Vector3<f64>>,
    first: &Vector3<f64>,
    second: &Vector3<f64>,
) -> f64 {
    let (mut count, mut mean, mut square) = (0.0, Vector2::zeros(), Matrix2::zeros());
    for x in points {
        let x = Vector2::new(first.dot(&x), second.dot(&x));
        count += 1.0;
        mean += x;
        square += x * x.transpose();
    }
    let spread = square / count - (mean / count) * (mean / count).transpose();
    let [low, high] = spread.symmetric_eigenvalues().into();
    low.min(high) / low.max(high)
}

/// Whether the data show a crossing at `place`: some point in the band and points of three
/// cells close by. Patches also cross where they are mere extrapolation; one cell may have a hole
/// in its sample there.
fn supported(place: &Vector3<f64>, points: &[Vector3<f64>], labels: &[u8], reach: f64) -> bool {
    let mut nearest = [f64::INFINITY; 5];
    for (x, &label) in points.iter().zip(labels) {
        let n = &mut nearest[label as usize];
        *n = n.min((x - place).norm());
    }
    let close = |d: &f64| *d < reach;
    close(&nearest[0]) && nearest[1..].iter().filter(|d| close(d)).count() >= 3
}

impl SingularityModel for TwoPlanes {
    fn local_dimension(&self) -> usize {
        3
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        let fit = self.fit(local)?;
        let center = fit.locate(local.center).ok_or(Rejection::NoRealSolution)?;
        let located = rows.iter().map(|&row| fit.locate(row)).collect();
        let decomposition = Decomposition {
            strata: std::iter::once(Stratum { dimension: 1 })
                .chain(std::iter::repeat_n(Stratum { dimension: 2 }, 4))
                .collect(),
            cells_at_curve: vec![4],
            residual: fit.residual,
            parameters: 16,
            points: Vec::new(),
            center: center.place,
            center_offset: center.offset,
            labels: fit.labels.into_iter().map(Label::from).collect(),
        };
        Ok((decomposition, located))
    }

    fn name(&self) -> &str {
        if self.refinement_rounds > 0 {
            "refined-two-planes"
        } else {
            "two-planes"
        }
    }
}

/// The point nearest to `start`, to first order, in which two patches meet: Newton with
/// steps of least norm. `None` when it wanders farther than `reach` or the patches meet at an angle with
/// a smaller sine there.
fn meet(
    sheets: &[QuadraticPatch; 2],
    start: Vector3<f64>,
    reach: f64,
    least_sine: f64,
) -> Option<Vector3<f64>> {
    let mut x = start;
    for _ in 0..12 {
        let (f, a) = sheets[0].height(&x);
        let (g, b) = sheets[1].height(&x);
        let (aa, ab, bb) = (a.dot(&a), a.dot(&b), b.dot(&b));
        let determinant = aa * bb - ab * ab;
        if determinant < least_sine * least_sine * aa * bb {
            return None;
        }
        let alpha = (f * bb - g * ab) / determinant;
        let beta = (g * aa - f * ab) / determinant;
        let step = a * alpha + b * beta;
        x -= step;
        if (x - start).norm() > reach {
            return None;
        }
        if step.norm() < 1e-12 * reach {
            break;
        }
    }
    Some(x)
}
