//! The points as they are worked on: without outliers, and where they scatter moved onto fits of their
//! neighborhoods.

use super::alone;
use super::input::Input;
use crate::pipeline::{Outcome, Parameters, Pipeline, distinct_rows};
use crosscap_algorithms::certificate::{CertificateOptions, CoverReport, Place, certify};
use crosscap_algorithms::creases::Creases;
use crosscap_algorithms::prepare::{Preparation, PreparationSummary, Remedies, Subspace};
use crosscap_algorithms::tuning::PreparationTuning;
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, PointCloud};

/// Rounds of leaving out points that a mesh shows to be alone.
const ROUNDS: usize = 2;

/// The input of all attempts.
pub(super) struct Prepared<'a> {
    /// What was given.
    given: Input<'a>,
    /// The points that are worked on instead, where something was done about them.
    better: Option<Better>,
    /// Where points may be left out: what decides about them.
    tuning: Option<PreparationTuning>,
}

#[derive(Clone)]
struct Better {
    cloud: PointCloud<f64>,
    /// Row of the input of every point.
    rows: Vec<usize>,
    /// What `cloud` has coordinates of, where that is not the space of the input.
    subspace: Option<Subspace>,
    /// The same points where they were given.
    unmoved: PointCloud<f64>,
    /// How far the points scatter across the surface, root mean square, unit of the data; 0 where they stayed.
    noise: f64,
    summary: PreparationSummary,
}

impl<'a> Prepared<'a> {
    /// The input as it is.
    pub(super) fn unchanged(given: Input<'a>) -> Self {
        Self {
            given,
            better: None,
            tuning: None,
        }
    }

    /// Whatever the points need. Distances alone stay as they are.
    pub(super) fn of(
        given: Input<'a>,
        tuning: &PreparationTuning,
        threads: usize,
    ) -> Result<Self, Error> {
        let Input::Points(cloud) = given else {
            return Ok(Self::unchanged(given));
        };
        let kept = distinct_rows(cloud);
        let distinct = cloud.select(&kept);
        let threads = Threads::new(threads)?;
        // Clouds of a dozen points are left alone.
        let Ok(found) = Preparation::of(&distinct, Remedies::ALL, tuning, &threads) else {
            return Ok(Self::unchanged(given));
        };
        let better = found.changes().then(|| Better {
            cloud: found.points(&distinct),
            unmoved: distinct.select(&found.kept),
            rows: found.kept.iter().map(|&k| kept[k]).collect(),
            noise: found.scatter(),
            subspace: found.subspace.clone(),
            summary: found.summary().named(|row| kept[row]),
        });
        Ok(Self {
            given,
            better,
            tuning: Some(tuning.clone()),
        })
    }

    /// The points that are worked on.
    pub(super) fn input(&self) -> Input<'_> {
        match &self.better {
            Some(better) => Input::Points(&better.cloud),
            None => self.given,
        }
    }

    /// One reconstruction by the pipeline that `make` puts together; rows are those of the input.
    ///
    /// Where all that is wrong with the mesh is a few points [alone](alone::rows) far from it, they are outliers that nothing told before
    /// there was a mesh, in line with a plate beyond its rim, say. They are left out and the same is made again.
    pub(super) fn run(
        &self,
        parameters: &Parameters,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Made, Error> {
        let mut better = self.better.clone();
        let mut rounds = 0;
        loop {
            let outcome = match &better {
                None => self.given.run(&mut make(parameters.clone())?),
                Some(better) => better.run(parameters, make)?,
            };
            if let (Ok(found), Input::Points(given), Some(tuning)) =
                (&outcome, self.given, &self.tuning)
                && rounds < ROUNDS
            {
                let kept = better.as_ref().map(|better| &better.rows[..]);
                let alone = alone::rows(found, given, kept);
                if !alone.is_empty() {
                    let before = match better {
                        Some(better) => better,
                        None => Better::unchanged(given, tuning)?,
                    };
                    better = Some(before.without(&alone));
                    rounds += 1;
                    continue;
                }
            }
            let summary = better.map(|better| better.summary);
            return Ok(Made { outcome, summary });
        }
    }
}

/// What an attempt yielded.
pub(super) struct Made {
    pub(super) outcome: Result<Outcome, Error>,
    /// What was done about outliers and noise, where something was.
    pub(super) summary: Option<PreparationSummary>,
}

