use super::*;
use proptest::prelude::*;

/// The definition, with no shortcut.
fn scan<S: Scalar>(cloud: &PointCloud<S>, row: &[S]) -> Vec<Neighbor<S>> {
    let mut all: Vec<_> = (0..cloud.len())
        .map(|index| Neighbor {
            index,
            distance: S::of(squared_distance(row, cloud.point(index)).sqrt()),
        })
        .collect();
    all.sort_by(|a, b| {
        (a.distance, a.index)
            .partial_cmp(&(b.distance, b.index))
            .unwrap()
    });
    all
}

fn agree<S: Scalar>(cloud: PointCloud<S>, radii: &[S]) {
    let oracle = EuclideanOracle::new(cloud).unwrap();
    let cloud = oracle.cloud();
    let mut found = Vec::new();
    let mut indices = Vec::new();
    let step = (cloud.len() / 12).max(1);
    for center in (0..cloud.len()).step_by(step) {
        let all = scan(cloud, cloud.point(center));
        // Radii that are distances of the data put points exactly on the sphere.
        let ties = all.iter().step_by(7).map(|n| n.distance);
        for radius in radii.iter().copied().chain(ties) {
            let expected: Vec<_> = (all.iter().copied())
                .filter(|n| n.distance < radius)
                .collect();
            oracle.within(center, radius, &mut found);
            assert_eq!(found, expected, "center {center}, radius {radius}");
            assert!(oracle.within_of(cloud.point(center), radius, &mut found));
            assert_eq!(found, expected);
            assert_eq!(
                oracle.is_near(cloud.point(center), radius),
                !expected.is_empty()
            );
            oracle.indices_within(center, radius, &mut indices);
            indices.sort_unstable();
            let mut set: Vec<u32> = expected.iter().map(|n| n.index as u32).collect();
            set.sort_unstable();
            assert_eq!(indices, set, "center {center}, radius {radius}");
        }
        for count in [0, 1, 2, 5, cloud.len() / 2, cloud.len(), cloud.len() + 3] {
            oracle.nearest(center, count, &mut found);
            let expected = &all[..count.min(all.len())];
            assert_eq!(found, expected, "center {center}, count {count}");
        }
    }
}

