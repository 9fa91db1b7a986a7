//! A singularity model of one's own: two planes by alternating fits.
//!
//! `cargo run --release --example custom_model`

use crosscap_core::laws::{self, Instances, Settings, instances};
use crosscap_core::{Decomposition, Label, LocalPoints, Rejection, SingularityModel, Stratum};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Two planes, each fitted to the points nearer to it, until nobody changes sides; from several starts.
pub struct AlternatingPlanes {
    /// Root mean squared distance up to which the fit is believed, unit of the data.
    pub dp: f64,
    /// A point closer than this to both planes is on the curve, unit of the data.
    pub ep: f64,
}

#[derive(Clone, Copy)]
struct Plane {
    normal: Vector3<f64>,
    offset: f64,
}

impl Plane {
    fn height(&self, x: &Vector3<f64>) -> f64 {
        self.normal.dot(x) + self.offset
    }

    fn fit(points: &[Vector3<f64>]) -> Self {
        let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let scatter: Matrix3<f64> = points
            .iter()
            .map(|x| (x - mean) * (x - mean).transpose())
            .sum();
        let eigen = SymmetricEigen::new(scatter);
        let normal: Vector3<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
        Self {
            normal,
            offset: -normal.dot(&mean),
        }
    }
}

fn nearer(planes: &[Plane; 2], x: &Vector3<f64>) -> usize {
    usize::from(planes[1].height(x).abs() < planes[0].height(x).abs())
}

/// Fits from a pair of normals; the sum of squares, and the planes.
fn alternate(points: &[Vector3<f64>], start: [Vector3<f64>; 2]) -> (f64, [Plane; 2]) {
    let mut planes = start.map(|n| Plane {
        normal: n.normalize(),
        offset: 0.0,
    });
    for _ in 0..40 {
        for k in 0..2 {
            let own: Vec<Vector3<f64>> = points
                .iter()
                .copied()
                .filter(|x| nearer(&planes, x) == k)
                .collect();
            if own.len() >= 3 {
                planes[k] = Plane::fit(&own);
            }
        }
    }
    let sum = points
        .iter()
        .map(|x| planes[nearer(&planes, x)].height(x).powi(2))
        .sum();
    (sum, planes)
}

/// The nearest place on the line in which the planes meet; none where they are nearly parallel.
fn onto_line([p, q]: &[Plane; 2], x: &Vector3<f64>) -> Option<Vector3<f64>> {
    let cosine = p.normal.dot(&q.normal);
    let square = 1.0 - cosine * cosine;
    if square < 0.02 {
        return None;
    }
    let (f, g) = (p.height(x), q.height(x));
    Some(x - p.normal * ((f - cosine * g) / square) - q.normal * ((g - cosine * f) / square))
}

impl AlternatingPlanes {
    /// Cells in cyclic order around the line, 1 to 4; 0 is the line.
    fn label(&self, planes: &[Plane; 2], x: &Vector3<f64>) -> u8 {
        let own = nearer(planes, x);
        let other = planes[1 - own].height(x);
        let farther = planes[own].height(x).abs().max(other.abs());
        match (farther < self.ep, own, other >= 0.0) {
            (true, _, _) => 0,
            (_, 0, true) => 1,
            (_, 1, true) => 2,
            (_, 0, false) => 3,
            _ => 4,
        }
    }
}

impl SingularityModel for AlternatingPlanes {
    fn local_dimension(&self) -> usize {
        3
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        if local.fitted < 16 {
            return Err(Rejection::TooFewPoints {
                found: local.fitted,
                needed: 16,
            });
        }
        let all: Vec<Vector3<f64>> = (0..local.len())
            .map(|k| Vector3::from_column_slice(local.point(k)))
            .collect();
        let points = &all[..local.fitted];
        // Pairs that are symmetric to the principal axes: no sign of an axis plays a part.
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut fits = Vec::new();
        for (i, j) in [(1, 2), (0, 2), (0, 1)] {
            for slope in [0.4, 0.7, 1.0, 1.4, 2.5] {
                let (a, b) = (axes[i], axes[j] * slope);
                fits.push(alternate(points, [a + b, a - b]));
            }
            fits.push(alternate(points, [axes[i], axes[j]]));
        }
        let (sum, planes) = fits
            .into_iter()
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .ok_or(Rejection::NoRealSolution)?;
        let residual = (sum / points.len() as f64).sqrt();
        if residual > self.dp {
            return Err(Rejection::PoorFit {
                residual,
                limit: self.dp,
            });
        }
        let labels: Vec<u8> = all.iter().map(|x| self.label(&planes, x)).collect();
        for stratum in 1..5 {
            let found = labels[..local.fitted]
                .iter()
                .filter(|&&l| l == stratum)
                .count();
            if found < 3 {
                return Err(Rejection::EmptyStratum {
                    stratum: stratum.into(),
                    found,
                });
            }
        }
        let center = all[local.center];
        let moved = onto_line(&planes, &center).ok_or(Rejection::NoRealSolution)?;
        Ok(Decomposition {
            strata: [1, 2, 2, 2, 2]
                .map(|dimension| Stratum { dimension })
                .to_vec(),
            labels: labels.into_iter().map(Label::from).collect(),
            cells_at_curve: vec![4],
            residual,
            parameters: 6,
            points: Vec::new(),
            center: moved.iter().copied().collect(),
            center_offset: (moved - center).norm(),
        })
    }

    fn name(&self) -> &str {
        "alternating-planes"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = AlternatingPlanes { dp: 0.1, ep: 0.05 };
    let settings = Settings {
        cases: 32,
        ..Settings::default()
    };
    laws::model(&settings, &model, &Instances::new(&instances::two_planes))?;
    println!("{} obeys the laws of SingularityModel", model.name());

    let instance = instances::two_planes(&mut instances::Draw::new(1, 200));
    match model.decompose(&instance.local()) {
        Ok(found) => println!(
            "residual {:.1e}, {} strata",
            found.residual,
            found.strata.len()
        ),
        Err(why) => println!("{why:?}"),
    }

    use crosscap::prelude::*;
    let sample = SampleSurface::find("two_spheres")?.sample(&Sampling::new(11_000, 2))?;
    // In a ball of 0.25 a unit sphere leaves its plane by 0.03.
    let model = AlternatingPlanes { dp: 0.04, ep: 0.04 };
    let outcome = Pipeline::new(Parameters::new(0.25, 0.15))?
        .models(vec![Box::new(model)])
        .reconstruct(&sample.points)?;
    println!(
        "verified: {}, Betti numbers {:?}",
        outcome.is_verified(),
        outcome.homology.betti_rational
    );
    println!("{}", outcome.pieces?);
    Ok(())
}
