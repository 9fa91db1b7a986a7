//! `crosscap paper`: the paper's table, measured.

use super::failure::Failure;
use super::findings::pretty;
use super::number::{betti, median};
use super::parameters::{DIMENSION_TOLERANCE, MethodName, curve_tolerance, fit_tolerance, threads};
use super::terminal::{Progress, complain, say};
use clap::Args;
use crosscap::Spaces;
use crosscap::pipeline::{Parameters, Pipeline};
use crosscap_algorithms::surfaces::{PaperExample, SampleSurface, catalogue};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{Error, Mesh, NeighborhoodOracle};
use serde::Serialize;
use serde_json::json;
use std::time::Instant;

const EXAMPLES: &str = "Every run draws a new sample, with the paper's parameters.
  ok      runs whose mesh is verified and has the true Betti numbers, over Q and over Z/2
  wrong   runs whose mesh is verified although its Betti numbers are wrong
  L       landmarks in the mesh, median; k: landmarks within eps of a landmark, mean
  s       seconds of one reconstruction, median, sampling excluded (paper: MATLAB, 2.26 GHz)
The figures of the paper are in brackets. Exit code 0 when every run is ok.

Examples:
  crosscap paper --seeds 3
  crosscap paper --only two-spheres --only henneberg --seeds 50
  crosscap paper --method paper --seeds 20 --json > literal.json";

/// The paper's table, measured: success, landmarks, Betti numbers, time
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Paper {
    /// Number of runs for each surface, with seeds from --first-seed on
    #[arg(long, value_name = "K", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    seeds: u32,

    /// The first seed
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..=u64::MAX / 2))]
    first_seed: u64,

    /// One surface only; may be repeated
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,

    /// Algorithm
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    method: MethodName,

    /// Number of threads, 0 for all processors
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Print JSON, with every run
    #[arg(long)]
    json: bool,
}

/// One reconstruction.
#[derive(Serialize)]
struct Run {
    seed: u64,
    points: usize,
    /// A mesh passed the certificate.
    verified: bool,
    /// It has the true Betti numbers.
    right: bool,
    landmarks: Option<usize>,
    mean_neighbors: Option<f64>,
    betti: Option<[usize; 3]>,
    betti_mod_2: Option<[usize; 3]>,
    seconds: f64,
    /// Why there is no verified mesh.
    reason: Option<String>,
}

/// All runs on one surface.
#[derive(Serialize)]
struct Row {
    surface: &'static str,
    runs: Vec<Run>,
    ok: usize,
    silent_wrong: usize,
    landmarks: f64,
    mean_neighbors: f64,
    betti: Option<[usize; 3]>,
    seconds: f64,
    truth: [usize; 3],
    paper_landmarks: usize,
    paper_mean_neighbors: usize,
    paper_betti: [usize; 3],
    paper_seconds: [f64; 2],
}

