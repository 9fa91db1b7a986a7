//! Two sheets that touch without crossing.

use super::patch::{PATCH_POINTS, QuadraticPatch};
use crate::principal::PrincipalFrame;
use crosscap_core::{Neighbor, NeighborhoodOracle, PointCloud, Scalar};
use nalgebra::{Matrix2, SymmetricEigen, Vector2, Vector3};

/// Points that are looked at: a hundred a sheet.
const POINTS: usize = 200;
/// Neighborhoods that are looked at, each nearer to the place than the one before.
const STEPS: usize = 4;
/// Rounds in which points change sheets.
const ROUNDS: usize = 15;
/// Farthest that a neighborhood that decides is centered from the place, in its radii.
const CENTERED: f64 = 0.3;
/// Least share of the points that is on either sheet; 0.3 and more where one of a plate and a cylinder was half as dense.
const SHARE: f64 = 0.2;
/// Most that two sheets leave of what one sheet leaves of the points, as a share: 0.007 and less at spheres, plates and cylinders that touch, 0.1 and more where
/// sheets cross at 20 degrees and above, at creases, in noise and where one sheet bends.
const LEFT: f64 = 0.08;
/// Least that one sheet leaves, in spacings; below it there is one sheet. It was 0.14 where a sphere touches a cylinder from inside.
const LEAST: f64 = 0.05;
/// Widest gap between sheets that touch, in spacings; less cannot be told from none.
const GAP: f64 = 0.2;
/// Curvature of the gap along the flatter direction, as a share of that along the other, below which the sheets touch along a curve.
const FLAT: f64 = 0.1;

/// A place where two sheets touch without crossing, in a point or along a curve.
///
/// Over one plane both sheets are the graphs of functions, and where they touch the difference of the two, the gap between the sheets, begins with its
/// second order: it vanishes at the place and grows to all sides. Where sheets cross, the difference changes its sign, and no two functions of
/// second order of which one is above the other describe the points. So the two nearest such functions are fitted, one to the points
/// above a sheet between them and one to those below, and it is asked what they leave of the points, and where and how fast the gap grows.
///
/// Moving, turning, mirroring and scaling the points changes nothing but the place and the lengths.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tangency {
    /// The place, unit of the data.
    pub place: Vec<f64>,
    /// The row that is nearest to it of those that were looked at.
    pub row: usize,
    /// Spacing of the points on a sheet, unit of the data.
    pub spacing: f64,
    /// Second derivatives of the gap along its two principal directions, the smaller first, one over the unit of the data. Next to
    /// none along a curve in which the sheets touch.
    pub curvatures: [f64; 2],
}

impl Tangency {
    /// The place near a row where two sheets touch, if the 200 points nearest to it show two sheets whose gap closes there.
    ///
    /// O(N^3 + k N^2) for each of four neighborhoods of k points in R^N at most.
    pub fn near<S: Scalar>(
        cloud: &PointCloud<S>,
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        row: usize,
    ) -> Option<Self> {
        let mut near: Vec<Neighbor<S>> = Vec::new();
        let mut center = row;
        for _ in 0..STEPS {
            oracle.nearest(center, POINTS, &mut near);
            let (found, off, closes) = Self::of(cloud, center, &near)?;
            // Farther away terms of third order say as much of the gap.
            if off <= CENTERED {
                return closes.then_some(found);
            }
            if found.row == center {
                return None;
            }
            center = found.row;
        }
        None
    }

