//! Ways from a cloud to the waist.

use super::analysis::{Analysis, AnalysisOptions, Analyzer};
use super::charts::ChartSpace;
use super::producer::WaistProducer;
use super::waist::{Cut, StratifyOptions};
use crosscap_core::{Error, LandmarkSelector, LocalChart, Scalar};

/// What a stratifier works with: the cloud, what was asked for, and plug-ins that it may use.
pub struct Ground<'g, S: Scalar> {
    /// The space, and what tells strata apart in it.
    pub analyzer: Analyzer<'g, S>,
    /// How large neighborhoods are, and what is known of the surface.
    pub analysis: AnalysisOptions,
    /// Largest distance of points from a fit (dp), unit of the data.
    pub dp: f64,
    /// A point closer to a curve than this is on it (eps_p), unit of the data.
    pub ep: f64,
    /// Landmark separation, radius of the charts, seed.
    pub options: StratifyOptions,
    /// What measures the charts.
    pub charts: ChartSpace<'g, S>,
    /// Chooses landmarks.
    pub selector: &'g dyn LandmarkSelector<Scalar = S>,
    /// Lays neighborhoods out, where that is needed before there are triangles.
    pub chart: &'g dyn LocalChart,
}

/// A way from a cloud to the narrow waist.
///
/// # Why it has this shape
/// There are two steps because they cost and fail differently. [`analyze`](Self::analyze) says where every point is: it
/// is the long part, the report counts what it found, and a refusal here is about eps and the models. [`cut`](Self::cut)
/// makes a [`WaistProducer`], from which one waist or several are taken, since landmarks may be added where
/// triangles stray from the points; a refusal here is about dl. Who has another idea of landmarks and
/// neighborhoods, but none of dimensions and curves, implements `cut` alone.
///
/// All that a stratifier may use is in the [`Ground`], as the caller has put it together: the estimator, models and
/// selector in it may be plug-ins themselves, and one that ignores them says so in its documentation. It is in this crate
/// and not in the core because it works on a space with strata, and the core has the words for single neighborhoods alone.
pub trait Stratifier<S: Scalar>: Sync {
    /// Where every point is. As it stands, what the models of the ground say in competition.
    ///
    /// # Errors
    /// Those of [`Analyzer::analyze`].
    fn analyze(&self, ground: &Ground<'_, S>) -> Result<Analysis, Error> {
        ground.analyzer.analyze(&ground.analysis)
    }

    /// What makes waists of the cloud.
    ///
    /// # Errors
    /// Lengths without a meaning, a plug-in that breaks its laws, or points that the method cannot work on.
    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, S>,
        analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<S> + 'p>, Error>;

    /// Short name for reports.
    fn name(&self) -> &str;
}

/// Cuts the cloud along its curves and points into cells: what the program does unless it is asked for something else.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cells;

impl<S: Scalar> Stratifier<S> for Cells {
    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, S>,
        analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<S> + 'p>, Error> {
        let Ground {
            analyzer,
            options,
            charts,
            selector,
            ..
        } = ground;
        Ok(Box::new(Cut::new(
            analyzer, analysis, *charts, *selector, options,
        )?))
    }

    fn name(&self) -> &str {
        "cells"
    }
}
