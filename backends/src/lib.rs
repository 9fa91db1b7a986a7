//! Other people's engines behind Crosscap's traits, and the doors to the outside.

pub mod euclidean;
pub mod files;
pub mod geodesic;
pub mod interrupt;
#[cfg(feature = "linear-program")]
pub mod linear_program;
pub mod parallel;
pub mod picture;
pub mod tiles;
