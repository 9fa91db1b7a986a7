//! Where a point of the cloud is: inside a cell, or on a stratum of lower dimension.

use crosscap_core::Row;
use serde::{Deserialize, Serialize};

/// A kind of stratum of dimension 0 or 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum StratumKind {
    /// A curve that a singularity model found.
    Curve,
    /// A boundary, given or found.
    Boundary,
    /// A point: where a found curve ends on a boundary, or a 0-stratum that a model found.
    Point,
}

/// The fit that put a point on its stratum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitUsed {
    /// Position of the model among those of the analysis.
    pub model: u8,
    /// Radius of the ball that it was fitted to, unit of the data.
    pub radius: f64,
}

/// What is known of a point on a stratum of dimension 0 or 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct On {
    /// Which kind of stratum.
    pub kind: StratumKind,
    /// The place on the stratum that the point is moved to; `None` where it stays.
    pub place: Option<Box<[f64]>>,
    /// How far it is moved, unit of the data.
    pub moved: f64,
    /// The fit that says so; `None` on a boundary, which has one cell and needs no labels to tell cells
    /// apart.
    pub fit: Option<FitUsed>,
    /// How many cells meet there, by that fit.
    pub cells: u8,
}

impl On {
    /// A point that was said to be on the boundary, and stays where it is.
    pub(super) const GIVEN_BOUNDARY: Self = Self {
        kind: StratumKind::Boundary,
        place: None,
        moved: 0.0,
        fit: None,
        cells: 0,
    };
}

/// Where a point of the cloud is.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Site {
    /// Inside a cell.
    #[default]
    Regular,
    /// On a curve, a boundary or a point.
    On(Box<On>),
    /// Nowhere that a model explains; counts as inside a cell.
    Unexplained,
}

impl Site {
    /// The kind of stratum, `None` inside a cell.
    pub fn kind(&self) -> Option<StratumKind> {
        self.on().map(|on| on.kind)
    }

    /// What is known of a point that is not inside a cell.
    pub fn on(&self) -> Option<&On> {
        match self {
            Self::On(on) => Some(on),
            Self::Regular | Self::Unexplained => None,
        }
    }
}

/// A point whose neighborhood shows a stratum close by, and where that is.
#[derive(Clone, Debug)]
pub(super) struct Witness {
    pub(super) row: Row,
    pub(super) on: On,
}

impl Witness {
    /// The place on the stratum.
    pub(super) fn place(&self) -> &[f64] {
        self.on.place.as_deref().unwrap_or(&[])
    }
}
