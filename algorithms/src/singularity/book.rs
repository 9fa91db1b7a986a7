//! Any number of sheets that meet in one curve.

use super::one_fit::{OneFit, located};
use super::page_sheets::PageSheets;
use super::patch::PATCH_POINTS;
use super::plane_pair::PlanePair;
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::BookTuning;
use crosscap_core::{
    Decomposition, Error, Label, LocalPoints, Located, Rejection, SingularityModel, Stratum,
};
use nalgebra::Vector3;

/// A book: pages that meet in one curve, three of which two are one sheet (a T-junction), or five and more.
///
/// Four pages of two sheets are [`TwoPlanes`](super::TwoPlanes) and three at angles
/// [`YJunction`](super::YJunction), which are fitted without looking for pages, and to fewer points.
/// The pages are read from the normals of small pieces of surface; each, or two that continue
/// each other, become a quadratic patch, and the curve is where the patches meet.
#[derive(Clone, Copy, Debug)]
pub struct Book {
    tolerance: Tolerance,
    tuning: BookTuning,
}

/// The label of the curve; those of the pages follow.
const CURVE: Label = Label::new(0);

impl Book {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to the place in which the sheets meet is on the curve.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: BookTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: BookTuning) -> Self {
        Self { tuning, ..self }
    }

    /// Whether the points lie on two planes, on both sides of each: that is told in a tenth of the time that pages take.
    fn is_crossing(&self, points: &[Vector3<f64>], radius: f64) -> bool {
        let Ok(pair) = PlanePair::direct(points.iter().copied(), radius) else {
            return false;
        };
        let mut held = [0usize; 4];
        let mut sum = 0.0;
        for x in points {
            let [a, b] = [0, 1].map(|k| pair.distance(k, x));
            let (own, other, off) = if a.abs() < b.abs() {
                (0, b, a)
            } else {
                (1, a, b)
            };
            // About the line a sheet that bends is on either side of its plane.
            if other.abs() > self.tolerance.ep {
                held[2 * own + usize::from(other >= 0.0)] += 1;
            }
            sum += off * off;
        }
        let count = points.len() as f64;
        let least = self.tuning.share * count;
        sum <= self.tolerance.ep.powi(2) * count && held.iter().all(|&h| h as f64 >= least)
    }

    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(3 * PATCH_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..local.fitted];
        if self.is_crossing(points, local.radius) {
            return Err(Rejection::NoRealSolution);
        }
        let (tuning, radius) = (&self.tuning, local.radius);
        let book = PageSheets::read(&all, local.fitted, radius, &tuning.pages, |pages| {
            match (pages.out.len(), pages.pairs().len()) {
                (3, sheets) => sheets > 0,
                (4, sheets) => sheets != 2,
                _ => true,
            }
        })?;
        let residual = book.residual(points, &self.tolerance, tuning.astray)?;
        book.are_held(points, tuning.share)?;
        Ok(Fit {
            all,
            book,
            residual,
            ep: self.tolerance.ep,
            radius,
            fitted: local.fitted,
            tuning: self.tuning,
        })
    }
}

/// A neighborhood with its book.
struct Fit {
    all: Vec<Vector3<f64>>,
    book: PageSheets,
    residual: f64,
    ep: f64,
    radius: f64,
    fitted: usize,
    tuning: BookTuning,
}

impl Fit {
    /// Place on the curve near a row, where the row is near enough to tell.
    fn on_curve(&self, row: usize) -> Option<Vector3<f64>> {
        let x = self.all[row];
        let pages = &self.book.pages;
        let d = x - pages.place;
        let aside = d - pages.along * pages.along.dot(&d);
        // The curve is no farther from the line than it bends within the ball.
        let step = self.tuning.step * self.radius;
        let near = aside.norm() < step;
        let place = self.book.meet(x, step).filter(|_| near)?;
        ((place - x).norm() < self.tuning.witness * self.ep).then_some(place)
    }

    fn label(&self, row: usize) -> Label {
        let x = self.all[row];
        match self.on_curve(row) {
            Some(place) if (place - x).norm() < self.ep => CURVE,
            _ => Label::new(1 + self.book.page(row, &x)),
        }
    }

    /// Whether every page has a point near a place on the curve.
    fn is_supported(&self, place: &Vector3<f64>) -> bool {
        let pages = 0..self.book.count();
        pages.into_iter().all(|page| {
            self.all[..self.fitted].iter().enumerate().any(|(row, x)| {
                (x - place).norm() < self.tuning.support * self.radius
                    && self.book.page(row, x) == page
            })
        })
    }
}

impl OneFit for Fit {
    fn located(&self, row: usize) -> Option<Located> {
        let x = self.all[row];
        let place = self.on_curve(row).filter(|p| self.is_supported(p));
        let on = self.label(row) == CURVE;
        if on && place.is_none() {
            return None;
        }
        let cells = self.book.count() as u8;
        Some(located(x, if on { 1 } else { 2 }, cells, place))
    }

