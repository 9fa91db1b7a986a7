//! How finely the coordinates of a cloud are resolved.

use super::LocalSpacing;
use crate::tuning::ResolutionTuning;
use crosscap_core::{PointCloud, Scalar};

/// The step that the coordinates of a cloud are multiples of: that of their number format at their
/// distance from the origin, or that of whoever rounded them.
///
/// Per coordinate the least gap between two different values. Of n values scattered over a range
/// two are as near as range / n^2; where the least gap is 40 times that and more, and gaps
/// are whole numbers of it, it is a step ([`ResolutionTuning`]). Rounding to steps of h moves a point by h / sqrt 12 (root mean square)
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
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        spacing: &LocalSpacing,
        tuning: &ResolutionTuning,
    ) -> Self {
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
                step_of(&mut values, tuning)
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
    pub fn is_lattice(&self, tuning: &ResolutionTuning) -> bool {
        self.of_spacing >= tuning.lattice
    }

    /// Whether rounding is a noise that shows: the step is a twentieth of the spacing and more.
    pub fn is_coarse(&self, tuning: &ResolutionTuning) -> bool {
        self.of_spacing >= tuning.coarse
    }
}

/// The step of the values of one coordinate, where there is one.
fn step_of(values: &mut [f64], tuning: &ResolutionTuning) -> Option<f64> {
    let count = values.len();
    values.sort_unstable_by(f64::total_cmp);
    let range = values.last()? - values.first()?;
    let gaps = || values.windows(2).map(|w| w[1] - w[0]).filter(|g| *g > 0.0);
    let step = gaps().fold(f64::INFINITY, f64::min);
    let chance = range / (count as f64).powi(2);
    if !step.is_finite() || step <= tuning.beyond_chance * chance {
        return None;
    }
    let whole = |g: f64| {
        let steps = g / step;
        (steps - steps.round()).abs() <= tuning.off_step
    };
    let all = gaps().count();
    let fit = gaps().filter(|&g| whole(g)).count();
    (fit as f64 >= tuning.whole * all as f64).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{SampleSurface, Sampling};

    const USUAL: ResolutionTuning = ResolutionTuning::MEASURED;

    fn resolution<S: Scalar>(rows: Vec<S>) -> Resolution {
        let cloud = PointCloud::new(3, rows).unwrap();
        let spacing = LocalSpacing::of(&cloud, &Serial).unwrap();
        Resolution::of(&cloud, &spacing, &USUAL)
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
                found.step < 1e-15 && !found.is_coarse(&USUAL),
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
            assert_eq!(found.is_coarse(&USUAL), digits < 3, "{digits}: {found:?}");
            assert_eq!(found.is_lattice(&USUAL), digits == 1, "{digits}: {found:?}");
        }
    }

    #[test]
    fn short_floats_far_from_the_origin_are_coarse() {
        let far: Vec<f64> = (sphere(2).iter())
            .map(|x| f64::from((x + 4e5) as f32))
            .collect();
        let found = resolution(far);
        assert_eq!(found.step, 1.0 / 32.0);
        assert!(found.is_coarse(&USUAL));
        let near: Vec<f32> = sphere(2).iter().map(|&x| x as f32).collect();
        assert!(!resolution(near).is_coarse(&USUAL));
    }
}
