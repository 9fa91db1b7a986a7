//! What a reconstruction is asked for.

use crate::spaces::{MetricName, Spaces};
use crosscap_algorithms::singularity::ModelName;
use crosscap_core::{Error, positive_length};
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// Charts reach this many landmark separations: beyond that a chart only bends more.
const CHART_SEPARATIONS: f64 = 3.0;

/// Which algorithm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Cells cut along the curves, repairs, refinement: what the measurements say works.
    #[default]
    Cells,
    /// The algorithm of Martin & Watson (2011) to the letter, for comparison: see [`Published`](crosscap_algorithms::stratify::Published) and
    /// [`Rules::PAPER`](crosscap_algorithms::triangulate::Rules::PAPER). Models and triangle rule of the builder are not used.
    Paper,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cells => "cells",
            Self::Paper => "paper",
        })
    }
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "cells" => Ok(Self::Cells),
            "paper" => Ok(Self::Paper),
            other => Err(Error::Parameter {
                name: "method",
                value: other.into(),
                expected: "cells or paper".into(),
            }),
        }
    }
}

/// Parameters of a reconstruction, all lengths in the unit of the data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameters {
    /// Radius of the neighborhoods in which dimension and crossings are looked for (strict).
    pub eps: f64,
    /// Largest radius of the charts (strict). Charts reach 3 dl, or less where this is
    /// smaller; beyond that a chart only bends more. A chart with few landmarks is widened.
    /// With the paper's method the radius itself, eps when left out.
    pub tri_eps: Option<f64>,
    /// Dimension tolerance: share of the variance that may lie outside the dimension (strict).
    pub dt: f64,
    /// Fit tolerance: largest root mean squared distance of a neighborhood to its model.
    pub dp: f64,
    /// Curve tolerance eps_p: a point closer than this to both sheets is on the curve (strict).
    pub ep: f64,
    /// Landmark separation.
    pub dl: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
    /// Take every point as 2-dimensional and look for no crossing.
    pub surface: bool,
    /// Width of the narrowest hole that the surface may have, in local spacings of the points, where that is known:
    /// see [`Limits::least_hole`](crosscap_algorithms::certificate::Limits::least_hole).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_hole: Option<f64>,
    /// Rows of points on the boundary.
    pub boundary: Vec<usize>,
    /// Singularity models that compete, by name.
    pub models: Vec<ModelName>,
    /// Which algorithm.
    pub method: Method,
    /// Metrics and neighborhoods.
    #[serde(skip_serializing_if = "Spaces::are_usual")]
    pub spaces: Spaces,
    /// Number of threads, all processors when left out; changes no result.
    pub threads: Option<usize>,
}

impl Parameters {
    /// Parameters with the given radius and separation; dt 0.05, dp eps/5, eps_p eps/10.
    pub fn new(eps: f64, dl: f64) -> Self {
        Self {
            eps,
            tri_eps: None,
            dt: 0.05,
            dp: eps / 5.0,
            ep: eps / 10.0,
            dl,
            seed: 0,
            surface: false,
            least_hole: None,
            boundary: Vec::new(),
            models: vec![ModelName::TwoPlanes],
            method: Method::default(),
            spaces: Spaces::default(),
            threads: None,
        }
    }

    /// The same, taking every point as 2-dimensional.
    pub fn surface(mut self) -> Self {
        self.surface = true;
        self
    }

    /// Whether every point is taken as one of a surface that does not end.
    pub(crate) fn is_closed(&self) -> bool {
        self.surface && self.boundary.is_empty() && !self.models.contains(&ModelName::Boundary)
    }

    /// Radius of the charts.
    pub fn chart_radius(&self) -> f64 {
        let usual = CHART_SEPARATIONS * self.dl;
        match self.method {
            Method::Cells if self.spaces.wide_charts => self.tri_eps.unwrap_or(usual),
            Method::Cells => self.tri_eps.map_or(usual, |radius| radius.min(usual)),
            Method::Paper => self.tri_eps.unwrap_or(self.eps),
        }
    }

    /// Checks every parameter alone and against the others.
    ///
    /// # Errors
    /// [`Error::Parameter`] for the first that has no meaning.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |name: &'static str, value: f64, expected: &str| {
            Err(Error::Parameter {
                name,
                value: value.to_string(),
                expected: expected.into(),
            })
        };
        let lengths = [
            ("eps", self.eps),
            ("tri-eps", self.chart_radius()),
            ("dp", self.dp),
            ("ep", self.ep),
            ("dl", self.dl),
        ];
        for (name, value) in lengths {
            positive_length(name, value)?;
        }
        if !(self.dt > 0.0 && self.dt < 1.0) {
            return refuse("dt", self.dt, "a number strictly between 0 and 1");
        }
        if self.chart_radius() <= self.dl {
            return refuse(
                "tri-eps",
                self.chart_radius(),
                "more than dl: a chart of one landmark holds no triangle",
            );
        }
        let band = !self.surface || self.models.contains(&ModelName::Boundary);
        if band && self.ep >= self.eps {
            return refuse(
                "ep",
                self.ep,
                "less than eps: the band of the curve lies inside the neighborhood",
            );
        }
        let closed = self.is_closed();
        if self.spaces.uses(MetricName::Conformal) && !closed {
            return Err(Error::Parameter {
                name: "metric",
                value: MetricName::Conformal.to_string(),
                expected: "another one where curves or boundaries are looked for, which are measured in straight \
                           lines: conformal lengths ask for --surface --models two-planes and no boundary"
                    .into(),
            });
        }
        if let Some(width) = self.least_hole.filter(|w| !(*w > 0.0 && w.is_finite())) {
            return refuse("least-hole", width, "a positive number of spacings");
        }
        self.spaces.check()
    }
}
