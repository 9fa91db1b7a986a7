use super::density::Density;
use super::moves::Known;
use super::{Auto, Doubt, Input, Move, Pinned};
use crate::pipeline::{Parameters, Pipeline};
use crate::refusal::{Advice, FaultKind};
use crosscap_algorithms::surfaces::{Random, SampleSurface, Sampling};
use crosscap_backends::files::Distances;
use crosscap_core::{Error, PointCloud, squared_distance};

fn sample(name: &str, count: usize) -> PointCloud<f64> {
    let surface = SampleSurface::find(name).unwrap();
    surface.sample(&Sampling::new(count, 5)).unwrap().points
}

/// Pipelines of which these attempts, from 0, are spoiled by landmarks that are much too far apart.
fn spoiled(which: &[usize]) -> impl FnMut(Parameters) -> Result<Pipeline, Error> {
    let mut attempts = 0..;
    move |parameters| {
        let coarse = Parameters {
            dl: 1.4,
            eps: 1.6,
            ..parameters.clone()
        };
        let spoil = attempts.next().is_some_and(|now| which.contains(&now));
        Pipeline::new(if spoil { coarse } else { parameters })
    }
}

#[test]
fn what_passes_after_a_failure_is_confirmed_by_other_landmarks() {
    let cloud = sample("sphere", 2000);
    let search = Auto::default()
        .search(Input::Points(&cloud), &mut spoiled(&[0]))
        .unwrap();
    let ends: Vec<bool> = search
        .attempts
        .iter()
        .map(|a| a.end.is_verified())
        .collect();
    assert_eq!(ends, [false, true, true]);
    let [_, passed, confirmed] = &search.attempts[..] else {
        unreachable!("three attempts")
    };
    assert_ne!(passed.parameters.seed, confirmed.parameters.seed);
    assert_eq!(passed.end.topology(), confirmed.end.topology());
    let outcome = search.into_verified(Some(&cloud)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
}

#[test]
fn what_passes_after_a_failure_is_not_handed_over_unconfirmed() {
    let cloud = sample("sphere", 2000);
    let search = Auto::default()
        .tries(3)
        .search(Input::Points(&cloud), &mut spoiled(&[0, 2]))
        .unwrap();
    assert!(matches!(search.doubt, Some(Doubt::Unconfirmed(_))));
    assert!(!search.is_verified());
    let refusal = search.into_verified(Some(&cloud)).unwrap_err();
    assert_eq!(refusal.faults[0].kind, FaultKind::Unconfirmed);
    assert_eq!(refusal.attempts.len(), 3);
    assert!(matches!(refusal.advice, Advice::MoreTries));
    let more = Auto::default().tries(4);
    let search = more
        .search(Input::Points(&cloud), &mut spoiled(&[0, 2]))
        .unwrap();
    assert!(search.is_verified());
}

/// Scattered by 0.13 of their spacing: the first attempt takes the points as they are, the second moves them.
#[test]
fn points_that_scatter_little_are_moved_for_the_second_attempt() {
    let surface = SampleSurface::find("sphere").unwrap();
    let noisy = Sampling {
        noise: 0.01,
        ..Sampling::new(2000, 5)
    };
    let cloud = surface.sample(&noisy).unwrap().points;
    let moved = |search: &crate::auto::Search| search.preparation.as_ref().and_then(|p| p.moved);
    let plain = Auto::default().reconstruct(&cloud).unwrap();
    assert!(plain.is_verified() && plain.attempts.len() == 1);
    assert!(moved(&plain).is_none());

    let search = Auto::default()
        .search(Input::Points(&cloud), &mut spoiled(&[0]))
        .unwrap();
    assert!(search.is_verified());
    assert!(moved(&search).is_some_and(|by| by > 0.005));
    let [first, second, _] = &search.attempts[..] else {
        unreachable!("three attempts")
    };
    assert_eq!(first.parameters, second.parameters);
    assert!(second.reason.contains("moved"));

    let asked = Auto::new(Pinned {
        prepare: Some(true),
        ..Pinned::default()
    });
    let search = asked.reconstruct(&cloud).unwrap();
    assert!(search.is_verified() && moved(&search).is_some());
}

/// The last attempt is kept to confirm one that passed: an attempt that no other can confirm is not made.
#[test]
fn the_last_attempt_confirms() {
    let cloud = sample("sphere", 2000);
    let with = |tries| {
        let auto = Auto::default().tries(tries);
        let search = auto.search(Input::Points(&cloud), &mut spoiled(&[0]));
        let search = search.unwrap();
        (search.attempts.len(), search.is_verified())
    };
    assert_eq!(with(2), (1, false));
    assert_eq!(with(3), (3, true));
}

#[test]
fn outliers_are_left_out_and_rows_stay_those_of_the_input() {
    // The corners of a cube around the sphere, each a little farther out than the one before.
    let mut rows: Vec<f64> = Vec::new();
    for corner in 0_u32..8 {
        let far = 1.5 + 0.1 * f64::from(corner);
        rows.extend([1, 2, 4].map(|axis| if corner & axis > 0 { far } else { -far }));
    }
    let plain = sample("sphere", 2000);
    rows.extend(plain.coordinates());
    let cloud = PointCloud::new(3, rows).unwrap();
    let search = Parameters::auto().reconstruct(&cloud).unwrap();
    let done = search.preparation.as_ref().unwrap();
    assert_eq!(done.outliers, (0..8).collect::<Vec<_>>());
    let outcome = search.into_verified(Some(&cloud)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
    for (vertex, &row) in outcome.mesh.point_index.iter().enumerate() {
        assert_eq!(
            outcome.mesh.vertices.point(vertex),
            cloud.point(row as usize)
        );
    }
}

#[test]
fn too_few_points_are_told_with_a_number_that_does() {
    let few = sample("torus", 300);
    let refusal = Parameters::auto()
        .tries(1)
        .reconstruct(&few)
        .unwrap()
        .into_verified(Some(&few))
        .unwrap_err();
    assert_eq!(refusal.faults[0].kind, FaultKind::Curvature, "{refusal}");
    let Advice::MorePoints(count) = refusal.advice else {
        panic!("{refusal}");
    };
    let more = sample("torus", count);
    let search = Parameters::auto().reconstruct(&more).unwrap();
    let outcome = search.into_verified(Some(&more)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 2, 1]);
}

#[test]
fn coordinates_without_digits_are_told_and_with_them_it_is_verified() {
    let plain = sample("sphere", 3000);
    let far = |x: &f64, axis: usize| x + if axis == 0 { 4e6 } else { 0.0 };
    let rounded = |&x: &f64| f64::from(x as f32);
    let moved: Vec<f64> = (plain.coordinates().iter().enumerate())
        .map(|(k, x)| far(x, k % 3))
        .collect();
    let coarse = PointCloud::new(3, moved.iter().map(rounded).collect()).unwrap();
    let search = Parameters::auto().reconstruct(&coarse).unwrap();
    let refusal = search.into_verified(Some(&coarse)).unwrap_err();
    assert_eq!(refusal.faults[0].kind, FaultKind::Precision, "{refusal}");
    assert!(matches!(refusal.advice, Advice::MoreDigits));
    // As advised: the offset off before rounding, or no rounding.
    let near = PointCloud::new(3, plain.coordinates().iter().map(rounded).collect()).unwrap();
    for cloud in [near, PointCloud::new(3, moved).unwrap()] {
        let search = Parameters::auto().reconstruct(&cloud).unwrap();
        assert_eq!(search.attempts.len(), 1);
        let outcome = search.into_verified(Some(&cloud)).unwrap();
        assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
    }
}

#[test]
fn points_that_fill_a_space_are_told_and_without_the_column_it_is_verified() {
    let mut random = Random::new(7);
    let rows = (0..3000).flat_map(|_| [(); 3].map(|()| random.uniform()));
    let solid = PointCloud::new(3, rows.collect()).unwrap();
    let search = Parameters::auto().tries(3).reconstruct(&solid).unwrap();
    let refusal = search.into_verified(Some(&solid)).unwrap_err();
    assert_eq!(refusal.faults[0].kind, FaultKind::Dimension, "{refusal}");
    assert!(matches!(refusal.advice, Advice::FewerDimensions));
    let plane = solid.iter().flat_map(|row| [row[0], row[1]]).collect();
    let plane = PointCloud::new(2, plane).unwrap();
    let search = Parameters::auto().reconstruct(&plane).unwrap();
    let outcome = search.into_verified(Some(&plane)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 0]);
}

