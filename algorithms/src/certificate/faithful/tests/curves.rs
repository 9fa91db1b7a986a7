//! Curves without triangles: stretches without points, and ends.

use super::{POINTS, SPACING, judged, plate, sample};
use crate::certificate::{Certificate, ViolationKind};
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn is_bare(certificate: &Certificate) -> bool {
    certificate
        .violations()
        .any(|v| v.kind == ViolationKind::BareStretch)
}

/// The plate with a curve on its middle, and a sample of both: two points of the curve to a spacing, from `away` above the plate on.
fn plate_with_curve(away: f64, seed: u64) -> (Mesh, PointCloud<f64>) {
    plate_and_curve(0.0, away, seed)
}

/// The plate and a curve over its middle, which begins so far above it in the mesh, and so far in the points.
fn plate_and_curve(begins: f64, away: f64, seed: u64) -> (Mesh, PointCloud<f64>) {
    let plate = plate(|_, _| false);
    let middle = (0..plate.vertices.len())
        .find(|&v| plate.vertices.point(v)[..2].iter().all(|x| x.abs() < 0.01))
        .unwrap() as u32;
    let (joined, steps) = (begins == 0.0, 6);
    let mut places = plate.vertices.coordinates().to_vec();
    let height = |k: u32| begins + (1.0 - begins) * f64::from(k) / f64::from(steps);
    places.extend((u32::from(joined)..=steps).flat_map(|k| [0.0, 0.0, height(k)]));
    let vertices = places.len() / 3;
    let at = |k: u32| match (k, joined) {
        (0, true) => middle,
        (k, _) => vertices as u32 - 1 - (steps - k),
    };
    let mut curves = plate.complex.curve_edges.clone();
    let ends = (0..steps).map(|k| [at(k), at(k + 1)]);
    curves.extend(ends.map(|[a, b]| CurveEdge::new(a, b, 0)));
    let complex = Complex::new(vertices, plate.complex.triangles, curves).unwrap();
    let mesh = Mesh::new(
        complex,
        PointCloud::new(3, places).unwrap(),
        vec![-1; vertices],
    )
    .unwrap();
    let mut rows = sample(seed, POINTS, |_, _| 1.0).coordinates().to_vec();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let count = (2.0 * (1.0 - away) / SPACING) as usize;
    rows.extend((0..count).flat_map(|_| [0.0, 0.0, random.random_range(away..1.0)]));
    (mesh, PointCloud::new(3, rows).unwrap())
}

/// A curve that ends five spacings above the plate is not joined to it, one that ends in it is.
#[test]
fn a_curve_that_ends_above_a_sheet() {
    for seed in 20..26 {
        let (mesh, points) = plate_with_curve(5.0 * SPACING, seed);
        let wrong = judged(&mesh, &points);
        assert!(is_bare(&wrong), "{seed}: {wrong}");
        let found = wrong.faithful.unwrap().largest_stretch.unwrap();
        assert!(found.joint && found.size > 4.9 * SPACING, "{found:?}");
        let (mesh, points) = plate_with_curve(0.0, seed);
        let right = judged(&mesh, &points);
        assert!(right.verdict().is_verified(), "{seed}: {right}");
    }
}

/// A curve that is said to end above the plate does so where its points leave more than chance does, and where they leave less
/// they do not decide: they would not have told a curve that is joined either.
#[test]
fn an_end_of_a_curve_is_one_where_chance_leaves_no_such_stretch() {
    let undecided = |certificate: &Certificate| {
        let mut kinds = certificate.violations().map(|v| v.kind);
        kinds.any(|kind| kind == ViolationKind::UndecidedEnd)
    };
    for seed in 20..26 {
        let far = 8.0 * SPACING;
        let (mesh, points) = plate_and_curve(far, far, seed);
        let right = judged(&mesh, &points);
        assert!(right.verdict().is_verified(), "{seed}: {right}");
        let end = right.faithful.unwrap().loose_end.unwrap();
        assert!(
            end.p < 3e-5 && (end.size / far - 1.0).abs() < 0.1,
            "{end:?}"
        );
        let near = 3.5 * SPACING;
        let (mesh, points) = plate_and_curve(near, near, seed);
        let either = judged(&mesh, &points);
        assert!(undecided(&either), "{seed}: {either}");
    }
}

/// A curve in two pieces is found as well.
#[test]
fn a_curve_in_two() {
    let (mesh, points) = plate_with_curve(0.0, 30);
    let kept = |p: &[f64]| p[2] == 0.0 || (p[2] - 0.5).abs() > 0.2;
    let rows: Vec<f64> = points
        .iter()
        .filter(|p| kept(p))
        .flatten()
        .copied()
        .collect();
    let wrong = judged(&mesh, &PointCloud::new(3, rows).unwrap());
    let found = wrong
        .faithful
        .as_ref()
        .unwrap()
        .largest_stretch
        .clone()
        .unwrap();
    assert!(!found.joint, "{wrong}");
    assert!(is_bare(&wrong), "{wrong}");
    assert!((found.place[2] - 0.5).abs() < 0.1, "{found:?}");
}