    /// What the points nearest to a row show, how far the place is from the row, in radii of the neighborhood, and whether the gap closes there; none
    /// where they are not those of two sheets whose gap is least in one place or along a curve.
    fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        center: usize,
        near: &[Neighbor<S>],
    ) -> Option<(Self, f64, bool)> {
        let radius = near.last()?.distance.as_f64();
        if cloud.dimension() < 3 || near.len() < POINTS || radius <= 0.0 {
            return None;
        }
        let frame = PrincipalFrame::of(cloud, near.iter().map(|x| x.index));
        let local = |point: &[S]| {
            let mut place = Vec::with_capacity(3);
            frame.project(point, 3, &mut place);
            Vector3::from_column_slice(&place)
        };
        let middle = local(cloud.point(center)).xy();
        let over = |x: Vector3<f64>| (x - middle.push(0.0)) / radius;
        let points: Vec<Vector3<f64>> = (near.iter())
            .map(|x| over(local(cloud.point(x.index))))
            .collect();
        let across = frame.variances.iter().skip(3).sum::<f64>() / (radius * radius);
        let spacing = (std::f64::consts::TAU / points.len() as f64).sqrt();
        let graphs = Graphs::of(&points)?;
        let fits = (graphs.left.powi(2) + across).sqrt() <= LEFT * graphs.one
            && graphs.one >= LEAST * spacing;
        let gap = graphs.gap();
        if !fits || !gap.opens() {
            return None;
        }
        // Beyond the neighborhood its second order says only which way.
        let at = gap.lowest / gap.lowest.norm().max(1.0);
        let place = at.push(graphs.height(at));
        let nearest = (near.iter().zip(&points))
            .min_by(|a, b| (a.1 - place).norm().total_cmp(&(b.1 - place).norm()))?;
        let lifted = frame.lift_vector((place * radius + middle.push(0.0)).as_slice());
        let found = Self {
            place: lifted.iter().zip(&frame.mean).map(|(x, m)| x + m).collect(),
            row: nearest.0.index,
            spacing: spacing * radius,
            curvatures: gap.curvatures.map(|x| x / radius),
        };
        Some((found, gap.lowest.norm(), gap.closes(spacing)))
    }

    /// The distance from the place beyond which the sheets are farther apart than `gap`, unit of the data; none where they touch along a curve.
    pub fn apart(&self, gap: f64) -> Option<f64> {
        let [flatter, steeper] = self.curvatures;
        (flatter > FLAT * steeper).then(|| (2.0 * gap / flatter).sqrt())
    }
}

/// Two sheets over a plane, one above the other.
struct Graphs {
    upper: QuadraticPatch,
    lower: QuadraticPatch,
    /// Root mean squared height over one sheet.
    one: f64,
    /// The same over the nearer of the two.
    left: f64,
}

impl Graphs {
    /// The two sheets nearest to points over the plane of the first two axes, in a ball of radius 1.
    fn of(points: &[Vector3<f64>]) -> Option<Self> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut sheet = QuadraticPatch::plane(Vector3::zeros(), axes);
        let count = points.len() as f64;
        let least = PATCH_POINTS.max((SHARE * count) as usize);
        if !sheet.fit(points.iter().copied(), 1.0) {
            return None;
        }
        let heights = points.iter().map(|x| sheet.height(x).0);
        let one = (heights.map(|h| h * h).sum::<f64>() / count).sqrt();
        let mut above: Vec<bool> = points.iter().map(|x| sheet.height(x).0 > 0.0).collect();
        let (mut upper, mut lower) = (sheet.clone(), sheet);
        for _ in 0..ROUNDS {
            for (is_upper, sheet) in [(true, &mut upper), (false, &mut lower)] {
                let own = points.iter().zip(&above).filter(|x| *x.1 == is_upper);
                if own.clone().count() < least || !sheet.fit(own.map(|x| *x.0), 1.0) {
                    return None;
                }
            }
            let nearer = |x: &Vector3<f64>| upper.height(x).0.abs() < lower.height(x).0.abs();
            let next: Vec<bool> = points.iter().map(nearer).collect();
            if next == above {
                break;
            }
            above = next;
        }
        let off = (points.iter()).map(|x| upper.height(x).0.abs().min(lower.height(x).0.abs()));
        Some(Self {
            left: (off.map(|h| h * h).sum::<f64>() / count).sqrt(),
            one,
            upper,
            lower,
        })
    }

    /// The gap between the sheets.
    fn gap(&self) -> Gap {
        let (upper, lower) = (self.upper.coefficients(), self.lower.coefficients());
        let [c, x, y, xx, xy, yy] = std::array::from_fn(|k| upper[k] - lower[k]);
        let half = Matrix2::new(xx, xy / 2.0, xy / 2.0, yy);
        let eigen = SymmetricEigen::new(half);
        let slopes = eigen.eigenvectors.transpose() * Vector2::new(x, y);
        let steepest = eigen.eigenvalues.max();
        let mut gap = Gap {
            least: c,
            lowest: Vector2::zeros(),
            slope: 0.0,
            curvatures: [eigen.eigenvalues.min(), steepest].map(|x| 2.0 * x),
        };
        for k in 0..2 {
            let (curvature, slope) = (eigen.eigenvalues[k], slopes[k]);
            if curvature > FLAT * steepest {
                let step = -slope / (2.0 * curvature);
                gap.least += slope * step / 2.0;
                gap.lowest += eigen.eigenvectors.column(k) * step;
            } else {
                gap.slope = slope.abs();
            }
        }
        gap
    }

    /// Mean height of the two sheets.
    fn height(&self, at: Vector2<f64>) -> f64 {
        let foot = at.push(0.0);
        // A point of the plane is below the sheet by the height of the sheet.
        -(self.upper.height(&foot).0 + self.lower.height(&foot).0) / 2.0
    }
}

