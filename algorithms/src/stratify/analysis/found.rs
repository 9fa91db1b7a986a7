//! What an analysis found out.

use super::explain::{Kind, Verdict};
use super::ledger::ModelCounts;
use crate::stratify::site::{On, Site, StratumKind, Witness};
use crosscap_core::{Row, Table};

/// What the analysis found out about every point.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub(in crate::stratify) sites: Table<Row, Site>,
    pub(in crate::stratify) dimensions: Table<Row, u8>,
    pub(in crate::stratify) mean_neighbors: f64,
    pub(in crate::stratify) unexplained: Vec<Row>,
    pub(in crate::stratify) models: Vec<ModelCounts>,
    /// Points near a curve but not on it, with their place on it, by row.
    pub(in crate::stratify) witnesses: Vec<Witness>,
    /// Points whose neighborhood shows a 0-stratum, with its place, by row.
    pub(in crate::stratify) apexes: Vec<Witness>,
    /// Radius of the neighborhoods, or of each; 0 where none was looked at.
    pub(super) eps: f64,
    pub(super) radii: Option<Table<Row, f64>>,
}

impl Analysis {
    /// So many points, all inside cells: for a method that looks for no curve.
    pub fn of_surface(points: usize) -> Self {
        Self::of_boundary(&Table::filled(points, false))
    }

    /// Nothing but what was given: boundary points where they are, all others inside cells.
    pub(in crate::stratify) fn of_boundary(boundary: &Table<Row, bool>) -> Self {
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
            eps: 0.0,
            radii: None,
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

    /// Radius of the neighborhood of a row.
    pub(in crate::stratify) fn radius(&self, row: Row) -> f64 {
        self.radii.as_ref().map_or(self.eps, |radii| radii[row])
    }

    /// Enters what a point turned out to be.
    pub(super) fn take(&mut self, row: Row, verdict: Verdict, boundary: bool) {
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
    pub(super) fn sort(&mut self) {
        self.apexes.sort_by_key(|w| w.row);
        self.witnesses.sort_by_key(|w| w.row);
        self.unexplained.sort_unstable();
    }
}
