//! `crosscap check`: what a mesh is, and whether it may be trusted.

use super::failure::Failure;
use super::findings::{Findings, pretty};
use super::number::{betti, counted, median, positive};
use super::origin::{Asked, Origin};
use super::output;
use super::parameters::yes_or_no;
use super::points::PointArguments;
use super::terminal::{Progress, say};
use clap::Args;
use crosscap::auto::Measured;
use crosscap_algorithms::certificate::certify;
use crosscap_algorithms::homology::{LocalHomology, homology, local_homology};
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::prepare::PreparationSummary;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::{MESH_EXTENSIONS, MeshExtras, read_mesh, write_mesh};
use crosscap_backends::parallel::Threads;
use crosscap_core::{Mesh, PointCloud};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Betti numbers are no acceptance test: a folded mesh can have the right ones. A mesh is verified when
every edge has the triangles it should have, every vertex looks like a point of a surface that may cross itself, nothing
folds, overlaps or crosses off the double curves, and, with --points, mesh and points are near each other.
Exit code 0: verified; 1: not verified.

Examples:
  crosscap check mesh.npz
  crosscap check mesh.npz --points points.npy --dl 0.1
  crosscap check mesh.npz --local --eps 0.25
  crosscap check mesh.npz --json > verdict.json
  crosscap check klein.npz --normalization bottle.npz";

/// Check a mesh: Betti numbers, torsion, edges, links, pieces, quality, verdict
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES, allow_negative_numbers = true)]
pub struct Check {
    /// Mesh: .npz, .vtu, .ply, .obj, .off or .stl
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

    /// Leave outliers out and allow for noise, as a reconstruction without parameters does: yes or no [default: what the mesh
    /// was made with, or yes]
    #[arg(long, value_name = "YES|NO", value_parser = yes_or_no, requires = "points")]
    prepare: Option<bool>,

    /// Width of the narrowest hole that the surface may have, where you know it, in spacings of the points: narrower gaps may
    /// be covered [default: what the mesh was made with]
    #[arg(long, value_name = "SPACINGS", value_parser = positive, requires = "points")]
    least_hole: Option<f64>,

    /// The surface is known to have no boundary: boundary edges are refused
    #[arg(long)]
    closed: bool,

    /// Check every neighborhood of a vertex too: its part of the mesh must have Betti numbers 1, 0, 0
    ///
    /// The paper's own check. What the vertices within eps span, as far as it hangs together with the vertex, is
    /// contractible when the mesh is good and the ball small enough for the surface.
    #[arg(long)]
    local: bool,

