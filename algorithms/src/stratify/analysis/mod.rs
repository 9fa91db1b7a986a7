//! Which stratum every point of the cloud is in.

mod about_end;
mod competition;
mod dimension;
mod explain;
mod fitter;
mod groups;
mod ledger;
mod look;
mod refit;

pub(super) use fitter::{Fitter, Scratch};
pub use ledger::ModelCounts;

use super::site::{On, Site, StratumKind, Witness};
use crate::audit;
use crate::execute::{self, Execute};
use crate::space::Space;
use crate::tuning::Tuning;
use crosscap_core::{
    BallDimension, DimensionEstimator, Error, Radii, Row, Scalar, SingularityModel, Table,
};
use explain::{Kind, Verdict};
use groups::Asked;

/// Parameters of the analysis.
#[derive(Clone, Debug)]
pub struct AnalysisOptions {
    /// Radius of the neighborhoods (strict), unit of the data.
    pub eps: f64,
    /// A radius for every point instead (strict), unit of the data: see
    /// [`NeighborhoodPolicy`](crate::neighborhood::NeighborhoodPolicy).
    pub radii: Option<Table<Row, f64>>,
    /// Take every point as 2-dimensional and look for no curve.
    pub surface: bool,
    /// Rows that lie on the boundary.
    pub boundary: Vec<Row>,
}

impl AnalysisOptions {
    /// Radius of the neighborhood of a row.
    fn radius(&self, row: Row) -> f64 {
        self.radii.as_ref().map_or(self.eps, |radii| radii[row])
    }

    /// Radii of all neighborhoods.
    fn all_radii(&self) -> Radii<'_> {
        match &self.radii {
            Some(radii) => Radii::Each(radii.as_slice()),
            None => Radii::Same(self.eps),
        }
    }

    fn check(&self, points: usize) -> Result<(), Error> {
        if !(self.eps > 0.0 && self.eps.is_finite()) {
            return Err(Error::Parameter {
                name: "eps",
                value: self.eps.to_string(),
                expected: "a positive length".into(),
            });
        }
        match &self.radii {
            Some(radii) if radii.len() != points => Err(Error::Shape {
                found: format!("{} radii", radii.len()),
                expected: format!("{points}, one a point"),
            }),
            _ => Ok(()),
        }
    }
}

/// For every row whether it is among those given as boundary.
///
/// # Errors
/// [`Error::Index`] for a row out of range.
pub(super) fn marked(rows: &[Row], points: usize) -> Result<Table<Row, bool>, Error> {
    let mut boundary = Table::filled(points, false);
    for &row in rows {
        *boundary.get_mut(row).ok_or(Error::Index {
            what: "boundary row",
            index: row.index(),
            limit: points,
        })? = true;
    }
    Ok(boundary)
}

/// The space, the engines and the models that the analysis is made with.
pub struct Analyzer<'a, S: Scalar> {
    /// The points. Models are fitted in its coordinates.
    pub space: Space<'a, S>,
    /// Tells the local dimension.
    pub estimator: &'a dyn DimensionEstimator<Scalar = S>,
    /// Models that compete for neighborhoods that are not 2-dimensional.
    pub models: &'a [Box<dyn SingularityModel>],
    /// What runs the points.
    pub execute: &'a dyn Execute,
    /// The numbers that decide.
    pub tuning: &'a Tuning,
}

/// What the analysis found out about every point.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub(super) sites: Table<Row, Site>,
    pub(super) dimensions: Table<Row, u8>,
    pub(super) mean_neighbors: f64,
    pub(super) unexplained: Vec<Row>,
    pub(super) models: Vec<ModelCounts>,
    /// Points near a curve but not on it, with their place on it, by row.
    pub(super) witnesses: Vec<Witness>,
    /// Points whose neighborhood shows a 0-stratum, with its place, by row.
    pub(super) apexes: Vec<Witness>,
}

