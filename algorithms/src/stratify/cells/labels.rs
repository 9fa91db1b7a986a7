//! What labels every point: the fit that is nearest.

use super::Labelling;
use crate::execute::{self, Execute};
use crate::stratify::atlas::Reference;
use crosscap_core::{Label, PointCloud, Row, Table, squared_distance};

/// Fits that a job takes at a time.
const FITS_AT_ONCE: usize = 8;

/// For every row the fit that is nearest, how far it is, and the label that it gives.
pub(in crate::stratify) struct Labels {
    nearest: Table<Row, Option<Labelling>>,
    closest: Table<Row, f64>,
    own: Table<Row, Label>,
}

impl Labels {
    /// Labels by the `fits`, believed up to the share `reach` of the radius of each. `places` are those of
    /// all rows; without, there are no fits and no labels.
    pub(in crate::stratify) fn new(
        count: usize,
        places: Option<&PointCloud<f64>>,
        fits: &[&Reference],
        reach: f64,
        execute: &dyn Execute,
    ) -> Self {
        let mut labels = Self {
            nearest: Table::filled(count, None),
            closest: Table::filled(count, f64::INFINITY),
            own: Table::filled(count, Label::default()),
        };
        let Some(places) = places else {
            return labels;
        };
        let squares = |k: usize| -> Vec<f64> {
            let origin = places.point(fits[k].row.index());
            let rows = fits[k].labels().iter().map(|x| x.0.index());
            rows.map(|row| squared_distance(origin, places.point(row)))
                .collect()
        };
        let all = execute::map_blocks(execute, FITS_AT_ONCE, fits.len(), || (), |(), k| squares(k));
        for (k, (fit, squares)) in fits.iter().zip(all).enumerate() {
            let limit = (reach * fit.radius).powi(2);
            for (&(row, label), square) in fit.labels().iter().zip(squares) {
                if square < limit && square < labels.closest[row] {
                    labels.closest[row] = square;
                    labels.nearest[row] = Some(Labelling::new(k));
                    labels.own[row] = label;
                }
            }
        }
        labels
    }

    /// Whether `i` and `j` are in different strata, or on the curve itself, by the fit that is
    /// nearest to either and knows both. `fits` are those that the labels were made of.
    pub(super) fn separated(&self, fits: &[&Reference], i: Row, j: Row) -> bool {
        let (first, second) = if self.closest[j] < self.closest[i] {
            (j, i)
        } else {
            (i, j)
        };
        for (from, to) in [(first, second), (second, first)] {
            let Some(k) = self.nearest[from] else {
                continue;
            };
            let fit = fits[k.index()];
            let label = if self.nearest[to] == Some(k) {
                Some(self.own[to])
            } else {
                fit.label(to)
            };
            if let Some(label) = label {
                return label != self.own[from] || !fit.is_cell(label);
            }
        }
        false
    }
}
