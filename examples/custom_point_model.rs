//! A singularity model of one's own, from the first line to a surface: two cones that meet in their apex.
//!
//! `cargo run --release --example custom_point_model`

use crosscap::algorithms::surfaces::Random;
use crosscap::prelude::*;
use crosscap_core::laws::{self, Draw, Instance, Instances, Settings};
use crosscap_core::{Decomposition, Label, LocalPoints, Rejection, Stratum};
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};
use std::f64::consts::{PI, TAU};

/// A quadric cone, both halves of it.
struct DoubleCone {
    /// Largest root mean squared distance of the points to the cone, unit of the data.
    dp: f64,
    /// Points closer than this to the apex are the apex, unit of the data.
    ep: f64,
}

struct Cone {
    apex: Vector3<f64>,
    form: Matrix3<f64>,
    axis: Vector3<f64>,
}

const LEAST: usize = 20;
/// Least eigenvalue of a cone, as a share of the largest: below it is a pair of planes.
const SHARPNESS: f64 = 0.05;

impl Cone {
    /// The quadric whose equation the points satisfy best, if it is a cone.
    fn fit(points: &[Vector3<f64>], radius: f64) -> Option<Self> {
        let mut normal = SMatrix::<f64, 10, 10>::zeros();
        for p in points {
            let [x, y, z] = [p.x / radius, p.y / radius, p.z / radius];
            let row = SVector::<f64, 10>::from([
                x * x,
                y * y,
                z * z,
                2.0 * x * y,
                2.0 * x * z,
                2.0 * y * z,
                2.0 * x,
                2.0 * y,
                2.0 * z,
                1.0,
            ]);
            normal += row * row.transpose();
        }
        let eigen = SymmetricEigen::new(normal);
        let a = eigen.eigenvectors.column(eigen.eigenvalues.imin());
        let form = Matrix3::new(a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2]);
        let apex = -form.try_inverse()? * Vector3::new(a[6], a[7], a[8]) * radius;
        let eigen = SymmetricEigen::new(form);
        let values = eigen.eigenvalues;
        let size = values.amax();
        if values.iter().any(|v| v.abs() < SHARPNESS * size) {
            return None;
        }
        // The axis is the direction whose sign is alone.
        let positive = values.iter().filter(|&&v| v > 0.0).count();
        let alone = |v: f64| match positive {
            1 => v > 0.0,
            2 => v < 0.0,
            _ => false,
        };
        let k = (0..3).find(|&k| alone(values[k]))?;
        Some(Self {
            apex,
            form,
            axis: eigen.eigenvectors.column(k).into(),
        })
    }

    /// To first order.
    fn distance(&self, p: &Vector3<f64>) -> f64 {
        let y = p - self.apex;
        let gradient = 2.0 * (self.form * y).norm();
        if gradient > 0.0 {
            (y.dot(&(self.form * y)) / gradient).abs()
        } else {
            0.0
        }
    }
}

impl DoubleCone {
    /// 0 for the apex, 1 and 2 for the halves.
    fn label(&self, cone: &Cone, p: &Vector3<f64>) -> u8 {
        let y = p - cone.apex;
        if y.norm() < self.ep {
            0
        } else if cone.axis.dot(&y) > 0.0 {
            1
        } else {
            2
        }
    }
}

