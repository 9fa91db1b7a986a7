//! Which distances a reconstruction is made with, and what serves them.

use crosscap_algorithms::metric::{BruteForceOracle, CheckedMetric};
use crosscap_algorithms::space::Space;
use crosscap_backends::geodesic::{EdgeRule, GraphWarning};
use crosscap_core::{Error, MetricSpace, PointCloud, positive_length};
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A metric on the points, by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MetricName {
    /// Straight lines.
    #[default]
    Euclidean,
    /// Shortest paths through a graph of neighbors: see [`GeodesicMetric`](crosscap_backends::geodesic::GeodesicMetric).
    Geodesic,
    /// Shortest paths again, every edge measured in the spacing of the points at its ends and given in the unit of
    /// the data where the spacing is the usual one: see [`GeodesicMetric::conformal`](crosscap_backends::geodesic::GeodesicMetric::conformal). For closed surfaces
    /// whose points lie many times as densely here as there.
    Conformal,
    /// Position and tangent plane together: see [`Lifted`](crosscap_algorithms::metric::Lifted). As the metric of the analysis it takes
    /// crossing sheets apart, and what comes out is the surface before it was made to cross itself.
    Lifted,
}

impl MetricName {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Euclidean,
        Self::Geodesic,
        Self::Conformal,
        Self::Lifted,
    ];
}

impl fmt::Display for MetricName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Euclidean => "euclidean",
            Self::Geodesic => "geodesic",
            Self::Conformal => "conformal",
            Self::Lifted => "lifted",
        })
    }
}

impl FromStr for MetricName {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.into_iter().find(|m| m.to_string() == name);
        known.ok_or_else(|| Error::Parameter {
            name: "metric",
            value: name.into(),
            expected: "euclidean, geodesic, conformal or lifted".into(),
        })
    }
}

/// How large the neighborhoods of the analysis are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Neighborhoods {
    /// Radius eps everywhere.
    #[default]
    Radius,
    /// As far as the so many nearest other points.
    Nearest(usize),
    /// From that far up to eps, as large as they look flat.
    Adaptive(usize),
}

impl fmt::Display for Neighborhoods {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Radius => f.write_str("radius"),
            Self::Nearest(count) => write!(f, "k-nearest:{count}"),
            Self::Adaptive(count) => write!(f, "adaptive:{count}"),
        }
    }
}

impl FromStr for Neighborhoods {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = || Error::Parameter {
            name: "neighborhoods",
            value: text.into(),
            expected: format!("radius, k-nearest:K or adaptive:K with K at least {LEAST_NEAREST}"),
        };
        if text == "radius" {
            return Ok(Self::Radius);
        }
        let (name, count) = text.split_once(':').ok_or_else(wrong)?;
        let count: usize = (count.parse().ok())
            .filter(|&k| k >= LEAST_NEAREST)
            .ok_or_else(wrong)?;
        match name {
            "k-nearest" => Ok(Self::Nearest(count)),
            "adaptive" => Ok(Self::Adaptive(count)),
            _ => Err(wrong()),
        }
    }
}

impl Serialize for Neighborhoods {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        serializer.collect_str(self)
    }
}

/// Fewest other points in a neighborhood: with the center it holds what the analysis asks for.
const LEAST_NEAREST: usize = 7;

/// Which distances are used for what. The default is the paper's: Euclidean, one radius.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spaces {
    /// Metric of the analysis: neighborhoods, landmarks, cells.
    pub metric: MetricName,
    /// Metric of the charts; that of the analysis when left out.
    pub tri_metric: Option<MetricName>,
    /// Which points the graph of geodesic distances joins.
    #[serde(serialize_with = "shown")]
    pub graph: EdgeRule,
    /// Edges of the graph join points of one sheet alone, as tangent planes tell sheets apart: a path
    /// then crosses a sharp crease where it is. See [`TangentField`](crosscap_algorithms::tangents::TangentField).
    pub sheets: bool,
    /// Geodesic distances in charts are lengths of smooth curves between two tangent planes, where these tell, instead of those of paths, which
    /// are some percent too long, each by its own. See [`TangentField::length`](crosscap_algorithms::tangents::TangentField::length).
    pub planes: bool,
    /// Distance at which the lifted metric holds two sheets apart that cross at a right angle, unit of
    /// the data; 2 eps when left out.
    pub lift: Option<f64>,
    /// Size of the neighborhoods.
    pub neighborhoods: Neighborhoods,
    /// Charts reach the radius that is given for them, also beyond 3 dl: for comparing metrics.
    pub wide_charts: bool,
}

fn shown<Z: Serializer>(rule: &EdgeRule, serializer: Z) -> Result<Z::Ok, Z::Error> {
    match rule {
        EdgeRule::Within(radius) => serializer.collect_str(&format_args!("within {radius}")),
        EdgeRule::Nearest(count) => serializer.collect_str(&format_args!("{count} nearest")),
    }
}

