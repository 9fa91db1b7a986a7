//! Creases and corners of meshes that the program makes.

use crosscap::prelude::*;

/// The faces, creases and corners of a surface of the catalogue, reconstructed at given lengths.
fn counted(name: &str, count: usize, [eps, dl]: [f64; 2]) -> [usize; 3] {
    let sampling = Sampling::new(count, 3);
    let sample = SampleSurface::find(name)
        .unwrap()
        .sample(&sampling)
        .unwrap();
    let parameters = Parameters::new(eps, dl).surface();
    let outcome = Pipeline::new(parameters)
        .unwrap()
        .reconstruct(&sample.points)
        .unwrap();
    assert!(outcome.is_verified(), "{name}");
    let creases = outcome.creases.unwrap();
    [creases.faces, creases.creases.len(), creases.corners.len()]
}

#[test]
fn what_has_edges_is_told_by_them() {
    assert_eq!(counted("can", 4000, [0.25, 0.15]), [3, 2, 0]);
    assert_eq!(counted("octahedron", 4000, [0.2, 0.1]), [8, 12, 6]);
}

#[test]
fn what_has_none_is_one_face() {
    assert_eq!(counted("sphere", 2000, [0.3, 0.25]), [1, 0, 0]);
    assert_eq!(counted("torus", 4000, [0.6, 0.4]), [1, 0, 0]);
}
