//! What `check` says about reconstructions of sample surfaces: the pieces of each, how they meet, the immersion
//! undone, and the homology of every neighborhood. The paper's nine are in `surfaces.rs`.

use crosscap::backends::euclidean::EuclideanOracle;
use crosscap::prelude::*;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::homology::{homology, local_homology};
use crosscap_algorithms::pieces::{Pieces, Sidedness};
use crosscap_algorithms::singularity::ModelName;

fn reconstruct(name: &str, count: usize, eps: f64, dl: f64) -> Outcome {
    let surface = SampleSurface::find(name).unwrap();
    let mut sampling = Sampling::new(count, 0);
    sampling.boundary = surface.has_boundary();
    let sample = surface.sample(&sampling).unwrap();
    let mut parameters = Parameters::new(eps, dl);
    if surface.truth().double_curves == 0 {
        parameters = parameters.surface();
    }
    if surface.truth().triple_points > 0 {
        parameters.models = vec![ModelName::TwoPlanes, ModelName::TriplePoint];
    }
    parameters.boundary = sample.boundary;
    let outcome = Pipeline::new(parameters).unwrap();
    let outcome = { outcome }.reconstruct(&sample.points).unwrap();
    assert!(outcome.is_verified(), "{name}: {:?}", outcome.failures);
    let truth = surface.truth();
    assert_eq!(outcome.homology.betti_rational, truth.betti, "{name}");
    let pieces = outcome.pieces.as_ref().unwrap();
    assert_eq!(pieces.curves.len(), truth.double_curves, "{name}: {pieces}");
    // The undone immersion is the abstract surface: its homology is that of its pieces.
    let h = homology(&pieces.normalization.complex).unwrap();
    let closed = truth.pieces.iter().filter(|p| p.boundaries == 0);
    assert_eq!(h.betti_rational[0], truth.pieces.len(), "{name}");
    assert_eq!(
        h.betti_rational[2],
        closed.filter(|p| p.orientable).count(),
        "{name}"
    );
    let euler: i64 = truth.pieces.iter().map(|p| p.euler).sum();
    assert_eq!(h.euler, euler, "{name}");
    outcome
}

fn pieces(outcome: &Outcome) -> &Pieces {
    outcome.pieces.as_ref().unwrap()
}

/// How many neighborhoods of the given radius are not contractible, and how many balls hold another sheet.
fn not_contractible(outcome: &Outcome, radius: f64) -> (usize, usize) {
    let oracle = EuclideanOracle::new(outcome.mesh.vertices.clone()).unwrap();
    let found = local_homology(&outcome.mesh.complex, &oracle, radius, &Serial).unwrap();
    assert_eq!(found.neighborhoods, outcome.mesh.complex.vertices);
    (found.failures.len(), found.other_sheets)
}

#[test]
fn surfaces_with_a_boundary() {
    for (name, count, eps, dl, said) in [
        ("hemisphere", 5_000, 0.4, 0.15, "One disc."),
        ("square", 4_000, 0.4, 0.15, "One disc."),
        ("annulus", 5_000, 0.3, 0.1, "One annulus."),
        ("cylinder", 5_000, 0.4, 0.2, "One annulus."),
        // The windings are 0.63 apart.
        ("swiss_roll", 8_000, 0.3, 0.12, "One disc."),
    ] {
        let outcome = reconstruct(name, count, eps, dl);
        assert_eq!(pieces(&outcome).to_string(), said, "{name}");
        assert_eq!(not_contractible(&outcome, eps), (0, 0), "{name}");
    }
}

#[test]
fn boys_surface_is_a_projective_plane() {
    let outcome = reconstruct("boy_surface", 40_000, 0.15, 0.08);
    let text = pieces(&outcome).to_string();
    let said = "One projective plane. The projective plane crosses itself in one circle, covered twice by one one-sided \
                circle (crossing angle";
    assert!(text.starts_with(said), "{text}");
    assert!(text.ends_with("There is one triple point."), "{text}");
    let [curve] = &pieces(&outcome).curves[..] else {
        panic!("{text}");
    };
    // Three loops through the triple point in space, one circle that runs twice on the projective plane.
    assert_eq!(curve.preimages.len(), 1);
    assert_eq!(curve.preimages[0].sidedness, Some(Sidedness::OneSided));
    assert_eq!(not_contractible(&outcome, 0.16).0, 0);
}

#[test]
fn closed_surfaces_that_cross_in_two_circles() {
    for (name, count, eps, dl, said) in [
        (
            "torus_sphere",
            40_000,
            0.35,
            0.17,
            "One sphere and one torus. The sphere and the torus meet in two circles, each two-sided on the sphere and \
             two-sided on the torus (crossing angle",
        ),
        (
            "two_tori",
            60_000,
            0.3,
            0.15,
            "Two tori. Torus 1 and torus 2 meet in two circles, each two-sided on torus 1 and two-sided on torus 2 \
             (crossing angle",
        ),
    ] {
        let outcome = reconstruct(name, count, eps, dl);
        let text = pieces(&outcome).to_string();
        assert!(text.starts_with(said), "{text}");
        for curve in &pieces(&outcome).curves {
            assert!(curve.circle);
            let two_sided = Some(Sidedness::TwoSided);
            assert!(curve.preimages.iter().all(|p| p.sidedness == two_sided));
        }
        // Balls in which the surface is contractible, crossing or not; and balls that hold a whole tube.
        let (failures, others) = not_contractible(&outcome, 2.0 * dl);
        assert_eq!(failures, 0, "{name}");
        // Beside a crossing at less than a right angle some balls hold the other sheet and not the curve.
        assert!(
            others > 0 && others < outcome.mesh.complex.vertices / 5,
            "{name}: {others}"
        );
        assert!(not_contractible(&outcome, 2.3).0 > 100, "{name}");
    }
}
