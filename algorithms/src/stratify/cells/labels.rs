//! What labels every point: the fit that is nearest.

use super::NONE;
use crate::execute::{self, Execute};
use crate::stratify::atlas::Reference;
use crosscap_core::{PointCloud, squared_distance};

/// Fits that a job takes at a time.
const FITS_AT_ONCE: usize = 8;

/// For every row the fit that is nearest, how far it is, and the label that it gives.
pub(in crate::stratify) struct Labels {
    nearest: Vec<u32>,
    closest: Vec<f64>,
    own: Vec<u8>,
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
            nearest: vec![NONE; count],
            closest: vec![f64::INFINITY; count],
            own: vec![0; count],
        };
        let Some(places) = places else {
            return labels;
        };
        let squares = |k: usize| -> Vec<f64> {
            let origin = places.point(fits[k].row);
            let rows = fits[k].labels().iter().map(|x| x.0 as usize);
            rows.map(|row| squared_distance(origin, places.point(row)))
                .collect()
        };
        let all = execute::map_blocks(execute, FITS_AT_ONCE, fits.len(), || (), |(), k| squares(k));
        for (k, (fit, squares)) in fits.iter().zip(all).enumerate() {
            let limit = (reach * fit.radius).powi(2);
            for (&(row, label), square) in fit.labels().iter().zip(squares) {
                let row = row as usize;
                if square < limit && square < labels.closest[row] {
                    labels.closest[row] = square;
                    labels.nearest[row] = k as u32;
                    labels.own[row] = label;
                }
            }
        }
        labels
    }

    /// Whether `i` and `j` are in different strata, or on the curve itself, by the fit that is
    /// nearest to either and knows both. `fits` are those that the labels were made of.
    pub(super) fn separated(&self, fits: &[&Reference], i: usize, j: usize) -> bool {
        let (first, second) = if self.closest[j] < self.closest[i] {
            (j, i)
        } else {
            (i, j)
        };
        for (from, to) in [(first, second), (second, first)] {
            let k = self.nearest[from];
            if k == NONE {
                continue;
            }
            let fit = fits[k as usize];
            let label = if self.nearest[to] == k {
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
