//! Tangent planes of a surface that may cross itself.

use crate::execute::{self, Execute};
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
/// off at a tenth of the radius), and fitted to those near it. A point within the thickness of
/// both sheets may get the plane of either, and is as good a sample of the one as of the other.
///
/// `O(count N)` a plane, 48 planes a point; the planes tried are always the same.
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
    let planes = execute::map(execute, cloud.len(), Scratch::default, |scratch, i| {
        oracle.nearest(i, count.saturating_add(1), &mut scratch.near);
        let near = &scratch.near;
        scratch.rows.clear();
        let apart = |row: usize| cloud.squared_distance(i, row) > 0.0;
        (scratch.rows).extend(near.iter().map(|x| x.index).filter(|&r| apart(r)));
        let found = scratch.rows.len();
        let reach = near.last().map_or(0.0, |x| x.distance.as_f64());
        plane(cloud, i, scratch, reach).ok_or(Error::SparseNeighborhood {
            point: i,
            found,
            needed: LEAST,
            parameter: "the number of points of a tangent plane",
        })
    });
    let mut bases = Vec::with_capacity(cloud.len() * 2 * n);
    for plane in planes {
        bases.extend(plane?.into_iter().map(S::of));
    }
    Ok(bases)
}

/// Fewest points that a plane is sought among.
const LEAST: usize = 6;

struct Scratch<S> {
    near: Vec<crosscap_core::Neighbor<S>>,
    rows: Vec<usize>,
    /// The neighbors relative to the point.
    arms: Vec<f64>,
}

impl<S> Default for Scratch<S> {
    fn default() -> Self {
        Self {
            near: Vec::new(),
            rows: Vec::new(),
            arms: Vec::new(),
        }
    }
}

fn plane<S: Scalar>(
    cloud: &PointCloud<S>,
    i: usize,
    scratch: &mut Scratch<S>,
    reach: f64,
) -> Option<Vec<f64>> {
    let n = cloud.dimension();
    let count = scratch.rows.len();
    if count < LEAST {
        return None;
    }
    scratch.arms.clear();
    for &row in &scratch.rows {
        let pairs = cloud.point(row).iter().zip(cloud.point(i));
        scratch
            .arms
            .extend(pairs.map(|(a, b)| a.as_f64() - b.as_f64()));
    }
    let arm = |k: usize| &scratch.arms[k * n..(k + 1) * n];
    let limit = (THICKNESS * reach).powi(2);
    let mut best: Option<(f64, [Vec<f64>; 2])> = None;
    for trial in 0..TRIALS {
        // The first arm runs through the farther half, the second through all others.
        let a = count - 1 - trial % count.div_ceil(2);
        let b = (a + 1 + (trial * 7 + trial / 5) % (count - 1)) % count;
        let Some(basis) = orthonormal(arm(a), arm(b)) else {
            continue;
        };
        let cost: f64 = (0..count).map(|k| off(arm(k), &basis).min(limit)).sum();
        if best.as_ref().is_none_or(|x| cost < x.0) {
            best = Some((cost, basis));
        }
    }
    let (_, mut basis) = best?;
    let mut on_sheet: Vec<usize> = Vec::with_capacity(count + 1);
    for _ in 0..ROUNDS {
        on_sheet.clear();
        on_sheet.push(i);
        let near = (0..count).filter(|&k| off(arm(k), &basis) < limit);
        on_sheet.extend(near.map(|k| scratch.rows[k]));
        let frame = PrincipalFrame::of(cloud, on_sheet.iter().copied());
        if on_sheet.len() < 4 || frame.rank() < 2 {
            break;
        }
        let Some(fitted) = orthonormal(frame.axis(0), frame.axis(1)) else {
            break;
        };
        basis = fitted;
    }
    Some(basis.concat())
}

/// Squared distance of the end of an arm from a plane through its beginning.
fn off(arm: &[f64], [u, v]: &[Vec<f64>; 2]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let (p, q) = (dot(arm, u), dot(arm, v));
    (dot(arm, arm) - p * p - q * q).max(0.0)
}

/// `None` for vectors that are nearly parallel.
fn orthonormal(a: &[f64], b: &[f64]) -> Option<[Vec<f64>; 2]> {
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
