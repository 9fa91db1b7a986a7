//! A metric space of one's own: a periodic box, as in simulations of materials.
//!
//! `cargo run --release --example custom_metric`

use crosscap_core::laws::{self, Scan, Settings};
use crosscap_core::{MetricSpace, NeighborhoodOracle, PointCloud};

/// Points of a cube whose opposite faces are one: what leaves it on one side comes back on the other.
struct PeriodicBox {
    cloud: PointCloud<f64>,
    side: f64,
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
    Ok(())
}
