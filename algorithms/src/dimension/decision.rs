//! From a real number with its standard error to a dimension with its confidence.

use crosscap_core::DimensionEstimate;

/// The estimate for a value, at most `most`: k points span no more than k - 1 dimensions.
pub(super) fn decide(value: f64, standard_error: f64, most: usize) -> DimensionEstimate {
    let value = value.clamp(0.0, most as f64);
    let dimension = value.round();
    DimensionEstimate {
        dimension: dimension as usize,
        value,
        confidence: confidence(value, standard_error),
        spectrum: Vec::new(),
    }
}

/// Probability that a normal error with this standard deviation is smaller than the distance of
/// the value from the nearest half.
pub(super) fn confidence(value: f64, standard_error: f64) -> f64 {
    let margin = 0.5 - (value - value.round()).abs();
    if margin <= 0.0 || standard_error.is_nan() {
        0.0
    } else if standard_error <= 0.0 {
        1.0
    } else {
        libm::erf(margin / (standard_error * std::f64::consts::SQRT_2)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn confidence_is_the_share_of_a_normal_law() {
        // One standard error from the half: 68.27 %, two: 95.45 %.
        assert_relative_eq!(confidence(2.0, 0.5), 0.682_689_492, epsilon = 1e-8);
        assert_relative_eq!(confidence(3.0, 0.25), 0.954_499_736, epsilon = 1e-8);
        assert_eq!(confidence(2.5, 0.1), 0.0);
        assert_eq!(confidence(2.5, 0.0), 0.0);
        assert_eq!(confidence(2.1, 0.0), 1.0);
        assert!(confidence(2.1, f64::INFINITY) < 1e-9);
    }

    #[test]
    fn values_are_rounded_and_bounded() {
        assert_eq!(decide(2.4, 0.1, 9).dimension, 2);
        assert_eq!(decide(2.6, 0.1, 9).dimension, 3);
        let bounded = decide(f64::INFINITY, 0.1, 9);
        assert_eq!((bounded.dimension, bounded.value), (9, 9.0));
        assert_eq!(decide(-1.0, 0.1, 9).value, 0.0);
    }
}
