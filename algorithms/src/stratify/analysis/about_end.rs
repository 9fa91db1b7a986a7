//! What a model says about the end of a curve.

use super::fitter::{Fitter, Scratch};
use crate::audit;
use crate::stratify::curve_ends::{EndRegion, Settled};
use crate::stratify::site::{FitUsed, On, StratumKind};
use crosscap_core::{Located, Rejection, Scalar};

/// Widest ball, in radii of the analysis.
const WIDEST: f64 = 5.0;
/// A ball whose center is farther than this share of its radius from the point that it shows is laid anew.
const OFF_CENTER: f64 = 0.15;
/// How often a ball is laid anew.
const ATTEMPTS: usize = 5;
/// A model that needs a wider ball gets one wider by this factor than it asks for.
const SPARE: f64 = 1.08;

impl<S: Scalar> Fitter<'_, S> {
    /// The region about the end of a curve at `row` by a model, and what becomes of its rows: first in the
    /// ball of the given radius, then in one about the point that it shows, wider where the model asks for it.
    /// `eps` is the radius of the analysis.
    pub(in crate::stratify) fn about_end(
        &self,
        model: usize,
        row: usize,
        radius: f64,
        eps: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<(EndRegion, Vec<Settled>)> {
        let engine = self.models[model].as_ref();
        let (mut center, mut radius) = (row, radius);
        for _ in 0..ATTEMPTS {
            if radius > WIDEST * eps {
                return None;
            }
            let view = self.view(center, radius, radius, scratch)?;
            if view.frame.spreads_beyond(engine.local_dimension()) {
                return None;
            }
            let rows: Vec<usize> = scratch.near.iter().map(|x| x.index).collect();
            let all: Vec<usize> = (0..rows.len()).collect();
            let local = self.local(&view, engine, scratch);
            let (found, located) = match engine.decompose_about(&local, &all) {
                Ok((fit, located)) => (Ok(fit), located),
                Err(Rejection::NeighborhoodTooSmall { needed }) => {
                    radius = SPARE * needed;
                    continue;
                }
                Err(rejection) => (Err(rejection), Vec::new()),
            };
            let mut fit = audit::sound(found, &local, engine, center, &self.faults)?;
            let lift = |to: &[f64], k: usize| self.moved(rows[k], &view, local.point(k), to);
            let place = lift(fit.points.first()?, view.center);
            let far = |r: usize| -> f64 {
                let own = self.cloud.point(r).iter().map(|x| x.as_f64());
                own.zip(&place).map(|(x, p)| (x - p) * (x - p)).sum()
            };
            let nearest = (rows.iter().copied())
                .min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)))?;
            let shift = far(center).sqrt();
            if shift > OFF_CENTER * radius && nearest != center {
                center = nearest;
                continue;
            }
            let reach = radius - shift;
            let used = FitUsed {
                model: model as u8,
                radius: eps,
            };
            let mut own: Vec<(u32, u8, Settled)> = Vec::new();
            for (k, located) in located.into_iter().enumerate() {
                if far(rows[k]) < reach * reach {
                    let located = located?;
                    let place = lift(&located.place, k);
                    let label = fit.labels[k];
                    own.push((
                        rows[k] as u32,
                        label,
                        settled(rows[k], located, place, used),
                    ));
                }
            }
            own.sort_by_key(|x| x.0);
            fit.labels = Vec::new();
            let region = EndRegion {
                labels: own.iter().map(|x| (x.0, x.1)).collect(),
                fit,
                place: place.into(),
                reach,
            };
            return Some((region, own.into_iter().map(|x| x.2).collect()));
        }
        None
    }
}

/// What becomes of a row that a fit has located.
fn settled(row: usize, located: Located, place: Box<[f64]>, used: FitUsed) -> Settled {
    let kind = match (located.dimension, located.cells) {
        (0, _) => StratumKind::Point,
        (_, 1) => StratumKind::Boundary,
        _ => StratumKind::Curve,
    };
    let on = On {
        kind,
        place: Some(place),
        moved: located.offset,
        fit: (kind != StratumKind::Boundary).then_some(used),
        cells: located.cells,
    };
    let inside = located.dimension == 2;
    let beside = inside && located.offset.is_finite();
    Settled {
        row,
        on: (!inside).then(|| on.clone()),
        beside: beside.then_some(on),
    }
}
