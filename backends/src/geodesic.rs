//! Geodesic distances over a neighbor graph, on petgraph.
//!
//! The distance of two points along the surface, as Isomap estimates it: the length of the
//! shortest path in a graph that joins nearby points of the dense cloud (Tenenbaum, de Silva and
//! Langford, "A global geometric framework for nonlinear dimensionality reduction", 2000, step 2;
//! named as an alternative metric by Martin & Watson 2011, section 2). Nothing is computed for all
//! pairs: a ball costs a search that stops at its rim.
//!
//! Edge lengths are stored as whole multiples of one tiny unit, so that sums are exact: a path has
//! one length, whichever end it is read from. That is what makes the metric symmetric to the bit,
//! and ball queries equal to pairwise distances to the bit.

use std::cell::RefCell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crosscap_core::{Error, MetricSpace, Neighbor, NeighborhoodOracle, Scalar};
use petgraph::Directed;
use petgraph::csr::Csr;
use petgraph::unionfind::UnionFind;
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

/// Edges shorter than this many spacings make paths zigzag, and so too long.
///
/// Measured on surfaces with the method of Martin & Watson: from three spacings on, geodesic
/// neighborhoods make a radius that is far too large harmless.
pub const LEAST_REACH: f64 = 3.0;

/// Which points an edge joins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeRule {
    /// Points at distance strictly less than this, in the unit of the data.
    Within(f64),
    /// A point with its so many nearest other points; the union over both ends.
    Nearest(usize),
}

/// A piece of a graph that no edge joins to the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Component {
    /// Number of points in it.
    pub size: usize,
    /// Its smallest point.
    pub first: usize,
}

/// What there is to know about a neighbor graph before trusting its distances.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GraphReport {
    /// Number of points.
    pub points: usize,
    /// Number of edges, each counted once.
    pub edges: usize,
    /// Spacing of the points: the median distance to the nearest point that is not a copy, among
    /// those that have an edge to one.
    pub spacing: f64,
    /// How far edges reach: the radius of the rule, or the median length of the longest edge to one of the
    /// nearest points.
    pub reach: f64,
    /// The connected components, largest first, then by their smallest point.
    pub components: Vec<Component>,
}

/// Why geodesic distances over a graph may mislead.
#[derive(Clone, Debug, Error, PartialEq, Serialize)]
#[non_exhaustive]
pub enum GraphWarning {
    /// Points in different components are at infinite distance.
    #[error(
        "the neighbor graph falls into {count} components, the largest of {largest} points; \
         point {outside} is not in it: make the edges longer, unless the data are in pieces"
    )]
    Disconnected {
        /// Number of components.
        count: usize,
        /// Number of points of the largest.
        largest: usize,
        /// A point outside of the largest.
        outside: usize,
    },
    /// Edges are short against the spacing, so that paths zigzag and come out too long.
    #[error(
        "the edges of the neighbor graph reach {reach}, {ratio:.2} times the spacing {spacing} of \
         the points: use at least {LEAST_REACH} times, or distances come out too long"
    )]
    TooCoarse {
        /// How far edges reach.
        reach: f64,
        /// Spacing of the points.
        spacing: f64,
        /// The first divided by the second.
        ratio: f64,
    },
}

impl GraphReport {
    /// Whether every two points are joined by a path.
    pub fn is_connected(&self) -> bool {
        self.components.len() <= 1
    }

    /// What speaks against using the distances; empty when nothing does.
    pub fn warnings(&self) -> Vec<GraphWarning> {
        let mut warnings = Vec::new();
        if let [largest, outside, ..] = self.components[..] {
            warnings.push(GraphWarning::Disconnected {
                count: self.components.len(),
                largest: largest.size,
                outside: outside.first,
            });
        }
        let ratio = self.reach / self.spacing;
        if ratio < LEAST_REACH {
            warnings.push(GraphWarning::TooCoarse {
                reach: self.reach,
                spacing: self.spacing,
                ratio,
            });
        }
        warnings
    }
}

