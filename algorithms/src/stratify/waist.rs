//! Landmarks, cells and distances put together.

use super::analysis::{Analysis, Analyzer, Role};
use super::cells::{CellGraph, Flood, Reference, references};
use super::chains::{Curves, NODE_SPACING, more_references};
use crate::execute;
use crosscap_core::{
    CellNeighborhood, Error, LandmarkSelector, MetricSpace, Neighbor, NeighborhoodOracle, Scalar,
    SparseDistances, StratifiedLandmarks, squared_distance,
};
use serde::{Deserialize, Serialize};

/// Parameters of the stratification.
#[derive(Clone, Debug)]
pub struct StratifyOptions {
    /// Landmark separation dl, unit of the data.
    pub dl: f64,
    /// Radius of the charts (strict), unit of the data; 3 dl where the user says nothing.
    pub tri_eps: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
    /// Rows that are landmarks whatever their separation.
    pub extra: Vec<usize>,
}

/// What the stratification counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StratifyCounts {
    /// Landmarks.
    pub landmarks: usize,
    /// Landmarks on curves and points.
    pub curve_landmarks: usize,
    /// Landmarks that are points where curves end.
    pub corners: usize,
    /// Chain edges.
    pub curve_edges: usize,
    /// Edges of the neighbor graph that the labels cut.
    pub cut_edges: usize,
    /// Mean number of members of a neighborhood.
    pub mean_members: f64,
}

/// The waist, and what ties it to the points.
#[derive(Clone, Debug)]
pub struct Stratification<S> {
    /// What the triangulator takes.
    pub waist: StratifiedLandmarks<S>,
    /// Row of the input that each landmark stands for.
    pub rows: Vec<usize>,
    /// Counts for the report.
    pub counts: StratifyCounts,
}

/// The space that charts live in, where it is not that of the places.
#[derive(Clone, Copy)]
pub struct ChartSpace<'a, S: Scalar> {
    /// Distances inside the charts.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// What is inside a chart; serves the same metric.
    pub oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
}

impl<S: Scalar> ChartSpace<'_, S> {
    /// Distances of sorted pairs of landmarks. Where a landmark was moved onto a curve, what the move
    /// does to the straight line is added: a metric knows the points as they were.
    fn lengths(
        &self,
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        rows: &[usize],
        pairs: &[(u32, u32)],
    ) -> Vec<S> {
        let mut lengths = lengths(analyzer, self.metric, rows, pairs);
        for (length, &(a, b)) in lengths.iter_mut().zip(pairs) {
            let (p, q) = (rows[a as usize], rows[b as usize]);
            if analysis.offsets[p] > 0.0 || analysis.offsets[q] > 0.0 {
                let moved = analysis.places.squared_distance(p, q).sqrt();
                let straight = analyzer.cloud.squared_distance(p, q).sqrt();
                *length = S::of((length.as_f64() + moved - straight).max(0.0));
            }
        }
        lengths
    }
}

/// Distances of sorted pairs of landmarks in a metric, asked for row by row.
pub(super) fn lengths<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    metric: &dyn MetricSpace<Scalar = S>,
    rows: &[usize],
    pairs: &[(u32, u32)],
) -> Vec<S> {
    let runs: Vec<&[(u32, u32)]> = pairs.chunk_by(|x, y| x.0 == y.0).collect();
    let lengths = execute::map(analyzer.execute, runs.len(), Vec::new, |targets, k| {
        targets.clear();
        targets.extend(runs[k].iter().map(|&(_, b)| rows[b as usize]));
        let mut lengths = Vec::with_capacity(targets.len());
        metric.distances_to(rows[runs[k][0].0 as usize], targets, &mut lengths);
        lengths
    });
    lengths.into_iter().flatten().collect()
}

/// The points of a ball with their distances from its center, reusable.
struct Ball<S> {
    found: Vec<Neighbor<S>>,
    stamps: Vec<u32>,
    distances: Vec<f64>,
    round: u32,
}

impl<S: Scalar> Ball<S> {
    fn new(n: usize) -> Self {
        Self {
            found: Vec::new(),
            stamps: vec![0; n],
            distances: vec![0.0; n],
            round: 0,
        }
    }

    fn fill(&mut self, oracle: &dyn NeighborhoodOracle<Scalar = S>, center: usize, radius: f64) {
        self.round += 1;
        oracle.within(center, S::of(radius), &mut self.found);
        for x in &self.found {
            self.stamps[x.index] = self.round;
            self.distances[x.index] = x.distance.as_f64();
        }
    }

    fn holds(&self, row: usize) -> bool {
        self.stamps[row] == self.round
    }

    /// Distance of a point that the ball holds.
    fn distance(&self, row: usize) -> f64 {
        self.distances[row]
    }
}

