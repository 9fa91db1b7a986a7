//! The subspace that holds a cloud, where all other directions are noise.

use crate::principal::PrincipalFrame;
use crate::tuning::SubspaceTuning;
use crosscap_core::{PointCloud, Scalar};

/// A linear subspace of R^N that holds a cloud but for noise of the same size in every other direction.
///
/// Measured coordinates are often many more than the shape needs, and each brings its own noise: in 100 directions normal
/// to a surface noise of a hundredth is a tenth. The variances along the principal axes show it: those of m directions of noise lie
/// between (1 - r)^2 and (1 + r)^2 of its square, with r^2 = m / n for n points (Marchenko and Pastur 1967), and the first that does not is
/// far above them. Within the subspace distances are those of R^N, so nothing else changes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Subspace {
    /// Standard deviation of the points in each direction out of the subspace, unit of the data.
    pub deviation: f64,
    mean: Vec<f64>,
    /// Orthonormal axes, N numbers each.
    axes: Vec<f64>,
}

impl Subspace {
    /// The subspace of a cloud; none where no directions are noise alone, or they cannot be told from the others.
    ///
    /// O(k N^2 + N^3) for k points of those that are looked at.
    pub fn of<S: Scalar>(cloud: &PointCloud<S>, tuning: &SubspaceTuning) -> Option<Self> {
        let width = cloud.dimension();
        let step = cloud.len().div_ceil(tuning.points).max(1);
        let count = cloud.len().div_ceil(step);
        if width < 2 + tuning.least_rest
            || width > tuning.most_coordinates
            || count < tuning.points_for_coordinate * width
        {
            return None;
        }
        let frame = PrincipalFrame::of(cloud, (0..cloud.len()).step_by(step));
        let variances = &frame.variances;
        let held = (2..=width - tuning.least_rest)
            .find(|&k| is_noise(&variances[k..], count, tuning.spare))?;
        let rest = &variances[held..];
        let told = variances[held - 1] > tuning.gap * rest[0];
        let mean_square = rest.iter().sum::<f64>() / rest.len() as f64;
        told.then(|| Self {
            deviation: mean_square.sqrt(),
            axes: frame.axes[..held * width].to_vec(),
            mean: frame.mean,
        })
    }

    /// Its dimension.
    pub fn dimension(&self) -> usize {
        self.axes.len() / self.mean.len()
    }

    /// Root mean square of the distances of the points from it, unit of the data.
    pub fn scatter(&self) -> f64 {
        self.deviation * ((self.mean.len() - self.dimension()) as f64).sqrt()
    }

    /// The points of a cloud of R^N in the coordinates of the subspace, each at the place in it that is nearest.
    pub fn project<S: Scalar>(&self, cloud: &PointCloud<S>) -> PointCloud<S> {
        let width = self.mean.len();
        let mut numbers = Vec::with_capacity(cloud.len() * self.dimension());
        for place in cloud.iter() {
            for axis in self.axes.chunks_exact(width) {
                let along = place.iter().zip(&self.mean).zip(axis);
                numbers.push(S::of(along.map(|((x, m), a)| (x.as_f64() - m) * a).sum()));
            }
        }
        PointCloud::new(self.dimension(), numbers).expect("finite numbers, as many as coordinates")
    }

    /// The place in R^N of one in the coordinates of the subspace.
    pub fn lift(&self, place: &[f64]) -> Vec<f64> {
        let mut out = self.mean.clone();
        for (x, axis) in place.iter().zip(self.axes.chunks_exact(self.mean.len())) {
            for (y, a) in out.iter_mut().zip(axis) {
                *y += x * a;
            }
        }
        out
    }
}

/// Whether variances, largest first, are those of one noise in all directions, up to a factor of `spare`.
fn is_noise(variances: &[f64], points: usize, spare: f64) -> bool {
    let root = (variances.len() as f64 / points as f64).sqrt();
    let widest = ((1.0 + root) / (1.0 - root)).powi(2) * spare;
    match (variances.first(), variances.last()) {
        (Some(&most), Some(&least)) => least > 0.0 && most <= widest * least,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::{
        Random, RingConformations, RingGeometry, SampleSurface, Sampling, embed,
    };

    fn noisy(name: &str, width: usize, deviation: f64) -> PointCloud<f64> {
        let surface = SampleSurface::find(name).unwrap();
        let sample = surface.sample(&Sampling::new(3000, 1)).unwrap().points;
        let wide = embed(&sample, width, 2).unwrap();
        let mut random = Random::new(3);
        let numbers = wide
            .coordinates()
            .iter()
            .map(|x| x + deviation * random.normal());
        PointCloud::new(width, numbers.collect()).unwrap()
    }

    #[test]
    fn finds_the_subspace_and_the_noise() {
        for (name, held) in [("torus", 3), ("klein_r5", 5), ("planes_r4", 4)] {
            for width in [20, 60] {
                let cloud = noisy(name, width, 0.01);
                let found = Subspace::of(&cloud, &SubspaceTuning::MEASURED).unwrap();
                assert_eq!(found.dimension(), held, "{name} in R^{width}");
                assert!((found.deviation - 0.01).abs() < 3e-4, "{}", found.deviation);
                let inside = found.project(&cloud);
                let mut sum = 0.0;
                for (place, own) in cloud.iter().zip(inside.iter()) {
                    let lifted = found.lift(own);
                    sum += crosscap_core::squared_distance(place, &lifted);
                }
                let scatter = (sum / cloud.len() as f64).sqrt();
                assert!((scatter - found.scatter()).abs() < 0.01 * scatter);
            }
        }
    }

    #[test]
    fn places_in_the_subspace_stay() {
        let cloud = noisy("torus", 30, 0.02);
        let found = Subspace::of(&cloud, &SubspaceTuning::MEASURED).unwrap();
        let inside = found.project(&cloud);
        let lifted: Vec<f64> = inside.iter().flat_map(|x| found.lift(x)).collect();
        let again = found.project(&PointCloud::new(30, lifted).unwrap());
        for (a, b) in inside.iter().zip(again.iter()) {
            assert!(crosscap_core::squared_distance(a, b) < 1e-20);
        }
        let apart = (inside.squared_distance(0, 1)).sqrt();
        let lifted = crosscap_core::squared_distance(
            &found.lift(inside.point(0)),
            &found.lift(inside.point(1)),
        );
        assert!((apart - lifted.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn where_no_direction_is_noise_alone_there_is_none() {
        // No noise; too few directions for noise to show; a surface that bends into all of its directions; noise alone.
        let mut seven = RingGeometry::regular(7, 1.52, 115.0);
        seven.bond_angles[0] = None;
        let ring = RingConformations::of(&seven).unwrap();
        let rings = ring.sample(2000, 1).unwrap().points;
        let clouds = [noisy("torus", 20, 0.0), noisy("torus", 5, 0.01), rings];
        for cloud in &clouds {
            let found = Subspace::of(cloud, &SubspaceTuning::MEASURED);
            assert!(found.is_none_or(|found| found.deviation < 1e-12));
        }
        let mut random = Random::new(4);
        let numbers: Vec<f64> = (0..20 * 1000).map(|_| random.normal()).collect();
        let ball = PointCloud::new(20, numbers).unwrap();
        assert!(Subspace::of(&ball, &SubspaceTuning::MEASURED).is_none());
    }
}