/// Lengths of shortest paths in a graph of neighbors, as a metric space and as an oracle.
///
/// Points without a path between them are at infinite distance. The triangle inequality holds
/// exactly before the result is rounded to `S`; an edge is as long as the metric below says, to
/// within 2^-42 of the longest edge (for a million points).
///
/// | query | cost |
/// | --- | --- |
/// | [`distance`](MetricSpace::distance) | searches from both ends that meet half-way |
/// | [`within`](NeighborhoodOracle::within), [`distances_from`](Self::distances_from) | a search of the ball: `O(e log k)` with `e` edges at its `k` points |
/// | [`distances_among`](Self::distances_among) | a search from each point, to the farthest of the others |
///
/// Searches allocate nothing once a thread has made its first, hash nothing, and may run on any
/// number of threads.
///
/// ```
/// use crosscap_backends::euclidean::EuclideanOracle;
/// use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric};
/// use crosscap_core::{MetricSpace, PointCloud};
/// // Three quarters of a circle: the ends are close in the plane, and far along the arc.
/// let angle = |i: usize| 1.5 * std::f64::consts::PI * i as f64 / 300.0;
/// let arc = (0..=300).flat_map(|i| [angle(i).cos(), angle(i).sin()]).collect();
/// let euclidean = EuclideanOracle::new(PointCloud::new(2, arc).unwrap()).unwrap();
/// let geodesic = GeodesicMetric::new(&euclidean, EdgeRule::Within(0.06)).unwrap();
/// assert!(geodesic.report().warnings().is_empty());
/// assert!((euclidean.distance(0, 300) - 2_f64.sqrt()).abs() < 1e-9);
/// assert!((geodesic.distance(0, 300) - 1.5 * std::f64::consts::PI).abs() < 0.01);
/// ```
pub struct GeodesicMetric<S: Scalar> {
    /// Both directions of every edge, with its length in units.
    graph: Csr<(), u64, Directed, u32>,
    /// A power of two, in the unit of the data.
    unit: f64,
    /// Label of the component of every point.
    component: Vec<u32>,
    report: GraphReport,
    scalar: std::marker::PhantomData<fn() -> S>,
}

impl<S: Scalar> GeodesicMetric<S> {
    /// Builds the graph over the points of an oracle, in parallel.
    ///
    /// Use it on the dense cloud: over landmarks the paths are too coarse. A graph that falls
    /// apart or is too coarse is no error; see [`GeodesicMetric::report`].
    ///
    /// # Errors
    /// [`Error::Parameter`] when the radius is not positive and finite or the number of nearest
    /// points is 0; [`Error::Shape`] when there are more points than a `u32` can count;
    /// [`Error::Law`] when the oracle returns an index out of range or a distance that is not at
    /// least 0.
    pub fn new(oracle: &dyn NeighborhoodOracle<Scalar = S>, rule: EdgeRule) -> Result<Self, Error> {
        Self::with_lengths(oracle, rule, &|_, _, length| length)
    }

    /// The same edges, each divided by how many times the spacing of the points at its two ends is the usual
    /// one (the geometric mean of `scale` there): where points lie twice as far apart, lengths count half. On a surface
    /// sampled unevenly all points are then about as far apart.
    ///
    /// Source: conformal Isomap (de Silva and Tenenbaum, "Global versus local methods in nonlinear dimensionality
    /// reduction", NIPS 2002, section 3.1), with the spacing in the place of the mean distance to the nearest
    /// points.
    ///
    /// # Errors
    /// Those of [`GeodesicMetric::new`]; [`Error::Shape`] for a scale that has not one positive number a point.
    pub fn conformal(
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        rule: EdgeRule,
        scale: &[f64],
    ) -> Result<Self, Error> {
        let sound = scale.iter().all(|s| *s > 0.0 && s.is_finite());
        if scale.len() != oracle.len() || !sound {
            return Err(Error::Shape {
                found: format!("a scale of {} numbers", scale.len()),
                expected: format!("{} positive ones, one a point", oracle.len()),
            });
        }
        let shrunk = |a: usize, b: usize, length: f64| length / (scale[a] * scale[b]).sqrt();
        Self::with_lengths(oracle, rule, &shrunk)
    }

    /// The edges of the rule that `joins` lets stand, asked with both ends: without those that lead from one sheet to
    /// another, paths cross a sharp crease where it is and not on the way.
    ///
    /// # Errors
    /// Those of [`GeodesicMetric::new`].
    pub fn joining(
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        rule: EdgeRule,
        joins: &(dyn Fn(usize, usize) -> bool + Sync),
    ) -> Result<Self, Error> {
        let standing = |a: usize, b: usize, length: f64| {
            if joins(a, b) { length } else { f64::INFINITY }
        };
        Self::with_lengths(oracle, rule, &standing)
    }

