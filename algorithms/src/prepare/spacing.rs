//! How far apart points are, place by place.

use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crosscap_core::{Error, NeighborhoodOracle, PointCloud, Scalar};
use std::f64::consts::PI;

/// Neighbors that the density at a point is read from: the spacing of a random sample is then
/// known to 1 / (2 sqrt 16) = 12 %, and a ball of so many points is smaller than what is looked
/// for with it.
const NEIGHBORS: usize = 16;
/// Of them, those in the inner ball by which surfaces are told from space.
const INNER: usize = 4;
/// Of them, the nearest whose values are compared.
const COMPARED: usize = 8;

/// The spacing of a sample of a surface at every point: one over the root of the number of points
/// per unit of area, in the unit of the data.
///
/// The ball that reaches the 16th nearest other point of row i has radius d, and a surface has
/// about the area pi d^2 in it, so that the spacing there is d sqrt(pi / 16). For points scattered at
/// random its square is unbiased, with a standard deviation of a quarter of it (d^2 follows a gamma
/// distribution: Loftsgaarden & Quesenberry 1965, Mack & Rosenblatt 1979). The value of a
/// row is the median of this over the row and its eight nearest, so that an outlier has the spacing of the
/// points that it is near, and they are not disturbed by it.
///
/// On a straight boundary the ball is half empty and the spacing 1.4 times too large; where two sheets cross
/// it is that of both together, 0.7 of the spacing on one; on a curve without a surface it is
/// d sqrt(pi / 16) for the d that reaches the 8th point each way, a few times the gap of the points.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::prepare::LocalSpacing;
/// use crosscap_core::PointCloud;
/// let grid = (0..900).flat_map(|k| [f64::from(k % 30), f64::from(k / 30)]).collect();
/// let spacing = LocalSpacing::of(&PointCloud::new(2, grid)?, &Serial)?;
/// // A point in the middle of the unit grid has a unit of area to itself.
/// assert!((spacing.at(465) - 1.0).abs() < 0.1);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LocalSpacing {
    spacing: Vec<f64>,
    nearest: Vec<f64>,
    off_center: Vec<f64>,
    crowding: Vec<f64>,
    raw: Vec<f64>,
    low: Vec<f64>,
    median: f64,
    variation: f64,
    evenness: f64,
}

/// What the search found at one row.
struct Found {
    row: u32,
    nearest: f64,
    reach: f64,
    off_center: f64,
    crowding: f64,
    compared: [u32; COMPARED],
}

impl LocalSpacing {
    /// Of the points of a cloud, by straight distances. O(n log n) distances.
    ///
    /// # Errors
    /// [`Error::Shape`] for fewer than 17 points.
    pub fn of<S: Scalar>(cloud: &PointCloud<S>, execute: &dyn Execute) -> Result<Self, Error> {
        enough(cloud.len())?;
        let places = cloud.cast::<f64>();
        let tree = BallTree::new(cloud.dimension(), places.coordinates());
        let found = tree.nearest_of_each(
            NEIGHBORS,
            |_| true,
            execute,
            |row, near| {
                let mut near = near.to_vec();
                near.sort_unstable();
                Found {
                    row,
                    nearest: near[0].square().sqrt(),
                    reach: near[NEIGHBORS - 1].square().sqrt(),
                    off_center: off_center(&places, row as usize, &near),
                    crowding: near[INNER - 1].square() / near[NEIGHBORS - 1].square(),
                    compared: std::array::from_fn(|k| near[k].index()),
                }
            },
        );
        Ok(Self::from(found))
    }

    /// In any metric, by an oracle. One query a point.
    ///
    /// # Errors
    /// [`Error::Shape`] for fewer than 17 points.
    pub fn by<S: Scalar>(
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        enough(oracle.len())?;
        let found = crate::execute::map(execute, oracle.len(), Vec::new, |near, row| {
            oracle.nearest(row, NEIGHBORS + 1, near);
            near.retain(|x| x.index != row);
            Found {
                row: row as u32,
                nearest: near[0].distance.as_f64(),
                reach: near[NEIGHBORS - 1].distance.as_f64(),
                off_center: 0.0,
                crowding: INNER as f64 / NEIGHBORS as f64,
                compared: std::array::from_fn(|k| near[k].index as u32),
            }
        });
        Ok(Self::from(found))
    }

