//! How far points scatter across the surface that they were sampled from.

use super::sheet_fit::{SheetFit, TERMS};
use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crate::tuning::NoiseTuning;
use crosscap_core::{PointCloud, Scalar};
use std::f64::consts::PI;

/// Twice the points let the square of what a quadratic leaves of a smooth surface grow so many times:
/// the third order of the radius, whose square is the number of points.
const GROWTH: f64 = 8.0;

/// The noise of a cloud: the standard deviation of its points across the surface.
///
/// At 400 places sheets (quadratic heights) are laid through the 24, 48, 96, 192 and 384 nearest points. The
/// scatter about them, unbiased for the six coefficients that were fitted, is the noise plus what the
/// surface bends beyond the second order. The latter grows eightfold in its square from one
/// size to the next and the noise does not, so that two sizes tell them apart. The least size is used at
/// which the neighborhood is thin: a ball as small as the noise has no normal.
///
/// Noise is everywhere, and creases and crossings are not, so that the scatter is read where it is small: at the
/// lower quartile of the places, which for noise alone is a known part of the whole (`at_lower_quartile`). (Of a prism of
/// 2,000 points more than half of the places have a crease among their 24 nearest points, and the median took it for noise.)
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Noise {
    /// Standard deviation in each direction normal to the surface, unit of the data.
    pub deviation: f64,
    /// Spacing of the points along the surface, unit of the data: the root of the area for each, where the
    /// noise does not count as an extent.
    pub spacing: f64,
    /// Number of points of the sheets that it was read from.
    pub neighbors: usize,
}

/// Squares of scatter and extent at one place, by size.
type Reading = [Option<[f64; 2]>; 5];

impl Noise {
    /// Of a cloud; `None` where it is thin at none of the sizes (noise that hides the surface, or no
    /// surface), has no direction normal to a surface, or fewer than 48 points. O(n log n) distances and 2,000 fits.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        tuning: &NoiseTuning,
        execute: &dyn Execute,
    ) -> Option<Self> {
        let n = cloud.dimension();
        // No neighborhood is more than a third of the cloud.
        let sizes = tuning
            .sizes
            .iter()
            .filter(|&&k| 3 * k <= cloud.len())
            .count();
        if n < 3 || sizes == 0 {
            return None;
        }
        let places = cloud.cast::<f64>();
        let tree = BallTree::new(n, places.coordinates());
        let most = tuning.sizes[sizes - 1];
        let stride = cloud.len().div_ceil(tuning.places).max(1) as u32;
        let readings = tree.nearest_of_each(
            most,
            |row| row % stride == 0,
            execute,
            |_, near| read(&places, near, tuning.sizes),
        );
        let values = |size: usize, which: usize| {
            let values = readings.iter().filter_map(|r| r[size].map(|x| x[which]));
            values.collect::<Vec<f64>>()
        };
        let scatter = |size: usize| {
            let low = quantile(values(size, 0), 0.25)?;
            Some(low / at_lower_quartile(freedom(tuning.sizes[size], n)))
        };
        for (size, &neighbors) in tuning.sizes.iter().enumerate().take(sizes) {
            let usual = [0, 1].map(|which| quantile(values(size, which), 0.5));
            let (Some(scattered), [Some(thickness), Some(extent)]) = (scatter(size), usual) else {
                continue;
            };
            // Half of the neighborhoods are thin, or this is no surface.
            if thickness > tuning.thin * tuning.thin * extent {
                continue;
            }
            let wider = (size + 1 < sizes).then(|| scatter(size + 1)).flatten();
            let square = wider.map_or(scattered, |w| (GROWTH * scattered - w) / (GROWTH - 1.0));
            return Some(Self {
                deviation: square.max(0.0).sqrt(),
                // The mean square of the distances from the middle of a disc is half of its radius squared.
                spacing: (2.0 * PI * extent / neighbors as f64).sqrt(),
                neighbors,
            });
        }
        None
    }

    /// The deviation in units of the spacing along the surface.
    pub fn of_spacing(&self) -> f64 {
        self.deviation / self.spacing
    }
}

/// The value below which that share of them lies.
fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values.get((share * values.len() as f64) as usize).copied()
}

/// How many numbers the scatter about a sheet of so many points is the mean of.
fn freedom(points: usize, dimension: usize) -> usize {
    (points - TERMS) * (dimension - 2)
}

