//! The stages of a reconstruction, one after another.

use super::making::{Judged, Maker, Triangulated};
use super::mesh::{AllRows, failures};
use super::prepared::{Input, Prepared};
use super::progress::Progress;
use super::report::PluginNames;
use super::whole::Whole;
use super::{Outcome, Parameters, Parts, Pipeline, Report, Stage};
use crate::spaces::{Neighborhoods, custom, positions};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::Verdict;
use crosscap_algorithms::creases::{CreaseLimits, Creases, creases};
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::neighborhood::{
    FlatRadius, NearestCount, NeighborhoodPolicy, PolicyOracle, Surroundings,
};
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, ChartSpace, Ground, ModelCounts, StratifyOptions,
};
use crosscap_backends::parallel::Threads;
use crosscap_core::{DimensionEstimator, Error, LocalChart, Mesh, Row, Table};

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
        let prepared = parts.prepare(input, &threads)?;
        let warnings = prepared.engines.warnings();
        warnings.iter().for_each(&mut *warned);

        progress.enter(Stage::Neighborhoods);
        let watched = Watched::new(parts.chart.as_ref(), &parts.interrupt);
        let principal = PrincipalComponents::new(parts.parameters.dt)?;
        let ground = parts.ground(&prepared, &principal, &watched, &threads)?;
        let stratifier = parts.stratifier.as_ref();
        let analysis = stratifier.analyze(&ground)?;

        progress.enter(Stage::Landmarks);
        let producer = stratifier.cut(&ground, &analysis)?;
        let whole = Whole {
            parts,
            prepared: &prepared,
            producer: producer.as_ref(),
            chart: &watched,
            rows: AllRows {
                places: producer.places().unwrap_or(&prepared.rows.cloud),
                kept: &prepared.rows.kept,
            },
        };
        let (made, judged) = whole.mesh(&mut progress)?;
        // A star that stayed open in its own chart may be complete all the same; whether it is, the
        // certificate has seen edge by edge and link by link.
        let failures = match judged.certificate.verdict() {
            Verdict::Verified => Vec::new(),
            _ => failures(&made.triangulation, &made.waist, whole.rows()),
        };
        Ok(Outcome {
            failures,
            creases: parts.creases(&prepared, &judged, &threads)?,
            homology: judged.homology,
            certificate: judged.certificate,
            pieces: judged.pieces,
            special_points: judged.special_points,
            report: Report {
                plugins: parts.plugins(&ground),
                points: input.cloud.len(),
                chart_distortion: watched.distortion(),
                warnings,
                seconds: progress.finish(),
                ..parts.report(&prepared, &analysis, &made)
            },
            mesh: Mesh {
                vertices: positions(&judged.mesh.vertices, prepared.rows.cloud.dimension())?,
                ..judged.mesh
            },
        })
    }
}

impl Parts {
    /// The creases of a mesh that is verified, where there are coordinates to tell them by.
    fn creases(
        &self,
        prepared: &Prepared<'_>,
        judged: &Judged,
        threads: &Threads,
    ) -> Result<Option<Creases>, Error> {
        if prepared.given.is_some() || !judged.certificate.verdict().is_verified() {
            return Ok(None);
        }
        let cloud = &prepared.engines.cloud;
        creases(&judged.mesh, cloud, &CreaseLimits::MEASURED, threads).map(Some)
    }

