//! How the points lie around a place.

use crosscap_algorithms::principal::PrincipalFrame;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{Neighbor, NeighborhoodOracle, PointCloud};
use nalgebra::DMatrix;

/// The smaller neighborhood: enough for a plane.
const FEW: usize = 15;
/// The larger one has four times as many points, and on a surface twice the radius.
const MANY: usize = 60;
/// Points around a place grow with the power of the radius that the dimension is; beyond this the points fill a space.
const VOLUME: f64 = 2.6;
/// A point whose nearest neighbor is farther than this share of the way to its 15th lies by itself: on a surface once in
/// 12,000 points, (1 - 0.7^2)^14.
const ALONE: f64 = 0.7;
/// A thickness in spacings below which points count as lying on a sheet.
const THIN: f64 = 0.25;
/// A thickness that grows less than this between the two neighborhoods is that of the points themselves.
const STEADY: f64 = 1.5;
/// A thickness that grows more than this bends: the height over a plane grows with the square of the radius.
const BENDING: f64 = 2.7;
/// A sheet is flat enough for charts when its thickness is at most this share of the radius.
const FLAT: f64 = 0.08;
/// Where a quadratic height leaves more than this share of the distances from the plane, and flat sheets are around, what bends is an edge. Of places that looked bent
/// none did on spheres and saddles, up to 0.09 on tori; on parabolas and waves whose bend has a radius of 2.4 spacings 0 and 0.15, of 1.7 spacings 0.03 and 0.4, of 1.2 spacings
/// 0.6; at edges of 60 to 120 degrees, corners of a box and walls 0.75 to 1.
const EDGED: f64 = 0.4;
/// Least share of the points around that are on flat sheets, at an edge.
const AROUND: f64 = 0.3;
/// One of so many of the points around is asked for that.
const STRIDE: usize = 4;
/// Terms of a quadratic height over a plane.
const TERMS: usize = 6;

/// How the points lie around a place, at two sizes of a neighborhood.
///
/// The thickness is the root mean squared distance of the points from the plane that fits them best.
/// Between a neighborhood and one of twice the radius it stays as it is where points scatter across
/// a sheet, doubles where sheets meet or the points fill a space, and grows fourfold where one sheet bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Spacing of the points, unit of the data.
    pub spacing: f64,
    /// The power of the radius with which the number of points grows.
    pub growth: f64,
    /// Thickness of the 15 nearest points, unit of the data.
    pub thickness: f64,
    /// Thickness of the 60 nearest points, unit of the data.
    pub wide_thickness: f64,
    /// Distance of the 60th point, unit of the data.
    pub radius: f64,
    /// Distance of the nearest point as a share of that of the 15th.
    pub apart: f64,
    /// What a quadratic height leaves of the thickness of the 60 nearest points, as a share of it.
    pub left: f64,
    /// Share of the points around that are on flat sheets, as their own 15 nearest points say.
    pub flat: f64,
}

/// What the surroundings of a place look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// A sheet that is flat at this density.
    Flat,
    /// A sheet that bends too much for this density.
    Bent,
    /// Flat sheets at an angle.
    Edged,
    /// A sheet across which the points scatter.
    Noisy,
    /// Points that fill a space of more than two dimensions.
    Solid,
    /// Several sheets.
    Meeting,
    /// A point by itself.
    Alone,
}

impl Surroundings {
    /// The surroundings of a row of a cloud that `oracle` serves; none for fewer than 61 points.
    pub fn of(oracle: &EuclideanOracle<f64>, row: usize) -> Option<Self> {
        let mut near: Vec<Neighbor<f64>> = Vec::new();
        oracle.nearest(row, MANY + 1, &mut near);
        let (small, radius) = (near.get(FEW)?.distance, near.get(MANY)?.distance);
        if small <= 0.0 || radius <= small {
            return None;
        }
        let cloud = oracle.cloud();
        Some(Self {
            spacing: small * (std::f64::consts::PI / FEW as f64).sqrt(),
            growth: (MANY as f64 / FEW as f64).ln() / (radius / small).ln(),
            thickness: thickness(cloud, &near[..=FEW]),
            wide_thickness: thickness(cloud, &near),
            radius,
            apart: near[1].distance / small,
            left: left_by_quadratic(cloud, &near),
            flat: flat_share(oracle, &near),
        })
    }

    /// What they look like.
    pub(super) fn look(&self) -> Look {
        let grown = self.wide_thickness / self.thickness.max(f64::MIN_POSITIVE);
        if self.apart > ALONE {
            Look::Alone
        } else if self.wide_thickness <= FLAT * self.radius {
            Look::Flat
        } else if self.growth > VOLUME && grown > STEADY {
            Look::Solid
        } else if self.thickness > THIN * self.spacing && grown < STEADY {
            Look::Noisy
        } else if grown > BENDING && self.left > EDGED && self.flat >= AROUND {
            Look::Edged
        } else if grown > BENDING {
            Look::Bent
        } else {
            Look::Meeting
        }
    }

    /// How many times as many points would make the sheet flat enough.
    pub(super) fn wanted(&self) -> f64 {
        // Thickness over radius falls with the radius, and that with the root of the number of points.
        (self.wide_thickness / (FLAT * self.radius)).powi(2)
    }
}

/// Root mean squared distance of points from their best plane.
fn thickness(cloud: &PointCloud<f64>, points: &[Neighbor<f64>]) -> f64 {
    let frame = PrincipalFrame::of(cloud, points.iter().map(|x| x.index));
    frame.variances.iter().skip(2).sum::<f64>().sqrt()
}

