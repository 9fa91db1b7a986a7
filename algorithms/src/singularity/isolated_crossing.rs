//! Two sheets of R^4 that have one point in common.

use super::flats::{Flat, candidates, greedy};
use super::patch::PATCH_POINTS;
use super::sheet_in_four::SheetInFour;
use super::tolerance::{Tolerance, at_least, vectors};
use super::vanishing::Vanishing;
use crate::tuning::IsolatedCrossingTuning;
use crosscap_core::{
    Decomposition, Error, Label, Link, LinkKind, LocalPoints, Rejection, SingularityModel, Stratum,
};
use nalgebra::{Matrix4, Vector4};

/// Two sheets that cross in an isolated point, as two surfaces of R^4 do in general: the two
/// cells have that point alone in common.
///
/// Four quadrics vanish on two planes of R^4 in general position, and at a point of one plane
/// their gradients span its normal plane (generalized principal component analysis; Vidal, Ma,
/// Sastry 2005). Each plane then becomes a sheet with quadratic heights; the crossing is where
/// the sheets meet, by Newton's method. In R^N, N above 4, the four leading principal
/// coordinates are used.
#[derive(Clone, Copy, Debug)]
pub struct IsolatedCrossing {
    tolerance: Tolerance,
    tuning: IsolatedCrossingTuning,
}

/// Rounds of fitting sheets and assigning points anew.
const ROUNDS: usize = 3;

impl IsolatedCrossing {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both sheets is at the crossing.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: IsolatedCrossingTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: IsolatedCrossingTuning) -> Self {
        Self { tuning, ..self }
    }
}

/// Unit-free equations of both sheets: heights, one row each.
fn equations(sheets: &[SheetInFour; 2], x: &Vector4<f64>) -> (Vector4<f64>, Matrix4<f64>) {
    let mut values = Vector4::zeros();
    let mut rows = Matrix4::zeros();
    for (s, sheet) in sheets.iter().enumerate() {
        let (v, g) = sheet.heights(x);
        for k in 0..2 {
            values[2 * s + k] = v[k];
            rows.set_row(2 * s + k, &g.row(k));
        }
    }
    (values, rows)
}

/// The point in which two sheets meet.
fn meet(
    sheets: &[SheetInFour; 2],
    start: Vector4<f64>,
    reach: f64,
    least_determinant: f64,
) -> Option<Vector4<f64>> {
    let mut x = start;
    for _ in 0..20 {
        let (values, rows) = equations(sheets, &x);
        if rows.determinant().abs() < least_determinant {
            return None;
        }
        let step = rows.lu().solve(&values)?;
        x -= step;
        if (x - start).norm() > reach {
            return None;
        }
        if step.norm() < 1e-12 * reach {
            return Some(x);
        }
    }
    None
}

/// Two sheets over two planes, bent to the first `count` points, and which of them every point is nearer to.
fn sheets(
    planes: &[Flat<4>],
    all: &[Vector4<f64>],
    count: usize,
    radius: f64,
) -> ([SheetInFour; 2], Vec<u8>) {
    let mut sheets = [
        SheetInFour::plane(&planes[0]),
        SheetInFour::plane(&planes[1]),
    ];
    let assign = |sheets: &[SheetInFour; 2]| -> Vec<u8> {
        all.iter()
            .map(|x| u8::from(sheets[1].distance(x) < sheets[0].distance(x)))
            .collect()
    };
    let mut owner = assign(&sheets);
    for _ in 0..ROUNDS {
        for (k, sheet) in sheets.iter_mut().enumerate() {
            let own = all[..count]
                .iter()
                .zip(&owner)
                .filter(|&(_, &o)| usize::from(o) == k);
            sheet.fit(own.map(|(x, _)| *x), radius);
        }
        owner = assign(&sheets);
    }
    (sheets, owner)
}

/// The label of every point; of the first `count` how many each sheet holds, and the sum of their squared distances.
fn labels(
    sheets: &[SheetInFour; 2],
    owner: &[u8],
    all: &[Vector4<f64>],
    count: usize,
    ep: f64,
) -> (Vec<u8>, [usize; 2], f64) {
    let mut labels = vec![0u8; all.len()];
    let mut held = [0usize; 2];
    let mut sum = 0.0;
    for (k, (x, label)) in all.iter().zip(&mut labels).enumerate() {
        let own = usize::from(owner[k]);
        let d = [sheets[0].distance(x), sheets[1].distance(x)];
        *label = if d[0] < ep && d[1] < ep {
            0
        } else {
            1 + own as u8
        };
        if k < count {
            sum += d[own] * d[own];
            held[own] += 1;
        }
    }
    (labels, held, sum)
}

impl SingularityModel for IsolatedCrossing {
    fn local_dimension(&self) -> usize {
        4
    }

    fn link(&self) -> Option<Link> {
        LinkKind::IsolatedCrossing.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        at_least(3 * PATCH_POINTS, local)?;
        let count = local.fitted;
        let ep = self.tolerance.ep;
        // The mean is the origin.
        let fourth: f64 = (0..count).map(|k| local.point(k)[3].powi(2)).sum();
        if fourth < self.tuning.fourth * local.radius.powi(2) * count as f64 {
            return Err(Rejection::NoRealSolution);
        }
        let all: Vec<Vector4<f64>> = vectors(local);
        let points = &all[..count];
        let quadrics =
            Vanishing::fit(points, 2, 4, local.radius).ok_or(Rejection::NoRealSolution)?;
        let found = candidates(points, |x, out| quadrics.gradients(x, out));
        let planes = greedy(points, &found, 2, self.tuning.plane * local.radius)
            .ok_or(Rejection::NoRealSolution)?;
        let (sheets, owner) = sheets(&planes, &all, count, local.radius);
        let center = all[local.center];
        let tuning = &self.tuning;
        let apex = meet(
            &sheets,
            center,
            tuning.reach * local.radius,
            tuning.determinant,
        )
        .ok_or(Rejection::NoRealSolution)?;
        let (labels, held, sum) = labels(&sheets, &owner, &all, count, ep);
        let residual = self.tolerance.residual(sum, count)?;
        let least = (self.tuning.sheet_share * count as f64).max(PATCH_POINTS as f64 / 2.0);
        if let Some(stratum) = (0..2).find(|&s| (held[s] as f64) < least) {
            return Err(Rejection::EmptyStratum {
                stratum: stratum + 1,
                found: held[stratum],
            });
        }
        let at_point = labels[local.center] == 0;
        Ok(Decomposition {
            strata: [0, 2, 2].map(|dimension| Stratum { dimension }).to_vec(),
            labels: labels.into_iter().map(Label::from).collect(),
            cells_at_curve: Vec::new(),
            residual,
            parameters: 24,
            points: vec![apex.iter().copied().collect()],
            center: if at_point { apex } else { center }
                .iter()
                .copied()
                .collect(),
            center_offset: if at_point {
                (apex - center).norm()
            } else {
                f64::INFINITY
            },
        })
    }

    fn name(&self) -> &str {
        "isolated-crossing"
    }
}
