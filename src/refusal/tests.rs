//! Kinds of refusals, each provoked, and its advice followed to a verified mesh.

use super::{Advice, FaultKind, Refusal, Spot};
use crate::auto::{Auto, Input, Pinned};
use crate::pipeline::{Outcome, Parameters, Pipeline};
use crosscap_algorithms::certificate::Limits;
use crosscap_algorithms::singularity::ModelName;
use crosscap_algorithms::surfaces::{Drawing, Feature, Random, SampleSurface, Sampling};
use crosscap_core::{PointCloud, squared_distance};
use std::f64::consts::PI;

fn sample(name: &str, count: usize) -> PointCloud<f64> {
    let surface = SampleSurface::find(name).unwrap();
    surface.sample(&Sampling::new(count, 3)).unwrap().points
}

fn auto(eps: f64, dl: f64) -> Parameters {
    Parameters {
        models: ModelName::AUTO.to_vec(),
        ..Parameters::new(eps, dl)
    }
}

fn run(points: &PointCloud<f64>, parameters: Parameters) -> Result<Outcome, crosscap_core::Error> {
    Pipeline::new(parameters).unwrap().reconstruct(points)
}

/// The refusal of a run that has to fail, by its first fault.
fn refused(points: &PointCloud<f64>, parameters: Parameters, kind: FaultKind) -> Refusal {
    let outcome = run(points, parameters);
    assert!(!outcome.as_ref().is_ok_and(Outcome::is_verified));
    let refusal = Refusal::of(outcome, None, Some(points));
    assert_eq!(refusal.faults[0].kind, kind, "{refusal}");
    refusal
}

/// The Betti numbers of a run that has to give a verified mesh.
fn verified(points: &PointCloud<f64>, pinned: Pinned) -> [usize; 3] {
    let search = Auto::new(pinned).reconstruct(points).unwrap();
    match search.into_verified(Some(points)) {
        Ok(outcome) => outcome.homology.betti_rational,
        Err(refusal) => panic!("{refusal}"),
    }
}

#[test]
fn a_gap_that_is_covered_stays_open_at_the_separation_that_is_told() {
    let drawing = Drawing {
        count: 700,
        size: 8.0,
        ratio: 1.0,
        noise: 0.0,
        seed: 2,
    };
    let plate = Feature::find("plate-hole").unwrap().draw(&drawing).unwrap();
    let coarse = auto(8.0 * plate.spacing, 4.5 * plate.spacing);
    let refusal = refused(&plate.points, coarse, FaultKind::Gap);
    let Advice::CloserLandmarks { dl } = refusal.advice else {
        panic!("{refusal}")
    };
    let pinned = Pinned {
        dl: Some(dl),
        ..Pinned::default()
    };
    assert_eq!(verified(&plate.points, pinned), [1, 1, 0]);
}

/// About so many points spread evenly over the unit sphere, without those nearer than `radius` to a pole.
fn even_sphere(count: usize, radius: f64) -> PointCloud<f64> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let place = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        [across * cos, across * sin, z]
    };
    let away = |[x, y, z]: &[f64; 3]| (x * x + y * y + (1.0 - z).powi(2)).sqrt() > radius;
    let places = (0..count).map(place).filter(away);
    PointCloud::new(3, places.flatten().collect()).unwrap()
}

#[test]
fn a_gap_that_is_no_chance_is_covered_by_more_points_or_by_who_knows_better() {
    let (count, radius) = (3000, 0.1);
    let scan = even_sphere(count, radius);
    let spacing = (4.0 * PI / count as f64).sqrt();
    let coarse = auto(6.0 * spacing, 3.0 * spacing);
    let refusal = refused(&scan, coarse, FaultKind::Gap);
    let Advice::DenserOrNoHole { points, least_hole } = refusal.advice else {
        panic!("{refusal}")
    };
    assert!((3.2..3.8).contains(&least_hole), "{refusal}");
    let known = Auto::new(Pinned {
        least_hole: Some(least_hole),
        ..Pinned::default()
    });
    let outcome = known.reconstruct(&scan).unwrap().into_verified(Some(&scan));
    let outcome = outcome.unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
    let told = outcome.certificate.faithful.unwrap().covered.unwrap();
    assert_eq!(told.gaps, 1, "{told:?}");
    assert!(told.widest < least_hole, "{told:?}");
    // It was a hole after all.
    let many = even_sphere(points, radius);
    assert_eq!(verified(&many, Pinned::default()), [1, 0, 0]);
}

#[test]
fn a_surface_that_ends_unawares_is_one_with_a_boundary() {
    let square = sample("square", 900);
    let closed = Parameters {
        surface: true,
        models: vec![ModelName::TwoPlanes],
        ..Parameters::new(0.4, 0.2)
    };
    let refusal = refused(&square, closed, FaultKind::Ends);
    assert!(matches!(refusal.advice, Advice::Boundary), "{refusal}");
    let pinned = Pinned {
        models: Some(ModelName::AUTO.to_vec()),
        ..Pinned::default()
    };
    assert_eq!(verified(&square, pinned), [1, 0, 0]);
}

