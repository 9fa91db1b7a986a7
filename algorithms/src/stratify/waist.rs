//! Landmarks, cells and distances put together.

use super::analysis::{Analysis, Analyzer, Role};
use super::cells::{CellGraph, Flood, Reference, Region, references};
use super::chains::{Curves, NODE_SPACING, more_references};
use super::plain::Surroundings;
use crate::audit;
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

/// A landmark at a 0-stratum, with what meets there by the model that found it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointStratum {
    /// The landmark.
    pub landmark: u32,
    /// Number of curves that end there.
    pub curves: usize,
    /// Number of cells that have it at their rim.
    pub cells: usize,
}

/// The waist, and what ties it to the points.
#[derive(Clone, Debug)]
pub struct Stratification<S> {
    /// What the triangulator takes.
    pub waist: StratifiedLandmarks<S>,
    /// Row of the input that each landmark stands for.
    pub rows: Vec<usize>,
    /// The 0-strata that a model found.
    pub points: Vec<PointStratum>,
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

/// Every point of a curve has a landmark or a reference within this many dl.
const CURVE_GAP: f64 = 0.7;
/// Floods that a job takes at a time.
const FLOODS_AT_ONCE: usize = 32;

/// A neighborhood to be found: that of a landmark of a cell, or of one cell at a curve landmark.
struct Job {
    landmark: usize,
    group: Option<usize>,
}

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
    if let Some(charts) = charts {
        audit::metric(charts.metric, charts.oracle)?;
    }
    let n = analysis.roles.len();
    let gap = 2.0 * NODE_SPACING * options.dl;
    analysis.fill_curves(gap, options.dl);
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
    analysis.faults.none()?;
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
    let question = audit::Question {
        plugin: selector.name(),
        candidates: &candidates,
        taken,
        separation: options.dl,
    };
    audit::selection(analyzer.oracle, analyzer.execute, &question, &chosen)?;
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
    let width = places.dimension();
    let mut landmark_places = Vec::with_capacity(rows.len() * width);
    for &row in &rows {
        landmark_places.extend_from_slice(places.point(row));
    }
    let mut on_curves = landmark_places[..curves.rows.len() * width].to_vec();
    for reference in &refs {
        on_curves.extend_from_slice(places.point(reference.row));
    }
    let gap = CURVE_GAP * options.dl;
    let around = Surroundings::new(width, landmark_places, &on_curves, gap, options.dl);
    let jobs: Vec<Job> = (curves.rows.len()..rows.len())
        .map(|k| Job {
            landmark: k,
            group: None,
        })
        .chain(contacts.groups.iter().enumerate().map(|(g, group)| Job {
            landmark: group.landmark,
            group: Some(g),
        }))
        .collect();
    let mut found: Vec<Option<Vec<u32>>> = execute::map(
        analyzer.execute,
        jobs.len(),
        Default::default,
        |scratch, j| {
            let job = &jobs[j];
            if job.group.is_some() || charts.is_some() {
                return None;
            }
            let landmark = job.landmark as u32;
            let mut radius = options.tri_eps;
            let mut members = around.near(landmark, radius);
            for _ in 0..WIDENINGS {
                if members.len() >= LEAST_MEMBERS {
                    break;
                }
                radius *= WIDENING;
                members = around.near(landmark, radius);
            }
            let origin = places.point(rows[job.landmark]);
            around
                .is_plain(landmark, radius, &members, scratch)
                .then(|| {
                    nearest_first(members, |k| {
                        squared_distance(origin, places.point(rows[k as usize]))
                    })
                })
        },
    );
    let mut pending: Vec<usize> = (0..jobs.len()).filter(|&j| found[j].is_none()).collect();
    let mut radius = options.tri_eps;
    let mut cut_edges = 0;
    // The last graph, and how far it reaches about every landmark.
    let mut known: Option<(CellGraph, Vec<f64>)> = None;
    for widening in 0..=WIDENINGS {
        if pending.is_empty() {
            break;
        }
        let sufficient = known
            .take()
            .filter(|(_, reach)| pending.iter().all(|&j| reach[jobs[j].landmark] >= radius));
        let (graph, reach) = match sufficient {
            Some(known) => known,
            None if charts.is_some() => {
                // Nothing is known of how far a chart reaches in straight lines.
                let region = Region::everything(n, options.dl);
                let reach = vec![f64::INFINITY; rows.len()];
                (CellGraph::new(analyzer, analysis, &refs, &region), reach)
            }
            None => {
                let mut reach = vec![0.0_f64; rows.len()];
                for &j in &pending {
                    // Where curves cut charts they are likely to be widened.
                    let spare = if jobs[j].group.is_some() {
                        WIDENING
                    } else {
                        1.0
                    };
                    reach[jobs[j].landmark] = spare * radius;
                }
                let centers: Vec<(usize, f64)> = (rows.iter().copied().zip(reach.iter().copied()))
                    .filter(|&(_, reach)| reach > 0.0)
                    .collect();
                let region = Region::about(analyzer, analysis, &centers, options.dl);
                (CellGraph::new(analyzer, analysis, &refs, &region), reach)
            }
        };
        if widening == 0 {
            cut_edges = graph.cut;
        }
        let flooded = execute::map_blocks(
            analyzer.execute,
            FLOODS_AT_ONCE,
            pending.len(),
            || {
                let held = if charts.is_some() { n } else { 0 };
                (Hits::new(&contacts), Ball::new(held))
            },
            |(hits, ball), p| {
                let job = &jobs[pending[p]];
                let own = [rows[job.landmark] as u32];
                let from = job.group.map_or(&own[..], |g| &contacts.groups[g].rows);
                let origin = places.point(own[0] as usize);
                let reach = radius * radius;
                if let Some(charts) = charts {
                    ball.fill(charts.oracle, rows[job.landmark], radius);
                }
                let node_inside = |node: usize| match charts {
                    None => squared_distance(origin, graph.place(node)) < reach,
                    Some(_) => ball.holds(graph.row(node)),
                };
                let inside = |k: usize| match charts {
                    None => squared_distance(origin, places.point(rows[k])) < reach,
                    Some(_) => ball.holds(rows[k]),
                };
                hits.flood.run(&graph, from, node_inside);
                let found = hits.members(&contacts, &landmark_at, job.landmark, inside);
                nearest_first(found, |k| match charts {
                    None => squared_distance(origin, places.point(rows[k as usize])),
                    Some(_) => ball.distance(rows[k as usize]),
                })
            },
        );
        let mut thin = Vec::new();
        for (&j, members) in pending.iter().zip(flooded) {
            if members.len() >= LEAST_MEMBERS || widening == WIDENINGS {
                found[j] = Some(members);
            } else {
                thin.push(j);
            }
        }
        pending = thin;
        radius *= WIDENING;
        known = Some((graph, reach));
    }
    let neighborhoods: Vec<CellNeighborhood> = jobs
        .iter()
        .zip(found)
        .map(|(job, members)| {
            let center = job.landmark as u32;
            CellNeighborhood {
                center,
                members: std::iter::once(center)
                    .chain(members.unwrap_or_default())
                    .collect(),
            }
        })
        .collect();
    let distances = match charts {
        None => SparseDistances::within(rows.len(), &neighborhoods, |a, b| {
            let (p, q) = (rows[a as usize], rows[b as usize]);
            S::of(places.squared_distance(p, q).sqrt())
        })?,
        Some(charts) => {
            let mut pairs: Vec<(u32, u32)> = Vec::new();
            for near in &neighborhoods {
                for (i, &a) in near.members.iter().enumerate() {
                    pairs.extend(near.members[..i].iter().map(|&b| (a.min(b), a.max(b))));
                }
            }
            pairs.sort_unstable();
            pairs.dedup();
            let lengths = charts.lengths(analyzer, analysis, &rows, &pairs);
            let wrong = |d: &S| !(d.is_finite() && *d >= S::zero());
            if let Some(at) = lengths.iter().position(wrong) {
                let [p, q] = [pairs[at].0, pairs[at].1].map(|k| rows[k as usize]);
                audit::distance(charts.metric, p, q)?;
            }
            let entries = pairs.iter().zip(&lengths).map(|(&(a, b), &d)| (a, b, d));
            SparseDistances::new(rows.len(), entries)?
        }
    };
    let counts = StratifyCounts {
        landmarks: rows.len(),
        curve_landmarks: curves.rows.len(),
        corners: curves.corners,
        curve_edges: curves.edges.len(),
        cut_edges,
        mean_members: neighborhoods.iter().map(|x| x.members.len()).sum::<usize>() as f64
            / neighborhoods.len().max(1) as f64,
    };
    Ok(Stratification {
        waist: StratifiedLandmarks {
            strata,
            curve_edges: curves.edges.clone(),
            neighborhoods,
            distances,
        },
        points: curves.points(),
        rows,
        counts,
    })
}

