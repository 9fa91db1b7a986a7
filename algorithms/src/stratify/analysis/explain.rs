//! What a point is, by the fit that explains its neighborhood best.

use super::competition::{Contender, Rules};
use super::fitter::{Fitter, Scratch, View};
use super::options::AnalysisOptions;
use crate::singularity::OneSheet;
use crate::stratify::site::{FitUsed, On, StratumKind, Witness};
use crosscap_core::{Located, Neighbor, Row, Scalar, SingularityModel, squared_distance};

/// What one point turned out to be.
#[derive(Debug)]
pub(super) struct Verdict {
    pub(super) kind: Kind,
    pub(super) apex: Option<Witness>,
}

impl Verdict {
    pub(super) const UNEXPLAINED: Self = Self {
        kind: Kind::Unexplained,
        apex: None,
    };
    pub(super) const REGULAR: Self = Self {
        kind: Kind::Regular,
        apex: None,
    };

    pub(super) fn is_unexplained(&self) -> bool {
        matches!(self.kind, Kind::Unexplained)
    }
}

#[derive(Debug)]
pub(super) enum Kind {
    Regular,
    Unexplained,
    Near(Witness),
    Singular(Witness),
}

/// What becomes of a ball of one size.
enum Outcome {
    Explained(Verdict, Vec<Option<Verdict>>),
    /// A smaller one may do better.
    Shrink,
    /// A smaller one has too few points.
    GiveUp,
}

/// A row whose ball is to be explained.
struct Question<'q> {
    row: Row,
    /// Rows that the fit speaks for as well, where they are close enough.
    others: &'q [Row],
    dimension: usize,
}

impl<S: Scalar> Fitter<'_, S> {
    /// Lets the models compete, at smaller and smaller radii: a radius at which the sheets
    /// bend too much for any model is too large there, whatever it is elsewhere.
    ///
    /// The fit speaks for the rows `others` as well, where they are close enough: `None` for those that
    /// it says nothing about.
    pub(super) fn explain(
        &self,
        i: Row,
        others: &[Row],
        dimension: usize,
        options: &AnalysisOptions,
        scratch: &mut Scratch<S>,
    ) -> (Verdict, Vec<Option<Verdict>>) {
        let tuning = &self.tuning.analysis;
        let mut radius = options.radius(i);
        let mut question = Question {
            row: i,
            others,
            dimension,
        };
        for shrunk in 0..=tuning.shrinks {
            let Some(mut view) = self.view(i, radius, radius, scratch) else {
                break;
            };
            view.lean = true;
            if shrunk > 0 {
                // A smaller ball of a crossing may pass for a sheet; models decide.
                question.dimension = match self.dimension_of(i, &view) {
                    None => question.dimension,
                    Some(0 | 1) => 1,
                    Some(more) => more.max(3),
                };
            }
            match self.explain_ball(&question, &view, scratch) {
                Outcome::Explained(own, kinds) => return (own, kinds),
                Outcome::Shrink if view.within >= 2 * tuning.least_neighbors => {
                    radius *= tuning.shrink;
                }
                Outcome::Shrink | Outcome::GiveUp => break,
            }
        }
        (Verdict::UNEXPLAINED, Vec::new())
    }

    fn explain_ball(
        &self,
        question: &Question<'_>,
        view: &View,
        scratch: &mut Scratch<S>,
    ) -> Outcome {
        let Question {
            row: i,
            others,
            dimension,
        } = *question;
        let tuning = &self.tuning.analysis;
        scratch.near.extend(others.iter().map(|row| Neighbor {
            index: row.index(),
            distance: S::zero(),
        }));
        let plain = match OneSheet.decompose(&self.local(view, &OneSheet, scratch)) {
            Ok(fit) => fit.residual,
            // A curve needs fewer points than a sheet, and is not compared with one.
            Err(_) if dimension == 1 => f64::INFINITY,
            Err(_) => return Outcome::GiveUp,
        };
        let rules = Rules {
            takes_part: &|model| {
                model.applies_to(dimension)
                    && !model.finds_boundary()
                    && !view.frame.spreads_beyond(model.local_dimension())
            },
            // A line is as near to a sheet as to itself.
            explains: &|fit| dimension < 3 || fit.residual < tuning.gain * plain,
        };
        let reach = (tuning.speaks_for * view.radius).powi(2);
        let close = |row: Row| self.square(i, row) < reach;
        if let Some(mut best) = self.compete(i, view, others.len(), &rules, scratch) {
            let located = self.locate(i, view, others.len(), &mut best, scratch);
            let model = self.models[best.model].as_ref();
            let rows = view.added(model, others.len());
            let local = self.local(view, model, scratch);
            let own = best.fit.located(view.center);
            let own = self.verdict(i, &best, view, local.point(view.center), own);
            let kinds = (located.into_iter().zip(others).zip(rows)).map(|((found, &row), k)| {
                let found = found.filter(|_| close(row))?;
                Some(self.verdict(row, &best, view, local.point(k), found))
            });
            return Outcome::Explained(own, kinds.collect());
        }
        let curve = dimension == 1 && self.knows_bare_curves();
        if !curve && plain < tuning.flat * view.radius {
            let kinds = others
                .iter()
                .map(|&row| close(row).then_some(Verdict::REGULAR));
            return Outcome::Explained(Verdict::REGULAR, kinds.collect());
        }
        Outcome::Shrink
    }

    /// What a fit makes of a row, which is at `from` in the coordinates of the model, and the
    /// 0-stratum that it shows near it.
    pub(super) fn verdict(
        &self,
        row: Row,
        best: &Contender,
        view: &View,
        from: &[f64],
        located: Located,
    ) -> Verdict {
        let tuning = &self.tuning.analysis;
        let witness = |kind: StratumKind, to: &[f64], moved: f64, cells: u8| Witness {
            row,
            on: On {
                kind,
                place: Some(self.moved(row, view, from, to)),
                moved,
                fit: (kind != StratumKind::Boundary).then_some(FitUsed {
                    model: best.model as u8,
                    radius: view.radius,
                }),
                cells,
            },
        };
        let apex = best
            .fit
            .points
            .iter()
            .map(|p| (squared_distance(p, from).sqrt(), p))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|&(offset, _)| offset < tuning.apex_reach * view.radius)
            .map(|(offset, p)| witness(StratumKind::Point, p, offset, 0));
        let curve = if self.models[best.model].finds_boundary() {
            StratumKind::Boundary
        } else {
            StratumKind::Curve
        };
        let moved = |kind| witness(kind, &located.place, located.offset, located.cells);
        let kind = match located.dimension {
            0 => Kind::Singular(moved(StratumKind::Point)),
            1 => Kind::Singular(moved(curve)),
            _ if located.offset > tuning.witness_reach * view.radius => Kind::Regular,
            _ => Kind::Near(moved(curve)),
        };
        Verdict { kind, apex }
    }

    /// The place of a row that a fit moves from one place to another, both in the coordinates of the model.
    pub(super) fn moved(&self, row: Row, view: &View, from: &[f64], to: &[f64]) -> Box<[f64]> {
        let shift: Vec<f64> = to.iter().zip(from).map(|(a, b)| a - b).collect();
        (view.frame.lift_vector(&shift).iter())
            .zip(self.cloud.point(row.index()))
            .map(|(d, x)| x.as_f64() + d)
            .collect()
    }
}
