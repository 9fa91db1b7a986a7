//! `crosscap view`: a picture of a mesh.

use super::failure::Failure;
use super::findings::Findings;
use super::layout::LayoutName;
use super::terminal::{Progress, say};
use super::{output, picture};
use clap::Args;
use crosscap_algorithms::certificate::{CertificateOptions, certify};
use crosscap_algorithms::homology::homology;
use crosscap_algorithms::pieces::pieces;
use crosscap_backends::files::{read_mesh, write_bytes_whole};
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str =
    "Every piece has a color of its own; double curves are black, a boundary is dark blue.

Examples:
  crosscap view mesh.npz -o mesh.html
  crosscap view mesh.npz -o mesh.png --size 1600x1200
  crosscap view conformations.npz -o conformations.html --layout pca";

/// Draw a mesh, colored by piece, with its double curves and boundary
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct View {
    /// Mesh: .npz, .vtu, .ply, .obj, .off or .stl
    #[arg(value_name = "MESH")]
    mesh: PathBuf,

    /// Picture to write: .html (one file, a page to turn it in) or .png
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// How a mesh in R^N is put into three dimensions [default: xyz up to R^3, isomap above]
    #[arg(long, value_name = "NAME", value_enum)]
    layout: Option<LayoutName>,

    /// Width and height of a .png, pixels
    #[arg(long, value_name = "WxH", value_parser = picture::size, default_value = "1200x900")]
    size: [usize; 2],

    /// Heading [default: the name of the file]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
}

impl View {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        output::check(&self.output, output::PICTURES)?;
        output::distinct(&[&self.mesh], &[&self.output])?;
        let file = read_mesh(&self.mesh)?;
        let mesh = &file.mesh;
        let progress = Progress::new("drawing");
        let homology = homology(&mesh.complex)?;
        let certificate = certify(mesh, &CertificateOptions::default());
        let pieces = pieces(mesh);
        let findings = Findings {
            mesh,
            homology: &homology,
            certificate: &certificate,
            pieces: &pieces,
        };
        let title = self.title.clone();
        let title = title.unwrap_or_else(|| picture::title(&self.mesh));
        let made = file
            .extras
            .metadata
            .get("verified")
            .and_then(Value::as_bool);
        let verdict = match (certificate.verdict().is_verified(), made) {
            (true, Some(true)) => "verified",
            (true, None) => "verified, as far as can be told without the points",
            _ => "not verified",
        };
        let scene = picture::scene(&title, &findings, verdict, self.layout)?;
        let bytes = picture::bytes(&self.output, &scene, self.size)?;
        write_bytes_whole(&self.output, &bytes)?;
        drop(progress);
        say(format!(
            "{}: {}, {}",
            self.output.display(),
            findings.size(),
            picture::pieces_shown(&scene)
        ))
    }
}
