//! `crosscap sample`: points on a surface whose topology is known.

use super::failure::Failure;
use super::number::{betti, counted, not_negative, positive};
use super::output;
use super::terminal::{Progress, say};
use clap::Args;
use crosscap_algorithms::surfaces::{
    PaperExample, Random, RingConformations, RingError, RingGeometry, SampleSurface, SamplingLaw,
    catalogue, embed, thin,
};
use crosscap_backends::files::{write_indices, write_points};
use crosscap_core::{Error, PointCloud};
use std::path::PathBuf;

const EXAMPLES: &str = "Points are uniform by area. Without -n and --thin number and spacing are those of the paper's example,
where the surface is one. The same seed gives the same file.

Examples:
  crosscap sample --list
  crosscap sample sphere -n 3000 --seed 1 -o sphere.npy
  crosscap sample two-spheres -n 200000 --thin 0.01 -o spheres.npy
  crosscap sample moebius -o strip.npy --boundary-out rim.npy
  crosscap sample torus -n 5000 --noise 0.01 --embed 10 -o torus.csv
  crosscap sample cyclo-octane -n 100000 -o conformations.npy
  crosscap sample cyclo-octane --bond-length 1.54 --bond-angle 111.5 --thin 0.05 -o other.npy";

/// Name of the conformations of cyclo-octane, which are no parametrized surface.
const RING: &str = "cyclo-octane";
/// Number of conformations when none is given.
const RING_COUNT: usize = 100_000;
/// Most coordinates of a sample: 8 gigabytes.
const MOST_COORDINATES: usize = 1 << 30;

/// Draw points from a surface whose topology is known
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES, allow_negative_numbers = true)]
pub struct Sample {
    /// Name of the surface; --list tells the names
    #[arg(value_name = "SURFACE", required_unless_present = "list")]
    surface: Option<String>,

    /// List the surfaces with their Betti numbers
    #[arg(long)]
    list: bool,

    /// Number of points drawn, before thinning [default: that of the surface]
    #[arg(short = 'n', long = "count", value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    count: Option<u32>,

    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    /// Thin the points to at least this spacing, unit of the surface
    #[arg(long, value_name = "SPACING", value_parser = positive)]
    thin: Option<f64>,

    /// Points uniform over the parameters of the surface rather than by area
    #[arg(long)]
    parameter_uniform: bool,

    /// Length of the bonds of cyclo-octane, Angstrom [default: 1.52]
    #[arg(long, value_name = "L", value_parser = positive)]
    bond_length: Option<f64>,

    /// Bond angle of cyclo-octane, degrees; the ring closes below 135 [default: 115]
    #[arg(long, value_name = "DEGREES", value_parser = positive)]
    bond_angle: Option<f64>,

    /// Standard deviation of normal noise added to every coordinate, unit of the surface
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, default_value_t = 0.0)]
    noise: f64,

    /// Turn the points into R^N by a random isometric embedding
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    embed: Option<u16>,

    /// Points to write: .npy, .csv, .xyz or .ply
    #[arg(short, long, value_name = "POINTS", required_unless_present = "list")]
    output: Option<PathBuf>,

    /// Rows on the boundary to write, .npy or .txt; points exactly on the boundary are added to the sample
    #[arg(long, value_name = "INDICES")]
    boundary_out: Option<PathBuf>,
}

/// What was drawn.
struct Drawn {
    points: PointCloud<f64>,
    boundary: Vec<usize>,
    name: &'static str,
    summary: &'static str,
    betti: Option<[usize; 3]>,
    paper: Option<PaperExample>,
}

impl Sample {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Failure> {
        let (Some(name), Some(path), false) = (&self.surface, &self.output, self.list) else {
            return say(list());
        };
        output::check(path, output::POINTS)?;
        if let Some(boundary) = &self.boundary_out {
            output::check(boundary, output::INDICES)?;
            output::distinct(&[], &[path, boundary])?;
        }
        let progress = Progress::new("drawing points");
        let plain = name.to_ascii_lowercase().replace(['-', '_'], "");
        let drawn = if plain == "cyclooctane" {
            self.conformations()?
        } else {
            self.points(name)?
        };
        drop(progress);
        let dimension = drawn.points.dimension();
        if output::extension(path) == "ply" && dimension != 3 {
            return Err(Failure::usage(format!(
                "{}: found points in R^{dimension}, expected R^3, which this format holds: write .npy or .csv",
                path.display()
            )));
        }
        if let Some(boundary) = &self.boundary_out {
            write_indices(boundary, &drawn.boundary)?;
        }
        write_points(path, &drawn.points)?;
        say(self.told(&drawn, path))
    }

    fn points(&self, name: &str) -> Result<Drawn, Failure> {
        let surface = SampleSurface::find(name).map_err(|_| {
            Failure::usage(format!(
                "there is no surface {name:?}; there are\n{}",
                list()
            ))
        })?;
        if self.bond_length.is_some() || self.bond_angle.is_some() {
            return Err(Failure::usage(format!(
                "{} has no bonds: leave out --bond-length and --bond-angle",
                surface.name()
            )));
        }
        if self.boundary_out.is_some() && !surface.has_boundary() {
            return Err(Failure::usage(format!(
                "{} has no boundary: leave out --boundary-out",
                surface.name()
            )));
        }
        let mut sampling = surface.default_sampling(self.seed);
        if let Some(count) = self.count {
            sampling.count = count as usize;
            sampling.thinning = None;
        }
        sampling.thinning = self.thin.or(sampling.thinning);
        if self.parameter_uniform {
            sampling.law = SamplingLaw::Parameters;
        }
        sampling.boundary = self.boundary_out.is_some();
        let dimension = surface.ambient_dimension();
        self.check_size(sampling.count, dimension)?;
        // Noise is in all coordinates there are: it comes after the embedding.
        let embedded = self.embed.is_some();
        sampling.noise = if embedded { 0.0 } else { self.noise };
        let sample = surface.sample(&sampling)?;
        let points = self.embedded(sample.points)?;
        Ok(Drawn {
            points: if embedded {
                self.noisy(points)?
            } else {
                points
            },
            boundary: sample.boundary,
            name: surface.name(),
            summary: surface.summary(),
            betti: Some(surface.truth().betti),
            // With another number of points the parameters would have to be others.
            paper: surface
                .paper()
                .copied()
                .filter(|_| self.count.is_none() && self.thin.is_none()),
        })
    }

