//! What an analysis is made with.

use crate::execute::Execute;
use crate::space::Space;
use crate::tuning::Tuning;
use crosscap_core::{DimensionEstimator, Scalar, SingularityModel};

/// The space, the engines and the models that the analysis is made with.
pub struct Analyzer<'a, S: Scalar> {
    /// The points. Models are fitted in its coordinates.
    pub space: Space<'a, S>,
    /// Tells the local dimension.
    pub estimator: &'a dyn DimensionEstimator<Scalar = S>,
    /// Models that compete for neighborhoods that are not 2-dimensional.
    pub models: &'a [Box<dyn SingularityModel>],
    /// What runs the points.
    pub execute: &'a dyn Execute,
    /// The numbers that decide.
    pub tuning: &'a Tuning,
}