impl Better {
    /// The different points as they are.
    fn unchanged(given: &PointCloud<f64>, tuning: &PreparationTuning) -> Result<Self, Error> {
        let rows = distinct_rows(given);
        let cloud = given.select(&rows);
        let found = Preparation::of(&cloud, Remedies::NONE, tuning, &Threads::new(1)?)?;
        Ok(Self {
            unmoved: cloud.clone(),
            cloud,
            rows,
            subspace: None,
            noise: 0.0,
            summary: found.summary(),
        })
    }

    /// The same without some rows of the input.
    fn without(self, rows: &[usize]) -> Self {
        let stays = |row: usize| !rows.contains(&row);
        let kept: Vec<usize> = (0..self.rows.len())
            .filter(|&at| stays(self.rows[at]))
            .collect();
        Self {
            cloud: self.cloud.select(&kept),
            unmoved: self.unmoved.select(&kept),
            rows: kept.iter().map(|&at| self.rows[at]).collect(),
            subspace: self.subspace,
            noise: self.noise,
            summary: self.summary.without(rows),
        }
    }

    /// One reconstruction; rows are those of the input.
    fn run(
        &self,
        parameters: &Parameters,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Result<Outcome, Error>, Error> {
        let mut own = parameters.clone();
        let position = |row: &usize| self.rows.binary_search(row).ok();
        own.boundary = parameters.boundary.iter().filter_map(position).collect();
        Ok(match make(own)?.reconstruct(&self.cloud) {
            Ok(outcome) => Ok(self.in_input(outcome, parameters)),
            Err(error) => Err(self.named(error)),
        })
    }

    /// The outcome with rows of the input, its mesh measured against the points where they were given.
    fn in_input(&self, mut outcome: Outcome, parameters: &Parameters) -> Outcome {
        if let Some(subspace) = &self.subspace {
            lift(subspace, &mut outcome);
        }
        if self.noise > 0.0 {
            // Where it cannot be told, the separation is the same everywhere, which is stricter where points are sparse.
            let scale = parameters.spaces.metric.separation_scale(&self.cloud);
            let scale = scale.ok().flatten();
            let options = CertificateOptions {
                points: Some(&self.unmoved),
                landmark_separation: Some(parameters.dl),
                separation_scale: scale.as_deref(),
                noise: self.noise,
                ..CertificateOptions::default()
            };
            let cover = certify(&outcome.mesh, &options).cover;
            // What is wrong with the moved points stays wrong.
            let sound = |report: &CoverReport| report.violations.is_empty();
            if outcome.certificate.cover.as_ref().is_some_and(sound) {
                outcome.certificate.cover = cover;
            }
        }
        for index in &mut outcome.mesh.point_index {
            if let Some(&row) = usize::try_from(*index).ok().and_then(|k| self.rows.get(k)) {
                *index = row as i64;
            }
        }
        let cover = outcome.certificate.cover.iter_mut();
        let found = cover.flat_map(|report| &mut report.violations);
        for place in found.flat_map(|violation| &mut violation.places) {
            if let Place::Point(row) = place {
                *row = self.row(*row);
            }
        }
        let failures = std::mem::take(&mut outcome.failures);
        outcome.failures = failures.into_iter().map(|e| self.named(e)).collect();
        outcome.report.parameters = parameters.clone();
        outcome
    }

    fn row(&self, position: usize) -> usize {
        self.rows.get(position).copied().unwrap_or(position)
    }

    /// The error with the row of the input.
    fn named(&self, mut error: Error) -> Error {
        match &mut error {
            Error::SparseNeighborhood { point, .. }
            | Error::Dimension { point, .. }
            | Error::Law { point, .. }
            | Error::Triangulation {
                point: Some(point), ..
            } => *point = self.row(*point),
            _ => {}
        }
        error
    }
}

/// Mesh and certificate with the places in R^N of those in a subspace.
fn lift(subspace: &Subspace, outcome: &mut Outcome) {
    let places = outcome.mesh.vertices.iter();
    let numbers: Vec<f64> = places.flat_map(|place| subspace.lift(place)).collect();
    let count = outcome.mesh.vertices.len();
    if let Ok(vertices) = PointCloud::new(numbers.len() / count.max(1), numbers) {
        outcome.report.dimension = vertices.dimension();
        outcome.mesh.vertices = vertices;
    }
    let creases = outcome.creases.iter_mut().flat_map(Creases::places_mut);
    for place in outcome.certificate.places_mut().chain(creases) {
        *place = subspace.lift(place);
    }
}
