//! Crosscap turns a point cloud in R^N into a triangulated surface that may cross itself.
//!
//! This crate is the facade: the [`Pipeline`] puts the parts of the workspace together with good
//! defaults, the [`prelude`] names what one needs every day, and the modules below lead to everything else.

// The command line is written against the public names, as if it stood outside.
extern crate self as crosscap;

#[doc(hidden)]
pub mod command;
pub mod comparison;
mod given;
pub mod pipeline;
mod spaces;
mod watched;

pub use crosscap_algorithms as algorithms;
pub use crosscap_backends as backends;
pub use crosscap_core as core;
pub use given::GivenSpace;
pub use pipeline::{Method, Outcome, Parameters, Pipeline, Report, Stage};
pub use spaces::{MetricName, Neighborhoods, Spaces, Warning};
pub use watched::Distortion;

/// What a reconstruction needs, in one line.
pub mod prelude {
    pub use crate::pipeline::{Method, Outcome, Parameters, Pipeline, Report, Stage};
    pub use crosscap_algorithms::certificate::Verdict;
    pub use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
    pub use crosscap_core::{
        Complex, DimensionEstimator, Error, LandmarkSelector, LocalChart, Mesh, MetricSpace,
        NeighborhoodOracle, PointCloud, SingularityModel,
    };
}
