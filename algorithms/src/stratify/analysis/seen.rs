//! What a look at one ball says of its center, as a value that can be sent to whoever has not got the ball.

use super::explain::{Kind, Verdict};
use super::fitter::Scratch;
use super::{AnalysisOptions, Analyzer, ModelCounts};
use crate::stratify::site::{On, Witness};
use crosscap_core::{Error, Row, Scalar, Table};
use serde::{Deserialize, Serialize};

/// What a 2-dimensional ball shows beside a sheet that goes on: a boundary, a curve, a point.
///
/// A look depends on the points of the ball alone. So balls may be looked at where their points are, and what they show is known
/// elsewhere without them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    center: Center,
    /// The 0-stratum close by.
    apex: Option<On>,
}

/// Where the center of a ball is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Center {
    /// Inside a cell, far from what is in the ball.
    Inside,
    /// Inside a cell beside a stratum.
    Beside(On),
    /// On a stratum.
    On(On),
    /// Nowhere that a model explains.
    Unexplained,
}

impl Seen {
    /// What a verdict says; `None` where that is a sheet alone.
    fn of(verdict: Verdict) -> Option<Self> {
        let center = match verdict.kind {
            Kind::Regular => Center::Inside,
            Kind::Unexplained => Center::Unexplained,
            Kind::Near(witness) => Center::Beside(witness.on),
            Kind::Singular(witness) => Center::On(witness.on),
        };
        let apex = verdict.apex.map(|witness| witness.on);
        (center != Center::Inside || apex.is_some()).then_some(Self { center, apex })
    }

    /// The verdict on a row that is the center.
    pub(super) fn verdict(&self, row: Row) -> Verdict {
        let witness = |on: &On| Witness {
            row,
            on: on.clone(),
        };
        Verdict {
            kind: match &self.center {
                Center::Inside => Kind::Regular,
                Center::Unexplained => Kind::Unexplained,
                Center::Beside(on) => Kind::Near(witness(on)),
                Center::On(on) => Kind::Singular(witness(on)),
            },
            apex: self.apex.as_ref().map(witness),
        }
    }
}

/// What was seen in some balls.
pub(crate) struct Looks {
    /// What the balls show that show more than a sheet, by row.
    pub(crate) seen: Vec<(Row, Seen)>,
    /// What became of the models.
    pub(crate) models: Vec<ModelCounts>,
}

impl<S: Scalar> Analyzer<'_, S> {
    /// What the models that ask for 2-dimensional balls see in those about the `wanted` rows, all of which are 2-dimensional. No boundary is
    /// given.
    ///
    /// # Errors
    /// [`Error::Shape`] for points without coordinates, [`Error::Law`] for what a model breaks.
    pub(crate) fn look_at_sheets(
        &self,
        options: &AnalysisOptions,
        wanted: &Table<Row, bool>,
    ) -> Result<Looks, Error> {
        let fitter = self.fitter("since curves and boundaries are looked for in them")?;
        let found = self
            .space
            .map(self.execute, Scratch::default, |scratch, i| {
                let row = Row::new(i);
                let look = || fitter.first_look(row, 2, options, false, scratch);
                let verdict = wanted[row].then(look).flatten()?;
                Seen::of(*verdict)
            });
        fitter.faults.none()?;
        let seen = wanted.ids().zip(found);
        let seen = seen.filter_map(|(row, seen)| Some((row, seen?)));
        Ok(Looks {
            seen: seen.collect(),
            models: fitter.counts(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stratify::site::{FitUsed, StratumKind};

    fn on(kind: StratumKind) -> On {
        On {
            kind,
            place: Some(Box::new([0.25, -1.0])),
            moved: 0.125,
            fit: Some(FitUsed {
                model: 1,
                radius: 0.5,
            }),
            cells: 3,
        }
    }

    #[test]
    fn a_verdict_comes_back_for_its_row() {
        let row = Row::new(7);
        let witness = |kind| Witness { row, on: on(kind) };
        let kinds: [fn(Witness) -> Kind; 4] = [
            Kind::Near,
            Kind::Singular,
            |_| Kind::Regular,
            |_| Kind::Unexplained,
        ];
        for kind in kinds {
            for apex in [None, Some(witness(StratumKind::Point))] {
                let verdict = || Verdict {
                    kind: kind(witness(StratumKind::Boundary)),
                    apex: apex.clone(),
                };
                let told = format!("{:?}", verdict());
                match Seen::of(verdict()) {
                    Some(seen) => assert_eq!(format!("{:?}", seen.verdict(row)), told),
                    None => assert_eq!(told, format!("{:?}", Verdict::REGULAR)),
                }
            }
        }
    }
}
