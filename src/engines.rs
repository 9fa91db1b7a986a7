//! What serves the metrics of one reconstruction.

use crate::kept::Kept;
use crate::spaces::{MetricName, Spaces, Warning};
use crosscap_algorithms::metric::{Lifted, tangent_planes};
use crosscap_algorithms::prepare::LocalSpacing;
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::ChartSpace;
use crosscap_algorithms::tangents::TangentField;
use crosscap_algorithms::tuning::TangentTuning;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric, GraphReport};
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, PointCloud};
use std::sync::Arc;

/// Lengths measured in the spacing of the points.
struct Conformal {
    metric: GeodesicMetric<f64>,
    /// How many times the usual spacing that at each point is.
    scale: Vec<f64>,
}

impl Conformal {
    fn new(
        points: &EuclideanOracle<f64>,
        rule: EdgeRule,
        threads: &Threads,
    ) -> Result<Self, Error> {
        let scale = in_usual_spacings(points, threads)?;
        let metric = threads.install(|| GeodesicMetric::conformal(points, rule, &scale))?;
        Ok(Self { metric, scale })
    }
}

/// How many times the usual spacing that at each point is.
fn in_usual_spacings(points: &EuclideanOracle<f64>, threads: &Threads) -> Result<Vec<f64>, Error> {
    let spacing = LocalSpacing::by(points, threads)?;
    let usual = spacing.median();
    let scale = |s: &f64| (s / usual).max(LEAST_SCALE);
    Ok(spacing.values().iter().map(scale).collect())
}

impl MetricName {
    /// How many times the separation dl landmarks keep from each other at each point, where that follows the spacing of the
    /// points: the conformal metric. `None` for the others, whose separation is the same everywhere.
    ///
    /// Whoever measures a mesh in landmark separations needs it: see
    /// [`CertificateOptions::separation_scale`](crosscap_algorithms::certificate::CertificateOptions). O(n log n) for n points.
    ///
    /// # Errors
    /// [`Error::Shape`] for too few points to have a spacing.
    pub fn separation_scale(self, points: &PointCloud<f64>) -> Result<Option<Vec<f64>>, Error> {
        if self != Self::Conformal {
            return Ok(None);
        }
        let oracle = EuclideanOracle::new(points.clone())?;
        in_usual_spacings(&oracle, &Threads::new(0)?).map(Some)
    }
}

/// Spacings below this share of the usual one are those of copies of a point, or nearly.
const LEAST_SCALE: f64 = 1e-3;

/// What serves the metrics of one reconstruction.
pub(crate) struct Engines {
    /// The points as the analysis sees them: lifted for the lifted metric.
    pub(crate) cloud: PointCloud<f64>,
    /// Straight lines between them.
    pub(crate) euclidean: EuclideanOracle<f64>,
    geodesic: Option<Arc<GeodesicMetric<f64>>>,
    /// Tangent planes, where charts or the graph ask for them.
    planes: Option<Arc<TangentField>>,
    conformal: Option<Conformal>,
    /// Straight lines in the other of the two: lifted for charts alone, or not lifted for charts.
    other: Option<EuclideanOracle<f64>>,
    spaces: Spaces,
}

impl Engines {
    /// All that the metrics need; what is `kept` of the same points is not made again.
    pub(crate) fn new(
        spaces: &Spaces,
        eps: f64,
        positions: &PointCloud<f64>,
        tuning: &TangentTuning,
        kept: &Kept,
        threads: &Threads,
    ) -> Result<Self, Error> {
        let flat = EuclideanOracle::new(positions.clone())?;
        let lifted = if spaces.uses(MetricName::Lifted) {
            let count = tuning.lifted.min(positions.len().saturating_sub(1));
            let bases = tangent_planes(positions, &flat, count, threads)?;
            let weight = spaces.lift.unwrap_or(2.0 * eps);
            let lifted = Lifted::new(positions.clone(), 2, bases, weight)?.coordinates()?;
            Some(EuclideanOracle::new(lifted)?)
        } else {
            None
        };
        let (euclidean, other) = match (lifted, spaces.metric) {
            (Some(lifted), MetricName::Lifted) => (lifted, Some(flat)),
            (lifted, _) => (flat, lifted),
        };
        let along = spaces.uses(MetricName::Geodesic);
        let planes = if along && (spaces.sheets || spaces.asks_planes()) {
            Some(kept.planes(&euclidean, tuning, threads)?)
        } else {
            None
        };
        let geodesic = if along {
            let field = planes.as_deref().filter(|_| spaces.sheets);
            let sheets = field.map(|field| (field, tuning));
            Some(kept.paths(&euclidean, spaces.graph, sheets, threads)?)
        } else {
            None
        };
        let conformal = if spaces.uses(MetricName::Conformal) {
            Some(Conformal::new(&euclidean, spaces.graph, threads)?)
        } else {
            None
        };
        Ok(Self {
            cloud: (**euclidean.cloud()).clone(),
            euclidean,
            geodesic,
            planes,
            conformal,
            other,
            spaces: spaces.clone(),
        })
    }

    /// The space of the analysis.
    pub(crate) fn analysis(&self) -> Space<'_, f64> {
        let paths = match self.spaces.metric {
            MetricName::Geodesic => self.geodesic.as_deref(),
            MetricName::Conformal => self.conformal.as_ref().map(|own| &own.metric),
            MetricName::Euclidean | MetricName::Lifted => None,
        };
        match paths {
            Some(paths) => Space::of(paths).with_places(&self.cloud),
            None => Space::of(&self.euclidean),
        }
    }

    /// What measures the charts.
    pub(crate) fn charts(&self) -> ChartSpace<'_, f64> {
        let own = match (self.spaces.charts(), self.spaces.metric) {
            (MetricName::Geodesic, _) => self.geodesic.as_deref().map(Space::of),
            (MetricName::Conformal, _) => self.conformal.as_ref().map(|own| Space::of(&own.metric)),
            (MetricName::Lifted, MetricName::Lifted) => None,
            (
                MetricName::Euclidean,
                MetricName::Euclidean | MetricName::Geodesic | MetricName::Conformal,
            ) => None,
            _ => self.other.as_ref().map(Space::of),
        };
        let planes = (self.planes.as_deref()).filter(|_| self.spaces.asks_planes());
        match (own, planes) {
            (None, _) => ChartSpace::Places,
            (Some(own), None) => ChartSpace::Metric(own),
            (Some(paths), Some(planes)) => ChartSpace::Along(paths, planes),
        }
    }

    /// The graph of geodesic distances, where there is one.
    pub(crate) fn graph(&self) -> Option<&GraphReport> {
        let conformal = self.conformal.as_ref().map(|own| &own.metric);
        (self.geodesic.as_deref().or(conformal)).map(GeodesicMetric::report)
    }

    /// How many times the usual spacing that at each point is, where landmarks follow the spacing.
    pub(crate) fn scale(&self) -> Option<&[f64]> {
        let own = (self.conformal.as_ref()).filter(|_| self.spaces.metric == MetricName::Conformal);
        own.map(|own| &own.scale[..])
    }

    /// What speaks against the distances.
    pub(crate) fn warnings(&self) -> Vec<Warning> {
        let report = self.graph().map(GraphReport::warnings);
        report.into_iter().flatten().map(Warning::Graph).collect()
    }
}
