//! Singularity models.

mod patch;
mod regular;
mod two_planes;
pub use patch::QuadraticPatch;
pub use regular::OneSheet;
pub use two_planes::{PlanePair, TwoPlanes};
