use super::*;
use crate::euclidean::EuclideanOracle;
use crosscap_algorithms::metric::{BruteForceOracle, GivenDistances};
use crosscap_core::PointCloud;
use proptest::prelude::*;
use rayon::prelude::*;
use std::f64::consts::PI;

/// All shortest paths by Floyd's and Warshall's three loops.
fn floyd_warshall<S: Scalar>(metric: &GeodesicMetric<S>) -> Vec<f64> {
    let n = metric.len();
    let mut d = vec![f64::INFINITY; n * n];
    for a in 0..n {
        d[a * n + a] = 0.0;
        for (b, length) in metric.edges_of(a) {
            d[a * n + b] = length.as_f64();
        }
    }
    for k in 0..n {
        for a in 0..n {
            for b in 0..n {
                d[a * n + b] = d[a * n + b].min(d[a * n + k] + d[k * n + b]);
            }
        }
    }
    d
}

fn rule() -> impl Strategy<Value = EdgeRule> {
    prop_oneof![
        (0.1_f64..1.5).prop_map(EdgeRule::Within),
        (1_usize..7).prop_map(EdgeRule::Nearest),
    ]
}

/// Points of the plane, half of the time on a coarse grid: copies, ties and edges of length 0.
fn points() -> impl Strategy<Value = Vec<f64>> {
    (any::<bool>(), prop::collection::vec(-1.0_f64..1.0, 2..80)).prop_map(|(grid, mut c)| {
        c.truncate(c.len() / 2 * 2);
        if grid {
            c.iter_mut().for_each(|x| *x = (*x * 3.0).round() / 3.0);
        }
        c
    })
}

fn check<S: Scalar>(cloud: PointCloud<S>, rule: EdgeRule, scale: f64) -> Result<(), TestCaseError> {
    let rule = match rule {
        EdgeRule::Within(r) => EdgeRule::Within(r * scale),
        nearest => nearest,
    };
    let euclidean = EuclideanOracle::new(cloud).unwrap();
    let metric = GeodesicMetric::new(&euclidean, rule).unwrap();
    let n = metric.len();
    let reference = floyd_warshall(&metric);
    let d = |a: usize, b: usize| metric.distance(a, b).as_f64();
    let rounding = 8.0 * S::default_epsilon().as_f64();
    let mut edges = 0;
    for a in 0..n {
        for (b, length) in metric.edges_of(a) {
            edges += 1;
            let straight = euclidean.distance(a, b).as_f64();
            prop_assert!((length.as_f64() - straight).abs() <= 1e-12 * scale);
        }
        for b in 0..n {
            prop_assert_eq!(d(a, b).to_bits(), d(b, a).to_bits());
            let expected = reference[a * n + b];
            prop_assert!(
                d(a, b) == expected || (d(a, b) - expected).abs() <= n as f64 * rounding * expected,
                "{} {}: {} {}",
                a,
                b,
                d(a, b),
                expected
            );
            for c in 0..n {
                prop_assert!(d(a, c) <= (d(a, b) + d(b, c)) * (1.0 + rounding));
            }
        }
        prop_assert_eq!(d(a, a), 0.0);
    }
    prop_assert_eq!(edges, 2 * metric.report().edges);

    // The oracle, and distances in bulk, are those of the metric to the bit.
    let brute = BruteForceOracle::new(&metric);
    let (mut found, mut expected, mut row) = (vec![], vec![], vec![]);
    for center in 0..n {
        let rim = metric.distance(center, n / 2);
        for radius in [
            S::of(0.4 * scale),
            S::of(scale),
            rim,
            S::zero(),
            S::of(f64::NAN),
            S::of(f64::INFINITY),
        ] {
            metric.within(center, radius, &mut found);
            brute.within(center, radius, &mut expected);
            prop_assert_eq!(&found, &expected, "within {} of {}", radius, center);
        }
        for count in [0, 1, 2, n / 2, n, n + 1] {
            metric.nearest(center, count, &mut found);
            brute.nearest(center, count, &mut expected);
            prop_assert_eq!(&found, &expected, "{} nearest to {}", count, center);
        }
        let targets: Vec<usize> = (0..n).step_by(3).chain([center, 0]).collect();
        metric.distances_to(center, &targets, &mut row);
        let expected: Vec<S> = targets
            .iter()
            .map(|&t| metric.distance(center, t))
            .collect();
        prop_assert_eq!(&row, &expected);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn equals_all_shortest_paths(points in points(), rule in rule(), exponent in -9_i32..9) {
        let scale = 10_f64.powi(exponent);
        let cloud = |s: f64| PointCloud::new(2, points.iter().map(|x| x * s).collect()).unwrap();
        check(cloud(1.0).cast::<f32>(), rule, 1.0)?;
        check(cloud(scale), rule, scale)?;
    }

    #[test]
    fn components_are_those_of_the_distances(points in points(), rule in rule()) {
        let oracle = EuclideanOracle::new(PointCloud::new(2, points).unwrap()).unwrap();
        let metric = GeodesicMetric::new(&oracle, rule).unwrap();
        let reference = floyd_warshall(&metric);
        let n = metric.len();
        let report = metric.report();
        prop_assert_eq!(report.components.iter().map(|c| c.size).sum::<usize>(), n);
        for component in &report.components {
            let row = &reference[component.first * n..][..n];
            prop_assert_eq!(row.iter().filter(|d| d.is_finite()).count(), component.size);
            prop_assert_eq!(row.iter().position(|d| d.is_finite()), Some(component.first));
        }
        prop_assert_eq!(report.is_connected(), reference.iter().all(|d| d.is_finite()));
    }
}

fn circle(n: usize) -> EuclideanOracle<f64> {
    let c = (0..n).flat_map(|i| {
        let (sin, cos) = (2.0 * PI * i as f64 / n as f64).sin_cos();
        [cos, sin]
    });
    EuclideanOracle::new(PointCloud::new(2, c.collect()).unwrap()).unwrap()
}

/// Spread evenly over the unit sphere along a spiral of golden angles.
fn sphere(n: usize) -> PointCloud<f64> {
    let c = (0..n).flat_map(|i| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (sin, cos) = (i as f64 * PI * (3.0 - 5_f64.sqrt())).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    });
    PointCloud::new(3, c.collect()).unwrap()
}

