//! Pipelines whose progress is shown.

use super::estimators::EstimatorName;
use super::terminal::{Progress, complain};
use crosscap::pipeline::{Outcome, Parameters, Pipeline};
use crosscap_backends::files::AnyCloud;
use crosscap_core::Error;

/// Runs the pipeline with progress.
pub fn reconstruct(cloud: &AnyCloud, parameters: Parameters) -> Result<Outcome, Error> {
    observed(parameters, EstimatorName::default())?.reconstruct(&cloud.to_f64())
}

/// A pipeline whose progress is shown, and its warnings as they come.
pub fn observed(parameters: Parameters, estimator: EstimatorName) -> Result<Pipeline, Error> {
    let progress = Progress::of_stages();
    let shown = progress.clone();
    let dt = parameters.dt;
    let mut pipeline = Pipeline::new(parameters)?
        .on_stage(move |stage| shown.enter(stage))
        .on_warning(move |warning| {
            progress.suspend(|| complain(format_args!("warning: {warning}")));
        });
    // The pipeline has principal components of its own, of all points together.
    if estimator != EstimatorName::Pca {
        pipeline = pipeline.estimator(estimator.local(dt)?);
    }
    Ok(pipeline)
}