/// Points of a sphere, a hundred times as dense at one pole as at the other.
fn uneven_sphere() -> PointCloud<f64> {
    let dense = sample("sphere", 100_000);
    let mut random = Random::new(3);
    let kept = dense.iter().filter(|row| {
        let share = (row[0] + 1.0) / 2.0;
        random.uniform() < 0.3 * 100_f64.powf(-share)
    });
    PointCloud::new(3, kept.flatten().copied().collect()).unwrap()
}

#[test]
fn a_density_that_varies_a_hundredfold_is_followed() {
    let cloud = uneven_sphere();
    let search = Parameters::auto().reconstruct(&cloud).unwrap();
    let outcome = search.into_verified(Some(&cloud)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
}

fn spaced(from: &Parameters, density: &Density) -> Option<Parameters> {
    let known = Known {
        density,
        needed: None,
        noise: None,
    };
    Move::Spaced.apply(from, &Pinned::default(), &known)
}

#[test]
fn in_the_spacing_of_the_points_landmarks_are_near_where_points_are() {
    let cloud = uneven_sphere();
    let choice = Parameters::auto().choose(Input::Points(&cloud)).unwrap();
    let density = choice.density.unwrap();
    let found = spaced(&choice.parameters, &density);
    let parameters = found.expect("the density varies");
    assert!(parameters.dl < choice.parameters.dl);
    let outcome = Pipeline::new(parameters)
        .unwrap()
        .reconstruct(&cloud)
        .unwrap();
    assert!(outcome.is_verified(), "{}", outcome.certificate);
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
    let mesh = outcome.into_verified().unwrap();
    let lengths = mesh.complex.triangles.iter().map(|t| {
        let [a, b] = [t[0], t[1]].map(|v| mesh.vertices.point(v as usize));
        (a[0], crosscap_core::squared_distance(a, b).sqrt())
    });
    let mean = |side: f64| {
        let some: Vec<f64> = (lengths.clone().filter(|x| side * x.0 > 0.7))
            .map(|x| x.1)
            .collect();
        some.iter().sum::<f64>() / some.len() as f64
    };
    // The spacings at the caps are seven and a half times each other.
    assert!(mean(1.0) > 3.0 * mean(-1.0), "{} {}", mean(1.0), mean(-1.0));
}

#[test]
fn what_does_not_vary_is_not_measured_in_its_spacing() {
    let cloud = sample("sphere", 2000);
    let choice = Parameters::auto().choose(Input::Points(&cloud)).unwrap();
    let density = choice.density.unwrap();
    let found = spaced(&choice.parameters, &density);
    assert!(found.is_none());
}

#[test]
fn distances_of_no_places_need_nothing_more() {
    let sphere = sample("sphere", 900);
    let n = sphere.len();
    let arc = |k: usize| {
        let [p, q] = [sphere.point(k / n), sphere.point(k % n)];
        let cosine: f64 = p.iter().zip(q).map(|(a, b)| a * b).sum();
        cosine.clamp(-1.0, 1.0).acos()
    };
    let values = (0..n * n).map(|k| if k / n == k % n { 0.0 } else { arc(k) });
    let distances = Distances::Dense {
        count: n,
        values: values.collect(),
    };
    let search = Parameters::auto()
        .reconstruct_distances(&distances)
        .unwrap();
    let outcome = search.into_verified(None).unwrap();
    assert!(outcome.report.parameters.surface);
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
}

#[test]
fn noise_in_many_directions_is_taken_away_by_the_subspace() {
    use crosscap_algorithms::surfaces::embed;
    const WIDTH: usize = 60;
    let plain = embed(&sample("torus", 4000), WIDTH, 8).unwrap();
    let mut random = Random::new(9);
    // In 57 directions together it is a third of what lies between the points.
    let noisy = (plain.coordinates().iter()).map(|x| x + 0.006 * random.normal());
    let cloud = PointCloud::new(WIDTH, noisy.collect()).unwrap();
    let search = Parameters::auto().reconstruct(&cloud).unwrap();
    let told = search.preparation.as_ref().and_then(|found| found.subspace);
    let (dimension, deviation) = told.unwrap();
    assert_eq!(dimension, 3);
    assert!((deviation - 0.006).abs() < 2e-4);
    let outcome = search.into_verified(Some(&cloud)).unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 2, 1]);
    assert_eq!(outcome.report.dimension, WIDTH);
    // Every vertex is where its point would be without noise.
    for (place, &row) in (outcome.mesh.vertices.iter()).zip(&outcome.mesh.point_index) {
        let row = usize::try_from(row).unwrap();
        let off = squared_distance(place, plain.point(row)).sqrt();
        assert!(off < 0.03, "{off} at row {row}");
        assert!(squared_distance(place, cloud.point(row)).sqrt() > off);
    }
}
