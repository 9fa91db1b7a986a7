//! Decomposition of a neighborhood into points, curves and cells.

use serde::{Deserialize, Serialize};

/// One stratum of a decomposed neighborhood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stratum {
    /// 0: a point (triple point, end of a double curve); 1: a curve (double curve, boundary);
    /// 2: a cell, an open piece of surface that no curve runs through.
    pub dimension: u8,
}

/// A neighborhood cut into strata, with every point labelled.
///
/// # Invariants
/// - `labels[k]` is an index into `strata`: the cells and curves partition the neighborhood;
/// - `continuations` pairs cells: two cells that continue each other across a curve are
///   one sheet. A cell may have several continuations (one a curve at its rim).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Decomposition {
    /// The strata, those of lowest dimension first.
    pub strata: Vec<Stratum>,
    /// For each point of the neighborhood, the stratum it is in.
    pub labels: Vec<u8>,
    /// Pairs of cells that are one sheet.
    pub continuations: Vec<(u8, u8)>,
    /// For each curve (in the order of `strata`) the number of cells that meet in it: the
    /// number of triangles that an edge along it must have.
    pub cells_at_curve: Vec<u8>,
    /// Root mean squared distance of the fitted points to the model, in the unit of the data.
    pub residual: f64,
    /// Number of free parameters of the fit, what a comparison of models penalizes.
    pub parameters: usize,
    /// Places of the strata of dimension 0, in the order of `strata`, in local coordinates; they may
    /// lie outside of the neighborhood's sample but not outside of its ball.
    pub points: Vec<Vec<f64>>,
    /// The center moved onto the stratum it belongs to, in local coordinates; a center inside a cell
    /// is moved onto the first curve, where there is one.
    pub center: Vec<f64>,
    /// Distance of the unmoved center to that place; infinite for a center inside a cell that
    /// tells nothing about a curve.
    pub center_offset: f64,
}

impl Decomposition {
    /// Dimension of the stratum that point `k` of the neighborhood lies in.
    pub fn dimension_of(&self, k: usize) -> u8 {
        self.strata[self.labels[k] as usize].dimension
    }

    /// Number of cells that meet in the curve that `label` names; `None` when it names no curve.
    pub fn cells_at(&self, label: u8) -> Option<u8> {
        let first = self.strata.iter().filter(|s| s.dimension == 0).count();
        (self.strata.get(label as usize)?.dimension == 1)
            .then(|| self.cells_at_curve.get(label as usize - first).copied())
            .flatten()
    }

    /// What is said of the center, which is row `k`.
    pub fn located(&self, k: usize) -> Located {
        Located {
            dimension: self.dimension_of(k),
            cells: match self.dimension_of(k) {
                0 => 0,
                1 => self.cells_at(self.labels[k]).unwrap_or(0),
                _ => self.cells_at_curve.first().copied().unwrap_or(0),
            },
            place: self.center.clone(),
            offset: self.center_offset,
        }
    }
}

/// Where a decomposition puts a point of its neighborhood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Located {
    /// Dimension of the stratum that the point is in.
    pub dimension: u8,
    /// Number of cells that meet in the curve that it is on, or that is near.
    pub cells: u8,
    /// As [`Decomposition::center`].
    pub place: Vec<f64>,
    /// As [`Decomposition::center_offset`].
    pub offset: f64,
}
