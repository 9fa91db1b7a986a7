//! How much memory a reconstruction takes, foretold.
//!
//! Amounts bound what runs held at most (`/usr/bin/time -v`, one thread) from above. Measured on a torus and on two spheres that cross, in R^3 and
//! turned into R^24, 10^5 to 10^6 points, 600 to 31,000 landmarks; the table is in the guide, *Clouds in tiles*.

use crosscap::pipeline::Pipeline;
use crosscap::{MetricName, Pinned, Spaces};
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::moments::MomentTree;
use crosscap_algorithms::stratify::AnalysisTuning;
use crosscap_algorithms::tiles::{
    Answer, BallQuestion, LookQuestion, Question, Tiles, TilesInMemory, Tiling,
};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::tiles::bytes_to_divide;
use crosscap_core::{Error, LandmarkSelector, PointCloud};

/// The program, its threads, and what a run holds whatever the points are.
const ALWAYS: f64 = 40.0 * MIB;
/// Of every point: rows, ranks, states, the tree.
const POINT: f64 = 55.0;
/// Of every coordinate: the cloud, and its copy in the tree with what the leaves leave empty.
const COORDINATE: f64 = 24.0;
/// Of every point where double curves are looked for: moments, sites, labels.
const POINT_WITH_CURVES: f64 = 100.0;
/// Of every point where all models compete, or points are prepared, on top of that.
const POINT_WITH_ALL: f64 = 130.0;
/// Of every point in a graph of neighbors: thirty of them, either way.
const POINT_IN_GRAPH: f64 = 1050.0;
/// Of every point that the certificate looks at one by one: pairs of places between them, mostly, a list that doubles as it grows; 370 where
/// landmarks are near to each other.
const LOOKED_AT: f64 = 950.0;
/// Of every such point where it had to be fetched from its tile, on top of that, beside its coordinates.
const FETCHED: f64 = 60.0;
/// Of every coordinate of it.
const FETCHED_COORDINATE: f64 = 8.0;
/// So many are looked at, at most.
const MOST_LOOKED_AT: usize = 200_000;
/// Of every landmark: distances, stars, the mesh.
const LANDMARK: f64 = 600.0;
/// Of every coordinate of a landmark: the places of the mesh that are asked for their nearest point.
const LANDMARK_COORDINATE: f64 = 1500.0;
/// Of every point of a tile that is asked, beside its coordinates.
const TILE_POINT: f64 = 120.0;
/// Of every coordinate of a tile that is asked.
const TILE_COORDINATE: f64 = 40.0;
/// Of every point of the excerpt that curves are laid in, beside its coordinates.
const EXCERPT_POINT: f64 = 180.0;
/// Of every coordinate of it: the points, where they are moved to, and while they are gathered those that are not in order yet.
const EXCERPT_COORDINATE: f64 = 32.0;
/// A ball of a sample must hold so many points on average for its dimension to say something.
const SAMPLED_BALL: f64 = 40.0;
/// The same where models look for boundaries in it: in one of 1,000 balls of 40 points a gap that chance made passed for one.
const SAMPLED_LOOK: f64 = 80.0;
/// A crossing shows in balls about points up to so many radii from it, or farther.
const SHOWN_FROM: f64 = 0.6;
/// Models say of points up to so many radii from a boundary that it is near.
const SEEN_FROM: f64 = AnalysisTuning::MEASURED.witness_reach;

const MIB: f64 = (1 << 20) as f64;

/// A sample with this many points a landmark has as many landmarks as the cloud, within a few percent.
const POINTS_A_LANDMARK: usize = 10;

/// What the points of a run are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Everything is a surface.
    Surface,
    /// Double curves are looked for.
    Curves,
    /// All models compete, or lengths are chosen.
    Everything,
}

impl Work {
    /// What a run with these parameters asks for.
    pub fn of(pinned: &Pinned) -> Self {
        if pinned.complete().is_none() || pinned.prepare == Some(true) || pinned.models.is_some() {
            Self::Everything
        } else if pinned.surface == Some(true) {
            Self::Surface
        } else {
            Self::Curves
        }
    }
}

/// What the memory of a run depends on.
#[derive(Clone, Debug)]
pub struct Needs {
    points: usize,
    dimension: usize,
    landmarks: f64,
    graph: bool,
}

impl Needs {
    /// Those of so many points, of which this is a sample, with landmarks so far apart.
    pub fn of(
        sample: &PointCloud<f64>,
        points: usize,
        dl: f64,
        pinned: &Pinned,
    ) -> Result<Self, Error> {
        let usual = Spaces::default();
        let metric = pinned.metric.unwrap_or(usual.metric);
        let charts = pinned.tri_metric.unwrap_or(metric);
        Ok(Self {
            points,
            dimension: sample.dimension(),
            landmarks: landmarks(sample, points, dl)?,
            graph: [metric, charts]
                .iter()
                .any(|m| matches!(m, MetricName::Geodesic | MetricName::Conformal)),
        })
    }

