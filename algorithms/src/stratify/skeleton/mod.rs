//! The skeleton: landmarks on points and along curves, and the chains that join them.
//!
//! Points come first, then boundaries, then curves. The points of a curve that was found are a band;
//! a thinned set of them are the nodes of a graph, the graph falls into parts (one curve each), and along
//! each part landmarks are laid at a separation that closes it well.

#[cfg(test)]
mod about_point;
mod ends;
mod graph;
mod ground;
mod join;
mod lay;
mod nodes;
mod sweep;
mod thin;
mod unreached;

use super::analysis::Analyzer;
use super::atlas::{Atlas, FitId, Reference};
use super::site::StratumKind;
use super::strata::Strata;
use super::stratification::PointStratum;
use crosscap_core::{CurveEdge, Error, Landmark, Row, Scalar, SingularityModel, Table};
use ground::Ground;
use thin::thin;

/// Landmarks on points and curves, with the chains.
#[derive(Default)]
pub(super) struct Skeleton {
    /// Rows of the landmarks, points first.
    rows: Table<Landmark, Row>,
    /// How many of them are points.
    corners: usize,
    /// How many cells meet in the curve of each landmark, in the order of `rows`; 0 for points.
    cells: Table<Landmark, u8>,
    /// Chain edges between positions in `rows`.
    edges: Vec<CurveEdge>,
    /// All fits.
    atlas: Atlas,
    /// Those about points, in the order of `rows`, where there is one.
    corner_fits: Vec<FitId>,
    /// Those that label the points of the cloud.
    labelling: Vec<FitId>,
    /// Corners that a curve does not reach although the fit about them says so, once for each such curve.
    unreached: Vec<Row>,
}

impl Skeleton {
    /// Lays landmarks and chains over the strata, and makes the fits that label the points around.
    ///
    /// # Errors
    /// [`Error::Shape`] for strata in a space without coordinates, [`Error::Law`] for what a model breaks.
    pub(super) fn lay<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        strata: &Strata,
        dl: f64,
    ) -> Result<Self, Error> {
        let mut out = Self::default();
        let (Some(places), true) = (
            strata.places(),
            strata.sites().iter().any(|site| site.on().is_some()),
        ) else {
            return Ok(out);
        };
        let fitter = analyzer.fitter("since curves are laid in them")?;
        let ground = Ground {
            fitter: &fitter,
            strata,
            places,
            tuning: &analyzer.tuning.skeleton,
            dl,
        };
        out.lay_points(&ground);
        for kind in [StratumKind::Boundary, StratumKind::Curve] {
            out.lay_kind(&ground, kind);
        }
        out.join_free_ends(&ground);
        out.edges.sort_unstable();
        out.edges.dedup_by_key(|e| e.ends);
        out.label(&ground);
        fitter.faults.none()?;
        Ok(out)
    }

    /// Takes the points that are 0-strata for landmarks, and makes the fits about them.
    fn lay_points<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>) {
        self.rows = thin(ground, ground.dl, StratumKind::Point).into();
        self.corners = self.rows.len();
        self.cells = Table::filled(self.corners, 0);
        let rows = self.rows.as_slice();
        self.atlas.fit(ground.fitter, ground.strata, rows);
        self.corner_fits = self.atlas.about_all(rows);
    }

    /// Makes the fits that label points: about every landmark, and along the curves between them.
    fn label<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>) {
        let strata = ground.strata;
        let fitted: Vec<Row> = (self.rows.iter().copied())
            .filter(|&r| strata.radius(r).is_some())
            .collect();
        self.atlas.fit(ground.fitter, strata, &fitted);
        self.labelling = self.atlas.about_all(&fitted);
        let radii = fitted.iter().filter_map(|&r| strata.radius(r));
        let least = radii.fold(f64::INFINITY, f64::min);
        if !least.is_finite() {
            return;
        }
        let known: Vec<Row> = self.labelling().map(|r| r.row).collect();
        let spacing = ground.tuning.label_spacing * least;
        let mut more = thin(ground, spacing, StratumKind::Curve);
        more.retain(|row| !known.contains(row));
        self.atlas.fit(ground.fitter, strata, &more);
        self.labelling.extend(self.atlas.about_all(&more));
    }

    /// Rows of the landmarks, points first.
    pub(super) fn rows(&self) -> &Table<Landmark, Row> {
        &self.rows
    }

    /// Rows of the landmarks that are points.
    fn corner_rows(&self) -> &[Row] {
        &self.rows.as_slice()[..self.corners]
    }

    /// How many of the landmarks are points.
    pub(super) fn corners(&self) -> usize {
        self.corners
    }

    /// Chain edges between positions in [`rows`](Self::rows).
    pub(super) fn edges(&self) -> &[CurveEdge] {
        &self.edges
    }

    /// The fits that label the points of the cloud.
    pub(super) fn labelling(&self) -> impl Iterator<Item = &Reference> {
        self.labelling.iter().map(|&id| self.atlas.get(id))
    }

    /// The fits about points.
    fn corner_fits(&self) -> impl Iterator<Item = &Reference> {
        self.corner_fits.iter().map(|&id| self.atlas.get(id))
    }

    /// The `k`-th of the fits about points.
    fn corner_fit(&self, k: usize) -> &Reference {
        self.atlas.get(self.corner_fits[k])
    }

    /// The points that models call 0-strata. The link is not theirs where a curve that they count does not reach the point.
    pub(super) fn points(
        &self,
        strata: &Strata,
        models: &[Box<dyn SingularityModel>],
    ) -> Vec<PointStratum> {
        self.corner_fits()
            .filter(|r| r.has_points())
            .filter_map(|r| {
                let landmark = self.corner_rows().iter().position(|&c| c == r.row)?;
                let count = |d| r.fit.strata.iter().filter(|s| s.dimension == d).count();
                let unreached = self.unreached.iter().filter(|&&row| row == r.row).count();
                Some(PointStratum {
                    landmark: Landmark::new(landmark),
                    curves: count(1) - unreached.min(count(1)),
                    cells: count(2),
                    link: (strata.sites()[r.row].on()?.fit)
                        .filter(|_| unreached == 0)
                        .and_then(|used| models[usize::from(used.model)].link_of(&r.fit)),
                })
            })
            .collect()
    }
}
