//! Classical multidimensional scaling.

use crosscap_core::{Chart, Error, LocalChart};
use nalgebra::{DMatrix, SymmetricEigen};

/// Classical scaling: the leading eigenvectors of the doubly centred matrix of squared
/// distances, -1/2 H D^2 H (Martin & Watson 2011, section 2.6; Torgerson 1952).
#[derive(Clone, Copy, Debug, Default)]
pub struct ClassicalScaling;

impl LocalChart for ClassicalScaling {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        if distances.len() != count * count {
            return Err(Error::Shape {
                found: format!("{} distances", distances.len()),
                expected: format!("{count} x {count}"),
            });
        }
        if let Some(at) = distances.iter().position(|d| !d.is_finite()) {
            return Err(Error::NotFinite {
                row: at / count,
                column: at % count,
            });
        }
        if count == 0 {
            return Ok(Chart {
                dimension,
                coordinates: Vec::new(),
                distortion: 0.0,
            });
        }
        let mut gram = DMatrix::<f64>::from_fn(count, count, |i, j| {
            let d = distances[i * count + j];
            d * d
        });
        let means: Vec<f64> = (0..count).map(|i| gram.row(i).mean()).collect();
        let mean = means.iter().sum::<f64>() / count as f64;
        for i in 0..count {
            for j in 0..count {
                gram[(i, j)] = -0.5 * (gram[(i, j)] - means[i] - means[j] + mean);
            }
        }
        let total: f64 = gram.trace();
        let eigen = SymmetricEigen::new(gram);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let mut coordinates = vec![0.0; count * dimension];
        let mut carried = 0.0;
        for (k, &column) in order.iter().take(dimension).enumerate() {
            let value = eigen.eigenvalues[column].max(0.0);
            carried += value;
            for i in 0..count {
                coordinates[i * dimension + k] = eigen.eigenvectors[(i, column)] * value.sqrt();
            }
        }
        Ok(Chart {
            dimension,
            coordinates,
            distortion: if total > 0.0 {
                (1.0 - carried / total).clamp(0.0, 1.0)
            } else {
                0.0
            },
        })
    }

    fn name(&self) -> &str {
        "mds"
    }
}