#[test]
fn noise_is_told_and_a_larger_separation_does() {
    let random = &mut Random::new(4);
    let mut rows = Vec::new();
    for p in sample("sphere", 1500).iter() {
        let far = 1.0 + 0.05 * random.normal();
        rows.extend(p.iter().map(|x| far * x));
    }
    let cloud = PointCloud::new(3, rows).unwrap();
    let refusal = refused(&cloud, auto(0.3, 0.15), FaultKind::Noise);
    let Advice::LessNoise { dl } = refusal.advice else {
        panic!("{refusal}")
    };
    let pinned = Pinned {
        dl: Some(1.5 * dl.unwrap_or(0.15)),
        ..Pinned::default()
    };
    assert_eq!(verified(&cloud, pinned), [1, 0, 1]);
}

#[test]
fn a_point_by_itself_is_told_and_without_it_the_mesh_is_verified() {
    let mut rows = sample("sphere", 1500).coordinates().to_vec();
    rows.extend([1.35, 0.0, 0.0]);
    let cloud = PointCloud::new(3, rows).unwrap();
    let refusal = refused(&cloud, auto(0.5, 0.25), FaultKind::Outliers);
    let Advice::LeaveOut { rows } = &refusal.advice else {
        panic!("{refusal}")
    };
    assert_eq!(rows, &[1500]);
    let kept: Vec<usize> = (0..cloud.len()).filter(|row| !rows.contains(row)).collect();
    let outcome = run(&cloud.select(&kept), auto(0.5, 0.25)).unwrap();
    assert!(outcome.is_verified());
    let prepared = Pinned {
        eps: Some(0.5),
        dl: Some(0.25),
        prepare: Some(true),
        ..Pinned::default()
    };
    assert_eq!(verified(&cloud, prepared), [1, 0, 1]);
}

#[test]
fn neighborhoods_of_too_few_points_are_told_how_many_would_do() {
    let refusal = refused(
        &sample("sphere", 500),
        auto(0.2, 0.14),
        FaultKind::TooFewPoints,
    );
    let Advice::MorePoints(count) = refusal.advice else {
        panic!("{refusal}")
    };
    assert!((1000..6000).contains(&count), "{count}");
    let pinned = Pinned {
        eps: Some(0.2),
        ..Pinned::default()
    };
    assert_eq!(verified(&sample("sphere", count), pinned), [1, 0, 1]);
}

#[test]
fn a_crossing_that_no_asked_model_claims_is_claimed_by_all_together() {
    let cloud = sample("two_squares", 4000);
    let pinned = Pinned {
        eps: Some(0.3),
        dl: Some(0.15),
        models: Some(vec![ModelName::Boundary]),
        ..Pinned::default()
    };
    let search = Auto::new(pinned.clone()).reconstruct(&cloud).unwrap();
    let refusal = search.into_verified(Some(&cloud)).unwrap_err();
    assert!(matches!(refusal.advice, Advice::AllModels), "{refusal}");
    let all = Pinned {
        models: Some(ModelName::AUTO.to_vec()),
        ..pinned
    };
    assert_eq!(verified(&cloud, all), [1, 0, 0]);
}

#[test]
fn a_place_is_told_as_far_as_it_is_known() {
    let spot = |row, coordinates: &[f64]| {
        let coordinates = coordinates.to_vec();
        let spacing = None;
        Spot {
            row,
            coordinates,
            spacing,
        }
        .to_string()
    };
    assert_eq!(spot(Some(7), &[]), "row 7");
    assert_eq!(spot(Some(7), &[0.5, 1.0]), "row 7 (0.5000, 1.0000)");
    assert_eq!(spot(None, &[0.5]), "(0.5000)");
}

/// A feature of so many spacings, drawn with more points and otherwise the same.
fn denser(feature: &str, few: &Drawing, count: usize) -> PointCloud<f64> {
    let size = few.size * (count as f64 / few.count as f64).sqrt();
    let drawing = Drawing {
        count,
        size,
        ..*few
    };
    Feature::find(feature)
        .unwrap()
        .draw(&drawing)
        .unwrap()
        .points
}

#[test]
fn sheets_that_are_one_in_the_mesh_are_told_and_more_points_keep_them_apart() {
    let few = Drawing {
        count: 450,
        size: 1.6,
        ratio: 1.0,
        noise: 0.0,
        seed: 1,
    };
    let cloud = Feature::find("parallel").unwrap().draw(&few).unwrap();
    let coarse = Parameters {
        surface: true,
        models: vec![ModelName::Boundary],
        ..Parameters::new(8.0 * cloud.spacing, 4.0 * cloud.spacing)
    };
    let refusal = refused(&cloud.points, coarse, FaultKind::Merged);
    let Advice::MorePoints(count) = refusal.advice else {
        panic!("{refusal}")
    };
    let many = denser("parallel", &few, count);
    assert_eq!(verified(&many, Pinned::default()), [2, 0, 0]);
}

