//! Gaps of samples that are more even than random ones.

use super::*;
use std::f64::consts::PI;

/// Points along a side: 3,600 of them, a thirtieth apart.
const SIDE: usize = 60;
const APART: f64 = 2.0 / SIDE as f64;

/// A shaken grid of the plate, without what lies in one of the discs (middle, radius).
fn grid(seed: u64, voids: &[([f64; 2], f64)]) -> PointCloud<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut rows = Vec::new();
    for k in 0..SIDE * SIDE {
        let mut at = |i: usize| (i as f64 + random.random_range(0.2..0.8)) * APART - 1.0;
        let (x, y) = (at(k / SIDE), at(k % SIDE));
        let empty = |&([a, b], r): &([f64; 2], f64)| (x - a).hypot(y - b) < r;
        if !voids.iter().any(empty) {
            rows.extend([x, y, 0.0]);
        }
    }
    PointCloud::new(3, rows).unwrap()
}

/// Voids of all sizes as a scan has them: the areas, in points, begin at 1.5 and become rarer by a factor e for each 0.9 more.
fn scanned(seed: u64) -> Vec<([f64; 2], f64)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut one = || {
        let middle = [(); 2].map(|()| random.random_range(-0.9..0.9));
        let points = 1.5 - 0.9 * random.random_range(0.0_f64..1.0).ln();
        (middle, (points / PI).sqrt() * APART)
    };
    (0..60).map(|_| one()).collect()
}

fn gaps(points: &PointCloud<f64>) -> usize {
    let certificate = judged(&plate_of(30, |_, _| false), points);
    let gaps = (certificate.violations()).filter(|v| v.kind == ViolationKind::BridgedGap);
    gaps.map(|v| v.count).sum()
}

#[test]
fn a_gap_that_follows_from_the_others_is_no_hole() {
    for seed in 0..6 {
        assert_eq!(gaps(&grid(seed, &[])), 0, "{seed}");
        assert_eq!(gaps(&grid(seed, &scanned(seed))), 0, "{seed}");
    }
}

#[test]
fn a_hole_stands_out_among_the_gaps_of_a_scan() {
    for seed in 0..6 {
        let mut voids = scanned(seed);
        voids.push(([0.1, -0.2], 2.7 * APART));
        assert!(gaps(&grid(seed, &voids)) > 0, "{seed}");
    }
}

/// A single gap of a size that a random sample has by chance, and a sieve of them.
#[test]
fn holes_of_a_grid_stand_out_alone_and_as_a_sieve() {
    let hole = |k: usize| {
        let at = |i: usize| 0.4 * i as f64 - 0.6;
        ([at(k / 4), at(k % 4)], 1.6 * APART)
    };
    for seed in 0..3 {
        let all: Vec<_> = (0..16).map(hole).collect();
        assert!(gaps(&grid(seed, &all[5..6])) > 0, "{seed}");
        assert!(gaps(&grid(seed, &all)) > 0, "{seed}");
    }
}
