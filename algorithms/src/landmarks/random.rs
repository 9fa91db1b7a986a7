//! Random landmarks.

use crosscap_core::{Error, LandmarkSelector, NeighborhoodOracle, Scalar, positive_length};
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
        positive_length("dl", separation)?;
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
        shuffle(&mut order, seed);
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

/// The random order of a seed. It depends on how many things there are alone.
fn shuffle<T>(order: &mut [T], seed: u64) {
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
}

/// The place of every row in the order in which [`RandomGreedy`] looks at the rows of a cloud, where all of them are
/// candidates.
pub fn random_ranks(count: usize, seed: u64) -> Vec<u32> {
    random_ranks_but(count, &[], seed)
}

/// Place of a row that is in no order.
pub const BARRED: u32 = u32::MAX;

/// The same where some rows, given in order, are no candidates: their place is [`BARRED`].
pub fn random_ranks_but(count: usize, barred: &[u32], seed: u64) -> Vec<u32> {
    let mut barred = barred.iter().copied().peekable();
    let rows = 0..count as u32;
    let mut order: Vec<u32> = rows
        .filter(|&row| barred.next_if_eq(&row).is_none())
        .collect();
    shuffle(&mut order, seed);
    let mut ranks = vec![BARRED; count];
    for (rank, row) in (0..).zip(order) {
        ranks[row as usize] = rank;
    }
    ranks
}
