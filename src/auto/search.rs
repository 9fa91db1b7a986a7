//! The attempts, one after another.
//!
//! Each further attempt is another chance for a wrong mesh to pass. So a mesh that passes after others
//! have failed is not handed over at once: a second attempt with other landmarks has to pass too,
//! and agree. Two verified attempts that disagree are two readings of the points, and neither is handed over.

mod next;

use super::Auto;
use super::attempt::{Attempt, End, Topology};
use super::density::Density;
use super::evidence::Evidence;
use super::input::Input;
use super::needs::gap_needs;
use super::pinned::Pinned;
use super::prepared::{Made, Prepared};
use super::rounded::Rounded;
use super::symptoms::Symptom;
use crate::kept::Kept;
use crate::pipeline::{Outcome, Parameters, Pipeline};
use crosscap_algorithms::prepare::PreparationSummary;
use crosscap_algorithms::singularity::ModelName;
use crosscap_core::Error;
use std::fmt;
use std::time::{Duration, Instant};

/// What a search for parameters yields.
#[derive(Debug)]
#[non_exhaustive]
pub struct Search {
    /// How densely the points lie; none where all lengths were pinned.
    pub density: Option<Density>,
    /// What was done about outliers and noise; none where nothing had to be done.
    pub preparation: Option<PreparationSummary>,
    /// What was tried, in order.
    pub attempts: Vec<Attempt>,
    /// Which attempt counts: the verified one that is handed over, or else the one that came farthest.
    pub chosen: usize,
    /// What that attempt yielded. It may be verified and still not be handed over: see [`Search::doubt`].
    pub outcome: Result<Outcome, Error>,
    /// Why a verified outcome is not handed over.
    pub doubt: Option<Doubt>,
}

/// Why a verified mesh is not handed over.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Doubt {
    /// Two attempts passed with different topology.
    TwoReadings(Topology, Topology),
    /// One attempt passed after others had failed, and no other one confirmed it.
    Unconfirmed(Topology),
    /// Coordinates are so coarse that the mesh may be that of their rounding.
    Rounded(Rounded),
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TwoReadings(one, other) => {
                write!(f, "two attempts passed and disagree: {one}; {other}")
            }
            Self::Unconfirmed(topology) => write!(
                f,
                "one attempt passed after others had failed, {topology}, and no other confirmed it"
            ),
            Self::Rounded(rounded) => rounded.fmt(f),
        }
    }
}

impl Search {
    /// Whether there is a mesh that may be handed over as good.
    pub fn is_verified(&self) -> bool {
        self.doubt.is_none() && self.outcome.as_ref().is_ok_and(Outcome::is_verified)
    }
}

/// What is chosen from the points, before anything is tried.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Choice {
    /// How densely the points lie; none where all lengths were pinned.
    pub density: Option<Density>,
    /// The parameters of the first attempt.
    pub parameters: Parameters,
    /// Why these, in a few words.
    pub reason: String,
}

/// A search that is under way.
struct Progress<'a> {
    auto: &'a Auto,
    prepared: Prepared<'a>,
    density: Option<Density>,
    /// What is not the program's to choose.
    pinned: Pinned,
    attempts: Vec<Attempt>,
    /// What went wrong in each.
    symptoms: Vec<Option<Symptom>>,
    /// The separation below which each would have left the gaps of the points open, where it did not.
    needed: Vec<Option<f64>>,
    /// The gaps of the points that they found.
    evidence: Evidence,
    /// What they made of the points alone.
    kept: Kept,
    /// The attempt that came farthest.
    best: Option<(usize, Result<Outcome, Error>)>,
    /// What was done about outliers and noise in that attempt.
    preparation: Option<PreparationSummary>,
    began: Instant,
}

impl Auto {
    /// The parameters of the first attempt, without making it.
    ///
    /// ```
    /// use crosscap::auto::Input;
    /// use crosscap::prelude::*;
    /// let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(3000, 1))?;
    /// let chosen = Parameters::auto().choose(Input::Points(&sample.points))?.parameters;
    /// assert_eq!(chosen.dl, chosen.eps / 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Shape`] for too few different points.
    pub fn choose(&self, input: Input<'_>) -> Result<Choice, Error> {
        let pinned = self.pinned();
        let (density, [eps, dl], reason) = match pinned.complete() {
            Some(lengths) => (None, lengths, "as given".into()),
            None => {
                let density = input.density()?;
                let (lengths, reason) = pinned.lengths(&density);
                (Some(density), lengths, reason)
            }
        };
        Ok(Choice {
            density,
            parameters: pinned.parameters(eps, dl),
            reason,
        })
    }

    /// The same from points or distances, each attempt by a pipeline that `make` puts together for
    /// its parameters: with other parts than the usual ones, or with observers.
    ///
    /// # Errors
    /// As for [`Auto::reconstruct`], and those of `make`.
    pub fn search(
        &self,
        input: Input<'_>,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Search, Error> {
        let prepared = if self.pinned().is_prepared() {
            Prepared::of(input, &self.preparation, self.pinned().threads.unwrap_or(0))?
        } else {
            Prepared::unchanged(input)
        };
        // Who asks for it has the points moved, however little they scatter.
        let prepared = match self.pinned().prepare {
            None => prepared.given_at_first(),
            Some(_) => prepared,
        };
        let Choice {
            density,
            parameters: first,
            reason,
        } = self.choose(prepared.input())?;
        let mut progress = Progress {
            auto: self,
            prepared,
            density,
            pinned: self.pinned().clone(),
            attempts: Vec::new(),
            symptoms: Vec::new(),
            needed: Vec::new(),
            evidence: Evidence::default(),
            kept: Kept::default(),
            best: None,
            preparation: None,
            began: Instant::now(),
        };
        let symptom = match progress.attempt(first.clone(), reason.clone(), make) {
            Err(Error::Parameter {
                name: "surface", ..
            }) if self.pinned.surface.is_none() => progress.without_places(first, reason, make)?,
            ended => ended?,
        };
        // Nothing that is tried mends the coordinates.
        let doubt = match (Rounded::of(&input, &self.preparation.resolution), symptom) {
            (Some(rounded), _) => Some(Doubt::Rounded(rounded)),
            (None, Some(_)) => progress.further(make)?,
            (None, None) => None,
        };
        progress.end(doubt)
    }
}

