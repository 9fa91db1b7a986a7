//! Exact Euclidean neighborhoods in any dimension, on kiddo.
//!
//! A kd-tree wants its dimension at compile time and degrades as it grows, the method wants
//! neighborhoods in R^2 to R^72 and beyond. Both are served by one observation: an orthogonal
//! projection never lengthens a distance. The tree holds the cloud projected to its leading
//! principal axes (eight at most, and all of R^N up to eight); a query there with a radius
//! inflated by a bound on the rounding errors misses nobody, and every candidate is then
//! measured from the original coordinates. So the answer is that of a scan over all points, to
//! the bit, and the axes decide nothing but the speed.

use std::cell::RefCell;
use std::num::NonZero;
use std::sync::Arc;

use crosscap_core::{
    Error, MetricSpace, Neighbor, NeighborhoodOracle, PointCloud, Scalar, squared_distance,
};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::DMatrix;

/// The tree has at most this many dimensions.
const MOST_AXES: usize = 8;
/// Points that the axes are computed from: they need not be exact.
const AXES_SAMPLE: usize = 2048;
/// Rounds of subspace iteration for the axes.
const AXES_ROUNDS: usize = 10;

/// Neighborhoods in a [`PointCloud`] under the Euclidean distance, exact at any dimension.
///
/// The metric is the square root of [`PointCloud::squared_distance`], rounded to `S`; all
/// answers are those of a scan with that metric: strict `<`, sorted by distance, ties by index.
/// Any number of points may coincide.
///
/// Building takes `O(n (log n + N))`, a query that finds `k` points about
/// `O(log n + k (N + log k))` when the cloud is of low dimension locally.
///
/// ```
/// use crosscap_backends::euclidean::EuclideanOracle;
/// use crosscap_core::{NeighborhoodOracle, PointCloud};
/// let line = PointCloud::new(1, vec![0.0, 3.0, 1.0, 2.0]).unwrap();
/// let oracle = EuclideanOracle::new(line).unwrap();
/// let mut found = Vec::new();
/// oracle.within(0, 2.0, &mut found); // strict: the point at distance 2 is not in it
/// assert_eq!(found.iter().map(|f| f.index).collect::<Vec<_>>(), [0, 2]);
/// oracle.nearest(2, 2, &mut found); // 0 and 3 are equally near: the smaller index wins
/// assert_eq!(found.iter().map(|f| f.index).collect::<Vec<_>>(), [2, 0]);
/// ```
pub struct EuclideanOracle<S: Scalar> {
    cloud: Arc<PointCloud<S>>,
    tree: Box<dyn Tree>,
    frame: Frame,
    /// Relative and absolute (in units of the tree) bound on rounding errors.
    slack: f64,
    /// Relative spacing of `S`.
    spacing: f64,
    /// A distance below which squares or `S` itself underflow, in units of the data.
    underflow: f64,
}

impl<S: Scalar> EuclideanOracle<S> {
    /// Builds the tree over a cloud, given by value or as an [`Arc`].
    ///
    /// # Errors
    /// [`Error::Shape`] when there are more points than a `u32` can count, and
    /// [`Error::Parameter`] when a coordinate is so large (above 1e36 for `f32`, 1e150 for
    /// `f64`) that distances overflow. An empty cloud is allowed.
    pub fn new(cloud: impl Into<Arc<PointCloud<S>>>) -> Result<Self, Error> {
        let cloud = cloud.into();
        if u32::try_from(cloud.len()).is_err() {
            return Err(Error::Shape {
                found: format!("{} points", cloud.len()),
                expected: format!("at most {} points", u32::MAX),
            });
        }
        let wide = S::of(1e100).is_finite();
        let (limit, underflow) = if wide { (1e150, 1e-150) } else { (1e36, 1e-36) };
        if let Some(at) = (cloud.coordinates().iter()).position(|c| c.as_f64().abs() > limit) {
            let (row, column) = (at / cloud.dimension(), at % cloud.dimension());
            return Err(Error::Parameter {
                name: "coordinates",
                value: format!("{} in row {row}, column {column}", cloud.coordinates()[at]),
                expected: format!("magnitudes up to {limit:e} (rescale the data)"),
            });
        }
        let frame = Frame::of(&cloud);
        let tree = plant(&cloud, &frame)?;
        Ok(Self {
            slack: (cloud.dimension() + 16) as f64 * 32.0 * f64::EPSILON,
            spacing: S::default_epsilon().as_f64(),
            underflow,
            cloud,
            tree,
            frame,
        })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.cloud.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.cloud.is_empty()
    }

