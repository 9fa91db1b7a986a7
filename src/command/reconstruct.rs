//! `crosscap reconstruct`: points to mesh.

use super::bytes::bytes;
use super::failure::Failure;
use super::findings::pretty;
use super::input::Input;
use super::limited::Limited;
use super::number::{counted, positive};
use super::observed::observed;
use super::outcome::{duplicates, findings, report, told, verdict, write_reconstruction};
use super::parameters::{ATTEMPTS, Help, MAIN, MethodName, ParameterArguments};
use super::points::PointArguments;
use super::terminal::{complain, say};
use super::{choice, output, overlay, picture, refused, repeat};
use clap::Args;
use crosscap::auto::USUAL_TRIES;
use crosscap::pipeline::Outcome;
use crosscap::{Advice, Auto, Pinned, Refusal};
use crosscap_backends::files::{MESH_EXTENSIONS, read_distances, read_indices, write_bytes_whole};
use crosscap_core::Error;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "Lengths (eps, tri-eps, dp, ep, dl) are in the unit of the data.

Examples:
  crosscap reconstruct points.npy -o mesh.npz
  crosscap reconstruct points.npy -o mesh.npz --eps 0.25 --dl 0.1
  crosscap reconstruct sphere.csv -o sphere.ply --eps 0.4 --dl 0.1 --surface --picture sphere.html
  crosscap reconstruct strip.npy -o strip.npz --eps 0.4 --dl 0.1 --surface --boundary rim.npy
  crosscap reconstruct points.npy -o mesh.npz --eps 0.25 --dl 0.1 --method paper --keep-unverified

A mesh that is not verified is not written unless --keep-unverified is given; the exit code is 1 either way. Report and
picture are written all the same, and --cut-out leaves the points around the worst place.";

const SHORT: &str = "Examples:
  crosscap reconstruct points.npy -o mesh.npz
  crosscap reconstruct points.npy -o mesh.npz --eps 0.25 --dl 0.1 --picture mesh.html

--help-all shows every option: metrics, estimators, tolerances, attempts, columns, molecules.";

/// Fewest points: what one neighborhood needs.
const LEAST_POINTS: usize = 8;
/// Attempts with parameters of the program's choice before they are advised.
const TRIES_FOR_ADVICE: usize = 3;

/// Reconstruct a surface from points: triangulate, check, write
#[derive(Args, Debug)]
#[command(after_help = SHORT, after_long_help = EXAMPLES, disable_help_flag = true)]
pub struct Reconstruct {
    /// Points, one a row: .npy, .npz, .csv, .tsv, .txt, .xyz, .pts, .pdb, .xtc, .dcd, .ply, .pcd, .las, .laz, .off,
    /// .obj, .stl, .vtk, .vtu, .vtp, .mat; .gz of any
    #[arg(value_name = "POINTS", required_unless_present = "distances")]
    points: Option<PathBuf>,

    /// Distances instead of points: .npy (n x n) or .npz (sparse, as SciPy's save_npz writes it)
    ///
    /// Distances of points in a Euclidean space give these points back, up to a motion. Other distances are taken as
    /// they are: they need --surface, and what needs coordinates is not checked.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "DISTANCES",
        conflicts_with = "points"
    )]
    distances: Option<PathBuf>,

    /// Mesh to write: .npz and .vtu (keep everything), .ply, .obj, .off, .stl or .glb
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    #[command(flatten)]
    parameters: ParameterArguments,

    /// Rows of the points on the boundary, counted from 0: .npy or .txt
    #[arg(long, help_heading = MAIN, value_name = "INDICES")]
    boundary: Option<PathBuf>,

    #[command(flatten)]
    choice: PointArguments,

    /// Attempts at most, where parameters are left to the program
    ///
    /// A mesh that passes after others have failed counts only when another attempt, with other landmarks, agrees.
    #[arg(long, help_heading = ATTEMPTS, hide_short_help = true, value_name = "N", default_value_t = USUAL_TRIES as u16, value_parser = clap::value_parser!(u16).range(1..=1000))]
    tries: u16,

    /// Seconds after which no further attempt begins
    #[arg(long, help_heading = ATTEMPTS, hide_short_help = true, value_name = "SECONDS", value_parser = positive)]
    time_limit: Option<f64>,

    /// Bytes of memory, about: 2GiB, 800MiB. More points than that stay in their file (.npy) and are worked on in tiles
    ///
    /// What the run takes in memory is foretold and said. In tiles the mesh is the same, byte for byte; they need --eps, --dl and
    /// --surface, and a scratch file beside the mesh, about twice as large as the points.
    #[arg(long, help_heading = ATTEMPTS, hide_short_help = true, value_name = "BYTES", value_parser = bytes, conflicts_with = "distances")]
    memory_limit: Option<u64>,

    /// Report to write, JSON: version, parameters, counts and seconds of every stage, homology, certificate
    ///
    /// Written also when there is no verified mesh, with what went wrong, where, and what was tried.
    #[arg(long, help_heading = MAIN, value_name = "REPORT.json")]
    report: Option<PathBuf>,

    /// Picture to write: .html (a page to turn it in) or .png
    ///
    /// When the mesh is not verified it is drawn as it is, with the places of the faults marked (in R^3).
    #[arg(long, help_heading = MAIN, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// Where there is no verified mesh: the points around the worst place, as a small file for a bug report
    #[arg(long, help_heading = ATTEMPTS, hide_short_help = true, value_name = "FILE", conflicts_with = "distances")]
    cut_out: Option<PathBuf>,

    /// Write the mesh also when it is not verified
    #[arg(long, help_heading = MAIN)]
    keep_unverified: bool,

    #[command(flatten)]
    help: Help,
}

