//! A triangulator of one's own: triangles on which the Delaunay stars of all three corners agree.
//!
//! Every landmark lays its neighborhood out and takes the Delaunay triangles around itself. Where a chart is flat,
//! neighbors find the same triangles; where it bends, a few of them differ, and those stars are called open.

use crosscap::algorithms::chart::ClassicalScaling;
use crosscap::algorithms::homology::homology;
use crosscap::core::laws::{self, Settings};
use crosscap::core::{
    Complex, Error, Incomplete, Landmark, LocalChart, StratifiedLandmarks, Table, Triangulation,
    TriangulationCounts, Triangulator,
};
use std::collections::BTreeMap;

/// Agreeing Delaunay stars, in charts of its own.
struct Consensus<C>(C);

impl<C: LocalChart> Consensus<C> {
    /// The Delaunay triangles at the center of a neighborhood: an empty circle goes through their corners.
    fn star(
        &self,
        waist: &StratifiedLandmarks<f64>,
        members: &[Landmark],
    ) -> Result<Vec<[Landmark; 3]>, Error> {
        let k = members.len();
        let between = |i: usize, j: usize| waist.distances().get(members[i], members[j]);
        let matrix: Vec<f64> = (0..k * k)
            .map(|e| between(e / k, e % k).unwrap_or(0.0))
            .collect();
        let places = self.0.chart(k, &matrix, 2)?.coordinates;
        // With the center at the origin, a point is inside the circle through the origin, p and q where this is positive.
        let at = |i: usize| [places[2 * i] - places[0], places[2 * i + 1] - places[1]];
        let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let lift = |p: [f64; 2]| p[0] * p[0] + p[1] * p[1];
        let inside = |p: [f64; 2], q: [f64; 2], x: [f64; 2]| {
            let sum = lift(p) * cross(q, x) + lift(q) * cross(x, p) + lift(x) * cross(p, q);
            -sum * cross(p, q).signum()
        };
        let mut star = Vec::new();
        for i in 1..k {
            for j in i + 1..k {
                let (p, q) = (at(i), at(j));
                let others = (1..k).filter(|&x| x != i && x != j);
                if cross(p, q) != 0.0 && others.clone().all(|x| inside(p, q, at(x)) < 0.0) {
                    let mut corners = [members[0], members[i], members[j]];
                    corners.sort_unstable();
                    star.push(corners);
                }
            }
        }
        Ok(star)
    }
}

impl<C: LocalChart> Triangulator<f64> for Consensus<C> {
    fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
        // How many corners know a triangle.
        let mut known: BTreeMap<[Landmark; 3], usize> = BTreeMap::new();
        for near in waist.neighborhoods() {
            for corners in self.star(waist, near.members())? {
                *known.entry(corners).or_default() += 1;
            }
        }
        let count = waist.strata().len();
        let mut open: Table<Landmark, bool> = Table::filled(count, false);
        for (corners, _) in known.iter().filter(|&(_, &n)| n < 3) {
            corners.iter().for_each(|&c| open[c] = true);
        }
        known.retain(|_, n| *n == 3);
        Ok(Triangulation {
            complex: Complex::new(
                count,
                known.into_keys().map(|t| t.map(u32::from)).collect(),
                waist.curve_edges().to_vec(),
            )?,
            dropped: Vec::new(),
            incomplete: (open.ids())
                .filter(|&k| open[k])
                .map(|landmark| Incomplete { landmark })
                .collect(),
            counts: TriangulationCounts {
                visits: waist.neighborhoods().len(),
                ..TriangulationCounts::default()
            },
        })
    }

    fn name(&self) -> &str {
        "consensus"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::triangulator(&Settings::default(), &Consensus(ClassicalScaling))?;

    // A torus that is flat, as none in space is: two angles, and the shorter way round in each.
    use crosscap::backends::files::Distances;
    use crosscap::prelude::*;
    let n = 40 * 40;
    let way = |a: f64, b: f64| {
        let d = (a - b).abs();
        d.min(1.0 - d)
    };
    // A lattice that is shaken, so that no four points are on one circle.
    let angles: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let shake = |i: usize| ((k * i * i % 9973) as f64 * 0.618).fract() - 0.5;
            let at = |cell: usize, s: f64| (cell as f64 + 0.8 * s) / 40.0;
            [at(k / 40, shake(31)), at(k % 40, shake(57))]
        })
        .collect();
    let values = (0..n * n).map(|e| {
        let (p, q) = (angles[e / n], angles[e % n]);
        way(p[0], q[0]).hypot(way(p[1], q[1]))
    });
    let distances = Distances::Dense {
        count: n,
        values: values.collect(),
    };
    let outcome = Pipeline::new(Parameters::new(0.2, 0.06).surface())?
        .triangulator(Box::new(Consensus(ClassicalScaling)))
        .reconstruct_distances(&distances)?;
    let complex = &outcome.mesh.complex;
    println!(
        "{}: {} triangles, {} open stars, Betti numbers {:?}, verified: {}",
        outcome.report.plugins.triangulator,
        complex.triangles.len(),
        outcome.failures.len(),
        homology(complex)?.betti_rational,
        outcome.is_verified()
    );
    Ok(())
}