    fn from(found: Vec<Found>) -> Self {
        let mut raw = vec![0.0; found.len()];
        let mut nearest = raw.clone();
        let mut off_center = raw.clone();
        let mut crowding = raw.clone();
        for x in &found {
            raw[x.row as usize] = x.reach * (PI / NEIGHBORS as f64).sqrt();
            nearest[x.row as usize] = x.nearest;
            off_center[x.row as usize] = x.off_center;
            crowding[x.row as usize] = x.crowding;
        }
        let mut spacing = raw.clone();
        let mut low = raw.clone();
        for x in &found {
            let mut values = [raw[x.row as usize]; COMPARED + 1];
            for (value, &other) in values.iter_mut().zip(&x.compared) {
                *value = raw[other as usize];
            }
            values.sort_unstable_by(f64::total_cmp);
            spacing[x.row as usize] = values[COMPARED / 2];
            low[x.row as usize] = values[1];
        }
        let quantiles = |values: &mut Vec<f64>, shares: [f64; 3]| {
            values.sort_unstable_by(f64::total_cmp);
            shares.map(|share| values[(share * (values.len() - 1) as f64).round() as usize])
        };
        let [least, median, most] = quantiles(&mut spacing.clone(), [0.01, 0.5, 0.99]);
        let pairs = nearest.iter().zip(&spacing).filter(|x| *x.1 > 0.0);
        let mut shares: Vec<f64> = pairs.map(|(d, s)| d / s).collect();
        shares.push(0.0);
        let [close, usual, _] = quantiles(&mut shares, [0.05, 0.5, 1.0]);
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 1.0 };
        Self {
            variation: ratio(most, least),
            evenness: ratio(close, usual),
            spacing,
            nearest,
            off_center,
            crowding,
            raw,
            low,
            median,
        }
    }

    /// Of row `row`; 0 only where many copies of one point are.
    pub fn at(&self, row: usize) -> f64 {
        self.spacing[row]
    }

    /// Of all rows.
    pub fn values(&self) -> &[f64] {
        &self.spacing
    }

    /// Distances of the rows to their nearest other point, unit of the data.
    pub fn nearest(&self) -> &[f64] {
        &self.nearest
    }

    /// How far row `row` is from the middle of its 16 nearest, unit of the data; 0 where there are no
    /// coordinates.
    pub(super) fn off_center(&self, row: usize) -> f64 {
        self.off_center[row]
    }

    /// Square of the distance from row `row` to its 4th nearest over that to its 16th: a quarter on average on a
    /// surface, less on a curve, 0.39 in space. Not a number where 16 copies are.
    pub(super) fn crowding(&self, row: usize) -> f64 {
        self.crowding[row]
    }

    /// Of row `row` by its own ball alone.
    pub(super) fn raw(&self, row: usize) -> f64 {
        self.raw[row]
    }

    /// The second smallest of these over the row and its eight nearest: where two of them are on a surface, that
    /// of the surface, 0.87 of it on average.
    pub(super) fn low(&self, row: usize) -> f64 {
        self.low[row]
    }

    /// The median over the rows, unit of the data.
    pub fn median(&self) -> f64 {
        self.median
    }

    /// How many times the spacing that 99 % of the rows stay below is that which 99 % stay above: 1.5
    /// to 2 for even densities, whose square is what the number of points per area varies by.
    pub fn variation(&self) -> f64 {
        self.variation
    }

    /// How evenly points lie: the distance to the nearest point, in local spacings, that 5 % stay below over that
    /// of half of the points. 0.27 for points scattered at random, 0.9 and more for thinned ones and 1 for grids.
    pub fn evenness(&self) -> f64 {
        self.evenness
    }
}

/// Distance of a row from the mean of its neighbors.
fn off_center(places: &PointCloud<f64>, row: usize, near: &[Near]) -> f64 {
    let own = places.point(row);
    let share = 1.0 / near.len() as f64;
    let square: f64 = (0..own.len())
        .map(|axis| {
            let sum: f64 = (near.iter())
                .map(|x| places.point(x.index() as usize)[axis] - own[axis])
                .sum();
            (sum * share).powi(2)
        })
        .sum();
    square.sqrt()
}

