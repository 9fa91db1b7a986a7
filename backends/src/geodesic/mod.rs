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

mod edges;
mod report;
mod search;
#[cfg(test)]
mod tests;

pub use edges::EdgeRule;
pub use report::{Component, GraphReport, GraphWarning, LEAST_REACH};

use crosscap_core::{Error, MetricSpace, Neighbor, NeighborhoodOracle, Scalar};
use edges::Edges;
use petgraph::Directed;
use petgraph::csr::Csr;
use search::{SCRATCH, UNREACHED};

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
        let rows = edges::rows(oracle, rule, length)?;
        let Edges {
            graph,
            unit,
            component,
            report,
        } = Edges::of(rows, rule)?;
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
