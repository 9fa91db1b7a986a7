//! What to do about it.

use super::fault::{Fault, Spot};
use super::kind::FaultKind;
use crate::auto::{CLOSEST, ROOMY, Topology};
use crate::pipeline::{Outcome, Parameters};
use crate::spaces::MetricName;
use crosscap_algorithms::certificate::ViolationKind;
use crosscap_algorithms::singularity::ModelName;
use crosscap_core::Error;
use serde::Serialize;
use std::fmt;

/// The best thing to do about a refusal.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Advice {
    /// Other parameters, which were tried and give a verified mesh.
    Parameters(Box<Parameters>, Topology),
    /// So many points in all, spread like those that are there.
    MorePoints(usize),
    /// So many points in all, or to say that the surface has no hole as narrow as the gaps of the points, if that is known: nothing
    /// else is wrong with the mesh.
    DenserOrNoHole {
        /// Points in all.
        points: usize,
        /// Width of the narrowest hole with which the mesh is verified, in local spacings.
        least_hole: f64,
    },
    /// Less noise, or a coarser mesh than this landmark separation gives.
    LessNoise {
        /// The landmark separation that was tried, unit of the data.
        dl: Option<f64>,
    },
    /// Leave out the points around these places, or the coordinates that are none.
    FewerDimensions,
    /// Coordinates with more digits, or nearer to the origin.
    MoreDigits,
    /// Leave points out.
    LeaveOut {
        /// Their rows, the first few.
        rows: Vec<usize>,
    },
    /// Tell where the surface ends.
    Boundary,
    /// Landmarks so near to each other that what the points leave apart stays apart.
    CloserLandmarks {
        /// Their separation, unit of the data.
        dl: f64,
    },
    /// The sheets as clouds of their own, or without the points about the place where they touch.
    Separate {
        /// The place, unit of the data.
        place: Spot,
        /// The distance from it beyond which the sheets are apart, unit of the data; none where they touch along a curve.
        radius: Option<f64>,
    },
    /// More points where sheets meet, where a model knows what meets there; a model of one's own, or the parts as clouds of their own, where none does.
    Model,
    /// More points where a curve ends, or, where it ends on a boundary or an edge, the curve as a cloud of its own.
    EndOfCurve,
    /// All models, where not all were asked.
    AllModels,
    /// More attempts.
    MoreTries,
}

/// How many times as many points are asked for at least.
const LEAST_INCREASE: f64 = 1.5;
/// How many times as many points decide between two readings: what is open by chance, some four spacings wide, is seven spacings
/// wide then. A plate with such a hole was right with them for 3 seeds of 3, with twice as many for 1.
const DECIDING: f64 = 3.0;

impl Advice {
    /// What to do about faults, by the one of most places. On so many `points`, where they are known, the parameters of `tried`
    /// were tried, and the faults are those of the `chosen` ones.
    pub(super) fn on(
        faults: &[Fault],
        outcome: &Result<Outcome, Error>,
        points: Option<usize>,
        tried: &[&Parameters],
        chosen: usize,
    ) -> Self {
        let report = outcome.as_ref().ok().map(|outcome| &outcome.report);
        let parameters = tried.get(chosen).copied();
        let parameters = parameters.or(report.map(|report| &report.parameters));
        let Some(first) = faults.first() else {
            return Self::MoreTries;
        };
        let more = |times: f64| {
            let count = points.or(report.map(|report| report.points));
            Self::MorePoints((count.unwrap_or(0) as f64 * times.max(LEAST_INCREASE)) as usize)
        };
        let meets = matches!(
            first.kind,
            FaultKind::Unclaimed | FaultKind::Edge | FaultKind::Dimension
        );
        // What is so nearly everywhere is no place where sheets meet.
        let local = points.is_none_or(|points| 2 * first.count < points);
        let mut runs = tried.iter().copied().chain(parameters).peekable();
        // Nor can they be asked where lengths are in the spacing of the points.
        let closed = |run: &Parameters| run.spaces.uses(MetricName::Conformal);
        let asked_all =
            runs.peek().is_none() || runs.any(|run| run.models == ModelName::AUTO || closed(run));
        if meets && local && !asked_all {
            return Self::AllModels;
        }
        match first.kind {
            FaultKind::Curvature | FaultKind::TooFewPoints => more(first.measure.unwrap_or(2.0)),
            FaultKind::TwoReadings => more(DECIDING),
            FaultKind::Precision => Self::MoreDigits,
            FaultKind::Noise => Self::LessNoise {
                dl: parameters.map(|run| run.dl),
            },
            FaultKind::Dimension => Self::FewerDimensions,
            FaultKind::Touching => match &first.worst {
                Some(place) => Self::Separate {
                    place: place.clone(),
                    radius: first.measure,
                },
                None => Self::Model,
            },
            FaultKind::Unclaimed | FaultKind::Edge => Self::Model,
            FaultKind::OpenEnd => Self::EndOfCurve,
            FaultKind::Outliers => Self::LeaveOut {
                rows: first.worst.iter().filter_map(|spot| spot.row).collect(),
            },
            FaultKind::Ends => Self::Boundary,
            FaultKind::Gap | FaultKind::Merged => match apart(outcome) {
                Some((dl, spacing)) if dl > CLOSEST * spacing => Self::CloserLandmarks { dl },
                Some((dl, spacing)) => {
                    let denser = more((wanted(first.kind) * spacing / dl).powi(2));
                    denser.or_no_hole(outcome)
                }
                None => more(2.0),
            },
            FaultKind::Unresolved | FaultKind::Unconfirmed => Self::MoreTries,
        }
    }
}

