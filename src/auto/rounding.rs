//! Lengths short enough to be typed again.

/// The positive number rounded to three significant digits, so that the command that repeats a run is
/// short and exact; other numbers stay as they are.
pub(super) fn three_digits(length: f64) -> f64 {
    if !(length > 0.0 && length.is_finite()) {
        return length;
    }
    // Printed and read again: the nearest number with these digits, whatever its exponent.
    format!("{length:.2e}").parse().unwrap_or(length)
}

#[cfg(test)]
mod tests {
    use super::three_digits;

    #[test]
    fn three_digits_are_kept_at_every_scale() {
        for (x, rounded) in [
            (0.123456, 0.123),
            (9.996, 10.0),
            (1.2345e-300, 1.23e-300),
            (87_654.0, 87_700.0),
        ] {
            assert_eq!(three_digits(x), rounded);
            assert_eq!(three_digits(rounded), rounded);
        }
        assert!(three_digits(f64::NAN).is_nan());
        assert_eq!(three_digits(0.0), 0.0);
    }
}
