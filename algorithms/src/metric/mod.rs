//! Metric spaces that need no engine, and the oracle that serves any of them.
//!
//! | model | distance | from |
//! | --- | --- | --- |
//! | [`Euclidean`] | straight line in R^N | coordinates |
//! | [`Lifted`] | position and tangent plane together | coordinates and tangent planes |
//! | [`GivenDistances`] | as measured | a full matrix |
//!
//! [`BruteForceOracle`] answers neighborhood queries in any metric space by looking at every
//! point: right by construction, so it is what every other oracle is compared with. [`CheckedMetric`] remembers
//! which answers of a metric were no distances.

mod brute_force;
mod checked;
mod euclidean;
mod given;
mod lifted;
mod tangent;

pub use brute_force::BruteForceOracle;
pub use checked::CheckedMetric;
pub use euclidean::Euclidean;
pub use given::GivenDistances;
pub use lifted::Lifted;
pub use tangent::tangent_planes;
