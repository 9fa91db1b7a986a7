//! The first look at a point, and who is looked at again.

use super::competition::Rules;
use super::explain::{Kind, Verdict};
use super::fitter::{Fitter, Scratch, View};
use super::found::Analysis;
use super::groups::Asked;
use super::options::AnalysisOptions;
use crate::stratify::site::StratumKind;
use crosscap_core::{Row, Scalar, Table};

impl<S: Scalar> Fitter<'_, S> {
    /// What a point with a neighborhood of this dimension is, unless it is regular, or fits in competition with
    /// one sheet must tell.
    pub(super) fn first_look(
        &self,
        i: Row,
        dimension: usize,
        options: &AnalysisOptions,
        boundary: bool,
        scratch: &mut Scratch<S>,
    ) -> Option<Box<Verdict>> {
        let asked = self
            .models
            .iter()
            .any(|m| m.applies_to(dimension) && !(boundary && m.finds_boundary()));
        let verdict = match dimension {
            2 if asked => self.second_thought(i, options, boundary, scratch),
            _ if asked || dimension == 2 => return None,
            _ => Verdict::UNEXPLAINED,
        };
        Some(Box::new(verdict))
    }

    /// What models say that ask for 2-dimensional neighborhoods.
    fn second_thought(
        &self,
        i: Row,
        options: &AnalysisOptions,
        boundary: bool,
        scratch: &mut Scratch<S>,
    ) -> Verdict {
        let eps = options.radius(i);
        let Some(view) = self.view(i, eps, eps, scratch) else {
            return Verdict::REGULAR;
        };
        let rules = Rules {
            takes_part: &|model| {
                let silent = if model.finds_boundary() {
                    boundary
                } else {
                    options.surface
                };
                !silent && model.applies_to(2)
            },
            explains: &|_| true,
        };
        let Some(best) = self.compete(i, &view, 0, &rules, scratch) else {
            return self.bare_curve(i, &view, options, scratch);
        };
        let local = self.local(&view, self.models[best.model].as_ref(), scratch);
        let located = best.fit.located(view.center);
        self.verdict(i, &best, &view, local.point(view.center), located)
    }

    /// Whether a point whose ball passes for a sheet is on a curve that no surface touches: a large ball may
    /// reach another stratum, and the dimension is estimated again in the inner ball, which sees
    /// only the center's own.
    fn bare_curve(
        &self,
        i: Row,
        view: &View,
        options: &AnalysisOptions,
        scratch: &mut Scratch<S>,
    ) -> Verdict {
        let radius = self.tuning.analysis.inner_ball * options.radius(i);
        let fitted = &scratch.near[..view.fitted];
        if !self.knows_bare_curves() || self.inner_dimension(i, radius, fitted) != Some(1) {
            return Verdict::REGULAR;
        }
        let (verdict, _) = self.explain(i, &[], 1, options, scratch);
        match &verdict.kind {
            Kind::Singular(w) if w.on.cells == 0 => verdict,
            _ => Verdict::REGULAR,
        }
    }

    /// Points that passed for 2-dimensional close to a point on a curve.
    ///
    /// Where sheets cross at a small angle the share of variance that tells a crossing is near the
    /// tolerance, and single points fall below it: a curve that was found on both sides of such a
    /// point is looked for there too.
    pub(super) fn beside_curves(
        &self,
        analysis: &Analysis,
        options: &AnalysisOptions,
    ) -> Vec<Asked> {
        let tuning = &self.tuning.analysis;
        let on_curve = |row: Row| analysis.sites[row].kind() == Some(StratumKind::Curve);
        let mut near = Vec::new();
        let mut covered: Table<Row, bool> = Table::filled(analysis.sites.len(), false);
        let mut beside = covered.clone();
        for i in analysis.sites.ids() {
            if !on_curve(i) || covered[i] {
                continue;
            }
            let eps = options.radius(i);
            let oracle = self.space.oracle();
            oracle.indices_within(i.index(), S::of(tuning.beside * eps), &mut near);
            for &x in &near {
                let x = Row::from(x);
                if on_curve(x) {
                    let reach = tuning.beside_spacing * eps;
                    covered[x] |= self.square(i, x) < reach.powi(2);
                } else if analysis.dimensions[x] == 2 {
                    beside[x] = true;
                }
            }
        }
        (beside.ids())
            .filter(|&row| beside[row])
            .map(|row| Asked { row, neighbors: 0 })
            .collect()
    }
}