    /// Bytes of a run that holds all points.
    pub fn in_memory(&self, work: Work) -> u64 {
        let more = match work {
            Work::Surface => 0.0,
            Work::Curves => POINT_WITH_CURVES,
            Work::Everything => POINT_WITH_CURVES + POINT_WITH_ALL,
        };
        let graph = if self.graph { POINT_IN_GRAPH } else { 0.0 };
        let point = POINT + COORDINATE * self.dimension as f64 + more + graph;
        (self.in_one_place() + self.points as f64 * point) as u64
    }

    /// About how many points the excerpt has that curves are laid in. Balls of a sample have to be larger, and show a crossing or a boundary from farther away.
    pub fn excerpt(&self, sample: &PointCloud<f64>, pipeline: &Pipeline) -> Result<usize, Error> {
        let Some(question) = pipeline.balls() else {
            return Ok(0);
        };
        let wider = match sample.len() < self.points {
            true => wider(sample, &question)?,
            false => 1.0,
        };
        let nearer = (wider - 1.0) * question.eps;
        let (reach, least) = (pipeline.excerpt_reach(), question.eps);
        let question = BallQuestion {
            eps: wider * question.eps,
            least: 0,
            looks: question.looks.map(|looks| {
                Box::new(LookQuestion {
                    dp: wider * looks.dp,
                    ep: wider * looks.ep,
                    ..*looks
                })
            }),
            ..question
        };
        let whole = Tiling::new(sample, 1);
        let tiles = TilesInMemory::new(sample, &whole, question.eps, 0, &Serial)?;
        let mut near = vec![false; sample.len()];
        for answer in tiles.ask(&Question::Balls(question))? {
            let Answer::Balls(own) = answer else { continue };
            let centers = own.centers.rows().iter().zip(&own.balls);
            for (curved, share) in [(true, SHOWN_FROM), (false, SEEN_FROM)] {
                let of_kind = centers.clone().filter(|(_, ball)| (ball[1] != 2) == curved);
                let rows: Vec<usize> = of_kind.map(|(row, _)| row.index()).collect();
                let tree = EuclideanOracle::new(sample.select(&rows))?;
                let reach = (reach - share * nearer).max(least);
                for (found, place) in near.iter_mut().zip(sample.iter()) {
                    *found |= tree.is_near(place, reach);
                }
            }
        }
        let count = near.iter().filter(|&&near| near).count();
        Ok((count as f64 / sample.len() as f64 * self.points as f64) as usize)
    }

    /// Bytes of a run in so many tiles, the largest of which has so many points, asked by so many threads, with an excerpt of so many points.
    pub fn in_tiles(&self, tiles: usize, largest: usize, threads: usize, excerpt: usize) -> u64 {
        let point = TILE_POINT + TILE_COORDINATE * self.dimension as f64;
        let fetched = FETCHED + FETCHED_COORDINATE * self.dimension as f64;
        let asked = self.in_one_place()
            + self.points.min(MOST_LOOKED_AT) as f64 * fetched
            + (largest * threads.min(tiles)) as f64 * point
            + excerpt as f64 * (EXCERPT_POINT + EXCERPT_COORDINATE * self.dimension as f64);
        let divided = ALWAYS as u64 + bytes_to_divide(self.points, tiles);
        divided.max(asked as u64)
    }

    /// About how many landmarks there are.
    pub fn landmarks(&self) -> usize {
        self.landmarks as usize
    }

    /// Bytes of landmarks, mesh and certificate.
    fn in_one_place(&self) -> f64 {
        let looked_at = self.points.min(MOST_LOOKED_AT) as f64;
        let landmark = LANDMARK + LANDMARK_COORDINATE * self.dimension as f64;
        ALWAYS + LOOKED_AT * looked_at + landmark * self.landmarks
    }
}

/// By how much balls of a sample have to be larger to say something, at least 1.
fn wider(sample: &PointCloud<f64>, question: &BallQuestion) -> Result<f64, Error> {
    let tree = MomentTree::new(sample)?;
    let balls = tree.settled_dimensions(question.eps, question.dt, &Serial)?;
    let total: f64 = balls.iter().map(|ball| f64::from(ball.neighbors)).sum();
    let wanted = match question.looks {
        Some(_) => SAMPLED_LOOK,
        None => SAMPLED_BALL,
    };
    let fuller = wanted * balls.len() as f64 / total;
    Ok(fuller.sqrt().max(1.0))
}

/// About how many landmarks a cloud has: as many as a sample, where that is dense beside them; else from landmarks farther
/// apart, of which a surface has as many less as the square of their separation says.
fn landmarks(sample: &PointCloud<f64>, points: usize, dl: f64) -> Result<f64, Error> {
    let oracle = EuclideanOracle::new(sample.clone())?;
    let all: Vec<usize> = (0..sample.len()).collect();
    let mut times = 1.0;
    loop {
        let found = RandomGreedy::new().select(&oracle, &all, &[], times * dl, 0)?;
        if sample.len() == points || found.len() * POINTS_A_LANDMARK <= sample.len() {
            return Ok((found.len() as f64 * times * times).min(points as f64));
        }
        times *= 2.0;
    }
}
