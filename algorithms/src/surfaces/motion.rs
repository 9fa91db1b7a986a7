//! Rigid motions, scalings and isometric embeddings: a result must not depend on them.

use super::Random;
use crosscap_core::{Error, PointCloud};

/// Embeds a cloud isometrically into R^`dimension`, along a random orthonormal frame of `seed`.
///
/// # Errors
/// [`Error::Parameter`] when `dimension` is below that of the cloud.
///
/// ```
/// use crosscap_algorithms::surfaces::embed;
/// use crosscap_core::PointCloud;
/// let cloud = PointCloud::new(2, vec![0.0, 0.0, 3.0, 4.0]).unwrap();
/// let wide = embed(&cloud, 10, 1).unwrap();
/// assert!((wide.squared_distance(0, 1) - 25.0).abs() < 1e-12);
/// ```
pub fn embed(
    cloud: &PointCloud<f64>,
    dimension: usize,
    seed: u64,
) -> Result<PointCloud<f64>, Error> {
    if dimension < cloud.dimension() {
        return Err(Error::Parameter {
            name: "dimension",
            value: dimension.to_string(),
            expected: format!(
                "at least {}, the dimension of the points",
                cloud.dimension()
            ),
        });
    }
    let frame = orthonormal_frame(cloud.dimension(), dimension, &mut Random::new(seed));
    PointCloud::new(dimension, combine(cloud, &frame, &vec![0.0; dimension]))
}

/// A rotation (or rotation and reflection) followed by a translation, of R^N.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidMotion {
    frame: Vec<Vec<f64>>,
    shift: Vec<f64>,
}

impl RigidMotion {
    /// A random motion of R^`dimension`, its orthogonal part uniform over all (Haar), its
    /// translation normal with standard deviation `reach` on every axis.
    pub fn random(dimension: usize, reach: f64, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let frame = orthonormal_frame(dimension, dimension, &mut random);
        let shift = (0..dimension).map(|_| reach * random.normal()).collect();
        Self { frame, shift }
    }

    /// The moved cloud.
    ///
    /// # Errors
    /// [`Error::Shape`] for a cloud of another dimension, [`Error::NotFinite`] when coordinates overflow.
    pub fn apply(&self, cloud: &PointCloud<f64>) -> Result<PointCloud<f64>, Error> {
        if cloud.dimension() != self.shift.len() {
            return Err(Error::Shape {
                found: format!("points of R^{}", cloud.dimension()),
                expected: format!("points of R^{}", self.shift.len()),
            });
        }
        PointCloud::new(cloud.dimension(), combine(cloud, &self.frame, &self.shift))
    }
}

/// The cloud with every coordinate multiplied by `factor`.
///
/// # Errors
/// [`Error::NotFinite`] when a coordinate overflows or `factor` is not finite.
pub fn scaled(cloud: &PointCloud<f64>, factor: f64) -> Result<PointCloud<f64>, Error> {
    let coordinates = cloud.coordinates().iter().map(|x| x * factor).collect();
    PointCloud::new(cloud.dimension(), coordinates)
}

fn combine(cloud: &PointCloud<f64>, frame: &[Vec<f64>], shift: &[f64]) -> Vec<f64> {
    let mut out = Vec::with_capacity(cloud.len() * shift.len());
    for p in cloud.iter() {
        for (k, s) in shift.iter().enumerate() {
            out.push(
                s + p
                    .iter()
                    .zip(frame)
                    .map(|(x, axis)| x * axis[k])
                    .sum::<f64>(),
            );
        }
    }
    out
}

/// `count` orthonormal vectors of R^`dimension`, uniform over all such frames: normal deviates,
/// orthogonalized twice (once loses digits when a draw is nearly dependent).
fn orthonormal_frame(count: usize, dimension: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut frame: Vec<Vec<f64>> = Vec::with_capacity(count);
    while frame.len() < count {
        let mut axis: Vec<f64> = (0..dimension).map(|_| random.normal()).collect();
        for _ in 0..2 {
            for other in &frame {
                let along: f64 = axis.iter().zip(other).map(|(a, b)| a * b).sum();
                axis.iter_mut()
                    .zip(other)
                    .for_each(|(a, b)| *a -= along * b);
            }
            let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
            axis.iter_mut().for_each(|a| *a /= length);
        }
        if axis.iter().all(|a| a.is_finite()) {
            frame.push(axis);
        }
    }
    frame
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn distances_survive_motion_and_embedding(
            raw in prop::collection::vec(-5.0..5.0f64, 12), extra in 0usize..30, seed in any::<u64>(),
        ) {
            let cloud = PointCloud::new(3, raw).unwrap();
            let wide = embed(&cloud, 3 + extra, seed).unwrap();
            let moved = RigidMotion::random(3 + extra, 2.0, seed ^ 1).apply(&wide).unwrap();
            let large = scaled(&moved, 3.0).unwrap();
            for a in 0..4 {
                for b in 0..a {
                    let d = cloud.squared_distance(a, b);
                    prop_assert!((wide.squared_distance(a, b) - d).abs() < 1e-11);
                    prop_assert!((moved.squared_distance(a, b) - d).abs() < 1e-10);
                    prop_assert!((large.squared_distance(a, b) - 9.0 * d).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn refuses_too_narrow_a_space() {
        let cloud = PointCloud::new(3, vec![0.0; 3]).unwrap();
        assert!(embed(&cloud, 2, 0).is_err());
        assert!(RigidMotion::random(2, 1.0, 0).apply(&cloud).is_err());
        assert!(scaled(&cloud, f64::NAN).is_err());
    }
}
