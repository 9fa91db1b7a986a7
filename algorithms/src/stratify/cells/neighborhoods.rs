//! The landmarks around each landmark, in each of its cells.

use super::contacts::{Contacts, Hits};
use super::found::{Found, Members};
use super::graph::CellGraph;
use super::labels::Labels;
use super::plain::{self, Surroundings};
use super::region::Region;
use super::{Node, Rim};
use crate::execute;
use crate::space::Space;
use crate::stratify::analysis::Analyzer;
use crate::stratify::atlas::Reference;
use crate::stratify::charts::ChartSpace;
use crate::stratify::curve_ends::Wards;
use crate::stratify::skeleton::Skeleton;
use crate::stratify::strata::Strata;
use crosscap_core::{
    Error, Landmark, Neighbor, NeighborhoodOracle, PointCloud, Row, Scalar, Table, squared_distance,
};

/// Floods that a job takes at a time.
const FLOODS_AT_ONCE: usize = 32;

/// All that neighborhoods are found from.
pub(in crate::stratify) struct Neighborhoods<'n, 'a, S: Scalar> {
    pub(in crate::stratify) analyzer: &'n Analyzer<'a, S>,
    pub(in crate::stratify) strata: &'n Strata,
    pub(in crate::stratify) skeleton: &'n Skeleton,
    pub(in crate::stratify) labels: &'n Labels,
    pub(in crate::stratify) contacts: &'n Contacts,
    /// What measures the charts.
    pub(in crate::stratify) charts: ChartSpace<'a, S>,
    /// Rows of the landmarks, those of the skeleton first.
    pub(in crate::stratify) rows: &'n Table<Landmark, Row>,
    /// Radius of the charts.
    pub(in crate::stratify) reach: f64,
    pub(in crate::stratify) dl: f64,
}

/// A neighborhood to be found: that of a landmark of a cell, or of one cell at a curve landmark.
struct Job {
    landmark: Landmark,
    group: Option<Rim>,
}

/// How far a graph reaches about every landmark.
type Reach = Table<Landmark, f64>;

/// What has been found so far.
struct Progress {
    jobs: Vec<Job>,
    members: Vec<Option<Members>>,
}

/// The extent of one chart: which nodes of the graph and which landmarks are in it, how far from its center.
enum Extent<'e, S: Scalar> {
    Places {
        places: &'e PointCloud<f64>,
        origin: &'e [f64],
        square: f64,
    },
    Metric(&'e Ball<S>),
}

/// What measures charts.
enum Measure<'m, 'a, S: Scalar> {
    Places(&'m PointCloud<f64>),
    Metric(&'m Space<'a, S>),
}

impl<S: Scalar> Extent<'_, S> {
    fn holds_node(&self, graph: &CellGraph, node: Node) -> bool {
        match self {
            // Places of nodes lie together in memory.
            Self::Places { origin, square, .. } => {
                squared_distance(origin, graph.place(node)) < *square
            }
            Self::Metric(ball) => ball.holds(graph.row(node)),
        }
    }

    fn holds(&self, row: Row) -> bool {
        match self {
            Self::Places { square, .. } => self.rank(row) < *square,
            Self::Metric(ball) => ball.holds(row),
        }
    }

    /// A number that orders rows by their distance from the center.
    fn rank(&self, row: Row) -> f64 {
        match self {
            Self::Places { places, origin, .. } => {
                squared_distance(origin, places.point(row.index()))
            }
            Self::Metric(ball) => ball.distance(row),
        }
    }
}

impl<S: Scalar> Neighborhoods<'_, '_, S> {
    /// The neighborhoods of the landmarks that are `wanted`.
    pub(in crate::stratify) fn find(
        &self,
        wanted: &dyn Fn(Landmark) -> bool,
    ) -> Result<Found, Error> {
        let mut jobs = self.jobs();
        jobs.retain(|job| wanted(job.landmark));
        let members = self.plain(&jobs)?;
        let mut progress = Progress { jobs, members };
        let mut found = Found::of(self.flood(&mut progress)?);
        for (job, members) in progress.jobs.iter().zip(progress.members) {
            found.take(job.landmark, members.unwrap_or_default());
        }
        Ok(found)
    }

    fn jobs(&self) -> Vec<Job> {
        let in_cells = self.rows.ids().skip(self.skeleton.rows().len());
        let own = in_cells.map(|landmark| Job {
            landmark,
            group: None,
        });
        let groups = self.contacts.groups.each();
        own.chain(groups.map(|(rim, group)| Job {
            landmark: group.landmark,
            group: Some(rim),
        }))
        .collect()
    }