    /// The cloud it serves.
    pub fn cloud(&self) -> &Arc<PointCloud<S>> {
        &self.cloud
    }

    /// Whether a point is closer to `place` than `radius`; `false` for a place with another number of
    /// coordinates. Takes O(log n) where one is.
    ///
    /// ```
    /// use crosscap_backends::euclidean::EuclideanOracle;
    /// use crosscap_core::PointCloud;
    /// let line = PointCloud::new(1, vec![0.0, 3.0]).unwrap();
    /// let oracle = EuclideanOracle::new(line).unwrap();
    /// assert!(oracle.is_near(&[2.5], 0.6));
    /// assert!(!oracle.is_near(&[2.5], 0.5)); // strict
    /// ```
    pub fn is_near(&self, place: &[S], radius: S) -> bool {
        if place.len() != self.cloud.dimension() {
            return false;
        }
        let mut lead = [0.0; MOST_AXES];
        let mut near = false;
        if self.frame.place(place, &mut lead) < 1e100 {
            self.tree.nearest(&lead, 1, &mut |index| {
                near |= self.distance_to(place, index as usize) < radius;
            });
        }
        // The nearest in the tree is a point like any other, but need not be the nearest of all.
        near || {
            let mut found = Vec::new();
            self.within_row(place, radius, &mut found);
            !found.is_empty()
        }
    }

    fn distance_to(&self, row: &[S], index: usize) -> S {
        S::of(squared_distance(row, self.cloud.point(index)).sqrt())
    }

    /// Visits every point whose distance from `row`, rounded to `S`, is at most `reach`, and
    /// perhaps some more, with its squared distance in the tree (NaN if not known).
    fn candidates(&self, row: &[S], reach: f64, visit: &mut dyn FnMut(u32, f64)) {
        let mut place = [0.0; MOST_AXES];
        let norm = self.frame.place(row, &mut place);
        // Outside of this window the tree cannot save anything, or its arithmetic could overflow.
        if norm < 1e100 {
            let reach = (reach * (1.0 + 2.0 * self.spacing) + self.underflow) * self.frame.scale;
            let reach = reach * (1.0 + self.slack) + self.slack * norm.max(1.0);
            if reach < 2.0 {
                return self.tree.within(&place, reach * reach, visit);
            }
        }
        for index in 0..self.cloud.len() {
            visit(index as u32, f64::NAN);
        }
    }

    fn within_row(&self, row: &[S], radius: S, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        if radius.as_f64().is_nan() || radius <= S::zero() {
            return;
        }
        self.candidates(row, radius.as_f64(), &mut |index, _| {
            let index = index as usize;
            let distance = self.distance_to(row, index);
            if distance < radius {
                out.push(Neighbor { index, distance });
            }
        });
        sort(out);
    }
}

impl<S: Scalar> MetricSpace for EuclideanOracle<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn distance(&self, a: usize, b: usize) -> S {
        self.distance_to(self.cloud.point(a), b)
    }

    fn places(&self) -> Option<&PointCloud<S>> {
        Some(&self.cloud)
    }

    fn name(&self) -> &str {
        "euclidean"
    }
}

