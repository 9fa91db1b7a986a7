//! Landmark selectors.

mod max_min;
mod random;
pub use max_min::MaxMin;
pub use random::{RandomGreedy, random_ranks};
