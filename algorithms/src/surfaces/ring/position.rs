//! Turning conformations towards a reference conformation.

use super::error::RingError;
use crate::alignment::Alignment;
use nalgebra::{DMatrix, DVector};

/// The conformation of cyclo-octane that others are aligned to, in Angstrom: recovered from the public set of 6,040
/// conformations (S. Martin's data of the paper) as the one for which all of them satisfy the Eckart condition, to
/// about 2e-5.
const CYCLO_OCTANE: [[f64; 3]; 8] = [
    [1.884_923_94, 0.717_411_76, 0.189_884_04],
    [1.860_490_90, -0.757_331_77, -0.177_446_11],
    [0.494_823_77, -1.300_083_44, -0.565_732_42],
    [-0.533_806_73, -1.311_382_49, 0.553_293_15],
    [-1.884_919_83, -0.717_410_99, 0.189_885_53],
    [-1.860_493_27, 0.757_331_79, -0.177_446_33],
    [-0.494_824_38, 1.300_084_55, -0.565_732_59],
    [0.533_805_60, 1.311_380_60, 0.553_294_72],
];

/// The position of conformations in space: centered, and turned next to a reference conformation.
///
/// The turned conformation p satisfies the Eckart condition, sum over atoms of reference x p = 0, so that all of
/// them lie in one linear space, the *slice*.
#[derive(Clone, Debug)]
pub(super) struct Position {
    pub alignment: Alignment,
    /// Orthonormal basis of the slice: 3m rows, 3m - 6 columns.
    pub slice: DMatrix<f64>,
}

impl Position {
    pub fn new(atoms: usize, reference: Option<&[[f64; 3]]>) -> Result<Self, RingError> {
        let reference: Vec<[f64; 3]> = match reference {
            Some(given) => given.to_vec(),
            None if atoms == CYCLO_OCTANE.len() => CYCLO_OCTANE.to_vec(),
            None => (0..atoms)
                .map(|k| {
                    let (s, c) = libm::sincos(std::f64::consts::TAU * k as f64 / atoms as f64);
                    [c, s, 0.0]
                })
                .collect(),
        };
        let alignment =
            Alignment::new(&reference, &vec![1.0; atoms]).map_err(|_| RingError::Reference)?;
        let slice = slice(alignment.reference()).ok_or(RingError::Reference)?;
        Ok(Self { alignment, slice })
    }
}

/// Orthonormal basis of the centered places x with sum over atoms of reference x place = 0; `None` when the six
/// conditions are not independent, for a reference on a line.
fn slice(reference: &[[f64; 3]]) -> Option<DMatrix<f64>> {
    let n = 3 * reference.len();
    let mut conditions: Vec<DVector<f64>> = (0..3)
        .map(|c| DVector::from_fn(n, |row, _| if row % 3 == c { 1.0 } else { 0.0 }))
        .collect();
    conditions.extend((0..3).map(|c| {
        DVector::from_fn(n, |row, _| {
            let (atom, axis) = (row / 3, row % 3);
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            // Component c of reference x place: reference_i place_j - reference_j place_i.
            if axis == j {
                reference[atom][i]
            } else if axis == i {
                -reference[atom][j]
            } else {
                0.0
            }
        })
    }));
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(n);
    let units = (0..n).map(|k| DVector::from_fn(n, |row, _| if row == k { 1.0 } else { 0.0 }));
    for (k, candidate) in conditions.into_iter().chain(units).enumerate() {
        let before = candidate.norm();
        let mut rest = candidate;
        for _ in 0..2 {
            for b in &basis {
                rest -= b * b.dot(&rest);
            }
        }
        let length = rest.norm();
        if k < 6 {
            if length.partial_cmp(&(1e-6 * before)) != Some(std::cmp::Ordering::Greater) {
                return None;
            }
            basis.push(rest / length);
        } else if length > 0.1 && basis.len() < n {
            // Of the unit vectors those are skipped that add little.
            basis.push(rest / length);
        }
    }
    (basis.len() == n).then(|| DMatrix::from_fn(n, n - 6, |row, column| basis[6 + column][row]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slice_is_orthonormal_and_satisfies_the_eckart_condition() {
        for atoms in [4, 5, 7, 8] {
            let position = Position::new(atoms, None).unwrap();
            let (slice, reference) = (&position.slice, position.alignment.reference());
            assert_eq!(slice.shape(), (3 * atoms, 3 * atoms - 6));
            let gram = slice.transpose() * slice;
            assert!((gram - DMatrix::identity(3 * atoms - 6, 3 * atoms - 6)).amax() < 1e-14);
            for place in slice.column_iter() {
                for c in 0..3 {
                    let (i, j) = ((c + 1) % 3, (c + 2) % 3);
                    let mean: f64 = (0..atoms).map(|a| place[3 * a + c]).sum();
                    let turn = |(a, r): (usize, &[f64; 3])| {
                        r[i] * place[3 * a + j] - r[j] * place[3 * a + i]
                    };
                    let turn: f64 = reference.iter().enumerate().map(turn).sum();
                    assert!(mean.abs() < 1e-13 && turn.abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn refuses_references_that_do_not_tell_a_rotation() {
        for bad in [
            vec![[0.0; 3]; 8],
            (0..8).map(|k| [f64::from(k), 0.0, 0.0]).collect(),
            vec![[f64::NAN; 3]; 8],
            vec![[f64::MAX; 3], [f64::MIN; 3], [0.0; 3], [1.0, 0.0, 0.0]],
        ] {
            let found = Position::new(bad.len(), Some(&bad));
            assert!(matches!(found, Err(RingError::Reference)), "{bad:?}");
        }
    }
}
