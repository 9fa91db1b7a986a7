//! Points that lie on nothing: off the sheet of their neighbors, and alone there.

use super::LocalSpacing;
use super::off_sheet::{Judge, Judgement};
use super::scattered::scattered;
use crate::balls::BallTree;
use crate::execute::Execute;
use crate::tuning::OutlierTuning;
use crosscap_core::{PointCloud, Scalar};

/// The outliers of a cloud.
///
/// A sheet (quadratic, weighted so that points off it do not bend it) is laid through those of the 24 nearest of
/// a point that lie as densely as a surface, without the point. It is an outlier when it is farther from the sheet
/// than a spacing of the surface and than eight times the noise, unless points near it are off the sheet with
/// it: a second sheet, a crease, a boundary or a curve is no outlier. Points that are no farther from
/// the middle of their neighbors than scattered points are not looked at. A point is an outlier, too, that is so far from
/// its second nearest that chance does not explain it, or that lies among others scattered in space.
///
/// What is found is taken away and the rest looked at again, until nothing more is found.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Outliers {
    /// Rows, increasing.
    pub rows: Vec<usize>,
    /// Distance of each from the sheet of its neighbors, in spacings of the surface there; of those scattered in space the
    /// spacing of their own, in spacings of the cloud.
    pub distances: Vec<f64>,
}

