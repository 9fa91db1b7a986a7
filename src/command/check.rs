//! `crosscap check`: what a mesh is, and whether it may be trusted.

use super::failure::Failure;
use super::findings::{Findings, pretty};
use super::number::positive;
use super::output;
use super::points::PointArguments;
use super::terminal::{Progress, say};
use clap::Args;
use crosscap_algorithms::certificate::{CertificateOptions, certify};
use crosscap_algorithms::homology::homology;
use crosscap_algorithms::pieces::pieces;
use crosscap_backends::files::{MESH_EXTENSIONS, MeshExtras, read_mesh, read_points, write_mesh};
use serde_json::{Value, json};
use std::path::PathBuf;

const EXAMPLES: &str = "Betti numbers are no acceptance test: a folded mesh can have the right ones. A mesh is verified when
every edge has the triangles it should have, every vertex looks like a point of a surface that may cross itself, nothing
folds, overlaps or crosses off the double curves, and, with --points, mesh and points are near each other.
Exit code 0: verified; 1: not verified.

Examples:
  crosscap check mesh.npz
  crosscap check mesh.npz --points points.npy --dl 0.1
  crosscap check mesh.npz --json > verdict.json
  crosscap check klein.npz --normalization bottle.npz";

/// Check a mesh: Betti numbers, torsion, edges, links, pieces, quality, verdict
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES, allow_negative_numbers = true)]
pub struct Check {
    /// Mesh: .npz, .vtu, .ply, .obj or .off
    #[arg(value_name = "MESH")]
    mesh: PathBuf,

    /// The points it was made from: distances both ways are measured
    #[arg(long, value_name = "POINTS")]
    points: Option<PathBuf>,

    #[command(flatten)]
    choice: PointArguments,

    /// Separation of the landmarks, unit of the data [default: what the mesh was made with, or 3/4 of the median edge]
    #[arg(long, visible_alias = "landmark-separation", value_name = "L", value_parser = positive)]
    dl: Option<f64>,

    /// The surface is known to have no boundary: boundary edges are refused
    #[arg(long)]
    closed: bool,

    /// Print JSON
    #[arg(long)]
    json: bool,

    /// Write the surface with its crossings taken apart, as a mesh in its own right
    #[arg(long, value_name = "MESH")]
    normalization: Option<PathBuf>,
}

impl Check {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(path) = &self.normalization {
            output::check(path, MESH_EXTENSIONS)?;
            let mut inputs = vec![self.mesh.as_path()];
            inputs.extend(self.points.as_deref());
            output::distinct(&inputs, &[path])?;
        }
        let file = read_mesh(&self.mesh)?;
        let mesh = &file.mesh;
        let points = match &self.points {
            Some(path) => Some(read_points(path, &self.choice.options())?.into_f64()),
            None => None,
        };
        if let (Some(points), Some(path)) = (&points, &self.points)
            && points.dimension() != mesh.vertices.dimension()
        {
            return Err(Failure::usage(format!(
                "{}: found points in R^{}, expected R^{}, as {} is",
                path.display(),
                points.dimension(),
                mesh.vertices.dimension(),
                self.mesh.display()
            )));
        }
        let progress = Progress::new("checking");
        let known = file.extras.metadata.get("dl").and_then(Value::as_f64);
        let options = CertificateOptions {
            points: points.as_ref(),
            landmark_separation: self.dl.or(known.filter(|&dl| dl > 0.0)),
            closed: self.closed,
            ..CertificateOptions::default()
        };
        let homology = homology(&mesh.complex)?;
        let certificate = certify(mesh, &options);
        let pieces = pieces(mesh);
        drop(progress);
        let findings = Findings {
            mesh,
            homology: &homology,
            certificate: &certificate,
            pieces: &pieces,
        };
        if let Some(path) = &self.normalization {
            let pieces = pieces.as_ref().map_err(|error| {
                Failure::NotVerified(format!(
                    "{}: the crossings cannot be taken apart: {error}",
                    self.mesh.display()
                ))
            })?;
            let labels = pieces.original_triangle.iter();
            let extras = MeshExtras {
                metadata: json!({ "crosscap": env!("CARGO_PKG_VERSION"), "normalization": true }),
                pieces: Some(
                    labels
                        .map(|&t| pieces.triangle_piece[t as usize].into())
                        .collect(),
                ),
            };
            let places = super::convert::places_for(path, &pieces.normalization, None)?;
            write_mesh(path, &pieces.normalization, &extras, places.as_ref())?;
        }
        let verdict = certificate.verdict();
        if self.json {
            let mut all = findings.json(verdict.is_verified());
            all.insert("crosscap".into(), json!(env!("CARGO_PKG_VERSION")));
            all.insert("file".into(), json!(self.mesh.display().to_string()));
            say(pretty(&Value::Object(all)).trim_end())?;
        } else {
            say(findings.lines())?;
        }
        if verdict.is_verified() {
            Ok(())
        } else {
            Err(Failure::NotVerified(format!(
                "{}: not verified",
                self.mesh.display()
            )))
        }
    }
}
