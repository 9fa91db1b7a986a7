//! What a reconstruction yields.

use super::{Parameters, Stage};
use crate::spaces::Warning;
use crate::watched::Distortion;
use crosscap_algorithms::certificate::{Certificate, SpecialPoint, Verdict};
use crosscap_algorithms::creases::Creases;
use crosscap_algorithms::homology::Homology;
use crosscap_algorithms::pieces::{Pieces, PiecesError};
use crosscap_algorithms::stratify::{ModelCounts, StratifyCounts, Tuning};
use crosscap_backends::geodesic::GraphReport;
use crosscap_core::{Error, Mesh, TriangulationCounts};
use serde::{Deserialize, Serialize};

/// What became of distances that were the only input.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GivenSpace {
    /// Dimension of the places.
    pub dimension: usize,
    /// Largest difference of a known distance and that of the places, unit of the data.
    pub deviation: f64,
    /// Whether the places are as good as coordinates: the deviation is at most a hundredth of dl.
    /// Otherwise they are a picture, and no distance was taken from them.
    pub exact: bool,
}

/// Names of the plug-ins of a reconstruction, as they call themselves.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PluginNames {
    /// The metric of the analysis.
    pub metric: String,
    /// What served it.
    pub oracle: String,
    /// What measured the charts: `places` for straight lines between the places of the points, those on curves moved
    /// onto them.
    pub chart_metric: String,
    /// What told the local dimension; none where every point was taken as 2-dimensional.
    pub estimator: Option<String>,
    /// The way from the cloud to the waist.
    pub stratifier: String,
    /// What chose landmarks.
    pub selector: String,
    /// What put triangles on them.
    pub triangulator: String,
    /// What laid charts out, decided which triangles may stand together, and ranked them; none of the three where a triangulator
    /// was plugged in, which has parts of its own or none.
    pub chart: Option<String>,
    /// See [`chart`](Self::chart).
    pub compatibility: Option<String>,
    /// See [`chart`](Self::chart).
    pub rule: Option<String>,
}

/// Counts and times of a reconstruction.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Version of this program.
    pub version: &'static str,
    /// The parameters.
    pub parameters: Parameters,
    /// Points of the input.
    pub points: usize,
    /// N.
    pub dimension: usize,
    /// Points that coincide with an earlier one and were left out.
    pub duplicates: usize,
    /// What worked on the points, by the names that the plug-ins give themselves; of singularity models
    /// [`models`](Self::models) says more.
    #[serde(flatten)]
    pub plugins: PluginNames,
    /// Mean number of points in a neighborhood.
    pub mean_neighbors: f64,
    /// Points whose neighborhood is not 2-dimensional.
    pub candidates: usize,
    /// Points found on curves.
    pub curve_points: usize,
    /// Points whose neighborhood no model explained.
    pub unexplained: usize,
    /// What became of every model that took part, by its own name: fits asked for, refused and why, won.
    pub models: Vec<ModelCounts>,
    /// Landmarks, chains, cells.
    pub landmarks: StratifyCounts,
    /// Landmarks added where triangles strayed from the points.
    pub added_landmarks: usize,
    /// Visits and repairs.
    pub triangulation: TriangulationCounts,
    /// How much the charts lose.
    pub chart_distortion: Distortion,
    /// The graph of geodesic distances, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graph: Option<GraphReport>,
    /// What became of distances that were the only input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub given: Option<GivenSpace>,
    /// What may be wrong although nothing failed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// The numbers that decided.
    pub tuning: Tuning,
    /// Seconds spent in each stage, in order.
    pub seconds: Vec<(Stage, f64)>,
}

/// What a reconstruction yields, verified or not.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// The mesh; vertices on double curves lie on the curve, beside their input point.
    pub mesh: Mesh,
    /// Betti numbers and torsion.
    pub homology: Homology,
    /// Vertices at points that a model declared, with the link that each must have.
    pub special_points: Vec<SpecialPoint>,
    /// Every level of validity with its violations.
    pub certificate: Certificate,
    /// What the surface is, where the crossing can be undone.
    pub pieces: Result<Pieces, PiecesError>,
    /// Where the surface bends sharply; `None` where the mesh is not verified, where distances were the only input, and
    /// where the points are in tiles.
    pub creases: Option<Creases>,
    /// Counts and times.
    pub report: Report,
    /// Where the triangulation could not be completed, with the parameter to change.
    pub failures: Vec<Error>,
}

impl Outcome {
    /// Whether the mesh may be handed over as good.
    pub fn is_verified(&self) -> bool {
        self.failures.is_empty() && matches!(self.certificate.verdict(), Verdict::Verified)
    }
}
