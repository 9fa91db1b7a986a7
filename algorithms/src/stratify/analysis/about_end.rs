//! What a model says about the end of a curve.

use super::fitter::{Fitter, Scratch, View};
use crate::audit;
use crate::stratify::curve_ends::{EndFound, EndRegion, Settled};
use crate::stratify::site::{FitUsed, On, StratumKind};
use crosscap_core::{Decomposition, Label, Located, Neighbor, Rejection, Row, Scalar};
use std::cmp::Ordering;

/// A fit about an end.
struct Shown {
    fit: Decomposition,
    /// What it says of the points of the ball.
    located: Vec<Option<Located>>,
    view: View,
    /// The point in which the curve ends.
    place: Box<[f64]>,
}

/// A ball in which a model is asked.
#[derive(Clone, Copy)]
struct Ball {
    center: Row,
    radius: f64,
}

impl<S: Scalar> Fitter<'_, S> {
    /// The region about the end of a curve at `row`, and what becomes of its rows, by that of some `models` which explains a ball of
    /// the given radius best. `eps` is the radius of the analysis.
    pub(in crate::stratify) fn about_end(
        &self,
        models: &[usize],
        row: Row,
        radius: f64,
        eps: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<EndFound> {
        let mut best: Option<EndFound> = None;
        for &model in models {
            let Some(found) = self.end_by(model, row, radius, eps, scratch) else {
                continue;
            };
            let first = best.as_ref().is_none_or(|b| better(&found, b).is_lt());
            let loser = match first {
                true => best.replace(found),
                false => Some(found),
            };
            if let Some((region, _)) = loser {
                self.ledger.lost(region.used.model.into());
            }
        }
        if let Some((region, _)) = &best {
            self.ledger.won(region.used.model.into());
        }
        best
    }

    /// The same by one model: first in the ball of the given radius, then in one about the point that it shows, wider where the model
    /// asks for it.
    fn end_by(
        &self,
        model: usize,
        row: Row,
        radius: f64,
        eps: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<EndFound> {
        let tuning = &self.tuning.ends;
        let mut ball = Ball {
            center: row,
            radius,
        };
        for _ in 0..tuning.attempts {
            if ball.radius > tuning.widest * eps {
                return None;
            }
            let shown = match self.shown(model, ball, tuning.overlap * eps, scratch)? {
                Ok(shown) => shown,
                Err(Rejection::NeighborhoodTooSmall { needed }) => {
                    ball.radius = tuning.spare * needed;
                    continue;
                }
                Err(_) => return None,
            };
            let far = |row: Row| self.far(row, &shown.place);
            let rows = scratch.near.iter().map(Neighbor::row);
            // The center is among them.
            let nearest = rows.min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
            let nearest = nearest.unwrap_or(ball.center);
            let shift = far(ball.center);
            if shift > tuning.off_center * ball.radius && nearest != ball.center {
                self.ledger.lost(model);
                ball.center = nearest;
                continue;
            }
            let used = FitUsed {
                model: model as u8,
                radius: eps,
            };
            let reach = ball.radius - shift;
            let reaches = [reach, reach + tuning.overlap * eps];
            let found = self.region(shown, reaches, used, scratch);
            if found.is_none() {
                self.ledger.lost(model);
            }
            return found;
        }
        None
    }

    /// What a model shows in a ball, or why it does not; `None` for a ball that it cannot be asked about. Rows up to `margin`
    /// beyond the ball are labelled.
    fn shown(
        &self,
        model: usize,
        ball: Ball,
        margin: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<Result<Shown, Rejection>> {
        let engine = self.models[model].as_ref();
        // A corner is told by the points that are missing: all of the ball count.
        let most = match engine.finds_boundary() {
            true => usize::MAX,
            false => self.tuning.analysis.most_fitted,
        };
        let radii = [ball.radius, ball.radius + margin];
        let view = self.view_of(ball.center, radii, most, scratch)?;
        if view.frame.spreads_beyond(engine.local_dimension()) {
            return None;
        }
        let all: Vec<usize> = (0..scratch.near.len()).collect();
        let local = self.local(&view, engine, scratch);
        self.ledger.asked(model);
        let (fit, located) = match engine.decompose_about(&local, &all) {
            Ok(found) => found,
            Err(rejection) => {
                self.ledger.refused(model, &rejection);
                return Some(Err(rejection));
            }
        };
        let point = ball.center.index();
        let Some(fit) = audit::sound(Ok(fit), &local, engine, point, &self.faults) else {
            self.ledger.broken(model);
            return None;
        };
        let located = audit::placed(located, &all, &local, engine, point, &self.faults);
        let Some(to) = fit.points.first() else {
            self.ledger.lost(model);
            return None;
        };
        let place = self.moved(ball.center, &view, local.point(view.center), to);
        Some(Ok(Shown {
            fit,
            located,
            view,
            place,
        }))
    }

    /// The rows nearer than `reach` to the point that a fit shows, with what it says of them, and labels of those that
    /// are nearer than `known`.
    fn region(
        &self,
        shown: Shown,
        [reach, known]: [f64; 2],
        used: FitUsed,
        scratch: &mut Scratch<S>,
    ) -> Option<EndFound> {
        let Shown {
            mut fit,
            located,
            view,
            place,
        } = shown;
        let rows: Vec<Row> = scratch.near.iter().map(Neighbor::row).collect();
        let engine = self.models[usize::from(used.model)].as_ref();
        let local = self.local(&view, engine, scratch);
        let labels = std::mem::take(&mut fit.labels);
        let mut own: Vec<(Row, Label, Settled)> = Vec::new();
        let mut beyond: Vec<(Row, Label)> = Vec::new();
        for (k, located) in located.into_iter().enumerate() {
            let row = rows[k];
            let far = self.far(row, &place);
            if far >= reach && far < known {
                beyond.push((row, labels[k]));
            }
            if far < reach {
                let located = located?;
                let to = self.moved(row, &view, local.point(k), &located.place);
                own.push((row, labels[k], settled(row, located, to, used)));
            }
        }
        own.sort_by_key(|x| x.0);
        let labels = own.iter().map(|x| (x.0, x.1)).collect();
        let region = EndRegion::new([labels, beyond], fit, place.into(), reach, used);
        Some((region, own.into_iter().map(|x| x.2).collect()))
    }

    /// How far a row is from a place.
    fn far(&self, row: Row, place: &[f64]) -> f64 {
        let own = self.cloud.point(row.index()).iter().map(|x| x.as_f64());
        let squares = own.zip(place).map(|(x, p)| (x - p) * (x - p));
        squares.sum::<f64>().sqrt()
    }
}

/// The order of what two models show of one end; that of the models changes nothing.
fn better(a: &EndFound, b: &EndFound) -> Ordering {
    let [a, b] = [&a.0.fit, &b.0.fit];
    let order = a.residual.total_cmp(&b.residual);
    order.then(a.parameters.cmp(&b.parameters))
}

/// What becomes of a row that a fit has located.
fn settled(row: Row, located: Located, place: Box<[f64]>, used: FitUsed) -> Settled {
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
