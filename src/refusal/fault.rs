//! What went wrong, by kind.

use super::kind::FaultKind;
use super::places::{Trouble, troubles};
use super::surroundings::{Look, Surroundings};
use crate::auto::Doubt;
use crate::pipeline::Outcome;
use crosscap_algorithms::singularity::Tangency;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{Error, PointCloud};
use serde::Serialize;
use std::fmt;

/// A place in the data.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Spot {
    /// Row of the input, where it is one.
    pub row: Option<usize>,
    /// Coordinates, unit of the data.
    pub coordinates: Vec<f64>,
    /// Spacing of the points there, unit of the data; none where points are not at hand.
    pub spacing: Option<f64>,
}

/// One kind of thing that went wrong.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Fault {
    /// The kind.
    pub kind: FaultKind,
    /// In how many places.
    pub count: usize,
    /// The worst place.
    pub worst: Option<Spot>,
    /// How bad it is there: in local spacings for noise, how many times as many points are wanted for curvature
    /// and too few points; for sheets that touch in a point the distance from it beyond which they are apart, unit of the data.
    pub measure: Option<f64>,
    /// What was seen, in words.
    pub detail: String,
    /// Rows of the input at its places, the first [`Fault::ROWS`].
    pub rows: Vec<usize>,
}

impl Fault {
    /// Rows that are listed.
    pub const ROWS: usize = 60;
}

/// The faults of an outcome that is not handed over: sheets that touch first, then those with a known cause, and of these those
/// of most places.
pub(super) fn faults(
    outcome: &Result<Outcome, Error>,
    doubt: Option<&Doubt>,
    points: Option<&PointCloud<f64>>,
) -> Vec<Fault> {
    let mut faults: Vec<Fault> = Vec::new();
    if let Some(doubt) = doubt {
        faults.push(Fault {
            kind: match doubt {
                Doubt::TwoReadings(..) => FaultKind::TwoReadings,
                Doubt::Unconfirmed(_) => FaultKind::Unconfirmed,
                Doubt::Rounded(_) => FaultKind::Precision,
            },
            count: 1,
            worst: None,
            measure: None,
            detail: doubt.to_string(),
            rows: Vec::new(),
        });
    }
    // Points too large for the tree were refused before.
    let oracle = points.and_then(|points| EuclideanOracle::new(points.clone()).ok());
    for trouble in troubles(outcome) {
        let found = judged(&trouble, oracle.as_ref());
        match faults.iter_mut().find(|fault| fault.kind == found.kind) {
            None => faults.push(found),
            Some(known) => {
                known.count += found.count;
                let room = Fault::ROWS.saturating_sub(known.rows.len());
                known.rows.extend(found.rows.iter().take(room));
                if found.measure > known.measure {
                    known.worst = found.worst;
                    known.measure = found.measure;
                }
            }
        }
    }
    // No mesh shows sheets that touch, whatever else is wrong with this one; and a star that stays open says nothing where something
    // else says why.
    faults.sort_by_key(|fault| {
        let rank = match fault.kind {
            kind if kind.is_of_the_whole() => 0,
            FaultKind::Touching => 1,
            FaultKind::Unresolved => 3,
            _ => 2,
        };
        (rank, std::cmp::Reverse(fault.count))
    });
    faults
}

/// Spacings on either sheet that sheets have to be apart next to a place where they touched: eps is four to five spacings where the program
/// chooses it, and with 4.5 one of four clouds was refused, with 6 none.
const APART: f64 = 6.0;

