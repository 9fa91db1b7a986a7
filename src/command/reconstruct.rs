//! `crosscap reconstruct`: points to mesh.

use super::estimators::EstimatorName;
use super::failure::Failure;
use super::findings::{Findings, pretty};
use super::number::counted;
use super::parameters::ParameterArguments;
use super::points::PointArguments;
use super::terminal::{Progress, complain, say};
use super::{output, picture};
use clap::Args;
use crosscap::GivenSpace;
use crosscap::pipeline::{Outcome, Parameters, Pipeline};
use crosscap_algorithms::certificate::Verdict;
use crosscap_backends::files::{
    AnyCloud, Distances, MESH_EXTENSIONS, MeshExtras, read_distances, read_indices,
    write_bytes_whole, write_mesh,
};
use crosscap_core::Error;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Lengths (eps, tri-eps, dp, ep, dl) are in the unit of the data.

Examples:
  crosscap reconstruct points.npy -o mesh.npz --eps 0.25 --dl 0.1
  crosscap reconstruct sphere.csv -o sphere.ply --eps 0.4 --dl 0.1 --surface --picture sphere.html
  crosscap reconstruct strip.npy -o strip.npz --eps 0.4 --dl 0.1 --surface --boundary rim.npy
  crosscap reconstruct points.npy -o mesh.npz --eps 0.25 --dl 0.1 --method paper --keep-unverified

A mesh that is not verified is not written, nor anything else, unless --keep-unverified is given; the exit code is 1
either way.";

/// Fewest points: what one neighborhood needs.
const LEAST_POINTS: usize = 8;
/// How many reasons of a failure are printed.
const REASONS: usize = 8;

/// Reconstruct a surface from points: triangulate, check, write
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Reconstruct {
    /// Points: .npy, .npz, .csv, .txt, .xyz, .pdb, .ply or .mat, one point a row
    #[arg(value_name = "POINTS", required_unless_present = "distances")]
    points: Option<PathBuf>,

    /// Distances instead of points: .npy (n x n) or .npz (sparse, as SciPy's save_npz writes it)
    ///
    /// Distances of points in a Euclidean space give these points back, up to a motion. Other distances are taken as
    /// they are: they need --surface, and what needs coordinates is not checked.
    #[arg(long, value_name = "DISTANCES", conflicts_with = "points")]
    distances: Option<PathBuf>,

    /// Mesh to write: .npz (keeps everything), .vtu, .ply, .obj or .off
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    #[command(flatten)]
    parameters: ParameterArguments,

    /// Rows of the points on the boundary, counted from 0: .npy or .txt
    #[arg(long, value_name = "INDICES")]
    boundary: Option<PathBuf>,

    #[command(flatten)]
    choice: PointArguments,

    /// Report to write, JSON: version, parameters, counts and seconds of every stage, homology, certificate
    #[arg(long, value_name = "REPORT.json")]
    report: Option<PathBuf>,

    /// Picture to write: .html (a page to turn it in) or .png
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// Write the files also when the mesh is not verified
    #[arg(long)]
    keep_unverified: bool,
}

impl Reconstruct {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        // Refuse what can be refused before the work begins.
        self.parameters.parameters(Vec::new())?;
        self.check_outputs()?;
        let input = match &self.distances {
            Some(path) => Input::Distances(read_distances(path)?),
            None => Input::Points(self.choice.read(self.input())?),
        };
        if input.len() < LEAST_POINTS {
            return Err(Failure::usage(format!(
                "{}: found {}, expected at least {LEAST_POINTS}, what one neighborhood needs",
                self.input().display(),
                counted(input.len(), "point")
            )));
        }
        let parameters = self
            .parameters
            .parameters(self.boundary_rows(input.len())?)?;
        let outcome = match &input {
            Input::Points(cloud) => {
                reconstruct_by(cloud, parameters.clone(), self.parameters.estimator)?
            }
            Input::Distances(distances) => observed(parameters.clone(), self.parameters.estimator)?
                .reconstruct_distances(distances)?,
        };
        let verified = outcome.is_verified();
        if !verified {
            for reason in reasons(&outcome) {
                complain(reason);
            }
            if !self.keep_unverified {
                return Err(Failure::NotVerified(format!(
                    "{}: no verified mesh, nothing written (--keep-unverified writes it as it is)",
                    self.input().display()
                )));
            }
        }
        self.write(&input, &parameters, &outcome)?;
        if verified {
            Ok(())
        } else {
            Err(Failure::NotVerified(format!(
                "{}: this mesh is not verified",
                self.output.display()
            )))
        }
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
        parameters: &Parameters,
        outcome: &Outcome,
    ) -> Result<(), Failure> {
        let findings = findings(outcome);
        let verdict = verdict(outcome);
        let verdict = verdict.as_str();
        // What may fail comes first: the mesh is written when everything else is.
        if let Some(path) = &self.picture {
            let scene = picture::scene(&picture::title(self.input()), &findings, verdict, None)?;
            write_bytes_whole(path, &picture::bytes(path, &scene, picture::SIZE)?)?;
        }
        if let Some(path) = &self.report {
            let input = json!({
                "file": self.input().display().to_string(),
                "scalar": input.scalar_name(),
            });
            write_bytes_whole(path, pretty(&report(outcome, input)).as_bytes())?;
        }
        write_reconstruction(&self.output, parameters, outcome)?;
        let mut lines = vec![
            format!("{}: {} ({verdict})", self.output.display(), findings.size()),
            format!("Betti numbers {}", findings.topology()),
            findings.description(),
        ];
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

/// What a surface is reconstructed from.
enum Input {
    Points(AnyCloud),
    Distances(Distances),
}

impl Input {
    fn len(&self) -> usize {
        match self {
            Self::Points(cloud) => cloud.len(),
            Self::Distances(distances) => distances.len(),
        }
    }

    fn scalar_name(&self) -> &'static str {
        match self {
            Self::Points(cloud) => cloud.scalar_name(),
            Self::Distances(_) => "f64",
        }
    }
}

