//! The part of a cloud that its curves depend on, in one place.
//!
//! Curves are found from the balls that are not 2-dimensional or show more than a sheet, and no step of their analysis looks farther than a few radii
//! from one of them. So the points that are as near as that to such a ball are an excerpt on which the analysis says what it says
//! of the whole cloud, to the last bit: rows keep their order, distances are those of the same coordinates, and what is a number of the whole cloud is
//! given ([`KnownBalls`]). Whether the excerpt was wide enough is not assumed: every question is compared with how far all points about its
//! center are known, and whoever asked starts again with a wider excerpt.

use super::gathered::Gathered;
use super::question::{Answer, BallQuestion, Question, Tiles};
use super::row::CloudRow;
use crate::balls::BallTree;
use crate::stratify::{KnownBalls, ModelCounts, Seen};
use crosscap_core::{BallDimension, Error, Neighbor, NeighborhoodOracle, PointCloud, Row, Table};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Rounding of lengths that are compared with the reach of an excerpt.
const ROUNDING: f64 = 1e-9;
/// How much wider than what was missing an excerpt is made.
const SPARE: f64 = 1.05;

/// The balls of a cloud that are not 2-dimensional, or show more than a sheet.
#[derive(Clone, Debug)]
pub struct Candidates {
    /// Their centers, in the order of their rows.
    pub centers: Gathered,
    /// How many points they hold, their dimensions, and what models see in those that are 2-dimensional.
    balls: Vec<(BallDimension, Option<Seen>)>,
    /// What became of the models.
    models: Vec<ModelCounts>,
    /// Number of points of the cloud.
    of: usize,
    /// Mean number of points of a ball.
    mean_neighbors: f64,
}

impl Candidates {
    /// Asks tiles for the balls of their points.
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] for the first ball with too few points; those of [`Tiles::ask`].
    pub fn of(tiles: &dyn Tiles, question: BallQuestion) -> Result<Self, Error> {
        let needed = question.least;
        let mut centers = Gathered::new(tiles.dimension());
        let mut balls: Vec<(CloudRow, (BallDimension, Option<Seen>))> = Vec::new();
        let mut models: Vec<ModelCounts> = Vec::new();
        let (mut neighbors, mut sparse) = (0, None::<(CloudRow, u32)>);
        for answer in tiles.ask(&Question::Balls(question))? {
            let Answer::Balls(own) = answer else { continue };
            let told = own.balls.iter().zip(own.seen).map(|(ball, seen)| {
                let &[neighbors, dimension] = ball;
                let ball = BallDimension {
                    neighbors,
                    dimension,
                };
                (ball, seen)
            });
            balls.extend(own.centers.rows().iter().copied().zip(told));
            models = match models.is_empty() {
                true => own.models,
                false => ModelCounts::with_later(&models, &own.models),
            };
            centers.extend(&own.centers);
            neighbors += own.neighbors;
            sparse = sparse.into_iter().chain(own.sparse).min_by_key(|x| x.0);
        }
        if let Some((row, found)) = sparse {
            return Err(Error::SparseNeighborhood {
                point: tiles.input_row(row),
                found: found as usize,
                needed,
                parameter: "eps",
            });
        }
        balls.sort_unstable_by_key(|x| x.0);
        Ok(Self {
            centers: centers.sorted(),
            balls: balls.into_iter().map(|x| x.1).collect(),
            models,
            of: tiles.points(),
            mean_neighbors: neighbors as f64 / tiles.points().max(1) as f64,
        })
    }
}

/// All points of a cloud as near as a reach to a ball in which there is more than a sheet, in the order of the cloud.
pub struct Excerpt {
    rows: Vec<CloudRow>,
    /// Shared with whoever finds neighborhoods in it: the coordinates are there once.
    cloud: Arc<PointCloud<f64>>,
    balls: KnownBalls,
    reach: f64,
    /// Up to which distance all points about each are in the excerpt.
    known: Table<Row, f64>,
    /// By how much that was too little, as the bits of a number that is not negative; they are in its order.
    short: AtomicU64,
}

