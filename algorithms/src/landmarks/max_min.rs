//! Max-min landmarks.

use crosscap_core::{Error, LandmarkSelector, NeighborhoodOracle, Scalar, positive_length};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BinaryHeap;
use std::marker::PhantomData;

/// Always the candidate farthest from those chosen (de Silva & Carlsson 2004), until none is
/// as far as the separation.
///
/// Distances beyond four separations count as equal, broken by a random order: they are cut off so that
/// every step is one local query. O(L) neighborhood queries of four separations.
#[derive(Clone, Copy, Debug, Default)]
pub struct MaxMin<S>(PhantomData<S>);

impl<S> MaxMin<S> {
    /// The selector.
    pub fn new() -> Self {
        Self(PhantomData)
    }
}

/// Distances are told apart up to this many separations.
const CUTOFF: f64 = 4.0;

impl<S: Scalar> LandmarkSelector for MaxMin<S> {
    type Scalar = S;

    fn select(
        &self,
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        candidates: &[usize],
        taken: &[usize],
        separation: f64,
        seed: u64,
    ) -> Result<Vec<usize>, Error> {
        positive_length("dl", separation)?;
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut tie = vec![0u32; oracle.len()];
        let mut gap = vec![-1.0; oracle.len()];
        for &row in candidates {
            gap[row] = CUTOFF * separation;
            tie[row] = rng.random();
        }
        let mut near = Vec::new();
        let mut heap: BinaryHeap<(u64, u32, usize)> = BinaryHeap::new();
        // Non-negative numbers order like their bits.
        let key = |gap: f64| gap.to_bits();
        let mut lower = |row: usize, gap: &mut Vec<f64>, heap: &mut BinaryHeap<_>, tie: &[u32]| {
            oracle.within(row, S::of(CUTOFF * separation), &mut near);
            for x in &near {
                let d = x.distance.as_f64();
                if d < gap[x.index] {
                    gap[x.index] = d;
                    if d >= separation {
                        heap.push((key(d), tie[x.index], x.index));
                    }
                }
            }
        };
        for &row in taken {
            lower(row, &mut gap, &mut heap, &tie);
        }
        for &row in candidates {
            heap.push((key(gap[row].max(0.0)), tie[row], row));
        }
        let mut chosen = Vec::new();
        while let Some((bits, _, row)) = heap.pop() {
            if bits != key(gap[row].max(0.0)) || gap[row] < separation {
                continue;
            }
            chosen.push(row);
            gap[row] = 0.0;
            lower(row, &mut gap, &mut heap, &tie);
        }
        Ok(chosen)
    }

    fn name(&self) -> &str {
        "max-min"
    }
}
