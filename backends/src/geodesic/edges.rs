//! Which points a graph joins, and how long its edges are.

use super::report::{GraphReport, census};
use crosscap_core::{Error, Neighbor, NeighborhoodOracle, Scalar};
use petgraph::Directed;
use petgraph::csr::Csr;
use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

/// Which points an edge joins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeRule {
    /// Points at distance strictly less than this, in the unit of the data.
    Within(f64),
    /// A point with its so many nearest other points; the union over both ends.
    Nearest(usize),
}

impl EdgeRule {
    fn check(self) -> Result<(), Error> {
        let refuse = |name, value, expected: &str| {
            Err(Error::Parameter {
                name,
                value,
                expected: expected.into(),
            })
        };
        match self {
            Self::Within(r) if !(r > 0.0 && r.is_finite()) => {
                refuse("edge length", r.to_string(), "a positive, finite length")
            }
            Self::Nearest(0) => refuse("nearest neighbors", "0".into(), "at least 1"),
            _ => Ok(()),
        }
    }
}

/// The edges from a point, each with its length.
type Row = Vec<(u32, f64)>;

/// The edges from every point, as long as `length` makes of their ends and what the oracle says.
pub(super) fn rows<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    rule: EdgeRule,
    length: &(dyn Fn(usize, usize, f64) -> f64 + Sync),
) -> Result<Vec<Row>, Error> {
    rule.check()?;
    let len = oracle.len();
    if u32::try_from(len).is_err() {
        return Err(Error::Shape {
            found: format!("{len} points"),
            expected: format!("at most {} points", u32::MAX),
        });
    }
    let points = (0..len).into_par_iter();
    points
        .map_init(Vec::new, |found, point| {
            let mut edges = row(oracle, rule, point, found)?;
            for (other, far) in &mut edges {
                *far = length(point, *other as usize, *far);
            }
            edges.retain(|edge| edge.1.is_finite());
            Ok(edges)
        })
        .collect()
}

/// The edges that the rule draws from `point`.
fn row<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    rule: EdgeRule,
    point: usize,
    found: &mut Vec<Neighbor<S>>,
) -> Result<Row, Error> {
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

/// A graph, and what is known of it.
pub(super) struct Edges {
    /// Both directions of every edge, with its length in units.
    pub graph: Csr<(), u64, Directed, u32>,
    /// A power of two, in the unit of the data.
    pub unit: f64,
    /// Label of the component of every point.
    pub component: Vec<u32>,
    pub report: GraphReport,
}

impl Edges {
    /// The graph with the edges of all points, each in both directions.
    pub fn of(rows: Vec<Row>, rule: EdgeRule) -> Result<Self, Error> {
        let len = rows.len();
        let longest = (rows.iter().flatten()).fold(0.0, |most: f64, e| most.max(e.1));
        let unit = unit_for(longest, len);
        let (spacing, reach) = (spacing(&rows), reach(&rows, rule));
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
        })
    }
}

/// Median length of the shortest edge of a point.
fn spacing(rows: &[Row]) -> f64 {
    median(rows.iter().filter_map(|r| {
        let nearest = r.iter().map(|e| e.1).filter(|&d| d > 0.0);
        nearest.min_by(f64::total_cmp)
    }))
}

/// How far edges reach: the radius that was asked for, or the median length of the longest edge of a point.
fn reach(rows: &[Row], rule: EdgeRule) -> f64 {
    let longest = |r: &Row| r.iter().fold(0.0, |m: f64, e| m.max(e.1));
    match rule {
        EdgeRule::Within(radius) => radius,
        EdgeRule::Nearest(_) => median(rows.iter().map(longest)),
    }
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
