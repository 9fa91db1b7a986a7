//! A curve that no surface touches.

use super::curve_fit::QuadraticCurve;
use super::tolerance::{Tolerance, at_least, vectors};
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Rejection, SingularityModel, Stratum,
};
use nalgebra::Vector3;

/// A curve by itself: the neighborhood is 1-dimensional. Where the data are of mixed dimension the
/// complex then has edges without triangles.
#[derive(Clone, Copy, Debug)]
pub struct BareCurve {
    tolerance: Tolerance,
}

/// Fewest points: a curve of two quadratic heights has six coefficients.
const LEAST_POINTS: usize = 6;

impl BareCurve {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: all points are within
    /// `ep` of the curve.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
        })
    }
}

impl SingularityModel for BareCurve {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        dimension == 1
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        at_least(LEAST_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..local.fitted];
        let curve = QuadraticCurve::fit(points).ok_or(Rejection::NoRealSolution)?;
        let off = |x: &Vector3<f64>| (curve.foot(x) - x).norm();
        let residual = self
            .tolerance
            .residual(points.iter().map(|x| off(x).powi(2)).sum(), points.len())?;
        let farthest = points.iter().map(off).fold(0.0, f64::max);
        if farthest >= self.tolerance.ep {
            return Err(Rejection::PoorFit {
                residual: farthest,
                limit: self.tolerance.ep,
            });
        }
        let center = all[local.center];
        let foot = curve.foot(&center);
        Ok(Decomposition {
            strata: vec![Stratum { dimension: 1 }],
            labels: vec![Label::new(0); all.len()],
            cells_at_curve: vec![0],
            residual,
            parameters: 8,
            points: Vec::new(),
            center: foot.iter().copied().collect(),
            center_offset: (foot - center).norm(),
        })
    }

    fn name(&self) -> &str {
        "curve"
    }
}
