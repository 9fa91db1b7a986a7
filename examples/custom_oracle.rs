//! A neighborhood oracle of one's own: points sorted along their first axis.
//!
//! `cargo run --release --example custom_oracle`

use crosscap::algorithms::surfaces::{SampleSurface, Sampling};
use crosscap::{Parameters, Pipeline};
use crosscap_core::laws::{self, Settings, StraightLine};
use crosscap_core::{Neighbor, NeighborhoodOracle, PointCloud};

/// A projection never lengthens a distance, so who is far along one axis is far.
pub struct SortedAxis {
    cloud: PointCloud<f64>,
    /// Points by their first coordinate.
    order: Vec<usize>,
    /// Where each point is in `order`.
    rank: Vec<usize>,
}

/// The root of a rounded square may be this much shorter than the axis says.
const ROUNDING: f64 = 1e-9;

impl SortedAxis {
    pub fn new(cloud: PointCloud<f64>) -> Self {
        let mut order: Vec<usize> = (0..cloud.len()).collect();
        order.sort_by(|&a, &b| cloud.point(a)[0].total_cmp(&cloud.point(b)[0]));
        let mut rank = vec![0; order.len()];
        for (k, &row) in order.iter().enumerate() {
            rank[row] = k;
        }
        Self { cloud, order, rank }
    }

    /// Visits points on both sides of `center`, outwards; a side ends when `visit` says so for the
    /// distance along the axis.
    fn outwards(&self, center: usize, mut visit: impl FnMut(usize, f64) -> bool) {
        let from = self.cloud.point(center)[0];
        let at = self.rank[center];
        let (left, right) = self.order.split_at(at);
        for side in [
            &mut right.iter() as &mut dyn Iterator<Item = &usize>,
            &mut left.iter().rev(),
        ] {
            for &row in side {
                let along = (self.cloud.point(row)[0] - from).abs();
                if !visit(row, along) {
                    break;
                }
            }
        }
    }

    fn neighbor(&self, center: usize, index: usize) -> Neighbor<f64> {
        let distance = self.cloud.squared_distance(center, index).sqrt();
        Neighbor { index, distance }
    }
}

fn before(a: &Neighbor<f64>, b: &Neighbor<f64>) -> std::cmp::Ordering {
    a.distance
        .total_cmp(&b.distance)
        .then(a.index.cmp(&b.index))
}

impl NeighborhoodOracle for SortedAxis {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        out.clear();
        self.outwards(center, |row, along| {
            let found = self.neighbor(center, row);
            // Strict: a point at the radius is outside.
            if found.distance < radius {
                out.push(found);
            }
            along * (1.0 - ROUNDING) < radius
        });
        out.sort_unstable_by(before);
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        out.clear();
        self.outwards(center, |row, along| {
            let found = self.neighbor(center, row);
            let at = out.partition_point(|x| before(x, &found).is_lt());
            if at < count {
                out.truncate(count - 1);
                out.insert(at, found);
            }
            out.len() < count
                || out
                    .last()
                    .is_some_and(|x| along * (1.0 - ROUNDING) <= x.distance)
        });
    }

    fn name(&self) -> &str {
        "sorted-axis"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::oracle(&Settings::default(), |cloud| {
        (StraightLine(cloud.clone()), SortedAxis::new(cloud.clone()))
    })?;
    println!("the sorted axis obeys the laws of NeighborhoodOracle");

    let grid = (0..100)
        .flat_map(|k| [f64::from(k % 10), f64::from(k / 10)])
        .collect();
    let oracle = SortedAxis::new(PointCloud::new(2, grid)?);
    let mut near = Vec::new();
    oracle.within(55, 1.5, &mut near);
    println!("{} points within 1.5 of the middle", near.len());

    // In the pipeline it is asked for everything that a search tree is asked for otherwise.
    let cloud = SampleSurface::find("torus")?
        .sample(&Sampling::new(4000, 7))?
        .points;
    let parameters = Parameters::new(0.6, 0.4);
    let outcome = Pipeline::new(parameters)?
        .oracle(Box::new(SortedAxis::new(cloud.clone())))
        .reconstruct(&cloud)?;
    println!(
        "{} triangles, Betti numbers {:?}",
        outcome.mesh.complex.triangles.len(),
        outcome.homology.betti_rational
    );
    Ok(())
}
