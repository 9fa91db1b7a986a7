//! The points as they are worked on: without outliers, and where they scatter moved onto fits of their
//! neighborhoods.

use super::input::Input;
use crate::pipeline::{Outcome, Parameters, Pipeline, distinct_rows};
use crosscap_algorithms::certificate::{CertificateOptions, CoverReport, Place, certify};
use crosscap_algorithms::prepare::{Preparation, PreparationSummary, Remedies};
use crosscap_algorithms::tuning::PreparationTuning;
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, PointCloud};

/// The input of all attempts.
pub(super) struct Prepared<'a> {
    /// What was given.
    given: Input<'a>,
    /// The points that are worked on instead, where something was done about them.
    better: Option<Better>,
}

struct Better {
    cloud: PointCloud<f64>,
    /// Row of the input of every point.
    rows: Vec<usize>,
    /// The same points where they were given.
    unmoved: PointCloud<f64>,
    /// Standard deviation of the points across the surface, unit of the data; 0 where they stayed.
    noise: f64,
    summary: PreparationSummary,
}

impl<'a> Prepared<'a> {
    /// The input as it is.
    pub(super) fn unchanged(given: Input<'a>) -> Self {
        Self {
            given,
            better: None,
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
        if !found.left_out && found.projection.is_none() {
            return Ok(Self::unchanged(given));
        }
        let better = Better {
            cloud: found.points(&distinct),
            unmoved: distinct.select(&found.kept),
            rows: found.kept.iter().map(|&k| kept[k]).collect(),
            noise: match (&found.projection, &found.noise) {
                (Some(_), Some(noise)) => noise.deviation,
                _ => 0.0,
            },
            summary: found.summary(),
        };
        Ok(Self {
            given,
            better: Some(better),
        })
    }

    /// What was done, where something was.
    pub(super) fn summary(&self) -> Option<&PreparationSummary> {
        self.better.as_ref().map(|better| &better.summary)
    }

    /// The points that are worked on.
    pub(super) fn input(&self) -> Input<'_> {
        match &self.better {
            Some(better) => Input::Points(&better.cloud),
            None => self.given,
        }
    }

    /// One reconstruction by the pipeline that `make` puts together; rows are those of the input.
    pub(super) fn run(
        &self,
        parameters: &Parameters,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Result<Outcome, Error>, Error> {
        let Some(better) = &self.better else {
            return Ok(self.given.run(&mut make(parameters.clone())?));
        };
        let mut own = parameters.clone();
        let position = |row: &usize| better.rows.binary_search(row).ok();
        own.boundary = parameters.boundary.iter().filter_map(position).collect();
        let outcome = make(own)?.reconstruct(&better.cloud);
        Ok(match outcome {
            Ok(outcome) => Ok(better.in_input(outcome, parameters)),
            Err(error) => Err(better.named(error)),
        })
    }
}

impl Better {
    /// The outcome with rows of the input, its mesh measured against the points where they were given.
    fn in_input(&self, mut outcome: Outcome, parameters: &Parameters) -> Outcome {
        if self.noise > 0.0 {
            let options = CertificateOptions {
                points: Some(&self.unmoved),
                landmark_separation: Some(parameters.dl),
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
