//! Standard errors by leaving out groups of points.

/// Groups that are left out in turn.
pub(super) const GROUPS: usize = 8;

/// Delete-a-group jackknife: the standard error of a statistic whose value without group `g` is
/// `values[g]`, `sqrt((G - 1) / G * sum (v_g - mean)^2)` (Efron & Tibshirani, *An Introduction to the
/// Bootstrap*, 1993, section 11.5). It is too large rather than too small for statistics of pairs.
pub(super) fn standard_error(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    ((count - 1.0) / count * spread).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn of_a_mean_it_is_the_usual_standard_error() {
        let data = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let total: f64 = data.iter().sum();
        let without: Vec<f64> = data.iter().map(|x| (total - x) / 7.0).collect();
        let mean = total / 8.0;
        let variance = data.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 7.0;
        assert_relative_eq!(
            standard_error(&without),
            (variance / 8.0).sqrt(),
            max_relative = 1e-12
        );
    }
}
