//! What happens when a star cannot be closed.

use super::Star;
use super::run::Run;
use crosscap_core::{Error, Landmark, Scalar};

impl<S: Scalar> Run<'_, '_, S> {
    /// Tries to close the star of `v` by repairs, with `drop` also by giving up a landmark.
    /// `true` when one succeeded.
    pub(super) fn mend(&mut self, v: Landmark, k: Star, drop: bool) -> Result<bool, Error> {
        if !self.front.parts.repair || self.attempts == 0 {
            return Ok(false);
        }
        let members: Vec<Landmark> = self.front.input.neighborhoods()[k.index()]
            .members()
            .iter()
            .copied()
            .filter(|&m| !self.front.dropped[m])
            .collect();
        let tuning = self.front.parts.tuning;
        for reach in tuning.tears {
            if reach < members.len() + tuning.beyond_chart
                && self.attempt(v, k, &members, reach, None)?
            {
                return Ok(true);
            }
        }
        if !drop {
            return Ok(false);
        }
        let cell = |u: &Landmark| self.front.input.strata()[*u] == 2;
        let droppable: Vec<Landmark> = members
            .iter()
            .copied()
            .filter(cell)
            .take(1 + tuning.drops)
            .collect();
        for u in droppable {
            for reach in tuning.tears_of_drop {
                if self.attempt(v, k, &members, reach, Some(u))? {
                    self.counts.dropped += 1;
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// One repair, all or nothing.
    fn attempt(
        &mut self,
        v: Landmark,
        k: Star,
        members: &[Landmark],
        reach: usize,
        drop: Option<Landmark>,
    ) -> Result<bool, Error> {
        self.attempts = match self.attempts.checked_sub(1) {
            Some(left) => left,
            None => return Ok(false),
        };
        self.front.mark();
        let order = self.tear(v, members, reach, drop);
        let mut good = drop == Some(v) || self.visit(k)?;
        for u in order {
            if !good {
                break;
            }
            if let Some(home) = self.home[u]
                && self.done[u]
                && !self.front.dropped[u]
            {
                good = self.visit(home)?;
            }
        }
        if good {
            self.counts.repairs += 1;
            // Landmarks that gained triangles and are not visited yet are on the front.
            let reached = self.front.moved();
            self.queue
                .extend(reached.into_iter().filter(|&u| !self.done[u]));
        } else {
            self.front.roll_back();
            if let Some(u) = drop {
                self.front.dropped[u] = false;
            }
        }
        Ok(good)
    }

    /// Removes the triangles at `v` and at its nearest members, and those of a landmark that is given up. Returns
    /// the landmarks that lost one, but for `v`: members first, in their order.
    fn tear(
        &mut self,
        v: Landmark,
        members: &[Landmark],
        reach: usize,
        drop: Option<Landmark>,
    ) -> Vec<Landmark> {
        let mut touched = Vec::new();
        // A landmark on a curve has triangles in other cells, which are none of this chart's business.
        let mut sorted = members.to_vec();
        sorted.sort_unstable();
        let inside = |c: Landmark| sorted.binary_search(&c).is_ok();
        let on_curve = self.front.input.strata()[v] < 2;
        let within = |c: Landmark| !on_curve || inside(c);
        self.front.clear(v, within, &mut touched);
        for &m in members.iter().skip(1).take(reach) {
            if self.front.input.strata()[m] == 2 {
                self.front.clear(m, |_| true, &mut touched);
            } else {
                self.front.clear(m, inside, &mut touched);
            }
        }
        if let Some(u) = drop {
            self.front.clear(u, |_| true, &mut touched);
            self.front.dropped[u] = true;
        }
        let mut order: Vec<Landmark> = members.to_vec();
        touched.sort_unstable();
        touched.dedup();
        order.retain(|m| touched.binary_search(m).is_ok() && *m != v);
        let far = touched.into_iter().filter(|m| !members.contains(m));
        order.extend(far);
        order
    }
}
