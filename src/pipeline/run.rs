//! The stages of a reconstruction, one after another.

use super::making::{Making, Triangulated};
use super::mesh::failures;
use super::progress::Progress;
use super::rows::Rows;
use super::{Method, Outcome, Parameters, Parts, Pipeline, Report, Stage};
use crate::spaces::{Engines, MetricName, Neighborhoods, custom, positions};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::Verdict;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::moments::{LocalDimension, MomentTree};
use crosscap_algorithms::neighborhood::{
    FlatRadius, NearestCount, NeighborhoodPolicy, PolicyOracle, Surroundings,
};
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, ChartSpace, Cut, Dimensions, Published, StratifyOptions,
    WaistProducer,
};
use crosscap_backends::parallel::Threads;
use crosscap_core::{DimensionEstimator, Error, Mesh, MetricSpace, PointCloud};

/// What a reconstruction is made of.
pub(crate) struct Input<'i> {
    /// The points. Of distances that were given a picture, which vertices are drawn in and nothing else.
    pub(crate) cloud: &'i PointCloud<f64>,
    /// Distances that were given.
    pub(crate) given: Option<Space<'i, f64>>,
}

/// A cloud ready for the stages, with what serves its metrics.
pub(super) struct Ground<'g> {
    pub(super) rows: Rows,
    boundary: Vec<usize>,
    pub(super) engines: Engines,
    pub(super) given: Option<Space<'g, f64>>,
}

impl Pipeline {
    pub(crate) fn run(&mut self, input: &Input<'_>) -> Result<Outcome, Error> {
        let outcome = self.guarded(|pipeline| pipeline.stages(input));
        // An answer that is no distance comes before all that followed from it.
        let own = [&self.parts.analysis_metric, &self.parts.chart_metric];
        for custom in own.into_iter().flatten() {
            custom.metric().sound()?;
        }
        outcome
    }

    fn stages(&mut self, input: &Input<'_>) -> Result<Outcome, Error> {
        let Self {
            parts,
            observer,
            warned,
        } = self;
        let mut progress = Progress::new(observer, &parts.interrupt);
        progress.enter(Stage::Index);
        let threads = parts.threads()?;
        let ground = parts.ground(input, &threads)?;
        let warnings = ground.engines.warnings();
        warnings.iter().for_each(&mut *warned);

        progress.enter(Stage::Neighborhoods);
        let space = parts.space(&ground);
        let known = parts.known_dimensions(&ground, &threads)?;
        let principal = PrincipalComponents::new(parts.parameters.dt)?;
        let estimator = parts.estimator.as_deref().unwrap_or(&principal);
        let dimensions = Dimensions::by(estimator);
        let analyzer = Analyzer {
            space,
            dimensions: match &known {
                Some(known) => dimensions.with_known(known),
                None => dimensions,
            },
            models: &parts.models,
            execute: &threads,
            tuning: &parts.tuning,
        };
        let published = parts.published(&ground);
        let analysis = match &published {
            Some(method) => method.analyze(&analyzer)?,
            None => analyzer.analyze(&parts.analysis_options(&ground, &analyzer, &threads)?)?,
        };

        progress.enter(Stage::Landmarks);
        let watched = Watched::new(parts.chart.as_ref(), &parts.interrupt);
        let producer = parts.producer(&ground, &analyzer, &analysis, published.as_ref())?;
        let making = Making {
            parts,
            ground: &ground,
            producer: producer.as_ref(),
            chart: &watched,
            places: producer.strata().places().unwrap_or(input.cloud),
        };
        let (made, judged) = making.mesh(&mut progress)?;
        // A star that stayed open in its own chart may be complete all the same; whether it is, the
        // certificate has seen edge by edge and link by link.
        let verified = matches!(judged.certificate.verdict(), Verdict::Verified);
        let failures = if published.is_none() && verified {
            Vec::new()
        } else {
            failures(&made.triangulation, &made.waist, &ground.rows.kept)
        };
        let estimator = (!parts.parameters.surface).then(|| estimator.name().to_string());
        Ok(Outcome {
            failures,
            homology: judged.homology,
            certificate: judged.certificate,
            pieces: judged.pieces,
            report: Report {
                estimator,
                points: input.cloud.len(),
                chart_distortion: watched.distortion(),
                warnings,
                seconds: progress.finish(),
                ..parts.report(&ground, &analysis, &made)
            },
            mesh: Mesh {
                vertices: positions(&judged.mesh.vertices, ground.rows.cloud.dimension())?,
                ..judged.mesh
            },
        })
    }
}