impl<S: Scalar> NeighborhoodOracle for EuclideanOracle<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn within(&self, center: usize, radius: S, out: &mut Vec<Neighbor<S>>) {
        self.within_row(self.cloud.point(center), radius, out);
    }

    /// As the trait says. The center is not the first where a copy of it has a smaller index.
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        if count == 0 {
            return;
        }
        let row = self.cloud.point(center);
        let reach = if count < self.cloud.len() {
            // The farthest of `count` points, whichever they are, bounds the answer.
            let mut place = [0.0; MOST_AXES];
            self.frame.place(row, &mut place);
            let mut reach = 0.0_f64;
            self.tree.nearest(&place, count, &mut |index| {
                reach = reach.max(squared_distance(row, self.cloud.point(index as usize)));
            });
            reach.sqrt()
        } else {
            f64::INFINITY
        };
        let limit = S::of(reach);
        self.candidates(row, reach, &mut |index, _| {
            let index = index as usize;
            let distance = self.distance_to(row, index);
            if distance <= limit {
                out.push(Neighbor { index, distance });
            }
        });
        if count < out.len() {
            out.select_nth_unstable_by_key(count, rank);
            out.truncate(count);
        }
        sort(out);
    }

    fn is_near(&self, place: &[S], radius: S) -> bool {
        EuclideanOracle::is_near(self, place, radius)
    }

    /// As the trait says, in the order of the tree.
    ///
    /// # Panics
    /// When `center` is not a point.
    fn indices_within(&self, center: usize, radius: S, out: &mut Vec<u32>) {
        out.clear();
        if radius.as_f64().is_nan() || radius <= S::zero() {
            return;
        }
        let row = self.cloud.point(center);
        let limit = radius.as_f64();
        // Where the tree holds all of R^N its own distances decide, but for a thin shell.
        let sure = if self.frame.axes.is_none() {
            let inner = (limit * (1.0 - 2.0 * self.spacing) - self.underflow) * self.frame.scale;
            let inner = inner * (1.0 - self.slack) - self.slack;
            if inner > 0.0 { inner * inner } else { -1.0 }
        } else {
            -1.0
        };
        self.candidates(row, limit, &mut |index, tree_squared| {
            if tree_squared < sure || self.distance_to(row, index as usize) < radius {
                out.push(index);
            }
        });
    }

    /// As the trait says; `false`, and nothing in `out`, when `place` does not have as many
    /// coordinates as the cloud. A place that is not finite is near no point.
    fn within_of(&self, place: &[S], radius: S, out: &mut Vec<Neighbor<S>>) -> bool {
        out.clear();
        if place.len() != self.cloud.dimension() {
            return false;
        }
        self.within_row(place, radius, out);
        true
    }

    fn name(&self) -> &str {
        "search-tree"
    }
}

/// Distance, then index, as one number: the bits of nonnegative numbers are in their order.
fn rank<S: Scalar>(neighbor: &Neighbor<S>) -> u128 {
    u128::from(neighbor.distance.as_f64().to_bits()) << 64 | neighbor.index as u128
}

/// Sorts by distance, then index. On a surface the number of neighbors grows with the square of
/// the distance, so buckets of equal squared width hold about one each: several times faster
/// than comparing (a query's time goes mostly here otherwise), and never worse than it.
fn sort<S: Scalar>(neighbors: &mut [Neighbor<S>]) {
    thread_local! {
        static SCRATCH: RefCell<(Vec<u32>, Vec<u128>)> = const { RefCell::new((vec![], vec![])) };
    }
    let count = neighbors.len();
    let square = |n: &Neighbor<S>| n.distance.as_f64() * n.distance.as_f64();
    let most = neighbors.iter().map(square).fold(0.0, f64::max);
    let per_square = (count as f64 - 1.0) / most;
    if count < 48 || !(per_square > 0.0 && per_square.is_finite()) {
        return neighbors.sort_unstable_by_key(rank);
    }
    let bucket = |n: &Neighbor<S>| ((square(n) * per_square) as usize).min(count - 1);
    SCRATCH.with_borrow_mut(|(ends, ranks)| {
        ends.clear();
        ends.resize(count, 0);
        ranks.clear();
        ranks.resize(count, 0);
        neighbors.iter().for_each(|n| ends[bucket(n)] += 1);
        let mut before = 0;
        for end in ends.iter_mut() {
            before += std::mem::replace(end, before);
        }
        // Each start moves to the end of its bucket while the bucket fills.
        for n in neighbors.iter() {
            let end = &mut ends[bucket(n)];
            ranks[*end as usize] = rank(n);
            *end += 1;
        }
        let mut start = 0;
        for &end in ends.iter() {
            if end - start > 1 {
                ranks[start as usize..end as usize].sort_unstable();
            }
            start = end;
        }
        for (n, rank) in neighbors.iter_mut().zip(ranks) {
            n.distance = S::of(f64::from_bits((*rank >> 64) as u64));
            n.index = *rank as u64 as usize;
        }
    });
}

