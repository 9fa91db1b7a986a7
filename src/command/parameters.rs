//! Parameters of a reconstruction as the command line has them.

use super::estimators::EstimatorName;
use super::failure::Failure;
use super::number::{positive, share};
use super::spaces::SpaceArguments;
use clap::{ArgAction, Args, ValueEnum};
use crosscap::{Method, Pinned};
use crosscap_algorithms::singularity::ModelName;
use crosscap_core::Error;

/// Which algorithm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Cut the points along the double curves into cells, triangulate cell by cell
    #[default]
    Cells,
    /// The algorithm of the paper taken literally, for comparison
    Paper,
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Cells => Self::Cells,
            MethodName::Paper => Self::Paper,
        }
    }
}

/// Default of the dimension tolerance.
pub const DIMENSION_TOLERANCE: f64 = 0.05;

/// Default of the fit tolerance: the paper's share of eps for two spheres.
pub fn fit_tolerance(eps: f64) -> f64 {
    eps / 5.0
}

/// Default of the curve tolerance: between the paper's shares of eps (1/5, 1/8, 1/16, 1/11).
pub fn curve_tolerance(eps: f64) -> f64 {
    eps / 10.0
}

/// The options that the short help shows stand first, whatever group was before them.
pub const MAIN: Option<&str> = None;
/// What is rarely set stands apart in the help.
pub const ATTEMPTS: &str = "Attempts and what they leave";
const TOLERANCES: &str = "Estimators and tolerances";

#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub struct ParameterArguments {
    /// Radius of a neighborhood, unit of the data
    ///
    /// Points nearer than this (strictly) are what local dimension and crossing are read from. About 50 points or more
    /// should be so near; the surface should be nearly flat over this distance. [default: chosen from the density of the
    /// points]
    #[arg(long, visible_alias = "epsilon", value_name = "E", value_parser = positive)]
    pub eps: Option<f64>,

    /// Largest radius of a chart in the triangulation, unit of the data
    ///
    /// Charts reach 3 dl, or this where it is smaller (method paper: this, or eps when left out). Must be larger than dl.
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, visible_alias = "triangulation-epsilon", value_name = "E", value_parser = positive)]
    pub tri_eps: Option<f64>,

    /// Tolerance of the local dimension: the share of variance left over, 0 to 1
    ///
    /// Larger values see fewer crossings. The paper uses 0.01 to 0.075. [default: 0.05]
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, visible_alias = "dimension-tolerance", value_name = "T", value_parser = share)]
    pub dt: Option<f64>,

    /// Estimator of the local dimension
    ///
    /// All but pca are for surfaces that do not cross: they take a crossing for a surface.
    #[arg(
        long,
        help_heading = TOLERANCES,
        hide_short_help = true,
        value_name = "NAME",
        value_enum,
        default_value_t,
        conflicts_with = "surface"
    )]
    pub estimator: EstimatorName,

    /// Tolerance of the fit of two sheets, unit of the data: the root mean squared distance of the points to the nearer one
    /// [default: eps / 5]
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, visible_alias = "fit-tolerance", value_name = "T", value_parser = positive)]
    pub dp: Option<f64>,

    /// Tolerance of the double curve, unit of the data: points so near to both sheets are on it [default: eps / 10]
    ///
    /// Should exceed the sag of the surface within a neighborhood, about eps^2 / (4 x radius of curvature).
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, visible_alias = "curve-tolerance", value_name = "T", value_parser = positive)]
    pub ep: Option<f64>,

    /// Separation of the landmarks, unit of the data: the vertices of the mesh are at least so far apart
    ///
    /// Decides how fine the mesh is. A third to a half of eps is a good start. [default: half of eps]
    #[arg(long, visible_alias = "landmark-separation", value_name = "L", value_parser = positive)]
    pub dl: Option<f64>,

    /// Seed of the random choice of landmarks [default: 0]
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,

    /// Take every point as 2-dimensional: no double curve is looked for, as the paper does for its manifolds
    #[arg(long)]
    pub surface: bool,

    /// Width of the narrowest hole that the surface may have, where you know it, in spacings of the points
    ///
    /// A gap of the points that is no chance is taken for a hole, and a mesh that covers it is refused. Scans have seams
    /// where points are missing and nothing is open: when you know that no hole is narrower than this, narrower gaps may be covered. The
    /// verdict says so.
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, value_name = "SPACINGS", value_parser = positive)]
    pub least_hole: Option<f64>,

    /// Singularity models that compete, separated by commas, or auto for all of them
    ///
    /// two-planes (a double curve), refined-two-planes (the same with the paper's equation 5), boundary (found, not
    /// given), y-junction (three sheets on a curve), triple-point (three sheets crossing in a point), isolated-crossing
    /// (two sheets of R^4 or more that have one point in common), curve (no surface around), curve-through-sheet,
    /// curve-on-sheet, pinch-point (a double curve ends in one sheet), book (any number of sheets on a curve), book-end (a curve
    /// ends where sheets that meet in it do), cone-point (the tip of a cone, or two tips that touch), boundary-corner (a corner of
    /// a boundary that was found). With --surface only boundary is looked for. [default: auto; two-planes where --eps and --dl are both
    /// given]
    #[arg(long, value_name = "NAME,...", value_parser = models)]
    pub models: Option<Models>,

    /// Algorithm
    #[arg(long, help_heading = TOLERANCES, hide_short_help = true, value_name = "NAME", value_enum, default_value_t)]
    pub method: MethodName,

    #[command(flatten)]
    pub spaces: SpaceArguments,

    /// Leave outliers out and move points that scatter onto fits of their neighborhoods, where there are any: yes or no
    /// [default: yes, points that scatter little for the second attempt; no where --eps and --dl are both given]
    #[arg(long, help_heading = ATTEMPTS, hide_short_help = true, value_name = "YES|NO", value_parser = yes_or_no)]
    pub prepare: Option<bool>,

    /// Number of threads, 0 for all processors; the result does not depend on it
    #[arg(long, help_heading = MAIN, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub threads: u16,
}

