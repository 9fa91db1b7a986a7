//! The conformations of a ring, and ways onto their surface.

use super::distances::{FixedDistances, RingGeometry};
use super::error::RingError;
use super::position::Position;
use crate::surfaces::Random;
use crosscap_core::{Error, PointCloud};

/// The conformations of a ring with fixed bond lengths and bond angles, up to rigid motion.
///
/// A ring of m atoms has 3m - 6 coordinates up to motion; m bonds and a angles that are fixed leave 2m - 6 - a degrees of
/// freedom. That is a surface for a ring of eight whose angles are all fixed, of seven with one free
/// angle, and so on down to four with all of them free; no larger ring is one. For cyclo-octane (1.52 Angstrom, 115
/// degrees) it is a Klein bottle and a sphere that cross in two circles, in R^24, with Betti numbers 1, 1, 2 (S.
/// Martin, A. Thompson, E. A. Coutsias, J.-P. Watson, Topology of cyclo-octane energy landscape, J. Chem. Phys. 132,
/// 2010).
///
/// Each conformation is centered and turned into the position that is nearest to a reference
/// conformation (Kabsch); it then satisfies the Eckart condition, sum over atoms of reference x place = 0.
///
/// ```
/// use crosscap_algorithms::surfaces::RingConformations;
/// assert!(RingConformations::new(8, 1.52, 115.0).is_ok());
/// let refused = RingConformations::new(7, 1.52, 115.0).unwrap_err();
/// assert!(refused.to_string().contains("leave 1 degrees of freedom, and a surface has 2: leave 1 bond angle free"));
/// ```
#[derive(Clone, Debug)]
pub struct RingConformations {
    pub(super) fixed: FixedDistances,
    pub(super) position: Position,
}

/// Conformations moved onto the surface by [`RingConformations::project`].
#[derive(Clone, Debug)]
pub struct RingProjection {
    /// For each point a place of the surface beside it.
    pub points: PointCloud<f64>,
    /// How far each point was from its place, in the unit of the bond lengths: a bound on its distance from the surface.
    pub moved: Vec<f64>,
}

impl RingConformations {
    /// Ring of `atoms` with the given bond length and bond angle, all of them equal and fixed.
    ///
    /// # Errors
    /// As [`RingConformations::of`].
    pub fn new(atoms: usize, bond_length: f64, bond_angle_degrees: f64) -> Result<Self, RingError> {
        Self::of(&RingGeometry::regular(
            atoms,
            bond_length,
            bond_angle_degrees,
        ))
    }

    /// Ring with the given bonds and angles.
    ///
    /// # Errors
    /// [`RingError::DegreesOfFreedom`] when the conformations are not a surface; [`RingError::Length`],
    /// [`RingError::Angle`], [`RingError::Count`], [`RingError::Reference`] for input that has no meaning;
    /// [`RingError::LongBond`] and [`RingError::TooStraight`] when the ring cannot close.
    pub fn of(ring: &RingGeometry) -> Result<Self, RingError> {
        ring.check()?;
        let fixed = FixedDistances::new(ring);
        let position = Position::new(fixed.atoms, ring.reference.as_deref())?;
        Ok(Self { fixed, position })
    }

    /// Cyclo-octane: 8 carbon atoms, bonds of 1.52 Angstrom, angles of 115 degrees.
    pub fn cyclo_octane() -> Self {
        Self::of(&RingGeometry::cyclo_octane()).expect("these values are within the ranges")
    }

    /// N, the number of coordinates of a conformation: three an atom.
    pub fn dimension(&self) -> usize {
        self.fixed.coordinates()
    }

    fn check_dimension(&self, cloud: &PointCloud<f64>) -> Result<(), Error> {
        if cloud.dimension() != self.dimension() {
            return Err(Error::Shape {
                found: format!("points of R^{}", cloud.dimension()),
                expected: format!("{} coordinates, three an atom", self.dimension()),
            });
        }
        Ok(())
    }

