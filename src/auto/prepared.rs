//! The points as they are worked on: without outliers, and where they scatter moved onto fits of their
//! neighborhoods.

use super::alone::{self, ROUNDS};
use super::input::Input;
use super::worked_on::WorkedOn;
use crate::pipeline::{Outcome, Parameters, Pipeline};
use crosscap_algorithms::prepare::PreparationSummary;
use crosscap_algorithms::tuning::PreparationTuning;
use crosscap_backends::parallel::Threads;
use crosscap_core::Error;

/// Scatter across the surface, in spacings, below which the points are first taken as they are: moving them rounds a little of what
/// is about a crossing, a wall or a rim. Of six clouds of sheets that meet, scattered by 0.1 to 0.15, four passed as they were and three
/// moved, and each of them in one way or the other; scattered by 0.28 two spheres passed only moved.
const SLIGHT: f64 = 0.2;

/// The input of all attempts.
pub(super) struct Prepared<'a> {
    /// What was given.
    given: Input<'a>,
    /// The points that are worked on instead, where something was done about them.
    better: Option<WorkedOn>,
    /// Whether the points are still taken as they were given, though there are better ones.
    as_given: bool,
    /// Where points may be left out: what decides about them.
    tuning: Option<PreparationTuning>,
}

impl<'a> Prepared<'a> {
    /// The input as it is.
    pub(super) fn unchanged(given: Input<'a>) -> Self {
        Self {
            given,
            better: None,
            as_given: false,
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
        let better = WorkedOn::of(cloud, tuning, &Threads::new(threads)?)?;
        Ok(Self {
            given,
            better: better.filter(WorkedOn::is_changed),
            as_given: false,
            tuning: Some(tuning.clone()),
        })
    }

    /// The same, where they scatter so little that they may be right as they are taken as they were given, until they are
    /// [moved](Self::move_from_now_on).
    pub(super) fn given_at_first(self) -> Self {
        Self {
            as_given: (self.better.as_ref()).is_some_and(|better| better.scatters_below(SLIGHT)),
            ..self
        }
    }

    /// From now on points that scatter are moved; `false` where nothing changes by that.
    pub(super) fn move_from_now_on(&mut self) -> bool {
        std::mem::take(&mut self.as_given)
    }

    /// The points that are worked on.
    pub(super) fn input(&self) -> Input<'_> {
        match &self.better {
            Some(better) => Input::Points(&better.cloud),
            None => self.given,
        }
    }

    /// Standard deviation of the points across the surface, unit of the data, where it is so large that they were moved.
    pub(super) fn noise(&self) -> Option<f64> {
        let summary = self.better.as_ref()?.summary.as_ref()?;
        summary.moved.and(summary.noise)
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
        let mut better = self.better.clone().filter(|_| !self.as_given);
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
                let kept = better.as_ref().map(WorkedOn::rows);
                let alone = match found.failures.is_empty() {
                    true => alone::rows(
                        &found.certificate,
                        &found.mesh,
                        given,
                        kept,
                        &found.report.tuning.refinement,
                    ),
                    false => Vec::new(),
                };
                if !alone.is_empty() {
                    let before = match better {
                        Some(better) => better,
                        None => WorkedOn::unchanged(given, tuning)?,
                    };
                    better = Some(before.without(&alone));
                    rounds += 1;
                    continue;
                }
            }
            let summary = better.and_then(|better| better.summary);
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
