//! What to try next.

use super::Progress;
use crate::auto::attempt::Attempt;
use crate::auto::density::Density;
use crate::auto::moves::{Known, Move, other_landmarks};
use crate::auto::needs::RESOLVING;
use crate::auto::symptoms::Symptom;
use crate::pipeline::Parameters;
use std::cmp::Reverse;

/// Other landmarks in a row, where little is wrong: of 30 attempts with others again none passed.
const AGAIN: usize = 1;
/// Attempts to confirm with landmarks as far apart, where they fail.
const CONFIRMING: usize = 2;
/// Separations that differ by less than this share give other landmarks and hardly another mesh.
const ALIKE: f64 = 0.08;

/// Share of what was wrong that a move leaves at most where it is worth making again. Of the rabbit's scan (seed 0) smaller neighborhoods left
/// 110, 89 and 98 of 108 open stars, distances along the surface 17.
const WORTH: f64 = 0.8;

/// Attempts in a row that come no farther than an earlier one, after which the search ends where much is wrong.
const IN_VAIN: usize = 3;

impl Progress<'_> {
    /// Other landmarks for the attempt that came farthest, where it nearly passed; no chance of the landmarks opens a gap that they
    /// are too far apart for, and then it is the last attempt, which had them nearer.
    fn nearly(&self) -> Option<Parameters> {
        let farthest = self.best.as_ref()?.0;
        let last = self.attempts.len() - 1;
        // Nor does it close a star near an end, which a smaller neighborhood sees better.
        if self.symptoms[farthest] == Some(Symptom::Frayed) {
            return None;
        }
        let asked = [farthest, last]
            .into_iter()
            .find(|&index| self.needed[index].is_none());
        self.others_than(asked?)
    }

    /// Other landmarks for an attempt that nearly passed, where they were not tried so often yet.
    fn others_than(&self, attempt: usize) -> Option<Parameters> {
        let near = (self.attempts.get(attempt)).filter(|attempt| attempt.end.is_near_miss())?;
        let of = &near.parameters;
        let alike = |other: &Attempt| {
            let other = &other.parameters;
            let near = (other.dl / of.dl - 1.0).abs() < ALIKE;
            near && other.spaces == of.spaces
                && other.models == of.models
                && other.surface == of.surface
        };
        // Equal parameters are the same landmarks, first of points as they were given and then of points that were moved.
        let again = |k: &usize| {
            let own = &self.attempts[*k].parameters;
            self.attempts[..*k].iter().any(|a| a.parameters == *own)
        };
        let all = (0..self.attempts.len()).filter(|k| !again(k));
        let times = all.filter(|&k| alike(&self.attempts[k])).count();
        // The first time there is nothing alike but the attempt itself.
        if times > AGAIN {
            return None;
        }
        let fresh = |next: &Parameters| self.attempts.iter().all(|a| a.parameters != *next);
        (times..=times + 1).find_map(|time| other_landmarks(of, &self.pinned, time).filter(fresh))
    }

    /// What moves go by, where gaps of the points need landmarks as near as this.
    fn known<'k>(&self, density: &'k Density, needed: Option<f64>) -> Known<'k> {
        Known {
            density,
            needed,
            noise: self.prepared.noise(),
        }
    }

    /// What to try next and why: other landmarks where little is wrong, and otherwise a change of the attempt that came
    /// farthest, or of the first, that was not tried yet.
    pub(super) fn next(&self, density: &Density) -> Option<(Parameters, &'static str)> {
        let pinned = &self.pinned;
        if let Some(next) = self.nearly() {
            return Some((next, "other landmarks, as little is wrong"));
        }
        let farthest = self.best.as_ref().map_or(0, |best| best.0);
        let fresh = |next: &Parameters| self.attempts.iter().all(|a| a.parameters != *next);
        [farthest, 0].into_iter().find_map(|index| {
            let from = &self.attempts[index].parameters;
            let known = self.known(density, self.needed[index]);
            let moves = self.symptoms[index].map_or(&[][..], Symptom::moves);
            let (last, first): (Vec<Move>, Vec<Move>) =
                (moves.iter()).partition(|&&step| self.gained_little(step, index, density));
            first.into_iter().chain(last).find_map(|step| {
                let next = step.apply(from, pinned, &known).filter(fresh)?;
                Some((next, step.reason()))
            })
        })
    }

    /// Whether a move of the attempt that had come farthest before led to this one, in which nearly as much is wrong.
    fn gained_little(&self, step: Move, attempt: usize, density: &Density) -> bool {
        let farthest = |&k: &usize| (self.attempts[k].end.rank(), Reverse(k));
        let Some(before) = (0..attempt).max_by_key(farthest) else {
            return false;
        };
        let wrong = |k: usize| self.attempts[k].end.places() as f64;
        let known = self.known(density, self.needed[before]);
        let from = &self.attempts[before].parameters;
        step.apply(from, &self.pinned, &known).as_ref() == Some(&self.attempts[attempt].parameters)
            && wrong(attempt) > WORTH * wrong(before)
    }

    /// What may confirm a mesh that passed with these parameters, the so-many-th time from 1: other landmarks, nearer to each
    /// other where those before were too far apart for what the points leave open, or failed twice.
    pub(super) fn confirming(
        &self,
        passed: &Parameters,
        time: usize,
        density: &Density,
    ) -> Option<(Parameters, &'static str)> {
        let fresh = |next: &Parameters| self.attempts.iter().all(|a| a.parameters != *next);
        let needed = self.needed.last().copied().flatten();
        let finer = match needed.filter(|_| time > 1) {
            Some(needed) => {
                let known = self.known(density, Some(needed.min(RESOLVING * passed.dl)));
                Move::Opened.apply(passed, &self.pinned, &known)
            }
            None if time > CONFIRMING => {
                Move::Smaller.apply(passed, &self.pinned, &self.known(density, None))
            }
            None => None,
        };
        let other = || other_landmarks(passed, &self.pinned, time);
        match finer.filter(fresh) {
            Some(next) => Some((next, "landmarks nearer to each other, to confirm")),
            None => Some((other()?, "other landmarks, to confirm the one that passed")),
        }
    }

    /// Whether further attempts are in vain: the last ones came no farther than one before them, and much is wrong
    /// with that.
    pub(super) fn is_hopeless(&self) -> bool {
        let farthest = self.best.as_ref().map_or(0, |best| best.0);
        let since = self.attempts.len() - 1 - farthest;
        since >= IN_VAIN && !self.attempts[farthest].end.is_near_miss()
    }
}
