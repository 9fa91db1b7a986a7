//! A curve that goes through a sheet, or ends on one.

mod fit;
mod last;

use crate::tuning::CurveAndSheetTuning;
use crosscap_core::{
    Decomposition, Error, Link, LinkKind, LocalPoints, Rejection, SingularityModel,
};
use fit::Conditions;

/// A curve that pierces a sheet: a point, two arcs without triangles, one cell.
///
/// Two quadrics vanish on a plane and a line, and at points of the plane their gradients are
/// normal to it; the plane that most points lie near becomes a quadratic patch, the points
/// off it a curve. The point is where the curve meets the patch, by Newton's method.
#[derive(Clone, Copy, Debug)]
pub struct CurveThroughSheet {
    conditions: Conditions,
}

/// A curve that ends on a sheet: a point, one arc without triangles, one cell.
///
/// Fitted like [`CurveThroughSheet`]; the arc is on one side of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct CurveOnSheet {
    conditions: Conditions,
}

impl CurveThroughSheet {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both curve and sheet is where they meet.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            conditions: Conditions::new(dp, ep)?,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(mut self, tuning: CurveAndSheetTuning) -> Self {
        self.conditions.tuning = tuning;
        self
    }
}

impl CurveOnSheet {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both curve and sheet is where they meet.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            conditions: Conditions::new(dp, ep)?,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(mut self, tuning: CurveAndSheetTuning) -> Self {
        self.conditions.tuning = tuning;
        self
    }
}

impl SingularityModel for CurveThroughSheet {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        (1..=3).contains(&dimension)
    }

    fn looks_behind(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::CurveThroughSheet.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let fit = last::fit(local, &self.conditions)?;
        if let Some(side) = (0..2).find(|&side| fit.arcs[side] < self.conditions.tuning.arc) {
            return Err(Rejection::EmptyStratum {
                stratum: 1 + side,
                found: fit.arcs[side],
            });
        }
        Ok(fit.into_decomposition(local, 2, [0, 1, 2, 3]))
    }

    fn name(&self) -> &str {
        "curve-through-sheet"
    }
}

impl SingularityModel for CurveOnSheet {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, dimension: usize) -> bool {
        (1..=3).contains(&dimension)
    }

    fn looks_behind(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::CurveOnSheet.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let fit = last::fit(local, &self.conditions)?;
        if fit.arcs[0].max(fit.arcs[1]) < self.conditions.tuning.arc {
            return Err(Rejection::EmptyStratum {
                stratum: 1,
                found: fit.arcs[0].max(fit.arcs[1]),
            });
        }
        if fit.arcs[0].min(fit.arcs[1]) >= self.conditions.tuning.arc {
            return Err(Rejection::NoRealSolution);
        }
        Ok(fit.into_decomposition(local, 1, [0, 1, 1, 2]))
    }

    fn name(&self) -> &str {
        "curve-on-sheet"
    }
}

#[cfg(test)]
mod tests;
