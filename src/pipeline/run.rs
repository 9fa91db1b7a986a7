//! The stages of a reconstruction, one after another.

use super::mesh::{at_input_row, failures, mesh_of, special_points};
use super::progress::Progress;
use super::rows::Rows;
use super::{Method, Outcome, Parameters, Parts, Pipeline, Report, Stage};
use crate::spaces::{Engines, MetricName, Neighborhoods, custom, positions};
use crate::watched::{Distortion, Watched};
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, SpecialPoint, Verdict, certify, certify_by_distances,
};
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::homology::{Homology, homology};
use crosscap_algorithms::moments::{LocalDimension, MomentTree};
use crosscap_algorithms::neighborhood::{
    FlatRadius, NearestCount, NeighborhoodPolicy, PolicyOracle, Surroundings,
};
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::space::Space;
use crosscap_algorithms::stratify::{
    Analysis, AnalysisOptions, Analyzer, ChartSpace, Cut, Dimensions, Published, Refinement,
    Stratification, StratifyOptions, WaistProducer,
};
use crosscap_algorithms::triangulate::Triangulation;
use crosscap_backends::parallel::Threads;
use crosscap_core::{DimensionEstimator, Error, LocalChart, Mesh, MetricSpace, PointCloud};

/// What a reconstruction is made of.
pub(crate) struct Input<'i> {
    /// The points. Of distances that were given a picture, which vertices are drawn in and nothing else.
    pub(crate) cloud: &'i PointCloud<f64>,
    /// Distances that were given.
    pub(crate) given: Option<Space<'i, f64>>,
}

/// A cloud ready for the stages, with what serves its metrics.
struct Ground<'g> {
    rows: Rows,
    boundary: Vec<usize>,
    engines: Engines,
    given: Option<Space<'g, f64>>,
}

/// A waist and what was made of it.
struct Triangulated {
    waist: Stratification<f64>,
    triangulation: Triangulation,
    /// Landmarks that were added.
    added: usize,
}

/// A mesh and what is known of it.
struct Judged {
    special_points: Vec<SpecialPoint>,
    mesh: Mesh,
    homology: Homology,
    pieces: Result<Pieces, PiecesError>,
    certificate: Certificate,
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
        let made = parts.triangulate(&ground, producer.as_ref(), &watched, &mut progress)?;

        let places = producer.strata().places().unwrap_or(input.cloud);
        let judged = parts.judge(&ground, places, &made, &mut progress)?;
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
            special_points: judged.special_points,
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
            && spaces.metric != MetricName::Geodesic
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

    /// Triangulates a waist, and others with more landmarks where triangles stray from the points.
    fn triangulate(
        &self,
        ground: &Ground<'_>,
        producer: &dyn WaistProducer<f64>,
        chart: &dyn LocalChart,
        progress: &mut Progress<'_>,
    ) -> Result<Triangulated, Error> {
        let tuning = &self.tuning.refinement;
        let mut extra: Vec<usize> = Vec::new();
        let mut round = 0;
        loop {
            let waist = producer.waist(&extra)?;
            progress.enter(Stage::Triangulation);
            let triangulation = self
                .triangulator(chart)
                .triangulate(&waist.waist)
                .map_err(|error| at_input_row(error, &waist.rows, &ground.rows.kept))?;
            // What cannot be triangulated is not mended by more landmarks.
            let open = triangulation.incomplete.len() as f64;
            let sound = open <= tuning.open_share * waist.rows.len() as f64;
            let mut added = Vec::new();
            if sound && producer.takes_more() && round < tuning.rounds {
                let refinement = Refinement {
                    near: &ground.engines.euclidean,
                    strata: producer.strata(),
                    rows: &waist.rows,
                    dl: self.parameters.dl,
                    tuning,
                };
                added = refinement.rows_where_astray(&triangulation.complex);
            }
            if added.is_empty() {
                return Ok(Triangulated {
                    waist,
                    triangulation,
                    added: extra.len(),
                });
            }
            extra.extend(added);
            round += 1;
            progress.enter(Stage::Landmarks);
        }
    }

    /// The mesh of a triangulation, its homology and pieces, and the verdict.
    fn judge(
        &self,
        ground: &Ground<'_>,
        places: &PointCloud<f64>,
        made: &Triangulated,
        progress: &mut Progress<'_>,
    ) -> Result<Judged, Error> {
        progress.enter(Stage::Homology);
        let complex = &made.triangulation.complex;
        let mesh = mesh_of(complex, &made.waist, places, &ground.rows.kept)?;
        let homology = homology(&mesh.complex)?;
        let pieces = pieces(&mesh);
        progress.enter(Stage::Certificate);
        let special_points = special_points(&mesh, &made.waist, &ground.rows.kept);
        Ok(Judged {
            certificate: self.certify(ground, &mesh, &special_points, made),
            special_points,
            mesh,
            homology,
            pieces,
        })
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
            added_landmarks: made.added,
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

    fn certify(
        &self,
        ground: &Ground<'_>,
        mesh: &Mesh,
        special_points: &[SpecialPoint],
        made: &Triangulated,
    ) -> Certificate {
        let dropped: Vec<usize> = (made.triangulation.dropped.iter())
            .map(|&k| made.waist.rows[k as usize])
            .collect();
        let options = CertificateOptions {
            points: Some(&ground.engines.cloud),
            landmark_separation: Some(self.parameters.dl),
            unused_landmarks: &ground.rows.in_input(&dropped),
            special_points,
            closed: self.parameters.boundary.is_empty()
                && !self.models.iter().any(|m| m.finds_boundary()),
            faithful: self.parameters.spaces.metric != MetricName::Lifted,
            limits: self.limits.clone(),
            ..CertificateOptions::default()
        };
        match &ground.given {
            None => ground.rows.named(certify(mesh, &options)),
            Some(space) => certify_by_distances(mesh, space.metric(), space.oracle(), &options),
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
