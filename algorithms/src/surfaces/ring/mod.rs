//! Conformations of a ring molecule: the space of cyclo-octane (paper, section 5), and of other rings.

mod chart;
mod conformations;
mod distances;
mod draw;
mod error;
mod net;
mod position;

#[cfg(test)]
mod tests;

pub use conformations::{RingConformations, RingProjection};
pub use distances::RingGeometry;
pub use draw::RingSample;
pub use error::RingError;