    /// Largest deviation of a fixed distance from its value, in the unit of the bond lengths, over a set of
    /// conformations.
    ///
    /// # Errors
    /// [`Error::Shape`] for points that have not three coordinates an atom.
    pub fn largest_deviation(&self, cloud: &PointCloud<f64>) -> Result<f64, Error> {
        self.check_dimension(cloud)?;
        let mut residual = vec![0.0; self.fixed.pairs.len()];
        let each = cloud.iter().map(|p| self.fixed.deviation(p, &mut residual));
        Ok(each.fold(0.0, f64::max))
    }

    /// How clearly the nearest rotation towards the reference is determined at each of a set of aligned
    /// conformations: the sum of the two smallest eigenvalues of the moment with the reference over the largest.
    /// Positive when the conformation is the nearest of its rotations, 0 when another one is as near. Where it stays above
    /// 0 the aligned conformations are a continuous image of the conformations up to motion.
    ///
    /// # Errors
    /// As [`RingConformations::largest_deviation`].
    pub fn alignment_margin(&self, cloud: &PointCloud<f64>) -> Result<Vec<f64>, Error> {
        self.check_dimension(cloud)?;
        Ok(cloud
            .iter()
            .map(|p| self.position.alignment.margin(p))
            .collect())
    }

    /// Moves aligned conformations onto the surface: to the slice of the Eckart condition, then by damped
    /// Gauss-Newton steps of least norm within it. Near the surface this ends, up to second order, in its nearest
    /// place.
    ///
    /// # Errors
    /// As [`RingConformations::largest_deviation`]; [`RingError::NotClosed`] for a conformation from which the steps
    /// do not settle.
    pub fn project(&self, cloud: &PointCloud<f64>) -> Result<RingProjection, RingError> {
        self.check_dimension(cloud)?;
        let slice = &self.position.slice;
        let mut coordinates = Vec::with_capacity(cloud.coordinates().len());
        let mut moved = Vec::with_capacity(cloud.len());
        for p in cloud.iter() {
            let flat = slice * slice.tr_mul(&nalgebra::DVector::from_column_slice(p));
            let place = self
                .settle(flat.as_slice().to_vec(), true)
                .map_err(|deviation| RingError::NotClosed {
                    starts: 1,
                    deviation,
                })?;
            moved.push(crosscap_core::squared_distance(p, &place).sqrt());
            coordinates.extend(place);
        }
        Ok(RingProjection {
            points: PointCloud::new(self.dimension(), coordinates)?,
            moved,
        })
    }

    /// A place of the surface near a random one, in aligned position, or how far from it the search ended.
    pub(super) fn seed(&self, random: &mut Random) -> Result<Vec<f64>, f64> {
        let start = (0..self.dimension()).map(|_| self.fixed.scale * random.normal());
        let place = self.settle(start.collect(), false)?;
        Ok(self.position.alignment.align(&place).place)
    }

    /// Damped Gauss-Newton steps of least norm, in the slice if asked to stay there, until the fixed distances are right; else
    /// the largest deviation that is left.
    pub(super) fn settle(&self, mut place: Vec<f64>, in_slice: bool) -> Result<Vec<f64>, f64> {
        let square = self.fixed.scale.powi(2);
        let mut residual = vec![0.0; self.fixed.pairs.len()];
        for _ in 0..200 {
            if self.fixed.residual(&place, &mut residual) < 1e-13 * square {
                return Ok(place);
            }
            let mut jacobian = self.fixed.jacobian(&place);
            if in_slice {
                let slice = &self.position.slice;
                jacobian = (jacobian * slice) * slice.transpose();
            }
            let mut gram = &jacobian * jacobian.transpose();
            for k in 0..residual.len() {
                gram[(k, k)] += 1e-9 * square;
            }
            let Some(cholesky) = gram.cholesky() else {
                break;
            };
            let weights = cholesky.solve(&nalgebra::DVector::from_column_slice(&residual));
            let step = jacobian.tr_mul(&weights);
            place.iter_mut().zip(&step).for_each(|(x, s)| *x -= s);
        }
        if self.fixed.residual(&place, &mut residual) < 1e-10 * square {
            return Ok(place);
        }
        Err(self.fixed.deviation(&place, &mut residual))
    }
}