/// Clouds with many equal distances: points of a small lattice, repeated, off center.
fn lattice() -> impl Strategy<Value = (usize, Vec<i32>, i32)> {
    (1_usize..=72).prop_flat_map(|n| {
        (
            Just(n),
            (1_usize..90).prop_flat_map(move |k| prop::collection::vec(-2..=2, n * k)),
            prop_oneof![Just(0), Just(1000), Just(-300_000)],
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn lattice_f64((n, c, offset) in lattice()) {
        let c = c.iter().map(|&x| f64::from(x + offset)).collect();
        agree(PointCloud::new(n, c).unwrap(), &[1.0, 2.0, 2.0_f64.sqrt(), f64::INFINITY]);
    }

    #[test]
    fn lattice_f32((n, c, offset) in lattice()) {
        let c = c.iter().map(|&x| (x + offset) as f32).collect();
        agree(PointCloud::new(n, c).unwrap(), &[1.0_f32, 2.0, 2.0_f32.sqrt(), 1e30]);
    }

    #[test]
    fn scattered(
        (n, k) in (1_usize..=72, 1_usize..120),
        seed in any::<u64>(),
        exponent in -12_i32..12,
        offset in -1e6_f64..1e6,
    ) {
        let scale = 10_f64.powi(exponent);
        let c: Vec<f64> = noise(seed).take(n * k).map(|x| (x + offset) * scale).collect();
        let radii = [0.3 * scale, scale * (n as f64 / 6.0).sqrt(), 0.0, -1.0, f64::NAN];
        let cloud = PointCloud::new(n, c).unwrap();
        let narrow = radii.map(|r| r as f32);
        agree(cloud.cast::<f32>(), &narrow);
        agree(cloud, &radii);
    }

    #[test]
    fn collinear(n in 1_usize..40, seed in any::<u64>(), shift in -1e5_f64..1e5) {
        let direction: Vec<f64> = noise(seed).take(n).collect();
        let mut c = Vec::new();
        for t in noise(!seed).take(70) {
            c.extend(direction.iter().map(|d| (5.0 * t).round() * d + shift));
        }
        agree(PointCloud::new(n, c).unwrap(), &[0.1, 1.0]);
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

#[test]
fn any_number_of_equal_points() {
    for n in [1, 3, 8, 9, 72] {
        agree(
            PointCloud::new(n, vec![7.25_f64; n * 3000]).unwrap(),
            &[1e-9, 1.0],
        );
        let mut c = vec![1.0_f32; n * 500];
        c.extend(noise(3).take(n * 200).map(|x| x as f32));
        agree(PointCloud::new(n, c).unwrap(), &[0.5, 1.0]);
    }
}

#[test]
fn many_neighbors() {
    for n in [2, 3, 12] {
        let c: Vec<f64> = noise(21).take(n * 1500).collect();
        let cloud = PointCloud::new(n, c).unwrap();
        agree(cloud.cast::<f32>(), &[0.5, 1.5]);
        agree(cloud, &[0.5, 1.5]);
    }
}

#[test]
fn extreme_scales() {
    for scale in [1e-320, 1e-200, 1e-100, 1e100, 1e149] {
        let c = noise(9).take(600).map(|x| x * scale).collect();
        agree(PointCloud::new(3, c).unwrap(), &[0.2 * scale, scale]);
    }
    let c = noise(9).take(600).map(|x| x as f32 * 1e-42).collect();
    agree(PointCloud::new(3, c).unwrap(), &[2e-43, 1e-42]);
}

#[test]
fn places_beyond_the_cloud() {
    let cloud = PointCloud::new(3, noise(5).take(900).collect()).unwrap();
    let oracle = EuclideanOracle::new(cloud.clone()).unwrap();
    let mut found = Vec::new();
    for place in [[0.1, 0.2, 0.3], [1e9, 0.0, 0.0], [1e300, 0.0, 0.0]] {
        for radius in [0.4, 1e9, 1e9 - 0.5, f64::INFINITY] {
            let mut expected = scan(&cloud, &place);
            expected.retain(|n| n.distance < radius);
            assert!(oracle.within_of(&place, radius, &mut found));
            assert_eq!(found, expected);
        }
    }
    assert!(oracle.within_of(&[f64::NAN; 3], 1.0, &mut found) && found.is_empty());
    assert!(!oracle.within_of(&[0.0; 2], 1.0, &mut found));
}

#[test]
fn empty_and_overlarge_clouds() {
    let empty = EuclideanOracle::new(PointCloud::<f64>::new(3, vec![]).unwrap()).unwrap();
    let mut found = Vec::new();
    assert!(empty.within_of(&[0.0; 3], 1.0, &mut found) && found.is_empty());
    let large = PointCloud::new(2, vec![0.0, 0.0, 1e200, 0.0]).unwrap();
    let error = EuclideanOracle::new(large).err().unwrap();
    assert!(
        error.is_input() && error.to_string().contains("row 1, column 0"),
        "{error}"
    );
}

/// `cargo test --release -p crosscap-backends time_of_a_query -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_a_query() {
    let mut uniform = noise(11);
    let mut c = Vec::new();
    while c.len() < 3 * 87_000 {
        let p = [0; 3].map(|_| uniform.next().unwrap());
        let r = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        if r < 1.0 && r > 0.0 {
            let shift = if c.len() % 2 == 0 { 0.0 } else { 2_f64.sqrt() };
            c.extend([p[0] / r + shift, p[1] / r, p[2] / r]);
        }
    }
    let oracle = EuclideanOracle::new(PointCloud::new(3, c).unwrap()).unwrap();
    let (mut found, mut indices, mut total) = (Vec::new(), Vec::new(), 0);
    let centers: Vec<usize> = (0..20_000).map(|i| (i * 7919) % 87_000).collect();
    for radius in [0.25, 0.25] {
        let start = std::time::Instant::now();
        for &center in &centers {
            oracle.within(center, radius, &mut found);
            total += found.len();
        }
        let sorted = start.elapsed().as_secs_f64() / centers.len() as f64;
        let start = std::time::Instant::now();
        for &center in &centers {
            oracle.indices_within(center, radius, &mut indices);
        }
        let plain = start.elapsed().as_secs_f64() / centers.len() as f64;
        let start = std::time::Instant::now();
        for &center in &centers {
            oracle.nearest(center, 24, &mut found);
        }
        let nearest = start.elapsed().as_secs_f64() / centers.len() as f64;
        println!(
            "{} neighbors: sorted {:.1} us, indices {:.1} us, 24 nearest {:.1} us",
            total / centers.len(),
            sorted * 1e6,
            plain * 1e6,
            nearest * 1e6
        );
        total = 0;
    }
}
