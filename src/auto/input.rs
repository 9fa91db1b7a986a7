//! What a surface is reconstructed from.

use super::density::Density;
use crate::pipeline::{Outcome, Pipeline, distinct_points};
use crosscap_algorithms::metric::{BruteForceOracle, GivenDistances};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::Distances;
use crosscap_core::{Error, PointCloud};

/// What a surface is reconstructed from.
#[derive(Clone, Copy)]
pub enum Input<'a> {
    /// Places.
    Points(&'a PointCloud<f64>),
    /// Distances alone.
    Distances(&'a Distances),
}

impl Input<'_> {
    /// How densely the points lie.
    pub(super) fn density(&self) -> Result<Density, Error> {
        match self {
            Self::Points(cloud) => Density::of(&EuclideanOracle::new(distinct_points(cloud))?),
            Self::Distances(Distances::Dense { count, values }) => {
                let metric = GivenDistances::new(*count, values.clone())?;
                Density::of(&BruteForceOracle::new(metric))
            }
            Self::Distances(Distances::Sparse(known)) => {
                Density::of(&crate::given::KnownDistances(known))
            }
        }
    }

    /// One reconstruction.
    pub(super) fn run(&self, pipeline: &mut Pipeline) -> Result<Outcome, Error> {
        match self {
            Self::Points(cloud) => pipeline.reconstruct(cloud),
            Self::Distances(distances) => pipeline.reconstruct_distances(distances),
        }
    }
}
