//! `crosscap view`: a picture of a mesh.

use super::failure::Failure;
use super::findings::Findings;
use super::layout::LayoutName;
use super::points::PointArguments;
use super::terminal::{Progress, say};
use super::{output, overlay, picture};
use clap::Args;
use crosscap_algorithms::certificate::{CertificateOptions, SpecialPoint, certify};
use crosscap_algorithms::homology::homology;
use crosscap_algorithms::pieces::pieces;
use crosscap_backends::files::{
    AnyCloud, FileError, MeshFile, NO_TRIANGLES, read_mesh, write_bytes_whole,
};
use crosscap_core::PointCloud;
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str =
    "Every piece has a color of its own; double curves are black, a boundary is dark blue. On a page a mesh can also be colored by height, by \
the dimension of the neighborhoods, and points by their distance to the mesh; a click tells the row of a vertex or point. Points by themselves are \
shown as they are.

Examples:
  crosscap view mesh.npz -o mesh.html
  crosscap view mesh.npz -o mesh.png --size 1600x1200
  crosscap view mesh.npz --points points.npy -o both.html
  crosscap view points.npy -o points.html
  crosscap view conformations.npz -o conformations.html --layout pca";

/// Draw a mesh, colored by piece, with its double curves and boundary; or points
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct View {
    /// Mesh: .npz, .vtu, .ply, .obj, .off or .stl; or points in any format that they are read from
    #[arg(value_name = "MESH|POINTS")]
    mesh: PathBuf,

    /// Points to show with the mesh, on a page
    #[arg(long, value_name = "POINTS")]
    points: Option<PathBuf>,

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

    #[command(flatten)]
    choice: PointArguments,
}

/// Whether a file cannot be a mesh at all: by its extension, or as an archive without triangles.
fn holds_no_mesh(error: &FileError) -> bool {
    match error {
        FileError::Extension { .. } => true,
        FileError::Content { found, .. } => found == NO_TRIANGLES,
        _ => false,
    }
}

/// What there is to see in a file.
enum Seen {
    Mesh(Box<MeshFile>),
    Points(PointCloud<f64>),
}

impl View {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        output::check(&self.output, output::PICTURES)?;
        let mut inputs = vec![self.mesh.as_path()];
        inputs.extend(self.points.as_deref());
        output::distinct(&inputs, &[&self.output])?;
        match self.read()? {
            Seen::Mesh(file) => self.draw_mesh(&file),
            Seen::Points(points) => self.draw_points(&points),
        }
    }

    /// What is in the file. Some formats hold meshes and points: where there is no triangle and no curve, points are meant.
    fn read(&self) -> Result<Seen, Failure> {
        let is_mesh = |file: &MeshFile| {
            let complex = &file.mesh.complex;
            !(complex.triangles.is_empty() && complex.curve_edges.is_empty())
        };
        let mesh = match read_mesh(&self.mesh) {
            Ok(file) if is_mesh(&file) || self.points.is_some() => {
                return Ok(Seen::Mesh(Box::new(file)));
            }
            other => other,
        };
        match mesh {
            // A mesh that is broken is not shown as points.
            Err(error) if !holds_no_mesh(&error) => Err(error.into()),
            _ => Ok(Seen::Points(self.choice.read(&self.mesh)?.into_f64())),
        }
    }

    fn heading(&self) -> String {
        let title = self.title.clone();
        title.unwrap_or_else(|| picture::title(&self.mesh))
    }

    fn draw_points(&self, points: &PointCloud<f64>) -> Result<(), Failure> {
        if self.points.is_some() {
            return Err(Failure::usage(format!(
                "{}: holds points and no mesh: found --points too, expected a mesh to show them with",
                self.mesh.display()
            )));
        }
        let progress = Progress::new("drawing");
        let scene = overlay::cloud(&self.heading(), points)?;
        write_bytes_whole(
            &self.output,
            &picture::bytes(&self.output, &scene, self.size)?,
        )?;
        drop(progress);
        let told = scene.facts.first().map_or("", |(_, size)| size.as_str());
        say(format!("{}: {told}", self.output.display()))
    }

    fn draw_mesh(&self, file: &MeshFile) -> Result<(), Failure> {
        let mesh = &file.mesh;
        let points = self.points.as_ref().map(|path| self.choice.read(path));
        let points = points.transpose()?.map(AnyCloud::into_f64);
        let progress = Progress::new("drawing");
        let homology = homology(&mesh.complex)?;
        let certificate = certify(mesh, &CertificateOptions::default());
        let pieces = pieces(mesh);
        let declared = file.extras.metadata.get("special_points");
        let special_points: Vec<SpecialPoint> = declared
            .and_then(|all| serde_json::from_value(all.clone()).ok())
            .unwrap_or_default();
        let findings = Findings {
            mesh,
            homology: &homology,
            certificate: &certificate,
            pieces: &pieces,
            creases: None,
            special_points: &special_points,
        };
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
        let mut scene = picture::scene(&self.heading(), &findings, verdict, self.layout)?;
        if let Some(points) = points.filter(|_| picture::is_page(&self.output)) {
            overlay::add_points(&mut scene, mesh, &points)?;
        }
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
