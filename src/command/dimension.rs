//! `crosscap dimension`: how many dimensions the points have.

use super::estimators::EstimatorName;
use super::failure::Failure;
use super::findings::pretty;
use super::number::{counted, positive, share};
use super::output;
use super::parameters::{DIMENSION_TOLERANCE, threads};
use super::points::PointArguments;
use super::terminal::{Progress, complain, say};
use clap::{Args, ValueEnum};
use crosscap_algorithms::dimension::{GlobalDimension, Scale, WholeCloud};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::write_bytes_whole;
use crosscap_backends::parallel::Threads;
use crosscap_core::{DimensionEstimate, Error, PointCloud};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "One dimension a point is estimated from its neighborhood, and the table shows the most frequent one, the share of the \
points that have it, and the spread of the values before rounding; with --global one dimension for all points together.

confidence is 0 for a toss-up between two dimensions and 1 for a sure decision: for pca how far the deciding share of \
variance is from dt (1 from a factor of ten on), for the others the probability that the value's standard error does \
not carry it past the nearest half. It knows nothing of curvature, noise and edges.

Where surfaces cross, pca says 3; the others say 2 on the crossing and 2 to 3 beside it. With --global pca tells the flat that holds all points: 3 for a \
sphere.

Examples:
  crosscap dimension points.npy
  crosscap dimension points.npy --eps 0.25 --estimator mle --estimator pca -o local.csv
  crosscap dimension points.npy --global -k 20";

/// Neighbors where nothing is said: enough for most estimators in three dimensions.
const LOCAL_NEIGHBORS: u32 = 50;
/// The same over a whole cloud, where small distances are better: the default of scikit-dimension.
const GLOBAL_NEIGHBORS: u32 = 20;

/// Estimate the dimension of points
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Dimension {
    /// Points, one a row: .npy, .npz, .csv, .tsv, .txt, .xyz, .pts, .pdb, .xtc, .dcd, .ply, .pcd, .las, .laz, .off,
    /// .obj, .stl, .vtk, .vtu, .vtp, .mat; .gz of any
    #[arg(value_name = "POINTS")]
    points: PathBuf,

    /// Estimator, may be repeated [default: all]
    #[arg(long, value_name = "NAME", value_enum)]
    estimator: Vec<EstimatorName>,

    /// Radius of the neighborhoods (strict), unit of the data
    #[arg(long, visible_alias = "epsilon", value_name = "E", value_parser = positive, conflicts_with = "k")]
    eps: Option<f64>,

    /// Number of nearest neighbors [default: 50, or 20 with --global]
    #[arg(short, long = "neighbors", value_name = "K", value_parser = clap::value_parser!(u32).range(4..))]
    k: Option<u32>,

    /// One dimension for the whole cloud
    #[arg(long)]
    global: bool,

    /// Tolerance of pca: the share of variance left over, 0 to 1
    #[arg(
        long,
        visible_alias = "dimension-tolerance",
        value_name = "T",
        value_parser = share,
        default_value_t = DIMENSION_TOLERANCE
    )]
    dt: f64,

    /// Table to write, .csv: the values at every point, or of every estimator with --global
    #[arg(short, long, value_name = "TABLE")]
    output: Option<PathBuf>,

    /// Print JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    choice: PointArguments,

    /// Number of threads, 0 for all processors; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,
}

/// What one estimator said.
struct Answers<T> {
    name: &'static str,
    answers: Result<T, Error>,
}