    fn conformations(&self) -> Result<Drawn, Failure> {
        if self.boundary_out.is_some() {
            return Err(Failure::usage(format!(
                "{RING} has no boundary: leave out --boundary-out"
            )));
        }
        if self.parameter_uniform {
            return Err(Failure::usage(format!(
                "{RING} has no parameters to be uniform over: leave out --parameter-uniform"
            )));
        }
        let count = self.count.map_or(RING_COUNT, |count| count as usize);
        self.check_size(count, 24)?;
        let plain = self.bond_length.is_none() && self.bond_angle.is_none();
        let known = RingGeometry::cyclo_octane();
        let length = self.bond_length.unwrap_or(known.bond_lengths[0]);
        let angle = match self.bond_angle {
            Some(angle) => angle,
            None => known.bond_angles[0].unwrap_or_default(),
        };
        let told = |error: RingError| Failure::usage(format!("{RING}: {error}"));
        let ring = RingConformations::new(known.bond_lengths.len(), length, angle).map_err(told)?;
        let mut points = ring.sample(count, self.seed).map_err(told)?.points;
        if let Some(spacing) = self.thin {
            points = points.select(&thin(&points, spacing)?);
        }
        Ok(Drawn {
            points: self.noisy(self.embedded(points)?)?,
            boundary: Vec::new(),
            name: RING,
            summary: "conformations of cyclo-octane, Angstrom",
            // Other lengths and angles are another surface.
            betti: plain.then_some([1, 1, 2]),
            paper: None,
        })
    }

    fn check_size(&self, count: usize, dimension: usize) -> Result<(), Failure> {
        let wanted = match self.embed {
            Some(n) if usize::from(n) < dimension => {
                return Err(Failure::usage(format!(
                    "--embed {n} is too small: the surface lies in R^{dimension}"
                )));
            }
            Some(n) => n.into(),
            None => dimension,
        };
        if count.saturating_mul(wanted) > MOST_COORDINATES {
            return Err(Failure::usage(format!(
                "{count} points in R^{wanted} are too many: at most {} are drawn at a time",
                MOST_COORDINATES / wanted
            )));
        }
        Ok(())
    }

    fn embedded(&self, points: PointCloud<f64>) -> Result<PointCloud<f64>, Error> {
        match self.embed {
            Some(dimension) => embed(&points, dimension.into(), self.seed),
            None => Ok(points),
        }
    }

    fn noisy(&self, points: PointCloud<f64>) -> Result<PointCloud<f64>, Error> {
        if self.noise == 0.0 {
            return Ok(points);
        }
        let mut random = Random::stream(self.seed, u64::MAX);
        let moved = points.coordinates().iter();
        let moved = moved.map(|x| x + self.noise * random.normal()).collect();
        PointCloud::new(points.dimension(), moved)
    }

    fn told(&self, drawn: &Drawn, path: &std::path::Path) -> String {
        let mut lines = vec![format!(
            "{}: {} in R^{} ({}, seed {})",
            path.display(),
            counted(drawn.points.len(), "point"),
            drawn.points.dimension(),
            drawn.summary,
            self.seed
        )];
        if let Some(boundary) = &self.boundary_out {
            lines.push(format!(
                "{}: {} on the boundary",
                boundary.display(),
                counted(drawn.boundary.len(), "row")
            ));
        }
        if let Some(known) = drawn.betti {
            lines.push(format!("true Betti numbers {}", betti(known)));
        }
        if let Some(paper) = &drawn.paper {
            let mut hint = format!(
                "the paper's parameters for {}: --eps {} --dl {}",
                drawn.name, paper.epsilon, paper.landmark_separation
            );
            for (flag, value) in [
                ("--tri-eps", paper.triangulation_epsilon),
                ("--dt", paper.dimension_tolerance),
                ("--dp", paper.fit_tolerance),
                ("--ep", paper.curve_tolerance),
            ] {
                if let Some(value) = value {
                    hint += &format!(" {flag} {value}");
                }
            }
            if paper.surface {
                hint += " --surface";
            }
            if let (true, Some(boundary)) = (paper.boundary_given, &self.boundary_out) {
                hint += &format!(" --boundary {}", boundary.display());
            }
            lines.push(hint);
        }
        lines.join("\n")
    }
}

/// The surfaces there are, one a line.
fn list() -> String {
    let mut lines: Vec<String> = catalogue()
        .iter()
        .map(|s| {
            format!(
                "  {:<28} R^{:<3} Betti {:<9} {}{}",
                s.name(),
                s.ambient_dimension(),
                betti(s.truth().betti),
                s.summary(),
                if s.has_boundary() { " (boundary)" } else { "" },
            )
        })
        .collect();
    lines.push(format!(
        "  {RING:<28} R^24  Betti {:<9} conformations of a ring of eight atoms",
        betti([1, 1, 2])
    ));
    lines.join("\n")
}