    /// A graph whose edges are as long as `length` makes of their ends and what the oracle says; one of infinite length
    /// is none.
    fn with_lengths(
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        rule: EdgeRule,
        length: &(dyn Fn(usize, usize, f64) -> f64 + Sync),
    ) -> Result<Self, Error> {
        let len = oracle.len();
        let parameter = |name, value, expected: &str| Error::Parameter {
            name,
            value,
            expected: expected.into(),
        };
        match rule {
            EdgeRule::Within(r) if !(r > 0.0 && r.is_finite()) => {
                let expected = "a positive, finite length";
                return Err(parameter("edge length", r.to_string(), expected));
            }
            EdgeRule::Nearest(0) => {
                return Err(parameter("nearest neighbors", "0".into(), "at least 1"));
            }
            _ => {}
        }
        if u32::try_from(len).is_err() {
            return Err(Error::Shape {
                found: format!("{len} points"),
                expected: format!("at most {} points", u32::MAX),
            });
        }
        let rows = (0..len)
            .into_par_iter()
            .map_init(Vec::new, |found, point| {
                let mut edges = row(oracle, rule, point, found)?;
                for (other, far) in &mut edges {
                    *far = length(point, *other as usize, *far);
                }
                edges.retain(|edge| edge.1.is_finite());
                Ok(edges)
            })
            .collect::<Result<Vec<_>, Error>>()?;

        let longest = (rows.iter().flatten()).fold(0.0, |most: f64, e| most.max(e.1));
        let unit = unit_for(longest, len);
        let spacing = median(rows.iter().filter_map(|r| {
            let nearest = r.iter().map(|e| e.1).filter(|&d| d > 0.0);
            nearest.min_by(f64::total_cmp)
        }));
        let reach = match rule {
            EdgeRule::Within(radius) => radius,
            EdgeRule::Nearest(_) => median(
                rows.iter()
                    .map(|r| r.iter().fold(0.0, |m: f64, e| m.max(e.1))),
            ),
        };

        let mut arcs = Vec::with_capacity(2 * rows.iter().map(Vec::len).sum::<usize>());
        let mut pieces = UnionFind::<u32>::new(len);
        for (point, row) in rows.into_iter().enumerate() {
            for (other, length) in row {
                let units = (length / unit).round() as u64;
                arcs.push((point as u32, other, units));
                arcs.push((other, point as u32, units));
                pieces.union(point as u32, other);
            }
        }
        arcs.par_sort_unstable();
        arcs.dedup_by_key(|arc| (arc.0, arc.1));
        let mut graph = Csr::from_sorted_edges(&arcs).map_err(|error| Error::Shape {
            found: format!("edges out of order ({error:?})"),
            expected: "sorted edges".into(),
        })?;
        while graph.node_count() < len {
            graph.add_node(());
        }

        let component = pieces.into_labeling();
        let report = GraphReport {
            points: len,
            edges: arcs.len() / 2,
            spacing,
            reach,
            components: census(&component),
        };
        Ok(Self {
            graph,
            unit,
            component,
            report,
            scalar: std::marker::PhantomData,
        })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.component.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.component.is_empty()
    }

    /// Components, spacing and reach of the graph.
    pub fn report(&self) -> &GraphReport {
        &self.report
    }

    /// The points that an edge joins to `point`, in increasing order, with its length.
    ///
    /// # Panics
    /// When `point` is out of range.
    pub fn edges_of(&self, point: usize) -> impl ExactSizeIterator<Item = (usize, S)> {
        let ends = self.graph.neighbors_slice(point as u32);
        let units = self.graph.edges_slice(point as u32);
        (ends.iter().zip(units)).map(|(&end, &units)| (end as usize, self.length(units)))
    }

    /// Writes the points at geodesic distance strictly less than `radius` from `source` into `out`,
    /// sorted by distance, ties by index: [`NeighborhoodOracle::within`] by another name.
    ///
    /// # Panics
    /// When `source` is out of range.
    pub fn distances_from(&self, source: usize, radius: S, out: &mut Vec<Neighbor<S>>) {
        self.within(source, radius, out);
    }

    /// Writes the geodesic distance from `source` to each of `targets` into `out`, in their order.
    /// One search, which stops at the farthest target that can be reached.
    ///
    /// # Panics
    /// When `source` or a target is out of range.
    pub fn distances_to(&self, source: usize, targets: &[usize], out: &mut Vec<S>) {
        out.clear();
        self.append_distances(source, targets, out);
    }