/// The fault that a trouble is, by how the points lie there.
fn judged(trouble: &Trouble, oracle: Option<&EuclideanOracle<f64>>) -> Fault {
    if let Some(touching) = touching(trouble, oracle) {
        return touching;
    }
    let around = trouble
        .row
        .zip(oracle)
        .and_then(|(row, oracle)| Surroundings::of(oracle, row));
    let (kind, measure) = match (trouble.kind, around.map(|a| (a, a.look()))) {
        (
            Some(
                kind @ (FaultKind::TooFewPoints
                | FaultKind::OpenEnd
                | FaultKind::Gap
                | FaultKind::Merged),
            ),
            _,
        ) => (kind, trouble.measure),
        (_, Some((_, Look::Alone))) => (FaultKind::Outliers, trouble.measure),
        (_, Some((a, Look::Bent))) => (FaultKind::Curvature, Some(a.wanted())),
        (_, Some((a, Look::Edged))) => (FaultKind::Edge, Some(a.thickness / a.spacing)),
        (_, Some((a, Look::Noisy))) => (FaultKind::Noise, Some(a.thickness / a.spacing)),
        (_, Some((a, Look::Solid))) => (FaultKind::Dimension, Some(a.growth)),
        (_, Some((a, Look::Meeting))) => (FaultKind::Unclaimed, Some(a.thickness / a.spacing)),
        (Some(kind), _) => (kind, trouble.measure),
        (None, _) => (FaultKind::Unresolved, trouble.measure),
    };
    Fault {
        kind,
        count: trouble.count,
        worst: (trouble.row.is_some() || !trouble.coordinates.is_empty()).then(|| Spot {
            row: trouble.row,
            coordinates: trouble.row.zip(oracle).map_or_else(
                || trouble.coordinates.clone(),
                |(row, oracle)| oracle.cloud().point(row).to_vec(),
            ),
            spacing: around.map(|a| a.spacing),
        }),
        measure,
        detail: trouble.detail.clone(),
        rows: trouble.row.into_iter().collect(),
    }
}

/// The fault that a trouble is where sheets touch: what goes wrong there comes of that.
fn touching(trouble: &Trouble, oracle: Option<&EuclideanOracle<f64>>) -> Option<Fault> {
    let (row, oracle) = trouble.row.zip(oracle)?;
    if matches!(
        trouble.kind,
        Some(FaultKind::TooFewPoints | FaultKind::OpenEnd | FaultKind::Gap | FaultKind::Outliers)
    ) {
        return None;
    }
    let found = Tangency::near(oracle.cloud(), oracle, row)?;
    Some(Fault {
        kind: FaultKind::Touching,
        count: trouble.count,
        measure: found.apart(APART * found.spacing),
        worst: Some(Spot {
            row: Some(found.row),
            coordinates: found.place,
            spacing: Some(found.spacing),
        }),
        detail: trouble.detail.clone(),
        rows: vec![row],
    })
}

/// Coordinates that are written out.
const SHOWN: usize = 6;

impl fmt::Display for Spot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown: Vec<String> = (self.coordinates.iter().take(SHOWN))
            .map(|x| format!("{x:.4}"))
            .collect();
        let more = if self.coordinates.len() > SHOWN {
            ", .."
        } else {
            ""
        };
        match self.row {
            // Whoever has no points at hand knows no coordinates.
            Some(row) if shown.is_empty() => write!(f, "row {row}"),
            Some(row) => write!(f, "row {row} ({}{more})", shown.join(", ")),
            None => write!(f, "({}{more})", shown.join(", ")),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.meaning())?;
        match (self.kind, self.measure) {
            (FaultKind::Noise, Some(m)) => write!(f, ", by up to {m:.1} of their spacing")?,
            (FaultKind::Curvature | FaultKind::TooFewPoints, Some(m)) if m > 1.0 => {
                write!(f, ", about {m:.1} times as many would do")?;
            }
            _ => {}
        }
        if !self.kind.is_of_the_whole() {
            let plural = if self.count == 1 { "place" } else { "places" };
            write!(f, ": {} {plural}", self.count)?;
        }
        if let Some(worst) = &self.worst {
            write!(f, ", the worst at {worst}")?;
            if let Some(spacing) = worst.spacing {
                write!(f, ", where points are {spacing:.3e} apart")?;
            }
        }
        if self.detail.is_empty() {
            Ok(())
        } else {
            write!(f, " ({})", self.detail)
        }
    }
}
