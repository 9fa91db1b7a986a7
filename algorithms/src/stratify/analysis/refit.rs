//! The fit about a point on a curve, made again in its own ball to label what is around it.

use super::competition::score;
use super::fitter::{Fitter, Scratch};
use crate::audit;
use crate::stratify::strata::Strata;
use crosscap_core::{Decomposition, Neighbor, Row, Scalar, SingularityModel};

impl<S: Scalar> Fitter<'_, S> {
    /// The decomposition of the ball of a point on a curve, with the rows it labels and the radius.
    pub(in crate::stratify) fn decomposition(
        &self,
        strata: &Strata,
        i: Row,
        scratch: &mut Scratch<S>,
    ) -> Option<(Decomposition, Vec<Row>, f64)> {
        let tuning = &self.tuning.analysis;
        let used = strata.sites()[i].on()?.fit?;
        let mut radius = used.radius;
        for _ in 0..=tuning.shrinks {
            let view = self.view(i, radius, tuning.label_margin * radius, scratch)?;
            let mut fit_by = |model: &dyn SingularityModel| {
                let local = self.local(&view, model, scratch);
                let found = model.decompose(&local);
                audit::sound(found, &local, model, i.index(), &self.faults)
            };
            let mut best = fit_by(self.models[used.model as usize].as_ref());
            if best.is_none() {
                let others = self
                    .models
                    .iter()
                    .filter(|m| m.applies_to(3) && !m.finds_boundary());
                best = others
                    .filter_map(|m| fit_by(m.as_ref()))
                    .min_by(|a, b| score(a, &view).total_cmp(&score(b, &view)));
            }
            if let Some(fit) = best {
                let rows = scratch.near.iter().map(Neighbor::row).collect();
                return Some((fit, rows, radius));
            }
            // The fit of a neighbor may have spoken for this point; its own ball can hold more.
            radius *= tuning.shrink;
        }
        None
    }
}
