//! Coordinates from distances.
//!
//! | from | way | exact for |
//! | --- | --- | --- |
//! | [`scale_metric`] | classical scaling of a few points, all others placed by their distances to these | points of R^m, every distance known |
//! | [`scale_patches`] | classical scaling of overlapping patches, moved onto each other | points of R^m, near distances known |
//!
//! Whether the result *is* the data or only a picture of it is measured, not assumed:
//! [`Scaled::deviation`] is the largest difference to a known distance. Distances that are not
//! those of points in a Euclidean space (geodesic ones, say) have no exact places.

mod patches;
mod pivots;

pub use patches::scale_patches;
pub use pivots::{picture_of_metric, scale_metric};

use crosscap_core::PointCloud;

/// Places of points that were known by their distances.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scaled {
    /// One place a point, in the unit of the distances.
    pub places: PointCloud<f64>,
    /// Largest difference between a known distance and that of the places, unit of the data.
    pub deviation: f64,
}

/// Most dimensions that are sought.
const MOST_DIMENSIONS: usize = 64;

/// Number of leading eigenvalues (largest first) that stand out of the rounding, which shows in the
/// negative ones; at least 1.
fn significant(eigenvalues: &[f64]) -> usize {
    let top = eigenvalues.first().copied().unwrap_or(0.0);
    let noise = eigenvalues.last().map_or(0.0, |&least| -least).max(0.0);
    let limit = (4.0 * noise).max(1e-11 * top);
    let count = eigenvalues.iter().take_while(|&&v| v > limit).count();
    count.clamp(1, MOST_DIMENSIONS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::metric::{Euclidean, GivenDistances};
    use crosscap_core::{MetricSpace, Row, SparseDistances};
    use proptest::prelude::*;

    /// Points of a bumpy sheet in R^n, turned out of the axes.
    fn sheet(n: usize, bump: f64) -> PointCloud<f64> {
        let rows = (0..260).flat_map(|k| {
            let (u, v) = (f64::from(k % 20) / 5.0, f64::from(k / 20) / 5.0);
            let z = bump * ((1.3 * u).sin() + (1.7 * v).cos());
            (0..n).map(move |c| {
                let a = c as f64;
                u * (0.7 * a).cos() + v * (0.9 + 1.1 * a).sin() + z * (2.0 + 1.9 * a).cos()
            })
        });
        PointCloud::new(n, rows.collect()).unwrap()
    }

    fn near(cloud: &PointCloud<f64>, radius: f64) -> SparseDistances<f64, Row> {
        let pairs = (0..cloud.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let all = pairs.map(|(a, b)| {
            let d = cloud.squared_distance(a, b).sqrt();
            (Row::new(a), Row::new(b), d)
        });
        SparseDistances::new(cloud.len(), all.filter(|x| x.2 < radius)).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn distances_of_points_give_the_points_back(
            n in 3_usize..9, bump in 0.05_f64..1.0, unit in -20_i32..20,
        ) {
            let unit = f64::from(unit).exp2();
            let rows = sheet(n, bump).coordinates().iter().map(|x| x * unit).collect();
            let cloud = PointCloud::new(n, rows).unwrap();
            let radius = 4.0 * unit;
            let by_all = scale_metric(&Euclidean::new(cloud.clone()), usize::MAX, &Serial).unwrap();
            let by_near = scale_patches(&near(&cloud, radius), &Serial).unwrap();
            for scaled in [by_all, by_near] {
                prop_assert_eq!(scaled.places.dimension(), 3);
                prop_assert!(scaled.deviation < 1e-7 * unit, "{}", scaled.deviation / unit);
                // Also the distances that were not given.
                for (a, b) in [(0, 259), (7, 180), (19, 240)] {
                    let d = cloud.squared_distance(a, b).sqrt();
                    let found = scaled.places.squared_distance(a, b).sqrt();
                    prop_assert!((d - found).abs() < 1e-6 * unit);
                }
            }
        }
    }

    #[test]
    fn distances_of_no_points_deviate() {
        // Along a circle: no four points of a Euclidean space have these distances.
        let n = 40;
        let arc = |a: usize, b: usize| a.abs_diff(b).min(n - a.abs_diff(b)) as f64;
        let values = (0..n * n).map(|k| arc(k / n, k % n)).collect();
        let circle = GivenDistances::new(n, values).unwrap();
        let scaled = scale_metric(&circle, usize::MAX, &Serial).unwrap();
        assert!(scaled.deviation > 0.1, "{}", scaled.deviation);
        let picture = picture_of_metric(&circle, 2).unwrap();
        assert!(picture.places.dimension() <= 2);
        assert!(picture.deviation >= 0.1, "{}", picture.deviation);
        let pairs = (0..n).flat_map(|a| (0..a).map(move |b| (a, b)));
        let known = pairs.map(|(a, b)| (Row::new(a), Row::new(b), circle.distance(a, b)));
        let known = known.filter(|x| x.2 < 12.0);
        let known = SparseDistances::new(n, known).unwrap();
        let by_near = scale_patches(&known, &Serial);
        assert!(by_near.is_err() || by_near.unwrap().deviation > 0.1);
    }

    #[test]
    fn data_in_pieces_are_not_laid() {
        let cloud = sheet(3, 0.5);
        let mut rows = cloud.coordinates().to_vec();
        rows.extend(cloud.coordinates().iter().map(|x| x + 100.0));
        let both = PointCloud::new(3, rows).unwrap();
        let error = scale_patches(&near(&both, 4.0), &Serial).unwrap_err();
        assert!(error.to_string().contains("distances given"), "{error}");
    }
}
