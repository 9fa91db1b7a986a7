//! One attempt at a reconstruction, and how it ended.

use crate::pipeline::{Outcome, Parameters};
use crosscap_algorithms::certificate::ViolationKind;
use crosscap_algorithms::pieces::{Pieces, Reading};
use crosscap_core::Error;
use serde::Serialize;
use std::cmp::Reverse;
use std::fmt;

/// One attempt at a reconstruction.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Attempt {
    /// The parameters.
    pub parameters: Parameters,
    /// Why these parameters, in a few words.
    pub reason: String,
    /// How it ended.
    pub end: End,
    /// Seconds it took.
    pub seconds: f64,
}

/// What a mesh is up to bending, as far as homology and its pieces tell.
///
/// Equal when Betti numbers and the [reading](Pieces::reading) of the pieces are: in words the same surface can be told
/// in another order, and with other angles.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Topology {
    /// Betti numbers over Q.
    pub betti: [usize; 3],
    /// Betti numbers over Z/2.
    pub betti_mod2: [usize; 3],
    /// The pieces and how they meet, in a sentence; none where they cannot be told apart.
    pub pieces: Option<String>,
    /// The same without order and measure.
    #[serde(skip)]
    reading: Option<Reading>,
}

impl PartialEq for Topology {
    fn eq(&self, other: &Self) -> bool {
        let key = |t: &Self| (t.betti, t.betti_mod2);
        key(self) == key(other) && self.reading == other.reading
    }
}

impl fmt::Display for Topology {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b, c] = self.betti;
        write!(f, "Betti numbers {a}, {b}, {c}")?;
        match &self.pieces {
            Some(pieces) => write!(f, " ({})", pieces.trim_end_matches('.')),
            None => Ok(()),
        }
    }
}

/// Places that chance may have spoiled.
const FEW_PLACES: usize = 3;

/// How an attempt ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum End {
    /// With a verified mesh.
    Verified(Topology),
    /// With a mesh that passes by itself, and covers a gap that an earlier attempt found in the points.
    Denied(Topology),
    /// With a mesh that is not verified.
    Refused {
        /// Stars and cells that stayed open.
        open: usize,
        /// Vertices of the mesh.
        vertices: usize,
        /// What the certificate found, each with its number of places.
        violations: Vec<(ViolationKind, usize)>,
    },
    /// Before there was a mesh.
    Failed(String),
}

impl End {
    /// How this outcome ended.
    pub(super) fn of(outcome: &Result<Outcome, Error>) -> Self {
        match outcome {
            Ok(outcome) if outcome.is_verified() => Self::Verified(Topology {
                betti: outcome.homology.betti_rational,
                betti_mod2: outcome.homology.betti_mod2,
                pieces: outcome.pieces.as_ref().ok().map(ToString::to_string),
                reading: outcome.pieces.as_ref().ok().map(Pieces::reading),
            }),
            Ok(outcome) => Self::Refused {
                open: outcome.failures.len(),
                vertices: outcome.mesh.complex.vertices,
                violations: (outcome.certificate.violations())
                    .map(|v| (v.kind, v.count))
                    .collect(),
            },
            Err(error) => Self::Failed(error.to_string()),
        }
    }

    /// The same, where earlier attempts speak against the mesh.
    pub(super) fn denied(self) -> Self {
        match self {
            Self::Verified(topology) => Self::Denied(topology),
            other => other,
        }
    }

    /// Whether there is a verified mesh.
    pub fn is_verified(&self) -> bool {
        self.topology().is_some()
    }

    /// What the verified mesh is.
    pub fn topology(&self) -> Option<&Topology> {
        match self {
            Self::Verified(topology) => Some(topology),
            _ => None,
        }
    }

    /// Whether so little is wrong that other landmarks may do: a few places, or one vertex in 200.
    pub(super) fn is_near_miss(&self) -> bool {
        let Self::Refused { vertices, .. } = self else {
            return false;
        };
        self.places() <= FEW_PLACES.max(vertices / 200)
    }

    /// Open stars and places that the certificate complains about.
    pub(super) fn places(&self) -> usize {
        match self {
            Self::Refused {
                open, violations, ..
            } => open + violations.iter().map(|v| v.1).sum::<usize>(),
            _ => 0,
        }
    }

    /// Boundaries of few edges: holes that the mesh shows, and does not resolve.
    fn small_holes(&self) -> usize {
        let small = |v: &&(ViolationKind, usize)| v.0 == ViolationKind::SmallHole;
        match self {
            Self::Refused { violations, .. } => violations.iter().filter(small).map(|v| v.1).sum(),
            _ => 0,
        }
    }

    /// How far an attempt came: the larger, the farther. Among meshes that are not verified those with
    /// fewer places to complain about; a hole that is shown with few edges is less wrong than anything else. One that covers what is
    /// known to be a gap says nothing of its own.
    pub(super) fn rank(&self) -> (u8, Reverse<usize>, Reverse<usize>) {
        let small = self.small_holes();
        let step = match self {
            Self::Verified(_) => 2,
            Self::Refused { .. } => 1,
            Self::Denied(_) | Self::Failed(_) => 0,
        };
        (step, Reverse(self.places() - small), Reverse(small))
    }
}