impl Parts {
    /// Looks the input over, and builds what serves its metrics.
    fn ground<'g>(&self, input: &Input<'g>, threads: &Threads) -> Result<Ground<'g>, Error> {
        let customs = [&self.analysis_metric, &self.chart_metric];
        for custom in customs.into_iter().flatten() {
            let count = custom.metric().len();
            if count != input.cloud.len() {
                return Err(Error::Shape {
                    found: format!("a metric on {count} points"),
                    expected: format!("{}, as many as there are", input.cloud.len()),
                });
            }
        }
        // A metric knows the rows as they are, copies included; so does an oracle.
        let copies = input.given.is_some()
            || self.oracle.is_some()
            || customs.iter().any(|custom| custom.is_some());
        let rows = Rows::of(input.cloud, copies)?;
        let Parameters {
            boundary,
            spaces,
            eps,
            ..
        } = &self.parameters;
        Ok(Ground {
            boundary: rows.positions(input.cloud, boundary)?,
            engines: Engines::new(spaces, *eps, &rows.cloud, threads)?,
            rows,
            given: input.given,
        })
    }

    /// The space of the analysis.
    fn space<'g>(&'g self, ground: &'g Ground<'_>) -> Space<'g, f64> {
        let space = match (ground.given, &self.analysis_metric) {
            (Some(given), _) => given,
            (None, Some(own)) => custom(own).with_places(&ground.engines.cloud),
            (None, None) => ground.engines.analysis(),
        };
        match &self.oracle {
            Some(oracle) => space.with_oracle(oracle.as_ref()),
            None => space,
        }
    }

    /// What measures the charts.
    fn charts<'g>(&'g self, ground: &'g Ground<'_>) -> ChartSpace<'g, f64> {
        match (&self.chart_metric, ground.given) {
            (Some(own), _) => ChartSpace::Metric(custom(own)),
            (None, Some(given)) => ChartSpace::Metric(given),
            (None, None) => ground.engines.charts(),
        }
    }

    /// The dimensions of all balls at once, where they are those of principal components: balls of one
    /// radius in straight lines are what the moments of a search tree are of.
    fn known_dimensions(
        &self,
        ground: &Ground<'_>,
        threads: &Threads,
    ) -> Result<Option<Vec<LocalDimension>>, Error> {
        let Parameters {
            surface,
            spaces,
            eps,
            dt,
            ..
        } = &self.parameters;
        let usual = self.estimator.is_none()
            && self.analysis_metric.is_none()
            && !matches!(spaces.metric, MetricName::Geodesic | MetricName::Conformal)
            && spaces.neighborhoods == Neighborhoods::Radius;
        if *surface || !usual {
            return Ok(None);
        }
        let tree = MomentTree::with(&ground.engines.cloud, threads)?;
        tree.settled_dimensions(*eps, *dt, threads).map(Some)
    }

    /// The published method, where it was chosen.
    fn published(&self, ground: &Ground<'_>) -> Option<Published> {
        let p = &self.parameters;
        (p.method == Method::Paper).then(|| Published {
            eps: p.eps,
            tri_eps: p.chart_radius(),
            dp: p.dp,
            ep: p.ep,
            dl: p.dl,
            seed: p.seed,
            surface: p.surface,
            boundary: ground.boundary.clone(),
        })
    }

    fn analysis_options(
        &self,
        ground: &Ground<'_>,
        analyzer: &Analyzer<'_, f64>,
        threads: &Threads,
    ) -> Result<AnalysisOptions, Error> {
        let estimator = analyzer.dimensions.estimator();
        Ok(AnalysisOptions {
            eps: self.parameters.eps,
            radii: radii(&self.parameters, &analyzer.space, estimator, threads)?,
            surface: self.parameters.surface,
            boundary: ground.boundary.clone(),
        })
    }

    /// What makes waists of the cloud.
    fn producer<'p>(
        &'p self,
        ground: &'p Ground<'_>,
        analyzer: &'p Analyzer<'p, f64>,
        analysis: &'p Analysis,
        published: Option<&'p Published>,
    ) -> Result<Box<dyn WaistProducer<f64> + 'p>, Error> {
        let charts = self.charts(ground);
        let selector = self.selector.as_ref();
        if let Some(method) = published {
            let chart = self.chart.as_ref();
            return Ok(Box::new(
                method.cut(analyzer, analysis, charts, selector, chart)?,
            ));
        }
        let options = StratifyOptions {
            dl: self.parameters.dl,
            tri_eps: self.parameters.chart_radius(),
            seed: self.parameters.seed,
        };
        Ok(Box::new(Cut::new(
            analyzer, analysis, charts, selector, &options,
        )?))
    }

    /// What the stages counted.
    fn report(&self, ground: &Ground<'_>, analysis: &Analysis, made: &Triangulated) -> Report {
        Report {
            version: env!("CARGO_PKG_VERSION"),
            points: ground.rows.cloud.len(),
            dimension: ground.rows.cloud.dimension(),
            duplicates: ground.rows.duplicates,
            estimator: None,
            mean_neighbors: analysis.mean_neighbors(),
            candidates: analysis.candidates(),
            curve_points: analysis.curve_points(),
            unexplained: analysis.unexplained().len(),
            models: analysis.models().to_vec(),
            landmarks: made.waist.counts,
            added_landmarks: made.added.len(),
            triangulation: made.triangulation.counts,
            chart_distortion: Distortion::default(),
            graph: ground.engines.graph().cloned(),
            given: None,
            warnings: Vec::new(),
            tuning: self.tuning.clone(),
            seconds: Vec::new(),
            parameters: self.parameters.clone(),
        }
    }
}

/// The radii of the neighborhoods, where they are not eps everywhere.
fn radii(
    parameters: &Parameters,
    space: &Space<'_, f64>,
    estimator: &dyn DimensionEstimator<Scalar = f64>,
    threads: &Threads,
) -> Result<Option<Vec<f64>>, Error> {
    let around = Surroundings {
        oracle: space.oracle(),
        metric: space.metric(),
        cloud: space.places(),
        execute: threads,
    };
    let of = |policy: &dyn NeighborhoodPolicy<f64>| {
        Ok(Some(PolicyOracle::new(policy, &around)?.into_radii()))
    };
    match parameters.spaces.neighborhoods {
        // Nothing is looked for in neighborhoods.
        _ if parameters.surface => Ok(None),
        Neighborhoods::Radius => Ok(None),
        Neighborhoods::Nearest(count) => of(&NearestCount::new(count)?),
        Neighborhoods::Adaptive(count) => of(&FlatRadius::new(parameters.eps, count, estimator)?),
    }
}