/// The gap between two sheets, of second order.
struct Gap {
    /// Its least value.
    least: f64,
    /// Where that is: of the places along a curve in which it does not change, the one nearest to the origin.
    lowest: Vector2<f64>,
    /// How fast it grows along a direction in which it is not curved.
    slope: f64,
    /// Its second derivatives, the smaller first.
    curvatures: [f64; 2],
}

impl Gap {
    /// Whether it has a least value and grows from there.
    fn opens(&self) -> bool {
        let [flatter, steeper] = self.curvatures;
        steeper > 0.0 && flatter >= -FLAT * steeper
    }

    /// Whether its least value is none, as far as the points tell, along all of a curve if it is one.
    fn closes(&self, spacing: f64) -> bool {
        self.least.abs() <= GAP * spacing && self.slope <= GAP * spacing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::surfaces::Random;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    type Place = [f64; 3];

    /// What is seen from the row nearest to a place among so many points that `draw` makes.
    fn seen(draw: impl Fn(&mut Random) -> Place, from: Place) -> Option<Tangency> {
        let random = &mut Random::new(5);
        let rows: Vec<Place> = (0..3000).map(|_| draw(random)).collect();
        near(3, &rows.concat(), &from)
    }

    fn near(dimension: usize, rows: &[f64], from: &[f64]) -> Option<Tangency> {
        let cloud = PointCloud::new(dimension, rows.to_vec()).unwrap();
        let off = |row: &[f64]| {
            row.iter()
                .zip(from)
                .map(|(x, y)| (x - y).powi(2))
                .sum::<f64>()
        };
        let row = (0..cloud.len())
            .min_by(|&a, &b| off(cloud.point(a)).total_cmp(&off(cloud.point(b))))
            .unwrap();
        let metric = Euclidean::new(cloud.clone());
        Tangency::near(&cloud, &BruteForceOracle::new(&metric), row)
    }

    fn at(random: &mut Random) -> [f64; 2] {
        [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]
    }

    /// One of two sheets over the square: `z = 0`, or as high above it as `gap` says.
    fn over(random: &mut Random, gap: impl Fn(f64, f64) -> f64) -> Place {
        let [x, y] = at(random);
        let upper = random.between(0.0, 1.0) < 0.5;
        [x, y, if upper { gap(x, y) } else { 0.0 }]
    }

    #[test]
    fn sheets_that_touch_in_a_point_are_seen_from_around_it() {
        let bowl = |r: &mut Random| over(r, |x, y| 0.5 * x * x + 0.8 * (y - 0.1) * (y - 0.1));
        for from in [[0.0, 0.1, 0.0], [0.3, 0.0, 0.0], [-0.2, 0.4, 0.1]] {
            let found = seen(bowl, from).unwrap();
            let off = [found.place[0], found.place[1] - 0.1, found.place[2]];
            assert!(off.iter().all(|x| x.abs() < 0.01), "{found:?}");
            assert!((found.curvatures[0] - 1.0).abs() < 0.1, "{found:?}");
            assert!((found.curvatures[1] - 1.6).abs() < 0.1, "{found:?}");
            // The gap is 0.08 there along the flatter direction.
            assert!((found.apart(0.08).unwrap() - 0.4).abs() < 0.03, "{found:?}");
        }
    }

    #[test]
    fn sheets_that_touch_along_a_curve_are_apart_at_no_distance_from_a_place() {
        let trough = |r: &mut Random| over(r, |x, _| 0.7 * x * x);
        let found = seen(trough, [0.2, 0.3, 0.0]).unwrap();
        assert!(
            found.place[0].abs() < 0.01 && found.place[2].abs() < 0.01,
            "{found:?}"
        );
        assert_eq!(found.apart(0.1), None);
    }

    #[test]
    fn what_does_not_touch_is_not_said_to() {
        let none = |draw: &dyn Fn(&mut Random) -> Place| {
            for from in [[0.0; 3], [0.1, 0.05, 0.0], [0.3, -0.2, 0.05]] {
                assert_eq!(seen(draw, from), None);
            }
        };
        none(&|r| over(r, |_, _| 0.0));
        // Crossings.
        for degrees in [20.0_f64, 30.0, 60.0, 90.0] {
            let (sin, cos) = (degrees / 2.0).to_radians().sin_cos();
            none(&|r| {
                let [x, y] = at(r);
                let side = if r.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
                [cos * x, y, side * sin * x]
            });
        }
        // Sheets apart, side by side or bent away from each other.
        none(&|r| over(r, |_, _| 0.06));
        none(&|r| over(r, |x, y| 0.03 + x * x + y * y));
        // Noise, and points of no surface.
        none(&|r| [at(r)[0], at(r)[1], 0.02 * r.normal()]);
        none(&|r| [at(r)[0], at(r)[1], at(r)[0]]);
        // One sheet, bent or with a crease.
        none(&|r| {
            let [x, y] = at(r);
            [x, y, 2.5 * x * x]
        });
        none(&|r| {
            let [x, y] = at(r);
            [x, y, 0.3 * (6.0 * x).sin()]
        });
        for slope in [0.2, 1.0] {
            none(&|r| {
                let [x, y] = at(r);
                [x, y, slope * x.abs()]
            });
        }
        // The tip of a double cone.
        none(&|r| {
            let [x, y] = at(r);
            let side = if r.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
            [x, y, side * x.hypot(y)]
        });
    }

    #[test]
    fn too_few_points_show_nothing() {
        let random = &mut Random::new(2);
        let rows: Vec<Place> = (0..199)
            .map(|_| over(random, |x, y| x * x + y * y))
            .collect();
        assert_eq!(near(3, &rows.concat(), &[0.0; 3]), None);
        let flat: Vec<f64> = (0..500).flat_map(|_| at(random)).collect();
        assert_eq!(near(2, &flat, &[0.0; 2]), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Turned, moved and scaled, in R^5 as well, the same is seen.
        #[test]
        fn motions_and_scale_change_the_place_and_lengths_alone(
            turns in proptest::collection::vec(0.0..4.0f64, 6),
            shift in proptest::collection::vec(-3.0..3.0f64, 5),
            scale in 0.01..100.0f64,
            curvatures in (0.5..1.0f64, 1.0..1.5f64),
        ) {
            let random = &mut Random::new(7);
            let (a, b) = curvatures;
            let rows: Vec<Place> =
                (0..900).map(|_| over(random, |x, y| (a * x * x + b * y * y) / 2.0)).collect();
            let moved = |place: &Place| {
                let mut out = [place[0], place[1], place[2], 0.0, 0.0];
                let planes = [(0, 1), (1, 2), (2, 3), (0, 4), (1, 4), (2, 0)];
                for (&(i, j), turn) in planes.iter().zip(&turns) {
                    let (sin, cos) = (FRAC_PI_2 * turn).sin_cos();
                    (out[i], out[j]) = (cos * out[i] - sin * out[j], sin * out[i] + cos * out[j]);
                }
                std::array::from_fn::<f64, 5, _>(|k| scale * (out[k] + shift[k]))
            };
            let plain = near(3, &rows.concat(), &rows[0]);
            let all: Vec<[f64; 5]> = rows.iter().map(moved).collect();
            let other = near(5, &all.concat(), &all[0]);
            prop_assert_eq!(plain.is_some(), other.is_some());
            let (Some(plain), Some(other)) = (plain, other) else { return Ok(()) };
            let place = moved(&[plain.place[0], plain.place[1], plain.place[2]]);
            for (x, y) in place.iter().zip(&other.place) {
                prop_assert!((x - y).abs() < 1e-6 * scale, "{place:?} {other:?}");
            }
            prop_assert!((plain.spacing * scale / other.spacing - 1.0).abs() < 1e-9);
            for (x, y) in plain.curvatures.iter().zip(&other.curvatures) {
                prop_assert!((x / scale / y - 1.0).abs() < 1e-6, "{x} {y}");
            }
        }
    }
}