    /// Writes the symmetric matrix of the geodesic distances between `points` into `out`, in row
    /// order: what a chart of a neighborhood is made from. Paths may leave the neighborhood.
    ///
    /// # Panics
    /// When a point is out of range.
    pub fn distances_among(&self, points: &[usize], out: &mut Vec<S>) {
        out.clear();
        for &source in points {
            self.append_distances(source, points, out);
        }
    }

    fn append_distances(&self, source: usize, targets: &[usize], out: &mut Vec<S>) {
        assert!(source < self.len(), "point {source} of {}", self.len());
        SCRATCH.with_borrow_mut(|[search, _]| {
            search.start(self.len(), source);
            let mut missing = 0;
            for &target in targets {
                if self.component[target] == self.component[source] {
                    missing += usize::from(search.want(target));
                }
            }
            while missing > 0 {
                let Some((_, point)) = search.settle(&self.graph, u64::MAX) else {
                    break;
                };
                missing -= usize::from(search.is_wanted(point as usize));
            }
            out.extend(targets.iter().map(|&t| self.length(search.units(t))));
        });
    }

    /// Length of so many units; [`UNREACHED`] is infinite.
    fn length(&self, units: u64) -> S {
        if units == UNREACHED {
            S::of(f64::INFINITY)
        } else {
            S::of(units as f64 * self.unit)
        }
    }
}

impl<S: Scalar> MetricSpace for GeodesicMetric<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.component.len()
    }

    fn distance(&self, a: usize, b: usize) -> S {
        if self.component[a] != self.component[b] {
            return self.length(UNREACHED);
        }
        if a == b {
            return S::zero();
        }
        SCRATCH.with_borrow_mut(|both| {
            both[0].start(self.len(), a);
            both[1].start(self.len(), b);
            let mut best = UNREACHED;
            loop {
                let tops = [both[0].top(), both[1].top()];
                let [Some(ahead), Some(behind)] = tops else {
                    break;
                };
                // No path through two points that are not settled yet can be shorter.
                if ahead.saturating_add(behind) >= best {
                    break;
                }
                let side = usize::from(behind < ahead);
                let Some((units, point)) = both[side].settle(&self.graph, u64::MAX) else {
                    break;
                };
                let rest = both[1 - side].units(point as usize);
                best = best.min(units.saturating_add(rest));
            }
            self.length(best)
        })
    }

    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<S>) {
        Self::distances_to(self, from, to, out);
    }

    fn name(&self) -> &str {
        "geodesic"
    }
}

impl<S: Scalar> NeighborhoodOracle for GeodesicMetric<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.component.len()
    }

    fn within(&self, center: usize, radius: S, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        assert!(
            center < self.component.len(),
            "point {center} of {}",
            self.component.len()
        );
        // Without rounding at the rim: what is near it is decided below. NaN gives 0.
        let spread = 1.0 + 4.0 * S::default_epsilon().as_f64();
        let most = (radius.as_f64() * spread / self.unit).ceil() as u64;
        SCRATCH.with_borrow_mut(|[search, _]| {
            search.start(self.component.len(), center);
            while let Some((units, point)) = search.settle(&self.graph, most) {
                let distance = self.length(units);
                if distance < radius {
                    out.push(Neighbor {
                        index: point as usize,
                        distance,
                    });
                }
            }
        });
        sort_ties(out);
    }

    /// As the trait says: points that no path leads to come last, at infinite distance.
    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<S>>) {
        out.clear();
        let len = self.component.len();
        assert!(center < len, "point {center} of {len}");
        SCRATCH.with_borrow_mut(|[search, _]| {
            search.start(len, center);
            let mut last = S::zero();
            // Beyond the last place as far as there are ties with it.
            while let Some((units, point)) = search.settle(&self.graph, u64::MAX) {
                let distance = self.length(units);
                if out.len() >= count && distance > last {
                    break;
                }
                last = distance;
                out.push(Neighbor {
                    index: point as usize,
                    distance,
                });
            }
        });
        sort_ties(out);
        out.truncate(count);
        if out.len() < count {
            let label = self.component[center];
            let beyond = (0..len).filter(|&i| self.component[i] != label);
            let beyond = beyond.map(|index| Neighbor {
                index,
                distance: self.length(UNREACHED),
            });
            out.extend(beyond.take(count - out.len()));
        }
    }

    fn name(&self) -> &str {
        "graph-search"
    }
}