/// What the quadratic height of least squares over the best plane of points leaves of their distances from it, as a share of these; 0 where they are in it.
fn left_by_quadratic(cloud: &PointCloud<f64>, points: &[Neighbor<f64>]) -> f64 {
    let frame = PrincipalFrame::of(cloud, points.iter().map(|x| x.index));
    let (count, rank) = (points.len(), frame.rank());
    let mut all = Vec::with_capacity(count * rank);
    for point in points {
        frame.project(cloud.point(point.index), rank, &mut all);
    }
    let unit = frame.variances[0].sqrt();
    if rank < 3 || count <= TERMS || unit <= 0.0 {
        return 0.0;
    }
    let terms = DMatrix::from_fn(count, TERMS, |row, term| {
        let [a, b] = [0, 1].map(|axis| all[row * rank + axis] / unit);
        [1.0, a, b, a * a, a * b, b * b][term]
    });
    let heights = DMatrix::from_fn(count, rank - 2, |row, k| all[row * rank + 2 + k] / unit);
    let basis = terms.qr().q();
    let left = &heights - &basis * (basis.transpose() * &heights);
    let of = |heights: &DMatrix<f64>, free: usize| heights.norm_squared() / free as f64;
    let thickness = of(&heights, count);
    if thickness <= 0.0 {
        return 0.0;
    }
    (of(&left, count - TERMS) / thickness).sqrt()
}

/// Share of points that are on flat sheets: their 15 nearest points are.
fn flat_share(oracle: &EuclideanOracle<f64>, points: &[Neighbor<f64>]) -> f64 {
    let mut near: Vec<Neighbor<f64>> = Vec::new();
    let mut flat = |point: &Neighbor<f64>| {
        oracle.nearest(point.index, FEW + 1, &mut near);
        let radius = near.last().map_or(0.0, |x| x.distance);
        thickness(oracle.cloud(), &near) <= FLAT * radius
    };
    let asked = points.iter().step_by(STRIDE);
    let of = asked.len();
    asked.filter(|point| flat(point)).count() as f64 / of.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::surfaces::Random;

    /// What most of the points near the middle of a cloud look like.
    fn looks(row: impl Fn(&mut Random) -> [f64; 3], count: usize) -> Look {
        let random = &mut Random::new(5);
        let rows: Vec<f64> = (0..count).flat_map(|_| row(random)).collect();
        let oracle = EuclideanOracle::new(PointCloud::new(3, rows).unwrap()).unwrap();
        let middle = |&row: &usize| {
            let place = oracle.cloud().point(row);
            place[0].abs() < 0.2 && place[1].abs() < 0.2
        };
        let found = (0..count).filter(middle).take(25);
        let all: Vec<Look> = found
            .map(|row| Surroundings::of(&oracle, row).unwrap().look())
            .collect();
        let times = |look: &Look| all.iter().filter(|other| *other == look).count();
        *all.iter().max_by_key(|look| times(look)).unwrap()
    }

    fn at(random: &mut Random) -> [f64; 2] {
        [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]
    }

    #[test]
    fn kinds_of_surroundings_are_told_apart() {
        let flat = |r: &mut Random| [at(r)[0], at(r)[1], 0.0];
        assert_eq!(looks(flat, 4000), Look::Flat);
        let noisy = |r: &mut Random| [at(r)[0], at(r)[1], 0.03 * r.normal()];
        assert_eq!(looks(noisy, 4000), Look::Noisy);
        let solid = |r: &mut Random| [at(r)[0], at(r)[1], at(r)[0]];
        assert_eq!(looks(solid, 4000), Look::Solid);
        let bent = |r: &mut Random| {
            let [x, y] = at(r);
            [x, y, 2.5 * x * x]
        };
        assert_eq!(looks(bent, 800), Look::Bent);
    }

    /// How many points within `reach` of the plane x = 0 look bent, and how many as at an edge.
    fn bent_and_edged(
        row: impl Fn(&mut Random) -> [f64; 3],
        count: usize,
        reach: f64,
    ) -> [usize; 2] {
        let random = &mut Random::new(5);
        let rows: Vec<f64> = (0..count).flat_map(|_| row(random)).collect();
        let oracle = EuclideanOracle::new(PointCloud::new(3, rows).unwrap()).unwrap();
        let inside = |&row: &usize| {
            let place = oracle.cloud().point(row);
            place[0].abs() < reach && place[1].abs() < 0.8
        };
        let looks = (0..count)
            .filter(inside)
            .filter_map(|row| Surroundings::of(&oracle, row));
        let all: Vec<Look> = looks.map(|a| a.look()).collect();
        [Look::Bent, Look::Edged].map(|look| all.iter().filter(|other| **other == look).count())
    }

    #[test]
    fn an_edge_is_no_bend_that_more_points_resolve() {
        let edge = |r: &mut Random| {
            let [x, y] = at(r);
            [x, y, x.abs()]
        };
        let wall = |r: &mut Random| match at(r) {
            [x, y] if x < 0.3 => [(x + 0.35) / 0.65, y, 0.0],
            [x, y] => [0.0, y, x - 0.3],
        };
        for [bent, edged] in [
            bent_and_edged(edge, 3000, 0.15),
            bent_and_edged(wall, 3000, 0.15),
        ] {
            assert!(edged > 40 && edged > bent, "{edged} {bent}");
        }
        let wave = |r: &mut Random| {
            let [x, y] = at(r);
            [x, y, 0.3 * (4.0 * x).sin()]
        };
        let [bent, edged] = bent_and_edged(wave, 1600, 1.0);
        assert!(bent > 40 && 4 * edged < bent, "{edged} {bent}");
    }
}