/// The coordinates of the tree: centered at the mean, scaled into the unit ball, and projected
/// when R^N has more than [`MOST_AXES`] dimensions.
struct Frame {
    mean: Vec<f64>,
    /// A power of two, so scaling rounds nothing.
    scale: f64,
    /// Orthonormal axes one after the other, N numbers each.
    axes: Option<Vec<f64>>,
}

impl Frame {
    fn of<S: Scalar>(cloud: &PointCloud<S>) -> Self {
        let n = cloud.dimension();
        let mut mean = vec![0.0; n];
        for row in cloud.iter() {
            for (m, x) in mean.iter_mut().zip(row) {
                *m += x.as_f64();
            }
        }
        let count = cloud.len().max(1) as f64;
        mean.iter_mut().for_each(|m| *m /= count);
        let radius = (cloud.iter())
            .map(|row| {
                let square = |(x, m): (&S, &f64)| (x.as_f64() - m) * (x.as_f64() - m);
                row.iter().zip(&mean).map(square).sum::<f64>()
            })
            .fold(0.0, f64::max)
            .sqrt();
        let exponent = if radius > 0.0 {
            -radius.log2().ceil().max(-990.0) - 1.0
        } else {
            0.0
        };
        let mut frame = Self {
            mean,
            scale: exponent.exp2(),
            axes: None,
        };
        if n > MOST_AXES {
            frame.axes = Some(frame.principal_axes(cloud));
        }
        frame
    }

    /// Leading principal axes by subspace iteration on a sample of the cloud. They are
    /// orthonormal whatever the data are, and that is all that exactness needs.
    fn principal_axes<S: Scalar>(&self, cloud: &PointCloud<S>) -> Vec<f64> {
        let n = cloud.dimension();
        let stride = cloud.len().div_ceil(AXES_SAMPLE).max(1);
        let rows: Vec<usize> = (0..cloud.len()).step_by(stride).collect();
        let sample = DMatrix::from_fn(rows.len(), n, |i, j| {
            (cloud.point(rows[i])[j].as_f64() - self.mean[j]) * self.scale
        });
        // A fixed start that leans on no direction.
        let mut axes = DMatrix::from_fn(n, MOST_AXES, |i, k| {
            ((i + 1) as f64 * (k as f64 + 1.7)).cos()
        });
        axes = axes.qr().q();
        for _ in 0..AXES_ROUNDS {
            let projected = &sample * &axes;
            axes = sample.tr_mul(&projected).qr().q();
        }
        axes.as_slice().to_vec()
    }

    fn tree_dimension(&self) -> usize {
        self.mean.len().min(MOST_AXES)
    }

    /// Writes the tree's coordinates of a row, and returns the row's norm in R^N in units of the tree.
    fn place<S: Scalar>(&self, row: &[S], place: &mut [f64; MOST_AXES]) -> f64 {
        let centered = |j: usize| (row[j].as_f64() - self.mean[j]) * self.scale;
        let mut square = 0.0;
        match &self.axes {
            None => {
                for (j, p) in place[..row.len()].iter_mut().enumerate() {
                    *p = centered(j);
                    square += *p * *p;
                }
            }
            Some(axes) => {
                *place = [0.0; MOST_AXES];
                for j in 0..row.len() {
                    let x = centered(j);
                    square += x * x;
                    for (k, p) in place.iter_mut().enumerate() {
                        *p += x * axes[k * row.len() + j];
                    }
                }
            }
        }
        square.sqrt()
    }
}

