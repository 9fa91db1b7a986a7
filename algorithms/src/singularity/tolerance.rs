//! The two tolerances that models of crossing sheets share.

use crosscap_core::{Error, LocalPoints, Rejection, positive_length};
use nalgebra::SVector;

/// Fit tolerance dp and curve tolerance eps_p, unit of the data (Martin & Watson 2011, section 2.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerance {
    pub(super) dp: f64,
    pub(super) ep: f64,
}

impl Tolerance {
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub(super) fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            dp: positive_length("dp", dp)?,
            ep: positive_length("ep", ep)?,
        })
    }

    /// The root of the mean square, where it is within dp.
    pub(super) fn residual(&self, sum: f64, count: usize) -> Result<f64, Rejection> {
        let residual = (sum / count.max(1) as f64).sqrt();
        if residual <= self.dp {
            Ok(residual)
        } else {
            Err(Rejection::PoorFit {
                residual,
                limit: self.dp,
            })
        }
    }
}

/// All points as vectors.
pub(super) fn vectors<const D: usize>(local: &LocalPoints<'_>) -> Vec<SVector<f64, D>> {
    (0..local.len())
        .map(|k| SVector::from_column_slice(local.point(k)))
        .collect()
}

/// Fewest points of a cell: fewer span no plane.
pub(super) const LEAST_HELD: usize = 3;

/// Refuses neighborhoods of fewer points.
pub(super) fn at_least(needed: usize, local: &LocalPoints<'_>) -> Result<(), Rejection> {
    if local.fitted < needed {
        return Err(Rejection::TooFewPoints {
            found: local.fitted,
            needed,
        });
    }
    Ok(())
}
