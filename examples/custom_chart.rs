//! A local chart of one's own: scaling about the center instead of about the mean.
//!
//! `cargo run --release --example custom_chart`

use crosscap_core::laws::{self, Settings};
use crosscap_core::{Chart, Error, LocalChart};
use nalgebra::{DMatrix, SymmetricEigen};

/// Inner products about point 0, by the law of cosines, and their leading eigenvectors.
struct CenteredScaling;

impl LocalChart for CenteredScaling {
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
        let square = |i: usize, j: usize| distances[i * count + j].powi(2);
        let gram = DMatrix::from_fn(count, count, |i, j| {
            0.5 * (square(0, i) + square(0, j) - square(i, j))
        });
        let mut coordinates = vec![0.0; count * dimension];
        let (mut carried, mut all) = (0.0, 0.0);
        if count > 0 {
            let eigen = SymmetricEigen::new(gram);
            let mut order: Vec<usize> = (0..count).collect();
            order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            for (k, &column) in order.iter().enumerate() {
                // Distances that no flat space has make negative eigenvalues: lost as well.
                all += eigen.eigenvalues[column].abs();
                let value = eigen.eigenvalues[column].max(0.0);
                if k < dimension {
                    carried += value;
                    for i in 0..count {
                        coordinates[i * dimension + k] =
                            eigen.eigenvectors[(i, column)] * value.sqrt();
                    }
                }
            }
        }
        let distortion = if all > 0.0 {
            (1.0 - carried / all).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Ok(Chart {
            dimension,
            coordinates,
            distortion,
        })
    }

    fn name(&self) -> &str {
        "centered"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::chart(&Settings::default(), &CenteredScaling)?;
    println!("{} obeys the laws of LocalChart", CenteredScaling.name());

    use crosscap::prelude::*;
    let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
    let outcome = Pipeline::new(Parameters::new(0.4, 0.2).surface())?
        .chart(Box::new(CenteredScaling))
        .reconstruct(&sample.points)?;
    println!("verified: {}", outcome.is_verified());
    Ok(())
}
