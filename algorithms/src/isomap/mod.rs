//! Low-dimensional pictures of R^N: principal axes and Isomap.
//!
//! A surface in R^24 can only be looked at through a map to R^3. Two are offered:
//!
//! | map | keeps | use it when |
//! | --- | --- | --- |
//! | [`principal_places`] | straight-line distances, as far as one orthogonal projection can | the surface is nearly flat in three directions |
//! | [`isomap_places`] | distances along the surface | the surface is rolled up |
//!
//! Both return an [`Embedding`], which says how much was lost.

mod geodesic;
mod landmark;
mod principal;

pub use landmark::{IsomapOptions, isomap_places};
pub use principal::principal_places;

use crosscap_core::{Error, PointCloud};

/// Places in a space of low dimension, with what the map lost.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Embedding {
    /// One place for each point or vertex, in the order of the input and in its unit. Every
    /// connected component has its mean at the origin before components are laid side by side.
    pub places: PointCloud<f64>,
    /// Share that is lost, 0 (nothing) to 1. For principal axes the share of the variance
    /// outside of the axes kept; for Isomap 1 - r^2, r the correlation of the distances along
    /// the mesh and the distances of the places (Tenenbaum, de Silva, Langford 2000, note 42).
    pub residual_variance: f64,
    /// Number of connected components that were laid out on their own (1 for principal axes).
    pub components: usize,
}

/// Refuses a picture of dimension 0.
fn check_dimension(dimension: usize) -> Result<(), Error> {
    if dimension == 0 {
        return Err(Error::Parameter {
            name: "dimension",
            value: "0".into(),
            expected: "at least 1 (3 for a picture to turn)".into(),
        });
    }
    Ok(())
}
