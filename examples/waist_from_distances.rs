//! Triangulation from distances alone: the waist filled by hand, no coordinates anywhere behind it.
//!
//! `cargo run --release --example waist_from_distances`

use crosscap::algorithms::chart::ClassicalScaling;
use crosscap::algorithms::homology::homology;
use crosscap::algorithms::predicate::PlanarPredicate;
use crosscap::algorithms::triangulate::{AdvancingFront, LargestAngle, Rules};
use crosscap::algorithms::tuning::FrontTuning;
use crosscap::core::{
    CellNeighborhood, Landmark, SparseDistances, StratifiedLandmarks, Table, Triangulator,
};

/// Great-circle distances of `n` places spread over the unit sphere: stands for a measured matrix.
fn measured(n: usize) -> Vec<f64> {
    let places: Vec<[f64; 3]> = (0..n)
        .map(|k| {
            let z = 1.0 - (2 * k + 1) as f64 / n as f64;
            let angle = k as f64 * std::f64::consts::PI * (3.0 - 5_f64.sqrt());
            let r = (1.0 - z * z).sqrt();
            [r * angle.cos(), r * angle.sin(), z]
        })
        .collect();
    let arc = |p: &[f64; 3], q: &[f64; 3]| {
        let chord = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        2.0 * (chord / 2.0).min(1.0).asin()
    };
    places
        .iter()
        .flat_map(|p| places.iter().map(move |q| arc(p, q)))
        .collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n = 400;
    let distances = measured(n);
    let distance = |a: usize, b: usize| distances[a * n + b];
    // Places are about 0.18 apart; charts of about three times that.
    let radius = 0.55;
    let neighborhoods: Vec<CellNeighborhood> = (0..n)
        .map(|center| {
            let mut members: Vec<usize> =
                (0..n).filter(|&m| distance(center, m) < radius).collect();
            // The center first, since nothing is nearer to it.
            members.sort_by(|&a, &b| {
                distance(center, a)
                    .total_cmp(&distance(center, b))
                    .then(a.cmp(&b))
            });
            CellNeighborhood::new(
                Landmark::new(center),
                members.into_iter().map(Landmark::new),
            )
        })
        .collect();
    // Two members of one chart are nearer than two radii.
    let pairs = (0..n).flat_map(|a| (0..a).map(move |b| (a, b)));
    let kept = pairs.filter(|&(a, b)| distance(a, b) < 2.0 * radius);
    let kept = kept.map(|(a, b)| (Landmark::new(a), Landmark::new(b), distance(a, b)));
    let distances = SparseDistances::new(n, kept)?;
    let strata = Table::filled(n, 2);
    let waist = StratifiedLandmarks::new(strata, Vec::new(), neighborhoods, distances)?;
    let triangulation = AdvancingFront {
        chart: &ClassicalScaling,
        test: &PlanarPredicate,
        rule: &LargestAngle,
        largest_circumradius: f64::INFINITY,
        repair: true,
        rules: Rules::MEASURED,
        tuning: &FrontTuning::MEASURED,
    }
    .triangulate(&waist)?;
    let found = homology(&triangulation.complex)?;
    println!(
        "{} triangles, {} open stars, {} repairs, Betti numbers {:?}",
        triangulation.complex.triangles.len(),
        triangulation.incomplete.len(),
        triangulation.counts.repairs,
        found.betti_rational
    );
    assert_eq!(found.betti_rational, [1, 0, 1], "a sphere");
    Ok(())
}