impl SingularityModel for DoubleCone {
    fn local_dimension(&self) -> usize {
        3
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        if local.fitted < LEAST {
            return Err(Rejection::TooFewPoints {
                found: local.fitted,
                needed: LEAST,
            });
        }
        let points: Vec<Vector3<f64>> = (0..local.len())
            .map(|k| Vector3::from_column_slice(local.point(k)))
            .collect();
        let fitted = &points[..local.fitted];
        let cone = Cone::fit(fitted, local.radius).ok_or(Rejection::NoRealSolution)?;
        if cone.apex.norm() > local.radius {
            return Err(Rejection::NoRealSolution);
        }
        let squares: f64 = fitted.iter().map(|p| cone.distance(p).powi(2)).sum();
        let residual = (squares / fitted.len() as f64).sqrt();
        if residual.is_nan() || residual > self.dp {
            return Err(Rejection::PoorFit {
                residual,
                limit: self.dp,
            });
        }
        let labels: Vec<u8> = points.iter().map(|p| self.label(&cone, p)).collect();
        for cell in [1, 2] {
            let found = labels[..local.fitted]
                .iter()
                .filter(|&&l| l == cell)
                .count();
            if found < LEAST / 4 {
                return Err(Rejection::EmptyStratum {
                    stratum: cell as usize,
                    found,
                });
            }
        }
        let here = points[local.center];
        let at_apex = labels[local.center] == 0;
        let (center, center_offset) = if at_apex {
            (cone.apex, (here - cone.apex).norm())
        } else {
            (here, f64::INFINITY)
        };
        Ok(Decomposition {
            strata: [0, 2, 2].map(|dimension| Stratum { dimension }).to_vec(),
            labels: labels.into_iter().map(Label::from).collect(),
            cells_at_curve: vec![],
            residual,
            parameters: 8,
            points: vec![cone.apex.iter().copied().collect()],
            center: center.iter().copied().collect(),
            center_offset,
        })
    }

    fn name(&self) -> &str {
        "double-cone"
    }
}

/// Both halves of an elliptic cone.
fn cone(draw: &mut Draw) -> Instance {
    let (a, b) = (draw.between(0.8, 2.0), draw.between(0.8, 2.0));
    let mut points = vec![(vec![0.0; 3], None)];
    for _ in 0..draw.points {
        // Uniform on a disc, lifted: denser away from the apex, as area is.
        let [x, y] = draw.disc().map(|c| 1.3 * c);
        let up = draw.between(-1.0, 1.0) > 0.0;
        let z = ((x / a).powi(2) + (y / b).powi(2)).sqrt();
        let stratum = (z > 0.2).then_some(u8::from(up));
        points.push((vec![x, y, if up { z } else { -z }], stratum));
    }
    Instance::new(3, 1.0, &points)
}

/// Two closed surfaces that touch in a cone point: z = sin t, at the radius |sin 2t| from the axis, for t from
/// -pi/2 to pi/2. Uniform by area.
fn hourglass(count: usize, seed: u64) -> Result<PointCloud<f64>, Error> {
    let mut random = Random::new(seed);
    let mut rows = Vec::with_capacity(3 * count);
    while rows.len() < 3 * count {
        let t = PI * (random.uniform() - 0.5);
        let r = (2.0 * t).sin().abs();
        // Area of a ring: circumference times slant height, at most sqrt(5) of the unit.
        let area = r * (2.0 * (2.0 * t).cos()).hypot(t.cos());
        if random.uniform() * 5_f64.sqrt() < area {
            let (sin, cos) = random.between(0.0, TAU).sin_cos();
            rows.extend([r * cos, r * sin, t.sin()]);
        }
    }
    PointCloud::new(3, rows)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In a crate of your own this is a test.
    let model = DoubleCone { dp: 0.2, ep: 0.1 };
    laws::model(&Settings::default(), &model, &Instances::new(&cone))?;
    println!("{} obeys the laws of SingularityModel", model.name());

    let points = hourglass(20_000, 0)?;
    let model = DoubleCone { dp: 0.03, ep: 0.06 };
    let outcome = Pipeline::new(Parameters::new(0.3, 0.12))?
        .models(vec![Box::new(model)])
        .reconstruct(&points)?;
    println!(
        "verified: {}, Betti numbers {:?}",
        outcome.is_verified(),
        outcome.homology.betti_rational
    );
    assert!(outcome.is_verified());
    assert_eq!(outcome.homology.betti_rational, [1, 0, 2]);
    // Two spheres. There is one point in which sheets touch.
    println!("{}", outcome.pieces?);
    Ok(())
}
