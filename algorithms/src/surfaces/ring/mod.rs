//! Conformations of a ring molecule: the space of cyclo-octane (paper, section 5), and of other rings.

mod chart;
mod distances;
mod error;
mod net;
mod position;

#[cfg(test)]
mod tests;

pub use distances::RingGeometry;
pub use error::RingError;

use super::Random;
use chart::Scratch;
use crosscap_core::{Error, PointCloud};
use distances::FixedDistances;
use net::{DISC, Net};
use position::Position;
use std::f64::consts::TAU;

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
    fixed: FixedDistances,
    position: Position,
}

/// Conformations drawn by [`RingConformations::sample`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RingSample {
    /// The conformations, 3 coordinates an atom (x, y, z of atom 0, of atom 1, ..), in random order.
    pub points: PointCloud<f64>,
    /// For each the smooth piece of the surface it lies on, the larger piece first.
    pub pieces: Vec<u32>,
    /// Area of each piece, an estimate with an error of about a percent.
    pub areas: Vec<f64>,
    /// Number of charts the sample was drawn from.
    pub charts: usize,
    /// Share of the draws that were given up because the solver did not settle (beside the double curves).
    pub given_up: f64,
    /// How clearly the alignment is determined, the least over the charts: see
    /// [`RingConformations::alignment_margin`].
    pub margin: f64,
}

/// Conformations moved onto the surface by [`RingConformations::project`].
#[derive(Clone, Debug)]
pub struct RingProjection {
    /// For each point a place of the surface beside it.
    pub points: PointCloud<f64>,
    /// How far each point was from its place, in the unit of the bond lengths: a bound on its distance from the surface.
    pub moved: Vec<f64>,
}

/// Separation of the centers of charts, in units of the mean bond length (0.07 Angstrom for cyclo-octane).
const SEPARATION: f64 = 0.046;
/// Largest share of draws that may be given up.
const GIVEN_UP: f64 = 0.01;

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
    fn seed(&self, random: &mut Random) -> Result<Vec<f64>, f64> {
        let start = (0..self.dimension()).map(|_| self.fixed.scale * random.normal());
        let place = self.settle(start.collect(), false)?;
        Ok(self.position.alignment.align(&place).place)
    }

    /// Damped Gauss-Newton steps of least norm, in the slice if asked to stay there, until the fixed distances are right; else
    /// the largest deviation that is left.
    fn settle(&self, mut place: Vec<f64>, in_slice: bool) -> Result<Vec<f64>, f64> {
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

    /// Draws `count` conformations, near-uniform by area, also beside the double curves.
    ///
    /// The surface is covered by charts, each on one sheet, whose centers are a net: from random
    /// conformations charts spread over what is not covered yet. Then points are drawn in the tangent disc of every chart,
    /// lifted to the surface, and accepted with probability 1 / (number of charts of the same sheet whose disc holds
    /// the place). What remains is the variation of the area element within a chart, below 1 %.
    ///
    /// The same seed gives the same points on one platform; on another the eigenvectors behind the charts may
    /// differ in their last digits.
    ///
    /// O(count) after some 10,000 charts.
    ///
    /// # Errors
    /// [`RingError::Input`] when `count` is 0; [`RingError::NotClosed`] when no conformation with these lengths and
    /// angles is found; [`RingError::Dependent`], [`RingError::Unaligned`], [`RingError::TooBent`] when those that
    /// are found are no surface, or none that can be aligned or charted.
    pub fn sample(&self, count: usize, seed: u64) -> Result<RingSample, RingError> {
        if count == 0 {
            return Err(RingError::Input(Error::Parameter {
                name: "count",
                value: "0".into(),
                expected: "at least 1 conformation".into(),
            }));
        }
        let n = self.dimension();
        let separation = SEPARATION * self.fixed.scale;
        let net = Net::spread(self, separation, &mut Random::stream(seed, 0))?;
        let radius = DISC * separation;
        let sheets = net.sheets();
        let mut random = Random::stream(seed, 1);
        let mut scratch = Scratch::new(self);
        let mut coordinates = Vec::with_capacity(count * n);
        let mut labels: Vec<u32> = Vec::with_capacity(count);
        let mut weight = vec![0.0; sheets.pieces];
        let (mut draws, mut failures) = (0usize, 0usize);
        // Draws from a disc of full size.
        let mut per_chart = 0usize;
        let size: f64 = net.charts.iter().map(|c| c.scale * c.scale).sum();
        let expected = (3.0 * count as f64 / size) as usize + 1;
        while labels.len() < count {
            // Whole rounds: every chart gives as many draws as its disc is large.
            let round = expected
                .min(8)
                .max(if per_chart == 0 { expected / 2 } else { 1 });
            per_chart += round;
            for (k, chart) in net.charts.iter().enumerate() {
                // In proportion to the area of the disc, rounded up as often as its fraction says.
                let share = round as f64 * chart.scale * chart.scale;
                let more = chart.scale < 1.0 && random.uniform() < share.fract();
                for _ in 0..share as usize + usize::from(more) {
                    draws += 1;
                    let reach = radius * chart.scale * random.uniform().sqrt();
                    let (s, c) = libm::sincos(random.between(0.0, TAU));
                    if !chart.lift(self, [reach * c, reach * s], &mut scratch) {
                        failures += 1;
                        continue;
                    }
                    let holds = |&&other: &&u32| {
                        let other = &net.charts[other as usize];
                        let [a, b] = other.coordinates(&scratch.place);
                        a * a + b * b < (radius * other.scale).powi(2)
                    };
                    let cover = 1 + sheets.beside[k].iter().filter(holds).count();
                    let acceptance = 1.0 / cover as f64;
                    weight[sheets.piece[k] as usize] += acceptance;
                    if random.uniform() < acceptance {
                        coordinates.extend_from_slice(&scratch.place);
                        labels.push(sheets.piece[k]);
                    }
                }
            }
            let given_up = failures as f64 / draws as f64;
            if given_up > GIVEN_UP {
                return Err(RingError::TooBent { given_up });
            }
        }
        let disc = 0.5 * TAU * radius * radius;
        let areas = weight.iter().map(|w| w * disc / per_chart as f64).collect();
        let mut order = random.permutation(labels.len());
        order.truncate(count);
        Ok(RingSample {
            points: PointCloud::new(n, coordinates)?.select(&order),
            pieces: order.iter().map(|&k| labels[k]).collect(),
            areas,
            charts: net.charts.len(),
            given_up: failures as f64 / draws as f64,
            margin: net.margin,
        })
    }
}