impl Analysis {
    /// So many points, all inside cells: for a method that looks for no curve.
    pub fn of_surface(points: usize) -> Self {
        Self::of_boundary(&Table::filled(points, false))
    }

    /// Nothing but what was given: boundary points where they are, all others inside cells.
    pub(super) fn of_boundary(boundary: &Table<Row, bool>) -> Self {
        let site = |&given: &bool| match given {
            true => Site::On(Box::new(On::GIVEN_BOUNDARY)),
            false => Site::Regular,
        };
        Self {
            sites: boundary.iter().map(site).collect(),
            dimensions: Table::filled(boundary.len(), 2),
            mean_neighbors: 0.0,
            unexplained: Vec::new(),
            models: Vec::new(),
            witnesses: Vec::new(),
            apexes: Vec::new(),
        }
    }

    /// Where every point is.
    pub fn sites(&self) -> &Table<Row, Site> {
        &self.sites
    }

    /// Local dimension of every point; 2 throughout where `surface` was set.
    pub fn dimensions(&self) -> &Table<Row, u8> {
        &self.dimensions
    }

    /// Mean number of points in a neighborhood; 0 where `surface` was set.
    pub fn mean_neighbors(&self) -> f64 {
        self.mean_neighbors
    }

    /// Number of points whose neighborhood is not 2-dimensional.
    pub fn candidates(&self) -> usize {
        self.dimensions.iter().filter(|&&d| d != 2).count()
    }

    /// Points whose neighborhood no model explained at any radius, by row.
    pub fn unexplained(&self) -> &[Row] {
        &self.unexplained
    }

    /// Number of points on curves and points that models found.
    pub fn curve_points(&self) -> usize {
        let found = |s: &&Site| matches!(s.kind(), Some(StratumKind::Curve | StratumKind::Point));
        self.sites.iter().filter(found).count()
    }

    /// What became of every model, in the order in which they were given.
    pub fn models(&self) -> &[ModelCounts] {
        &self.models
    }

    /// Enters what a point turned out to be.
    fn take(&mut self, row: Row, verdict: Verdict, boundary: bool) {
        self.apexes.extend(verdict.apex);
        match verdict.kind {
            Kind::Regular => {}
            Kind::Unexplained => {
                self.unexplained.push(row);
                if self.sites[row] == Site::Regular {
                    self.sites[row] = Site::Unexplained;
                }
            }
            Kind::Near(witness) => self.witnesses.push(witness),
            Kind::Singular(mut witness) => {
                if boundary && witness.on.kind == StratumKind::Curve {
                    witness.on.kind = StratumKind::Point;
                }
                self.sites[row] = Site::On(Box::new(witness.on));
            }
        }
    }

    /// Brings what was found in the order of the rows.
    fn sort(&mut self) {
        self.apexes.sort_by_key(|w| w.row);
        self.witnesses.sort_by_key(|w| w.row);
        self.unexplained.sort_unstable();
    }
}

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
        let found = execute::map(self.execute, n, Scratch::default, |scratch, i| {
            let (row, dimension) = (Row::new(i), balls[i].dimension as usize);
            self.first_look(row, dimension, options, boundary[row], scratch)
        });
        let mut total = 0usize;
        let mut asked: Vec<(u8, Asked)> = Vec::new();
        for ((row, ball), verdict) in boundary.ids().zip(&balls).zip(found) {
            let (neighbors, dimension) = (ball.neighbors as usize, ball.dimension as u8);
            total += neighbors;
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
        out.mean_neighbors = total as f64 / n.max(1) as f64;
        self.few_are_unexplained(out)
    }

    /// # Errors
    /// [`Error::Dimension`] where so many points are explained by no model that the radius must be unfit.
    fn few_are_unexplained(&self, out: &Analysis) -> Result<(), Error> {
        let limit = self.tuning.analysis.unexplained_share * out.sites.len() as f64;
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
