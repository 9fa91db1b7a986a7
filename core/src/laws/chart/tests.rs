use super::*;
use crate::Error;
use crate::laws::twins::{each_is_caught, quick};
use nalgebra::{DMatrix, SymmetricEigen};
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    Overflowing,
    Open,
    NotSquared,
    NeverDistorted,
    Kept,
    Anchored,
    Remembering,
}

struct Twin(Fault, AtomicUsize);

/// Leading eigenvectors of the centered inner products.
fn scaled(count: usize, distances: &[f64], dimension: usize, power: i32) -> Chart {
    let square = |i: usize, j: usize| distances[i * count + j].powi(power);
    let mean = |i: usize| (0..count).map(|j| square(i, j)).sum::<f64>() / count as f64;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let total = means.iter().sum::<f64>() / count.max(1) as f64;
    let gram = DMatrix::from_fn(count, count, |i, j| {
        -0.5 * (square(i, j) - means[i] - means[j] + total)
    });
    let trace = gram.trace();
    let mut coordinates = vec![0.0; count * dimension];
    let mut kept = 0.0;
    if count > 0 {
        let eigen = SymmetricEigen::new(gram);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        for (k, &column) in order.iter().take(dimension).enumerate() {
            let value = eigen.eigenvalues[column].max(0.0);
            kept += value;
            for i in 0..count {
                coordinates[i * dimension + k] = value.sqrt() * eigen.eigenvectors[(i, column)];
            }
        }
    }
    let lost = if trace > 0.0 { 1.0 - kept / trace } else { 0.0 };
    Chart {
        dimension,
        coordinates,
        distortion: lost.clamp(0.0, 1.0),
    }
}

impl LocalChart for Twin {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        let sound = distances.len() == count * count && distances.iter().all(|d| d.is_finite());
        if !sound {
            if self.0 == Fault::Open {
                return Ok(scaled(0, &[], dimension, 2));
            }
            return Err(Error::Shape {
                found: format!("{} distances", distances.len()),
                expected: format!("{count} x {count} finite ones"),
            });
        }
        let mut chart = scaled(count, distances, dimension, 2);
        match self.0 {
            Fault::None | Fault::Open => {}
            Fault::Overflowing => {
                let greatest = distances.iter().fold(0.0, |m: f64, d| m.max(*d));
                chart
                    .coordinates
                    .iter_mut()
                    .for_each(|x| *x = *x / greatest * greatest);
            }
            Fault::NotSquared => chart = scaled(count, distances, dimension, 1),
            Fault::NeverDistorted => chart.distortion = 0.0,
            Fault::Kept => chart.distortion = 1.0 - chart.distortion,
            Fault::Anchored => {
                // Off by what is lost, in the last point.
                if let Some(last) = chart.coordinates.last_mut() {
                    *last *= 1.0 + chart.distortion;
                }
            }
            Fault::Remembering => {
                let calls = self.1.fetch_add(1, Ordering::Relaxed);
                let turned = if calls.is_multiple_of(2) { 1.0 } else { -1.0 };
                chart.coordinates.iter_mut().for_each(|x| *x *= turned);
            }
        }
        Ok(chart)
    }
    fn name(&self) -> &str {
        "twin"
    }
}

#[test]
fn every_fault_is_caught_by_its_law() {
    let put = |fault| chart(&quick(), &Twin(fault, AtomicUsize::new(0)));
    let faults: &[(Fault, &Law)] = &[
        (Fault::Overflowing, &FINITE),
        (Fault::Open, &REFUSAL),
        (Fault::NotSquared, &FLAT),
        (Fault::NeverDistorted, &DISTORTION),
        (Fault::Kept, &DISTORTION),
        (Fault::Anchored, &MOTION),
        (Fault::Remembering, &MOTION),
    ];
    each_is_caught(put, Fault::None, faults);
}
