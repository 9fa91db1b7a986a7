//! Three sheets that end in one curve, as in soap films.

use super::flats::{Flat, candidates, greedy};
use super::one_fit::{OneFit, located};
use super::patch::PATCH_POINTS;
use super::sheets::Sheets;
use super::tolerance::{LEAST_HELD, Tolerance, at_least, vectors};
use super::vanishing::Vanishing;
use crate::tuning::YJunctionTuning;
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Located, Rejection, SingularityModel, Stratum,
};
use nalgebra::{Matrix3, Vector3};

/// Three half sheets of space on a common curve, at any angles: a Y-junction.
///
/// Half planes on a line lie in three planes through it, and these are those of the cubic that
/// vanishes on the points, read off its gradients (generalized principal component analysis; Vidal,
/// Ma, Sastry 2005). Which half of a plane is there is seen from its points. Each half plane
/// becomes a quadratic patch; the curve is where the patches meet.
#[derive(Clone, Copy, Debug)]
pub struct YJunction {
    tolerance: Tolerance,
    tuning: YJunctionTuning,
}

impl YJunction {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to two of the sheets is on the curve.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: YJunctionTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: YJunctionTuning) -> Self {
        Self { tuning, ..self }
    }
}

/// The line that three planes have in common, and the direction from it into each half plane.
struct Book {
    place: Vector3<f64>,
    pages: [Vector3<f64>; 3],
}

impl Book {
    /// `None` for planes that have no line in common, or of which both halves are there.
    fn of(
        planes: &[Flat<3>],
        points: &[Vector3<f64>],
        tolerance: f64,
        tuning: &YJunctionTuning,
    ) -> Option<Self> {
        let mut spread = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for plane in planes {
            let n = plane.normals[0];
            spread += n * n.transpose();
            right += n * n.dot(&plane.origin);
        }
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            let sine = planes[a].normals[0].cross(&planes[b].normals[0]).norm();
            if sine < tuning.sine {
                return None;
            }
        }
        let eigen = spread.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        if eigen.eigenvalues[least] > tuning.along {
            return None;
        }
        let along: Vector3<f64> = eigen.eigenvectors.column(least).into();
        let mut place = Vector3::zeros();
        for k in (0..3).filter(|&k| k != least) {
            let axis = eigen.eigenvectors.column(k);
            place += axis * (axis.dot(&right) / eigen.eigenvalues[k]);
        }
        let mut pages = [Vector3::zeros(); 3];
        for (k, plane) in planes.iter().enumerate() {
            let across = plane.normals[0].cross(&along).normalize();
            let (mut ahead, mut behind) = (0usize, 0usize);
            for x in points {
                let near = plane.squared_distance(x).sqrt();
                let side = across.dot(&(x - place));
                let alone = planes.iter().enumerate().all(|(j, p)| {
                    j == k || p.squared_distance(x).sqrt() > 2.0 * near.max(tolerance / 2.0)
                });
                if near < tolerance && alone {
                    if side > 0.0 {
                        ahead += 1;
                    } else {
                        behind += 1;
                    }
                }
            }
            if ahead.min(behind) as f64 > tuning.beyond * (ahead + behind) as f64 {
                return None;
            }
            pages[k] = if ahead >= behind { across } else { -across };
        }
        Some(Self { place, pages })
    }

    /// Distance of `x`, which is `d` from the patch of page `k`, from that half sheet.
    fn distance(&self, k: usize, d: f64, x: &Vector3<f64>) -> f64 {
        let from = x - self.place;
        let side = self.pages[k].dot(&from);
        if side >= 0.0 { d.abs() } else { d.hypot(side) }
    }
}

/// Three half sheets fitted to a neighborhood.
struct Fit {
    all: Vec<Vector3<f64>>,
    fitted: usize,
    sheets: Sheets,
    labels: Vec<u8>,
    residual: f64,
    /// How far a center is moved, how far from the junction the cells must have points, and from where on a point
    /// tells where the junction is.
    reach: [f64; 3],
    /// Least sine at which sheets meet.
    sine: f64,
}

impl YJunction {
    /// Fits three half sheets, and labels all points.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(3 * PATCH_POINTS, local)?;
        let count = local.fitted;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..count];
        let cubic = Vanishing::fit(points, 3, 1, local.radius).ok_or(Rejection::NoRealSolution)?;
        let found = candidates(points, |x, out| cubic.gradients(x, out));
        let (tuning, ep) = (&self.tuning, self.tolerance.ep);
        let tolerance = tuning.plane * local.radius;
        let planes = greedy(points, &found, 3, tolerance).ok_or(Rejection::NoRealSolution)?;
        let book = Book::of(&planes, points, tolerance, tuning).ok_or(Rejection::NoRealSolution)?;
        let sheets = Sheets::new(&planes, &all, count, local.radius, |k, d, x| {
            book.distance(k, d, x)
        });
        let mut labels = vec![0u8; all.len()];
        let mut held = [0usize; 4];
        let mut sum = 0.0;
        for (k, (x, label)) in all.iter().zip(&mut labels).enumerate() {
            let own = usize::from(sheets.owner[k]);
            let d = [0, 1, 2].map(|s| sheets.patches[s].signed_distance(x).abs());
            let on = d[own] < ep && (0..3).any(|s| s != own && d[s] < ep);
            *label = if on { 0 } else { 1 + own as u8 };
            if k < count {
                sum += book.distance(own, d[own], x).powi(2);
                held[usize::from(*label)] += 1;
            }
        }
        let residual = self.tolerance.residual(sum, count)?;
        if let Some(stratum) = (1..4).find(|&c| held[c] < LEAST_HELD) {
            return Err(Rejection::EmptyStratum {
                stratum,
                found: held[stratum],
            });
        }
        let radius = local.radius;
        Ok(Fit {
            all,
            fitted: count,
            sheets,
            labels,
            residual,
            sine: tuning.meet,
            reach: [
                tuning.step * radius,
                tuning.support * radius,
                tuning.witness * ep,
            ],
        })
    }
}

impl OneFit for Fit {
    fn located(&self, row: usize) -> Option<Located> {
        let [step, _, witness] = self.reach;
        let x = self.all[row];
        let on_curve = self.labels[row] == 0;
        let place = (self.sheets)
            .meet(&[0, 1, 2], 2, x, step, self.sine)
            .filter(|p| on_curve || (p - x).norm() < witness)
            .filter(|p| self.supports(p));
        if on_curve && place.is_none() {
            return None;
        }
        Some(located(x, if on_curve { 1 } else { 2 }, 3, place))
    }

    fn decomposition(self, center: Located) -> Decomposition {
        Decomposition {
            strata: [1, 2, 2, 2].map(|dimension| Stratum { dimension }).to_vec(),
            cells_at_curve: vec![3],
            residual: self.residual,
            parameters: 22,
            points: Vec::new(),
            center: center.place,
            center_offset: center.offset,
            labels: self.labels.into_iter().map(Label::from).collect(),
        }
    }
}

impl Fit {
    /// Whether all cells have a fitted point close to a place.
    fn supports(&self, place: &Vector3<f64>) -> bool {
        let mut nearest = [f64::INFINITY; 4];
        for (x, &label) in self.all[..self.fitted].iter().zip(&self.labels) {
            let n = &mut nearest[usize::from(label)];
            *n = n.min((x - place).norm());
        }
        nearest[1..].iter().all(|&d| d < self.reach[1])
    }
}

impl SingularityModel for YJunction {
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
        "y-junction"
    }
}
