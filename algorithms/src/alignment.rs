//! Turning conformations of a molecule towards a reference conformation.
//!
//! The shapes of a molecule are its conformations up to rigid motion. To compare them as points of R^(3m) each is
//! moved to one position. Of all rigid motions the one that brings it nearest to a reference r is taken: the sum of
//! w_a |r_a - p_a|^2 is least (Kabsch 1976, a singular value decomposition of a 3 by 3 matrix). Then
//! the sum of w_a p_a is 0 and so is that of w_a r_a x p_a: with atomic masses for weights these are Eckart's
//! conditions (1935), with equal weights those of the optimal superposition.
//!
//! The rotation is determined, and changes smoothly from conformation to conformation, as long as the
//! [margin](Aligned::margin) stays above 0. A reference for which it does over all conformations should be chosen.

use crosscap_core::PointCloud;
use nalgebra::Matrix3;

/// Why conformations were not aligned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlignmentError {
    /// The numbers of atoms differ.
    #[error("found {found}, expected {expected}, 3 coordinates for each of {atoms} atoms")]
    Atoms {
        /// Coordinates, or places, found.
        found: String,
        /// Coordinates, or places, expected.
        expected: usize,
        /// Atoms.
        atoms: usize,
    },
    /// A weight is not a positive finite number.
    #[error("the weight of atom {atom} (from 0) is {value}: expected a positive finite number")]
    Weight {
        /// The atom.
        atom: usize,
        /// Its weight.
        value: f64,
    },
    /// The reference says nothing about a rotation.
    #[error(
        "the places of the reference conformation are on a line or not finite, so a rotation towards it is \
         not determined: give another reference"
    )]
    Reference,
    /// Two rotations bring a conformation equally near to the reference.
    #[error(
        "the rotation of conformation {row} (from 0) towards the reference is not determined (margin {margin:.1e} \
         of 1): give another reference"
    )]
    Undetermined {
        /// The conformation.
        row: usize,
        /// Its margin.
        margin: f64,
    },
}

/// Smallest margin with which a rotation counts as determined.
const LEAST_MARGIN: f64 = 1e-9;

/// A position for conformations of m atoms.
///
/// ```
/// use crosscap_algorithms::alignment::Alignment;
/// let reference = [[0., 0., 0.], [2., 0., 0.], [0., 1., 0.]];
/// let alignment = Alignment::new(&reference, &[12.0, 1.0, 1.0]).unwrap();
/// // The same triangle, turned by a right angle about the z axis and carried away.
/// let turned = [5., 5., 5., 5., 7., 5., 4., 5., 5.];
/// let found = alignment.align(&turned);
/// // The reference, with its center of mass at the origin.
/// for (atom, place) in reference.iter().enumerate() {
///     assert!((found.place[3 * atom] - (place[0] - 2.0 / 14.0)).abs() < 1e-12);
///     assert!((found.place[3 * atom + 1] - (place[1] - 1.0 / 14.0)).abs() < 1e-12);
/// }
/// assert!(found.margin > 0.1);
/// ```
#[derive(Clone, Debug)]
pub struct Alignment {
    /// The centered reference, scaled so that its weighted size is 1.
    reference: Vec<[f64; 3]>,
    /// Weights, of sum 1.
    weights: Vec<f64>,
}

/// A conformation in its position.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Aligned {
    /// Its coordinates, x, y, z of atom 0, of atom 1, ..
    pub place: Vec<f64>,
    /// How clearly the rotation is determined: with s1 >= s2 >= s3 the singular values of the weighted moment of
    /// reference and conformation, (s2 + s3) / s1, or (s2 - s3) / s1 when mirroring would bring it nearer; 0 when
    /// another rotation is as good, 2 at most.
    pub margin: f64,
}

/// A set of conformations in their positions.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AlignedCloud {
    /// The conformations.
    pub points: PointCloud<f64>,
    /// Least margin.
    pub margin: f64,
    /// Row of the least margin.
    pub row: usize,
}

impl Alignment {
    /// Position nearest to a reference, by weights (equal ones, or masses; only their ratios matter).
    ///
    /// # Errors
    /// [`AlignmentError::Atoms`] when the numbers of places and weights differ, [`AlignmentError::Weight`],
    /// [`AlignmentError::Reference`] for places on one line.
    pub fn new(reference: &[[f64; 3]], weights: &[f64]) -> Result<Self, AlignmentError> {
        let atoms = weights.len();
        if reference.len() != atoms {
            return Err(AlignmentError::Atoms {
                found: format!("a reference of {} places", reference.len()),
                expected: 3 * atoms,
                atoms,
            });
        }
        let wrong = |w: &f64| !(*w > 0.0 && w.is_finite());
        if let Some(atom) = weights.iter().position(wrong) {
            return Err(AlignmentError::Weight {
                atom,
                value: weights[atom],
            });
        }
        let largest = weights.iter().fold(0.0f64, |m, w| m.max(*w));
        let total: f64 = weights.iter().map(|w| w / largest).sum();
        let weights: Vec<f64> = weights.iter().map(|w| w / largest / total).collect();
        // Scaled before anything is squared.
        let flat = reference.as_flattened();
        let extent = flat.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        if !(extent > 0.0 && extent.is_finite() && flat.iter().all(|x| x.is_finite())) {
            return Err(AlignmentError::Reference);
        }
        let scaled: Vec<f64> = flat.iter().map(|x| x / extent).collect();
        let centered = centered(&scaled, &weights);
        let alignment = |scale: f64| Self {
            reference: centered
                .chunks_exact(3)
                .map(|p| [p[0] / scale, p[1] / scale, p[2] / scale])
                .collect(),
            weights: weights.clone(),
        };
        let size = |p: &[f64]| p.iter().map(|x| x * x).sum::<f64>();
        let weighted = centered.chunks_exact(3).zip(&weights);
        let square: f64 = weighted.map(|(p, w)| w * size(p)).sum();
        if square.is_nan() || square <= 0.0 {
            return Err(AlignmentError::Reference);
        }
        let alignment = alignment(square.sqrt());
        // The second singular value of the reference itself: 0 for a line.
        let own: Vec<f64> = alignment.reference.as_flattened().to_vec();
        let mut values: Vec<f64> = alignment
            .moment(&own)
            .symmetric_eigenvalues()
            .iter()
            .copied()
            .collect();
        values.sort_by(f64::total_cmp);
        if values[1].is_nan() || values[1] <= 1e-12 {
            return Err(AlignmentError::Reference);
        }
        Ok(alignment)
    }