fn enough(points: usize) -> Result<(), Error> {
    if points > NEIGHBORS {
        return Ok(());
    }
    Err(Error::Shape {
        found: format!("{points} points"),
        expected: format!("at least {}, to read a density from", NEIGHBORS + 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::surfaces::{RigidMotion, SampleSurface, Sampling, scaled};

    fn sample(name: &str, sampling: &Sampling) -> PointCloud<f64> {
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(sampling).unwrap().points
    }

    #[test]
    fn spacing_is_the_root_of_the_area_of_a_point() {
        let cloud = sample("torus", &Sampling::new(4000, 3));
        let found = LocalSpacing::of(&cloud, &Serial).unwrap();
        let truth = (8.0 * PI * PI / 4000.0).sqrt();
        let mean = found.values().iter().sum::<f64>() / 4000.0;
        assert!((mean / truth - 1.0).abs() < 0.04, "{}", mean / truth);
        let far = |s: &&f64| !(0.6 * truth..1.6 * truth).contains(*s);
        assert!(found.values().iter().filter(far).count() < 40);
        assert!(
            (0.2..0.35).contains(&found.evenness()),
            "{}",
            found.evenness()
        );
        assert!(
            (1.2..2.2).contains(&found.variation()),
            "{}",
            found.variation()
        );
    }

    #[test]
    fn thinned_points_are_even() {
        let thinned = Sampling {
            thinning: Some(0.1),
            ..Sampling::new(20_000, 1)
        };
        let found = LocalSpacing::of(&sample("sphere", &thinned), &Serial).unwrap();
        assert!(found.evenness() > 0.85, "{}", found.evenness());
    }

    #[test]
    fn density_is_followed_place_by_place() {
        // Points of a square whose density grows from left to right, area per point 1e-4 (1 + 9 x)^2.
        let mut random = crate::surfaces::Random::new(5);
        let mut rows: Vec<f64> = Vec::new();
        while rows.len() < 2 * 6000 {
            let (x, y) = (random.uniform(), random.uniform());
            if random.uniform() < (1.0 + 9.0 * x).powi(-2) {
                rows.extend([x, y]);
            }
        }
        let cloud = PointCloud::new(2, rows).unwrap();
        let found = LocalSpacing::of(&cloud, &Serial).unwrap();
        // The number of points per area is n (1 + 9 x)^-2 over the integral, 1/10.
        let inner = |p: &[f64]| p.iter().all(|c| (0.1..0.9).contains(c));
        let errors: Vec<f64> = (0..6000)
            .filter(|&i| inner(cloud.point(i)))
            .map(|i| {
                let truth = (0.1 / 6000.0_f64).sqrt() * (1.0 + 9.0 * cloud.point(i)[0]);
                (found.at(i) / truth - 1.0).abs()
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(errors.len() > 1000 && mean < 0.12, "{mean}");
        assert!(found.variation() > 5.0, "{}", found.variation());
    }

    #[test]
    fn one_far_point_has_the_spacing_of_the_others() {
        let cloud = sample("sphere", &Sampling::new(2000, 1));
        let own = LocalSpacing::of(&cloud, &Serial).unwrap();
        let mut rows = cloud.coordinates().to_vec();
        rows.extend([50.0, 0.0, 0.0]);
        let found = LocalSpacing::of(&PointCloud::new(3, rows).unwrap(), &Serial).unwrap();
        assert!(found.at(2000) < 2.0 * own.median());
        assert_eq!(own.values(), &found.values()[..2000]);
        assert!(found.nearest()[2000] > 48.0);
    }

    #[test]
    fn motion_and_scale_and_oracle_change_nothing_else() {
        let cloud = sample("two_spheres", &Sampling::new(1500, 2));
        let own = LocalSpacing::of(&cloud, &Serial).unwrap();
        let moved = RigidMotion::random(3, 2.0, 4).apply(&cloud).unwrap();
        let moved = LocalSpacing::of(&scaled(&moved, 1e6).unwrap(), &Serial).unwrap();
        let metric = Euclidean::new(cloud.clone());
        let oracle = BruteForceOracle::new(&metric);
        let by = LocalSpacing::by(&oracle, &Serial).unwrap();
        for i in 0..1500 {
            assert!((moved.at(i) / own.at(i) / 1e6 - 1.0).abs() < 1e-9);
            assert!((by.at(i) / own.at(i) - 1.0).abs() < 1e-12);
        }
        assert!((moved.evenness() - own.evenness()).abs() < 1e-9);
    }

    #[test]
    fn copies_have_no_spacing_and_few_points_are_refused() {
        let mut rows = vec![0.0; 40];
        rows.extend((0..60).map(f64::from));
        let found = LocalSpacing::of(&PointCloud::new(1, rows).unwrap(), &Serial).unwrap();
        assert_eq!(found.at(0), 0.0);
        assert!(found.evenness().is_finite() && found.variation().is_finite());
        let few = PointCloud::new(1, vec![0.0; 16]).unwrap();
        assert!(LocalSpacing::of(&few, &Serial).is_err());
    }
}
