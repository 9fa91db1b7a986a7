//! The points about the end of a curve.

use crate::stratify::site::{FitUsed, On};
use crosscap_core::{Decomposition, Label, PointCloud, Row, Scalar, squared_distance};

/// A point at which a curve ends, with the points about it.
#[derive(Clone, Debug)]
pub(in crate::stratify) struct EndRegion {
    /// Rows of the region with their labels, by row.
    pub(in crate::stratify) labels: Vec<(Row, Label)>,
    /// Rows beyond it with the labels that they have by its fit.
    pub(super) beyond: Vec<(Row, Label)>,
    /// The strata, without the labels.
    pub(in crate::stratify) fit: Decomposition,
    /// Place of the point.
    pub(in crate::stratify) place: Vec<f64>,
    /// How far from it the region reaches.
    pub(in crate::stratify) reach: f64,
    /// The fit that says so.
    pub(in crate::stratify) used: FitUsed,
}

/// What becomes of a row of a region.
pub(in crate::stratify) struct Settled {
    pub(in crate::stratify) row: Row,
    /// On which stratum it is, `None` inside a cell.
    pub(in crate::stratify) on: Option<On>,
    /// The curve that a row of a cell is near.
    pub(in crate::stratify) beside: Option<On>,
}

/// A region, and what becomes of its rows.
pub(in crate::stratify) type EndFound = (EndRegion, Vec<Settled>);

impl EndRegion {
    /// The rows nearer than `reach` to `place`, each with its label and by row, some beyond, the strata that the
    /// labels name, and the fit that names them.
    pub(in crate::stratify) fn new(
        [labels, beyond]: [Vec<(Row, Label)>; 2],
        fit: Decomposition,
        place: Vec<f64>,
        reach: f64,
        used: FitUsed,
    ) -> Self {
        Self {
            labels,
            beyond,
            fit,
            place,
            reach,
            used,
        }
    }

    /// Rows with their labels, by row: those of the region, and those beyond.
    pub(in crate::stratify) fn known(&self) -> Vec<(Row, Label)> {
        let mut all = [&self.labels[..], &self.beyond[..]].concat();
        all.sort_unstable();
        all
    }

    /// The label of a row.
    pub(in crate::stratify) fn label(&self, row: Row) -> Option<Label> {
        let at = self.labels.binary_search_by_key(&row, |x| x.0).ok()?;
        Some(self.labels[at].1)
    }

    /// Its rows.
    pub(in crate::stratify) fn rows(&self) -> impl Iterator<Item = Row> {
        self.labels.iter().map(|x| x.0)
    }

    /// Whether a label names a cell.
    pub(in crate::stratify) fn is_cell(&self, label: Label) -> bool {
        self.fit.is_of(label, 2)
    }

    /// How far a place is from the point.
    pub(super) fn distance(&self, place: &[f64]) -> f64 {
        squared_distance(&self.place, place).sqrt()
    }

    /// How far a row of the cloud is from the point.
    pub(super) fn far<S: Scalar>(&self, cloud: &PointCloud<S>, row: Row) -> f64 {
        let own = cloud.point(row.index()).iter().map(|x| x.as_f64());
        let squares = own.zip(&self.place).map(|(x, p)| (x - p) * (x - p));
        squares.sum::<f64>().sqrt()
    }
}
