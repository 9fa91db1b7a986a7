//! The sheets of pages that meet in a curve: a quadratic patch for every page, or for two that are one sheet.

use super::curve_end;
use super::flats::Flat;
use super::pages::Pages;
use super::plane_pair::PlanePair;
use super::sheets::Sheets;
use super::tolerance::{LEAST_HELD, Tolerance};
use crate::tuning::PagesTuning;
use crosscap_core::Rejection;
use nalgebra::Vector3;

/// Most pages that labels are given to.
pub(super) const MOST_PAGES: usize = 60;

/// One sheet: a page, or two that continue each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageSheet {
    /// Its page, and the one on the other side of the curve where there is one.
    pub(super) pages: [Option<usize>; 2],
    /// The sheet whose patch tells the two sides apart.
    divider: usize,
    /// Sign of the distance from that patch on the first page.
    sign: f64,
}

/// Pages with their sheets.
pub(super) struct PageSheets {
    pub(super) pages: Pages,
    pub(super) sheets: Sheets,
    pub(super) of: Vec<PageSheet>,
    radius: f64,
}

impl PageSheets {
    /// Patches over the pages that the first `fitted` of the points show, where they are those that are asked for.
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] where they show no such pages.
    pub(super) fn read(
        all: &[Vector3<f64>],
        fitted: usize,
        radius: f64,
        tuning: &PagesTuning,
        asked: impl Fn(&Pages) -> bool,
    ) -> Result<Self, Rejection> {
        let pages = Pages::read(&all[..fitted], radius, tuning)
            .filter(|pages| pages.out.len() <= MOST_PAGES && asked(pages))
            .ok_or(Rejection::NoRealSolution)?;
        Ok(Self::over(pages, all, fitted, radius))
    }

    /// Patches over the four pages of two sheets that cross, at whatever angle.
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] where the points show no two planes.
    pub(super) fn crossing(
        all: &[Vector3<f64>],
        fitted: usize,
        radius: f64,
        tuning: &PagesTuning,
    ) -> Result<Self, Rejection> {
        let pages = crossing(&all[..fitted], radius, tuning)?;
        Ok(Self::over(pages, all, fitted, radius))
    }

    /// Patches over pages, and again over where these patches meet: which side of the line a point is on decides what it is
    /// fitted to, and the line as it was read is a little off.
    fn over(pages: Pages, all: &[Vector3<f64>], fitted: usize, radius: f64) -> Self {
        let first = Self::laid(pages, all, fitted, radius);
        match first.settled() {
            Some(pages) => Self::laid(pages, all, fitted, radius),
            None => first,
        }
    }

    /// Patches over pages about the line that these have.
    fn laid(pages: Pages, all: &[Vector3<f64>], fitted: usize, radius: f64) -> Self {
        let parts = parts(&pages);
        let planes: Vec<Flat<3>> = (parts.iter())
            .map(|part| {
                let out = part[0].map_or(Vector3::zeros(), |p| pages.out[p]);
                let out = part[1].map_or(out, |p| out - pages.out[p]);
                Flat {
                    origin: pages.place,
                    normals: vec![pages.along.cross(&out).normalize()],
                }
            })
            .collect();
        let distance = |k: usize, d: f64, x: &Vector3<f64>| off(&pages, &parts[k], d, x);
        let sheets = Sheets::new(&planes, all, fitted, radius, distance);
        let mut out = Self {
            of: Vec::with_capacity(parts.len()),
            pages,
            sheets,
            radius,
        };
        for (k, part) in parts.into_iter().enumerate() {
            out.of.push(PageSheet {
                pages: part,
                ..out.divided(k, part[0].unwrap_or(0), &planes)
            });
        }
        out
    }

    /// The pages about the line in which the patches meet.
    fn settled(&self) -> Option<Pages> {
        let place = self.meet(self.pages.place, self.radius)?;
        let normals: Vec<Vector3<f64>> = (self.sheets.patches.iter())
            .map(|patch| patch.height(&place).1.normalize())
            .collect();
        let pairs = (0..normals.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let along = pairs
            .map(|(a, b)| normals[a].cross(&normals[b]))
            .max_by(|x, y| x.norm_squared().total_cmp(&y.norm_squared()))
            .filter(|along| along.norm() > self.pages.tuning.sine)?;
        let along = along.normalize() * along.dot(&self.pages.along).signum();
        let out = self.pages.out.iter();
        let out = out.map(|out| (out - along * along.dot(out)).normalize());
        Some(Pages {
            place,
            along,
            out: out.collect(),
            tuning: self.pages.tuning,
        })
    }

    /// What tells the two sides of a sheet apart: the sheet that is most at right angles to it.
    fn divided(&self, sheet: usize, first: usize, planes: &[Flat<3>]) -> PageSheet {
        let normal = |k: usize| planes[k].normals[0];
        let sine = |k: usize| normal(k).cross(&normal(sheet)).norm();
        let divider = (0..planes.len())
            .max_by(|&a, &b| sine(a).total_cmp(&sine(b)))
            .unwrap_or(sheet);
        let out = self.pages.place + self.pages.out[first] * (self.pages.tuning.out * self.radius);
        PageSheet {
            pages: [None; 2],
            divider,
            sign: self.sheets.patches[divider].signed_distance(&out).signum(),
        }
    }

    /// Number of pages.
    pub(super) fn count(&self) -> usize {
        self.pages.out.len()
    }

    /// Numbers that were fitted.
    pub(super) fn parameters(&self) -> usize {
        6 * self.of.len()
    }

    /// Distance of a point from the nearest sheet: those about the curve can have been given to another before its place was known
    /// exactly.
    fn off(&self, x: &Vector3<f64>) -> f64 {
        let patches = self.sheets.patches.iter().zip(&self.of);
        patches
            .map(|(patch, sheet)| off(&self.pages, &sheet.pages, patch.signed_distance(x), x))
            .fold(f64::INFINITY, f64::min)
    }

    /// Root mean squared distance of the points from the sheets, where they follow them.
    ///
    /// # Errors
    /// [`Rejection::PoorFit`].
    pub(super) fn residual(
        &self,
        points: &[Vector3<f64>],
        tolerance: &Tolerance,
        astray: f64,
    ) -> Result<f64, Rejection> {
        let off: Vec<f64> = points.iter().map(|x| self.off(x)).collect();
        let sum = off.iter().map(|d| d * d).sum();
        let residual = tolerance.residual(sum, points.len())?;
        curve_end::follows(off.into_iter(), residual, tolerance.ep, astray)?;
        Ok(residual)
    }

    /// Page of the point of a row.
    pub(super) fn page(&self, row: usize, x: &Vector3<f64>) -> usize {
        let sheet = &self.of[usize::from(self.sheets.owner[row])];
        match sheet.pages {
            [Some(first), Some(second)] => {
                let d = self.sheets.patches[sheet.divider].signed_distance(x);
                if d * sheet.sign >= 0.0 { first } else { second }
            }
            [page, other] => page.or(other).unwrap_or(0),
        }
    }

    /// Place on the curve near a place; `None` where it is farther than `reach`.
    pub(super) fn meet(&self, from: Vector3<f64>, reach: f64) -> Option<Vector3<f64>> {
        let mut which = [0usize; MOST_PAGES];
        let count = self.of.len();
        (which.iter_mut().enumerate()).for_each(|(k, w)| *w = k);
        self.sheets
            .meet(&which[..count], 2, from, reach, self.pages.tuning.sine)
    }

    /// Refuses pages of which one holds less than the share `least` of the points, or fewer than three.
    pub(super) fn are_held(&self, points: &[Vector3<f64>], least: f64) -> Result<(), Rejection> {
        let mut held = [0usize; MOST_PAGES];
        for (row, x) in points.iter().enumerate() {
            held[self.page(row, x)] += 1;
        }
        let least = (least * points.len() as f64).max(LEAST_HELD as f64);
        match held[..self.count()]
            .iter()
            .position(|&h| (h as f64) < least)
        {
            Some(page) => Err(Rejection::EmptyStratum {
                stratum: 1 + page,
                found: held[page],
            }),
            None => Ok(()),
        }
    }
}

