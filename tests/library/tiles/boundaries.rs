//! Surfaces with boundaries that are to be found, and models that are asked about every point, are the same in tiles.

use super::same::{same, sample};
use crosscap::prelude::*;

/// A surface with a boundary that is looked for, with other models or as a surface alone.
fn bounded(surface: bool) -> Parameters {
    Parameters {
        models: vec![ModelName::TwoPlanes, ModelName::Boundary],
        surface,
        ..Parameters::new(0.3, 0.15)
    }
}

#[test]
fn a_moebius_strip_is_the_same() {
    for surface in [true, false] {
        let cloud = sample("moebius", 6000, 2);
        let (strip, asked) = same(&cloud, &bounded(surface), 200_000, &[1, 4, 9]);
        assert!(strip.is_verified(), "{}", strip.certificate);
        assert_eq!(strip.homology.betti_rational, [1, 1, 0]);
        assert!(strip.mesh.complex.curve_edges.len() > 20);
        assert!(asked.names.contains(&"balls"));
    }
}

#[test]
fn a_hemisphere_needs_a_part_of_the_cloud_alone() {
    // Balls small beside the surface: the band about its boundary is narrow.
    let cloud = sample("hemisphere", 24_000, 3);
    let parameters = Parameters {
        models: vec![ModelName::TwoPlanes, ModelName::Boundary],
        ..Parameters::new(0.1, 0.05)
    };
    let (half, asked) = same(&cloud, &parameters, 3000, &[3, 8]);
    assert!(half.is_verified(), "{}", half.certificate);
    // The excerpt is the first of these.
    let part = asked.around[0] as f64 / cloud.len() as f64;
    assert!(part < 0.7, "{part}");
}

#[test]
fn all_models_say_the_same() {
    // Corners that go inward; double curves that end on boundaries; a curve through a sheet; sheets that meet in one point of R^4; a boundary that crosses
    // another sheet.
    for (name, count, eps, verified) in [
        ("l_plate", 8000, 0.15, true),
        ("two_squares", 12_000, 0.2, true),
        ("line_disc", 6000, 0.26, true),
        ("planes_r4", 12_000, 0.2, true),
        ("henneberg", 12_000, 1.3, false),
    ] {
        let parameters = Parameters {
            models: ModelName::AUTO.to_vec(),
            seed: 1,
            ..Parameters::new(eps, eps / 2.0)
        };
        let (found, _) = same(&sample(name, count, 1), &parameters, 4000, &[5]);
        assert!(
            found.is_verified() || !verified,
            "{name}: {}",
            found.certificate
        );
        let asked = |model: &str| {
            let mut counts = found.report.models.iter();
            counts.find(|counts| counts.name == model).unwrap().asked
        };
        assert!(asked("boundary") > count / 4, "{name}");
        assert!(asked("curve-through-sheet") > count / 4, "{name}");
    }
}