    /// The space of the analysis.
    fn space<'g>(&'g self, prepared: &'g Prepared<'_>) -> Space<'g, f64> {
        let space = match (prepared.given, &self.analysis_metric) {
            (Some(given), _) => given,
            (None, Some(own)) => custom(own).with_places(&prepared.engines.cloud),
            (None, None) => prepared.engines.analysis(),
        };
        match &self.oracle {
            Some(oracle) => space.with_oracle(oracle.as_ref()),
            None => space,
        }
    }

    /// What measures the charts.
    fn charts<'g>(&'g self, prepared: &'g Prepared<'_>) -> ChartSpace<'g, f64> {
        if let Some(own) = &self.chart_metric {
            return ChartSpace::Metric(custom(own));
        }
        if let Some(given) = prepared.given {
            return ChartSpace::Metric(given);
        }
        // Charts follow the metric of the analysis unless another was named; straight lines are drawn between the places
        // that points on curves are moved to.
        let followed = self.parameters.spaces.tri_metric.is_none();
        match self.analysis_metric.as_ref().map(custom) {
            Some(own) if followed && !own.is_straight() => ChartSpace::Metric(own),
            _ => prepared.engines.charts(),
        }
    }

    /// What the stratifier works with.
    fn ground<'g>(
        &'g self,
        prepared: &'g Prepared<'_>,
        usual: &'g PrincipalComponents<f64>,
        chart: &'g dyn LocalChart,
        threads: &'g Threads,
    ) -> Result<Ground<'g, f64>, Error> {
        let p = &self.parameters;
        let (space, estimator) = (
            self.space(prepared),
            self.estimator.as_deref().unwrap_or(usual),
        );
        Ok(Ground {
            analysis: AnalysisOptions {
                eps: p.eps,
                radii: radii(p, &space, estimator, threads)?,
                surface: p.surface,
                boundary: prepared.boundary.clone(),
            },
            analyzer: Analyzer {
                space,
                estimator,
                models: self.models.all(),
                execute: threads,
                tuning: &self.tuning,
            },
            dp: p.dp,
            ep: p.ep,
            options: StratifyOptions {
                dl: p.dl,
                tri_eps: p.chart_radius(),
                seed: p.seed,
            },
            charts: self.charts(prepared),
            selector: self.selector.as_ref(),
            chart,
        })
    }

    /// What works on these points, by its own name.
    fn plugins(&self, ground: &Ground<'_, f64>) -> PluginNames {
        let space = &ground.analyzer.space;
        PluginNames {
            metric: space.metric().name().into(),
            oracle: space.oracle().name().into(),
            chart_metric: match &ground.charts {
                ChartSpace::Places => "places".into(),
                ChartSpace::Metric(space) => space.metric().name().into(),
                ChartSpace::Along(space, _) => format!("{}, tangent planes", space.metric().name()),
            },
            estimator: (!self.parameters.surface).then(|| ground.analyzer.estimator.name().into()),
            ..self.makers(ground.chart)
        }
    }

    /// What works on waists and makes them, by its own name.
    pub(super) fn makers(&self, chart: &dyn LocalChart) -> PluginNames {
        let front = self.front(chart);
        let literal = self.triangulator.is_none();
        let part = |name: &str| literal.then(|| name.to_string());
        PluginNames {
            stratifier: self.stratifier.name().into(),
            selector: self.selector.name().into(),
            triangulator: self.triangulator(&front).name().into(),
            chart: part(front.chart.name()),
            compatibility: part(front.test.name()),
            rule: part(front.rule.name()),
            ..PluginNames::default()
        }
    }

    /// What the stages counted.
    fn report(&self, prepared: &Prepared<'_>, analysis: &Analysis, made: &Triangulated) -> Report {
        Report {
            version: env!("CARGO_PKG_VERSION"),
            points: prepared.rows.cloud.len(),
            dimension: prepared.rows.cloud.dimension(),
            duplicates: prepared.rows.duplicates,
            plugins: PluginNames::default(),
            mean_neighbors: analysis.mean_neighbors(),
            candidates: analysis.candidates(),
            curve_points: analysis.curve_points(),
            unexplained: analysis.unexplained().len(),
            models: ModelCounts::with_later(analysis.models(), &made.waist.models),
            landmarks: made.waist.counts,
            added_landmarks: made.added.len(),
            triangulation: made.triangulation.counts,
            chart_distortion: Distortion::default(),
            graph: prepared.engines.graph().cloned(),
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
) -> Result<Option<Table<Row, f64>>, Error> {
    let around = Surroundings {
        oracle: space.oracle(),
        metric: space.metric(),
        cloud: space.places(),
        execute: threads,
    };
    let of = |policy: &dyn NeighborhoodPolicy<f64>| {
        let radii = PolicyOracle::new(policy, &around)?.into_radii();
        Ok(Some(radii.into()))
    };
    match parameters.spaces.neighborhoods {
        // Nothing is looked for in neighborhoods.
        _ if parameters.surface => Ok(None),
        Neighborhoods::Radius => Ok(None),
        Neighborhoods::Nearest(count) => of(&NearestCount::new(count)?),
        Neighborhoods::Adaptive(count) => of(&FlatRadius::new(parameters.eps, count, estimator)?),
    }
}
