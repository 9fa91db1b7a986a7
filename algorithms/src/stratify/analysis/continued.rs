//! Boundaries followed to where another sheet hides them.

use super::competition::Rules;
use super::explain::Kind;
use super::fitter::{Fitter, Scratch};
use super::found::Analysis;
use crate::stratify::site::{On, Site, StratumKind};
use crate::stratify::strata::Strata;
use crosscap_core::{Row, Scalar, SingularityModel, Table};

impl<S: Scalar> Fitter<'_, S> {
    /// Points of boundaries that were not found because another sheet is in their neighborhoods: beyond a place where two sheets cross
    /// and end there is air on one side, and the other sheet not far behind it.
    ///
    /// A smaller ball shows them, but everywhere a smaller ball is also less evidence. So it is asked only ahead of where a boundary
    /// that was found breaks off, and from there on. Points that a region about an end has settled stay as they are.
    /// O(b) neighborhoods and O(c) fits, for b points of boundaries and c points ahead of where they break off.
    pub(in crate::stratify) fn continue_boundaries(
        &self,
        analysis: &Analysis,
        strata: &mut Strata,
    ) {
        if !self.models.iter().any(|m| is_followed(m.as_ref())) {
            return;
        }
        let mut scratch = Scratch::default();
        let mut looked_at: Table<Row, bool> = Table::filled(strata.len(), false);
        for region in strata.regions() {
            region.rows().for_each(|row| looked_at[row] = true);
        }
        let mut latest: Vec<Row> = (strata.rows())
            .filter(|&row| on_boundary(&strata.sites()[row]))
            .collect();
        while !latest.is_empty() {
            let mut found = Vec::new();
            for row in latest {
                for ahead in self.ahead(row, analysis.radius(row), strata) {
                    if std::mem::replace(&mut looked_at[ahead], true) {
                        continue;
                    }
                    let eps = analysis.radius(ahead);
                    if let Some(on) = self.hidden_boundary(ahead, eps, &mut scratch) {
                        found.push((ahead, on));
                    }
                }
            }
            latest = found.iter().map(|x| x.0).collect();
            for (row, on) in found {
                strata.enter(self.cloud, row, Some(on));
            }
        }
    }

    /// Points inside cells ahead of a point of a boundary where the boundary breaks off; none where it goes on both ways.
    fn ahead(&self, row: Row, eps: f64, strata: &Strata) -> Vec<Row> {
        let tuning = &self.tuning.ends;
        let mut near = Vec::new();
        self.around(row, eps, &mut near);
        let own = self.cloud.point(row.index());
        let from = |other: Row| -> Vec<f64> {
            let other = self.cloud.point(other.index());
            let pairs = other.iter().zip(own);
            pairs.map(|(x, o)| x.as_f64() - o.as_f64()).collect()
        };
        let sites = strata.sites();
        let mut middle = vec![0.0; own.len()];
        let mut count = 0.0;
        for &other in near.iter().filter(|&&x| on_boundary(&sites[x])) {
            for (m, d) in middle.iter_mut().zip(from(other)) {
                *m += d;
            }
            count += 1.0;
        }
        let off = middle.iter().map(|m| m * m).sum::<f64>().sqrt();
        if off < tuning.breaks_off * eps * count {
            return Vec::new();
        }
        let is_ahead = |&&x: &&Row| {
            let along: f64 = from(x).iter().zip(&middle).map(|(d, m)| d * m).sum();
            strata.is_regular(x)
                && along < 0.0
                && self.square(row, x) < (tuning.continues * eps).powi(2)
        };
        near.iter().filter(is_ahead).copied().collect()
    }

    /// What is known of a row as a point of a boundary, by a model in a ball that is smaller than that of the analysis; `None` where
    /// none says in any of them that the row is on one.
    fn hidden_boundary(&self, row: Row, eps: f64, scratch: &mut Scratch<S>) -> Option<On> {
        let rules = Rules {
            takes_part: &|model| is_followed(model),
            explains: &|_| true,
        };
        for share in self.tuning.ends.continued_in {
            let radius = share * eps;
            let view = self.view(row, radius, radius, scratch)?;
            if view.within < self.tuning.analysis.least_neighbors {
                return None;
            }
            if self.dimension_of(row, &view) != Some(2) {
                continue;
            }
            let Some(best) = self.compete(row, &view, 0, &rules, scratch) else {
                continue;
            };
            let local = self.local(&view, self.models[best.model].as_ref(), scratch);
            let located = best.fit.located(view.center);
            let verdict = self.verdict(row, &best, &view, local.point(view.center), located);
            if let Kind::Singular(witness) = verdict.kind {
                return Some(witness.on);
            }
        }
        None
    }
}

/// Whether a model finds boundaries in neighborhoods of one sheet.
fn is_followed(model: &dyn SingularityModel) -> bool {
    model.finds_boundary() && model.applies_to(2) && !model.explains_ends()
}

fn on_boundary(site: &Site) -> bool {
    site.kind() == Some(StratumKind::Boundary)
}
