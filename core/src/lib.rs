//! Vocabulary and traits of Crosscap.
//!
//! A plug-in author needs this crate alone. It holds what the ideas of the method *are*
//! (point cloud, metric space, neighborhood, stratum, chart, landmark, complex), and no
//! algorithm, no file format, no thread.
//!
//! | idea | type or trait |
//! | --- | --- |
//! | points of R^N | [`PointCloud`] |
//! | distances | [`MetricSpace`] |
//! | who is near whom | [`NeighborhoodOracle`] |
//! | how many dimensions | [`DimensionEstimator`] |
//! | how a surface can be singular | [`SingularityModel`], [`Decomposition`] |
//! | what a point looks like | [`Link`], [`LinkKind`] |
//! | well-separated subset | [`LandmarkSelector`] |
//! | local coordinates | [`LocalChart`] |
//! | may two triangles stand side by side | [`CompatibilityTest`], [`TriangleRule`] |
//! | the narrow waist | [`StratifiedLandmarks`] |
//! | triangles on landmarks | [`Triangulator`] |
//! | the result | [`Complex`], [`Mesh`] |
//! | many jobs at once | [`execute`] |
//! | numbers that name things | [`Row`], [`Landmark`], [`Label`], [`Table`] |

mod balls;
mod cell;
mod chart;
mod cloud;
mod compatibility;
mod complex;
mod dimension;
mod distances;
mod error;
mod estimate;
pub mod execute;
mod ids;
mod landmarks;
#[cfg(any(test, feature = "laws"))]
pub mod laws;
mod link;
mod local;
mod metric;
mod neighborhood;
mod scalar;
mod singularity;
mod strata;
mod triangulation;
mod waist;

pub use balls::{BallDimension, Balls, Radii};
pub use cell::CellNeighborhood;
pub use chart::{Chart, LocalChart};
pub use cloud::{PointCloud, squared_distance};
pub use compatibility::{ChartTriangle, CompatibilityTest, Meeting, TriangleRule};
pub use complex::{Complex, CurveEdge, Mesh};
pub use dimension::DimensionEstimator;
pub use distances::SparseDistances;
pub use error::{Error, positive_length};
pub use estimate::DimensionEstimate;
pub use ids::{Id, Label, Landmark, Row, Table};
pub use landmarks::LandmarkSelector;
pub use link::{Link, LinkKind};
pub use local::LocalPoints;
pub use metric::MetricSpace;
pub use neighborhood::{Neighbor, Neighborhood, NeighborhoodOracle};
pub use scalar::Scalar;
pub use singularity::{Rejection, SingularityModel};
pub use strata::{Contradiction, Decomposition, Located, Stratum};
pub use triangulation::{Incomplete, Triangulation, TriangulationCounts, Triangulator};
pub use waist::StratifiedLandmarks;
