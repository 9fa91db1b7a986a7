//! What earlier attempts found in the points, so that no later one passes over it.
//!
//! A search makes many meshes of the same points. The gap that is no chance under one of them is the same gap under the next, which
//! may happen to cover only a part of it, too little for a finding of its own. A verdict that looks at the last mesh alone
//! forgets what was known; here it is kept.

use crate::pipeline::Outcome;
use crosscap_algorithms::certificate::{Gap, ViolationKind, distances_to_mesh};
use crosscap_core::{Mesh, PointCloud};

/// Probability below which a gap is kept. One that is found at the limit of the certificate may be a false alarm, as a thousandth of all
/// meshes have, and another mesh may then be right: a sphere of 5,000 points (1.4e-4) and a plate with a bent slit (2.3e-5) were. None of
/// those was below this.
const BEYOND_DOUBT: f64 = 1e-6;
/// Part of the inner places of a gap that a mesh may cover: at the ends of a slit it may be closed a little early.
const CLOSED: f64 = 0.25;
/// How far from an inner place a mesh covers it, in radii of the empty disc there: nearer than any point, and farther than a
/// chord is from its arc.
const NEAR: f64 = 0.25;

/// Gaps that are no chance, each found under a mesh with which nothing else was wrong.
#[derive(Default)]
pub(super) struct Evidence {
    gaps: Vec<Gap>,
}

impl Evidence {
    /// Keeps what was found in an attempt. Where more is wrong with a mesh than the gaps that it covers, these may be its own:
    /// triangles through the air.
    pub fn keep(&mut self, outcome: &Outcome) {
        let certificate = &outcome.certificate;
        let mut kinds = certificate.violations().map(|v| v.kind);
        if outcome.failures.is_empty() && kinds.all(|kind| kind == ViolationKind::BridgedGap) {
            let found = certificate.faithful.iter().flat_map(|f| &f.bridged);
            let kept = found.filter(|gap| gap.p < BEYOND_DOUBT);
            self.gaps.extend(kept.cloned());
        }
    }

    /// Whether a mesh covers one of the gaps.
    pub fn speaks_against(&self, mesh: &Mesh) -> bool {
        self.gaps.iter().any(|gap| covered(gap, mesh) > CLOSED)
    }
}

/// Which part of the inner places of a gap a mesh covers.
fn covered(gap: &Gap, mesh: &Mesh) -> f64 {
    let Ok(places) = PointCloud::new(mesh.vertices.dimension(), gap.inner.clone()) else {
        return 0.0;
    };
    if places.is_empty() {
        return 0.0;
    }
    let away = distances_to_mesh(mesh, &places);
    let near = away.iter().filter(|&&away| away < NEAR * gap.depth);
    near.count() as f64 / places.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::certificate::{CertificateOptions, certify};
    use crosscap_algorithms::surfaces::Random;
    use crosscap_core::{Complex, CurveEdge};
    use std::collections::BTreeMap;

    /// Squares along a side of the plate [-1, 1]^2.
    const SQUARES: usize = 20;

    /// The plate in squares cut in two, without those whose middle is `open`.
    fn plate(open: impl Fn(f64, f64) -> bool) -> Mesh {
        let side = |k: usize| 2.0 * k as f64 / SQUARES as f64 - 1.0;
        let half = 1.0 / SQUARES as f64;
        let places: Vec<f64> = (0..(SQUARES + 1).pow(2))
            .flat_map(|v| [side(v / (SQUARES + 1)), side(v % (SQUARES + 1))])
            .collect();
        let mut triangles = Vec::new();
        for (i, j) in (0..SQUARES).flat_map(|i| (0..SQUARES).map(move |j| (i, j))) {
            if !open(side(i) + half, side(j) + half) {
                let at = |i: usize, j: usize| (i * (SQUARES + 1) + j) as u32;
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let mut counts: BTreeMap<[u32; 2], u8> = BTreeMap::new();
        for t in &triangles {
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                *counts.entry([t[i].min(t[j]), t[i].max(t[j])]).or_default() += 1;
            }
        }
        let rim = counts.iter().filter(|c| *c.1 == 1);
        let curves = rim.map(|(e, _)| CurveEdge::new(e[0], e[1], 1)).collect();
        let count = places.len() / 2;
        let complex = Complex::new(count, triangles, curves).unwrap();
        Mesh::new(
            complex,
            PointCloud::new(2, places).unwrap(),
            vec![-1; count],
        )
        .unwrap()
    }

    /// A cut through a plate, found under the whole of it: a mesh that goes across a part of it covers it, one that leaves it open, or
    /// closes its end a little early, does not.
    #[test]
    fn a_gap_that_was_found_speaks_against_a_bridge_over_it() {
        let mut random = Random::stream(3, 0);
        let mut rows = Vec::new();
        while rows.len() < 2 * 2000 {
            let [x, y] = std::array::from_fn(|_| random.between(-1.0, 1.0));
            if f64::abs(x) > 0.06 {
                rows.extend([x, y]);
            }
        }
        let points = PointCloud::new(2, rows).unwrap();
        let options = CertificateOptions {
            points: Some(&points),
            landmark_separation: Some(0.15),
            ..CertificateOptions::default()
        };
        let whole = plate(|_, _| false);
        let gaps = certify(&whole, &options).faithful.unwrap().bridged;
        assert!(!gaps.is_empty());
        let evidence = Evidence { gaps };
        let across = |low: f64, high: f64| plate(|x, y| x.abs() < 0.1 && !(low..high).contains(&y));
        assert!(evidence.speaks_against(&whole));
        assert!(evidence.speaks_against(&across(0.0, 0.7)));
        assert!(!evidence.speaks_against(&across(0.0, 0.0)));
        assert!(!evidence.speaks_against(&across(0.85, 1.0)));
        assert!(!Evidence::default().speaks_against(&whole));
    }
}
