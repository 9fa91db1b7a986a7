//! Two sheets that cross in a curve.

use super::one_fit::{OneFit, located};
use super::patch::{PATCH_POINTS, QuadraticPatch};
use super::plane_pair::PlanePair;
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::TwoPlanesTuning;
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Located, Rejection, SingularityModel, Stratum,
};
use nalgebra::{Matrix2, Vector2, Vector3};

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
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        let mut planes = PlanePair::direct(points.iter().copied(), local.radius)?;
        if self.refinement_rounds > 0 {
            let refined = planes.refined(points.iter().copied(), self.refinement_rounds);
            planes = refined.0;
        }
        let line = planes.line(&all[local.center]);
        let (tangent, origin) = line.ok_or(Rejection::NoRealSolution)?;
        // The plane itself, through the line.
        let sheets = planes
            .normals
            .map(|normal| QuadraticPatch::plane(origin, [tangent, normal.cross(&tangent), normal]));
        let patches = Patches::fit(sheets, &all, count, self.curved.then_some(local.radius));
        let cells = patches.cells(count, self.tolerance.ep);
        let residual = self.tolerance.residual(cells.sum, count)?;
        self.holds(&cells, count, residual)?;
        for (own, normal) in planes.normals.iter().enumerate() {
            let across = normal.cross(&tangent);
            let own = (0..count)
                .filter(|&k| cells.labels[k] != 0 && patches.nearer(k) == own)
                .map(|k| points[k]);
            if narrowness(own, &tangent, &across) < self.tuning.narrowness {
                return Err(Rejection::NoRealSolution);
            }
        }
        Ok(Sheets {
            tuning: self.tuning,
            ep: self.tolerance.ep,
            radius: local.radius,
            fitted: count,
            sheets: patches.sheets,
            labels: cells.labels,
            all,
            residual,
        })
    }

    /// Whether few points are astray, and the cells hold enough.
    fn holds(&self, cells: &CellsHeld, count: usize, residual: f64) -> Result<(), Rejection> {
        let CellsHeld { astray, held, .. } = cells;
        if self.curved && *astray as f64 > self.tuning.astray * count as f64 {
            return Err(Rejection::PoorFit {
                residual,
                limit: self.tolerance.ep,
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
        match short {
            Some(stratum) => Err(Rejection::EmptyStratum {
                stratum,
                found: held[stratum],
            }),
            None => Ok(()),
        }
    }
}

/// A patch a sheet, with the signed distances of all points from both.
struct Patches {
    sheets: [QuadraticPatch; 2],
    distances: [Vec<f64>; 2],
}

/// The points by cell.
struct CellsHeld {
    labels: Vec<u8>,
    /// Fitted points of every label.
    held: [usize; 5],
    /// Fitted points farther than ep from both sheets.
    astray: usize,
    /// Squared distances of the fitted points from the nearer sheet.
    sum: f64,
}

impl Patches {
    /// The sheets, bent to the first `count` points where a radius is given: three rounds of hard reassignment.
    fn fit(
        sheets: [QuadraticPatch; 2],
        all: &[Vector3<f64>],
        count: usize,
        bent: Option<f64>,
    ) -> Self {
        let columns = [0, 1, 2].map(|axis| all.iter().map(|x| x[axis]).collect::<Vec<f64>>());
        let columns = columns.each_ref().map(Vec::as_slice);
        let mut out = Self {
            sheets,
            distances: [vec![0.0; all.len()], vec![0.0; all.len()]],
        };
        // Only the fitted rows matter until the patches are final.
        let first = columns.map(|c| &c[..count]);
        if let Some(radius) = bent {
            for _ in 0..3 {
                for (patch, out) in out.sheets.iter().zip(&mut out.distances) {
                    patch.signed_distances(first, &mut out[..count]);
                }
                for own in 0..2 {
                    let points = (all[..count].iter().enumerate())
                        .filter(|&(k, _)| nearer(&out.distances, k) == own)
                        .map(|(_, x)| *x);
                    out.sheets[own].fit(points, radius);
                }
            }
        }
        for (patch, out) in out.sheets.iter().zip(&mut out.distances) {
            patch.signed_distances(columns, out);
        }
        out
    }

    /// The sheet that a point is nearer to.
    fn nearer(&self, k: usize) -> usize {
        nearer(&self.distances, k)
    }

    /// Labels all points, and counts the first `count` of them.
    fn cells(&self, count: usize, ep: f64) -> CellsHeld {
        let mut cells = CellsHeld {
            labels: vec![0; self.distances[0].len()],
            held: [0; 5],
            astray: 0,
            sum: 0.0,
        };
        for (k, label) in cells.labels.iter_mut().enumerate() {
            let sheet = self.nearer(k);
            let (own, other) = (self.distances[sheet][k], self.distances[1 - sheet][k]);
            // Cells in cyclic order around the curve: 1, 2, 3, 4.
            let cell = match (sheet, other >= 0.0) {
                (0, true) => 1,
                (1, true) => 2,
                (0, false) => 3,
                _ => 4,
            };
            let on_curve = own.abs() < ep && other.abs() < ep;
            *label = if on_curve { 0 } else { cell };
            if k < count {
                cells.sum += own * own;
                cells.astray += usize::from(own.abs() > ep);
                cells.held[*label as usize] += 1;
            }
        }
        cells
    }
}

/// The sheet that a point is nearer to, by its distances from both.
fn nearer(distances: &[Vec<f64>; 2], k: usize) -> usize {
    usize::from(distances[1][k].abs() < distances[0][k].abs())
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

impl OneFit for Sheets {
    fn located(&self, row: usize) -> Option<Located> {
        let x = self.all[row];
        let singular = self.labels[row] == 0;
        let (points, labels) = (&self.all[..self.fitted], &self.labels[..self.fitted]);
        let tuning = &self.tuning;
        let place = meet(&self.sheets, x, tuning.step * self.radius, tuning.sine)
            .filter(|place| singular || (place - x).norm() < tuning.witness * self.ep)
            .filter(|place| supported(place, points, labels, tuning.support * self.radius));
        if singular && place.is_none() {
            return None;
        }
        Some(located(x, if singular { 1 } else { 2 }, 4, place))
    }

    fn decomposition(self, center: Located) -> Decomposition {
        Decomposition {
            strata: [1, 2, 2, 2, 2]
                .map(|dimension| Stratum { dimension })
                .to_vec(),
            cells_at_curve: vec![4],
            residual: self.residual,
            parameters: 16,
            points: Vec::new(),
            center: center.place,
            center_offset: center.offset,
            labels: self.labels.into_iter().map(Label::from).collect(),
        }
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
        self.fit(local)?.about(local.center, rows)
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
