//! A landmark selector of one's own: where points are densest, first.
//!
//! `cargo run --release --example custom_selector`

use crosscap_core::laws::{self, Settings};
use crosscap_core::{Error, LandmarkSelector, NeighborhoodOracle};

/// Candidates with the most points within the separation come first, ties by index; the seed decides
/// nothing.
struct DensestFirst;

impl LandmarkSelector for DensestFirst {
    type Scalar = f64;

    fn select(
        &self,
        oracle: &dyn NeighborhoodOracle<Scalar = f64>,
        candidates: &[usize],
        taken: &[usize],
        separation: f64,
        _seed: u64,
    ) -> Result<Vec<usize>, Error> {
        // So written, it refuses NaN as well.
        if !(separation > 0.0 && separation.is_finite()) {
            return Err(Error::Parameter {
                name: "dl",
                value: separation.to_string(),
                expected: "a positive length".into(),
            });
        }
        let mut near = Vec::new();
        let mut order: Vec<(usize, usize)> = candidates
            .iter()
            .map(|&row| {
                oracle.within(row, separation, &mut near);
                (near.len(), row)
            })
            .collect();
        order.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut covered = vec![false; oracle.len()];
        let mut chosen = Vec::new();
        for row in taken.iter().copied().chain(order.into_iter().map(|x| x.1)) {
            let given = taken.contains(&row);
            if covered[row] && !given {
                continue;
            }
            if !given {
                chosen.push(row);
            }
            oracle.within(row, separation, &mut near);
            for x in &near {
                covered[x.index] = true;
            }
        }
        Ok(chosen)
    }

    fn name(&self) -> &str {
        "densest-first"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::selector(&Settings::default(), &DensestFirst)?;
    println!("{} obeys the laws of LandmarkSelector", DensestFirst.name());

    use crosscap::prelude::*;
    let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
    let outcome = Pipeline::new(Parameters::new(0.4, 0.2).surface())?
        .selector(Box::new(DensestFirst))
        .reconstruct(&sample.points)?;
    println!(
        "verified: {}, {} vertices",
        outcome.is_verified(),
        outcome.mesh.complex.vertices
    );
    Ok(())
}
