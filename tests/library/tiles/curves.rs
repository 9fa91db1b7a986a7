//! Surfaces that cross themselves are the same in tiles, to the last bit, whatever the tiles are.

use super::same::{same, sample};
use crosscap::backends::euclidean::EuclideanOracle;
use crosscap::prelude::*;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{Analysis, AnalysisOptions, Analyzer, Site, Tuning};
use crosscap_algorithms::surfaces::RingConformations;
use crosscap_algorithms::tiles::{
    BallQuestion, Candidates, CloudRow, Excerpt, TilesInMemory, Tiling,
};
use crosscap_core::Row;

const EPS: f64 = 0.12;
const DT: f64 = 0.05;

/// What an analysis with the model of two planes says of a space.
fn analysis(
    space: Space<'_, f64>,
    analyze: impl FnOnce(&Analyzer<'_, f64>, &AnalysisOptions) -> Result<Analysis, Error>,
) -> Analysis {
    let analyzer = Analyzer {
        space,
        estimator: &PrincipalComponents::new(DT).unwrap(),
        models: &[ModelName::TwoPlanes.model(EPS / 5.0, EPS / 10.0).unwrap()],
        execute: &Serial,
        tuning: &Tuning::MEASURED,
    };
    let options = AnalysisOptions {
        eps: EPS,
        radii: None,
        surface: false,
        boundary: Vec::new(),
    };
    analyze(&analyzer, &options).unwrap()
}

#[test]
fn an_excerpt_says_of_every_row_what_the_cloud_says() {
    let cloud = sample("two_spheres", 40_000, 1);
    let tree = EuclideanOracle::new(cloud.clone()).unwrap();
    let whole = analysis(Space::of(&tree), |analyzer, o| analyzer.analyze(o));
    assert!(whole.curve_points() > 300, "{}", whole.curve_points());
    let tiling = Tiling::new(&cloud, 7);
    let tiles = TilesInMemory::new(&cloud, &tiling, EPS, 0, &Serial).unwrap();
    let question = BallQuestion {
        eps: EPS,
        dt: DT,
        least: 8,
        surface: false,
        looks: None,
    };
    let candidates = Candidates::of(&tiles, question).unwrap();
    assert_eq!(candidates.centers.len(), whole.candidates());
    let found = |reach: f64| {
        let excerpt = Excerpt::gather(&tiles, &candidates, reach).unwrap();
        let tree = EuclideanOracle::new(excerpt.cloud().clone()).unwrap();
        let oracle = excerpt.watched(&tree);
        let part = analysis(Space::new(&tree, &oracle), |analyzer, options| {
            analyzer.analyze_part(options, excerpt.balls())
        });
        (excerpt, part)
    };
    // A ball looked at, beside a curve that may be as far from a candidate as half of one.
    let (excerpt, part) = found(1.51 * EPS);
    assert!(excerpt.wider().is_none());
    assert!(4 * excerpt.rows().len() < cloud.len());
    for row in (0..cloud.len()).map(Row::new) {
        let at = excerpt.find(CloudRow::new(row.index()));
        let site = at.map_or(&Site::Regular, |at| &part.sites()[at]);
        assert!(site == &whole.sites()[row], "{row}");
    }
    assert_eq!(part.models(), whole.models());
    // One that is too narrow notices.
    let (narrow, _) = found(0.5 * EPS);
    assert!(narrow.wider().is_some_and(|wider| wider >= EPS));
}

#[test]
fn spheres_that_cross_are_the_same() {
    let cloud = sample("two_spheres", 30_000, 1);
    let parameters = Parameters::new(0.2, 0.1);
    let (spheres, asked) = same(&cloud, &parameters, 5000, &[1, 4, 16]);
    assert!(spheres.is_verified());
    assert_eq!(spheres.homology.betti_rational, [1, 0, 3]);
    // The excerpt is the first of these.
    let part = asked.around[0] as f64 / cloud.len() as f64;
    assert!(part < 0.8, "{part}");
    assert!(asked.names.contains(&"balls"));
}

#[test]
fn triple_points_are_the_same() {
    let parameters = Parameters {
        models: vec![
            ModelName::TwoPlanes,
            ModelName::TriplePoint,
            ModelName::YJunction,
        ],
        seed: 2,
        ..Parameters::new(0.4, 0.2)
    };
    let cloud = sample("boy", 12_000, 3);
    same(&cloud, &parameters, 200_000, &[5]);
}

#[test]
fn what_is_refused_is_refused_for_the_same_places() {
    // A curve that ends, which no model here explains.
    let cloud = sample("whitney_umbrella", 4000, 5);
    let (umbrella, _) = same(&cloud, &Parameters::new(0.3, 0.15), 3000, &[6]);
    assert!(!umbrella.is_verified());
}

#[test]
fn too_large_a_radius_is_told_for_the_same_row() {
    let cloud = sample("klein_immersion", 4000, 5);
    let pipeline = || Pipeline::new(Parameters::new(2.5, 0.6)).unwrap();
    let whole = pipeline().reconstruct(&cloud).unwrap_err();
    assert!(matches!(whole, Error::Dimension { .. }), "{whole}");
    let (tiling, halo) = (Tiling::new(&cloud, 5), pipeline().tile_halo());
    let tiles = TilesInMemory::new(&cloud, &tiling, halo, 0, &Serial).unwrap();
    assert_eq!(pipeline().reconstruct_tiles(&tiles).unwrap_err(), whole);
    // And too small a one.
    let pipeline = || Pipeline::new(Parameters::new(0.01, 0.005)).unwrap();
    let whole = pipeline().reconstruct(&cloud).unwrap_err();
    let (tiling, halo) = (Tiling::new(&cloud, 5), pipeline().tile_halo());
    let tiles = TilesInMemory::new(&cloud, &tiling, halo, 0, &Serial).unwrap();
    assert_eq!(pipeline().reconstruct_tiles(&tiles).unwrap_err(), whole);
}

#[test]
fn conformations_of_cyclo_octane_are_the_same() {
    let ring = RingConformations::cyclo_octane();
    let cloud = ring.sample(30_000, 1).unwrap().points;
    let parameters = Parameters {
        dp: 0.1,
        ep: 0.04,
        ..Parameters::new(0.35, 0.2)
    };
    let (conformations, _) = same(&cloud, &parameters, 200_000, &[3]);
    assert!(conformations.is_verified());
}