/// Width of gaps is told in tenths of a spacing, and asked for in as many above it.
const TENTHS: f64 = 10.0;

impl Advice {
    /// The same, or to say that there is no such hole, where gaps are all that is wrong.
    fn or_no_hole(self, outcome: &Result<Outcome, Error>) -> Self {
        match (self, outcome.as_ref().ok().and_then(widest_gap)) {
            (Self::MorePoints(points), Some(widest)) => Self::DenserOrNoHole {
                points,
                least_hole: (widest * TENTHS).floor() / TENTHS + 1.0 / TENTHS,
            },
            (denser, _) => denser,
        }
    }
}

/// The widest of the gaps that a mesh covers, in local spacings, where nothing else is wrong with it.
fn widest_gap(outcome: &Outcome) -> Option<f64> {
    let mut violations = outcome.certificate.violations();
    let gaps_only = violations.all(|v| v.kind == ViolationKind::BridgedGap);
    let told = outcome.certificate.faithful.as_ref()?;
    told.widest_bridged
        .filter(|_| gaps_only && outcome.failures.is_empty())
}

/// Spacings of the points that landmarks are apart where the program chooses them; more where neighborhoods, which are twice as
/// wide, have to be within the distance of two sheets.
fn wanted(kind: FaultKind) -> f64 {
    if kind == FaultKind::Merged { 5.0 } else { 2.5 }
}

/// The landmark separation that keeps apart what the points leave apart, and their spacing.
fn apart(outcome: &Result<Outcome, Error>) -> Option<(f64, f64)> {
    let faithful = outcome.as_ref().ok()?.certificate.faithful.as_ref()?;
    Some((ROOMY * faithful.separation_needed?, faithful.spacing[1]))
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameters(found, topology) => write!(
                f,
                "with eps {} and dl {} it is verified: {topology}",
                found.eps, found.dl
            ),
            Self::MorePoints(0) => f.write_str("sample more densely"),
            Self::MorePoints(count) => {
                write!(f, "sample more densely: about {count} points in all would do")
            }
            Self::DenserOrNoHole { points, least_hole } => {
                write!(f, "{}; or, if you know that the surface has no hole narrower than {least_hole:.1} spacings of the points, say so \
                    (--least-hole {least_hole:.1})", Self::MorePoints(*points))
            }
            Self::LessNoise { dl: Some(dl) } => write!(
                f,
                "measure with less noise, or give a landmark separation above dl = {dl} (--dl)"
            ),
            Self::LessNoise { dl: None } => {
                f.write_str("measure with less noise, or give a larger landmark separation (--dl)")
            }
            Self::FewerDimensions => f.write_str(
                "leave out the points there, or the columns that are no coordinates: the points are those of no surface",
            ),
            Self::MoreDigits => f.write_str(
                "subtract the coordinates of a place among the points before they are rounded to 32 bits, or write 64 bits",
            ),
            Self::LeaveOut { rows } => {
                let rows: Vec<String> = rows.iter().map(usize::to_string).collect();
                write!(
                    f,
                    "leave out points that lie by themselves (row {}), or let that be done (--prepare yes)",
                    rows.join(", ")
                )
            }
            Self::Boundary => {
                f.write_str("say where the surface ends (--boundary), or let it be found (--models auto)")
            }
            Self::CloserLandmarks { dl } => write!(
                f,
                "give a landmark separation of {dl:.3e} (--dl), so that what the points leave apart stays apart"
            ),
            Self::Separate { place, radius } => {
                f.write_str("give each sheet as a cloud of its own")?;
                if let Some(radius) = radius {
                    write!(
                        f,
                        ", or leave out the points nearer than {radius:.3e} to {place}, which leaves a hole in either sheet"
                    )?;
                }
                f.write_str("; no mesh that this program makes shows sheets that touch")
            }
            Self::AllModels => f.write_str("let all models compete (--models auto)"),
            Self::Model => f.write_str(
                "sample more densely there if it is an edge between two faces, a corner of such faces, or in the guide's list of singularity models; anything else, as a wall \
                that ends at an edge, needs a model of its own, or the parts that meet there as clouds of their own",
            ),
            Self::EndOfCurve => f.write_str(
                "sample the end of the curve and what is ahead of it more densely; if it ends on a boundary or an edge no model knows the place: give the curve \
                as a cloud of its own then",
            ),
            Self::MoreTries => f.write_str("allow more attempts (--tries), or give dl (--dl)"),
        }
    }
}
