//! How likely a stretch of a curve without points is by chance.

/// Probability that points scattered along a curve at random leave a stretch of that `length` between two of them, where
/// `spacings` others together are `span` long: (1 + x / m)^-m for x mean spacings that m are known of, in place of exp(-x).
/// One where nothing is known.
pub(crate) fn chance(length: f64, span: f64, spacings: usize) -> f64 {
    let count = spacings as f64;
    if spacings > 0 && span > 0.0 && length > 0.0 {
        (1.0 + length / span).powf(-count)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::chance;

    #[test]
    fn seven_mean_spacings_are_no_chance_where_the_mean_is_known() {
        assert!((chance(7.0, 1e6, 1_000_000) - (-7.0_f64).exp()).abs() < 1e-6);
        // Seven times the mean of four spacings says less.
        assert!(chance(7.0, 4.0, 4) > 0.01);
        assert_eq!(chance(7.0, 0.0, 0), 1.0);
    }
}
