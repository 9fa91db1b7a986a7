//! What can be changed after an attempt that failed.

use super::density::Density;
use super::pinned::Pinned;
use super::rounding::three_digits;
use crate::pipeline::Parameters;
use crate::spaces::{MetricName, Neighborhoods, Spaces};
use crosscap_algorithms::singularity::ModelName;
use crosscap_backends::geodesic::EdgeRule;
use serde::Serialize;

/// A change of the parameters of the attempt that came farthest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Move {
    /// Landmarks near enough to leave the gaps of the points open, in neighborhoods that are smaller by as much: as large as before they
    /// would see the other side of a hole.
    Opened,
    /// Both lengths larger, where the points scatter across the surface: what moving them onto fits leaves of that is less in a larger
    /// neighborhood. No other move makes the mesh coarser, as a coarser mesh passes by seeing less; here there is less to be seen.
    Widened,
    /// Larger neighborhoods, landmarks as they were: a coarser mesh passes by seeing less, and is tried only where points
    /// scatter.
    Larger,
    /// Smaller neighborhoods, and landmarks nearer to each other.
    Smaller,
    /// Landmarks nearer to each other in neighborhoods of the same size.
    Finer,
    /// Neighborhoods of their own size at every point.
    Local,
    /// Distances along the surface in the charts, so that they unfold where it bends.
    Unfolded,
    /// The same, every point taken as one of a closed surface that does not cross itself.
    Closed,
    /// The same, distances by paths that keep to one side of a crease until they cross it.
    Creased,
    /// The same as closed, of a surface that may end and does not cross itself.
    Ending,
    /// Every point taken as one of a closed surface that does not cross itself, landmarks and charts by the spacing of the
    /// points, which varies much.
    Spaced,
}

/// Points that the graph of unfolded charts joins each point to: enough to hold a random sample together, and
/// few enough not to join it to the next sheet. On random points of a cube and a slab, landmarks 2.6 and 3.5
/// spacings apart, 7 of 8 runs passed with 20 and 5 of 8 with 10.
const GRAPH: usize = 20;
/// Points that a neighborhood of its own size holds at least.
const LOCAL: usize = 30;
/// Factors on eps, or on both lengths.
const LARGER: f64 = 1.3;
pub(super) const SMALLER: f64 = 0.8;
/// Part of the separation that the gaps of the points ask for that is taken: landmarks lie as chance has it.
pub(crate) const ROOMY: f64 = 0.95;
/// Factor on the separation alone.
const FINER: f64 = 0.75;
/// Spacings of one point in a hundred that are this many times those of another one vary more than one separation
/// suits: landmarks that are near enough where points are dense have none around them where they are sparse. Of
/// surfaces with densities of 30 to 1 (5 times the spacing) all passed with one separation, of 100 to 1 none.
const UNEVEN: f64 = 4.0;
/// Landmarks are at least so many spacings apart: below that a landmark has no points around it.
pub(crate) const CLOSEST: f64 = 1.3;

/// Factor on both lengths where points scatter.
const WIDER: f64 = 1.2;
/// Neighborhoods that scatter asks for at least, in standard deviations: a double bubble with noise of half of dl left 18 stars open at 4
/// of them, and 2 at 10.
const LEAST_WIDE: f64 = 10.0;
/// Widest neighborhoods that scatter asks for, in standard deviations: beyond, what is left of it after the points were moved is
/// not what fails.
const SCATTER: f64 = 25.0;

/// What is known of the points when a move is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known<'k> {
    pub(super) density: &'k Density,
    /// The separation below which the attempt would have left the gaps of the points open, where it did not.
    pub(super) needed: Option<f64>,
    /// Standard deviation of the points across the surface, where they scatter.
    pub(super) noise: Option<f64>,
}

impl Move {
    /// Why it is tried, in a few words.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Opened => "landmarks near enough to leave the gaps open",
            Self::Widened => "larger neighborhoods, as the points scatter",
            Self::Larger => "larger neighborhoods",
            Self::Smaller => "smaller neighborhoods, where the surface bends less",
            Self::Finer => "landmarks nearer to each other",
            Self::Local => "neighborhoods of their own size at every point",
            Self::Unfolded => "charts by distances along the surface, which unfold where it bends",
            Self::Closed => {
                "every point taken as one of a closed surface that does not cross itself, charts by distances along it"
            }
            Self::Creased => {
                "distances along the surface by paths that do not leave it at a crease"
            }
            Self::Ending => {
                "every point taken as one of a surface that may end and does not cross itself, charts by distances along it"
            }
            Self::Spaced => {
                "every point taken as one of a closed surface that does not cross itself, all lengths in the spacing of the points"
            }
        }
    }

    /// Parameters `from` an earlier attempt with this change; nothing where what is pinned forbids it, the points are
    /// too few for it, what it goes by is not known, or it changes nothing.
    pub(super) fn apply(
        self,
        from: &Parameters,
        pinned: &Pinned,
        known: &Known<'_>,
    ) -> Option<Parameters> {
        let density = known.density;
        let least = match self {
            // Landmarks do not come nearer.
            Self::Widened => 0.0,
            Self::Spaced => density.spacing,
            _ if from.spaces.metric == MetricName::Conformal => density.spacing,
            _ => density.dense,
        };
        match self {
            Self::Opened => opened(from, pinned, known.needed?),
            Self::Widened => widened(from, pinned, known.noise?),
            Self::Larger => scaled(from, pinned, LARGER, 1.0),
            Self::Smaller => scaled(from, pinned, SMALLER, SMALLER),
            Self::Finer => scaled(from, pinned, 1.0, FINER),
            Self::Local if pinned.neighborhoods.is_none() && !from.surface => Some(Parameters {
                spaces: Spaces {
                    neighborhoods: Neighborhoods::Adaptive(LOCAL),
                    ..from.spaces.clone()
                },
                ..from.clone()
            }),
            Self::Unfolded
                if pinned.tri_metric.is_none()
                    && pinned.metric.is_none()
                    && from.spaces.metric == MetricName::Euclidean =>
            {
                Some(Parameters {
                    spaces: Spaces {
                        tri_metric: Some(MetricName::Geodesic),
                        graph: graph(pinned),
                        planes: pinned.planes.unwrap_or(true),
                        ..from.spaces.clone()
                    },
                    ..from.clone()
                })
            }
            Self::Closed => one_surface(from, pinned, ModelName::TwoPlanes),
            Self::Creased => creased(from, pinned),
            Self::Ending => one_surface(from, pinned, ModelName::Boundary),
            Self::Spaced => spaced(from, pinned, density),
            _ => None,
        }
        .filter(|found| found.dl >= CLOSEST * least && found.check().is_ok() && found != from)
    }
}

