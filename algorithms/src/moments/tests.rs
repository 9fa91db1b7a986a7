use super::decide::dimension_of;
use super::*;
use crate::execute::Serial;
use crate::principal::PrincipalFrame;
use crate::surfaces::{RingConformations, SampleSurface, Sampling};
use crosscap_core::squared_distance;
use proptest::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::time::Instant;

/// The rows of a ball, with no shortcut.
fn scan<S: Scalar>(cloud: &PointCloud<S>, center: usize, eps: f64) -> Vec<usize> {
    let inside = |&i: &usize| {
        S::of(squared_distance(cloud.point(center), cloud.point(i)).sqrt()) < S::of(eps)
    };
    (0..cloud.len()).filter(inside).collect()
}

/// The dimension by its definition.
fn naive<S: Scalar>(cloud: &PointCloud<S>, rows: &[usize], dt: f64) -> u32 {
    let variances = PrincipalFrame::of(cloud, rows.iter().copied()).variances;
    dimension_of(&variances, dt)
}

/// Counts, dimensions and moments of all points are those of the definition.
fn agree<S: Scalar>(cloud: &PointCloud<S>, eps: f64, dt: f64) {
    agree_at(cloud, eps, dt, 0..cloud.len());
}

/// The same for some of the points.
fn agree_at<S: Scalar>(
    cloud: &PointCloud<S>,
    eps: f64,
    dt: f64,
    rows: impl Iterator<Item = usize>,
) {
    let tree = MomentTree::new(cloud).unwrap();
    let found = tree.dimensions(eps, dt, &Serial).unwrap();
    assert_eq!(found.len(), cloud.len());
    let settled = tree.settled_dimensions(eps, dt, &Serial).unwrap();
    for (i, (a, b)) in found.iter().zip(&settled).enumerate() {
        // A ball whose share is the tolerance within rounding is not settled with others.
        assert_eq!(a.dimension, b.dimension, "point {i}, eps {eps}");
        assert!(
            a.neighbors == b.neighbors || a.dimension == 2 && a.neighbors.min(b.neighbors) >= 16
        );
    }
    let n = cloud.dimension();
    let balls = Mutex::new(vec![BallMoments::default(); cloud.len()]);
    tree.balls(eps, &Serial, &|ball| {
        balls.lock().unwrap()[ball.center] = ball.clone()
    })
    .unwrap();
    let balls = balls.into_inner().unwrap();
    for i in rows {
        let rows = scan(cloud, i, eps);
        let at = format!("point {i} of {} in R^{n}, eps {eps}", cloud.len());
        assert_eq!(found[i].neighbors as usize, rows.len(), "{at}");
        assert_eq!(balls[i].count as usize, rows.len(), "{at}");
        let dimension = naive(cloud, &rows, dt);
        assert!(
            found[i].dimension == dimension || rows.len() == 1,
            "{at}: {} not {dimension}",
            found[i].dimension
        );
        let mut expected = BallMoments::default();
        expected.sum(cloud, &rows);
        let trace: f64 = (0..n).map(|k| expected.covariance[k * n + k]).sum();
        let largest = cloud
            .coordinates()
            .iter()
            .map(|c| c.as_f64().abs())
            .fold(0.0, f64::max);
        // Places are summed about the center of a node that lies within eps,
        // so a ball of one point keeps the rounding of squares of that size.
        let rounding = 1e-28 * largest * largest + f64::EPSILON * eps * eps;
        for (a, b) in balls[i].covariance.iter().zip(&expected.covariance) {
            assert!((a - b).abs() <= 1e-10 * trace + rounding, "{at}: {a} {b}");
        }
        for (a, b) in balls[i].mean.iter().zip(&expected.mean) {
            assert!((a - b).abs() <= 1e-13 * largest.max(eps), "{at}: {a} {b}");
        }
    }
}

