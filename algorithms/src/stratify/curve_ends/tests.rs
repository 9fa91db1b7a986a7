//! Pinch points from the points alone, as far as the certificate.

use super::*;
use crate::certificate::{CertificateOptions, SpecialPoint, certify};
use crate::chart::ClassicalScaling;
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::homology::homology;
use crate::landmarks::RandomGreedy;
use crate::metric::{BruteForceOracle, Euclidean};
use crate::predicate::PlanarPredicate;
use crate::singularity::ModelName;
use crate::space::Space;
use crate::stratify::{
    AnalysisOptions, ChartSpace, Cut, Dimensions, StratifyOptions, Tuning, WaistProducer,
};
use crate::surfaces::{PointKind, SampleSurface, Sampling};
use crate::triangulate::{LargestAngle, Rules, Triangulator};
use crosscap_core::{Complex, CurveEdge, LinkKind, Mesh, SingularityModel};

/// What came of one cloud.
struct Found {
    verified: bool,
    betti: [usize; 3],
    /// How far each pinch point is from the nearest true one, in dl.
    off: Vec<f64>,
    text: String,
}

fn reconstruct(name: &str, count: usize, seed: u64, eps: f64, models: &[ModelName]) -> Found {
    let surface = SampleSurface::find(name).unwrap();
    let mut sampling = Sampling::new(count, seed);
    sampling.boundary = surface.has_boundary();
    let sample = surface.sample(&sampling).unwrap();
    let cloud = sample.points;
    let metric = Euclidean::new(cloud.clone());
    let oracle = BruteForceOracle::new(metric.clone());
    let dl = eps / 2.5;
    let models: Vec<Box<dyn SingularityModel>> = (models.iter())
        .map(|m| m.model(eps / 5.0, eps / 10.0).unwrap())
        .collect();
    let principal = PrincipalComponents::new(0.05).unwrap();
    let analyzer = Analyzer {
        space: Space::new(&metric, &oracle).with_places(&cloud),
        dimensions: Dimensions::by(&principal),
        models: &models,
        execute: &Serial,
        tuning: &Tuning::MEASURED,
    };
    let analysis = analyzer
        .analyze(&AnalysisOptions {
            eps,
            radii: None,
            surface: false,
            boundary: sample.boundary,
        })
        .unwrap();
    let options = StratifyOptions {
        dl,
        tri_eps: 3.0 * dl,
        seed,
    };
    let selector = RandomGreedy::new();
    let cut = Cut::new(
        &analyzer,
        &analysis,
        ChartSpace::Places,
        &selector,
        &options,
    )
    .unwrap();
    let made = cut.waist(&[]).unwrap();
    let triangulation = Triangulator {
        chart: &ClassicalScaling,
        test: &PlanarPredicate,
        rule: &LargestAngle,
        largest_circumradius: f64::INFINITY,
        repair: true,
        rules: Rules::MEASURED,
    }
    .triangulate(&made.waist)
    .unwrap();
    let complex = &triangulation.complex;
    let places = cut.strata().places().unwrap().select(&made.rows);
    let used: Vec<u32> = (0..complex.vertices as u32)
        .filter(|v| !triangulation.dropped.contains(v))
        .collect();
    let name_of = |v: u32| used.binary_search(&v).unwrap() as u32;
    let triangles = complex.triangles.iter().map(|t| t.map(name_of));
    let edges = (complex.curve_edges.iter())
        .map(|e| CurveEdge::new(name_of(e.ends[0]), name_of(e.ends[1]), e.cells));
    let kept: Vec<usize> = used.iter().map(|&v| v as usize).collect();
    let complex = Complex::new(used.len(), triangles.collect(), edges.collect()).unwrap();
    let mesh = Mesh::new(complex, places.select(&kept), vec![-1; kept.len()]).unwrap();
    let special: Vec<SpecialPoint> = (made.points.iter())
        .map(|p| SpecialPoint {
            vertex: name_of(p.landmark),
            link: p.link.clone().unwrap(),
        })
        .collect();
    let certificate = certify(
        &mesh,
        &CertificateOptions {
            points: Some(&cloud),
            landmark_separation: Some(dl),
            special_points: &special,
            ..CertificateOptions::default()
        },
    );
    let truth = surface.points().iter();
    let pinches: Vec<&Vec<f64>> = (truth.filter(|p| p.kind == PointKind::Pinch))
        .map(|p| &p.place)
        .collect();
    let off = (special.iter().filter(|s| s.link.kind() == LinkKind::Pinch))
        .map(|s| {
            let place = mesh.vertices.point(s.vertex as usize);
            let squares = pinches.iter().map(|p| squared_distance(p, place));
            squares.fold(f64::INFINITY, f64::min).sqrt() / dl
        })
        .collect();
    Found {
        verified: certificate.verdict().is_verified(),
        betti: homology(&mesh.complex).unwrap().betti_rational,
        off,
        text: format!("{name} {seed}: {certificate}"),
    }
}

const MODELS: [ModelName; 2] = [ModelName::TwoPlanes, ModelName::PinchPoint];

#[test]
fn a_cross_cap_has_two_pinch_points() {
    let found = reconstruct("cross_cap", 10_000, 3, 0.117, &MODELS);
    assert!(found.verified, "{}", found.text);
    assert_eq!(found.betti, [1, 0, 1]);
    assert_eq!(found.off.len(), 2);
    assert!(found.off.iter().all(|&d| d < 0.5), "{:?}", found.off);
}

/// `cargo test -p crosscap-algorithms --lib pinches_of_many_seeds -- --ignored --nocapture`
#[test]
#[ignore = "a minute"]
fn pinches_of_many_seeds() {
    let with_triple = [MODELS[0], MODELS[1], ModelName::TriplePoint];
    for (name, count, eps, models, betti) in [
        ("cross_cap", 10_000, 0.118, &MODELS[..], [1, 0, 1]),
        ("whitney_umbrella", 5_000, 0.228, &MODELS[..], [1, 0, 0]),
        ("roman", 10_000, 0.106, &with_triple[..], [1, 0, 4]),
    ] {
        let mut good = 0;
        for seed in 0..20 {
            let found = reconstruct(name, count, seed, eps, models);
            assert!(!found.verified || found.betti == betti, "{}", found.text);
            good += usize::from(found.verified);
            let off = found.off.iter().copied().fold(0.0, f64::max);
            println!(
                "{name} {seed}: {} {:?} {} pinches, {off:.2} dl off",
                found.verified,
                found.betti,
                found.off.len()
            );
            if !found.verified {
                println!(
                    "{}",
                    found.text.lines().take(12).collect::<Vec<_>>().join("\n")
                );
            }
        }
        println!("{name}: {good} of 20");
    }
}