/// A kd-tree whose dimension is no longer in its type. Places are padded to [`MOST_AXES`].
trait Tree: Send + Sync {
    /// Visits the points at squared distance at most `squared_radius`, with that distance.
    fn within(
        &self,
        place: &[f64; MOST_AXES],
        squared_radius: f64,
        visit: &mut dyn FnMut(u32, f64),
    );
    /// Visits `count` points nearest in the tree, in any order.
    fn nearest(&self, place: &[f64; MOST_AXES], count: usize, visit: &mut dyn FnMut(u32));
}

struct Planted<const K: usize>(ImmutableKdTree<f64, K>);

fn lead<const K: usize>(place: &[f64; MOST_AXES]) -> [f64; K] {
    std::array::from_fn(|k| place[k])
}

impl<const K: usize> Tree for Planted<K> {
    fn within(
        &self,
        place: &[f64; MOST_AXES],
        squared_radius: f64,
        visit: &mut dyn FnMut(u32, f64),
    ) {
        (self.0.query(&lead(place)))
            .within::<SquaredEuclidean<f64>>(squared_radius)
            .unsorted()
            .visit(|found| visit(found.item, found.distance));
    }

    fn nearest(&self, place: &[f64; MOST_AXES], count: usize, visit: &mut dyn FnMut(u32)) {
        let Some(count) = NonZero::new(count) else {
            return;
        };
        let found = (self.0.query(&lead(place)))
            .nearest_n::<SquaredEuclidean<f64>>(count)
            .execute();
        found.into_iter().for_each(|found| visit(found.item));
    }
}

/// For the empty cloud.
struct Bare;

impl Tree for Bare {
    fn within(&self, _: &[f64; MOST_AXES], _: f64, _: &mut dyn FnMut(u32, f64)) {}
    fn nearest(&self, _: &[f64; MOST_AXES], _: usize, _: &mut dyn FnMut(u32)) {}
}

fn plant<S: Scalar>(cloud: &PointCloud<S>, frame: &Frame) -> Result<Box<dyn Tree>, Error> {
    if cloud.is_empty() {
        return Ok(Box::new(Bare));
    }
    match frame.tree_dimension() {
        1 => plant_in::<S, 1>(cloud, frame),
        2 => plant_in::<S, 2>(cloud, frame),
        3 => plant_in::<S, 3>(cloud, frame),
        4 => plant_in::<S, 4>(cloud, frame),
        5 => plant_in::<S, 5>(cloud, frame),
        6 => plant_in::<S, 6>(cloud, frame),
        7 => plant_in::<S, 7>(cloud, frame),
        _ => plant_in::<S, MOST_AXES>(cloud, frame),
    }
}

