//! `crosscap demo`: everything once, with something to look at.

use super::failure::Failure;
use super::findings::pretty;
use super::number::counted;
use super::observed::reconstruct;
use super::outcome::{findings, reasons, report, write_reconstruction};
use super::paper::paper_parameters;
use super::parameters::MethodName;
use super::terminal::{Progress, complain, say};
use super::{overlay, picture};
use clap::Args;
use crosscap::{Outcome, Parameters};
use crosscap_algorithms::surfaces::SampleSurface;
use crosscap_backends::files::{AnyCloud, FileError, write_bytes_whole};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "Examples:
  crosscap demo
  crosscap demo -o somewhere --seed 7";

/// Sample two spheres that cross, reconstruct them, check the mesh, draw it
///
/// Writes a folder with a page to look at (index.html), an image (picture.png), the mesh (mesh.npz) and a report (report.json).
/// The example and its parameters are the paper's.
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Demo {
    /// Folder to write, made when it is not there
    #[arg(short, long, value_name = "DIR", default_value = "crosscap-demo")]
    output: PathBuf,

    /// Seed of the sample and of the landmarks
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
}

impl Demo {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        self.check_folder()?;
        let start = Instant::now();
        let progress = Progress::new("drawing points");
        let surface = SampleSurface::find("two_spheres")?;
        let paper = surface.paper().ok_or_else(|| {
            Failure::usage("the example has lost its parameters: this is a mistake of crosscap")
        })?;
        let sample = surface.sample(&surface.default_sampling(self.seed))?;
        drop(progress);
        say(format!(
            "sampled       {} on {}",
            counted(sample.points.len(), "point"),
            surface.summary()
        ))?;
        let parameters =
            paper_parameters(paper, self.seed, sample.boundary, MethodName::Cells, None);
        let cloud = AnyCloud::F64(sample.points);
        let outcome = reconstruct(&cloud, parameters.clone())?;
        if !outcome.is_verified() {
            reasons(&outcome).iter().for_each(complain);
            return Err(Failure::NotVerified(format!(
                "no verified mesh with seed {}, nothing written: try another --seed",
                self.seed
            )));
        }
        let findings = findings(&outcome);
        say(format!(
            "reconstructed {}\nBetti numbers {}\npieces        {}\nverdict       verified",
            findings.size(),
            findings.topology(),
            findings.description()
        ))?;
        let page = self.write(surface.name(), &cloud, &parameters, &outcome)?;
        say(format!(
            "done in       {:.1} s\n\nOpen {} in a browser to turn it. Beside it: picture.png, mesh.npz, report.json.",
            start.elapsed().as_secs_f64(),
            page.display()
        ))
    }

    /// Writes page, image, mesh and report; the page's path.
    fn write(
        &self,
        surface: &str,
        cloud: &AnyCloud,
        parameters: &Parameters,
        outcome: &Outcome,
    ) -> Result<PathBuf, Failure> {
        let progress = Progress::new("drawing");
        let page = self.output.join("index.html");
        let image = self.output.join("picture.png");
        let mut scene = picture::scene("Two spheres", &findings(outcome), "verified", None)?;
        overlay::add_points(&mut scene, &outcome.mesh, &cloud.to_f64())?;
        let pages = picture::bytes(&page, &scene, picture::SIZE)?;
        let pixels = picture::bytes(&image, &scene, picture::SIZE)?;
        std::fs::create_dir_all(&self.output).map_err(|source| FileError::Write {
            path: self.output.clone(),
            source,
        })?;
        write_bytes_whole(&page, &pages)?;
        write_bytes_whole(&image, &pixels)?;
        write_reconstruction(
            &self.output.join("mesh.npz"),
            parameters,
            outcome,
            outcome.is_verified(),
            false,
        )?;
        let input = json!({ "surface": surface, "scalar": cloud.scalar_name() });
        let report = pretty(&report(outcome, input));
        write_bytes_whole(self.output.join("report.json"), report.as_bytes())?;
        drop(progress);
        Ok(page)
    }

    /// The folder above must be there, and the folder itself must not be a file.
    fn check_folder(&self) -> Result<(), Failure> {
        if self.output.is_dir() {
            return Ok(());
        }
        if self.output.exists() {
            return Err(Failure::usage(format!(
                "{}: is a file, expected a folder or a new name",
                self.output.display()
            )));
        }
        match self.output.parent() {
            Some(above) if !above.as_os_str().is_empty() && !above.is_dir() => {
                Err(FileError::Folder {
                    path: self.output.clone(),
                    folder: above.into(),
                }
                .into())
            }
            _ => Ok(()),
        }
    }
}