/// Help in two lengths, for commands with many options: the ones that most runs need, and all.
#[derive(Args, Debug)]
pub struct Help {
    /// Print the options that most runs need
    #[arg(short = 'h', long = "help", help_heading = MAIN, action = ArgAction::HelpShort)]
    short: Option<bool>,

    /// Print every option, with what it does
    #[arg(long = "help-all", help_heading = MAIN, action = ArgAction::HelpLong)]
    all: Option<bool>,
}

impl ParameterArguments {
    /// What is given, and so not to be chosen.
    ///
    /// # Errors
    /// [`Failure::Usage`] for values that contradict each other.
    pub fn pinned(&self, boundary: Vec<usize>) -> Result<Pinned, Failure> {
        if let (Some(eps), Some(dl)) = (self.eps, self.dl)
            && dl > eps
        {
            return Err(Failure::usage(format!(
                "--dl {dl} is larger than --eps {eps}: landmarks would be farther apart than a neighborhood reaches; \
                 decrease --dl or increase --eps"
            )));
        }
        if let (Some(radius), Some(dl)) = (self.tri_eps, self.dl)
            && radius <= dl
        {
            return Err(Failure::usage(format!(
                "--tri-eps {radius} is not larger than --dl {dl}: no two landmarks would share a chart; 3 dl = {} is \
                 a good value",
                3.0 * dl
            )));
        }
        if let (Some(ep), Some(eps)) = (self.ep, self.eps)
            && ep >= eps
        {
            return Err(Failure::usage(format!(
                "--ep {ep} is not smaller than --eps {eps}: every point of a neighborhood would be on the double \
                 curve; decrease --ep (a tenth of eps is usual)"
            )));
        }
        Ok(Pinned {
            eps: self.eps,
            tri_eps: self.tri_eps,
            dt: self.dt,
            dp: self.dp,
            ep: self.ep,
            dl: self.dl,
            seed: self.seed,
            surface: self.surface.then_some(true),
            least_hole: self.least_hole,
            boundary,
            models: self.models.as_ref().map(|models| models.0.clone()),
            method: Some(self.method.into()),
            metric: self.spaces.metric,
            tri_metric: self.spaces.tri_metric,
            graph: self.spaces.graph.rule(),
            sheets: self.spaces.graph.graph_sheets.then_some(true),
            planes: self.spaces.graph.tri_planes.then_some(true),
            lift: self.spaces.graph.lift,
            neighborhoods: self.spaces.neighborhoods,
            prepare: self.prepare,
            threads: threads(self.threads),
        })
    }
}

/// Names of singularity models.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Models(pub Vec<ModelName>);

fn models(text: &str) -> Result<Models, String> {
    if text == "auto" {
        return Ok(Models(ModelName::AUTO.to_vec()));
    }
    let mut names = Vec::new();
    for name in text.split(',') {
        let name: ModelName = name.trim().parse().map_err(|e: Error| e.to_string())?;
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Ok(Models(names))
}

/// The value of an option that is a choice of two.
pub fn yes_or_no(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("expected yes or no".into()),
    }
}

/// 0 stands for all processors.
pub fn threads(count: u16) -> Option<usize> {
    (count > 0).then_some(count.into())
}
