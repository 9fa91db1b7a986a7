//! Points at which curves end inside a sheet: what is there is asked of models that say so, with balls as
//! wide as it takes, and their answers stand for all points about the end.

use super::analysis::{Analyzer, Scratch};
use super::site::{On, Site, StratumKind};
use super::strata::Strata;
use crosscap_core::{Decomposition, Error, Neighbor, PointCloud, Scalar, squared_distance};

/// A point at which a curve ends, with the points about it.
#[derive(Clone, Debug)]
pub(super) struct EndRegion {
    /// Rows of the region with their labels, by row.
    pub(super) labels: Vec<(u32, u8)>,
    /// The strata, without the labels.
    pub(super) fit: Decomposition,
    /// Place of the point.
    pub(super) place: Vec<f64>,
    /// How far from it the region reaches.
    pub(super) reach: f64,
}

impl EndRegion {
    /// The label of a row.
    pub(super) fn label(&self, row: usize) -> Option<u8> {
        let key = |x: &(u32, u8)| x.0;
        let at = self.labels.binary_search_by_key(&(row as u32), key).ok()?;
        Some(self.labels[at].1)
    }

    /// Whether a label names a cell.
    fn is_cell(&self, label: u8) -> bool {
        self.fit.strata[usize::from(label)].dimension == 2
    }

    fn distance(&self, place: &[f64]) -> f64 {
        squared_distance(&self.place, place).sqrt()
    }
}

/// What becomes of a row of a region.
pub(super) struct Settled {
    pub(super) row: usize,
    /// On which stratum it is, `None` inside a cell.
    pub(super) on: Option<On>,
    /// The curve that a row of a cell is near.
    pub(super) beside: Option<On>,
}

/// A point of a curve is an end when the middle of the curve within its radius is off by more than this share
/// of the radius; it is 0.5 at the end of a straight curve.
const END_SHIFT: f64 = 0.3;
/// Radii that are tried about an end, as multiples of the radius of the analysis.
const RADII: [f64; 5] = [1.0, 1.4, 2.0, 2.8, 4.0];
/// Curves of a region have a point within this share of the radius of the analysis, where there is any to be
/// moved.
const GAP: f64 = 0.1;
/// Farthest of the innermost landmarks from the point, in dl.
const INNERMOST: f64 = 1.2;

/// Asks what is at the ends of double curves, and enters the answers.
///
/// # Errors
/// [`Error::Law`] for what a model breaks.
pub(super) fn explain<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    strata: &mut Strata,
) -> Result<(), Error> {
    let models: Vec<usize> = (0..analyzer.models.len())
        .filter(|&m| analyzer.models[m].explains_ends())
        .collect();
    let on_curve = |site: &Site| site.kind() == Some(StratumKind::Curve);
    if models.is_empty() || !strata.sites().iter().any(on_curve) {
        return Ok(());
    }
    let fitter = analyzer.fitter("since ends of curves are looked at in them")?;
    let mut scratch = Scratch::default();
    for (row, eps) in free_ends(analyzer, strata) {
        let found = RADII.iter().find_map(|factor| {
            let one = |&m: &usize| fitter.about_end(m, row, factor * eps, eps, &mut scratch);
            models.iter().find_map(one)
        });
        let Some((region, settled)) = found else {
            continue;
        };
        let apart = |r: &EndRegion| r.distance(&region.place) > region.reach + r.reach;
        if strata.regions().iter().all(apart) {
            enter(strata, fitter.cloud, region, settled, eps);
        }
    }
    fitter.faults.none()
}