/// Points of a cell that must be flooded for a curve landmark to be at the rim of the flood.
const CONTACTS: usize = 6;
/// Spacing of the decompositions that label points, as a share of the radius of their fit.
const REFERENCE_SPACING: f64 = 0.2;
/// Where landmarks are sparse a chart of the usual radius misses triangles that it has to keep clear
/// of: charts with fewer members are widened by a factor, a few times.
const LEAST_MEMBERS: usize = 14;
const WIDENING: f64 = 1.25;
const WIDENINGS: usize = 2;
/// A cell whose points begin farther than this many dl from a curve landmark does not touch it.
const CONTACT_REACH: f64 = 2.0;

/// Cuts the cloud along its curves and points into cells and describes every landmark's surroundings.
///
/// `charts` gives the extent of the neighborhoods and the distances inside them, in any metric on the
/// rows of the input; `None` for Euclidean distances of the places, moved ones included.
///
/// # Errors
/// [`Error::Parameter`] for lengths that are not positive; those of the selector.
pub fn stratify<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &mut Analysis,
    charts: Option<&ChartSpace<'_, S>>,
    selector: &dyn LandmarkSelector<Scalar = S>,
    options: &StratifyOptions,
) -> Result<Stratification<S>, Error> {
    for (name, value) in [("dl", options.dl), ("tri-eps", options.tri_eps)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::Parameter {
                name,
                value: value.to_string(),
                expected: "a positive length".into(),
            });
        }
    }
    let n = analysis.roles.len();
    let mut near = Vec::new();
    analysis.fill_curves(2.0 * NODE_SPACING * options.dl, |row, radius, out| {
        analyzer.oracle.within(row, S::of(radius), &mut near);
        out.clear();
        out.extend(near.iter().map(|x| x.index));
    });
    let analysis = &*analysis;
    let places = &analysis.places;
    let curves = Curves::new(analyzer, analysis, options.dl);
    let mut refs = references(
        analyzer,
        analysis,
        &curves
            .rows
            .iter()
            .copied()
            .filter(|&r| analysis.radii[r] > 0.0)
            .collect::<Vec<_>>(),
    );
    let least = curves
        .rows
        .iter()
        .map(|&r| analysis.radii[r])
        .filter(|&r| r > 0.0)
        .fold(f64::INFINITY, f64::min);
    if least.is_finite() {
        let known: Vec<usize> = refs.iter().map(|r| r.row).collect();
        refs.extend(more_references(
            analyzer,
            analysis,
            REFERENCE_SPACING * least,
            &known,
        ));
    }
    let graph = CellGraph::new(analyzer, analysis, &refs);

    let mut rows = curves.rows.clone();
    let candidates = free_of_edges(analyzer, analysis, &curves);
    let taken = &curves.rows;
    let chosen = selector.select(
        analyzer.oracle,
        &candidates,
        taken,
        options.dl,
        options.seed,
    )?;
    rows.extend(&chosen);
    for &row in &options.extra {
        if row < n && analysis.roles[row] == Role::Regular && !chosen.contains(&row) {
            rows.push(row);
        }
    }
    let mut strata = vec![2u8; rows.len()];
    strata[..curves.rows.len()].fill(1);
    strata[..curves.corners].fill(0);
    let mut landmark_at = vec![u32::MAX; n];
    for (k, &row) in rows.iter().enumerate() {
        landmark_at[row] = k as u32;
    }

    let contacts = Contacts::new(analyzer, analysis, &curves, &refs, options.dl);
    let mut flood = Flood::new(n);
    let mut ball = Ball::new(if charts.is_some() { n } else { 0 });
    let mut hits = vec![0u32; contacts.groups.len()];
    let mut touched: Vec<u32> = Vec::new();
    let mut neighborhoods = Vec::with_capacity(rows.len());
    let starts = (curves.rows.len()..rows.len()).map(|k| (k, None)).chain(
        contacts
            .groups
            .iter()
            .enumerate()
            .map(|(g, group)| (group.landmark, Some(g))),
    );
    for (center, group) in starts {
        let origin = places.point(rows[center]);
        let mut members: Vec<u32> = Vec::new();
        let mut radius = options.tri_eps;
        for widening in 0..=WIDENINGS {
            let reach = radius * radius;
            if let Some(charts) = charts {
                ball.fill(charts.oracle, rows[center], radius);
            }
            let inside = |row: usize| match charts {
                None => squared_distance(origin, places.point(row)) < reach,
                Some(_) => ball.holds(row),
            };
            match group {
                None => flood.run(&graph, std::iter::once(rows[center] as u32), inside),
                Some(g) => flood.run(&graph, contacts.groups[g].rows.iter().copied(), inside),
            }
            members.clear();
            touched.clear();
            for &row in &flood.reached {
                let k = landmark_at[row as usize];
                if k != u32::MAX && k as usize != center {
                    members.push(k);
                }
                for &g in contacts.of(row as usize) {
                    if hits[g as usize] == 0 {
                        touched.push(g);
                    }
                    hits[g as usize] += 1;
                }
            }
            for &g in &touched {
                let group = &contacts.groups[g as usize];
                let enough = 2 * hits[g as usize] as usize >= group.rows.len();
                hits[g as usize] = 0;
                if enough && group.landmark != center && inside(rows[group.landmark]) {
                    members.push(group.landmark as u32);
                }
            }
            if members.len() >= LEAST_MEMBERS || widening == WIDENINGS {
                break;
            }
            radius *= WIDENING;
        }
        members.sort_unstable();
        members.dedup();
        let far = |k: u32| match charts {
            None => squared_distance(origin, places.point(rows[k as usize])),
            Some(_) => ball.distance(rows[k as usize]),
        };
        members.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        members.insert(0, center as u32);
        neighborhoods.push(CellNeighborhood {
            center: center as u32,
            members,
        });
    }
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for near in &neighborhoods {
        for (i, &a) in near.members.iter().enumerate() {
            pairs.extend(near.members[..i].iter().map(|&b| (a.min(b), a.max(b))));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let lengths: Vec<S> = match charts {
        Some(charts) => charts.lengths(analyzer, analysis, &rows, &pairs),
        None => (pairs.iter())
            .map(|&(a, b)| {
                let (p, q) = (rows[a as usize], rows[b as usize]);
                S::of(places.squared_distance(p, q).sqrt())
            })
            .collect(),
    };
    let distances = SparseDistances::new(
        rows.len(),
        pairs.iter().zip(&lengths).map(|(&(a, b), &d)| (a, b, d)),
    )?;
    let counts = StratifyCounts {
        landmarks: rows.len(),
        curve_landmarks: curves.rows.len(),
        corners: curves.corners,
        curve_edges: curves.edges.len(),
        cut_edges: graph.cut,
        mean_members: neighborhoods.iter().map(|x| x.members.len()).sum::<usize>() as f64
            / neighborhoods.len().max(1) as f64,
    };
    Ok(Stratification {
        waist: StratifiedLandmarks {
            strata,
            curve_edges: curves.edges,
            neighborhoods,
            distances,
        },
        rows,
        counts,
    })
}

/// Regular rows outside the diametral ball of every chain edge: a landmark inside it would
/// make the edge no edge of a Delaunay triangulation, and on a convex boundary may even lie
/// beyond it.
fn free_of_edges<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    curves: &Curves,
) -> Vec<usize> {
    let places = &analysis.places;
    let mut barred = vec![false; analysis.roles.len()];
    let mut near = Vec::new();
    for e in &curves.edges {
        let [a, b] = e.ends.map(|k| curves.rows[k as usize]);
        let length = places.squared_distance(a, b);
        let slack = analysis.offsets[a];
        analyzer
            .oracle
            .within(a, S::of(length.sqrt() + slack), &mut near);
        for x in &near {
            if places.squared_distance(a, x.index) + places.squared_distance(b, x.index) < length {
                barred[x.index] = true;
            }
        }
    }
    (0..analysis.roles.len())
        .filter(|&i| analysis.roles[i] == Role::Regular && !barred[i])
        .collect()
}