impl Reconstruct {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        // Refuse what can be refused before the work begins.
        self.parameters.pinned(Vec::new())?;
        self.check_outputs()?;
        let (input, searches) = self.read()?;
        if input.len() < LEAST_POINTS {
            return Err(Failure::usage(format!(
                "{}: found {}, expected at least {LEAST_POINTS}, what one neighborhood needs",
                self.input().display(),
                counted(input.len(), "point")
            )));
        }
        let pinned = self.parameters.pinned(self.boundary_rows(input.len())?)?;
        // Where lengths are not given the program may still choose a metric that asks.
        if pinned.complete().is_some() {
            let idle = self.parameters.spaces.without_effect();
            idle.iter().for_each(complain);
        }
        let whole = match input.whole() {
            Ok(whole) => whole,
            Err(limited) => return self.in_tiles(&input, limited, &pinned),
        };
        let estimator = self.parameters.estimator;
        let mut auto = Auto::new(pinned.clone()).tries(self.tries.into());
        if let Some(seconds) = self.time_limit {
            auto = auto.time_limit(Duration::from_secs_f64(seconds));
        }
        let search = auto.search(whole, &mut |parameters| observed(parameters, estimator))?;
        let lines = choice::chosen(&self.input().display().to_string(), &pinned, &search);
        if !lines.is_empty() {
            say(lines.join("\n"))?;
        }
        let told = json!({ "density": search.density, "preparation": search.preparation, "attempts": search.attempts, "doubt": search.doubt });
        match search.into_verified(input.places()) {
            Ok(outcome) => self.write(&input, &outcome, true, &told),
            Err(mut refusal) => {
                let options = match searches {
                    true => self.better(whole, &pinned, &refusal)?,
                    false => None,
                };
                let options = options.map(|(advice, options)| {
                    refusal.advice = advice;
                    options
                });
                self.refuse(&input, &refusal, options.as_deref(), &told)
            }
        }
    }

    /// The input, and whether there is memory for a search beside the run that was asked for.
    fn read(&self) -> Result<(Input, bool), Failure> {
        if let Some(path) = &self.distances {
            return Ok((Input::Distances(read_distances(path)?), true));
        }
        let mut searches = true;
        if let Some(limit) = self.memory_limit {
            let pinned = self.parameters.pinned(Vec::new())?;
            let limited = Limited::open(self.input(), &self.choice, &pinned, limit)?;
            searches = limited.leaves_room_for_a_search();
            if !limited.fits() {
                return Ok((Input::Tiles(Box::new(limited)), false));
            }
        }
        let cloud = self.choice.read(self.input())?;
        let name = cloud.scalar_name();
        Ok((Input::Points(cloud.into_f64(), name), searches))
    }

    /// The same reconstruction without the points in memory.
    fn in_tiles(&self, input: &Input, limited: &Limited, pinned: &Pinned) -> Result<(), Failure> {
        if self.cut_out.is_some() {
            return Err(Failure::usage(
                "--cut-out looks at all points together, which --memory-limit leaves in their file: leave one of them out",
            ));
        }
        let estimator = self.parameters.estimator;
        let scratch = output::folder_of(&self.output);
        let end = limited.reconstruct(pinned, scratch, |parameters| {
            observed(parameters, estimator)
        })?;
        let told = json!({ "memory": limited.told() });
        match end {
            Ok(outcome) => self.write(input, &outcome, true, &told),
            Err(refusal) => self.refuse(input, &refusal, None, &told),
        }
    }

    /// Tells why there is no verified mesh, and leaves what was asked for.
    fn refuse(
        &self,
        input: &Input,
        refusal: &Refusal,
        options: Option<&str>,
        told: &Value,
    ) -> Result<(), Failure> {
        refused::tell(refusal, options);
        let places = input.places();
        if let (Some(path), Some(points)) = (&self.cut_out, places) {
            refused::write_cut_out(path, refusal, points)?;
        }
        if self.keep_unverified
            && let Ok(outcome) = &refusal.outcome
        {
            self.write(input, outcome, false, told)?;
            return Err(Failure::NotVerified(format!(
                "{}: this mesh is not verified",
                self.output.display()
            )));
        }
        if let Some(path) = &self.report {
            let input = self.described(input);
            refused::write_report(path, refusal, options, input, told)?;
        }
        if let Some(path) = &self.picture {
            refused::write_picture(path, &picture::title(self.input()), refusal, places)?;
        }
        Err(Failure::NotVerified(format!(
            "{}: no verified mesh, none written (--keep-unverified writes it as it is)",
            self.input().display()
        )))
    }

    /// For a run with eps and dl given: parameters of the program's choice, where they give a verified mesh, and the options
    /// to give them by in place of those two.
    fn better(
        &self,
        whole: crosscap::auto::Input<'_>,
        pinned: &Pinned,
        refusal: &Refusal,
    ) -> Result<Option<(Advice, String)>, Failure> {
        let given = pinned.complete().is_some() && self.parameters.method == MethodName::Cells;
        if !given || !refused::may_be_helped(refusal) {
            return Ok(None);
        }
        let free = Pinned {
            eps: None,
            dl: None,
            ..pinned.clone()
        };
        let estimator = self.parameters.estimator;
        let search = Auto::new(free.clone())
            .tries(TRIES_FOR_ADVICE)
            .search(whole, &mut |parameters| observed(parameters, estimator));
        let search = match search {
            Ok(search) if search.is_verified() => search,
            Err(Error::Interrupted) => return Err(Error::Interrupted.into()),
            // What is pinned may leave nothing to choose; that is no fault of the refused run.
            Ok(_) | Err(_) => return Ok(None),
        };
        let attempt = search.attempts.get(search.chosen);
        let found = attempt.and_then(|a| Some((a.parameters.clone(), a.end.topology()?.clone())));
        let prepared = search.preparation.is_some();
        Ok(found.map(|(parameters, topology)| {
            let options = repeat::options(&free, &parameters, prepared);
            (Advice::Parameters(Box::new(parameters), topology), options)
        }))
    }

    /// The input, for reports.
    fn described(&self, input: &Input) -> Value {
        json!({
            "file": self.input().display().to_string(),
            "scalar": input.scalar_name(),
        })
    }

    /// The file with the points or their distances.
    fn input(&self) -> &Path {
        // One of the two is there: the definition of the arguments says so.
        let given = self.points.as_deref().or(self.distances.as_deref());
        given.unwrap_or(Path::new(""))
    }

    fn check_outputs(&self) -> Result<(), Failure> {
        output::check(&self.output, MESH_EXTENSIONS)?;
        let mut outputs = vec![self.output.as_path()];
        if let Some(report) = &self.report {
            output::check(report, ".json")?;
            outputs.push(report);
        }
        if let Some(picture) = &self.picture {
            output::check(picture, output::PICTURES)?;
            outputs.push(picture);
        }
        if let Some(cut_out) = &self.cut_out {
            output::check(cut_out, output::POINTS)?;
            outputs.push(cut_out);
        }
        let mut inputs = vec![self.input()];
        inputs.extend(self.boundary.as_deref());
        output::distinct(&inputs, &outputs)
    }

    fn boundary_rows(&self, points: usize) -> Result<Vec<usize>, Failure> {
        let Some(path) = &self.boundary else {
            return Ok(Vec::new());
        };
        let mut rows = read_indices(path)?;
        if let Some(at) = rows.iter().position(|&row| row >= points) {
            return Err(Failure::usage(format!(
                "{}: row {at} (from 0): found index {}, expected 0 to {}, as {} has {points} points",
                path.display(),
                rows[at],
                points - 1,
                self.input().display()
            )));
        }
        rows.sort_unstable();
        rows.dedup();
        Ok(rows)
    }

    fn write(
        &self,
        input: &Input,
        outcome: &Outcome,
        verified: bool,
        search: &Value,
    ) -> Result<(), Failure> {
        let findings = findings(outcome);
        let verdict = if verified {
            verdict(outcome)
        } else {
            "not verified".into()
        };
        let verdict = verdict.as_str();
        // What may fail comes first: the mesh is written when everything else is.
        if let Some(path) = &self.picture {
            let title = picture::title(self.input());
            let mut scene = picture::scene(&title, &findings, verdict, None)?;
            if let Some(points) = input.places().filter(|_| picture::is_page(path)) {
                overlay::add_points(&mut scene, &outcome.mesh, points)?;
            }
            write_bytes_whole(path, &picture::bytes(path, &scene, picture::SIZE)?)?;
        }
        if let Some(path) = &self.report {
            let mut report = report(outcome, self.described(input));
            if let (Value::Object(all), Value::Object(search)) = (&mut report, search) {
                all.extend(search.clone());
                all.insert("verified".into(), json!(verified));
            }
            write_bytes_whole(path, pretty(&report).as_bytes())?;
        }
        let prepared = !search["preparation"].is_null();
        let parameters = &outcome.report.parameters;
        write_reconstruction(&self.output, parameters, outcome, verified, prepared)?;
        let mut lines = vec![
            format!("{}: {} ({verdict})", self.output.display(), findings.size()),
            format!("Betti numbers {}", findings.topology()),
            findings.description(),
        ];
        lines.extend(findings.creased());
        lines.extend(outcome.report.given.as_ref().map(told));
        if let Some(count @ 1..) = duplicates(outcome) {
            lines.push(format!(
                "{} in the input",
                counted(count, "duplicate point")
            ));
        }
        for path in [&self.report, &self.picture].into_iter().flatten() {
            lines.push(format!("{}: written", path.display()));
        }
        say(lines.join("\n"))
    }
}
