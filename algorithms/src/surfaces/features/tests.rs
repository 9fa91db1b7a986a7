//! What a feature cloud says of itself.

use super::*;

fn drawing(size: f64) -> Drawing {
    Drawing {
        count: 1500,
        size,
        ratio: 1.0,
        noise: 0.0,
        seed: 5,
    }
}

#[test]
fn areas_are_those_of_the_places() {
    // Of random places as many are within a small distance of another as the density asks for: the mean number of
    // neighbors within r is count pi r^2 / area, less at rims.
    for feature in Feature::all() {
        let size = feature.lengths(&drawing(6.0)).0;
        let places = feature.places(size, 1500, 3).unwrap();
        let places = &places[..1500];
        let r = 1.2 * ((feature.area)(size) / 1500.0).sqrt();
        let near = |p: &Spot| {
            let d = places.iter().map(|q| crosscap_core::squared_distance(p, q));
            d.filter(|&d| d < r * r).count() as f64 - 1.0
        };
        let mean = places.iter().map(near).sum::<f64>() / 1500.0;
        let even = std::f64::consts::PI * 1.2 * 1.2;
        let share = mean / even;
        assert!((0.75..1.25).contains(&share), "{}: {share}", feature.name);
    }
}

#[test]
fn a_feature_is_measured_where_the_points_are_thin() {
    let hole = Feature::find("plate-hole").unwrap();
    let even = hole.draw(&drawing(6.0)).unwrap();
    assert!((even.resolved - 6.0).abs() < 1e-9, "{}", even.resolved);
    assert!((even.size - 6.0 * even.spacing).abs() < 1e-9);
    let noisy = Drawing {
        noise: 0.5,
        ..drawing(6.0)
    };
    assert!((hole.draw(&noisy).unwrap().resolved - 5.0).abs() < 1e-9);
    // Two plates are thinner somewhere than on average.
    let varied = Drawing {
        ratio: 20.0,
        ..drawing(6.0)
    };
    let plates = Feature::find("parallel").unwrap().draw(&varied).unwrap();
    assert!(plates.resolved < 5.0, "{}", plates.resolved);
    let (same, again) = (hole.draw(&noisy).unwrap(), hole.draw(&noisy).unwrap());
    assert_eq!(same.points, again.points);
    assert!(
        hole.draw(&Drawing {
            ratio: 0.5,
            ..noisy
        })
        .is_err()
    );
    let crowded = hole.draw(&drawing(1e4)).unwrap();
    assert!(crowded.size <= hole.most);
}

#[test]
fn the_hole_is_empty() {
    let cloud = Feature::find("sphere-hole")
        .unwrap()
        .draw(&drawing(8.0))
        .unwrap();
    let inside = cloud
        .points
        .iter()
        .filter(|p| p[2] > 0.0 && p[0].hypot(p[1]) < cloud.size / 2.0);
    assert_eq!(inside.count(), 0);
}