/// Landmarks in order of their distance, ties by index, each once.
fn nearest_first(members: Vec<u32>, far: impl Fn(u32) -> f64) -> Vec<u32> {
    let mut ranked: Vec<(f64, u32)> = members.into_iter().map(|k| (far(k), k)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.dedup();
    ranked.into_iter().map(|x| x.1).collect()
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
    for e in curves.edges.iter().filter(|e| e.cells > 0) {
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

/// A flood, and what of the contacts it reached.
struct Hits {
    flood: Flood,
    counts: Vec<u32>,
    touched: Vec<u32>,
}

impl Hits {
    fn new(contacts: &Contacts) -> Self {
        Self {
            flood: Flood::default(),
            counts: vec![0; contacts.groups.len()],
            touched: Vec::new(),
        }
    }

    /// The landmarks that the flood reached and the curve landmarks at its rim, without `center`.
    fn members(
        &mut self,
        contacts: &Contacts,
        landmark_at: &[u32],
        center: usize,
        inside: impl Fn(usize) -> bool,
    ) -> Vec<u32> {
        let mut members = Vec::new();
        self.touched.clear();
        for &row in &self.flood.reached {
            let k = landmark_at[row as usize];
            if k != u32::MAX && k as usize != center {
                members.push(k);
            }
            for &g in contacts.of(row as usize) {
                if self.counts[g as usize] == 0 {
                    self.touched.push(g);
                }
                self.counts[g as usize] += 1;
            }
        }
        for &g in &self.touched {
            let group = &contacts.groups[g as usize];
            let enough = 2 * self.counts[g as usize] as usize >= group.rows.len();
            self.counts[g as usize] = 0;
            if enough && group.landmark != center && inside(group.landmark) {
                members.push(group.landmark as u32);
            }
        }
        members.sort_unstable();
        members.dedup();
        members
    }
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
            let mut touching: Vec<&[(u8, f64, u32)]> = cells.chunk_by(|a, b| a.0 == b.0).collect();
            if let Some(r) = reference.filter(|_| landmark >= curves.corners) {
                // A fit may know of cells that do not touch this curve: those are farther away.
                let own = r.label(row).and_then(|l| r.fit.cells_at(l));
                let count = own.unwrap_or(analysis.cells[row]);
                touching.sort_by(|a, b| a[0].1.total_cmp(&b[0].1).then(a[0].0.cmp(&b[0].0)));
                touching.truncate(count.into());
                touching.sort_by_key(|cell| cell[0].0);
            }
            for cell in touching {
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