/// The verdict in a line, with what it does not cover.
fn verdict(outcome: &Outcome) -> String {
    if !outcome.is_verified() {
        return "not verified".into();
    }
    let unchecked = outcome.certificate.unchecked();
    if unchecked.is_empty() {
        return "verified".into();
    }
    let names: Vec<String> = unchecked.iter().map(ToString::to_string).collect();
    format!(
        "verified by distances; not checked for want of coordinates: {}",
        names.join(", ")
    )
}

/// What became of distances.
fn told(given: &GivenSpace) -> String {
    let GivenSpace {
        dimension,
        deviation,
        exact,
    } = given;
    if *exact {
        format!("the distances are those of points in R^{dimension}, within {deviation:.1e}")
    } else {
        format!(
            "no points have these distances: the places written, in R^{dimension}, are a picture, off by up to \
             {deviation:.1e}"
        )
    }
}

/// Runs the pipeline with progress.
pub fn reconstruct(cloud: &AnyCloud, parameters: Parameters) -> Result<Outcome, Error> {
    reconstruct_by(cloud, parameters, EstimatorName::default())
}

/// The same with an estimator of the local dimension.
fn reconstruct_by(
    cloud: &AnyCloud,
    parameters: Parameters,
    estimator: EstimatorName,
) -> Result<Outcome, Error> {
    observed(parameters, estimator)?.reconstruct(&cloud.to_f64())
}

/// A pipeline whose progress is shown, and its warnings as they come.
fn observed(parameters: Parameters, estimator: EstimatorName) -> Result<Pipeline, Error> {
    let progress = Progress::new("starting");
    let shown = progress.clone();
    let dt = parameters.dt;
    let mut pipeline = Pipeline::new(parameters)?
        .on_stage(move |stage| shown.stage(stage))
        .on_warning(move |warning| {
            progress.suspend(|| complain(format_args!("warning: {warning}")));
        });
    // The pipeline has principal components of its own, of all points together.
    if estimator != EstimatorName::Pca {
        pipeline = pipeline.estimator(estimator.local(dt)?);
    }
    Ok(pipeline)
}

/// What is known about the mesh of an outcome.
pub fn findings(outcome: &Outcome) -> Findings<'_> {
    Findings {
        mesh: &outcome.mesh,
        homology: &outcome.homology,
        certificate: &outcome.certificate,
        pieces: &outcome.pieces,
    }
}

/// Why a mesh is not verified: place and parameter to change, the first few.
pub fn reasons(outcome: &Outcome) -> Vec<String> {
    let mut reasons: Vec<String> = outcome.failures.iter().map(ToString::to_string).collect();
    if let Verdict::Refused(violations) = outcome.certificate.verdict() {
        reasons.extend(violations.iter().map(ToString::to_string));
    }
    let more = reasons.len().saturating_sub(REASONS);
    reasons.truncate(REASONS);
    if more > 0 {
        reasons.push(format!(
            "and {more} more (see the report of --keep-unverified)"
        ));
    }
    reasons
}

/// Writes the mesh with its pieces and with what it was made from; nothing in it changes from run to run.
pub fn write_reconstruction(
    path: &Path,
    parameters: &Parameters,
    outcome: &Outcome,
) -> Result<(), Failure> {
    let mut metadata = json!({
        "crosscap": env!("CARGO_PKG_VERSION"),
        "verified": outcome.is_verified(),
        "eps": parameters.eps,
        "tri_eps": parameters.tri_eps,
        "dt": parameters.dt,
        "dp": parameters.dp,
        "ep": parameters.ep,
        "dl": parameters.dl,
        "seed": parameters.seed,
        "surface": parameters.surface,
        "boundary_points": parameters.boundary.len(),
        "models": parameters.models,
        "method": parameters.method.to_string(),
        "estimator": outcome.report.estimator,
    });
    if let Some(given) = &outcome.report.given {
        metadata["distances"] = json!(given);
        metadata["unchecked"] = json!(outcome.certificate.unchecked());
    }
    if !parameters.spaces.are_usual() {
        metadata["spaces"] = json!(parameters.spaces);
    }
    let pieces = outcome.pieces.as_ref().ok();
    let extras = MeshExtras {
        metadata,
        pieces: pieces.map(|p| p.triangle_piece.iter().map(|&k| k.into()).collect()),
    };
    let places = super::convert::places_for(path, &outcome.mesh, None)?;
    write_mesh(path, &outcome.mesh, &extras, places.as_ref())?;
    Ok(())
}

/// The report for programs.
pub fn report(outcome: &Outcome, input: Value) -> Value {
    let mut all = match json!(outcome.report) {
        Value::Object(map) => map,
        other => [("report".to_string(), other)].into_iter().collect(),
    };
    all.insert("input".into(), input);
    all.extend(findings(outcome).json(outcome.is_verified()));
    let failures: Vec<String> = outcome.failures.iter().map(ToString::to_string).collect();
    all.insert("failures".into(), json!(failures));
    Value::Object(all)
}

/// Number of duplicate points that the pipeline reports.
fn duplicates(outcome: &Outcome) -> Option<usize> {
    let count = json!(outcome.report).get("duplicates")?.as_u64()?;
    usize::try_from(count).ok()
}
