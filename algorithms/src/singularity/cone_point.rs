//! A point at which a surface is like the tip of a cone.

use super::one_fit::{OneFit, located};
use super::quadric_cone::QuadricCone;
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::ConePointTuning;
use crosscap_core::{
    Decomposition, Error, Label, Link, LinkKind, LocalPoints, Located, Rejection, SingularityModel,
    Stratum,
};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The tip of a cone, of one half or of both: a sheet without a tangent plane, or two that have this point alone in common.
///
/// It is the simplest isolated singularity that an algebraic surface can have, a node: there the surface is, to second order,
/// the cone of a quadratic form of two signs. The quadric of least distances is fitted to the points, and its center is the tip.
/// Where the quadric does not go through its own center it is a hyperboloid, a thin neck or two sheets that come near to each
/// other: the model says no where that would show in the points.
#[derive(Clone, Copy, Debug)]
pub struct ConePoint {
    tolerance: Tolerance,
    tuning: ConePointTuning,
}

/// Fewest points that a cone is fitted to: twice the coefficients of a quadric.
const LEAST: usize = 20;
/// Labels: the point, and the cells on both sides of it.
const POINT: u8 = 0;
const CELLS: [u8; 2] = [1, 2];

impl ConePoint {
    /// Model with fit tolerance `dp` and point tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to the tip is the tip.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: ConePointTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: ConePointTuning) -> Self {
        Self { tuning, ..self }
    }

    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(LEAST, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let (points, radius) = (&all[..local.fitted], local.radius);
        let Self { tolerance, tuning } = self;
        let cone = QuadricCone::fit(points, radius, tuning.sharpness)
            .filter(|cone| cone.apex.norm() < tuning.reach * radius)
            .ok_or(Rejection::NoRealSolution)?;
        let spacing = radius * (PI / points.len() as f64).sqrt();
        if cone.neck > tuning.neck * spacing {
            return Err(Rejection::NoRealSolution);
        }
        let off: Vec<f64> = points.iter().map(|x| cone.distance(x)).collect();
        let residual = tolerance.residual(off.iter().map(|d| d * d).sum(), off.len())?;
        let astray = off.iter().filter(|&&d| d > tolerance.ep).count();
        if astray as f64 > tuning.astray * off.len() as f64 {
            return Err(Rejection::PoorFit {
                residual,
                limit: tolerance.ep,
            });
        }
        let mut fit = Fit {
            all,
            cone,
            residual,
            ep: tolerance.ep,
            halves: [true; 2],
        };
        fit.halves = CELLS.map(|cell| (0..local.fitted).any(|k| fit.label(k) == cell));
        match fit.halves {
            [false, false] => Err(Rejection::NoRealSolution),
            _ => Ok(fit),
        }
    }
}

/// A cone with the points about it.
struct Fit {
    all: Vec<Vector3<f64>>,
    cone: QuadricCone,
    residual: f64,
    ep: f64,
    /// Which of its halves are there.
    halves: [bool; 2],
}

impl Fit {
    /// Where a row is: the tip, or the half of the cone that it belongs to.
    fn label(&self, row: usize) -> u8 {
        let x = &self.all[row];
        if (x - self.cone.apex).norm() < self.ep {
            return POINT;
        }
        match (self.halves, self.cone.height(x) > 0.0) {
            ([true, true], false) => CELLS[1],
            // A single half has the first label, whichever it is.
            _ => CELLS[0],
        }
    }
}

impl OneFit for Fit {
    fn located(&self, row: usize) -> Option<Located> {
        let at_tip = self.label(row) == POINT;
        let (dimension, place) = match at_tip {
            true => (0, Some(self.cone.apex)),
            false => (2, None),
        };
        Some(located(self.all[row], dimension, 0, place))
    }

    fn decomposition(self, center: Located) -> Decomposition {
        let strata: &[u8] = match self.halves {
            [true, true] => &[0, 2, 2],
            _ => &[0, 2],
        };
        Decomposition {
            strata: (strata.iter())
                .map(|&dimension| Stratum { dimension })
                .collect(),
            labels: (0..self.all.len())
                .map(|row| Label::from(self.label(row)))
                .collect(),
            cells_at_curve: Vec::new(),
            residual: self.residual,
            parameters: 9,
            points: vec![self.cone.apex.iter().copied().collect()],
            center: center.place,
            center_offset: center.offset,
        }
    }
}

impl SingularityModel for ConePoint {
    fn local_dimension(&self) -> usize {
        3
    }

    /// That of the tips in which two sheets meet; no curve stops in either kind.
    fn link(&self) -> Option<Link> {
        LinkKind::IsolatedCrossing.link()
    }

    fn link_of(&self, fit: &Decomposition) -> Option<Link> {
        match fit.strata.len() {
            3 => LinkKind::IsolatedCrossing.link(),
            _ => LinkKind::Circle.link(),
        }
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
        "cone-point"
    }
}
