//! Boundaries followed to where another sheet hides them.

use super::competition::Rules;
use super::explain::Kind;
use super::fitter::{Fitter, Scratch};
use super::found::Analysis;
use super::groups::FITS_AT_ONCE;
use crate::execute;
use crate::stratify::site::{On, Site, StratumKind};
use crate::stratify::strata::Strata;
use crosscap_core::{Row, Scalar, SingularityModel, Table};

impl<S: Scalar> Fitter<'_, S> {
    /// Points of boundaries that were not found because another sheet is in their neighborhoods: beyond a place where two sheets cross
    /// and end there is air on one side, and the other sheet not far behind it.
    ///
    /// A smaller ball shows them, but everywhere a smaller ball is also less evidence. So it is asked only ahead of where a boundary
    /// that was found breaks off, and from there on. Points that a region about an end has settled stay as they are.
    /// O(b) neighborhoods and O(c) fits, for b points of boundaries and c points ahead of where they break off. All points of one step
    /// are asked about before any of their answers is entered, so that the threads that do it change nothing.
    pub(in crate::stratify) fn continue_boundaries(
        &self,
        analysis: &Analysis,
        strata: &mut Strata,
    ) {
        if !self.models.iter().any(|m| is_followed(m.as_ref())) {
            return;
        }
        let mut looked_at: Table<Row, bool> = Table::filled(strata.len(), false);
        for region in strata.regions() {
            region.rows().for_each(|row| looked_at[row] = true);
        }
        let mut latest: Vec<Row> = (strata.rows())
            .filter(|&row| on_boundary(&strata.sites()[row]))
            .collect();
        while !latest.is_empty() {
            let ahead = execute::map(self.execute, latest.len(), Vec::new, |near, k| {
                self.ahead(latest[k], analysis.radius(latest[k]), strata, near)
            });
            let mut asked: Vec<Row> = ahead.into_iter().flatten().collect();
            asked.retain(|&row| !std::mem::replace(&mut looked_at[row], true));
            let count = asked.len();
            let found = execute::map_blocks(
                self.execute,
                FITS_AT_ONCE,
                count,
                Scratch::default,
                |scratch, k| self.hidden_boundary(asked[k], analysis.radius(asked[k]), scratch),
            );
            latest.clear();
            for (row, on) in asked.into_iter().zip(found) {
                if let Some(on) = on {
                    strata.enter(self.cloud, row, Some(on));
                    latest.push(row);
                }
            }
        }
    }

    /// Points inside cells ahead of a point of a boundary where the boundary breaks off; none where it goes on both ways.
    fn ahead(&self, row: Row, eps: f64, strata: &Strata, near: &mut Vec<Row>) -> Vec<Row> {
        let tuning = &self.tuning.ends;
        self.around(row, eps, near);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::PrincipalComponents;
    use crate::execute::{Execute, Serial};
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::singularity::Boundary;
    use crate::space::Space;
    use crate::stratify::analysis::{Analyzer, ModelCounts};
    use crate::tuning::Tuning;
    use crosscap_core::PointCloud;
    use crosscap_core::laws::Draw;
    use std::ops::Range;

    const EPS: f64 = 0.5;
    const SPACING: f64 = 0.1;
    /// Points of a plate along its boundary, and across.
    const PLATE: [usize; 2] = [40, 12];
    /// Points of the boundary, from one side, that are known; those that come next have the other plate in their balls.
    const KNOWN: usize = 20;

    /// All of a job by itself, the last first.
    struct Backwards;

    impl Execute for Backwards {
        fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync)) {
            (0..count).rev().for_each(|k| job(k..k + 1));
        }
    }

    /// A plate whose boundary is its first row of points, and behind its second half another one that goes on beyond the boundary,
    /// in the balls of the analysis and not in smaller ones.
    fn plates() -> PointCloud<f64> {
        let mut draw = Draw::new(5, 0);
        let mut off = || 0.08 * SPACING * draw.between(-1.0, 1.0);
        let mut places = Vec::new();
        for across in 0..PLATE[1] {
            for along in 0..PLATE[0] {
                let [x, y] = [along, across].map(|k| SPACING * k as f64);
                places.extend([x + off(), y + off(), 0.1 * off()]);
            }
        }
        for across in 0..2 * PLATE[1] {
            for along in KNOWN + 2..PLATE[0] {
                let [x, y] = [along, across].map(|k| SPACING * (k as f64 + 0.5));
                let y = y - SPACING * PLATE[1] as f64;
                places.extend([x + off(), y + off(), -0.9 * EPS]);
            }
        }
        PointCloud::new(3, places).unwrap()
    }

    /// The rows of boundaries after the known ones were continued, and what became of the model.
    fn continued(execute: &dyn Execute) -> (Vec<usize>, ModelCounts) {
        let cloud = plates();
        let metric = Euclidean::new(cloud.clone());
        let oracle = BruteForceOracle::new(&metric);
        let analyzer = Analyzer {
            space: Space::new(&metric, &oracle),
            estimator: &PrincipalComponents::new(0.05).unwrap(),
            models: &[Box::new(Boundary::new(0.05, 0.05).unwrap())],
            execute,
            tuning: &Tuning::MEASURED,
        };
        let mut analysis = Analysis::of_surface(cloud.len());
        analysis.eps = EPS;
        let mut strata = Strata::as_found(&analysis, Some(&cloud));
        for row in 0..KNOWN {
            strata.enter(&cloud, Row::new(row), Some(On::GIVEN_BOUNDARY));
        }
        let fitter = Fitter::new(&analyzer, &cloud);
        fitter.continue_boundaries(&analysis, &mut strata);
        fitter.faults.none().unwrap();
        let on = strata
            .rows()
            .filter(|&row| on_boundary(&strata.sites()[row]));
        (on.map(Row::index).collect(), fitter.counts().remove(0))
    }

    #[test]
    fn a_boundary_goes_on_where_another_sheet_is_near() {
        let (on, counts) = continued(&Serial);
        // Up to where the ball has the corner of the plate in it.
        let most = PLATE[0] - (EPS / SPACING) as usize;
        assert!((0..most).all(|row| on.contains(&row)), "{on:?}");
        // Nothing inside a plate, and nothing of the other one.
        let is_rim = |row: &usize| {
            let at = [row % PLATE[0], row / PLATE[0]];
            (0..2).any(|k| at[k] == 0 || at[k] + 1 == PLATE[k])
        };
        assert!(
            on.iter()
                .all(|row| *row < PLATE[0] * PLATE[1] && is_rim(row)),
            "{on:?}"
        );
        assert!(counts.won >= most - KNOWN, "{counts:?}");
        let refused = counts.no_real_solution + counts.empty_stratum + counts.too_few_points;
        assert_eq!(counts.asked, counts.won + refused, "{counts:?}");
        assert_eq!((on, counts), continued(&Backwards));
    }
}
