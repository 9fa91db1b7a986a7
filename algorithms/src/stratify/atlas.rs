//! The fits about points on curves that label what is around them.

use super::analysis::{Fitter, Scratch};
use super::strata::Strata;
use crate::execute;
use crosscap_core::{Decomposition, Label, Row, Scalar};
use std::collections::BTreeMap;

/// A fit about a point on a curve or point, with the labels of the rows around it.
#[derive(Debug)]
pub(super) struct Reference {
    /// Its row.
    pub(super) row: Row,
    /// Rows in its ball with their labels, by row.
    labels: Vec<(Row, Label)>,
    /// Radius of the fit.
    pub(super) radius: f64,
    /// The strata, without the labels.
    pub(super) fit: Decomposition,
}

impl Reference {
    /// The label of a row.
    pub(super) fn label(&self, row: Row) -> Option<Label> {
        let at = self.labels.binary_search_by_key(&row, |x| x.0).ok()?;
        Some(self.labels[at].1)
    }

    /// The rows that are labelled, with their labels.
    pub(super) fn labels(&self) -> &[(Row, Label)] {
        &self.labels
    }

    /// Whether `label` names a 0-stratum.
    pub(super) fn is_point(&self, label: Label) -> bool {
        self.fit.is_of(label, 0)
    }

    /// Whether `label` names a curve.
    pub(super) fn is_curve(&self, label: Label) -> bool {
        self.fit.is_of(label, 1)
    }

    /// Whether the model knows of 0-strata.
    pub(super) fn has_points(&self) -> bool {
        !self.fit.points.is_empty()
    }

    /// Whether `label` names a cell.
    pub(super) fn is_cell(&self, label: Label) -> bool {
        self.fit.is_of(label, 2)
    }
}

/// A fit of an [`Atlas`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FitId(u32);

/// Fits that label points, each made once and kept. It only grows.
#[derive(Default)]
pub(super) struct Atlas {
    fits: Vec<Reference>,
    /// The fit of every row that was asked about; `None` where there is none.
    of_row: BTreeMap<Row, Option<FitId>>,
}

/// Fits that a job takes at a time.
const FITS_AT_ONCE: usize = 8;

impl Atlas {
    /// Fits the balls of rows on curves and points, those that were fitted before left out.
    pub(super) fn fit<S: Scalar>(&mut self, fitter: &Fitter<'_, S>, strata: &Strata, rows: &[Row]) {
        let new: Vec<Row> = (rows.iter().copied())
            .filter(|row| !self.of_row.contains_key(row))
            .collect();
        let found = execute::map_blocks(
            fitter.execute,
            FITS_AT_ONCE,
            new.len(),
            Scratch::default,
            |scratch, k| {
                let mut regions = strata.regions().iter();
                if let Some(region) = regions.find(|r| r.label(new[k]).is_some()) {
                    return Some(Reference {
                        row: new[k],
                        labels: region.known(),
                        // All of the region, from whichever of its points.
                        radius: 2.0 * region.reach,
                        fit: region.fit.clone(),
                    });
                }
                let (mut fit, near, radius) = fitter.decomposition(strata, new[k], scratch)?;
                let mut labels: Vec<(Row, Label)> =
                    (near.into_iter().zip(std::mem::take(&mut fit.labels))).collect();
                labels.sort_unstable();
                Some(Reference {
                    row: new[k],
                    labels,
                    radius,
                    fit,
                })
            },
        );
        for (row, found) in new.into_iter().zip(found) {
            let id = found.map(|reference| {
                self.fits.push(reference);
                FitId(self.fits.len() as u32 - 1)
            });
            self.of_row.insert(row, id);
        }
    }

    /// A fit.
    pub(super) fn get(&self, id: FitId) -> &Reference {
        &self.fits[id.0 as usize]
    }

    /// The fit about a row, if it was made.
    pub(super) fn about(&self, row: Row) -> Option<FitId> {
        self.of_row.get(&row).copied().flatten()
    }

    /// The fits about the rows for which there is one, in the order of the rows.
    pub(super) fn about_all(&self, rows: &[Row]) -> Vec<FitId> {
        rows.iter().filter_map(|&row| self.about(row)).collect()
    }
}
