//! Reconstruction of a cloud that nobody holds as a whole.

use super::making::{Maker, Triangulated};
use super::mesh::failures;
use super::progress::Progress;
use super::report::{PluginNames, Report};
use super::rows::LEAST_POINTS;
use super::tiled::Tiled;
use super::{Outcome, Parts, Pipeline, Stage};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::Verdict;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, ChartSpace, Cut, ModelCounts, StratifyOptions,
};
use crosscap_algorithms::tiles::{
    Candidates, Curves, Excerpt, Gathered, Question, Tiles, landmarks,
};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{DimensionEstimator, Error, LocalChart};

impl Pipeline {
    /// Reconstructs the surface that a cloud was sampled from which is in `tiles`, made with the
    /// [seed](super::Parameters::seed) and the [halo](Self::tile_halo) of this pipeline. The mesh and the verdict are those of
    /// [`reconstruct`](Self::reconstruct) on the whole cloud, whatever the tiles are.
    ///
    /// Held in one place are landmarks, their waist and their mesh, as many points as the certificate looks at, and four bytes a
    /// point for whoever makes the tiles, and where curves or boundaries are looked for the points about them. No metric, estimator, stratifier,
    /// selector or oracle but the usual ones, and no boundary that is given.
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
        let reach = self.excerpt_reach();
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
        let asked = Asked { parts, tiles };
        let mut outcome = match parts.looks_at_balls() {
            true => asked.with_curves(reach, &mut progress)?,
            false => asked.finished(None, &mut progress)?,
        };
        outcome.report.seconds = progress.finish();
        Ok(outcome)
    }
}

/// Tiles, and what asks them.
struct Asked<'t> {
    parts: &'t Parts,
    tiles: &'t dyn Tiles,
}

/// What was found out about curves.
struct Found<'f> {
    analysis: &'f Analysis,
    curves: &'f Curves<'f>,
    estimator: &'f str,
}

impl Asked<'_> {
    /// The outcome where curves or boundaries are looked for, in an excerpt that is made wider until it knows all that is asked of it.
    fn with_curves(&self, mut reach: f64, progress: &mut Progress<'_>) -> Result<Outcome, Error> {
        progress.enter(Stage::Neighborhoods);
        let candidates = Candidates::of(self.tiles, self.parts.balls())?;
        loop {
            let excerpt = Excerpt::gather(self.tiles, &candidates, reach)?;
            let end = self.in_excerpt(&excerpt, progress);
            match excerpt.wider() {
                None => return end,
                Some(wider) => reach = wider,
            }
            progress.enter(Stage::Neighborhoods);
        }
    }

    /// The same with an excerpt; of no use where that turns out to be too narrow.
    fn in_excerpt(&self, excerpt: &Excerpt, progress: &mut Progress<'_>) -> Result<Outcome, Error> {
        let (parts, parameters) = (self.parts, &self.parts.parameters);
        let threads = parts.threads()?;
        let tree = EuclideanOracle::new(excerpt.cloud().clone())?;
        let oracle = excerpt.watched(&tree);
        let estimator = PrincipalComponents::new(parameters.dt)?;
        let analyzer = Analyzer {
            space: Space::new(&tree, &oracle),
            estimator: &estimator,
            models: parts.models.all(),
            execute: &threads,
            tuning: &parts.tuning,
        };
        let options = AnalysisOptions {
            eps: parameters.eps,
            radii: None,
            surface: parameters.surface,
            boundary: Vec::new(),
        };
        let analysis = analyzer.analyze_part(&options, excerpt.balls());
        let analysis = analysis.map_err(|error| self.in_input(error, excerpt))?;
        let options = StratifyOptions {
            dl: parameters.dl,
            tri_eps: parameters.chart_radius(),
            seed: parameters.seed,
        };
        let cut = Cut::laid(&analyzer, &analysis, ChartSpace::Places, &options)?;
        let curves = Curves::new(excerpt, &cut, &options, &parts.tuning.cells);
        let found = Found {
            analysis: &analysis,
            curves: &curves,
            estimator: estimator.name(),
        };
        self.finished(Some(&found), progress)
    }

    /// An error with rows of the input instead of those of an excerpt.
    fn in_input(&self, mut error: Error, excerpt: &Excerpt) -> Error {
        if let Error::Dimension { point, .. } | Error::Law { point, .. } = &mut error
            && let Some(&row) = excerpt.rows().get(*point)
        {
            *point = self.tiles.input_row(row);
        }
        error
    }

    /// The outcome with what was found out about curves, where they were looked for.
    fn finished(
        &self,
        found: Option<&Found<'_>>,
        progress: &mut Progress<'_>,
    ) -> Result<Outcome, Error> {
        let Self { parts, tiles } = *self;
        progress.enter(Stage::Landmarks);
        let watched = Watched::new(parts.chart.as_ref(), &parts.interrupt);
        let curves = found.map(|found| found.curves);
        let mut first = Gathered::new(tiles.dimension());
        if let Some(curves) = curves {
            tiles.bar(&curves.barred())?;
            first = curves.taken();
        }
        first.extend(&landmarks(tiles, parts.parameters.dl, &first)?);
        let maker = Tiled::new(parts, tiles, &watched, curves, first);
        let (made, judged) = maker.mesh(progress)?;
        let failures = match judged.certificate.verdict() {
            Verdict::Verified => Vec::new(),
            _ => failures(&made.triangulation, &made.waist, maker.rows()),
        };
        let mut report = Report {
            chart_distortion: watched.distortion(),
            ..parts.report_of_tiles(tiles, &watched, &made)
        };
        if let Some(found) = found {
            let analysis = found.analysis;
            report.mean_neighbors = analysis.mean_neighbors();
            report.candidates = analysis.candidates();
            report.curve_points = analysis.curve_points();
            report.unexplained = analysis.unexplained().len();
            report.models = ModelCounts::with_later(analysis.models(), &made.waist.models);
            report.plugins.estimator = (!parts.parameters.surface).then(|| found.estimator.into());
        }
        Ok(Outcome {
            failures,
            homology: judged.homology,
            certificate: judged.certificate,
            pieces: judged.pieces,
            // They are read from all points.
            creases: None,
            special_points: judged.special_points,
            report,
            mesh: judged.mesh,
        })
    }
}

impl Parts {
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
