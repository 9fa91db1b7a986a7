//! Random clouds of surfaces with known truth, reconstructed with no parameter but the seed.

use crosscap::auto::{Input, Search};
use crosscap::prelude::*;

fn search(name: &str, sampling: &Sampling) -> Search {
    let surface = SampleSurface::find(name).unwrap();
    let points = surface.sample(sampling).unwrap().points;
    Parameters::auto()
        .search(Input::Points(&points), &mut |asked| Pipeline::new(asked))
        .unwrap()
}

/// Where two sheets of Henneberg's surface part after their crossing ends, each is in the neighborhoods of the other's boundary for four
/// spacings and more. Seeds 21, 24 and 27 were refused at every attempt before boundaries were followed there; of these one is run, and
/// what is done by itself in the tests of `stratify/analysis/continued.rs`.
#[test]
fn a_boundary_goes_on_where_another_sheet_is_near() {
    let found = search("henneberg", &Sampling::new(12_800, 24));
    assert!(found.is_verified());
    let outcome = found.outcome.unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 5, 0]);
    let boundary = &outcome.certificate.edges.as_ref().unwrap().boundaries;
    assert_eq!(boundary.len(), 2, "{boundary:?}");
}

/// Half a spacing of noise, a tenth of eps: next to the crossing no point says by itself which sheet it is of.
#[test]
fn noise_where_sheets_cross_is_taken_away() {
    let sampling = Sampling {
        noise: 0.02,
        ..Sampling::new(20_000, 1)
    };
    let found = search("two_spheres", &sampling);
    let noise = found.preparation.as_ref().unwrap();
    assert!(noise.noise_of_spacing.unwrap() > 0.45);
    assert!(noise.moved.is_some());
    assert!(noise.unexplained < 20, "{}", noise.unexplained);
    assert!(found.is_verified());
    let outcome = found.outcome.unwrap();
    assert_eq!(outcome.homology.betti_rational, [1, 0, 3]);
}
