//! What a surface is reconstructed from, as the command line has it.

use super::limited::Limited;
use crosscap::auto;
use crosscap_backends::files::Distances;
use crosscap_core::PointCloud;

/// What a surface is reconstructed from.
pub enum Input {
    /// Places, and the type that their file has them in.
    Points(PointCloud<f64>, &'static str),
    Distances(Distances),
    /// Places that are not in memory.
    Tiles(Box<Limited>),
}

impl Input {
    pub fn len(&self) -> usize {
        match self {
            Self::Points(cloud, _) => cloud.len(),
            Self::Distances(distances) => distances.len(),
            Self::Tiles(limited) => limited.len(),
        }
    }

    /// The points, where they are in memory.
    pub fn places(&self) -> Option<&PointCloud<f64>> {
        match self {
            Self::Points(cloud, _) => Some(cloud),
            Self::Distances(_) | Self::Tiles(_) => None,
        }
    }

    /// What a search looks at, where it can.
    pub fn whole(&self) -> Result<auto::Input<'_>, &Limited> {
        match self {
            Self::Points(cloud, _) => Ok(auto::Input::Points(cloud)),
            Self::Distances(distances) => Ok(auto::Input::Distances(distances)),
            Self::Tiles(limited) => Err(limited),
        }
    }

    pub fn scalar_name(&self) -> &'static str {
        match self {
            Self::Points(_, name) => name,
            Self::Distances(_) => "f64",
            Self::Tiles(limited) => limited.scalar_name(),
        }
    }
}
