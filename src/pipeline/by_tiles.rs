//! Reconstruction of a cloud that nobody holds as a whole.

use super::making::{Maker, Triangulated};
use super::mesh::failures;
use super::progress::Progress;
use super::report::{PluginNames, Report};
use super::rows::LEAST_POINTS;
use super::tiled::Tiled;
use super::{Method, Outcome, Parts, Pipeline, Stage};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::Verdict;
use crosscap_algorithms::tiles::{Question, Tiles, landmarks};
use crosscap_core::{Error, LocalChart};

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
        // Rounding of the sum must not make the halo too small for itself.
        reach * (1.0 + 1e-9)
    }

    /// Whether tiles can be asked for all that this pipeline wants to know.
    ///
    /// # Errors
    /// [`Error::Parameter`] for the first thing that they cannot.
    pub fn takes_tiles(&self) -> Result<(), Error> {
        self.parts.takes_tiles()
    }

    /// Reconstructs the surface that a cloud was sampled from which is in `tiles`, made with the
    /// [seed](super::Parameters::seed) and the [halo](Self::tile_halo) of this pipeline. The mesh and the verdict are those of
    /// [`reconstruct`](Self::reconstruct) on the whole cloud, whatever the tiles are.
    ///
    /// Held in one place are landmarks, their waist and their mesh, as many points as the certificate looks at, and four bytes a
    /// point for whoever makes the tiles. Only surfaces without curves: [`surface`](super::Parameters::surface) has to be set, and no boundary,
    /// metric, stratifier, selector or oracle but the usual ones.
    ///
    /// # Errors
    /// [`Error::Parameter`] for what tiles cannot be asked about, [`Error::Shape`] for fewer than 8 points or for points of which two are at
    /// one place, [`Error::SparseNeighborhood`] where points are so sparse that a chart may depend on what is beyond a tile's halo; those
    /// of the tiles and of [`reconstruct`](Self::reconstruct).
    pub fn reconstruct_tiles(&mut self, tiles: &dyn Tiles) -> Result<Outcome, Error> {
        self.guarded(|pipeline| pipeline.tiled(tiles))
    }

    fn tiled(&mut self, tiles: &dyn Tiles) -> Result<Outcome, Error> {
        let halo = self.tile_halo();
        let Self {
            parts, observer, ..
        } = self;
        parts.takes_tiles()?;
        if tiles.halo() < halo {
            return Err(Error::Parameter {
                name: "halo",
                value: tiles.halo().to_string(),
                expected: format!("at least {halo}, for this landmark separation and these charts"),
            });
        }
        let mut progress = Progress::new(observer, &parts.interrupt);
        progress.enter(Stage::Index);
        look_over(tiles)?;
        progress.enter(Stage::Landmarks);
        let watched = Watched::new(parts.chart.as_ref(), &parts.interrupt);
        let chosen = landmarks(tiles, parts.parameters.dl)?;
        let maker = Tiled::new(parts, tiles, &watched, chosen);
        let (made, judged) = maker.mesh(&mut progress)?;
        let failures = match judged.certificate.verdict() {
            Verdict::Verified => Vec::new(),
            _ => failures(&made.triangulation, &made.waist, maker.rows()),
        };
        Ok(Outcome {
            failures,
            homology: judged.homology,
            certificate: judged.certificate,
            pieces: judged.pieces,
            // They are read from all points.
            creases: None,
            special_points: judged.special_points,
            report: Report {
                chart_distortion: watched.distortion(),
                seconds: progress.finish(),
                ..parts.report_of_tiles(tiles, &watched, &made)
            },
            mesh: judged.mesh,
        })
    }
}

impl Parts {
    /// # Errors
    /// [`Error::Parameter`] for what is not asked of tiles.
    fn takes_tiles(&self) -> Result<(), Error> {
        let p = &self.parameters;
        let finds_boundary = self.models.all().iter().any(|m| m.finds_boundary());
        let own_metric = self.analysis_metric.is_some() || self.chart_metric.is_some();
        let usual = |usual: bool| if usual { "usual" } else { "another" };
        let straight = p.spaces.are_usual() && !own_metric;
        let cells = p.method == Method::Cells && self.stratifier.name() == "cells";
        let random = self.selector.name() == "random";
        let alone = p.boundary.is_empty() && !finds_boundary;
        let curves =
            "since curves are not looked for in tiles (a cloud in memory is searched for them)";
        let taken = [
            (
                "surface",
                p.surface,
                p.surface.to_string(),
                format!("true, {curves}"),
            ),
            (
                "boundary",
                alone,
                "looked for or given".into(),
                format!("none, {curves}"),
            ),
            (
                "metric",
                straight,
                usual(straight).into(),
                "straight lines, which tiles know".into(),
            ),
            ("method", cells, usual(cells).into(), "that of cells".into()),
            (
                "selector",
                random,
                usual(random).into(),
                "random, the order that tiles have".into(),
            ),
            (
                "oracle",
                self.oracle.is_none(),
                "another".into(),
                "none: tiles are their own".into(),
            ),
        ];
        match taken.into_iter().find(|one| !one.1) {
            None => Ok(()),
            Some((name, _, value, expected)) => Err(Error::Parameter {
                name,
                value,
                expected,
            }),
        }
    }

    /// What the stages counted.
    fn report_of_tiles(
        &self,
        tiles: &dyn Tiles,
        chart: &dyn LocalChart,
        made: &Triangulated,
    ) -> Report {
        Report {
            version: env!("CARGO_PKG_VERSION"),
            points: tiles.points() + tiles.left_out(),
            dimension: tiles.dimension(),
            duplicates: tiles.left_out(),
            plugins: PluginNames {
                metric: "euclidean".into(),
                oracle: "tiles".into(),
                chart_metric: "places".into(),
                estimator: None,
                ..self.makers(chart)
            },
            mean_neighbors: 0.0,
            candidates: 0,
            curve_points: 0,
            unexplained: 0,
            models: Vec::new(),
            landmarks: made.waist.counts,
            added_landmarks: made.added.len(),
            triangulation: made.triangulation.counts,
            chart_distortion: Distortion::default(),
            graph: None,
            given: None,
            warnings: Vec::new(),
            tuning: self.tuning.clone(),
            seconds: Vec::new(),
            parameters: self.parameters.clone(),
        }
    }
}

/// # Errors
/// [`Error::Shape`] for points that cannot be worked on.
fn look_over(tiles: &dyn Tiles) -> Result<(), Error> {
    let shape = |found: String, expected: String| Err(Error::Shape { found, expected });
    if tiles.dimension() < 2 {
        let found = format!("points of R^{}", tiles.dimension());
        return shape(found, "at least 2 coordinates".into());
    }
    if tiles.points() < LEAST_POINTS {
        let found = format!("{} points", tiles.points());
        return shape(found, format!("at least {LEAST_POINTS}"));
    }
    let copies = tiles.gather(&Question::Copies)?;
    match copies.rows().first() {
        None => Ok(()),
        Some(row) => shape(
            format!(
                "{} points at the place of another, first row {}",
                copies.len(),
                row.index()
            ),
            "points without copies: leave them out".into(),
        ),
    }
}
