//! Inner products of vectors that are slices of coordinates, and steps of Gram-Schmidt orthogonalization.

/// Inner product, added up in the order of the coordinates.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Makes vector `k` of `vectors`, which are `width` long each, a unit vector across those before it, which are
/// such already: Gram-Schmidt, so many `passes` (a second one takes away what rounding left of a vector that was nearly
/// dependent). `false` where at most the share `least` of its squared length is left: it is dependent.
pub(crate) fn unit_across(
    vectors: &mut [f64],
    width: usize,
    k: usize,
    passes: usize,
    least: f64,
) -> bool {
    let (done, rest) = vectors.split_at_mut(k * width);
    let own = &mut rest[..width];
    let before: f64 = own.iter().map(|x| x * x).sum();
    for _ in 0..passes {
        for other in done.chunks_exact(width) {
            let along: f64 = other.iter().zip(&*own).map(|(a, b)| a * b).sum();
            own.iter_mut().zip(other).for_each(|(x, o)| *x -= along * o);
        }
    }
    let square: f64 = own.iter().map(|x| x * x).sum();
    // NaN is refused as well.
    let left = square > least * before;
    if left {
        let inverse = 1.0 / square.sqrt();
        own.iter_mut().for_each(|x| *x *= inverse);
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nearly_dependent_vector_needs_two_passes() {
        let dot = |v: &[f64]| -> f64 { v[..3].iter().zip(&v[3..]).map(|(a, b)| a * b).sum() };
        let start = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0 + 1e-9];
        let after = |passes| {
            let mut v = start;
            assert!(unit_across(&mut v, 3, 0, 1, 1e-24));
            assert!(unit_across(&mut v, 3, 1, passes, 1e-24));
            dot(&v).abs()
        };
        assert!(after(2) < 1e-15, "{}", after(2));
        assert!(after(1) > 1e-9, "{}", after(1));
    }

    #[test]
    fn dependent_vectors_are_refused() {
        for second in [[2.0, 4.0], [0.0, 0.0], [f64::NAN, 1.0]] {
            let mut v = [1.0, 2.0, second[0], second[1]];
            assert!(unit_across(&mut v, 2, 0, 1, 1e-12));
            assert!(!unit_across(&mut v, 2, 1, 1, 1e-12), "{second:?}");
        }
    }
}
