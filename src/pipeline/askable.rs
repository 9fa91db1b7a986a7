//! What tiles are asked for by a pipeline, and whether they can be.

use super::{Method, Models, Parts, Pipeline};
use crosscap_algorithms::tiles::{BallQuestion, LookQuestion};
use crosscap_core::{Error, SingularityModel};

impl Pipeline {
    /// How far the points of every tile have to go beyond its box for [`reconstruct_tiles`](Self::reconstruct_tiles), unit of
    /// the data.
    pub fn tile_halo(&self) -> f64 {
        let Parts {
            parameters, tuning, ..
        } = &self.parts;
        let reach = crosscap_algorithms::tiles::halo(
            parameters.dl,
            parameters.chart_radius(),
            &tuning.cells,
        );
        let reach = match self.parts.looks_at_balls() {
            true => reach.max(parameters.eps),
            false => reach,
        };
        // Rounding of the sum must not make the halo too small for itself.
        reach * (1.0 + 1e-9)
    }

    /// How far from balls that are not 2-dimensional, or show more than a sheet, the points are gathered that curves are laid in, at first, unit of the data; where it is too
    /// little they are gathered once more.
    ///
    /// Beside the curves fits label points, charts that reach these belong to landmarks beyond, and what is in these charts has to be known with its nearest
    /// neighbors.
    pub fn excerpt_reach(&self) -> f64 {
        let Parts {
            parameters, tuning, ..
        } = &self.parts;
        let charts = 2.0 * parameters.chart_radius();
        let gaps = (tuning.cells.curve_gap + 1.0) * parameters.dl;
        charts + gaps + tuning.analysis.label_margin * parameters.eps
    }

    /// The question about balls that a run in tiles begins with; `None` where nothing is looked for in them.
    pub fn balls(&self) -> Option<BallQuestion> {
        (self.parts.looks_at_balls()).then(|| self.parts.balls())
    }

    /// Whether tiles can be asked for all that this pipeline wants to know.
    ///
    /// # Errors
    /// [`Error::Parameter`] for the first thing that they cannot.
    pub fn takes_tiles(&self) -> Result<(), Error> {
        self.parts.takes_tiles()
    }
}

impl Parts {
    /// Whether anything is looked for in balls.
    pub(super) fn looks_at_balls(&self) -> bool {
        !self.parameters.surface || self.finds_boundary()
    }

    /// Whether the surface is known to have no boundary.
    pub(super) fn is_closed(&self) -> bool {
        self.parameters.boundary.is_empty() && !self.finds_boundary()
    }

    fn finds_boundary(&self) -> bool {
        self.models.all().iter().any(|m| m.finds_boundary())
    }

    /// The model that is asked about 2-dimensional balls, if one is.
    fn asks_everywhere(&self) -> Option<&dyn SingularityModel> {
        let mut models = self.models.all().iter().filter(|_| self.looks_at_balls());
        models.find(|m| m.applies_to(2)).map(AsRef::as_ref)
    }

    /// The balls that curves and boundaries are looked for in.
    pub(super) fn balls(&self) -> BallQuestion {
        let (p, tuning) = (&self.parameters, &self.tuning);
        BallQuestion {
            eps: p.eps,
            dt: p.dt,
            least: tuning.analysis.least_neighbors,
            surface: p.surface,
            looks: self.asks_everywhere().map(|_| {
                Box::new(LookQuestion {
                    models: p.models.clone(),
                    dp: p.dp,
                    ep: p.ep,
                    analysis: tuning.analysis.clone(),
                    tuning: tuning.models,
                })
            }),
        }
    }

    /// # Errors
    /// [`Error::Parameter`] for what is not asked of tiles.
    pub(super) fn takes_tiles(&self) -> Result<(), Error> {
        let p = &self.parameters;
        let own_metric = self.analysis_metric.is_some() || self.chart_metric.is_some();
        let usual = |usual: bool| if usual { "usual" } else { "another" };
        let straight = p.spaces.are_usual() && !own_metric;
        let cells = p.method == Method::Cells && self.stratifier.name() == "cells";
        let random = self.selector.name() == "random";
        let own = match self.models {
            Models::Named(_) => None,
            Models::Own(_) => self.asks_everywhere(),
        };
        let taken = [
            (
                "boundary",
                p.boundary.is_empty(),
                "given".into(),
                "none, since tiles are not told of it (models of boundaries find it)",
            ),
            (
                "models",
                own.is_none(),
                own.map_or(String::new(), |model| model.name().into()),
                "models that are named: this one is your own and asked about every point, and whoever has a tile makes models by name",
            ),
            (
                "estimator",
                self.estimator.is_none(),
                "another".into(),
                "none: tiles tell dimensions by principal components",
            ),
            (
                "metric",
                straight,
                usual(straight).into(),
                "straight lines, which tiles know",
            ),
            ("method", cells, usual(cells).into(), "that of cells"),
            (
                "selector",
                random,
                usual(random).into(),
                "random, the order that tiles have",
            ),
            (
                "oracle",
                self.oracle.is_none(),
                "another".into(),
                "none: tiles are their own",
            ),
        ];
        match taken.into_iter().find(|one| !one.1) {
            None => Ok(()),
            Some((name, _, value, expected)) => Err(Error::Parameter {
                name,
                value,
                expected: expected.into(),
            }),
        }
    }
}
