//! `crosscap compare`: which metric, and up to which radius.

use super::compare_plot::svg;
use super::compare_table::Table;
use super::failure::Failure;
use super::number::{counted, positive, share};
use super::output;
use super::parameters::{DIMENSION_TOLERANCE, MethodName, threads};
use super::points::PointArguments;
use super::spaces::GraphArguments;
use super::terminal::{Progress, say};
use clap::Args;
use crosscap::auto::Input;
use crosscap::comparison::{ComparedRun, Comparison, Contender, compare};
use crosscap::{MetricName, Parameters};
use crosscap_backends::files::{read_indices, write_bytes_whole};
use crosscap_backends::geodesic::EdgeRule;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Every metric is used for the analysis and for the charts, at every radius; the radius is that of the neighborhoods and
of the charts alike, as in the paper (`reconstruct` keeps charts at 3 dl, where a radius that is too large does no harm).
With --analysis-eps only the charts vary.

A page has the plot with its table below; .svg is the plot alone; .csv and .json are the table, the same for any number
of threads: seconds are in them only with --times. Instead of points a .json that was written before may be given, to
draw it again without running anything.

Examples:
  crosscap compare klein.npy --dl 0.25 --surface --eps 0.6:2.2:9 -o klein.html
  crosscap compare klein.npy --dl 0.25 --surface --eps 0.6:2.2:9 --metrics euclidean,geodesic --betti 1,1,0 -o klein.csv
  crosscap compare klein.npy --dl 0.25 --surface --eps 0.6:2.2:9 --times -o klein.json -o klein.html
  crosscap compare klein.json -o klein.svg
  crosscap compare points.npy --dl 0.15 --eps 0.3:0.9:7 --analysis-eps 0.2 --dt 0.075 -o charts.html";

/// The formats of a comparison.
const OUTPUTS: &str = ".html, .svg, .csv, .json";
/// Radii that are tried where nothing is said, as multiples of dl.
const USUAL: [f64; 2] = [2.0, 9.0];
const USUAL_STEPS: usize = 8;

/// Compare metrics: at which radius does each reconstruct, and how much do its charts lose
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES, allow_negative_numbers = true)]
pub struct Compare {
    /// Points, one a row: .npy, .npz, .csv, .tsv, .txt, .xyz, .pts, .pdb, .xtc, .dcd, .ply, .pcd, .las, .laz, .off,
    /// .obj, .stl, .vtk, .vtu, .vtp, .mat; .gz of any; or a .json of this command
    #[arg(value_name = "POINTS")]
    points: PathBuf,

    /// What to write: .html (a page), .svg (the plot), .csv or .json (the table); may be repeated
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,

    /// The metrics, separated by commas: euclidean, geodesic, lifted
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "euclidean,geodesic,lifted"
    )]
    metrics: Vec<MetricName>,

    /// Radii from LO to HI in so many steps, unit of the data [default: 2 dl to 9 dl in 8 steps]
    #[arg(long, value_name = "LO:HI:STEPS", value_parser = radii)]
    eps: Option<Radii>,

    /// Radius of the neighborhoods, where only the charts are to vary, unit of the data
    #[arg(long, value_name = "E", value_parser = positive)]
    analysis_eps: Option<f64>,

    /// Separation of the landmarks, unit of the data [default: chosen from the density of the points]
    #[arg(long, visible_alias = "landmark-separation", value_name = "L", value_parser = positive)]
    dl: Option<f64>,

    /// Tolerance of the local dimension, 0 to 1
    #[arg(long, visible_alias = "dimension-tolerance", value_name = "T", value_parser = share, default_value_t = DIMENSION_TOLERANCE)]
    dt: f64,

    /// Tolerance of the fit of two sheets, unit of the data [default: eps / 5]
    #[arg(long, visible_alias = "fit-tolerance", value_name = "T", value_parser = positive)]
    dp: Option<f64>,

    /// Tolerance of the double curve, unit of the data [default: eps / 10]
    #[arg(long, visible_alias = "curve-tolerance", value_name = "T", value_parser = positive)]
    ep: Option<f64>,

    /// Betti numbers over Q that the surface has, as in 1,1,0: a mesh with others does not count as working
    #[arg(long, value_name = "B0,B1,B2", value_parser = three)]
    betti: Option<[usize; 3]>,

    /// Seed of the random choice of landmarks
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    /// Take every point as 2-dimensional: no double curve is looked for
    #[arg(long)]
    surface: bool,

    /// Rows of the points on the boundary, counted from 0: .npy or .txt
    #[arg(long, value_name = "INDICES")]
    boundary: Option<PathBuf>,

    /// Algorithm
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    method: MethodName,

    #[command(flatten)]
    graph: GraphArguments,

    #[command(flatten)]
    choice: PointArguments,

    /// Write the seconds of every run into .csv and .json too (one thread a run)
    #[arg(long)]
    times: bool,

    /// Number of threads, 0 for all processors: one run a thread
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,
}

