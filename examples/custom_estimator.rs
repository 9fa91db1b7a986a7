//! A dimension estimator of one's own: principal components that a few outliers do not move.
//!
//! `cargo run --release --example custom_estimator`

use crosscap_core::laws::{self, Settings};
use crosscap_core::{
    DimensionEstimate, DimensionEstimator, Error, Neighbor, Neighborhood, PointCloud, Scalar,
};
use nalgebra::{DMatrix, SymmetricEigen};

/// Principal components, fitted again without the points farthest off the surface.
///
/// After a first fit the share `trim` of the points with the largest distances off the leading two
/// axes is left out; the dimension is read from the rest as usual, with tolerance `dt`.
pub struct TrimmedComponents {
    pub dt: f64,
    pub trim: f64,
}

/// Mean, axes (columns) and variances, largest first.
struct Frame {
    mean: Vec<f64>,
    axes: DMatrix<f64>,
    variances: Vec<f64>,
}

fn frame<S: Scalar>(cloud: &PointCloud<S>, rows: &[usize]) -> Frame {
    let (n, count) = (cloud.dimension(), rows.len() as f64);
    let mut mean = vec![0.0; n];
    for &row in rows {
        for (m, x) in mean.iter_mut().zip(cloud.point(row)) {
            *m += x.as_f64() / count;
        }
    }
    let mut covariance = DMatrix::<f64>::zeros(n, n);
    for &row in rows {
        let x = cloud.point(row);
        for a in 0..n {
            for b in 0..n {
                covariance[(a, b)] += (x[a].as_f64() - mean[a]) * (x[b].as_f64() - mean[b]) / count;
            }
        }
    }
    let eigen = SymmetricEigen::new(covariance);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    Frame {
        mean,
        axes: eigen.eigenvectors.select_columns(&order),
        variances: order
            .iter()
            .map(|&k| eigen.eigenvalues[k].max(0.0))
            .collect(),
    }
}

impl DimensionEstimator for TrimmedComponents {
    type Scalar = f64;

    fn estimate(&self, near: &Neighborhood<'_, f64>) -> Result<DimensionEstimate, Error> {
        let cloud = near.cloud.ok_or_else(|| Error::Shape {
            found: "distances without coordinates".into(),
            expected: "coordinates".into(),
        })?;
        if near.neighbors.len() < 8 {
            return Err(Error::SparseNeighborhood {
                point: near.center,
                found: near.neighbors.len(),
                needed: 8,
                parameter: "eps",
            });
        }
        let rows: Vec<usize> = near.neighbors.iter().map(|x| x.index).collect();
        let first = frame(cloud, &rows);
        let off = |row: usize| -> f64 {
            let x: Vec<f64> = cloud
                .point(row)
                .iter()
                .zip(&first.mean)
                .map(|(a, m)| a - m)
                .collect();
            let all: f64 = x.iter().map(|c| c * c).sum();
            let along = first.axes.columns(0, first.axes.ncols().min(2));
            let inside: f64 = along
                .column_iter()
                .map(|axis| axis.iter().zip(&x).map(|(a, c)| a * c).sum::<f64>().powi(2))
                .sum();
            all - inside
        };
        let offs: Vec<f64> = rows.iter().map(|&row| off(row)).collect();
        let mut ranked = offs.clone();
        ranked.sort_by(f64::total_cmp);
        let kept = (rows.len() as f64 * (1.0 - self.trim)).ceil() as usize;
        // Points as far off as the last one kept stay as well, or rounding would choose among them.
        let spread: f64 = first.variances.iter().sum();
        let limit = ranked[kept.clamp(1, rows.len()) - 1] + 1e-9 * spread;
        let kept = rows.iter().zip(&offs).filter(|x| *x.1 <= limit);
        let rows: Vec<usize> = kept.map(|x| *x.0).collect();

        let spectrum = frame(cloud, &rows).variances;
        let total: f64 = spectrum.iter().sum();
        let (mut dimension, mut before, mut share) = (0, 1.0, 1.0);
        while dimension < spectrum.len() && total > 0.0 && share >= self.dt {
            dimension += 1;
            before = share;
            share = spectrum[dimension..].iter().sum::<f64>() / total;
        }
        // How far the share that decided, and the one before it, are from the tolerance.
        let margin = (1.0 - share / self.dt).min(1.0 - self.dt / before);
        Ok(DimensionEstimate {
            dimension,
            value: dimension as f64,
            confidence: margin.clamp(0.0, 1.0),
            spectrum,
        })
    }

    fn name(&self) -> &str {
        "trimmed-pca"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let robust = TrimmedComponents {
        dt: 0.05,
        trim: 0.1,
    };
    laws::estimator(&Settings::default(), &robust)?;
    println!("{} obeys the laws of DimensionEstimator", robust.name());
    one_neighborhood()?;
    a_torus()
}

/// A flat piece of 200 points, and 8 outliers above it.
fn one_neighborhood() -> Result<(), Box<dyn std::error::Error>> {
    let mut coordinates = Vec::new();
    for k in 0..200 {
        coordinates.extend([
            f64::from(k % 20) / 10.0 - 1.0,
            f64::from(k / 20) / 5.0 - 1.0,
            0.0,
        ]);
    }
    for k in 0..8 {
        coordinates.extend([0.1 * f64::from(k), 0.0, 1.2]);
    }
    let cloud = PointCloud::new(3, coordinates)?;
    let metric = laws::StraightLine(cloud.clone());
    let mut neighbors: Vec<Neighbor<f64>> = (0..cloud.len())
        .map(|index| Neighbor {
            index,
            distance: cloud.squared_distance(0, index).sqrt(),
        })
        .collect();
    neighbors.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let near = Neighborhood {
        center: 0,
        radius: f64::INFINITY,
        neighbors: &neighbors,
        metric: &metric,
        cloud: Some(&cloud),
    };
    for trim in [0.0, 0.1] {
        let found = TrimmedComponents { dt: 0.05, trim }.estimate(&near)?;
        println!(
            "trim {trim}: dimension {}, spectrum {:.3?}",
            found.dimension, found.spectrum
        );
    }
    Ok(())
}

/// A torus on which every hundredth point is a bad measurement. Landmarks are chosen among the others: an estimator
/// says what a neighborhood is, and leaves the bad points in it.
fn a_torus() -> Result<(), Box<dyn std::error::Error>> {
    use crosscap::prelude::*;
    let sample = SampleSurface::find("torus")?.sample(&Sampling::new(6000, 7))?;
    let good = sample.points;
    let mut rows = good.coordinates().to_vec();
    for k in (0..good.len()).step_by(100) {
        rows[3 * k + k / 100 % 3] += 0.2;
    }
    let shaken = PointCloud::new(3, rows)?;
    for trim in [0.0, 0.1] {
        let estimator = TrimmedComponents { dt: 0.02, trim };
        let found = Pipeline::new(Parameters::new(0.5, 0.35))?
            .estimator(Box::new(estimator))
            .reconstruct(&shaken);
        match found {
            Ok(outcome) => println!(
                "trim {trim}: {} of {} points are not 2-dimensional, verified: {}, Betti numbers {:?}",
                outcome.report.candidates,
                shaken.len(),
                outcome.is_verified(),
                outcome.homology.betti_rational
            ),
            Err(why) => println!("trim {trim}: {why}"),
        }
    }
    Ok(())
}