/// One cell at one curve landmark.
struct ContactGroup {
    landmark: usize,
    /// The points of the cell nearest to the landmark.
    rows: Vec<u32>,
}

/// Which points of which cells touch which curve landmarks.
struct Contacts {
    groups: Vec<ContactGroup>,
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Contacts {
    fn new<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        curves: &Curves,
        refs: &[Reference],
        dl: f64,
    ) -> Self {
        let places = &analysis.places;
        let mut groups = Vec::new();
        let mut near = Vec::new();
        for (landmark, &row) in curves.rows.iter().enumerate() {
            let reference = refs.iter().find(|r| r.row == row);
            let reach = CONTACT_REACH * dl;
            analyzer
                .oracle
                .within(row, S::of(reach + analysis.offsets[row]), &mut near);
            let mut cells: Vec<(u8, f64, u32)> = near
                .iter()
                .filter(|x| analysis.roles[x.index] == Role::Regular)
                .filter_map(|x| {
                    let label = match reference {
                        None => 0,
                        Some(r) => r.label(x.index).filter(|&l| r.is_cell(l))?,
                    };
                    Some((label, places.squared_distance(row, x.index), x.index as u32))
                })
                .collect();
            cells.sort_by(|a, b| {
                (a.0, a.1)
                    .partial_cmp(&(b.0, b.1))
                    .unwrap_or(std::cmp::Ordering::Equal)
                    .then(a.2.cmp(&b.2))
            });
            for cell in cells.chunk_by(|a, b| a.0 == b.0) {
                groups.push(ContactGroup {
                    landmark,
                    rows: cell.iter().take(CONTACTS).map(|x| x.2).collect(),
                });
            }
        }
        let n = analysis.roles.len();
        let mut pairs: Vec<(u32, u32)> = groups
            .iter()
            .enumerate()
            .flat_map(|(g, group)| group.rows.iter().map(move |&r| (r, g as u32)))
            .collect();
        pairs.sort_unstable();
        let mut starts = vec![0u32; n + 1];
        for &(r, _) in &pairs {
            starts[r as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        Self {
            groups,
            starts,
            entries: pairs.into_iter().map(|(_, g)| g).collect(),
        }
    }

    /// The groups that a row belongs to.
    fn of(&self, row: usize) -> &[u32] {
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}