#[test]
fn sheets_that_no_model_claims_are_claimed_where_there_are_more_points() {
    // Which of so few points are refused for this, for a bend or not at all, is chance.
    let refusals = (20..=35).filter_map(|k| {
        let few = sample("two_spheres", 20 * k);
        let lengths = Auto::default().choose(Input::Points(&few)).unwrap();
        let outcome = run(&few, lengths.parameters);
        let failed = !outcome.as_ref().is_ok_and(Outcome::is_verified);
        failed.then(|| Refusal::of(outcome, None, Some(&few)))
    });
    let refusal = { refusals }
        .find(|refusal| refusal.faults[0].kind == FaultKind::Unclaimed)
        .unwrap();
    assert!(matches!(refusal.advice, Advice::Model), "{refusal}");
    assert!(refusal.advice.to_string().contains("sample more densely"));
    let more = sample("two_spheres", 1500);
    assert_eq!(verified(&more, Pinned::default()), [1, 0, 3]);
}

/// A hole that chance explains for somebody who allows a false alarm in 100,000: closed where landmarks are far apart, open where they are
/// near to each other.
#[test]
fn two_readings_are_told_and_more_points_decide() {
    let few = Drawing {
        count: 1000,
        size: 4.2,
        ratio: 1.0,
        noise: 0.0,
        seed: 1,
    };
    let cloud = Feature::find("plate-hole").unwrap().draw(&few).unwrap();
    // Without corners the first attempt sees next to nothing of a plate, and the others disagree.
    let rounded = |model: &ModelName| *model != ModelName::BoundaryCorner;
    let spacings = |eps: f64, dl: f64| Parameters {
        models: ModelName::AUTO.into_iter().filter(rounded).collect(),
        ..Parameters::new(eps * cloud.spacing, dl * cloud.spacing)
    };
    let mut readings = [spacings(16.0, 14.0), spacings(5.0, 2.5), spacings(4.2, 2.1)].into_iter();
    let rims = Limits {
        shortest_boundary: 4,
        ..Limits::default()
    };
    let search = Auto::default()
        .search(Input::Points(&cloud.points), &mut |asked| {
            // The first attempt, with landmarks far apart, is refused for the hole.
            let significance = if readings.len() == 3 { 1e-3 } else { 1e-5 };
            let reading = readings.next().unwrap_or(asked);
            let limits = Limits {
                significance,
                ..rims.clone()
            };
            Ok(Pipeline::new(reading)?.limits(limits))
        })
        .unwrap();
    let tried: Vec<_> = search.attempts.iter().map(|a| a.end.clone()).collect();
    let refusal = search.into_verified(Some(&cloud.points)).unwrap_err();
    assert_eq!(
        refusal.faults[0].kind,
        FaultKind::TwoReadings,
        "{refusal}: {tried:?}"
    );
    let Advice::MorePoints(count) = refusal.advice else {
        panic!("{refusal}")
    };
    assert_eq!(count, 3 * few.count);
    let many = denser("plate-hole", &few, count);
    assert_eq!(verified(&many, Pinned::default()), [1, 1, 0]);
}

/// A sphere of radius 1 on a plate, or on another sphere, that it touches in the origin.
fn touching(on_plate: bool) -> PointCloud<f64> {
    let random = &mut Random::new(6);
    let mut rows = Vec::new();
    for k in 0..3600 {
        let unit = loop {
            let at = [0; 3].map(|_| random.normal());
            let length = at.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 1e-9 {
                break at.map(|x| x / length);
            }
        };
        let [x, y, z] = unit;
        rows.push(match (k % 2 == 0, on_plate) {
            (true, _) => [x, y, z + 1.0],
            (false, false) => [x, y, z - 1.0],
            (false, true) => {
                let [x, y] = [0; 2].map(|_| random.between(-1.8, 1.8));
                [x, y, 0.0]
            }
        });
    }
    PointCloud::new(3, rows.concat()).unwrap()
}

#[test]
fn sheets_that_touch_are_told_and_apart_they_are_verified() {
    for (on_plate, holes, second) in [(true, [2, 1, 0], [1, 0, 0]), (false, [2, 0, 0], [1, 0, 1])] {
        let cloud = touching(on_plate);
        let search = Auto::new(Pinned::default()).reconstruct(&cloud).unwrap();
        let refusal = search.into_verified(Some(&cloud)).unwrap_err();
        assert_eq!(refusal.faults[0].kind, FaultKind::Touching, "{refusal}");
        let Advice::Separate { place, radius } = &refusal.advice else {
            panic!("{refusal}")
        };
        assert!(
            place.coordinates.iter().all(|x| x.abs() < 0.02),
            "{refusal}"
        );
        let radius = radius.unwrap();
        let far =
            |&row: &usize| squared_distance(cloud.point(row), &place.coordinates) > radius * radius;
        let kept: Vec<usize> = (0..cloud.len()).filter(far).collect();
        assert_eq!(verified(&cloud.select(&kept), Pinned::default()), holes);
        let own = |second| (0..cloud.len()).filter(move |row| (row % 2 == 1) == second);
        let cloud_of = |is_second| cloud.select(&own(is_second).collect::<Vec<_>>());
        assert_eq!(verified(&cloud_of(false), Pinned::default()), [1, 0, 1]);
        assert_eq!(verified(&cloud_of(true), Pinned::default()), second);
    }
}
