use super::*;

type Generator = fn(&mut Draw) -> Instance;

#[test]
fn instances_are_what_they_say() {
    let all: [(Generator, usize, usize); 11] = [
        (flat_sheet, 3, 1),
        (two_planes, 3, 4),
        (boundary, 3, 1),
        (boundary_corner, 3, 1),
        (y_junction, 3, 3),
        (t_junction, 3, 3),
        (triple_point, 3, 12),
        (crossing_in_four_dimensions, 4, 2),
        (line_through_plane, 3, 3),
        (line_on_plane, 3, 2),
        (curve, 3, 1),
    ];
    for (generator, dimension, strata) in all {
        let instance = generator(&mut Draw::new(7, 400));
        assert_eq!(instance, generator(&mut Draw::new(7, 400)));
        assert_ne!(instance, generator(&mut Draw::new(8, 400)));
        assert_eq!((instance.dimension, instance.len()), (dimension, 401));
        let norm = |k: usize| instance.local().point(k).iter().map(|x| x * x).sum::<f64>();
        assert!((0..instance.fitted).all(|k| norm(k) < 1.0));
        assert!((instance.fitted..401).all(|k| norm(k) >= 1.0));
        assert!(
            instance.fitted > 150 && instance.fitted < 395,
            "{}",
            instance.fitted
        );
        let mut found: Vec<u8> = instance.truth.iter().copied().flatten().collect();
        found.sort_unstable();
        found.dedup();
        assert_eq!(found, (0..strata as u8).collect::<Vec<_>>());
    }
}

#[test]
fn a_range_without_numbers_gives_its_lower_end() {
    let mut draw = Draw::new(1, 0);
    assert_eq!(draw.between(0.5, 0.5), 0.5);
    assert_eq!(draw.between(0.5, -1.0), 0.5);
    assert!((0.5..0.6).contains(&draw.between(0.5, 0.6)));
}

#[test]
fn noise_has_the_size_that_is_asked_for() {
    let exact = flat_sheet(&mut Draw::new(1, 500));
    let noisy = exact.with_noise(3, 0.02);
    let off: f64 = (0..noisy.len())
        .map(|k| noisy.local().point(k)[2].powi(2))
        .sum();
    let deviation = (off / noisy.len() as f64).sqrt();
    assert!((deviation - 0.02).abs() < 0.002, "{deviation}");
}

#[test]
fn principal_coordinates_keep_distances() {
    let raw = two_planes(&mut Draw::new(2, 60));
    let turned = raw.principal();
    let squared =
        |i: &Instance, a, b| crate::squared_distance(i.local().point(a), i.local().point(b));
    for k in 1..raw.len() {
        assert!((squared(&raw, 0, k) - squared(&turned, 0, k)).abs() < 1e-12);
    }
    for axis in 0..3 {
        let mean: f64 = (0..raw.fitted).map(|k| turned.local().point(k)[axis]).sum();
        assert!(mean.abs() < 1e-9);
    }
}
