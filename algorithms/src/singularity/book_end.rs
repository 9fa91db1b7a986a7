//! A curve that ends where the sheets that meet in it do.

use super::curve_end::CurveEnd;
use super::page_sheets::PageSheets;
use super::patch::PATCH_POINTS;
use super::rim::{EndingSheet, Rim};
use super::tolerance::{Tolerance, at_least, vectors};
use crate::tuning::BookEndTuning;
use crosscap_core::{
    Decomposition, Error, Link, LocalPoints, Located, Rejection, SingularityModel,
};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The end of a curve in which any number of pages meet: some of the sheets end there, on boundaries that
/// nobody has to give, and the others go on beyond it.
///
/// Two crossing sheets that both end, three of a foam, one that stands on another, at its rim or inside, five and more:
/// they differ in the pages that [`Book`](super::Book) reads, and in which sheets end. Each is a
/// quadratic patch laid out in its tangent plane at the curve, and its boundary the lowest parabola that has all
/// of its points on one side, as [`Boundary`](super::Boundary) finds it. The curve ends where it meets all of them.
/// A sheet that goes on has points beyond any such parabola; a seam of two cells, which
/// continues the curve inside it, lets its two pages be told apart up to the end.
#[derive(Clone, Copy, Debug)]
pub struct BookEnd {
    tolerance: Tolerance,
    tuning: BookEndTuning,
}

/// Labels: the point and the curve; then those of rims and seams, then cells.
const POINT: u8 = 0;
const CURVE: u8 = 1;

impl BookEnd {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to the place where the sheets meet is on the curve, nearer than that to the end of its sheet on the boundary.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: BookEndTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: BookEndTuning) -> Self {
        Self { tuning, ..self }
    }

    /// The sheets and their boundaries.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(2 * PATCH_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let (fitted, radius) = (local.fitted, local.radius);
        let first = PageSheets::read(&all, fitted, radius, &self.tuning.pages, |_| true);
        first
            .and_then(|book| self.ended(book, &all, local))
            .or_else(|_| {
                let pages = &self.tuning.pages;
                self.ended(
                    PageSheets::crossing(&all, fitted, radius, pages)?,
                    &all,
                    local,
                )
            })
    }

    /// The end of the curve of given pages.
    fn ended(
        &self,
        book: PageSheets,
        all: &[Vector3<f64>],
        local: &LocalPoints<'_>,
    ) -> Result<Fit, Rejection> {
        let (points, radius, ep) = (&all[..local.fitted], local.radius, self.tolerance.ep);
        let (center, tuning) = (all[local.center], &self.tuning);
        let residual = book.residual(points, &self.tolerance, tuning.end.astray)?;
        book.are_held(points, 0.0)?;
        let meet = |x| {
            book.meet(x, tuning.step * radius)
                .ok_or(Rejection::NoRealSolution)
        };
        let near = meet(center)?;
        // The mean of the points is the origin.
        let along = book.pages.along;
        let way = if along.dot(&near) < 0.0 {
            -along
        } else {
            along
        };
        let spacing = radius * (0.5 * PI * book.count() as f64 / points.len() as f64).sqrt();
        let most = (tuning.apart * spacing).max(tuning.apart_ep * ep);
        let (middle, rims) = ending(&book, points, [near, way], [radius, most], tuning)?;
        let end = meet(farthest_on(&book, points, way, middle, ep, &rims))?;
        if (end - center).norm() > tuning.end.reach * radius {
            return Err(Rejection::NoRealSolution);
        }
        let names = Names::of(&book, &rims);
        Ok(Fit {
            all: all.to_vec(),
            book,
            rims,
            names,
            way,
            end,
            residual,
            ep,
            reach: tuning.step * radius,
            witness: tuning.end.witness,
        })
    }
}

/// The end of a curve that is about at `middle`, or where the last point of the curve is that belongs to a sheet that ends,
/// if that is farther out: no point lies beyond the end.
fn farthest_on(
    book: &PageSheets,
    points: &[Vector3<f64>],
    way: Vector3<f64>,
    middle: Vector3<f64>,
    ep: f64,
    rims: &[Option<Rim>],
) -> Vector3<f64> {
    let on = points.iter().zip(&book.sheets.owner).filter(|(x, sheet)| {
        let from = *x - middle;
        let aside = (from - way * way.dot(&from)).norm();
        rims[usize::from(**sheet)].is_some() && aside < ep
    });
    let beyond = on.map(|(x, _)| way.dot(&(x - middle)));
    middle + way * beyond.fold(0.0, f64::max)
}

