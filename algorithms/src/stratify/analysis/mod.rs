//! Which stratum every point of the cloud is in.

mod about_end;
mod analyzer;
mod competition;
mod continued;
mod dimension;
mod explain;
mod fitter;
mod found;
mod groups;
mod ledger;
mod look;
mod options;
mod part;
mod refit;
mod seen;

pub use analyzer::Analyzer;
pub(super) use fitter::{Fitter, Scratch};
pub use found::Analysis;
pub use ledger::ModelCounts;
pub use options::AnalysisOptions;
pub(super) use options::marked;
pub use part::KnownBalls;
pub(crate) use seen::Looks;
pub use seen::Seen;

use crate::audit;
use crosscap_core::{BallDimension, Error, Row, Scalar, Table};
use explain::Verdict;
use groups::Asked;

/// What a first look says of a row whose ball has a dimension.
type FirstLook<'f, S> = dyn Fn(Row, usize, &mut Scratch<S>) -> Option<Box<Verdict>> + Sync + 'f;

impl<'a, S: Scalar> Analyzer<'a, S> {
    /// Analyzes every point.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a radius that is not positive, [`Error::Index`] for a boundary row
    /// out of range, [`Error::SparseNeighborhood`] where a neighborhood holds fewer than 8 points,
    /// [`Error::Shape`] where curves are looked for in a space without coordinates, [`Error::Law`] for what
    /// the metric, the oracle, the estimator or a model breaks,
    /// [`Error::Dimension`] where more than 5 % of the points are explained by no model.
    ///
    /// O(n k N^2) for k points in a neighborhood.
    pub fn analyze(&self, options: &AnalysisOptions) -> Result<Analysis, Error> {
        let n = self.space.len();
        options.check(n)?;
        let boundary = marked(&options.boundary, n)?;
        let mut out = Analysis::of_boundary(&boundary);
        self.space.audit(options.eps)?;
        for model in self.models {
            audit::local_dimension(model.as_ref())?;
        }
        let looked_at = !options.surface || self.models.iter().any(|m| m.finds_boundary());
        if looked_at {
            (out.eps, out.radii) = (options.eps, options.radii.clone());
            let fitter = self.fitter("since curves and boundaries are looked for in them")?;
            fitter.look(options, &boundary, &mut out)?;
            out.models = fitter.counts();
        }
        Ok(out)
    }

    /// What fits models, with the coordinates at hand.
    ///
    /// # Errors
    /// [`Error::Shape`] where there are none; `why` says what they are for.
    pub(super) fn fitter(&self, why: &str) -> Result<Fitter<'a, S>, Error> {
        Ok(Fitter::new(self, self.space.coordinates(why)?))
    }
}

impl<S: Scalar> Fitter<'_, S> {
    /// Looks at every point, explains those that are not 2-dimensional, and looks again beside the curves
    /// that were found.
    fn look(
        &self,
        options: &AnalysisOptions,
        boundary: &Table<Row, bool>,
        out: &mut Analysis,
    ) -> Result<(), Error> {
        let n = boundary.len();
        // Where surface is set every ball is 2-dimensional on trust, and only a boundary is looked for.
        let balls = match options.surface {
            true => vec![
                BallDimension {
                    neighbors: 0,
                    dimension: 2
                };
                n
            ],
            false => self.dimensions(options.all_radii())?,
        };
        let total: usize = balls.iter().map(|ball| ball.neighbors as usize).sum();
        out.mean_neighbors = total as f64 / n.max(1) as f64;
        let first = |row: Row, dimension: usize, scratch: &mut Scratch<S>| {
            self.first_look(row, dimension, options, boundary[row], scratch)
        };
        self.look_at(&balls, &first, n, options, boundary, out)
    }

    /// The same with balls that are known, and what a `first` look at each says, of points that are all of a cloud of so many or a part of it.
    fn look_at(
        &self,
        balls: &[BallDimension],
        first: &FirstLook<'_, S>,
        of: usize,
        options: &AnalysisOptions,
        boundary: &Table<Row, bool>,
        out: &mut Analysis,
    ) -> Result<(), Error> {
        let found = self
            .space
            .map(self.execute, Scratch::default, |scratch, i| {
                first(Row::new(i), balls[i].dimension as usize, scratch)
            });
        let mut asked: Vec<(u8, Asked)> = Vec::new();
        for ((row, ball), verdict) in boundary.ids().zip(balls).zip(found) {
            let (neighbors, dimension) = (ball.neighbors as usize, ball.dimension as u8);
            out.dimensions[row] = dimension;
            match verdict {
                Some(verdict) => out.take(row, *verdict, boundary[row]),
                None if dimension == 2 => {}
                None => asked.push((dimension, Asked { row, neighbors })),
            }
        }
        asked.sort_by_key(|a| a.0);
        for same in asked.chunk_by(|a, b| a.0 == b.0) {
            let rows = same.iter().map(|a| a.1).collect();
            for (i, verdict) in self.explain_all(rows, same[0].0.into(), options, true) {
                out.take(i, verdict, boundary[i]);
            }
        }
        let again = self.beside_curves(out, options);
        for (i, verdict) in self.explain_all(again, 3, options, false) {
            if !verdict.is_unexplained() {
                out.take(i, verdict, boundary[i]);
            }
        }
        out.sort();
        self.faults.none()?;
        self.few_are_unexplained(out, of)
    }

    /// # Errors
    /// [`Error::Dimension`] where so many points are explained by no model that the radius must be unfit.
    fn few_are_unexplained(&self, out: &Analysis, of: usize) -> Result<(), Error> {
        let limit = self.tuning.analysis.unexplained_share * of as f64;
        match out.unexplained.first() {
            Some(&point) if out.unexplained.len() as f64 > limit => Err(Error::Dimension {
                point: point.index(),
                dimension: out.dimensions[point] as usize,
                count: out.unexplained.len(),
                parameter: "eps",
            }),
            _ => Ok(()),
        }
    }
}
