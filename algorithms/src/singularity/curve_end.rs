//! What models of the ends of curves have in common: when they are believed, and what they say of rows. Books are believed so, too.

use crosscap_core::{Decomposition, Label, LocalPoints, Located, Rejection, Stratum};
use nalgebra::Vector3;

/// Refuses a fit that too many of the points are farther off than ep; `off` are their distances.
pub(super) fn follows(
    off: impl ExactSizeIterator<Item = f64>,
    residual: f64,
    ep: f64,
    astray: f64,
) -> Result<(), Rejection> {
    let most = astray * off.len() as f64;
    match off.filter(|&d| d > ep).count() as f64 > most {
        true => Err(Rejection::PoorFit {
            residual,
            limit: ep,
        }),
        false => Ok(()),
    }
}

/// A neighborhood of the end of a curve, with what was fitted to it.
pub(super) trait CurveEnd {
    /// Dimension of the stratum of every label.
    fn strata(&self) -> &[u8];
    /// How many cells meet at the strata that are curves, by label.
    fn cells(&self) -> &[u8];
    /// Numbers that were fitted.
    fn parameters(&self) -> usize;

    /// The points.
    fn points(&self) -> &[Vector3<f64>];
    /// Where the curve ends.
    fn end(&self) -> Vector3<f64>;
    /// Root mean squared distance of the fitted points from the surface.
    fn residual(&self) -> f64;
    /// Curve tolerance.
    fn ep(&self) -> f64;
    /// A point off the curves tells where they are up to this many ep.
    fn witness(&self) -> f64;
    /// Label of a row, the nearest place on a curve, and how many cells meet there.
    fn locate(&self, row: usize) -> (u8, Vector3<f64>, u8);

    /// What is said of a row: a place on a curve where it is on one or near one.
    fn located(&self, row: usize) -> Located {
        let (label, place, cells) = self.locate(row);
        let dimension = self.strata()[usize::from(label)];
        let own = self.points()[row];
        let offset = (place - own).norm();
        let (place, offset) = match dimension < 2 || offset < self.witness() * self.ep() {
            true => (place, offset),
            false => (own, f64::INFINITY),
        };
        Located {
            dimension,
            cells,
            place: place.iter().copied().collect(),
            offset,
        }
    }

    /// The decomposition of the neighborhood, and what is said of some of its rows: nothing of one that would be moved onto a curve or
    /// point by more than the radius. Rows behind those that are fitted may lie where the curve or a rim is mere extrapolation.
    fn decomposition(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> (Decomposition, Vec<Option<Located>>) {
        let center = self.located(local.center);
        let near = |x: &Located| x.dimension == 2 || x.offset <= local.radius;
        let located = rows.iter().map(|&row| Some(self.located(row)).filter(near));
        let located = located.collect();
        let strata = self.strata().iter();
        let decomposition = Decomposition {
            strata: strata.map(|&dimension| Stratum { dimension }).collect(),
            labels: (0..local.len())
                .map(|row| Label::from(self.locate(row).0))
                .collect(),
            cells_at_curve: self.cells().to_vec(),
            residual: self.residual(),
            parameters: self.parameters(),
            points: vec![self.end().iter().copied().collect()],
            center: center.place,
            center_offset: center.offset,
        };
        (decomposition, located)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An end at the origin that takes every point for itself.
    struct Greedy(Vec<Vector3<f64>>);

    impl CurveEnd for Greedy {
        fn strata(&self) -> &[u8] {
            &[0, 1, 2]
        }

        fn cells(&self) -> &[u8] {
            &[4]
        }

        fn parameters(&self) -> usize {
            1
        }

        fn points(&self) -> &[Vector3<f64>] {
            &self.0
        }

        fn end(&self) -> Vector3<f64> {
            Vector3::zeros()
        }

        fn residual(&self) -> f64 {
            0.0
        }

        fn ep(&self) -> f64 {
            0.1
        }

        fn witness(&self) -> f64 {
            2.0
        }

        fn locate(&self, _: usize) -> (u8, Vector3<f64>, u8) {
            (0, Vector3::zeros(), 0)
        }
    }

    #[test]
    fn nothing_is_moved_by_more_than_the_radius() {
        let coordinates = [0.0, 0.0, 0.0, 0.9, 0.0, 0.0, 1.2, 0.0, 0.0];
        let local = super::super::about_first(&coordinates, 1.0);
        let fit = Greedy(super::super::tolerance::vectors(&local));
        let (_, located) = fit.decomposition(&local, &[1, 2]);
        assert!(located[0].as_ref().is_some_and(|x| x.offset == 0.9));
        assert!(located[1].is_none(), "{located:?}");
    }
}
