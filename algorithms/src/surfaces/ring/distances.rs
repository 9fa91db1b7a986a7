//! The distances that are fixed in a ring.

use super::error::RingError;
use nalgebra::DMatrix;

/// The bonds and angles of a ring of atoms.
///
/// ```
/// use crosscap_algorithms::surfaces::{RingConformations, RingGeometry};
/// // Oxocane: the oxygen (atom 0) has shorter bonds and another angle.
/// let mut oxocane = RingGeometry::regular(8, 1.52, 115.0);
/// (oxocane.bond_lengths[0], oxocane.bond_lengths[7]) = (1.43, 1.43);
/// oxocane.bond_angles[0] = Some(113.0);
/// assert_eq!(oxocane.degrees_of_freedom(), 2);
/// assert!(RingConformations::of(&oxocane).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RingGeometry {
    /// Length of the bond from each atom to the next one, the last one's to the first; any unit, which is that of
    /// the conformations.
    pub bond_lengths: Vec<f64>,
    /// Bond angle at each atom, degrees; `None` for an angle that is free.
    pub bond_angles: Vec<Option<f64>>,
    /// The conformation that others are turned towards, a place for each atom. `None` for that of the
    /// paper's data in a ring of eight, and for a regular polygon in other rings.
    pub reference: Option<Vec<[f64; 3]>>,
}

impl RingGeometry {
    /// Equal bonds, equal angles (degrees), all fixed.
    pub fn regular(atoms: usize, bond_length: f64, bond_angle_degrees: f64) -> Self {
        Self {
            bond_lengths: vec![bond_length; atoms],
            bond_angles: vec![Some(bond_angle_degrees); atoms],
            reference: None,
        }
    }

    /// Cyclo-octane: bonds of 1.52 Angstrom, angles of 115 degrees.
    pub fn cyclo_octane() -> Self {
        Self::regular(8, 1.52, 115.0)
    }

    /// Degrees of freedom where the fixed distances are independent: m atoms have 3m - 6 coordinates up to
    /// motion, the bonds fix m of them and every angle that is not free another one.
    pub fn degrees_of_freedom(&self) -> i64 {
        2 * self.bond_lengths.len() as i64 - 6 - self.bond_angles.iter().flatten().count() as i64
    }

    /// Refuses what is no surface or cannot close.
    pub(super) fn check(&self) -> Result<(), RingError> {
        let atoms = self.bond_lengths.len();
        let reference = self.reference.as_ref().map_or(atoms, Vec::len);
        for (what, found) in [
            ("bond angles", self.bond_angles.len()),
            ("reference places", reference),
        ] {
            if found != atoms {
                return Err(RingError::Count { what, found, atoms });
            }
        }
        let fixed = self.bond_angles.iter().flatten().count();
        let freedom = self.degrees_of_freedom();
        if freedom != 2 {
            return Err(RingError::DegreesOfFreedom {
                atoms,
                angles: fixed,
                freedom,
            });
        }
        for (bond, &value) in self.bond_lengths.iter().enumerate() {
            if !(value > 0.0 && value.is_finite()) {
                return Err(RingError::Length { bond, value });
            }
        }
        for (atom, angle) in self.bond_angles.iter().enumerate() {
            if let Some(value) = angle.filter(|a| !(*a > 0.0 && *a < 180.0)) {
                return Err(RingError::Angle { atom, value });
            }
        }
        let total: f64 = self.bond_lengths.iter().sum();
        for (bond, &length) in self.bond_lengths.iter().enumerate() {
            let others = total - length;
            if length >= others {
                return Err(RingError::LongBond {
                    bond,
                    length,
                    others,
                });
            }
        }
        let turn: f64 = self
            .bond_angles
            .iter()
            .map(|a| 180.0 - a.unwrap_or(0.0))
            .sum();
        // Equality is the plane convex ring, which is rigid.
        if turn <= 360.0 + 1e-9 {
            return Err(RingError::TooStraight { turn });
        }
        Ok(())
    }
}

/// The fixed distances of a ring: bonds, and the 1-3 distances that the angles amount to.
#[derive(Clone, Debug)]
pub(super) struct FixedDistances {
    pub atoms: usize,
    /// Two atoms and the square of their distance.
    pub pairs: Vec<(usize, usize, f64)>,
    /// Mean bond length.
    pub scale: f64,
}

impl FixedDistances {
    pub fn new(ring: &RingGeometry) -> Self {
        let atoms = ring.bond_lengths.len();
        let length = |bond: usize| ring.bond_lengths[bond % atoms];
        let bonds = (0..atoms).map(|k| (k, (k + 1) % atoms, length(k) * length(k)));
        // From atom k to atom k + 2, by the law of cosines at the atom between them.
        let across = (0..atoms).filter_map(|k| {
            let angle = ring.bond_angles[(k + 1) % atoms]?.to_radians();
            let (a, b) = (length(k), length(k + 1));
            let square = (a - b).powi(2) + 4.0 * a * b * libm::sin(0.5 * angle).powi(2);
            Some((k, (k + 2) % atoms, square))
        });
        Self {
            atoms,
            pairs: bonds.chain(across).collect(),
            scale: ring.bond_lengths.iter().sum::<f64>() / atoms as f64,
        }
    }

    /// Number of coordinates of a conformation.
    pub fn coordinates(&self) -> usize {
        3 * self.atoms
    }

    /// Squares of the fixed distances less what they should be. Returns the largest of them without their signs.
    pub fn residual(&self, place: &[f64], out: &mut [f64]) -> f64 {
        let mut largest = 0.0f64;
        for (&(p, q, square), out) in self.pairs.iter().zip(out) {
            let mut sum = -square;
            for c in 0..3 {
                let d = place[3 * p + c] - place[3 * q + c];
                sum += d * d;
            }
            *out = sum;
            largest = largest.max(sum.abs());
        }
        largest
    }

    /// The quadratic part of the residual as a bilinear form: the residual at x + v is that at x, plus its
    /// derivative along v, plus this form of (v, v), exactly.
    pub fn polar(&self, v: &[f64], w: &[f64]) -> Vec<f64> {
        let form = |&(p, q, _): &(usize, usize, f64)| {
            (0..3)
                .map(|c| (v[3 * p + c] - v[3 * q + c]) * (w[3 * p + c] - w[3 * q + c]))
                .sum()
        };
        self.pairs.iter().map(form).collect()
    }

    /// Derivative of the residual: one row a fixed distance.
    pub fn jacobian(&self, place: &[f64]) -> DMatrix<f64> {
        let mut jacobian = DMatrix::zeros(self.pairs.len(), self.coordinates());
        for (k, &(p, q, _)) in self.pairs.iter().enumerate() {
            for c in 0..3 {
                let d = 2.0 * (place[3 * p + c] - place[3 * q + c]);
                jacobian[(k, 3 * p + c)] = d;
                jacobian[(k, 3 * q + c)] = -d;
            }
        }
        jacobian
    }

    /// Largest deviation of a fixed distance from its value.
    pub fn deviation(&self, place: &[f64], residual: &mut [f64]) -> f64 {
        self.residual(place, residual);
        let each = self.pairs.iter().zip(residual);
        each.map(|(&(_, _, square), r)| ((*r + square).max(0.0).sqrt() - square.sqrt()).abs())
            .fold(0.0, f64::max)
    }
}
