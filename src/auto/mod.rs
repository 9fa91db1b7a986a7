//! A reconstruction that finds its own parameters.
//!
//! [`Parameters::auto`] is the way in. The lengths come from the [`Density`] of the points; what the
//! user has [`Pinned`] stays as it is. What was tried, and why, is in [`Search::attempts`].

mod alone;
mod attempt;
mod density;
mod evidence;
mod input;
mod measured;
mod moves;
mod needs;
mod pinned;
mod prepared;
mod rounded;
mod rounding;
mod search;
mod symptoms;
#[cfg(test)]
mod tests;
mod worked_on;

pub use attempt::{Attempt, End, Topology};
pub use density::Density;
pub use input::Input;
pub use measured::{Measured, Measuring};
pub use moves::Move;
pub(crate) use moves::{CLOSEST, ROOMY};
pub use pinned::Pinned;
pub use rounded::Rounded;
pub use search::{Choice, Doubt, Search};

use crate::pipeline::{Parameters, Pipeline};
use crosscap_algorithms::tuning::PreparationTuning;
use crosscap_backends::files::Distances;
use crosscap_core::{Error, PointCloud};
use std::time::Duration;

/// A reconstruction whose parameters are chosen from the points.
///
/// ```
/// use crosscap::prelude::*;
/// let sample = SampleSurface::find("torus")?.sample(&Sampling::new(4000, 7))?;
/// let search = Parameters::auto().reconstruct(&sample.points)?;
/// let outcome = search.outcome?;
/// assert!(outcome.is_verified());
/// assert_eq!(outcome.homology.betti_rational, [1, 2, 1]);
/// println!("eps {}, dl {}", outcome.report.parameters.eps, outcome.report.parameters.dl);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Auto {
    pinned: Pinned,
    tries: usize,
    time_limit: Option<Duration>,
    preparation: PreparationTuning,
}

/// Attempts at most, where nothing is said.
pub const USUAL_TRIES: usize = 7;

impl Default for Auto {
    fn default() -> Self {
        Self::new(Pinned::default())
    }
}

impl Auto {
    /// Chooses what is not pinned.
    pub fn new(pinned: Pinned) -> Self {
        Self {
            pinned,
            tries: USUAL_TRIES,
            time_limit: None,
            preparation: PreparationTuning::MEASURED,
        }
    }

    /// The landmark separation dl is this one, unit of the data; everything else is chosen.
    pub fn dl(mut self, dl: f64) -> Self {
        self.pinned.dl = Some(dl);
        self
    }

    /// The seed of the landmark selection is this one.
    pub fn seed(mut self, seed: u64) -> Self {
        self.pinned.seed = Some(seed);
        self
    }

    /// At most so many attempts, at least one.
    pub fn tries(mut self, tries: usize) -> Self {
        self.tries = tries.max(1);
        self
    }

    /// No further attempt begins after this time. An attempt that has begun is finished.
    pub fn time_limit(mut self, limit: Duration) -> Self {
        self.time_limit = Some(limit);
        self
    }

    /// The numbers that decide which points are outliers, and where points that scatter are moved.
    pub fn preparation(mut self, tuning: PreparationTuning) -> Self {
        self.preparation = tuning;
        self
    }

    /// What is not the program's to choose.
    pub fn pinned(&self) -> &Pinned {
        &self.pinned
    }

    /// Reconstructs the surface that `cloud` was sampled from.
    ///
    /// # Errors
    /// Input that cannot be worked on ([`Error::is_input`]). Everything else is in the search.
    pub fn reconstruct(&self, cloud: &PointCloud<f64>) -> Result<Search, Error> {
        self.search(Input::Points(cloud), &mut Pipeline::new)
    }

    /// Reconstructs a surface from the distances of its points: see [`Pipeline::reconstruct_distances`].
    ///
    /// # Errors
    /// As for [`Auto::reconstruct`].
    pub fn reconstruct_distances(&self, distances: &Distances) -> Result<Search, Error> {
        self.search(Input::Distances(distances), &mut Pipeline::new)
    }
}

impl Parameters {
    /// Parameters chosen from the points, instead of given ones.
    pub fn auto() -> Auto {
        Auto::default()
    }
}