    /// Number of atoms.
    pub fn atoms(&self) -> usize {
        self.weights.len()
    }

    /// The reference, centered, in a scale of its own.
    pub fn reference(&self) -> &[[f64; 3]] {
        &self.reference
    }

    fn moment(&self, place: &[f64]) -> Matrix3<f64> {
        let mut moment = Matrix3::zeros();
        for ((r, p), w) in self
            .reference
            .iter()
            .zip(place.chunks_exact(3))
            .zip(&self.weights)
        {
            for i in 0..3 {
                for j in 0..3 {
                    moment[(i, j)] += w * r[i] * p[j];
                }
            }
        }
        moment
    }

    /// Centers a conformation and turns it next to the reference; proper rotations only. O(m).
    ///
    /// # Panics
    /// When `place` has not 3 coordinates an atom.
    pub fn align(&self, place: &[f64]) -> Aligned {
        assert_eq!(place.len(), 3 * self.atoms(), "3 coordinates an atom");
        let centered = centered(place, &self.weights);
        let svd = self.moment(&centered).svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
            return Aligned {
                place: centered,
                margin: 0.0,
            };
        };
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| svd.singular_values[b].total_cmp(&svd.singular_values[a]));
        let handed = (u.determinant() * v.determinant()).signum();
        let mut sign = Matrix3::<f64>::identity();
        sign[(order[2], order[2])] = handed;
        let rotation = u * sign * v;
        let [first, second, third] = order.map(|k| svd.singular_values[k]);
        let turned = centered.chunks_exact(3).flat_map(|p| {
            [0, 1, 2].map(|i| {
                rotation[(i, 0)] * p[0] + rotation[(i, 1)] * p[1] + rotation[(i, 2)] * p[2]
            })
        });
        Aligned {
            place: turned.collect(),
            margin: if first > 0.0 {
                (second + handed * third) / first
            } else {
                0.0
            },
        }
    }

    /// The margin of a conformation as it stands: that of [`Aligned::margin`] when it is in its position, below 0
    /// when another rotation would bring it nearer.
    ///
    /// The moment of a conformation in Eckart position is symmetric; this is the sum of its two smaller
    /// eigenvalues over the largest.
    ///
    /// # Panics
    /// As [`Alignment::align`].
    pub fn margin(&self, place: &[f64]) -> f64 {
        assert_eq!(place.len(), 3 * self.atoms(), "3 coordinates an atom");
        let moment = self.moment(place);
        let symmetric = (moment + moment.transpose()) * 0.5;
        let mut values: Vec<f64> = symmetric.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        (values[0] + values[1]) / values[2].abs().max(f64::MIN_POSITIVE)
    }

    /// Aligns every row of a cloud. O(n m).
    ///
    /// # Errors
    /// [`AlignmentError::Atoms`] for points that have not 3 coordinates an atom;
    /// [`AlignmentError::Undetermined`] for the first conformation whose rotation is not determined.
    pub fn align_all(&self, cloud: &PointCloud<f64>) -> Result<AlignedCloud, AlignmentError> {
        if cloud.dimension() != 3 * self.atoms() {
            return Err(AlignmentError::Atoms {
                found: format!("points of R^{}", cloud.dimension()),
                expected: 3 * self.atoms(),
                atoms: self.atoms(),
            });
        }
        let mut coordinates = Vec::with_capacity(cloud.coordinates().len());
        let (mut least, mut at) = (f64::INFINITY, 0);
        for (row, place) in cloud.iter().enumerate() {
            let Aligned { place, margin } = self.align(place);
            let undetermined = AlignmentError::Undetermined { row, margin };
            // Rounding makes NaN of coordinates near the largest number.
            let finite = margin.is_finite() && place.iter().all(|x| x.is_finite());
            if !finite || margin <= LEAST_MARGIN {
                return Err(undetermined);
            }
            if margin < least {
                (least, at) = (margin, row);
            }
            coordinates.extend(place);
        }
        let points = PointCloud::new(cloud.dimension(), coordinates)
            .map_err(|_| AlignmentError::Reference)?;
        Ok(AlignedCloud {
            points,
            margin: least,
            row: at,
        })
    }
}

/// A conformation with its weighted center (weights of sum 1) at the origin.
fn centered(place: &[f64], weights: &[f64]) -> Vec<f64> {
    let mut mean = [0.0; 3];
    for (p, w) in place.chunks_exact(3).zip(weights) {
        (0..3).for_each(|c| mean[c] += w * p[c]);
    }
    let places = place.chunks_exact(3);
    places
        .flat_map(|p| [p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]])
        .collect()
}

#[cfg(test)]
mod tests;
