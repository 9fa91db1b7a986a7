//! What a cloud is like before anything is reconstructed from it: how densely its points lie, how
//! finely its coordinates are resolved, which points are outliers, and how noisy it is.
//!
//! | question | answer |
//! | --- | --- |
//! | how far apart are the points, place by place? | [`LocalSpacing`] |
//! | how finely are the coordinates resolved? | [`Resolution`] |
//! | which directions are noise alone? | [`Subspace`] |
//! | which points lie on nothing? | [`Outliers`] |
//! | how far do they scatter across the surface? | [`Noise`], and [`Projection`] takes it away |
//!
//! [`Preparation`] answers all of them in turn and puts the cloud in order.
//!
//! Lengths here are told in units of the *local spacing*, the one length that a cloud brings with it.

mod crossing_fits;
mod crossing_sheets;
mod noise;
mod off_sheet;
mod outliers;
mod preparation;
mod projection;
mod resolution;
mod scattered;
mod sheet_fit;
mod spacing;
mod subspace;

pub use noise::Noise;
pub use outliers::Outliers;
pub use preparation::{Preparation, PreparationSummary, Remedies};
pub use projection::Projection;
pub use resolution::Resolution;
pub(crate) use sheet_fit::SheetFit;
pub use spacing::LocalSpacing;
pub use subspace::Subspace;
