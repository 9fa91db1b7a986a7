//! What an estimator says of one neighborhood.

use crate::Error;
use serde::{Deserialize, Serialize};

/// A local dimension with its evidence.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DimensionEstimate {
    /// The estimate as a whole number, what the pipeline acts on.
    pub dimension: usize,
    /// The estimate before rounding; equal to `dimension` for estimators that count.
    pub value: f64,
    /// How far the decision was from falling otherwise, 0 (a toss-up) to 1.
    pub confidence: f64,
    /// What it was read from; for principal component analysis the variances,
    /// largest first, in squared units of the data. May be empty.
    pub spectrum: Vec<f64>,
}

impl DimensionEstimate {
    /// Whether this can be the answer of an estimator named `plugin` about the ball of so many `neighbors` around
    /// `point`.
    ///
    /// # Errors
    /// [`Error::Law`] for a value that is not finite or negative, a confidence outside 0 to 1, a dimension
    /// that is not the value rounded, or more dimensions than the points span.
    pub fn check(&self, plugin: &str, point: usize, neighbors: usize) -> Result<(), Error> {
        let Self {
            dimension,
            value,
            confidence,
            ..
        } = *self;
        let broken = |law: &'static str, detail: String| {
            Err(Error::Law {
                plugin: plugin.into(),
                law,
                point,
                detail,
            })
        };
        if !(value.is_finite() && value >= 0.0) {
            let law = "answer: the value is finite and at least 0";
            return broken(law, format!("{value}"));
        }
        if !(0.0..=1.0).contains(&confidence) {
            let law = "answer: the confidence is between 0 and 1";
            return broken(law, format!("{confidence}"));
        }
        if (value - dimension as f64).abs() > 0.5 + ROUNDING {
            let law = "rounded: the dimension is the value rounded";
            return broken(law, format!("dimension {dimension} for the value {value}"));
        }
        if dimension >= neighbors.max(1) {
            let law = "answer: k points span at most k - 1 dimensions";
            return broken(
                law,
                format!("dimension {dimension} from {neighbors} points"),
            );
        }
        Ok(())
    }
}

/// A value this far beyond a half may be rounded either way.
const ROUNDING: f64 = 1e-6;
