use super::*;
use crate::chart::ClassicalScaling;
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::landmarks::RandomGreedy;
use crate::metric::{BruteForceOracle, Euclidean};
use crate::space::Space;
use crate::stratify::{Analyzer, ChartSpace, Stratification, StratumKind, Tuning, WaistProducer};
use crosscap_core::{Landmark, PointCloud, Row};

fn published() -> Published {
    Published {
        eps: 0.5,
        tri_eps: 0.5,
        dp: 0.05,
        ep: 0.05,
        dl: 0.2,
        seed: 3,
        surface: false,
        boundary: Vec::new(),
    }
}

/// Points of the planes z = 0 and x = 0, |x|, |y|, |z| <= 1, spacing 0.1, none on the line.
fn cross() -> PointCloud<f64> {
    let mut rows = Vec::new();
    for i in 0..20 {
        for j in 0..20 {
            let (u, v) = (f64::from(i) * 0.1 - 0.95, f64::from(j) * 0.1 - 0.95);
            rows.extend([u, v, 0.0]);
            rows.extend([0.0, v + 0.03, u]);
        }
    }
    PointCloud::new(3, rows).unwrap()
}

fn run(
    method: &Published,
    cloud: &PointCloud<f64>,
) -> Result<(Analysis, Stratification<f64>), Error> {
    let metric = Euclidean::new(cloud.clone());
    let oracle = BruteForceOracle::new(&metric);
    let estimator = PrincipalComponents::new(0.05)?;
    let analyzer = Analyzer {
        space: Space::new(&metric, &oracle),
        estimator: &estimator,
        models: &[],
        execute: &Serial,
        tuning: &Tuning::MEASURED,
    };
    let analysis = method.analyze(&analyzer)?;
    let selector = RandomGreedy::new();
    let cut = method.cut(
        &analyzer,
        &analysis,
        ChartSpace::Places,
        &selector,
        &ClassicalScaling,
    )?;
    let out = cut.waist(&[])?;
    drop(cut);
    Ok((analysis, out))
}

#[test]
fn crossing_planes_are_divided_at_their_line() {
    let cloud = cross();
    // 0.05 from the line, and the tolerance is strict.
    let method = Published {
        ep: 0.06,
        ..published()
    };
    let (analysis, out) = run(&method, &cloud).unwrap();
    for (i, x) in analysis.sites.ids().zip(cloud.iter()) {
        let near = x[0].abs().max(x[2].abs()) < 0.06;
        assert_eq!(
            analysis.sites[i].kind() == Some(StratumKind::Curve),
            near,
            "{x:?}"
        );
    }
    let on_curve = |k: Landmark| out.waist.strata()[k] == 1;
    let mut divided = 0;
    for near in out.waist.neighborhoods() {
        assert!(!on_curve(near.center()));
        if analysis.dimensions[out.rows[near.center()]] != 3 {
            continue;
        }
        divided += 1;
        let sheet = |k: Landmark| cloud.point(out.rows[k].index())[2] == 0.0;
        for &m in near.members() {
            assert!(on_curve(m) || sheet(m) == sheet(near.center()));
        }
    }
    assert!(divided > 10, "{divided}");
}

#[test]
fn landmarks_keep_their_separation_and_curves_come_first() {
    let cloud = cross();
    let method = Published {
        ep: 0.06,
        ..published()
    };
    let (analysis, out) = run(&method, &cloud).unwrap();
    assert!(out.counts.curve_landmarks >= 5);
    for (k, &row) in out.rows.each() {
        assert_eq!(
            analysis.sites[row].kind() == Some(StratumKind::Curve),
            k.index() < out.counts.curve_landmarks
        );
        for other in out.rows.iter().take(k.index()) {
            assert!(cloud.squared_distance(row.index(), other.index()).sqrt() >= 0.2);
        }
    }
}

#[test]
fn a_rejected_fit_leaves_the_neighborhood_whole() {
    let cloud = cross();
    // No pair of planes comes within dp of points with noise.
    let method = Published {
        dp: 1e-12,
        ep: 0.06,
        ..published()
    };
    let noisy: Vec<f64> = cloud
        .coordinates()
        .iter()
        .enumerate()
        .map(|(k, x)| x + 1e-3 * ((k * 7919 % 101) as f64 / 101.0 - 0.5))
        .collect();
    let cloud = PointCloud::new(3, noisy).unwrap();
    let (analysis, out) = run(&method, &cloud).unwrap();
    assert!(analysis.sites.iter().all(|s| s.kind().is_none()));
    assert!(!analysis.unexplained.is_empty());
    assert_eq!(analysis.unexplained.len(), analysis.candidates());
    for near in out.waist.neighborhoods() {
        let ball = out.rows.iter().filter(|&&r| {
            let center = out.rows[near.center()];
            cloud.squared_distance(r.index(), center.index()).sqrt() < 0.5
        });
        assert_eq!(near.members().len(), ball.count());
    }
}

#[test]
fn a_given_boundary_becomes_one_ring_of_one_cell() {
    // A disk of radius 1 with 40 points on its rim.
    let mut rows = Vec::new();
    for k in 0..40 {
        let t = f64::from(k) * std::f64::consts::TAU / 40.0;
        rows.extend([t.cos(), t.sin()]);
    }
    for k in 0..300 {
        let (r, t) = (0.9 * (f64::from(k) / 300.0).sqrt(), f64::from(k) * 2.39996);
        rows.extend([r * t.cos(), r * t.sin()]);
    }
    let cloud = PointCloud::new(2, rows).unwrap();
    let method = Published {
        surface: true,
        boundary: (0..40).map(Row::new).collect(),
        ..published()
    };
    let (analysis, out) = run(&method, &cloud).unwrap();
    assert_eq!(
        analysis.sites[Row::new(0)].kind(),
        Some(StratumKind::Boundary)
    );
    let ring = out.counts.curve_landmarks;
    assert!(ring >= 10);
    assert_eq!(out.waist.curve_edges().len(), ring);
    for k in 0..ring as u32 {
        let edges = out.waist.curve_edges().iter();
        let own = edges.filter(|e| e.ends.contains(&k) && e.cells == 1);
        assert_eq!(own.count(), 2, "landmark {k}");
    }
}

#[test]
fn what_has_no_meaning_is_refused() {
    let cloud = cross();
    for method in [
        Published {
            dl: 0.0,
            ..published()
        },
        Published {
            tri_eps: f64::NAN,
            ..published()
        },
        Published {
            boundary: vec![Row::new(9999)],
            ..published()
        },
    ] {
        assert!(run(&method, &cloud).unwrap_err().is_input());
    }
}