/// Both lengths by one factor, so that the separation is below the `needed` one.
fn opened(from: &Parameters, pinned: &Pinned, needed: f64) -> Option<Parameters> {
    let factor = ROOMY * needed / from.dl;
    (factor < 1.0).then(|| scaled(from, pinned, factor, factor))?
}

/// Both lengths by one factor, where points scatter by `noise`.
fn widened(from: &Parameters, pinned: &Pinned, noise: f64) -> Option<Parameters> {
    let factor = (LEAST_WIDE * noise / from.eps).max(WIDER);
    scaled(from, pinned, factor, factor).filter(|next| next.eps <= SCATTER * noise)
}

/// Whether every point may be taken as one of a surface, with distances along it.
fn is_free(pinned: &Pinned) -> bool {
    pinned.metric.is_none()
        && pinned.tri_metric.is_none()
        && pinned.neighborhoods.is_none()
        && pinned.models.is_none()
        && pinned.surface != Some(false)
}

/// The same on one closed surface, lengths in the spacing of the points where that varies much: separations are as many
/// spacings everywhere as they are where the spacing is the usual one.
fn spaced(from: &Parameters, pinned: &Pinned, density: &Density) -> Option<Parameters> {
    let uneven = density.sparse > UNEVEN * density.dense;
    let lengths = pinned.eps.is_none() && pinned.dl.is_none() && pinned.tri_eps.is_none();
    let free = is_free(pinned) && lengths && pinned.boundary.is_empty();
    (uneven && free).then(|| {
        let eps = three_digits(density.usual_reach);
        let one = pinned.parameters(eps, pinned.lengths(&density.even()).0[1]);
        Parameters {
            seed: from.seed,
            surface: true,
            models: vec![ModelName::TwoPlanes],
            spaces: Spaces {
                metric: MetricName::Conformal,
                graph: graph(pinned),
                ..one.spaces.clone()
            },
            ..one
        }
    })
}

/// Every point on one surface, distances along it; of the models only a boundary is looked for.
fn one_surface(first: &Parameters, pinned: &Pinned, model: ModelName) -> Option<Parameters> {
    let along = first.spaces.metric != MetricName::Conformal;
    (along && is_free(pinned)).then(|| Parameters {
        surface: true,
        models: vec![model],
        spaces: Spaces {
            metric: MetricName::Geodesic,
            graph: graph(pinned),
            planes: pinned.planes.unwrap_or(true),
            ..first.spaces.clone()
        },
        ..first.clone()
    })
}

/// The same with a graph that joins points of one sheet alone, where distances go along one surface.
fn creased(from: &Parameters, pinned: &Pinned) -> Option<Parameters> {
    let along = from.surface && from.spaces.metric == MetricName::Geodesic;
    (along && pinned.sheets.is_none()).then(|| Parameters {
        spaces: Spaces {
            sheets: true,
            ..from.spaces.clone()
        },
        ..from.clone()
    })
}

fn graph(pinned: &Pinned) -> EdgeRule {
    pinned.graph.unwrap_or(EdgeRule::Nearest(GRAPH))
}

/// Both lengths times their factors, where they may be moved; the tolerances go with eps.
fn scaled(first: &Parameters, pinned: &Pinned, eps: f64, dl: f64) -> Option<Parameters> {
    let new = |pinned: Option<f64>, old: f64, factor: f64| {
        pinned.unwrap_or_else(|| three_digits(old * factor))
    };
    let (eps, dl) = (
        new(pinned.eps, first.eps, eps),
        new(pinned.dl, first.dl, dl),
    );
    if (eps, dl) == (first.eps, first.dl) || dl > eps {
        return None;
    }
    let changed = pinned.parameters(eps, dl);
    Some(Parameters {
        dp: changed.dp,
        ep: changed.ep,
        eps,
        dl,
        ..first.clone()
    })
}

/// The same with other landmarks, the so-many-th time from 1: another seed, or where that is pinned a separation that is
/// a little smaller.
pub(super) fn other_landmarks(of: &Parameters, pinned: &Pinned, time: usize) -> Option<Parameters> {
    match (pinned.seed, pinned.dl) {
        (None, _) => Some(Parameters {
            seed: of.seed.wrapping_add(time as u64),
            ..of.clone()
        }),
        (Some(_), None) => Some(Parameters {
            dl: three_digits(OTHER.get(time - 1)? * of.dl),
            ..of.clone()
        }),
        _ => None,
    }
}

/// Factors on the separation, one time after another, that give other landmarks and hardly another mesh.
const OTHER: [f64; 5] = [0.95, 0.975, 0.925, 0.9625, 0.9375];
