//! Ways to put the vertices of a mesh into three dimensions.

use clap::ValueEnum;
use crosscap_algorithms::isomap::{IsomapOptions, isomap_places, principal_places};
use crosscap_core::{Error, Mesh, PointCloud};

/// A way to put the vertices of a mesh into three dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutName {
    /// The three principal axes: an orthogonal projection
    Pca,
    /// Distances along the mesh are kept as well as can be
    Isomap,
    /// The first three coordinates
    Xyz,
}

impl LayoutName {
    /// What suits a mesh in R^`dimension`: its own coordinates, or Isomap above three.
    pub fn suiting(dimension: usize) -> Self {
        if dimension <= 3 {
            Self::Xyz
        } else {
            Self::Isomap
        }
    }

    /// What a reader calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Pca => "principal axes",
            Self::Isomap => "Isomap",
            Self::Xyz => "x, y, z",
        }
    }

    /// Places of the vertices in R^3, in the unit of the mesh.
    pub fn places(self, mesh: &Mesh) -> Result<PointCloud<f64>, Error> {
        match self {
            Self::Pca => Ok(principal_places(&mesh.vertices, 3)?.places),
            Self::Isomap => Ok(isomap_places(mesh, 3, &IsomapOptions::default())?.places),
            Self::Xyz => {
                let first = |p: &[f64]| [0, 1, 2].map(|k| p.get(k).copied().unwrap_or(0.0));
                PointCloud::new(3, mesh.vertices.iter().flat_map(first).collect())
            }
        }
    }
}