/// Lower quartile of the mean of the squares of so many normal deviates of variance 1: the chi-square distribution by the
/// cube of a normal one (Wilson and Hilferty, "The distribution of chi-square", 1931).
fn at_lower_quartile(freedom: usize) -> f64 {
    const QUARTILE: f64 = -0.674_489_750_196_082;
    let variance = 2.0 / (9.0 * freedom as f64);
    (1.0 - variance + QUARTILE * variance.sqrt()).powi(3)
}

/// Scatter and extent about one place, for each size.
fn read(places: &PointCloud<f64>, near: &[Near], sizes: [usize; 5]) -> Reading {
    let n = places.dimension();
    let mut near = near.to_vec();
    near.sort_unstable();
    let mut fit = SheetFit::new(n);
    let (mut points, mut offset) = (Vec::new(), Vec::new());
    for x in &near {
        points.extend_from_slice(places.point(x.index() as usize));
    }
    let weights = vec![1.0; near.len()];
    sizes.map(|size| {
        if size > near.len() || !fit.fit(&points[..size * n], &weights[..size]) {
            return None;
        }
        let own = points[..size * n].chunks_exact(n);
        let sum: f64 = own
            .map(|x| fit.distance(x, f64::INFINITY, &mut offset).powi(2))
            .sum();
        Some([sum / freedom(size, n) as f64, fit.extent().powi(2)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{SampleSurface, Sampling, embed};

    fn sample(name: &str, noise: f64) -> PointCloud<f64> {
        let sampling = Sampling {
            noise,
            ..Sampling::new(4000, 3)
        };
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(&sampling).unwrap().points
    }

    #[test]
    fn noise_is_measured_from_a_tenth_of_the_spacing_to_more_than_it() {
        for name in ["sphere", "torus", "two_spheres", "moebius"] {
            for noise in [0.005, 0.02, 0.08] {
                let found =
                    Noise::of(&sample(name, noise), &NoiseTuning::MEASURED, &Serial).unwrap();
                let ratio = found.deviation / noise;
                assert!((0.8..1.25).contains(&ratio), "{name} {noise}: {found:?}");
            }
        }
    }

    #[test]
    fn bending_is_no_noise() {
        for name in [
            "sphere",
            "torus",
            "two_spheres",
            "klein_r5",
            "double_bubble",
            "boy_surface",
        ] {
            let found = Noise::of(&sample(name, 0.0), &NoiseTuning::MEASURED, &Serial).unwrap();
            assert!(found.of_spacing() < 0.05, "{name}: {found:?}");
        }
    }

    #[test]
    fn creases_are_no_noise_and_hide_none() {
        for (name, count) in [
            ("cube", 800),
            ("octahedron", 1200),
            ("can", 900),
            ("open_box", 1000),
        ] {
            let sampling = |noise| Sampling {
                noise,
                ..Sampling::new(count, 3)
            };
            let surface = SampleSurface::find(name).unwrap();
            let read = |noise| {
                let points = surface.sample(&sampling(noise)).unwrap().points;
                Noise::of(&points, &NoiseTuning::MEASURED, &Serial).unwrap()
            };
            let clean = read(0.0);
            assert!(clean.of_spacing() < 0.06, "{name}: {clean:?}");
            let noise = 0.3 * clean.spacing;
            let ratio = read(noise).deviation / noise;
            assert!((0.8..1.3).contains(&ratio), "{name}: {ratio}");
        }
    }

    #[test]
    fn every_direction_counts_for_itself() {
        let wide = embed(&sample("torus", 0.0), 8, 1).unwrap();
        let mut random = crate::surfaces::Random::new(1);
        let noisy = wide
            .coordinates()
            .iter()
            .map(|x| x + 0.03 * random.normal());
        let noisy = PointCloud::new(8, noisy.collect()).unwrap();
        let found = Noise::of(&noisy, &NoiseTuning::MEASURED, &Serial).unwrap();
        assert!((found.deviation / 0.03 - 1.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn a_ball_has_no_surface() {
        let mut random = crate::surfaces::Random::new(2);
        let rows = (0..6000).map(|_| random.between(-1.0, 1.0)).collect();
        assert!(
            Noise::of(
                &PointCloud::new(3, rows).unwrap(),
                &NoiseTuning::MEASURED,
                &Serial
            )
            .is_none()
        );
        assert!(
            Noise::of(
                &PointCloud::new(2, vec![0.5; 400]).unwrap(),
                &NoiseTuning::MEASURED,
                &Serial
            )
            .is_none()
        );
    }
}