/// Nearest points that the graph of geodesic distances joins where nothing is said: about 6.6 times the
/// spacing of points scattered at random.
const GRAPH_NEAREST: usize = 30;

impl Default for Spaces {
    fn default() -> Self {
        Self {
            metric: MetricName::default(),
            tri_metric: None,
            graph: EdgeRule::Nearest(GRAPH_NEAREST),
            sheets: false,
            planes: false,
            lift: None,
            neighborhoods: Neighborhoods::default(),
            wide_charts: false,
        }
    }
}

impl Spaces {
    /// Metric of the charts.
    pub fn charts(&self) -> MetricName {
        self.tri_metric.unwrap_or(self.metric)
    }

    /// Whether nothing but the default was asked for.
    pub fn are_usual(&self) -> bool {
        *self == Self::default()
    }

    /// Checks what can be checked without points.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a number without a meaning.
    pub fn check(&self) -> Result<(), Error> {
        match self.graph {
            EdgeRule::Within(r) => drop(positive_length("graph-eps", r)?),
            EdgeRule::Nearest(0) => {
                return Err(Error::Parameter {
                    name: "graph-k",
                    value: "0".into(),
                    expected: "at least 1".into(),
                });
            }
            EdgeRule::Nearest(_) => {}
        }
        self.lift
            .map_or(Ok(()), |w| positive_length("lift", w).map(drop))
    }

    /// Whether charts ask tangent planes for their lengths.
    pub fn asks_planes(&self) -> bool {
        self.planes && self.charts() == MetricName::Geodesic
    }

    /// Whether one of the metrics is this one.
    pub fn uses(&self, name: MetricName) -> bool {
        self.metric == name || self.charts() == name
    }
}

/// What may be wrong with a result although nothing failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Warning {
    /// About the graph of geodesic distances.
    Graph(GraphWarning),
    /// Distances are known up to less than a chart reaches.
    Range {
        /// The first point of which this is so.
        point: usize,
        /// The largest distance known from it, unit of the data.
        known: f64,
        /// What a chart reaches, unit of the data.
        radius: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Graph(warning) => write!(f, "{warning}"),
            Self::Range {
                point,
                known,
                radius,
            } => write!(
                f,
                "distances from point {point} are given up to {known}, and charts reach {radius}: longer ones are \
                 lengths of paths; give more of them, or decrease dl"
            ),
        }
    }
}

/// A metric of the user's, whose answers are looked at, with neighborhoods by looking at every point.
pub(crate) type Custom = BruteForceOracle<CheckedMetric<Box<dyn MetricSpace<Scalar = f64>>>>;

/// The space of a metric of the user's.
pub(crate) fn custom(oracle: &Custom) -> Space<'_, f64> {
    Space::new(oracle.metric(), oracle)
}

/// Positions of places that may be lifted: their first `dimension` coordinates.
pub(crate) fn positions(
    places: &PointCloud<f64>,
    dimension: usize,
) -> Result<PointCloud<f64>, Error> {
    if places.dimension() == dimension {
        return Ok(places.clone());
    }
    let rows = places.iter().flat_map(|row| row[..dimension].to_vec());
    PointCloud::new(dimension, rows.collect())
}

/// Places with zeros behind their coordinates up to `dimension` of them.
pub(crate) fn padded(places: &PointCloud<f64>, dimension: usize) -> Result<PointCloud<f64>, Error> {
    let width = places.dimension().max(dimension);
    let zeros = vec![0.0; width - places.dimension()];
    let rows = places.iter().flat_map(|row| [row, &zeros].concat());
    PointCloud::new(width, rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_shown() {
        for metric in MetricName::ALL {
            assert_eq!(metric.to_string().parse(), Ok(metric));
        }
        for policy in [
            Neighborhoods::Radius,
            Neighborhoods::Nearest(40),
            Neighborhoods::Adaptive(7),
        ] {
            assert_eq!(policy.to_string().parse(), Ok(policy));
        }
        for wrong in ["", "k-nearest", "k-nearest:6", "adaptive:x", "radius:3"] {
            let error = wrong.parse::<Neighborhoods>().unwrap_err();
            assert!(error.to_string().contains("k-nearest:K"), "{error}");
        }
        assert!("manhattan".parse::<MetricName>().is_err());
    }

    #[test]
    fn numbers_without_a_meaning_are_refused() {
        let with = |graph, lift| Spaces {
            graph,
            lift,
            ..Spaces::default()
        };
        assert!(Spaces::default().check().is_ok());
        assert!(with(EdgeRule::Within(0.0), None).check().is_err());
        assert!(with(EdgeRule::Nearest(0), None).check().is_err());
        assert!(with(EdgeRule::Nearest(3), Some(f64::NAN)).check().is_err());
    }
}
