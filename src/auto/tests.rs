use super::{Auto, Doubt, Input};
use crate::pipeline::{Parameters, Pipeline};
use crate::refusal::{Advice, FaultKind};
use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
use crosscap_core::{Error, PointCloud};

fn sample(name: &str, count: usize) -> PointCloud<f64> {
    let surface = SampleSurface::find(name).unwrap();
    surface.sample(&Sampling::new(count, 5)).unwrap().points
}

/// Pipelines whose first attempt is spoiled by landmarks that are much too far apart.
fn spoiled() -> impl FnMut(Parameters) -> Result<Pipeline, Error> {
    let mut first = true;
    move |parameters| {
        let coarse = Parameters {
            dl: 1.4,
            eps: 1.6,
            ..parameters.clone()
        };
        Pipeline::new(if std::mem::take(&mut first) {
            coarse
        } else {
            parameters
        })
    }
}

#[test]
fn what_passes_after_a_failure_is_confirmed_by_other_landmarks() {
    let cloud = sample("sphere", 2000);
    let search = Auto::default()
        .search(Input::Points(&cloud), &mut spoiled())
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
        .tries(2)
        .search(Input::Points(&cloud), &mut spoiled())
        .unwrap();
    assert!(matches!(search.doubt, Some(Doubt::Unconfirmed(_))));
    assert!(!search.is_verified());
    let refusal = search.into_verified(Some(&cloud)).unwrap_err();
    assert_eq!(refusal.faults[0].kind, FaultKind::TwoReadings);
    assert_eq!(refusal.attempts.len(), 2);
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
