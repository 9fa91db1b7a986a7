//! What the points say about their own density: the lengths that parameters are chosen from.

use crosscap_core::{Error, Neighbor, NeighborhoodOracle};
use serde::Serialize;

/// Rows whose neighbors are looked up, at most: the 99 % quantile of so many distances is that of all
/// within a few percent.
const ROWS: usize = 2000;
/// Points a neighborhood should hold. Measured on 71 small clouds of forty shapes: 60 to 80 do
/// everywhere, 30 to 40 on smooth closed surfaces only, and 250 are too many where a surface bends.
const NEIGHBORS: usize = 60;
/// A neighborhood holds at most this share of all points: of few points 60 would be half of the surface.
const SHARE: usize = 5;
/// Fewest other points in a neighborhood of the analysis.
const FEWEST: usize = 7;
/// Room for a place that is a little sparser than the rows that were looked up.
const ROOM: f64 = 1.1;
/// A point whose distances to its 60th and 15th neighbors are this often each other lies on a curve: about 4
/// times there, 2 times on a surface (above 2.7 by chance at one point of 300).
const ALONG_A_CURVE: f64 = 2.7;
/// A point whose seventh neighbor is farther than so many reaches lies by itself, and asks for nothing.
const BY_ITSELF: f64 = 3.0;
/// The rank of the neighbor that the spacing is read from: more are farther than a bend, fewer are chance.
const NEAR: usize = 15;

/// How densely the points lie, unit of the data.
///
/// All of it is read from the distances of points to their neighbors, so that it does not matter
/// where the distances come from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Density {
    /// Number of points.
    pub points: usize,
    /// The rank of the neighbor that [`Density::reach`] is measured to.
    pub neighbors: usize,
    /// Spacing of the points where they lie in the middle of all: 1 / sqrt(density), taken from
    /// the distance d to the k-th neighbor as d sqrt(pi / k) with k = 15.
    pub spacing: f64,
    /// The spacing that one point in a hundred is below.
    pub dense: f64,
    /// The spacing that one point in a hundred is above.
    pub sparse: f64,
    /// The distance within which 99 of 100 points of surfaces have [`Density::neighbors`] others, and
    /// points of curves, which need fewer, at least 7.
    pub reach: f64,
    /// The distance within which half of the points have so many others.
    pub usual_reach: f64,
}

impl Density {
    /// Measures the density of all points that `oracle` serves.
    ///
    /// Looks up the neighbors of 2000 rows at most, evenly picked.
    ///
    /// # Errors
    /// [`Error::Shape`] where there are fewer than [`Density::LEAST`] points, or where all distances are 0.
    pub fn of(oracle: &dyn NeighborhoodOracle<Scalar = f64>) -> Result<Self, Error> {
        let points = oracle.len();
        if points < Self::LEAST {
            return Err(Error::Shape {
                found: format!("{points} different points"),
                expected: format!("at least {}", Self::LEAST),
            });
        }
        let neighbors = (points / SHARE).clamp(Self::LEAST - 1, NEIGHBORS);
        let near = NEAR.min(neighbors);
        let rows = points.min(ROWS);
        let (mut short, mut long) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
        let (mut curves, mut fewest) = (Vec::new(), Vec::with_capacity(rows));
        let mut around: Vec<Neighbor<f64>> = Vec::new();
        for k in 0..rows {
            let row = (k as u128 * points as u128 / rows as u128) as usize;
            oracle.nearest(row, neighbors + 1, &mut around);
            // A sparse matrix may know of fewer neighbors.
            let at = |rank: usize| {
                around
                    .get(rank)
                    .or(around.last())
                    .map_or(0.0, |x| x.distance)
            };
            let (a, b) = (at(near), at(neighbors));
            let along = neighbors == NEIGHBORS && b > ALONG_A_CURVE * a;
            short.push(a);
            if along { &mut curves } else { &mut long }.push(b);
            fewest.push(at(FEWEST));
        }
        if long.is_empty() {
            long = curves;
        }
        short.sort_unstable_by(f64::total_cmp);
        long.sort_unstable_by(f64::total_cmp);
        let surfaces = quantile(&long, 0.99);
        let counted = fewest.iter().filter(|&&d| d <= BY_ITSELF * surfaces);
        let least = counted.fold(0.0, |a: f64, &b| a.max(b));
        let spacing = |q: f64| quantile(&short, q) * (std::f64::consts::PI / near as f64).sqrt();
        let density = Self {
            points,
            neighbors,
            spacing: spacing(0.5),
            dense: spacing(0.01),
            sparse: spacing(0.99),
            reach: surfaces.max(ROOM * least),
            usual_reach: quantile(&long, 0.5),
        };
        if density.usual_reach > 0.0 && density.spacing > 0.0 {
            return Ok(density);
        }
        Err(Error::Shape {
            found: "points that nearly all lie at one place".into(),
            expected: "points of a surface".into(),
        })
    }

    /// The density of points that lie everywhere as they do in the middle of all.
    pub(super) fn even(&self) -> Self {
        Self {
            dense: self.spacing,
            sparse: self.spacing,
            reach: self.usual_reach,
            ..self.clone()
        }
    }

    /// Fewest points that are worked on: what one neighborhood needs.
    pub const LEAST: usize = 8;
}

/// The value that the share `q` of sorted values is at most.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let last = sorted.len() - 1;
    sorted[((last as f64 * q).ceil() as usize).min(last)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::surfaces::Random;
    use crosscap_backends::euclidean::EuclideanOracle;
    use crosscap_core::PointCloud;

    fn density(rows: Vec<f64>) -> Result<Density, Error> {
        Density::of(&EuclideanOracle::new(PointCloud::new(3, rows)?)?)
    }

    /// A unit square of random points in the plane.
    fn square(count: usize, random: &mut Random) -> Vec<f64> {
        let row = |_| [random.uniform(), random.uniform(), 0.0];
        (0..count).flat_map(row).collect()
    }

    #[test]
    fn spacing_and_reach_are_those_of_the_density() {
        for seed in 0..5 {
            let found = density(square(10_000, &mut Random::new(seed))).unwrap();
            assert!((0.0095..0.0105).contains(&found.spacing), "{found:?}");
            // 60 points in a disc of radius 4.37 spacings, in half of one at the rim.
            assert!((0.042..0.046).contains(&found.usual_reach), "{found:?}");
            assert!((0.055..0.072).contains(&found.reach), "{found:?}");
        }
    }

    #[test]
    fn points_of_a_curve_do_not_widen_the_neighborhoods() {
        let random = &mut Random::new(3);
        let mut rows = square(10_000, random);
        let plain = density(rows.clone()).unwrap().reach;
        rows.extend((0..200).flat_map(|_| [0.5, 0.5, 0.05 + random.uniform()]));
        let found = density(rows).unwrap().reach;
        assert!(found < 1.2 * plain, "{found} {plain}");
    }

    #[test]
    fn points_at_one_place_are_refused() {
        assert!(density(vec![1.0; 30]).unwrap_err().is_input());
        assert!(density(vec![1.0; 9]).unwrap_err().is_input());
    }
}
