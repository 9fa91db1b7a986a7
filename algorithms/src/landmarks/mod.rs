//! Landmark selectors.

mod max_min;
mod random;
pub use max_min::MaxMin;
pub use random::{BARRED, RandomGreedy, random_ranks, random_ranks_but};

use crosscap_core::Error;

fn check(separation: f64) -> Result<(), Error> {
    if separation > 0.0 && separation.is_finite() {
        return Ok(());
    }
    Err(Error::Parameter {
        name: "dl",
        value: separation.to_string(),
        expected: "a positive length".into(),
    })
}
