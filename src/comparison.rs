//! Which metric, and up to which radius: the same points by several metrics at several radii.

use crate::pipeline::{Outcome, Parameters, Pipeline, PluginNames};
use crate::spaces::{MetricName, Spaces};
use crate::watched::Distortion;
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, MetricSpace, PointCloud};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// What a contender makes of the points and of the parameters of a run.
type Setup<'a> = Box<dyn Fn(&PointCloud<f64>, Parameters) -> Result<Pipeline, Error> + Sync + 'a>;

/// A metric that is compared: a named one, one of your own, or a whole pipeline.
pub struct Contender<'a> {
    name: String,
    setup: Setup<'a>,
}

impl<'a> Contender<'a> {
    /// A metric that this crate has, for the analysis and for the charts.
    pub fn named(metric: MetricName) -> Self {
        Self::pipeline(metric.to_string(), move |_, parameters| {
            Pipeline::new(Parameters {
                spaces: Spaces {
                    metric,
                    tri_metric: None,
                    ..parameters.spaces
                },
                ..parameters
            })
        })
    }

    /// A metric of your own, for the analysis and for the charts: `build` makes it over the rows of the cloud, twice a
    /// run.
    pub fn metric<M: MetricSpace<Scalar = f64> + 'static>(
        name: impl Into<String>,
        build: impl Fn(&PointCloud<f64>) -> Result<M, Error> + Sync + 'a,
    ) -> Self {
        Self::pipeline(name, move |cloud, parameters| {
            let own = || Ok::<_, Error>(Box::new(build(cloud)?));
            Ok(Pipeline::new(parameters)?
                .analysis_metric(own()?)
                .triangulation_metric(own()?))
        })
    }

    /// Any pipeline: `build` gets the cloud and the parameters of a run. Metrics, models and other parts can be
    /// compared in this way.
    pub fn pipeline(
        name: impl Into<String>,
        build: impl Fn(&PointCloud<f64>, Parameters) -> Result<Pipeline, Error> + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            setup: Box::new(build),
        }
    }

    /// Its name in the runs.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// At which radii contenders are compared, and with what.
///
/// The radius of a run is eps *and* the radius of the charts, as in the paper, where one radius
/// serves both: charts are not kept at 3 dl, as they are otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The radii, unit of the data.
    pub radii: Vec<f64>,
    /// Radius of the analysis, where it is not to be that of the charts.
    pub analysis_eps: Option<f64>,
    /// Fit tolerance dp; a fifth of eps when left out.
    pub dp: Option<f64>,
    /// Curve tolerance eps_p; a tenth of eps when left out.
    pub ep: Option<f64>,
    /// Betti numbers over Q that the surface is known to have.
    pub betti: Option<[usize; 3]>,
}

impl Comparison {
    /// At these radii, with the usual tolerances and nothing known of the surface.
    pub fn new(radii: impl Into<Vec<f64>>) -> Self {
        Self {
            radii: radii.into(),
            analysis_eps: None,
            dp: None,
            ep: None,
            betti: None,
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RunState {
    /// A verified mesh.
    Verified,
    /// A verified mesh with other Betti numbers than the known ones.
    OtherBetti,
    /// A mesh that is not verified.
    Refused,
    /// No mesh.
    Failed,
}

/// One contender at one radius.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ComparedRun {
    /// Name of the contender: the metric of analysis and charts.
    pub metric: String,
    /// Radius of analysis and charts, unit of the data.
    pub eps: f64,
    /// How it ended.
    pub state: RunState,
    /// Betti numbers over Q of the mesh.
    pub betti: Option<[usize; 3]>,
    /// Betti numbers over Z/2 of the mesh.
    pub betti_mod_2: Option<[usize; 3]>,
    /// Vertices of the mesh.
    pub vertices: Option<usize>,
    /// Triangles of the mesh.
    pub triangles: Option<usize>,
    /// What the charts lose.
    pub distortion: Option<Distortion>,
    /// Why there is no verified mesh, or what speaks against one that is verified.
    pub reason: Option<String>,
    /// What worked on the points, by the names that the plug-ins give themselves; none where there is no mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plugins: Option<PluginNames>,
    /// The singularity models that took part, by their own names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<String>,
    /// Seconds on one thread.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

impl ComparedRun {
    /// Whether it gave a verified mesh, and not with Betti numbers known to be wrong.
    pub fn works(&self) -> bool {
        self.state == RunState::Verified
    }
}

/// Runs every contender at every radius, each run on one thread, and calls `done` after each. The
/// result is in the order of contenders, then radii, and but for the seconds the same for any number of
/// threads.
///
/// # Errors
/// [`Error::Parameter`] where no contender or no radius is given; what goes wrong in a run is in its
/// [`ComparedRun::reason`].
///
/// ```
/// use crosscap::comparison::{Comparison, Contender, compare};
/// use crosscap::prelude::*;
/// /// The angle between two directions, the length of the arc on the unit sphere.
/// struct Angle(PointCloud<f64>);
/// impl MetricSpace for Angle {
///     type Scalar = f64;
///     fn len(&self) -> usize { self.0.len() }
///     fn distance(&self, a: usize, b: usize) -> f64 {
///         // From the chord: 0 for equal points, and no arc cosine of more than 1.
///         2.0 * (self.0.squared_distance(a, b).sqrt() / 2.0).min(1.0).asin()
///     }
///     fn name(&self) -> &str { "angle" }
/// }
/// let points = SampleSurface::find("sphere")?.sample(&Sampling::new(1500, 7))?.points;
/// let contenders = [
///     Contender::named(MetricName::Euclidean),
///     Contender::metric("angle", |cloud| Ok(Angle(cloud.clone()))),
/// ];
/// let base = Parameters::new(0.6, 0.3).surface();
/// let runs = compare(&points, &base, &contenders, &Comparison::new([0.8]), &|| ())?;
/// assert!(runs.iter().all(|run| run.works()));
/// assert_eq!(runs[1].metric, "angle");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(
    cloud: &PointCloud<f64>,
    base: &Parameters,
    contenders: &[Contender<'_>],
    comparison: &Comparison,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<ComparedRun>, Error> {
    let needs = |name, count| {
        (count > 0).then_some(()).ok_or_else(|| Error::Parameter {
            name,
            value: "none".into(),
            expected: "at least one".into(),
        })
    };
    needs("metrics", contenders.len())?;
    needs("eps", comparison.radii.len())?;
    let jobs: Vec<(&Contender<'_>, f64)> = (contenders.iter())
        .flat_map(|contender| comparison.radii.iter().map(move |&eps| (contender, eps)))
        .collect();
    // Plain threads: one of a pool would take up another run while its own waits for the pool inside.
    let count = Threads::new(base.threads.unwrap_or(0))?.count();
    let runs: Vec<OnceLock<ComparedRun>> = jobs.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..count.min(jobs.len()) {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(&(contender, eps)) = jobs.get(k) else {
                        break;
                    };
                    // Every job is taken once, so setting it cannot fail.
                    let _ = runs[k].set(one(cloud, base, comparison, contender, eps));
                    done();
                }
            });
        }
    });
    Ok(runs.into_iter().filter_map(OnceLock::into_inner).collect())
}