/// Puts ties of a list that is sorted by distance in the order of their indices.
fn sort_ties<S: Scalar>(found: &mut [Neighbor<S>]) {
    for ties in found.chunk_by_mut(|a, b| a.distance == b.distance) {
        if ties.len() > 1 {
            ties.sort_unstable_by_key(|n| n.index);
        }
    }
}

/// The edges that the rule draws from `point`.
fn row<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    rule: EdgeRule,
    point: usize,
    found: &mut Vec<Neighbor<S>>,
) -> Result<Vec<(u32, f64)>, Error> {
    let count = match rule {
        EdgeRule::Within(radius) => {
            oracle.within(point, S::of(radius), found);
            usize::MAX
        }
        EdgeRule::Nearest(count) => {
            oracle.nearest(point, count.saturating_add(1), found);
            count
        }
    };
    let mut row = Vec::with_capacity(found.len());
    for n in found.iter() {
        let length = n.distance.as_f64();
        if n.index >= oracle.len() || length < 0.0 || length.is_nan() {
            return Err(Error::Law {
                plugin: "neighborhood oracle".into(),
                law: "equals brute force",
                point,
                detail: format!("neighbor {} at distance {length}", n.index),
            });
        }
        if n.index != point && length.is_finite() && row.len() < count {
            row.push((n.index as u32, length));
        }
    }
    Ok(row)
}

/// A power of two so small that edges are exact for all purposes, and so large that the sum over
/// any path, which has fewer edges than there are points, fits in 63 bits.
fn unit_for(longest: f64, points: usize) -> f64 {
    let for_sums = points.max(2).ilog2() + 1;
    let digits = (62 - for_sums).min(52) as f64;
    let exponent = if longest > 0.0 {
        longest.log2().ceil()
    } else {
        0.0
    };
    (exponent - digits).max(-1000.0).exp2()
}

/// The middle value (the upper of two), 0 when there is none.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn census(label: &[u32]) -> Vec<Component> {
    let mut place = vec![usize::MAX; label.len()];
    let mut components: Vec<Component> = Vec::new();
    for (point, &l) in label.iter().enumerate() {
        let place = &mut place[l as usize];
        if *place == usize::MAX {
            *place = components.len();
            components.push(Component {
                size: 0,
                first: point,
            });
        }
        components[*place].size += 1;
    }
    components.sort_by_key(|c| (Reverse(c.size), c.first));
    components
}

const UNREACHED: u64 = u64::MAX;

thread_local! {
    /// The two searches of a thread: one for each end.
    static SCRATCH: RefCell<[Search; 2]> = RefCell::default();
}

