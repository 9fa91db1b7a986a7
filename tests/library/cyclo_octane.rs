//! The conformations of cyclo-octane (Martin & Watson 2011, section 5): a sphere and a Klein bottle in
//! R^24 that meet in two circles.

use crosscap::backends::euclidean::EuclideanOracle;
use crosscap::prelude::*;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::homology::local_homology;
use crosscap_algorithms::pieces::Sidedness;
use crosscap_algorithms::surfaces::RingConformations;

fn reconstruct(points: &PointCloud<f64>, parameters: Parameters) -> Outcome {
    Pipeline::new(parameters)
        .unwrap()
        .reconstruct(points)
        .unwrap()
}

/// Asserts everything that is known about the space.
fn assert_is_the_known_space(outcome: &Outcome, which: &str) {
    let why: Vec<String> = outcome
        .failures
        .iter()
        .map(ToString::to_string)
        .chain(outcome.certificate.violations().map(ToString::to_string))
        .collect();
    assert!(
        outcome.is_verified(),
        "{which}: refused: {}",
        why.join("; ")
    );
    assert_eq!(
        outcome.homology.betti_rational,
        [1, 1, 2],
        "{which}, over Q"
    );
    assert_eq!(outcome.homology.betti_mod2, [1, 1, 2], "{which}, over Z/2");
    assert!(outcome.homology.torsion.is_empty(), "{which}");

    let complex = &outcome.mesh.complex;
    assert!(!complex.curve_edges.is_empty(), "{which}: no double curve");
    for e in &complex.curve_edges {
        let on = |t: &&[u32; 3]| e.ends.iter().all(|v| t.contains(v));
        let triangles = complex.triangles.iter().filter(on).count();
        assert_eq!((e.cells, triangles), (4, 4), "{which}: edge {:?}", e.ends);
    }

    let pieces = outcome.pieces.as_ref().unwrap();
    let mut names: Vec<&str> = pieces.pieces.iter().map(|p| p.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["Klein bottle", "sphere"], "{which}");
    assert_eq!(pieces.curves.len(), 2, "{which}");
    for curve in &pieces.curves {
        assert!(curve.circle, "{which}");
        let mut over: Vec<(&str, Option<Sidedness>, u32)> = curve
            .preimages
            .iter()
            .map(|p| {
                (
                    pieces.pieces[p.piece as usize].name.as_str(),
                    p.sidedness,
                    p.covers,
                )
            })
            .collect();
        over.sort_by_key(|o| o.0);
        let expected = [
            ("Klein bottle", Some(Sidedness::OneSided), 1),
            ("sphere", Some(Sidedness::TwoSided), 1),
        ];
        assert_eq!(over, expected, "{which}");
    }
    assert!(
        pieces.multiple_points.is_empty() && pieces.contacts.is_empty(),
        "{which}"
    );
}

#[test]
fn a_sample_of_our_own() {
    let ring = RingConformations::cyclo_octane();
    let sample = ring.sample(30_000, 1).unwrap();
    // The paper has 1,031,644 points and eps 0.23, dl 0.12; these are 34 times sparser, so that
    // the same number of points in a neighborhood would ask for lengths 6 times as large. A
    // hundred points are enough, and eps 1.5 times as large.
    let parameters = Parameters {
        dp: 0.1,
        ep: 0.04,
        ..Parameters::new(0.35, 0.2)
    };
    let outcome = reconstruct(&sample.points, parameters);
    assert_is_the_known_space(&outcome, "30,000 conformations");
    // The paper's own check: every neighborhood is contractible.
    let oracle = EuclideanOracle::new(outcome.mesh.vertices.clone()).unwrap();
    let complex = &outcome.mesh.complex;
    let local = local_homology(complex, &oracle, 0.35, &Serial).unwrap();
    assert_eq!(local.neighborhoods, complex.vertices);
    assert!(local.failures.is_empty(), "{:?}", local.failures);
    assert_eq!(local.other_sheets, 0);
}

/// Every 30th of the public landmark set of the paper (see `tests/data/README.md`), moved onto the variety that the
/// sampler draws from: none by more than what four decimals leave.
#[test]
fn public_conformations_lie_on_the_variety() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/cyclo_octane_public_202.npy"
    );
    let cloud = crosscap::backends::files::read_points(file, &Default::default())
        .unwrap()
        .into_f64();
    assert_eq!((cloud.len(), cloud.dimension()), (202, 24));
    assert_on_the_variety(&cloud);
}

fn assert_on_the_variety(cloud: &PointCloud<f64>) {
    let ring = RingConformations::cyclo_octane();
    let projected = ring.project(cloud).unwrap();
    let farthest = projected.moved.iter().copied().fold(0.0, f64::max);
    println!("farthest from the variety: {farthest:.2e}");
    assert!(farthest < 2e-4, "{farthest}");
    assert!(ring.largest_deviation(&projected.points).unwrap() < 1e-9);
    // In the position of the sampler: the alignment leaves them where they are.
    let margins = ring.alignment_margin(&projected.points).unwrap();
    assert!(margins.iter().all(|&m| m > 0.4));
    // Other bonds, another variety.
    let other = RingConformations::new(8, 1.521, 115.0).unwrap();
    let moved = other.project(cloud).unwrap().moved;
    assert!(moved.iter().all(|&m| m > 5e-4));
}

/// The public landmark set of the paper, 6040 conformations, where the variable
/// `CROSSCAP_CYCLO_OCTANE` names it.
#[test]
fn the_public_landmarks() {
    const VARIABLE: &str = "CROSSCAP_CYCLO_OCTANE";
    let Ok(file) = std::env::var(VARIABLE) else {
        eprintln!("SKIPPED: set {VARIABLE} to the public 6040 x 24 landmark file to run this test");
        return;
    };
    let cloud = crosscap::backends::files::read_points(&file, &Default::default())
        .unwrap_or_else(|e| panic!("{VARIABLE}: {e}"))
        .into_f64();
    assert_eq!((cloud.len(), cloud.dimension()), (6040, 24));
    assert_on_the_variety(&cloud);
    for seed in 0..3 {
        let parameters = Parameters {
            dp: 0.1,
            ep: 0.05,
            seed,
            ..Parameters::new(0.45, 0.2)
        };
        let outcome = reconstruct(&cloud, parameters);
        assert_is_the_known_space(&outcome, &format!("public landmarks, seed {seed}"));
    }
}
