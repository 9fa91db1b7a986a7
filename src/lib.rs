//! Crosscap turns a point cloud in R^N into a triangulated surface that may cross itself.
//!
//! This crate is the facade: the [`Pipeline`] puts the parts of the workspace together with good
//! defaults, the [`prelude`] names what one needs every day, and the modules below lead to everything else.

// The command line is written against the public names, as if it stood outside.
extern crate self as crosscap;

pub mod auto;
#[doc(hidden)]
pub mod command;
pub mod comparison;
mod engines;
mod given;
mod kept;
pub mod pipeline;
pub mod refusal;
mod spaces;
mod watched;

pub use auto::{Auto, Pinned, Search};
pub use crosscap_algorithms as algorithms;
pub use crosscap_backends as backends;
pub use crosscap_core as core;
pub use pipeline::{GivenSpace, Method, Outcome, Parameters, Pipeline, Report, Stage};
pub use refusal::{Advice, Refusal};
pub use spaces::{MetricName, Neighborhoods, Spaces, Warning};
pub use watched::Distortion;

/// What a reconstruction needs, in one line.
pub mod prelude {
    pub use crate::auto::{Auto, Pinned, Search};
    pub use crate::comparison::{Comparison, Contender, compare};
    pub use crate::pipeline::{Method, Outcome, Parameters, Pipeline, Report, Stage};
    pub use crate::refusal::{Advice, Refusal};
    pub use crate::spaces::{MetricName, Neighborhoods, Spaces, Warning};
    pub use crosscap_algorithms::certificate::Verdict;
    pub use crosscap_algorithms::singularity::ModelName;
    pub use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
    pub use crosscap_backends::files::{MeshExtras, PointOptions, read_points, write_mesh};
    pub use crosscap_core::{
        Complex, DimensionEstimator, Error, LandmarkSelector, LocalChart, Mesh, MetricSpace,
        NeighborhoodOracle, PointCloud, SingularityModel,
    };
}
