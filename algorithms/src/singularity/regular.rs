//! No singularity: one sheet.

use super::patch::{PATCH_POINTS, QuadraticPatch};
use crosscap_core::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Stratum};
use nalgebra::Vector3;

/// One cell, a quadratic patch over the leading principal plane: what every other model
/// has to beat.
#[derive(Clone, Copy, Debug, Default)]
pub struct OneSheet;

impl SingularityModel for OneSheet {
    fn local_dimension(&self) -> usize {
        3
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        if local.fitted < PATCH_POINTS {
            return Err(Rejection::TooFewPoints {
                found: local.fitted,
                needed: PATCH_POINTS,
            });
        }
        let place = |k: usize| Vector3::from_column_slice(local.point(k));
        let mut patch =
            QuadraticPatch::plane(Vector3::zeros(), [Vector3::x(), Vector3::y(), Vector3::z()]);
        patch.fit((0..local.fitted).map(place), local.radius);
        let column =
            |axis: usize| -> Vec<f64> { (0..local.fitted).map(|k| local.point(k)[axis]).collect() };
        let columns = [column(0), column(1), column(2)];
        let mut distances = vec![0.0; local.fitted];
        patch.signed_distances(columns.each_ref().map(Vec::as_slice), &mut distances);
        let sum: f64 = distances.iter().map(|d| d * d).sum();
        Ok(Decomposition {
            strata: vec![Stratum { dimension: 2 }],
            labels: vec![Label::new(0); local.len()],
            cells_at_curve: Vec::new(),
            residual: (sum / local.fitted as f64).sqrt(),
            parameters: 8,
            points: Vec::new(),
            center: local.point(local.center).to_vec(),
            center_offset: f64::INFINITY,
        })
    }

    fn name(&self) -> &str {
        "one-sheet"
    }
}
