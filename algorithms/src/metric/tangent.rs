//! Tangent planes of a surface that may cross itself.

use crate::execute::Execute;
use crate::locality;
use crate::principal::PrincipalFrame;
use crosscap_core::{Error, NeighborhoodOracle, PointCloud, Scalar};

/// Planes that are tried at a point, at most.
const TRIALS: usize = 48;
/// Points farther from a plane than this share of the radius are not on its sheet.
const THICKNESS: f64 = 0.1;
/// Rounds of fitting the plane to the points on its sheet.
const ROUNDS: usize = 3;

/// An orthonormal basis of the tangent plane at every point, 2 * N numbers each, what
/// [`Lifted`](super::Lifted) takes.
///
/// Where sheets cross, the principal directions of a neighborhood belong to neither: here the plane
/// has to go through the point itself. Of the planes through the point and two of its `count`
/// nearest others the one is taken that most of them are near (least sum of squared distances, cut
/// off at a tenth of the radius); of that plane and those of the neighbors, moved to the point, again
/// the best, fitted to the points near it. A point within the thickness of
/// both sheets may get the plane of either, and is as good a sample of the one as of the other.
///
/// `O(count N)` a plane, 48 + `count` planes a point; the planes tried are always the same.
///
/// # Errors
/// [`Error::Parameter`] for fewer than 6 points, [`Error::Shape`] when oracle and cloud differ in
/// size or the cloud lies in R^1, [`Error::SparseNeighborhood`] where there are too few
/// different points.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean, tangent_planes};
/// use crosscap_core::PointCloud;
/// // Two planes that cross in the first axis; the last point is on z = 0.
/// let grid = (0..81).map(|k| (f64::from(k % 9) - 4.0, f64::from(k / 9) - 4.0));
/// let rows = grid.flat_map(|(x, y)| [[x, y, 0.0], [x + 0.5, 0.0, y + 0.3]]);
/// let cloud = PointCloud::new(3, rows.chain([[0.2, 0.9, 0.0]]).flatten().collect())?;
/// let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
/// let bases = tangent_planes(&cloud, &oracle, 24, &Serial)?;
/// let plane = &bases[162 * 6..];
/// assert!(plane[2].abs() < 1e-9 && plane[5].abs() < 1e-9);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub fn tangent_planes<S: Scalar>(
    cloud: &PointCloud<S>,
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    count: usize,
    execute: &dyn Execute,
) -> Result<Vec<S>, Error> {
    let n = cloud.dimension();
    if n < 2 || oracle.len() != cloud.len() {
        return Err(Error::Shape {
            found: format!("{} points of R^{n}", cloud.len()),
            expected: format!("{} points of R^2 or more", oracle.len()),
        });
    }
    if count < LEAST {
        return Err(Error::Parameter {
            name: "points of a tangent plane",
            value: count.to_string(),
            expected: format!("at least {LEAST}"),
        });
    }
    let own = at_each(cloud, oracle, count, execute, |scratch, i| {
        plane(scratch).ok_or(Error::SparseNeighborhood {
            point: i,
            found: scratch.rows.len(),
            needed: LEAST,
            parameter: "the number of points of a tangent plane",
        })
    });
    let own = own.into_iter().collect::<Result<Vec<Basis>, Error>>()?;
    let planes = at_each(cloud, oracle, count, execute, |scratch, i| {
        among_neighbors(cloud, i, scratch, &own)
    });
    let numbers = planes.into_iter().flatten().flatten();
    Ok(numbers.map(S::of).collect())
}

/// What `work` makes of every point, by row, with its `count` nearest at hand.
fn at_each<S: Scalar, T: Send + Sync>(
    cloud: &PointCloud<S>,
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    count: usize,
    execute: &dyn Execute,
    work: impl Fn(&mut Scratch<S>, usize) -> T + Sync,
) -> Vec<T> {
    let look = |scratch: &mut Scratch<S>, i: usize| {
        scratch.look(cloud, oracle, i, count);
        work(scratch, i)
    };
    locality::map(execute, Some(cloud), cloud.len(), Scratch::default, look)
}

/// Fewest points that a plane is sought among.
const LEAST: usize = 6;

/// Two orthonormal vectors.
type Basis = [Vec<f64>; 2];

/// The neighbors of a point.
struct Scratch<S> {
    near: Vec<crosscap_core::Neighbor<S>>,
    /// Those that do not coincide with it, nearest first.
    rows: Vec<usize>,
    /// Their places relative to it, N numbers each.
    arms: Vec<f64>,
    space: usize,
    /// Square of the distance from a plane up to which they are on its sheet.
    limit: f64,
}

impl<S> Default for Scratch<S> {
    fn default() -> Self {
        Self {
            near: Vec::new(),
            rows: Vec::new(),
            arms: Vec::new(),
            space: 0,
            limit: 0.0,
        }
    }
}