impl Progress<'_> {
    /// The first attempt at distances that are those of no places: every point is one of a surface, and no metric is
    /// tried but the one that is given.
    fn without_places(
        &mut self,
        first: Parameters,
        reason: String,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Option<Symptom>, Error> {
        let spaces = first.spaces.clone();
        self.pinned.surface = Some(true);
        self.pinned.models.get_or_insert(vec![ModelName::TwoPlanes]);
        self.pinned.metric = Some(spaces.metric);
        self.pinned.tri_metric = Some(spaces.charts());
        self.pinned.neighborhoods = Some(spaces.neighborhoods);
        let first = Parameters {
            spaces,
            ..self.pinned.parameters(first.eps, first.dl)
        };
        let reason = format!(
            "{reason}; curves are not looked for, as these distances are those of no places"
        );
        self.attempt(first, reason, make)
    }

    /// One attempt; what went wrong, where it is not verified.
    fn attempt(
        &mut self,
        parameters: Parameters,
        reason: String,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Option<Symptom>, Error> {
        let since = Instant::now();
        // Every further attempt is another chance for a wrong mesh to pass.
        let times = self.attempts.len() + 1;
        let kept = &self.kept;
        let mut make =
            |parameters| make(parameters).map(|pipeline| pipeline.stricter(times).keeping(kept));
        let Made { outcome, summary } = self.prepared.run(&parameters, &mut make)?;
        // What was chosen later may not suit the input; that is no fault of the input.
        if let Err(error) = &outcome
            && (*error == Error::Interrupted || error.is_input() && self.attempts.is_empty())
        {
            return Err(error.clone());
        }
        let end = match &outcome {
            Ok(found) if found.is_verified() && self.evidence.speaks_against(&found.mesh) => {
                End::of(&outcome).denied()
            }
            _ => End::of(&outcome),
        };
        let symptom = match &end {
            End::Verified(_) => None,
            End::Denied(_) => Some(Symptom::Gaps),
            _ => Some(Symptom::of(&outcome)),
        };
        if let Ok(found) = &outcome {
            self.evidence.keep(found);
        }
        self.needed.push(gap_needs(symptom, &outcome));
        let nearer = |best: &(usize, _)| end.rank() > self.attempts[best.0].end.rank();
        if self.best.as_ref().is_none_or(nearer) {
            self.best = Some((self.attempts.len(), outcome));
            self.preparation = summary;
        }
        self.symptoms.push(symptom);
        self.attempts.push(Attempt {
            parameters,
            reason,
            end,
            seconds: since.elapsed().as_secs_f64(),
        });
        Ok(symptom)
    }

    /// Whether another attempt may begin: the last one is kept to confirm what has `passed`, as nothing is handed over
    /// without.
    fn may_go_on(&self, passed: bool) -> bool {
        let in_time = |limit: Duration| self.began.elapsed() < limit;
        let ends = self.auto.tries - usize::from(!passed);
        self.attempts.len() < ends && self.auto.time_limit.is_none_or(in_time)
    }

    /// The attempts after the first one failed, until two agree, further ones are in vain or the budget is spent.
    fn further(
        &mut self,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Option<Doubt>, Error> {
        let Some(density) = self.density.clone() else {
            return Ok(None);
        };
        let mut passed: Option<(Topology, Parameters)> = None;
        let mut confirmations = 0;
        while self.may_go_on(passed.is_some()) {
            confirmations += usize::from(passed.is_some());
            let next = match &passed {
                Some((_, parameters)) => self.confirming(parameters, confirmations, &density),
                None if self.prepared.move_from_now_on() => Some((
                    self.attempts[0].parameters.clone(),
                    "the points moved onto fits, as they scatter",
                )),
                None if self.is_hopeless() => None,
                None => self.next(&density),
            };
            let Some((next, reason)) = next else {
                break;
            };
            let parameters = next.clone();
            match self.attempt(next, reason.into(), make)? {
                // Something else, or where one has passed other landmarks again.
                Some(_) => {}
                None => {
                    let now = self.attempts.last().and_then(|a| a.end.topology().cloned());
                    match (passed.take(), now) {
                        (Some((before, _)), Some(now)) if before == now => return Ok(None),
                        (Some((before, _)), Some(now)) => {
                            return Ok(Some(Doubt::TwoReadings(before, now)));
                        }
                        (_, now) => passed = now.map(|topology| (topology, parameters)),
                    }
                }
            }
        }
        Ok(passed.map(|(topology, _)| Doubt::Unconfirmed(topology)))
    }

    fn end(self, doubt: Option<Doubt>) -> Result<Search, Error> {
        let nothing = || Error::Shape {
            found: "no attempt".into(),
            expected: "at least one".into(),
        };
        let (chosen, outcome) = self.best.ok_or_else(nothing)?;
        Ok(Search {
            preparation: self.preparation,
            density: self.density,
            attempts: self.attempts,
            chosen,
            outcome,
            doubt,
        })
    }
}