impl Paper {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        let surfaces = self.surfaces()?;
        let seeds = u64::from(self.seeds);
        let progress = Progress::of(surfaces.len() as u64 * seeds, "");
        let mut rows = Vec::new();
        if !self.json {
            say(header())?;
        }
        for (surface, paper) in &surfaces {
            progress.stage(surface.name());
            let mut runs = Vec::new();
            for seed in self.first_seed..self.first_seed + seeds {
                runs.push(self.one(surface, paper, seed)?);
                progress.step();
            }
            let row = Row::new(surface, paper, runs);
            if !self.json {
                progress.suspend(|| say(row.line()))?;
                for run in row.runs.iter().filter(|r| !(r.verified && r.right)) {
                    progress.suspend(|| complain(run.told(row.surface)));
                }
            }
            rows.push(row);
        }
        drop(progress);
        if self.json {
            let method = crosscap::pipeline::Method::from(self.method).to_string();
            let all = json!({
                "crosscap": env!("CARGO_PKG_VERSION"),
                "method": method,
                "first_seed": self.first_seed,
                "seeds": self.seeds,
                "surfaces": rows,
            });
            say(pretty(&all).trim_end())?;
        }
        let runs: usize = rows.iter().map(|r| r.runs.len()).sum();
        let ok: usize = rows.iter().map(|r| r.ok).sum();
        if ok == runs {
            return Ok(());
        }
        let wrong: usize = rows.iter().map(|r| r.silent_wrong).sum();
        Err(Failure::NotVerified(format!(
            "{ok} of {runs} runs are ok, {wrong} verified although wrong"
        )))
    }

    /// The paper's surfaces, or those that were asked for.
    fn surfaces(&self) -> Result<Vec<(SampleSurface, PaperExample)>, Failure> {
        let with_paper = |s: SampleSurface| s.paper().copied().map(|p| (s, p));
        if self.only.is_empty() {
            return Ok(catalogue().into_iter().filter_map(with_paper).collect());
        }
        let named = self.only.iter().map(|name| {
            SampleSurface::find(name)
                .ok()
                .and_then(with_paper)
                .ok_or_else(|| {
                    let names: Vec<&str> = catalogue()
                        .iter()
                        .filter(|s| s.paper().is_some())
                        .map(SampleSurface::name)
                        .collect();
                    Failure::usage(format!(
                        "--only {name}: the paper has no such surface, expected one of {}",
                        names.join(", ")
                    ))
                })
        });
        named.collect()
    }

    fn one(
        &self,
        surface: &SampleSurface,
        paper: &PaperExample,
        seed: u64,
    ) -> Result<Run, Failure> {
        let mut sampling = surface.default_sampling(seed);
        sampling.boundary = paper.boundary_given;
        let sample = surface.sample(&sampling)?;
        let parameters = paper_parameters(
            paper,
            seed,
            sample.boundary,
            self.method,
            threads(self.threads),
        );
        let start = Instant::now();
        let result = Pipeline::new(parameters)?.reconstruct(&sample.points);
        let seconds = start.elapsed().as_secs_f64();
        let mut run = Run {
            seed,
            points: sample.points.len(),
            verified: false,
            right: false,
            landmarks: None,
            mean_neighbors: None,
            betti: None,
            betti_mod_2: None,
            seconds,
            reason: None,
        };
        match result {
            Ok(outcome) => {
                let radius = paper.triangulation_epsilon.unwrap_or(paper.epsilon);
                let h = &outcome.homology;
                let truth = surface.truth();
                run.verified = outcome.is_verified();
                run.right = h.betti_rational == truth.betti && h.betti_mod2 == truth.betti_mod_2;
                run.landmarks = Some(outcome.mesh.complex.vertices);
                run.mean_neighbors = mean_neighbors(&outcome.mesh, radius).ok();
                run.betti = Some(h.betti_rational);
                run.betti_mod_2 = Some(h.betti_mod2);
                if !run.verified {
                    run.reason = super::outcome::reasons(&outcome).into_iter().next();
                }
            }
            Err(error) if error.is_input() => return Err(error.into()),
            Err(error) => run.reason = Some(error.to_string()),
        }
        Ok(run)
    }
}

impl Run {
    fn told(&self, surface: &str) -> String {
        match (&self.reason, self.betti) {
            (Some(reason), _) => format!("{surface}, seed {}: {reason}", self.seed),
            (None, Some(found)) => format!(
                "{surface}, seed {}: verified, and the Betti numbers are wrong: {}",
                self.seed,
                betti(found)
            ),
            _ => format!("{surface}, seed {}: no mesh", self.seed),
        }
    }
}

/// The parameters of one of the paper's examples; what it does not print gets the default.
pub fn paper_parameters(
    paper: &PaperExample,
    seed: u64,
    boundary: Vec<usize>,
    method: MethodName,
    threads: Option<usize>,
) -> Parameters {
    let eps = paper.epsilon;
    Parameters {
        eps,
        tri_eps: paper.triangulation_epsilon,
        dt: paper.dimension_tolerance.unwrap_or(DIMENSION_TOLERANCE),
        dp: paper.fit_tolerance.unwrap_or_else(|| fit_tolerance(eps)),
        ep: paper
            .curve_tolerance
            .unwrap_or_else(|| curve_tolerance(eps)),
        dl: paper.landmark_separation,
        seed,
        surface: paper.surface,
        boundary,
        method: method.into(),
        spaces: Spaces::default(),
        threads,
        ..Parameters::new(eps, paper.landmark_separation)
    }
}

