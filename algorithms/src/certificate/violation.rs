//! What can be wrong with a mesh: kinds, places, and what to change.

use super::kinds::ViolationKind;
use super::places::Place;
use serde::Serialize;
use std::fmt;

/// One kind of violation with all its places.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Violation {
    /// What is wrong.
    pub kind: ViolationKind,
    /// In how many places.
    pub count: usize,
    /// The first places, at most [`Violation::PLACES`], in increasing order.
    pub places: Vec<Place>,
    /// Coordinates of the first place (of its first vertex), empty when it has none.
    pub coordinates: Vec<f64>,
    /// The worst value found, in the unit of `limit`, where the violation is one of degree.
    pub worst: Option<f64>,
    /// The limit it broke.
    pub limit: Option<f64>,
    /// What was found, where kind and place do not say it.
    pub detail: String,
    /// Which parameter to change.
    pub advice: &'static str,
}

impl Violation {
    /// Number of places that are listed.
    pub const PLACES: usize = 20;

    /// All places of one kind; nothing when there are none. Places are brought into order.
    pub(super) fn at(
        kind: ViolationKind,
        mut places: Vec<Place>,
        coordinates: impl FnOnce(Place) -> Vec<f64>,
    ) -> Option<Self> {
        places.sort_unstable();
        let count = places.len();
        let first = *places.first()?;
        places.truncate(Self::PLACES);
        Some(Self {
            kind,
            count,
            coordinates: coordinates(first),
            places,
            worst: None,
            limit: None,
            detail: String::new(),
            advice: kind.advice(),
        })
    }

    /// A violation of the mesh as a whole.
    pub(super) fn whole(kind: ViolationKind, detail: String) -> Self {
        Self {
            kind,
            count: 1,
            places: Vec::new(),
            coordinates: Vec::new(),
            worst: None,
            limit: None,
            detail,
            advice: kind.advice(),
        }
    }

    /// Adds the worst value and the limit.
    pub(super) fn measured(mut self, worst: f64, limit: f64) -> Self {
        self.worst = Some(worst);
        self.limit = Some(limit);
        self
    }

    /// Adds what was found.
    pub(super) fn detailed(mut self, detail: String) -> Self {
        self.detail = detail;
        self
    }
}

/// A number as it is printed: probabilities are too small for decimals.
struct Figure(f64);

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        if value != 0.0 && value.abs() < 0.01 {
            write!(f, "{value:.1e}")
        } else {
            write!(f, "{value:.4}")
        }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.count, self.kind.meaning())?;
        if !self.detail.is_empty() {
            write!(f, " ({})", self.detail)?;
        }
        if let (Some(worst), Some(limit)) = (self.worst, self.limit) {
            write!(
                f,
                ", worst {} against a limit of {}",
                Figure(worst),
                Figure(limit)
            )?;
        }
        if let Some(first) = self.places.first() {
            write!(f, "; first at {first}")?;
        }
        if !self.coordinates.is_empty() {
            f.write_str(" (")?;
            for (k, c) in self.coordinates.iter().take(6).enumerate() {
                write!(f, "{}{c:.4}", if k == 0 { "" } else { ", " })?;
            }
            f.write_str(if self.coordinates.len() > 6 {
                ", ..)"
            } else {
                ")"
            })?;
        }
        write!(f, ". To change: {}.", self.advice)
    }
}

/// Whether a mesh may be handed over as good.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every level holds.
    Verified,
    /// What is wrong, in the order of the levels.
    Refused(Vec<Violation>),
}

impl Verdict {
    /// Whether the mesh may be handed over as good.
    pub fn is_verified(&self) -> bool {
        matches!(self, Self::Verified)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Verified => f.write_str("verified"),
            Self::Refused(violations) => {
                f.write_str("refused")?;
                for v in violations {
                    write!(f, "\n  {v}")?;
                }
                Ok(())
            }
        }
    }
}
