//! The analysis of a part of a cloud, whose balls somebody else has looked at.

use super::{Analysis, AnalysisOptions, Analyzer, ModelCounts, Seen};
use crosscap_core::{BallDimension, Error, Row, Scalar, Table};

/// The balls of a part of a cloud.
///
/// Balls at the rim of a part are cut, so that their dimension and what they show cannot be told there: both are given. What else depends
/// on the whole cloud are numbers.
#[derive(Clone, Debug)]
pub struct KnownBalls {
    /// Points and dimension of every ball, as the whole cloud shows them; how many points only matters where the dimension is not 2.
    pub balls: Vec<BallDimension>,
    /// What the models see in those that are 2-dimensional.
    pub seen: Vec<Option<Seen>>,
    /// What became of the models that were asked for that, of all of the cloud; nothing where none was.
    pub models: Vec<ModelCounts>,
    /// Number of points of the whole cloud, a share of which may stay unexplained.
    pub of: usize,
    /// Mean number of points in a ball of the whole cloud.
    pub mean_neighbors: f64,
}

impl<S: Scalar> Analyzer<'_, S> {
    /// Analyzes a part of a cloud that holds every ball in which there is more than a sheet, and what is about it as far as questions go. Points that
    /// are not in the part are inside cells.
    ///
    /// # Errors
    /// Those of [`analyze`](Self::analyze), but for balls and laws of the metric, which others have looked at;
    /// [`Error::Shape`] unless there is a ball for every point.
    pub fn analyze_part(
        &self,
        options: &AnalysisOptions,
        known: &KnownBalls,
    ) -> Result<Analysis, Error> {
        let n = self.space.len();
        options.check(n)?;
        let of_points = |found: usize, what: &str| match found == n {
            true => Ok(()),
            false => Err(Error::Shape {
                found: format!("{found} {what}"),
                expected: format!("{n}, one a point"),
            }),
        };
        of_points(known.balls.len(), "balls")?;
        of_points(known.seen.len(), "looks")?;
        let none: Table<Row, bool> = Table::filled(n, false);
        let mut out = Analysis::of_boundary(&none);
        (out.eps, out.mean_neighbors) = (options.eps, known.mean_neighbors);
        let fitter = self.fitter("since curves are looked for in them")?;
        let look = |row: Row, dimension: usize, scratch: &mut _| match dimension {
            2 => {
                let seen = known.seen[row.index()].as_ref();
                seen.map(|seen| Box::new(seen.verdict(row)))
            }
            _ => fitter.first_look(row, dimension, options, false, scratch),
        };
        fitter.look_at(&known.balls, &look, known.of, options, &none, &mut out)?;
        out.models = ModelCounts::with_later(&fitter.counts(), &known.models);
        Ok(out)
    }
}