/// Numbers in (-1, 1) from a seed (a linear congruential generator will do).
fn noise(seed: u64) -> impl Iterator<Item = f64> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// A curved surface of `count` points in R^n, with a second sheet through it.
fn curved(n: usize, count: usize, seed: u64) -> Vec<f64> {
    let mut random = noise(seed);
    let mut rows = Vec::with_capacity(n * count);
    for i in 0..count {
        let (u, v) = (random.next().unwrap_or(0.0), random.next().unwrap_or(0.0));
        for k in 0..n {
            let wave = (1.0 + k as f64 / 3.0) * if k % 2 == 0 { u } else { v } + k as f64;
            let bend = 0.4 / (1.0 + k as f64) * wave.sin();
            rows.push(match k {
                0 => u,
                1 if i % 3 == 0 => 0.2 * v * v,
                2 if i % 3 == 0 => v,
                1 => v,
                _ => bend,
            });
        }
    }
    rows
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// With a tolerance that is the share of a ball, or the next number, the whole cloud and a part that holds the ball say what the
    /// ball says by itself.
    #[test]
    fn at_the_tolerance_a_ball_decides_alone(
        n in 2_usize..=9, seed in any::<u64>(), center in 0_usize..160, few in 2_usize..9,
    ) {
        let cloud = PointCloud::new(n, curved(n, 160, seed)).unwrap();
        let eps = 0.6;
        let rows = scan(&cloud, center, eps);
        let near = scan(&cloud, center, 1.1 * eps);
        let part: Vec<usize> = (0..cloud.len())
            .filter(|row| row % few == 0 || near.contains(row))
            .collect();
        let own = part.iter().position(|&row| row == center).unwrap();
        let part = cloud.select(&part);
        let variances = PrincipalFrame::of(&cloud, rows.iter().copied()).variances;
        let total: f64 = variances.iter().sum();
        let mut tail = total;
        for v in variances.iter().take(3) {
            tail -= v;
            let share = tail / total;
            for dt in [share, share.next_up(), share - 3e-10] {
                if !(dt > 0.0 && dt < 1.0) {
                    continue;
                }
                let expected = naive(&cloud, &rows, dt);
                for (cloud, row) in [(&cloud, center), (&part, own)] {
                    let tree = MomentTree::new(cloud).unwrap();
                    for found in [tree.dimensions(eps, dt, &Serial), tree.settled_dimensions(eps, dt, &Serial)] {
                        let found = &found.unwrap()[row];
                        prop_assert!(rows.len() == 1 || found.dimension == expected, "{dt}: {} not {expected}", found.dimension);
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Many equal distances and many equal points, exactly at the radius, off center.
    #[test]
    fn lattices(
        (n, cells) in (1_usize..=30).prop_flat_map(|n| (
            Just(n),
            (1_usize..180).prop_flat_map(move |k| prop::collection::vec(-2..=2, n * k)),
        )),
        offset in prop_oneof![Just(0), Just(1000), Just(-300_000)],
        dt in prop_oneof![Just(0.01), Just(0.05), Just(0.3)],
    ) {
        let cloud = PointCloud::new(n, cells.iter().map(|&x| f64::from(x + offset)).collect()).unwrap();
        for eps in [1.0, 2.0, 2.0_f64.sqrt(), (n as f64 * 2.0).sqrt()] {
            agree(&cloud, eps, dt);
            agree(&cloud.cast::<f32>(), eps, dt);
        }
    }

    #[test]
    fn scattered(
        (n, count) in (1_usize..=30, 1_usize..250),
        seed in any::<u64>(),
        exponent in -12_i32..12,
        offset in -1e5_f64..1e5,
        share in 0.2_f64..1.5,
    ) {
        let scale = 10_f64.powi(exponent);
        let rows = noise(seed).take(n * count).map(|x| (x + offset) * scale).collect();
        let cloud = PointCloud::new(n, rows).unwrap();
        let eps = share * scale * (n as f64 / 2.0).sqrt();
        agree(&cloud, eps, 0.05);
        agree(&cloud.cast::<f32>(), eps, 0.05);
    }

    /// Two sheets through each other: balls of hundreds of points, common nodes, complements,
    /// brackets that do and that do not settle the dimension.
    #[test]
    fn curved_sheets(
        n in 3_usize..=30, seed in any::<u64>(), eps in 0.15_f64..0.9, dt in 0.002_f64..0.3,
        shift in prop_oneof![Just(0.0), Just(1e4)],
    ) {
        let rows = curved(n, 900, seed).iter().map(|x| x + shift).collect();
        let cloud = PointCloud::new(n, rows).unwrap();
        let some = || (((seed % 10) as usize)..900).step_by(10);
        agree_at(&cloud, eps, dt, some());
        agree_at(&cloud.cast::<f32>(), eps, dt, some());
    }

    #[test]
    fn collinear(n in 1_usize..30, seed in any::<u64>(), shift in -1e3_f64..1e3) {
        let direction: Vec<f64> = noise(seed).take(n).collect();
        let mut rows = Vec::new();
        for t in noise(!seed).take(150) {
            rows.extend(direction.iter().map(|d| (9.0 * t).round() * d + shift));
        }
        agree(&PointCloud::new(n, rows).unwrap(), 2.0, 0.05);
    }
}

#[test]
fn clusters_that_are_tiny_beside_the_radius() {
    for n in [2, 3, 9] {
        let mut random = noise(5);
        let mut rows = Vec::new();
        for i in 0..600 {
            rows.extend(
                (0..n)
                    .map(|k| f64::from(i % 4 * i32::from(k == 0)) + 1e-7 * random.next().unwrap()),
            );
        }
        agree(&PointCloud::new(n, rows).unwrap(), 0.5, 0.05);
    }
}

#[test]
fn a_stray_point_far_away() {
    for n in [2, 3, 9] {
        let mut rows = curved(n, 700, 3);
        rows.extend(vec![1e9; n]);
        rows.extend(vec![-1e12; n]);
        agree(&PointCloud::new(n, rows).unwrap(), 0.4, 0.05);
    }
}

#[test]
fn more_directions_than_nodes_keep_moments_for() {
    for n in [70, 300] {
        let rows = noise(8).take(n * 120).collect();
        agree(
            &PointCloud::new(n, rows).unwrap(),
            (n as f64 * 0.66).sqrt(),
            0.05,
        );
    }
}

#[test]
fn equal_points_alone() {
    for n in [1, 3, 12] {
        let cloud = PointCloud::new(n, vec![7.25; n * 500]).unwrap();
        for found in dimensions(&cloud, 1e-9, 0.05, &Serial).unwrap() {
            assert_eq!(
                found,
                BallDimension {
                    neighbors: 500,
                    dimension: 0
                }
            );
        }
    }
}

#[test]
fn radii_of_every_magnitude() {
    for scale in [1e-130, 1e-30, 1e30, 1e130] {
        let rows = curved(3, 300, 4).iter().map(|x| x * scale).collect();
        agree(&PointCloud::new(3, rows).unwrap(), 0.5 * scale, 0.05);
    }
}

#[test]
fn balls_that_hold_everything() {
    for n in [1, 4, 7, 20] {
        let rows = noise(2).take(n * 90).collect();
        agree(&PointCloud::new(n, rows).unwrap(), 100.0, 0.05);
    }
}

/// Hands out single jobs, the last first.
struct Backwards;

impl Execute for Backwards {
    fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync)) {
        (0..count).rev().for_each(|i| job(i..i + 1));
    }
}

#[test]
fn the_order_of_the_jobs_does_not_matter() {
    let cloud = PointCloud::new(8, curved(8, 20_000, 6)).unwrap();
    let tree = MomentTree::new(&cloud).unwrap();
    let moments = |execute: &dyn Execute| {
        let sum = Mutex::new(vec![0_u64; cloud.len()]);
        tree.balls(0.1, execute, &|ball| {
            sum.lock().unwrap()[ball.center] = ball.covariance[0].to_bits()
        })
        .unwrap();
        sum.into_inner().unwrap()
    };
    assert_eq!(
        tree.dimensions(0.1, 0.05, &Serial),
        tree.dimensions(0.1, 0.05, &Backwards)
    );
    assert_eq!(moments(&Serial), moments(&Backwards));
}

#[test]
fn refuses_what_has_no_meaning() {
    let cloud = PointCloud::new(2, vec![0.0_f32; 8]).unwrap();
    for eps in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-60, 1e60] {
        let error = dimensions(&cloud, eps, 0.05, &Serial).unwrap_err();
        assert!(
            matches!(error, Error::Parameter { name: "eps", .. }),
            "{eps}: {error}"
        );
    }
    for dt in [0.0, 1.0, f64::NAN] {
        assert!(dimensions(&cloud, 1.0, dt, &Serial).is_err());
    }
    let large = PointCloud::new(2, vec![0.0, 0.0, 1e200, 0.0]).unwrap();
    let error = MomentTree::new(&large).err().unwrap();
    assert!(
        error.is_input() && error.to_string().contains("row 1, column 0"),
        "{error}"
    );
    let empty = PointCloud::<f64>::new(3, vec![]).unwrap();
    assert_eq!(dimensions(&empty, 1.0, 0.05, &Serial), Ok(vec![]));
}

/// `cargo test --release -p crosscap-algorithms time_of_the_first_step -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_the_first_step() {
    let surface = SampleSurface::find("two-spheres").unwrap();
    measure(
        "two spheres",
        &surface.sample(&Sampling::new(87_081, 1)).unwrap().points,
        0.25,
    );
    let ring = RingConformations::cyclo_octane()
        .sample(200_000, 1)
        .unwrap()
        .points;
    // As many neighbors as a fivefold sample has at 0.23.
    measure("cyclo-octane", &ring, 0.46);
}

fn measure<S: Scalar>(name: &str, cloud: &PointCloud<S>, eps: f64) {
    let start = Instant::now();
    let tree = MomentTree::new(cloud).unwrap();
    let built = start.elapsed().as_secs_f64();
    let found = tree.dimensions(eps, 0.05, &Serial).unwrap();
    let all = start.elapsed().as_secs_f64();
    let mean = found.iter().map(|f| f64::from(f.neighbors)).sum::<f64>() / found.len() as f64;
    let other = found.iter().filter(|f| f.dimension != 2).count();
    println!(
        "{name}: {} points, {mean:.0} neighbors, {other} not 2-dimensional",
        found.len()
    );
    println!("tree {built:.3} s, all {all:.3} s");
    for i in (0..cloud.len()).step_by(cloud.len() / 200) {
        let rows = scan(cloud, i, eps);
        assert_eq!(found[i].neighbors as usize, rows.len(), "point {i}");
        assert_eq!(found[i].dimension, naive(cloud, &rows, 0.05), "point {i}");
    }
}
