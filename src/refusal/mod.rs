//! A reconstruction that gave no verified mesh: what went wrong, where, and what to do about it.
//!
//! [`Outcome::into_verified`] and [`Search::into_verified`] give the mesh or a [`Refusal`]. A refusal has a [`Fault`]
//! for every kind of thing that went wrong, each with the number of places and the worst one, and
//! one [`Advice`]. Kinds are told apart by how the points lie around the places where the
//! reconstruction failed, not by which stage failed: see [`Surroundings`].

mod advice;
mod fault;
mod kind;
mod places;
mod surroundings;

#[cfg(test)]
mod tests;

pub use advice::Advice;
pub use fault::{Fault, Spot};
pub use kind::FaultKind;
pub use surroundings::Surroundings;

use crate::auto::{Attempt, Doubt, Search};
use crate::pipeline::{Outcome, Parameters};
use crosscap_core::{Error, Mesh, PointCloud};
use std::fmt;

/// Why there is no verified mesh.
#[derive(Debug)]
#[non_exhaustive]
pub struct Refusal {
    /// What went wrong, one entry a kind: those with a known cause first, and of these those of most places.
    pub faults: Vec<Fault>,
    /// The best thing to do.
    pub advice: Advice,
    /// What was tried; empty for a single reconstruction.
    pub attempts: Vec<Attempt>,
    /// The attempt that came farthest: its mesh as it is, or the error it ended with.
    pub outcome: Result<Outcome, Error>,
}

impl Refusal {
    /// The refusal of an outcome; with its points the kinds are told apart by how they lie.
    pub fn of(
        outcome: Result<Outcome, Error>,
        doubt: Option<&Doubt>,
        points: Option<&PointCloud<f64>>,
    ) -> Self {
        Self::after(Vec::new(), 0, outcome, doubt, points)
    }

    /// The refusal of attempts, of which the `chosen` one gave this outcome.
    fn after(
        attempts: Vec<Attempt>,
        chosen: usize,
        outcome: Result<Outcome, Error>,
        doubt: Option<&Doubt>,
        points: Option<&PointCloud<f64>>,
    ) -> Self {
        let faults = fault::faults(&outcome, doubt, points);
        let tried: Vec<&Parameters> = attempts.iter().map(|a| &a.parameters).collect();
        Self {
            advice: Advice::on(
                &faults,
                &outcome,
                points.map(PointCloud::len),
                &tried,
                chosen,
            ),
            faults,
            attempts,
            outcome,
        }
    }

    /// The worst place of all, where there is one.
    pub fn worst(&self) -> Option<&Spot> {
        self.faults.iter().find_map(|fault| fault.worst.as_ref())
    }
}

impl fmt::Display for Refusal {
    /// A line for every kind of fault, the advice last.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for fault in &self.faults {
            writeln!(f, "{fault}")?;
        }
        write!(f, "{}", self.advice)
    }
}

impl std::error::Error for Refusal {}

impl Outcome {
    /// The mesh, if it may be handed over as good.
    ///
    /// ```
    /// use crosscap::prelude::*;
    /// let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(3000, 1))?;
    /// let outcome = Pipeline::new(Parameters::new(0.5, 0.25))?.reconstruct(&sample.points)?;
    /// assert_eq!(outcome.into_verified()?.vertices.dimension(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What went wrong, where, and what to do. The points are not at hand here, so that kinds are told by the
    /// certificate alone; [`Refusal::of`] with the points tells more.
    pub fn into_verified(self) -> Result<Mesh, Box<Refusal>> {
        if self.is_verified() {
            Ok(self.mesh)
        } else {
            Err(Box::new(Refusal::of(Ok(self), None, None)))
        }
    }
}

impl Search {
    /// The outcome that may be handed over as good.
    ///
    /// # Errors
    /// What went wrong, where, and what to do. With the `points` that were searched kinds are told
    /// apart by how they lie.
    pub fn into_verified(self, points: Option<&PointCloud<f64>>) -> Result<Outcome, Box<Refusal>> {
        let verified = self.is_verified();
        match self.outcome {
            Ok(outcome) if verified => Ok(outcome),
            outcome => {
                let doubt = self.doubt.as_ref();
                let refusal = Refusal::after(self.attempts, self.chosen, outcome, doubt, points);
                Err(Box::new(refusal))
            }
        }
    }
}
