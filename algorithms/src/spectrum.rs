//! The dimension that a spectrum of variances shows.

use crosscap_core::Error;

/// The share of the total variance that may lie outside of the dimension: dt of Martin & Watson (2011), section 2.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VarianceTolerance(f64);

impl VarianceTolerance {
    /// A tolerance `dt`, a share of the total variance (strict).
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `0 < dt < 1`.
    pub(crate) fn new(dt: f64) -> Result<Self, Error> {
        if dt > 0.0 && dt < 1.0 {
            return Ok(Self(dt));
        }
        Err(Error::Parameter {
            name: "dt",
            value: dt.to_string(),
            expected: "a number strictly between 0 and 1".into(),
        })
    }

    /// The share.
    pub(crate) fn share(self) -> f64 {
        self.0
    }

    /// Dimension of a spectrum of variances, largest first, with its value (the dimension
    /// as a number) and its confidence: how far the deciding shares are from the tolerance, on a
    /// logarithmic scale, 1 from a factor of ten on.
    pub(crate) fn dimension_of(self, variances: &[f64]) -> (usize, f64, f64) {
        let total: f64 = variances.iter().sum();
        if total <= 0.0 {
            return (0, 0.0, 1.0);
        }
        let mut tail = total;
        let mut before = f64::INFINITY;
        let mut dimension = variances.len();
        let mut after = 0.0;
        for (d, v) in variances.iter().enumerate() {
            before = tail / total;
            tail -= v;
            after = (tail / total).max(0.0);
            if after < self.0 {
                dimension = d + 1;
                break;
            }
        }
        let margin = (before / self.0)
            .log10()
            .min((self.0 / after.max(1e-300)).log10());
        (dimension, dimension as f64, margin.clamp(0.0, 1.0))
    }
}
