//! Landmark selectors.

mod max_min;
mod random;
pub use max_min::MaxMin;
pub use random::{BARRED, RandomGreedy, random_ranks, random_ranks_but};
