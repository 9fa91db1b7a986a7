//! The lowest curve of a family above points of the plane.

use nalgebra::{SMatrix, SVector};

/// What holds a curve up.
#[derive(Clone, Copy, PartialEq)]
enum Stay {
    /// It goes through a point.
    Point(usize),
    /// A coefficient times the sign is at its lower bound.
    Bound(usize, f64),
}

/// Exchanges tried.
const EXCHANGES: usize = 300;
/// A point this far above the curve is not above it.
const ROUNDING: f64 = 1e-11;

/// Coefficients of the combination of `K` functions of `t` that has the least mean height over points `(t, v)` with none of them
/// above it. Coefficient `j` is at most `bounds[j]` in size; `row` has the functions' values. Points and functions are of the size 1.
///
/// A linear program in `K` unknowns, solved by the dual simplex method: the bounds hold the curve first, which no bound can do
/// wrong, then the point farthest above it comes in, and the ratio test says which stay goes. O(k) an exchange for
/// k points, few exchanges. `None` where no such curve is above the points, or rounding stands in the way.
pub(super) fn lowest<const K: usize>(
    points: &[[f64; 2]],
    row: impl Fn(f64) -> SVector<f64, K>,
    bounds: &[f64; K],
) -> Option<SVector<f64, K>> {
    let rows: Vec<SVector<f64, K>> = points.iter().map(|p| row(p[0])).collect();
    let mean = rows.iter().sum::<SVector<f64, K>>() / rows.len().max(1) as f64;
    let of = |stay: Stay| match stay {
        Stay::Point(k) => (rows[k], points[k][1]),
        Stay::Bound(j, sign) => {
            let mut unit = SVector::zeros();
            unit[j] = sign;
            (unit, -bounds[j])
        }
    };
    let mut stays: [Stay; K] = std::array::from_fn(|j| {
        let sign = if mean[j] < 0.0 { -1.0 } else { 1.0 };
        Stay::Bound(j, sign)
    });
    for _ in 0..EXCHANGES {
        let held = stays.map(of);
        let columns = SMatrix::<f64, K, K>::from_columns(&held.map(|x| x.0));
        let inverse = columns.try_inverse()?;
        let heights = SVector::<f64, K>::from(held.map(|x| x.1));
        let terms = inverse.transpose() * heights;
        let Some(enter) = most_broken(points, &rows, bounds, &terms) else {
            return Some(terms);
        };
        if stays.contains(&enter) {
            return None;
        }
        let (shares, change) = (inverse * mean, inverse * of(enter).0);
        let ratio = |j: usize| shares[j].max(0.0) / change[j];
        let leave = (0..K)
            .filter(|&j| change[j] > 1e-10)
            .min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))?;
        stays[leave] = enter;
    }
    None
}

/// The point that is farthest above a curve, or the bound that it breaks by more than that.
fn most_broken<const K: usize>(
    points: &[[f64; 2]],
    rows: &[SVector<f64, K>],
    bounds: &[f64; K],
    terms: &SVector<f64, K>,
) -> Option<Stay> {
    let mut worst = (ROUNDING, None);
    for (k, (p, row)) in points.iter().zip(rows).enumerate() {
        let above = p[1] - terms.dot(row);
        if above > worst.0 {
            worst = (above, Some(Stay::Point(k)));
        }
    }
    for (j, bound) in bounds.iter().enumerate() {
        let beyond = terms[j].abs() - bound;
        if beyond > worst.0 {
            worst = (beyond, Some(Stay::Bound(j, -terms[j].signum())));
        }
    }
    worst.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn parabola(t: f64) -> Vector3<f64> {
        Vector3::new(1.0, t, t * t)
    }

    proptest! {
        #[test]
        fn is_above_all_points_and_no_other_is_lower(
            points in prop::collection::vec([-1.0..1.0f64, -1.0..1.0f64], 5..60),
            other in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let bounds = [3.0, 2.0, 0.7];
            let found = lowest(&points, parabola, &bounds).unwrap();
            prop_assert!(points.iter().all(|p| found.dot(&parabola(p[0])) >= p[1] - 1e-9));
            prop_assert!((0..3).all(|j| found[j].abs() <= bounds[j] + 1e-9));
            // Any other one within the bounds, lifted until it is above all.
            let mut other = Vector3::from(other).component_mul(&Vector3::from(bounds));
            other[0] = 0.0;
            let lift = points.iter().map(|p| p[1] - other.dot(&parabola(p[0])));
            other[0] = lift.fold(f64::NEG_INFINITY, f64::max);
            let mean = |c: &Vector3<f64>| points.iter().map(|p| c.dot(&parabola(p[0]))).sum::<f64>();
            prop_assert!(other[0].abs() > bounds[0] || mean(&found) <= mean(&other) + 1e-9);
        }
    }

    #[test]
    fn bounds_that_no_curve_keeps_leave_none() {
        assert!(lowest(&[[0.0, 0.5]], parabola, &[0.4, 1.0, 1.0]).is_none());
    }
}