impl<S: Scalar> Scratch<S> {
    fn look(
        &mut self,
        cloud: &PointCloud<S>,
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        i: usize,
        count: usize,
    ) {
        oracle.nearest(i, count.saturating_add(1), &mut self.near);
        let reach = self.near.last().map_or(0.0, |x| x.distance.as_f64());
        self.limit = (THICKNESS * reach).powi(2);
        self.space = cloud.dimension();
        self.rows.clear();
        self.arms.clear();
        for x in &self.near {
            if cloud.squared_distance(i, x.index) > 0.0 {
                self.rows.push(x.index);
                let pairs = cloud.point(x.index).iter().zip(cloud.point(i));
                self.arms
                    .extend(pairs.map(|(a, b)| a.as_f64() - b.as_f64()));
            }
        }
    }

    fn arm(&self, k: usize) -> &[f64] {
        &self.arms[k * self.space..(k + 1) * self.space]
    }

    /// Sum of the squared distances of all neighbors from a plane, each cut off at the limit.
    fn cost(&self, basis: &Basis) -> f64 {
        (0..self.rows.len())
            .map(|k| off(self.arm(k), basis).min(self.limit))
            .sum()
    }
}

/// The best of the planes through two neighbors.
fn plane<S: Scalar>(scratch: &Scratch<S>) -> Option<Basis> {
    let count = scratch.rows.len();
    if count < LEAST {
        return None;
    }
    let mut best: Option<(f64, Basis)> = None;
    for trial in 0..TRIALS {
        // The first arm runs through the farther half, the second through all others.
        let a = count - 1 - trial % count.div_ceil(2);
        let b = (a + 1 + (trial * 7 + trial / 5) % (count - 1)) % count;
        let Some(basis) = orthonormal(scratch.arm(a), scratch.arm(b)) else {
            continue;
        };
        let cost = scratch.cost(&basis);
        if best.as_ref().is_none_or(|x| cost < x.0) {
            best = Some((cost, basis));
        }
    }
    best.map(|x| x.1)
}

/// The best of the planes of a point and of its neighbors, moved to the point and fitted to what is
/// near it: on a crossing a neighbor a little off it has the better view.
fn among_neighbors<S: Scalar>(
    cloud: &PointCloud<S>,
    i: usize,
    scratch: &Scratch<S>,
    own: &[Basis],
) -> Basis {
    let candidates = scratch.rows.iter().map(|&row| &own[row]);
    let mut basis = &own[i];
    let mut least = scratch.cost(basis);
    for candidate in candidates {
        let cost = scratch.cost(candidate);
        if cost < least {
            (basis, least) = (candidate, cost);
        }
    }
    let mut basis = basis.clone();
    let mut on_sheet: Vec<usize> = Vec::with_capacity(scratch.rows.len() + 1);
    for _ in 0..ROUNDS {
        on_sheet.clear();
        on_sheet.push(i);
        let near = (0..scratch.rows.len()).filter(|&k| off(scratch.arm(k), &basis) < scratch.limit);
        on_sheet.extend(near.map(|k| scratch.rows[k]));
        let frame = PrincipalFrame::of(cloud, on_sheet.iter().copied());
        if on_sheet.len() < 4 || frame.rank() < 2 {
            break;
        }
        let Some(fitted) = orthonormal(frame.axis(0), frame.axis(1)) else {
            break;
        };
        // A fit that is worse has taken in the other sheet.
        if scratch.cost(&fitted) > scratch.cost(&basis) {
            break;
        }
        basis = fitted;
    }
    basis
}

/// Squared distance of the end of an arm from a plane through its beginning.
fn off(arm: &[f64], [u, v]: &Basis) -> f64 {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let (p, q) = (dot(arm, u), dot(arm, v));
    (dot(arm, arm) - p * p - q * q).max(0.0)
}

/// `None` for vectors that are nearly parallel.
fn orthonormal(a: &[f64], b: &[f64]) -> Option<Basis> {
    let unit = |x: Vec<f64>, least: f64| {
        let length = x.iter().map(|c| c * c).sum::<f64>().sqrt();
        (length > least).then(|| x.into_iter().map(|c| c / length).collect::<Vec<f64>>())
    };
    let u = unit(a.to_vec(), 0.0)?;
    let size = b.iter().map(|c| c * c).sum::<f64>().sqrt();
    let mut v = b.to_vec();
    // Twice, since the first time leaves rounding where the two are close.
    for _ in 0..2 {
        let along: f64 = u.iter().zip(&v).map(|(x, y)| x * y).sum();
        v.iter_mut().zip(&u).for_each(|(x, y)| *x -= along * y);
    }
    Some([u, unit(v, 0.2 * size)?])
}