impl Outliers {
    /// Looks at all points of a cloud, whose spacing is given. None are reported where it would be more than 12 % of
    /// all, as that is another kind of cloud. O(n log n) distances.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        spacing: &LocalSpacing,
        tuning: &OutlierTuning,
        execute: &dyn Execute,
    ) -> Self {
        let whole = cloud.cast::<f64>();
        let mut kept: Vec<usize> = (0..cloud.len()).collect();
        let mut found: Vec<(usize, f64)> = Vec::new();
        let mut rest = whole.clone();
        let mut own = None;
        for _ in 0..tuning.rounds {
            let new = round(&rest, own.as_ref().unwrap_or(spacing), tuning, execute);
            if new.is_empty() {
                break;
            }
            let mut out = vec![false; kept.len()];
            new.iter().for_each(|x| out[x.0] = true);
            found.extend(new.iter().map(|&(at, distance)| (kept[at], distance)));
            if found.len() as f64 > tuning.most * cloud.len() as f64 {
                return Self::default();
            }
            kept = (kept.iter().zip(&out).filter(|x| !x.1))
                .map(|x| *x.0)
                .collect();
            rest = whole.select(&kept);
            own = LocalSpacing::of(&rest, execute).ok();
            if own.is_none() {
                break;
            }
        }
        found.sort_unstable_by_key(|x| x.0);
        Self {
            rows: found.iter().map(|x| x.0).collect(),
            distances: found.iter().map(|x| x.1).collect(),
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// The outliers among the points of a cloud, with their distances.
fn round(
    cloud: &PointCloud<f64>,
    spacing: &LocalSpacing,
    tuning: &OutlierTuning,
    execute: &dyn Execute,
) -> Vec<(usize, f64)> {
    let mut out = scattered(cloud, spacing, tuning, execute);
    let suspect = |at: usize| spacing.off_center(at) > tuning.central * spacing.low(at);
    if cloud.len() <= tuning.neighbors || !(0..cloud.len()).any(suspect) {
        return out;
    }
    let tree = BallTree::new(cloud.dimension(), cloud.coordinates());
    let judged = tree.nearest_of_each(
        tuning.neighbors,
        |at| suspect(at as usize),
        execute,
        |at, near| {
            let judgement = Judge::new(cloud, spacing, tuning).judge(at as usize, near)?;
            Some((at as usize, judgement))
        },
    );
    let judged: Vec<(usize, Judgement)> = judged.into_iter().flatten().collect();
    // The noise of a place read from 24 points is now and then far too small.
    let mut scales: Vec<f64> = judged.iter().map(|x| x.1.scale).collect();
    scales.sort_unstable_by(f64::total_cmp);
    let usual = scales.get(scales.len() / 2).copied().unwrap_or(0.0);
    let limit = tuning.least_distance.max(tuning.least_deviations * usual);
    let alone = (judged.into_iter())
        .filter(|(_, x)| x.alone || x.unsupported && x.distance > limit)
        .map(|(at, x)| (at, x.distance));
    out.extend(alone);
    out.sort_unstable_by_key(|x| x.0);
    out.dedup_by_key(|x| x.0);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{Random, RigidMotion, SampleSurface, Sampling, scaled};
    use crosscap_core::squared_distance;

    fn outliers(cloud: &PointCloud<f64>) -> Outliers {
        let spacing = LocalSpacing::of(cloud, &Serial).unwrap();
        Outliers::of(cloud, &spacing, &OutlierTuning::MEASURED, &Serial)
    }

    fn sample(name: &str, sampling: &Sampling) -> PointCloud<f64> {
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(sampling).unwrap().points
    }

    /// The cloud with `count` points uniform in its bounding box behind it.
    fn with_box(cloud: &PointCloud<f64>, count: usize, seed: u64) -> PointCloud<f64> {
        let n = cloud.dimension();
        let mut low = vec![f64::INFINITY; n];
        let mut high = vec![f64::NEG_INFINITY; n];
        for row in cloud.iter() {
            for k in 0..n {
                low[k] = low[k].min(row[k]);
                high[k] = high[k].max(row[k]);
            }
        }
        let mut random = Random::new(seed);
        let mut rows = cloud.coordinates().to_vec();
        for _ in 0..count {
            rows.extend((0..n).map(|k| random.between(low[k], high[k])));
        }
        PointCloud::new(n, rows).unwrap()
    }

    #[test]
    fn clean_samples_lose_nothing() {
        // Closed, crossing, with a boundary, with three sheets, with curves, pinched, in R^5.
        for name in [
            "torus",
            "two_spheres",
            "three_spheres",
            "moebius",
            "square",
            "double_bubble",
            "line_disc",
            "roman",
            "boy_surface",
            "klein_r5",
        ] {
            let cloud = sample(name, &Sampling::new(4000, 1));
            let found = outliers(&cloud);
            assert!(found.is_empty(), "{name}: {found:?}");
        }
    }

    #[test]
    fn noise_has_tails_but_no_outliers() {
        let even = |noise: f64| Sampling {
            noise,
            ..Sampling::new(4000, 2)
        };
        for name in ["sphere", "two_spheres", "hemisphere"] {
            for noise in [0.005, 0.02, 0.06] {
                let found = outliers(&sample(name, &even(noise)));
                assert!(found.len() < 2, "{name} {noise}: {found:?}");
            }
        }
    }

    #[test]
    fn points_of_the_box_are_found() {
        for (name, share, seed) in [
            ("torus", 0.01, 1),
            ("two_spheres", 0.05, 2),
            ("moebius", 0.05, 3),
        ] {
            let clean = sample(name, &Sampling::new(4000, seed));
            let count = (share * 4000.0) as usize;
            let cloud = with_box(&clean, count, seed);
            let found = outliers(&cloud);
            let own: Vec<usize> = found.rows.iter().copied().filter(|&r| r < 4000).collect();
            assert!(own.len() <= 1, "{name}: points of the surface {own:?}");
            // Those that are left lie about as near to the surface as its points to each other.
            let spacing = LocalSpacing::of(&clean, &Serial).unwrap();
            let left: Vec<usize> = (4000..4000 + count)
                .filter(|r| found.rows.binary_search(r).is_err())
                .filter(|&r| {
                    let near = clean.iter().map(|x| squared_distance(x, cloud.point(r)));
                    near.fold(f64::INFINITY, f64::min).sqrt() > 2.0 * spacing.median()
                })
                .collect();
            // A few are kept by others that happen to be in line with them.
            assert!(left.len() * 100 <= count, "{name}: left {left:?}");
            assert!(found.len() > count / 2);
        }
    }

    #[test]
    fn sparse_parts_of_a_surface_are_no_outliers() {
        // The density falls by a factor of 100 from one end to the other.
        let mut random = Random::new(9);
        for name in ["sphere", "two_spheres"] {
            let all = sample(name, &Sampling::new(20_000, 5));
            let ends = (all.iter()).fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| {
                [l.min(x[0]), h.max(x[0])]
            });
            let kept: Vec<usize> = (0..all.len())
                .filter(|&i| {
                    let share = (all.point(i)[0] - ends[0]) / (ends[1] - ends[0]);
                    random.uniform() < 100_f64.powf(-share)
                })
                .collect();
            let found = outliers(&all.select(&kept));
            assert!(
                found.len() <= 1,
                "{name}: {} of {}",
                found.len(),
                kept.len()
            );
        }
    }

    #[test]
    fn a_far_point_is_found_wherever_the_cloud_is() {
        let clean = sample("torus", &Sampling::new(3000, 1));
        let mut rows = clean.coordinates().to_vec();
        rows.extend([100.0, 3.0, -50.0]);
        let cloud = PointCloud::new(3, rows).unwrap();
        let moved = RigidMotion::random(3, 5.0, 1).apply(&cloud).unwrap();
        for cloud in [&cloud, &moved, &scaled(&moved, 1e-7).unwrap()] {
            let found = outliers(cloud);
            assert_eq!(found.rows, [3000]);
            assert!(found.distances[0] > 500.0);
        }
    }
}
