//! Numbers as they are typed and shown.

/// A positive finite number.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 {
        Ok(number)
    } else {
        Err("expected a number above 0".into())
    }
}

/// A finite number that is not negative.
pub fn not_negative(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number >= 0.0 {
        Ok(number)
    } else {
        Err("expected a number of at least 0".into())
    }
}

/// A number between 0 and 1, both excluded.
pub fn share(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 && number < 1.0 {
        Ok(number)
    } else {
        Err("expected a number above 0 and below 1".into())
    }
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("expected a finite number".into()),
        Err(_) => Err("expected a number".into()),
    }
}

/// A number of things with its noun: "1 point", "3 points".
pub fn counted(count: usize, one: &str) -> String {
    if count == 1 {
        format!("1 {one}")
    } else if let Some(stem) = one.strip_suffix("ex") {
        format!("{count} {stem}ices")
    } else {
        format!("{count} {one}s")
    }
}

/// Betti numbers: "1, 0, 3".
pub fn betti(numbers: [usize; 3]) -> String {
    let [b0, b1, b2] = numbers;
    format!("{b0}, {b1}, {b2}")
}

/// The middle value, the mean of two for an even number of them; NaN for none.
pub fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len().is_multiple_of(2) {
        (values[half - 1] + values[half]) / 2.0
    } else {
        values[half]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_length() {
        for text in ["0", "-1", "nan", "inf", "", "a", "1e999"] {
            assert!(positive(text).is_err(), "{text}");
        }
        assert_eq!(positive("2.5e-1"), Ok(0.25));
        assert_eq!(not_negative("0"), Ok(0.0));
        assert!(share("1").is_err() && share("0").is_err() && share("0.05").is_ok());
    }

    #[test]
    fn nouns_agree_with_their_number() {
        assert_eq!(counted(1, "vertex"), "1 vertex");
        assert_eq!(counted(2, "vertex"), "2 vertices");
        assert_eq!(counted(0, "point"), "0 points");
    }

    #[test]
    fn median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(vec![]).is_nan());
    }
}