    /// Neighborhoods of one sheet without a curve, where nearness alone says what belongs together.
    fn plain(&self, jobs: &[Job]) -> Result<Vec<Option<Members>>, Error> {
        if self.charts.space().is_some() {
            return Ok(jobs.iter().map(|_| None).collect());
        }
        let tuning = &self.analyzer.tuning.cells;
        let places = self.places()?;
        let width = places.dimension();
        let mut landmarks = Vec::with_capacity(self.rows.len() * width);
        for row in self.rows {
            landmarks.extend_from_slice(places.point(row.index()));
        }
        let mut on_curves = landmarks[..self.skeleton.rows().len() * width].to_vec();
        for fit in self.skeleton.labelling() {
            on_curves.extend_from_slice(places.point(fit.row.index()));
        }
        let gap = tuning.curve_gap * self.dl;
        let around = Surroundings::new(width, landmarks, &on_curves, gap, tuning.flat * self.dl);
        let find = |scratch: &mut plain::Scratch, j: usize| {
            if jobs[j].group.is_some() {
                return None;
            }
            let landmark = jobs[j].landmark;
            let mut radius = self.reach;
            let mut members = around.near(landmark, radius);
            for _ in 0..tuning.widenings {
                if members.len() >= tuning.least_members {
                    break;
                }
                radius *= tuning.widening;
                members = around.near(landmark, radius);
            }
            let center = self.rows[landmark].index();
            let far = |k: Landmark| places.squared_distance(center, self.rows[k].index());
            around
                .is_plain(landmark, radius, &members, scratch)
                .then(|| Members {
                    landmarks: nearest_first(members, far),
                    radius,
                })
        };
        Ok(execute::map(
            self.analyzer.execute,
            jobs.len(),
            Default::default,
            find,
        ))
    }

    /// Floods from every landmark that is left, in charts that are widened where they hold few members.
    /// Returns how many edges of the first graph were cut.
    fn flood(&self, progress: &mut Progress) -> Result<usize, Error> {
        let tuning = &self.analyzer.tuning.cells;
        let Progress { jobs, members } = progress;
        let mut landmark_at = Table::filled(self.strata.len(), None);
        for (k, &row) in self.rows.each() {
            landmark_at[row] = Some(k);
        }
        let mut pending: Vec<usize> = (0..jobs.len()).filter(|&j| members[j].is_none()).collect();
        let mut radius = self.reach;
        let mut cut = None;
        // The last graph, and how far it reaches about every landmark.
        let mut known: Option<(CellGraph, Reach)> = None;
        for widening in 0..=tuning.widenings {
            if pending.is_empty() {
                break;
            }
            let sufficient = known
                .take()
                .filter(|(_, reach)| pending.iter().all(|&j| reach[jobs[j].landmark] >= radius));
            let (graph, reach) = match sufficient {
                Some(known) => known,
                None => self.graph(jobs, &pending, radius)?,
            };
            cut.get_or_insert(graph.cut);
            let flooded = self.flooded(&graph, jobs, &pending, radius, &landmark_at)?;
            let mut thin = Vec::new();
            for (&j, found) in pending.iter().zip(flooded) {
                if found.len() >= tuning.least_members || widening == tuning.widenings {
                    members[j] = Some(Members {
                        landmarks: found,
                        radius,
                    });
                } else {
                    thin.push(j);
                }
            }
            pending = thin;
            radius *= tuning.widening;
            known = Some((graph, reach));
        }
        Ok(cut.unwrap_or(0))
    }

