//! Random landmarks.

use crosscap_core::{Error, LandmarkSelector, NeighborhoodOracle, Scalar};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use std::marker::PhantomData;

/// Takes candidates in random order, each that keeps the separation (Martin & Watson 2011,
/// section 2.4). O(L) neighborhood queries.
#[derive(Clone, Copy, Debug, Default)]
pub struct RandomGreedy<S>(PhantomData<S>);

impl<S> RandomGreedy<S> {
    /// The selector.
    pub fn new() -> Self {
        Self(PhantomData)
    }
}

impl<S: Scalar> LandmarkSelector for RandomGreedy<S> {
    type Scalar = S;

    fn select(
        &self,
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        candidates: &[usize],
        taken: &[usize],
        separation: f64,
        seed: u64,
    ) -> Result<Vec<usize>, Error> {
        super::check(separation)?;
        let mut blocked = vec![false; oracle.len()];
        let mut near = Vec::new();
        let mut block = |row: usize, blocked: &mut Vec<bool>| {
            oracle.indices_within(row, S::of(separation), &mut near);
            for &k in &near {
                blocked[k as usize] = true;
            }
        };
        for &row in taken {
            block(row, &mut blocked);
        }
        let mut order = candidates.to_vec();
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
        let mut chosen = Vec::new();
        for row in order {
            if !blocked[row] {
                chosen.push(row);
                block(row, &mut blocked);
            }
        }
        Ok(chosen)
    }

    fn name(&self) -> &str {
        "random"
    }
}