    /// Radius of the neighborhoods of --local, unit of the data [default: what the mesh was made with]
    #[arg(long, visible_alias = "epsilon", value_name = "E", value_parser = positive, requires = "local")]
    eps: Option<f64>,

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
        self.check_outputs()?;
        let file = read_mesh(&self.mesh)?;
        let mesh = &file.mesh;
        let points = self.cloud(mesh)?;
        let progress = Progress::new("checking");
        let origin = Origin::of(&file.extras.metadata)
            .map_err(|why| Failure::usage(format!("{}: {why}", self.mesh.display())))?;
        let asked = Asked {
            dl: self.dl,
            closed: self.closed,
            prepare: self.prepare,
            least_hole: self.least_hole,
        };
        let (options, measuring) = (origin.certificate(&asked), origin.measuring(&asked));
        let homology = homology(&mesh.complex)?;
        let local = match self.local {
            true => Some(self.local_check(mesh, origin.eps)?),
            false => None,
        };
        let (certificate, creases, preparation) = match &points {
            None => (certify(mesh, &options), None, None),
            Some(points) => {
                let found = Measured::of(mesh, points, &options, &measuring)?;
                (found.certificate, Some(found.creases), found.preparation)
            }
        };
        let pieces = pieces(mesh);
        drop(progress);
        self.normalize(&pieces)?;
        self.tell(
            &Findings {
                mesh,
                homology: &homology,
                certificate: &certificate,
                pieces: &pieces,
                creases: creases.as_ref(),
                special_points: &origin.special_points,
            },
            local.as_ref(),
            preparation.as_ref(),
        )
    }

    /// Refuses an output of another kind, or that is an input, before the long part.
    fn check_outputs(&self) -> Result<(), Failure> {
        let Some(path) = &self.normalization else {
            return Ok(());
        };
        output::check(path, MESH_EXTENSIONS)?;
        let mut inputs = vec![self.mesh.as_path()];
        inputs.extend(self.points.as_deref());
        output::distinct(&inputs, &[path])
    }

    /// Writes the surface with its crossings taken apart where that is asked for.
    fn normalize(&self, pieces: &Result<Pieces, PiecesError>) -> Result<(), Failure> {
        let Some(path) = &self.normalization else {
            return Ok(());
        };
        let pieces = pieces.as_ref().map_err(|error| {
            Failure::NotVerified(format!(
                "{}: the crossings cannot be taken apart: {error}",
                self.mesh.display()
            ))
        })?;
        write_normalization(path, pieces)
    }

    /// The points that the mesh was made from, in the space that it is in.
    fn cloud(&self, mesh: &Mesh) -> Result<Option<PointCloud<f64>>, Failure> {
        let Some(path) = &self.points else {
            return Ok(None);
        };
        let points = self.choice.read(path)?.into_f64();
        if points.dimension() != mesh.vertices.dimension() {
            return Err(Failure::usage(format!(
                "{}: found points in R^{}, expected R^{}, as {} is",
                path.display(),
                points.dimension(),
                mesh.vertices.dimension(),
                self.mesh.display()
            )));
        }
        Ok(Some(points))
    }

    /// Prints what was found, and fails where it is not verified.
    fn tell(
        &self,
        findings: &Findings<'_>,
        local: Option<&LocalHomology>,
        preparation: Option<&PreparationSummary>,
    ) -> Result<(), Failure> {
        let sound = local.is_none_or(|local| local.failures.is_empty());
        let verified = findings.certificate.verdict().is_verified() && sound;
        if self.json {
            let mut all = findings.json(verified);
            if let Some(local) = local {
                all.insert("local".into(), json!(local));
            }
            if let Some(preparation) = preparation {
                all.insert("preparation".into(), json!(preparation));
            }
            all.insert("crosscap".into(), json!(env!("CARGO_PKG_VERSION")));
            all.insert("file".into(), json!(self.mesh.display().to_string()));
            say(pretty(&Value::Object(all)).trim_end())?;
        } else {
            if let Some(local) = local {
                say(told(local, findings.mesh))?;
            }
            if let Some(preparation) = preparation {
                say(preparation.to_string().trim_end())?;
            }
            say(findings.lines())?;
        }
        if verified {
            return Ok(());
        }
        let why = match sound {
            true => "",
            false => ": there are neighborhoods that are not contractible",
        };
        Err(Failure::NotVerified(format!(
            "{}: not verified{why}",
            self.mesh.display()
        )))
    }

    fn local_check(&self, mesh: &Mesh, made_with: Option<f64>) -> Result<LocalHomology, Failure> {
        let Some(eps) = self.eps.or(made_with) else {
            return Err(Failure::usage(format!(
                "{}: does not tell the eps it was made with: give --eps, the radius of the neighborhoods of --local",
                self.mesh.display()
            )));
        };
        let edges = mesh.complex.edges();
        let length = |e: &[u32; 2]| {
            let [a, b] = e.map(|v| v as usize);
            mesh.vertices.squared_distance(a, b).sqrt()
        };
        let edge = median(edges.iter().map(length).collect());
        if eps <= edge {
            return Err(Failure::usage(format!(
                "--eps {eps} is not above the median edge, {edge:.3}: most neighborhoods would be single vertices, and \
                 the check would say nothing; 2 edges are a good start"
            )));
        }
        let oracle = EuclideanOracle::new(mesh.vertices.clone())?;
        Ok(local_homology(
            &mesh.complex,
            &oracle,
            eps,
            &Threads::new(0)?,
        )?)
    }
}

/// Writes the surface with its crossings taken apart.
fn write_normalization(path: &Path, pieces: &Pieces) -> Result<(), Failure> {
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
    Ok(())
}

/// The local check in a line or two.
fn told(local: &LocalHomology, mesh: &Mesh) -> String {
    let all = format!(
        "{} of radius {} (median {})",
        counted(local.neighborhoods, "neighborhood"),
        local.radius,
        counted(local.median_members, "vertex")
    );
    let others = match local.other_sheets {
        0 => String::new(),
        n => format!(
            "\n           {n} of the balls hold a part of another sheet, which does not meet theirs in them"
        ),
    };
    let Some(first) = local.failures.first() else {
        return format!("local      {all}: all have Betti numbers 1, 0, 0{others}");
    };
    let vertex = first.vertex as usize;
    let row = match mesh.point_index[vertex] {
        row if row >= 0 => format!(" (point {row})"),
        _ => String::new(),
    };
    let place = mesh.vertices.point(vertex).iter().take(3);
    let place: Vec<String> = place.map(|x| format!("{x:.4}")).collect();
    let more = if mesh.vertices.dimension() > 3 {
        ", .."
    } else {
        ""
    };
    format!(
        "local      {all}: {} not 1, 0, 0 over Q and Z/2, first at vertex {vertex}{row} at ({}{more}): {} over Q, {} \
         over Z/2. To change: a smaller --eps if the surface is no disc within it, else the mesh is wrong there{others}",
        local.failures.len(),
        place.join(", "),
        betti(first.betti_rational),
        betti(first.betti_mod2)
    )
}