impl Excerpt {
    /// Gathers the points as near as `reach` to one of the candidates.
    ///
    /// # Errors
    /// Those of [`Tiles::ask`].
    pub fn gather(tiles: &dyn Tiles, candidates: &Candidates, reach: f64) -> Result<Self, Error> {
        let places = candidates.centers.coordinates();
        let points = match places {
            [] => Gathered::new(tiles.dimension()),
            _ => tiles.gather(&Question::Around {
                places: places.to_vec(),
                radius: reach,
            })?,
        };
        let (rows, cloud) = points.into_cloud()?;
        let mut balls = vec![
            BallDimension {
                neighbors: 0,
                dimension: 2
            };
            rows.len()
        ];
        let mut seen = vec![None; rows.len()];
        for (&row, (ball, shown)) in candidates.centers.rows().iter().zip(&candidates.balls) {
            let at = (rows.binary_search(&row)).map_err(|_| super::gathered::lost(row))?;
            (balls[at], seen[at]) = (*ball, shown.clone());
        }
        let whole = rows.len() == tiles.points();
        let tree = BallTree::new(cloud.dimension(), places);
        let known = cloud.iter().map(|place| {
            let far = tree.nearest(place, |_| true).map_or(0.0, |x| x.1.sqrt());
            if whole {
                f64::INFINITY
            } else {
                reach * (1.0 - ROUNDING) - far
            }
        });
        Ok(Self {
            known: known.collect(),
            cloud: Arc::new(cloud),
            balls: KnownBalls {
                balls,
                seen,
                models: candidates.models.clone(),
                of: candidates.of,
                mean_neighbors: candidates.mean_neighbors,
            },
            rows,
            reach,
            short: AtomicU64::new(0),
        })
    }

    /// Rows of the whole cloud, in order.
    pub fn rows(&self) -> &[CloudRow] {
        &self.rows
    }

    /// The points.
    pub fn cloud(&self) -> &Arc<PointCloud<f64>> {
        &self.cloud
    }

    /// The balls about the points, as the whole cloud shows them.
    pub fn balls(&self) -> &KnownBalls {
        &self.balls
    }

    /// The reach of an excerpt that would have known all that was asked of this one; `None` where it did.
    pub fn wider(&self) -> Option<f64> {
        let short = f64::from_bits(self.short.load(Ordering::Relaxed));
        (short > 0.0).then_some((self.reach + short) * SPARE)
    }

    /// Row of the whole cloud.
    pub(super) fn in_cloud(&self, row: Row) -> CloudRow {
        self.rows[row.index()]
    }

    /// The row of the excerpt that is a row of the cloud. O(log n).
    pub fn find(&self, row: CloudRow) -> Option<Row> {
        self.rows.binary_search(&row).ok().map(Row::new)
    }

    /// Notes that all points as near as `radius` to one of the excerpt matter.
    pub(super) fn needs(&self, row: Row, radius: f64) {
        self.lacks(radius - self.known[row]);
    }

    /// Notes by how much the reach is too little; nothing where it is not positive.
    pub(super) fn lacks(&self, short: f64) {
        if short > 0.0 {
            self.short.fetch_max(short.to_bits(), Ordering::Relaxed);
        }
    }

    /// The neighborhoods that `oracle` finds in the excerpt, with an eye on what it cannot know.
    pub fn watched<'e>(
        &'e self,
        oracle: &'e dyn NeighborhoodOracle<Scalar = f64>,
    ) -> WatchedOracle<'e> {
        WatchedOracle {
            excerpt: self,
            oracle,
        }
    }
}

/// Neighborhoods in an excerpt, which notes where it is too narrow.
pub struct WatchedOracle<'e> {
    excerpt: &'e Excerpt,
    oracle: &'e dyn NeighborhoodOracle<Scalar = f64>,
}

impl NeighborhoodOracle for WatchedOracle<'_> {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.oracle.len()
    }

    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        self.excerpt.needs(Row::new(center), radius);
        self.oracle.within(center, radius, out);
    }

    fn indices_within(&self, center: usize, radius: f64, out: &mut Vec<u32>) {
        self.excerpt.needs(Row::new(center), radius);
        self.oracle.indices_within(center, radius, out);
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        self.oracle.nearest(center, count, out);
        let farthest = match out.last() {
            Some(last) if out.len() == count => last.distance,
            // Fewer than there are in all, unless all are here.
            _ => self.excerpt.reach,
        };
        self.excerpt.needs(Row::new(center), farthest);
    }

    fn name(&self) -> &str {
        self.oracle.name()
    }
}
