//! The competition of the models for one neighborhood.

use super::fitter::{Fitter, Scratch, View};
use crate::audit;
use crosscap_core::{Decomposition, Located, Row, Scalar, SingularityModel};

/// A fit that holds its own.
pub(super) struct Contender {
    /// Position of the model.
    pub(super) model: usize,
    pub(super) fit: Decomposition,
    /// What the fit says of the rows that it was asked about, where it was asked.
    located: Option<Vec<Option<Located>>>,
    score: f64,
}

/// Which models are asked, and which answers count.
pub(super) struct Rules<'r> {
    /// Whether a model takes part.
    pub(super) takes_part: &'r dyn Fn(&dyn SingularityModel) -> bool,
    /// Whether a fit explains more than one sheet does.
    pub(super) explains: &'r dyn Fn(&Decomposition) -> bool,
}

impl<S: Scalar> Fitter<'_, S> {
    /// Asks all models that take part about a ball; the fit with the least score wins. Among equal
    /// scores the first name does, so that the order of the models changes nothing.
    ///
    /// The winner will be asked about the `added` rows behind those of the ball.
    pub(super) fn compete(
        &self,
        i: Row,
        view: &View,
        added: usize,
        rules: &Rules<'_>,
        scratch: &mut Scratch<S>,
    ) -> Option<Contender> {
        let mut best: Option<Contender> = None;
        for (m, model) in self.models.iter().enumerate() {
            if !(rules.takes_part)(model.as_ref()) {
                continue;
            }
            let Some(fitted) = self.ask(i, view, added, m, scratch) else {
                continue;
            };
            if !(rules.explains)(&fitted.fit) {
                self.ledger.lost(m);
                continue;
            }
            let before = best.as_ref().is_none_or(|b| {
                let name = |k: usize| self.models[k].name();
                let order = fitted.score.total_cmp(&b.score);
                order.then_with(|| name(m).cmp(name(b.model))).is_lt()
            });
            let loser = if before {
                best.replace(fitted)
            } else {
                Some(fitted)
            };
            if let Some(loser) = loser {
                self.ledger.lost(loser.model);
            }
        }
        if let Some(winner) = &best {
            self.ledger.won(winner.model);
        }
        best
    }

    /// The fit of one model, if it has one that can be used.
    fn ask(
        &self,
        i: Row,
        view: &View,
        added: usize,
        m: usize,
        scratch: &mut Scratch<S>,
    ) -> Option<Contender> {
        let model = self.models[m].as_ref();
        let local = self.local(view, model, scratch);
        self.ledger.asked(m);
        // One model alone need not be asked twice.
        let found = if self.models.len() == 1 && added > 0 {
            let about: Vec<usize> = view.added(model, added).collect();
            let found = model.decompose_about(&local, &about);
            found.map(|(fit, located)| (fit, Some(located)))
        } else {
            model.decompose(&local).map(|fit| (fit, None))
        };
        let (fit, located) = match found {
            Ok(found) => found,
            Err(rejection) => {
                self.ledger.refused(m, &rejection);
                return None;
            }
        };
        let Some(fit) = audit::sound(Ok(fit), &local, model, i.index(), &self.faults) else {
            self.ledger.broken(m);
            return None;
        };
        Some(Contender {
            model: m,
            score: score(&fit, view),
            fit,
            located,
        })
    }

    /// What the winner says of the `added` rows behind those of the ball.
    pub(super) fn locate(
        &self,
        i: Row,
        view: &View,
        added: usize,
        winner: &mut Contender,
        scratch: &mut Scratch<S>,
    ) -> Vec<Option<Located>> {
        if added == 0 {
            return Vec::new();
        }
        let model = self.models[winner.model].as_ref();
        let local = self.local(view, model, scratch);
        let known = winner.located.take().filter(|l| l.len() == added);
        let about: Vec<usize> = view.added(model, added).collect();
        let located = known.unwrap_or_else(|| match model.decompose_about(&local, &about) {
            Ok((_, located)) => located,
            Err(_) => vec![None; added],
        });
        audit::placed(located, &about, &local, model, i.index(), &self.faults)
    }
}

/// What models are compared by: the logarithm of the residual of the points that were fitted, penalized for
/// parameters (the Bayesian information criterion of normal errors, up to a constant).
pub(super) fn score(fit: &Decomposition, view: &View) -> f64 {
    let count = view.fitted.max(2) as f64;
    2.0 * count * (fit.residual / view.radius).max(1e-12).ln() + fit.parameters as f64 * count.ln()
}
