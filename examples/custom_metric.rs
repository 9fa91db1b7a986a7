//! A metric space of one's own: a periodic box, as in simulations of materials.
//!
//! `cargo run --release --example custom_metric`

use crosscap::algorithms::homology::homology;
use crosscap::algorithms::landmarks::RandomGreedy;
use crosscap::algorithms::surfaces::Random;
use crosscap::{Parameters, Pipeline};
use crosscap_core::laws::{self, Scan, Settings};
use crosscap_core::{
    CellNeighborhood, Landmark, LandmarkSelector, MetricSpace, NeighborhoodOracle, PointCloud,
    SparseDistances, StratifiedLandmarks, Table,
};

/// Points of a cube whose opposite faces are one: what leaves it on one side comes back on the other.
pub struct PeriodicBox {
    pub cloud: PointCloud<f64>,
    pub side: f64,
}

impl MetricSpace for PeriodicBox {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn distance(&self, a: usize, b: usize) -> f64 {
        let pairs = self.cloud.point(a).iter().zip(self.cloud.point(b));
        let squares = pairs.map(|(x, y)| {
            // The absolute value first: what follows is then symmetric to the bit.
            let apart = (x - y).abs() % self.side;
            apart.min(self.side - apart).powi(2)
        });
        squares.sum::<f64>().sqrt()
    }

    fn name(&self) -> &str {
        "periodic"
    }
}

/// A torus without an embedding: points of the unit square, whose opposite sides are one. No
/// coordinates can stand for its distances, so they go into the waist: landmarks, the
/// landmarks around each of them, and the distances between these.
fn flat_torus(
    count: usize,
    dl: f64,
) -> Result<StratifiedLandmarks<f64>, Box<dyn std::error::Error>> {
    let mut random = Random::new(11);
    let cloud = PointCloud::new(2, (0..2 * count).map(|_| random.uniform()).collect())?;
    let metric = PeriodicBox { cloud, side: 1.0 };
    let oracle = Scan(&metric);
    let all: Vec<usize> = (0..count).collect();
    let rows = RandomGreedy::new().select(&oracle, &all, &[], dl, 0)?;
    let rows: Table<Landmark, usize> = rows.into();
    let mut place = vec![None; count];
    for (k, &row) in rows.each() {
        place[row] = Some(k);
    }
    let mut near = Vec::new();
    let mut neighborhoods = Vec::new();
    let mut distances = Vec::new();
    for (center, &row) in rows.each() {
        oracle.within(row, 3.0 * dl, &mut near);
        // Sorted by distance, so that the center comes first.
        let members: Vec<Landmark> = near.iter().filter_map(|x| place[x.index]).collect();
        for (k, &a) in members.iter().enumerate() {
            let with = |&b: &Landmark| (a, b, metric.distance(rows[a], rows[b]));
            distances.extend(members[..k].iter().map(with));
        }
        neighborhoods.push(CellNeighborhood::new(center, members));
    }
    let distances = SparseDistances::new(rows.len(), distances)?;
    let strata = Table::filled(rows.len(), 2);
    let waist = StratifiedLandmarks::new(strata, Vec::new(), neighborhoods, distances)?;
    Ok(waist)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::metric(&Settings::default(), |cloud| PeriodicBox {
        cloud: cloud.clone(),
        side: 2.5,
    })?;
    println!("the periodic box obeys the laws of MetricSpace");

    let cloud = PointCloud::new(2, vec![0.1, 0.5, 0.9, 0.5, 0.5, 0.5])?;
    let oracle = Scan(PeriodicBox { cloud, side: 1.0 });
    let mut near = Vec::new();
    oracle.nearest(0, 3, &mut near);
    for x in near {
        println!("point {} at distance {:.2}", x.index, x.distance);
    }

    let dl = 0.08;
    let waist = flat_torus(3000, dl)?;
    let triangulation = Pipeline::new(Parameters::new(3.0 * dl, dl))?.triangulate(&waist)?;
    let found = homology(&triangulation.complex)?;
    println!(
        "{} triangles, {} open stars, Betti numbers {:?}",
        triangulation.complex.triangles.len(),
        triangulation.incomplete.len(),
        found.betti_rational
    );
    assert_eq!(found.betti_rational, [1, 2, 1], "a torus");
    Ok(())
}
