//! Where a reconstruction failed, gathered from its stages.

use super::kind::FaultKind;
use crate::pipeline::Outcome;
use crosscap_algorithms::certificate::{Place, Violation, ViolationKind};
use crosscap_core::{Error, Mesh};

/// Something that failed at a place.
pub(super) struct Trouble {
    /// Row of the input, where it is one.
    pub row: Option<usize>,
    /// Coordinates, empty where they are not known.
    pub coordinates: Vec<f64>,
    /// What it is, where the stage that failed knows.
    pub kind: Option<FaultKind>,
    /// How bad it is: see [`super::Fault::measure`].
    pub measure: Option<f64>,
    /// How many places it stands for.
    pub count: usize,
    /// What the stage said.
    pub detail: String,
}

/// Open stars that are looked at, at most.
const STARS: usize = 60;

/// Everything that failed.
pub(super) fn troubles(outcome: &Result<Outcome, Error>) -> Vec<Trouble> {
    match outcome {
        Err(error) => vec![of_error(error)],
        Ok(outcome) => {
            let stars = outcome.failures.iter().map(of_error);
            let mut all: Vec<Trouble> = stars.take(STARS).collect();
            let listed = all.len();
            for (k, star) in all.iter_mut().enumerate() {
                star.count = part(outcome.failures.len(), listed, k);
            }
            let violations = outcome.certificate.violations();
            all.extend(violations.flat_map(|v| of_violation(v, &outcome.mesh)));
            all
        }
    }
}

/// How many of `total` places the k-th of those that are listed stands for: about as many as each other one, since what one place looks like
/// says nothing of all.
fn part(total: usize, listed: usize, k: usize) -> usize {
    total * (k + 1) / listed - total * k / listed
}

fn of_error(error: &Error) -> Trouble {
    let (row, kind, measure, count) = match error {
        Error::SparseNeighborhood {
            point,
            found,
            needed,
            ..
        } => {
            let wanted = enough(*needed as f64) / (*found).max(1) as f64;
            (Some(*point), Some(FaultKind::TooFewPoints), Some(wanted), 1)
        }
        Error::Dimension { point, count, .. } => (Some(*point), None, None, *count),
        Error::Triangulation { point, .. } => (*point, None, None, 1),
        Error::Law { point, .. } => (Some(*point), None, None, 1),
        _ => (None, None, None, 1),
    };
    Trouble {
        row,
        coordinates: Vec::new(),
        kind,
        measure,
        count,
        detail: match error {
            Error::Triangulation { reason, .. } => reason.clone(),
            _ => String::new(),
        },
    }
}

/// Points that a neighborhood holds in the mean so that all of many hold as many as are `needed`: four standard deviations
/// more.
fn enough(needed: f64) -> f64 {
    (2.0 + (4.0 + needed).sqrt()).powi(2)
}

/// One trouble for each place of a violation that is listed; they stand for those that are not as well.
fn of_violation<'a>(
    violation: &'a Violation,
    mesh: &'a Mesh,
) -> impl Iterator<Item = Trouble> + 'a {
    let kind = match violation.kind {
        ViolationKind::UncoveredPoints | ViolationKind::UnusedLandmarks => {
            Some(FaultKind::Outliers)
        }
        ViolationKind::UndeclaredBoundary | ViolationKind::BoundaryOfClosed => {
            Some(FaultKind::Ends)
        }
        ViolationKind::InadmissibleLink
        | ViolationKind::SplitLink
        | ViolationKind::Pinch
        | ViolationKind::TouchingParts => Some(FaultKind::Unclaimed),
        ViolationKind::BridgedGap | ViolationKind::BareStretch => Some(FaultKind::Gap),
        ViolationKind::UndecidedEnd => Some(FaultKind::OpenEnd),
        ViolationKind::MergedSheets => Some(FaultKind::Merged),
        _ => None,
    };
    let told = matches!(kind, Some(FaultKind::Gap | FaultKind::Merged));
    let detail = if told {
        &violation.detail
    } else {
        violation.kind.meaning()
    };
    let places = violation.places.len().max(1);
    let total = violation.count.max(places);
    let whole = violation.places.is_empty().then_some(None);
    let listed = violation.places.iter().map(|&place| Some(place));
    let all = listed.chain(whole).enumerate();
    all.map(move |(k, place)| Trouble {
        row: place.and_then(|place| row(place, mesh)),
        coordinates: if k == 0 {
            violation.coordinates.clone()
        } else {
            Vec::new()
        },
        kind,
        measure: None,
        count: part(total, places, k),
        detail: detail.into(),
    })
}

/// The row of the input that a place of the mesh stands for.
fn row(place: Place, mesh: &Mesh) -> Option<usize> {
    let triangle = |t: u32| mesh.complex.triangles.get(t as usize).map(|t| t[0]);
    let vertex = match place {
        Place::Point(row) => return Some(row),
        Place::Vertex(v) | Place::Vertices([v, _]) | Place::Edge([v, _]) => Some(v),
        Place::Triangle(t) | Place::Triangles([t, _]) => triangle(t),
        Place::CurveEdge(e) => mesh.complex.curve_edges.get(e as usize).map(|e| e.ends[0]),
    };
    let row = *mesh.point_index.get(vertex? as usize)?;
    usize::try_from(row).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listed_places_stand_for_all_in_equal_parts() {
        for (total, listed) in [(7, 7), (150, 60), (1, 1), (61, 60)] {
            let parts: Vec<usize> = (0..listed).map(|k| part(total, listed, k)).collect();
            assert_eq!(parts.iter().sum::<usize>(), total);
            let (least, most) = (parts.iter().min().unwrap(), parts.iter().max().unwrap());
            assert!(*least > 0 && most - least < 2, "{parts:?}");
        }
    }
}