    fn decomposition(self, center: Located) -> Decomposition {
        let count = self.book.count();
        let dimensions = std::iter::once(1).chain(std::iter::repeat_n(2, count));
        Decomposition {
            strata: dimensions.map(|dimension| Stratum { dimension }).collect(),
            labels: (0..self.all.len()).map(|row| self.label(row)).collect(),
            cells_at_curve: vec![count as u8],
            residual: self.residual,
            // Besides the patches the direction and the place of the line.
            parameters: self.book.parameters() + 4,
            points: Vec::new(),
            center: center.place,
            center_offset: center.offset,
        }
    }
}

impl SingularityModel for Book {
    fn local_dimension(&self) -> usize {
        3
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        self.fit(local)?.about(local.center, rows)
    }

    fn name(&self) -> &str {
        "book"
    }
}

#[cfg(test)]
mod tests {
    use super::super::about_first;
    use super::*;
    use std::f64::consts::{PI, TAU};

    const RADIUS: f64 = 1.0;

    /// Half planes about the third axis at the given turns, in a ball about the origin; the first point is on the axis.
    pub(in crate::singularity) fn book(turns: &[f64]) -> Vec<f64> {
        let steps = || (0..12).map(|k| (f64::from(k) + 0.4) / 12.0);
        let page = |t: f64| {
            let (s, c) = t.sin_cos();
            steps().flat_map(move |r| steps().map(move |z| [r * c, r * s, 2.0 * z - 1.0]))
        };
        (std::iter::once([0.0; 3]).chain(turns.iter().flat_map(|&t| page(t))))
            .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS)
            .flatten()
            .collect()
    }

    fn decompose(coordinates: &[f64]) -> Result<Decomposition, Rejection> {
        Book::new(0.2, 0.1)
            .unwrap()
            .decompose(&about_first(coordinates, RADIUS))
    }

    #[test]
    fn every_page_is_a_cell() {
        let even = |count: usize| -> Vec<f64> {
            (0..count)
                .map(|k| 0.2 + TAU * k as f64 / count as f64)
                .collect()
        };
        for turns in [vec![0.0, 1.5, PI], even(5), even(6), even(8)] {
            let places = book(&turns);
            let fit = decompose(&places).unwrap();
            assert_eq!(fit.cells_at_curve, [turns.len() as u8]);
            assert_eq!(fit.strata.len(), 1 + turns.len());
            assert!(fit.center_offset < 0.02, "{}", fit.center_offset);
            let mut seen = vec![None; turns.len()];
            for (x, &label) in places.chunks_exact(3).zip(&fit.labels) {
                let from = x[0].hypot(x[1]);
                assert_eq!(label == CURVE, from < 0.1, "{x:?}");
                if label > CURVE {
                    let turn = x[1].atan2(x[0]).rem_euclid(TAU);
                    let page = (turns.iter()).position(|t| (t - turn).abs() < 1e-6);
                    let known = seen[label.index() - 1].get_or_insert(page);
                    assert_eq!(*known, page, "{x:?}");
                }
            }
            assert!(seen.iter().all(Option::is_some));
        }
    }

    /// A sheet that bends towards the side on which another one stands is on both sides of its own mean plane about the
    /// curve: no crossing for that.
    #[test]
    fn a_sheet_that_stands_on_a_bent_one_is_no_crossing() {
        // On the inside of a cylinder, of 4.6 radii of the ball, about the third axis.
        let bend = 4.6;
        let steps = || (0..9).map(|k| f64::from(k) / 9.0);
        let bent = steps().flat_map(|z| {
            (-9..=9).map(move |k| {
                let (s, c) = libm::sincos(f64::from(k) / (9.0 * bend));
                [bend * s, bend * (1.0 - c), 2.0 * z - 1.0]
            })
        });
        let standing = steps().flat_map(|z| steps().map(move |r| [0.0, r, 2.0 * z - 0.93]));
        let places: Vec<f64> = (std::iter::once([0.0; 3]).chain(bent).chain(standing))
            .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS)
            .flatten()
            .collect();
        let fit = decompose(&places).unwrap();
        assert_eq!(fit.cells_at_curve, [3]);
        assert!(fit.center_offset < 0.02, "{}", fit.center_offset);
    }

    #[test]
    fn what_other_models_know_is_none() {
        // A sheet, a crossing, a Y-junction.
        let known = [
            vec![0.0, PI],
            vec![0.0, 1.5, PI, PI + 1.5],
            vec![0.0, 2.1, 4.2],
        ];
        for turns in known {
            assert!(decompose(&book(&turns)).is_err(), "{turns:?}");
        }
    }
}