#[test]
fn arcs_of_a_circle() {
    let oracle = circle(1000);
    let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.05)).unwrap();
    assert_eq!(metric.report().warnings(), []);
    for b in [1, 10, 250, 500, 999] {
        let arc = 2.0 * PI * b.min(1000 - b) as f64 / 1000.0;
        approx::assert_relative_eq!(metric.distance(0, b), arc, max_relative = 1e-3);
    }
}

#[test]
fn great_circles_of_a_sphere() {
    let cloud = sphere(6000);
    let oracle = EuclideanOracle::new(cloud.clone()).unwrap();
    let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.15)).unwrap();
    assert_eq!(metric.report().warnings(), []);
    let mut out = vec![];
    let points: Vec<usize> = (0..6000).step_by(211).collect();
    metric.distances_among(&points, &mut out);
    let mut total = 0.0;
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().filter(|&(j, _)| j != i) {
            let product: f64 = cloud
                .point(a)
                .iter()
                .zip(cloud.point(b))
                .map(|(x, y)| x * y)
                .sum();
            let excess = out[i * points.len() + j] / product.clamp(-1.0, 1.0).acos() - 1.0;
            assert!((-0.005..0.04).contains(&excess), "{a} {b}: {excess}");
            assert_eq!(out[i * points.len() + j], out[j * points.len() + i]);
            total += excess;
        }
    }
    assert!(total / ((points.len() * (points.len() - 1)) as f64) < 0.015);
}

#[test]
fn a_graph_that_is_too_coarse_or_falls_apart_says_so() {
    let oracle = circle(100);
    let coarse = GeodesicMetric::new(&oracle, EdgeRule::Nearest(2)).unwrap();
    assert!(
        matches!(coarse.report().warnings()[..], [GraphWarning::TooCoarse { ratio, .. }] if ratio < 1.1)
    );
    let apart = GeodesicMetric::new(&oracle, EdgeRule::Within(0.05)).unwrap();
    assert_eq!(apart.report().components.len(), 100);
    assert!(apart.distance(0, 1).is_infinite());
    let pair = PointCloud::new(1, vec![0.0, 1.0, 2.0, 50.0, 51.0]).unwrap();
    let pair =
        GeodesicMetric::new(&EuclideanOracle::new(pair).unwrap(), EdgeRule::Within(4.0)).unwrap();
    let expected = GraphWarning::Disconnected {
        count: 2,
        largest: 3,
        outside: 3,
    };
    assert_eq!(pair.report().warnings(), [expected]);
}

