//! A double curve that ends inside a sheet.

use super::curve_end::{self, CurveEnd};
use super::patch::PATCH_POINTS;
use super::pinch_map::PinchMap;
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::PinchPointTuning;
use crosscap_core::{
    Decomposition, Error, Link, LinkKind, LocalPoints, Located, Rejection, SingularityModel,
};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A pinch point: the end of a double curve at which one sheet meets itself, as in Whitney's umbrella.
///
/// The sheet is the image of a disc under a map (u, v) that is even in u where v is 0: a point, the double
/// curve v = 0, and four quarters of the disc between that curve and the curve u = 0, along which the sheet
/// is folded more and more sharply towards the point. That fold is a curve of two cells: it lets every cell
/// meet the double curve from one side only. The map is a polynomial of degree 3.
///
/// Source: H. Whitney, The singularities of a smooth n-manifold in (2n - 1)-space, Annals of Mathematics
/// 45 (1944): up to smooth changes of coordinates the only stable one.
#[derive(Clone, Copy, Debug)]
pub struct PinchPoint {
    tolerance: Tolerance,
    tuning: PinchPointTuning,
}

/// Sectors of the disc that must all hold points.
const SECTORS: usize = 8;

/// Labels: the point, the double curve, the fold for v above and below 0, then the cells.
const POINT: u8 = 0;
const DOUBLE: u8 = 1;
const FIRST_CELL: u8 = 4;

fn fold(v: f64) -> u8 {
    if v >= 0.0 { 2 } else { 3 }
}

fn cell(u: f64, v: f64) -> u8 {
    FIRST_CELL + u8::from(u >= 0.0) + 2 * u8::from(v >= 0.0)
}

impl PinchPoint {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to the double curve or the fold is on it, nearer to both at the pinch point.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: PinchPointTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: PinchPointTuning) -> Self {
        Self { tuning, ..self }
    }

    /// The map of a neighborhood, and the parameters of all its points.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(4 * PATCH_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..local.fitted];
        let (map, square) = PinchMap::fit(points, local.radius).ok_or(Rejection::NoRealSolution)?;
        let sum = square * points.len() as f64;
        let residual = self.tolerance.residual(sum, points.len())?;
        let shift = (map.point() - all[local.center]).norm();
        if shift > self.tuning.end.reach * local.radius {
            return Err(Rejection::NoRealSolution);
        }
        let fit = Fit {
            parameters: all.iter().map(|x| map.foot(x)).collect(),
            map,
            all,
            residual,
            ep: self.tolerance.ep,
            tuning: self.tuning,
        };
        let off = fit.all[..local.fitted].iter().zip(&fit.parameters);
        let off = off.map(|(x, at)| (fit.map.at(*at) - x).norm());
        curve_end::follows(off, residual, fit.ep, self.tuning.end.astray)?;
        fit.surrounds(local.fitted, local.radius - shift)?;
        fit.has_room(local.radius, shift)?;
        Ok(fit)
    }
}

/// A neighborhood with its map.
struct Fit {
    map: PinchMap,
    all: Vec<Vector3<f64>>,
    parameters: Vec<[f64; 2]>,
    residual: f64,
    ep: f64,
    tuning: PinchPointTuning,
}

impl Fit {
    /// Refuses a sheet that does not lie all around the point, as far as the ball reaches to all sides of it.
    fn surrounds(&self, fitted: usize, reach: f64) -> Result<(), Rejection> {
        let mut held = [0usize; SECTORS];
        for (x, &at) in self.all[..fitted].iter().zip(&self.parameters) {
            if (x - self.map.point()).norm() < reach {
                let turn = self.map.angle(at) / TAU;
                held[((turn + 1.0) * SECTORS as f64) as usize % SECTORS] += 1;
            }
        }
        match held.iter().position(|&h| h == 0) {
            Some(stratum) => Err(Rejection::EmptyStratum { stratum, found: 0 }),
            None => Ok(()),
        }
    }

    /// Refuses a ball that shows too little of the fold. The point is `shift` off the center.
    fn has_room(&self, radius: f64, shift: f64) -> Result<(), Rejection> {
        let length = self.map.natural_length().ok_or(Rejection::NoRealSolution)?;
        let wide = self.tuning.fold_length * (self.ep * length).sqrt();
        let needed = wide.max(self.tuning.fold * self.ep);
        if radius - shift < needed {
            return Err(Rejection::NeighborhoodTooSmall {
                needed: needed + shift,
            });
        }
        Ok(())
    }
}

impl CurveEnd for Fit {
    fn strata(&self) -> &[u8] {
        &[0, 1, 1, 1, 2, 2, 2, 2]
    }

    fn cells(&self) -> &[u8] {
        &[4, 2, 2]
    }

