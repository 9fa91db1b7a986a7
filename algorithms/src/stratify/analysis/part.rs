//! The analysis of a part of a cloud, whose balls somebody else has looked at.

use super::{Analysis, AnalysisOptions, Analyzer};
use crosscap_core::{BallDimension, Error, Row, Scalar, Table};

/// The balls of a part of a cloud.
///
/// Balls at the rim of a part are cut, so that their dimension cannot be told there: it is given. What else depends on the
/// whole cloud are numbers.
#[derive(Clone, Debug)]
pub struct KnownBalls {
    /// Points and dimension of every ball, as the whole cloud shows them; how many points only matters where the dimension is not 2.
    pub balls: Vec<BallDimension>,
    /// Number of points of the whole cloud, a share of which may stay unexplained.
    pub of: usize,
    /// Mean number of points in a ball of the whole cloud.
    pub mean_neighbors: f64,
}

impl<S: Scalar> Analyzer<'_, S> {
    /// Analyzes a part of a cloud that holds every ball that is not 2-dimensional, and what is about it as far as questions go. Points that are not in the part are inside
    /// cells.
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
        if known.balls.len() != n {
            return Err(Error::Shape {
                found: format!("{} balls", known.balls.len()),
                expected: format!("{n}, one a point"),
            });
        }
        let none: Table<Row, bool> = Table::filled(n, false);
        let mut out = Analysis::of_boundary(&none);
        (out.eps, out.mean_neighbors) = (options.eps, known.mean_neighbors);
        let fitter = self.fitter("since curves are looked for in them")?;
        fitter.look_at(&known.balls, known.of, options, &none, &mut out)?;
        out.models = fitter.counts();
        Ok(out)
    }
}
