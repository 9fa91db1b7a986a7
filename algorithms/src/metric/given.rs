//! Distances that somebody measured.

use crosscap_core::{Error, MetricSpace, Scalar};

/// A metric space given by the full matrix of its distances: whatever a laboratory measured or
/// another program computed. `O(1)` a distance, `O(n^2)` memory.
///
/// ```
/// use crosscap_algorithms::metric::GivenDistances;
/// use crosscap_core::MetricSpace;
/// let pair = GivenDistances::new(2, vec![0.0, 1.5, 1.5, 0.0]).unwrap();
/// assert_eq!(pair.distance(1, 0), 1.5);
/// let error = GivenDistances::new(2, vec![0.0, 1.5, 1.0, 0.0]).unwrap_err();
/// assert!(error.to_string().contains("row 0, column 1"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GivenDistances<S> {
    len: usize,
    distances: Vec<S>,
}

impl<S: Scalar> GivenDistances<S> {
    /// Takes `len * len` distances in row order. Infinity is not accepted: leave points out
    /// that nothing was measured to.
    ///
    /// The triangle inequality is not checked here, since measurements break it within their
    /// error; [`GivenDistances::triangle_defect`] tells by how much.
    ///
    /// # Errors
    /// [`Error::Shape`] when the matrix is not square of that size, and for the first entry in
    /// row order that is not allowed: [`Error::NotFinite`], or [`Error::Parameter`] with row,
    /// column and value when it is negative, not zero on the diagonal, or not the same as its
    /// mirror image (to the bit: average the two if a rounding set them apart).
    pub fn new(len: usize, distances: Vec<S>) -> Result<Self, Error> {
        if len.checked_mul(len) != Some(distances.len()) {
            return Err(Error::Shape {
                found: format!("{} distances", distances.len()),
                expected: format!("{len} rows of {len}"),
            });
        }
        for row in 0..len {
            for column in 0..len {
                let value = distances[row * len + column];
                if !value.is_finite() {
                    return Err(Error::NotFinite { row, column });
                }
                let mirrored = distances[column * len + row];
                let expected = if value < S::zero() {
                    "at least 0".to_string()
                } else if row == column && value != S::zero() {
                    "0, the distance of a point from itself".to_string()
                } else if mirrored.is_finite() && mirrored >= S::zero() && value != mirrored {
                    format!("{mirrored}, as in row {column}, column {row}")
                } else {
                    continue;
                };
                return Err(Error::Parameter {
                    name: "distances",
                    value: format!("{value} in row {row}, column {column}"),
                    expected,
                });
            }
        }
        Ok(Self { len, distances })
    }

    /// The largest excess of a side over the two others, `d(a, c) - d(a, b) - d(b, c)`, with the
    /// three points; `None` when the triangle inequality holds everywhere. `O(n^3)`.
    ///
    /// ```
    /// use crosscap_algorithms::metric::GivenDistances;
    /// let bent = GivenDistances::new(3, vec![0.0, 1.0, 5.0, 1.0, 0.0, 1.0, 5.0, 1.0, 0.0]).unwrap();
    /// assert_eq!(bent.triangle_defect(), Some((3.0, [0, 1, 2])));
    /// ```
    pub fn triangle_defect(&self) -> Option<(f64, [usize; 3])> {
        let d = |a: usize, b: usize| self.distances[a * self.len + b].as_f64();
        let mut worst: Option<(f64, [usize; 3])> = None;
        for a in 0..self.len {
            for b in 0..self.len {
                for c in a + 1..self.len {
                    let excess = d(a, c) - d(a, b) - d(b, c);
                    if excess > worst.map_or(0.0, |w| w.0) {
                        worst = Some((excess, [a, b, c]));
                    }
                }
            }
        }
        worst
    }
}

impl<S: Scalar> MetricSpace for GivenDistances<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.len
    }

    fn distance(&self, a: usize, b: usize) -> S {
        assert!(b < self.len, "point {b} of {}", self.len);
        self.distances[a * self.len + b]
    }

    fn name(&self) -> &str {
        "given distances"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn one_wrong_entry_is_found(
            len in 2_usize..9,
            at in (0_usize..9, 0_usize..9),
            wrong in prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(-1.0), Just(17.5)],
        ) {
            let mut matrix: Vec<f64> = (0..len * len)
                .map(|k| ((k / len) as f64 - (k % len) as f64).abs())
                .collect();
            let line = GivenDistances::new(len, matrix.clone()).unwrap();
            prop_assert_eq!(line.triangle_defect(), None);
            let (row, column) = (at.0 % len, at.1 % len);
            matrix[row * len + column] = wrong;
            let error = GivenDistances::new(len, matrix).unwrap_err();
            prop_assert!(error.is_input());
            let text = error.to_string();
            let named = |r: usize, c: usize| text.contains(&format!("row {r}, column {c}"));
            // An entry that breaks the symmetry is as wrong as its mirror image.
            prop_assert!(named(row, column) || wrong == 17.5 && named(column, row), "{}", text);
        }
    }

    #[test]
    fn wrong_sizes_are_refused() {
        for len in [0, 2, usize::MAX] {
            let error = GivenDistances::new(len, vec![0.0_f32; 3]).unwrap_err();
            assert!(matches!(error, Error::Shape { .. }));
        }
        assert!(GivenDistances::<f64>::new(0, vec![]).unwrap().is_empty());
    }
}