/// Ends of double curves that stop at nothing, with the radius of the analysis there: those that are ends most.
fn free_ends<S: Scalar>(analyzer: &Analyzer<'_, S>, strata: &Strata) -> Vec<(usize, f64)> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let double = |row: usize| strata.kind(row) == Some(StratumKind::Curve) && strata.cells(row) > 2;
    let mut near: Vec<Neighbor<S>> = Vec::new();
    let mut found: Vec<(f64, usize, f64)> = Vec::new();
    for row in (0..strata.len()).filter(|&row| double(row)) {
        // The fit of the row itself may have shrunk.
        let mut eps = strata.radius(row).unwrap_or(0.0);
        for _ in 0..2 {
            analyzer.space.oracle().within(row, S::of(eps), &mut near);
            let radii = near.iter().filter_map(|x| strata.radius(x.index));
            eps = radii.fold(eps, f64::max);
        }
        analyzer.space.oracle().within(row, S::of(eps), &mut near);
        let place = places.point(row);
        let mut mean = vec![0.0; place.len()];
        let mut count = 0.0;
        let mut stopped = false;
        for x in &near {
            stopped |= strata.kind(x.index) == Some(StratumKind::Point);
            if double(x.index) {
                count += 1.0;
                for ((m, o), p) in mean.iter_mut().zip(places.point(x.index)).zip(place) {
                    *m += o - p;
                }
            }
        }
        let shift = mean.iter().map(|m| m * m).sum::<f64>().sqrt() / count;
        if !stopped && shift > END_SHIFT * eps {
            found.push((shift, row, eps));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut ends: Vec<(usize, f64)> = Vec::new();
    for (_, row, eps) in found {
        let free = |x: &(usize, f64)| places.squared_distance(row, x.0) > eps * eps;
        if ends.iter().all(free) {
            ends.push((row, eps));
        }
    }
    ends
}

/// Enters what a model says about the end of a curve.
fn enter<S: Scalar>(
    strata: &mut Strata,
    cloud: &PointCloud<S>,
    region: EndRegion,
    settled: Vec<Settled>,
    eps: f64,
) {
    let mut beside: Vec<(usize, On)> = Vec::new();
    let mut at_point = false;
    for row in settled {
        at_point |= row
            .on
            .as_ref()
            .is_some_and(|on| on.kind == StratumKind::Point);
        strata.enter(cloud, row.row, row.on);
        beside.extend(row.beside.map(|on| (row.row, on)));
    }
    fill_gaps(strata, cloud, &region, beside, eps);
    if !at_point {
        // The nearest row stands for the point.
        let far = |row: &usize| {
            let own = cloud.point(*row).iter().map(|x| x.as_f64());
            let squares = own.zip(&region.place).map(|(x, p)| (x - p) * (x - p));
            squares.sum::<f64>()
        };
        let rows = region.labels.iter().map(|x| x.0 as usize);
        let nearest = rows.min_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
        let fit = (region.labels.iter()).find_map(|x| strata.sites()[x.0 as usize].on()?.fit);
        if let Some(row) = nearest {
            let on = On {
                kind: StratumKind::Point,
                place: Some(region.place.clone().into()),
                moved: far(&row).sqrt(),
                fit,
                cells: 0,
            };
            strata.enter(cloud, row, Some(on));
        }
    }
    strata.add_region(region);
}

/// Moves points beside the curves of a region onto them where they have gaps.
fn fill_gaps<S: Scalar>(
    strata: &mut Strata,
    cloud: &PointCloud<S>,
    region: &EndRegion,
    mut beside: Vec<(usize, On)>,
    eps: f64,
) {
    beside.sort_by(|a, b| a.1.moved.total_cmp(&b.1.moved).then(a.0.cmp(&b.0)));
    let gap = GAP * eps;
    let rows = region.labels.iter().map(|x| x.0 as usize);
    let place_of = |strata: &Strata, row: usize| {
        let on = strata.sites()[row].on()?;
        let curve = on.kind == StratumKind::Curve;
        Some((on.cells, on.place.clone()?)).filter(|_| curve)
    };
    let mut there: Vec<(u8, Box<[f64]>)> = rows.filter_map(|r| place_of(strata, r)).collect();
    for (row, on) in beside {
        let Some(place) = on.place.clone() else {
            continue;
        };
        let covered =
            |x: &(u8, Box<[f64]>)| x.0 == on.cells && squared_distance(&x.1, &place) < gap * gap;
        if region.distance(&place) > gap && !there.iter().any(covered) {
            there.push((on.cells, place));
            strata.enter(cloud, row, Some(on));
        }
    }
}

/// The regular row nearest to the point of every region in each of its cells, but clear of the curves: without
/// a landmark there the triangle between two curves would be that of several cells.
pub(super) fn innermost(strata: &Strata, dl: f64) -> Vec<usize> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut out = Vec::new();
    for region in strata.regions() {
        let on_curves: Vec<usize> = (region.labels.iter().map(|x| x.0 as usize))
            .filter(|&row| !strata.is_regular(row))
            .collect();
        let clear = |row: usize| {
            let squares = on_curves.iter().map(|&c| places.squared_distance(row, c));
            squares.fold(f64::INFINITY, f64::min)
        };
        for label in (0..region.fit.strata.len() as u8).filter(|&l| region.is_cell(l)) {
            let own = region.labels.iter().filter(|x| x.1 == label);
            let near = own.map(|x| x.0 as usize).filter(|&row| {
                strata.is_regular(row) && region.distance(places.point(row)) < INNERMOST * dl
            });
            let best = near.max_by(|&a, &b| clear(a).total_cmp(&clear(b)).then(b.cmp(&a)));
            out.extend(best);
        }
    }
    out
}

/// Which cell of which region every row is in: a flood that starts well inside one does not come back to
/// the others by a way around the ends of the curves between them.
pub(super) struct Wards<'a> {
    strata: &'a Strata,
    /// 0 outside of all regions and on curves, equal for rows of one cell; empty where there is no region.
    cells: Vec<u32>,
    dl: f64,
}

/// Names of cells of one region differ below this.
const CELLS_OF_A_REGION: u32 = 256;

impl<'a> Wards<'a> {
    /// The wards of all regions; charts are laid over landmarks some `dl` apart.
    pub(super) fn new(strata: &'a Strata, dl: f64) -> Self {
        let mut cells = Vec::new();
        if !strata.regions().is_empty() {
            cells.resize(strata.len(), 0);
        }
        for (name, region) in (1u32..).zip(strata.regions()) {
            for &(row, label) in region.labels.iter().filter(|x| region.is_cell(x.1)) {
                cells[row as usize] = name * CELLS_OF_A_REGION + u32::from(label);
            }
        }
        Self { strata, cells, dl }
    }

    /// The cell that a flood from `row` about a landmark keeps to; 0 for one near the rim of its region,
    /// where all cells come together.
    pub(super) fn of(&self, landmark: usize, row: usize) -> u32 {
        let (Some(&cell), Some(places)) = (self.cells.get(row), self.strata.places()) else {
            return 0;
        };
        if cell == 0 {
            return 0;
        }
        let region = &self.strata.regions()[(cell / CELLS_OF_A_REGION) as usize - 1];
        let inside = region.distance(places.point(landmark)) < region.reach - self.dl;
        if inside { cell } else { 0 }
    }

    /// Whether a flood that keeps to `cell` may reach `row`.
    pub(super) fn admits(&self, cell: u32, row: usize) -> bool {
        let other = |c: u32| c != cell && c / CELLS_OF_A_REGION == cell / CELLS_OF_A_REGION;
        cell == 0 || !self.cells.get(row).is_some_and(|&c| other(c))
    }
}

#[cfg(test)]
mod tests;
