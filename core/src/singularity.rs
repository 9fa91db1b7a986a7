//! Models of how a surface can be singular.

use crate::{Decomposition, Link, LocalPoints, Located};

/// Why a model does not apply to a neighborhood.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Rejection {
    /// Too few points for the number of parameters.
    TooFewPoints {
        /// Points there are.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// The algebra has no real solution of the form the model asks for.
    NoRealSolution,
    /// The fit is worse than the threshold.
    PoorFit {
        /// Residual of the fit, unit of the data.
        residual: f64,
        /// The threshold it broke.
        limit: f64,
    },
    /// A simpler model explains the points as well.
    SimplerModelFits {
        /// Residual of this model.
        residual: f64,
        /// Residual of the simpler one.
        simpler: f64,
    },
    /// The neighborhood shows the singularity, and not all that is needed of it.
    NeighborhoodTooSmall {
        /// Radius about the same center that would do.
        needed: f64,
    },
    /// One of the strata holds too few points to be believed.
    EmptyStratum {
        /// Which stratum.
        stratum: usize,
        /// Points found in it.
        found: usize,
    },
}

/// Proposes a decomposition of a neighborhood, and says how well it fits.
///
/// # Why it has this shape
/// A model answers two questions that only it can answer, and leaves the others to the pipeline. Which strata are
/// there, and in which of them is each point? How far are the points from what the model says? With the number of
/// its parameters the second lets models compete that know nothing of each other, so that adding one to a list
/// needs no change in any other. Whether a model is believed is not its own affair: it is compared with a
/// single sheet, and rejects only what it cannot describe.
///
/// A model works in a fixed small number of principal coordinates, whatever the space of the data: a crossing of
/// two sheets in R^72 lies in three dimensions, and a fit in them is quick. Rows behind those that are fitted are
/// labelled as well, because cells are told apart a little farther out than a fit is good.
///
/// # Laws
/// - *motion*: the same decomposition, up to the names of the cells, after a motion of the
///   data, from which principal coordinates are taken anew (signs of axes are arbitrary);
/// - *order*: the same decomposition for any order of the points;
/// - *partition*: every point has exactly one label;
/// - *exact data*: residual 0, within rounding, on points of an exact instance, and growing with noise.
pub trait SingularityModel: Sync {
    /// Number of principal coordinates that the model works in (3 for two planes in space).
    fn local_dimension(&self) -> usize;

    /// Whether the model is to be asked about neighborhoods of this local dimension; 3 and more
    /// unless a model says otherwise.
    ///
    /// Where the dimension is 3 or more an answer must halve the residual of a single sheet to
    /// be believed. Where it is 1 or 2 there is nothing to halve: a model that asks for such
    /// neighborhoods must itself reject those that show no singularity.
    fn applies_to(&self, dimension: usize) -> bool {
        dimension > 2
    }

    /// Whether the curves of the model are boundaries: laid before the others, without cells to tell
    /// apart, and corners where another curve meets them.
    fn finds_boundary(&self) -> bool {
        false
    }

    /// Whether rows behind those that are fitted change the answer, and not their own labels alone: a model
    /// that counts the few points of a curve counts all of them. A model that says no is spared rows
    /// whose labels nobody asks for.
    fn looks_behind(&self) -> bool {
        false
    }

    /// Whether the model says what is at the end of a curve: it is then asked about balls about the ends of
    /// double curves, of eps and wider ones, and its labels stand for all points of the ball about the point
    /// that it finds. Such a model is not asked elsewhere unless [`SingularityModel::applies_to`] says so.
    ///
    /// Together with [`SingularityModel::finds_boundary`] it says the same of boundaries: it is asked about balls of two eps and more about points of
    /// boundaries that were found, and what it finds are corners.
    fn explains_ends(&self) -> bool {
        false
    }

    /// The link of the 0-strata of the model, where it has any and knows what they look like: the
    /// vertex of the mesh that stands for such a point must have it.
    fn link(&self) -> Option<Link> {
        None
    }

    /// The link of the 0-strata of one of its own decompositions: for a model that knows several kinds of points, and can
    /// tell from the strata which of them it found.
    fn link_of(&self, _fit: &Decomposition) -> Option<Link> {
        self.link()
    }

    /// Fits the model.
    ///
    /// # Errors
    /// The [`Rejection`] that says why the model does not apply.
    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection>;

    /// Fits the model once and says of the given `rows` what a decomposition says of the center:
    /// the dimension of the stratum it is in and the place it is moved to. `None` for a row that
    /// would have to be the center for an answer.
    ///
    /// The fit of a neighborhood holds for all points near its center, and locating a point takes
    /// much less time than fitting. As it stands the model is fitted anew for every row; a model
    /// whose fit does not depend on the center does better.
    ///
    /// # Errors
    /// The [`Rejection`] that says why the model does not apply.
    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        let fit = self.decompose(local)?;
        let located = rows
            .iter()
            .map(|&row| {
                let own = LocalPoints {
                    center: row,
                    ..*local
                };
                let fit = self.decompose(&own).ok()?;
                // Not every model keeps its labels in range.
                let label = fit.labels.get(row)?.index();
                (label < fit.strata.len()).then(|| fit.located(row))
            })
            .collect();
        Ok((fit, located))
    }

    /// Short name for reports and the command line.
    fn name(&self) -> &str;
}
