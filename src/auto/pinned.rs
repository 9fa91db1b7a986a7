//! What the user has decided.

use super::density::Density;
use super::rounding::three_digits;
use crate::pipeline::{Method, Parameters};
use crate::spaces::{MetricName, Neighborhoods, Spaces};
use crosscap_algorithms::singularity::ModelName;
use crosscap_backends::geodesic::EdgeRule;

/// The parameters that are not the program's to choose: what is `Some` stays as it is.
///
/// The fields are those of [`Parameters`] and [`Spaces`], with their units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pinned {
    /// [`Parameters::eps`].
    pub eps: Option<f64>,
    /// [`Parameters::tri_eps`].
    pub tri_eps: Option<f64>,
    /// [`Parameters::dt`].
    pub dt: Option<f64>,
    /// [`Parameters::dp`].
    pub dp: Option<f64>,
    /// [`Parameters::ep`].
    pub ep: Option<f64>,
    /// [`Parameters::dl`].
    pub dl: Option<f64>,
    /// [`Parameters::seed`].
    pub seed: Option<u64>,
    /// [`Parameters::surface`].
    pub surface: Option<bool>,
    /// [`Parameters::least_hole`].
    pub least_hole: Option<f64>,
    /// [`Parameters::boundary`]: rows that are known to lie on the boundary.
    pub boundary: Vec<usize>,
    /// [`Parameters::models`].
    pub models: Option<Vec<ModelName>>,
    /// [`Parameters::method`].
    pub method: Option<Method>,
    /// [`Spaces::metric`].
    pub metric: Option<MetricName>,
    /// [`Spaces::tri_metric`].
    pub tri_metric: Option<MetricName>,
    /// [`Spaces::graph`].
    pub graph: Option<EdgeRule>,
    /// [`Spaces::sheets`].
    pub sheets: Option<bool>,
    /// [`Spaces::planes`].
    pub planes: Option<bool>,
    /// [`Spaces::lift`].
    pub lift: Option<f64>,
    /// [`Spaces::neighborhoods`].
    pub neighborhoods: Option<Neighborhoods>,
    /// Whether outliers are left out, and points that scatter moved onto fits of their neighborhoods;
    /// where nothing is said they are unless eps and dl are both given, those that scatter by less than a fifth of their
    /// spacing for the second attempt.
    pub prepare: Option<bool>,
    /// [`Parameters::threads`].
    pub threads: Option<usize>,
}

/// Landmarks keep this share of eps from each other: the best of six rules on 71 clouds.
const SEPARATION: f64 = 0.5;

impl Pinned {
    /// eps and dl where both are given: then a run is made exactly as it is told, once, and with the
    /// defaults of [`Parameters::new`] for what is left out.
    pub fn complete(&self) -> Option<[f64; 2]> {
        Some([self.eps?, self.dl?])
    }

    /// Whether something may be done about outliers and noise.
    pub(super) fn is_prepared(&self) -> bool {
        self.prepare.unwrap_or(self.complete().is_none())
    }

    /// Whether lengths are those in the spacing of the points, in which there is one closed surface and nothing else.
    fn is_spaced(&self) -> bool {
        self.metric == Some(MetricName::Conformal)
    }

    fn models(&self) -> Vec<ModelName> {
        match (&self.models, self.complete()) {
            (Some(models), _) => models.clone(),
            (None, Some(_)) => vec![ModelName::TwoPlanes],
            (None, None) if self.is_spaced() => vec![ModelName::TwoPlanes],
            (None, None) => ModelName::AUTO.to_vec(),
        }
    }

    /// eps and dl by the density, and why in a few words; each gives way to what is pinned.
    pub(super) fn lengths(&self, density: &Density) -> ([f64; 2], String) {
        let (share, density) = match self.is_spaced() {
            true => ("half of the points", &density.even()),
            false => ("99 of 100 points", density),
        };
        let Density { neighbors, .. } = density;
        let (eps, of_eps) = match (self.eps, self.dl.map(|dl| dl / SEPARATION)) {
            (Some(eps), _) => (eps, "given".into()),
            (None, Some(least)) if least > density.reach => {
                (three_digits(least), "twice dl".into())
            }
            (None, _) => {
                let told = format!("{share} have {neighbors} others nearer than that");
                (three_digits(density.reach), told)
            }
        };
        let usual = eps * SEPARATION;
        let (dl, of_dl) = match (self.dl, self.tri_eps.map(|radius| radius / 2.0)) {
            (Some(dl), _) => (dl, "given"),
            (None, Some(most)) if most < usual => (three_digits(most), "half of tri-eps"),
            (None, _) => (three_digits(usual), "half of eps"),
        };
        let reason = format!("eps {eps} ({of_eps}), dl {dl} ({of_dl})");
        ([eps, dl], reason)
    }

    /// The parameters with these two lengths and the usual values of what is not pinned.
    pub fn parameters(&self, eps: f64, dl: f64) -> Parameters {
        let usual = Parameters::new(eps, dl);
        let spaces = Spaces::default();
        // What is asked for by halves is asked for as it can be had; a run with both lengths is made as it is told.
        let closed = self.is_spaced() && self.complete().is_none();
        Parameters {
            eps,
            tri_eps: self.tri_eps,
            dt: self.dt.unwrap_or(usual.dt),
            dp: self.dp.unwrap_or(usual.dp),
            ep: self.ep.unwrap_or(usual.ep),
            dl,
            seed: self.seed.unwrap_or(usual.seed),
            surface: self.surface.unwrap_or(usual.surface || closed),
            least_hole: self.least_hole,
            boundary: self.boundary.clone(),
            models: self.models(),
            method: self.method.unwrap_or(usual.method),
            spaces: Spaces {
                metric: self.metric.unwrap_or(spaces.metric),
                tri_metric: self.tri_metric,
                graph: self.graph.unwrap_or(spaces.graph),
                sheets: self.sheets.unwrap_or(spaces.sheets),
                planes: self.planes.unwrap_or(spaces.planes),
                lift: self.lift,
                neighborhoods: self.neighborhoods.unwrap_or(spaces.neighborhoods),
                wide_charts: spaces.wide_charts,
            },
            threads: self.threads,
        }
    }
}