/// The points of a sheet, with the direction into it where it is on one side of the curve alone.
fn sheet<'b>(book: &'b PageSheets, points: &[Vector3<f64>], k: usize) -> EndingSheet<'b> {
    let own = points.iter().zip(&book.sheets.owner);
    let own = own.filter(|x| usize::from(*x.1) == k).map(|x| *x.0);
    let half = match book.of[k].pages {
        [Some(page), None] => Some(book.pages.out[page]),
        _ => None,
    };
    EndingSheet {
        patch: &book.sheets.patches[k],
        points: own.collect(),
        half,
    }
}

/// Where the curve ends, about, and the boundary of every sheet that does, `None` for those that go on; a single page cannot. `near`
/// is a place on the curve, `way` its direction. Sheets on both sides of the curve have boundaries of their own, which it
/// meets at most `most` apart; where there are single pages, the boundaries of all go through one place.
fn ending(
    book: &PageSheets,
    points: &[Vector3<f64>],
    [near, way]: [Vector3<f64>; 2],
    [radius, most]: [f64; 2],
    tuning: &BookEndTuning,
) -> Result<(Vector3<f64>, Vec<Option<Rim>>), Rejection> {
    let count = book.of.len();
    let mut rims: Vec<Option<Rim>> = Vec::with_capacity(count);
    let mut ended: Vec<(usize, EndingSheet<'_>)> = Vec::new();
    for k in 0..count {
        let sheet = sheet(book, points, k);
        let own = match sheet.half {
            Some(_) => Ok(None),
            None => Rim::of(&sheet, near, way, radius, &tuning.rim).map(Some),
        };
        match own {
            Err(Rejection::EmptyStratum { .. }) => rims.push(None),
            other => {
                rims.push(other?);
                ended.push((k, sheet));
            }
        }
    }
    if ended.iter().any(|(_, sheet)| sheet.half.is_some()) {
        let (which, sheets): (Vec<usize>, Vec<EndingSheet<'_>>) = ended.into_iter().unzip();
        let (end, found) =
            Rim::all_through(&sheets, near, way, radius, tuning.crossing, &tuning.rim)?;
        which
            .into_iter()
            .zip(found)
            .for_each(|(k, rim)| rims[k] = Some(rim));
        return Ok((end, rims));
    }
    let crossings = rims
        .iter()
        .flatten()
        .map(|rim| rim.crossing(tuning.crossing));
    let crossings: Option<Vec<Vector3<f64>>> = crossings.collect();
    let crossings = crossings.ok_or(Rejection::NoRealSolution)?;
    let apart = (crossings.iter()).any(|x| crossings.iter().any(|y| (x - y).norm() > most));
    if crossings.is_empty() || apart {
        return Err(Rejection::NoRealSolution);
    }
    let middle = crossings.iter().sum::<Vector3<f64>>() / crossings.len() as f64;
    Ok((middle, rims))
}

/// Labels of the pages.
struct Names {
    /// Of the boundary of every page, or of the seam that it ends at.
    rims: Vec<u8>,
    /// Of its cell.
    cell_of: Vec<u8>,
    /// Dimension of the stratum of every label, and how many cells meet at those that are curves.
    strata: Vec<u8>,
    cells_at_curve: Vec<u8>,
}

impl Names {
    fn of(book: &PageSheets, rims: &[Option<Rim>]) -> Self {
        let count = book.count();
        let mut out = Self {
            rims: vec![0; count],
            cell_of: vec![0; count],
            strata: vec![0, 1],
            cells_at_curve: vec![count as u8],
        };
        for (sheet, rim) in book.of.iter().zip(rims) {
            let seam = out.strata.len() as u8;
            for page in sheet.pages.iter().flatten() {
                out.rims[*page] = match rim {
                    Some(_) => out.strata.len() as u8,
                    None => seam,
                };
                if rim.is_some() || seam == out.strata.len() as u8 {
                    out.strata.push(1);
                    out.cells_at_curve.push(if rim.is_some() { 1 } else { 2 });
                }
            }
        }
        for cell in &mut out.cell_of {
            *cell = out.strata.len() as u8;
            out.strata.push(2);
        }
        out
    }
}

/// A neighborhood with its sheets.
struct Fit {
    all: Vec<Vector3<f64>>,
    book: PageSheets,
    /// The boundary of each sheet that ends.
    rims: Vec<Option<Rim>>,
    names: Names,
    /// Direction of the curve towards its end, and that end.
    way: Vector3<f64>,
    end: Vector3<f64>,
    residual: f64,
    ep: f64,
    /// How far places on the curve are looked for.
    reach: f64,
    witness: f64,
}

impl CurveEnd for Fit {
    fn strata(&self) -> &[u8] {
        &self.names.strata
    }

    fn cells(&self) -> &[u8] {
        &self.names.cells_at_curve
    }

    // The patches and the parabolas at their ends.
    fn parameters(&self) -> usize {
        self.book.parameters() + 3 * self.rims.iter().flatten().count()
    }

    fn points(&self) -> &[Vector3<f64>] {
        &self.all
    }

    fn end(&self) -> Vector3<f64> {
        self.end
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn ep(&self) -> f64 {
        self.ep
    }

    fn witness(&self) -> f64 {
        self.witness
    }

    fn locate(&self, row: usize) -> (u8, Vector3<f64>, u8) {
        let x = self.all[row];
        let page = self.book.page(row, &x);
        let sheet = usize::from(self.book.sheets.owner[row]);
        let (rim_name, cell) = (self.names.rims[page], self.names.cell_of[page]);
        let curve = (self.book.meet(x, self.reach))
            .map(|place| (place, (place - x).norm(), self.way.dot(&(self.end - place))));
        let pages = self.book.count() as u8;
        let Some(rim) = &self.rims[sheet] else {
            return match curve {
                None => (cell, self.end, pages),
                Some((place, off, before)) => match (off < self.ep, before) {
                    (true, t) if t.abs() < self.ep => (POINT, self.end, 0),
                    (true, t) if t > 0.0 => (CURVE, place, pages),
                    (true, _) => (rim_name, place, 2),
                    (false, t) if t > 0.0 => (cell, place, pages),
                    (false, _) => (cell, place, 2),
                },
            };
        };
        let inside = rim.depth(&x);
        // Rows behind those that are fitted may lie beyond it.
        let near_rim = inside.abs() < self.ep;
        let on_rim = rim.place(&self.book.sheets.patches[sheet], &x);
        match (curve, near_rim) {
            // Far behind the end a boundary that bends comes near the curve again.
            (Some((_, off, before)), true) if off < self.ep && before < self.witness * self.ep => {
                (POINT, self.end, 0)
            }
            (Some((place, off, _)), _) if off < self.ep => (CURVE, place, pages),
            (_, true) => (rim_name, on_rim, 1),
            (Some((place, off, _)), _) if off < inside => (cell, place, pages),
            _ => (cell, on_rim, 1),
        }
    }
}

impl SingularityModel for BookEnd {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, _dimension: usize) -> bool {
        false
    }

    fn explains_ends(&self) -> bool {
        true
    }

    fn link_of(&self, fit: &Decomposition) -> Option<Link> {
        let (&pages, rest) = fit.cells_at_curve.split_first()?;
        let ends = rest.iter().filter(|&&cells| cells == 1).count() as u8;
        let arcs: Vec<[u8; 2]> = (rest.iter().filter(|&&cells| cells == 2).map(|_| [0, 0]))
            .chain((1..=ends).map(|leaf| [0, leaf]))
            .collect();
        let link = Link::new(1 + ends, &arcs, 0)?;
        let is_end = (0..=ends).any(|node| link.degree(node) == usize::from(pages));
        is_end.then_some(link)
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        Ok(self.fit(local)?.decomposition(local, rows))
    }

    fn name(&self) -> &str {
        "book-end"
    }
}

#[cfg(test)]
mod tests;
