//! The mathematics of Crosscap: models of the traits of `crosscap-core` that need nobody
//! else's engine, the triangulator, homology, and the verdict on a mesh.

pub mod alignment;
mod audit;
mod balls;
pub mod certificate;
pub mod chart;
pub mod creases;
pub mod dimension;
pub mod execute;
pub mod homology;
pub mod isomap;
pub mod landmarks;
#[cfg(any(test, feature = "laws"))]
pub mod laws;
mod locality;
pub mod metric;
pub mod moments;
pub mod neighborhood;
mod orthogonal;
pub mod pieces;
pub mod predicate;
pub mod prepare;
pub mod principal;
pub mod scaling;
pub mod singularity;
pub mod space;
mod spectrum;
pub mod stratify;
mod stretch;
pub mod surfaces;
pub mod tangents;
pub mod tiles;
pub mod triangulate;
pub mod tuning;
