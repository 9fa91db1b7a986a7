//! Estimates of the dimension.

use super::broken;
use crosscap_core::{DimensionEstimate, Error};

/// The dimension that an estimator found at `point` from so many `neighbors`, at most `space`.
///
/// # Errors
/// [`Error::Law`] for a value that is not finite or negative, a confidence outside 0 to 1, a dimension
/// that is not the value rounded, or more dimensions than the points span.
pub(crate) fn dimension(
    plugin: &str,
    point: usize,
    estimate: &DimensionEstimate,
    neighbors: usize,
    space: usize,
) -> Result<usize, Error> {
    let DimensionEstimate {
        dimension,
        value,
        confidence,
        ..
    } = *estimate;
    if !(value.is_finite() && value >= 0.0) {
        return broken(
            plugin,
            "answer: the value is finite and at least 0",
            point,
            format!("{value}"),
        );
    }
    if !(0.0..=1.0).contains(&confidence) {
        return broken(
            plugin,
            "answer: the confidence is between 0 and 1",
            point,
            format!("{confidence}"),
        );
    }
    if (value - dimension as f64).abs() > 0.5 + ROUNDING {
        return broken(
            plugin,
            "rounded: the dimension is the value rounded",
            point,
            format!("dimension {dimension} for the value {value}"),
        );
    }
    if dimension >= neighbors.max(1) {
        return broken(
            plugin,
            "answer: k points span at most k - 1 dimensions",
            point,
            format!("dimension {dimension} from {neighbors} points"),
        );
    }
    // A value above the dimension of the space is an error of chance.
    Ok(dimension.min(space))
}

/// A value this far beyond a half may be rounded either way.
const ROUNDING: f64 = 1e-6;
