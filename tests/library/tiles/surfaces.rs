//! Surfaces that do not cross themselves, and what is not taken.

use super::same::{same, sample};
use crosscap::prelude::*;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::surfaces::Random;
use crosscap_algorithms::tiles::{TilesInMemory, Tiling};

#[test]
fn closed_surfaces_are_the_same() {
    // With more points than the certificate looks at.
    let parameters = Parameters::new(0.6, 0.3).surface();
    let (torus, _) = same(&sample("torus", 4000, 1), &parameters, 3000, &[1, 5]);
    assert!(torus.is_verified());
}

#[test]
fn landmarks_are_added_in_the_same_places() {
    // Where triangles stray from the points, in R^5.
    let parameters = Parameters {
        seed: 3,
        ..Parameters::new(1.0, 0.3).surface()
    };
    let (bottle, asked) = same(&sample("klein_r5", 3000, 2), &parameters, 200_000, &[3]);
    assert!(bottle.report.added_landmarks > 0);
    assert!(asked.names.contains(&"around"));
}

#[test]
fn points_that_are_left_behind_are_the_same() {
    let parameters = Parameters::new(0.6, 0.3).surface();
    let (thorns, asked) = same(&thorny(), &parameters, 200_000, &[3]);
    assert!(thorns.report.added_landmarks > 0);
    assert!(asked.names.contains(&"behind"), "{asked:?}");
}

/// A unit sphere with thorns that are almost as long as landmarks are apart.
fn thorny() -> PointCloud<f64> {
    let mut random = Random::new(1);
    let mut direction = || {
        let x = [0; 3].map(|_| random.normal());
        let norm = x.iter().map(|c| c * c).sum::<f64>().sqrt();
        x.map(|c| c / norm)
    };
    let mut rows: Vec<f64> = (0..2000).flat_map(|_| direction()).collect();
    for _ in 0..10 {
        let tip = direction();
        for k in 0..40 {
            let height = f64::from(k) / 40.0;
            let beside = direction().map(|c| 0.06 * (1.0 - height) * c);
            rows.extend((0..3).map(|c| (1.0 + 0.27 * height) * tip[c] + beside[c]));
        }
    }
    PointCloud::new(3, rows).unwrap()
}

#[test]
fn a_surface_that_is_refused_is_refused_for_the_same_places() {
    // Too few points for the separation, and a rim that nobody named.
    let open = sample("hemisphere", 1500, 4);
    let (open, _) = same(&open, &Parameters::new(0.4, 0.2).surface(), 1000, &[4]);
    assert!(!open.is_verified());
}

#[test]
fn a_grid_with_all_its_ties_is_the_same() {
    // The faces of a cube: distances tie everywhere, and edges leave points behind.
    let mut rows = Vec::new();
    for i in 0..=20 {
        for j in 0..=20 {
            for k in 0..=20 {
                if [i, j, k].iter().any(|x| x % 20 == 0) {
                    rows.extend([i, j, k].map(f64::from));
                }
            }
        }
    }
    let cube = PointCloud::new(3, rows).unwrap();
    let (cube, asked) = same(
        &cube,
        &Parameters::new(5.0, 3.0).surface(),
        200_000,
        &[4, 9],
    );
    println!(
        "{} {asked:?} {}",
        cube.is_verified(),
        cube.report.added_landmarks
    );
}

#[test]
fn what_tiles_cannot_be_asked_about_is_refused() {
    let cloud = sample("sphere", 600, 1);
    let ask = |parameters: Parameters, cloud: &PointCloud<f64>| {
        let mut pipeline = Pipeline::new(parameters).unwrap();
        let tiling = Tiling::new(cloud, 3);
        let tiles = TilesInMemory::new(cloud, &tiling, pipeline.tile_halo(), 0, &Serial).unwrap();
        pipeline.reconstruct_tiles(&tiles).map(drop)
    };
    let everywhere = ModelName::CurveThroughSheet.model(0.1, 0.05).unwrap();
    let own = Pipeline::new(Parameters::new(0.6, 0.3)).unwrap();
    assert!(matches!(
        own.models(vec![everywhere]).takes_tiles(),
        Err(Error::Parameter { name: "models", value, .. }) if value == "curve-through-sheet"
    ));
    let sphere = Parameters::new(0.6, 0.3).surface();
    let mut pipeline = Pipeline::new(sphere).unwrap();
    let narrow = 0.9 * pipeline.tile_halo();
    let tiles = TilesInMemory::new(&cloud, &Tiling::new(&cloud, 3), narrow, 0, &Serial).unwrap();
    let narrow = pipeline.reconstruct_tiles(&tiles);
    assert!(matches!(narrow, Err(Error::Parameter { name: "halo", .. })));
    let boundary = Parameters {
        boundary: vec![1],
        ..Parameters::new(0.6, 0.3).surface()
    };
    assert!(matches!(
        ask(boundary, &cloud),
        Err(Error::Parameter {
            name: "boundary",
            ..
        })
    ));
    let twice = [cloud.coordinates(), cloud.point(7)].concat();
    let copies = ask(
        Parameters::new(0.6, 0.3).surface(),
        &PointCloud::new(3, twice).unwrap(),
    );
    assert!(matches!(copies, Err(Error::Shape { found, .. }) if found.contains("first row 600")));
    // A lone point, whose nearest neighbors nobody near it has.
    let far = [cloud.coordinates(), &[9.0, 9.0, 9.0][..]].concat();
    let lone = ask(
        Parameters::new(0.6, 0.3).surface(),
        &PointCloud::new(3, far).unwrap(),
    );
    assert!(
        matches!(lone, Err(Error::SparseNeighborhood { point: 600, .. })),
        "{lone:?}"
    );
}
