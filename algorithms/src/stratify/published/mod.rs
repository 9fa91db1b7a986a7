//! The preprocessing of Martin & Watson (2011) to the letter, for comparison.
//!
//! What the paper does not say is decided here as follows.
//! - A neighborhood of dimension 0, 1 or more than 3, or of dimension 3 whose fit is rejected, stays
//!   undivided: B0 is empty and B1 is all of it.
//! - A fit is rejected when the planes are not real, when there are fewer than 10 points (the quadric
//!   has 9 degrees of freedom), or when the *root* mean squared distance to the nearer plane exceeds dp.
//! - Where the triangulation has a radius of its own, planes are fitted to the ball of eps and
//!   divide the larger ball; which points are on curves is decided with eps alone.
//! - A landmark on a curve is laid out in its own B0 where that holds it, otherwise in the B0 of the
//!   nearest point whose B0 holds it. It is joined to the nearest landmark on either side in the
//!   chart, unless an edge leads to that side already. A side without landmarks stays free.
//! - A given boundary point counts as a curve point, its B0 is the boundary points in its ball,
//!   and an edge between two boundary landmarks bounds one cell. Any other curve edge bounds four.

mod analysis;
mod divide;
#[cfg(test)]
mod tests;
mod waist;

pub use analysis::Published;
pub use waist::PublishedCut;

use super::analysis::Analysis;
use super::producer::WaistProducer;
use super::stratifier::{Ground, Stratifier};
use crosscap_core::{Error, Scalar};

/// The published method as a [`Stratifier`], with the parameters of the ground. Models are not asked.
#[derive(Clone, Copy, Debug, Default)]
pub struct PublishedMethod;

impl PublishedMethod {
    fn of<S: Scalar>(ground: &Ground<'_, S>) -> Published {
        Published {
            eps: ground.analysis.eps,
            tri_eps: ground.options.tri_eps,
            dp: ground.dp,
            ep: ground.ep,
            dl: ground.options.dl,
            seed: ground.options.seed,
            surface: ground.analysis.surface,
            boundary: ground.analysis.boundary.clone(),
        }
    }
}

impl<S: Scalar> Stratifier<S> for PublishedMethod {
    fn analyze(&self, ground: &Ground<'_, S>) -> Result<Analysis, Error> {
        Self::of(ground).analyze(&ground.analyzer)
    }

    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, S>,
        analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<S> + 'p>, Error> {
        let Ground {
            analyzer,
            charts,
            selector,
            chart,
            ..
        } = ground;
        let method = Self::of(ground);
        let cut = method.cut(analyzer, analysis, *charts, *selector, *chart)?;
        Ok(Box::new(cut))
    }

    fn name(&self) -> &str {
        "paper"
    }
}