    /// A graph that holds the charts of the jobs that are pending, and how far it reaches about every landmark.
    fn graph(
        &self,
        jobs: &[Job],
        pending: &[usize],
        radius: f64,
    ) -> Result<(CellGraph, Reach), Error> {
        let Analyzer {
            space,
            execute,
            tuning,
            ..
        } = self.analyzer;
        let fits: Vec<&Reference> = self.skeleton.labelling().collect();
        let (region, reach) = match self.charts {
            // Nothing is known of how far a chart reaches in straight lines.
            ChartSpace::Metric(_) | ChartSpace::Along(..) => (
                Region::everything(self.strata.len(), self.dl),
                Table::filled(self.rows.len(), f64::INFINITY),
            ),
            ChartSpace::Places => {
                let mut reach: Reach = Table::filled(self.rows.len(), 0.0);
                for &j in pending {
                    // Where curves cut charts they are likely to be widened.
                    let spare = match jobs[j].group {
                        Some(_) => tuning.cells.widening,
                        None => 1.0,
                    };
                    reach[jobs[j].landmark] = spare * radius;
                }
                let all = self.rows.iter().copied().zip(reach.iter().copied());
                let centers: Vec<(Row, f64)> = all.filter(|x| x.1 > 0.0).collect();
                let cloud = space.coordinates("since charts are laid in them")?;
                let places = self.places()?;
                let region = Region::about(cloud, places, &centers, self.dl, *execute);
                (region, reach)
            }
        };
        let separated = |i: Row, j: Row| self.labels.separated(&fits, i, j);
        let graph = CellGraph::new(space, self.strata, separated, &region, *execute)?;
        Ok((graph, reach))
    }

    fn flooded(
        &self,
        graph: &CellGraph,
        jobs: &[Job],
        pending: &[usize],
        radius: f64,
        landmark_at: &Table<Row, Option<Landmark>>,
    ) -> Result<Vec<Vec<Landmark>>, Error> {
        let measure = self.measure()?;
        let wards = Wards::new(self.strata, self.dl);
        let held = match measure {
            Measure::Places(_) => 0,
            Measure::Metric(_) => self.strata.len(),
        };
        Ok(execute::map_blocks(
            self.analyzer.execute,
            FLOODS_AT_ONCE,
            pending.len(),
            || (Hits::new(self.contacts), Ball::new(held)),
            |(hits, ball), p| {
                let job = &jobs[pending[p]];
                let center = self.rows[job.landmark];
                let own = [center];
                let from = job
                    .group
                    .map_or(&own[..], |g| &self.contacts.groups[g].rows);
                let extent = match measure {
                    Measure::Places(places) => Extent::Places {
                        places,
                        origin: places.point(center.index()),
                        square: radius * radius,
                    },
                    Measure::Metric(space) => {
                        ball.fill(space.oracle(), center, radius);
                        Extent::Metric(ball)
                    }
                };
                let ward = wards.of(center, from[0]);
                hits.flood.run(graph, from, |node| {
                    wards.admits(ward, graph.row(node)) && extent.holds_node(graph, node)
                });
                let inside = |k: Landmark| extent.holds(self.rows[k]);
                let found = hits.members(self.contacts, landmark_at, job.landmark, inside);
                nearest_first(found, |k| extent.rank(self.rows[k]))
            },
        ))
    }

    fn measure(&self) -> Result<Measure<'_, '_, S>, Error> {
        Ok(match &self.charts {
            ChartSpace::Places => Measure::Places(self.places()?),
            ChartSpace::Metric(space) | ChartSpace::Along(space, _) => Measure::Metric(space),
        })
    }

    fn places(&self) -> Result<&PointCloud<f64>, Error> {
        self.strata.places().ok_or_else(|| Error::Shape {
            found: "points without coordinates".into(),
            expected: "coordinates, or a metric for the charts".into(),
        })
    }
}

/// The points of a ball with their distances from its center, reusable.
struct Ball<S> {
    found: Vec<Neighbor<S>>,
    stamps: Table<Row, u32>,
    distances: Table<Row, f64>,
    round: u32,
}

impl<S: Scalar> Ball<S> {
    fn new(n: usize) -> Self {
        Self {
            found: Vec::new(),
            stamps: Table::filled(n, 0),
            distances: Table::filled(n, 0.0),
            round: 0,
        }
    }

    fn fill(&mut self, oracle: &dyn NeighborhoodOracle<Scalar = S>, center: Row, radius: f64) {
        self.round += 1;
        oracle.within(center.index(), S::of(radius), &mut self.found);
        for x in &self.found {
            self.stamps[x.row()] = self.round;
            self.distances[x.row()] = x.distance.as_f64();
        }
    }

    fn holds(&self, row: Row) -> bool {
        self.stamps[row] == self.round
    }

    /// Distance of a point that the ball holds.
    fn distance(&self, row: Row) -> f64 {
        self.distances[row]
    }
}

/// Landmarks in order of their distance, ties by index, each once.
fn nearest_first(members: Vec<Landmark>, far: impl Fn(Landmark) -> f64) -> Vec<Landmark> {
    let mut ranked: Vec<(f64, Landmark)> = members.into_iter().map(|k| (far(k), k)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.dedup();
    ranked.into_iter().map(|x| x.1).collect()
}