/// The parameters of a run at one radius.
fn at_radius(base: &Parameters, comparison: &Comparison, radius: f64) -> Parameters {
    let eps = comparison.analysis_eps.unwrap_or(radius);
    let usual = Parameters::new(eps, base.dl);
    Parameters {
        eps,
        tri_eps: Some(radius),
        dp: comparison.dp.unwrap_or(usual.dp),
        ep: comparison.ep.unwrap_or(usual.ep),
        spaces: Spaces {
            wide_charts: true,
            ..base.spaces.clone()
        },
        threads: Some(1),
        ..base.clone()
    }
}

/// One contender at one radius.
fn one(
    cloud: &PointCloud<f64>,
    base: &Parameters,
    comparison: &Comparison,
    contender: &Contender<'_>,
    radius: f64,
) -> ComparedRun {
    let since = Instant::now();
    let pipeline = (contender.setup)(cloud, at_radius(base, comparison, radius));
    let outcome = pipeline.and_then(|mut pipeline| pipeline.reconstruct(cloud));
    let mut run = ComparedRun {
        metric: contender.name.clone(),
        eps: radius,
        state: RunState::Failed,
        betti: None,
        betti_mod_2: None,
        vertices: None,
        triangles: None,
        distortion: None,
        reason: None,
        plugins: None,
        models: Vec::new(),
        seconds: Some(since.elapsed().as_secs_f64()),
    };
    match outcome {
        Ok(outcome) => {
            let betti = outcome.homology.betti_rational;
            (run.state, run.reason) = ended(&outcome, comparison.betti.filter(|&k| k != betti));
            run.betti = Some(betti);
            run.betti_mod_2 = Some(outcome.homology.betti_mod2);
            run.vertices = Some(outcome.mesh.complex.vertices);
            run.triangles = Some(outcome.mesh.complex.triangles.len());
            run.distortion = Some(outcome.report.chart_distortion);
            let models = outcome.report.models.into_iter();
            run.models = models.map(|model| model.name).collect();
            run.plugins = Some(outcome.report.plugins);
        }
        Err(error) => run.reason = Some(error.to_string()),
    }
    run
}

/// How a run that gave a mesh ended, and what there is to say of it; `other` are the Betti numbers that the surface
/// is known to have where the mesh has not these.
fn ended(outcome: &Outcome, other: Option<[usize; 3]>) -> (RunState, Option<String>) {
    if !outcome.is_verified() {
        let violations = outcome.certificate.violations().map(ToString::to_string);
        let failures = outcome.failures.iter().map(ToString::to_string);
        let mut reasons = failures.chain(violations);
        let mut reason = reasons.next();
        let more = reasons.count();
        if let (Some(reason), 1..) = (&mut reason, more) {
            reason.push_str(&format!(" (and {more} more)"));
        }
        return (RunState::Refused, reason);
    }
    if let Some(known) = other {
        let reason = format!("the surface is known to have {known:?}");
        return (RunState::OtherBetti, Some(reason));
    }
    let warnings = outcome.report.warnings.iter().map(ToString::to_string);
    (RunState::Verified, warnings.reduce(|a, b| a + "; " + &b))
}

/// The runs of neighboring radii that all work, as first and last radius, in order; `runs` are
/// those of one metric, by radius.
///
/// ```
/// use crosscap::comparison::intervals;
/// let works = [false, true, true, false, true];
/// assert_eq!(intervals(&[1.0, 2.0, 3.0, 4.0, 5.0], &works), [[2.0, 3.0], [5.0, 5.0]]);
/// ```
pub fn intervals(radii: &[f64], works: &[bool]) -> Vec<[f64; 2]> {
    let both: Vec<(f64, bool)> = radii.iter().copied().zip(works.iter().copied()).collect();
    let alike = both.chunk_by(|a, b| a.1 == b.1);
    let working = alike.filter(|chunk| chunk[0].1);
    working.map(|c| [c[0].0, c[c.len() - 1].0]).collect()
}
