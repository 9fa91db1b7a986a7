//! How finely the coordinates of a cloud are resolved.

use super::LocalSpacing;
use crosscap_core::{PointCloud, Scalar};

/// Values of one coordinate are on a grid when their least gap is this many times what chance leaves
/// between as many of them. The least of n gaps is exponential with mean range / n^2, so chance
/// passes this once in e^40.
const BEYOND_CHANCE: f64 = 40.0;
/// How far a gap may be from a whole number of steps, as a share of a step: 32-bit numbers that
/// stand for decimals are off by their own rounding.
const OFF_STEP: f64 = 0.05;
/// Of the gaps, the share that must be whole numbers of steps.
const WHOLE: f64 = 0.99;
/// Steps of half a spacing and more make a lattice of the cloud.
const LATTICE: f64 = 0.5;
/// Steps from a twentieth of a spacing on are noise that is seen.
const COARSE: f64 = 0.05;

/// The step that the coordinates of a cloud are multiples of: that of their number format at their
/// distance from the origin, or that of whoever rounded them.
///
/// Per coordinate the least gap between two different values. Of n values scattered over a range
/// two are as near as range / n^2; where the least gap is 40 times that and more, and gaps
/// are whole numbers of it, it is a step. Rounding to steps of h moves a point by h / sqrt 12 (root mean square)
/// a coordinate. O(N n log n).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Resolution {
    /// Largest step over the coordinates, unit of the data; that of the number format, about 1e-16
    /// of the largest coordinate, where none is seen.
    pub step: f64,
    /// The same in units of the median spacing of the points.
    pub of_spacing: f64,
}

impl Resolution {
    /// Of a cloud whose local spacing is known.
    pub fn of<S: Scalar>(cloud: &PointCloud<S>, spacing: &LocalSpacing) -> Self {
        let n = cloud.dimension();
        let largest = cloud
            .coordinates()
            .iter()
            .fold(0.0_f64, |a, x| a.max(x.as_f64().abs()));
        let format = largest * S::default_epsilon().as_f64();
        let mut values = Vec::with_capacity(cloud.len());
        let step = (0..n)
            .filter_map(|axis| {
                values.clear();
                values.extend(cloud.iter().map(|row| row[axis].as_f64()));
                step_of(&mut values)
            })
            .fold(format, f64::max);
        let median = spacing.median();
        Self {
            step,
            of_spacing: if median > 0.0 { step / median } else { 0.0 },
        }
    }

    /// Whether the points are places of a lattice (voxels, integers), as the step is half of their
    /// spacing and more.
    pub fn is_lattice(&self) -> bool {
        self.of_spacing >= LATTICE
    }

    /// Whether rounding is a noise that shows: the step is a twentieth of the spacing and more.
    pub fn is_coarse(&self) -> bool {
        self.of_spacing >= COARSE
    }
}

/// The step of the values of one coordinate, where there is one.
fn step_of(values: &mut [f64]) -> Option<f64> {
    let count = values.len();
    values.sort_unstable_by(f64::total_cmp);
    let range = values.last()? - values.first()?;
    let gaps = || values.windows(2).map(|w| w[1] - w[0]).filter(|g| *g > 0.0);
    let step = gaps().fold(f64::INFINITY, f64::min);
    let chance = range / (count as f64).powi(2);
    if !step.is_finite() || step <= BEYOND_CHANCE * chance {
        return None;
    }
    let whole = |g: f64| {
        let steps = g / step;
        (steps - steps.round()).abs() <= OFF_STEP
    };
    let all = gaps().count();
    let fit = gaps().filter(|&g| whole(g)).count();
    (fit as f64 >= WHOLE * all as f64).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{SampleSurface, Sampling};

    fn resolution<S: Scalar>(rows: Vec<S>) -> Resolution {
        let cloud = PointCloud::new(3, rows).unwrap();
        Resolution::of(&cloud, &LocalSpacing::of(&cloud, &Serial).unwrap())
    }

    fn sphere(seed: u64) -> Vec<f64> {
        let surface = SampleSurface::find("sphere").unwrap();
        let sample = surface.sample(&Sampling::new(3000, seed)).unwrap();
        sample.points.coordinates().to_vec()
    }

    #[test]
    fn full_precision_has_no_step() {
        for seed in 0..20 {
            let found = resolution(sphere(seed));
            assert!(
                found.step < 1e-15 && !found.is_coarse(),
                "{seed}: {found:?}"
            );
        }
    }

    #[test]
    fn decimals_and_integers_are_found() {
        for digits in [1, 2, 3] {
            let unit = 10f64.powi(digits);
            let rounded = sphere(1)
                .iter()
                .map(|x| (x * unit).round() / unit)
                .collect();
            let found = resolution(rounded);
            assert!(
                (found.step * unit - 1.0).abs() < 1e-6,
                "{digits}: {found:?}"
            );
            assert_eq!(found.is_coarse(), digits < 3, "{digits}: {found:?}");
            assert_eq!(found.is_lattice(), digits == 1, "{digits}: {found:?}");
        }
    }

    #[test]
    fn short_floats_far_from_the_origin_are_coarse() {
        let far: Vec<f64> = (sphere(2).iter())
            .map(|x| f64::from((x + 4e5) as f32))
            .collect();
        let found = resolution(far);
        assert_eq!(found.step, 1.0 / 32.0);
        assert!(found.is_coarse());
        let near: Vec<f32> = sphere(2).iter().map(|&x| x as f32).collect();
        assert!(!resolution(near).is_coarse());
    }
}