fn plant_in<S: Scalar, const K: usize>(
    cloud: &PointCloud<S>,
    frame: &Frame,
) -> Result<Box<dyn Tree>, Error> {
    let mut place = [0.0; MOST_AXES];
    let places: Vec<[f64; K]> = (cloud.iter())
        .map(|row| {
            frame.place(row, &mut place);
            lead(&place)
        })
        .collect();
    let tree = ImmutableKdTree::new_from_slice(&places).map_err(|error| Error::Shape {
        found: format!("a cloud that the kd-tree refuses ({error})"),
        expected: "finite coordinates".into(),
    })?;
    Ok(Box::new(Planted(tree)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition, with no shortcut.
    fn scan<S: Scalar>(cloud: &PointCloud<S>, row: &[S]) -> Vec<Neighbor<S>> {
        let mut all: Vec<_> = (0..cloud.len())
            .map(|index| Neighbor {
                index,
                distance: S::of(squared_distance(row, cloud.point(index)).sqrt()),
            })
            .collect();
        all.sort_by(|a, b| {
            (a.distance, a.index)
                .partial_cmp(&(b.distance, b.index))
                .unwrap()
        });
        all
    }

    fn agree<S: Scalar>(cloud: PointCloud<S>, radii: &[S]) {
        let oracle = EuclideanOracle::new(cloud).unwrap();
        let cloud = oracle.cloud();
        let mut found = Vec::new();
        let mut indices = Vec::new();
        let step = (cloud.len() / 12).max(1);
        for center in (0..cloud.len()).step_by(step) {
            let all = scan(cloud, cloud.point(center));
            // Radii that are distances of the data put points exactly on the sphere.
            let ties = all.iter().step_by(7).map(|n| n.distance);
            for radius in radii.iter().copied().chain(ties) {
                let expected: Vec<_> = (all.iter().copied())
                    .filter(|n| n.distance < radius)
                    .collect();
                oracle.within(center, radius, &mut found);
                assert_eq!(found, expected, "center {center}, radius {radius}");
                assert!(oracle.within_of(cloud.point(center), radius, &mut found));
                assert_eq!(found, expected);
                assert_eq!(
                    oracle.is_near(cloud.point(center), radius),
                    !expected.is_empty()
                );
                oracle.indices_within(center, radius, &mut indices);
                indices.sort_unstable();
                let mut set: Vec<u32> = expected.iter().map(|n| n.index as u32).collect();
                set.sort_unstable();
                assert_eq!(indices, set, "center {center}, radius {radius}");
            }
            for count in [0, 1, 2, 5, cloud.len() / 2, cloud.len(), cloud.len() + 3] {
                oracle.nearest(center, count, &mut found);
                let expected = &all[..count.min(all.len())];
                assert_eq!(found, expected, "center {center}, count {count}");
            }
        }
    }

    /// Clouds with many equal distances: points of a small lattice, repeated, off center.
    fn lattice() -> impl Strategy<Value = (usize, Vec<i32>, i32)> {
        (1_usize..=72).prop_flat_map(|n| {
            (
                Just(n),
                (1_usize..90).prop_flat_map(move |k| prop::collection::vec(-2..=2, n * k)),
                prop_oneof![Just(0), Just(1000), Just(-300_000)],
            )
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(96))]

        #[test]
        fn lattice_f64((n, c, offset) in lattice()) {
            let c = c.iter().map(|&x| f64::from(x + offset)).collect();
            agree(PointCloud::new(n, c).unwrap(), &[1.0, 2.0, 2.0_f64.sqrt(), f64::INFINITY]);
        }

        #[test]
        fn lattice_f32((n, c, offset) in lattice()) {
            let c = c.iter().map(|&x| (x + offset) as f32).collect();
            agree(PointCloud::new(n, c).unwrap(), &[1.0_f32, 2.0, 2.0_f32.sqrt(), 1e30]);
        }

        #[test]
        fn scattered(
            (n, k) in (1_usize..=72, 1_usize..120),
            seed in any::<u64>(),
            exponent in -12_i32..12,
            offset in -1e6_f64..1e6,
        ) {
            let scale = 10_f64.powi(exponent);
            let c: Vec<f64> = noise(seed).take(n * k).map(|x| (x + offset) * scale).collect();
            let radii = [0.3 * scale, scale * (n as f64 / 6.0).sqrt(), 0.0, -1.0, f64::NAN];
            let cloud = PointCloud::new(n, c).unwrap();
            let narrow = radii.map(|r| r as f32);
            agree(cloud.cast::<f32>(), &narrow);
            agree(cloud, &radii);
        }

        #[test]
        fn collinear(n in 1_usize..40, seed in any::<u64>(), shift in -1e5_f64..1e5) {
            let direction: Vec<f64> = noise(seed).take(n).collect();
            let mut c = Vec::new();
            for t in noise(!seed).take(70) {
                c.extend(direction.iter().map(|d| (5.0 * t).round() * d + shift));
            }
            agree(PointCloud::new(n, c).unwrap(), &[0.1, 1.0]);
        }
    }

    /// Numbers in (-1, 1) from a seed (a linear congruential generator will do).
    fn noise(seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed;
        std::iter::repeat_with(move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
    }

    #[test]
    fn any_number_of_equal_points() {
        for n in [1, 3, 8, 9, 72] {
            agree(
                PointCloud::new(n, vec![7.25_f64; n * 3000]).unwrap(),
                &[1e-9, 1.0],
            );
            let mut c = vec![1.0_f32; n * 500];
            c.extend(noise(3).take(n * 200).map(|x| x as f32));
            agree(PointCloud::new(n, c).unwrap(), &[0.5, 1.0]);
        }
    }

    #[test]
    fn many_neighbors() {
        for n in [2, 3, 12] {
            let c: Vec<f64> = noise(21).take(n * 1500).collect();
            let cloud = PointCloud::new(n, c).unwrap();
            agree(cloud.cast::<f32>(), &[0.5, 1.5]);
            agree(cloud, &[0.5, 1.5]);
        }
    }

    #[test]
    fn extreme_scales() {
        for scale in [1e-320, 1e-200, 1e-100, 1e100, 1e149] {
            let c = noise(9).take(600).map(|x| x * scale).collect();
            agree(PointCloud::new(3, c).unwrap(), &[0.2 * scale, scale]);
        }
        let c = noise(9).take(600).map(|x| x as f32 * 1e-42).collect();
        agree(PointCloud::new(3, c).unwrap(), &[2e-43, 1e-42]);
    }

    #[test]
    fn places_beyond_the_cloud() {
        let cloud = PointCloud::new(3, noise(5).take(900).collect()).unwrap();
        let oracle = EuclideanOracle::new(cloud.clone()).unwrap();
        let mut found = Vec::new();
        for place in [[0.1, 0.2, 0.3], [1e9, 0.0, 0.0], [1e300, 0.0, 0.0]] {
            for radius in [0.4, 1e9, 1e9 - 0.5, f64::INFINITY] {
                let mut expected = scan(&cloud, &place);
                expected.retain(|n| n.distance < radius);
                assert!(oracle.within_of(&place, radius, &mut found));
                assert_eq!(found, expected);
            }
        }
        assert!(oracle.within_of(&[f64::NAN; 3], 1.0, &mut found) && found.is_empty());
        assert!(!oracle.within_of(&[0.0; 2], 1.0, &mut found));
    }

    #[test]
    fn empty_and_overlarge_clouds() {
        let empty = EuclideanOracle::new(PointCloud::<f64>::new(3, vec![]).unwrap()).unwrap();
        let mut found = Vec::new();
        assert!(empty.within_of(&[0.0; 3], 1.0, &mut found) && found.is_empty());
        let large = PointCloud::new(2, vec![0.0, 0.0, 1e200, 0.0]).unwrap();
        let error = EuclideanOracle::new(large).err().unwrap();
        assert!(
            error.is_input() && error.to_string().contains("row 1, column 0"),
            "{error}"
        );
    }

    /// `cargo test --release -p crosscap-backends time_of_a_query -- --ignored --nocapture`
    #[test]
    #[ignore = "a measurement"]
    fn time_of_a_query() {
        let mut uniform = noise(11);
        let mut c = Vec::new();
        while c.len() < 3 * 87_000 {
            let p = [0; 3].map(|_| uniform.next().unwrap());
            let r = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            if r < 1.0 && r > 0.0 {
                let shift = if c.len() % 2 == 0 { 0.0 } else { 2_f64.sqrt() };
                c.extend([p[0] / r + shift, p[1] / r, p[2] / r]);
            }
        }
        let oracle = EuclideanOracle::new(PointCloud::new(3, c).unwrap()).unwrap();
        let (mut found, mut indices, mut total) = (Vec::new(), Vec::new(), 0);
        let centers: Vec<usize> = (0..20_000).map(|i| (i * 7919) % 87_000).collect();
        for radius in [0.25, 0.25] {
            let start = std::time::Instant::now();
            for &center in &centers {
                oracle.within(center, radius, &mut found);
                total += found.len();
            }
            let sorted = start.elapsed().as_secs_f64() / centers.len() as f64;
            let start = std::time::Instant::now();
            for &center in &centers {
                oracle.indices_within(center, radius, &mut indices);
            }
            let plain = start.elapsed().as_secs_f64() / centers.len() as f64;
            let start = std::time::Instant::now();
            for &center in &centers {
                oracle.nearest(center, 24, &mut found);
            }
            let nearest = start.elapsed().as_secs_f64() / centers.len() as f64;
            println!(
                "{} neighbors: sorted {:.1} us, indices {:.1} us, 24 nearest {:.1} us",
                total / centers.len(),
                sorted * 1e6,
                plain * 1e6,
                nearest * 1e6
            );
            total = 0;
        }
    }
}
