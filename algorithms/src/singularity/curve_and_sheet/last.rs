//! The last fit, which the other of the two models asks for next.

use super::fit::{Conditions, Fit};
use crosscap_core::{LocalPoints, Rejection};
use std::cell::RefCell;

/// A fit with all that it was made from.
struct Kept {
    coordinates: Vec<f64>,
    fitted: usize,
    center: usize,
    radius: f64,
    conditions: Option<Conditions>,
    /// None where it was handed out already.
    fit: Option<Result<Fit, Rejection>>,
}

impl Kept {
    const NOTHING: Self = Self {
        coordinates: Vec::new(),
        fitted: 0,
        center: 0,
        radius: 0.0,
        conditions: None,
        fit: None,
    };

    fn keep(
        &mut self,
        local: &LocalPoints<'_>,
        conditions: &Conditions,
        fit: Result<Fit, Rejection>,
    ) {
        self.coordinates.clear();
        self.coordinates.extend_from_slice(local.coordinates);
        (self.fitted, self.center) = (local.fitted, local.center);
        self.radius = local.radius;
        self.conditions = Some(*conditions);
        self.fit = Some(fit);
    }

    fn is_of(&self, local: &LocalPoints<'_>, conditions: &Conditions) -> bool {
        (self.fitted, self.center) == (local.fitted, local.center)
            && self.radius == local.radius
            && self.conditions.as_ref() == Some(conditions)
            && self.coordinates == local.coordinates
    }
}

thread_local! {
    /// The last fit of this thread. Whether the curve ends on the sheet is asked right after whether it goes
    /// through, about the same points, and the fit is the same; comparing the points takes a hundredth of
    /// the time of fitting.
    static LAST: RefCell<Kept> = const { RefCell::new(Kept::NOTHING) };
}

/// The fit of a neighborhood, the last one where that is what it is of.
pub(super) fn fit(local: &LocalPoints<'_>, conditions: &Conditions) -> Result<Fit, Rejection> {
    LAST.with_borrow_mut(|last| {
        if last.is_of(local, conditions)
            && let Some(fit) = last.fit.take()
        {
            return fit;
        }
        let fit = Fit::new(local, conditions);
        last.keep(local, conditions, fit.clone());
        fit
    })
}