/// Radii, smallest first.
#[derive(Clone, Debug, PartialEq)]
struct Radii(Vec<f64>);

impl Compare {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        let mut inputs = vec![self.points.as_path()];
        inputs.extend(self.boundary.as_deref());
        let outputs: Vec<&Path> = self.output.iter().map(PathBuf::as_path).collect();
        for path in &outputs {
            output::check(path, OUTPUTS)?;
        }
        output::distinct(&inputs, &outputs)?;
        let table = if output::extension(&self.points) == "json" {
            self.earlier()?
        } else {
            self.made()?
        };
        let lanes = table.lanes();
        for path in &outputs {
            let text = match output::extension(path).as_str() {
                "html" => table.page(&lanes),
                "svg" => svg(&lanes, true) + "\n",
                "csv" => table.csv(self.times),
                _ => table.json(self.times),
            };
            write_bytes_whole(path, text.as_bytes())?;
        }
        let mut lines: Vec<String> = (lanes.iter())
            .map(|lane| format!("{} works {}", lane.name, lane.told()))
            .collect();
        let runs = counted(table.runs.len(), "run");
        lines.extend(
            outputs
                .iter()
                .map(|path| format!("{}: {runs}", path.display())),
        );
        say(lines.join("\n"))
    }

    /// The table of a file.
    fn earlier(&self) -> Result<Table, Failure> {
        let path = &self.points;
        let wrong = |what: String| Failure::usage(format!("{}: {what}", path.display()));
        let text = std::fs::read_to_string(path).map_err(|e| wrong(format!("cannot read: {e}")))?;
        let table: Table = serde_json::from_str(&text).map_err(|e| {
            wrong(format!(
                "{e}; expected what `crosscap compare` writes as .json"
            ))
        })?;
        // One run for each metric and radius, in this order.
        let radii = &table.comparison.radii;
        let lanes = table.runs.chunks(radii.len().max(1));
        let whole = |lane: &[ComparedRun]| {
            let metric = &lane[0].metric;
            (lane.iter().map(|run| (&run.metric, run.eps)))
                .eq(radii.iter().map(|&eps| (metric, eps)))
        };
        if lanes.len() > 0 && lanes.clone().all(whole) {
            return Ok(table);
        }
        Err(wrong(format!(
            "found {}, expected one for each metric and radius",
            counted(table.runs.len(), "run")
        )))
    }

    /// The table of the runs.
    fn made(&self) -> Result<Table, Failure> {
        let cloud = self.choice.read(&self.points)?;
        let points = cloud.to_f64();
        let dl = match self.dl {
            Some(dl) => dl,
            None => {
                Parameters::auto()
                    .choose(Input::Points(&points))?
                    .parameters
                    .dl
            }
        };
        let comparison = self.comparison(dl);
        let base = self.base(comparison.radii[0], dl)?;
        let contenders = self.contenders();
        let count = contenders.len() * comparison.radii.len();
        let progress = Progress::of(count as u64, "runs");
        let done = || progress.step();
        let runs = compare(&points, &base, &contenders, &comparison, &done)?;
        drop(progress);
        let mut table = Table {
            crosscap: env!("CARGO_PKG_VERSION").into(),
            title: super::picture::title(&self.points),
            points: cloud.len(),
            dimension: cloud.dimension(),
            comparison,
            dl,
            dt: base.dt,
            seed: base.seed,
            surface: base.surface,
            method: base.method.to_string(),
            graph: match base.spaces.graph {
                EdgeRule::Within(radius) => format!("points nearer than {radius}"),
                EdgeRule::Nearest(count) => format!("the {count} nearest points"),
            },
            lift: (self.graph.lift).map_or("2 eps".into(), |w| w.to_string()),
            works: BTreeMap::new(),
            runs,
        };
        let works = table.lanes().into_iter();
        table.works = works
            .map(|lane| (lane.name.clone(), lane.intervals()))
            .collect();
        Ok(table)
    }

    /// The metrics, each once.
    fn contenders(&self) -> Vec<Contender<'static>> {
        let mut metrics: Vec<MetricName> = Vec::new();
        for &metric in &self.metrics {
            if !metrics.contains(&metric) {
                metrics.push(metric);
            }
        }
        metrics.into_iter().map(Contender::named).collect()
    }

    /// What is varied, and what is known.
    fn comparison(&self, dl: f64) -> Comparison {
        let radii = match &self.eps {
            Some(radii) => radii.0.clone(),
            None => steps(USUAL[0] * dl, USUAL[1] * dl, USUAL_STEPS),
        };
        Comparison {
            radii,
            analysis_eps: self.analysis_eps,
            dp: self.dp,
            ep: self.ep,
            betti: self.betti,
        }
    }

    /// What all runs have in common.
    fn base(&self, eps: f64, dl: f64) -> Result<Parameters, Failure> {
        let boundary = match &self.boundary {
            Some(path) => read_indices(path)?,
            None => Vec::new(),
        };
        let base = Parameters {
            dt: self.dt,
            seed: self.seed,
            surface: self.surface,
            boundary,
            method: self.method.into(),
            spaces: self.graph.spaces(),
            threads: threads(self.threads),
            ..Parameters::new(eps, dl)
        };
        base.spaces.check()?;
        Ok(base)
    }
}

