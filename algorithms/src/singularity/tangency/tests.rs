use super::*;
use crate::metric::{BruteForceOracle, Euclidean};
use crate::surfaces::Random;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

type Place = [f64; 3];

/// What is seen from the row nearest to a place among so many points that `draw` makes.
fn seen(draw: impl Fn(&mut Random) -> Place, from: Place) -> Option<Tangency> {
    let random = &mut Random::new(5);
    let rows: Vec<Place> = (0..3000).map(|_| draw(random)).collect();
    near(3, &rows.concat(), &from)
}

fn near(dimension: usize, rows: &[f64], from: &[f64]) -> Option<Tangency> {
    let cloud = PointCloud::new(dimension, rows.to_vec()).unwrap();
    let off = |row: &[f64]| {
        row.iter()
            .zip(from)
            .map(|(x, y)| (x - y).powi(2))
            .sum::<f64>()
    };
    let row = (0..cloud.len())
        .min_by(|&a, &b| off(cloud.point(a)).total_cmp(&off(cloud.point(b))))
        .unwrap();
    let metric = Euclidean::new(cloud.clone());
    Tangency::near(&cloud, &BruteForceOracle::new(&metric), row)
}

fn at(random: &mut Random) -> [f64; 2] {
    [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]
}

/// One of two sheets over the square: `z = 0`, or as high above it as `gap` says.
fn over(random: &mut Random, gap: impl Fn(f64, f64) -> f64) -> Place {
    let [x, y] = at(random);
    let upper = random.between(0.0, 1.0) < 0.5;
    [x, y, if upper { gap(x, y) } else { 0.0 }]
}

#[test]
fn sheets_that_touch_in_a_point_are_seen_from_around_it() {
    let bowl = |r: &mut Random| over(r, |x, y| 0.5 * x * x + 0.8 * (y - 0.1) * (y - 0.1));
    for from in [[0.0, 0.1, 0.0], [0.3, 0.0, 0.0], [-0.2, 0.4, 0.1]] {
        let found = seen(bowl, from).unwrap();
        let off = [found.place[0], found.place[1] - 0.1, found.place[2]];
        assert!(off.iter().all(|x| x.abs() < 0.01), "{found:?}");
        assert!((found.curvatures[0] - 1.0).abs() < 0.1, "{found:?}");
        assert!((found.curvatures[1] - 1.6).abs() < 0.1, "{found:?}");
        // The gap is 0.08 there along the flatter direction.
        assert!((found.apart(0.08).unwrap() - 0.4).abs() < 0.03, "{found:?}");
    }
}

#[test]
fn sheets_that_touch_along_a_curve_are_apart_at_no_distance_from_a_place() {
    let trough = |r: &mut Random| over(r, |x, _| 0.7 * x * x);
    let found = seen(trough, [0.2, 0.3, 0.0]).unwrap();
    assert!(
        found.place[0].abs() < 0.01 && found.place[2].abs() < 0.01,
        "{found:?}"
    );
    assert_eq!(found.apart(0.1), None);
}

#[test]
fn what_does_not_touch_is_not_said_to() {
    let none = |draw: &dyn Fn(&mut Random) -> Place| {
        for from in [[0.0; 3], [0.1, 0.05, 0.0], [0.3, -0.2, 0.05]] {
            assert_eq!(seen(draw, from), None);
        }
    };
    none(&|r| over(r, |_, _| 0.0));
    // Crossings.
    for degrees in [20.0_f64, 30.0, 60.0, 90.0] {
        let (sin, cos) = (degrees / 2.0).to_radians().sin_cos();
        none(&|r| {
            let [x, y] = at(r);
            let side = if r.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
            [cos * x, y, side * sin * x]
        });
    }
    // Sheets apart, side by side or bent away from each other.
    none(&|r| over(r, |_, _| 0.06));
    none(&|r| over(r, |x, y| 0.03 + x * x + y * y));
    // Noise, and points of no surface.
    none(&|r| [at(r)[0], at(r)[1], 0.02 * r.normal()]);
    none(&|r| [at(r)[0], at(r)[1], at(r)[0]]);
    // One sheet, bent or with a crease.
    none(&|r| {
        let [x, y] = at(r);
        [x, y, 2.5 * x * x]
    });
    none(&|r| {
        let [x, y] = at(r);
        [x, y, 0.3 * (6.0 * x).sin()]
    });
    for slope in [0.2, 1.0] {
        none(&|r| {
            let [x, y] = at(r);
            [x, y, slope * x.abs()]
        });
    }
    // The tip of a double cone.
    none(&|r| {
        let [x, y] = at(r);
        let side = if r.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
        [x, y, side * x.hypot(y)]
    });
}

#[test]
fn too_few_points_show_nothing() {
    let random = &mut Random::new(2);
    let rows: Vec<Place> = (0..199)
        .map(|_| over(random, |x, y| x * x + y * y))
        .collect();
    assert_eq!(near(3, &rows.concat(), &[0.0; 3]), None);
    let flat: Vec<f64> = (0..500).flat_map(|_| at(random)).collect();
    assert_eq!(near(2, &flat, &[0.0; 2]), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Turned, moved and scaled, in R^5 as well, the same is seen.
    #[test]
    fn motions_and_scale_change_the_place_and_lengths_alone(
        turns in proptest::collection::vec(0.0..4.0f64, 6),
        shift in proptest::collection::vec(-3.0..3.0f64, 5),
        scale in 0.01..100.0f64,
        curvatures in (0.5..1.0f64, 1.0..1.5f64),
    ) {
        let random = &mut Random::new(7);
        let (a, b) = curvatures;
        let rows: Vec<Place> =
            (0..900).map(|_| over(random, |x, y| (a * x * x + b * y * y) / 2.0)).collect();
        let moved = |place: &Place| {
            let mut out = [place[0], place[1], place[2], 0.0, 0.0];
            let planes = [(0, 1), (1, 2), (2, 3), (0, 4), (1, 4), (2, 0)];
            for (&(i, j), turn) in planes.iter().zip(&turns) {
                let (sin, cos) = (FRAC_PI_2 * turn).sin_cos();
                (out[i], out[j]) = (cos * out[i] - sin * out[j], sin * out[i] + cos * out[j]);
            }
            std::array::from_fn::<f64, 5, _>(|k| scale * (out[k] + shift[k]))
        };
        let plain = near(3, &rows.concat(), &rows[0]);
        let all: Vec<[f64; 5]> = rows.iter().map(moved).collect();
        let other = near(5, &all.concat(), &all[0]);
        prop_assert_eq!(plain.is_some(), other.is_some());
        let (Some(plain), Some(other)) = (plain, other) else { return Ok(()) };
        let place = moved(&[plain.place[0], plain.place[1], plain.place[2]]);
        for (x, y) in place.iter().zip(&other.place) {
            prop_assert!((x - y).abs() < 1e-6 * scale, "{place:?} {other:?}");
        }
        prop_assert!((plain.spacing * scale / other.spacing - 1.0).abs() < 1e-9);
        for (x, y) in plain.curvatures.iter().zip(&other.curvatures) {
            prop_assert!((x / scale / y - 1.0).abs() < 1e-6, "{x} {y}");
        }
    }
}