/// The four pages of two planes that cross at an angle too small for gaps between them.
fn crossing(
    points: &[Vector3<f64>],
    radius: f64,
    tuning: &PagesTuning,
) -> Result<Pages, Rejection> {
    let pair = PlanePair::direct(points.iter().copied(), radius)?;
    let (along, place) = (pair.line(&Vector3::zeros())).ok_or(Rejection::NoRealSolution)?;
    let out = pair.normals.map(|normal| along.cross(&normal).normalize());
    let out = vec![out[0], out[1], -out[0], -out[1]];
    Ok(Pages {
        place,
        along,
        out,
        tuning: *tuning,
    })
}

/// The pages of every sheet.
fn parts(pages: &Pages) -> Vec<[Option<usize>; 2]> {
    let mut parts: Vec<[Option<usize>; 2]> = pages.pairs().iter().map(|p| p.map(Some)).collect();
    let alone = |p: &usize| parts.iter().all(|part| !part.contains(&Some(*p)));
    let alone: Vec<usize> = (0..pages.out.len()).filter(alone).collect();
    parts.extend(alone.into_iter().map(|p| [Some(p), None]));
    parts
}

/// Distance of `x`, which is `d` from the patch of a sheet, from the sheet.
fn off(pages: &Pages, part: &[Option<usize>; 2], d: f64, x: &Vector3<f64>) -> f64 {
    match part {
        [Some(page), None] => {
            let side = pages.out[*page].dot(&(x - pages.place));
            if side >= 0.0 { d.abs() } else { d.hypot(side) }
        }
        _ => d.abs(),
    }
}