#[test]
fn bad_rules_and_bad_oracles_are_refused() {
    let oracle = circle(10);
    for rule in [0.0, -1.0, f64::NAN, f64::INFINITY].map(EdgeRule::Within) {
        assert!(GeodesicMetric::new(&oracle, rule).err().unwrap().is_input());
    }
    assert!(
        GeodesicMetric::new(&oracle, EdgeRule::Nearest(0))
            .err()
            .unwrap()
            .is_input()
    );

    struct Broken;
    impl NeighborhoodOracle for Broken {
        type Scalar = f64;
        fn len(&self) -> usize {
            3
        }
        fn within(&self, _: usize, _: f64, out: &mut Vec<Neighbor<f64>>) {
            *out = vec![Neighbor {
                index: 7,
                distance: 0.5,
            }];
        }
        fn nearest(&self, _: usize, _: usize, out: &mut Vec<Neighbor<f64>>) {
            *out = vec![Neighbor {
                index: 0,
                distance: f64::NAN,
            }];
        }
    }
    for rule in [EdgeRule::Within(1.0), EdgeRule::Nearest(1)] {
        assert!(matches!(
            GeodesicMetric::new(&Broken, rule),
            Err(Error::Law { .. })
        ));
    }
}

#[test]
fn empty_and_single_and_measured() {
    let empty = EuclideanOracle::new(PointCloud::<f64>::new(2, vec![]).unwrap()).unwrap();
    let empty = GeodesicMetric::new(&empty, EdgeRule::Nearest(3)).unwrap();
    assert!(empty.is_empty() && empty.report().is_connected());
    let one = EuclideanOracle::new(PointCloud::new(1, vec![4.0_f32]).unwrap()).unwrap();
    let one = GeodesicMetric::new(&one, EdgeRule::Nearest(3)).unwrap();
    assert_eq!(one.distance(0, 0), 0.0);
    // Over distances that were measured, without coordinates: the long way is cut short.
    let d = GivenDistances::new(3, vec![0.0, 1.0, 9.0, 1.0, 0.0, 1.5, 9.0, 1.5, 0.0]).unwrap();
    let metric = GeodesicMetric::new(&BruteForceOracle::new(d), EdgeRule::Within(2.0)).unwrap();
    assert_eq!(metric.distance(0, 2), 2.5);
}

#[test]
fn threads_agree() {
    let oracle = EuclideanOracle::new(sphere(800)).unwrap();
    let metric = GeodesicMetric::new(&oracle, EdgeRule::Nearest(10)).unwrap();
    let ball = |center| {
        let mut out = vec![];
        metric.within(center, 0.7, &mut out);
        out
    };
    let parallel: Vec<_> = (0..800).into_par_iter().map(ball).collect();
    assert!((0..800).all(|center| ball(center) == parallel[center]));
}

/// `cargo test -p crosscap-backends time_of_a_ball -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_a_ball() {
    let oracle = EuclideanOracle::new(sphere(43_500)).unwrap();
    let start = std::time::Instant::now();
    let metric = GeodesicMetric::new(&oracle, EdgeRule::Within(0.06)).unwrap();
    println!(
        "graph of {} edges: {:?}",
        metric.report().edges,
        start.elapsed()
    );
    let (mut out, mut total) = (vec![], 0);
    let start = std::time::Instant::now();
    for i in 0..2000 {
        metric.within(i * 7919 % 43_500, 0.264, &mut out);
        total += out.len();
    }
    println!(
        "ball of {} points: {:?}",
        total / 2000,
        start.elapsed() / 2000
    );
    let start = std::time::Instant::now();
    let sum: f64 = (0..200)
        .map(|i| metric.distance(i * 7919 % 43_500, i * 104_729 % 43_500))
        .sum();
    println!(
        "distance of {:.2}: {:?}",
        sum / 200.0,
        start.elapsed() / 200
    );
}