/// Mean number of vertices within `radius` of a vertex, itself included: the paper's k.
fn mean_neighbors(mesh: &Mesh, radius: f64) -> Result<f64, Error> {
    let count = mesh.vertices.len();
    let oracle = EuclideanOracle::new(mesh.vertices.clone())?;
    let mut near = Vec::new();
    let mut total = 0;
    for vertex in 0..count {
        oracle.within(vertex, radius, &mut near);
        total += near.len();
    }
    Ok(total as f64 / count.max(1) as f64)
}

impl Row {
    fn new(surface: &SampleSurface, paper: &PaperExample, runs: Vec<Run>) -> Self {
        let ok = runs.iter().filter(|r| r.verified && r.right).count();
        let silent_wrong = runs.iter().filter(|r| r.verified && !r.right).count();
        // The figures are those of the verified meshes, or of all where there is none.
        let any = runs.iter().any(|r| r.verified);
        let good = || runs.iter().filter(|r| r.verified || !any);
        let landmarks = good().filter_map(|r| r.landmarks).map(|l| l as f64);
        let mut found: Vec<[usize; 3]> = good().filter_map(|r| r.betti).collect();
        found.sort_unstable();
        Self {
            surface: surface.name(),
            ok,
            silent_wrong,
            landmarks: median(landmarks.collect()),
            mean_neighbors: median(good().filter_map(|r| r.mean_neighbors).collect()),
            betti: commonest(&found),
            seconds: median(runs.iter().map(|r| r.seconds).collect()),
            truth: surface.truth().betti,
            paper_landmarks: paper.landmarks,
            paper_mean_neighbors: paper.mean_neighbors,
            paper_betti: paper.betti,
            paper_seconds: paper.seconds,
            runs,
        }
    }

    fn line(&self) -> String {
        let number = |x: f64, digits: usize| {
            if x.is_nan() {
                "-".into()
            } else {
                format!("{x:.digits$}")
            }
        };
        format!(
            "{:<18} {:>9} {:>5}   {:<13} {:<10} {:<21} {:.2} ({:.0})",
            self.surface,
            format!("{}/{}", self.ok, self.runs.len()),
            self.silent_wrong,
            format!("{} ({})", number(self.landmarks, 0), self.paper_landmarks),
            format!(
                "{} ({})",
                number(self.mean_neighbors, 0),
                self.paper_mean_neighbors
            ),
            format!(
                "{} ({})",
                self.betti.map_or("-".into(), betti),
                betti(self.paper_betti)
            ),
            self.seconds,
            self.paper_seconds.iter().sum::<f64>(),
        )
    }
}

fn header() -> String {
    format!(
        "{:<18} {:>9} {:>5}   {:<13} {:<10} {:<21} {}",
        "surface", "ok", "wrong", "L (paper)", "k (paper)", "Betti (paper)", "s (paper)"
    )
}

/// The value that is there most often, the least of several.
fn commonest(sorted: &[[usize; 3]]) -> Option<[usize; 3]> {
    let mut best: Option<&[[usize; 3]]> = None;
    for run in sorted.chunk_by(|a, b| a == b) {
        if best.is_none_or(|b| run.len() > b.len()) {
            best = Some(run);
        }
    }
    best.map(|run| run[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commonest_of_several() {
        let all = [[1, 0, 1], [1, 0, 3], [1, 0, 3]];
        assert_eq!(commonest(&all), Some([1, 0, 3]));
        assert_eq!(commonest(&[]), None);
    }

    #[test]
    fn the_paper_has_nine_surfaces() {
        let parsed = Paper {
            seeds: 1,
            first_seed: 0,
            only: vec![],
            method: MethodName::Cells,
            threads: 0,
            json: false,
        };
        assert_eq!(parsed.surfaces().unwrap().len(), 9);
    }
}