/// A search from one point (Dijkstra 1959), with memory that is not cleared between searches: a
/// number is valid when its stamp is that of the search.
#[derive(Default)]
struct Search {
    epoch: u32,
    stamps: Vec<u32>,
    wanted: Vec<u32>,
    units: Vec<u64>,
    queue: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Search {
    fn start(&mut self, len: usize, source: usize) {
        if self.stamps.len() < len {
            self.stamps.resize(len, 0);
            self.wanted.resize(len, 0);
            self.units.resize(len, 0);
        }
        if self.epoch == u32::MAX {
            self.stamps.fill(0);
            self.wanted.fill(0);
            self.epoch = 0;
        }
        self.epoch += 1;
        self.queue.clear();
        self.reach(source as u32, 0);
    }

    /// Length of the shortest path found so far; final for points that are settled.
    fn units(&self, point: usize) -> u64 {
        if self.stamps[point] == self.epoch {
            self.units[point]
        } else {
            UNREACHED
        }
    }

    /// Marks a point as a target; `false` when it is one already.
    fn want(&mut self, point: usize) -> bool {
        std::mem::replace(&mut self.wanted[point], self.epoch) != self.epoch
    }

    fn is_wanted(&self, point: usize) -> bool {
        self.wanted[point] == self.epoch
    }

    fn reach(&mut self, point: u32, units: u64) {
        if units < self.units(point as usize) {
            self.stamps[point as usize] = self.epoch;
            self.units[point as usize] = units;
            self.queue.push(Reverse((units, point)));
        }
    }

    /// Drops queue entries that a shorter path has overtaken.
    fn top(&mut self) -> Option<u64> {
        while let Some(&Reverse((units, point))) = self.queue.peek() {
            if units == self.units[point as usize] {
                return Some(units);
            }
            self.queue.pop();
        }
        None
    }

    /// Settles the nearest point that is not settled yet, in order of (distance, index), and
    /// reaches out from it as far as `most`.
    fn settle(&mut self, graph: &Csr<(), u64, Directed, u32>, most: u64) -> Option<(u64, u32)> {
        self.top()?;
        let Reverse((units, point)) = self.queue.pop()?;
        let edges = graph.edges_slice(point);
        for (&end, &length) in graph.neighbors_slice(point).iter().zip(edges) {
            let there = units + length;
            if there <= most {
                self.reach(end, there);
            }
        }
        Some((units, point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::euclidean::EuclideanOracle;
    use crosscap_algorithms::metric::{BruteForceOracle, GivenDistances};
    use crosscap_core::PointCloud;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// All shortest paths by Floyd's and Warshall's three loops.
    fn floyd_warshall<S: Scalar>(metric: &GeodesicMetric<S>) -> Vec<f64> {
        let n = metric.len();
        let mut d = vec![f64::INFINITY; n * n];
        for a in 0..n {
            d[a * n + a] = 0.0;
            for (b, length) in metric.edges_of(a) {
                d[a * n + b] = length.as_f64();
            }
        }
        for k in 0..n {
            for a in 0..n {
                for b in 0..n {
                    d[a * n + b] = d[a * n + b].min(d[a * n + k] + d[k * n + b]);
                }
            }
        }
        d
    }

    fn rule() -> impl Strategy<Value = EdgeRule> {
        prop_oneof![
            (0.1_f64..1.5).prop_map(EdgeRule::Within),
            (1_usize..7).prop_map(EdgeRule::Nearest),
        ]
    }

    /// Points of the plane, half of the time on a coarse grid: copies, ties and edges of length 0.
    fn points() -> impl Strategy<Value = Vec<f64>> {
        (any::<bool>(), prop::collection::vec(-1.0_f64..1.0, 2..80)).prop_map(|(grid, mut c)| {
            c.truncate(c.len() / 2 * 2);
            if grid {
                c.iter_mut().for_each(|x| *x = (*x * 3.0).round() / 3.0);
            }
            c
        })
    }

    fn check<S: Scalar>(
        cloud: PointCloud<S>,
        rule: EdgeRule,
        scale: f64,
    ) -> Result<(), TestCaseError> {
        let rule = match rule {
            EdgeRule::Within(r) => EdgeRule::Within(r * scale),
            nearest => nearest,
        };
        let euclidean = EuclideanOracle::new(cloud).unwrap();
        let metric = GeodesicMetric::new(&euclidean, rule).unwrap();
        let n = metric.len();
        let reference = floyd_warshall(&metric);
        let d = |a: usize, b: usize| metric.distance(a, b).as_f64();
        let rounding = 8.0 * S::default_epsilon().as_f64();
        let mut edges = 0;
        for a in 0..n {
            for (b, length) in metric.edges_of(a) {
                edges += 1;
                let straight = euclidean.distance(a, b).as_f64();
                prop_assert!((length.as_f64() - straight).abs() <= 1e-12 * scale);
            }
            for b in 0..n {
                prop_assert_eq!(d(a, b).to_bits(), d(b, a).to_bits());
                let expected = reference[a * n + b];
                prop_assert!(
                    d(a, b) == expected
                        || (d(a, b) - expected).abs() <= n as f64 * rounding * expected,
                    "{} {}: {} {}",
                    a,
                    b,
                    d(a, b),
                    expected
                );
                for c in 0..n {
                    prop_assert!(d(a, c) <= (d(a, b) + d(b, c)) * (1.0 + rounding));
                }
            }
            prop_assert_eq!(d(a, a), 0.0);
        }
        prop_assert_eq!(edges, 2 * metric.report().edges);

        // The oracle, and distances in bulk, are those of the metric to the bit.
        let brute = BruteForceOracle::new(&metric);
        let (mut found, mut expected, mut row) = (vec![], vec![], vec![]);
        for center in 0..n {
            let rim = metric.distance(center, n / 2);
            for radius in [
                S::of(0.4 * scale),
                S::of(scale),
                rim,
                S::zero(),
                S::of(f64::NAN),
                S::of(f64::INFINITY),
            ] {
                metric.within(center, radius, &mut found);
                brute.within(center, radius, &mut expected);
                prop_assert_eq!(&found, &expected, "within {} of {}", radius, center);
            }
            for count in [0, 1, 2, n / 2, n, n + 1] {
                metric.nearest(center, count, &mut found);
                brute.nearest(center, count, &mut expected);
                prop_assert_eq!(&found, &expected, "{} nearest to {}", count, center);
            }
            let targets: Vec<usize> = (0..n).step_by(3).chain([center, 0]).collect();
            metric.distances_to(center, &targets, &mut row);
            let expected: Vec<S> = targets
                .iter()
                .map(|&t| metric.distance(center, t))
                .collect();
            prop_assert_eq!(&row, &expected);
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn equals_all_shortest_paths(points in points(), rule in rule(), exponent in -9_i32..9) {
            let scale = 10_f64.powi(exponent);
            let cloud = |s: f64| PointCloud::new(2, points.iter().map(|x| x * s).collect()).unwrap();
            check(cloud(1.0).cast::<f32>(), rule, 1.0)?;
            check(cloud(scale), rule, scale)?;
        }

        #[test]
        fn components_are_those_of_the_distances(points in points(), rule in rule()) {
            let oracle = EuclideanOracle::new(PointCloud::new(2, points).unwrap()).unwrap();
            let metric = GeodesicMetric::new(&oracle, rule).unwrap();
            let reference = floyd_warshall(&metric);
            let n = metric.len();
            let report = metric.report();
            prop_assert_eq!(report.components.iter().map(|c| c.size).sum::<usize>(), n);
            for component in &report.components {
                let row = &reference[component.first * n..][..n];
                prop_assert_eq!(row.iter().filter(|d| d.is_finite()).count(), component.size);
                prop_assert_eq!(row.iter().position(|d| d.is_finite()), Some(component.first));
            }
            prop_assert_eq!(report.is_connected(), reference.iter().all(|d| d.is_finite()));
        }
    }

    fn circle(n: usize) -> EuclideanOracle<f64> {
        let c = (0..n).flat_map(|i| {
            let (sin, cos) = (2.0 * PI * i as f64 / n as f64).sin_cos();
            [cos, sin]
        });
        EuclideanOracle::new(PointCloud::new(2, c.collect()).unwrap()).unwrap()
    }

    /// Spread evenly over the unit sphere along a spiral of golden angles.
    fn sphere(n: usize) -> PointCloud<f64> {
        let c = (0..n).flat_map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / n as f64;
            let (sin, cos) = (i as f64 * PI * (3.0 - 5_f64.sqrt())).sin_cos();
            let r = (1.0 - z * z).sqrt();
            [r * cos, r * sin, z]
        });
        PointCloud::new(3, c.collect()).unwrap()
    }

    #[test]
    fn arcs_of_a_circle() {
        let oracle = circle(1000);
        let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.05)).unwrap();
        assert_eq!(metric.report().warnings(), []);
        for b in [1, 10, 250, 500, 999] {
            let arc = 2.0 * PI * b.min(1000 - b) as f64 / 1000.0;
            approx::assert_relative_eq!(metric.distance(0, b), arc, max_relative = 1e-3);
        }
    }

    #[test]
    fn great_circles_of_a_sphere() {
        let cloud = sphere(6000);
        let oracle = EuclideanOracle::new(cloud.clone()).unwrap();
        let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.15)).unwrap();
        assert_eq!(metric.report().warnings(), []);
        let mut out = vec![];
        let points: Vec<usize> = (0..6000).step_by(211).collect();
        metric.distances_among(&points, &mut out);
        let mut total = 0.0;
        for (i, &a) in points.iter().enumerate() {
            for (j, &b) in points.iter().enumerate().filter(|&(j, _)| j != i) {
                let product: f64 = cloud
                    .point(a)
                    .iter()
                    .zip(cloud.point(b))
                    .map(|(x, y)| x * y)
                    .sum();
                let excess = out[i * points.len() + j] / product.clamp(-1.0, 1.0).acos() - 1.0;
                assert!((-0.005..0.04).contains(&excess), "{a} {b}: {excess}");
                assert_eq!(out[i * points.len() + j], out[j * points.len() + i]);
                total += excess;
            }
        }
        assert!(total / ((points.len() * (points.len() - 1)) as f64) < 0.015);
    }

    #[test]
    fn a_graph_that_is_too_coarse_or_falls_apart_says_so() {
        let oracle = circle(100);
        let coarse = GeodesicMetric::new(&oracle, EdgeRule::Nearest(2)).unwrap();
        assert!(
            matches!(coarse.report().warnings()[..], [GraphWarning::TooCoarse { ratio, .. }] if ratio < 1.1)
        );
        let apart = GeodesicMetric::new(&oracle, EdgeRule::Within(0.05)).unwrap();
        assert_eq!(apart.report().components.len(), 100);
        assert!(apart.distance(0, 1).is_infinite());
        let pair = PointCloud::new(1, vec![0.0, 1.0, 2.0, 50.0, 51.0]).unwrap();
        let pair = GeodesicMetric::new(&EuclideanOracle::new(pair).unwrap(), EdgeRule::Within(4.0))
            .unwrap();
        let expected = GraphWarning::Disconnected {
            count: 2,
            largest: 3,
            outside: 3,
        };
        assert_eq!(pair.report().warnings(), [expected]);
    }

    #[test]
    fn bad_rules_and_bad_oracles_are_refused() {
        let oracle = circle(10);
        for rule in [0.0, -1.0, f64::NAN, f64::INFINITY].map(EdgeRule::Within) {
            assert!(GeodesicMetric::new(&oracle, rule).err().unwrap().is_input());
        }
        assert!(
            GeodesicMetric::new(&oracle, EdgeRule::Nearest(0))
                .err()
                .unwrap()
                .is_input()
        );

        struct Broken;
        impl NeighborhoodOracle for Broken {
            type Scalar = f64;
            fn len(&self) -> usize {
                3
            }
            fn within(&self, _: usize, _: f64, out: &mut Vec<Neighbor<f64>>) {
                *out = vec![Neighbor {
                    index: 7,
                    distance: 0.5,
                }];
            }
            fn nearest(&self, _: usize, _: usize, out: &mut Vec<Neighbor<f64>>) {
                *out = vec![Neighbor {
                    index: 0,
                    distance: f64::NAN,
                }];
            }
        }
        for rule in [EdgeRule::Within(1.0), EdgeRule::Nearest(1)] {
            assert!(matches!(
                GeodesicMetric::new(&Broken, rule),
                Err(Error::Law { .. })
            ));
        }
    }

    #[test]
    fn empty_and_single_and_measured() {
        let empty = EuclideanOracle::new(PointCloud::<f64>::new(2, vec![]).unwrap()).unwrap();
        let empty = GeodesicMetric::new(&empty, EdgeRule::Nearest(3)).unwrap();
        assert!(empty.is_empty() && empty.report().is_connected());
        let one = EuclideanOracle::new(PointCloud::new(1, vec![4.0_f32]).unwrap()).unwrap();
        let one = GeodesicMetric::new(&one, EdgeRule::Nearest(3)).unwrap();
        assert_eq!(one.distance(0, 0), 0.0);
        // Over distances that were measured, without coordinates: the long way is cut short.
        let d = GivenDistances::new(3, vec![0.0, 1.0, 9.0, 1.0, 0.0, 1.5, 9.0, 1.5, 0.0]).unwrap();
        let metric = GeodesicMetric::new(&BruteForceOracle::new(d), EdgeRule::Within(2.0)).unwrap();
        assert_eq!(metric.distance(0, 2), 2.5);
    }

    #[test]
    fn threads_agree() {
        let oracle = EuclideanOracle::new(sphere(800)).unwrap();
        let metric = GeodesicMetric::new(&oracle, EdgeRule::Nearest(10)).unwrap();
        let ball = |center| {
            let mut out = vec![];
            metric.within(center, 0.7, &mut out);
            out
        };
        let parallel: Vec<_> = (0..800).into_par_iter().map(ball).collect();
        assert!((0..800).all(|center| ball(center) == parallel[center]));
    }

    /// `cargo test -p crosscap-backends time_of_a_ball -- --ignored --nocapture`
    #[test]
    #[ignore = "a measurement"]
    fn time_of_a_ball() {
        let oracle = EuclideanOracle::new(sphere(43_500)).unwrap();
        let start = std::time::Instant::now();
        let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.06)).unwrap();
        println!(
            "graph of {} edges: {:?}",
            metric.report().edges,
            start.elapsed()
        );
        let (mut out, mut total) = (vec![], 0);
        let start = std::time::Instant::now();
        for i in 0..2000 {
            metric.within(i * 7919 % 43_500, 0.264, &mut out);
            total += out.len();
        }
        println!(
            "ball of {} points: {:?}",
            total / 2000,
            start.elapsed() / 2000
        );
        let start = std::time::Instant::now();
        let sum: f64 = (0..200)
            .map(|i| metric.distance(i * 7919 % 43_500, i * 104_729 % 43_500))
            .sum();
        println!(
            "distance of {:.2}: {:?}",
            sum / 200.0,
            start.elapsed() / 200
        );
    }
}