impl Dimension {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(path) = &self.output {
            output::check(path, ".csv")?;
            output::distinct(&[&self.points], &[path])?;
        }
        self.estimate(&self.choice.read(&self.points)?.into_f64())
    }

    fn scale(&self) -> Scale {
        let usual = if self.global {
            GLOBAL_NEIGHBORS
        } else {
            LOCAL_NEIGHBORS
        };
        self.eps.map_or(
            Scale::Nearest(self.k.unwrap_or(usual) as usize),
            Scale::Within,
        )
    }

    fn estimate(&self, cloud: &PointCloud<f64>) -> Result<(), Failure> {
        let chosen = if self.estimator.is_empty() {
            EstimatorName::value_variants()
        } else {
            &self.estimator
        };
        let oracle = EuclideanOracle::new(cloud.clone())?;
        let threads = Threads::new(threads(self.threads).unwrap_or(0))?;
        let space = WholeCloud {
            metric: &oracle,
            oracle: &oracle,
            cloud: Some(cloud),
            scale: self.scale(),
            execute: &threads,
        };
        let progress = Progress::new("starting");
        let mut global = Vec::new();
        let mut local = Vec::new();
        for &kind in chosen {
            let name = kind.name();
            progress.stage(name);
            if self.global {
                let answers = kind.global(self.dt)?.global(&space);
                global.push(Answers { name, answers });
            } else {
                let estimator = kind.local(self.dt)?;
                let answers = space.local(estimator.as_ref());
                local.push(Answers { name, answers });
            }
        }
        drop(progress);
        let read = match self.scale() {
            Scale::Nearest(k) => format!("{k} nearest neighbors"),
            Scale::Within(r) => format!("points nearer than {r}"),
        };
        let head = format!(
            "{}: {} of R^{}, {}, {read}",
            self.points.display(),
            counted(cloud.len(), "point"),
            cloud.dimension(),
            if self.global {
                "one dimension for all"
            } else {
                "one dimension a point"
            },
        );
        if self.global {
            self.tell(&head, &global, global_row, GLOBAL_HEAD, global_json, || {
                global_csv(&global)
            })
        } else {
            self.tell(&head, &local, local_row, LOCAL_HEAD, local_json, || {
                local_csv(cloud.len(), &local)
            })
        }
    }

    /// Writes the file, prints the table, and why an estimator has no answer.
    fn tell<T>(
        &self,
        head: &str,
        all: &[Answers<T>],
        row: fn(&T) -> String,
        columns: &str,
        json: fn(&T) -> Value,
        csv: impl Fn() -> String,
    ) -> Result<(), Failure> {
        if let Some(path) = &self.output {
            write_bytes_whole(path, csv().as_bytes())?;
        }
        let mut text = String::new();
        if self.json {
            let rows: Vec<Value> = all
                .iter()
                .map(|a| {
                    let mut value = match &a.answers {
                        Ok(found) => json(found),
                        Err(error) => json!({ "error": error.to_string() }),
                    };
                    value["estimator"] = a.name.into();
                    value
                })
                .collect();
            text = pretty(&json!(rows)).trim_end().into();
        } else {
            let _ = write!(text, "{head}\n\n{:<14}{columns}", "estimator");
            for a in all {
                let cells = a.answers.as_ref().map_or("-".into(), row);
                let _ = write!(text, "\n{:<14}{cells}", a.name);
            }
        }
        say(text)?;
        let mut first = None;
        for a in all {
            if let Err(error) = &a.answers {
                complain(format!("{}: {error}", a.name));
                first.get_or_insert(error.clone());
            }
        }
        match first {
            Some(error) if all.iter().all(|a| a.answers.is_err()) => Err(error.into()),
            _ => Ok(()),
        }
    }
}

const GLOBAL_HEAD: &str =
    "dimension   value  std. error  confidence  from distances                points";

fn global_row(found: &GlobalDimension) -> String {
    let error = found
        .standard_error
        .map_or("-".into(), |e| format!("{e:.3}"));
    let distances = format!("{:.4e} .. {:.4e}", found.scales[0], found.scales[1]);
    format!(
        "{:>9}  {:>6.3}  {error:>10}  {:>10.3}  {distances:<26}  {:>6}",
        found.dimension, found.value, found.confidence, found.points
    )
}

fn global_json(found: &GlobalDimension) -> Value {
    // JSON has no infinity.
    let distances = found.scales.map(|s| s.is_finite().then_some(s));
    json!({
        "dimension": found.dimension,
        "value": found.value,
        "standard_error": found.standard_error,
        "confidence": found.confidence,
        "distances": distances,
        "points": found.points,
    })
}