/// Radii from the first to the second in so many steps.
fn steps(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = |k: usize| low + (high - low) * k as f64 / (count.max(2) - 1) as f64;
    // Twelve digits: 0.6 + 0.2 is 0.8.
    let rounded = |x: f64| format!("{x:.12}").parse().unwrap_or(x);
    (0..count).map(|k| rounded(step(k))).collect()
}

fn radii(text: &str) -> Result<Radii, String> {
    let wrong = || {
        "expected LO:HI:STEPS, two lengths and a number of steps from 2 to 200, such as 0.6:2.2:9, or one length"
            .to_string()
    };
    let parts: Vec<&str> = text.split(':').collect();
    match parts[..] {
        [one] => Ok(Radii(vec![positive(one)?])),
        [low, high, count] => {
            let (low, high) = (positive(low)?, positive(high)?);
            let count = count.parse().ok().filter(|c| (2..=200).contains(c));
            let count = count.ok_or_else(wrong)?;
            if low < high {
                Ok(Radii(steps(low, high, count)))
            } else {
                Err(format!("{low} is not below {high}"))
            }
        }
        _ => Err(wrong()),
    }
}

fn three(text: &str) -> Result<[usize; 3], String> {
    let wrong = || "expected three numbers, such as 1,1,0".to_string();
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|t| t.trim().parse()).collect();
    let numbers = numbers.map_err(|_| wrong())?;
    numbers.try_into().map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_are_round_and_in_order() {
        let nine = radii("0.6:2.2:9").unwrap().0;
        assert_eq!(nine, [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2]);
        assert_eq!(radii("0.5").unwrap().0, [0.5]);
        for wrong in ["", "1:2", "2:1:3", "1:2:1", "0:1:3", "a:2:3", "1:2:3:4"] {
            assert!(radii(wrong).is_err(), "{wrong}");
        }
        assert_eq!(three("1,1,0"), Ok([1, 1, 0]));
        assert!(three("1,1").is_err() && three("1,x,0").is_err());
    }
}