    fn parameters(&self) -> usize {
        PinchMap::PARAMETERS
    }

    fn points(&self) -> &[Vector3<f64>] {
        &self.all
    }

    fn end(&self) -> Vector3<f64> {
        self.map.point()
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn ep(&self) -> f64 {
        self.ep
    }

    fn witness(&self) -> f64 {
        self.tuning.end.witness
    }

    fn locate(&self, row: usize) -> (u8, Vector3<f64>, u8) {
        let x = self.all[row];
        let [u, v] = self.parameters[row];
        let (on_double, on_fold) = (self.map.on_double(&x), self.map.on_fold(v));
        let (to_double, to_fold) = ((on_double - x).norm(), (on_fold - x).norm());
        let (place, cells) = if to_double < to_fold {
            (on_double, 4)
        } else {
            (on_fold, 2)
        };
        match (to_double < self.ep, to_fold < self.ep) {
            (true, true) => (POINT, self.map.point(), 0),
            (true, false) => (DOUBLE, place, cells),
            (false, true) => (fold(v), place, cells),
            (false, false) => (cell(self.map.off_fold([u, v]), v), place, cells),
        }
    }
}

impl SingularityModel for PinchPoint {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, _dimension: usize) -> bool {
        false
    }

    fn explains_ends(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::Pinch.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        Ok(self.fit(local)?.decomposition(local, rows))
    }

    fn name(&self) -> &str {
        "pinch-point"
    }
}

#[cfg(test)]
mod tests {
    use super::super::about_first;
    use super::*;

    const RADIUS: f64 = 0.8;

    /// Places of a surface in a ball about the origin; the first one is the center.
    fn ball(at: impl Fn(f64, f64) -> [f64; 3]) -> Vec<f64> {
        let grid = || (-20..=20).map(|k| f64::from(k) / 20.0);
        let all = grid().flat_map(|u| grid().map(move |v| (u, v)));
        std::iter::once([0.0; 3])
            .chain(all.map(|(u, v)| at(u + 0.003, v - 0.002)))
            .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS)
            .flatten()
            .collect()
    }

    fn decompose(coordinates: &[f64]) -> Result<Decomposition, Rejection> {
        PinchPoint::new(0.1, 0.05)
            .unwrap()
            .decompose(&about_first(coordinates, RADIUS))
    }

    #[test]
    fn labels_of_an_umbrella() {
        let places = ball(|u, v| [u * v, v, u * u]);
        let fit = decompose(&places).unwrap();
        assert!(
            fit.points[0].iter().all(|x| x.abs() < 0.01),
            "{:?}",
            fit.points
        );
        assert_eq!(fit.labels[0].index(), usize::from(POINT));
        // Two points are in one cell where u and v have the same signs, and there are four cells.
        let mut sides = [None; 4];
        for (x, label) in places.chunks_exact(3).zip(&fit.labels) {
            let label = label.index() as u8;
            if label >= FIRST_CELL {
                let side = (x[0] * x[1] > 0.0, x[1] > 0.0);
                let known = sides[usize::from(label - FIRST_CELL)].get_or_insert(side);
                assert_eq!(*known, side, "{x:?}");
            }
            if label == DOUBLE {
                assert!(x[1].abs() < 0.06 && x[2] > 0.0, "{x:?}");
            }
        }
        assert!((0..4).all(|k| sides[k].is_some() && !sides[..k].contains(&sides[k])));
    }

    #[test]
    fn a_plane_and_two_planes_are_none() {
        assert!(decompose(&ball(|u, v| [u, v, 0.1 * u * v])).is_err());
        let crossing = [ball(|u, v| [u, v, 0.5 * u]), ball(|u, v| [u, v, -0.5 * u])];
        assert!(decompose(&crossing.concat()).is_err());
        // One of them ends in the other.
        let ending = [
            ball(|u, v| [u, v, 0.5 * u]),
            ball(|u, v| [u, 0.5 * (v + 1.0), -0.5 * u]),
        ];
        assert!(decompose(&ending.concat()).is_err());
    }

    #[test]
    fn a_ball_that_shows_too_little_of_the_fold_is_to_be_wider() {
        let places: Vec<f64> = ball(|u, v| [u * v, v, u * u]);
        let small: Vec<f64> = places
            .chunks_exact(3)
            .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < 0.4 * 0.4)
            .flatten()
            .copied()
            .collect();
        let found = PinchPoint::new(0.1, 0.05)
            .unwrap()
            .decompose(&about_first(&small, 0.4));
        let Err(Rejection::NeighborhoodTooSmall { needed }) = found else {
            panic!("{found:?}");
        };
        assert!(needed > 0.6 && needed < 0.8, "{needed}");
    }
}