fn global_csv(all: &[Answers<GlobalDimension>]) -> String {
    let mut text = String::from(
        "estimator,dimension,value,standard_error,confidence,smallest_distance,largest_distance,points\n",
    );
    for a in all {
        let _ = match &a.answers {
            Ok(g) => {
                let error = g.standard_error.map_or(String::new(), |e| e.to_string());
                let [near, far] = g.scales;
                let Answers { name, .. } = a;
                writeln!(
                    text,
                    "{name},{},{},{error},{},{near},{far},{}",
                    g.dimension, g.value, g.confidence, g.points
                )
            }
            Err(_) => writeln!(text, "{},,,,,,,", a.name),
        };
    }
    text
}

/// One answer a point; none where the neighborhood held too few.
type Local = Vec<Option<DimensionEstimate>>;

const LOCAL_HEAD: &str =
    "dimension    share  median  quartiles         confidence  no answer  dimension: points";

/// What the table says about the values of one estimator.
struct Spread {
    counts: Vec<(usize, usize)>,
    dimension: usize,
    answered: usize,
    share: f64,
    quartiles: [f64; 3],
    confidence: f64,
}

fn spread(found: &Local) -> Option<Spread> {
    let answers: Vec<&DimensionEstimate> = found.iter().flatten().collect();
    let mut dimensions: Vec<usize> = answers.iter().map(|e| e.dimension).collect();
    dimensions.sort_unstable();
    let counts: Vec<(usize, usize)> = dimensions
        .chunk_by(|a, b| a == b)
        .map(|run| (run[0], run.len()))
        .collect();
    let &(dimension, most) = counts.iter().rev().max_by_key(|c| c.1)?;
    let sorted = |of: fn(&DimensionEstimate) -> f64| {
        let mut values: Vec<f64> = answers.iter().map(|e| of(e)).collect();
        values.sort_unstable_by(f64::total_cmp);
        move |quarter: usize| values[(values.len() - 1) * quarter / 4]
    };
    let value = sorted(|e| e.value);
    let confidence = sorted(|e| e.confidence);
    Some(Spread {
        dimension,
        answered: answers.len(),
        share: most as f64 / answers.len() as f64,
        quartiles: [value(1), value(2), value(3)],
        confidence: confidence(2),
        counts,
    })
}

fn local_row(found: &Local) -> String {
    let Some(s) = spread(found) else {
        return "-".into();
    };
    let [low, median, high] = s.quartiles;
    let quartiles = format!("{low:.2} .. {high:.2}");
    let counts: Vec<String> = s.counts.iter().map(|(d, n)| format!("{d}: {n}")).collect();
    format!(
        "{:>9}  {:>5.1} %  {median:>6.2}  {quartiles:<16}  {:>10.2}  {:>9}  {}",
        s.dimension,
        100.0 * s.share,
        s.confidence,
        found.len() - s.answered,
        counts.join(", ")
    )
}

fn local_json(found: &Local) -> Value {
    spread(found).map_or(Value::Null, |s| {
        json!({
            "dimension": s.dimension,
            "share": s.share,
            "median": s.quartiles[1],
            "quartiles": [s.quartiles[0], s.quartiles[2]],
            "confidence": s.confidence,
            "answers": s.answered,
            "no_answer": found.len() - s.answered,
            "points_by_dimension": s.counts,
        })
    })
}

fn local_csv(points: usize, all: &[Answers<Local>]) -> String {
    let mut text = String::from("point");
    for a in all {
        let _ = write!(text, ",{0}_dimension,{0}_value,{0}_confidence", a.name);
    }
    text.push('\n');
    for i in 0..points {
        let _ = write!(text, "{i}");
        for a in all {
            let _ = match a.answers.as_ref().ok().and_then(|found| found[i].as_ref()) {
                Some(e) => write!(text, ",{},{},{}", e.dimension, e.value, e.confidence),
                None => write!(text, ",,,"),
            };
        }
        text.push('\n');
    }
    text
}
