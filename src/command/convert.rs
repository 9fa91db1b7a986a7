//! `crosscap convert`: a mesh in another format.

use super::failure::Failure;
use super::layout::LayoutName;
use super::number::counted;
use super::output::{self, extension};
use super::terminal::say;
use clap::Args;
use crosscap_backends::files::{MESH_EXTENSIONS, read_mesh, write_mesh};
use crosscap_core::{Error, Mesh, PointCloud};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = ".npz and .vtu keep everything; .ply loses the coordinates above R^3 and the parameters; .obj also the rows of the
input; .off and .stl also the curves; .glb, in colors, is for showing only. A mesh in R^N goes into all but .npz and .vtu
through a layout. Triangles are wound: those of a closed piece in R^3 counter-clockwise, seen from outside.

Examples:
  crosscap convert mesh.npz mesh.vtu
  crosscap convert conformations.npz conformations.ply --layout pca";

/// Write a mesh in another format
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Convert {
    /// Mesh: .npz, .vtu, .ply, .obj, .off or .stl
    #[arg(value_name = "MESH")]
    mesh: PathBuf,

    /// Mesh to write: .npz, .vtu, .ply, .obj, .off, .stl or .glb
    #[arg(value_name = "OUT")]
    output: PathBuf,

    /// How a mesh in R^N is put into three dimensions [default: its own places in R^3, isomap above]
    #[arg(long, value_name = "NAME", value_enum)]
    layout: Option<LayoutName>,
}

impl Convert {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        output::check(&self.output, MESH_EXTENSIONS)?;
        output::distinct(&[&self.mesh], &[&self.output])?;
        let file = read_mesh(&self.mesh)?;
        let places = places_for(&self.output, &file.mesh, self.layout)?;
        write_mesh(&self.output, &file.mesh, &file.extras, places.as_ref())?;
        let complex = &file.mesh.complex;
        say(format!(
            "{}: {}, {}",
            self.output.display(),
            counted(complex.vertices, "vertex"),
            counted(complex.triangles.len(), "triangle")
        ))
    }
}

/// Places in R^3 where the format needs them or a layout is asked for.
pub fn places_for(
    path: &Path,
    mesh: &Mesh,
    layout: Option<LayoutName>,
) -> Result<Option<PointCloud<f64>>, Error> {
    let dimension = mesh.vertices.dimension();
    let layout = match layout {
        Some(layout) => layout,
        None if dimension == 3 || extension(path) == "npz" => return Ok(None),
        None => LayoutName::suiting(dimension),
    };
    layout.places(mesh).map(Some)
}
